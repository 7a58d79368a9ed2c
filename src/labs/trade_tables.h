// labs/trade_tables.h  6  a trade's answers and curves in HTML
#pragma once
#include <functional>
#include <set>

#include "labs/trade_curves.h"
#include "labs/trade_shots.h"

namespace page {

// ---- Tables ------------------------------------------------------------------------------------

struct Column {
    std::string title;
    bool number = true;
};

// The first cell of a row is its head.  Cells hold HTML, the caption and titles hold text.
inline std::string table(const std::string& caption, const std::vector<Column>& columns,
                         const std::vector<std::vector<std::string>>& rows) {
    std::string out = text(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"%s\">\n<table>"
        "<caption><span>%s</span></caption>\n<thead><tr>",
        escaped(caption), escaped(caption));
    auto kind = [&](size_t k) { return columns[k].number ? " class=\"number\"" : ""; };
    for (size_t k = 0; k < columns.size(); ++k)
        out += text("<th scope=\"col\"%s>%s</th>", kind(k), escaped(columns[k].title));
    out += "</tr></thead>\n<tbody>\n";
    for (const auto& row : rows) {
        out += text("<tr><th scope=\"row\"%s>%s</th>", kind(0), row[0]);
        for (size_t k = 1; k < row.size(); ++k) out += text("<td%s>%s</td>", kind(k), row[k]);
        out += "</tr>\n";
    }
    return out + "</tbody></table></div>\n";
}

// "2.1 s · 1.3×": a time, and how many times another it is; one below the other on telephones.
inline std::string told_times(double seconds, double ratio) {
    if (!std::isfinite(seconds)) return told_nothing;
    return text("<span>%s</span> <span>· %s</span>", told_seconds(seconds), told_ratio(ratio));
}

// What an error costs at least, and by default.
inline std::string answers(const TradeScene& scene) {
    std::vector<std::vector<std::string>> rows;
    for (const TradeAnswer& a : scene.answers) {
        const bool known = a.setting < scene.settings.size() && std::isfinite(a.seconds);
        const TradeSetting* s = known ? &scene.settings[a.setting] : nullptr;
        const std::string setting =
            s ? text("%s<br><small>%s</small>", code(s->words), told_kind(*s))
              : "none measured gets there";
        rows.push_back({told_percent(a.E), setting, told_seconds(a.seconds),
                        told_times(a.default_seconds, a.default_seconds / a.seconds)});
    }
    return table("The cheapest setting for an error on " + scene.name +
                     ", and how many times its time the default takes",
                 {{"Error"}, {"Cheapest setting", false}, {"Its time"}, {"The default's"}}, rows);
}

// All that was measured, the last point of each.  An error below what the reference shows has no
// number.
inline std::string settings(const TradeScene& scene) {
    std::vector<std::vector<std::string>> rows;
    for (const TradeSetting& s : scene.settings) {
        const TradePoint last = s.points.empty() ? TradePoint{NAN, NAN, NAN, NAN} : s.points.back();
        rows.push_back({code(s.words), told_kind(s), escaped(told_law(s)), told_spread(s),
                        told_number(last.spp, 1), told_seconds(last.seconds),
                        told_percent(last.error), s.dropped.empty() ? "" : escaped(s.dropped)});
    }
    return table("All settings on " + scene.name + ", each with the last count that was measured",
                 {{"Setting", false},
                  {"Numbers, bias", false},
                  {"Error after t s"},
                  {"Points off this law by"},
                  {"Samples a pixel, or particles"},
                  {"Time"},
                  {"Error"},
                  {"Dropped", false}},
                 rows);
}

// Every scene in a row, every error that any was asked for in a column, the largest first.
inline std::string overview(const Trade& trade) {
    std::set<double, std::greater<>> asked;
    for (const TradeScene& scene : trade.scenes)
        for (const TradeAnswer& a : scene.answers) asked.insert(a.E);
    std::vector<Column> columns = {{"Scene", false}};
    for (double E : asked) columns.push_back({told_percent(E)});
    std::vector<std::vector<std::string>> rows;
    for (const TradeScene& scene : trade.scenes) {
        const std::string name = escaped(scene.name);
        rows.push_back({text("<a href=\"#scene-%s\">%s</a>", name, name)});
        for (double E : asked) {
            const auto a = std::find_if(scene.answers.begin(), scene.answers.end(),
                                        [&](const TradeAnswer& answer) { return answer.E == E; });
            rows.back().push_back(a == scene.answers.end()
                                      ? told_nothing
                                      : told_times(a->seconds, a->default_seconds / a->seconds));
        }
    }
    return table(
        "Time of the cheapest setting · how many times that the default takes; –: nothing "
        "measured gets there",
        columns, rows);
}

inline std::string candidates(const Trade& trade) {
    std::vector<std::vector<std::string>> rows;
    for (const TradeCandidate& c : trade.candidates)
        rows.push_back({code(c.words), told_precision(c.is_float), told_ratio(c.mean_ratio),
                        told_ratio(c.worst_ratio), escaped(c.worst_scene)});
    return table("Unbiased settings that take every scene: their time over the cheapest such one's",
                 {{"Setting", false},
                  {"Numbers", false},
                  {"Geometric mean of scenes"},
                  {"Worst"},
                  {"There", false}},
                 rows);
}

// ---- Curves ------------------------------------------------------------------------------------

// HTML knows SVG by itself.
inline std::string curves(const Trade& trade, const TradeScene& scene) {
    const std::vector<size_t> named = named_settings(trade, scene);
    const std::string file = curves_svg(scene, named).file();
    const std::string before = "<svg xmlns=\"http://www.w3.org/2000/svg\"";
    std::string out = text(
        "<figure class=\"curves\">\n<svg role=\"img\" aria-label=\"Error over time on %s, both "
        "axes "
        "logarithmic; the numbers are in the table of all settings\"%s"
        "<figcaption>Points were measured; lines are their laws, the error after t seconds, dashed "
        "in float; all other settings are grey.  Errors were measured on "
        "%d×%d pixels.</figcaption>\n"
        "<ol class=\"legend\">\n",
        escaped(scene.name), file.substr(before.size()), scene.width, scene.height);
    for (size_t k = 0; k < named.size(); ++k) {
        const TradeSetting& s = scene.settings[named[k]];
        out += text(
            "<li><b style=\"background:%s;color:%s\">%zu</b><span>%s%s (%s): <span "
            "class=\"law\">%s</span></span></li>\n",
            svg::colours[k], k < 2 ? "#fff" : "#000", k + 1, code(s.words),
            s.words == trade.default_words ? ", the default" : "", told_kind(s),
            escaped(told_law(s)));
    }
    return out + "</ol></figure>\n";
}

}  // namespace page

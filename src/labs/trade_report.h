// labs/trade_report.h  4  a trade as tables and plots
#pragma once
#include <map>

#include "base/stats.h"
#include "labs/trade_law.h"
#include "labs/trade_words.h"

namespace trade {

// "sobol mis": without what all have; ", float".
inline std::string short_name(const std::string& words, bool is_float) {
    std::istringstream in(words);
    std::string name;
    for (std::string word; in >> word;)
        if (!word.starts_with("--")) name += (name.empty() ? "" : " ") + word;
    if (words.find("--sets ") != words.npos) name += " set";
    return name + (is_float ? ", float" : "");
}
inline std::string short_name(const TradeSetting& s) { return short_name(s.words, s.is_float); }

// ---- Plots --------------------------------------------------------------------------------------

// The default, and what is cheapest at one of the errors asked for; each once.
inline std::vector<size_t> named(const TradeScene& s, const std::string& by_default) {
    std::vector<size_t> list;
    auto add = [&](size_t k) {
        if (k != SIZE_MAX && std::find(list.begin(), list.end(), k) == list.end())
            list.push_back(k);
    };
    add(index_of(s, by_default));
    for (const TradeAnswer& a : s.answers) add(a.setting);
    for (double E : asked) add(cheapest(s, E, is_candidate).setting);
    add(index_of(s, "--sampler independent --light nee"));
    if (list.size() > std::size(svg::colours)) list.resize(std::size(svg::colours));
    return list;
}

inline void add_curve(Plot& plot, const TradeSetting& s, const Plot::Style& style,
                      const std::string& words) {
    std::vector<double> x, y;
    for (const TradePoint& p : s.points) x.push_back(p.seconds), y.push_back(p.error);
    plot.curve(x, y, style, words);
}

// Decades that hold all of a scene's points.
struct Range {
    double lo = HUGE_VAL, hi = 0;
    void add(double x) {
        if (x > 0) lo = std::min(lo, x), hi = std::max(hi, x);
    }
    Axis axis(const std::string& label) const {
        return {label, std::pow(10, std::floor(std::log10(lo))),
                std::pow(10, std::ceil(std::log10(hi)))};
    }
};

inline Svg curves(const Trade& t) {
    constexpr double width = 620, height = 330;
    const size_t columns = 2, rows = (t.scenes.size() + columns - 1) / columns;
    Svg sheet(width * double(columns), height * double(rows));
    size_t drawn = 0;
    for (const TradeScene& s : t.scenes) {
        Range x, y;
        for (const TradeSetting& setting : s.settings)
            for (const TradePoint& p : setting.points)
                if (p.error > 0) x.add(p.seconds), y.add(p.error);
        if (!(x.hi > 0)) continue;
        const size_t place = drawn++;
        Plot plot(sheet,
                  {width * double(place % columns) + 70, height * double(place / columns) + 40},
                  {340, height - 110}, x.axis("core seconds"), y.axis("error (d_rel)"), s.name);
        for (const TradeSetting& setting : s.settings)
            add_curve(plot, setting, {.colour = "#cccccc", .dots = false, .width = 0.7}, "");
        const std::vector<size_t> names = named(s, t.default_words);
        for (size_t k = 0; k < names.size(); ++k)
            add_curve(plot, s.settings[names[k]], {.colour = svg::colours[k]},
                      short_name(s.settings[names[k]]));
    }
    return sheet;
}

// ---- Tables -------------------------------------------------------------------------------------

inline std::string cell(const TradeScene& s, const TradeAnswer& a) {
    const std::string own = "; default " + told_seconds(a.default_seconds);
    if (a.setting == SIZE_MAX) return told_nothing + own;
    return told_seconds(a.seconds) + ": " + short_name(s.settings[a.setting]) + own;
}

inline void tell_answers(Report& report, const Trade& t) {
    report.say(text(R"(## What to choose

For each scene and error: core seconds of the cheapest setting, which it is, and what the default costs
instead.  –: not by what was measured.  Laws are believed up to %.0f times the seconds of their last point,
but of a setting that is biased or computes in float, whose errors have a floor, nothing beyond its points;
no setting is cheaper than one sample a pixel.)",
                    law_reach));
    std::vector<std::string> head = {"scene"};
    for (double E : asked) head.push_back("error " + told_percent(E));
    report.head(head);
    for (const TradeScene& s : t.scenes) {
        std::vector<std::string> cells = {s.name};
        for (const TradeAnswer& a : s.answers) cells.push_back(cell(s, a));
        report.row(cells);
    }
    report.end_of_table();
}

// The default beside itself with one set of samples, at every count that both took.
inline void tell_sets(Report& report, const Trade& t) {
    report.say(R"(## What more samples where noise is bring

1 / (error² × core seconds) of the default over that with --sets 1, which states no error; at equal samples a
set.  The geometric mean is of the scenes where both were measured.)");
    report.head({"scene", "4 samples", "16", "64", "256"});
    std::map<double, Moments> logs;
    for (const TradeScene& s : t.scenes) {
        const size_t own = index_of(s, t.default_words),
                     one = index_of(s, t.default_words + " --sets 1");
        if (own == SIZE_MAX || one == SIZE_MAX) continue;
        std::vector<std::string> cells = {s.name};
        for (const double spp : {4, 16, 64, 256}) {
            auto efficiency = [&](size_t k) -> double {
                for (const TradePoint& p : s.settings[k].points)
                    if (p.spp == spp && p.error > 0) return 1 / (p.error * p.error * p.seconds);
                return 0;
            };
            const double gain = efficiency(one) > 0 ? efficiency(own) / efficiency(one) : 0;
            if (gain > 0) logs[spp].add(std::log(gain));
            cells.push_back(gain > 0 ? text("%.2f", gain) : told_nothing);
        }
        report.row(cells);
    }
    std::vector<std::string> cells = {"geometric mean"};
    for (const double spp : {4, 16, 64, 256})
        cells.push_back(logs[spp].n
                            ? text("%.2f of %.0f", std::exp(logs[spp].mean), double(logs[spp].n))
                            : told_nothing);
    report.row(cells);
    report.end_of_table();
}

inline void tell_default(Report& report, const Trade& t) {
    report.say(R"(## One default

Unbiased settings that take every scene, in double: their seconds over those of the cheapest of them at equal
error (geometric mean over the errors asked for; then over the scenes), and the scene where this is most.)");
    report.head({"setting", "seconds over the best's", "most", "where", ""});
    for (const TradeCandidate& c : t.candidates)
        report.row({"`" + c.words + "`", told_ratio(c.mean_ratio), told_ratio(c.worst_ratio),
                    c.worst_scene, c.words == t.default_words ? "today's default" : ""});
    report.end_of_table();
    if (t.candidates.empty()) return;
    const auto own = std::find_if(t.candidates.begin(), t.candidates.end(),
                                  [&](auto& c) { return c.words == t.default_words; });
    const double ratio = own == t.candidates.end() ? NAN : own->mean_ratio;
    report.claim(ratio <= 1.5, text("Today's default takes %.2f times the seconds of the best, in "
                                    "the mean of the scenes, and no more than 1.5",
                                    ratio));
    report.claim(ratio <= 1.05 * t.candidates[0].mean_ratio,
                 text("It is the best of them, within 5 %% (`%s`: %.2f)", t.candidates[0].words,
                      t.candidates[0].mean_ratio));
}

// Of the default and of what is cheapest at 1 %.
inline void tell_laws(Report& report, const Trade& t) {
    report.say(R"(## Laws

error = c t^-γ, t in core seconds, over the counts measured; spread: the deviation of the points' logarithms
from it.)");
    report.head({"scene", "default: c", "γ", "spread", "reference's own error", "remark"});
    for (const TradeScene& s : t.scenes) {
        const size_t k = index_of(s, t.default_words);
        if (k == SIZE_MAX) continue;
        const TradeSetting& d = s.settings[k];
        report.row({s.name, told_percent(d.c), text("%.2f", d.gamma), text("%.2f", d.spread),
                    told_percent(s.reference_error), s.remark});
    }
    report.end_of_table();
}

inline void tell_float(Report& report, const Trade& t) {
    report.say(R"(## What float saves, and where it costs

Geometric means over settings measured in both precisions, at their last common count: core seconds and error
of float over double's; then the error of the default at its last count.  Errors of float are against the
reference in double: what its rounding changes is in them.)");
    report.head({"scene", "settings", "seconds, float / double", "error, float / double",
                 "default in double", "default in float"});
    for (const TradeScene& s : t.scenes) {
        const FloatBesideDouble f = float_beside_double(s);
        const size_t d = index_of(s, t.default_words), own = index_of(s, t.default_words, true);
        if (f.settings == 0 || d == SIZE_MAX || own == SIZE_MAX) continue;
        report.row({s.name, text("%zu", f.settings), text("%.2f", f.time), text("%.2f", f.error),
                    told_percent(s.settings[d].points.back().error),
                    told_percent(s.settings[own].points.back().error)});
    }
    report.end_of_table();
}

// Who was dropped when, by the words before the colon.
inline void tell_dropped(Report& report, const Trade& t) {
    report.say(text(R"(## What was dropped

Settings whose efficiency 1 / (error² × core seconds) after some samples was less than 1/%.0f of the best of
their class by more than its standard error; and, "for want of time", the worst of the rest when the next
count would have taken more than the scene's share.  Classes: those that may be the default, and all.)",
                    hopeless_factor));
    for (const TradeScene& s : t.scenes) {
        std::vector<std::string> order;
        std::map<std::string, std::string> lists;
        for (const TradeSetting& setting : s.settings) {
            if (setting.dropped.empty()) continue;
            const std::string when = setting.dropped.substr(0, setting.dropped.find(':'));
            if (!lists.contains(when)) order.push_back(when);
            lists[when] += (lists[when].empty() ? "" : "; ") + short_name(setting);
        }
        std::string words = "* " + s.name + (order.empty() ? ": none" : "");
        for (const std::string& when : order) words += "; " + when + ": " + lists[when];
        report.say(words + ".");
    }
}

inline void tell(Report& report, const Trade& t) {
    report.say(R"(# Accuracy against time

What error takes what time, by each setting, so that a user may choose.  Errors are
d_rel = √(1/N Σ(f−g)²) / √(1/N Σf²) (Khodulev 1996, ch. 5) against long runs f whose own error is known and
taken off; bias is in them.  Seconds are core seconds of whole images, without
reading the scene.  Differences of a few per cent between settings are noise.  Settings are named by what
stands after their options, "1 set" without more samples where noise is, "float" the other precision.)");
    tell_answers(report, t);
    report.picture("trade", curves(t), "Error over core seconds; grey: all other settings");
    tell_default(report, t);
    tell_sets(report, t);
    tell_float(report, t);
    tell_laws(report, t);
    tell_dropped(report, t);
}

}  // namespace trade

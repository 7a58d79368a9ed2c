// labs/trade.h  6  the fastest setting for an error; the data of trade.html
#pragma once
#include "keep/pair.h"
#include "labs/grid.h"
#include "text/json.h"

namespace penumbra::trade {

// ---- Measurements -------------------------------------------------------------------------------

// A measurement of a setting: samples per pixel, CPU seconds, relative RMSE or NaN if unknown.
struct Point {
    double spp = 0, seconds = NAN, error = NAN;
};

// The error of an image at distance `off` from a reference with the independent error `own`.  NaN
// if the reference's error may be most of the distance.
inline double known_error(double off, double own) {
    return own <= 0.8 * off ? std::sqrt(off * off - own * own) : NAN;
}

inline std::vector<Point> known(std::vector<Point> points) {
    std::erase_if(points, [](const Point& p) { return !(p.error > 0); });
    return points;
}

// A setting, named by its command, and its measurements.
struct Choice {
    Setting setting;
    bool may_be_default = true;  // unbiased on every scene
    std::vector<Point> points = {};
};
using Choices = std::vector<Choice>;  // the first is the default

// ---- Answers ------------------------------------------------------------------------------------

// The point where a setting reaches an error: its first point if that is as good, else a power law
// between two points.  NaN if no measured error is that small: there is no extrapolation.
inline Point reach(const Choice& c, double error) {
    const std::vector<Point> points = known(c.points);
    const auto to = std::find_if(points.begin(), points.end(),
                                 [&](const Point& p) { return p.error <= error; });
    if (to == points.end()) return {};
    if (to == points.begin()) return *to;
    const Point& from = to[-1];
    const double part = std::log(error / from.error) / std::log(to->error / from.error);
    auto between = [&](double a, double b) { return a * std::pow(b / a, part); };
    return {between(from.spp, to->spp), between(from.seconds, to->seconds), error};
}

// The fastest setting, and the first of equals.  NaN seconds: none reaches the error.
struct Answer {
    size_t choice = 0;
    Point at = {};
};
inline Answer cheapest(const Choices& all, double error, bool among_defaults = false) {
    Answer a;
    for (size_t k = 0; k < all.size(); ++k)
        if (const Point p = reach(all[k], error); all[k].may_be_default || !among_defaults)
            if (p.seconds < a.at.seconds || std::isnan(a.at.seconds)) a = {k, p};
    return a;
}

inline constexpr double asked[] = {0.10, 0.03, 0.01, 0.003};

// A setting's seconds over those of the best default: geometric mean over the requested errors.  If
// it does not reach one, its smallest error counts instead.
inline double ratio_to_best(const Choices& all, const Choice& c) {
    double last = INFINITY;
    for (const Point& p : known(c.points)) last = std::min(last, p.error);
    Moments logs;
    for (double error : asked) {
        const double had = std::max(error, last);
        if (cheapest(all, error, true).at.seconds > 0 && std::isfinite(had))
            logs.add(std::log(reach(c, had).seconds / cheapest(all, had, true).at.seconds));
    }
    return logs.n ? std::exp(logs.mean) : NAN;
}

// ---- Studies ------------------------------------------------------------------------------------

// An image that took the same CPU time as the scene's other shots.  The first is the reference.
struct Shot {
    std::string command;
    Point at;
    Image image;
};

struct Study {
    std::string scene;
    double exposure = 1, own = NAN;  // own: relative RMSE of the reference
    Choices choices = {};
    std::vector<Shot> shots = {};
};

// A possible default with its ratio_to_best: geometric mean over scenes, and the greatest.
struct Candidate {
    std::string command;
    double ratio = NAN, most = 0;
    std::string where = "";
};

// Possible defaults, best first.
inline std::vector<Candidate> candidates(const std::vector<Study>& studies) {
    std::map<std::string, std::pair<Moments, Candidate>> all;
    for (const Study& s : studies)
        for (const Choice& c : s.choices) {
            const double ratio = c.may_be_default ? ratio_to_best(s.choices, c) : NAN;
            if (std::isnan(ratio)) continue;
            auto& [logs, of] = all[c.setting.name];
            logs.add(std::log(ratio));
            if (ratio > of.most) of.most = ratio, of.where = s.scene;
            of.command = c.setting.name, of.ratio = std::exp(logs.mean);
        }
    std::vector<Candidate> sorted;
    for (const auto& [command, both] : all) sorted.push_back(both.second);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Candidate& a, const Candidate& b) { return a.ratio < b.ratio; });
    return sorted;
}

// ---- JSON ---------------------------------------------------------------------------------------

// A JSON array of items, each by json_of.
template <class Item>
std::string array(const std::vector<Item>& items) {
    std::string words;
    for (const Item& item : items) words += (words.empty() ? "" : ",\n") + json_of(item);
    return "[" + words + "]";
}
// A JSON object of alternating names and values.
inline std::string object(const std::vector<std::string>& words) {
    std::string out;
    for (size_t k = 0; k < words.size(); k += 2)
        out += (k ? ", \"" : "\"") + words[k] + "\": " + words[k + 1];
    return "{" + out + "}";
}
inline std::string json_of(const Point& p) {
    return object({"spp", json::number(p.spp), "seconds", json::number(p.seconds), "error",
                   json::number(p.error)});
}
inline std::string json_of(const Choice& c) {
    std::string seconds;  // for each requested error
    for (double error : asked)
        seconds += (seconds.empty() ? "" : ", ") + json::number(reach(c, error).seconds);
    return object({"command", json::string(c.setting.name), "seconds", "[" + seconds + "]",
                   "points", array(c.points)});
}
inline std::string json_of(const Shot& s) {
    return object({"command", json::string(s.command), "at", json_of(s.at)});
}
inline std::string json_of(const Candidate& c) {
    return object({"command", json::string(c.command), "ratio", json::number(c.ratio), "most",
                   json::number(c.most), "where", json::string(c.where)});
}
inline std::string json_of(const Study& s) {
    std::string answers;  // for each requested error
    for (double error : asked) {
        const auto [k, at] = cheapest(s.choices, error);
        answers += (answers.empty() ? "" : ", ") +
                   object({"choice", at.seconds > 0 ? json::number(double(k)) : "null", "spp",
                           json::number(at.spp)});
    }
    const Image& f = s.shots.at(0).image;
    return object({"name", json::string(s.scene), "width", json::number(f.width), "height",
                   json::number(f.height), "exposure", json::number(s.exposure), "own",
                   json::number(s.own), "answers", "[" + answers + "]", "choices", array(s.choices),
                   "shots", array(s.shots)});
}

// Writes the page and its data.  A page opened without a server can read scripts only: trade.js has
// the measurements, NAME.js a scene's images as floats.
inline void write_page(const std::vector<Study>& studies, const std::string& command, bool preview,
                       const std::string& folder) {
    const std::string data =
        object({"command", json::string(command), "preview", json::truth(preview), "asked",
                "[0.1, 0.03, 0.01, 0.003]", "candidates", array(candidates(studies)), "scenes",
                array(studies)});
    write_file(folder + "/trade.js", "const trade = " + data + ";\n");
    std::string page = read_file("src/labs/trade.html");
    const std::string_view place = "<!-- pair_viewer -->";
    write_file(folder + "/trade.html", page.replace(page.find(place), place.size(), pair_viewer));
    for (const Study& s : studies) {
        std::string images;
        for (const Shot& shot : s.shots) images.append("\"").append(base64(shot.image)).append("\",\n");
        write_file(folder + "/" + s.scene + ".js",
                   text("pixels(%s, [\n%s]);\n", json::string(s.scene), images));
    }
}

}  // namespace penumbra::trade

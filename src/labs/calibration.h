// labs/calibration.h  3  the error that a render states, beside its true one
#pragma once
#include <map>
#include <optional>
#include <tuple>

#include "labs/lab.h"

// ---- Runs ---------------------------------------------------------------------------------------

// One render of a scene whose truth is known.
struct Run {
    std::string scene, words;  // "hard/spark", "--spp 16"
    uint64_t seed = 0;
    std::string program, truth;  // fingerprints of what rendered it, and of its reference
    double stated = NAN;         // d_rel; NaN: said not to be known
    double by_spread = NAN;      // d_rel by the spread of replications alone
    double off = 0, own = 0;     // d_rel of image to reference; stated by the reference of itself
    double samples = 0, rays = 0;
    std::string stopped_by;
};
using Runs = std::vector<Run>;

// Image and reference are independent: E off^2 = d^2 + own^2.
inline double square_of(const Run& r) { return r.off * r.off - r.own * r.own; }
inline double true_d(const Run& r) { return std::sqrt(std::max(0.0, square_of(r))); }

// A statement of an error against the truth, a factor of two allowed.  The truth is not known where
// the reference's own error is most of the distance to it.
enum class Verdict { right, too_low, too_high, unknown };
inline bool is_known(const Run& r) { return r.own < 0.8 * r.off; }
inline Verdict verdict(const Run& r, double stated) {
    if (!is_known(r) || std::isnan(stated)) return Verdict::unknown;
    if (2 * stated < true_d(r)) return Verdict::too_low;
    return stated > 2 * true_d(r) ? Verdict::too_high : Verdict::right;
}

inline bool is_hinted(const Run& r) { return std::isnan(r.stated); }
inline bool is_understated(const Run& r) { return verdict(r, r.stated) == Verdict::too_low; }

// The word that a statistics file has under `key`; "": none.
inline std::string word_of(const std::string& json, const std::string& key) {
    const std::string before = "\"" + key + "\": \"";
    const size_t at = json.find(before);
    if (at == json.npos) return "";
    const size_t from = at + before.size();
    return json.substr(from, json.find('"', from) - from);
}

// Both statements of a statistics file.  Without a rule that hushes it, d_rel is the spread's.
inline double stated_in(const std::string& json) { return stats(json, "d_rel")[0]; }
inline double by_spread_in(const std::string& json) {
    const char* key = "d_rel_by_spread";
    return stats(json, json.find(key) == json.npos ? "d_rel" : key)[0];
}

// d_rel of an image to its reference (labs/compare.cpp).
inline double distance(const Image& reference, const Image& image) {
    Image black = reference;
    for (auto& pixel : black.pixels) pixel = {0, 0, 0};
    return std::sqrt(mse(reference, image) / mse(reference, black));
}

// ---- The file of runs ---------------------------------------------------------------------------

// A line, with tabs between; numbers come back as they were.
inline std::string line_of(const Run& r) {
    std::ostringstream line;
    line.precision(17);
    const char tab = '\t';
    line << r.scene << tab << r.words << tab << r.seed << tab << r.program << tab << r.truth << tab
         << r.stated << tab << r.by_spread << tab << r.off << tab << r.own << tab << r.samples
         << tab << r.rays << tab << r.stopped_by << '\n';
    return line.str();
}

// Nothing of a line that was cut short.
inline std::optional<Run> run_of(const std::string& line) {
    std::vector<std::string> cells(1);
    for (char c : line) {
        if (c == '\t')
            cells.emplace_back();
        else
            cells.back() += c;
    }
    if (cells.size() != 12 || cells[11].empty()) return std::nullopt;
    auto number = [&](size_t k) { return std::strtod(cells[k].c_str(), nullptr); };
    return Run{cells[0],  cells[1],   std::strtoull(cells[2].c_str(), nullptr, 10),
               cells[3],  cells[4],   number(5),
               number(6), number(7),  number(8),
               number(9), number(10), cells[11]};
}

// ---- Measures of many runs ----------------------------------------------------------------------

template <class Which>
Runs those(const Runs& runs, Which which) {
    Runs some;
    for (const Run& r : runs)
        if (which(r)) some.push_back(r);
    return some;
}

// Over those whose truth is known.
template <class Which>
double share(const Runs& runs, Which which) {
    const Runs known = those(runs, is_known);
    return double(those(known, which).size()) / double(known.size());
}

template <class Number>
std::vector<double> each(const Runs& runs, Number number) {
    std::vector<double> x;
    for (const Run& r : runs) x.push_back(number(r));
    return x;
}

// What --error asked for; 0: these words have none.
inline double asked_in(const std::string& words) {
    std::istringstream in(words);
    std::string word, value;
    while (in >> word >> value)
        if (word == "--error") return std::stod(value) / 100;
    return 0;
}

// Whether --error was reached, and not another limit.
inline bool is_reached(const Run& r) { return r.stopped_by == "error" && !is_hinted(r); }

// exp of the mean of log x.
inline double geometric_mean(const std::vector<double>& x) {
    double sum = 0;
    for (double v : x) sum += std::log(v);
    return std::exp(sum / double(x.size()));
}

// Of each run a number over that of its twin of the same scene, words and seed.
template <class Number>
std::vector<double> over_twins(const Runs& runs, const Runs& twins, Number number) {
    std::vector<double> ratios;
    for (const Run& r : runs)
        for (const Run& t : twins)
            if (r.scene == t.scene && r.words == t.words && r.seed == t.seed)
                ratios.push_back(number(r) / number(t));
    return ratios;
}

// Mean d^2 times mean rays of some words over that of others, geometric mean over scenes.
inline double cost_over(const Runs& runs, const std::string& words, const std::string& others) {
    std::map<std::string, std::pair<Runs, Runs>> of_scene;
    for (const Run& r : runs) {
        if (r.words == words) of_scene[r.scene].first.push_back(r);
        if (r.words == others) of_scene[r.scene].second.push_back(r);
    }
    auto mean = [](const Runs& all, auto number) {
        const std::vector<double> x = each(all, number);
        return std::accumulate(x.begin(), x.end(), 0.0) / double(x.size());
    };
    auto cost = [&](const Runs& all) {
        return mean(all, square_of) * mean(all, [](const Run& r) { return r.rays; });
    };
    std::vector<double> ratios;
    for (const auto& [scene, both] : of_scene)
        if (const double x = cost(both.first) / cost(both.second); x > 0) ratios.push_back(x);
    return geometric_mean(ratios);
}

// ---- The worst scenes ---------------------------------------------------------------------------

struct Worst {
    std::string scene;
    size_t count = 0, runs = 0;
    double most = 0;  // true over stated, or the like
};

// Scenes by the number of their runs that are so, and then by the greatest number of those.
template <class Which, class Number>
std::vector<Worst> worst_of(const Runs& runs, Which which, Number number) {
    std::map<std::string, Worst> of_scene;
    for (const Run& r : runs) {
        Worst& w = of_scene[r.scene];
        w.scene = r.scene, ++w.runs;
        if (which(r)) ++w.count, w.most = std::max(w.most, number(r));
    }
    std::vector<Worst> all;
    for (const auto& [scene, w] : of_scene)
        if (w.count > 0) all.push_back(w);
    std::sort(all.begin(), all.end(), [](const Worst& a, const Worst& b) {
        return std::tie(a.count, a.most) > std::tie(b.count, b.most);
    });
    return all;
}

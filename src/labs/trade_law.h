// labs/trade_law.h  3  what follows from errors and times: laws, answers, who is hopeless
#pragma once
#include <limits>

#include "labs/lab.h"
#include "labs/trade_data.h"

// ---- Laws ---------------------------------------------------------------------------------------

// Fits error = c seconds^-gamma to a setting's points: least squares of the logarithms, each point
// with the same weight.  Points without an error (smaller than what the reference shows) are left
// out; of fewer than two there is no law.
inline void fit(TradeSetting& s) {
    std::vector<double> t, e;
    for (const TradePoint& p : s.points)
        if (p.error > 0 && p.seconds > 0) t.push_back(p.seconds), e.push_back(p.error);
    s.c = s.gamma = s.spread = NAN;
    if (t.size() < 2) return;
    s.gamma = -slope(t, e);
    double log_c = 0, squares = 0;
    for (size_t k = 0; k < t.size(); ++k)
        log_c += (std::log(e[k]) + s.gamma * std::log(t[k])) / double(t.size());
    s.c = std::exp(log_c);
    for (size_t k = 0; k < t.size(); ++k) {
        const double off = std::log(e[k]) + s.gamma * std::log(t[k]) - log_c;
        squares += off * off / double(t.size());
    }
    s.spread = std::sqrt(squares);
}

// What one sample a pixel costs: nothing is cheaper.
inline double least_seconds(const TradeSetting& s) {
    const TradePoint& first = s.points.front();
    return first.seconds / std::max(1.0, first.spp);
}

// Whether its error goes on falling as the law says: a bias, or rounding in float, does not.
inline bool follows_its_law(const TradeSetting& s) {
    return s.unbiased && !s.is_float && s.gamma > 0.1;
}

inline double seconds_by_law(const TradeSetting& s, double E) {
    return std::max(least_seconds(s), std::pow(s.c / E, 1 / s.gamma));
}

// Between the points, by powers; before the first like 1 / sqrt(t).
inline double seconds_between_points(const TradeSetting& s, double E) {
    for (size_t k = 0; k < s.points.size(); ++k) {
        const TradePoint& p = s.points[k];
        if (!(p.error <= E)) continue;
        if (k == 0) return std::max(least_seconds(s), p.seconds * p.error * p.error / (E * E));
        const TradePoint& before = s.points[k - 1];
        const double part = std::log(E / before.error) / std::log(p.error / before.error);
        return before.seconds * std::pow(p.seconds / before.seconds, part);
    }
    return NAN;
}

// Laws are believed up to this many times the seconds of the last point.
inline constexpr double law_reach = 16;

// Seconds after which the setting's error is E: by its law, or, of a setting that is biased or
// rounds, between its points alone.  NAN: not by what was measured.
inline double seconds_for(const TradeSetting& s, double E) {
    if (s.points.empty()) return NAN;
    if (!follows_its_law(s)) return seconds_between_points(s, E);
    const double t = seconds_by_law(s, E);
    return t <= law_reach * s.points.back().seconds ? t : NAN;
}

// ---- Answers ------------------------------------------------------------------------------------

inline constexpr double asked[] = {0.10, 0.03, 0.01, 0.003};

inline size_t index_of(const TradeScene& scene, const std::string& words, bool is_float = false) {
    for (size_t k = 0; k < scene.settings.size(); ++k)
        if (scene.settings[k].words == words && scene.settings[k].is_float == is_float) return k;
    return SIZE_MAX;
}

// The least of seconds_for(E), and who has it; ties to the first.
template <class May>
TradeAnswer cheapest(const TradeScene& scene, double E, May may) {
    TradeAnswer a{E};
    for (size_t k = 0; k < scene.settings.size(); ++k) {
        if (!may(scene.settings[k])) continue;
        const double t = seconds_for(scene.settings[k], E);
        if (t < a.seconds || (std::isnan(a.seconds) && !std::isnan(t)))
            a.seconds = t, a.setting = k;
    }
    return a;
}

inline std::vector<TradeAnswer> answers_of(const TradeScene& scene, const std::string& by_default) {
    std::vector<TradeAnswer> answers;
    const size_t own = index_of(scene, by_default);
    for (double E : asked) {
        answers.push_back(cheapest(scene, E, [](const TradeSetting&) { return true; }));
        if (own != SIZE_MAX) answers.back().default_seconds = seconds_for(scene.settings[own], E);
    }
    return answers;
}

// ---- Who is hopeless ----------------------------------------------------------------------------

// 1 / (error^2 seconds), and the standard error of its logarithm; of an error that is too small to
// be told it is not known.
struct Efficiency {
    double value = 0, log_error = INFINITY;
};
inline Efficiency efficiency_of(const TradePoint& p) {
    if (!(p.error > 0)) return {};
    return {1 / (p.error * p.error * p.seconds), 2 * p.error_se / p.error};
}

// Less than 1 / 8 of the best, by more than the standard error of this ratio.
inline constexpr double hopeless_factor = 8;
inline bool is_hopeless(const Efficiency& e, const Efficiency& best) {
    const double error = std::hypot(e.log_error, best.log_error);
    return std::log(best.value / e.value) - error > std::log(hopeless_factor);
}

// May be the default of a program in double.
inline bool is_candidate(const TradeSetting& s) {
    return s.unbiased && s.takes_every_scene && !s.is_float;
}

// Who takes part in a tournament: a setting, and its last point.
struct Entrant {
    bool alive = true, candidate = false, kept = false;  // kept: is never dropped
    Efficiency efficiency;
    double next_cost = 0;  // seconds that the next count would take here, by all seeds
    std::string dropped = "";
};

// The most efficient of those who are alive; of none, its efficiency is 0.
template <class Among>
const Entrant* best_of(const std::vector<Entrant>& all, Among among) {
    const Entrant* best = nullptr;
    for (const Entrant& e : all)
        if (e.alive && among(e) && (!best || e.efficiency.value > best->efficiency.value))
            best = &e;
    return best;
}

// Drops who is hopeless beside the best of all or, if it is a candidate for the default, beside the
// best of these: so the best of either is never dropped.
inline void drop_hopeless(std::vector<Entrant>& all, double spp) {
    const Entrant *best = best_of(all, [](const Entrant&) { return true; }),
                  *candidate = best_of(all, [](const Entrant&e) { return e.candidate; });
    for (Entrant& e : all) {
        if (!e.alive || e.kept) continue;
        const Efficiency& beside = (e.candidate ? candidate : best)->efficiency;
        if (is_hopeless(e.efficiency, beside))
            e.dropped = text("after %.0f samples: 1/%.0f of the best's efficiency", spp,
                             beside.value / e.efficiency.value);
    }
    for (Entrant& e : all) e.alive = e.alive && e.dropped.empty();
}

// Drops the least efficient, beside the best of their class, until the next count fits into the
// budget; the best of either class stays.
inline void drop_for_budget(std::vector<Entrant>& all, double spp, double budget) {
    const Entrant *best = best_of(all, [](const Entrant&) { return true; }),
                  *candidate = best_of(all, [](const Entrant&e) { return e.candidate; });
    auto part = [&](const Entrant& e) {
        return e.efficiency.value / (e.candidate ? candidate : best)->efficiency.value;
    };
    while (true) {
        double cost = 0;
        Entrant* worst = nullptr;
        for (Entrant& e : all) {
            if (!e.alive) continue;
            cost += e.next_cost;
            if (!e.kept && &e != best && &e != candidate && (!worst || part(e) < part(*worst)))
                worst = &e;
        }
        if (cost <= budget || !worst) return;
        worst->alive = false;
        worst->dropped =
            text("after %.0f samples, for want of time: 1/%.1f of the best's efficiency", spp,
                 1 / part(*worst));
    }
}

// ---- One default --------------------------------------------------------------------------------

// Geometric mean over the errors asked for that some candidate reaches: the seconds of a setting
// over those of the cheapest candidate.
inline double ratio_to_best(const TradeScene& scene, const TradeSetting& s) {
    Moments log_ratio;
    for (double E : asked) {
        const TradeAnswer best = cheapest(scene, E, is_candidate);
        if (std::isnan(best.seconds) || s.points.empty() || !(s.gamma > 0)) continue;
        log_ratio.add(std::log(seconds_by_law(s, E) / best.seconds));
    }
    return log_ratio.n ? std::exp(log_ratio.mean) : NAN;
}

// All that take part in every scene, the least mean ratio first.
inline std::vector<TradeCandidate> candidates_of(const std::vector<TradeScene>& scenes) {
    std::vector<TradeCandidate> all;
    if (scenes.empty()) return all;
    for (const TradeSetting& s : scenes[0].settings) {
        if (!is_candidate(s)) continue;
        TradeCandidate c{s.words, s.is_float};
        Moments log_ratio;
        for (const TradeScene& scene : scenes) {
            const size_t k = index_of(scene, s.words);
            const double ratio = k == SIZE_MAX ? NAN : ratio_to_best(scene, scene.settings[k]);
            if (std::isnan(ratio)) continue;
            log_ratio.add(std::log(ratio));
            if (!(ratio <= c.worst_ratio)) c.worst_ratio = ratio, c.worst_scene = scene.name;
        }
        c.mean_ratio = std::exp(log_ratio.mean);
        if (log_ratio.n) all.push_back(c);
    }
    std::stable_sort(all.begin(), all.end(), [](const TradeCandidate& a, const TradeCandidate& b) {
        return a.mean_ratio < b.mean_ratio;
    });
    return all;
}

// What float brings: geometric mean over the settings of a scene that were measured in both, at
// their last common count.
struct FloatBesideDouble {
    double time = NAN, error = NAN;  // float's over double's
    size_t settings = 0;
};
inline FloatBesideDouble float_beside_double(const TradeScene& scene) {
    Moments time, error;
    for (const TradeSetting& f : scene.settings) {
        const size_t k = f.is_float ? index_of(scene, f.words) : SIZE_MAX;
        if (k == SIZE_MAX) continue;
        const auto& d = scene.settings[k].points;
        const size_t common = std::min(d.size(), f.points.size());
        if (common == 0 || !(d[common - 1].error > 0) || !(f.points[common - 1].error > 0))
            continue;
        time.add(std::log(f.points[common - 1].seconds / d[common - 1].seconds));
        error.add(std::log(f.points[common - 1].error / d[common - 1].error));
    }
    return time.n ? FloatBesideDouble{std::exp(time.mean), std::exp(error.mean), time.n}
                  : FloatBesideDouble{};
}

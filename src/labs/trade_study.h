// labs/trade_study.h  6  the measurement: a scene's reference, its tournament, its pictures
#pragma once
#include "labs/trade_errors.h"
#include "labs/trade_law.h"
#include "labs/trade_runs.h"

namespace trade {

struct Effort {
    bool quick = false;
    std::string float_program;
    std::vector<std::string> scenes = {};  // none: all
    std::vector<uint64_t> counts = {1, 4, 16, 64, 256};
    uint64_t seeds = 1;
    int part = 1;                             // of the scenes' widths and heights
    double tournament = 150, reference = 30;  // core seconds a scene may take
};

// Seeds of runs, pictures and references: none is used twice.
inline constexpr uint64_t first_seed = 1, picture_seed = 500, reference_seed = 1000;

// ---- References ---------------------------------------------------------------------------------

// Eight runs of the default, of as many samples as the seconds allow, a power of two.
inline Reference long_run(const Ground& g, double core_seconds) {
    constexpr uint64_t runs = 8, pilot = 8;
    const std::string words = default_words();
    const double each = taken_by(g, {words, pilot, 0}).seconds / double(pilot);
    uint64_t spp = pilot;
    while (2 * double(spp) * each * double(runs) <= core_seconds) spp *= 2;
    Series series;
    for (uint64_t k = 0; k < runs; ++k) {
        Taken t = taken_by(g, {words, spp, reference_seed + k});
        series.images.push_back(std::move(t.image)), series.seconds.push_back(t.seconds);
    }
    return reference_of(series);
}

// ---- A tournament -------------------------------------------------------------------------------

// Settings of both precisions, and where they stand.
struct Tournament {
    const Effort& plan;
    const Ground& ground;
    const Reference& reference;
    std::vector<TradeSetting> settings = {};
    std::vector<Entrant> entrants = {};
    double spent = 0;

    void enter(const std::vector<TradeSetting>& more) {
        for (const TradeSetting& s : more) {
            settings.push_back(s);
            Entrant e;
            e.candidate = is_candidate(s), e.kept = s.words == default_words();
            entrants.push_back(e);
        }
    }
};

// Of those who are alive, in turn from another one on: all runs of one seed, in one precision.
inline std::vector<size_t> turn(const Tournament& t, bool is_float, uint64_t seed) {
    std::vector<size_t> who;
    for (size_t k = 0; k < t.settings.size(); ++k)
        if (t.entrants[k].alive && t.settings[k].is_float == is_float) who.push_back(k);
    if (!who.empty())
        std::rotate(who.begin(), who.begin() + ptrdiff_t(seed * who.size() / 3 % who.size()),
                    who.end());
    return who;
}

// A series for each setting.
inline std::vector<Series> play(Tournament& t, uint64_t spp) {
    std::vector<Series> series(t.settings.size());
    for (Entrant& e : t.entrants) e.next_cost = 0;
    for (uint64_t seed = first_seed; seed < first_seed + t.plan.seeds; ++seed)
        for (const bool is_float : {false, true}) {
            const std::vector<size_t> who = turn(t, is_float, seed);
            std::vector<Task> tasks;
            for (size_t k : who) tasks.push_back({t.settings[k].words, spp, seed});
            std::vector<Taken> taken = is_float ? rendered_by(t.plan.float_program, t.ground, tasks)
                                                : rendered_here(t.ground, tasks);
            for (size_t i = 0; i < who.size(); ++i) {
                Series& s = series[who[i]];
                s.images.push_back(std::move(taken[i].image));
                s.seconds.push_back(taken[i].seconds);
                t.entrants[who[i]].next_cost += taken[i].seconds;
            }
        }
    return series;
}

// All at one count; then the hopeless go, and who does not fit into the budget of the next.
inline void round_of(Tournament& t, uint64_t spp, uint64_t next) {
    const std::vector<Series> series = play(t, spp);
    for (size_t k = 0; k < t.settings.size(); ++k) {
        if (series[k].images.empty()) continue;
        const Error e = error_of(series[k].images, t.reference);
        const TradePoint p{double(spp), median(series[k].seconds), e.value, e.standard_error};
        t.settings[k].points.push_back(p);
        t.spent += t.entrants[k].next_cost;
        t.entrants[k].efficiency = efficiency_of(p);
        t.entrants[k].next_cost *= double(next) / double(spp);
    }
    if (next == 0) return;
    // After the first count errors say little of what low discrepancy will bring.
    if (t.settings[0].points.size() > 1) drop_hopeless(t.entrants, double(spp));
    const double left = t.plan.tournament - t.spent;
    drop_for_budget(t.entrants, double(spp), next == t.plan.counts.back() ? left : 0.4 * left);
}

inline std::vector<TradeSetting> tournament(const Effort& plan, const Ground& g,
                                            const Reference& f) {
    Tournament t{plan, g, f};
    t.enter(settings_of(g, false));
    if (!plan.float_program.empty()) t.enter(settings_of(g, true));
    for (size_t i = 0; i < plan.counts.size(); ++i)
        round_of(t, plan.counts[i], i + 1 < plan.counts.size() ? plan.counts[i + 1] : 0);
    for (size_t k = 0; k < t.settings.size(); ++k) t.settings[k].dropped = t.entrants[k].dropped;
    return t.settings;
}

// Where rounding is an error of its own, beyond the noise.
inline std::string of_float(const TradeScene& s) {
    const size_t d = index_of(s, default_words()), f = index_of(s, default_words(), true);
    if (d == SIZE_MAX || f == SIZE_MAX) return "";
    const double in_double = s.settings[d].points.back().error,
                 in_float = s.settings[f].points.back().error;
    if (!(in_float > 1.25 * in_double)) return "";
    return text(" In float the default's error is %.2g %% where it is %.2g %% in double: rounding.",
                100 * in_float, 100 * in_double);
}

// The default in float beside double: sums over all pixels but the brightest hundredth, whose noise
// would hide a bias.
inline std::string bias_of_float(const Effort& plan, const Ground& g) {
    if (plan.float_program.empty()) return "";
    const std::vector<Task> task = {{default_words(), 64, picture_seed}};
    const Image in_double = rendered_here(g, task)[0].image,
                in_float = rendered_by(plan.float_program, g, task)[0].image;
    auto sum = [](const auto& pixel) {
        return double(pixel[0]) + double(pixel[1]) + double(pixel[2]);
    };
    std::vector<double> sums;
    for (const auto& pixel : in_double.pixels) sums.push_back(sum(pixel));
    const double bright = quantile(sums, 0.99);
    double one = 0, other = 0;
    for (size_t i = 0; i < sums.size(); ++i)
        if (sums[i] < bright) one += sums[i], other += sum(in_float.pixels[i]);
    const double more = other / one - 1;
    if (!(std::abs(more) > 0.01)) return "";
    return text(
        " In float the image is %.1f %% too %s, its brightest hundredth left out: rounding.",
        100 * std::abs(more), more > 0 ? "bright" : "dark");
}

// ---- Pictures at equal time ---------------------------------------------------------------------

// What is shown: the default, the cheapest at 3 %, and lessons; float where that is one.
inline std::vector<std::pair<std::string, bool>> shown(const TradeScene& s) {
    std::vector<std::pair<std::string, bool>> list = {{default_words(), false}};
    auto add = [&](const TradeSetting& t) {
        const std::pair<std::string, bool> one{t.words, t.is_float};
        if (std::find(list.begin(), list.end(), one) == list.end()) list.push_back(one);
    };
    auto add_cheapest = [&](auto may) {
        const TradeAnswer a = cheapest(s, 0.03, may);
        if (a.setting != SIZE_MAX) add(s.settings[a.setting]);
    };
    add_cheapest([](const TradeSetting& t) { return !t.is_float; });
    for (const char* words :
         {"--sampler independent --light none", "--sampler independent --light nee"})
        if (const size_t k = index_of(s, words); k != SIZE_MAX) add(s.settings[k]);
    if (const size_t k = index_of(s, default_words(), true); k != SIZE_MAX && !of_float(s).empty())
        add(s.settings[k]);
    return list;
}

// Seconds a picture takes: as many as the default needs for 3 %, in reason.
inline double seconds_of_pictures(const TradeScene& s) {
    const size_t own = index_of(s, default_words());
    const double t = own == SIZE_MAX ? NAN : seconds_for(s.settings[own], 0.03);
    return std::isnan(t) ? 1 : std::clamp(t, 0.1, 1.0);
}

inline TradePicture picture(const Effort& plan, const Ground& g, const TradeSetting& s,
                            double seconds) {
    const TradePoint& last = s.points.back();
    const auto spp = uint64_t(std::max(1.0, std::round(seconds * last.spp / last.seconds)));
    const std::vector<Task> task = {{s.words, spp, picture_seed}};
    std::vector<Taken> t =
        s.is_float ? rendered_by(plan.float_program, g, task) : rendered_here(g, task);
    return {s.words, s.is_float, t[0].seconds, NAN, std::move(t[0].image)};
}

inline void add_pictures(const Effort& plan, const Ground& g, const Reference& f, TradeScene& s) {
    const double seconds = seconds_of_pictures(s);
    for (const auto& [words, is_float] : shown(s)) {
        const TradeSetting& setting = s.settings[index_of(s, words, is_float)];
        if (!setting.points.empty()) s.pictures.push_back(picture(plan, g, setting, seconds));
    }
    for (TradePicture& p : s.pictures) p.error = error_of({p.image}, f).value;
}

// ---- A scene ------------------------------------------------------------------------------------

inline TradeScene study(const Effort& plan, const std::string& name) {
    const Ground g = ground_of(name, plan.part);
    const Reference reference = long_run(g, plan.reference);
    TradeScene s{name};
    s.width = g.scene.size.width, s.height = g.scene.size.height;
    s.exposure = double(g.scene.exposure);
    s.reference = reference.image, s.reference_error = reference.error;
    s.settings = tournament(plan, g, reference);
    for (TradeSetting& setting : s.settings) fit(setting);
    s.answers = answers_of(s, default_words());
    add_pictures(plan, g, reference, s);
    s.remark += of_float(s) + bias_of_float(plan, g);
    constexpr double coarse = 0.05;
    if (reference.error > coarse)
        s.remark += text(
            " Light is rare: the reference itself is known to %.0f %%, and no better "
            "errors can be told.",
            100 * reference.error);
    return s;
}

}  // namespace trade

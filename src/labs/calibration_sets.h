// labs/calibration_sets.h  5  what an image pays for knowing its error: replications by several
// rules
#pragma once
#include "labs/calibration_runs.h"

// A rule of how many replications pixels have: two of them everywhere, or by noise.
struct Rule {
    std::string name;
    Allocation by;
    uint64_t pilot = pilot_samples;
};

inline std::vector<Rule> all_rules() {
    auto by = [](double factor, uint32_t most) {
        return Rule{text("factor %g, at most %.0f", factor, double(most)), {factor, most}};
    };
    return {{"two everywhere", {.most = 2}},
            {"by noise", {}},
            by(2.5, 16),
            by(5, 16),
            by(3.5, 8),
            by(3.5, 32),
            {"a pilot of 4", {}, 4},
            {"a pilot of 8", {}, 8},
            {"a pilot of 16", {}, 16}};
}

inline constexpr uint64_t longest_pilot = 16;

// The replications of all pixels by every rule, and those that any rule asks for: the first ones of
// a pixel are the same by every rule, so that the rules are compared on the same numbers.
struct Union {
    std::vector<std::vector<uint16_t>> by_rule;
    std::vector<uint16_t> all;
};

// By the spread of noise of the first 1, 2, 4 ... samples, as many as a replication has.
inline Union union_of(const std::vector<Rule>& rules, const std::vector<std::vector<float>>& spread,
                      Size size) {
    Union u{{}, std::vector<uint16_t>(spread[0].size(), 1)};
    for (const Rule& r : rules) {
        const size_t pilot = std::min(spread.size(), size_t(std::bit_width(r.pilot))) - 1;
        u.by_rule.push_back(sets_where_noise_is(spread[pilot], size, r.by));
        for (size_t i = 0; i < u.all.size(); ++i)
            u.all[i] = std::max(u.all[i], u.by_rule.back()[i]);
    }
    return u;
}

// A film of so many replications, without samples.
inline Film film_of_sets(Size size, const std::vector<uint16_t>& sets) {
    Film film = make_film(size, 1);
    film.sets = sets;
    film.sum.assign(std::accumulate(sets.begin(), sets.end(), size_t(0)), Sum{});
    return film;
}

// The image by a rule, and how many replications it took in the mean of pixels, each worth its
// work.
struct Paid {
    Image image;
    double sets = 0;
};

inline Paid paid(const Film& film, const std::vector<uint16_t>& sets,
                 const std::vector<double>& work) {
    Paid p{Image(film.size.width, film.size.height)};
    double all = 0;
    for_each_pixel(film, [&](size_t i, const Pixel& pixel) {
        const Pixel part{pixel.sum.first(sets[i]), pixel.first, pixel.others};
        for (size_t c = 0; c < 3; ++c) p.image.pixels[i][c] = float(part.value(c));
        p.sets += sets[i] * work[i], all += work[i];
    });
    p.sets /= all;
    return p;
}

// ---- Error over work ----------------------------------------------------------------------------

// d^2 of images over samples in all: between them a power of samples.
struct Curve {
    std::vector<double> samples, square;
    void add(double n, double d2) { samples.push_back(n), square.push_back(d2); }
    double at(double n) const {
        size_t k = 1;
        while (k + 1 < samples.size() && samples[k] < n) ++k;
        const double t = std::log(n / samples[k - 1]) / std::log(samples[k] / samples[k - 1]);
        return square[k - 1] * std::pow(square[k] / square[k - 1], t);
    }
};

// The mean of the curves of seeds, but for one.
inline Curve mean_curve(const std::vector<Curve>& seeds, size_t without) {
    Curve mean{std::vector<double>(seeds[0].samples.size()), mean.samples};
    for (size_t k = 0; k < seeds.size(); ++k)
        for (size_t j = 0; k != without && j < mean.samples.size(); ++j) {
            const double n = double(seeds.size() - (without < seeds.size()));
            mean.samples[j] += seeds[k].samples[j] / n, mean.square[j] += seeds[k].square[j] / n;
        }
    return mean;
}

// Rays of the first samples of each pixel: its work.
inline std::vector<double> work_of(Size size, const Radiance& L) {
    std::vector<double> work;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            Tally tally;
            for (uint64_t i = 0; i < pilot_samples; ++i) L({x, y, i}, tally);
            work.push_back(double(tally.rays));
        }
    return work;
}

// ---- Seeds --------------------------------------------------------------------------------------

// In all, of a pixel in the mean.
inline constexpr std::array<double, 5> counts = {4, 8, 16, 32, 128};

// Of one seed.
struct Curves {
    Curve one;  // replication
    std::vector<Curve> by_rule;
    std::vector<double> sets;  // by rule, of the last
};

// Replications have 1, 2, 4 ... samples, and are chosen by a pilot of as many, or a rule's.
inline Curves curves_of(const Study& study, const std::vector<Rule>& rules, uint64_t seed,
                        double most) {
    const Size size = study.scene.size;
    const Pattern pattern = make_pattern(SamplerKind::sobol, seed, study.scene.depth, 0);
    const Radiance L = radiance_of(study.scene, {}, pattern);
    const std::vector<double> work = work_of(size, L);
    Curves c{{}, std::vector<Curve>(rules.size()), std::vector<double>(rules.size())};
    Film one = make_film(size, 1), pilot = make_film(size, 0), all;
    std::vector<std::vector<float>> spread;
    for (uint64_t n = 1; double(n) < 2 * most; n *= 2) {
        fill(one, n, L);
        c.one.add(double(n), study.truth2(image_of(one)));
        if (double(n) > most / 2) continue;  // all rules have two or more
        if (n <= longest_pilot) fill(pilot, n, L), spread.push_back(pilot.spread);
        const Union u = union_of(rules, spread, size);
        if (n <= longest_pilot) all = film_of_sets(size, u.all);
        fill(all, n, L);
        for (size_t r = 0; r < rules.size(); ++r) {
            const Paid p = paid(all, u.by_rule[r], work);
            c.by_rule[r].add(double(n) * p.sets, study.truth2(p.image));
            c.sets[r] = p.sets;
        }
    }
    return c;
}

// How many times the squared error of one replication is that of a rule, both of n samples in all.
inline Estimate gain(const std::vector<Curve>& one, const std::vector<Curve>& rule, double n) {
    return over_seeds(one.size(), [&](size_t without) {
        return mean_curve(one, without).at(n) / mean_curve(rule, without).at(n);
    });
}

// ---- The table ----------------------------------------------------------------------------------

inline void tell_sets(Report& report, const std::vector<Study>& studies, uint64_t seeds,
                      double most) {
    std::vector<std::string> head = {"replications"};
    for (double n : counts)
        if (n <= most) head.push_back(text("%.0f samples", n));
    head.insert(head.end(), {"all", "a pixel", "least", "greatest"});
    report.head(head);
    const std::vector<Rule> rules = all_rules();
    std::vector<std::vector<Curves>> of_scene;
    for (const Study& s : studies)
        of_scene.push_back(over_threads<Curves>(
            seeds, [&](uint64_t k) { return curves_of(s, rules, k + 1, most); }));
    for (size_t r = 0; r < rules.size(); ++r) {
        std::vector<std::string> cells = {rules[r].name};
        Overall whole;
        Moments sets;
        for (const auto& scene : of_scene)
            for (const Curves& c : scene) sets.add(c.sets[r]);
        for (double n : counts) {
            if (n > most) continue;
            Overall at_n;
            for (size_t s = 0; s < studies.size(); ++s) {
                std::vector<Curve> one, rule;
                for (const Curves& c : of_scene[s])
                    one.push_back(c.one), rule.push_back(c.by_rule[r]);
                const Estimate g = gain(one, rule, n);
                if (!std::isfinite(std::log(g.value))) continue;  // a truth that is not known
                at_n.add(g.value, g.log_error, studies[s].name);
                whole.add(g.value, g.log_error, studies[s].name);
            }
            cells.push_back(told(at_n.mean(), "%.3f"));
        }
        cells.insert(cells.end(), {told(whole.mean(), "%.3f"), text("%.2f", sets.mean),
                                   text("%.2f (%s)", whole.least.first, whole.least.second),
                                   text("%.2f (%s)", whole.greatest.first, whole.greatest.second)});
        report.row(cells);
    }
    report.end_of_table();
}

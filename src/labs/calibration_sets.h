// labs/calibration_sets.h  5  what an image pays for knowing its error: sets of samples by several
// rules
#pragma once
#include "labs/calibration_runs.h"

// A rule of how many sets pixels have.
struct Rule {
    std::string name;
    std::optional<Allocation> by;  // nothing: two everywhere
};

inline std::vector<Rule> all_rules() {
    return {{"two everywhere", {}},
            {"by noise", Allocation{}},
            {"factor 0.8", Allocation{.factor = 0.8}},
            {"factor 1", Allocation{.factor = 1}},
            {"at most 4", Allocation{.most = 4}},
            {"at most 16", Allocation{.most = 16}},
            {"factor 1.5", Allocation{.factor = 1.5}},
            {"128 measured", Allocation{.measured = 128}},
            {"256 measured", Allocation{.measured = 256}},
            {"1024 measured", Allocation{.measured = 1024}}};
}

// A film that has all sets that any rule asks for: the sets of a pixel are the same by every rule,
// so that the rules are compared on the same numbers.
struct Union {
    std::vector<std::vector<Sets>> by_rule;
    std::vector<Sets> all;
};

inline Union union_of(const std::vector<Rule>& rules, const Film<MeanPixel>& film, uint64_t seed) {
    const std::vector<double> noise = film.noise();
    Union u{{}, std::vector<Sets>(noise.size(), {2})};
    for (const Rule& r : rules) {
        u.by_rule.push_back(r.by ? sets_where_noise_is(noise, film.size, seed, *r.by)
                                 : std::vector<Sets>(noise.size(), {2}));
        for (size_t i = 0; i < noise.size(); ++i)
            u.all[i].shown = std::max(u.all[i].shown, u.by_rule.back()[i].count());
    }
    return u;
}

// The image by a rule, and how many sets it took in the mean of pixels, each worth its work.
struct Paid {
    Image image;
    double sets = 0;
};

inline Paid paid(const Film<MeanPixel>& film, const std::vector<Sets>& sets,
                 const std::vector<double>& work) {
    Paid p{Image(film.size.width, film.size.height)};
    const auto value = value_in(film);
    double all = 0;
    for (size_t i = 0; i < sets.size(); ++i) {
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0;
            for (uint32_t set = 0; set < sets[i].shown; ++set) sum += value(film.pixel(i, set), c);
            p.image.pixels[i][c] = float(sum / sets[i].shown);
        }
        p.sets += sets[i].count() * work[i], all += work[i];
    }
    p.sets /= all;
    return p;
}

// ---- One set ------------------------------------------------------------------------------------

// d^2 of images of one set of samples, at 16, 32, 64 ... of them: between them a power of samples.
struct Curve {
    std::vector<double> samples, square;
    double at(double n) const {
        size_t k = 1;
        while (k + 1 < samples.size() && samples[k] < n) ++k;
        const double t = std::log(n / samples[k - 1]) / std::log(samples[k] / samples[k - 1]);
        return square[k - 1] * std::pow(square[k] / square[k - 1], t);
    }
};

// Rays of the first samples of each pixel: its work.
inline std::vector<double> work_of(const Job& job) {
    std::vector<double> work;
    for (int y = 0; y < job.scene.size.height; ++y)
        for (int x = 0; x < job.scene.size.width; ++x) {
            uint64_t rays = 0;
            for (uint64_t i = 0; i < samples_before_sets; ++i)
                radiance(job, start(job.scene, job.pattern, {x, y, i}), rays);
            work.push_back(double(rays));
        }
    return work;
}

// ---- Seeds --------------------------------------------------------------------------------------

inline constexpr std::array<uint64_t, 3> counts = {16, 64, 256};

// Sums over seeds: d^2 of one set, of every rule at every count, and its sets.
struct Squares {
    Curve one;
    std::vector<std::array<double, counts.size()>> square, sets;  // one a rule
};

// Of one seed; `most` of the counts, from the first.
inline Squares squares_of(const Study& study, const std::vector<Rule>& rules, uint64_t seed,
                          size_t most) {
    const Options o = options_for("sobol", seed);
    const Job job = job_of(o, study.scene);
    const std::vector<double> work = work_of(job);
    Squares s{{}, {}, {}};
    s.square.resize(rules.size()), s.sets.resize(rules.size());
    Film<MeanPixel> one(study.scene.size), all(study.scene.size);
    for (uint64_t n = 8; n <= 4 * counts[most - 1]; n *= 2) {
        add_samples(one, job, n - one.samples(), 1);
        s.one.samples.push_back(double(n));
        s.one.square.push_back(study.truth2(one.image()));
    }
    add_samples(all, job, counts[0], 1);
    const Union u = union_of(rules, all, seed);
    all.add_sets(u.all);
    for (size_t k = 0; k < most; ++k) {
        add_samples(all, job, counts[k] - all.samples(), 1);
        for (size_t r = 0; r < rules.size(); ++r) {
            const Paid p = paid(all, u.by_rule[r], work);
            s.square[r][k] = study.truth2(p.image), s.sets[r][k] = p.sets;
        }
    }
    return s;
}

inline std::vector<Squares> squares_of_seeds(const Study& study, const std::vector<Rule>& rules,
                                             uint64_t seeds, size_t most) {
    return over_threads<Squares>(seeds,
                                 [&](uint64_t k) { return squares_of(study, rules, k + 1, most); });
}

// How many times the squared error of one set of as much work is that of a rule.
inline double gain_of_rule(const std::vector<Squares>& seeds, size_t rule, size_t count,
                           size_t without) {
    Curve one{seeds[0].one.samples, std::vector<double>(seeds[0].one.samples.size(), 0)};
    double square = 0, sets = 0, n = 0;
    for (size_t k = 0; k < seeds.size(); ++k) {
        if (k == without) continue;
        for (size_t j = 0; j < one.square.size(); ++j) one.square[j] += seeds[k].one.square[j];
        square += seeds[k].square[rule][count], sets += seeds[k].sets[rule][count], ++n;
    }
    return one.at(double(counts[count]) * sets / n) / square;
}
inline Estimate gain(const std::vector<Squares>& seeds, size_t rule, size_t count) {
    return over_seeds(seeds.size(),
                      [&](size_t without) { return gain_of_rule(seeds, rule, count, without); });
}

// ---- The table ----------------------------------------------------------------------------------

inline void tell_sets(Report& report, const std::vector<Study>& studies, uint64_t seeds,
                      size_t most) {
    std::vector<std::string> head = {"sets"};
    for (size_t k = 0; k < most; ++k) head.push_back(text("%.0f samples", double(counts[k])));
    head.insert(head.end(), {"all", "sets a pixel", "least", "greatest"});
    report.head(head);
    const std::vector<Rule> rules = all_rules();
    std::vector<std::vector<Squares>> squares;  // of each scene
    for (const Study& s : studies) squares.push_back(squares_of_seeds(s, rules, seeds, most));
    for (size_t r = 0; r < rules.size(); ++r) {
        std::vector<std::string> cells = {rules[r].name};
        Overall whole;
        Moments sets;
        for (size_t k = 0; k < most; ++k) {
            Overall one;
            for (size_t s = 0; s < squares.size(); ++s) {
                const Estimate g = gain(squares[s], r, k);
                if (!std::isfinite(std::log(g.value))) continue;  // a truth that is not known
                one.add(g.value, g.log_error, studies[s].name);
                whole.add(g.value, g.log_error, studies[s].name);
                for (const Squares& q : squares[s]) sets.add(q.sets[r][k]);
            }
            cells.push_back(told(one.mean(), "%.3f"));
        }
        cells.insert(cells.end(), {told(whole.mean(), "%.3f"), text("%.2f", sets.mean),
                                   text("%.2f (%s)", whole.least.first, whole.least.second),
                                   text("%.2f (%s)", whole.greatest.first, whole.greatest.second)});
        report.row(cells);
    }
    report.end_of_table();
}

// labs/illumination_race.h  4  one room, both methods on the same triangles: error over time
#pragma once
#include "labs/illumination.h"

namespace illumination {

struct Curve {
    std::vector<double> seconds, error;
    void add(double s, double e) { seconds.push_back(s), error.push_back(e); }
};

// y = factor x^exponent.
struct Power {
    double factor = 1, exponent = 1;
    double operator()(double x) const { return factor * std::pow(x, exponent); }
};
inline Power power_through(const Curve& c) {
    const double p = slope(c.seconds, c.error);
    double log_factor = 0;
    for (size_t k = 0; k < c.error.size(); ++k)
        log_factor += std::log(c.error[k]) - p * std::log(c.seconds[k]);
    return {std::exp(log_factor / double(c.error.size())), p};
}

// Between the points of a curve by powers; beyond them like 1 / sqrt(t), as independent numbers do.
inline double error_at(const Curve& c, double t) {
    const auto& s = c.seconds;
    const size_t above = size_t(std::upper_bound(s.begin(), s.end(), t) - s.begin());
    if (above == 0) return c.error.front() * std::sqrt(s.front() / t);
    if (above == s.size()) return c.error.back() * std::sqrt(s.back() / t);
    const double part = std::log(t / s[above - 1]) / std::log(s[above] / s[above - 1]);
    return c.error[above - 1] * std::pow(c.error[above] / c.error[above - 1], part);
}

// ---- References whose error is inferred ---------------------------------------------------------

// The error of an image is proportional to what a run reports of its map (Khodulev 1996, ch. 5).
// Of two runs with reports a and b, the squares add: d = k sqrt(a^2 + b^2).
struct Proportion {
    Moments k;               // over the shorter runs
    double exponent = 1;     // of d over sqrt(a^2 + b^2): 1, if proportional
    double uncertainty = 0;  // of the exponent, a standard error
    double predicted = 0;    // error of the longer run, by k
    double measured = 0;     // the same against the longest run
};

inline double together(double a, double b) { return std::sqrt(a * a + b * b); }

inline Proportion proportion(const std::vector<Filled>& shorter, const Filled& longer,
                             const Filled& longest) {
    Proportion p;
    Curve c;
    for (const Filled& run : shorter) {
        const double report = together(run.reported, longer.reported);
        c.add(report, d_rel(longer.image, run.image));
        p.k.add(c.error.back() / report);
    }
    const Power fit = power_through(c);
    Moments x;
    double residual = 0;
    for (size_t i = 0; i < c.error.size(); ++i) {
        const double off = std::log(c.error[i] / fit(c.seconds[i]));
        residual += off * off / double(c.error.size() - 2);
        x.add(std::log(c.seconds[i]));
    }
    p.exponent = fit.exponent;
    p.uncertainty = std::sqrt(residual / x.m2);
    p.predicted = p.k.mean * longer.reported;
    p.measured = d_rel(longest.image, longer.image) * longer.reported /
                 together(longer.reported, longest.reported);
    return p;
}

// ---- A race -------------------------------------------------------------------------------------

// What is run: the longest Monte Carlo run, and where shooting ends.
struct Course {
    std::string scene;
    double H = 1;
    uint64_t particles = 1 << 22;
    double unshot = 1e-3, seconds = 60;
};

// A deterministic method: its error by the Monte Carlo limit and by its own last solution.
struct Deterministic {
    std::vector<Shot> shots;
    Curve realistic, optimistic;
    double floor = 0;  // distance of its last solution to the Monte Carlo limit
};

struct Race {
    std::string scene;
    size_t elements = 0;
    Proportion proportion;
    Curve independent, halton, references;  // errors of the references are inferred
    Deterministic flat, hierarchy;
    // Of independent particles: the shorter runs, then the references; in time.
    Curve particles() const {
        Curve all = independent;
        for (size_t i = 0; i < references.error.size(); ++i)
            all.add(references.seconds[i], references.error[i]);
        return all;
    }
};

// Without the reference's own error, which is independent of it.
inline double without(double d, double own) { return std::sqrt(std::max(0.0, d * d - own * own)); }

inline Deterministic race_of(const Room& room, const Eye& eye, Shooter shooter,
                             const Course& course, const Filled& reference, double own) {
    Deterministic d;
    d.shots = shoot(room, eye, shooter, unshot_down_to(course.unshot), course.seconds);
    const Shot& last = d.shots.back();
    for (const Shot& s : d.shots) {
        d.realistic.add(s.seconds, without(d_rel(reference.image, s.image), own));
        // Near the last solution the distance to it says nothing any more.
        if (s.unshot > 4 * last.unshot) d.optimistic.add(s.seconds, d_rel(last.image, s.image));
    }
    d.floor = d.realistic.error.back();
    return d;
}

inline Race run_race(const Course& course) {
    const Room room = illumination::room(course.scene, course.H);
    const Eye eye(room);
    Race race{course.scene, room.mesh.elements(), {}, {}, {}, {}, {}, {}};
    auto run = [&](SamplerKind kind, uint64_t seed, uint64_t n) {
        return fill(room, eye, kind, seed, n);
    };
    constexpr auto independent = SamplerKind::independent, halton = SamplerKind::halton;
    const Filled longest = run(independent, 1, course.particles),
                 longer = run(independent, 2, course.particles / 4);
    std::vector<Filled> shorter;
    for (uint64_t part : {1024, 512, 256, 128, 64, 32})
        for (uint64_t seed : {3, 4})
            shorter.push_back(run(independent, seed, course.particles / part));
    race.proportion = proportion(shorter, longer, longest);
    const double k = race.proportion.k.mean, own = k * longest.reported;
    for (const Filled* f : {&longer, &longest}) race.references.add(f->seconds, k * f->reported);
    auto add = [&](Curve& curve, const Filled& a, const Filled& b) {
        const double ea = without(d_rel(longest.image, a.image), own),
                     eb = without(d_rel(longest.image, b.image), own);
        curve.add((a.seconds + b.seconds) / 2, std::sqrt((ea * ea + eb * eb) / 2));
    };
    for (size_t i = 0; i < shorter.size(); i += 2)
        add(race.independent, shorter[i], shorter[i + 1]);
    for (uint64_t part : {1024, 512, 256, 128, 64, 32})
        add(race.halton, run(halton, 5, course.particles / part),
            run(halton, 6, course.particles / part));
    race.flat = race_of(room, eye, Shooter::element, course, longest, own);
    race.hierarchy = race_of(room, eye, Shooter::face, course, longest, own);
    return race;
}

// Where particles are ahead of a deterministic curve.
struct Ahead {
    bool ever = false, to_the_end = false;
    double from = 0, to = 0, worst = 0, best = 0;  // seconds; errors of particles there
};
inline Ahead ahead(const Curve& particles, const Curve& deterministic) {
    Ahead a;
    for (size_t i = 0; i < deterministic.seconds.size(); ++i) {
        const double t = deterministic.seconds[i];
        const double own = error_at(particles, t);
        if (own >= deterministic.error[i]) continue;
        if (!a.ever) a.from = t, a.worst = own;
        a.ever = true, a.to = t, a.best = own, a.to_the_end = i + 1 == deterministic.seconds.size();
    }
    return a;
}

}  // namespace illumination

// labs/illumination.h  5  error over time of two methods, and references of inferred error
#pragma once
#include "labs/rows.h"

namespace penumbra::illumination {

struct Curve {
    std::vector<double> seconds, error;
    void add(double s, double e) { seconds.push_back(s), error.push_back(e); }
};

// The error at time t: power laws between points, 1 / sqrt(t) beyond, as for independent samples.
inline double error_at(const Curve& c, double t) {
    const auto& s = c.seconds;
    const size_t above = size_t(std::upper_bound(s.begin(), s.end(), t) - s.begin());
    if (above == 0) return c.error.front() * std::sqrt(s.front() / t);
    if (above == s.size()) return c.error.back() * std::sqrt(s.back() / t);
    const double part = std::log(t / s[above - 1]) / std::log(s[above] / s[above - 1]);
    return c.error[above - 1] * std::pow(c.error[above] / c.error[above - 1], part);
}

// The error of an image is proportional to the reported error of its map (Khodulev 1996, ch. 5).
// If a run reports a and its reference b, d = k sqrt(a^2 + b^2).  Averages k over rows
// with d in `off`, a in `stated` and b in `reference`.
inline Moments proportion(const Rows& rows) {
    Moments k;
    for (const Row& r : rows) k.add(r["off"] / std::hypot(r["stated"], r["reference"]));
    return k;
}

// Times at which particles have a smaller error than a deterministic method.
struct Ahead {
    bool ever = false, to_the_end = false;
    double from = 0, to = 0, worst = 0, best = 0;  // seconds; errors of particles then
};
inline Ahead ahead(const Curve& particles, const Curve& deterministic) {
    Ahead a;
    for (size_t i = 0; i < deterministic.seconds.size(); ++i) {
        const double t = deterministic.seconds[i], own = error_at(particles, t);
        if (own >= deterministic.error[i]) continue;
        if (!a.ever) a.from = t, a.worst = own;
        a.ever = true, a.to = t, a.best = own, a.to_the_end = i + 1 == deterministic.seconds.size();
    }
    return a;
}

}  // namespace penumbra::illumination

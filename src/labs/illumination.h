// labs/illumination.h  5  error over time of two methods, and references of inferred error
#pragma once
#include "labs/rows.h"

namespace illumination {

struct Curve {
    std::vector<double> seconds, error;
    void add(double s, double e) { seconds.push_back(s), error.push_back(e); }
};

// Between the points of a curve by powers; beyond them like 1 / sqrt(t), as independent numbers do.
inline double error_at(const Curve& c, double t) {
    const auto& s = c.seconds;
    const size_t above = size_t(std::upper_bound(s.begin(), s.end(), t) - s.begin());
    if (above == 0) return c.error.front() * std::sqrt(s.front() / t);
    if (above == s.size()) return c.error.back() * std::sqrt(s.back() / t);
    const double part = std::log(t / s[above - 1]) / std::log(s[above] / s[above - 1]);
    return c.error[above - 1] * std::pow(c.error[above] / c.error[above - 1], part);
}

// The error of an image is proportional to what a run states of its map (Khodulev 1996, ch. 5): of
// a run and a reference, which state a and b, d = k sqrt(a^2 + b^2).  k of rows with `off`,
// `stated` and `reference` (what that states).
inline Moments proportion(const Rows& rows) {
    Moments k;
    for (const Row& r : rows) k.add(r["off"] / std::hypot(r["stated"], r["reference"]));
    return k;
}

// Where particles are ahead of a deterministic curve.
struct Ahead {
    bool ever = false, to_the_end = false;
    double from = 0, to = 0, worst = 0, best = 0;  // seconds; errors of particles there
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

// 0.5, 0.2, 0.1, ... down to the least.
inline std::vector<double> decades_down_to(double least) {
    std::vector<double> list;
    for (double decade = 1; decade > least * 0.99; decade /= 10)
        for (double part : {0.5, 0.2, 0.1})
            if (decade * part > least * 0.99) list.push_back(decade * part);
    return list;
}

}  // namespace illumination

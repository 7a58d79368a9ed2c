// labs/illumination.h  5  error over time of two methods, and references whose error is inferred
#pragma once
#include "base/json.h"
#include "labs/rows.h"

inline std::string in_seconds(double s) { return text(s < 0.1 ? "%.2g s" : "%.3g s", s); }

namespace illumination {

struct Curve {
    std::vector<double> seconds, error;
    void add(double s, double e) { seconds.push_back(s), error.push_back(e); }
};

// y = factor x^exponent.
struct Power {
    double factor = 1, exponent = 1;
    double operator()(double x) const { return factor * std::pow(x, exponent); }
    double inverse(double y) const { return std::pow(y / factor, 1 / exponent); }
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

// Without the reference's own error, which is independent of it.
inline double without(double d, double own) { return std::sqrt(std::max(0.0, d * d - own * own)); }

// The error of an image is proportional to what a run states of its map (Khodulev 1996, ch. 5): of
// a run and a reference, which state a and b, d = k sqrt(a^2 + b^2).
struct Proportion {
    Moments k;                           // over the shorter runs
    double exponent = 1;                 // of d over sqrt(a^2 + b^2): 1, if proportional
    double standard_error = 0;           // of the exponent
    double predicted = 0, measured = 0;  // error of a longer run: by k; against the reference
    bool holds() const {
        const double spread = std::sqrt(k.variance()) / k.mean;
        return std::abs(exponent - 1) < 4 * standard_error + 0.02 &&
               std::abs(measured / predicted - 1) < 4 * spread;
    }
};

// Of rows with `off`, `stated` and `reference` (what that states).
inline Proportion proportion(const Rows& shorter, const Rows& longer) {
    Proportion p;
    Curve c;
    for (const Row& r : shorter) {
        c.add(std::hypot(r["stated"], r["reference"]), r["off"]);
        p.k.add(c.error.back() / c.seconds.back());
    }
    const Power fit = power_through(c);
    Moments x;
    double residual = 0;
    for (size_t i = 0; i < c.error.size(); ++i) {
        const double off = std::log(c.error[i] / fit(c.seconds[i]));
        residual += off * off / double(c.error.size() - 2);
        x.add(std::log(c.seconds[i]));
    }
    p.exponent = fit.exponent, p.standard_error = std::sqrt(residual / x.m2);
    const double a = mean(longer, "stated"), b = mean(longer, "reference");
    p.predicted = p.k.mean * a, p.measured = mean(longer, "off") * a / std::hypot(a, b);
    return p;
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

// From how many cameras on one solution and its views take less time than as many images of the
// same error by path tracing; none: infinity.
inline double cameras(double solution, double view, double traced) {
    return traced > view ? std::max(1.0, std::ceil(solution / (traced - view))) : INFINITY;
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

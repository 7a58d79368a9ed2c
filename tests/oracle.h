// oracle.h  verdicts about random numbers, each with its significance and its power
//
// Needs nothing of the renderer but its moments.  A verdict fails a right program with probability
// alpha = 1e-6, and a wrong one passes with probability 1e-3 if it is off by delta_min.
#pragma once
#include <cmath>
#include <cstdio>
#include <string>

#include "../src/stats.h"

inline constexpr double alpha = 1e-6;

struct Verdict {
    bool pass = false;
    double p = 0;          // two-sided
    double delta_min = 0;  // smallest relative bias seen with 99.9 % power
    std::string text;
};

// A mean and its standard error; of independent ones, sums and differences can be formed.
struct Estimate {
    double mean = 0, standard_error = 0;
};
inline Estimate estimate(const Moments& m) { return {m.mean, m.standard_error()}; }

// |z| = 4.89 rejects at alpha; 8.0 = 4.89 + 3.09 is seen with 99.9 % power.  A difference that is
// rounding (1e-13 of the truth in double, where no error is left) passes as exact.
inline Verdict expect_difference(Estimate a, double b, double b_error, const char* what) {
    const double error = std::hypot(a.standard_error, b_error), off = a.mean - b;
    const bool exact = std::abs(off) <= 1e-13 * std::abs(b);
    Verdict v;
    v.p = exact ? 1 : error > 0 ? p_of_z(off / error) : 0;
    v.delta_min = 8 * error / std::abs(b);
    v.pass = std::isfinite(off) && v.p > alpha;
    char text[256];
    std::snprintf(text, sizeof text,
                  "mean %.7g +- %.2g, %s %.7g: %+.2f sigma, p = %.2g; smallest bias seen with "
                  "99.9 %% power: %.2g %%",
                  a.mean, a.standard_error, what, b, error > 0 ? off / error : 0, v.p,
                  100 * v.delta_min);
    v.text = text;
    return v;
}

// Against a known value.
inline Verdict expect_mean(double truth, Estimate a) {
    return expect_difference(a, truth, 0, "expected");
}

// Two independent estimates of the same thing (Welch 1947, in the limit of many samples).
inline Verdict expect_equal(Estimate a, Estimate b) {
    return expect_difference(a, b.mean, b.standard_error, "the other");
}

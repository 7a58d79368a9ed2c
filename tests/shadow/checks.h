// shadow/checks.h  what tests of shadowed light share
#pragma once
#include "base/vec.h"
#include "oracle/expect.h"
#include "shadow/estimators.h"

inline constexpr bool single = sizeof(real) == 4;
inline constexpr Estimator estimators[] = {Estimator::stochastic, Estimator::control,
                                           Estimator::ratio, Estimator::regression};

inline doctest::Approx approx(double x, double in_double = 1e-12, double in_float = 2e-5) {
    return doctest::Approx(x).epsilon(single ? in_float : in_double).scale(0);  // relative
}

// The moments of n light samples.
ShadowMoments moments_of(uint64_t n, auto sample) {
    ShadowMoments m;
    for (uint64_t i = 0; i < n; ++i) {
        const auto [U, w, wV] = sample();
        m.add(double(U), double(w), double(wV));
    }
    return m;
}

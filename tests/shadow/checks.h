// shadow/checks.h  helpers of the tests of shadowed light
#pragma once
#include "base/approx.h"
#include "oracle/expect.h"
#include "shadow/estimators.h"

inline constexpr Estimator estimators[] = {Estimator::stochastic, Estimator::control,
                                           Estimator::ratio, Estimator::regression};

// The moments of n light samples.
ShadowMoments moments_of(uint64_t n, auto sample) {
    ShadowMoments m;
    for (uint64_t i = 0; i < n; ++i) {
        const auto [U, w, wV] = sample();
        m.add(double(U), double(w), double(wV));
    }
    return m;
}

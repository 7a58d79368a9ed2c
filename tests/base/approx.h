// base/approx.h  equality within relative errors, at any scale
#pragma once
#include <doctest/doctest.h>

#include "base/vec.h"

namespace penumbra {

inline constexpr bool single = sizeof(real) == 4;

// The tolerance of doctest::Approx is relative to 1 + the value, not to the value.
inline doctest::Approx about(double value, double relative) {
    return doctest::Approx(value).epsilon(relative).scale(0);
}

// Up to the rounding of the precision in use: relative errors.
inline doctest::Approx approx(double x, double in_double = 1e-12, double in_float = 2e-5) {
    return about(x, single ? in_float : in_double);
}

}  // namespace penumbra

using namespace penumbra;

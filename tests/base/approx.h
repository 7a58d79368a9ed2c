// base/approx.h  equality up to the rounding of the precision in use
#pragma once
#include <doctest/doctest.h>

#include "base/vec.h"

inline constexpr bool single = sizeof(real) == 4;

// The tolerances are relative errors.
inline doctest::Approx approx(double x, double in_double = 1e-12, double in_float = 2e-5) {
    return doctest::Approx(x).epsilon(single ? in_float : in_double).scale(0);
}

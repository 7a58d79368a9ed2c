// base/approx.h  numbers that are equal but for the rounding of this precision
#pragma once
#include <doctest/doctest.h>

#include "base/vec.h"

inline constexpr bool single = sizeof(real) == 4;

// By relative errors.
inline doctest::Approx approx(double x, double in_double = 1e-12, double in_float = 2e-5) {
    return doctest::Approx(x).epsilon(single ? in_float : in_double).scale(0);
}

// base/about.h  compares numbers by their relative error, at any scale
#pragma once
#include <doctest/doctest.h>

// The tolerance of doctest::Approx is relative to 1 + the value, not to the value.
inline doctest::Approx about(double value, double relative) {
    return doctest::Approx(value).epsilon(relative).scale(0);
}

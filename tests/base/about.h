// base/about.h  a number within a relative error, whatever its size
#pragma once
#include <doctest/doctest.h>

// doctest's own tolerance is relative to 1 + the value.
inline doctest::Approx about(double value, double relative) {
    return doctest::Approx(value).epsilon(relative).scale(0);
}

// keep/p_of_z_test.cpp  p-values against known quantiles
#include "keep/p_of_z.h"

#include <doctest/doctest.h>

TEST_CASE("p-values: quantiles of the normal distribution") {
    CHECK(p_of_z(1.959963984540054) == doctest::Approx(0.05).epsilon(1e-12));
    CHECK(p_of_z(4.891638475698590) == doctest::Approx(1e-6).epsilon(1e-9));
}

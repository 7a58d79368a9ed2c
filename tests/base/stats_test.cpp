// base/stats_test.cpp  moments of data that defeat sums of squares
#include "base/stats.h"

#include "base/rng.h"
#include "oracle/expect.h"

using namespace penumbra;

TEST_CASE("moments are those of the numbers, also far from zero and merged in any parts") {
    Rng rng{seed_here()};
    Moments all, parts[4];
    long double sum = 0, squares = 0;
    const int n = 10000;
    for (int i = 0; i < n; ++i) {
        const double x = std::exp(rng.uniform()), shifted = x + 1e8;
        all.add(shifted);
        parts[i % 7 % 4].add(shifted);
        const long double exact = (long double)(shifted)-1e8L;
        sum += exact;
        squares += exact * exact;
    }
    const long double mean = sum / n, m2 = squares - n * mean * mean;
    Moments merged;
    for (const Moments& p : parts) merged.merge(p);
    for (const Moments& m : {all, merged}) {
        CHECK(m.n == uint64_t(n));
        CHECK(std::abs(m.mean - 1e8 - double(mean)) < 1e-6);  // 100 = sqrt(n) roundings of 7e-9
        CHECK(std::abs(m.m2 / double(m2) - 1) < 1e-6);
    }
    CHECK(all.standard_error() ==
          doctest::Approx(std::sqrt(double(m2) / (n - 1) / n)).epsilon(1e-5));
}

TEST_CASE("a constant has no variance, nothing has no error, two numbers have theirs") {
    Moments m;
    CHECK(m.standard_error() == 0);
    for (int i = 0; i < 1000; ++i) m.add(0.1);
    CHECK(m.variance() < 1e-34);
    Moments two;
    two.add(1);
    two.add(3);
    CHECK(two.variance() == 2);
}

TEST_CASE("p-values: quantiles of the normal distribution") {
    CHECK(p_of_z(1.959963984540054) == doctest::Approx(0.05).epsilon(1e-12));
    CHECK(p_of_z(4.891638475698590) == doctest::Approx(1e-6).epsilon(1e-9));
}

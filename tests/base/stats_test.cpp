// base/stats_test.cpp  moments where sums of squares fail, p-values against known quantiles
#include "base/stats.h"

#include <initializer_list>
#include <numbers>

#include "base/rng.h"
#include "oracle/expect.h"

namespace {

double uniform(Rng& rng) { return double(rng.bits() >> 11) * 0x1p-53; }

}  // namespace

TEST_CASE("moments are those of the numbers, also far from zero and merged in any parts") {
    Rng rng{seed_here()};
    Moments all, parts[4];
    long double sum = 0, squares = 0, cubes = 0;
    const int n = 10000;
    for (int i = 0; i < n; ++i) {
        const double x = std::exp(uniform(rng)), shifted = x + 1e8;
        all.add(shifted);
        parts[i % 7 % 4].add(shifted);
        const long double exact = (long double)(shifted)-1e8L;
        sum += exact;
        squares += exact * exact;
        cubes += exact * exact * exact;
    }
    const long double mean = sum / n, m2 = squares - n * mean * mean;
    const long double m3 = cubes - 3 * mean * squares + 2 * n * mean * mean * mean;
    Moments merged;
    for (const Moments& p : parts) merged.merge(p);
    for (const Moments& m : {all, merged}) {
        CHECK(m.n == uint64_t(n));
        CHECK(std::abs(m.mean - 1e8 - double(mean)) < 1e-6);  // 100 = sqrt(n) roundings of 7e-9
        CHECK(std::abs(m.m2 / double(m2) - 1) < 1e-6);
        CHECK(std::abs(m.m3 / double(m3) - 1) < 1e-5);
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
    CHECK(two.skewness() == 0);
    Moments three;  // 0, 0, 1: a coin of p = 1/3 has (1 - 2p) / sqrt(p (1 - p)) = 1 / sqrt(2)
    for (double x : {0.0, 0.0, 1.0}) three.add(x);
    CHECK(three.skewness() == doctest::Approx(std::sqrt(0.5)).epsilon(1e-14));
}

TEST_CASE("p-values: quantiles of the normal, Student's and the chi-squared distribution") {
    CHECK(p_of_z(1.959963984540054) == doctest::Approx(0.05).epsilon(1e-12));
    CHECK(p_of_z(4.891638475698590) == doctest::Approx(1e-6).epsilon(1e-9));
    // t with 1 degree is Cauchy, with 2 closed; 30: table (Abramowitz, Stegun 26.10).
    for (double t : {0.1, 1.0, 12.0, 1e4}) {
        CHECK(p_of_t(t, 1) ==
              doctest::Approx(1 - 2 * std::atan(t) / std::numbers::pi).epsilon(1e-8));
        CHECK(p_of_t(t, 2) == doctest::Approx(1 - t / std::sqrt(2 + t * t)).epsilon(1e-8));
    }
    CHECK(p_of_t(2.042, 30) == doctest::Approx(0.05).epsilon(1e-3));
    CHECK(p_of_t(5, 1e7) == doctest::Approx(p_of_z(5)).epsilon(1e-4));
    // chi2 with 2 degrees is exponential; with 1 the square of z; odd ones by the recurrence.
    for (double x : {0.01, 1.0, 5.0, 60.0}) {
        CHECK(p_of_chi2(x, 2) == doctest::Approx(std::exp(-x / 2)).epsilon(1e-12));
        CHECK(p_of_chi2(x, 1) == doctest::Approx(p_of_z(std::sqrt(x))).epsilon(1e-10));
        CHECK(p_of_chi2(x, 4) == doctest::Approx(std::exp(-x / 2) * (1 + x / 2)).epsilon(1e-12));
    }
    CHECK(p_of_chi2(124.342, 100) == doctest::Approx(0.05).epsilon(1e-4));
}

TEST_CASE("p of t is not that of z at hundreds of degrees of freedom: in closed form, far out") {
    // For even k, with theta = atan(t / sqrt k) and c_j = (1 3 ... 2j-1) / (2 4 ... 2j), what the
    // finite sum of Abramowitz, Stegun 26.7.4 leaves of 1:
    //   p = sin(theta) (c_j cos^2j(theta) summed over j >= k/2).
    auto closed = [](double t, int k) {
        const double cos2 = k / (k + t * t);
        double term = t / std::sqrt(k + t * t), sum = 0;
        for (int j = 1; j <= k / 2; ++j) term *= cos2 * (2 * j - 1) / (2 * j);
        for (int j = k / 2; term > 1e-12 * sum; ++j, term *= cos2 * (2 * j - 1) / (2 * j))
            sum += term;
        return sum;
    };
    CHECK(closed(3, 2) == doctest::Approx(1 - 3 / std::sqrt(11.0)).epsilon(1e-9));
    for (int k : {100, 200, 1000, 10000})
        for (double t : {5.0, 6.0, 7.0, 8.0}) {
            CAPTURE(k);
            CAPTURE(t);
            CHECK(p_of_t(t, k) == doctest::Approx(closed(t, k)).epsilon(1e-6).scale(0));
        }
}

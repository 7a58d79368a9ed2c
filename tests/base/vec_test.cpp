// base/vec_test.cpp  frames, cross products, numbers in [0,1)
#include "base/vec.h"

#include "base/rng.h"
#include "oracle/expect.h"

namespace {
using namespace penumbra;

// The larger of the two numbers; infinite if either is NaN.
real worse(real a, real b) { return a <= b ? b : b <= a ? a : infinity; }

real largest_flaw(const Frame& f) {
    if (!is_finite(f.x) || !is_finite(f.y) || !is_finite(f.n)) return infinity;
    return std::max({std::abs(dot(f.x, f.y)), std::abs(dot(f.y, f.n)), std::abs(dot(f.n, f.x)),
                     std::abs(dot(f.x, f.x) - 1), std::abs(dot(f.y, f.y) - 1),
                     length(cross(f.x, f.y) - f.n)});
}

}  // namespace

TEST_CASE("frames are right-handed and orthonormal, at the poles too") {
    Rng rng{seed_here()};
    auto u = [&] { return 2 * to_unit(rng.bits()) - 1; };
    real worst = 0;
    for (int i = 0; i < 100000; ++i)
        worst = worse(worst, largest_flaw(frame(unit({u(), u(), u()}))));
    for (real z : {real(1), real(-1)})
        for (real tiny = 1; tiny > 0; tiny /= 4)
            for (real angle = 0; angle < 6; angle += real(0.1))
                worst = worse(
                    worst,
                    largest_flaw(frame(unit({tiny * std::cos(angle), tiny * std::sin(angle), z}))));
    for (real zero : {real(0), -real(0)}) worst = worse(worst, largest_flaw(frame({1, 0, zero})));
    CHECK(worst < 16 * ulp);
}

TEST_CASE("unit vectors are unit, and as long as they were they point there") {
    using big = long double;  // has a wider range than real, and 40 or 11 more bits
    Rng rng{seed_here()};
    auto u = [&] { return 2 * to_unit(rng.bits()) - 1; };
    constexpr int digits = std::numeric_limits<real>::digits,
                  lowest = std::numeric_limits<real>::min_exponent - digits,
                  highest = std::numeric_limits<real>::max_exponent - 1;
    big worst = 0;
    for (int i = 0; i < 200000; ++i) {
        // Tries every binary exponent of real.  Denormal numbers have fewer digits: a value is
        // rounded before the reference uses it.
        const int e = lowest + i % (highest - lowest + 1);
        const vec3 v{std::ldexp(u(), e), std::ldexp(u(), e), std::ldexp(u(), e)};
        if (v == vec3{}) continue;
        const vec3 n = unit(v);
        const big l = std::sqrt(big(v.x) * v.x + big(v.y) * v.y + big(v.z) * v.z);
        for (auto k : axis) {
            const big off = std::abs(n.*k - v.*k / l) / ulp;
            worst = off <= worst ? worst : off;
        }
    }
    // Products and sums err by 3 ulp, halved by the root, which adds 1; the other two add 1 each.
    CHECK(worst < 4.5);
    CHECK(unit({0, std::numeric_limits<real>::denorm_min(), 0}) == vec3{0, 1, 0});
    CHECK(unit({0, 0, -std::numeric_limits<real>::max()}) == vec3{0, 0, -1});
    CHECK(std::isnan(unit({}).x));  // no direction: NaN
}

TEST_CASE("a frame's local coordinates invert its world coordinates") {
    const Frame f = frame(unit({1, -2, real(0.5)}));
    const vec3 v{3, 4, -5};
    CHECK(length(f.to_world(f.to_local(v)) - v) < 32 * ulp * length(v));
    CHECK(length(f.to_world({0, 0, 1}) - f.n) == 0);
}

TEST_CASE("cross products keep their digits where the factors are nearly parallel") {
    // (1, e, 0) x (1, 2e, 0) = (0, 0, e): naive rounding is exact here, and loses all digits below.
    const real e = 64 * ulp;
    const real a = 1 + e, b = 1 - e;  // a b - 1 = -e^2, far below the rounding of a b
    CHECK(cross({a, 1, 0}, {1, b, 0}).z == -e * e);
    CHECK(cross({1, a, 0}, {b, 1, 0}).z == e * e);
}

TEST_CASE("every channel counts: largest, mean, finite") {
    const real nan = std::numeric_limits<real>::quiet_NaN();
    for (auto channel : axis) {
        vec3 v{1, 1, 1};
        v.*channel = -7;
        CHECK(mean_of(v) == real(-5) / 3);
        CHECK(max_of(v) == 1);
        CHECK(max_abs(v) == 7);
        v.*channel = 4;
        CHECK(max_of(v) == 4);
        CHECK(is_finite(v));
        for (real bad : {nan, infinity, -infinity}) {
            v.*channel = bad;
            CHECK(!is_finite(v));
            CHECK(std::isnan(max_of(v)) == std::isnan(bad));
        }
    }
}

TEST_CASE("random bits become numbers below 1, all of them") {
    CHECK(to_unit(UINT64_MAX) == below_one);
    CHECK(to_unit(0) == 0);
    CHECK(to_unit(uint64_t(1) << 63) == real(0.5));
}

TEST_CASE("power of two scaling commutes with every operation of a frame") {
    const vec3 v{real(0.3), real(-0.7), real(1.9)};
    const real k = std::ldexp(real(1), 20);
    CHECK(unit(v * k) == unit(v));
    for (int e : {std::numeric_limits<real>::min_exponent + std::numeric_limits<real>::digits,
                  std::numeric_limits<real>::max_exponent - 2})
        CHECK(unit(v * std::ldexp(real(1), e)) == unit(v));
    CHECK(cross(v * k, {1, 2, 3}) == cross(v, {1, 2, 3}) * k);
}

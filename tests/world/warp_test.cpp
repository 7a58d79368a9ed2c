// world/warp_test.cpp  the samplers of warp.h follow their densities, with integral 1
#include "world/warp.h"

#include "base/rng.h"
#include "oracle/expect.h"

namespace {
using namespace penumbra;

// The sampler rotated so that its axis is n, as a map of (u, v).
auto about(vec3 n, auto sample) {
    const Frame f = frame(n);
    return [=](double u, double v) { return f.to_world(sample(vec2{real(u), real(v)})); };
}
// Checks the density of a sampler's directions about n.
void expect_density(oracle::Random& random, vec3 n, auto sample, auto pdf,
                    const std::string& name = "") {
    oracle::Options o{.sees = 0.08, .name = name};
    o.axis = {double(n.x), double(n.y), double(n.z)};
    EXPECT(oracle::expect_density(random, about(n, sample), pdf, o), 0.09);
}
// An axis in general position.
const vec3 skew = unit({1, -2, real(-0.3)});

}  // namespace

TEST_CASE("u turns: within 2 ulp of 1 of cosine and sine, at quarters of a turn exactly") {
    const vec2 quarters[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    for (int i = 0; i < 5; ++i) {
        CHECK(unit_circle(real(i) / 4).x == quarters[i].x);
        CHECK(unit_circle(real(i) / 4).y == quarters[i].y);
    }
    std::vector<real> turns{ulp, sqr(ulp), std::numeric_limits<real>::denorm_min(), below_one};
    for (int i = 0; i <= 8; ++i)  // ends and middles of the polynomials' ranges
        for (real u : {real(i) / 8, std::nextafter(real(i) / 8, real(0)),
                       std::nextafter(real(i) / 8, real(1))})
            turns.push_back(u);
    Rng rng{seed_here()};
    for (int i = 0; i < 100000; ++i) turns.push_back(to_unit(rng.bits()));
    double worst = 0;
    for (real u : turns) {
        const long double angle = 2 * std::numbers::pi_v<long double> * (long double)(u);
        const vec2 at = unit_circle(u);
        worst = std::max({worst, double(std::abs((long double)(at.x) - std::cos(angle))),
                          double(std::abs((long double)(at.y) - std::sin(angle)))});
    }
    CHECK(worst <= 2 * double(ulp));
}

TEST_CASE("uniform hemisphere: p(w) = 1 / 2 pi; uniform sphere: 1 / 4 pi") {
    oracle::Random random(seed_here());
    expect_density(random, skew, sample_uniform_hemisphere,
                   [](vec3 w) { return pdf_uniform_hemisphere(dot(skew, w)); });
    expect_density(random, {0, 0, 1}, sample_uniform_sphere,
                   [](vec3) { return pdf_uniform_sphere(); });
}

TEST_CASE("cosine hemisphere: p(w) = cos(theta) / pi, about any axis") {
    oracle::Random random(seed_here());
    for (vec3 n : {vec3{0, 0, 1}, skew})
        expect_density(random, n, sample_cosine_hemisphere,
                       [&](vec3 w) { return pdf_cosine_hemisphere(dot(n, w)); });
    for (real z : {real(1), real(0.3), real(1e-6)})
        CHECK(std::abs(pi * pdf_cosine_hemisphere(z) / z - 1) < 4 * ulp);
}

// An azimuth that goes round a broken number of times is uneven by less than a density shows.
TEST_CASE("directions are balanced about their axis") {
    const auto off_balance = [](auto sample) {
        double x = 0, y = 0;
        for (int i = 0; i < 64; ++i)
            for (int k = 0; k < 64; ++k) {
                const vec3 w = sample(vec2{real(i + 0.5) / 64, real(k + 0.5) / 64});
                x += double(w.x) / 4096, y += double(w.y) / 4096;
            }
        return std::hypot(x, y);
    };
    const double digits = 64 * double(ulp);
    CHECK(off_balance(sample_uniform_hemisphere) < digits);
    CHECK(off_balance(sample_uniform_sphere) < digits);
    CHECK(off_balance(sample_cosine_hemisphere) < digits);
    CHECK(off_balance([](vec2 u) { return sample_phong_lobe(u, 3); }) < digits);
    CHECK(off_balance([](vec2 u) { return sample_cone(u, real(0.36)); }) < digits);
}

TEST_CASE("Phong lobe: p(w) = (n+1)/(2 pi) cos^n(alpha), exponents 0 to 10^5") {
    oracle::Random random(seed_here());
    for (real n : {real(0), real(0.5), real(1), real(10), real(1000), real(1e5)}) {
        expect_density(
            random, skew, [&](vec2 u) { return sample_phong_lobe(u, n); },
            [&](vec3 w) { return pdf_phong_lobe(dot(skew, w), n); });
        CHECK(std::abs(2 * pi * pdf_phong_lobe(1, n) / (n + 1) - 1) < 8 * ulp);
    }
}

TEST_CASE("Phong lobe: the sine keeps its digits, however narrow the lobe") {
    real worst = 0;  // relative error in ulp
    for (real n : {real(0), real(1), real(10), real(1e3), real(1e6)})
        for (real u = real(0.9); u > real(1e-12); u /= 3) {
            const vec3 w = sample_phong_lobe({u, 0}, n);
            const long double log_cos = std::log1p(-(long double)(u)) / ((long double)(n) + 1);
            const long double sine = std::sqrt(-std::expm1(2 * log_cos));
            worst = std::max(worst, real(std::abs((long double)(w.x) / sine - 1)) / ulp);
        }
    CHECK(worst < 8);
}

TEST_CASE("cone: p(w) = 1 / solid angle within, half-angles from 90 degrees to 10^-8") {
    oracle::Random random(seed_here());
    for (real sin2 : {real(1), real(0.75), real(1e-2), real(1e-4), real(1e-10), real(1e-16)}) {
        // These cones contain few float directions: their samples have no density.
        if (sizeof(real) == 4 && sin2 < real(0.99e-4)) continue;
        expect_density(
            random, {0, 0, 1}, [&](vec2 u) { return sample_cone(u, sin2); },
            [&](vec3 w) {
                const bool inside = w.z >= 0 && sqr(w.x) + sqr(w.y) <= sin2 * (1 + 8 * ulp);
                return inside ? pdf_cone(sin2) : 0;
            },
            oracle::say("sin^2 = %g", double(sin2)));
    }
}

TEST_CASE("cone: 2 pi (1 - cos), to the last digits of the smallest") {
    // The reference is long double; the naive form loses all digits.
    for (double sin2 : {1.0, 0.5, 1e-3, 1e-8, 1e-16, 1e-30}) {
        const long double c = std::sqrt(1 - (long double)(real(sin2)));
        const long double exact = 2 * std::numbers::pi_v<long double> * real(sin2) / (1 + c);
        CHECK(std::abs(double(solid_angle_cone(real(sin2)) / exact - 1)) < 4 * double(ulp));
        CHECK(std::abs(double(pdf_cone(real(sin2)) * exact - 1)) < 4 * double(ulp));
    }
}

TEST_CASE("triangle and quad: p = 1 / area, every part of them alike") {
    oracle::Random random(seed_here());
    const vec3 e{2, 1, real(-0.5)}, f{real(-0.3), real(0.7), 4};
    auto triangle = [&](double u, double v) { return sample_triangle({real(u), real(v)}, e, f); };
    auto quad = [&](double u, double v) { return sample_quad({real(u), real(v)}, e, f); };
    EXPECT(oracle::expect_jacobian(random, triangle, [&](vec3) { return pdf_triangle_area(e, f); }),
           1e-3);
    EXPECT(oracle::expect_jacobian(random, quad, [&](vec3) { return pdf_quad_area(e, f); }), 1e-3);
    // (a, b) are the barycentric coordinates of p = a e + b f.  The quad has 4 x 4 cells; a
    // triangle covers 6 of them and half of 4 more.
    const vec3 n = cross(e, f);
    for (bool of_quad : {false, true}) {
        std::vector<uint64_t> counts(16);
        std::vector<double> expected(16);
        for (int i = 0; i < 40000; ++i) {
            const double u = random(), v = random();
            const vec3 p = of_quad ? quad(u, v) : triangle(u, v);
            const real a = dot(cross(p, f), n) / dot(n, n), b = dot(cross(e, p), n) / dot(n, n);
            REQUIRE((a > -8 * ulp && b > -8 * ulp && (of_quad || a + b < 1 + 8 * ulp)));
            auto cell = [](real x) { return size_t(std::clamp(x * 4, real(0), real(3))); };
            ++counts[cell(a) * 4 + cell(b)];
        }
        for (size_t i = 0; i < 16; ++i) {
            const size_t sum = i / 4 + i % 4;
            expected[i] = of_quad ? 1 / 16.0 : sum < 3 ? 1 / 8.0 : sum == 3 ? 1 / 16.0 : 0;
        }
        EXPECT(oracle::expect_counts(counts, expected), 0.06);
    }
}

TEST_CASE("power heuristic: p^2 / (p^2 + q^2), sums to 1, at any scale") {
    for (real p : {real(1e-3), real(0.7), real(1), real(40)})
        for (real q : {real(1e-3), real(0.7), real(1), real(40)}) {
            CHECK(std::abs(power_heuristic(p, q) - p * p / (p * p + q * q)) < 4 * ulp);
            CHECK(std::abs(power_heuristic(p, q) + power_heuristic(q, p) - 1) < 4 * ulp);
        }
    CHECK(power_heuristic(0, 1) == 0);
    CHECK(power_heuristic(0, 0) == 0);
    CHECK(power_heuristic(1, 0) == 1);
    CHECK(power_heuristic(infinity, 1) == 1);
    const real huge = std::numeric_limits<real>::max() / 4;
    CHECK(power_heuristic(huge, huge) == real(0.5));
    CHECK(power_heuristic(1, huge) == 0);
}

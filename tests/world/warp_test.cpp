// world/warp_test.cpp  every sampler of warp.h follows its density, and the density is one
#include "world/warp.h"

#include "base/rng.h"
#include "oracle/expect.h"

namespace {

// The sampler as a map of (u, v), turned so that its axis is n.
auto about(vec3 n, auto sample) {
    const Frame f = frame(n);
    return [=](double u, double v) { return f.to_world(sample(vec2{real(u), real(v)})); };
}
oracle::Options about(vec3 n) {
    oracle::Options o{.sees = 0.04};
    o.axis = {double(n.x), double(n.y), double(n.z)};
    return o;
}

// Axes of the whole sphere and at its poles, where frames have gone wrong.
std::vector<vec3> some_axes() {
    std::vector<vec3> axes{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, -real(0.0)}};
    for (real z : {real(1), real(-1)}) axes.push_back(unit({real(3e-5), real(-2e-5), z}));
    Rng rng{seed_here()};
    for (int i = 0; i < 4; ++i) {
        const real z = 2 * to_unit(rng.bits()) - 1;
        axes.push_back(spherical(z, std::sqrt(1 - z * z), to_unit(rng.bits())));
    }
    return axes;
}

}  // namespace

TEST_CASE("u turns: within 2 ulp of 1 of cosine and sine, at quarters of a turn exactly") {
    const vec2 quarters[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    for (int i = 0; i < 5; ++i) {
        CHECK(turned(real(i) / 4).x == quarters[i].x);
        CHECK(turned(real(i) / 4).y == quarters[i].y);
    }
    std::vector<real> turns{ulp, sqr(ulp), std::numeric_limits<real>::denorm_min(), below_one};
    for (int i = 0; i <= 8; ++i)  // the polynomials' ends, and the middles of their ranges
        for (real u : {real(i) / 8, std::nextafter(real(i) / 8, real(0)),
                       std::nextafter(real(i) / 8, real(1))})
            turns.push_back(u);
    Rng rng{seed_here()};
    for (int i = 0; i < 100000; ++i) turns.push_back(to_unit(rng.bits()));
    double worst = 0;
    for (real u : turns) {
        const long double angle = 2 * std::numbers::pi_v<long double> * (long double)(u);
        const vec2 at = turned(u);
        worst = std::max({worst, double(std::abs((long double)(at.x) - std::cos(angle))),
                          double(std::abs((long double)(at.y) - std::sin(angle)))});
    }
    CHECK(worst <= 2 * double(ulp));
}

TEST_CASE("uniform hemisphere: p(w) = 1 / 2 pi, about any axis") {
    oracle::Random random(seed_here());
    for (vec3 n : some_axes())
        EXPECT(oracle::expect_density(
                   random, about(n, sample_uniform_hemisphere),
                   [&](vec3 w) { return pdf_uniform_hemisphere(dot(n, w)); }, about(n)),
               0.05);
}

TEST_CASE("uniform sphere: p(w) = 1 / 4 pi") {
    oracle::Random random(seed_here());
    EXPECT(oracle::expect_density(
               random,
               [](real u, real v) {
                   return sample_uniform_sphere({u, v});
               },
               [](vec3) { return pdf_uniform_sphere(); }),
           0.05);
}

TEST_CASE("cosine hemisphere: p(w) = cos(theta) / pi, about any axis") {
    oracle::Random random(seed_here());
    for (vec3 n : some_axes())
        EXPECT(oracle::expect_density(
                   random, about(n, sample_cosine_hemisphere),
                   [&](vec3 w) { return pdf_cosine_hemisphere(dot(n, w)); }, about(n)),
               0.05);
}

TEST_CASE("cosine hemisphere: E[z^k] = 2 / (k+2), E[x] = E[y] = 0, estimates of int cos dw") {
    oracle::Random random(seed_here());
    auto draw_one = [&] {
        const vec2 u{real(random()), real(random())};
        return sample_cosine_hemisphere(u);
    };
    for (int k : {1, 2, 3, 6})
        EXPECT(oracle::expect_mean(2 / (k + 2.0), 50000,
                                   [&] { return std::pow(draw_one().z, real(k)); })
                   .of("E[z^k] = int z^k cos/pi dw"),
               0.08);
    EXPECT(oracle::expect_mean(0, 50000, [&] { return draw_one().x; }), 0.02);
    EXPECT(oracle::expect_mean(0, 50000, [&] { return draw_one().y; }), 0.02);
    // cos / pdf has no variance: exact.
    EXPECT(oracle::expect_mean(std::numbers::pi, 1000,
                               [&] {
                                   const vec3 w = draw_one();
                                   return w.z / pdf_cosine_hemisphere(w.z);
                               })
               .of("int cos dw = pi"),
           1e-12);
    EXPECT(oracle::expect_mean(std::numbers::pi, 100000,
                               [&] {
                                   const vec2 u{real(random()), real(random())};
                                   const vec3 w = sample_uniform_hemisphere(u);
                                   return w.z / pdf_uniform_hemisphere(w.z);
                               })
               .of("int cos dw = pi by uniform directions, variance pi^2 / 3"),
           0.016);
}

TEST_CASE("Phong lobe: p(w) = (n+1)/(2 pi) cos^n(alpha), exponents 0 to 10^5") {
    oracle::Random random(seed_here());
    for (real n : {real(0), real(0.5), real(1), real(10), real(1000), real(1e5)})
        for (vec3 z : {vec3{0, 0, 1}, unit({1, -2, real(-0.3)})}) {
            oracle::Options o = about(z);
            EXPECT(oracle::expect_density(
                       random, about(z, [&](vec2 u) { return sample_phong_lobe(u, n); }),
                       [&](vec3 w) { return pdf_phong_lobe(dot(z, w), n); }, o),
                   0.05);
        }
}

TEST_CASE("Phong lobe: E[cos] = (n+1)/(n+2), and 1 - cos keeps its digits") {
    oracle::Random random(seed_here());
    for (real n : {real(0), real(3), real(100), real(1e5)})
        EXPECT(oracle::expect_mean(1 / (double(n) + 2), 100000,
                                   [&] {
                                       const vec2 u{real(random()), real(random())};
                                       const vec3 w = sample_phong_lobe(u, n);
                                       return (sqr(w.x) + sqr(w.y)) / (1 + w.z);  // 1 - cos
                                   })
                   .of("E[1 - cos] = 1 / (n+2)"),
               0.03);
}

TEST_CASE("Phong lobe: the sine keeps its digits, however narrow the lobe") {
    real worst = 0;  // relative, in ulp
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
    const oracle::Options o{.sees = 0.04};
    for (real sin2 : {real(1), real(0.75), real(1e-2), real(1e-4), real(1e-10), real(1e-16)}) {
        CAPTURE(sin2);
        const long double c = std::sqrt(1 - (long double)(sin2));
        const long double exact = (1 + c) / (2 * std::numbers::pi_v<long double> * sin2);
        CHECK(std::abs(double(pdf_cone(sin2) / exact - 1)) < 4 * double(ulp));
        // Cones of few of float's directions: their samples have no density.
        if (sizeof(real) == 4 && sin2 < real(0.99e-4)) continue;
        auto inside = [&](vec3 w) {
            return w.z >= 0 && sqr(w.x) + sqr(w.y) <= sin2 * (1 + 8 * ulp);
        };
        EXPECT(oracle::expect_density(
                   random, about({0, 0, 1}, [&](vec2 u) { return sample_cone(u, sin2); }),
                   [&](vec3 w) { return inside(w) ? pdf_cone(sin2) : 0; }, o)
                   .of(oracle::say("sin^2 = %g", double(sin2))),
               0.05);
    }
}

TEST_CASE("cone: E[1 - cos] = (1 - cos_max) / 2, to the last digits of the smallest") {
    oracle::Random random(seed_here());
    for (double sin2 : {0.75, 1e-4, 1e-12})
        EXPECT(oracle::expect_mean(sin2 / (1 + std::sqrt(1 - sin2)) / 2, 20000,
                                   [&] {
                                       const vec2 u{real(random()), real(random())};
                                       const vec3 w = sample_cone(u, real(sin2));
                                       return (sqr(w.x) + sqr(w.y)) / (1 + w.z);
                                   }),
               0.05);
    // 2 pi (1 - cos): against long double, where the naive form has no digit left.
    for (double sin2 : {1.0, 0.5, 1e-3, 1e-8, 1e-16, 1e-30}) {
        const long double c = std::sqrt(1 - (long double)(real(sin2)));
        const long double exact = 2 * std::numbers::pi_v<long double> * real(sin2) / (1 + c);
        CHECK(std::abs(double(solid_angle_cone(real(sin2)) / exact - 1)) < 4 * double(ulp));
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
    // Barycentric coordinates (a, b) of p = a e + b f; 4 x 4 cells of the quad, of which a triangle
    // has 6 whole and 4 halves.
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

TEST_CASE("multiple importance sampling: int cos^2 dw = 2 pi / 3 from two techniques") {
    oracle::Random random(seed_here());
    EXPECT(oracle::expect_mean(2 * std::numbers::pi / 3, 100000,
                               [&] {
                                   const vec2 u{real(random()), real(random())};
                                   const vec2 v{real(random()), real(random())};
                                   const vec3 a = sample_cosine_hemisphere(u);
                                   const vec3 b = sample_phong_lobe(v, 20);
                                   const real pa = pdf_cosine_hemisphere(a.z),
                                              qa = pdf_phong_lobe(a.z, 20);
                                   const real pb = pdf_cosine_hemisphere(b.z),
                                              qb = pdf_phong_lobe(b.z, 20);
                                   return sqr(a.z) / pa * power_heuristic(pa, qa) +
                                          sqr(b.z) / qb * power_heuristic(qb, pb);
                               }),
           0.03);
}

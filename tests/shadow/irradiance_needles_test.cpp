// shadow/irradiance_needles_test.cpp  lights that are thin or tiny compared with their distance
#include "shadow/checks.h"
#include "shadow/irradiance.h"
#include "world/geometry.h"

namespace {

// The integral of s max(0, z) / r^4 over p + s d for s from 0 to 1, by Simpson's rule on the part
// above the horizon.
big along(big3 p, big3 d) {
    const big end = p.z + d.z;
    if (p.z <= 0 && end <= 0) return 0;
    const big from = p.z < 0 ? -p.z / d.z : 0, to = end < 0 ? -p.z / d.z : 1;
    const int n = 1000;
    big sum = 0;
    for (int i = 0; i <= n; ++i) {
        const big s = from + (to - from) * i / n;
        const big3 m = p + s * d;
        const big r2 = dot(m, m);
        sum += (i == 0 || i == n ? 1 : 2 + 2 * (i % 2)) * s * std::max(0.0L, m.z) / (r2 * r2);
    }
    return sum * (to - from) / (3 * n);
}

// Long double, because products of nearly parallel edges cancel nine of twenty digits.  The height
// g cuts a triangle with the longest side e in two.  Fans of lines lead from the ends of that side
// to the points of Gauss' three-point rule on g.
big fans(big3 a, big3 e, big3 f) {
    const big foot = dot(e, f) / dot(e, e), root = std::sqrt(0.15L);
    const big3 g = f - foot * e;
    big sum = 0;
    for (auto [t, weight] : {std::pair{0.5L - root, 5.0L}, {0.5L, 8.0L}, {0.5L + root, 5.0L}}) {
        const big3 there = foot * e + t * g;
        sum += weight / 18 * (foot * along(a, there) + (1 - foot) * along(a + e, there - e));
    }
    return sum * std::abs(dot(cross(e, f), a));
}

double triangle_by_fans(big3 a, big3 u, big3 v) {
    const big3 w = v - u;
    const big uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
    if (ww > uu && ww > vv) return double(fans(a + u, w, -1 * u));
    return double(uu > vv ? fans(a, u, v) : fans(a, v, u));
}
double quad_by_fans(big3 a, big3 u, big3 v) {
    return triangle_by_fans(a, u, v) + triangle_by_fans(a + u + v, -1 * u, -1 * v);
}

// A corner and two edges.  The first is the longest side, the height is about `width`, and the
// third corner lies above that side.  No receiver sees it edge-on: rounding would decide there.
struct Needle {
    vec3 a, e, f;
};
Needle needle(oracle::Random& random, real width, bool across_the_horizon) {
    auto number = [&] { return real(2 * random() - 1); };
    while (true) {
        const vec3 e = unit({number(), number(), number()}) * real(0.5);
        const vec3 f = unit(cross(e, {number(), number(), number()})) * width + e * real(random());
        const vec3 a = unit({number(), number(), real(0.1) + std::abs(number())}) - (e + f) / 2;
        const big3 n = cross(big3(e), f), p = a;
        const bool edge_on = !(std::abs(dot(n, p)) > 0.1L * std::sqrt(dot(n, n) * dot(p, p)));
        const bool crosses = a.z * (a.z + e.z) < 0;
        if (!edge_on && crosses == across_the_horizon) return {a, e, f};
    }
}

}  // namespace

TEST_CASE("needles: triangles and parallelograms of any width against fans of lines") {
    oracle::Random random(oracle::seed_of("needles"));
    const double bound = single ? 2e-5 : 1e-9;
    for (double width : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9})
        for (int i = 0; i < 20; ++i) {
            const auto [a, e, f] = needle(random, real(width), i % 4 == 0);
            const double quad = quad_by_fans(a, e, f);
            INFO("width ", width, ", needle ", i);
            CHECK(double(irradiance_quad(a, e, f)) == approx(quad, bound, bound));
            CHECK(double(irradiance_quad(a, f, e)) == approx(quad, bound, bound));
            const real far = std::ldexp(real(1), single ? 30 : 300), near = 1 / far;
            CHECK(irradiance_quad(a * far, e * far, f * far) == irradiance_quad(a, e, f));
            CHECK(irradiance_quad(a * near, e * near, f * near) == irradiance_quad(a, e, f));
            for (const auto& [b, u, v] : {Needle{a, e, f}, {a, f, e}, {a + e, f - e, -e}}) {
                const double triangle = triangle_by_fans(b, u, v);
                CHECK(double(irradiance_triangle(b, u, v)) == approx(triangle, bound, bound));
            }
        }
}

TEST_CASE("needles: a tiny light is its area times both cosines over the square distance") {
    const vec3 centre{1, 2, 2};
    for (int power = -10; power >= -32; power -= 2) {
        const real side = std::ldexp(real(1), power);
        const vec3 u{side, 0, 0}, v{0, side, 0}, corner = centre - (u + v) / 2;
        const double quad = double(side) * double(side) * 2 * 2 / 81;
        const double bound = single ? 2e-5 : power > -16 ? 1e-6 : 1e-9;
        INFO("side 2^", power);
        CHECK(double(irradiance_quad(corner, u, v)) == approx(quad, bound, bound));
        const vec3 third = centre - (u + v) / 3;  // centre: mean of corners
        CHECK(double(irradiance_triangle(third, u, v)) == approx(quad / 2, bound, bound));
    }
}

TEST_CASE("needles: below the horizon or seen from their ends they send nothing") {
    const real thin = real(1e-6);
    CHECK(irradiance_quad({1, 0, -1}, {real(0.5), 0, real(0.2)}, {0, thin, 0}) == 0);
    CHECK(irradiance_triangle({1, 0, 1}, {1, 0, 1}, {0, thin, 0}) == 0);
    CHECK(irradiance_quad({1, 0, 1}, {1, 0, 1}, {0, thin, 0}) == 0);
    // The upper half of a needle across the horizon.
    const double half = double(irradiance_quad({1, 0, -1}, {0, 0, 2}, {0, thin, 0}));
    const double upper = double(irradiance_quad({1, 0, 0}, {0, 0, 1}, {0, thin, 0}));
    CHECK(half == approx(upper, 1e-11, 1e-5));
    CHECK(half == approx(double(thin) / 4, 1e-9, 1e-5));
}

TEST_CASE("needles: what is thin beside its ends but passes near by is no needle") {
    // A strip with its middle five widths above the receiver: four times the closed form of a
    // rectangle with one corner on the normal.
    const real width = single ? real(0x1p-10) : real(0x1p-20);
    const double E = double(irradiance_quad({-1, -width / 2, 5 * width}, {2, 0, 0}, {0, width, 0}));
    const double x = 1 / (5 * double(width)), y = 0.1, rx = std::hypot(1, x), ry = std::hypot(1, y);
    const double truth = 2 * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
    CHECK(E == approx(truth, 1e-12, 1e-5));
}

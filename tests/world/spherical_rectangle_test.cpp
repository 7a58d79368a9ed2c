// world/spherical_rectangle_test.cpp  solid angles and uniform directions
#include "world/spherical_rectangle.h"

#include <doctest/doctest.h>

#include "oracle/oracle.h"

namespace {

constexpr bool single = sizeof(real) == 4;

// From above one corner, at height h (O'Rourke; half-tangents): atan(a b / (h sqrt(a^2+b^2+h^2))).
double corner_angle(double a, double b, double h) {
    return std::atan(a * b / (h * std::sqrt(a * a + b * b + h * h)));
}

}  // namespace

TEST_CASE("rectangle: solid angle of a corner, a frustum, any rectangle; either side") {
    const auto corner = see_rectangle(rectangle_frame({1, 0, 0}, {0, 3, 0}), {0, 0, -2});
    REQUIRE(corner);
    CHECK(double(corner->solid_angle) ==
          doctest::Approx(corner_angle(1, 3, 2)).epsilon(single ? 1e-5 : 1e-13).scale(0));
    const auto frustum = see_rectangle(rectangle_frame({6, 0, 0}, {0, 8, 0}), {-3, -4, 5});
    REQUIRE(frustum);
    CHECK(double(frustum->solid_angle) ==
          doctest::Approx(4 * corner_angle(3, 4, 5)).epsilon(single ? 1e-5 : 1e-13).scale(0));
    const auto off = see_rectangle(rectangle_frame({0, 4, 0}, {5, 0, 0}), {1, 2, 3});
    REQUIRE(off);
    const double truth = corner_angle(6, 6, 3) - corner_angle(1, 6, 3) - corner_angle(6, 2, 3) +
                         corner_angle(1, 2, 3);
    CHECK(double(off->solid_angle) ==
          doctest::Approx(truth).epsilon(single ? 1e-4 : 1e-12).scale(0));
    CHECK(pdf_rectangle(*off) == 1 / off->solid_angle);
    for (real skew : {real(0.1), real(-0.1)})
        CHECK_FALSE(see_rectangle(rectangle_frame({0, 4, 0}, {5, skew, 0}), {1, 2, 3}));
    CHECK_FALSE(see_rectangle(rectangle_frame({1, 0, 0}, {0, 1, 0}), {0, 0, 1000}));
    CHECK_FALSE(see_rectangle(rectangle_frame({1, 0, 0}, {0, 1, 0}), {1, 1, 0}));
}

TEST_CASE("rectangle: the solid angle that a step of u covers is the same everywhere") {
    oracle::Random random(oracle::seed_of("rectangle density"));
    auto number = [&] { return real(2 * random() - 1); };
    for (int i = 0; i < 200; ++i) {
        const Frame f = frame(unit({number(), number(), number()}));
        const vec3 p{number(), number(), number()}, u = f.s * (2 * number()),
                                                    v = f.t * (2 * number());
        const auto r = see_rectangle(rectangle_frame(u, v), p);
        if (!r) continue;
        for (int k = 0; k < 10; ++k) {
            const real h = single ? real(4e-3) : real(1e-5);
            const vec2 c{real(0.01 + 0.98 * random()), real(0.01 + 0.98 * random())};
            auto direction = [&](real x, real y) {
                return unit(sample_rectangle(*r, {c.x + x * h, c.y + y * h}));
            };
            const vec3 across = (direction(1, 0) - direction(-1, 0)) / (2 * h),
                       along = (direction(0, 1) - direction(0, -1)) / (2 * h);
            const double jacobian = double(length(cross(across, along)));
            INFO("rectangle ", i, ", solid angle ", double(r->solid_angle), ", u ", double(c.x),
                 " ", double(c.y));
            // Where a corner comes near the point, steps of u see the curvature of the map.
            if (std::abs(r->z0) > 0.05)
                CHECK(
                    jacobian ==
                    doctest::Approx(double(r->solid_angle)).epsilon(single ? 0.05 : 1e-4).scale(0));
        }
    }
}

TEST_CASE("rectangle: samples lie on it, corners are reached") {
    oracle::Random random(oracle::seed_of("rectangle points"));
    auto number = [&] { return real(2 * random() - 1); };
    for (int i = 0; i < 300; ++i) {
        const Frame f = frame(unit({number(), number(), number()}));
        const vec3 p{number(), number(), number()}, u = f.s * real(0.1 + random()),
                                                    v = f.t * real(0.1 + random());
        const auto r = see_rectangle(rectangle_frame(u, v), p);
        if (!r) continue;
        const real slack = (single ? real(1e-3) : real(1e-8));
        for (vec2 c : {vec2{0, 0},
                       {0, below_one},
                       {below_one, 0},
                       {below_one, below_one},
                       {real(random()), real(random())}}) {
            const vec3 q = sample_rectangle(*r, c) - p;
            const real a = dot(q, u) / dot(u, u), b = dot(q, v) / dot(v, v);
            CHECK(std::abs(dot(q, f.n)) < slack);
            CHECK(a > -slack);
            CHECK(a < 1 + slack);
            CHECK(b > -slack);
            CHECK(b < 1 + slack);
            if (c.x == 0) CHECK(std::abs(a) < slack + real(1e-3));
            if (c.x == below_one) CHECK(std::abs(a - 1) < slack + real(1e-3));
            if (c.y == 0) CHECK(std::abs(b) < slack);
            if (c.y == below_one) CHECK(std::abs(b - 1) < slack);
        }
    }
}

TEST_CASE("rectangle: from just above it rounding moves no sample off it") {
    // The sine of the elevation is 1 but for 10^-15 or so, of which few digits are left.
    oracle::Random random(oracle::seed_of("rectangle just below"));
    int outside = 0, seen = 0;
    for (double height : {1e-8, 1e-7, 1e-6, 1e-4, 1e-3})
        for (int i = 0; i < 1000; ++i) {
            const vec3 p{real(-random()), real(-random()), real(-height)};
            const auto r = see_rectangle(rectangle_frame({1, 0, 0}, {0, 1, 0}), p);
            if (!r) continue;
            ++seen;
            const vec3 q = sample_rectangle(*r, {real(random()), i % 2 ? 0 : below_one}) - p;
            for (real along : {q.x, q.y}) outside += along < -4 * ulp || along > 1 + 4 * ulp;
        }
    CHECK(outside == 0);
    CHECK(seen > 2000);
}

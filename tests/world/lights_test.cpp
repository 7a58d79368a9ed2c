// world/lights_test.cpp  light sampling: densities per solid angle, points on lights, unbiased
// choices
#include "world/lights.h"

#include "base/approx.h"
#include "oracle/expect.h"
#include "world/geometry.h"

namespace {

Light shining(Light l) { return l.L = {1, 2, 3}, l; }

auto directions(const Light& l, vec3 p) {
    return [=](double u, double v) {
        const auto s = sample_light(l, p, {real(u), real(v)});
        return s ? s->wi : vec3{};
    };
}

vec3 middle(const Light& l) {
    vec3 sum;
    for (vec3 corner : corners_of(l)) sum += corner;
    return sum / real(corners_of(l).size());
}

// Solid angle of the triangle a, b, c from the origin (van Oosterom, Strackee 1983).
double solid_angle(vec3 a, vec3 b, vec3 c) {
    const double A = double(length(a)), B = double(length(b)), C = double(length(c));
    return 2 * std::atan2(std::abs(double(dot(a, cross(b, c)))), A * B * C + double(dot(a, b)) * C +
                                                                     double(dot(b, c)) * A +
                                                                     double(dot(c, a)) * B);
}
double solid_angle(const Light& l, vec3 p) {
    const auto c = corners_of(l);
    return solid_angle(c[0] - p, c[1] - p, c[2] - p) +
           (c.size() == 4 ? solid_angle(c[0] - p, c[2] - p, c[3] - p) : 0.0);
}

}  // namespace

TEST_CASE("sphere light: uniform over the cone it subtends, from 10^-7 above it to 10^4 radii") {
    oracle::Random random(seed_here());
    const vec3 centre{real(0.3), real(-0.2), real(0.5)}, away = unit({2, 1, -3});
    const real r = real(0.25);
    for (double gap : {1e-7, 1e-3, 0.5, 1.0, 30.0, 1e4}) {
        if (single && (gap < 1e-5 || gap > 100)) continue;  // rounding of p or wi exceeds this
        const double d = double(r) * (1 + gap), sigma = double(r) / d;
        const double rounding = 64 * double(ulp) / std::min(sigma, std::sqrt(gap));
        const Light l(centre, SphereLight{r});
        const vec3 p = centre + real(d) * away;
        oracle::Options o;
        o.axis = oracle::detail::point(-away);
        o.tolerance = std::max(single ? 2e-3 : 1e-6, 100 * rounding);
        o.n = single ? 40000 : 32000;  // rounding hides some of what is seen
        auto density = [&](vec3 w) {
            const vec3 off = cross(w, centre - p);
            const bool inside = dot(w, away) < 0 && dot(off, off) <= sqr(r * (1 + real(rounding)));
            return inside ? pdf_light(l, p, {}) : 0;
        };
        EXPECT(oracle::expect_density(random, directions(l, p), density, o)
                   .of(oracle::say("gap of %g radii", gap)),
               0.07);
    }
}

TEST_CASE("sphere light: points lie on the sphere and on the ray, on the near side") {
    oracle::Random random(seed_here());
    const real r = real(0.5);
    Light l = shining(Light({1, 2, 3}, SphereLight{r}));
    l.error = 64 * ulp;
    for (real d : {real(0.5005), real(0.6), real(2), real(100)})
        for (int i = 0; i < 2000; ++i) {
            const vec2 v{real(random()), real(random())}, u{real(random()), real(random())};
            const vec3 p = l.p + d * spherical(1 - 2 * v.x, 2 * std::sqrt(v.x * (1 - v.x)), v.y);
            const auto s = sample_light(l, p, u);
            REQUIRE(s);
            const real rounding = 32 * ulp * (d + length(l.p));
            CHECK(std::abs(length(s->at.p - l.p) - r) < rounding);
            CHECK(std::abs(length(s->at.n) - 1) < 8 * ulp);
            CHECK(s->at.error == l.error);
            // Rounding moves the point off the ray, more so at grazing angles.
            const vec3 off = cross(s->at.p - p, s->wi);
            CHECK(length(off) < 4 * rounding);
            CHECK(dot(s->at.n, s->wi) < 8 * ulp * (1 + d / r));
            CHECK(s->L == l.L);
            CHECK(s->pdf == pdf_light(l, p, s->at));
        }
}

TEST_CASE("no sample from the inside of a sphere light, from its surface, nor within its error") {
    Light l = shining(Light({0, 0, 0}, SphereLight{1}));
    for (const auto& [d, error, sampled] : {std::tuple{0.0, 0.0, false},
                                            {0.5, 0.0, false},
                                            {1.0, 0.0, false},
                                            {1 + 0.9e-4, 1e-4, false},
                                            {1 + 1.1e-4, 1e-4, true}}) {
        l.error = real(error);
        const vec3 p{0, real(d), 0};
        CAPTURE(p.y);
        CHECK(sample_light(l, p, {0.3, 0.4}).has_value() == sampled);
        CHECK((pdf_light(l, p, {{0, 1, 0}, {0, 1, 0}, 0}) > 0) == sampled);
    }
}

TEST_CASE("triangle and quad lights: density r^2 / (A cos), near, far and slanted") {
    oracle::Random random(seed_here());
    const vec3 corner{-1, 2, 3}, u{2, real(0.3), 0}, v{real(0.1), real(-0.4), real(1.5)};
    const vec3 n = unit(cross(u, v));
    for (const Light& l : {Light(corner, TriangleLight{u, v}), Light(corner, QuadLight{u, v})})
        for (real height : {real(0.3), real(2), real(30)})
            for (vec3 beside : {vec3{}, 2 * unit(u), 8 * unit(v)}) {
                const vec3 p = middle(l) + height * n + beside;
                const std::string where =
                    oracle::say("height %g, %g beside", double(height), double(length(beside)));
                // As in the integrator, the density is at the point of the light that wi meets.
                auto density = [&](vec3 wi) {
                    return pdf_light(l, p, {p + dot(l.p - p, n) / dot(wi, n) * wi, n, 0});
                };
                EXPECT(oracle::expect_jacobian(random, directions(l, p), density).of(where),
                       single ? 0.03 : 0.02);
                auto per_pdf = [&] {
                    const auto s = sample_light(l, p, {real(random()), real(random())});
                    CHECK(std::abs(s->pdf / density(s->wi) - 1) < 1e4 * ulp);
                    return 1 / s->pdf;
                };
                EXPECT(oracle::expect_mean(solid_angle(l, p), 20000, per_pdf)
                           .of("E[1 / pdf] = solid angle, " + where),
                       0.15);
            }
}

TEST_CASE("polygon lights: the side that emits, both sides, edge-on") {
    Light l({0, 0, 0}, QuadLight{{1, 0, 0}, {0, 1, 0}});
    const vec2 u{real(0.3), real(0.6)};
    CHECK(sample_light(l, {0, 0, 1}, u));
    CHECK(!sample_light(l, {0, 0, -1}, u));
    CHECK(!sample_light(l, {5, 0, 0}, u));
    l.twosided = true;
    CHECK(sample_light(l, {0, 0, -1}, u));
    CHECK(!sample_light(l, {5, 0, 0}, u));
    CHECK(pdf_light(l, {5, 0, 0}, {{0, 0, 0}, {0, 0, 1}, 0}) == 0);
    const auto s = sample_light(l, {0, 0, -2}, u);
    CHECK(length(s->at.p - vec3{real(0.3), real(0.6), 0}) < 4 * ulp);
}

TEST_CASE("point light: L = I / d^2, density 1, never hit by chance") {
    const Light l({1, 2, 3}, PointLight(), {18, 9, 0});
    const auto s = sample_light(l, {1, 2, 0}, {});
    REQUIRE(s);
    CHECK(s->wi == vec3{0, 0, 1});
    CHECK(s->L == rgb{2, 1, 0});
    CHECK(s->pdf == 1);
    CHECK(l.is_delta());
    CHECK(pdf_light(l, {1, 2, 0}, s->at) == 0);
    CHECK(!sample_light(l, {1, 2, 3}, {}));
}

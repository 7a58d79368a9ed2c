// whole/extremes_light_test.cpp  near, far, faint, clipped and edge-on lights
#include "radiosity/particles.h"
#include "whole/extremes.h"
#include "world/prepare.h"

namespace {

Light bright_sphere(vec3 centre, real r) {
    Light l(centre, SphereLight{r});
    l.L = {1, 1, 1};
    l.error = rounding_error(Shape{centre, {}, {}, r});
    return l;
}

// Irradiance at p, normal up, from light l by midpoints: the mean of cos / pdf.
double irradiance(const Light& l, vec3 p, int cells) {
    double sum = 0;
    each_cell(cells, [&](vec2 u) {
        const auto s = sample_light(l, p, u);
        if (s && s->wi.z > 0) sum += double(s->wi.z) / double(s->pdf);
    });
    return sum / (double(cells) * cells);
}

double cone_solid_angle() {
    return worst_of("solid angle of a cone", 10000, [&](Dice& random, Worst& worst) {
        const real sin2 = random.decades(-20, 0);
        worst.see(relative(solid_angle_cone(sin2),
                           2 * big_pi * big(sin2) / (1 + std::sqrt(1 - big(sin2)))));
    });
}

double cone_sines() {
    const real sin2_max = real(1e-8) / pi;  // 1e-8 sr
    return worst_of_cells(64, [&](Worst& worst, vec2 u) {
        const vec3 w = sample_cone(u, sin2_max);
        const big x = u.x * big(sin2_max) / (1 + std::sqrt(1 - big(sin2_max)));
        worst.see(relative(std::hypot(big(w.x), big(w.y)), std::sqrt(x * (2 - x))));
    });
}

// 1 / pdf is the solid angle; a light of radius 1 is seen from a distance of d.
double sphere_light_pdf(real d) {
    return worst_of("pdf of a sphere light", 1000, [&](Dice& random, Worst& worst) {
        const Light l = bright_sphere(random.direction(), 1);
        const vec3 p = d * random.direction();
        const big3 f = big3(l.p) - p;
        const big sin2 = 1 / dot(f, f);
        const big truth = 2 * big_pi * sin2 / (1 + std::sqrt(1 - sin2));
        const auto s = sample_light(l, p, random.pair());
        worst.see(s ? relative(1 / big(s->pdf), truth) : HUGE_VAL);
        worst.see(relative(1 / big(pdf_light(l, p, {})), truth));
    });
}

// The normal at the ray's hit on the sphere: the angle beta between it and -wi has sin(beta) =
// sin(theta) / sin(sigma), so the angle at the centre is beta - theta. u is in long double.
// Rounding of theta moves a grazing ray's hit by 1 / cos(beta) of it, whatever the program computes
// then.
double sphere_light_normal(real d) {
    return worst_of("normal of a sphere light", 20000, [&](Dice& random, Worst& worst) {
        const Light l = bright_sphere({}, real(0.01));
        const vec3 p = d * l.radius * random.direction();
        const vec2 u = random.pair();
        const auto s = sample_light(l, p, u);
        if (!s) return worst.see(HUGE_VAL);
        const big sin2_max = big(l.radius) * l.radius / dot(big3(p), big3(p));
        const big x = u.x * sin2_max / (1 + std::sqrt(1 - sin2_max)), phi = 2 * big_pi * u.y;
        const big theta = std::atan2(std::sqrt(x * (2 - x)), 1 - x);
        const big sin_beta = std::sqrt(x * (2 - x) / sin2_max);
        const big cos_beta = std::sqrt(1 - sin_beta * sin_beta);
        const big alpha = std::atan2(sin_beta, cos_beta) - theta;
        const Frame f = frame(-p / length(p));
        const big3 n = std::sin(alpha) * std::cos(phi) * big3(f.x) +
                       std::sin(alpha) * std::sin(phi) * big3(f.y) - std::cos(alpha) * big3(f.n);
        worst.see(length(big3(s->at.n) - n) * cos_beta);
    });
}

// E = pi sin^2(sigma) under the middle of the light; the receiver is h below the light's surface.
double sphere_light_from(real r, real h) {
    const Light l = bright_sphere({0, 0, r + h}, r);
    const big d = l.p.z;
    return relative(irradiance(l, {}, 64), big_pi * r * r / (d * d));
}

// k = cos / sin(sigma): E = s^3 (k acos(-k) + sqrt(1 - k^2) (2 + k^2) / 3) for small s (relative
// error 1.4 s^2).  For k = 0 half of the light is above the horizon.
double clipped_sphere_light(real s, real k) {
    const real c = k * s;
    const Light l = bright_sphere({std::sqrt(1 - c * c), 0, c}, s);
    const big truth = big(s) * s * s *
                      (k * std::acos(-big(k)) + std::sqrt(1 - big(k) * k) * (2 + big(k) * k) / 3);
    return relative(irradiance(l, {}, 1024), truth);
}

bool sane(const std::optional<LightSample>& s) {
    return !s || (is_finite(s->wi) && is_finite(s->at.p) && is_finite(s->at.n) && s->pdf > 0 &&
                  !std::isnan(s->pdf));
}

// Receivers on the surface of a sphere light, one ulp below and above it, and inside.
double insane_on_a_light() {
    return count_of("on a light", 20000, [](Dice& random, int i) {
        const Light l = bright_sphere(random.direction(), random.decades(-3, 3));
        const real r = l.radius, at[] = {r, std::nextafter(r, real(0)), std::nextafter(r, infinity),
                                         r * random(0, 1), 0};
        const vec3 p = l.p + at[i % 5] * random.direction();
        const vec2 corners[] = {{0, 0}, {below_one, below_one}, random.pair()};
        int insane = !std::isfinite(pdf_light(l, p, {l.p, {0, 0, 1}, 0}));
        for (vec2 u : corners) insane += !sane(sample_light(l, p, u));
        return insane;
    });
}

// Receivers at corners, on edges, in the plane of a quad and next to it.
double insane_beside_a_light() {
    return count_of("beside a light", 20000, [](Dice& random, int i) {
        const vec3 e{2, 0, 0}, f{0, 0, 4};
        Light l({1, 2, 3}, QuadLight{e, f});
        l.L = {1, 1, 1}, l.twosided = i % 2 == 0;
        const real heights[] = {0, std::numeric_limits<real>::denorm_min(), real(1e-30), -0.0};
        const vec3 p = l.p + random(0, 1) * e + vec3{0, heights[i / 2 % 4], 0};
        const vec2 u = random.pair();
        l.p.y = 0;
        return !sane(sample_light(l, {p.x, heights[i / 2 % 4], p.z}, u)) +
               !sane(sample_light(l, l.p, {0, 0})) +
               !sane(sample_light(l, l.p + u.x * e + u.y * f, u)) +
               (pdf_light(l, {p.x, 0, p.z}, {l.p + e, {0, 1, 0}, 0}) != 0);
    });
}

// A quad seen at a grazing angle from h above its plane, point by point: cos / pdf is x h A / d^4
// for the normal +x.
double edge_on(real h) {
    const Light l({1, real(-0.5), h}, QuadLight{{0, 1, 0}, {1, 0, 0}});
    return worst_of_cells(32, [&](Worst& worst, vec2 u) {
        const auto s = sample_light(l, {}, u);
        const big x = 1 + big(u.y), y = big(u.x) - 0.5L, d2 = x * x + y * y + big(h) * h;
        worst.see(s ? relative(big(s->wi.x) / s->pdf, x * h / (d2 * d2)) : HUGE_VAL);
    });
}

// a b - c d from exact products, each a sum of two doubles (Dekker 1971).
big exact_difference(double a, double b, double c, double d) {
    const double ab = a * b, cd = c * d;
    return (big(ab) - cd) + (big(std::fma(a, b, -ab)) - std::fma(c, d, -cd));
}

// Area of a triangle with edges that differ by 2^-narrow.
double sliver_light(int narrow) {
    const real off = std::exp2(real(-narrow));
    return worst_of("sliver light", 10000, [&](Dice& random, Worst& worst) {
        const vec3 u = random.direction(), v = u + off * random.direction();
        const big3 n{exact_difference(u.y, v.z, u.z, v.y), exact_difference(u.z, v.x, u.x, v.z),
                     exact_difference(u.x, v.y, u.y, v.x)};
        worst.see(relative(1 / big(pdf_triangle_area(u, v)), length(n) / 2));
    });
}

// A point light at a distance of 1e-9 to 1e9: L d^2 = I.
double light_of_a_point() {
    const Light l({}, PointLight(), {1, 1, 1});
    return worst_of("point light", 1000, [&](Dice& random, Worst& worst) {
        const vec3 p = random.decades(-9, 9) * random.direction();
        const auto s = sample_light(l, p, {});
        worst.see(s ? relative(s->L.x, 1 / dot(big3(p), big3(p))) : HUGE_VAL);
    });
}

// One light is `ratio` times as powerful as another.  Compares the part of all random numbers that
// choose each with the probability that estimates divide by.
double choice_of_lights(double ratio) {
    Scene s;
    Material faint, bright;
    faint.Le = {1, 1, 1}, bright.Le = rgb{1, 1, 1} * real(ratio);
    s.materials = {faint, bright};
    for (uint32_t m : {0u, 1u, 0u}) add_sphere(s, {real(m), 0, 0}, 1, m);
    const LightsByPower lights(s.lights);
    constexpr int digits = std::numeric_limits<real>::digits;
    const uint64_t all = uint64_t(1) << digits;
    auto first_of = [&](size_t light) {  // the first number for this light or a later one
        uint64_t low = 0, high = all;
        while (low < high) {
            const uint64_t middle = (low + high) / 2;
            const real u = to_unit(middle << (64 - digits));
            const bool reached = lights.choose(u) >= light;
            (reached ? high : low) = reached ? middle : middle + 1;
        }
        return low;
    };
    Worst worst;
    for (size_t i = 0; i < 3; ++i) {
        const big part = big((i < 2 ? first_of(i + 1) : all) - first_of(i)) / all;
        worst.see(relative(lights.probability_of(i), part));
    }
    return worst.value;
}

double weights_of_two() {
    return worst_of("weights", 100000, [](Dice& random, Worst& worst) {
        const real p = random.decades(-30, 30), q = random.decades(-30, 30);
        worst.see(std::abs(power_heuristic(p, q) + power_heuristic(q, p) - 1));
        worst.see(std::abs(power_heuristic(infinity, 1) - 1));
        worst.see(power_heuristic(0, 1));
        worst.see(std::abs(power_heuristic(1, 0) - 1));
    });
}

}  // namespace

TEST_CASE("extremes of lights: no more error than they may have") {
    check_rows({
        {"cone of 10^-20 ... 2 pi sr: solid angle", ulps(4), cone_solid_angle},
        {"cone of 10^-8 sr: sines of sampled angles", ulps(8), cone_sines},
        {"sphere light of 10^-8 sr: 1 / pdf", ulps(16), of(sphere_light_pdf, 17725)},
        {"sphere light of 10^-12 sr: 1 / pdf", ulps(16), of(sphere_light_pdf, 1.7725e6)},
        {"sphere light 10 radii away: normal", ulps(32), of(sphere_light_normal, 10)},
        {"sphere light 10^7 radii away: normal", ulps(32), of(sphere_light_normal, 1e7)},
        // Float cannot separate outside from inside so near the light: there are no light samples.
        {"10^-7 above a sphere light: irradiance", within(64 * d_ulp, any),
         of(sphere_light_from, 1, 1e-7)},
        {"10^-3 above a light of radius 10^6: irradiance", within(64 * d_ulp, any),
         of(sphere_light_from, 1e6, 1e-3)},
        // 1024 midpoints of the square root of u: 0.3 / 1024^1.5 = 1e-5.
        {"sphere light of sine 10^-4, a third below the horizon: irradiance", within(1e-5, 1e-4),
         of(clipped_sphere_light, 1e-4, 0.4)},
        {"sphere light of sine 10^-5, half below: irradiance", within(1e-5, 1e-4),
         of(clipped_sphere_light, 1e-5, 0)},
        {"sphere light of sine 10^-5, nine tenths below: irradiance", within(1e-5, 1e-4),
         of(clipped_sphere_light, 1e-5, -0.8)},
        {"on the surface of a sphere light, and in it: samples not finite", to_the_bit,
         insane_on_a_light},
        {"in the plane of a quad light, on its edge, its corner: samples not finite", to_the_bit,
         insane_beside_a_light},
        {"quad light edge-on, 10^-9 off its plane: contributions", ulps(16), of(edge_on, 1e-9)},
        {"light as thin as 10^-6 of its length: area", ulps(8), of(sliver_light, 20)},
        {"point light 10^-9 ... 10^9 away: radiance", ulps(8), light_of_a_point},
        {"lights of powers 1 and 10^9: how often against how probable", to_the_bit,
         of(choice_of_lights, 1e9)},
        {"lights of powers 1 and 10^30: how often against how probable", to_the_bit,
         of(choice_of_lights, 1e30)},
        {"MIS weights of densities 10^-30 ... 10^30: sum", ulps(4), weights_of_two},
    });
}

// whole/extremes_test.cpp  what precision buys: each configuration with the error it may have
//
// One table of rows, asserted here in the precision of this build; `make extremes` runs it in both
// and writes reference/extremes.md.
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "film/film.h"
#include "oracle/oracle.h"
#include "path/paths.h"
#include "world/scene_file.h"

namespace {

using big = long double;  // on x86: 11 bits more than double has
constexpr big big_pi = 3.141592653589793238462643383279502884L;

constexpr bool is_double = sizeof(real) == 8;

// `error` runs the configuration with this build's `real`.  An infinite bound: float cannot tell
// the configuration from another, and nothing is asked of it.
struct Row {
    const char* name;
    double in_double, in_float;  // the error that each may have
    std::function<double()> error;
    bool in_suite = true;  // else too long for it: `make extremes` alone
    double bound() const { return is_double ? in_double : in_float; }
};

// The largest number seen; a NaN counts as infinite.
struct Worst {
    double value = 0;
    void see(big x) { value = x <= value ? value : x > value ? double(x) : HUGE_VAL; }
};

double relative(big value, big truth) { return double(std::abs(value - truth) / std::abs(truth)); }

// ---- Random geometry ----------------------------------------------------------------------------

struct Draw3 {
    Rng rng;
    explicit Draw3(const char* name) : rng{seed_of(name)} {}
    real operator()(real lo, real hi) { return lo + (hi - lo) * to_unit(rng.bits()); }
    real decades(real lo, real hi) { return std::pow(real(10), (*this)(lo, hi)); }
    size_t below(size_t n) { return size_t(rng.bits() % n); }
    vec2 pair() { return {(*this)(0, 1), (*this)(0, 1)}; }
    vec3 direction() {
        const vec2 u = pair();
        return spherical(1 - 2 * u.x, 2 * std::sqrt(u.x * (1 - u.x)), 2 * pi * u.y);
    }
};

struct big3 {
    big x, y, z;
    big3(big a, big b, big c) : x(a), y(b), z(c) {}
    big3(vec3 v) : x(v.x), y(v.y), z(v.z) {}
};
big3 operator+(big3 a, big3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
big3 operator-(big3 a, big3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
big3 operator*(big s, big3 a) { return {s * a.x, s * a.y, s * a.z}; }
big dot(big3 a, big3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
big length(big3 a) { return std::sqrt(dot(a, a)); }

// Midpoints of n x n cells of the unit square.
template <class F>
void each_cell(int n, F f) {
    for (int i = 0; i < n * n; ++i)
        f(vec2{(real(i % n) + real(0.5)) / real(n), (real(i / n) + real(0.5)) / real(n)});
}

Light sphere_light(vec3 centre, real r) {
    Light l{Light::Kind::sphere, centre, {}, {}, r, {1, 1, 1}};
    l.error = rounding_error(Shape{centre, {}, {}, r});
    l.pick = 1;
    return l;
}

// Irradiance at p, n up from light l, by midpoints: mean of cos / pdf.
double irradiance(const Light& l, vec3 p, int cells) {
    double sum = 0;
    each_cell(cells, [&](vec2 u) {
        const auto s = sample_light(l, p, u);
        if (s && s->wi.z > 0) sum += double(s->wi.z) / double(s->pdf);
    });
    return sum / (double(cells) * cells);
}

// ---- A scene anywhere, at any size --------------------------------------------------------------

// Lights of every kind, every material; lengths times k, then moved.
std::string room(double k, vec3 move = {}, double brightness = 1, bool point_light = true) {
    auto number = [](double x) { return print("%.17g ", x); };
    auto length = [&](double x) { return number(k * x); };
    auto edge = [&](double x, double y, double z) { return length(x) + length(y) + length(z); };
    auto point = [&](double x, double y, double z) {
        return number(k * x + double(move.x)) + number(k * y + double(move.y)) +
               number(k * z + double(move.z));
    };
    auto light = [&](double x) {
        return number(x * brightness) + number(x / 2 * brightness) + number(x / 4 * brightness);
    };
    std::string s = "size 32 16\ndepth 4\n";
    s += "camera " + point(0, 1.5, 6) + point(0, 0.8, 0) + "50\n";
    s += "diffuse white 0.7 0.6 0.5\nphong gloss 0.2 0.3 0.3 0.5 0.4 0.5 40\n";
    s += "mirror mirror 0.8 0.9 0.9\nglass glass 1.5\n";
    s += "light ball " + light(6) + "\nlight panel " + light(2) + "white\n";
    if (point_light) s += "pointlight " + point(1, 3, 2) + light(3 * k * k) + "\n";
    s += "quad " + point(-5, 0, -5) + edge(0, 0, 10) + edge(10, 0, 0) + "white\n";
    s += "quad " + point(-5, 0, -3) + edge(10, 0, 0) + edge(0, 5, 0) + "gloss\n";
    s += "quad " + point(-1, 3.5, -1) + edge(2, 0, 0) + edge(0, 0, 2) + "panel\n";
    s += "triangle " + point(-2, 0, 1) + point(-1, 0, 1) + point(-1.5, 1, 0.5) + "gloss\n";
    s += "sphere " + point(-1.6, 1.6, 0) + length(0.4) + "ball\n";
    s += "sphere " + point(-0.6, 0.6, 0.5) + length(0.6) + "mirror\n";
    s += "sphere " + point(1.2, 0.7, 0.2) + length(0.7) + "glass\n";
    return s;
}

// Radiance of every sample of every pixel.
std::vector<rgb> samples_of(const std::string& text, int spp) {
    const Scene scene = parse_scene(text, "extreme").scene;
    const Pattern pattern{SamplerKind::independent, seed_of("room")};
    std::vector<rgb> samples;
    for (int y = 0; y < scene.size.height; ++y)
        for (int x = 0; x < scene.size.width; ++x)
            for (int i = 0; i < spp; ++i)
                samples.push_back(radiance(scene, {}, pattern, x, y, uint64_t(i)));
    return samples;
}

constexpr int room_spp = 8;
std::vector<rgb> room_samples(double k, vec3 move = {}, double brightness = 1) {
    return samples_of(room(k, move, brightness), room_spp);
}

// Samples that are not factor times the others, bit for bit.
double different(const std::vector<rgb>& a, real factor, const std::vector<rgb>& b) {
    int n = 0;
    for (size_t i = 0; i < a.size(); ++i) n += !(a[i] * factor == b[i]);
    return n;
}

double mean_of_all(const std::vector<rgb>& samples) {
    double sum = 0;
    for (rgb L : samples) sum += double(L.x) + double(L.y) + double(L.z);
    return sum / (3 * double(samples.size()));
}

double room_scaled(int by) {
    return different(room_samples(1), 1, room_samples(std::ldexp(1.0, by)));
}

// The largest and the smallest lengths of a scene file; without the point light, whose intensity
// would not fit.
double room_at_its_limits() {
    const int most = is_double ? 96 : 26;
    auto at = [](int by) { return samples_of(room(std::ldexp(1.0, by), {}, 1, false), room_spp); };
    const auto samples = at(0);
    return different(samples, 1, at(most)) + different(samples, 1, at(-most));
}

double room_brighter(int by) {
    return different(room_samples(1), std::ldexp(real(1), by),
                     room_samples(1, {}, std::ldexp(1.0, by)));
}

double room_mean(double k, real move) {
    return relative(mean_of_all(room_samples(k, {move, -move, move})),
                    mean_of_all(room_samples(1)));
}

// rho = 1 - 1e-7 and Le = 1 everywhere, 1e4 scatterings: L = (1 - rho^(D+1)) / (1 - rho).
double white_furnace() {
    const Scene scene = parse_scene(
                            "camera 0 0 1.8  0 0.1 0  60\ndepth 10000\n"
                            "diffuse white 0.9999999 0.9999999 0.9999999\n"
                            "light glow 1 1 1 twosided white\n"
                            "box 4 3 4  0  -2 -1.5 -2  glow\n",
                            "furnace")
                            .scene;
    const Technique chance{Direction::bsdf, LightMode::none};
    const Pattern pattern{SamplerKind::independent, seed_of("white furnace")};
    const big truth = -std::expm1(10001 * std::log1p(-1e-7L)) / 1e-7L;
    Worst worst;
    for (uint64_t i = 0; i < 10; ++i)
        worst.see(relative(radiance(scene, chance, pattern, 3, 2, i).x, truth));
    return worst.value;
}

// ---- Lights -------------------------------------------------------------------------------------

double cone_solid_angle() {
    Draw3 random("solid angle of a cone");
    Worst worst;
    for (int i = 0; i < 10000; ++i) {
        const real sin2 = random.decades(-20, 0);
        worst.see(relative(solid_angle_cone(sin2),
                           2 * big_pi * big(sin2) / (1 + std::sqrt(1 - big(sin2)))));
    }
    return worst.value;
}

double cone_sines() {
    const real sin2_max = real(1e-8) / pi;  // 1e-8 sr
    Worst worst;
    each_cell(64, [&](vec2 u) {
        const vec3 w = sample_cone(u, sin2_max);
        const big x = u.x * big(sin2_max) / (1 + std::sqrt(1 - big(sin2_max)));
        worst.see(relative(std::hypot(big(w.x), big(w.y)), std::sqrt(x * (2 - x))));
    });
    return worst.value;
}

// 1 / pdf is the solid angle; light of radius 1 seen from a distance of d.
double sphere_light_pdf(real d) {
    Draw3 random("pdf of a sphere light");
    Worst worst;
    for (int i = 0; i < 1000; ++i) {
        const Light l = sphere_light(random.direction(), 1);
        const vec3 p = d * random.direction();
        const big3 f = big3(l.p) - p;
        const big sin2 = 1 / dot(f, f);
        const big truth = 2 * big_pi * sin2 / (1 + std::sqrt(1 - sin2));
        const auto s = sample_light(l, p, random.pair());
        worst.see(s ? relative(1 / big(s->pdf), truth) : HUGE_VAL);
        worst.see(relative(1 / big(pdf_light(l, p, {})), truth));
    }
    return worst.value;
}

// Normal where the ray meets the sphere: beta between it and -wi has sin(beta) = sin(theta) /
// sin(sigma), so the angle at the centre is beta - theta.  From u in long double.
double sphere_light_normal(real d) {
    Draw3 random("normal of a sphere light");
    Worst worst;
    for (int i = 0; i < 20000; ++i) {
        const Light l = sphere_light({}, real(0.01));
        const vec3 p = d * l.r * random.direction();
        const vec2 u = random.pair();
        const auto s = sample_light(l, p, u);
        if (!s) return HUGE_VAL;
        const big sin2_max = big(l.r) * l.r / dot(big3(p), big3(p));
        const big x = u.x * sin2_max / (1 + std::sqrt(1 - sin2_max)), phi = 2 * big_pi * u.y;
        const big theta = std::atan2(std::sqrt(x * (2 - x)), 1 - x);
        const big sin_beta = std::sqrt(x * (2 - x) / sin2_max);
        const big alpha = std::atan2(sin_beta, std::sqrt(1 - sin_beta * sin_beta)) - theta;
        const Frame f = frame(-p / length(p));
        const big3 n = std::sin(alpha) * std::cos(phi) * big3(f.s) +
                       std::sin(alpha) * std::sin(phi) * big3(f.t) - std::cos(alpha) * big3(f.n);
        worst.see(length(big3(s->at.n) - n));
    }
    return worst.value;
}

// E = pi sin^2(sigma) under the middle of the light, h above whose surface the receiver is.
double sphere_light_from(real r, real h) {
    const Light l = sphere_light({0, 0, r + h}, r);
    const big d = l.p.z;
    return relative(irradiance(l, {}, 64), big_pi * r * r / (d * d));
}

// k = cos / sin(sigma): E = s^3 (k acos(-k) + sqrt(1 - k^2) (2 + k^2) / 3) for small s (relative
// error 1.4 s^2); 0 is half above the horizon.
double clipped_sphere_light(real s, real k) {
    const real c = k * s;
    const Light l = sphere_light({std::sqrt(1 - c * c), 0, c}, s);
    const big truth = big(s) * s * s *
                      (k * std::acos(-big(k)) + std::sqrt(1 - big(k) * k) * (2 + big(k) * k) / 3);
    return relative(irradiance(l, {}, 1024), truth);
}

bool sane(const std::optional<LightSample>& s) {
    return !s || (is_finite(s->wi) && is_finite(s->at.p) && is_finite(s->at.n) && s->pdf > 0 &&
                  !std::isnan(s->pdf));
}

// From the surface of a sphere light, one number below and above, and its inside.
double insane_on_a_light() {
    Draw3 random("on a light");
    int insane = 0;
    for (int i = 0; i < 20000; ++i) {
        const Light l = sphere_light(random.direction(), random.decades(-3, 3));
        const real at[] = {l.r, std::nextafter(l.r, real(0)), std::nextafter(l.r, infinity),
                           l.r * random(0, 1), 0};
        const vec3 p = l.p + at[i % 5] * random.direction();
        const vec2 corners[] = {{0, 0}, {below_one, below_one}, random.pair()};
        for (vec2 u : corners) insane += !sane(sample_light(l, p, u));
        insane += !std::isfinite(pdf_light(l, p, {l.p, {0, 0, 1}, 0}));
    }
    return insane;
}

// From corners, edges, the plane of a quad and points next to it.
double insane_beside_a_light() {
    Draw3 random("beside a light");
    int insane = 0;
    for (int i = 0; i < 20000; ++i) {
        Light l{Light::Kind::quad, {1, 2, 3}, {2, 0, 0}, {0, 0, 4}, 0, {1, 1, 1}, i % 2 == 0};
        const real heights[] = {0, std::numeric_limits<real>::denorm_min(), real(1e-30), -0.0};
        const vec3 p = l.p + random(0, 1) * l.u + vec3{0, heights[i / 2 % 4], 0};
        const vec2 u = random.pair();
        l.p.y = 0;
        insane += !sane(sample_light(l, {p.x, heights[i / 2 % 4], p.z}, u));
        insane += !sane(sample_light(l, l.p, {0, 0}));
        insane += !sane(sample_light(l, l.p + u.x * l.u + u.y * l.v, u));
        insane += pdf_light(l, {p.x, 0, p.z}, {l.p + l.u, {0, 1, 0}, 0}) != 0;
    }
    return insane;
}

// A quad seen at a grazing angle from h above its plane, point by point: cos / pdf is
// x h A / d^4 for the normal +x.
double edge_on(real h) {
    const Light l{Light::Kind::quad, {1, real(-0.5), h}, {0, 1, 0}, {1, 0, 0}};
    Worst worst;
    each_cell(32, [&](vec2 u) {
        const auto s = sample_light(l, {}, u);
        const big x = 1 + big(u.y), y = big(u.x) - 0.5L, d2 = x * x + y * y + big(h) * h;
        worst.see(s ? relative(big(s->wi.x) / s->pdf, x * h / (d2 * d2)) : HUGE_VAL);
    });
    return worst.value;
}

// a b - c d from exact products, each a sum of two doubles (Dekker 1971).
big exact_difference(double a, double b, double c, double d) {
    const double ab = a * b, cd = c * d;
    return (big(ab) - cd) + (big(std::fma(a, b, -ab)) - std::fma(c, d, -cd));
}

// Area of a triangle whose edges differ by 2^-narrow.
double sliver_light(int narrow) {
    Draw3 random("sliver light");
    const real off = std::exp2(real(-narrow));
    Worst worst;
    for (int i = 0; i < 10000; ++i) {
        const vec3 u = random.direction(), v = u + off * random.direction();
        const big3 n{exact_difference(u.y, v.z, u.z, v.y), exact_difference(u.z, v.x, u.x, v.z),
                     exact_difference(u.x, v.y, u.y, v.x)};
        worst.see(relative(1 / big(pdf_triangle_area(u, v)), length(n) / 2));
    }
    return worst.value;
}

// Point light at a distance of 1e-9 to 1e9: L d^2 = I.
double point_light() {
    Draw3 random("point light");
    Light l;
    l.L = {1, 1, 1};
    Worst worst;
    for (int i = 0; i < 1000; ++i) {
        const vec3 p = random.decades(-9, 9) * random.direction();
        const auto s = sample_light(l, p, {});
        worst.see(s ? relative(s->L.x, 1 / dot(big3(p), big3(p))) : HUGE_VAL);
    }
    return worst.value;
}

// A light `ratio` times as powerful as another: the part of all random numbers that choose each
// against the probability that estimates are divided by.
double choice_of_lights(double ratio) {
    Scene s;
    Material faint, bright;
    faint.Le = {1, 1, 1}, bright.Le = rgb{1, 1, 1} * real(ratio);
    s.materials = {faint, bright};
    for (uint32_t m : {0u, 1u, 0u}) add_sphere(s, {real(m), 0, 0}, 1, m);
    prepare(s);
    constexpr int digits = std::numeric_limits<real>::digits;
    const uint64_t all = uint64_t(1) << digits;
    auto first_of = [&](size_t light) {  // number that chooses this light or a later one
        uint64_t low = 0, high = all;
        while (low < high) {
            const uint64_t middle = (low + high) / 2;
            const real u = to_unit(middle << (64 - digits));
            const bool reached = &choose_light(s, u) >= &s.lights[light];
            (reached ? high : low) = reached ? middle : middle + 1;
        }
        return low;
    };
    Worst worst;
    for (size_t i = 0; i < 3; ++i) {
        const big part = big((i < 2 ? first_of(i + 1) : all) - first_of(i)) / all;
        worst.see(relative(s.lights[i].pick, part));
    }
    return worst.value;
}

double weights_of_two() {
    Draw3 random("weights");
    Worst worst;
    for (int i = 0; i < 100000; ++i) {
        const real p = random.decades(-30, 30), q = random.decades(-30, 30);
        worst.see(std::abs(power_heuristic(p, q) + power_heuristic(q, p) - 1));
    }
    worst.see(std::abs(power_heuristic(infinity, 1) - 1));
    worst.see(power_heuristic(0, 1));
    worst.see(std::abs(power_heuristic(1, 0) - 1));
    return worst.value;
}

// ---- Spheres and triangles ----------------------------------------------------------------------

std::optional<Hit> meet(const Shape& s, const Ray& ray) {
    return intersect(s, ray, shear(ray.d), ray.tmax);
}

// Past the centre at a distance of x radii, from d radii away.
struct Aimed {
    Shape s;
    Ray ray;
};
Aimed aimed(real d, real x, Draw3& random) {
    const Shape s{{}, {}, {}, random.decades(-3, 3)};
    const vec3 o = s.a + d * s.r * random.direction();
    const real sine = x * s.r / length(s.a - o);
    const vec3 local = spherical(std::sqrt(1 - sine * sine), sine, 2 * pi * random(0, 1));
    return {s, {o, unit(frame(unit(s.a - o)).to_world(local))}};
}

// Part of the rays that miss; how far o + t d, and the point that paths use, are off the surface,
// in distances at most and in radii in the mean.
struct FarSphere {
    double missed = 0, hit_off = 0, hit_mean = 0, point_off = 0, point_mean = 0;
};
FarSphere far_sphere(real d) {
    Draw3 random("far sphere");
    FarSphere result;
    Worst hit_off, point_off;
    Moments hit_mean, point_mean;
    const int n = 50000;
    for (int i = 0; i < n; ++i) {
        const Aimed at = aimed(d, random(0, real(0.99)), random);
        const Shape& s = at.s;
        const Ray& ray = at.ray;
        const auto hit = meet(s, ray);
        result.missed += hit ? 0 : 1.0 / n;
        if (!hit) continue;
        auto off = [&](big3 p) { return double(std::abs(length(p - s.a) - s.r) / s.r); };
        const double at_hit = off(big3(ray.o) + hit->t * big3(ray.d));
        const double at_point = off(surface(s, ray, *hit).p);
        hit_off.see(at_hit / double(d));
        hit_mean.add(at_hit);
        point_off.see(at_point / double(d));
        point_mean.add(at_point);
    }
    result.hit_off = hit_off.value, result.hit_mean = hit_mean.mean;
    result.point_off = point_off.value, result.point_mean = point_mean.mean;
    return result;
}

// Height of 1e-3 over a sphere of radius 1e6, by a ray straight down; in radii.
double over_a_planet() {
    const Shape s{{0, real(-1e6), 0}, {}, {}, real(1e6)};
    const auto hit = meet(s, {{0, real(1e-3), 0}, {0, -1, 0}});
    return hit ? std::abs(double(hit->t) - 1e-3) / 1e6 : HUGE_VAL;
}

// Rays that leave a surface point outwards, at any angle, and meet their own shape.
double met_again() {
    Draw3 random("met again");
    int again = 0;
    for (int i = 0; i < 20000; ++i) {
        const real sizes[] = {real(1e-6), 1, real(1e6)};
        const real size = sizes[i % 3], distance = i % 2 ? real(1e6) : 0;
        const vec3 at = distance * random.direction();
        Shape s{at, {}, {}, size};
        if (i % 5 == 0) s = {at, at + size * random.direction(), at + size * random.direction()};
        if (!s.is_sphere() && s.a == s.b) continue;
        const vec3 target = s.is_sphere() ? s.a : (s.a + s.b + s.c) / 3;
        const vec3 o = target + 4 * size * random.direction();
        if (o == target) continue;
        const Ray ray{o, unit(target - o)};
        const auto hit = meet(s, ray);
        if (!hit) continue;
        const Surface x = surface(s, ray, *hit);
        if (!is_finite(x.n)) continue;
        const Frame f = frame(x.n);
        for (int k = 0; k < 16; ++k) {
            const real z = k % 2 ? random(0, 1) : random.decades(-12, 0);
            const vec3 d = f.to_world(spherical(z, std::sqrt(1 - z * z), 2 * pi * random(0, 1)));
            if (dot(d, x.n) > 0) again += meet(s, spawn(x, d)).has_value();
        }
    }
    return again;
}

// A closed surface about the origin.
using Mesh = std::vector<Shape>;

Mesh ball(int levels) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) {
        const real x = i & 1 ? -1 : 1, y = i & 2 ? -1 : 1, z = i & 4 ? -1 : 1;
        mesh.push_back({{x, 0, 0}, {0, y, 0}, {0, 0, z}});
    }
    for (int level = 0; level < levels; ++level) {
        Mesh finer;
        for (const Shape& s : mesh) {
            const vec3 ab = unit(s.a + s.b), bc = unit(s.b + s.c), ca = unit(s.c + s.a);
            finer.insert(finer.end(), {{s.a, ab, ca}, {ab, s.b, bc}, {ca, bc, s.c}, {ab, bc, ca}});
        }
        mesh = finer;
    }
    return mesh;
}

// Two cones on a ring of n corners and their twins, `gap` further on.
Mesh slivers(int n, real gap) {
    std::vector<vec3> ring;
    for (int i = 0; i < n; ++i) {
        const real phi = 2 * pi * real(i) / real(n);
        const vec3 p{std::cos(phi), std::sin(phi), 0};
        ring.insert(ring.end(), {p, p + gap * vec3{-p.y, p.x, 0}});
    }
    Mesh mesh;
    for (size_t i = 0; i < ring.size(); ++i)
        for (real z : {real(-1), real(1)})
            mesh.push_back({{0, 0, z}, ring[i], ring[(i + 1) % ring.size()]});
    return mesh;
}

// Rays from inside, aimed at corners and edges, that find a way out of the mesh.
double leaks(Mesh mesh, vec3 move) {
    for (Shape& s : mesh) s = {s.a + move, s.b + move, s.c + move};
    const Bvh bvh(mesh);
    Draw3 random("leaks");
    int leaked = 0;
    for (int i = 0; i < 40000; ++i) {
        const Shape& s = mesh[random.below(mesh.size())];
        const vec3 corner[3] = {s.a, s.b, s.c};
        const size_t k = random.below(3);
        const real along = i % 3 ? random(0, 1) : 0;
        const vec3 target = corner[k] + along * (corner[(k + 1) % 3] - corner[k]);
        const vec3 o = move + random(0, real(0.3)) * random.direction();
        leaked += !bvh.closest({o, unit(target - o)});
    }
    return leaked;
}

// Rays along axes, within the faces of boxes and of the tree: tree against loop.
double along_axes() {
    Draw3 random("along axes");
    Scene boxes;
    boxes.materials.resize(1);
    for (int i = 0; i < 60; ++i)
        add_box(boxes, {1, 1, real(i % 3 ? 1 : 0.5)}, 0,
                {real(random.below(6)), real(random.below(6)), real(random.below(6))}, 0);
    const std::vector<Shape>& shapes = boxes.shapes;
    const Bvh bvh(shapes);
    int wrong = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec3 o{real(random.below(7)) - (i % 7 == 0 ? 10 : 0), real(random.below(7)),
                     real(random.below(7))};
        vec3 d{i & 1 ? -real(0) : real(0), i & 2 ? -real(0) : real(0), i & 4 ? -real(0) : real(0)};
        d.*axis[i % 3] = i & 8 ? -1 : 1;
        const Ray ray{o, d};
        Hit best;
        for (size_t j = 0; j < shapes.size(); ++j)
            if (const auto hit = meet(shapes[j], ray); hit && hit->t < best.t)
                best = *hit, best.id = uint32_t(j);
        const auto hit = bvh.closest(ray);
        wrong += hit ? hit->id != best.id || hit->t != best.t : best.id != UINT32_MAX;
        wrong += bvh.occluded(ray) != hit.has_value();
    }
    return wrong;
}

// Of coincident shapes the first is seen, whatever surrounds them.
double coincident() {
    Draw3 random("coincident");
    int wrong = 0;
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<Shape> shapes;
        const Shape wall{{-9, -9, 0}, {9, -9, 0}, {0, 12, 0}};
        const size_t n = 1 + random.below(40), first = random.below(n);
        for (size_t i = 0; i < n; ++i)
            shapes.push_back(i == first || (i > first && random.below(2))
                                 ? wall
                                 : Shape{random.direction() - vec3{0, 0, 3}, {}, {}, 1});
        const Bvh bvh(shapes);
        for (int i = 0; i < 200; ++i) {
            const vec3 o{random(-2, 2), random(-2, 2), 5};
            const auto hit = bvh.closest({o, {0, 0, -1}});
            wrong += !hit || hit->id != first;
        }
    }
    return wrong;
}

// A sheet `gap` before a wall, seen from about 10 away: part of the rays that see the wall.
double sheet_before_wall(real gap) {
    std::vector<Shape> shapes;
    for (real z : {real(0), gap}) shapes.push_back({{-20, -20, z}, {20, -20, z}, {0, 30, z}});
    const Bvh bvh(shapes);
    Draw3 random("sheet");
    const int n = 20000;
    int wall = 0;
    for (int i = 0; i < n; ++i) {
        const vec3 o{random(-3, 3), random(-3, 3), 10}, to{random(-3, 3), random(-3, 3), 0};
        const auto hit = bvh.closest({o, unit(to - o)});
        wall += !hit || hit->id == 0;
    }
    return double(wall) / n;
}

// The same sheet over a floor: part of the shadow rays from the floor that pass it.
double shadow_of_sheet(real gap) {
    const Shape floor{{-20, -20, 0}, {20, -20, 0}, {0, 30, 0}};
    const Bvh bvh({floor, {{-20, -20, gap}, {20, -20, gap}, {0, 30, gap}}});
    Draw3 random("shadow of a sheet");
    const int n = 20000;
    int lit = 0;
    for (int i = 0; i < n; ++i) {
        const Surface x{{random(-3, 3), random(-3, 3), 0}, {0, 0, 1}, rounding_error(floor)};
        lit += !bvh.occluded(spawn_to(x, {{random(-3, 3), random(-3, 3), 10}, {0, 0, -1}, 0}));
    }
    return double(lit) / n;
}

// Triangles with edges of 10^-k, and with no area, as scenes take them: each is dropped, or has a
// normal of length 1.  Worst | |n| - 1 |.
double tiny_normals() {
    Draw3 random("tiny normals");
    Scene scene;
    scene.materials.resize(1);
    const real least = is_double ? -320 : -44;
    Worst worst;
    for (int i = 0; i < 20000; ++i) {
        const vec3 a = i % 2 ? vec3{} : random.direction();
        const real size = random.decades(least, 0);
        const vec3 b = a + size * random.direction();
        const vec3 c = i % 5 ? a + size * random.direction() : i % 3 ? b : a + 2 * (b - a);
        scene.shapes.clear();
        add_triangle(scene, a, b, c, 0);
        add_quad(scene, a, b - a, c - a, 0);
        for (const Shape& s : scene.shapes)
            worst.see(std::abs(length(big3(surface(s, {}, {}).n)) - 1));
    }
    return worst.value;
}

double few_shapes() {
    int wrong = Bvh(std::vector<Shape>{}).closest({{}, {0, 0, 1}}).has_value();
    const Bvh one({{{0, 0, 5}, {}, {}, 1}});
    wrong += one.closest({{}, {0, 0, 1}})->t != 4;
    wrong += one.closest({{}, {0, 0, -1}}).has_value();
    const real nan = std::numeric_limits<real>::quiet_NaN();
    wrong += one.closest({{}, {nan, nan, nan}}).has_value();
    return wrong;
}

// ---- Directions ---------------------------------------------------------------------------------

// Largest scalar product of two axes.
double skewness(const Frame& f) {
    return double(std::max({std::abs(dot(big3(f.s), f.t)), std::abs(dot(big3(f.t), f.n)),
                            std::abs(dot(big3(f.n), f.s))}));
}

double frames_anywhere() {
    Draw3 random("frames");
    Worst worst;
    for (int i = 0; i < 20000; ++i) worst.see(skewness(frame(random.direction())));
    return worst.value;
}

// Down to 1e-9, 1e-20 and 0 from both poles.
double frames_at_poles() {
    Worst worst;
    for (real z : {real(-1), real(1)})
        for (real tiny : {real(1e-4), real(4.5e-5), real(1e-9), real(1e-20), real(0)})
            for (real angle = 0; angle < 6; angle += real(0.01))
                worst.see(skewness(frame({tiny * std::cos(angle), tiny * std::sin(angle),
                                          z * std::sqrt(1 - tiny * tiny)})));
    return worst.value;
}

// Directions from the corners of the unit square: lengths off 1.
double corners_of_the_square() {
    Worst worst;
    const real ends[] = {0, std::numeric_limits<real>::denorm_min(), ulp, real(0.5), below_one};
    for (real x : ends)
        for (real y : ends)
            for (vec3 w : {sample_uniform_hemisphere({x, y}), sample_cosine_hemisphere({x, y}),
                           sample_phong_lobe({x, y}, 0), sample_phong_lobe({x, y}, real(1e6)),
                           sample_cone({x, y}, 1), sample_cone({x, y}, real(1e-30))}) {
                worst.see(std::abs(length(big3(w)) - 1));
                worst.see(w.z >= 0 ? 0 : HUGE_VAL);
            }
    return worst.value;
}

// Near the pole of a uniform hemisphere: sin^2 = u (2 - u).
double sines_at_the_pole() {
    Draw3 random("pole");
    Worst worst;
    for (int i = 0; i < 10000; ++i) {
        const real u = random.decades(is_double ? -15 : -7, 0);
        const vec3 w = sample_uniform_hemisphere({u, real(0.3)});
        // 1 - u is rounded, and so is the point; the sine is that of u.
        worst.see(relative(std::hypot(big(w.x), big(w.y)), std::sqrt(big(u) * (2 - big(u)))));
    }
    return worst.value;
}

// Exponent 1e5: sine of the angle from the axis.
double lobe_sines() {
    const real n = real(1e5);
    Draw3 random("lobe");
    Worst worst;
    for (int i = 0; i < 10000; ++i) {
        const real u = random.decades(is_double ? -12 : -6, 0);
        const vec3 w = sample_phong_lobe({u, real(0.3)}, n);
        const big truth = std::sqrt(-std::expm1(2 * std::log1p(-big(u)) / (big(n) + 1)));
        worst.see(relative(std::hypot(big(w.x), big(w.y)), truth));
    }
    return worst.value;
}

// Mirrored at a cosine of 1e-6 by a lobe of exponent 1e5: its density, as `pdf` finds it from wi
// against that from u; and the weight f cos / pdf, which must be ks (n+2) / (n+1) cos.
struct Lobe {
    double density = 0, weight = 0;
};
Lobe grazing_lobe() {
    Material m;
    m.ks = {1, 1, 1}, m.exponent = real(1e5);
    const real z = real(1e-6);
    const vec3 wo{std::sqrt(1 - z * z), 0, z};
    Worst density, weight;
    each_cell(64, [&](vec2 u) {
        const BsdfSample s = sample(m, wo, true, 0, u, Direction::bsdf);
        const big n = m.exponent;
        density.see(relative(s.pdf, (n + 1) / (2 * big_pi) * std::pow(1 - big(u.x), n / (n + 1))));
        if (s.wi.z > 0) weight.see(relative(s.f.x * (s.wi.z / s.pdf), (n + 2) / (n + 1) * s.wi.z));
    });
    return {density.value, weight.value};
}

// ---- Glass --------------------------------------------------------------------------------------

Material glass(real ior) {
    Material m;
    m.kind = Material::Kind::glass, m.ior = ior;
    return m;
}
vec3 at_cosine(real z) { return {std::sqrt((1 - z) * (1 + z)), 0, z}; }

// Reflectance as sample_glass has it, against Fresnel's in long double.
double glass_off(real ior, bool outside, real z) {
    const BsdfSample s = sample(glass(ior), at_cosine(z), outside, 0, {}, Direction::bsdf);
    const big reflectance = s.wi.z > 0 ? big(s.pdf) : 1 - big(s.pdf);
    const big eta = outside ? 1 / big(ior) : big(ior);
    const big i = z, cos2 = (1 - eta) * (1 + eta) + eta * eta * i * i, c = std::sqrt(cos2);
    const big parallel = (i - eta * c) / (i + eta * c), cross = (eta * i - c) / (eta * i + c);
    const big truth = cos2 > 0 ? (parallel * parallel + cross * cross) / 2 : 1;
    return double(std::abs(reflectance - truth));
}

double glass_like_air() {
    Worst worst;
    for (bool outside : {false, true})
        for (real z = 1; z > real(1e-12); z *= real(0.7)) worst.see(glass_off(1, outside, z));
    return worst.value;
}

double grazing_glass() {
    Worst worst;
    for (real ior : {real(1.5), real(2.4), real(100)})
        for (real z = 1; z > real(1e-12); z *= real(0.7)) worst.see(glass_off(ior, true, z));
    return worst.value;
}

double critical_glass() {
    Worst worst;
    for (real ior : {real(1.5), real(1.0001), real(2.4)}) {
        const real critical = std::sqrt(1 - 1 / (ior * ior));
        for (real off = real(0.01); off > ulp; off *= real(0.8))
            for (real z : {critical * (1 - off), critical * (1 + off), critical})
                worst.see(glass_off(ior, false, z));
    }
    return worst.value;
}

// f cos / pdf is 1 for what is reflected, eta^2 for what is refracted: index 10^-30 to 10^30.
double glass_weights() {
    Draw3 random("glass");
    Worst worst;
    for (int i = 0; i < 100000; ++i) {
        const real ior = i % 3 ? random.decades(-30, 30) : random(real(0.5), 2);
        const vec3 wo = i % 7 ? at_cosine(random.decades(-9, 0)) : vec3{0, 0, 1};
        const bool outside = i % 2;
        const BsdfSample s = sample(glass(ior), wo, outside, random(0, 1), {}, Direction::bsdf);
        const big eta = s.wi.z > 0 ? 1 : outside ? 1 / big(ior) : big(ior);
        worst.see(relative(s.f.x * (std::abs(s.wi.z) / s.pdf), eta * eta));
        worst.see(is_finite(s.wi) ? 0 : HUGE_VAL);
    }
    return worst.value;
}

// ---- Camera -------------------------------------------------------------------------------------

// Neighbouring pixels of a telescope: the angle between their rays is 2 tan(fov / 2) / height.
double telescope(real degrees) {
    const Camera c = look_at({}, {1, 2, -3}, degrees);
    const big angle = 2 * std::tan(big(degrees) * big_pi / 360) / 128;
    Worst worst;
    for (int x = 100; x < 150; ++x) {
        const Ray a = camera_ray(c, {256, 128}, real(x), 64),
                  b = camera_ray(c, {256, 128}, real(x + 1), 64);
        worst.see(relative(length(big3(a.d) - b.d), angle));
    }
    return worst.value;
}

// A field of view of 179.99 degrees: height of the image plane.
double wide_angle() {
    const real degrees = real(179.99);
    const Camera c = look_at({}, {0, 0, -1}, degrees);
    return relative(c.tan_half, std::tan(big(degrees) * big_pi / 360));
}

// Looking almost straight down: axes not orthonormal.
double from_above(real off) {
    const Camera c = look_at({real(0.3) + off, 1, off / 3}, {real(0.3), real(0.2), 0}, 40);
    return double(
        std::max({std::abs(dot(big3(c.right), c.up)), std::abs(dot(big3(c.up), c.forward)),
                  std::abs(dot(big3(c.forward), c.right)), std::abs(length(big3(c.right)) - 1),
                  std::abs(length(big3(c.up)) - 1)}));
}

// ---- Numbers of paths ---------------------------------------------------------------------------

// Radical inverses at and beside an index, against the sum of d_k b^(-k-1).
double halton_at(uint64_t index) {
    Worst worst;
    for (uint32_t base : {2u, 3u, 5u, 541u, 104729u})
        for (uint64_t i : {index - 2, index - 1, index}) {
            big truth = 0, scale = 1;
            for (uint64_t rest = i; rest > 0; rest /= base)
                truth += big(rest % base) * (scale /= base);
            const real x = radical_inverse(base, i);
            worst.see(x < 1 ? relative(x, std::min(truth, big(below_one))) : HUGE_VAL);
        }
    return worst.value;
}

// Blocks of b^k scrambled points at the far end of the indices: intervals of b^-k without exactly
// one point.
double halton_blocks() {
    Draw3 random("blocks");
    int wrong = 0;
    for (uint32_t base : {2u, 3u, 5u})
        for (uint64_t about : {uint64_t(1) << 31, uint64_t(1) << 32, uint64_t(1) << 53}) {
            const uint64_t n = uint64_t(base) * base * base, start = about / n * n;
            const uint64_t shift = random.rng.bits(), factor = random.rng.bits();
            std::vector<int> points(n);
            for (uint64_t i = start; i < start + n; ++i) {
                const real x = scrambled_radical_inverse(base, i, shift, factor);
                // A point on a border may be rounded across it.
                ++points[std::min<uint64_t>(uint64_t(x * real(n) * (1 + 8 * ulp)), n - 1)];
            }
            for (int p : points) wrong += p != 1;
        }
    return wrong;
}

// The 2^40th sample of a pixel: grids are still complete, and no number leaves [0,1).
double late_samples() {
    int wrong = 0;
    const uint64_t late = uint64_t(1) << 40;
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::stratified, SamplerKind::halton,
                             SamplerKind::halton_naive}) {
        const Pattern pattern = make_pattern(kind, seed_of("late samples"), false, 4, 16);
        for (uint32_t dim : {film_x, dimension(3, Draw::wi_x)}) {
            int cells[16] = {};
            for (uint64_t i = late; i < late + 16; ++i) {
                const vec2 u = Sampler(pattern, 77, i).get2(dim);
                wrong += !(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
                ++cells[size_t(u.x * 4) * 4 + size_t(u.y * 4)];
            }
            if (kind == SamplerKind::stratified)
                for (int c : cells) wrong += c != 1;
        }
    }
    return wrong + !(to_unit(0xffffffff80u) < 1) + !(to_unit(UINT64_MAX) < 1);
}

// ---- Sums ---------------------------------------------------------------------------------------

// 1e9 numbers, 0 ... 999 a million times each, in 1000 parts: mean 499.5, variance
// (1000^2 - 1) / 12 n / (n - 1).
double merged_billion() {
    Moments part, all;
    for (int i = 0; i < 1000000; ++i) part.add(i % 1000);
    for (int i = 0; i < 1000; ++i) all.merge(part);
    const double truth = (1e6 - 1) / 12 * 1e9 / (1e9 - 1);
    return std::max(relative(all.mean, 499.5), relative(all.variance(), truth));
}

// The film's mean and variance of 1e9 samples of one pixel, 0.1 and 0.3 by turns, one by one.
double billion_one_by_one() {
    Film<MeanPixel> film({1, 1});
    const real low = real(0.1), high = real(0.3);
    film.add_row(0, 1000000000, [&](int, uint64_t i) {
        const real L = i % 2 ? high : low;
        return rgb{L, L, L};
    });
    film.end_pass(1000000000);
    const double mean = (double(low) + double(high)) / 2, half = (double(high) - double(low)) / 2;
    // Both are stored as float: rounded once more, by 6e-8.
    const double off = relative(image_of(film).at(0, 0)[0], mean);
    const Image variance = variance_of(film, VarianceFrom::samples);
    return std::max(off, relative(variance.at(0, 0)[0], half * half / (1e9 - 1)));
}

// Mean 1e8, sigma 1: moments of doubles.
double variance_far_from_zero() {
    Moments m;
    for (int i = 0; i < 100000; ++i) m.add(1e8 + (i % 2 ? 1 : -1));
    return relative(m.variance(), 1e5 / (1e5 - 1));
}

// The same as radiance, in the film.
double film_far_from_zero() {
    Film<MeanPixel> film({1, 1});
    film.add_row(0, 100000, [](int, uint64_t i) {
        const real L = real(1e8) + (i % 2 ? real(1) : real(-1));
        return rgb{L, L, L};
    });
    film.end_pass(100000);
    return relative(variance_of(film, VarianceFrom::samples).at(0, 0)[0], 1 / (1e5 - 1));
}

// P(|z| > 20), and Student's t far out: P(|t| > x) -> 2 / (pi x) for one degree of freedom.
double tails() {
    return std::max(relative(p_of_z(20), 5.507248237212467e-89L),
                    relative(p_of_t(1e8, 1), 2 / (big_pi * 1e8L)));
}

// ---- The table ----------------------------------------------------------------------------------

constexpr double d_ulp = 0x1p-53, f_ulp = 0x1p-24;  // of double and float: 1.1e-16, 6e-8
constexpr double any = HUGE_VAL;

const std::vector<Row>& rows() {
    static const std::vector<Row> table = {
        // A few of 4096 paths may part where float rounds another way.
        {"scene scaled by 2^20: samples not the same, bit for bit", 0, 0,
         [] { return room_scaled(20); }},
        {"scene scaled by 2^-20: samples not the same", 0, 0, [] { return room_scaled(-20); }},
        {"scene as large and as small as its file may say: samples not the same", 0, 0,
         room_at_its_limits},
        {"scene scaled by 10^6: mean", 1e-6, 1e-3, [] { return room_mean(1e6, 0); }},
        {"scene scaled by 10^-6: mean", 1e-6, 1e-3, [] { return room_mean(1e-6, 0); }},
        {"scene moved by 10^3: mean", 1e-6, 0.02, [] { return room_mean(1, 1000); }},
        {"scene moved by 10^6: mean", 1e-6, any, [] { return room_mean(1, real(1e6)); }},
        {"radiance x 2^96 (10^29): samples not 2^96 x the same", 0, 0,
         [] { return room_brighter(96); }},
        {"radiance x 2^-96: samples not 2^-96 x the same", 0, 0, [] { return room_brighter(-96); }},
        {"albedo 1 - 10^-7, 10^4 scatterings: radiance", 1e-11, 1e-3, white_furnace},

        {"cone of 10^-20 ... 2 pi sr: solid angle", 4 * d_ulp, 4 * f_ulp, cone_solid_angle},
        {"cone of 10^-8 sr: sines of sampled angles", 8 * d_ulp, 8 * f_ulp, cone_sines},
        {"sphere light of 10^-8 sr: 1 / pdf", 16 * d_ulp, 16 * f_ulp,
         [] { return sphere_light_pdf(real(17725)); }},
        {"sphere light of 10^-12 sr: 1 / pdf", 16 * d_ulp, 16 * f_ulp,
         [] { return sphere_light_pdf(real(1.7725e6)); }},
        {"sphere light 10 radii away: normal", 32 * d_ulp, 32 * f_ulp,
         [] { return sphere_light_normal(10); }},
        {"sphere light 10^7 radii away: normal", 32 * d_ulp, 32 * f_ulp,
         [] { return sphere_light_normal(real(1e7)); }},
        // So near that float cannot tell outside from inside: no light samples there.
        {"10^-7 above a sphere light: irradiance", 64 * d_ulp, any,
         [] { return sphere_light_from(1, real(1e-7)); }},
        {"10^-3 above a light of radius 10^6: irradiance", 64 * d_ulp, any,
         [] { return sphere_light_from(real(1e6), real(1e-3)); }},
        // 1024 midpoints of the square root of u: 0.3 / 1024^1.5 = 1e-5.
        {"sphere light of sine 10^-4, a third below the horizon: irradiance", 1e-5, 1e-4,
         [] { return clipped_sphere_light(real(1e-4), real(0.4)); }},
        {"sphere light of sine 10^-5, half below: irradiance", 1e-5, 1e-4,
         [] { return clipped_sphere_light(real(1e-5), 0); }},
        {"sphere light of sine 10^-5, nine tenths below: irradiance", 1e-5, 1e-4,
         [] { return clipped_sphere_light(real(1e-5), real(-0.8)); }},
        {"on the surface of a sphere light, and in it: samples not finite", 0, 0,
         insane_on_a_light},
        {"in the plane of a quad light, on its edge, its corner: samples not finite", 0, 0,
         insane_beside_a_light},
        {"quad light edge-on, 10^-9 off its plane: contributions", 16 * d_ulp, 16 * f_ulp,
         [] { return edge_on(real(1e-9)); }},
        {"light as thin as 10^-6 of its length: area", 8 * d_ulp, 8 * f_ulp,
         [] { return sliver_light(20); }},
        {"point light 10^-9 ... 10^9 away: radiance", 8 * d_ulp, 8 * f_ulp, point_light},
        {"lights of powers 1 and 10^9: how often against how probable", 0, 0,
         [] { return choice_of_lights(1e9); }},
        {"lights of powers 1 and 10^30: how often against how probable", 0, 0,
         [] { return choice_of_lights(1e30); }},
        {"MIS weights of densities 10^-30 ... 10^30: sum", 4 * d_ulp, 4 * f_ulp, weights_of_two},

        // Rounding of a unit direction moves the hit by 3 ulp of the distance, of the roots by 5.
        {"sphere 10^4 radii away: hit off the surface, in distances", 8 * d_ulp, 8 * f_ulp,
         [] { return far_sphere(real(1e4)).hit_off; }},
        {"sphere 10^4 radii away: point of a path off the surface, in distances", 5e-16, 3e-7,
         [] { return far_sphere(real(1e4)).point_off; }},
        {"sphere 10^4 radii away: part of the rays within 0.99 R that miss", 0, 0,
         [] { return far_sphere(real(1e4)).missed; }},
        {"sphere 10^7 radii away: part of the rays within 0.99 R that miss", 0, 0.5,
         [] { return far_sphere(real(1e7)).missed; }},
        {"sphere 10^7 radii away: hit off the surface, mean, in radii", 8e7 * d_ulp, any,
         [] { return far_sphere(real(1e7)).hit_mean; }},
        {"sphere 10^7 radii away: point of a path off the surface, mean, in radii", 6e-10,
         4 * f_ulp, [] { return far_sphere(real(1e7)).point_mean; }},
        {"sphere 1 / ulp radii away: the same", 4 * d_ulp, 4 * f_ulp,
         [] { return far_sphere(1 / ulp).point_mean; }},
        {"sphere of radius 10^6 seen from 10^-3: distance, in radii", 8 * d_ulp, any,
         over_a_planet},
        {"rays leaving spheres of 10^-6 ... 10^6, 10^6 from the origin: met again", 0, 0,
         met_again},
        {"closed mesh at (148376, 1234, -223423), aimed at edges and corners: leaks", 0, 0,
         [] {
             return leaks(ball(3), {148376, 1234, -223423});
         }},
        {"closed mesh of slivers, aspect 10^8, aimed at edges and corners: leaks", 0, 0,
         [] { return leaks(slivers(150, real(1e-8)), {}); }},
        {"rays along axes, +0 and -0, in faces of boxes: tree unlike loop", 0, 0, along_axes},
        {"coincident surfaces: not the first one seen", 0, 0, coincident},
        {"sheet 10^-6 before a wall, from 10: part of the rays that see the wall", 0, 0.5,
         [] { return sheet_before_wall(real(1e-6)); }},
        {"sheet 10^-6 above a floor: part of the shadow rays that pass", 0, any,
         [] { return shadow_of_sheet(real(1e-6)); }},
        {"triangles from 1 to denormal, and without area: length of the normal", 4 * d_ulp,
         4 * f_ulp, tiny_normals},
        {"no shape, one shape, a ray that is not a number: wrong answers", 0, 0, few_shapes},

        {"frames about n.z = +-1, and 10^-9 off: scalar products of axes", 2.8e-16, 1e-7,
         frames_at_poles},
        // n is unit within 2 ulp.
        {"frames anywhere: scalar products of axes", 8 * d_ulp, 8 * f_ulp, frames_anywhere},
        {"samplers at the corners of the unit square: length", 8 * d_ulp, 8 * f_ulp,
         corners_of_the_square},
        {"uniform hemisphere near its pole: sines", 8 * d_ulp, 8 * f_ulp, sines_at_the_pole},
        {"Phong exponent 10^5: sines from the axis", 8 * d_ulp, 8 * f_ulp, lobe_sines},
        // Rounding of the cosine, 4 ulp, times the exponent.
        {"Phong exponent 10^5, grazing: density", 4e5 * d_ulp, 4e5 * f_ulp,
         [] { return grazing_lobe().density; }},
        {"Phong exponent 10^5, grazing: weight", 16 * d_ulp, 16 * f_ulp,
         [] { return grazing_lobe().weight; }},
        {"glass of index 1, cosines down to 10^-12: reflectance", 8 * d_ulp, 8 * f_ulp,
         glass_like_air},
        {"glass of index 1.5 ... 100, cosines down to 10^-12: reflectance", 16 * d_ulp, 16 * f_ulp,
         grazing_glass},
        // 4 ulp of cos^2 cancel, the root of which is the refracted cosine over n cos; 1 - R is
        // 2 (n + 1 / n) / cos times that: 2 (n^2 + 1) sqrt(4 ulp), n = 2.4.
        {"glass at its critical angle: reflectance", 2.9e-7, 6.6e-3, critical_glass},
        {"glass of index 10^-30 ... 10^30: weights", 16 * d_ulp, 16 * f_ulp, glass_weights},
        {"field of view of 10^-4 degrees: angle between pixels", 1e-6, any,
         [] { return telescope(real(1e-4)); }},
        {"field of view of 179.99 degrees: its tangent", 1e-11, 1e-2, wide_angle},
        {"camera 10^-9 from looking straight down: axes", 8 * d_ulp, 8 * f_ulp,
         [] { return from_above(real(1e-9)); }},

        {"Halton up to index 2^31", 4 * d_ulp, 4 * f_ulp,
         [] { return halton_at(uint64_t(1) << 31); }},
        {"Halton up to index 2^32", 4 * d_ulp, 4 * f_ulp,
         [] { return halton_at(uint64_t(1) << 32); }},
        {"Halton up to index 2^53", 4 * d_ulp, 4 * f_ulp,
         [] { return halton_at(uint64_t(1) << 53); }},
        {"Halton up to index 2^64 - 1", 4 * d_ulp, 4 * f_ulp, [] { return halton_at(UINT64_MAX); }},
        {"scrambled Halton at 2^31, 2^32, 2^53: intervals without their one point", 0, 0,
         halton_blocks},
        {"sample 2^40 of a pixel: numbers outside [0,1), cells without their one point", 0, 0,
         late_samples},
        {"10^9 numbers, merged: mean and variance", 1e-12, 1e-12, merged_billion},
        // The image is float: 6e-8.
        {"10^9 samples of a pixel, one by one: mean and variance", 1e-7, 1e-7, billion_one_by_one,
         false},
        {"mean 10^8, sigma 1: variance", 1e-6, 1e-6, variance_far_from_zero},
        {"radiance 10^8, sigma 1: variance in the film", 1e-6, any, film_far_from_zero},
        {"p-values of z = 20, of Student's t = 10^8", 1e-12, 1e-12, tails},
    };
    return table;
}

}  // namespace

// With EXTREMES=FILE every row, also the long ones, goes to that file: name, both bounds, error.
TEST_CASE("every extreme has no more error than it may have") {
    const char* path = std::getenv("EXTREMES");
    std::FILE* out = path ? std::fopen(path, "w") : nullptr;
    REQUIRE((!path || out));
    for (const Row& row : rows()) {
        if (!row.in_suite && !out) continue;
        const double error = row.error();
        INFO(std::string(row.name));
        CHECK(!std::isnan(error));
        CHECK(error <= row.bound());
        if (out)
            std::fprintf(out, "%s\t%.2g\t%.2g\t%.2g\n", row.name, row.in_double, row.in_float,
                         error);
    }
    if (out) std::fclose(out);
}

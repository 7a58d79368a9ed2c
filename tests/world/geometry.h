// world/geometry.h  random placements, and vectors of long double, for tests of geometry
#pragma once
#include <vector>

#include "base/rng.h"
#include "oracle/expect.h"
#include "world/lights.h"
#include "world/shapes.h"
#include "world/warp.h"

namespace penumbra {

struct Dice {
    Rng rng{seed_here()};
    real operator()(real lo, real hi) { return lo + (hi - lo) * to_unit(rng.bits()); }
    real decades(real lo, real hi) { return std::pow(real(10), (*this)(lo, hi)); }
    size_t below(size_t n) { return size_t(rng.bits() % n); }
    real sign() { return below(2) ? real(1) : real(-1); }
    vec2 pair(real lo = 0, real hi = 1) { return {(*this)(lo, hi), (*this)(lo, hi)}; }
    vec3 direction(real length = 1) {
        const vec2 u = pair();
        return length * spherical(1 - 2 * u.x, 2 * std::sqrt(u.x * (1 - u.x)), u.y);
    }
    vec2 barycentrics() {
        const vec2 u = pair();
        return {std::sqrt(u.x) * (1 - u.y), std::sqrt(u.x) * u.y};
    }
};

// Of a polygon light; the point or centre of another.
inline std::vector<vec3> corners_of(const Light& l) {
    if (const auto* quad = l.as<QuadLight>())
        return {l.p, l.p + quad->e, l.p + quad->e + quad->f, l.p + quad->f};
    if (const auto* triangle = l.as<TriangleLight>())
        return {l.p, l.p + triangle->e, l.p + triangle->f};
    return {l.p};
}

// ---- Long double --------------------------------------------------------------------------------

using big = long double;  // on x86: 11 bits more than double

struct big3 {
    big x, y, z;
    big3(big a, big b, big c) : x(a), y(b), z(c) {}
    big3(vec3 v) : x(v.x), y(v.y), z(v.z) {}
};
inline big3 operator+(big3 a, big3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline big3 operator-(big3 a, big3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline big3 operator*(big s, big3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline big dot(big3 a, big3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline big length(big3 a) { return std::sqrt(dot(a, a)); }
inline big difference_of_products(big a, big b, big c, big d) {
    const big cd = c * d;
    return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}
inline big3 cross(big3 a, big3 b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

// The largest number seen; a NaN counts as infinite.
struct Worst {
    big value = 0;
    void see(big x) { value = x <= value ? value : x > value ? x : big(infinity); }
};

// ---- Shapes -------------------------------------------------------------------------------------

inline std::optional<Hit> meet(const Shape& s, const Ray& ray) {
    return intersect(s, ray, shear(ray.d), ray.tmax);
}

inline vec3 point(const Shape& s, vec2 u) { return s.a + u.x * (s.b - s.a) + u.y * (s.c - s.a); }

// A ray from o that passes the centre of the shape at a distance of x radii.
inline Ray aimed(const Shape& s, vec3 o, real x, Dice& random) {
    const real sine = x * s.r / length(s.a - o);
    const vec3 local = spherical(std::sqrt(1 - sine * sine), sine, random(0, 1));
    return {o, unit(frame(unit(s.a - o)).to_world(local))};
}

inline Shape random_triangle(Dice& random, real edge) {
    const vec3 a = random.direction();
    return {a, a + edge * random.direction(), a + edge * random.direction()};
}

// A triangle with edges of about 1 and a width from 2^-7 down to 2^-narrowest.
inline Shape random_sliver(Dice& random, real narrowest) {
    const vec3 a = random.direction(), e = random.direction();
    const vec3 off = random.direction(std::exp2(random(-narrowest, -7)));
    return {a, a + e, a + random(0, 1) * e + off};
}

inline Shape scaled(const Shape& s, real k) { return {s.a * k, s.b * k, s.c * k, s.r * k}; }
inline Shape moved(const Shape& s, vec3 v) {
    return s.r > 0 ? Shape{s.a + v, {}, {}, s.r} : Shape{s.a + v, s.b + v, s.c + v};
}

// Placements: unit size, small, huge, and far from the origin compared with the size.
struct Placement {
    real scale, distance;
};
inline constexpr Placement placements[] = {
    {1, 0}, {1, 3}, {real(1e-6), 0}, {real(1e6), real(1e6)}, {1, 100}, {1, 10000}};

inline Shape placed(const Shape& s, const Placement& p, Dice& random) {
    return moved(scaled(s, p.scale), random.direction(p.distance));
}

// A surface around the origin; triangles that share a corner have bit-identical coordinates.
using Triangles = std::vector<Shape>;

// Two cones on a ring of n corners and n twins; twins are `gap` apart.
inline Triangles cones(int n, real gap) {
    std::vector<vec3> ring;
    for (int i = 0; i < n; ++i) {
        const real phi = 2 * pi * real(i) / real(n);
        const vec3 p{std::cos(phi), std::sin(phi), 0};
        ring.insert(ring.end(), {p, p + gap * vec3{-p.y, p.x, 0}});
    }
    Triangles mesh;
    for (size_t i = 0; i < ring.size(); ++i)
        for (real z : {real(-1), real(1)})
            mesh.push_back({{0, 0, z}, ring[i], ring[(i + 1) % ring.size()]});
    return mesh;
}

// The octahedron, subdivided and projected onto the sphere.
inline Triangles ball(int levels) {
    Triangles mesh;
    for (int i = 0; i < 8; ++i) {
        const real x = i & 1 ? -1 : 1, y = i & 2 ? -1 : 1, z = i & 4 ? -1 : 1;
        mesh.push_back({{x, 0, 0}, {0, y, 0}, {0, 0, z}});
    }
    for (int level = 0; level < levels; ++level) {
        Triangles finer;
        for (const auto& [a, b, c, r] : mesh) {
            const vec3 ab = unit(a + b), bc = unit(b + c), ca = unit(c + a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh = finer;
    }
    return mesh;
}

}  // namespace penumbra

using namespace penumbra;

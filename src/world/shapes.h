// world/shapes.h  1  rays, boxes, triangles, spheres, and where the next ray starts
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/vec.h"

namespace penumbra {

// The points o + t d with 0 < t <= tmax.  d is unit, so t is a distance.
struct Ray {
    vec3 o, d;
    real tmax = infinity;
};

// A triangle (vertices a, b, c; r = 0) or a sphere (centre a, radius r > 0).
struct Shape {
    vec3 a, b, c;
    real r = 0;

    bool is_triangle() const { return r == 0; }
};

// Where a ray meets a shape: at distance t, in a triangle at p = (1-v-w) a + v b + w c.
struct Hit {
    real t = infinity;
    uint32_t id = UINT32_MAX;  // index of the shape
    real v = 0, w = 0;
};

// A point of a surface, its unit normal (triangle: side of (b-a) x (c-a); sphere: outwards), and
// a bound on the distance between p as computed and the surface as the intersectors see it.
struct Surface {
    vec3 p, n;
    real error = 0;
};

// ---- Boxes ------------------------------------------------------------------------------------

struct Box {
    vec3 lo{infinity, infinity, infinity};
    vec3 hi{-infinity, -infinity, -infinity};  // empty

    void add(vec3 p) {
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
    }
    void add(const Box& b) {
        lo = {std::min(lo.x, b.lo.x), std::min(lo.y, b.lo.y), std::min(lo.z, b.lo.z)};
        hi = {std::max(hi.x, b.hi.x), std::max(hi.y, b.hi.y), std::max(hi.z, b.hi.z)};
    }
    // Half the surface area; 0 for an empty box.
    real half_area() const {
        vec3 e = hi - lo;
        return e.x < 0 ? 0 : e.x * e.y + e.y * e.z + e.z * e.x;
    }
};

// ---- Triangles --------------------------------------------------------------------------------

// The shear that turns a ray into the z axis: z is the axis of the longest component of d (Woop,
// Benthin, Wald 2013, JCGT 2(1)).
struct Shear {
    size_t x, y, z;  // axes of the sheared space, as indices of axis
    real sx, sy, sz;
};

inline Shear shear(vec3 d) {
    const vec3 m{std::abs(d.x), std::abs(d.y), std::abs(d.z)};
    const size_t longer = m.x > m.y ? 0 : 1;
    const size_t z = std::max(m.x, m.y) > m.z ? longer : 2;
    constexpr size_t after[] = {1, 2, 0, 1};
    const size_t x = after[z], y = after[z + 1];
    const real sz = 1 / d.*axis[z];
    return {x, y, z, d.*axis[x] * sz, d.*axis[y] * sz, sz};
}

// Where a ray meets a triangle, from either side, at 0 < t <= tmax.  k is shear(ray.d).
inline std::optional<Hit> intersect_triangle(const Shape& s, const Ray& ray, const Shear& k,
                                             real tmax) {
    // exercise 1.3
    // Watertight: u, v, w are the edge functions of the sheared triangle.  Vertices that triangles
    // share are sheared to the same numbers, and an edge function is never rounded to the wrong
    // sign or to 0; a 0 counts as inside.  So a ray between two triangles always meets one of them.
    // Its error is relative, so that even in a sliver (1-v-w) a + v b + w c is where the ray is.
    // All this holds only while nothing else is fused.
    const auto x = axis[k.x], y = axis[k.y], z = axis[k.z];
    real ox = ray.o.*x, oy = ray.o.*y, oz = ray.o.*z;
    real az = s.a.*z - oz, ax = (s.a.*x - ox) - k.sx * az, ay = (s.a.*y - oy) - k.sy * az;
    real bz = s.b.*z - oz, bx = (s.b.*x - ox) - k.sx * bz, by = (s.b.*y - oy) - k.sy * bz;
    real cz = s.c.*z - oz, cx = (s.c.*x - ox) - k.sx * cz, cy = (s.c.*y - oy) - k.sy * cz;
    real u = difference_of_products(cx, by, cy, bx);
    real v = difference_of_products(ax, cy, ay, cx);
    real w = difference_of_products(bx, ay, by, ax);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {};
    real det = u + v + w;
    if (det == 0) return {};  // edge-on: its neighbours have it
    real t = (u * az + v * bz + w * cz) * k.sz / det;
    if (!(t > 0 && t <= tmax)) return {};
    return Hit{t, 0, v / det, w / det};
    // end
}

// ---- Spheres ----------------------------------------------------------------------------------

// The power of the point o, |o - a|^2 - r^2, within 4 ulp of itself and of ulp r^2, however close
// to the sphere o is: differences, squares and sums with their rounding errors (Ogita, Rump, Oishi
// 2005, SIAM J. Sci. Comput. 26(6)).
inline real power_of_point(vec3 o, const Shape& s) {
    real sum = -s.r * s.r, errors = -std::fma(s.r, s.r, sum);
    for (auto k : axis) {
        const ExactSum f = exact_sum(o.*k, -s.a.*k);
        const real square = f.value * f.value;
        const ExactSum next = exact_sum(sum, square);
        sum = next.value;
        errors += next.error + std::fma(f.value, f.value, -square) + 2 * f.value * f.error;
    }
    return sum + errors;
}

// The nearest point of the sphere on a ray, at 0 < t <= tmax, from outside or from inside.
inline std::optional<Hit> intersect_sphere(const Shape& s, const Ray& ray, real tmax) {
    // exercise 1.2
    // Roots of |f + t d|^2 = r^2, f = o - a, without cancellation, from q = b +- sqrt and c / q.
    // The discriminant is that of the vector between the centre and its foot on the ray, which is
    // exact from afar (Haines, Gunther, Akenine-Moller 2019, Ray Tracing Gems ch. 7), but near the
    // surface, where c vanishes and decides, b^2 - c is.  Comparisons are written so that NaN
    // misses.
    const vec3 f = ray.o - s.a;
    const real b = -dot(f, ray.d), r2 = s.r * s.r;
    const vec3 foot = f + b * ray.d;
    real c = dot(f, f) - r2, discriminant = r2 - dot(foot, foot);
    if (std::abs(c) < r2 / 16) {
        c = power_of_point(ray.o, s);
        discriminant = b * b - c;
    }
    if (!(discriminant >= 0)) return {};
    real q = b + std::copysign(std::sqrt(discriminant), b);
    real near = b >= 0 ? c / q : q;
    real far = b >= 0 ? q : c / q;
    real t = near > 0 ? near : far;
    if (!(t > 0 && t <= tmax)) return {};
    return Hit{t};
    // end
}

// ---- Kinds of shapes --------------------------------------------------------------------------
//
// A kind is a struct with these functions; `ask` chooses it.
//     name                  in messages
//     corners(s)            points about a flat shape, counterclockwise from its front; else none
//     box(s)                its bounds, not padded
//     normal(s)             the unit normal of a flat shape; else 0
//     intersect(s, ray, k, tmax)  where a ray meets it first, 0 < t <= tmax; k is shear(ray.d)
//     surface(s, f, ray, hit)     the point hit, moved onto the shape: exact also far from the eye

// Properties of all points of a shape: the unit normal, if it is flat, and Surface::error.
struct ShapeConstants {
    vec3 n;
    real error = 0;
};

// Twice the area of a triangle, along its normal.
inline vec3 area_vector(const Shape& s) { return cross(s.b - s.a, s.c - s.a); }

struct TriangleShape {
    static constexpr auto name = "triangle";
    static std::array<vec3, 3> corners(const Shape& s) { return {s.a, s.b, s.c}; }
    static Box box(const Shape& s) {
        if (!s.is_triangle()) __builtin_trap();  // `ask` has no case for its kind
        Box box;
        for (vec3 p : corners(s)) box.add(p);
        return box;
    }
    static vec3 normal(const Shape& s) { return unit(area_vector(s)); }
    static constexpr auto intersect = intersect_triangle;
    static Surface surface(const Shape& s, const ShapeConstants& f, const Ray&, const Hit& hit) {
        return {(1 - hit.v - hit.w) * s.a + hit.v * s.b + hit.w * s.c, f.n, f.error};
    }
};

struct SphereShape {
    static constexpr auto name = "sphere";
    static std::array<vec3, 0> corners(const Shape&) { return {}; }
    static Box box(const Shape& s) {
        const vec3 r{s.r, s.r, s.r};
        return {s.a - r, s.a + r};
    }
    static vec3 normal(const Shape&) { return {}; }
    static auto intersect(const Shape& s, const Ray& ray, const Shear&, real tmax) {
        return intersect_sphere(s, ray, tmax);
    }
    // So far away that rounding leaves only the centre, it is the point towards the eye.
    static Surface surface(const Shape& s, const ShapeConstants& f, const Ray& ray,
                           const Hit& hit) {
        vec3 out = ray.o + hit.t * ray.d - s.a;
        vec3 n = out == vec3{} ? -ray.d : unit(out);
        return {s.a + s.r * n, n, f.error};
    }
};

// What a shape's kind answers.
decltype(auto) ask(const Shape& s, auto question) {
    return s.r > 0 ? question(SphereShape()) : question(TriangleShape());
}

// ---- Any shape --------------------------------------------------------------------------------

// Bound of the rounding error of a shape's geometry, as a length: intersectors lose a few ulp of
// the largest coordinate, for a hit anywhere on the shape.  It is proportional to the scene: a
// scene scaled by a power of two gives the same image, bit for bit.
inline real rounding_error(const Shape& s) {
    const Box box = ask(s, [&](auto kind) { return kind.box(s); });
    return 16 * ulp * std::max(max_abs(box.lo), max_abs(box.hi));
}

// Bounds of a shape, padded so that no box starts behind a hit that its shape computes.
inline Box bounds(const Shape& s) {
    const Box box = ask(s, [&](auto kind) { return kind.box(s); });
    const real e = rounding_error(s);
    return {box.lo - vec3{e, e, e}, box.hi + vec3{e, e, e}};
}

inline std::optional<Hit> intersect(const Shape& s, const Ray& ray, const Shear& k, real tmax) {
    return ask(s, [&](auto kind) { return kind.intersect(s, ray, k, tmax); });
}
inline ShapeConstants constants_of(const Shape& s) {
    return {ask(s, [&](auto kind) { return kind.normal(s); }), rounding_error(s)};
}
inline Surface surface(const Shape& s, const ShapeConstants& f, const Ray& ray, const Hit& hit) {
    return ask(s, [&](auto kind) { return kind.surface(s, f, ray, hit); });
}
inline Surface surface(const Shape& s, const Ray& ray, const Hit& hit) {
    return surface(s, constants_of(s), ray, hit);
}

// ---- Where the next ray starts ------------------------------------------------------------------

// The one place that owns the ray offset.  A ray leaves a surface from a point 2 errors off it,
// on the side that d points to; one error is p's, the other the intersector's.
inline vec3 offset(const Surface& x, vec3 towards) {
    return x.p + std::copysign(2 * x.error, dot(x.n, towards)) * x.n;
}

inline Ray spawn(const Surface& x, vec3 d) { return {offset(x, d), d}; }

// The open segment between two surface points, to be asked whether it is occluded.  Seen from afar
// the far end is only as exact as the distance.
inline Ray spawn_to(const Surface& x, Surface y) {
    const vec3 w = y.p - x.p;
    // The sum of the components' sizes is no less than the distance, and takes no root.
    y.error += 16 * ulp * (std::abs(w.x) + std::abs(w.y) + std::abs(w.z));
    const vec3 o = offset(x, w), to = offset(y, -w) - o;
    const real distance = length(to);
    return {o, to * (1 / distance), distance};
}

}  // namespace penumbra

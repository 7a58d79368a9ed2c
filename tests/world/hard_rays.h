// world/hard_rays.h  rays and scenes that are hard for a BVH
#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "world/geometry.h"
#include "world/nearest.h"

using Shapes = std::vector<Shape>;

// Counts rays with different answers, endless ones and those that end at, before or after the hit.
template <class Tree>
struct ComparisonOf {
    const Shapes& shapes;
    Tree tree{shapes};
    int rays = 0, hits = 0, different = 0;

    void judge(Ray ray) {
        const auto expected = nearest(shapes, ray);
        bool equal = agrees(ray, expected);
        if (expected) {
            const real t = expected->t;
            for (real end : {t, std::nextafter(t, real(0)), rays % 2 ? t / 2 : t * 2}) {
                ray.tmax = end;
                equal = equal && agrees(ray, t <= end ? expected : std::nullopt);
            }
        }
        ++rays;
        hits += expected.has_value();
        different += !equal;
    }
    bool agrees(const Ray& ray, const std::optional<Hit>& expected) const {
        return same(tree.closest(ray), expected) && tree.occluded(ray) == expected.has_value();
    }
};

// ---- Rays ---------------------------------------------------------------------------------------

// Returns a corner of a triangle, or a pole of a sphere.
inline vec3 corner(const Shape& s, Dice& random) {
    const size_t i = random.below(3);
    if (s.r == 0) return i == 0 ? s.a : i == 1 ? s.b : s.c;
    vec3 p = s.a;
    p.*axis[i] += random.sign() * s.r;
    return p;
}

// The box of a shape as the BVH stores it.
template <class Tree>
Box stored_box(const Shape& s) {
    return bounds(s);
}

enum Aim {
    anywhere,
    at_edge,
    at_corner,
    beside,
    in_plane,
    near_axis,
    across_axis,
    along_axis,
    aims
};
template <class Tree>
Ray aimed(const Shape& s, int aim, real reach, Dice& random) {
    const vec3 anyhow = random.direction();
    const real distance = reach * random.decades(-1, 1);
    if (aim == anywhere) return {distance * random.direction(), anyhow};
    vec3 target = corner(s, random), d = anyhow;
    const vec3 e = s.b - s.a, f = s.c - s.a;
    if (aim == at_edge && s.r > 0) {  // the ray is tangent
        const vec3 n = random.direction();
        target = s.a + s.r * n, d = unit(cross(n, d));
    } else if (aim == at_edge) {
        const vec3 next = target == s.a ? s.b : target == s.b ? s.c : s.a;
        target += random(0, 1) * (next - target);
    } else if (aim == beside) {
        target = s.a + random(-1, 2) * e + random(-1, 2) * f;
    } else if (aim == in_plane && s.r == 0) {
        target = s.a + random(0, real(0.5)) * e + random(0, real(0.5)) * f;
        d = unit(random(-1, 1) * e + random(-1, 1) * f);
    } else if (aim == near_axis) {
        // In double, the inverse may exceed the range of float.
        const real least = sizeof(real) == 8 && random.below(3) == 0 ? -44 : -8;
        for (auto a : axis) d.*a *= random.decades(least, 0);
        d.*axis[random.below(3)] += random.sign();
        d = unit(d);
    } else if (aim == across_axis || aim == along_axis) {  // zeros of both signs, planes of boxes
        const size_t odd = random.below(3);
        const Box box = stored_box<Tree>(s);
        for (size_t a = 0; a < 3; ++a) {
            if ((a == odd) == (aim == across_axis)) d.*axis[a] = random.sign() * 0;
            if (random.below(2)) target.*axis[a] = (random.below(2) ? box.lo : box.hi).*axis[a];
        }
        d = unit(d);
    }
    if (!is_finite(d)) d = anyhow;  // the triangle has no area
    const vec3 o = target - distance * d;
    // Rounding may have moved o off the line: the ray is aimed again, unless the plane matters.
    const vec3 again = unit(target - o);
    if ((aim < in_plane || aim == near_axis) && is_finite(again)) d = again;
    return {o, d};
}

template <class Tree>
void judge(ComparisonOf<Tree>& c, int rays, real reach, Dice& random) {
    for (int i = 0; i < rays; ++i)
        c.judge(aimed<Tree>(c.shapes[random.below(c.shapes.size())], i % aims, reach, random));
}

// ---- Scenes, about as large as 1 ----------------------------------------------------------------

inline Shape triangle(real edge, Dice& random) {
    const real distance = random(0, 1);  // drawn first, on every compiler
    const vec3 a = distance * random.direction();
    return {a, a + edge * random.direction(), a + edge * random.direction()};
}

inline Shapes soup(int triangles, int spheres, Dice& random) {
    Shapes scene;
    for (int i = 0; i < triangles; ++i) scene.push_back(triangle(random.decades(-2, 0), random));
    for (int i = 0; i < spheres; ++i)
        scene.push_back({random(0, 1) * random.direction(), {}, {}, random.decades(-2, 0)});
    return scene;
}

inline Shapes slivers(int n, Dice& random) {
    Shapes scene;
    for (int i = 0; i < n; ++i) {
        const vec3 a = random(0, 1) * random.direction(), e = random.direction();
        const vec3 f = random(0, 1) * e + random.decades(-11, -2) * random.direction();
        scene.push_back({a, a + e, a + f});
    }
    return scene;
}

inline void add_quad(Shapes& scene, vec3 p, vec3 u, vec3 v) {
    scene.push_back({p, p + u, p + u + v});
    scene.push_back({p, p + u + v, p + v});
}

// Quads of a cubic grid in all three orientations; every fourth is duplicated.
inline Shapes grid(int n) {
    Shapes scene;
    const real step = real(1) / real(n);
    int count = 0;
    for (int a = 0; a < 3; ++a)
        for (int i = 0; i < n * n * n; ++i) {
            vec3 p, u, v;
            p.*axis[0] = real(i % n) * step, p.*axis[1] = real(i / n % n) * step;
            p.*axis[2] = real(i / n / n) * step;
            u.*axis[(a + 1) % 3] = step, v.*axis[(a + 2) % 3] = step;
            for (int twice = 0; twice <= (count++ % 4 == 0); ++twice) add_quad(scene, p, u, v);
        }
    return scene;
}

inline void add_box(Shapes& scene, vec3 p, vec3 size, real cosine, real sine) {
    const vec3 x = size.x * vec3{cosine, 0, sine}, z = size.z * vec3{-sine, 0, cosine};
    const vec3 y{0, size.y, 0};
    for (const auto& [o, u, v] :
         {std::array{p, x, y}, {p, y, z}, {p, z, x}, {p + x, y, z}, {p + y, z, x}, {p + z, x, y}})
        add_quad(scene, o, u, v);
}

// A room with two boxes, a ball, and a lamp in the plane of the ceiling.
inline Shapes room() {
    Shapes scene;
    add_box(scene, {-1, -1, -1}, {2, 2, 2}, 1, 0);
    add_box(scene, {-0.7, -1, -0.5}, {0.6, 1.2, 0.6}, 0.96, 0.28);
    add_box(scene, {0.1, -1, 0}, {0.6, 0.6, 0.6}, 1, 0);
    add_quad(scene, {-0.3, 1, -0.3}, {0.6, 0, 0}, {0, 0, 0.6});
    scene.push_back({{0.4, 0, 0.3}, {}, {}, 0.4});
    return scene;
}

inline Shapes scaled(Shapes shapes, real k) {
    for (Shape& s : shapes) s = scaled(s, k);
    return shapes;
}

inline Shapes many(int n, real edge, Dice& random) {
    Shapes scene;
    for (int i = 0; i < n; ++i) scene.push_back(triangle(edge, random));
    return scene;
}

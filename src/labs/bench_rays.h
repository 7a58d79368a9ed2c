// labs/bench_rays.h  3  scenes to be raced through, and their rays
#pragma once
#include "base/rng.h"
#include "labs/lab.h"
#include "world/scene_file.h"

namespace bench {

// primary: closest hit along jittered camera rays, row by row: neighbours take the same way;
// bounce: closest hit from the primary hits in cosine-weighted directions: no two alike;
// shadow: any hit between the primary hits and random points of a quad.
enum Kind { primary, bounce, shadow };
inline constexpr std::array kinds = {primary, bounce, shadow};

struct Quad {
    vec3 p, u, v;
};

struct Case {
    std::string name;
    std::vector<Shape> shapes;
    Camera camera;
    Quad light;                                 // shadow rays go there
    std::array<std::vector<Ray>, 3> rays = {};  // of each kind
};

// Draws come one after the other: the order of a call's arguments is not specified.
inline vec2 random2(Rng& rng) {
    const real x = to_unit(rng.bits()), y = to_unit(rng.bits());
    return {x, y};
}
inline vec3 random3(Rng& rng) {
    const vec2 xy = random2(rng);
    return {xy.x, xy.y, to_unit(rng.bits())};
}

// Embree knows nothing else.  volatile: the vectoriser of g++ 12 drops a conversion to float and
// back.
inline real to_float(real x) {
    volatile float y = float(x);
    return y;
}
inline vec3 to_float(vec3 a) { return {to_float(a.x), to_float(a.y), to_float(a.z)}; }
inline Ray to_float(const Ray& r) { return {to_float(r.o), to_float(r.d), to_float(r.tmax)}; }

// A point of a surface whose error is that of float, so that no ray meets what it leaves.
inline Surface float_surface(Surface x) {
    x.error *= real(std::numeric_limits<float>::epsilon() / 2) / ulp;
    return x;
}

inline Case with_rays(Case c, int width) {
    for (Shape& s : c.shapes) s = {to_float(s.a), to_float(s.b), to_float(s.c)};
    const Tree tree(c.shapes);
    const vec3 light_normal = unit(cross(c.light.u, c.light.v));
    Rng rng{mix(c.shapes.size())};
    for (int y = 0; y < width; ++y)
        for (int x = 0; x < width; ++x) {
            const vec2 jitter = random2(rng), direction = random2(rng), place = random2(rng);
            const Ray ray = to_float(
                camera_ray(c.camera, {width, width}, real(x) + jitter.x, real(y) + jitter.y));
            c.rays[primary].push_back(ray);
            const auto hit = tree.closest(ray);
            if (!hit) continue;
            Surface from = float_surface(surface(c.shapes[hit->id], ray, *hit));
            if (dot(from.n, ray.d) > 0) from.n = -from.n;
            const vec3 wi = frame(from.n).to_world(sample_cosine_hemisphere(direction));
            c.rays[bounce].push_back(to_float(spawn(from, wi)));
            const vec3 p = c.light.p + sample_quad(place, c.light.u, c.light.v);
            const Surface to{p, light_normal, rounding_error({p, p, p})};
            c.rays[shadow].push_back(to_float(spawn_to(from, float_surface(to))));
        }
    return c;
}

inline Case cornell(int width) {
    const Scene s = read_scene("scenes/cornell36.scene").scene;
    const Light& lamp = s.lights.at(0);
    return with_rays({"cornell36", s.shapes, s.camera, {lamp.p, lamp.u, lamp.v}}, width);
}

// 4^level triangles of the unit sphere for each face of the icosahedron; neighbours share corners.
inline void refine(std::vector<Shape>& out, vec3 a, vec3 b, vec3 c, int level) {
    if (level == 0) return out.push_back({a, b, c});
    const vec3 ab = unit(a + b), bc = unit(b + c), ca = unit(c + a);
    refine(out, a, ab, ca, level - 1);
    refine(out, ab, b, bc, level - 1);
    refine(out, ca, bc, c, level - 1);
    refine(out, ab, bc, ca, level - 1);
}

// The unit sphere in a box of side 4, seen from a corner; the light is a part of the ceiling.
inline Case icosphere(int level, int width) {
    Scene s;
    s.materials.emplace_back();
    add_box(s, {4, 4, 4}, 0, {-2, -2, -2}, 0);
    const real g = std::numbers::phi_v<real>;
    std::vector<vec3> corner;  // (0, +-1, +-g) and its rotations
    for (real y : {real(-1), real(1)})
        for (real z : {-g, g})
            for (vec3 p : {vec3{0, y, z}, vec3{y, z, 0}, vec3{z, 0, y}}) corner.push_back(p);
    auto adjacent = [](vec3 a, vec3 b) { return dot(a - b, a - b) < 5; };  // the edges have 4
    for (size_t i = 0; i < corner.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            for (size_t k = 0; k < j; ++k) {
                const vec3 a = corner[i], b = corner[j], c = corner[k];
                if (adjacent(a, b) && adjacent(b, c) && adjacent(c, a))
                    refine(s.shapes, unit(a), unit(b), unit(c), level);
            }
    const std::string name = text("%zu, icosphere in a box", s.shapes.size());
    const Camera camera = look_at({real(1.7), real(1.2), real(1.9)}, {0, real(-0.1), 0}, 65);
    return with_rays({name, s.shapes, camera, {{-1, real(1.99), -1}, {2, 0, 0}, {0, 0, 2}}}, width);
}

// Corners within n^(-1/3) of a random point of the unit cube: however many, it looks as full.
inline Case soup(int n, int width) {
    const vec3 middle = {real(0.5), real(0.5), real(0.5)};
    Case c{text("%d, random", n),
           {},
           look_at({real(0.5), real(0.5), 2}, middle, 45),
           {{0, real(1.5), 0}, {1, 0, 0}, {0, 0, 1}}};
    const real size = 1 / std::cbrt(real(n));
    Rng rng{uint64_t(n)};
    for (int i = 0; i < n; ++i) {
        const vec3 centre = random3(rng);
        auto corner = [&] { return centre + size * (2 * random3(rng) - vec3{1, 1, 1}); };
        const vec3 p = corner(), q = corner(), r = corner();
        c.shapes.push_back({p, q, r});
    }
    return with_rays(std::move(c), width);
}

}  // namespace bench

// world/scene.h  6  the scene: camera, shapes, materials, lights
#pragma once
#include <vector>

#include "world/bsdf.h"
#include "world/choice.h"
#include "world/tree.h"

namespace penumbra {

// A pinhole; the axes are unit, tan_half is the tangent of half the vertical field of view.
struct Camera {
    vec3 eye, right, up, forward;
    real tan_half = 1;
};

// Right-handed with +y up: looking along -z, +x is right.  fov is vertical, in degrees.
inline Camera look_at(vec3 eye, vec3 target, real fov) {
    vec3 forward = unit(target - eye);
    vec3 right = unit(cross(forward, {0, 1, 0}));
    const vec2 half = unit_circle(fov / 720);
    return {eye, right, cross(right, forward), forward, half.y / half.x};
}

// Through the point (x, y) of the image plane, in pixels from its top left corner.  Pixels are
// square: a wider image sees more, never stretches.
inline Ray camera_ray(const Camera& c, Size size, real x, real y) {
    // exercise 1.1
    real pixel = 2 * c.tan_half / real(size.height);
    vec3 d = c.forward + c.right * ((x - real(size.width) / 2) * pixel) +
             c.up * ((real(size.height) / 2 - y) * pixel);
    return {c.eye, unit(d)};
    // end
}

inline constexpr int32_t no_light = -1;
inline constexpr int max_depth = 1000000;

struct Scene {
    Size size{256, 128};
    Camera camera;
    int depth = 8;          // maximum number of bounces
    uint64_t samples = 64;  // per pixel, unless the user asks for others
    real exposure = 1;      // factor from radiance to PNG

    std::vector<Material> materials;
    std::vector<Shape> shapes;
    std::vector<uint32_t> material_of;  // of each shape
    std::vector<int32_t> light_of;      // of each shape, or no_light
    std::vector<Light> lights;

    int dropped = 0;  // triangles that have no area

    Tree bvh;                               // from here on made by prepare
    std::vector<ShapeConstants> constants;  // of each shape
    LightChoice light_choice;

    const Material& material_at(uint32_t shape) const { return materials[material_of[shape]]; }
    const Material& material(const Hit& hit) const { return material_at(hit.id); }
    Surface surface(const Ray& ray, const Hit& hit) const {
        return penumbra::surface(shapes[hit.id], constants[hit.id], ray, hit);
    }
};

inline void add_shape(Scene& s, const Shape& shape, uint32_t material, int32_t light) {
    s.shapes.push_back(shape);
    s.material_of.push_back(material);
    s.light_of.push_back(light);
}

// Adds the light that an emitting shape is; returns its index, or no_light.
inline int32_t add_light(Scene& s, Light light, uint32_t material, real error) {
    const Material& m = s.materials[material];
    if (!m.emits()) return no_light;
    light.L = m.Le;
    light.twosided = m.twosided;
    light.error = error;
    s.lights.push_back(light);
    return int32_t(s.lights.size()) - 1;
}

inline void add_sphere(Scene& s, vec3 centre, real r, uint32_t material) {
    Shape sphere{centre, {}, {}, r};
    const int32_t light = add_light(s, {centre, SphereLight{r}}, material, rounding_error(sphere));
    add_shape(s, sphere, material, light);
}

// True if a triangle has an area and a normal: their square must neither overflow nor be denormal,
// or both lose digits.
inline bool has_area(const Shape& s) {
    vec3 n = area_vector(s);
    return std::isnormal(dot(n, n));
}

inline void add_triangle(Scene& s, vec3 a, vec3 b, vec3 c, uint32_t material) {
    Shape t{a, b, c};
    if (!has_area(t)) return void(++s.dropped);
    const int32_t light =
        add_light(s, {a, TriangleLight{b - a, c - a}}, material, rounding_error(t));
    add_shape(s, t, material, light);
}

// Parallelogram with corners a, b, c, d: triangles (a, b, c) and (a, c, d), one light; it faces the
// side of (b-a) x (d-a).
inline void add_face(Scene& s, vec3 a, vec3 b, vec3 c, vec3 d, uint32_t material) {
    Shape first{a, b, c}, second{a, c, d};
    if (!has_area(first) || !has_area(second)) return void(s.dropped += 2);
    real error = std::max(rounding_error(first), rounding_error(second));
    int32_t light = add_light(s, {a, QuadLight{b - a, d - a}}, material, error);
    add_shape(s, first, material, light);
    add_shape(s, second, material, light);
}

// Corner p and two edges.
inline void add_quad(Scene& s, vec3 p, vec3 u, vec3 v, uint32_t material) {
    add_face(s, p, p + u, p + u + v, p + v, material);
}

// A light that has no surface; dark, it is none.
inline void add_light(Scene& s, const Light& light) {
    if (!(max_of(light.L) <= 0)) s.lights.push_back(light);
}

}  // namespace penumbra

// radiosity/rooms.h  shared scenes and sums of the tests of illumination maps
#pragma once
#include "base/approx.h"
#include "radiosity/projection.h"
#include "text/scene_file.h"

namespace penumbra::rooms {

inline constexpr SamplerKind all_samplers[] = {SamplerKind::independent, SamplerKind::stratified,
                                               SamplerKind::halton, SamplerKind::sobol};

inline Material diffuse(rgb kd, rgb Le = {}, bool twosided = false) {
    return {Rough(kd), Le, twosided};
}
inline rgb grey(double x) { return {real(x), real(x), real(x)}; }

// Adds a material and returns its index.
inline uint32_t add(Scene& s, const Material& m) {
    s.materials.push_back(m);
    return uint32_t(s.materials.size()) - 1;
}

// The inside of a box between 0 and `size`: its six faces look inwards.  Face k has material first
// + k % several.
inline void add_room(Scene& s, vec3 size, uint32_t first, uint32_t several = 1) {
    vec3 c[8];
    for (int i = 0; i < 8; ++i)
        c[i] = {size.x * real(i & 1), size.y * real(i >> 1 & 1), size.z * real(i >> 2)};
    uint32_t k = 0;
    for (auto [p, q, r, t] : {std::array{0, 1, 3, 2}, std::array{4, 6, 7, 5},   // -z, +z
                              std::array{0, 4, 5, 1}, std::array{2, 3, 7, 6},   // -y, +y
                              std::array{0, 2, 6, 4}, std::array{1, 5, 7, 3}})  // -x, +x
        add_face(s, c[p], c[q], c[r], c[t], first + k++ % several);
}
inline Scene room(vec3 size, const Material& m, vec3 light = {}, rgb intensity = {}) {
    Scene s;
    add_room(s, size, add(s, m));
    add_light(s, {light, PointLight(), intensity});  // none if it is dark
    prepare(s);
    return s;
}

// Walls that glow and reflect: E = pi (2, 2.5, 2), which is in the span of the hats of any mesh.
inline Scene furnace() { return room({2, 3, 1}, diffuse({0.5, 0.2, 0.7}, {1, 2, 0.6})); }

// A coloured room without symmetry: a lamp, a screen that reflects on both sides, a triangle that
// emits on both sides, and a point.  An open room has no last wall.
inline Scene study(bool open = false) {
    Scene s;
    const uint32_t walls = add(s, diffuse({0.7, 0.5, 0.2}));
    add(s, diffuse({0.3, 0.6, 0.6}));
    add_room(s, {3, 2, 2.5}, walls, 2);
    for (int k = 0; k < (open ? 2 : 0); ++k)
        s.shapes.pop_back(), s.material_of.pop_back(), s.light_of.pop_back();
    add_quad(s, {1, 1.9, 1}, {0.5, 0, 0}, {0, 0, 0.7}, add(s, diffuse(grey(0.1), {5, 4, 2})));
    add_quad(s, {2, 0, 1}, {0, 1.2, 0}, {0.3, 0, 0.8}, add(s, diffuse(grey(0.8))));
    add_triangle(s, {0.3, 0.4, 2}, {1, 0.4, 2}, {0.3, 1, 2.2},
                 add(s, diffuse(grey(0.4), grey(1), true)));
    add_light(s, {{0.7, 1.1, 0.6}, PointLight(), {1, 1, 2}});
    prepare(s);
    return s;
}

// Quads that are long, high, skew and tiny, on the axes and off them; also triangles.
inline Scene furniture() {
    Scene s;
    const uint32_t d = add(s, diffuse(grey(0.5)));
    add_room(s, {4, 3, 2}, d);
    add_quad(s, {1, 1, 1}, {0.7, 0.1, 0}, {0, 0, 0.4}, d);
    add_quad(s, {1, 2, 1}, {0.1, 0, 0}, {0, 0.1, 1}, d);
    add_quad(s, {3, 1, 1}, {1, 0, 0.2}, {0.8, 0.6, 0}, d);
    add_quad(s, {2, 1, 0.5}, {-0.4, 0, 0}, {0.3, 0.3, 0}, d);
    add_triangle(s, {1, 1, 0}, {3, 1, 0.3}, {1, 2, 1}, d);
    add_triangle(s, {2, 2, 1}, {2.01, 2, 1}, {2, 2.02, 1}, d);
    prepare(s);
    return s;
}

// Khodulev's theoretical case: see exact.h.
inline Scene cubic_room() {
    Scene s;
    const uint32_t wall = add(s, diffuse(grey(2.0 / 3)));
    add_box(s, {10, 10, 10}, 0, {-5, -5, -5}, wall);
    add_light(s, {{}, PointLight(), grey(50000)});
    prepare(s);
    return s;
}

// A parallelogram a, a + u, a + u + v, a + v with a material of its own.
struct Quad {
    vec3 a, u, v;
    Material material = diffuse(grey(0.5));
};
// A scene with only these, and a point light.
inline Scene scene_of_quads(const std::vector<Quad>& quads, vec3 light = {}, rgb intensity = {}) {
    Scene s;
    for (const Quad& q : quads) add_quad(s, q.a, q.u, q.v, add(s, q.material));
    add_light(s, {light, PointLight(), intensity});
    prepare(s);
    return s;
}
// A scene with only the triangle a, a + u, a + v.
inline Scene one_triangle(vec3 a, vec3 u, vec3 v) {
    Scene s;
    add_triangle(s, a, a + u, a + v, add(s, diffuse(grey(0.5))));
    prepare(s);
    return s;
}

// A scene and its mesh of edges of at most H.
struct Meshed {
    Scene scene;
    Mesh mesh;
    Meshed(Scene s, double H) : scene(std::move(s)), mesh(make_mesh(scene, H)) {}
};

inline vec3 corner_of(const Mesh& mesh, uint32_t element, size_t k) {
    return mesh.at[mesh.corners[element][k]];
}
inline real area_of(const Face& f) { return f.area() / real(f.elements()); }

inline double longest_edge(const Mesh& mesh) {
    double longest = 0;
    for (uint32_t e = 0; e < mesh.elements(); ++e)
        for (size_t k = 0; k < 3; ++k) {
            const vec3 edge = corner_of(mesh, e, k) - corner_of(mesh, e, (k + 1) % 3);
            longest = std::max(longest, double(length(edge)));
        }
    return longest;
}

// The grid points of a face in the meshes' order of vertices; those of mesh.at lie slightly inside.
inline std::vector<vec3> grid_points(const Face& f) {
    std::vector<vec3> points;
    for (uint32_t j = 0; j <= f.rows; ++j)
        for (uint32_t i = 0; i <= (f.quad ? f.columns : f.rows - j); ++i)
            points.push_back(f.a + real(i) / real(f.columns) * (f.b - f.a) +
                             real(j) / real(f.rows) * ((f.quad ? f.d : f.c) - f.a));
    return points;
}

// Returns the face of each element.
inline std::vector<uint32_t> face_of_element(const Mesh& mesh) {
    std::vector<uint32_t> face(mesh.elements());
    for (uint32_t k = 0; k < mesh.faces.size(); ++k)
        for (uint32_t e = 0; e < mesh.faces[k].elements(); ++e) face[mesh.faces[k].element + e] = k;
    return face;
}

// Emitted power per channel (watts; lumen): pi L times the area, 4 pi I for a point.
inline rgb emitted_power(const Scene& s) {
    rgb power;
    for (const Light& l : s.lights)
        power += (l.is_delta() ? 4 * pi : pi / l.pdf_area * (l.twosided ? 2 : 1)) * l.L;
    return power;
}

// The integral of a map over one side of a face.
inline rgb integral(const Mesh& mesh, const IlluminationMap& map, const Face& f, bool back) {
    rgb sum;
    for (uint32_t e = f.element; e < f.element + f.elements(); ++e)
        for (uint32_t v : mesh.corners[e]) sum += map[2 * v + back] * (area_of(f) / 3);
    return sum;
}

// The integral of the squared difference of two maps, over all surfaces and channels.
inline double square(const Mesh& mesh, const IlluminationMap& a, const IlluminationMap& b) {
    double sum = 0;
    for (const Face& f : mesh.faces)
        for (const bool back : {false, true}) {
            Sums x;
            for (uint32_t v = 2 * f.vertex + back; v < 2 * (f.vertex + f.vertices()); v += 2)
                x.push_back(a[v] - b[v]);
            const rgb s = Projection(mesh, f).square(x);
            sum += double(s.x + s.y + s.z);
        }
    return sum;
}

// The squared error of a furnace's map over the square of the right map.
inline double furnace_error2(const Mesh& mesh, const IlluminationMap& map) {
    const IlluminationMap none(map.size());
    IlluminationMap truth = none;
    for (size_t k = 0; k < truth.size(); k += 2) truth[k] = pi * rgb{2, 2.5, 2};
    return square(mesh, map, truth) / square(mesh, truth, none);
}

// The point of a shape at a hit.
inline vec3 point_of(const Scene& s, const Hit& hit) {
    const Shape& t = s.shapes[hit.id];
    return (1 - hit.v - hit.w) * t.a + hit.v * t.b + hit.w * t.c;
}

}  // namespace penumbra::rooms

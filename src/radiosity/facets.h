// radiosity/facets.h  1  conversion of a scene to diffuse triangles
#pragma once
#include <string>

#include "text/scene_file.h"

namespace penumbra {

// ---- Diffuse surfaces only ----------------------------------------------------------------------

// What a material that is not diffuse is; "": it is diffuse.
inline std::string other_than_diffuse(const Material& m) {
    const Rough* rough = m.as<Rough>();
    if (!rough) return m.ask([](const auto& kind) { return kind.name; });
    return max_of(rough->ks) > 0 ? "glossy" : "";
}

// Throws UserError "NAME:LINE: ..." about the first shape that is not diffuse, or neither a
// triangle nor a sphere, or the first light without a surface that is no point.
inline void check_diffuse(const NamedScene& s, const std::string& name) {
    for (size_t i = 0; i < s.shapes.size(); ++i) {
        if (const std::string what = other_than_diffuse(s.material_at(uint32_t(i))); !what.empty())
            throw error_at(name, s.line_of[i],
                           "material " + in_quotes(s.names[s.material_of[i]]) + " is " + what +
                               "; radiosity supports diffuse surfaces only");
        const std::string shape = ask(s.shapes[i], [](auto kind) { return kind.name; });
        if (shape != TriangleShape::name && shape != SphereShape::name)
            throw error_at(name, s.line_of[i], "radiosity supports no " + shape);
    }
    for (size_t k = 0; k < s.lights.size(); ++k)
        if (const Light& l = s.lights[k]; l.is_delta() && !l.as<PointLight>())
            throw error_at(name, s.line_of_light[k],
                           "radiosity supports no " + std::string(name_of(l)) + " light");
}

// The line of the first shape that absorbs nothing of a channel; 0: none.
inline uint32_t line_of_white(const NamedScene& s) {
    for (size_t i = 0; i < s.shapes.size(); ++i)
        if (max_of(s.materials[s.material_of[i]].diffuse()) >= 1) return s.line_of[i];
    return 0;
}

// ---- Spheres ------------------------------------------------------------------------------------

// Longest edge of an icosahedron that is quartered k times.  Its own edges are 1.052 radii; their
// halves grow on projection to the sphere, by 25.9 % in all.
inline double edge_of_facets(real r, int k) { return 1.052 * 1.26 * std::pow(0.5, k) * double(r); }

// Number of quarterings of an icosahedron: until no edge is longer than H, but at least two, and at
// most ten.  The mesh cuts edges that are still too long.
inline int quarterings(real r, double H) {
    int k = 2;
    while (k < 10 && edge_of_facets(r, k) > H) ++k;
    return k;
}
inline double facets_of_sphere(real r, double H) { return 20 * std::pow(4, quarterings(r, H)); }

// The faces of an icosahedron in the unit sphere, their corners counterclockwise from without.
inline std::vector<std::array<vec3, 3>> icosahedron() {
    const real a = 1, b = (1 + std::sqrt(real(5))) / 2;  // corners: (0, +-a, +-b), turned
    auto corner = [&](int k) {
        const real x = k & 1 ? a : -a, y = k & 2 ? b : -b;
        const vec3 of[] = {{0, x, y}, {x, y, 0}, {y, 0, x}};
        return unit(of[k >> 2]);
    };
    std::vector<std::array<vec3, 3>> faces;
    const real near = real(1.1);  // between an edge, 1.05, and what is farther
    for (int i = 0; i < 12; ++i)
        for (int j = i + 1; j < 12; ++j)
            for (int k = j + 1; k < 12; ++k) {
                const vec3 p = corner(i), q = corner(j), r = corner(k);
                if (length(p - q) > near || length(q - r) > near || length(r - p) > near) continue;
                const bool outwards = dot(cross(q - p, r - p), p) > 0;
                faces.push_back({p, outwards ? q : r, outwards ? r : q});
            }
    return faces;
}

// Each triangle becomes four; new corners lie on the sphere.
inline std::vector<std::array<vec3, 3>> quartered(const std::vector<std::array<vec3, 3>>& faces) {
    std::vector<std::array<vec3, 3>> out;
    for (const auto& [a, b, c] : faces) {
        const vec3 ab = unit(a + b), bc = unit(b + c), ca = unit(c + a);
        for (const auto& face : {std::array{a, ab, ca}, std::array{ab, b, bc},
                                 std::array{ca, bc, c}, std::array{ab, bc, ca}})
            out.push_back(face);
    }
    return out;
}

// ---- The scene of facets ------------------------------------------------------------------------

struct Faceted {
    NamedScene scene;
    std::vector<std::string> warnings;  // "LINE: what"
    bool has_balls = false;             // facets stand for spheres: no estimate is unbiased
};

// Copies a shape of `from`, and its light if it is one by itself, to `to`.
inline void add_facet(NamedScene& to, const NamedScene& from, size_t i, const Shape& shape,
                      int32_t light) {
    add_shape(to, shape, from.material_of[i], light);
    to.line_of.push_back(from.line_of[i]);
}

// Those facets of a sphere that are not too small for their place.
inline std::vector<Shape> facets_of(const Shape& sphere, double H) {
    auto faces = icosahedron();
    for (int k = quarterings(sphere.r, H); k > 0; --k) faces = quartered(faces);
    std::vector<Shape> facets;
    for (const auto& [a, b, c] : faces) {
        const Shape facet{sphere.a + sphere.r * a, sphere.a + sphere.r * b,
                          sphere.a + sphere.r * c};
        if (has_area(facet)) facets.push_back(facet);
    }
    return facets;
}

// Area of a sphere's facets, divided by the area of the sphere.
inline double part_of_area(const Shape& sphere, const std::vector<Shape>& facets) {
    double area = 0;
    for (const Shape& facet : facets) area += double(length(area_vector(facet))) / 2;
    return area / (4 * std::numbers::pi * double(sphere.r) * double(sphere.r));
}

// Adds facets of sphere i, with that part of the sphere's area.  The radiance of emitting facets is
// increased, so that their power is the sphere's.
inline void add_facets(NamedScene& to, const NamedScene& from, size_t i,
                       const std::vector<Shape>& facets, double part) {
    const uint32_t material = from.material_of[i];
    if (from.light_of[i] == no_light) {
        for (const Shape& facet : facets) add_facet(to, from, i, facet, no_light);
        return;
    }
    const Light& ball = from.lights[size_t(from.light_of[i])];
    Material bright = from.materials[material];
    bright.Le = ball.L / real(part);
    add_material(to, bright, from.names[material]);
    for (const Shape& facet : facets) {
        Light l{facet.a, TriangleLight{facet.b - facet.a, facet.c - facet.a}, bright.Le};
        l.twosided = ball.twosided, l.error = ball.error;
        add_facet(to, from, i, facet, int32_t(to.lights.size()));
        to.material_of.back() = uint32_t(to.materials.size()) - 1;
        to.lights.push_back(l);
        to.line_of_light.push_back(from.line_of[i]);
    }
}

// The same scene, made of triangles only: a sphere becomes an inscribed icosphere with edges of at
// most H.  Lights keep their power; an icosphere has less area, so its radiance is larger.
inline Faceted faceted(const NamedScene& from, double H) {
    Faceted result{from, {}};
    NamedScene& to = result.scene;
    to.shapes.clear(), to.material_of.clear(), to.light_of.clear(), to.line_of.clear();
    to.lights.clear(), to.line_of_light.clear();
    std::vector<int32_t> light(from.lights.size(), no_light);  // new lights, except for spheres
    for (size_t k = 0; k < from.lights.size(); ++k) {
        if (from.lights[k].as<SphereLight>()) continue;
        light[k] = int32_t(to.lights.size());
        to.lights.push_back(from.lights[k]);
        to.line_of_light.push_back(from.line_of_light[k]);
    }
    for (size_t i = 0; i < from.shapes.size(); ++i) {
        const int32_t own = from.light_of[i];
        if (from.shapes[i].is_triangle()) {
            add_facet(to, from, i, from.shapes[i], own == no_light ? own : light[size_t(own)]);
            continue;
        }
        const std::vector<Shape> facets = facets_of(from.shapes[i], H);
        const double part = part_of_area(from.shapes[i], facets);
        add_facets(to, from, i, facets, part);
        result.has_balls = true;
        char less[32];
        std::snprintf(less, sizeof less, "%.2g", 100 * (1 - part));
        result.warnings.push_back(std::to_string(from.line_of[i]) + ": the sphere becomes " +
                                  std::to_string(facets.size()) + " triangles; their area is " +
                                  less + " % less" +
                                  (own == no_light ? "" : ", and their radiance as much more"));
    }
    if (const uint32_t line = line_of_white(to))
        result.warnings.push_back(std::to_string(line) +
                                  ": reflects all light: in a closed room, paths never end");
    prepare(to);
    return result;
}

// Emitted power in all directions (watts).  A convex body has four times the area that it shows,
// in the mean of all directions (Cauchy 1841).
inline double power(const Light& l) {
    const int sides = l.is_round() ? 4 : l.twosided ? 2 : 1;
    return sides * intensity(l, std::numbers::pi);
}

}  // namespace penumbra

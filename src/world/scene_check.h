// world/scene_check.h  7  what a scene's author may not see: covered lights, points on surfaces,
// rounding
#pragma once
#include <map>
#include <optional>
#include <string>

#include "world/scene.h"

// ---- Lights that something covers ---------------------------------------------------------------

// Shapes of the same key are the same set of points.
using ShapeKey = std::array<std::array<real, 3>, 4>;
inline ShapeKey key_of(const Shape& s) {
    ShapeKey key{
        {{s.a.x, s.a.y, s.a.z}, {s.b.x, s.b.y, s.b.z}, {s.c.x, s.c.y, s.c.z}, {s.r, 0, 0}}};
    std::sort(key.begin(), key.begin() + 3);
    return key;
}

// For each shape of a light the first shape in the same place, which is the one that rays meet.
inline std::map<ShapeKey, uint32_t> first_in_place(const Scene& s) {
    std::map<ShapeKey, uint32_t> first;
    for (uint32_t i = 0; i < s.shapes.size(); ++i)
        if (s.light_of[i] != no_light) first.try_emplace(key_of(s.shapes[i]), i);
    if (first.empty()) return first;
    for (uint32_t i = 0; i < s.shapes.size(); ++i)
        if (const auto found = first.find(key_of(s.shapes[i])); found != first.end())
            found->second = std::min(found->second, i);
    return first;
}

// No ray ever meets a light whose shapes all come after others in the same places; light samples
// must not find it either.  Takes such lights away; returns their lines, each once, and of each
// line that of a cover.
inline std::vector<std::array<uint32_t, 2>> drop_covered_lights(Scene& s) {
    const auto first = first_in_place(s);
    std::vector<int> seen(s.lights.size());        // shapes of each that rays can meet
    std::vector<uint32_t> cover(s.lights.size());  // the line of what covers another
    for (uint32_t i = 0; i < s.shapes.size(); ++i) {
        if (s.light_of[i] == no_light) continue;
        const uint32_t before = first.at(key_of(s.shapes[i]));
        seen[size_t(s.light_of[i])] += before == i;
        if (before < i) cover[size_t(s.light_of[i])] = s.line_of[before];
    }
    std::vector<std::array<uint32_t, 2>> dropped;
    std::vector<int32_t> number(s.lights.size(), no_light);  // from now on
    size_t n = 0;
    for (size_t k = 0; k < s.lights.size(); ++k) {
        const uint32_t line = s.line_of_light[k];
        if (seen[k] == 0 && s.lights[k].kind != Light::Kind::point) {
            if (dropped.empty() || dropped.back()[0] != line) dropped.push_back({line, cover[k]});
            continue;
        }
        s.lights[n] = s.lights[k], s.line_of_light[n] = line;
        number[k] = int32_t(n++);
    }
    s.lights.resize(n), s.line_of_light.resize(n);
    for (int32_t& light : s.light_of)
        if (light != no_light) light = number[size_t(light)];
    return dropped;
}

// ---- Point lights on surfaces -------------------------------------------------------------------

// Whether p lies on the shape but for rounding, so that chance would decide on which side it is: by
// a quarter of what rounding_error allows, which is what the intersectors do lose.
inline bool lies_on(const Shape& s, const Facing& f, vec3 p) {
    const real error = f.error / 4 + 4 * ulp * max_abs(p);
    if (s.is_sphere()) return std::abs(length(p - s.a) - s.r) <= error;
    const vec3 n = f.n, corner[] = {s.a, s.b, s.c};
    if (!(std::abs(dot(n, p - s.a)) <= error)) return false;
    for (size_t k = 0; k < 3; ++k) {
        const vec3 edge = corner[(k + 1) % 3] - corner[k];
        if (dot(cross(edge, p - corner[k]), n) < -error * length(edge)) return false;
    }
    return true;
}

// The first point light that lies on a shape, and the first such shape, by their lines.
struct OnSurface {
    uint32_t line_of_light, line;
};
inline std::optional<OnSurface> light_on_surface(const Scene& s) {
    struct Point {
        vec3 p;
        uint32_t line;
    };
    std::vector<Point> points;  // that might come before those found
    for (size_t k = 0; k < s.lights.size(); ++k)
        if (s.lights[k].kind == Light::Kind::point)
            points.push_back({s.lights[k].p, s.line_of_light[k]});
    std::optional<OnSurface> found;
    for (size_t i = 0; i < s.shapes.size() && !points.empty(); ++i) {
        const Facing f = facing(s.shapes[i]);
        for (size_t k = 0; k < points.size(); ++k)
            if (lies_on(s.shapes[i], f, points[k].p)) {
                found = {points[k].line, s.line_of[i]};
                points.resize(k);
            }
    }
    return found;
}

// ---- Rounding -----------------------------------------------------------------------------------

// Rays start as far from a surface as its rounding demands (see spawn).  Where that is more than a
// hundredth of what lies there, images are wrong by per cents.
struct Coarse {
    real part = 0;                   // of the shape's size that rays start away from surfaces
    uint32_t line = 0, because = 0;  // of the shape; of the one whose rounding it is
};

inline real size_of(const Shape& s) {
    if (s.is_sphere()) return 2 * s.r;
    return std::max({max_abs(s.b - s.a), max_abs(s.c - s.b), max_abs(s.a - s.c)});
}

// Whether the other shape is as near to a sphere's surface, or to a triangle's box, as it is large.
inline bool is_near(const Shape& s, const Shape& other) {
    const real size = size_of(other);
    if (s.is_sphere()) return std::abs(length(other.a - s.a) - s.r) <= size;
    const Box box = bounds(s), there = bounds(other);
    for (auto a : axis)
        if (there.lo.*a > box.hi.*a + size || there.hi.*a < box.lo.*a - size) return false;
    return true;
}

// The worst shape, by its own rounding and by that of the shape that has most.
inline Coarse coarsest(const Scene& s) {
    uint32_t worst = 0;
    for (uint32_t i = 0; i < s.shapes.size(); ++i)
        if (rounding_error(s.shapes[i]) > rounding_error(s.shapes[worst])) worst = i;
    Coarse found;
    for (uint32_t i = 0; i < s.shapes.size(); ++i)
        for (uint32_t by : {i, worst}) {
            const real part = 2 * rounding_error(s.shapes[by]) / size_of(s.shapes[i]);
            if (part > found.part && (by == i || is_near(s.shapes[by], s.shapes[i])))
                found = {part, s.line_of[i], s.line_of[by]};
        }
    return found;
}

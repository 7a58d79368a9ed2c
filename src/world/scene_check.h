// world/scene_check.h  8  hidden problems of a scene: lights in surfaces, points on them, rounding
#pragma once
#include <map>
#include <numeric>

#include "world/scene.h"

// ---- Lights that lie in other surfaces ----------------------------------------------------------

// True if two shapes share more than an edge of one surface, within the bound of spawn.
inline bool share_surface(const Shape& s, const Shape& t) {
    const real e = 2 * (rounding_error(s) + rounding_error(t));
    if (s.is_sphere() || t.is_sphere())
        return s.is_sphere() && t.is_sphere() && length(s.a - t.a) + std::abs(s.r - t.r) <= e;
    const vec3 corners[2][3] = {{s.a, s.b, s.c}, {t.a, t.b, t.c}};
    bool is_in_plane = false;
    for (size_t k : {0, 1}) {
        const auto &own = corners[k], &others = corners[1 - k];
        const vec3 n = unit(cross(own[1] - own[0], own[2] - own[0]));
        auto farthest = [&](vec3 from, vec3 along) {
            return std::max({dot(others[0] - from, along), dot(others[1] - from, along),
                             dot(others[2] - from, along)});
        };
        is_in_plane |= farthest(own[0], n) <= e && farthest(own[0], -n) <= e;
        for (size_t i = 0; i < 3; ++i)
            if (farthest(own[i], unit(cross(n, own[(i + 1) % 3] - own[i]))) <= e) return false;
    }
    return is_in_plane;
}

inline bool overlap(const Box& a, const Box& b) {
    bool meets = true;
    for (auto k : axis) meets = meets && a.lo.*k <= b.hi.*k && b.lo.*k <= a.hi.*k;
    return meets;
}

// For each light, the shapes of other lights or of none that share a surface with it.  Sweeps along
// the axis of the lights' greatest extent.  Throws UserError "NAME: ..." if it would take seconds.
inline std::vector<std::vector<uint32_t>> surfaces_of_lights(const Scene& s,
                                                             const std::string& name) {
    std::vector<Box> box;
    Box lights;
    for (const Shape& shape : s.shapes) {
        if (s.light_of[box.size()] != no_light) lights.add(bounds(shape));
        box.push_back(bounds(shape));
    }
    const vec3 size = lights.hi - lights.lo;
    const auto along = std::ranges::max(axis, {}, [&](auto k) { return size.*k; });
    std::vector<uint32_t> in_order(box.size());
    std::iota(in_order.begin(), in_order.end(), 0u);
    std::ranges::sort(in_order, {}, [&](uint32_t i) { return std::pair(box[i].lo.*along, i); });
    std::vector<std::vector<uint32_t>> found(s.lights.size());
    std::vector<uint32_t> open[2];  // shapes of no light, and of lights, that have not ended yet
    int64_t left = 1 << 28;         // tests of boxes; a test of shapes counts as 32
    for (uint32_t i : in_order) {
        const bool lit = s.light_of[i] != no_light;
        for (size_t kind = lit ? 0 : 1; kind < 2; ++kind) {
            std::erase_if(open[kind],
                          [&](uint32_t j) { return box[j].hi.*along < box[i].lo.*along; });
            left -= int64_t(open[kind].size());
            if (left < 0) throw UserError(name + ": too many shapes where lights are");
            for (uint32_t j : open[kind]) {
                if (s.light_of[i] == s.light_of[j] || !overlap(box[i], box[j])) continue;
                left -= 32;
                if (!share_surface(s.shapes[i], s.shapes[j])) continue;
                if (lit) found[size_t(s.light_of[i])].push_back(j);
                if (kind == 1) found[size_t(s.light_of[j])].push_back(i);
            }
        }
        open[lit].push_back(i);
    }
    return found;
}

// Moved along a normal; a sphere, which has none, grows.
inline Light lifted(Light l, real by) {
    l.p += by * l.n;
    if (l.r > 0) l.r = std::max(l.r / 2, l.r + by);
    return l;
}
inline Shape lifted(Shape s, vec3 n, real by) {
    s.a += by * n, s.b += by * n, s.c += by * n;
    if (s.r > 0) s.r = std::max(s.r / 2, s.r + by);
    return s;
}

// Moves each light that lies in another surface in front of it, by more than the error of spawn_to.
// Of two lights in one place the first is in front.  A two-sided light is doubled, with a copy on
// either side.  Returns the lines of these lights, each once, and the line of a surface that each
// lies in.
inline std::vector<std::array<uint32_t, 2>> lift_lights(Scene& s, const std::string& name) {
    const auto in = surfaces_of_lights(s, name);
    real size = max_abs(s.camera.eye);
    for (const Shape& shape : s.shapes) size = std::max(size, rounding_error(shape) / (16 * ulp));
    const real step = 512 * ulp * size;
    std::vector<std::array<uint32_t, 2>> lines;
    std::vector<real> by(in.size());  // last first: a light is above all later ones in its place
    std::vector<int32_t> back(in.size(), no_light);
    for (size_t k = in.size(); k-- > 0;) {
        for (uint32_t i : in[k]) {
            const int32_t other = s.light_of[i];
            by[k] = std::max(by[k], (other > int32_t(k) ? by[size_t(other)] : 0) + step);
            const std::array<uint32_t, 2> line{s.line_of_light[k], s.line_of[i]};
            if (other < int32_t(k) && (lines.empty() || lines.back()[0] != line[0]))
                lines.push_back(line);
        }
        if (by[k] > 0 && s.lights[k].twosided) {
            back[k] = int32_t(s.lights.size());
            s.lights.push_back(lifted(s.lights[k], -by[k]));
            s.line_of_light.push_back(s.line_of_light[k]);
        }
    }
    for (size_t i = 0, n = s.shapes.size(); i < n; ++i) {
        if (s.light_of[i] == no_light) continue;
        const size_t k = size_t(s.light_of[i]);
        const Shape shape = s.shapes[i];
        s.shapes[i] = lifted(shape, s.lights[k].n, by[k]);
        if (back[k] == no_light) continue;
        add_shape(s, lifted(shape, s.lights[k].n, -by[k]), s.material_of[i], back[k]);
        s.line_of.push_back(s.line_of[i]);
    }
    for (size_t k = 0; k < in.size(); ++k) s.lights[k] = lifted(s.lights[k], by[k]);
    std::ranges::reverse(lines);
    return lines;
}

// ---- Points on surfaces, rounding ---------------------------------------------------------------

// True if p lies on the shape within rounding, so that its side would be arbitrary.  The bound is a
// quarter of rounding_error, the error that the intersectors actually make.
inline bool lies_on(const Shape& s, const Facing& f, vec3 p) {
    const real error = f.error / 4 + 4 * ulp * max_abs(p);
    const vec3 n = s.is_sphere() ? unit(p - s.a) : f.n;
    const Ray through{p - error * n, n, 2 * error};
    return intersect(s, through, shear(n), through.tmax).has_value();
}

// Rays start two errors off a surface (see spawn).  If that is more than a hundredth of a shape, or
// of its distance to the eye, a light or another shape, images are wrong by several percent.
inline bool is_coarse(const Shape& s) {
    const Box box = bounds(s);
    return 200 * rounding_error(s) > max_abs(box.hi - box.lo);
}

// The first shape too near to the middle of x, which is shape `own` or a point: both ways along the
// normal of a triangle, else along the axes.  A shape within four errors of a triangle touches it.
inline std::optional<Hit> near_hit(const Scene& s, Shape x, Facing f, uint32_t own, real reach) {
    const vec3 middle = x.is_sphere() ? x.a : (x.a + x.b + x.c) / 3;
    for (size_t k = 0; k < (f.n == vec3{} ? 12 : 2); ++k) {
        vec3 d = k & 1 ? -f.n : f.n;
        if (f.n == vec3{}) d.*axis[k / 4] = k & 1 ? -1 : 1;
        const vec3 o = middle + ((k & 2 ? x.r : 0) + 4 * f.error) * d;
        const auto hit = s.bvh.closest({o, d, reach});
        const real error = hit ? std::max(f.error, s.facing[hit->id].error) : 0;
        if (hit && hit->id != own && length(o + hit->t * d - middle) < 200 * error) return hit;
    }
    return {};
}

// Lengths that are too short, one of each kind, with the line of a shape.  Pairs are searched at no
// more than 2048 shapes: the first of each line, and others; without lights if some were lifted.
inline std::map<std::string, uint32_t> coarse_lengths(const Scene& s, bool lifted) {
    std::map<std::string, uint32_t> found;
    const real reach = 200 * std::ranges::max(s.facing, {}, &Facing::error).error;
    auto look_about = [&](vec3 p, const char* what) {
        if (const auto hit = near_hit(s, {p, p, p}, {}, UINT32_MAX, reach))
            found.emplace(what, s.line_of[hit->id]);
    };
    look_about(s.camera.eye, "distance to the eye");
    for (const Light& l : s.lights)
        if (l.kind == Light::Kind::point) look_about(l.p, "distance to a point light");
    for (uint32_t i = 0, firsts = 0, pairs = 0; i < s.shapes.size(); ++i) {
        if (is_coarse(s.shapes[i])) found.emplace("size", s.line_of[i]);
        const bool first = i == 0 || s.line_of[i] != s.line_of[i - 1];
        if (i % (1 + s.shapes.size() / 1024) > 0 && !(first && firsts++ < 1024)) continue;
        const auto hit = pairs ? std::nullopt : near_hit(s, s.shapes[i], s.facing[i], i, reach);
        if (!hit || (lifted && std::max(s.light_of[i], s.light_of[hit->id]) >= 0)) continue;
        found.emplace("distance to line " + std::to_string(s.line_of[hit->id]), s.line_of[i]);
        ++pairs;
    }
    return found;
}

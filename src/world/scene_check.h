// world/scene_check.h  8  what an author may not see: lights in surfaces, points on them, rounding
#pragma once
#include <numeric>
#include <span>

#include "world/scene.h"

// ---- Lights that lie in other surfaces ----------------------------------------------------------

// Whether two shapes have more than an edge of one surface in common, by the bound of spawn.
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

// For each light the shapes, of others or of none, in whose surface it lies; by a sweep along the
// axis on which lights spread most.  Throws UserError by the scene's name if it would take seconds.
inline std::vector<std::vector<uint32_t>> surfaces_of_lights(const Scene& s,
                                                             const std::string& name) {
    std::vector<Box> box;
    Box lights;
    for (const Shape& shape : s.shapes) {
        if (s.light_of[box.size()] != no_light) lights.add(bounds(shape));
        box.push_back(bounds(shape));
    }
    const vec3 size = lights.hi - lights.lo;
    const auto along = size.x == max_of(size)   ? &vec3::x
                       : size.y == max_of(size) ? &vec3::y
                                                : &vec3::z;
    std::vector<uint32_t> in_order(box.size());
    std::iota(in_order.begin(), in_order.end(), 0u);
    std::ranges::sort(in_order, {}, [&](uint32_t i) { return std::pair(box[i].lo.*along, i); });
    std::vector<std::vector<uint32_t>> found(s.lights.size());
    std::vector<uint32_t> open[2];  // shapes of no light, and of lights, that have not ended yet
    int64_t left = 1 << 28;         // looks at boxes; one at shapes counts as 32
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

// A light that lies in another surface shines as if it were in front of it, on its emitting side or
// on both; of two lights in one place the first one does.  So each is lifted, by more than spawn_to
// may miss; one of two sides stands on either side.  Returns the lines of these lights, each once,
// and of a surface that each lies in.
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

// Whether p lies on the shape but for rounding, so that chance would decide on which side it is: by
// a quarter of what rounding_error allows, which is what the intersectors do lose.
inline bool lies_on(const Shape& s, const Facing& f, vec3 p) {
    const real error = f.error / 4 + 4 * ulp * max_abs(p);
    const vec3 n = s.is_sphere() ? unit(p - s.a) : f.n;
    const Ray through{p - error * n, n, 2 * error};
    return intersect(s, through, shear(n), through.tmax).has_value();
}

// Rays start two errors off a surface (see spawn).  Where that is more than a hundredth of a shape,
// images are wrong by per cents.
inline bool is_coarse(const Shape& s) {
    const Box box = bounds(s);
    return 200 * rounding_error(s) > max_abs(box.hi - box.lo);
}

// labs/textbook.h  3  a minimal path tracer as in textbooks, the baseline for speed
//
// All surfaces are diffuse quadrilaterals, tested in a loop.  One is the light.  Samples are
// independent.  Uses cosine-weighted directions and next-event estimation, no MIS and no roulette.
#pragma once
#include "base/program.h"
#include "base/rng.h"
#include "film/image.h"
#include "world/scene.h"

namespace textbook {

// A parallelogram p + a u + b v: a = dot(x, du) - a0, b = dot(x, dv) - b0 for x in its plane.
struct Quad {
    vec3 p, u, v, du, dv;
    Frame frame;  // z is the normal
    real plane, a0, b0, area;
    rgb albedo, Le;
};

struct Room {
    std::vector<Quad> quads;
    size_t light = 0;
    uint64_t rays = 0;  // traced so far
};

inline Quad quad_of(vec3 p, vec3 u, vec3 v, const Material& m) {
    const vec3 n = cross(u, v), w = n / dot(n, n), du = cross(v, w), dv = cross(w, u);
    const Frame f = frame(unit(n));
    return {p, u, v, du, dv, f, dot(f.n, p), dot(p, du), dot(p, dv), length(n), m.kd, m.Le};
}

// The room of a scene with triangles in pairs (a, b, c), (a, c, d), as `quad` and `box` make them.
inline Room room_of(const Scene& scene) {
    Room room;
    for (size_t i = 0; i + 1 < scene.shapes.size(); i += 2) {
        const Shape &s = scene.shapes[i], &t = scene.shapes[i + 1];
        const Material& m = scene.materials[scene.material_of[i]];
        const bool pair = !s.is_sphere() && s.a == t.a && s.c == t.b;
        if (!pair || m.is_delta() || max_of(m.ks) > 0 || scene.lights.size() != 1)
            throw UserError("the textbook tracer knows but diffuse quadrangles");
        if (m.emits()) room.light = room.quads.size();
        room.quads.push_back(quad_of(s.a, s.b - s.a, t.c - t.a, m));
    }
    return room;
}

// ---- The tracer ---------------------------------------------------------------------------------

// Distance to a quad along o + t d, or 0 if the ray misses it.  Combines all comparisons without
// branches, because the processor would mispredict these too often.
inline real meet(const Quad& q, vec3 o, vec3 d, real tmax) {
    const real t = (q.plane - dot(q.frame.n, o)) / dot(q.frame.n, d);
    const vec3 x = o + t * d;
    const real a = dot(x, q.du) - q.a0, b = dot(x, q.dv) - q.b0;
    const bool inside = (t > 0) & (t < tmax) & (a >= 0) & (a <= 1) & (b >= 0) & (b <= 1);
    return inside ? t : 0;
}

// True if another quad lies between two points of quads.  No ray hits the quad that it leaves.
inline bool between(Room& room, const Quad* from, vec3 x, const Quad* to, vec3 y) {
    ++room.rays;
    for (const Quad& q : room.quads)
        if (&q != from && &q != to && meet(q, x, y - x, 1) > 0) return true;
    return false;
}

inline vec2 draw2(Rng& random) {
    const real x = to_unit(random.bits()), y = to_unit(random.bits());
    return {x, y};
}

inline rgb radiance(Room& room, vec3 o, vec3 d, int depth, Rng& random) {
    const Quad& light = room.quads[room.light];
    rgb L, beta{1, 1, 1};
    const Quad* from = nullptr;
    for (int k = 0;; ++k) {
        const Quad* hit = nullptr;
        real t = infinity;
        ++room.rays;
        for (const Quad& q : room.quads)
            if (const real here = &q == from ? 0 : meet(q, o, d, t); here > 0) t = here, hit = &q;
        if (!hit) return L;
        const real side = dot(hit->frame.n, d) < 0 ? 1 : -1;
        if (k == 0 && side > 0) L += hit->Le;
        beta *= hit->albedo;
        if (k == depth || max_of(beta) <= 0) return L;
        const vec3 x = o + t * d;

        const vec2 u = draw2(random);
        const vec3 y = light.p + u.x * light.u + u.y * light.v, w = y - x;
        const real cos_x = side * dot(hit->frame.n, w), cos_y = -dot(light.frame.n, w);
        const real d2 = dot(w, w);  // both cosines have a factor sqrt(d2)
        if (cos_x > 0 && cos_y > 0 && !between(room, hit, x, &light, y))
            L += beta * light.Le * (cos_x * cos_y * light.area / (pi * d2 * d2));

        const vec3 wi = sample_cosine_hemisphere(draw2(random));
        d = hit->frame.to_world({wi.x, wi.y, side * wi.z});
        o = x;
        from = hit;
    }
}

// Renders row y of the image.  Each pixel is the mean of spp samples.
inline void render_row(Room& room, const Scene& s, uint64_t seed, uint64_t spp, int y, Image& out) {
    for (int x = 0; x < s.size.width; ++x) {
        Rng random{hash(hash(seed, uint64_t(y)), uint64_t(x))};
        rgb sum;
        for (uint64_t i = 0; i < spp; ++i) {
            const vec2 u = draw2(random);
            const Ray ray = camera_ray(s.camera, s.size, real(x) + u.x, real(y) + u.y);
            sum += radiance(room, ray.o, ray.d, s.depth, random);
        }
        for (size_t c = 0; c < 3; ++c) out.at(x, y)[c] = float(sum.*axis[c] / real(spp));
    }
}

}  // namespace textbook

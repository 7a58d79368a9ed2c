// labs/textbook.h  4  a student's first path tracer, to be raced against ours
#pragma once
#include "base/rng.h"
#include "labs/lab.h"
#include "world/scene_file.h"

// What courses and one-weekend books teach, in double, written for speed but for nothing else:
// diffuse triangles, one lamp, light samples at every vertex (no MIS, no roulette), numbers from a
// stream, a binary tree split at the median, triangles by Moeller and Trumbore (1997, JGT 2(1)), a
// ray offset of 1e-4.  It is right on cornell36, and nobody asks it for more: no watertightness,
// no bound of an error, no other material, no replay of a sample.
namespace textbook {

struct Random {
    uint64_t state;
    real operator()() {  // xorshift64* (Marsaglia 2003; Vigna 2016)
        state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
        return to_unit(state * 0x2545f4914f6cdd1du);
    }
};

inline vec3 plain_cross(vec3 a, vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline vec3 plain_unit(vec3 a) { return a * (1 / length(a)); }

struct Triangle {
    vec3 a, ab, ac, n;
    rgb albedo, Le;
};
struct Node {
    Box box;
    uint32_t first, count;  // triangles of a leaf
    uint32_t right = 0;     // child; the left one follows its parent
};

class Tracer {
public:
    uint64_t rays = 0;

    explicit Tracer(const Scene& s) : lamp_(s.lights.at(0)), depth_(s.depth) {
        for (size_t i = 0; i < s.shapes.size(); ++i) {
            const Shape& t = s.shapes[i];
            const Material& m = s.materials[s.material_of[i]];
            triangles_.push_back(
                {t.a, t.b - t.a, t.c - t.a, plain_unit(area_vector(t)), m.kd, m.Le});
        }
        divide(0, uint32_t(triangles_.size()));
        const vec3 area = plain_cross(lamp_.u, lamp_.v);
        lamp_n_ = plain_unit(area);
        lamp_area_ = length(area);
    }

    rgb radiance(vec3 o, vec3 d, Random& random) {
        rgb L, beta{1, 1, 1};
        for (int k = 0;; ++k) {
            real t = infinity;
            const Triangle* hit = find<false>(o, d, t);
            if (!hit) return L;
            const vec3 n = dot(hit->n, d) < 0 ? hit->n : -hit->n;
            if (k == 0 && dot(hit->n, d) < 0) L += hit->Le;  // later the light samples have it
            if (k == depth_) return L;
            const vec3 p = o + t * d + real(1e-4) * n;
            beta *= hit->albedo;
            if (max_of(beta) == 0) return L;
            L += beta * direct(p, n, random);
            d = scattered(n, random);
            o = p;
        }
    }

private:
    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
    Light lamp_;
    vec3 lamp_n_;
    real lamp_area_ = 0;
    int depth_;

    // Irradiance over pi by a uniform point of the lamp.
    rgb direct(vec3 p, vec3 n, Random& random) {
        const real u = random(), v = random();
        vec3 w = lamp_.p + u * lamp_.u + v * lamp_.v - p;
        const real d2 = dot(w, w), distance = std::sqrt(d2);
        w = w * (1 / distance);
        const real cos_x = dot(n, w), cos_y = -dot(lamp_n_, w);
        real t = distance * (1 - real(1e-6));
        if (cos_x <= 0 || cos_y <= 0 || find<true>(p, w, t)) return {};
        return lamp_.L * (cos_x * cos_y * lamp_area_ / (pi * d2));
    }

    // Cosine-weighted about n.
    static vec3 scattered(vec3 n, Random& random) {
        const real u = random(), phi = 2 * pi * random(), r = std::sqrt(u);
        const vec3 other = std::abs(n.x) > real(0.5) ? vec3{0, 1, 0} : vec3{1, 0, 0};
        const vec3 s = plain_unit(plain_cross(other, n)), t = plain_cross(n, s);
        return r * std::cos(phi) * s + r * std::sin(phi) * t + std::sqrt(1 - u) * n;
    }

    // The nearest triangle before t, which becomes its distance, or any one.
    template <bool any>
    const Triangle* find(vec3 o, vec3 d, real& t) {
        ++rays;
        const vec3 inverse{1 / d.x, 1 / d.y, 1 / d.z};
        const Triangle* hit = nullptr;
        uint32_t stack[64], top = 0;
        if (enter(nodes_[0].box, o, inverse, t) < infinity) stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[stack[--top]];
            for (uint32_t i = node.first; i < node.first + node.count; ++i)
                if (meets(triangles_[i], o, d, t)) {
                    hit = &triangles_[i];
                    if (any) return hit;
                }
            if (node.count > 0) continue;
            uint32_t near = uint32_t(&node - nodes_.data()) + 1, far = node.right;
            real t_near = enter(nodes_[near].box, o, inverse, t);
            real t_far = enter(nodes_[far].box, o, inverse, t);
            if (t_far < t_near) std::swap(near, far), std::swap(t_near, t_far);
            if (t_far < infinity) stack[top++] = far;
            if (t_near < infinity) stack[top++] = near;
        }
        return hit;
    }

    static real enter(const Box& b, vec3 o, vec3 inverse, real t) {
        const vec3 lo = (b.lo - o) * inverse, hi = (b.hi - o) * inverse;
        const real in =
            std::max({std::min(lo.x, hi.x), std::min(lo.y, hi.y), std::min(lo.z, hi.z), real(0)});
        const real out =
            std::min({std::max(lo.x, hi.x), std::max(lo.y, hi.y), std::max(lo.z, hi.z), t});
        return in <= out ? in : infinity;
    }

    static bool meets(const Triangle& s, vec3 o, vec3 d, real& t) {
        const vec3 p = plain_cross(d, s.ac), f = o - s.a;
        const real inverse = 1 / dot(s.ab, p), v = dot(f, p) * inverse;
        if (v < 0 || v > 1) return false;
        const vec3 q = plain_cross(f, s.ab);
        const real w = dot(d, q) * inverse, distance = dot(s.ac, q) * inverse;
        if (w < 0 || v + w > 1 || !(distance > 0 && distance < t)) return false;
        t = distance;
        return true;
    }

    // At the plane of least surface area times triangles (the SAH), swept over all of them.
    void divide(uint32_t first, uint32_t count) {
        const auto begin = triangles_.begin() + first;
        Box all;
        for (uint32_t i = 0; i < count; ++i) all.add(box(begin[i]));
        const size_t index = nodes_.size();
        nodes_.push_back({all, first, count});
        real least = all.half_area() * real(count - 1);
        uint32_t left = 0;
        int along = 0;
        for (int a = 0; a < 3; ++a) {
            sort(first, count, a);
            std::vector<real> above(count);
            Box sum;
            for (uint32_t i = count - 1; i > 0; --i) {
                sum.add(box(begin[i]));
                above[i] = sum.half_area() * real(count - i);
            }
            sum = {};
            for (uint32_t i = 1; i < count; ++i) {
                sum.add(box(begin[i - 1]));
                const real cost = sum.half_area() * real(i) + above[i];
                if (cost < least) least = cost, left = i, along = a;
            }
        }
        if (left == 0) return;
        sort(first, count, along);
        nodes_[index].count = 0;
        divide(first, left);
        nodes_[index].right = uint32_t(nodes_.size());
        divide(first + left, count - left);
    }

    static Box box(const Triangle& t) {
        Box b;
        for (vec3 corner : {t.a, t.a + t.ab, t.a + t.ac}) b.add(corner);
        return b;
    }
    void sort(uint32_t first, uint32_t count, int a) {
        const auto begin = triangles_.begin() + first;
        auto centre = [a](const Triangle& t) { return (3 * t.a + t.ab + t.ac).*axis[a]; };
        std::sort(begin, begin + count, [&](auto& s, auto& t) { return centre(s) < centre(t); });
    }
};

}  // namespace textbook

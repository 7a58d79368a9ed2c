// wide/leaf.h  3  shapes in the order of the leaves; a ray is intersected with a leaf at a time
//
// Triangles lie in rows, and several are intersected at once.  Shapes of other kinds lie one by
// one.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "wide/node.h"

namespace penumbra::wide {

// Hits of a ray with some triangles: t and, times det, v and w, in the lanes of hit.
struct Meeting {
    Lanes hit;
    Reals t, v, w, det;
};

// Some of a leaf's triangles, from at on, as many as there are lanes.  Its numbers lie in rows: a.x
// of each of count, a.y of each and so on.
struct Rows {
    const real* numbers;
    size_t count, at;
};

// intersect_triangle, line by line, for several triangles.  Lanes beyond the last triangle hold
// whatever follows the row, and are ignored.
// Inlined: a call passes the vectors through memory.
[[gnu::always_inline]] inline Meeting intersect_triangles(const Rows& rows, const Ray& ray,
                                                          const Shear& k, real tmax) {
    const real ox = ray.o.*axis[k.x], oy = ray.o.*axis[k.y], oz = ray.o.*axis[k.z];
    const size_t count = rows.count;
    const real* first = rows.numbers + rows.at;
    const real *x = first + k.x * count, *y = first + k.y * count, *z = first + k.z * count;
    const size_t to_b = 3 * count, to_c = 6 * count;
    const Reals az = load(z) - oz, bz = load(z + to_b) - oz, cz = load(z + to_c) - oz;
    const Reals ax = (load(x) - ox) - k.sx * az, ay = (load(y) - oy) - k.sy * az;
    const Reals bx = (load(x + to_b) - ox) - k.sx * bz, by = (load(y + to_b) - oy) - k.sy * bz;
    const Reals cx = (load(x + to_c) - ox) - k.sx * cz, cy = (load(y + to_c) - oy) - k.sy * cz;
    const Reals u = difference_of_products(cx, by, cy, bx);
    const Reals v = difference_of_products(ax, cy, ay, cx);
    const Reals w = difference_of_products(bx, ay, by, ax);
    const Reals det = u + v + w;
    // Where det is 0 or a NaN is about, t is NaN.
    const auto inside = (smaller(smaller(u, v), w) >= 0) | (larger(larger(u, v), w) <= 0);
    Meeting met{Lanes(inside), {}, v, w, det};
    met.hit.keep(count - rows.at);
    if (!met.hit.any()) return met;
    met.t = (u * az + v * bz + w * cz) * k.sz / det;
    met.hit = Lanes(inside & (met.t > 0) & (met.t <= tmax));
    met.hit.keep(count - rows.at);
    return met;
}

class Leaves {
public:
    static constexpr uint32_t largest = lane_count;  // shapes in a leaf

    void reserve(size_t shapes) {
        ids_.reserve(shapes);
        numbers_.reserve(shapes * numbers + lane_count);
    }

    // Adds a leaf of these shapes, 1 to 8.
    Child add(const std::vector<Shape>& shapes, std::span<const uint32_t> ids) {
        const size_t n = ids.size();
        if (!shapes[ids[0]].is_triangle()) {
            for (uint32_t id : ids) others_.push_back({shapes[id], id});
            return Child::leaf(uint32_t(others_.size() - n), uint32_t(n), true);
        }
        const Child leaf = Child::leaf(uint32_t(ids_.size()), uint32_t(n), false);
        ids_.insert(ids_.end(), ids.begin(), ids.end());
        std::array<real, numbers * largest> rows{};
        for (size_t i = 0; i < n; ++i) {
            const Shape& shape = shapes[ids[i]];
            real* row = &rows[i];
            for (vec3 p : {shape.a, shape.b, shape.c})
                for (auto k : axis) *row = p.*k, row += n;
        }
        numbers_.insert(numbers_.end(), rows.begin(), rows.begin() + ptrdiff_t(numbers * n));
        return leaf;
    }
    // The last row is read beyond its end.
    void finish() { numbers_.resize(numbers_.size() + lane_count); }

    // The nearest hit of best and of a leaf's; of equals the one with the smallest index.
    [[gnu::always_inline]] Hit nearest(Child leaf, const Ray& ray, const Shear& k, Hit best) const {
        if (leaf.others()) [[unlikely]]
            return nearest_other(leaf, ray, best);
        Rows rows{&numbers_[leaf.first() * numbers], leaf.count(), 0};
        do {
            Meeting met = intersect_triangles(rows, ray, k, best.t);
            for (; met.hit.any(); met.hit.drop_first()) {
                const size_t i = met.hit.first();
                const uint32_t id = ids_[leaf.first() + rows.at + i];
                if (met.t[i] < best.t || (met.t[i] == best.t && id < best.id))
                    best = {met.t[i], id, met.v[i] / met.det[i], met.w[i] / met.det[i]};
            }
        } while (has_more(rows));
        return best;
    }

    bool any(Child leaf, const Ray& ray, const Shear& k) const {
        if (leaf.others()) [[unlikely]]
            return any_other(leaf, ray);
        Rows rows{&numbers_[leaf.first() * numbers], leaf.count(), 0};
        do {
            if (intersect_triangles(rows, ray, k, ray.tmax).hit.any()) return true;
        } while (has_more(rows));
        return false;
    }

    size_t bytes() const {
        return numbers_.capacity() * sizeof(real) + ids_.capacity() * sizeof(uint32_t) +
               others_.capacity() * sizeof(Other);
    }

private:
    struct Other {
        Shape shape;
        uint32_t id;
    };
    static constexpr size_t numbers = 9;  // of a triangle
    std::vector<real> numbers_;
    std::vector<uint32_t> ids_;  // indices of triangles
    std::vector<Other> others_;

    // Moves on to the next lanes.
    static bool has_more(Rows& rows) {
        return real_lanes < largest && (rows.at += real_lanes) < rows.count;
    }
    static std::optional<Hit> met(const Shape& s, const Ray& ray, real tmax) {
        return ask(s, [&](auto kind) { return kind.intersect(s, ray, shear(ray.d), tmax); });
    }
    // Apart, so that a scene of triangles pays nothing for them.
    [[gnu::noinline]] Hit nearest_other(Child leaf, const Ray& ray, Hit best) const {
        for (uint32_t i = leaf.first(); i < leaf.first() + leaf.count(); ++i) {
            const auto& [shape, id] = others_[i];
            const auto hit = met(shape, ray, best.t);
            if (!hit || (hit->t == best.t && id >= best.id)) continue;
            best = *hit;
            best.id = id;
        }
        return best;
    }
    [[gnu::noinline]] bool any_other(Child leaf, const Ray& ray) const {
        for (uint32_t i = leaf.first(); i < leaf.first() + leaf.count(); ++i)
            if (met(others_[i].shape, ray, ray.tmax)) return true;
        return false;
    }
};

}  // namespace penumbra::wide

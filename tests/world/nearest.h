// world/nearest.h  the nearest hit by a loop over all shapes: the reference for BVHs
#pragma once
#include <optional>
#include <vector>

#include "world/shapes.h"

namespace penumbra {

// Of equally near hits it returns the first.
inline std::optional<Hit> nearest(const std::vector<Shape>& shapes, const Ray& ray) {
    const Shear k = shear(ray.d);
    std::optional<Hit> best;
    for (uint32_t i = 0; i < shapes.size(); ++i) {
        const auto hit = intersect(shapes[i], ray, k, ray.tmax);
        if (!hit || (best && hit->t >= best->t)) continue;
        best = hit;
        best->id = i;
    }
    return best;
}

inline bool same(const std::optional<Hit>& a, const std::optional<Hit>& b) {
    if (!a || !b) return !a && !b;
    return a->t == b->t && a->id == b->id && a->v == b->v && a->w == b->w;
}

}  // namespace penumbra

using namespace penumbra;

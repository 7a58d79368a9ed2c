// mesh/ears.h  1  polygons cut into triangles
#pragma once
#include <array>
#include <numeric>
#include <optional>
#include <vector>

#include "base/vec.h"

namespace penumbra::mesh {

using Corners = std::vector<vec3>;                // corners of a polygon
using Cuts = std::vector<std::array<size_t, 3>>;  // of a polygon: indices of its corners

// Twice the area of a polygon, along its normal: the sum over a fan from its first corner.
inline vec3 area_vector(const Corners& c) {
    vec3 sum;
    for (size_t i = 1; i + 1 < c.size(); ++i) sum += cross(c[i] - c[0], c[i + 1] - c[0]);
    return sum;
}

inline Cuts fan_of(const Corners& c) {
    Cuts fan;
    for (size_t i = 1; i + 1 < c.size(); ++i) fan.push_back({0, i, i + 1});
    return fan;
}

inline vec3 area_vector(const Corners& c, const std::array<size_t, 3>& t) {
    return cross(c[t[1]] - c[t[0]], c[t[2]] - c[t[0]]);
}

// True if all triangles have an area on the side of the polygon.
inline bool face_one_way(const Corners& c, const Cuts& triangles) {
    const vec3 normal = area_vector(c);
    return std::ranges::all_of(triangles,
                               [&](const auto& t) { return dot(area_vector(c, t), normal) > 0; });
}

// True if a triangle has more than a thousandth of the polygon's area on its other side; less may
// be the rounding of a file to three digits.
inline bool is_folded(const Corners& c, const Cuts& triangles) {
    const vec3 normal = area_vector(c);
    return std::ranges::any_of(triangles, [&](const auto& t) {
        const vec3 own = area_vector(c, t);
        const real area = dot(own, normal);
        return normal == vec3{} ? !(own == vec3{}) : area < -dot(normal, normal) / 1000;
    });
}

// A polygon seen along the longest component of its normal, where it runs anticlockwise.  Cuts off
// an ear, a triangle of three neighbours that has no other corner in it, until three are left
// (Meisters 1975, Amer. Math. Monthly 82(6)); of all ears the one that is highest for its longest
// side, so that corners in line make no slivers.
class Ears {
public:
    explicit Ears(const Corners& c) : n_(c.size()), before_(n_), after_(n_), height_(n_) {
        const vec3 normal = area_vector(c);
        size_t k = 0;
        for (size_t i : {1, 2})
            if (std::abs(normal.*axis[i]) > std::abs(normal.*axis[k])) k = i;
        auto x = axis[(k + 1) % 3], y = axis[(k + 2) % 3];
        if (normal.*axis[k] < 0) std::swap(x, y);
        for (size_t i = 0; i < n_; ++i) {
            at_.push_back({c[i].*x, c[i].*y});
            before_[i] = (i + n_ - 1) % n_;
            after_[i] = (i + 1) % n_;
        }
    }

    // Nothing if the polygon crosses itself, or takes more than `left` tests, which it spends.
    std::optional<Cuts> cut(int64_t& left) {
        if (left < int64_t(n_ * n_)) return {};
        Cuts all;
        std::vector<size_t> rest(n_);
        std::iota(rest.begin(), rest.end(), size_t(0));
        auto look = [&](size_t i) { height_[i] = height(i, rest, left); };
        for (size_t i : rest) look(i);
        for (bool fresh = true; rest.size() > 3 && left > 0;) {
            left -= int64_t(rest.size());
            const auto best =
                std::ranges::max_element(rest, {}, [&](size_t i) { return height_[i]; });
            const size_t i = *best, a = before_[i], b = after_[i];
            if (height_[i] < 0) {
                if (fresh) return {};
                fresh = true;
                for (size_t j : rest) look(j);
                continue;
            }
            all.push_back({a, i, b});
            rest.erase(best);
            after_[a] = b, before_[b] = a;
            look(a), look(b);
            fresh = false;
        }
        const size_t a = before_[rest[0]], b = after_[rest[0]];
        all.push_back({a, rest[0], b});
        return left > 0 && area(a, rest[0], b) >= 0 ? std::optional(all) : std::nullopt;
    }

private:
    const size_t n_;
    std::vector<vec2> at_;
    std::vector<size_t> before_, after_;  // neighbours among the corners left
    std::vector<real> height_;            // of the ear at each, over its longest side; -1: no ear

    // The edge function of the intersector: twice the area of a, b, c, never of the wrong sign but
    // for the rounding of differences.
    real area(size_t a, size_t b, size_t c) const {
        return difference_of_products(at_[b].x - at_[a].x, at_[c].y - at_[a].y, at_[c].x - at_[a].x,
                                      at_[b].y - at_[a].y);
    }
    real height(size_t i, const std::vector<size_t>& rest, int64_t& left) const {
        const size_t a = before_[i], b = after_[i];
        const real twice = area(a, i, b);
        if (!(twice >= 0)) return -1;
        left -= int64_t(rest.size());
        for (size_t j : rest) {
            if (j == a || j == i || j == b || area(before_[j], j, after_[j]) > 0) continue;
            const bool inside = area(a, i, j) >= 0 && area(i, b, j) >= 0 && area(b, a, j) >= 0;
            if (twice > 0 && inside) return -1;
        }
        auto square = [&](size_t p, size_t q) {
            return sqr(at_[q].x - at_[p].x) + sqr(at_[q].y - at_[p].y);
        };
        const real longest = std::max({square(a, i), square(i, b), square(b, a)});
        return longest > 0 ? twice / longest : 0;
    }
};

}  // namespace penumbra::mesh

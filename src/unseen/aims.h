// unseen/aims.h  1  directions that aim at gaps and at small things
#pragma once
#include <algorithm>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include "base/portable.h"
#include "base/rng.h"
#include "world/scene.h"

namespace penumbra {

// A choice of `most` of many items, each as likely as any other (a reservoir, Vitter 1985).
template <class Item>
struct Chosen {
    uint64_t most, seen = 0;
    std::vector<Item> items = {};

    void add(const Item& item) {
        const uint64_t place = hash(seen, 0) % (seen + 1);
        if (seen++ < most)
            items.push_back(item);
        else if (place < most)
            items[place] = item;
    }
    // Adds the other's items, which it loses.
    void take(Chosen& other) {
        for (const Item& item : other.items) add(item);
        other = {other.most};
    }
};

// Light comes in by gaps, and gaps lie beside edges.  An edge leads from a to a + e; the third
// corner of its triangle is c.  A direction from y goes through
//     a + x e + h w,    x uniform in [0,1), log h uniform from |e| / 65536 to 8 |e|,
// w the normal of the plane of y and the edge, away from the triangle.  One direction of four aims
// at a shape instead, which may be small and throw light, as if it were a lamp.  Shapes that shine
// have their own samples, and do not count.
class Aims {
    struct Edge {
        vec3 a, e, c;
    };
    struct Target {
        Shape shape;
        Light as_light;
    };

public:
    // 128 edges, but no diagonals of quads, and 64 shapes; no more than half of them from one run
    // of shapes of one material, for a mesh has thousands.
    explicit Aims(const Scene& s) {
        Chosen<Edge> edges{128}, of_run{64};
        Chosen<size_t> shapes{64}, shapes_of_run{32}, mirrors{4};
        auto halves = [&](size_t i, size_t j) {  // of a quad
            return j < s.shapes.size() && s.shapes[i].a == s.shapes[j].a &&
                   s.shapes[i].c == s.shapes[j].b && s.shapes[j].is_triangle();
        };
        for (size_t i = 0; i < s.shapes.size(); ++i) {
            if (i > 0 && s.material_of[i] != s.material_of[i - 1])
                edges.take(of_run), shapes.take(shapes_of_run);
            if (s.light_of[i] != no_light) continue;
            shapes_of_run.add(i);
            if (!s.shapes[i].is_triangle()) continue;
            const auto& [a, b, c, r] = s.shapes[i];
            const bool is_second = i > 0 && halves(i - 1, i);
            of_run.add({b, c - b, a});
            if (!halves(i, i + 1)) of_run.add({c, a - c, b});
            if (!is_second) of_run.add({a, b - a, c});
            if (!is_second && s.materials[s.material_of[i]].is_delta()) mirrors.add(i);
        }
        edges.take(of_run), shapes.take(shapes_of_run);
        edges_ = edges.items;
        for (const size_t i : shapes.items) targets_.push_back(target(s.shapes[i]));
        for (const size_t i : mirrors.items) mirrors_.push_back(s.shapes[i]);
        share();
    }
    // Also what an eye sees in up to four plane mirrors or panes of glass.
    Aims with_reflections() const {
        Aims all = *this;
        for (const Shape& m : mirrors_) {
            const vec3 n = unit(area_vector(m));
            auto turn = [&](vec3 v) { return v - n * (2 * dot(n, v)); };
            auto reflect = [&](vec3 p) { return m.a + turn(p - m.a); };
            for (const auto& [a, e, c] : edges_)
                all.edges_.push_back({reflect(a), turn(e), reflect(c)});
            for (const auto& [s, as_light] : targets_)
                all.targets_.push_back(target({reflect(s.a), reflect(s.b), reflect(s.c), s.r}));
        }
        all.share();
        return all;
    }
    size_t size() const { return edges_.size() + targets_.size(); }

    // A direction, and the number of the edge or shape that it aims at.
    struct Aim {
        size_t at;
        vec3 d;
    };
    std::optional<Aim> sample(vec3 y, real u_which, vec2 u) const {
        const size_t i = std::min(
            size_t(std::ranges::upper_bound(upto_, double(u_which)) - upto_.begin()), size() - 1);
        if (i >= edges_.size()) {
            const auto& [shape, as_light] = targets_[i - edges_.size()];
            const auto at = sample_light(as_light, y, u);
            const bool is_met = at && intersect(shape, {y, at->wi}, shear(at->wi), infinity);
            return is_met ? std::optional(Aim{i, at->wi}) : std::nullopt;  // not if edge-on
        }
        const Edge& edge = edges_[i];
        const vec3 r = edge.a - y, e = edge.e;
        const vec3 d = r + e * u.x +
                       away(edge, r) * (widest * length(e) *
                                        real(portable::pow(0.5, double(octaves * (1 - u.y)))));
        return dot(d, d) > 0 ? std::optional(Aim{i, unit(d)}) : std::nullopt;
    }
    // Density per solid angle.
    real pdf(vec3 y, vec3 d) const {
        real sum = 0;
        for (size_t i = 0; i < edges_.size(); ++i)
            sum += real(part_[i]) * pdf_beside(edges_[i], edges_[i].a - y, d);
        const Ray ray{y, d};
        const Shear k = shear(d);
        for (size_t i = edges_.size(); i < size(); ++i) {
            const auto& [shape, as_light] = targets_[i - edges_.size()];
            const vec3 to_centre = as_light.centre - y;
            const vec3 across = to_centre - d * dot(to_centre, d);
            if (dot(across, across) > sqr(as_light.reach * real(1.001))) continue;  // rounding
            if (const auto hit = intersect(shape, ray, k, infinity))
                sum += real(part_[i]) * pdf_light(as_light, y, surface(shape, ray, *hit));
        }
        return sum;
    }
    // From now on half of all directions aim where it is worth most; the others are as before, in
    // defence (Hesterberg 1995).
    void prefer(const std::vector<double>& worth) {
        const double all = std::accumulate(worth.begin(), worth.end(), 0.0);
        if (!(all > 0 && std::isfinite(all))) return;
        for (size_t i = 0; i < size(); ++i) part_[i] = part_[i] / 2 + worth[i] / all / 2;
        sum_up();
    }

private:
    // Of h, in lengths of the edge: a gap of a millimetre is beside an edge of 60 m, too.
    static constexpr int octaves = 19;
    static constexpr real widest = 8, narrowest = widest / (1 << octaves);
    std::vector<Edge> edges_;
    std::vector<Target> targets_;
    std::vector<Shape> mirrors_;
    std::vector<double> part_, upto_;  // parts of all directions: edges, then shapes

    static Target target(const Shape& shape) {
        const auto& [a, b, c, r] = shape;
        Light light =
            shape.is_triangle() ? Light(a, TriangleLight{b - a, c - a}) : Light(a, SphereLight{r});
        light.twosided = true;
        return {shape, light};
    }
    void share() {
        const double of_targets = targets_.empty() ? 0 : edges_.empty() ? 1 : 0.25;
        part_.assign(edges_.size(), (1 - of_targets) / double(edges_.size()));
        part_.resize(size(), of_targets / double(targets_.size()));
        sum_up();
    }
    void sum_up() {
        upto_.resize(size());
        std::partial_sum(part_.begin(), part_.end(), upto_.begin());
    }
    // w, unless y is on the line of the edge.
    static vec3 away(const Edge& edge, vec3 r) {
        const vec3 n = cross(edge.e, r);
        if (!(dot(n, n) > 0)) return {};
        return unit(n) * (dot(n, edge.c - edge.a) > 0 ? real(-1) : real(1));
    }
    // At t d = r + x e + h w: t^2 / cosine, 1 / |e| and 1 / (h log 2^19).  Most edges are told by
    // the signs of h and t, which need no square root.
    static real pdf_beside(const Edge& edge, vec3 r, vec3 d) {
        const vec3 e = edge.e, n = cross(e, r), side = edge.c - edge.a;
        const real dn = dot(d, n), nn = dot(n, n);  // n n is ee rr - er^2, too
        if (!(dot(n, side) > 0 ? dn < 0 : dn > 0)) return 0;
        const vec3 in_plane = d - n * (dn / nn);
        const real ee = dot(e, e), er = dot(e, r), rr = dot(r, r);
        const real de = dot(in_plane, e), dr = dot(in_plane, r);
        const real t = nn / (dr * ee - de * er), x = t * (de * rr - dr * er) / nn;
        if (!(t > 0 && x >= 0 && x < 1)) return 0;
        const real width = std::sqrt(ee), h = t * std::abs(dn) / std::sqrt(nn);
        if (!(h >= narrowest * width && h <= widest * width)) return 0;
        const real cosine = std::abs(dot(d, cross(e, n))) / (width * std::sqrt(nn));
        return sqr(t) / (cosine * width * h * (octaves * std::numbers::ln2_v<real>));
    }
};

}  // namespace penumbra

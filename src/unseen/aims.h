// unseen/aims.h  2  directions that aim at gaps and at small things
#pragma once
#include <numeric>
#include <tuple>
#include <vector>

#include "base/rng.h"
#include "unseen/aim.h"

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

// At most so many of these numbers: the half of the greatest worth, and others by lot.
template <class Worth>
std::vector<size_t> half_of_greatest(const std::vector<size_t>& numbers, size_t most, Worth worth) {
    if (numbers.size() <= most) return numbers;
    std::vector<std::tuple<real, uint64_t, size_t>> order;  // those of equal worth by lot
    for (const size_t i : numbers) order.emplace_back(-worth(i), hash(i, 1), i);
    std::ranges::sort(order);
    std::vector<size_t> chosen;
    Chosen<size_t> others{most - most / 2};
    for (const auto& [less, lot, i] : order)
        chosen.size() < most / 2 ? chosen.push_back(i) : others.add(i);
    chosen.insert(chosen.end(), others.items.begin(), others.items.end());
    return chosen;
}

// The radiosity rho E of shapes, up to a factor, as if nothing were between a shape's centroid and
// the lights, and it faced each of them.  Of more than 64 lights it knows the 32 of the greatest
// intensity, and others by lot.
class EstimatedRadiosity {
public:
    explicit EstimatedRadiosity(const Scene& s)
        : scene_(s),
          lights_(from_afar(s.lights, intensities_of(s.lights))),
          chosen_(lights_.size()) {
        std::iota(chosen_.begin(), chosen_.end(), 0);
        chosen_ = half_of_greatest(chosen_, 64, [&](size_t i) { return lights_[i].intensity; });
    }
    // rho, in the direction of the normal: pi f, at most 1.
    real reflectance(size_t shape) const {
        const Material& m = scene_.materials[scene_.material_of[shape]];
        const vec3 n{0, 0, 1};
        return m.is_delta() ? 1 : std::min(real(1), pi * max_of(eval(m, n, n)));
    }
    // By other lights than itself; 0 about a point light, where E is infinite.
    real of(size_t shape) const {
        const vec3 p = centroid(scene_.shapes[shape]);
        real E = 0;
        for (const size_t i : chosen_)
            if (int32_t(i) != scene_.light_of[shape])
                E += light_weight(lights_[i], p, unit(lights_[i].centre - p)).value;
        return E < infinity ? E * reflectance(shape) : 0;
    }

private:
    const Scene& scene_;
    std::vector<DistantLight> lights_;
    std::vector<size_t> chosen_;
};

// Aims of a scene, in views.  A view is a list of mirrors, in the order in which a ray meets them,
// and aims at what they show; view 0 has no mirrors, and lights have it alone.
class Aims {
    using View = std::vector<size_t>;

public:
    // At most 128 edges, but no diagonals of quads, 64 shapes, each in two sizes, 64 lamps and 128
    // mirrors.  No more than half of the edges and shapes come from one run of shapes of one
    // material, for a mesh has thousands; of a run 256 shapes by lot are compared.
    explicit Aims(const Scene& s) {
        Chosen<EdgeAim> edges{128}, of_run{64};
        Chosen<size_t> shapes{2048}, shapes_of_run{256}, lamps{64};
        const EstimatedRadiosity radiosity(s);
        Chosen<PlaneMirror> mirrors{128};
        auto normal = [&](size_t i) { return unit(area_vector(s.shapes[i])); };
        auto halves = [&](size_t i, size_t j) {  // of a quad
            return j < s.shapes.size() && s.shapes[i].a == s.shapes[j].a &&
                   s.shapes[i].c == s.shapes[j].b && s.shapes[j].is_triangle();
        };
        auto is_flat = [&](size_t i, size_t j) {  // but for rounding
            return halves(i, j) && length(normal(i) - normal(j)) < real(1e-4);
        };
        auto most_lit = [&](const std::vector<size_t>& of, size_t most) {
            return half_of_greatest(of, most, [&](size_t i) { return radiosity.of(i); });
        };
        auto end_run = [&] {
            edges.take(of_run);
            shapes_of_run.items = most_lit(shapes_of_run.items, 32);
            shapes.take(shapes_of_run);
        };
        for (size_t i = 0; i < s.shapes.size(); ++i) {
            if (i > 0 && s.material_of[i] != s.material_of[i - 1]) end_run();
            if (s.light_of[i] != no_light) lamps.add(i);
            if (s.light_of[i] == no_light || radiosity.reflectance(i) > 0) shapes_of_run.add(i);
            if (!s.shapes[i].is_triangle()) continue;
            const auto& [a, b, c, r] = s.shapes[i];
            of_run.add({b, c, a});
            if (!halves(i, i + 1)) of_run.add({c, a, b});
            if (i == 0 || !halves(i - 1, i)) of_run.add({a, b, c});
            if (s.materials[s.material_of[i]].is_delta() && (i == 0 || !is_flat(i - 1, i)))
                mirrors.add({i, is_flat(i, i + 1) ? i + 1 : i, a, b, c, normal(i)});
        }
        end_run();
        for (const EdgeAim& edge : edges.items)  // one of two triangles counts once
            if (std::ranges::find(edges_, edge) == edges_.end()) edges_.push_back(edge);
        for (const size_t i : most_lit(shapes.items, 64))
            for (const Shape& shape : {s.shapes[i], grown(s.shapes[i])})
                shapes_.push_back(ShapeAim(shape)), radiosity_.push_back(double(radiosity.of(i)));
        const double all = std::accumulate(radiosity_.begin(), radiosity_.end(), 0.0);
        for (double& x : radiosity_) x = all > 0 ? x / all : 1 / double(radiosity_.size());
        mirrors_ = mirrors.items;
        if (!mirrors_.empty())
            for (const size_t i : lamps.items) lamps_.push_back(ShapeAim(s.shapes[i]));
        share();
    }
    // The eye's: also 256 corners, and views in mirrors, in 128 pairs and in 64 triples of them.
    Aims of_eye(const Scene& s) const {
        Aims all = *this;
        all.corners_ = corners(s);
        Chosen<View> pairs{128}, triples{64};
        for (size_t i = 0; i < mirrors_.size(); ++i) {
            all.views_.push_back({i});
            for (size_t j = 0; j < mirrors_.size(); ++j)
                if (mirrors_[i].shows(mirrors_[j], s.camera.eye)) pairs.add({i, j});
        }
        for (const View& pair : pairs.items)
            for (size_t j = 0; j < mirrors_.size(); ++j)
                if (mirrors_[pair[1]].shows(mirrors_[j], mirrors_[pair[0]].image(s.camera.eye)))
                    triples.add({pair[0], pair[1], j});
        for (const auto* longer : {&pairs, &triples})
            all.views_.insert(all.views_.end(), longer->items.begin(), longer->items.end());
        all.share();
        return all;
    }
    size_t size() const { return part_.size(); }

    // A direction, and its number among the aims of all views.
    struct Aim {
        size_t at;
        vec3 d;
    };
    std::optional<Aim> sample(vec3 y, real u_which, vec2 u) const {
        const size_t at = std::min(
            size_t(std::ranges::upper_bound(upto_, double(u_which)) - upto_.begin()), size() - 1);
        const View& view = views_[view_of(at)];
        auto d = toward(at % of_view(), image(y, view), u);
        for (size_t k = view.size(); d && k-- > 0;) d = mirrors_[view[k]].turn(*d);
        return d ? std::optional(Aim{at, *d}) : std::nullopt;
    }
    // Density per solid angle, of directions of a view.
    real pdf(vec3 y, vec3 d, size_t view = 0) const {
        y = image(y, views_[view]);
        for (const size_t i : views_[view]) d = mirrors_[i].turn(d);
        const double* part = part_.data() + view * of_view();
        real sum = 0;
        auto add = [&](const auto& aims) {
            for (const auto& aim : aims) {
                const real p = real(*part++);
                if (p > 0) sum += p * aim.pdf(y, d);
            }
        };
        add(edges_), add(shapes_), add(lamps_), add(corners_);
        return sum;
    }
    size_t view_of(size_t at) const { return at / of_view(); }
    // The view of rays of this one that a shape reflects, if there is one.
    std::optional<size_t> in_mirror(size_t view, size_t shape) const {
        const auto is_of = [&](const PlaneMirror& m) {
            return m.first <= shape && shape <= m.last;
        };
        const auto mirror = std::ranges::find_if(mirrors_, is_of);
        View next = views_[view];
        next.push_back(size_t(mirror - mirrors_.begin()));
        const size_t at = size_t(std::ranges::find(views_, next) - views_.begin());
        return at < views_.size() ? std::optional(at) : std::nullopt;
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
    std::vector<EdgeAim> edges_;
    std::vector<ShapeAim> shapes_, lamps_;  // lamps in mirrors; others have samples of their own
    std::vector<double> radiosity_;         // of the shapes, relative to their sum
    std::vector<CornerAim> corners_;
    std::vector<PlaneMirror> mirrors_;
    std::vector<View> views_{{}};
    std::vector<double> part_, upto_;  // parts of all directions: by views, edges, shapes ...

    size_t of_view() const {
        return edges_.size() + shapes_.size() + lamps_.size() + corners_.size();
    }
    vec3 image(vec3 p, const View& view) const {
        for (const size_t i : view) p = mirrors_[i].image(p);
        return p;
    }
    std::optional<vec3> toward(size_t i, vec3 y, vec2 u) const {
        if (i < edges_.size()) return edges_[i].toward(y, u);
        i -= edges_.size();
        if (i < shapes_.size()) return shapes_[i].toward(y, u);
        i -= shapes_.size();
        if (i < lamps_.size()) return lamps_[i].toward(y, u);
        return corners_[i - lamps_.size()].toward(y, u);
    }
    // Of all directions from a light 3/4 aim at edges, the others at shapes; of those from the eye
    // in view 0 1/2 at edges, 1/4 at corners; of those in mirrors 1/2 at edges, 1/3 at lamps.  Half
    // of those at shapes are in proportion to radiosity.  Per 4 in view 0 there are 3 in single
    // mirrors, and 3 in longer lists.
    void share() {
        const double singles = double(mirrors_.size());
        const double longer = double(views_.size()) - 1 - singles;
        part_.clear();
        for (const View& view : views_) {
            const bool has_corners = view.empty() && !corners_.empty();
            const double alike = view.empty() ? 0.5 : view.size() == 1 ? singles : longer;
            auto add = [&](size_t n, double part) {
                part_.insert(part_.end(), n, part / alike / double(n));
            };
            add(edges_.size(), has_corners ? 2 : 3), add(shapes_.size(), 0.5);
            for (size_t i = 0; i < radiosity_.size(); ++i)
                part_[part_.size() - radiosity_.size() + i] += radiosity_[i] / 2 / alike;
            add(lamps_.size(), view.empty() ? 0 : 2), add(corners_.size(), has_corners ? 1 : 0);
        }
        const double all = std::accumulate(part_.begin(), part_.end(), 0.0);
        for (double& part : part_) part /= all;
        sum_up();
    }
    void sum_up() {
        upto_.resize(size());
        std::partial_sum(part_.begin(), part_.end(), upto_.begin());
    }
    // What hides light ends at an edge, or at the outline of a ball.  The eye sees either in
    // directions d with axis d = cosine; an edge goes from a to a + e, relative to the eye.
    struct Outline {
        vec3 axis, a, e = {};
        real cosine = 0, tangent = 0;  // of a ball: the distance of its outline

        bool is_edge() const { return tangent == 0; }
        // Distance along d; 0 beyond the ends of an edge.
        real distance(vec3 d) const {
            const vec3 w = cross(axis, d);
            const real x = -dot(w, a) / dot(w, e), t = dot(d, a + e * x);
            return !is_edge() ? tangent : x > 0 && x < 1 && t > 0 ? t : 0;
        }
    };
    static Outline outline(const EdgeAim& edge, vec3 eye) {
        const vec3 a = edge.a - eye;
        return {unit(cross(a, edge.b - eye)), a, edge.b - edge.a};
    }
    static Outline outline(const Shape& ball, vec3 eye) {
        const vec3 a = ball.a - eye;
        const real cosine = std::sqrt(1 - sqr(ball.r) / dot(a, a));
        return {unit(a), a, {}, cosine, cosine * length(a)};
    }
    // Points where the eye sees an outline before another, and nothing before them: edges that meet
    // are not one before the other, and a point is not hidden by its own surface, but for rounding.
    std::vector<CornerAim> corners(const Scene& s) const {
        const vec3 eye = s.camera.eye;
        std::vector<Outline> outlines;
        for (const EdgeAim& edge : edges_) outlines.push_back(outline(edge, eye));
        Chosen<Shape> balls{64};
        for (const Shape& shape : s.shapes)
            if (!shape.is_triangle()) balls.add(shape);
        for (const Shape& ball : balls.items) outlines.push_back(outline(ball, eye));
        Chosen<CornerAim> chosen{256};
        auto add = [&](const Outline& first, const Outline& second, vec3 d) {
            const real t = first.distance(d), other = second.distance(d), near = std::min(t, other);
            const bool may_meet = first.is_edge() && second.is_edge();
            if (!(near > 0) || (may_meet && std::max(t, other) < real(1.0001) * near)) return;
            const auto hit = s.bvh.closest({eye, d});
            if (!hit || hit->t > real(0.999) * near) chosen.add({eye + near * d});
        };
        for (size_t i = 0; i < outlines.size(); ++i)
            for (size_t j = 0; j < i; ++j) {
                // d = x u + y v + z n has the cosines a, b to the axes u, v, and length 1.
                const vec3 u = outlines[i].axis, v = outlines[j].axis, n = cross(u, v);
                const real a = outlines[i].cosine, b = outlines[j].cosine, uv = dot(u, v);
                const real x = (a - b * uv) / dot(n, n), y = (b - a * uv) / dot(n, n);
                const real z = std::sqrt((1 - (x * a + y * b)) / dot(n, n));
                if (!(z > 0)) continue;  // they do not cross, or the eye is in line or in a ball
                for (const real side : {z, -z})
                    add(outlines[i], outlines[j], u * x + v * y + n * side);
            }
        return chosen.items;
    }
};

}  // namespace penumbra

// check/scene_check.h  1  problems of a scene that its text hides: surfaces in one place, point
// lights on surfaces, coordinates too coarse for their precision
#pragma once
#include <concepts>
#include <map>
#include <set>
#include <span>

#include "text/named_scene.h"
#include "text/words.h"
#include "world/prepare.h"

namespace penumbra {

inline constexpr bool moves_surfaces = true;  // of programs that are built with this module

// ---- Surfaces that lie in each other ------------------------------------------------------------

// True if two flat shapes with these corners share more than an edge of a plane, within e, or lie
// above each other at no more than `room`.  Each lies within its edges: another one that is beyond
// an edge of it touches it at most.
inline bool share_plane(std::span<const vec3> s, std::span<const vec3> t, real e, real room) {
    const std::span<const vec3> corners[2] = {s, t};
    const vec3 normal[2] = {unit(cross(s[1] - s[0], s[2] - s[0])),
                            unit(cross(t[1] - t[0], t[2] - t[0]))};
    auto farthest = [&](size_t k, vec3 from, vec3 along) {
        real far = -infinity;
        for (vec3 p : corners[1 - k]) far = std::max(far, dot(p - from, along));
        return far;
    };
    auto has_other_in_plane = [&](size_t k) {
        return farthest(k, corners[k][0], normal[k]) <= e + room &&
               farthest(k, corners[k][0], -normal[k]) <= e + room;
    };
    if (!has_other_in_plane(0) && !has_other_in_plane(1)) return false;
    for (size_t k : {0, 1})
        for (size_t i = 0, n = corners[k].size(); i < n; ++i) {
            const vec3 edge = corners[k][(i + 1) % n] - corners[k][i];
            if (farthest(k, corners[k][i], unit(cross(normal[k], edge))) <= e) return false;
        }
    return true;
}

// The same of two shapes of any kind, within rounding.
inline bool share_surface(const Shape& s, const Shape& t, real room) {
    const real e = 2 * (rounding_error(s) + rounding_error(t));  // the bound of spawn
    return ask(s, [&](auto kind) {
        return ask(t, [&](auto other) {
            const auto corners = kind.corners(s);
            const auto others = other.corners(t);
            static_assert(corners.size() > 0 || std::same_as<decltype(kind), SphereShape>,
                          "`lifted`, `lies_on` and `near_hit` take a round shape for a sphere");
            if (corners.size() > 0 && others.size() > 0)
                return share_plane(corners, others, e, room);
            const real apart = length(s.a - t.a) + length(s.b - t.b) + length(s.c - t.c);
            return corners.size() == others.size() && apart + std::abs(s.r - t.r) <= e + room;
        });
    });
}

inline bool overlap(const Box& a, const Box& b) {
    bool meets = true;
    for (auto k : axis) meets = meets && a.lo.*k <= b.hi.*k && b.lo.*k <= a.hi.*k;
    return meets;
}

inline bool may_move(const NamedScene& s, uint32_t i) {
    return s.light_of[i] != no_light || s.material_at(i).transmits();
}

// Finds the pairs of shapes, but those of one light or of one face of a mesh, that share a surface
// or are as near as `room`, and of which one is a light or glass.  A set of boxes is halved again
// and again; only halves whose boxes overlap have pairs.  Throws UserError "NAME: ..." if it would
// take seconds.
class Contacts {
public:
    using Pair = std::array<uint32_t, 2>;
    std::vector<Pair> pairs;  // in order, the smaller index first

    Contacts(const NamedScene& s, const std::string& name, real room = 0)
        : scene_(s), name_(name), room_(room), left_((1 << 28) + 1024 * int64_t(s.shapes.size())) {
        std::vector<Item> items;
        Box movable;
        for (uint32_t i = 0; i < s.shapes.size(); ++i) {
            const Box b = bounds(s.shapes[i]);
            items.push_back({{b.lo - vec3{room, room, room}, b.hi + vec3{room, room, room}},
                             i,
                             may_move(s, i)});
            if (items.back().moves) movable.add(items.back().box);
        }
        std::erase_if(items, [&](const Item& item) { return !overlap(item.box, movable); });
        search(items);
        std::ranges::sort(pairs);
    }

private:
    struct Item {
        Box box;
        uint32_t id;
        bool moves;
    };
    using Items = std::span<Item>;
    const NamedScene& scene_;
    const std::string& name_;
    const real room_;
    int64_t left_;  // boxes to look at; a test of shapes counts as 16

    void spend(size_t boxes) {
        left_ -= int64_t(boxes);
        if (left_ < 0 || pairs.size() > 1 << 21)
            throw UserError(name_ + ": too many shapes where lights or glass are");
    }
    // The box about all, and whether one moves.
    static Item about(Items items) {
        Item all{};
        for (const Item& item : items) all.box.add(item.box), all.moves |= item.moves;
        return all;
    }

    void search(Items items) {
        const Item all = about(items);
        if (items.size() < 2 || !all.moves) return;
        spend(items.size());
        const auto k =
            std::ranges::max(axis, {}, [&](auto a) { return all.box.hi.*a - all.box.lo.*a; });
        const Items low = items.first(items.size() / 2), high = items.subspan(items.size() / 2);
        std::ranges::nth_element(items, high.begin(), {},
                                 [k](const Item& item) { return item.box.lo.*k + item.box.hi.*k; });
        search(low), search(high), search(low, high);
    }
    void search(Items a, Items b) {
        spend(a.size() + b.size());
        const Item all_a = about(a), all_b = about(b);
        if (!overlap(all_a.box, all_b.box) || !(all_a.moves || all_b.moves)) return;
        if (a.size() < b.size()) std::swap(a, b);
        if (a.size() == 1) return test(std::min(a[0].id, b[0].id), std::max(a[0].id, b[0].id));
        search(a.first(a.size() / 2), b), search(a.subspan(a.size() / 2), b);
    }
    void test(uint32_t i, uint32_t j) {
        const NamedScene& s = scene_;
        if (s.light_of[i] != no_light && s.light_of[i] == s.light_of[j]) return;
        const bool one_face = j < s.line_in_mesh.size() && s.line_in_mesh[i] > 0 &&
                              s.line_in_mesh[i] == s.line_in_mesh[j];
        if (one_face && s.line_of[i] == s.line_of[j]) return;
        spend(16);
        if (share_surface(scene_.shapes[i], scene_.shapes[j], room_)) pairs.push_back({i, j});
    }
};

// A light's shape when its surface is moved: corners follow p, and a point has no surface.
inline void grow(SphereLight& ball, real by) { ball.r = std::max(ball.r / 2, ball.r + by); }
template <int corners>
void grow(PolygonLight<corners>&, real) {}
template <class Kind>
requires Kind::is_delta void grow(Kind&, real) {}

// Moved along a normal; a round one, which has none, grows.
inline Light lifted(Light l, real by) {
    l.p += by * l.n;
    std::visit([&](auto& kind) { grow(kind, by); }, l.kind);
    l.ask([&](const auto& kind) { kind.place(l); });
    return l;
}
inline Shape lifted(Shape s, vec3 n, real by) {
    s.a += by * n, s.b += by * n, s.c += by * n;
    if (n == vec3{}) s.r = std::max(s.r / 2, s.r + by);
    return s;
}

inline std::string too_coarse(const std::string& shape, const std::string& fact) {
    const bool is_float = sizeof(real) == 4;
    return shape + ": " + (is_float ? "float" : "double") + " precision is too low here: " + fact +
           ", and light may be wrong; " + (is_float ? "use REAL=double, or " : "") +
           "bring all shapes nearer to the origin";
}

// Surfaces in one place, in the order in which they are moved farther: what is opaque stays;
// lights, the last first; glass by its index of refraction.  Glass of one index, which may be
// exchanged without changing a picture, by radius, line and corners: equal triangles of one line
// are one surface.
using Order = std::array<real, 13>;
inline Order order_of(const NamedScene& s, uint32_t i) {
    const Shape& t = s.shapes[i];
    const Material& m = s.material_at(i);
    if (!m.transmits()) return {real(s.light_of[i] == no_light ? 0 : 1), -real(s.light_of[i])};
    std::array<std::array<real, 3>, 3> c{
        {{t.a.x, t.a.y, t.a.z}, {t.b.x, t.b.y, t.b.z}, {t.c.x, t.c.y, t.c.z}}};
    std::rotate(c.begin(), std::ranges::min_element(c), c.end());
    const real ior = m.ask([](const auto& kind) -> real { return kind.ior; });
    Order order{2, ior, t.r, real(s.line_of[i])};
    for (size_t k = 0; k < 9; ++k) order[k + 4] = c[k / 3][k % 3];
    return order;
}

// Moves surfaces apart that lie in each other, by more than the error of spawn_to: lights outwards,
// glass into its own body, so that no path is in glass and beyond what touches it.
class Separation {
public:
    std::vector<std::string> warnings;  // one for a line

    // Throws UserError "NAME:LINE: ..." where there is no room.
    Separation(NamedScene& s, const std::string& name)
        : scene_(s),
          lights_(s.lights.size()),
          pairs_(Contacts(s, name).pairs),
          moved_(lights_ + s.shapes.size()) {
        if (pairs_.empty()) return;
        for (const auto& [i, j] : pairs_) touching_[i].push_back(j), touching_[j].push_back(i);
        decide();
        check_room(name);
        warn();
        move();
    }

private:
    NamedScene& scene_;
    const size_t lights_;
    const std::vector<Contacts::Pair> pairs_;
    std::map<uint32_t, std::vector<uint32_t>> touching_;
    std::vector<real> moved_;  // along the normal: each light, and each shape that is none

    real& by(uint32_t i) {
        const int32_t k = scene_.light_of[i];
        return moved_[k == no_light ? lights_ + i : size_t(k)];
    }
    bool is_glass(uint32_t i) const { return scene_.material_at(i).transmits(); }

    // Each is moved a step farther than what comes before it.  Rays come from the eye and from what
    // reflects them.
    void decide() {
        real error = 16 * ulp * max_abs(scene_.camera.eye);
        for (uint32_t i = 0; i < scene_.shapes.size(); ++i)
            if (scene_.material_at(i).reflects() || touching_.contains(i))
                error = std::max(error, rounding_error(scene_.shapes[i]));
        std::vector<std::pair<Order, uint32_t>> order;
        for (const auto& [i, others] : touching_) order.push_back({order_of(scene_, i), i});
        std::ranges::sort(order);
        for (const auto& [own, i] : order)
            for (uint32_t j : touching_[i])
                if (order_of(scene_, j) < own)
                    by(i) = (is_glass(i) ? -1 : 1) *
                            std::max(std::abs(by(i)), std::abs(by(j)) + 32 * error);
    }

    // Within the distance by which glass is moved there must be nothing but what it touches.
    void check_room(const std::string& name) {
        const real farthest = -std::min(real(0), std::ranges::min(moved_));
        if (farthest == 0) return;
        for (const auto& pair : Contacts(scene_, name, 2 * farthest).pairs)
            for (size_t k : {0, 1})
                if (const uint32_t i = pair[k], other = pair[1 - k];
                    is_glass(i) && by(i) < 0 && !std::ranges::binary_search(pairs_, pair))
                    throw error_at(name, scene_.line_of[i],
                                   "this glass lies in the surface of " +
                                       where(scene_, touching_[i][0]) +
                                       " and has no room to be moved off: " +
                                       (scene_.line_of[i] == scene_.line_of[other]
                                            ? "it is too thin"
                                            : where(scene_, other) + " is too near"));
    }

    void warn() {
        for (uint32_t i = 0; i < scene_.shapes.size() && warnings.empty(); ++i) {
            const Box box = bounds(scene_.shapes[i]);
            if (100 * std::abs(by(i)) > max_abs(box.hi - box.lo))
                warnings.push_back(
                    too_coarse(where(scene_, i),
                               "it is moved off another surface by more than 1 % of its size"));
        }
        std::set<uint32_t> told;
        for (auto [other, i] : pairs_) {
            if (order_of(scene_, other) == order_of(scene_, i)) continue;
            if (order_of(scene_, other)[0] > order_of(scene_, i)[0]) std::swap(other, i);
            if (!told.insert(scene_.line_of[i]).second) continue;
            const std::string in = " lies in the surface of " + where(scene_, other) + ": ";
            warnings.push_back(
                where(scene_, i) +
                (is_glass(i)
                     ? ": this glass" + in +
                           "it is moved a hair into its own body, with air between"
                     : ": this light" + in +
                           "it is moved in front of it (of two lights in one place, the first)"));
        }
    }

    // A two-sided light is doubled, with a copy on either side.
    void move() {
        NamedScene& s = scene_;
        std::vector<int32_t> back(lights_, no_light);
        for (size_t k = 0; k < lights_; ++k) {
            if (moved_[k] > 0 && s.lights[k].twosided) {
                back[k] = int32_t(s.lights.size());
                s.lights.push_back(lifted(s.lights[k], -moved_[k]));
                s.line_of_light.push_back(s.line_of_light[k]);
            }
            s.lights[k] = lifted(s.lights[k], moved_[k]);
        }
        for (uint32_t i = 0, n = uint32_t(s.shapes.size()); i < n; ++i) {
            if (by(i) == 0) continue;
            const Shape shape = s.shapes[i];
            const int32_t k = s.light_of[i];
            const vec3 normal = k == no_light ? constants_of(shape).n : s.lights[size_t(k)].n;
            s.shapes[i] = lifted(shape, normal, by(i));
            if (k == no_light || back[size_t(k)] == no_light) continue;
            add_shape(s, lifted(shape, normal, -by(i)), s.material_of[i], back[size_t(k)]);
            s.line_of.push_back(s.line_of[i]);
        }
    }
};

// ---- Points on surfaces, rounding ---------------------------------------------------------------

// True if p lies on the shape within rounding, so that its side would be arbitrary.  The bound is a
// quarter of rounding_error, the error that the intersectors actually make.
inline bool lies_on(const Shape& s, const ShapeConstants& f, vec3 p) {
    const real error = f.error / 4 + 4 * ulp * max_abs(p);
    const vec3 n = f.n == vec3{} ? unit(p - s.a) : f.n;
    const Ray through{p - error * n, n, 2 * error};
    return intersect(s, through, shear(n), through.tmax).has_value();
}

// The first point light that lies on a shape, and the first such shape.  Only lights between the
// bounds of a shape along the x axis are looked at, for which they are sorted.  Throws UserError
// "NAME: ..." if it would take seconds.
struct LightOnShape {
    size_t light;
    uint32_t shape;
};
inline std::optional<LightOnShape> point_light_on_surface(const Scene& s, const std::string& name) {
    std::vector<size_t> points;
    for (size_t k = 0; k < s.lights.size(); ++k)
        if (s.lights[k].is_delta()) points.push_back(k);
    auto x_of = [&](size_t k) { return s.lights[k].p.x; };
    std::ranges::stable_sort(points, {}, x_of);
    std::optional<LightOnShape> first;
    int64_t left = 1 << 30;  // lights to look at; a test counts as 16
    for (uint32_t i = 0; i < s.shapes.size() && !points.empty(); ++i) {
        const Box box = bounds(s.shapes[i]);
        auto k = std::ranges::lower_bound(points, box.lo.x, {}, x_of);
        for (; k != points.end() && x_of(*k) <= box.hi.x; ++k) {
            const vec3 p = s.lights[*k].p;
            const bool may = overlap(box, {p, p}) && (!first || *k < first->light);
            left -= may ? 16 : 1;
            if (left < 0)
                throw UserError(name + ": too many lights without a surface where shapes are");
            if (may && lies_on(s.shapes[i], s.constants[i], p)) first = LightOnShape{*k, i};
        }
    }
    return first;
}

// Rays start two errors off a surface (see spawn).  If that is more than a hundredth of a shape, or
// of its distance to the eye, a light or another shape, images are wrong by several percent.
inline bool is_coarse(const Shape& s) {
    const Box box = bounds(s);
    return 200 * rounding_error(s) > max_abs(box.hi - box.lo);
}

// The first other shape too near to the middle of x, which is shape `own` or a point: along +-n if
// x is flat, else along the axes.  A shape within four errors of a flat one touches it.
inline std::optional<Hit> near_hit(const NamedScene& s, Shape x, ShapeConstants f, uint32_t own,
                                   real reach) {
    const vec3 middle = ask(x, [&](auto kind) {
        vec3 sum;
        for (vec3 p : kind.corners(x)) sum += p;
        return f.n == vec3{} ? x.a : sum / real(kind.corners(x).size());
    });
    for (size_t k = 0; k < (f.n == vec3{} ? 12 : 2); ++k) {
        vec3 d = k & 1 ? -f.n : f.n;
        if (f.n == vec3{}) d.*axis[k / 4] = k & 1 ? -1 : 1;
        const vec3 o = middle + ((k & 2 ? x.r : 0) + 4 * f.error) * d;
        const auto hit = s.bvh.closest({o, d, reach});
        const real error = hit ? std::max(f.error, s.constants[hit->id].error) : 0;
        if (hit && hit->id != own && length(o + hit->t * d - middle) < 200 * error) return hit;
    }
    return {};
}

// Lengths that are too short, one of each kind, with a shape.  Pairs are searched at no
// more than 2048 shapes: the first of each line, and others; without lights and glass if some were
// moved.
inline std::map<std::string, uint32_t> coarse_lengths(const NamedScene& s, bool moved) {
    std::map<std::string, uint32_t> found;
    const real reach = 200 * std::ranges::max(s.constants, {}, &ShapeConstants::error).error;
    auto look_about = [&](vec3 p, const std::string& what) {
        if (const auto hit = near_hit(s, {p, p, p}, {}, UINT32_MAX, reach))
            found.emplace(what, hit->id);
    };
    look_about(s.camera.eye, "distance to the eye");
    for (const Light& l : s.lights)
        if (l.is_delta()) look_about(l.p, std::string("distance to a ") + name_of(l) + " light");
    for (uint32_t i = 0, firsts = 0, pairs = 0; i < s.shapes.size(); ++i) {
        if (is_coarse(s.shapes[i])) found.emplace("size", i);
        const bool first = i == 0 || s.line_of[i] != s.line_of[i - 1];
        if (i % (1 + s.shapes.size() / 1024) > 0 && !(first && firsts++ < 1024)) continue;
        const auto hit = pairs ? std::nullopt : near_hit(s, s.shapes[i], s.constants[i], i, reach);
        if (!hit || (moved && (may_move(s, i) || may_move(s, hit->id)))) continue;
        found.emplace("distance to " + where(s, hit->id), i);
        ++pairs;
    }
    return found;
}

// ---- All of these -------------------------------------------------------------------------------

// Moves surfaces apart, prepares the scene, and returns warnings to its author.  Throws UserError
// "NAME:LINE: ..." about a scene that cannot be rendered.
inline std::vector<std::string> check_and_prepare(NamedScene& s, const std::string& name) {
    std::vector<std::string> warnings = Separation(s, name).warnings;
    const bool moved = !warnings.empty();
    prepare(s);
    if (const auto on = point_light_on_surface(s, name))
        throw error_at(name, s.line_of_light[on->light],
                       std::string("this ") + name_of(s.lights[on->light]) +
                           " light lies on the surface of " + where(s, on->shape) +
                           ": move it off");
    for (const auto& [length, shape] : coarse_lengths(s, moved))
        warnings.push_back(too_coarse(
            where(s, shape), "ray origins are offset by more than 1 % of this shape's " + length));
    return warnings;
}

}  // namespace penumbra

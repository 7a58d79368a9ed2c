// world/light_choice.h  3  light selection by estimated contribution, in a tree of lights
//
// A sample chooses one light of many.  Lights that are near each other form groups, and groups
// larger groups (Conty Estevez, Kulla 2018).  From the root, the choice descends from group to
// member, each time with probabilities by the members' estimated contributions.
#pragma once
#include <array>
#include <limits>
#include <vector>

#include "world/lights.h"

namespace penumbra {

inline constexpr size_t max_members = 8;

// An estimate may be wrong by any factor, because it does not know what hides a light.  So a part
// of all choices goes to all members alike that can contribute (a defensive mixture, Hesterberg
// 1995): no member starves.
inline constexpr real even_part = real(0.0625);

// A light, or a group of lights, as it looks from afar: it sends L A cos_l cos_s / d^2 to a
// surface. L A is its strength, d the distance of its centre, and the cosines are those at both
// ends.
struct LightNode {
    vec3 centre = {};   // of a group: the mean of its lights', by strength
    real reach = 0;     // radius of a sphere about the centre that holds all
    real spread2 = 0;   // mean square of the distance from the centre
    vec3 axis = {};     // normal of a polygon; of a group: the mean by strength
    real round = 1;     // the part that shines in all directions
    real behind = 0;    // distance behind the plane through the centre that is still lit
    real twosided = 0;  // 1: it shines against its axis, too
    real strength = 0;
    uint32_t light = 0;
};
inline LightNode node_of(const Light& l, real strength, uint32_t light) {
    LightNode n{l.centre, l.reach, sqr(l.reach)};
    // A polygon does not shine along its own plane, within rounding.
    if (!l.is_round()) n.axis = l.n, n.round = 0, n.twosided = l.twosided, n.behind = -2 * l.error;
    n.strength = strength, n.light = light;
    return n;
}

// Up to eight members, in rows: a loop over a row becomes vector instructions.
struct LightGroup {
    template <class T>
    using Row = std::array<T, max_members>;
    Row<real> x{}, y{}, z{}, reach{}, spread2{}, axis_x{}, axis_y{}, axis_z{}, round{}, behind{},
        twosided{}, strength{};
    Row<uint32_t> child{};  // the number of a group or light
    Row<bool> is_light{};
    uint32_t members = 0, parent = 0, place = 0;  // place among the parent's members

    // Unused places are below any horizon, and their d^2 is not 0.
    LightGroup() { reach.fill(std::numeric_limits<real>::lowest()), spread2.fill(1); }
    void add(const LightNode& n) {
        const size_t k = members++;
        x[k] = n.centre.x, y[k] = n.centre.y, z[k] = n.centre.z;
        reach[k] = n.reach, spread2[k] = n.spread2;
        axis_x[k] = n.axis.x, axis_y[k] = n.axis.y, axis_z[k] = n.axis.z;
        round[k] = n.round, behind[k] = n.behind;
        twosided[k] = n.twosided, strength[k] = n.strength;
    }
};

// Estimated contributions of members to a surface at p with normal m on the side of the eye.  For
// d^2 stands d^2 + spread2: only a near point has no finite weight.  For the height of the centre
// above the surface's plane stands that of the sphere's top.
struct LightWeights {
    LightGroup::Row<real> of;
    LightGroup::Row<real> can;  // 0: all of it is below the horizon or turned away; else 1
};
inline LightWeights weights(const LightGroup& g, vec3 p, vec3 m) {
    LightWeights w;
    for (size_t k = 0; k < max_members; ++k) {
        const real x = g.x[k] - p.x, y = g.y[k] - p.y, z = g.z[k] - p.z;
        const real d2 = x * x + y * y + z * z + g.spread2[k], d = std::sqrt(d2), per_d2 = 1 / d2;
        const real height = m.x * x + m.y * y + m.z * z + g.reach[k];
        const real top = height < d ? height : d;
        const real front = g.behind[k] - (g.axis_x[k] * x + g.axis_y[k] * y + g.axis_z[k] * z);
        const real back = -front * g.twosided[k];
        // At most d, though a group may reach far beyond its distance.
        const real lit = front > back ? front : back;
        const real facing = (lit < d ? lit : d) + g.round[k] * d;
        w.can[k] = top > 0 && facing > 0 ? real(1) : real(0);
        w.of[k] = w.can[k] * g.strength[k] * (top * per_d2) * (facing * per_d2);
    }
    return w;
}

// A sum in pairs, as vector instructions add.
inline real sum_of(const LightGroup::Row<real>& a) {
    return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}

// Probabilities of members.
inline LightGroup::Row<real> shares(const LightGroup& g, vec3 p, vec3 m) {
    const LightWeights w = weights(g, p, m);
    const real sum = sum_of(w.of), number = sum_of(w.can);
    // Part of a denormal sum could be rounded to all of it.
    const bool is_sum = sum >= std::numeric_limits<real>::min() && sum < infinity;
    const real by_weight = is_sum ? (1 - even_part) / sum : 0;
    const real even = (is_sum ? even_part : 1) / number;
    LightGroup::Row<real> of;
    for (size_t k = 0; k < max_members; ++k)
        of[k] = (is_sum ? w.of[k] * by_weight : 0) + w.can[k] * even;
    if (number == 0) of = {1};  // none contributes, whichever is chosen
    return of;
}

// Members share [0,1): the one whose part holds u, and where that part begins.
inline std::pair<size_t, real> member_at(const LightGroup::Row<real>& share, real u) {
    std::pair<size_t, real> found;
    real begin = 0;
    for (size_t k = 0; k < max_members; begin += share[k++])
        if (share[k] > 0 && begin <= u) found = {k, begin};  // rounding may leave a gap below 1
    return found;
}

class LightTree {
public:
    LightTree() = default;
    // Of lights whose strengths are relative to the greatest.
    LightTree(const std::vector<Light>& lights, const std::vector<real>& strengths)
        : places_(lights.size()) {
        std::vector<LightNode> all;
        for (size_t i = 0; i < lights.size(); ++i)
            all.push_back(node_of(lights[i], strengths[i], uint32_t(i)));
        if (lights.size() > 1) add_group(std::move(all), 0, 0);
    }

    // A light, and the probability that it is chosen.
    struct Choice {
        size_t light = 0;
        real probability = 1;
    };
    // For a surface at p with normal m on the side of the eye, by u in [0,1): down from the group
    // of all lights, in each to the member that u chooses, until that is a light.
    Choice choose(vec3 p, vec3 m, real u) const {
        if (groups_.empty()) return {};
        real probability = 1;
        for (const LightGroup* group = &groups_[0];;) {
            const LightGroup::Row<real> share = shares(*group, p, m);
            const auto [k, begin] = member_at(share, u);
            probability *= share[k];
            if (group->is_light[k]) return {group->child[k], probability};
            // Where u lies in the part of that member is a random number of its own.
            u = std::clamp((u - begin) / share[k], real(0), below_one);
            group = &groups_[group->child[k]];
        }
    }
    // The probability that it chooses this light.
    real probability_of(size_t light, vec3 p, vec3 m) const {
        return groups_.empty() ? 1 : probability_of(places_[light], p, m);
    }

    // Calls visit(light, weight) for all lights that can contribute.
    template <class Visit>
    void visit_weights(vec3 p, vec3 m, Visit visit) const {
        for (const LightGroup& g : groups_) {
            const LightWeights w = weights(g, p, m);
            for (size_t k = 0; k < g.members; ++k)
                if (g.is_light[k] && w.can[k] > 0) visit(size_t(g.child[k]), w.of[k]);
        }
    }

private:
    using Part = std::vector<LightNode>;
    struct Place {
        uint32_t group = 0, member = 0;
    };
    std::vector<LightGroup> groups_;  // the first holds all lights; none if there is one
    std::vector<Place> places_;       // of lights

    real probability_of(Place at, vec3 p, vec3 m) const {
        const LightGroup& g = groups_[at.group];
        const real above = at.group == 0 ? 1 : probability_of({g.parent, g.place}, p, m);
        return above * shares(g, p, m)[at.member];
    }

    // ---- The tree -------------------------------------------------------------------------------

    // Makes the group of two lights or more, and those below it; returns its number.
    uint32_t add_group(Part lights, uint32_t parent, uint32_t place) {
        const uint32_t at = uint32_t(groups_.size());
        groups_.emplace_back();
        groups_[at].parent = parent, groups_[at].place = place;
        std::vector<Part> parts = parts_of(std::move(lights));
        for (uint32_t k = 0; k < parts.size(); ++k) {
            const bool is_light = parts[k].size() == 1;
            const LightNode node = is_light ? parts[k][0] : group_of(parts[k]);
            groups_[at].add(node), groups_[at].is_light[k] = is_light;
            if (is_light) places_[node.light] = {at, k};
            const uint32_t child = is_light ? node.light : add_group(std::move(parts[k]), at, k);
            groups_[at].child[k] = child;
        }
        return at;
    }

    static LightNode group_of(const Part& lights) {
        LightNode g;
        for (const LightNode& n : lights) g.strength += n.strength;
        auto part = [&](const LightNode& n) {
            return g.strength > 0 ? n.strength / g.strength : 1 / real(lights.size());
        };
        bool is_flat = true;  // polygons of one side with the same normal: all may be turned away
        for (const LightNode& n : lights) {
            const bool one_side = n.round == 0 && n.twosided == 0;
            g.centre += n.centre * part(n);
            if (one_side) g.axis += n.axis * part(n);
            is_flat &= one_side && n.axis == lights[0].axis;
        }
        for (const LightNode& n : lights) {
            const vec3 off = n.centre - g.centre;
            g.spread2 += (dot(off, off) + n.spread2) * part(n);
            g.reach = std::max(g.reach, (length(off) + n.reach) * (1 + 8 * ulp));
        }
        if (is_flat) g.axis = lights[0].axis;
        g.round = is_flat ? 0 : std::max(1 - length(g.axis), 8 * ulp);
        g.behind = g.reach;
        return g;
    }

    // Lights of more than an eighth of the strength are members of their own.  The others are cut
    // at medians of the longest axis.
    static std::vector<Part> parts_of(Part lights) {
        real sum = 0;
        for (const LightNode& n : lights) sum += n.strength;
        std::ranges::stable_sort(lights, std::ranges::greater{}, &LightNode::strength);
        std::vector<Part> parts;
        const size_t most = std::min(max_members, lights.size());
        while (parts.size() + 1 < most && lights[parts.size()].strength > sum / max_members)
            parts.push_back({lights[parts.size()]});
        lights.erase(lights.begin(), lights.begin() + ptrdiff_t(parts.size()));
        cut(std::move(lights), most - parts.size(), parts);
        return parts;
    }
    static void cut(Part lights, size_t number, std::vector<Part>& parts) {
        if (number == 1) return parts.push_back(std::move(lights));
        Box box;
        for (const LightNode& n : lights) box.add(n.centre);
        const vec3 e = box.hi - box.lo;
        const auto a = axis[e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2];
        std::ranges::stable_sort(lights, {}, [&](const LightNode& n) { return n.centre.*a; });
        const auto middle = lights.begin() + ptrdiff_t(lights.size() * (number / 2) / number);
        cut({lights.begin(), middle}, number / 2, parts);
        cut({middle, lights.end()}, number - number / 2, parts);
    }
};

}  // namespace penumbra

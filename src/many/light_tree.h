// many/light_tree.h  1  light selection in a tree of lights
//
// Lights that are near each other form groups, and groups larger groups.  From the root, the choice
// descends from group to member, each time with probabilities by the members' estimated
// contributions (after Conty Estevez, Kulla 2018); a part of each step goes to all members alike.
#pragma once
#include <array>

#include "world/light_choice.h"

namespace penumbra {

inline constexpr size_t max_members = 8;

// Up to eight members, in rows: a loop over a row becomes vector instructions.
struct LightGroup {
    template <class T>
    using Row = std::array<T, max_members>;
    Row<real> x{}, y{}, z{}, radius{}, spread2{}, axis_x{}, axis_y{}, axis_z{}, round{}, behind{},
        twosided{}, intensity{};
    Row<uint32_t> child{};  // the number of a group or light
    Row<bool> is_light{};
    uint32_t members = 0, parent = 0, place = 0;  // place among the parent's members

    // Unused places are below any horizon, and their d^2 is not 0.
    LightGroup() { radius.fill(std::numeric_limits<real>::lowest()), spread2.fill(1); }
    void add(const DistantLight& light) {
        const size_t k = members++;
        x[k] = light.centre.x, y[k] = light.centre.y, z[k] = light.centre.z;
        radius[k] = light.radius, spread2[k] = light.spread2;
        axis_x[k] = light.axis.x, axis_y[k] = light.axis.y, axis_z[k] = light.axis.z;
        round[k] = light.round, behind[k] = light.behind;
        twosided[k] = light.twosided, intensity[k] = light.intensity;
    }
    DistantLight member(size_t k) const {
        return {{x[k], y[k], z[k]}, radius[k], spread2[k],  {axis_x[k], axis_y[k], axis_z[k]},
                round[k],           behind[k], twosided[k], intensity[k]};
    }
};

// Weights of the members, see LightWeight.
struct LightWeights {
    LightGroup::Row<real> value, can;
};
inline LightWeights weights(const LightGroup& g, vec3 p, vec3 m) {
    LightWeights w;
    for (size_t k = 0; k < max_members; ++k) {
        const LightWeight member = light_weight(g.member(k), p, m);
        w.value[k] = member.value, w.can[k] = member.can;
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
    const LightShares shares({sum_of(w.value), sum_of(w.can)});
    LightGroup::Row<real> of;
    for (size_t k = 0; k < max_members; ++k) of[k] = shares.of({w.value[k], w.can[k]});
    if (shares.none) of = {1};
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
    LightTree(const std::vector<Light>& lights, const std::vector<double>& intensities)
        : places_(lights.size()) {
        Part all;
        for (const DistantLight& light : from_afar(lights, intensities))
            all.push_back({light, uint32_t(all.size())});
        if (lights.size() > 1) add_group(std::move(all), 0, 0);
    }

    // For a surface at p with normal m on the side of the eye, by u in [0,1): down from the group
    // of all lights, in each to the member that u chooses, until that is a light.
    ChosenLight choose(vec3 p, vec3 m, real u) const {
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
                if (g.is_light[k] && w.can[k] > 0) visit(size_t(g.child[k]), w.value[k]);
        }
    }

private:
    struct Item : DistantLight {
        uint32_t light = 0;
    };
    using Part = std::vector<Item>;
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
            const Item member = is_light ? parts[k][0] : Item{together(parts[k])};
            groups_[at].add(member), groups_[at].is_light[k] = is_light;
            if (is_light) places_[member.light] = {at, k};
            const uint32_t child = is_light ? member.light : add_group(std::move(parts[k]), at, k);
            groups_[at].child[k] = child;
        }
        return at;
    }

    static DistantLight together(const Part& lights) {
        DistantLight g;
        for (const Item& n : lights) g.intensity += n.intensity;
        auto part = [&](const Item& n) {
            return g.intensity > 0 ? n.intensity / g.intensity : 1 / real(lights.size());
        };
        bool is_flat = true;  // polygons of one side with the same normal: all may be turned away
        for (const Item& n : lights) {
            const bool one_side = n.round == 0 && n.twosided == 0;
            g.centre += n.centre * part(n);
            if (one_side) g.axis += n.axis * part(n);
            is_flat &= one_side && n.axis == lights[0].axis;
        }
        for (const Item& n : lights) {
            const vec3 off = n.centre - g.centre;
            g.spread2 += (dot(off, off) + n.spread2) * part(n);
            g.radius = std::max(g.radius, (length(off) + n.radius) * (1 + 8 * ulp));
        }
        if (is_flat) g.axis = lights[0].axis;
        g.round = is_flat ? 0 : std::max(1 - length(g.axis), 8 * ulp);
        g.behind = g.radius;
        return g;
    }

    // Lights of more than an eighth of the intensity are members of their own.  The others are cut
    // at medians of the longest axis.
    static std::vector<Part> parts_of(Part lights) {
        real sum = 0;
        for (const Item& n : lights) sum += n.intensity;
        std::ranges::stable_sort(lights, std::ranges::greater{}, &Item::intensity);
        std::vector<Part> parts;
        const size_t most = std::min(max_members, lights.size());
        while (parts.size() + 1 < most && lights[parts.size()].intensity > sum / max_members)
            parts.push_back({lights[parts.size()]});
        lights.erase(lights.begin(), lights.begin() + ptrdiff_t(parts.size()));
        cut(std::move(lights), most - parts.size(), parts);
        return parts;
    }
    static void cut(Part lights, size_t number, std::vector<Part>& parts) {
        if (number == 1) return parts.push_back(std::move(lights));
        Box box;
        for (const Item& n : lights) box.add(n.centre);
        const vec3 e = box.hi - box.lo;
        const auto a = axis[e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2];
        std::ranges::stable_sort(lights, {}, [&](const Item& n) { return n.centre.*a; });
        const auto middle = lights.begin() + ptrdiff_t(lights.size() * (number / 2) / number);
        cut({lights.begin(), middle}, number / 2, parts);
        cut({middle, lights.end()}, number - number / 2, parts);
    }
};

}  // namespace penumbra

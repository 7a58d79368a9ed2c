// world/light_choice.h  3  light selection by estimated contribution
//
// A sample chooses one light of several, each with a probability by what it seems to send (Shirley,
// Wang, Zimmerman 1996).
#pragma once
#include <limits>
#include <vector>

#include "world/lights.h"

namespace penumbra {

// ---- Estimates ----------------------------------------------------------------------------------

// An estimate may be wrong by any factor, because it does not know what hides a light.  So a part
// of all choices goes to all lights alike that can contribute (a defensive mixture, Hesterberg
// 1995): none starves.
inline constexpr real even_part = real(0.0625);

// A light, or several together, from afar: it sends L A cos_l cos_s / d^2 to a surface.  L A is its
// intensity, d the distance of its centre, and the cosines are those at both ends.
struct DistantLight {
    vec3 centre = {};   // of several: the mean of theirs, by intensity
    real radius = 0;    // radius of a sphere about the centre that holds all
    real spread2 = 0;   // radius^2; of several: mean square of the distance from the centre
    vec3 axis = {};     // normal of a polygon; of several: the mean of those of one side
    real round = 1;     // the part that shines in all directions
    real behind = 0;    // distance behind the plane through the centre that is still lit, or < 0
    real twosided = 0;  // 1: it shines against its axis, too
    real intensity = 0;
};
inline DistantLight from_afar(const Light& l, real intensity) {
    DistantLight light{l.centre, l.radius, sqr(l.radius)};
    light.intensity = intensity;
    if (l.is_round()) return light;
    // A polygon does not shine along its own plane, within rounding.
    light.axis = l.n, light.round = 0, light.twosided = l.twosided, light.behind = -2 * l.error;
    return light;
}

// Its estimated contribution to a surface at p with normal m on the side of the eye.  For d^2
// stands d^2 + spread2: only a point light at p itself has no finite weight.  For the height of the
// centre above the surface's plane stands that of the sphere's top.
struct LightWeight {
    real value;
    real can;  // 0: all of it is below the horizon or turned away; else 1
};
inline LightWeight light_weight(const DistantLight& light, vec3 p, vec3 m) {
    const vec3 to = light.centre - p;
    const real d2 = dot(to, to) + light.spread2, d = std::sqrt(d2), per_d2 = 1 / d2;
    const real height = dot(m, to) + light.radius;
    const real top = height < d ? height : d;
    const real front = light.behind - dot(light.axis, to);
    const real back = -front * light.twosided;
    // At most d, though several may extend far beyond their distance.
    const real lit = front > back ? front : back;
    const real facing = (lit < d ? lit : d) + light.round * d;
    const real can = top > 0 && facing > 0 ? real(1) : real(0);
    // With `can` elsewhere GCC 12 makes no vector instructions of a loop over lights.
    return {light.intensity * (top * per_d2) * (facing * per_d2) * can, can};
}

// Probabilities, by the sums of weights over all lights to choose from.
struct LightShares {
    bool none;  // no light can contribute: whichever is chosen
    real by_weight, even;

    explicit LightShares(LightWeight sum) : none(sum.can == 0) {
        // The reciprocal of a denormal sum may be infinite.
        const bool is_sum = sum.value >= std::numeric_limits<real>::min() && sum.value < infinity;
        by_weight = is_sum ? (1 - even_part) / sum.value : 0;
        even = (is_sum ? even_part : 1) / sum.can;
    }
    real of(LightWeight w) const {
        return (by_weight > 0 ? w.value * by_weight : 0) + w.can * even;
    }
};

// ---- Choices ------------------------------------------------------------------------------------

// A light, and the probability that it is chosen.
struct ChosenLight {
    size_t light = 0;
    real probability = 1;
};

// The intensity of each light, see lights.h.
inline std::vector<double> intensities_of(const std::vector<Light>& lights) {
    std::vector<double> all;
    for (const Light& l : lights) all.push_back(intensity(l));
    return all;
}

// Lights from afar.  Their intensities become relative to the greatest, so that a float holds them.
inline std::vector<DistantLight> from_afar(const std::vector<Light>& lights,
                                           const std::vector<double>& intensities) {
    double most = std::numeric_limits<double>::min();
    for (double x : intensities) most = std::max(most, x);
    std::vector<DistantLight> all;
    for (size_t i = 0; i < lights.size(); ++i)
        all.push_back(from_afar(lights[i], real(intensities[i] / most)));
    return all;
}

// Each choice looks at all lights, of which there is one at least.
class LightList {
public:
    LightList() = default;
    LightList(const std::vector<Light>& lights, const std::vector<double>& intensities)
        : lights_(from_afar(lights, intensities)) {}

    // For a surface at p with normal m on the side of the eye, by u in [0,1): lights share [0,1),
    // and the one whose part holds u is chosen.
    ChosenLight choose(vec3 p, vec3 m, real u) const {
        ChosenLight chosen;
        const LightShares shares = shares_at(p, m);
        real begin = 0;
        for (size_t i = 0; i < lights_.size() && begin <= u; ++i) {
            const real share = share_of(i, shares, p, m);
            if (share > 0) chosen = {i, share};  // rounding may leave a gap below 1
            begin += share;
        }
        return chosen;
    }
    // The probability that it chooses this light.
    real probability_of(size_t light, vec3 p, vec3 m) const {
        return share_of(light, shares_at(p, m), p, m);
    }

private:
    std::vector<DistantLight> lights_;

    LightShares shares_at(vec3 p, vec3 m) const {
        LightWeight sum{};
        for (const DistantLight& light : lights_) {
            const LightWeight w = light_weight(light, p, m);
            sum.value += w.value, sum.can += w.can;
        }
        return LightShares(sum);
    }
    real share_of(size_t light, const LightShares& shares, vec3 p, vec3 m) const {
        if (lights_.size() == 1 || shares.none) return light == 0;
        return shares.of(light_weight(lights_[light], p, m));
    }
};

}  // namespace penumbra

// world/light_choice.h  3  light selection by estimated contribution
#pragma once
#include <array>
#include <vector>

#include "world/lights.h"

// With 5 lights (atelier) weights pay off; with 7 (furnace) they take more time than they save.
inline constexpr size_t most_weighed = 6;

// Seen from afar, a light of radiance L sends it L A cos_l cos_s / d^2: A is its area, or the disc
// that a sphere shows, d the distance of its centre, and the cosines are those at both ends.
inline double strength(const Light& l) {
    const double L = double(mean_of(l.L)), r = double(l.r);
    if (l.kind == Light::Kind::point) return L;
    if (l.kind == Light::Kind::sphere) return L * std::numbers::pi * r * r;
    return L * double(length(l.area_vector()));
}

// Computes what the weights of lights need.
inline void prepare_weights(std::vector<Light>& lights) {
    double strongest = 0;
    for (const Light& l : lights) strongest = std::max(strongest, strength(l));
    for (Light& l : lights) {
        l.strength = std::max(real(strength(l) / strongest), std::numeric_limits<real>::min());
        l.centre = l.p, l.reach = l.r;
        if (l.is_round()) continue;
        const bool quad = l.kind == Light::Kind::quad;
        const vec3 diagonal = l.u + l.v, c = diagonal / (quad ? 2 : 3);
        l.centre = l.p + c;
        l.reach = quad ? std::max(length(diagonal), length(l.u - l.v)) / 2
                       : std::max({length(c), length(l.u - c), length(l.v - c)});
    }
}

// Estimated contribution of a light to a surface at p with normal m on the side of the eye.  It has
// d^2 + r^2 for d^2, so that a near light keeps a finite weight, and the height of the sphere's top
// above the surface's plane for that of its centre: a light has weight 0 only if all of it is below
// the horizon or turned away.  Any weights are unbiased as long as lights of weight 0 contribute
// nothing.
inline real light_weight(const Light& l, vec3 p, vec3 m) {
    // Divided by at least the square of the least distance nothing overflows, and nothing is 0/0.
    constexpr real least = std::numeric_limits<real>::min() / ulp;
    const vec3 f = l.centre - p;
    const real d2 = dot(f, f) + std::max(sqr(l.reach), least), per_d2 = 1 / d2;
    const real top = dot(m, f) + l.reach, front = -dot(l.n, f);
    const real facing = l.is_round() ? std::sqrt(d2) : l.twosided ? std::abs(front) : front;
    return l.strength * (std::max(top, real(0)) * per_d2) * (std::max(facing, real(0)) * per_d2);
}

// Nothing if there is one light or too many, if none contributes, or if the sum is out of range.
struct LightWeights {
    std::array<real, most_weighed> of;
    real sum = 0;
};
inline std::optional<LightWeights> light_weights(const std::vector<Light>& lights, vec3 p, vec3 m) {
    if (lights.size() < 2 || lights.size() > most_weighed) return {};
    LightWeights w;
    for (size_t i = 0; i < lights.size(); ++i) w.sum += w.of[i] = light_weight(lights[i], p, m);
    // Part of a denormal sum could be rounded to all of it.
    if (!(w.sum >= std::numeric_limits<real>::min() && w.sum < infinity)) return {};
    return w;
}

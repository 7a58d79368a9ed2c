// world/light_choice.h  3  which of a few lights is worth a sample
#pragma once
#include <array>
#include <vector>

#include "world/lights.h"

// With 5 lights (atelier) weights pay; with 7 (furnace) they take more time than they give.
inline constexpr size_t most_weighed = 6;

// Seen from afar, a light of radiance L sends it L A cos_l cos_s / d^2: A is its area, or the disc
// that a sphere shows, d the distance of its centre, and the cosines are those at both ends.
inline double strength(const Light& l) {
    const double L = double(mean_of(l.L)), r = double(l.r);
    if (l.kind == Light::Kind::point) return L;
    if (l.kind == Light::Kind::sphere) return L * std::numbers::pi * r * r;
    return L * double(length(l.area_vector()));
}

// Computes what lights are weighed by.
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

// What a light can send to a surface at p whose normal, on the side of the eye, is m.  Here d^2 +
// r^2 stands for d^2: what is near keeps a finite weight.  The height of the sphere's top above the
// surface's plane stands for that of its centre: a light weighs 0 only if all of it is below the
// horizon or turned away.  Whatever the weights, the light found is unbiased as long as what weighs
// 0 sends nothing.
inline real light_weight(const Light& l, vec3 p, vec3 m) {
    // Over the square of the least distance nothing overflows, and nothing is 0/0.
    constexpr real least = std::numeric_limits<real>::min() / ulp;
    const vec3 f = l.centre - p;
    const real d2 = dot(f, f) + std::max(sqr(l.reach), least), per_d2 = 1 / d2;
    const real top = dot(m, f) + l.reach, front = -dot(l.n, f);
    const real facing = l.is_round() ? std::sqrt(d2) : l.twosided ? std::abs(front) : front;
    return l.strength * (std::max(top, real(0)) * per_d2) * (std::max(facing, real(0)) * per_d2);
}

// Nothing if there is no choice, if lights are too many, if none is of use, or numbers cannot tell.
struct LightWeights {
    std::array<real, most_weighed> of;
    real sum = 0;
};
inline std::optional<LightWeights> light_weights(const std::vector<Light>& lights, vec3 p, vec3 m) {
    if (lights.size() < 2 || lights.size() > most_weighed) return {};
    LightWeights w;
    for (size_t i = 0; i < lights.size(); ++i) w.sum += w.of[i] = light_weight(lights[i], p, m);
    // Denormal, a part of it could be rounded to all of it.
    if (!(w.sum >= std::numeric_limits<real>::min() && w.sum < infinity)) return {};
    return w;
}

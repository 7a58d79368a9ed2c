// world/light_choice.h  3  which of a few lights is worth a sample
#pragma once
#include <array>
#include <vector>

#include "world/lights.h"

// How one of several lights is chosen to aim at.
enum class Pick {
    power,  // in proportion to what it emits
    place   // to about what it sends to where it is needed; many lights: by power
};

// What each of a few lights can send to a surface, in a loop without branches.
//
// Seen from afar, a light of radiance L sends it L A cos_l cos_s / d^2: A is its area, or the disc
// that a sphere shows, d the distance of its centre, and the cosines are those at both ends.  Here
// d^2 + r^2 stands for d^2, r being the radius of the sphere about the light: what is near keeps a
// finite weight.  The height of that sphere's top above the surface's plane stands for that of its
// centre: a light weighs 0 only if all of it is below the horizon or turned away.  Whatever the
// weights, the light found is unbiased as long as what weighs 0 sends nothing.
struct FewLights {
    // With 5 lights (atelier) this pays; with 7 (furnace) it takes more time than it gives.
    static constexpr size_t most = 6, room = 8;
    using Each = std::array<real, room>;
    size_t n = 0;             // 0: there is no choice, or lights are too many
    Each x{}, y{}, z{}, r{};  // centres and radii
    Each r2{};                // r^2, not 0
    Each nx{}, ny{}, nz{};    // normals; of spheres and points 0
    Each both{};              // 1: emits on both sides
    Each round{};             // 1: a sphere or a point, whose cos_l is 1
    Each strength{};          // L A over that of the strongest; 0: no light

    // Of the first n, for a surface at p whose normal, on the side of the eye, is m.
    Each weights(vec3 p, vec3 m) const {
        Each w{};
        n <= room / 2 ? weigh<room / 2>(w, p, m) : weigh<room>(w, p, m);
        return w;
    }

private:
    template <size_t count>  // fixed, so that compilers make vectors of it
    void weigh(Each& w, vec3 p, vec3 m) const {
        for (size_t i = 0; i < count; ++i) {
            const real fx = x[i] - p.x, fy = y[i] - p.y, fz = z[i] - p.z;
            const real d2 = fx * fx + fy * fy + fz * fz + r2[i], per_d2 = 1 / d2;
            const real top = m.x * fx + m.y * fy + m.z * fz + r[i];
            const real front = -(nx[i] * fx + ny[i] * fy + nz[i] * fz);
            const real facing =
                std::max(std::max(front, -both[i] * front), round[i] * std::sqrt(d2));
            w[i] = strength[i] * (std::max(top, real(0)) * per_d2) * (facing * per_d2);
        }
    }
};

// The sphere about a light, and L A.
struct LightBounds {
    vec3 centre;
    real r = 0;
    double strength = 0;
};
inline LightBounds bounds_of(const Light& l) {
    const double L = double(mean_of(l.L));
    if (l.kind == Light::Kind::point) return {l.p, 0, L};
    if (l.kind == Light::Kind::sphere)
        return {l.p, l.r, L * std::numbers::pi * double(l.r) * double(l.r)};
    const double area = double(length(l.area_vector()));
    const vec3 diagonal = l.u + l.v;
    if (l.kind == Light::Kind::quad)
        return {l.p + diagonal / 2, std::max(length(diagonal), length(l.u - l.v)) / 2, L * area};
    const vec3 c = diagonal / 3;
    return {l.p + c, std::max({length(c), length(l.u - c), length(l.v - c)}), L * area};
}

inline FewLights few_lights(const std::vector<Light>& lights) {
    FewLights few;
    if (lights.size() < 2 || lights.size() > FewLights::most) return few;
    // Over the square of the least distance nothing overflows, and nothing is 0/0.
    constexpr real least = std::numeric_limits<real>::min() / ulp;
    double strongest = 0;
    for (const Light& l : lights) strongest = std::max(strongest, bounds_of(l).strength);
    few.r2.fill(least);
    for (const Light& l : lights) {
        const LightBounds b = bounds_of(l);
        const size_t i = few.n++;
        few.x[i] = b.centre.x, few.y[i] = b.centre.y, few.z[i] = b.centre.z;
        few.r[i] = b.r, few.r2[i] = std::max(sqr(b.r), least);
        few.nx[i] = l.n.x, few.ny[i] = l.n.y, few.nz[i] = l.n.z;
        few.both[i] = l.twosided;
        few.round[i] = l.kind == Light::Kind::sphere || l.kind == Light::Kind::point;
        few.strength[i] = std::max(real(b.strength / strongest), std::numeric_limits<real>::min());
    }
    return few;
}

// Weights and their running sums.  Nothing if no light is of use, or numbers cannot tell.
struct LightWeights {
    size_t n;
    FewLights::Each of, sums;
    real sum() const { return sums[n - 1]; }
};
inline std::optional<LightWeights> light_weights(const FewLights& few, vec3 p, vec3 m) {
    LightWeights w{few.n, few.weights(p, m), {}};
    real sum = 0;
    for (size_t i = 0; i < few.n; ++i) w.sums[i] = sum += w.of[i];
    // Denormal, a part of it could be rounded to all of it.
    if (!(sum >= std::numeric_limits<real>::min() && sum < infinity)) return {};
    return w;
}

// A light, and the probability that it is chosen.
struct LightPick {
    size_t light = 0;
    real pick = 1;
};
inline LightPick choose_light(const LightWeights& w, real u) {
    const real mark = u * w.sum();  // less than the sum
    size_t chosen = 0;
    while (w.sums[chosen] <= mark) ++chosen;
    return {chosen, w.of[chosen] / w.sum()};
}
inline real pick_of(const LightWeights& w, size_t light) { return w.of[light] / w.sum(); }

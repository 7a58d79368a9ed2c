// labs/indirect_paths.h  3  paths that end on illumination maps, or continue there
//
// At a diffuse surface point y, maps approximate the reflected radiance R(y) by R_map(y) =
// rho E(y) / pi, with noise and discretisation error.  After a bounce there are three methods.
//
// map:        R_map(y) ends the path (final gathering; Reichert 1992).  Biased by the maps' error,
//             averaged over the surfaces that one bounce reaches.
// control:    R_map(y) + [xi < q] / q (R^(y) - R_map(y)).  R^ is the path's own estimate, by a
//             light sample and one more bounce, recursively.  This is Russian roulette that returns
//             the maps' value instead of 0 when it ends a path (Szecsi, Szirmay-Kalos, Kelemen
//             2003, Variance reduction for Russian roulette).  Unbiased for any maps.
// regression: A slope times R_map in both places.  Unbiased, because other paths give the slope.
//
// All this holds for the triangles of the maps.  Where they approximate spheres (facets.h), their
// light differs from that of the spheres.
//
// The number of bounces is unlimited, as in the maps: the scene's depth must be out of reach.
#pragma once
#include "radiosity/gather.h"

// ---- Sample values ------------------------------------------------------------------------------

// Sample values of a path of any length.  From vertex `structured` on they are independent, like
// those of particles.
class EndlessNumbers {
public:
    static constexpr int structured = 8;
    static Pattern pattern(SamplerKind kind, uint64_t seed, uint64_t spp) {
        return make_pattern(kind, seed, structured, spp);
    }
    static Pattern independent(uint64_t seed) {
        return make_pattern(SamplerKind::independent, seed, 0, 0);
    }

    EndlessNumbers(const Sampler& first, const Sampler& rest) : first_(first), rest_(rest) {}
    // Sample values of vertex k.
    const Sampler& operator[](int k) const { return k < structured ? first_ : rest_; }
    // The value that decides if the path continues at vertex k: the last one of vertex k - 1.
    real xi(int k) const { return (*this)[k - 1].get(dimension(k - 1, Draw::roulette)); }

private:
    const Sampler first_, rest_;
};

// ---- Russian roulette ---------------------------------------------------------------------------

// Paths continue with probability throughput / threshold, as in step().  The threshold 2/3 was the
// best in measurements (`make indirect`).
inline constexpr real by_throughput = real(2) / 3, never = infinity;

// The probability to continue.  It is below 1 in long paths, so that they end between white walls.
inline real probability(real threshold, const Segment& s) {
    const real most = s.k < EndlessNumbers::structured ? 1 : real(0.98);
    return std::min(most, max_of(s.beta) / threshold);
}

// ---- Paths --------------------------------------------------------------------------------------

struct Gather {
    const Scene& scene;
    Technique technique;  // its roulette is 0: probability() replaces it
    const KnownLight& known;
    real threshold = by_throughput;
    rgb slope{1, 1, 1};
};

// Radiance along a segment.  The path always continues at the end of the first segment.
inline rgb radiance_along(const Gather& g, const Segment& first, const EndlessNumbers& u) {
    rgb L;
    for (Segment s = first;;) {
        const real q = s.k > first.k ? probability(g.threshold, s) : 1;
        const bool goes = s.k == first.k || (q > 0 && u.xi(s.k) < q);
        // The weight of the maps' value: 1 - [xi < q] / q.
        const real weight = s.k == first.k ? 0 : goes ? 1 - 1 / q : 1;
        // At the scene's depth step() finds emission only.
        Segment now = s;
        if (goes)
            now.beta /= q;
        else
            now.k = g.scene.depth;
        const Step e = step(g.scene, g.technique, now, u[s.k]);
        L += s.beta * e.Le * e.weight + now.beta * e.direct.L;
        if (e.met && weight != 0) L += s.beta * g.slope * g.known.at(e.x) * weight;
        if (e.end) return L;
        s = e.next;
    }
}

// Radiance along a camera ray.
inline rgb Li(const Gather& g, const Ray& ray, const EndlessNumbers& u) {
    return radiance_along(g, Segment{ray, ray.o}, u);
}

// ---- Slope --------------------------------------------------------------------------------------

// The slope of regression from n paths, per channel.  At the first vertex after a bounce it is the
// b that minimises the mean of (throughput (R^ - b R_map))^2, since the variance of Russian
// roulette grows with that mean.  It is 1 where the maps are black.  The paths begin anywhere on
// the film.  The pattern must be of independent samples, and differ from that of any image.
inline rgb slope_of(const Gather& g, const Pattern& pattern, uint64_t n) {
    const auto [width, height] = g.scene.size;
    std::array<double, 3> both{}, known{};
    for (uint64_t i = 0; i < n; ++i) {
        const Sampler sampler(pattern, 0, i);
        const EndlessNumbers u(sampler, sampler);
        const vec2 film = sampler.get2(film_x);
        const Ray ray =
            camera_ray(g.scene.camera, g.scene.size, film.x * real(width), film.y * real(height));
        const Step seen = step(g.scene, g.technique, {ray, ray.o}, u[0]);
        if (seen.end) continue;
        const Step y = step(g.scene, g.technique, seen.next, u[1]);
        if (!y.met) continue;
        const rgb R_map = seen.next.beta * g.known.at(y.x),
                  emitted = seen.next.beta * y.Le * y.weight, L = radiance_along(g, seen.next, u);
        for (size_t c = 0; c < 3; ++c) {
            const double m = double(R_map.*axis[c]);
            both[c] += double((L - emitted).*axis[c]) * m;
            known[c] += m * m;
        }
    }
    auto slope = [&](size_t c) { return known[c] > 0 ? real(both[c] / known[c]) : 1; };
    return {slope(0), slope(1), slope(2)};
}

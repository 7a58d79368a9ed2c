// labs/indirect_paths.h  3  paths that end on illumination maps, or go on beyond them
//
// At a diffuse surface y the reflected radiance R(y) is known, but for noise and the mesh:
// R_map(y) = rho E(y) / pi.  Where a path has scattered, one of three things follows.
//
// map:        R_map(y) ends the path (final gathering; Reichert 1992).  Biased by the maps' error,
//             in the mean over what one bounce sees of it.
// control:    R_map(y) + [xi < q] / q (R^(y) - R_map(y)).  R^ is the path's own estimate, by a
//             light sample and one more bounce, where the same happens: Russian roulette that
//             returns the maps' value, and not 0, when it ends a path (Szecsi, Szirmay-Kalos,
//             Kelemen 2003, Variance reduction for Russian roulette).  Unbiased, whatever the maps
//             hold.
// regression: a slope times R_map in both places.  Unbiased, for the slope is that of other paths.
//
// All of this is about the scene of triangles that the maps lie on: where these stand for balls
// (facets.h), its light is not that of the balls.
//
// Light is scattered without end, as in the maps: the scene's depth must be too large to be met.
#pragma once
#include "radiosity/gather.h"

// ---- Numbers ------------------------------------------------------------------------------------

// The numbers of a path that may be of any length.  From vertex `structured` on they are
// independent, as those of particles are.
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
    // Those of vertex k.
    const Sampler& operator[](int k) const { return k < structured ? first_ : rest_; }
    // The number that decides whether the path goes on at vertex k: the last of the one before.
    real xi(int k) const { return (*this)[k - 1].get(dimension(k - 1, Draw::roulette)); }

private:
    const Sampler first_, rest_;
};

// ---- When to go on ------------------------------------------------------------------------------

// Paths go on with probability throughput / threshold, the rule of step; two thirds by measurement
// (`make indirect`).
inline constexpr real by_throughput = real(2) / 3, never = infinity;

// The probability at the end of a segment.  A path must end between white walls, too.
inline real probability(real threshold, const Segment& s) {
    const real most = s.k < EndlessNumbers::structured ? 1 : real(0.98);
    return std::min(most, max_of(s.beta) / threshold);
}

// ---- The path -----------------------------------------------------------------------------------

struct Gather {
    const Scene& scene;
    Technique technique;  // its roulette is 0: there is another here
    const KnownLight& known;
    real threshold = by_throughput;
    rgb slope{1, 1, 1};
};

// Radiance along a segment; the path continues at its end in any case.
inline rgb radiance_along(const Gather& g, const Segment& first, const EndlessNumbers& u) {
    rgb L;
    for (Segment s = first;;) {
        const real q = s.k > first.k ? probability(g.threshold, s) : 1;
        const bool goes = s.k == first.k || (q > 0 && u.xi(s.k) < q);
        // Of what the maps know: 1 - [xi < q] / q.
        const real weight = s.k == first.k ? 0 : goes ? 1 - 1 / q : 1;
        // Where a path may scatter no more, emission is all that step finds.
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

// Along a ray from the camera.
inline rgb Li(const Gather& g, const Ray& ray, const EndlessNumbers& u) {
    return radiance_along(g, Segment{ray, ray.o}, u);
}

// ---- The slope ----------------------------------------------------------------------------------

// Of what n paths find at the first vertex that they reach by scattering, over R_map there, a
// channel at a time: the slope b for which the mean of (throughput (R^ - b R_map))^2 is least, for
// by it the variance of Russian roulette grows.  1 where the maps are black.  The paths begin
// anywhere on the film; their pattern of independent numbers must be no image's.
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

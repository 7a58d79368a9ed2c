// labs/indirect_paths.h  4  paths that end on illumination maps or continue there, without bias
//
// At a diffuse surface point y, maps approximate the reflected radiance R(y) by R_map(y) =
// rho E(y) / pi, with noise and discretisation error.  After a bounce these paths estimate R(y) by
//
//     R_map(y) + [xi < q] / q (R^(y) - R_map(y)).
//
// R^ is the path's own estimate, by a light sample and one more bounce, recursively.  This is
// Russian roulette that returns the maps' value instead of 0 when it ends a path (Szecsi,
// Szirmay-Kalos, Kelemen 2003, Variance reduction for Russian roulette).  Unbiased for any maps.
//
// It holds for the triangles of the maps.  Where they approximate spheres (facets.h), their light
// differs from that of the spheres.
//
// The number of bounces is unlimited, as in the maps: the scene's depth must be out of reach.
#pragma once
#include "app/threads.h"
#include "app/views.h"
#include "labs/room.h"
#include "radiosity/gather.h"

namespace penumbra {

// Sample values of a path of any length.  From vertex `structured` on they are independent, like
// those of particles.
class EndlessNumbers {
public:
    static constexpr int structured = 8;
    static SamplerSettings settings(SamplerKind kind, uint64_t seed) {
        return sampler_settings(kind, seed, structured);
    }
    static SamplerSettings independent(uint64_t seed) {
        return sampler_settings(SamplerKind::independent, seed, 0);
    }

    EndlessNumbers(const Sampler& first, const Sampler& rest) : first_(first), rest_(rest) {}
    // Sample values of vertex k.
    const Sampler& operator[](int k) const { return k < structured ? first_ : rest_; }
    // The value that decides if the path continues at vertex k: the last one of vertex k - 1.
    real xi(int k) const { return (*this)[k - 1].get(dimension(k - 1, Dimension::roulette)); }

private:
    const Sampler first_, rest_;
};

struct Gather {
    const Scene& scene;
    Technique technique;  // its roulette is 0: probability() replaces it
    const KnownLight& known;
};

// The probability to continue, 3/2 of the throughput.  It is below 1 in long paths, so that they
// end between white walls.
inline real probability(const PathState& path) {
    const real most = path.k < EndlessNumbers::structured ? 1 : real(0.98);
    return std::min(most, max_of(path.beta) * real(1.5));
}

// Radiance along a camera ray.  The path always continues at its first vertex.
inline rgb Li(const Gather& g, const Ray& ray, const EndlessNumbers& u) {
    rgb L;
    for (PathState path{ray, ray.o};;) {
        const real q = path.k > 0 ? probability(path) : 1;
        const bool goes = path.k == 0 || (q > 0 && u.xi(path.k) < q);
        // The weight of the maps' value: 1 - [xi < q] / q.
        const real weight = path.k == 0 ? 0 : goes ? 1 - 1 / q : 1;
        // At the scene's depth step() finds emission only.
        PathState now = path;
        if (goes)
            now.beta /= q;
        else
            now.k = g.scene.depth;
        const VertexEvents e = step(g.scene, g.technique, now, u[path.k]);
        L += path.beta * e.Le * e.weight + now.beta * e.direct.L;
        if (e.met && weight != 0) L += path.beta * g.known.at(e.vertex) * weight;
        if (e.end != End::no) return L;
        path = e.next;
    }
}

// Renders a scene's triangles.  Its maps have one particle per 64 paths, and edges of at most 1/16
// of the scene's diagonal.  Particles and paths have different seeds.
inline Rendered by_control(const NamedScene& read, uint64_t spp, uint64_t seed) {
    const double start_of_all = processor_seconds();
    const Room room = make_room("", read, double(diagonal(read)) / 16);
    Scene scene = room.scene;
    scene.depth = std::numeric_limits<int>::max();
    const auto [width, height] = scene.size;
    const uint64_t n = spp * uint64_t(width) * uint64_t(height) / 64 + 1;
    Particles p(scene, room.mesh, Particles::settings(SamplerKind::halton, hash(seed, 1)));
    walk(p, n);
    const KnownLight known = known_light(scene, room.mesh, p.map());
    const Gather g{scene, {Direction::bsdf, LightMode::mis, 0}, known};
    const SamplerSettings settings = EndlessNumbers::settings(SamplerKind::sobol, seed),
                          rest = EndlessNumbers::independent(seed);
    Image image(width, height);
    auto row = [&](size_t y, unsigned) {
        for (int x = 0; x < image.width; ++x) {
            rgb sum;
            for (uint64_t i = 0; i < spp; ++i) {
                const PixelSample s{x, int(y), i};
                const Start at = start(scene, settings, s);
                sum += Li(g, at.ray, {at.sampler, Sampler(rest, pixel_number(scene, s), i)});
            }
            for (size_t c = 0; c < 3; ++c) image.at(x, int(y))[c] = float(sum.*axis[c] / real(spp));
        }
    };
    by_workers(size_t(height), all_cores(), row, [](double) {});
    return {std::move(image), {{"cpu_seconds", processor_seconds() - start_of_all}}};
}

}  // namespace penumbra

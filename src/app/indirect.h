// app/indirect.h  4  paths that end on illumination maps, as options ask for them
#pragma once
#include "app/summary.h"
#include "app/walks.h"
#include "radiosity/gather.h"

// The user's target, or the scene's number of samples.
inline Target target_of(const Options& o, const Scene& scene) {
    if (o.spp > 0 || o.seconds > 0 || o.error > 0) return {o.spp, o.seconds, o.error};
    return {scene.samples};
}

inline bool has_maps(const Options& o) { return o.indirect != Indirect::path; }

// The same scene as maps need it, their edges no longer than H: triangles, and light that is
// scattered without end.
inline Faceted endless(const Scene& scene, double H) {
    Faceted f = faceted(scene, H);
    f.scene.depth = std::numeric_limits<int>::max();
    return f;
}

// What maps may cost: unless the user says how many particles, a sixteenth of the time, or one for
// 16 paths, so that their noise, which all pixels share, is little beside that of the paths.  Paths
// that go on need no more than a quarter of that (both by `make indirect`).
inline WalksTarget walks_of(const Options& o, const Scene& scene) {
    const uint64_t share = o.indirect == Indirect::map ? 16 : 64;
    const Target target = target_of(o, scene);
    // Who goes on has to have the same maps, which those that the time ends are not.
    const bool is_kept = !o.checkpoint.empty() || !o.resume.empty();
    if (o.particles > 0) return {o.particles, is_kept ? 0 : target.seconds};
    const uint64_t pixels = uint64_t(scene.size.width) * uint64_t(scene.size.height);
    // Of an image that its error ends nobody knows the samples: as many as the scene's at most.
    const bool unknown = o.error > 0 && (target.samples == 0 || target.samples > scene.samples);
    const double paths = double(pixels) * double(unknown ? scene.samples : target.samples);
    return {uint64_t(std::ceil(paths / double(share))), target.seconds / double(share)};
}

// Maps, and how paths use them.
struct Maps {
    KnownLight known;
    MapStats stats;

    Gather gather(const Options& o, const Scene& scene) const {
        Gather g{scene, o.technique, known};
        g.technique.roulette = 0;
        g.slope = stats.slope;
        if (o.indirect == Indirect::map) g.go_on = never;
        return g;
    }
};

// Of an endless scene, o.mesh given.  Particles, paths that tell the slope, and those of the image
// have keys of their own: they are independent.
inline Maps maps_of(const Options& o, const Scene& scene) {
    const auto start = std::chrono::steady_clock::now();
    const uint64_t key_of_particles = hash(o.seed, 1), key_of_slope = hash(o.seed, 2);
    Maps maps;
    maps.stats.H = o.mesh.value();
    Mesh mesh = make_mesh(scene, maps.stats.H);
    const WalksTarget target = walks_of(o, scene);
    const Pattern pattern =
        Particles::pattern(SamplerKind::halton, key_of_particles, target.particles);
    Walked w = walk_all(scene, mesh, pattern, target, o);
    maps.stats.triangles = mesh.elements();
    maps.stats.particles = w.particles, maps.stats.rays = w.rays, maps.stats.error = w.error;
    maps.known = known_light(scene, std::move(mesh), std::move(w.map));
    if (o.indirect == Indirect::regression && !interrupted) {
        constexpr uint64_t paths = 1 << 14;
        maps.stats.slope =
            slope_of(maps.gather(o, scene), EndlessNumbers::independent(key_of_slope), paths);
    }
    maps.stats.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return maps;
}

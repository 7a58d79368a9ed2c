// labs/indirect_images.h  5  images by whole paths, and by paths that end on maps
#pragma once
#include "labs/indirect_levels.h"
#include "radiosity/walks.h"

namespace indirect {

enum class Method { path, gather, control_variate, regression, endless };
inline constexpr const char* method_names[] = {"path", "map", "control", "regression",
                                               "path --roulette 0"};

// What to draw; 0: no limit, or the default.
struct Asked {
    std::string scene;
    Method method = Method::path;
    double seconds = 0;
    uint64_t spp = 0;
    double H = 0;
    uint64_t particles = 0;
    Size size = {};
};

struct Drawn {
    Image image;
    double samples = 0, core_seconds = 0;
    double H = 0, triangles = 0, map_seconds = 0, map_error = 0;
    std::string bias = "unbiased";  // class of the estimator, of the scene that was read
};

// Maps, and how paths use them; the scene is of triangles, its light scattered without end.
struct Maps {
    Scene scene;
    KnownLight known;
    rgb slope{1, 1, 1};

    Gather gather(Method m) const {
        return {scene,
                {Direction::bsdf, LightMode::mis, 0},
                known,
                m == Method::gather ? never : by_throughput,
                slope};
    }
};

// Unless it is said how many particles: one for 16 paths, or a 16th of the time; paths that go on
// need a quarter of that.  Particles, paths that tell the slope, and those of the image have keys
// of their own: they are independent.
inline Maps maps_of(const Asked& a, const Scene& read, uint64_t seed, Drawn& drawn) {
    const illumination::Clock::time_point start = illumination::Clock::now();
    drawn.H = a.H > 0 ? a.H : double(diagonal(read)) / 16;
    Faceted facets = faceted(read, drawn.H);
    if (facets.has_balls || a.method == Method::gather) drawn.bias = "biased";
    Maps maps{std::move(facets.scene), {}};
    maps.scene.depth = std::numeric_limits<int>::max();
    Mesh mesh = make_mesh(maps.scene, drawn.H);
    const double share = a.method == Method::gather ? 16 : 64;
    const double paths = double(a.spp) * double(read.size.width) * double(read.size.height);
    const WalksTarget target =
        a.particles ? WalksTarget{a.particles, a.seconds}
                    : WalksTarget{uint64_t(std::ceil(paths / share)), a.seconds / share};
    CommonOptions o;
    o.quiet = true;
    Walked w = walk_all(maps.scene, mesh,
                        Particles::pattern(SamplerKind::halton, hash(seed, 1), target.particles),
                        target, o);
    drawn.triangles = double(mesh.elements()), drawn.map_error = w.stated.error;
    maps.known = known_light(maps.scene, std::move(mesh), std::move(w.map));
    if (a.method == Method::regression)
        maps.slope =
            slope_of(maps.gather(a.method), EndlessNumbers::independent(hash(seed, 2)), 1 << 14);
    drawn.map_seconds = illumination::seconds_since(start);
    return maps;
}

// A film's function of a sample.
inline Radiance mapped(const Maps& maps, Method m, const Pattern& pattern, const Pattern& rest) {
    return [&maps, &pattern, &rest, g = maps.gather(m)](const PixelSample& s, Tally&) {
        const Start at = start(maps.scene, pattern, s);
        const Sampler beyond(rest, pixel_number(maps.scene, s), s.i, s.set);
        return Li(g, at.ray, {at.sampler, beyond});
    };
}
inline Radiance whole_paths(const Scene& scene, const Technique& t, const Pattern& pattern) {
    return [=, &scene, &pattern](const PixelSample& s, Tally&) {
        const Start at = start(scene, pattern, s);
        return Li(scene, t, at.ray, at.sampler);
    };
}

inline Drawn draw(const Asked& a, uint64_t seed) {
    Drawn drawn;
    const double before = processor_seconds();
    Scene read = read_scene("scenes/" + a.scene + ".scene").scene;
    if (a.size.width > 0) read.size = a.size;
    const bool by_paths = a.method == Method::path || a.method == Method::endless;
    const Maps maps = by_paths ? Maps{} : maps_of(a, read, seed, drawn);
    const Technique t{Direction::bsdf, LightMode::mis, a.method == Method::path ? roulette : 0};
    const int depth = by_paths ? read.depth : EndlessNumbers::structured;
    const Pattern pattern = make_pattern(SamplerKind::sobol, seed, depth, a.spp),
                  rest = EndlessNumbers::independent(seed);
    const Radiance L =
        by_paths ? whole_paths(read, t, pattern) : mapped(maps, a.method, pattern, rest);
    Film film = make_film(read.size, 1);
    Target target{a.spp, a.seconds};
    if (a.seconds > 0) target.seconds = std::max(1e-9, a.seconds - drawn.map_seconds);
    const illumination::Clock::time_point start = illumination::Clock::now();
    Watch watch;
    watch.elapsed = [&] { return illumination::seconds_since(start); };
    Loop(film, {target, 1, all_cores()}, L, watch).run();
    drawn.image = image_of(film);
    drawn.samples = film.total() / double(film.pixels());
    drawn.core_seconds = processor_seconds() - before;
    return drawn;
}

}  // namespace indirect

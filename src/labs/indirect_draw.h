// labs/indirect_draw.h  5  images by paths that end on maps or continue, by a chosen rule
#pragma once
#include "labs/indirect_paths.h"
#include "labs/room.h"

namespace indirect {

// Options of a render.  0 stands for the scene's value, or the default.
struct Asked {
    std::string scene, way = "control";
    Size size = {};
    SamplerKind sampler = SamplerKind::sobol;
    uint64_t spp = 16, seed = 0, particles = 0;
    double H = 0;
    unsigned threads = all_cores();
};

// The rule by which paths end.  Whole paths use no maps.  If `is_scattered`, the scene's depth
// limits their bounces.
struct Way {
    bool is_whole = false, is_scattered = false, has_slope = false;
    real roulette = 0;  // for whole paths
    real threshold = by_throughput;
};

// Parses "whole:ROULETTE", "endless:ROULETTE" (depth 64), "map", "control", "regression", or
// "over:t", which is control with the threshold t.
inline Way way_of(const std::string& words) {
    const size_t at = words.find(':');
    const std::string kind = words.substr(0, at);
    const real x = at == words.npos ? 0 : real(parse_number(words.substr(at + 1), 100));
    if (kind == "whole") return {true, true, false, x};
    if (kind == "endless") return {true, false, false, x};
    if (kind == "map") return {.threshold = never};
    if (kind == "control") return {};
    if (kind == "regression") return {.has_slope = true};
    if (kind == "over") return {.threshold = x};
    throw UserError(unknown("way", kind, {"whole", "map", "control", "regression", "over"}));
}

struct Drawn {
    Image image;
    double cpu_seconds = 0, map_cpu_seconds = 0, map_error = 0, triangles = 0;
    bool is_biased = false;  // with respect to the scene as read
};

// Renders an image.  Particles, paths for the slope and paths of the image are independent: they
// have different seeds.  The default is one particle per 64 paths, and one per 16 for `map`.
inline Drawn draw(const Asked& a) {
    const double start_of_all = processor_seconds();
    Drawn drawn;
    const Way way = way_of(a.way);
    Scene scene = read_scene(a.scene).scene;
    if (a.size.width > 0) scene.size = a.size;
    const int width = scene.size.width, height = scene.size.height;
    if (!way.is_scattered) scene.depth = way.is_whole ? 64 : std::numeric_limits<int>::max();
    const int depth = way.is_whole ? scene.depth : EndlessNumbers::structured;
    KnownLight known;
    if (!way.is_whole) {
        const double H = a.H > 0 ? a.H : double(diagonal(scene)) / 16;
        Faceted facets = faceted(scene, H);
        scene = std::move(facets.scene);
        if (facets.has_balls || a.way == "map") drawn.is_biased = true;
        Mesh mesh = make_mesh(scene, H);
        const double paths = double(a.spp) * width * height / (a.way == "map" ? 16 : 64);
        const uint64_t n = a.particles ? a.particles : uint64_t(std::ceil(paths));
        Particles p(scene, mesh, Particles::pattern(SamplerKind::halton, hash(a.seed, 1), n));
        walk(p, n, a.threads);
        drawn.map_error = p.error(), drawn.triangles = double(mesh.elements());
        known = known_light(scene, std::move(mesh), p.map());
    }
    Gather g{scene, {Direction::bsdf, LightMode::mis, way.roulette}, known, way.threshold};
    const Pattern rest = EndlessNumbers::independent(a.seed);
    if (way.has_slope) g.slope = slope_of(g, EndlessNumbers::independent(hash(a.seed, 2)), 1 << 14);
    drawn.map_cpu_seconds = way.is_whole ? 0 : processor_seconds() - start_of_all;
    const Pattern pattern = make_pattern(a.sampler, a.seed, depth, a.spp);
    drawn.image = Image(width, height);
    auto row = [&](size_t y) {
        for (int x = 0; x < width; ++x) {
            rgb sum;
            for (uint64_t i = 0; i < a.spp; ++i) {
                const PixelSample s{x, int(y), i};
                const Start at = start(scene, pattern, s);
                const Sampler beyond(rest, pixel_number(scene, s), i);
                sum += way.is_whole ? Li(scene, g.technique, at.ray, at.sampler)
                                    : Li(g, at.ray, {at.sampler, beyond});
            }
            for (size_t c = 0; c < 3; ++c)
                drawn.image.at(x, int(y))[c] = float(sum.*axis[c] / real(a.spp));
        }
    };
    in_parallel(size_t(height), a.threads, row, [](double) {});
    drawn.cpu_seconds = processor_seconds() - start_of_all;
    return drawn;
}

}  // namespace indirect

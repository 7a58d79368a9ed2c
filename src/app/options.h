// app/options.h  2  what the user asks of penumbra
#pragma once
#include <sstream>

#include "app/option.h"
#include "film/sets.h"
#include "path/pathtracer.h"
#include "shadow/estimators.h"
#include "voronoi/weights.h"

// What the image shows.
enum class View { radiance, normal, depth, albedo, bvh, variance };

// How points of a rectangular light are chosen.
enum class Polygons {
    area,  // uniform over its area
    angle  // uniform over the solid angle that it subtends
};

// How light is found that diffuse surfaces send to each other; see radiosity/gather.h.
enum class Indirect { path, map, control, regression };

// Sets of samples: one, and more where noise is.
inline constexpr uint32_t sets_by_noise = 0;

struct PixelIndex {
    int x = 0, y = 0;
};

// From the first to the last of some numbers.
struct Range {
    uint64_t first = 0, last = 0;

    uint64_t count() const { return last - first + 1; }
};
inline std::string as_text(const Range& r) {
    return std::to_string(r.first) + "-" + std::to_string(r.last);
}

struct Options : CommonOptions {
    uint64_t spp = 0;  // 0: the scene's, unless seconds or an error are given
    double error = 0;  // d_rel to stop at; 0: none
    SamplerKind sampler = SamplerKind::sobol;
    Technique technique{Direction::bsdf, LightMode::mis, real(0.25)};
    Estimator direct = Estimator::stochastic;
    Polygons polygons = Polygons::area;
    Indirect indirect = Indirect::path;
    std::optional<double> mesh;     // longest edge of the maps' triangles; default: diagonal / 16
    uint64_t particles = 0;         // that fill the maps; 0: by the samples or the time
    std::optional<int> depth;       // default: the scene's
    uint32_t sets = sets_by_noise;  // of samples, in every pixel
    View view = View::radiance;
    Weighting film = Weighting::mc;    // of a pixel's samples
    std::string checkpoint, resume;    // files, or empty
    double every = 60;                 // seconds between checkpoints
    std::optional<Range> rows;         // of the picture; default: all
    std::optional<Range> samples;      // of each set of a pixel; default: all
    std::optional<PixelIndex> replay;  // instead of rendering, print the path of
    std::optional<uint64_t> sample;    // this sample
    std::optional<uint32_t> set;       // of this set
};

// ---- Values -------------------------------------------------------------------------------------

namespace option {

constexpr uint64_t most_samples = uint64_t(1) << 40;
constexpr uint64_t most_scatterings = 1000000;

inline double error(std::string_view text) {
    const double E = parse_fraction(text);
    if (!(E > 0 && E < 1)) throw UserError(in_quotes(text) + " is not between 0 and 100 %");
    return E;
}

inline uint32_t sets(std::string_view text, uint64_t least) {
    return uint32_t(parse_count(text, least, most_sets));
}

// "10-19"
inline Range range(std::string_view text, uint64_t most) {
    const size_t dash = text.find('-');
    if (dash == text.npos) throw UserError(in_quotes(text) + " is not FIRST-LAST");
    const Range r{parse_count(text.substr(0, dash), 0, most),
                  parse_count(text.substr(dash + 1), 0, most)};
    if (r.last < r.first) throw UserError(in_quotes(text) + " ends before it begins");
    return r;
}

inline std::string film(std::string_view text) {
    if (!text.ends_with(".film")) throw UserError(in_quotes(text) + " does not end in .film");
    return std::string(text);
}

inline PixelIndex pixel(std::string_view text) {
    size_t comma = text.find(',');
    if (comma == text.npos) throw UserError(in_quotes(text) + " is not X,Y");
    return {int(parse_count(text.substr(0, comma), 0, INT32_MAX)),
            int(parse_count(text.substr(comma + 1), 0, INT32_MAX))};
}

}  // namespace option

// ---- The table ----------------------------------------------------------------------------------

inline const OptionTable<Options> option_table = {
    CommonRows<Options>::output("out/NAME.png, out/NAME.pfm"),
    {"--spp", "N", "stop after N samples per pixel",
     "the scene's, unless --time or --error is given",
     [](Options& o, Text v) { o.spp = parse_count(v, 1, option::most_samples); }},
    CommonRows<Options>::time("stop after S seconds; with --spp, whichever comes first"),
    {"--error", "E",
     "stop once the error d_rel, as estimated, is at most E, e.g. 1%; with --spp or --time, "
     "whichever comes first",
     "", [](Options& o, Text v) { o.error = option::error(v); },
     [](const Options& o) {
         return o.error > 0 ? (std::ostringstream() << o.error).str() : "null";
     }},
    one_of<Options>(
        "--sampler", "independent|stratified|halton|sobol|halton-naive",
        "where the random numbers come from; halton-naive is a lesson in what not to do, and "
        "biased",
        [](auto& o) -> auto& { return o.sampler; }),
    {"--sets", "N|noise",
     "how many sets of samples a pixel has, each randomised on its own, whose spread tells the "
     "error; noise: one, and up to 8 where there is noise",
     "noise", [](Options& o, Text v) { o.sets = v == "noise" ? 0 : option::sets(v, 1); },
     [](const Options& o) { return o.sets ? std::to_string(o.sets) : "\"noise\""; }},
    one_of<Options>(
        "--direction", "uniform|bsdf",
        "directions at rough surfaces: uniform over the hemisphere, or importance-sampled",
        [](auto& o) -> auto& { return o.technique.direction; }),
    one_of<Options>(
        "--light", "none|nee|mis",
        "light found by hitting it, by aiming at it (next-event estimation), or by both, "
        "weighted",
        [](auto& o) -> auto& { return o.technique.light; }),
    one_of<Options>(
        "--direct", "stochastic|control|ratio|regression",
        "how light samples on visible diffuse surfaces are used: as they are, or to find "
        "only what shadows take from the exact unshadowed light; needs --light nee",
        [](auto& o) -> auto& { return o.direct; }),
    one_of<Options>(
        "--polygons", "area|angle",
        "points of rectangular lights: uniform over the area, or over the solid angle",
        [](auto& o) -> auto& { return o.polygons; }),
    one_of<Options>(
        "--indirect", "path|map|control|regression",
        "light between surfaces: by paths; by illumination maps after one bounce (biased a "
        "little); by paths that end on maps (unbiased), or on multiples of them; maps need diffuse "
        "surfaces alone, and scatter without end",
        [](auto& o) -> auto& { return o.indirect; }),
    {"--mesh", "H", "longest edge of the maps' triangles", "diagonal / 16",
     [](Options& o, Text v) { o.mesh = option::positive(v); }},
    {"--particles", "N", "walks that fill the maps", "map: paths / 16, or time / 16; else / 64",
     [](Options& o, Text v) { o.particles = parse_count(v, 1, uint64_t(1) << 40); }},
    one_of<Options>(
        "--pick", "power|place",
        "which of several lights is aimed at: in proportion to its power, or to about what it "
        "sends to the place (of more than 6 lights: to its power)",
        [](auto& o) -> auto& { return o.technique.pick; }),
    {"--depth", "N", "scatterings a path may have, 0: emission only", "the scene's",
     [](Options& o, Text v) { o.depth = int(parse_count(v, 0, option::most_scatterings)); }},
    {"--roulette", "T",
     "Russian roulette: a path whose throughput (its greatest channel) has fallen below T goes on "
     "with a probability of throughput / T; 0: no path ends so",
     "0.25", [](Options& o, Text v) { o.technique.roulette = real(parse_fraction(v)); },
     [](const Options& o) { return std::to_string(o.technique.roulette); }},
    CommonRows<Options>::seed(),
    CommonRows<Options>::threads(),
    CommonRows<Options>::size(),
    CommonRows<Options>::exposure(),
    one_of<Options>(
        "--view", "radiance|normal|depth|albedo|bvh|variance",
        "what the image shows: radiance; (normal + 1) / 2; distance; albedo; nodes (red) and "
        "shapes (green) visited by a ray; variance of the pixels' means, which implies "
        "--sets 2",
        [](auto& o) -> auto& { return o.view; }),
    one_of<Options>(
        "--film", "mc|vor|fvor|cvor|torus",
        "weights of a pixel's samples: equal, or areas of their Voronoi cells in the pixel: "
        "bounded by a strip around it, the same without cells that leave it, clipped to the "
        "pixel, or on a torus; all but mc need --sampler independent and --spp",
        [](auto& o) -> auto& { return o.film; }),
    CommonRows<Options>::stats(),
    {"--checkpoint", "F.film", "keep here what is needed to go on: now and then, and at the end",
     "", [](Options& o, Text v) { o.checkpoint = option::film(v); }},
    {"--every", "S", "seconds between checkpoints; at least 100 times what one takes", "60",
     [](Options& o, Text v) { o.every = option::positive(v); }},
    {"--resume", "F.film", "go on from there; the image is that of a run without a break", "",
     [](Options& o, Text v) { o.resume = option::film(v); }},
    {"--rows", "A-B", "render these rows alone, 0 at the top (for build/merge)", "all",
     [](Options& o, Text v) { o.rows = option::range(v, INT32_MAX); },
     [](const Options& o) { return o.rows ? '"' + as_text(*o.rows) + '"' : "null"; }},
    {"--samples", "A-B", "take these of --spp N samples alone (for build/merge)", "all",
     [](Options& o, Text v) { o.samples = option::range(v, option::most_samples); },
     [](const Options& o) { return o.samples ? '"' + as_text(*o.samples) + '"' : "null"; }},
    {"--pixel", "X,Y", "instead of rendering, print every vertex of one path", "",
     [](Options& o, Text v) { o.replay = option::pixel(v); }},
    {"--sample", "I", "of this sample, with --pixel", "0",
     [](Options& o, Text v) { o.sample = parse_count(v, 0, option::most_samples); }},
    {"--set", "K", "of this set, with --pixel", "0",
     [](Options& o, Text v) { o.set = option::sets(v, 0); }},
    CommonRows<Options>::quiet(),
    CommonRows<Options>::help(),
};

// ---- Sets of samples ----------------------------------------------------------------------------

// In every pixel, or by noise.
inline uint32_t sets_of(const Options& o) {
    if (o.sampler == SamplerKind::halton_naive) return 1;
    if (o.view == View::variance && o.sets == sets_by_noise) return 2;
    return o.sets;
}

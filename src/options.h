// options.h  floor 3  what the user asks
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bsdf.h"
#include "check.h"
#include "estimators.h"
#include "sampler.h"

// How light is found.
enum class LightMode {
    none,  // by hitting it
    nee,   // next-event estimation: by aiming at it
    mis    // both, weighted by the power heuristic
};

// How points of a rectangular light are chosen.
enum class Polygons {
    area,  // uniform over its area
    angle  // uniform over the solid angle that it subtends
};

// What the image shows.
enum class View { radiance, normal, depth, albedo, bvh, variance };

// Words of the options, in the order of their enumerations.
inline const std::vector<std::string_view> sampler_names = {"independent", "stratified", "halton",
                                                            "halton-naive"};
inline const std::vector<std::string_view> direction_names = {"uniform", "bsdf"};
inline const std::vector<std::string_view> light_names = {"none", "nee", "mis"};
inline const std::vector<std::string_view> direct_names = {"stochastic", "control", "ratio",
                                                           "regression"};
inline const std::vector<std::string_view> polygon_names = {"area", "angle"};
inline const std::vector<std::string_view> view_names = {"radiance", "normal", "depth",
                                                         "albedo",   "bvh",    "variance"};

struct PixelIndex {
    int x = 0, y = 0;
};

struct Options {
    std::string scene;
    std::vector<std::string> outputs;
    bool default_outputs = false;
    uint64_t spp = 0;    // 0: no limit
    double seconds = 0;  // 0: no limit
    SamplerKind sampler = SamplerKind::halton;
    Direction direction = Direction::bsdf;
    LightMode light = LightMode::mis;
    Estimator direct = Estimator::stochastic;
    Polygons polygons = Polygons::area;
    std::optional<int> depth;  // default: the scene's
    int roulette = 0;          // 0: off
    uint64_t seed = 0;
    unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    std::optional<Size> size;      // default: the scene's
    std::optional<real> exposure;  // default: the scene's
    bool halves = false;           // see Pattern
    View view = View::radiance;
    Weighting film = Weighting::mc;    // of a pixel's samples
    std::string stats;                 // file, or empty
    std::optional<PixelIndex> replay;  // instead of rendering, print the path of
    uint64_t replay_sample = 0;        // this sample
    bool quiet = false, help = false;
};

inline constexpr const char* usage = R"(usage: penumbra [options] SCENE

Renders SCENE (a file in the format of scenes/*.scene) by path tracing.

  -o FILE               image to write, .png or .pfm; may be repeated
                        (default: out/NAME.png and out/NAME.pfm)
  --spp N               stop after N samples per pixel
  --time S              stop after S seconds; with --spp, whichever comes first
                        (default: 64 samples if neither is given)
  --sampler independent|stratified|halton|halton-naive   where the random
                        numbers come from (default: halton); halton-naive is
                        a lesson in what not to do, and biased
  --halves              two independently randomised halves of stratified and
                        halton samples, so that their error can be estimated
  --direction uniform|bsdf   directions at rough surfaces: uniform over the
                        hemisphere, or importance-sampled (default: bsdf)
  --light none|nee|mis  light found by hitting it, by aiming at it (next-event
                        estimation), or by both, weighted (default: mis)
  --direct stochastic|control|ratio|regression   how light samples on visible
                        diffuse surfaces are used: as they are (default), or
                        to find only what shadows take from the exact
                        unshadowed light; needs --light nee
  --polygons area|angle points of rectangular lights: uniform over the area
                        (default), or over the solid angle
  --depth N             scatterings a path may have, 0: emission only
                        (default: the scene's)
  --roulette K          Russian roulette from the K-th scattering on
                        (default: off)
  --seed N              another seed, another noise (default: 0)
  --threads N           the image does not depend on it (default: all cores)
  --size WxH            pixels, e.g. 256x128 (default: the scene's)
  --exposure E          factor from radiance to PNG (default: the scene's)
  --view radiance|normal|depth|albedo|bvh|variance   what the image shows:
                        radiance (default); (normal + 1) / 2; distance; albedo;
                        nodes (red) and shapes (green) visited by a ray;
                        variance of the pixels' means (implies --halves)
  --film mc|vor|fvor|cvor|torus   weights of a pixel's samples: equal (default),
                        or areas of their Voronoi cells in the pixel: bounded by
                        a strip around it, the same without cells that leave it,
                        clipped to the pixel, or on a torus; all but mc need
                        --sampler independent and --spp
  --stats FILE          write what was measured, as JSON
  --pixel X,Y           instead of rendering, print every vertex of one path
  --sample I            of sample I (default: 0)
  --quiet               print nothing but errors
  --help                print this

A .pfm holds linear radiance; a .png holds exposure times radiance, clamped to
[0,1] and encoded as sRGB.  Pixel (0,0) is the top left one.

Exit status: 0 done; 1 a sample was not finite, or a file could not be written;
2 the scene or an option cannot be used; 130 interrupted (Ctrl-C), after writing
the image of the passes completed so far.
)";

namespace option {

inline double positive(std::string_view text) {
    double x = parse_number(text);
    if (!(x > 0)) throw UserError(in_quotes(text) + " is not positive");
    return x;
}

// The index of `text` among `known`.
inline int choice(std::string_view text, const std::vector<std::string_view>& known) {
    auto found = std::find(known.begin(), known.end(), text);
    if (found == known.end()) throw UserError(unknown("value", text, known));
    return int(found - known.begin());
}

inline Size size(std::string_view text) {
    size_t x = text.find('x');
    if (x == text.npos) throw UserError(in_quotes(text) + " is not WIDTHxHEIGHT");
    return parse_size(text.substr(0, x), text.substr(x + 1));
}

inline PixelIndex pixel(std::string_view text) {
    size_t comma = text.find(',');
    if (comma == text.npos) throw UserError(in_quotes(text) + " is not X,Y");
    return {int(parse_count(text.substr(0, comma), 0, INT32_MAX)),
            int(parse_count(text.substr(comma + 1), 0, INT32_MAX))};
}

// Gives one option its value.
inline void set(Options& o, std::string_view name, std::string_view value) {
    if (name == "-o") {
        if (!value.ends_with(".png") && !value.ends_with(".pfm"))
            throw UserError(in_quotes(value) + " ends neither in .png nor in .pfm");
        o.outputs.emplace_back(value);
    }
    if (name == "--spp") o.spp = parse_count(value, 1, uint64_t(1) << 40);
    if (name == "--time") o.seconds = positive(value);
    if (name == "--sampler") o.sampler = SamplerKind(choice(value, sampler_names));
    if (name == "--direction") o.direction = Direction(choice(value, direction_names));
    if (name == "--light") o.light = LightMode(choice(value, light_names));
    if (name == "--direct") o.direct = Estimator(choice(value, direct_names));
    if (name == "--polygons") o.polygons = Polygons(choice(value, polygon_names));
    if (name == "--depth") o.depth = int(parse_count(value, 0, 1000000));
    if (name == "--roulette") o.roulette = int(parse_count(value, 1, 1000000));
    if (name == "--seed") o.seed = parse_count(value, 0, UINT64_MAX);
    if (name == "--threads") o.threads = unsigned(parse_count(value, 1, 1024));
    if (name == "--view") o.view = View(choice(value, view_names));
    if (name == "--film") o.film = Weighting(choice(value, weighting_names));
    if (name == "--stats") o.stats = value;
    if (name == "--pixel") o.replay = pixel(value);
    if (name == "--sample") o.replay_sample = parse_count(value, 0, uint64_t(1) << 40);
    if (name == "--size") o.size = size(value);
    if (name == "--exposure") o.exposure = real(positive(value));
}

}  // namespace option

// Throws UserError about the first word that cannot be used.
inline Options parse_options(const std::vector<std::string>& words) {
    static const std::vector<std::string_view> with_value = {
        "-o",         "--spp",   "--time",     "--sampler", "--direction", "--light", "--direct",
        "--polygons", "--depth", "--roulette", "--seed",    "--threads",   "--size",  "--exposure",
        "--view",     "--film",  "--stats",    "--pixel",   "--sample"};
    std::vector<std::string_view> known = with_value;
    known.insert(known.end(), {"--halves", "--quiet", "--help"});
    Options o;
    bool sample_given = false;
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (word == "--quiet") {
            o.quiet = true;
        } else if (word == "--halves") {
            o.halves = true;
        } else if (word == "--help") {
            o.help = true;
        } else if (std::find(with_value.begin(), with_value.end(), word) != with_value.end()) {
            sample_given = sample_given || word == "--sample";
            if (i + 1 == words.size()) throw UserError(word + ": needs a value");
            try {
                option::set(o, word, words[++i]);
            } catch (const UserError& e) {
                throw UserError(word + ": " + e.what());
            }
        } else if (word.starts_with('-')) {
            throw UserError(unknown("option", word, known));
        } else if (!o.scene.empty()) {
            throw UserError("two scenes: " + in_quotes(o.scene) + " and " + in_quotes(word));
        } else {
            o.scene = word;
            if (word.empty()) throw UserError("the scene's name is empty");
        }
    }
    if (o.help) return o;
    if (o.view == View::variance) o.halves = true;
    if (sample_given && !o.replay) throw UserError("--sample: goes with --pixel X,Y");
    if (o.direct != Estimator::stochastic && o.light != LightMode::nee)
        throw UserError("--direct " + std::string(direct_names[size_t(o.direct)]) +
                        ": needs --light nee");
    if (o.scene.empty()) throw UserError("no scene given (try --help)");
    if (o.spp == 0 && o.seconds == 0) o.spp = 64;
    if (o.film != Weighting::mc) {
        const std::string film = "--film " + std::string(weighting_names[size_t(o.film)]);
        if (o.sampler != SamplerKind::independent)
            throw UserError(film + ": needs --sampler independent");
        if (o.seconds > 0)
            throw UserError(film + ": needs --spp, not --time: all samples of a pixel at once");
        if (o.spp > (1 << 20)) throw UserError(film + ": at most 1048576 samples per pixel");
        if (o.view == View::variance) throw UserError(film + ": its variance is not known");
        if (o.direct != Estimator::stochastic)
            throw UserError(film + ": needs --direct stochastic");
    }
    if (o.outputs.empty()) {
        std::string stem = "out/" + std::filesystem::path(o.scene).stem().string();
        o.outputs = {stem + ".png", stem + ".pfm"};
        o.default_outputs = true;
    }
    return o;
}

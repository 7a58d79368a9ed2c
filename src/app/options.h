// app/options.h  1  what the user asks: one table of options
//
// Parsing, --help, suggestions, --stats and the README's table all follow from option_table.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "film/passes.h"
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

struct PixelIndex {
    int x = 0, y = 0;
};

struct Options {
    std::string scene;
    std::vector<std::string> outputs;
    Target target;  // nothing: the scene's number of samples
    SamplerKind sampler = SamplerKind::halton;
    Technique technique;
    Estimator direct = Estimator::stochastic;
    Polygons polygons = Polygons::area;
    std::optional<int> depth;  // default: the scene's
    uint64_t seed = 0;
    unsigned threads = all_cores();
    std::optional<Size> size;      // default: the scene's
    std::optional<real> exposure;  // default: the scene's
    bool halves = false;           // see Pattern
    View view = View::radiance;
    Weighting film = Weighting::mc;    // of a pixel's samples
    std::string stats;                 // file, or empty
    std::optional<PixelIndex> replay;  // instead of rendering, print the path of
    std::optional<uint64_t> sample;    // this sample
    bool quiet = false, help = false;
};

// ---- Values -------------------------------------------------------------------------------------

namespace option {

constexpr uint64_t most_samples = uint64_t(1) << 40;
constexpr uint64_t most_scatterings = 1000000;

inline double positive(std::string_view text) {
    double x = parse_number(text);
    if (!(x > 0)) throw UserError(in_quotes(text) + " is not positive");
    return x;
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

inline std::string image(std::string_view text) {
    if (!text.ends_with(".png") && !text.ends_with(".pfm"))
        throw UserError(in_quotes(text) + " ends neither in .png nor in .pfm");
    return std::string(text);
}

// The words of "none|nee|mis".
inline std::vector<std::string_view> words_of(std::string_view alternatives) {
    std::vector<std::string_view> words;
    for (size_t from = 0, to = 0; to != alternatives.npos; from = to + 1) {
        to = alternatives.find('|', from);
        words.push_back(alternatives.substr(from, to - from));
    }
    return words;
}

// The index of `text` among them.
inline size_t choice(std::string_view text, std::string_view alternatives) {
    const auto known = words_of(alternatives);
    const auto found = std::find(known.begin(), known.end(), text);
    if (found == known.end()) throw UserError(unknown("value", text, known));
    return size_t(found - known.begin());
}

}  // namespace option

// ---- The table ----------------------------------------------------------------------------------

using Text = std::string_view;

// Functions are plain pointers: std::function would cost every file that includes this a second.
struct Option {
    Text name;
    Text value;           // what stands after it; "": nothing
    Text help;            // what it is for
    Text otherwise = {};  // without it; "": nothing
    void (*assign)(Options&, Text);
    std::string (*json)(const Options&) = nullptr;  // its value; none: not in --stats
    // Of a choice instead: its word's index among those of `value`.
    void (*choose)(Options&, size_t) = nullptr;
    size_t (*chosen)(const Options&) = nullptr;

    void set(Options& o, Text v) const {
        if (choose)
            choose(o, option::choice(v, value));
        else
            assign(o, v);
    }
    std::string stats(const Options& o) const {  // "": nothing
        if (chosen) return '"' + std::string(option::words_of(value)[chosen(o)]) + '"';
        return json ? json(o) : "";
    }
};

// One of several words, which stand in the order of their enumeration; at(o) is where it is kept.
template <class At>
Option one_of(Text name, Text words, Text help, At) {
    using Enum = std::remove_reference_t<decltype(At()(std::declval<Options&>()))>;
    auto choose = [](Options& o, size_t k) { At()(o) = Enum(k); };
    auto chosen = [](const Options& o) { return size_t(At()(o)); };
    const Text otherwise = option::words_of(words)[chosen({})];
    return {name, words, help, otherwise, nullptr, nullptr, choose, chosen};
}

inline const Option option_table[] = {
    {"-o", "FILE", "image to write, .png or .pfm; may be repeated", "out/NAME.png, out/NAME.pfm",
     [](Options& o, Text v) { o.outputs.push_back(option::image(v)); }},
    {"--spp", "N", "stop after N samples per pixel", "the scene's, unless --time is given",
     [](Options& o, Text v) { o.target.samples = parse_count(v, 1, option::most_samples); }},
    {"--time", "S", "stop after S seconds; with --spp, whichever comes first", "",
     [](Options& o, Text v) { o.target.seconds = option::positive(v); }},
    one_of(
        "--sampler", "independent|stratified|halton|halton-naive",
        "where the random numbers come from; halton-naive is a lesson in what not to do, and "
        "biased",
        [](auto& o) -> auto& { return o.sampler; }),
    {"--halves", "",
     "two independently randomised halves of stratified and halton samples, so "
     "that their error can be estimated",
     "", [](Options& o, Text) { o.halves = true; },
     [](const Options& o) { return std::string(o.halves ? "true" : "false"); }},
    one_of(
        "--direction", "uniform|bsdf",
        "directions at rough surfaces: uniform over the hemisphere, or importance-sampled",
        [](auto& o) -> auto& { return o.technique.direction; }),
    one_of(
        "--light", "none|nee|mis",
        "light found by hitting it, by aiming at it (next-event estimation), or by both, "
        "weighted",
        [](auto& o) -> auto& { return o.technique.light; }),
    one_of(
        "--direct", "stochastic|control|ratio|regression",
        "how light samples on visible diffuse surfaces are used: as they are, or to find "
        "only what shadows take from the exact unshadowed light; needs --light nee",
        [](auto& o) -> auto& { return o.direct; }),
    one_of(
        "--polygons", "area|angle",
        "points of rectangular lights: uniform over the area, or over the solid angle",
        [](auto& o) -> auto& { return o.polygons; }),
    {"--depth", "N", "scatterings a path may have, 0: emission only", "the scene's",
     [](Options& o, Text v) { o.depth = int(parse_count(v, 0, option::most_scatterings)); }},
    {"--roulette", "K", "Russian roulette from the K-th scattering on", "off",
     [](Options& o, Text v) {
         o.technique.roulette = int(parse_count(v, 1, option::most_scatterings));
     },
     [](const Options& o) {
         return o.technique.roulette ? std::to_string(o.technique.roulette) : "null";
     }},
    {"--seed", "N", "another seed, another noise", "0",
     [](Options& o, Text v) { o.seed = parse_count(v, 0, UINT64_MAX); },
     [](const Options& o) { return std::to_string(o.seed); }},
    {"--threads", "N", "the image does not depend on it", "all cores",
     [](Options& o, Text v) { o.threads = unsigned(parse_count(v, 1, 1024)); },
     [](const Options& o) { return std::to_string(o.threads); }},
    {"--size", "WxH",
     "pixels, e.g. 256x128; pixels are square, and the field of view is "
     "vertical",
     "the scene's", [](Options& o, Text v) { o.size = option::size(v); }},
    {"--exposure", "E", "factor from radiance to PNG", "the scene's",
     [](Options& o, Text v) { o.exposure = real(option::positive(v)); }},
    one_of(
        "--view", "radiance|normal|depth|albedo|bvh|variance",
        "what the image shows: radiance; (normal + 1) / 2; distance; albedo; nodes (red) and "
        "shapes (green) visited by a ray; variance of the pixels' means, which implies "
        "--halves",
        [](auto& o) -> auto& { return o.view; }),
    one_of(
        "--film", "mc|vor|fvor|cvor|torus",
        "weights of a pixel's samples: equal, or areas of their Voronoi cells in the pixel: "
        "bounded by a strip around it, the same without cells that leave it, clipped to the "
        "pixel, or on a torus; all but mc need --sampler independent and --spp",
        [](auto& o) -> auto& { return o.film; }),
    {"--stats", "FILE", "write what was measured, as JSON", "",
     [](Options& o, Text v) { o.stats = v; }},
    {"--pixel", "X,Y", "instead of rendering, print every vertex of one path", "",
     [](Options& o, Text v) { o.replay = option::pixel(v); }},
    {"--sample", "I", "of this sample, with --pixel", "0",
     [](Options& o, Text v) { o.sample = parse_count(v, 0, option::most_samples); }},
    {"--quiet", "", "print nothing but errors", "", [](Options& o, Text) { o.quiet = true; }},
    {"--help", "", "print this, as -h does", "", [](Options& o, Text) { o.help = true; }},
};

// How the user would write that option: "--light nee".
inline std::string as_written(const Options& o, std::string_view name) {
    for (const Option& row : option_table)
        if (row.name == name) {
            std::string word = row.stats(o);
            std::erase(word, '"');
            return std::string(name) + " " + word;
        }
    return std::string(name);
}

// ---- Words to options ---------------------------------------------------------------------------

// What single options do not tell.
inline void check_together(const Options& o) {
    if (o.sample && !o.replay) throw UserError("--sample: goes with --pixel X,Y");
    if (o.direct != Estimator::stochastic && o.technique.light != LightMode::nee)
        throw UserError(as_written(o, "--direct") + ": needs --light nee");
    if (o.scene.empty()) throw UserError("no scene given (try --help)");
    if (o.film == Weighting::mc) return;
    const std::string film = as_written(o, "--film");
    if (o.sampler != SamplerKind::independent)
        throw UserError(film + ": needs --sampler independent");
    if (o.target.seconds > 0)
        throw UserError(film + ": needs --spp, not --time: all samples of a pixel at once");
    if (o.target.samples > (1 << 20)) throw UserError(film + ": at most 1048576 samples per pixel");
    if (o.view == View::variance) throw UserError(film + ": its variance is not known");
    if (o.direct != Estimator::stochastic) throw UserError(film + ": needs --direct stochastic");
}

// Throws UserError about the first word that cannot be used.
inline Options parse_options(const std::vector<std::string>& words) {
    std::vector<Text> known;
    for (const Option& row : option_table) known.push_back(row.name);
    Options o;
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string word = words[i] == "-h" ? "--help" : words[i];
        const auto row = std::find_if(std::begin(option_table), std::end(option_table),
                                      [&](const Option& r) { return r.name == word; });
        if (row != std::end(option_table)) {
            const bool has_value = !row->value.empty();
            if (has_value && i + 1 == words.size()) throw UserError(word + ": needs a value");
            try {
                row->set(o, has_value ? words[++i] : "");
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
    check_together(o);
    return o;
}

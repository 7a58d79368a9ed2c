// app/options.h  1  what the user asks of penumbra
#pragma once
#include "base/option.h"
#include "film/film.h"
#include "path/pathtracer.h"

// What the image shows.
enum class View { radiance, normal, depth, albedo, bvh };

struct Rows {
    int first = 0, last = 0;  // of the picture, from the top

    int count() const { return last - first + 1; }
};

struct Options : CommonOptions {
    uint64_t spp = 0;   // 0: the scene's, unless seconds or an error are given
    double error = 0;   // d_rel to stop at; 0: none
    uint32_t sets = 0;  // replications of each pixel; 0: two, and more where noise is
    SamplerKind sampler = SamplerKind::sobol;
    Technique technique;
    std::optional<int> depth;  // default: the scene's
    View view = View::radiance;
    std::string keep;                   // a film, or empty
    std::optional<Rows> rows;           // default: all
    std::optional<PixelSample> replay;  // instead of rendering, print its path
};

inline constexpr uint64_t most_samples = uint64_t(1) << 40, most_depth = 1000000;

// "10-19"
inline Rows parse_rows(Text v) {
    const auto [first, last] = parts_of(v, '-', "FIRST-LAST");
    const Rows r{int(parse_count(first, 0, INT32_MAX)), int(parse_count(last, 0, INT32_MAX))};
    if (r.count() < 1) throw UserError(in_quotes(v) + " ends before it begins");
    return r;
}
inline std::string as_text(const Rows& r) {
    return std::to_string(r.first) + "-" + std::to_string(r.last);
}

// The path to replay: its pixel, "X,Y", and its sample, "I" or "I,K".
inline void set_pixel(std::optional<PixelSample>& replay, Text v) {
    const auto [x, y] = parts_of(v, ',', "X,Y");
    if (!replay) replay.emplace();
    replay->x = int(parse_count(x, 0, INT32_MAX));
    replay->y = int(parse_count(y, 0, INT32_MAX));
}
inline void set_sample(std::optional<PixelSample>& replay, Text v) {
    const size_t comma = v.find(',');
    if (!replay) replay.emplace();
    replay->i = parse_count(v.substr(0, comma), 0, most_samples);
    if (comma != v.npos) replay->set = uint32_t(parse_count(v.substr(comma + 1), 0, most_sets));
}

inline std::string parse_film(Text v) {
    if (!v.ends_with(".film")) throw UserError(in_quotes(v) + " does not end in .film");
    return std::string(v);
}

// When to stop.
inline OptionTable target_rows(Options& o) {
    return {
        output_row(o, "out/NAME.png, out/NAME.pfm"),
        {"--spp", "N", "stop after N samples a pixel, more where noise is",
         "the scene's, unless --time or --error is given",
         [&o](Text v) { o.spp = parse_count(v, 1, most_samples); }},
        {"--time", "S", "stop after S seconds; with --spp, whichever comes first", "",
         [&o](Text v) { o.seconds = parse_positive(v); }},
        {"--error", "E",
         "stop once the error d_rel, as estimated, is at most E, e.g. 1%; with --spp or --time, "
         "whichever comes first",
         "", [&o](Text v) { o.error = parse_error(v); },
         [&o] { return o.error > 0 ? json::number(o.error) : "null"; }},
        {"--sets", "K|adaptive",
         "replications of each pixel, randomised independently, whose spread tells the error; "
         "adaptive: two, and up to 32 where noise is",
         "adaptive",
         [&o](Text v) { o.sets = v == "adaptive" ? 0 : uint32_t(parse_count(v, 1, most_sets)); },
         [&o] { return o.sets ? std::to_string(o.sets) : json::string("adaptive"); }}};
}

// What samples are of.
inline OptionTable sample_rows(Options& o) {
    return {
        one_of("--sampler", "independent|stratified|halton|sobol", "source of the random numbers",
               o.sampler),
        one_of("--direction", "uniform|bsdf",
               "directions at rough surfaces: uniform over the hemisphere, or BSDF sampling",
               o.technique.direction),
        one_of("--light", "none|nee|mis",
               "light found by hitting it, by aiming at it (next-event estimation), or by both, "
               "weighted",
               o.technique.light),
        {"--depth", "N", "scatterings a path may have, 0: emission only", "the scene's",
         [&o](Text v) { o.depth = int(parse_count(v, 0, most_depth)); }},
        {"--roulette", "T",
         "Russian roulette: a path whose throughput (its greatest channel) has fallen below T goes "
         "on with a probability of throughput / T; 0: no path ends so",
         significant(double(o.technique.roulette), 3),
         [&o](Text v) { o.technique.roulette = real(parse_fraction(v)); },
         [&o] { return json::number(double(o.technique.roulette)); }},
        one_of("--view", "radiance|normal|depth|albedo|bvh",
               "the image shows radiance; (normal + 1) / 2; distance; albedo; nodes (red) and "
               "shapes (green) visited by a ray",
               o.view)};
}

// What is left of a render, and what part of it is looked at.
inline OptionTable part_rows(Options& o) {
    return {{"--keep", "F.film", "keep the film in F.film, and go on from there if it exists", "",
             [&o](Text v) { o.keep = parse_film(v); }},
            {"--rows", "A-B", "render these rows alone, 0 at the top (for build/merge)", "all",
             [&o](Text v) { o.rows = parse_rows(v); },
             [&o] { return o.rows ? json::string(as_text(*o.rows)) : "null"; }},
            {"--pixel", "X,Y", "print every event of one path of pixel X,Y instead of rendering",
             "", [&o](Text v) { set_pixel(o.replay, v); }},
            {"--sample", "I[,K]", "sample I of replication K, with --pixel", "0,0",
             [&o](Text v) { set_sample(o.replay, v); }}};
}

inline OptionTable option_table(Options& o) {
    return target_rows(o) + sample_rows(o) + part_rows(o) + common_rows(o);
}

// Throws UserError about the first word that cannot be used, or goes with no other.
inline void parse_options(OptionTable& table, Options& o, const std::vector<std::string>& words) {
    parse_words(table, words, o);
    if (is_given(table, "--sample") && !is_given(table, "--pixel"))
        throw UserError("--sample: goes with --pixel X,Y");
    if (o.replay && !o.keep.empty()) throw UserError("--keep: goes without --pixel");
    if (o.error > 0 && o.sets == 1) throw UserError("--error: needs --sets 2 or more, or adaptive");
    if (o.rows && o.keep.empty() && o.outputs.empty())
        throw UserError("--rows: needs --keep F.film, which build/merge takes, or -o");
}

// Samples of each replication, of N a pixel; 0: not known.
inline uint64_t samples_each(const Options& o, uint64_t N) {
    const uint64_t K = o.sets ? o.sets : 2;
    return (N + K - 1) / K;
}

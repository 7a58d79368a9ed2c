// app/options.h  2  the options of penumbra
//
// A path is replayed if -DWITH_REPLAY: with src/replay.
#pragma once
#include "app/views.h"
#include "film/film.h"

#ifdef WITH_REPLAY
#include "replay/replay.h"
#else
namespace penumbra {
inline OptionTable replay_rows(std::optional<PixelSample>&) {
    constexpr const char* why = "this program was built without src/replay";
    auto refuse = [why](Text) { throw UserError(why); };
    return {{"--pixel", "X,Y", why, "", refuse}, {"--sample", "I[,K]", why, "", refuse}};
}
inline void replay(auto&&...) {}
}  // namespace penumbra
#endif

namespace penumbra {

struct RowRange {
    int first = 0, last = 0;  // row 0 is at the top of the picture

    int count() const { return last - first + 1; }
};

struct Options : CommonOptions {
    uint64_t spp = 0;           // 0: the scene's, unless seconds or an error are given
    double error = 0;           // d_rel to stop at; 0: none
    uint32_t replications = 0;  // of each pixel; 0: adaptive
    SamplerKind sampler = SamplerKind::sobol;
    Technique technique;
    std::optional<int> depth;           // default: the scene's
    View view = views.front().second;   // radiance
    std::string keep;                   // a film, or empty
    std::optional<RowRange> rows;       // default: all
    std::optional<PixelSample> replay;  // instead of rendering, print its path
};

// "10-19"
inline RowRange parse_rows(Text v) {
    const auto [first, last] = parts_of(v, '-', "FIRST-LAST");
    const RowRange r{int(parse_count(first, 0, INT32_MAX)), int(parse_count(last, 0, INT32_MAX))};
    if (r.count() < 1) throw UserError(in_quotes(v) + " ends before it begins");
    return r;
}
inline std::string as_text(const RowRange& r) {
    return std::to_string(r.first) + "-" + std::to_string(r.last);
}

inline std::string parse_film(Text v) {
    if (!v.ends_with(".film")) throw UserError(in_quotes(v) + " must end in .film");
    return std::string(v);
}

inline OptionTable stop_rows(Options& o) {
    OptionTable rows = {
        {"--spp", "N",
         "stop after N samples per pixel; with --replications adaptive, quiet pixels take half of "
         "that, noisy ones up to 8 times",
         "the scene's, unless --time or --error is given",
         [&o](Text v) { o.spp = parse_count(v, 1, max_samples); }},
        {"--time", "S", "stop after S seconds; with --spp, whichever comes first", "",
         [&o](Text v) { o.seconds = parse_positive(v); }},
        {"--error", "E",
         "stop once the estimated relative RMSE (d_rel) is at most E, e.g. 1%; with --spp or "
         "--time, whichever comes first",
         "", [&o](Text v) { o.error = parse_error(v); },
         [&o] { return o.error > 0 ? json::number(o.error) : "null"; }}};
    rows[0].also = "--samples";
    return in_group("Stop when", rows);
}

inline OptionTable sampling_rows(Options& o) {
    return in_group(
        "Sampling",
        {{"--replications", "K|adaptive",
          "number of independent replications per pixel, whose differences give the error "
          "estimate; "
          "adaptive: two halves (more in a picture of less than 400 pixels), with up to 16 times "
          "the samples where the image is noisy",
          "adaptive",
          [&o](Text v) {
              o.replications = v == "adaptive" ? 0 : uint32_t(parse_count(v, 1, max_replications));
          },
          [&o] {
              return o.replications ? std::to_string(o.replications) : json::string("adaptive");
          }},
         one_of("--sampler",
                {{"independent", SamplerKind::independent},
                 {"stratified", SamplerKind::stratified},
                 {"halton", SamplerKind::halton},
                 {"sobol", SamplerKind::sobol}},
                "sample points: pseudo-random, jittered 4x4 grids, or low-discrepancy points",
                o.sampler)});
}

inline OptionTable transport_rows(Options& o) {
    return in_group(
        "Light transport",
        {one_of("--direction", {{"uniform", Direction::uniform}, {"bsdf", Direction::bsdf}},
                "scattering directions on diffuse and glossy surfaces: uniform over the "
                "hemisphere, or BSDF sampling",
                o.technique.direction),
         one_of("--light",
                {{"none", LightMode::none}, {"nee", LightMode::nee}, {"mis", LightMode::mis}},
                "direct light by BSDF sampling only, by light sampling (next-event estimation) "
                "only, or by both with MIS",
                o.technique.light),
         {"--depth", "N", "maximum number of bounces; 0: emission only", "the scene's",
          [&o](Text v) { o.depth = int(parse_count(v, 0, max_depth)); }},
         {"--roulette", "T",
          "Russian roulette: a path survives with probability throughput / T (largest component, "
          "without the factor of refraction) where that is below 1; 0 disables Russian roulette",
          significant(double(o.technique.roulette), 3),
          [&o](Text v) { o.technique.roulette = real(parse_fraction(v)); },
          [&o] { return json::number(double(o.technique.roulette)); }}});
}

inline OptionTable view_rows(Options& o) {
    return in_group("Views and debugging", OptionTable{one_of("--view", views, view_help, o.view)} +
                                               replay_rows(o.replay));
}

inline OptionTable part_rows(Options& o) {
    return in_group(
        "Checkpoints and parts",
        {{"--keep", "F.film",
          "write a checkpoint every 10 seconds and at the end; resume from it if it exists", "",
          [&o](Text v) { o.keep = parse_film(v); }},
         {"--rows", "A-B", "render only these rows; row 0 is at the top (for build/merge)", "all",
          [&o](Text v) { o.rows = parse_rows(v); },
          [&o] { return o.rows ? json::string(as_text(*o.rows)) : "null"; }}});
}

inline OptionTable option_table(Options& o) {
    return output_rows(o, "out/NAME.png, out/NAME.pfm") + stop_rows(o) + sampling_rows(o) +
           OptionTable{seed_row(o)} + transport_rows(o) + view_rows(o) + part_rows(o) +
           general_rows(o);
}

// Throws UserError about the first word that cannot be used, or does not go with the others.
inline void parse_options(OptionTable& table, Options& o, const std::vector<std::string>& words) {
    parse_words(table, words, o);
    if (is_given(table, "--sample") && !is_given(table, "--pixel"))
        throw UserError("--sample: needs --pixel X,Y (for samples per pixel use --spp N)");
    if (o.replay && !o.keep.empty()) throw UserError("--keep: cannot be combined with --pixel");
    if (o.error > 0 && o.view.of) throw UserError("--error: needs --view radiance");
    if (o.error > 0 && o.replications == 1)
        throw UserError("--error: needs --replications 2 or more, or adaptive");
    if (o.rows && o.keep.empty() && o.outputs.empty())
        throw UserError("--rows: needs --keep F.film, which build/merge takes, or -o");
}

}  // namespace penumbra

// radiosity/options.h  6  the options of radiosity
#pragma once
#include "app/options.h"

namespace penumbra {

// The method that fills the illumination maps.
enum class Method {
    shooting,   // the element with the most unshot power shoots it, then the next
    hierarchy,  // whole faces shoot, in parts as small as their receivers need
    particles   // random walks from the lights
};

// Quantity that the image of the maps shows.
enum class MapView { luminance, illuminance, mesh };

// An error is that of the maps; of the image, with final gathering.
struct RadiosityOptions : Options {
    bool final_gather = false;  // render paths, with spp, replications, technique and sampler
    Method method = Method::hierarchy;
    std::optional<double> mesh;  // longest edge of an element
    double unshot = 0;           // fraction of all power; 0: no limit
    uint64_t shots = 0;          // 0: no limit
    uint64_t particles = 0;      // 0: no limit
    int rays = 2;                // squared, of a pixel
    MapView shows = MapView::luminance;
};

inline bool is_random(const RadiosityOptions& o) { return o.method == Method::particles; }

inline OptionTable radiosity_table(RadiosityOptions& o) {
    o.sampler = SamplerKind::halton;
    OptionTable all = option_table(o);
    auto taken = [&all](Text name, Text help) {
        Option r = row(all, name);
        if (!help.empty()) r.help = help;
        return r;
    };
    OptionTable table =
        output_rows(o, "out/NAME-radiosity.png, .pfm") +
        in_group(
            "Radiosity",
            {one_of("--method",
                    {{"shooting", Method::shooting},
                     {"hierarchy", Method::hierarchy},
                     {"particles", Method::particles}},
                    "shooting: the element with the most unshot power shoots first; hierarchy: "
                    "whole faces shoot, in parts as small as a receiver needs; particles: "
                    "random walks from the lights",
                    o.method),
             {"--mesh", "H", "longest edge of the triangles of the mesh",
              "a 32nd of the scene's diagonal; a 16th with --final-gather",
              [&o](Text v) { o.mesh = parse_positive(v); }},
             {"--final-gather", "",
              "paths end on the maps after one bounce; particles fill the maps", "",
              [&o](Text) { o.final_gather = true; },
              [&o] { return json::truth(o.final_gather); }}}) +
        in_group(
            "Stop when",
            {{"--unshot", "F",
              "stop once this fraction of the emitted power is unshot, e.g. 1%; this is not the "
              "error of the picture; needs --method shooting or hierarchy",
              "1%, unless --error, --shots or --time is given",
              [&o](Text v) { o.unshot = parse_error(v); }},
             whole_number("--shots", "stop after N shots; needs --method shooting or hierarchy", "",
                          o.shots, 1, max_samples),
             whole_number("--particles",
                          "stop after N particles, rounded up to 16 equal batches; needs --method "
                          "particles",
                          "1000000, unless --error or --time is given; with --final-gather one "
                          "per 16 paths, or a 16th of the time",
                          o.particles, 1, max_samples),
             {"--error", "E",
              "stop once the error of the illumination maps is at most E, e.g. 5%.  It is the "
              "relative RMSE over all surfaces, without the error of the mesh: an estimate from "
              "the "
              "spread of particles, or a bound from unshot power.  With --final-gather: the error "
              "of the image, without the error of the maps",
              "", [&o](Text v) { o.error = parse_error(v); }},
             {"--time", "S", "stop after S seconds; with other limits, whichever comes first", "",
              [&o](Text v) { o.seconds = parse_positive(v); }},
             taken("--spp",
                   "stop after N paths per pixel; fewer in quiet pixels, more in noisy ones (see "
                   "--replications)")}) +
        in_group("Sampling",
                 {{"--rays", "K", "K x K rays per pixel, on a grid, without --final-gather", "2",
                   [&o](Text v) { o.rays = int(parse_count(v, 1, 64)); }},
                  taken("--replications", ""),
                  taken("--sampler", "sample points of particles, or of paths"),
                  seed_row(o)}) +
        in_group("Light transport", {taken("--direction", ""), taken("--light", "")}) +
        in_group(
            "Views and debugging",
            {one_of("--view",
                    {{"luminance", MapView::luminance},
                     {"illuminance", MapView::illuminance},
                     {"mesh", MapView::mesh}},
                    "the image shows radiance; illuminance (a .pfm in lux, if radiances are in "
                    "cd/m2; a .png as if all were white); or radiance and the edges of the "
                    "triangles",
                    o.shows)}) +
        general_rows(o);
    row(table, "--sampler").default_text = "halton; sobol with --final-gather";
    return table;
}

// Throws UserError about the first word that cannot be used, or that does not go with the method.
inline void parse_radiosity(OptionTable& table, RadiosityOptions& o,
                            const std::vector<std::string>& words) {
    parse_words(table, words, o);
    auto need = [&](const std::vector<Text>& names, bool holds, const char* what) {
        for (Text name : names)
            if (!holds && is_given(table, name)) throw UserError(std::string(name) + ": " + what);
    };
    if (o.final_gather && !is_given(table, "--method")) o.method = Method::particles;
    need({"--final-gather"}, is_random(o), "needs --method particles");
    need({"--unshot", "--shots"}, !is_random(o), "needs --method shooting or hierarchy");
    need({"--particles", "--sampler", "--seed"}, is_random(o), "needs --method particles");
    need({"--spp", "--replications", "--direction", "--light"}, o.final_gather,
         "needs --final-gather");
    need({"--rays", "--view"}, !o.final_gather, "cannot be combined with --final-gather");
    if (o.final_gather) {
        need({"--error"}, o.replications != 1, "needs --replications 2 or more, or adaptive");
        if (!is_given(table, "--sampler")) o.sampler = SamplerKind::sobol;
        o.technique.roulette = 0;
        return;
    }
    if (o.error > 0 || o.seconds > 0) return;
    if (is_random(o) && !o.particles) o.particles = 1000000;
    if (!is_random(o) && !o.unshot && !o.shots) o.unshot = 0.01;
}

}  // namespace penumbra

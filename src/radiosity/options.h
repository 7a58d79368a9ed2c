// radiosity/options.h  6  what the user asks of radiosity
#pragma once
#include "app/options.h"

// How the illumination maps are filled.
enum class Method {
    shooting,   // the element with the most unshot power shoots it, then the next
    hierarchy,  // whole faces shoot, in parts as small as their receivers need
    particles   // random walks from the lights
};

// What the image of the maps shows.
enum class MapView { luminance, illuminance, mesh };

// An error is that of the maps; of the image, with final gathering.
struct RadiosityOptions : Options {
    bool final_gather = false;  // by paths, of spp, sets, technique and sampler
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
    OptionTable table = {
        output_row(o, "out/NAME-radiosity.png, .pfm"),
        one_of("--method", "shooting|hierarchy|particles",
               "how light spreads: elements shoot what they have not yet shot, those of most power "
               "first; whole faces do, in parts as small as a receiver needs; or random walks from "
               "the lights",
               o.method),
        {"--mesh", "H", "longest edge of the triangles that faces are cut into",
         "a 32nd of the scene's diagonal; a 16th with --final-gather",
         [&o](Text v) { o.mesh = parse_positive(v); }},
        {"--unshot", "F",
         "stop once this fraction of the emitted power is yet to be sent on (which is no error of "
         "the picture): 0.01, or 1%; not with particles",
         "1%, unless --error, --shots or --time is given",
         [&o](Text v) { o.unshot = parse_error(v); }},
        whole_number("--shots", "stop after N shots; not with particles", "", o.shots, 1,
                     most_samples),
        whole_number("--particles",
                     "stop after N walks, a multiple of 16 batches, each one thread's work; needs "
                     "--method particles",
                     "1000000, unless --error or --time is given; with --final-gather a walk for "
                     "16 paths, or a 16th of the time",
                     o.particles, 1, most_samples),
        {"--error", "E",
         "stop once the illumination maps' error is at most E: 0.05, or 5%; it is the quadratic "
         "mean over all surfaces relative to that of their light, and leaves out what the "
         "triangles cost; that of particles is estimated by their spread, that of the other "
         "methods bounded by what is unshot.  With --final-gather: the error of the image, without "
         "that of the maps",
         "", [&o](Text v) { o.error = parse_error(v); }},
        {"--time", "S", "stop after S seconds, or by another limit that comes first", "",
         [&o](Text v) { o.seconds = parse_positive(v); }},
        {"--final-gather", "", "paths end on the maps after one bounce; particles fill these", "",
         [&o](Text) { o.final_gather = true; }, [&o] { return json::truth(o.final_gather); }},
        {"--rays", "K", "K x K rays a pixel, on a grid, without --final-gather", "2",
         [&o](Text v) { o.rays = int(parse_count(v, 1, 64)); }},
        one_of("--view", "luminance|illuminance|mesh",
               "what the image shows: radiance; illuminance (in a .pfm lux, if radiances are "
               "cd/m2; in a .png as if all were white); radiance and the edges of the triangles",
               o.shows)};
    OptionTable all = option_table(o);
    for (Text name : {"--spp", "--sets", "--sampler", "--direction", "--light"})
        table.push_back(row(all, name));
    row(table, "--spp").help = "samples a pixel of paths, more where noise is";
    row(table, "--sampler").help = "source of the random numbers of particles, or of paths";
    row(table, "--sampler").otherwise = "halton; sobol with --final-gather";
    for (Option& r : common_rows(o)) table.push_back(std::move(r));
    return table;
}

// Throws UserError about the first word that cannot be used, or says nothing to the method.
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
    need({"--spp", "--sets", "--direction", "--light"}, o.final_gather, "needs --final-gather");
    need({"--rays", "--view"}, !o.final_gather, "goes without --final-gather");
    if (o.final_gather) {
        need({"--error"}, o.sets != 1, "needs --sets 2 or more, or adaptive");
        if (!is_given(table, "--sampler")) o.sampler = SamplerKind::sobol;
        o.technique.roulette = 0;
        return;
    }
    if (o.error > 0 || o.seconds > 0) return;
    if (is_random(o) && !o.particles) o.particles = 1000000;
    if (!is_random(o) && !o.unshot && !o.shots) o.unshot = 0.01;
}

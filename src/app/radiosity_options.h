// app/radiosity_options.h  2  what the user asks of radiosity
#pragma once
#include "app/option.h"
#include "path/sampler.h"

// How the illumination maps are filled.
enum class Method {
    shooting,   // the element with the most unshot power shoots it, then the next
    hierarchy,  // whole faces shoot, in parts as small as their receivers need
    particles   // random walks from the lights
};

// What the image of the maps shows.
enum class MapView { luminance, illuminance, mesh };

struct RadiosityOptions : CommonOptions {
    Method method = Method::hierarchy;
    std::optional<double> mesh;  // longest edge of an element
    double unshot = 0;           // fraction of all power; 0: no limit
    uint64_t shots = 0;          // 0: no limit
    uint64_t particles = 0;      // 0: no limit
    double error = 0;            // of the maps; 0: none is asked for
    SamplerKind sampler = SamplerKind::halton;
    int rays = 2;  // squared, of a pixel
    MapView view = MapView::luminance;
};

// ---- Values -------------------------------------------------------------------------------------

namespace option {

inline double fraction(std::string_view text) {
    const double x = parse_fraction(text);
    if (x == 0) throw UserError(in_quotes(text) + " is never reached");
    if (x > 1) throw UserError(in_quotes(text) + " is more than 100 %");
    return x;
}

inline double relative_error(std::string_view text) {
    const double x = parse_fraction(text);
    if (x == 0) throw UserError(in_quotes(text) + " is never reached");
    if (x >= 1) throw UserError(in_quotes(text) + " is the error of darkness, or more");
    return x;
}

inline SamplerKind unbiased_sampler(std::string_view text) {
    if (text == "halton-naive") throw UserError(in_quotes(text) + " is biased");
    return SamplerKind(choice(text, "independent|stratified|halton|sobol"));
}

// What stands for a value in the statistics if the option says nothing to the method.
inline std::string if_any(bool any, const std::string& value) { return any ? value : "null"; }

}  // namespace option

// ---- The table ----------------------------------------------------------------------------------

inline constexpr double default_unshot = 0.01;
inline constexpr uint64_t default_particles = 1000000;
inline bool is_random(const RadiosityOptions& o) { return o.method == Method::particles; }

inline const OptionTable<RadiosityOptions> radiosity_table = {
    CommonRows<RadiosityOptions>::output("out/NAME-radiosity.png, .pfm"),
    one_of<RadiosityOptions>(
        "--method", "shooting|hierarchy|particles",
        "how light spreads: elements shoot what they have not yet shot, those of most power "
        "first; whole faces do, in parts as small as a receiver needs; or random walks from the "
        "lights",
        [](auto& o) -> auto& { return o.method; }),
    {"--mesh", "H", "longest edge of the triangles that faces are cut into",
     "a 32nd of the scene's diagonal",
     [](RadiosityOptions& o, Text v) { o.mesh = option::positive(v); }},
    {"--unshot", "F",
     "stop once this fraction of the emitted power is yet to be sent on (which is no error of the "
     "picture): 0.01, or 1%; not with particles",
     "1%, unless --error, --shots or --time is given",
     [](RadiosityOptions& o, Text v) { o.unshot = option::fraction(v); }},
    {"--shots", "N", "stop after N shots; not with particles", "",
     [](RadiosityOptions& o, Text v) { o.shots = parse_count(v, 1, uint64_t(1) << 40); }},
    {"--particles", "N",
     "stop after N walks, a multiple of 16 batches, each one thread's work; needs --method "
     "particles",
     "1000000, unless --error or --time is given",
     [](RadiosityOptions& o, Text v) { o.particles = parse_count(v, 1, uint64_t(1) << 40); }},
    {"--error", "E",
     "stop once the illumination maps' error is at most E: 0.05, or 5%; it is the quadratic mean "
     "over all surfaces relative to that of their light, and leaves out what the triangles cost; "
     "that of particles is estimated by their spread, that of the other methods bounded by what is "
     "unshot",
     "", [](RadiosityOptions& o, Text v) { o.error = option::relative_error(v); }},
    CommonRows<RadiosityOptions>::time("stop after S seconds; with --error, --unshot, --shots or "
                                       "--particles, whichever comes first"),
    {"--sampler", "independent|stratified|halton|sobol",
     "where the random numbers of particles come from", "halton",
     [](RadiosityOptions& o, Text v) { o.sampler = option::unbiased_sampler(v); },
     [](const RadiosityOptions& o) {
         const char* names[] = {"\"independent\"", "\"stratified\"", "\"halton\"", "\"sobol\""};
         return option::if_any(is_random(o), names[int(o.sampler)]);
     }},
    {"--seed", "N", "another seed, another noise, of particles", "0",
     [](RadiosityOptions& o, Text v) { o.seed = parse_count(v, 0, UINT64_MAX); },
     [](const RadiosityOptions& o) {
         return option::if_any(is_random(o), std::to_string(o.seed));
     }},
    {"--rays", "K", "K x K rays a pixel, on a grid", "2",
     [](RadiosityOptions& o, Text v) { o.rays = int(parse_count(v, 1, 64)); }},
    CommonRows<RadiosityOptions>::threads(),
    CommonRows<RadiosityOptions>::size(),
    CommonRows<RadiosityOptions>::exposure(),
    one_of<RadiosityOptions>(
        "--view", "luminance|illuminance|mesh",
        "what the image shows: radiance; illuminance (in a .pfm lux, if radiances are cd/m2; in a "
        ".png as if all were white); radiance and the edges of the triangles",
        [](auto& o) -> auto& { return o.view; }),
    CommonRows<RadiosityOptions>::stats(),
    CommonRows<RadiosityOptions>::quiet(),
    CommonRows<RadiosityOptions>::help(),
};

// ---- Words to options ---------------------------------------------------------------------------

// Throws UserError about the first word that cannot be used, or says nothing to the method.
inline RadiosityOptions parse_radiosity(const std::vector<std::string>& words) {
    RadiosityOptions o = parse_words(radiosity_table, words);
    if (o.help) return o;
    for (const Text name : {"--unshot", "--shots"})
        if (is_random(o) && is_given(o, name))
            throw UserError(std::string(name) + ": needs --method shooting or hierarchy");
    for (const Text name : {"--particles", "--sampler", "--seed"})
        if (!is_random(o) && is_given(o, name))
            throw UserError(std::string(name) + ": needs --method particles");
    need_scene(o);
    const bool ends = o.error > 0 || o.seconds > 0;
    if (!is_random(o) && !ends && !o.unshot && !o.shots) o.unshot = default_unshot;
    if (is_random(o) && !ends && !o.particles) o.particles = default_particles;
    return o;
}

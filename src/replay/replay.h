// replay/replay.h  1  prints the events of one path instead of rendering (--pixel)
#pragma once
#include <cstdio>

#include "film/film.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "text/named_scene.h"
#include "text/option.h"

namespace penumbra {

// ---- Options ------------------------------------------------------------------------------------

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
    replay->i = parse_count(v.substr(0, comma), 0, max_samples);
    if (comma != v.npos)
        replay->replication = uint32_t(parse_count(v.substr(comma + 1), 0, max_replications));
}

inline OptionTable replay_rows(std::optional<PixelSample>& replay) {
    return {{"--pixel", "X,Y", "print every event of one path of pixel X,Y instead of rendering",
             "", [&replay](Text v) { set_pixel(replay, v); }},
            {"--sample", "I[,K]", "index of the sample, and of its replication, for --pixel", "0,0",
             [&replay](Text v) { set_sample(replay, v); }}};
}

// ---- Events of a path ---------------------------------------------------------------------------

inline const char* in_words(Unlit why) {
    switch (why) {
        case Unlit::no: break;
        case Unlit::by_technique: return "--light none";
        case Unlit::without_lights: return "the scene has no light";
        case Unlit::by_delta: return "the surface is a mirror or glass";
        case Unlit::light_averted: return "the light does not emit towards the surface";
        case Unlit::light_behind: return "the light is behind the surface";
        case Unlit::reflects_nothing: return "the BSDF is 0";
    }
    return "";
}

inline const char* in_words(End why) {
    switch (why) {
        case End::no: break;
        case End::leaves_scene: return "the ray leaves the scene";
        case End::bounces: return "the maximum number of bounces";
        case End::in_surface: return "the ray lies in the surface";
        case End::reflects_nothing: return "the sampled direction reflects nothing";
        case End::roulette: return "Russian roulette";
    }
    return "";
}

// Prints the events of a path, one per line and with every digit: these numbers made the image.
class PathLog {
public:
    PathLog(const NamedScene& scene, std::FILE* out) : scene_(scene), out_(out) {}

    void film(const Start& at) const {
        print("position in the pixel", {at.u.x, at.u.y});
        print("ray from", at.ray.o);
        print("ray towards", at.ray.d);
    }

    // A vertex, as a visitor of Li.
    void operator()(const PathState& path, const VertexEvents& e) const {
        if (!e.met) return;
        const Vertex& x = e.vertex;
        std::fprintf(out_, "vertex %d: shape %u%s at distance %.17g\n", path.k, x.hit.id,
                     origin(x.hit.id).c_str(), double(x.hit.t));
        print("  p", x.at.p);
        print("  n", x.at.n);
        print("  throughput", path.beta);
        if (path.eta2 != 1) print("  its factor of refraction", {path.eta2});
        if (x.material->emits()) {
            print("  emission", e.Le);
            print("  MIS weight", {e.weight});
        }
        if (e.direct.light) light(e.direct);
        if (e.direct.unlit != Unlit::no)
            std::fprintf(out_, "  no light sample: %s\n", in_words(e.direct.unlit));
        if (e.scattered.pdf > 0) {
            print("  wi", e.wi);
            print("  f", e.scattered.f);
            print("  cosine", {std::abs(e.scattered.wi.z)});
            print("  pdf", {e.scattered.pdf});
        }
    }

    void end(const char* why, rgb L) const {
        std::fprintf(out_, "end: %s\n", why);
        print("L", L);
    }

private:
    const NamedScene& scene_;
    std::FILE* out_;

    // The material of this shape, and its line in the scene's file.
    std::string origin(uint32_t shape) const {
        if (scene_.line_of.empty()) return "";
        return ", material " + in_quotes(scene_.names[scene_.material_of[shape]]) + ", " +
               where(scene_, shape) + ",";
    }

    void light(const DirectLight& d) const {
        std::fprintf(out_, "  light sample: %s light, chosen with probability %.17g, %s\n",
                     name_of(*d.light), double(d.pdf / d.sample.pdf),
                     d.occluded ? "occluded" : "visible");
        print("    at", d.sample.at.p);
        print("    wi", d.sample.wi);
        print("    pdf", {d.pdf});
        print("    MIS weight", {d.weight});
        print("    reflected", d.L);
    }
    void print(const char* what, std::initializer_list<real> numbers) const {
        std::fprintf(out_, "%s:", what);
        for (real x : numbers) std::fprintf(out_, " %.17g", double(x));
        std::fputc('\n', out_);
    }
    void print(const char* what, vec3 v) const { print(what, {v.x, v.y, v.z}); }
};

// Prints one path of the image, and what a view shows of it, if there is one; throws UserError if
// its pixel is outside.
inline void replay(const NamedScene& scene, const Technique& technique,
                   const SamplerSettings& settings, const PixelSample& which,
                   const std::function<rgb(const Start&)>& view) {
    if (which.x >= scene.size.width || which.y >= scene.size.height)
        throw UserError("--pixel: outside the image");
    const PathLog log(scene, stdout);
    const Start at = start(scene, settings, which);
    std::printf("pixel %d,%d, sample %llu of replication %u, seed %llu\n", which.x, which.y,
                static_cast<unsigned long long>(which.i), which.replication,
                static_cast<unsigned long long>(settings.seed));
    log.film(at);
    if (view) return log.end("a view, not radiance", view(at));
    End why = End::no;
    const rgb L =
        Li(scene, technique, at.ray, at.sampler, [&](const PathState& path, const VertexEvents& e) {
            log(path, e);
            why = e.end;
        });
    log.end(in_words(why), L);
}

}  // namespace penumbra

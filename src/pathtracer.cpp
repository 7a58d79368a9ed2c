// pathtracer.cpp  floor 5  the path tracer; read it downwards: main, render, pixel, Li
#include <functional>

#include "direct.h"
#include "film.h"
#include "parser.h"
#include "program.h"
#include "report.h"
#include "sampler.h"
#include "views.h"
#include "weighted.h"

// What one path brings: radiance, and the rays it took.  With --direct ratio or regression L lacks
// the light in `shadowed`, which only a pixel's samples together can estimate.
struct PathSample {
    rgb L;
    uint64_t rays = 0;
    Shadowed shadowed = {};
};

// Inline, for more than one test includes this file.
inline int penumbra(const std::vector<std::string>& words);
inline Image variance_of(const Film& film, const ShadowFilm& shadows, Film::Estimate from);
inline void replay(const Scene& scene, const Options& o, const Pattern& pattern);
inline RunStats render(const Scene& scene, const Options& o, const Pattern& pattern, Film& film,
                       ShadowFilm* shadows = nullptr);
inline PathSample pixel(const Scene& scene, const Options& o, const Pattern& pattern, int x, int y,
                        uint64_t sample, const PathLog* log = nullptr);
inline PathSample Li(const Scene& scene, const Options& o, Ray ray, const Sampler& sampler,
                     const PathLog* log = nullptr);

// ---- Main -------------------------------------------------------------------------------------

#ifndef TESTING
int main(int argc, char** argv) {
    return exit_status([&] { return penumbra({argv + 1, argv + argc}); });
}
#endif

// The scene that the user asks for; throws UserError if it is not to be had.
inline Scene load(const Options& o) {
    auto [scene, warnings] = read_scene(o.scene);
    scene.size = o.size.value_or(scene.size);
    scene.depth = o.depth.value_or(scene.depth);
    scene.exposure = o.exposure.value_or(default_exposure(scene, o.view));
    for (Light& l : scene.lights) l.by_angle = o.polygons == Polygons::angle;
    for (const Light& l : scene.lights)
        if (l.kind == Light::Kind::point && o.light == LightMode::none)
            throw UserError("--light none: rays never hit the point light of " + o.scene);
    if (o.replay && (o.replay->x >= scene.size.width || o.replay->y >= scene.size.height))
        throw UserError("--pixel: outside the image");
    if (!o.quiet)
        for (const std::string& w : warnings)
            std::fprintf(stderr, "%s: warning: %s\n", o.scene.c_str(), w.c_str());
    return scene;
}

// The program; returns its exit status, throws UserError and SystemError.
int penumbra(const std::vector<std::string>& words) {
    const Options o = parse_options(words);
    if (o.help) {
        std::fputs(usage, stdout);
        return 0;
    }
    const Scene scene = load(o);
    const Pattern pattern = make_pattern(o.sampler, o.seed, o.halves, scene.depth, o.spp);
    if (o.replay) {
        replay(scene, o, pattern);
        return 0;
    }
    if (o.view == View::variance && o.spp == 1)
        throw UserError("--view variance: needs --spp 2 or more");
    catch_interrupt();
    std::error_code failed;
    if (o.default_outputs && (std::filesystem::create_directories("out", failed), failed))
        throw UserError("out: cannot make this directory: " + failed.message());
    for (const std::string& path : o.outputs) check_writable(path);
    if (!o.stats.empty()) check_writable(o.stats);

    Film film(scene.size);
    std::optional<ShadowFilm> shadows;
    if (estimates_pixels(o.direct)) shadows.emplace(o.direct, scene.size);
    const RunStats run = render(scene, o, pattern, film, shadows ? &*shadows : nullptr);
    if (run.non_finite > 0) {
        const NonFinite& bad = film.first_non_finite();
        const std::string pixel = std::to_string(bad.x) + "," + std::to_string(bad.y);
        const std::string sample = std::to_string(bad.sample);
        throw SystemError(std::to_string(run.non_finite) +
                          " samples were not finite, the first at pixel " + pixel + " sample " +
                          sample + " (replay it by --pixel " + pixel + " --sample " + sample +
                          "); nothing was written");
    }
    if (o.view == View::variance && run.spp == 1)
        throw UserError("--view variance: one sample has no variance; nothing was written");
    if (run.spp > 0) {
        const Image variance = shadows ? variance_of(film, *shadows, variance_estimate(o))
                                       : film.variance(variance_estimate(o));
        const Image radiance = shadows ? shadows->added_to(film.image()) : film.image();
        const Image& image = o.view == View::variance ? variance : radiance;
        for (const std::string& path : o.outputs) write_image(path, image, double(scene.exposure));
        if (!o.stats.empty())
            write_file(o.stats, encode_stats(o, scene.size, scene.depth, run, radiance, variance));
    }
    return run.interrupted ? 130 : 0;
}

// Ratio and regression are no means of samples: the spread of samples says nothing about them, the
// difference of two halves does, with an error of its own that falls as their bias does.
inline Image variance_of(const Film& film, const ShadowFilm& shadows, Film::Estimate from) {
    if (from == Film::Estimate::none) return film.variance(from);
    return film.variance_of_halves(shadows.half_added_to(film.half(0), 0),
                                   shadows.half_added_to(film.half(1), 1));
}

// Prints one path of the image.
void replay(const Scene& scene, const Options& o, const Pattern& pattern) {
    const PathLog log(stdout);
    pixel(scene, o, pattern, o.replay->x, o.replay->y, o.replay_sample, &log);
}

// ---- Render loop ------------------------------------------------------------------------------

// Adds passes to the film until the schedule is content, or Ctrl-C, or a sample is not finite.
inline RunStats render(const Scene& scene, const Options& o, const Pattern& pattern, Film& film,
                       ShadowFilm* shadows) {
    Progress progress(o);
    const bool weighted = o.film != Weighting::mc;
    Schedule schedule(o, weighted ? o.spp : pattern.period());
    std::atomic<uint64_t> rays = 0, redraws = 0, fallbacks = 0;
    while (uint64_t n = schedule.next(film.samples(), progress.elapsed())) {
        auto row = [&](int y) {
            uint64_t row_rays = 0;
            if (shadows) shadows->begin_row(y);
            auto L = [&](int x, uint64_t sample) {
                const PathSample path = pixel(scene, o, pattern, x, y, sample);
                row_rays += path.rays;
                if (shadows) shadows->add(x, y, sample, path.shadowed);
                return is_finite(path.shadowed) ? path.L : rgb{NAN, NAN, NAN};
            };
            if (weighted) {
                WeightedRow row_L(o, pattern, scene.size, y, L);
                film.add_row(y, n, std::ref(row_L));
                redraws += row_L.weigher().redraws;
                fallbacks += row_L.weigher().fallbacks;
            } else {
                film.add_row(y, n, L);
            }
            rays += row_rays;
        };
        auto meanwhile = [&](double part) {
            progress.show(double(film.samples()) + part * double(n));
        };
        if (!parallel_rows(film.height, o.threads, row, meanwhile)) break;
        if (film.non_finite() > 0) break;
        film.end_pass(n);
        if (shadows) shadows->end_pass();
    }
    const RunStats run{film.samples(), progress.elapsed(), rays, film.non_finite(), interrupted,
                       redraws,        fallbacks};
    progress.summary(run);
    return run;
}

// One sample of the mean over a pixel.  Unbiased, but for the scene's depth.
inline PathSample pixel(const Scene& scene, const Options& o, const Pattern& pattern, int x, int y,
                        uint64_t sample, const PathLog* log) {
    const uint64_t index = uint64_t(y) * uint64_t(scene.size.width) + uint64_t(x);
    const Sampler sampler(pattern, index, sample);
    const vec2 u = sampler.get2(film_x);
    const Ray ray = camera_ray(scene.camera, scene.size, real(x) + u.x, real(y) + u.y);
    if (log) log->film(u, ray);
    if (o.view != View::radiance && o.view != View::variance) {
        const rgb value = view_along(scene, o.view, ray);
        if (log) log->end("a view, not radiance", value);
        return {value, 1};
    }
    return Li(scene, o, ray, sampler, log);
}

// ---- Radiance ---------------------------------------------------------------------------------

// Weight of emission that a ray met by chance, its direction drawn from point p with density
// pdf_wi (infinite: from the camera, a mirror or glass, which no light sample can imitate).
inline real weight_of_emission(const Scene& scene, LightMode mode, vec3 p, real pdf_wi,
                               const Hit& hit, const Surface& y) {
    if (mode == LightMode::none || std::isinf(pdf_wi)) return 1;
    const Light& light = scene.lights[size_t(scene.light_of[hit.id])];
    const real pdf = light.pick * pdf_light(light, p, y);
    // 0 where light samples do not go: the inside of a two-sided sphere light.
    if (mode == LightMode::nee) return pdf > 0 ? 0 : 1;
    return power_heuristic(pdf_wi, pdf);
}

// The rendering equation (Kajiya 1986) along one path: at every vertex x
//   L(x, wo) = Le(x, wo) + integral over wi of f(x, wo, wi) L(y, -wi) |cos| dwi,
// the integral by one direction, the light that reaches x directly by one light sample as well.
inline PathSample Li(const Scene& scene, const Options& o, Ray ray, const Sampler& sampler,
                     const PathLog* log) {
    PathSample path;
    auto end = [&](const char* why) {
        if (log) log->end(why, path.L);
        return path;
    };
    rgb beta{1, 1, 1};       // product of f |cos| / pdf so far
    real pdf_wi = infinity;  // of ray.d
    vec3 from = ray.o;
    for (int scattered = 0;; ++scattered) {
        const auto hit = scene.bvh.closest(ray);
        ++path.rays;
        if (!hit) return end("the ray leaves the scene");
        const Surface x = surface(scene.shapes[hit->id], ray, *hit);
        const Material& m = scene.material(*hit, x.p);
        const real cos_o = -dot(x.n, ray.d);
        if (log) log->vertex(scattered, *hit, x, beta);

        if (m.emits()) {
            const rgb Le = emitted(m, cos_o);
            const real weight = weight_of_emission(scene, o.light, from, pdf_wi, *hit, x);
            path.L += beta * Le * weight;
            if (log) log->emission(Le, weight);
        }
        if (scattered == scene.depth) return end("the scene's depth");
        if (cos_o == 0) return end("a ray within the surface");

        const Frame local = frame(cos_o > 0 ? x.n : -x.n);
        const vec3 wo = local.to_local(-ray.d);

        const DirectLight d = direct_light(scene, o, m, x, local, wo, sampler, scattered);
        path.L += beta * d.L;
        path.rays += d.rays;
        if (log && d.light)
            log->light(*d.light, d.sample, d.pdf, d.weight, d.occluded, d.L + d.shadowed.wV);
        if (splits(o, scattered)) {
            const auto& [U, w, wV] = path.shadowed = d.shadowed;
            if (log) log->shadowed(U, w, wV);
            if (o.direct == Estimator::control) path.L += U - (w - wV);
        }

        const vec2 u_wi = sampler.get2(dimension(scattered, Draw::wi_x));
        const real u_lobe = sampler.get(dimension(scattered, Draw::lobe));
        const BsdfSample s = sample(m, wo, cos_o > 0, u_lobe, u_wi, o.direction);
        const vec3 wi = local.to_world(s.wi);
        if (log) log->scattering(wi, s.f, std::abs(s.wi.z), s.pdf);
        if (max_of(s.f) <= 0) return end("nothing is reflected that way");
        beta *= s.f * (std::abs(s.wi.z) / s.pdf);
        if (o.roulette > 0 && scattered + 1 >= o.roulette) {
            const real survival = std::min(real(1), max_of(beta));
            if (sampler.get(dimension(scattered, Draw::roulette)) >= survival)
                return end("Russian roulette");
            beta /= survival;
        }
        pdf_wi = m.is_delta() ? infinity : s.pdf;
        from = x.p;
        ray = spawn(x, wi);
    }
}

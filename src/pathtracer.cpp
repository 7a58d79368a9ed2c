// pathtracer.cpp  floor 5  the path tracer; read it downwards: main, render, pixel, Li
#include "film.h"
#include "parser.h"
#include "report.h"
#include "sampler.h"
#include "views.h"

// What one path brings: radiance, and the rays it took.
struct PathSample {
    rgb L;
    uint64_t rays = 0;
};

// Inline, for more than one test includes this file.
inline int penumbra(const std::vector<std::string>& words);
inline void replay(const Scene& scene, const Options& o, const Pattern& pattern);
inline RunStats render(const Scene& scene, const Options& o, const Pattern& pattern, Film& film);
inline PathSample pixel(const Scene& scene, const Options& o, const Pattern& pattern, int x, int y,
                        uint64_t sample, const PathLog* log = nullptr);
inline PathSample Li(const Scene& scene, const Options& o, Ray ray, const Sampler& sampler,
                     const PathLog* log = nullptr);

// ---- Main -------------------------------------------------------------------------------------

#ifndef TESTING
int main(int argc, char** argv) {
    try {
        return penumbra({argv + 1, argv + argc});
    } catch (const UserError& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 2;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
#endif

// The scene that the user asks for; throws UserError if it is not to be had.
inline Scene load(const Options& o) {
    auto [scene, warnings] = read_scene(o.scene);
    scene.size = o.size.value_or(scene.size);
    scene.depth = o.depth.value_or(scene.depth);
    scene.exposure = o.exposure.value_or(default_exposure(scene, o.view));
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
    const RunStats run = render(scene, o, pattern, film);
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
        const Image variance = film.variance(variance_estimate(o));
        const Image image = o.view == View::variance ? variance : film.image();
        for (const std::string& path : o.outputs) write_image(path, image, double(scene.exposure));
        if (!o.stats.empty())
            write_file(o.stats,
                       encode_stats(o, scene.size, scene.depth, run, film.image(), variance));
    }
    return run.interrupted ? 130 : 0;
}

// Prints one path of the image.
void replay(const Scene& scene, const Options& o, const Pattern& pattern) {
    const PathLog log(stdout);
    pixel(scene, o, pattern, o.replay->x, o.replay->y, o.replay_sample, &log);
}

// ---- Render loop ------------------------------------------------------------------------------

// Adds passes to the film until the schedule is content, or Ctrl-C, or a sample is not finite.
RunStats render(const Scene& scene, const Options& o, const Pattern& pattern, Film& film) {
    Progress progress(o);
    Schedule schedule(o, pattern.period());
    std::atomic<uint64_t> rays = 0;
    while (uint64_t n = schedule.next(film.samples(), progress.elapsed())) {
        auto row = [&](int y) {
            uint64_t row_rays = 0;
            film.add_row(y, n, [&](int x, uint64_t sample) {
                const PathSample path = pixel(scene, o, pattern, x, y, sample);
                row_rays += path.rays;
                return path.L;
            });
            rays += row_rays;
        };
        auto meanwhile = [&](double part) {
            progress.show(double(film.samples()) + part * double(n));
        };
        if (!parallel_rows(film.height, o.threads, row, meanwhile)) break;
        if (film.non_finite() > 0) break;
        film.end_pass(n);
    }
    const RunStats run{film.samples(), progress.elapsed(), rays, film.non_finite(), interrupted};
    progress.summary(run);
    return run;
}

// One sample of the mean over a pixel.  Unbiased, but for the scene's depth.
PathSample pixel(const Scene& scene, const Options& o, const Pattern& pattern, int x, int y,
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

// Radiance that one light, chosen at random, sends by way of x to wo: unbiased for the sum of all,
// f L cos / (pick pdf) where nothing is in the way.  Under MIS, its weighted share of it.
inline PathSample direct(const Scene& scene, const Options& o, const Material& m, const Surface& x,
                         const Frame& local, vec3 wo, const Sampler& sampler, int vertex,
                         const PathLog* log) {
    if (o.light == LightMode::none || scene.lights.empty() || m.is_delta()) return {};
    const Light& light = choose_light(scene, sampler.get(dimension(vertex, Draw::pick)));
    const auto s = sample_light(light, x.p, sampler.get2(dimension(vertex, Draw::light_x)));
    if (!s) return {};
    const vec3 wi = local.to_local(s->wi);
    const rgb f = eval(m, wo, wi);
    if (max_of(f) <= 0) return {};
    const real pdf_light = light.pick * s->pdf;
    const bool share = o.light == LightMode::mis && !s->delta;
    const real weight = share ? power_heuristic(pdf_light, pdf(m, wo, wi, o.direction)) : 1;
    const bool occluded = scene.bvh.occluded(spawn_to(x, s->at));
    const rgb L = occluded ? rgb{} : f * s->L * (wi.z / pdf_light * weight);
    if (log) log->light(light, *s, pdf_light, weight, occluded, L);
    return {L, 1};
}

// The rendering equation (Kajiya 1986) along one path: at every vertex x
//   L(x, wo) = Le(x, wo) + integral over wi of f(x, wo, wi) L(y, -wi) |cos| dwi,
// the integral by one direction, the light that reaches x directly by one light sample as well.
PathSample Li(const Scene& scene, const Options& o, Ray ray, const Sampler& sampler,
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

        const PathSample d = direct(scene, o, m, x, local, wo, sampler, scattered, log);
        path.L += beta * d.L;
        path.rays += d.rays;

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

// pathtracer.cpp  floor 5  the path tracer; read it downwards: main, render, pixel, Li
#include "film.h"
#include "parser.h"
#include "sampler.h"

// What one path brings: radiance, and the rays it took.
struct PathSample {
    rgb L;
    uint64_t rays = 0;
};

int penumbra(const std::vector<std::string>& words);
void render(const Scene& scene, const Options& o, Film& film, Progress& progress, uint64_t& rays);
PathSample pixel(const Scene& scene, const Options& o, int x, int y, uint64_t sample);
PathSample Li(const Scene& scene, const Options& o, Ray ray, Sampler& sampler);

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

// The program; returns its exit status, throws UserError and SystemError.
int penumbra(const std::vector<std::string>& words) {
    const Options o = parse_options(words);
    if (o.help) {
        std::fputs(usage, stdout);
        return 0;
    }
    auto [scene, warnings] = read_scene(o.scene);
    scene.size = o.size.value_or(scene.size);
    scene.depth = o.depth.value_or(scene.depth);
    scene.exposure = o.exposure.value_or(scene.exposure);
    for (const Light& l : scene.lights)
        if (l.kind == Light::Kind::point && o.light == LightMode::none)
            throw UserError("--light none: rays never hit the point light of " + o.scene);
    if (o.default_outputs) std::filesystem::create_directories("out");
    for (const std::string& path : o.outputs) check_writable(path);
    if (!o.quiet)
        for (const std::string& w : warnings)
            std::fprintf(stderr, "%s: warning: %s\n", o.scene.c_str(), w.c_str());

    catch_interrupt();
    Film film(scene.size);
    Progress progress(o);
    uint64_t rays = 0;
    render(scene, o, film, progress, rays);
    const double seconds = progress.elapsed();

    if (film.non_finite() > 0) {
        const NonFinite& bad = film.first_non_finite();
        progress.summary("");
        throw SystemError(std::to_string(film.non_finite()) +
                          " samples were not finite, the first at pixel " + std::to_string(bad.x) +
                          "," + std::to_string(bad.y) + " sample " + std::to_string(bad.sample) +
                          "; nothing was written");
    }
    if (film.samples() > 0)
        for (const std::string& path : o.outputs)
            write_image(path, film.image(), double(scene.exposure));
    progress.summary(o.scene + ": " + std::to_string(film.samples()) + " samples per pixel, " +
                     fixed(seconds, 2) + " s, " + fixed(double(rays) / seconds * 1e-6, 2) +
                     " Mrays/s, " + std::to_string(film.non_finite()) + " non-finite" +
                     (interrupted ? " (interrupted)" : ""));
    return interrupted ? 130 : 0;
}

// ---- Render loop ------------------------------------------------------------------------------

// Adds passes to the film until the schedule is content, or Ctrl-C, or a sample is not finite.
void render(const Scene& scene, const Options& o, Film& film, Progress& progress, uint64_t& rays) {
    Schedule schedule(o);
    std::atomic<uint64_t> count = 0;
    while (uint64_t n = schedule.next(film.samples(), progress.elapsed())) {
        auto row = [&](int y) {
            uint64_t row_rays = 0;
            film.add_row(y, n, [&](int x, uint64_t sample) {
                PathSample path = pixel(scene, o, x, y, sample);
                row_rays += path.rays;
                return path.L;
            });
            count += row_rays;
        };
        auto meanwhile = [&](double part) {
            progress.show(double(film.samples()) + part * double(n));
        };
        if (!parallel_rows(film.height, o.threads, row, meanwhile)) break;
        if (film.non_finite() > 0) break;
        film.end_pass(n);
    }
    rays = count;
}

// One sample of the mean radiance over a pixel.  Unbiased, but for the scene's depth.
PathSample pixel(const Scene& scene, const Options& o, int x, int y, uint64_t sample) {
    Sampler sampler(o.seed, uint64_t(y) * uint64_t(scene.size.width) + uint64_t(x), sample);
    const vec2 u = sampler.next2();
    return Li(scene, o, camera_ray(scene.camera, scene.size, real(x) + u.x, real(y) + u.y),
              sampler);
}

// ---- Radiance ---------------------------------------------------------------------------------

// Weight of emission that a ray met by chance, its direction drawn from point p with density
// pdf_wi (infinite: from the camera, a mirror or glass, which no light sample can imitate).
real weight_of_emission(const Scene& scene, LightMode mode, vec3 p, real pdf_wi, const Hit& hit,
                        const Surface& y) {
    if (mode == LightMode::none || std::isinf(pdf_wi)) return 1;
    if (mode == LightMode::nee) return 0;
    const Light& light = scene.lights[size_t(scene.light_of[hit.id])];
    return power_heuristic(pdf_wi, light.pick * pdf_light(light, p, y));
}

// Radiance that one light, chosen at random, sends by way of x to wo: unbiased for the sum of all,
// f L cos / (pick pdf) where nothing is in the way.  Under MIS, its weighted share of it.
PathSample direct(const Scene& scene, const Options& o, const Material& m, const Surface& x,
                  const Frame& local, vec3 wo, real u_pick, vec2 u_light) {
    if (o.light == LightMode::none || scene.lights.empty() || m.is_delta()) return {};
    const Light& light = choose_light(scene, u_pick);
    const auto s = sample_light(light, x.p, u_light);
    if (!s) return {};
    const vec3 wi = local.to_local(s->wi);
    const rgb f = eval(m, wo, wi);
    if (max_of(f) <= 0) return {};
    if (scene.bvh.occluded(spawn_to(x, s->at))) return {{}, 1};
    const real pdf_light = light.pick * s->pdf;
    const bool share = o.light == LightMode::mis && !s->delta;
    const real weight = share ? power_heuristic(pdf_light, pdf(m, wo, wi, o.direction)) : 1;
    return {f * s->L * (wi.z / pdf_light * weight), 1};
}

// The rendering equation (Kajiya 1986) along one path: at every vertex x
//   L(x, wo) = Le(x, wo) + integral over wi of f(x, wo, wi) L(y, -wi) |cos| dwi,
// the integral by one direction, the light that reaches x directly by one light sample as well.
PathSample Li(const Scene& scene, const Options& o, Ray ray, Sampler& sampler) {
    PathSample path;
    rgb beta{1, 1, 1};       // product of f |cos| / pdf so far
    real pdf_wi = infinity;  // of ray.d
    vec3 from = ray.o;
    for (int scattered = 0;; ++scattered) {
        const auto hit = scene.bvh.closest(ray);
        ++path.rays;
        if (!hit) return path;
        const Surface x = surface(scene.shapes[hit->id], ray, *hit);
        const Material& m = scene.material(*hit);
        const real cos_o = -dot(x.n, ray.d);

        if (m.emits())
            path.L += beta * emitted(m, cos_o) *
                      weight_of_emission(scene, o.light, from, pdf_wi, *hit, x);
        if (scattered == scene.depth || cos_o == 0) return path;

        const vec2 u_light = sampler.next2();
        const real u_pick = sampler.next();
        const vec2 u_wi = sampler.next2();
        const real u_lobe = sampler.next();
        const real u_roulette = sampler.next();
        const Frame local = frame(cos_o > 0 ? x.n : -x.n);
        const vec3 wo = local.to_local(-ray.d);

        const PathSample d = direct(scene, o, m, x, local, wo, u_pick, u_light);
        path.L += beta * d.L;
        path.rays += d.rays;

        const BsdfSample s = sample(m, wo, cos_o > 0, u_lobe, u_wi, o.direction);
        if (max_of(s.f) <= 0) return path;
        beta *= s.f * (std::abs(s.wi.z) / s.pdf);
        if (o.roulette > 0 && scattered + 1 >= o.roulette) {
            const real survival = std::min(real(1), max_of(beta));
            if (u_roulette >= survival) return path;
            beta /= survival;
        }
        pdf_wi = m.is_delta() ? infinity : s.pdf;
        from = x.p;
        ray = spawn(x, local.to_world(s.wi));
    }
}

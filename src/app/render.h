// app/render.h  5  from options to images: which samples, on which film
#pragma once
#include <atomic>

#include "app/indirect.h"
#include "app/views.h"
#include "film/error.h"
#include "shadow/shadow.h"
#include "voronoi/weighted.h"

// ---- What to render -----------------------------------------------------------------------------

struct Job {
    const Options& o;
    const Scene& scene;
    const Pattern pattern;
    const Passes passes;
    const Maps* maps = nullptr;  // on which paths end
    const Pattern rest = {};     // of their later numbers
};

// Whole grids first, then all sets but the first of each pixel.
inline Passes passes_of(const Options& o, const Target& target, uint64_t period) {
    return {target, period, o.threads, (samples_before_sets + period - 1) / period * period};
}

// Samples that will be taken, not only at most; 0: not known.
inline uint64_t planned(const Target& target) { return target.error > 0 ? 0 : target.samples; }

inline Job job_of(const Options& o, const Scene& scene) {
    const Target target = target_of(o, scene);
    const Pattern pattern = make_pattern(o.sampler, o.seed, scene.depth, planned(target));
    // Voronoi weights need all of a set's samples at once.
    const uint64_t period = o.film == Weighting::mc ? pattern.period() : target.samples;
    return {o, scene, pattern, passes_of(o, target, period)};
}

// Of an endless scene; what the maps took is taken off the time.
inline Job job_of(const Options& o, const Scene& scene, const Maps& maps) {
    Target target = target_of(o, scene);
    const Pattern pattern = EndlessNumbers::pattern(o.sampler, o.seed, planned(target));
    // Of all limits the shortest: 0 would be none, and the first pass runs in any case.
    constexpr double a_moment = 1e-3;
    if (target.seconds > 0)
        target.seconds = std::max(a_moment, target.seconds - maps.stats.seconds);
    return {o,       scene,
            pattern, passes_of(o, target, pattern.period()),
            &maps,   EndlessNumbers::independent(o.seed)};
}

// ---- Samples ------------------------------------------------------------------------------------

// Whether the image shows something that takes no path.
inline bool is_plain_view(View v) { return v != View::radiance && v != View::variance; }

// An account of Li that counts the path's rays.
inline auto counting(uint64_t& rays) {
    return [&rays](const Segment&, const Step& e) { rays += 1 + (e.direct.light != nullptr); };
}

// One sample by a path that ends on maps.
template <class Account>
rgb mapped_Li(const Job& job, const PixelSample& s, Account account) {
    const Start at = start(job.scene, job.pattern, s);
    const EndlessNumbers u(at.sampler, Sampler(job.rest, pixel_number(job.scene, s), s.i, s.set));
    return Li(job.maps->gather(job.o, job.scene), at.ray, u, account);
}

// Unbiased for the pixel's mean, but for the scene's depth.
inline rgb radiance(const Job& job, const Start& at, uint64_t& rays) {
    const auto& [o, scene, pattern, passes, maps, rest] = job;
    if (is_plain_view(o.view)) return ++rays, view_along(scene, o.view, at.ray);
    if (o.direct == Estimator::control)
        return shadow_Li(scene, o.technique, o.direct, at, counting(rays)).rest;
    return Li(scene, o.technique, at.ray, at.sampler, counting(rays));
}

// ---- Images -------------------------------------------------------------------------------------

struct Rendered {
    Image image, variance;
    RunStats run;
};

// Throws if a sample did not fit into the film.
template <class Pixel>
void check_finite(const Film<Pixel>& film) {
    if (film.non_finite() == 0) return;
    const NonFinite& bad = film.first_non_finite();
    const std::string pixel = std::to_string(bad.x) + "," + std::to_string(bad.y);
    const std::string sample = std::to_string(bad.sample);
    throw SystemError(
        std::to_string(film.non_finite()) + " samples were not finite, the first at pixel " +
        pixel + " sample " + sample + " (replay it by --pixel " + pixel + " --sample " + sample +
        (bad.set ? " --set " + std::to_string(bad.set) : "") + "); nothing was written");
}

// What the film holds, and how far that is from the truth.
template <class Pixel, class Value>
Rendered developed(const Film<Pixel>& film, const Options& o, RunStats run, ErrorCourse course,
                   Value value) {
    const Image image = film.image_of(value);
    run.mean_radiance = mean_of_pixels(image);
    run.error = error_of(film, value);
    run.sets = film.sets_per_pixel();
    if (course.is_due(run.spp)) course.add(run.spp, run.error.d_rel());
    run.exponent_of_cost = 1 / course.exponent();
    return {image, o.view == View::variance ? variance_of(film, value) : Image(), run};
}

// Renders row by row, row(y, n, rays), which counts its rays; value_in(film) is what the pixels
// say.
template <class Pixel, class Row, class ValueIn>
Rendered fill(Film<Pixel>& film, const Job& job, Row row, ValueIn value_in) {
    const Target& target = job.passes.target;
    SampleProgress progress(target, job.o.quiet);
    std::atomic<uint64_t> rays = 0;
    auto counted = [&](int y, uint64_t n) {
        uint64_t row_rays = 0;
        row(y, n, row_rays);
        rays += row_rays;
    };
    // Once, where noise is; if hardly any time is left, only those that measure.
    auto choose_sets = [&] {
        if (film.has_sets() || film.samples() < 2 || interrupted || film.non_finite() > 0) return;
        const std::vector<double> noise = film.noise();
        std::vector<Sets> sets = sets_where_noise_is(noise, film.size, job.o.seed);
        const double elapsed = progress.elapsed(), left = target.seconds - elapsed;
        if (target.seconds > 0 && (mean_count(sets) - 1) * elapsed > left)
            sets = sets_where_noise_is(noise, film.size, job.o.seed, {.most = 1});
        film.add_sets(std::move(sets));
        add_pass(film, 0, job.passes.threads, counted, progress);
    };
    if (sets_of(job.o) != sets_by_noise)
        film.add_sets(std::vector<Sets>(film.number_of_pixels(), {sets_of(job.o)}));
    ErrorCourse course;
    bool enough = false;
    uint64_t look = 0;  // at so many samples, however passes divide them
    render(film, job.passes, counted, progress, [&](const Film<Pixel>&) -> uint64_t {
        if (film.samples() < job.passes.pause) return UINT64_MAX;
        choose_sets();
        if (film.non_finite() > 0) return 0;
        if (film.samples() < look) return look - film.samples();
        if (target.error == 0 && !course.is_due(film.samples())) return UINT64_MAX;
        const ImageError e = error_of(film, value_in(film));
        course.add(film.samples(), e.d_rel());
        if (target.error == 0) return UINT64_MAX;
        const bool dark = e.norm == 0 && job.scene.lights.empty();  // and will stay so
        const uint64_t more = dark ? 0 : samples_to_look(e, target.error, film.samples());
        look = film.samples() + more;
        const double all =
            double(film.samples()) * course.cost_of(std::max(1.0, e.d_rel() / target.error));
        progress.expect(std::max(look, all < 1e18 ? uint64_t(all) : 0));
        enough = more == 0;
        return more;
    });
    choose_sets();
    check_finite(film);
    RunStats run;
    run.spp = film.samples(), run.seconds = progress.elapsed(), run.rays = rays;
    run.non_finite = film.non_finite(), run.interrupted = interrupted;
    run.stopped_by = enough ? "error" : film.samples() == target.samples ? "samples" : "time";
    if (run.interrupted) run.stopped_by = "interrupt";
    return developed(film, job.o, run, course, value_in(film));
}

inline Rendered render_means(const Job& job) {
    Film<MeanPixel> film(job.scene.size);
    auto row = [&](int y, uint64_t n, uint64_t& rays) {
        film.add_row(y, n, [&](int x, uint64_t i, uint32_t set) {
            return radiance(job, start(job.scene, job.pattern, {x, y, i, set}), rays);
        });
    };
    return fill(film, job, row, [](const auto& f) { return value_in(f); });
}

// By paths that end on maps, whose time and rays count, too.
inline Rendered render_mapped(const Job& job) {
    Film<MeanPixel> film(job.scene.size);
    auto row = [&](int y, uint64_t n, uint64_t& rays) {
        auto count = [&rays](const Segment&, const Step& e, const Mapped&) {
            rays += 1 + (e.direct.light != nullptr);
        };
        film.add_row(y, n, [&](int x, uint64_t i, uint32_t set) {
            return mapped_Li(job, {x, y, i, set}, count);
        });
    };
    Rendered r = fill(film, job, row, [](const auto& f) { return value_in(f); });
    r.run.maps = job.maps->stats;
    r.run.seconds += r.run.maps->seconds, r.run.rays += r.run.maps->rays;
    return r;
}

// Direct light by ratio or regression.
inline Rendered render_shadows(const Job& job) {
    const Options& o = job.o;
    Film<ShadowPixel> film(job.scene.size);
    auto row = [&](int y, uint64_t n, uint64_t& rays) {
        film.add_row(y, n, [&](int x, uint64_t i, uint32_t set) {
            const Start at = start(job.scene, job.pattern, {x, y, i, set});
            return shadow_Li(job.scene, o.technique, o.direct, at, counting(rays));
        });
    };
    return fill(film, job, row, [&](const auto& f) { return value_in(f, o.direct); });
}

// Samples weighted by the areas of their Voronoi cells.
inline Rendered render_cells(const Job& job) {
    Film<MeanPixel> film(job.scene.size);
    std::atomic<uint64_t> redraws = 0, fallbacks = 0;
    auto row = [&](int y, uint64_t n, uint64_t& rays) {
        auto L = [&](int x, uint64_t i, uint32_t set) {
            if (interrupted) return rgb{};  // its pass will not count
            return radiance(job, start(job.scene, job.pattern, {x, y, i, set}), rays);
        };
        const uint64_t all = job.passes.target.samples,
                       first = uint64_t(y) * uint64_t(film.size.width);
        WeightedRow weighted(job.o.film, job.pattern, all, first, L);
        film.add_row(y, n, [&](int x, uint64_t i, uint32_t set) { return weighted(x, i, set); });
        redraws += weighted.weigher().redraws;
        fallbacks += weighted.weigher().fallbacks;
    };
    Rendered r = fill(film, job, row, [](const auto& f) { return value_in(f); });
    r.run.redraws = redraws, r.run.fallbacks = fallbacks;
    return r;
}

inline Rendered rendered(const Job& job) {
    if (job.maps) return render_mapped(job);
    if (job.o.film != Weighting::mc) return render_cells(job);
    const bool plain = is_plain_view(job.o.view) || !estimates_pixels(job.o.direct);
    return plain ? render_means(job) : render_shadows(job);
}

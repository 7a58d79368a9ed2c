// app/render.h  5  from options to images: which samples, on which film
#pragma once
#include <atomic>

#include "app/indirect.h"
#include "app/views.h"
#include "shadow/shadow.h"
#include "voronoi/weighted.h"

// ---- What to render -----------------------------------------------------------------------------

// What the user's samples allow to say about their variance.
inline VarianceFrom variance_from(const Options& o) {
    if (o.film != Weighting::mc) return VarianceFrom::nothing;
    const bool samples = o.sampler == SamplerKind::independent;
    return samples    ? VarianceFrom::samples
           : o.halves ? VarianceFrom::halves
                      : VarianceFrom::nothing;
}

struct Job {
    const Options& o;
    const Scene& scene;
    const Pattern pattern;
    const Passes passes;
    const Maps* maps = nullptr;  // on which paths end
    const Pattern rest = {};     // of their later numbers
};

inline Job job_of(const Options& o, const Scene& scene) {
    const Target target = target_of(o, scene);
    const Pattern pattern = make_pattern(o.sampler, o.seed, o.halves, scene.depth, target.samples);
    // Voronoi weights need all of a pixel's samples at once.
    const uint64_t period = o.film == Weighting::mc ? pattern.period() : target.samples;
    return {o, scene, pattern, {target, period, o.threads}};
}

// Of an endless scene; what the maps took is taken off the time.
inline Job job_of(const Options& o, const Scene& scene, const Maps& maps) {
    Target target = target_of(o, scene);
    const Pattern pattern = EndlessNumbers::pattern(o.sampler, o.seed, o.halves, target.samples);
    // Of all limits the shortest: 0 would be none, and the first pass runs in any case.
    constexpr double a_moment = 1e-3;
    if (target.seconds > 0)
        target.seconds = std::max(a_moment, target.seconds - maps.stats.seconds);
    return {o,       scene,
            pattern, {target, pattern.period(), o.threads},
            &maps,   EndlessNumbers::independent(o.seed)};
}

// ---- Samples ------------------------------------------------------------------------------------

// Whether the image shows something that takes no path.
inline bool is_plain_view(View v) { return v != View::radiance && v != View::variance; }

// An account of Li that counts the path's rays.
inline auto counting(uint64_t& rays) {
    return [&rays](const Segment&, const Step& e) { rays += 1 + (e.direct.light != nullptr); };
}

// Sample i of pixel (x, y) by paths that end on maps.
template <class Account>
rgb mapped_Li(const Job& job, int x, int y, uint64_t i, Account account) {
    const Start at = start(job.scene, job.pattern, x, y, i);
    const uint64_t pixel = uint64_t(y) * uint64_t(job.scene.size.width) + uint64_t(x);
    const EndlessNumbers u(at.sampler, Sampler(job.rest, pixel, i));
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
    throw SystemError(std::to_string(film.non_finite()) +
                      " samples were not finite, the first at pixel " + pixel + " sample " +
                      sample + " (replay it by --pixel " + pixel + " --sample " + sample +
                      "); nothing was written");
}

// Renders row by row, row(y, n, rays), which counts its rays.
template <class Pixel, class Row>
RunStats fill(Film<Pixel>& film, const Job& job, Row row) {
    SampleProgress progress(job.passes.target, job.o.quiet);
    std::atomic<uint64_t> rays = 0;
    auto counted = [&](int y, uint64_t n) {
        uint64_t row_rays = 0;
        row(y, n, row_rays);
        rays += row_rays;
    };
    render(film, job.passes, counted, progress);
    check_finite(film);
    RunStats run;
    run.spp = film.samples(), run.seconds = progress.elapsed(), run.rays = rays;
    run.non_finite = film.non_finite(), run.interrupted = interrupted;
    return run;
}

// What the film holds.  Pixels are independent of each other: the variance of their mean is the
// mean of their variances over their number.
template <class Pixel, class Value, class Variance>
Rendered developed(const Film<Pixel>& film, RunStats run, Value value, Variance variance) {
    const Image image = film.image_of(value);
    run.mean_radiance = mean_of_pixels(image);
    run.variance_of_mean = film.mean_of(variance);
    for (double& v : run.variance_of_mean) v /= double(image.pixels.size());
    return {image, film.image_of(variance), run};
}

inline Rendered render_means(const Job& job) {
    const Options& o = job.o;
    const Scene& scene = job.scene;
    Film<MeanPixel> film(scene.size);
    const RunStats run = fill(film, job, [&](int y, uint64_t n, uint64_t& rays) {
        film.add_row(y, n, [&](int x, uint64_t i) {
            return radiance(job, start(scene, job.pattern, x, y, i), rays);
        });
    });
    return developed(film, run, value_in(film), variance_in(film, variance_from(o)));
}

// By paths that end on maps, whose time and rays count, too.
inline Rendered render_mapped(const Job& job) {
    Film<MeanPixel> film(job.scene.size);
    RunStats run = fill(film, job, [&](int y, uint64_t n, uint64_t& rays) {
        film.add_row(y, n, [&](int x, uint64_t i) {
            return mapped_Li(job, x, y, i, [&rays](const Segment&, const Step& e, const Mapped&) {
                rays += 1 + (e.direct.light != nullptr);
            });
        });
    });
    run.maps = job.maps->stats;
    run.seconds += run.maps->seconds, run.rays += run.maps->rays;
    return developed(film, run, value_in(film), variance_in(film, variance_from(job.o)));
}

// Direct light by ratio or regression.
inline Rendered render_shadows(const Job& job) {
    const Options& o = job.o;
    const Scene& scene = job.scene;
    Film<ShadowPixel> film(scene.size);
    const RunStats run = fill(film, job, [&](int y, uint64_t n, uint64_t& rays) {
        film.add_row(y, n, [&](int x, uint64_t i) {
            const Start at = start(scene, job.pattern, x, y, i);
            return shadow_Li(scene, o.technique, o.direct, at, counting(rays));
        });
    });
    return developed(film, run, value_in(film, o.direct),
                     variance_in(film, o.direct, variance_from(o)));
}

// Samples weighted by the areas of their Voronoi cells.
inline Rendered render_cells(const Job& job) {
    const Options& o = job.o;
    const Scene& scene = job.scene;
    Film<MeanPixel> film(scene.size);
    std::atomic<uint64_t> redraws = 0, fallbacks = 0;
    RunStats run = fill(film, job, [&](int y, uint64_t n, uint64_t& rays) {
        auto L = [&](int x, uint64_t i) {
            if (interrupted) return rgb{};  // its pass will not count
            return radiance(job, start(scene, job.pattern, x, y, i), rays);
        };
        WeightedRow weighted(o.film, job.pattern, n, uint64_t(y) * uint64_t(scene.size.width), L);
        film.add_row(y, n, [&](int x, uint64_t i) { return weighted(x, i); });
        redraws += weighted.weigher().redraws;
        fallbacks += weighted.weigher().fallbacks;
    });
    run.redraws = redraws, run.fallbacks = fallbacks;
    return developed(film, run, value_in(film), variance_in(film, VarianceFrom::nothing));
}

inline Rendered rendered(const Job& job) {
    if (job.maps) return render_mapped(job);
    if (job.o.film != Weighting::mc) return render_cells(job);
    const bool plain = is_plain_view(job.o.view) || !estimates_pixels(job.o.direct);
    return plain ? render_means(job) : render_shadows(job);
}

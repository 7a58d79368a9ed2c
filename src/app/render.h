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

// An account of Li that counts the path's rays, and leaves a path for which nobody waits any more.
inline auto counting(uint64_t& rays) {
    return [&rays](const Segment&, const Step& e) {
        if (interrupted) throw Interrupted();
        rays += 1 + (e.direct.light != nullptr);
    };
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
    Image image;  // of what --view asks for
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

// Picks the sets of a film's pixels by its noise; if hardly any time is left, only those that
// measure.
template <class Pixel>
std::vector<Sets> sets_by_film(const Film<Pixel>& film, const Job& job, double elapsed) {
    std::vector<Sets> sets = sets_where_noise_is(film.noise(), film.size, job.o.seed);
    const double limit = job.passes.target.seconds;
    if (limit > 0 && (mean_count(sets) - 1) * elapsed > limit - elapsed)
        sets = sets_where_noise_is(film.noise(), film.size, job.o.seed, {.most = 1});
    return sets;
}

// A film on its way to the target: what happens between its passes.
template <class Pixel, class Add>
class Filling {
public:
    Filling(Film<Pixel>& film, const Job& job, Add add)
        : film_(film), job_(job), add_(add), progress_(job.passes.target, job.o.quiet) {}

    void fill() {
        if (sets_of(job_.o) != sets_by_noise && !film_.has_sets())
            film_.add_sets(std::vector<Sets>(film_.number_of_pixels(), {sets_of(job_.o)}));
        render(film_, job_.passes, add_, progress_,
               [&](const Film<Pixel>&) { return film_.samples() ? between() : UINT64_MAX; });
        choose_sets();
    }

    RunStats stats() {
        const Target& target = job_.passes.target;
        RunStats run;
        run.spp = film_.samples(), run.seconds = progress_.elapsed();
        run.non_finite = film_.non_finite(), run.interrupted = interrupted;
        run.stopped_by = enough_ ? "error" : run.spp == target.samples ? "samples" : "time";
        if (run.interrupted) run.stopped_by = "interrupt";
        const ErrorTerms terms = film_.terms();
        for (size_t c = 0; c < 3; ++c) run.mean_radiance[c] = terms.sum[c] / double(terms.pixels);
        run.error = terms.error();
        run.sets = film_.sets_per_pixel();
        if (course_.is_due(run.spp)) course_.add(run.spp, run.error.d_rel());
        run.exponent_of_cost = 1 / course_.exponent();
        return run;
    }

private:
    Film<Pixel>& film_;
    const Job& job_;
    const Add add_;
    SampleProgress progress_;
    ErrorCourse course_;
    bool enough_ = false;

    // Once, where noise is.
    void choose_sets() {
        if (film_.has_sets() || film_.samples() < 2 || interrupted || film_.non_finite() > 0)
            return;
        film_.add_sets(sets_by_film(film_, job_, progress_.elapsed()));
        add_pass(film_, 0, job_.passes.threads, add_, progress_);
    }

    // How many samples the next pass may bring.
    uint64_t between() {
        const auto& [target, period, threads, pause] = job_.passes;
        const uint64_t samples = film_.samples();
        if (samples < pause) return UINT64_MAX;
        choose_sets();
        if (film_.non_finite() > 0) return 0;
        const bool looks = target.error > 0 && next_look(samples - 1, pause, period) == samples;
        if (looks || course_.is_due(samples)) look(error_of(film_), looks);
        if (enough_) return 0;
        return target.error > 0 ? next_look(samples, pause, period) - samples : UINT64_MAX;
    }

    void look(const ImageError& e, bool may_be_enough) {
        const double wanted = job_.passes.target.error;
        const uint64_t samples = film_.samples();
        course_.add(samples, e.d_rel());
        if (!may_be_enough) return;
        enough_ = is_small_enough(e, wanted);
        // It is dark, and will stay so.
        if (e.norm == 0 && job_.scene.lights.empty()) enough_ = true;
        const double all = double(samples) * course_.cost_of(std::max(1.0, e.d_rel() / wanted));
        progress_.expect(std::max(samples, all < 1e18 ? uint64_t(all) : 0));
    }
};

// Renders into a film of that kind of pixel: radiance_of_block() is an L(sample, rays), which
// counts its rays.
template <class Pixel, class RadianceOfBlock>
Rendered fill(const Job& job, const typename Pixel::Value& value,
              RadianceOfBlock radiance_of_block) {
    const Shows shows = job.o.view == View::variance ? Shows::variances : Shows::values;
    Film<Pixel> film(job.scene.size, value, shows);
    std::atomic<uint64_t> rays = 0;
    auto add = [&](size_t block, uint64_t n) {
        uint64_t rays_of_block = 0;
        auto L = radiance_of_block();
        film.add_block(block, n, [&](int x, int y, uint64_t i, uint32_t set) {
            return L(PixelSample{x, y, i, set}, rays_of_block);
        });
        rays += rays_of_block;
    };
    Filling filling(film, job, add);
    filling.fill();
    check_finite(film);
    RunStats run = filling.stats();
    run.rays = rays;
    return {film.take_image(), run};
}

inline Rendered render_means(const Job& job) {
    return fill<MeanPixel>(job, {}, [&] {
        return [&](const PixelSample& s, uint64_t& rays) {
            return radiance(job, start(job.scene, job.pattern, s), rays);
        };
    });
}

// By paths that end on maps, whose time and rays count, too.
inline Rendered render_mapped(const Job& job) {
    Rendered r = fill<MeanPixel>(job, {}, [&] {
        return [&](const PixelSample& s, uint64_t& rays) {
            auto count = counting(rays);
            return mapped_Li(job, s, [&](const Segment& segment, const Step& e, const Mapped&) {
                count(segment, e);
            });
        };
    });
    r.run.maps = job.maps->stats;
    r.run.seconds += r.run.maps->seconds, r.run.rays += r.run.maps->rays;
    return r;
}

// Direct light by ratio or regression.
inline Rendered render_shadows(const Job& job) {
    const Options& o = job.o;
    return fill<ShadowPixel>(job, {o.direct}, [&] {
        return [&](const PixelSample& s, uint64_t& rays) {
            const Start at = start(job.scene, job.pattern, s);
            return shadow_Li(job.scene, o.technique, o.direct, at, counting(rays));
        };
    });
}

// Samples weighted by the areas of their Voronoi cells.
inline Rendered render_cells(const Job& job) {
    std::atomic<uint64_t> redraws = 0, fallbacks = 0;
    const uint64_t all = job.passes.target.samples;
    Rendered r = fill<MeanPixel>(job, {}, [&] {
        return [&, weighted = WeightedPixels(job.o.film, job.pattern, all)](
                   const PixelSample& s, uint64_t& rays) mutable {
            const Weigher& weigher = weighted.weigher();
            const uint64_t redrawn = weigher.redraws, fallen = weigher.fallbacks;
            auto L = [&](uint64_t i) {
                if (interrupted) throw Interrupted();
                return radiance(job, start(job.scene, job.pattern, {s.x, s.y, i, s.set}), rays);
            };
            const rgb value = weighted(pixel_number(job.scene, s), s.set, s.i, L);
            redraws += weigher.redraws - redrawn, fallbacks += weigher.fallbacks - fallen;
            return value;
        };
    });
    r.run.redraws = redraws, r.run.fallbacks = fallbacks;
    return r;
}

inline Rendered rendered(const Job& job) {
    if (job.maps) return render_mapped(job);
    if (job.o.film != Weighting::mc) return render_cells(job);
    const bool plain = is_plain_view(job.o.view) || !estimates_pixels(job.o.direct);
    return plain ? render_means(job) : render_shadows(job);
}

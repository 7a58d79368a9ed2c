// app/job.h  6  what to render: which samples of which pixels, by what paths
#pragma once
#include "app/indirect.h"
#include "app/part.h"
#include "app/views.h"
#include "shadow/shadow.h"

// ---- What to render -----------------------------------------------------------------------------

struct Job {
    const Options& o;
    const Scene& scene;
    const Pattern pattern;
    const Passes passes;
    const Part part;
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
    Target target = target_of(o, scene);
    const Part part = part_of(o, scene, target.samples);
    const Pattern pattern = make_pattern(o.sampler, o.seed, scene.depth, planned(target));
    target.samples = part.samples;
    // Voronoi weights need all of a set's samples at once.
    const uint64_t period = o.film == Weighting::mc ? pattern.period() : target.samples;
    return {o, scene, pattern, passes_of(o, target, period), part};
}

// Of an endless scene; what the maps took is taken off the time.
inline Job job_of(const Options& o, const Scene& scene, const Maps& maps) {
    Target target = target_of(o, scene);
    const Part part = part_of(o, scene, target.samples);
    const Pattern pattern = EndlessNumbers::pattern(o.sampler, o.seed, planned(target));
    target.samples = part.samples;
    // Of all limits the shortest: 0 would be none, and the first pass runs in any case.
    constexpr double a_moment = 1e-3;
    if (target.seconds > 0)
        target.seconds = std::max(a_moment, target.seconds - maps.stats.seconds);
    return {o,
            scene,
            pattern,
            passes_of(o, target, pattern.period()),
            part,
            &maps,
            EndlessNumbers::independent(o.seed)};
}

// Samples of first sets after which the other sets are chosen.
inline uint64_t samples_to_choose(const Job& job) {
    const uint64_t total = job.part.total, pause = job.passes.pause;
    return total > 0 ? std::min(pause, total) : pause;
}

// Sample i of a film that holds a part of the picture.
inline PixelSample in_picture(const Part& part, int x, int y, uint64_t i, uint32_t set) {
    return {x, y + part.first_row, i + part.first_sample, set};
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
    const auto& [o, scene, pattern, passes, part, maps, rest] = job;
    if (is_plain_view(o.view)) return ++rays, view_along(scene, o.view, at.ray);
    if (o.direct == Estimator::control)
        return shadow_Li(scene, o.technique, o.direct, at, counting(rays)).rest;
    return Li(scene, o.technique, at.ray, at.sampler, counting(rays));
}

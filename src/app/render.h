// app/render.h  9  from options to images: by which paths, on which film
#pragma once
#include "app/filling.h"
#include "voronoi/weighted.h"

struct CountNothing {
    void operator()(RunStats&) const {}
};

template <class Pixel, class RadianceOfBlock, class Count = CountNothing>
Rendered fill(const Job& job, const FilmHeader& identity, const typename Pixel::Value& value,
              RadianceOfBlock radiance_of_block, Count count = {}) {
    Filling<Pixel, RadianceOfBlock, Count> filling(job, identity, value, radiance_of_block, count);
    return filling.fill();
}

inline Rendered render_means(const Job& job, const FilmHeader& identity) {
    return fill<MeanPixel>(job, identity, {}, [&] {
        return [&](const PixelSample& s, uint64_t& rays) {
            return radiance(job, start(job.scene, job.pattern, s), rays);
        };
    });
}

// By paths that end on maps, whose time and rays count, too.
inline Rendered render_mapped(const Job& job, const FilmHeader& identity) {
    auto L = [&] {
        return [&](const PixelSample& s, uint64_t& rays) {
            auto count = counting(rays);
            return mapped_Li(job, s, [&](const Segment& segment, const Step& e, const Mapped&) {
                count(segment, e);
            });
        };
    };
    Rendered r =
        fill<MeanPixel>(job, identity, {}, L, [&](RunStats& run) { run.maps = job.maps->stats; });
    r.run.seconds += r.run.maps->seconds, r.run.rays += r.run.maps->rays;
    return r;
}

// Direct light by ratio or regression.
inline Rendered render_shadows(const Job& job, const FilmHeader& identity) {
    const Options& o = job.o;
    return fill<ShadowPixel>(job, identity, {o.direct}, [&] {
        return [&](const PixelSample& s, uint64_t& rays) {
            const Start at = start(job.scene, job.pattern, s);
            return shadow_Li(job.scene, o.technique, o.direct, at, counting(rays));
        };
    });
}

// Samples weighted by the areas of their Voronoi cells.
inline Rendered render_cells(const Job& job, const FilmHeader& identity) {
    std::atomic<uint64_t> redraws = 0, fallbacks = 0;
    const uint64_t all = job.passes.target.samples;
    auto weighted_L = [&] {
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
    };
    return fill<MeanPixel>(job, identity, {}, weighted_L, [&](RunStats& run) {
        run.redraws += redraws, run.fallbacks += fallbacks;
    });
}

// identity: of checkpoints, see identity_of().
inline Rendered rendered(const Job& job, const FilmHeader& identity = {}) {
    if (job.maps) return render_mapped(job, identity);
    if (job.o.film != Weighting::mc) return render_cells(job, identity);
    const bool plain = is_plain_view(job.o.view) || !estimates_pixels(job.o.direct);
    return plain ? render_means(job, identity) : render_shadows(job, identity);
}

// labs/films.h  2  films within a lab, as penumbra fills them
#pragma once
#include "app/options.h"
#include "film/passes.h"
#include "path/start.h"

// Of paths; counts their rays.
inline Radiance radiance_of(const Scene& scene, const Technique& t, const Pattern& pattern) {
    return [&scene, t, &pattern](const PixelSample& s, Tally& tally) {
        const Start at = start(scene, pattern, s);
        return Li(scene, t, at.ray, at.sampler, [&](const Segment&, const Step& e) {
            tally.rays += 1 + (e.direct.light != nullptr);
        });
    };
}

// Brings every replication to n samples.
inline void fill(Film& film, uint64_t n, const Radiance& L, unsigned threads = 1) {
    const std::vector<size_t> at = offsets(film);
    auto add = [&](size_t block) {
        Tally tally;
        add_samples(film, block, at[block], n, L, tally);
    };
    if (threads > 1)
        in_parallel(film.taken.size(), threads, add, [](double) {});
    else
        for (size_t block = 0; block < film.taken.size(); ++block) add(block);
}

// The image by these options, of --spp samples a pixel.
inline Image rendered(const Scene& scene, const Options& o) {
    const uint64_t n = samples_each(o, o.spp);
    const Pattern pattern = make_pattern(o.sampler, o.seed, scene.depth, n);
    const Radiance L = radiance_of(scene, o.technique, pattern);
    Film film = make_film(scene.size, o.spp == 1 && o.sets == 0 ? 1 : o.sets);
    if (film.sets.empty()) {
        fill(film, Plan{{n}, pattern.period()}.pilot(), L, o.threads);
        choose_sets(film, INFINITY);
    }
    fill(film, n, L, o.threads);
    return image_of(film);
}

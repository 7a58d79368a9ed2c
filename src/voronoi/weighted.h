// voronoi/weighted.h  6  pixels from samples that are weighted by their Voronoi cells
#pragma once
#include <atomic>

#include "film/loop.h"
#include "path/start.h"
#include "voronoi/weights.h"

namespace penumbra {

// Number of redraws and fallbacks of weights, see Weigher.
struct WeightTroubles {
    std::atomic<uint64_t> redraws = 0, fallbacks = 0;
};

// A film's function of a sample from L, one of the pixel's samples: the weighted mean of all n of a
// replication, by their places in the pixel.  The sampler is `independent`.  Bias class:
// see Weighting.
inline SampleFunction weighted_mean(const Scene& scene, const SamplerSettings& settings,
                                    Weighting kind, uint64_t n, const SampleFunction& L,
                                    WeightTroubles& troubles) {
    return [=, &scene, &settings, &troubles](PixelSample s, Tally& tally) {
        std::vector<Site> places;
        std::vector<rgb> values;
        const uint64_t pixel = pixel_number(scene, s);
        for (s.i = 0; s.i < n; ++s.i) {
            // As L draws it.
            const vec2 u = Sampler(settings, pixel, s.i, s.replication).get2(film_x);
            places.push_back({double(u.x), double(u.y)});
            values.push_back(L(s, tally));
        }
        Weigher weigher;
        // No path draws this number.
        const uint64_t strip =
            hash(hash(hash(0, settings.seed), pixel), UINT64_MAX - s.replication);
        const std::vector<double>& weights = weigher(kind, places, strip);
        troubles.redraws += weigher.redraws, troubles.fallbacks += weigher.fallbacks;
        Sum sum{};
        for (size_t i = 0; i < n; ++i)
            for (size_t c = 0; c < 3; ++c) sum[c] += weights[i] * double(values[i].*axis[c]);
        return rgb{real(sum[0]), real(sum[1]), real(sum[2])};
    };
}

}  // namespace penumbra

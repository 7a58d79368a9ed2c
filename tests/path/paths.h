// path/paths.h  single paths of a scene, for tests
#pragma once
#include "path/pathtracer.h"
#include "path/start.h"

// Radiance of sample i of pixel (x, y).
template <class Account = NoAccount>
rgb radiance(const Scene& scene, const Technique& t, const Pattern& pattern, int x, int y,
             uint64_t i, Account account = {}) {
    const Start at = start(scene, pattern, x, y, i);
    return Li(scene, t, at.ray, at.sampler, account);
}

// Rays that its path took.
inline uint64_t rays_of(const Scene& scene, const Technique& t, const Pattern& pattern, int x,
                        int y, uint64_t i) {
    uint64_t rays = 0;
    radiance(scene, t, pattern, x, y, i,
             [&](const Segment&, const Step& e) { rays += 1 + (e.direct.light != nullptr); });
    return rays;
}

// path/start.h  3  where paths start: the samples of a pixel
#pragma once
#include "path/sampler.h"
#include "world/scene.h"

// Sample i of pixel (x, y): the numbers of its path, its place in the pixel, its ray.
struct Start {
    Sampler sampler;
    vec2 u;
    Ray ray;
};

inline Start start(const Scene& scene, const Pattern& pattern, int x, int y, uint64_t i) {
    const uint64_t pixel = uint64_t(y) * uint64_t(scene.size.width) + uint64_t(x);
    const Sampler sampler(pattern, pixel, i);
    const vec2 u = sampler.get2(film_x);
    return {sampler, u, camera_ray(scene.camera, scene.size, real(x) + u.x, real(y) + u.y)};
}

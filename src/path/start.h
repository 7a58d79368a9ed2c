// path/start.h  3  the start of a path: a sample of a pixel
#pragma once
#include "path/sampler.h"
#include "world/scene.h"

namespace penumbra {

// The sampler of the path, its position in the pixel, and its ray.
struct Start {
    Sampler sampler;
    vec2 u;
    Ray ray;
};

inline uint64_t pixel_number(const Scene& scene, const PixelSample& s) {
    return uint64_t(s.y) * uint64_t(scene.size.width) + uint64_t(s.x);
}

// The coordinate x + u of a point of pixel x.  Rounding never takes it to the next pixel.
inline real in_pixel(int x, real u) { return std::min(real(x) + u, real(x + 1) * below_one); }

Start start(const Scene&, const SamplerSettings&&, const PixelSample&) = delete;
inline Start start(const Scene& scene, const SamplerSettings& settings, const PixelSample& s) {
    const Sampler sampler(settings, pixel_number(scene, s), s.i, s.replication);
    const vec2 u = sampler.get2(film_x);
    return {sampler, u,
            camera_ray(scene.camera, scene.size, in_pixel(s.x, u.x), in_pixel(s.y, u.y))};
}

}  // namespace penumbra

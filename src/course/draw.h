// course/draw.h  2  pictures by the plainest loop: pixel by pixel, sample by sample
#pragma once
#include <atomic>
#include <thread>

#include "film/image.h"
#include "path/pathtracer.h"
#include "path/start.h"
#if __has_include("shadow/shadow.h")
#include "shadow/shadow.h"
#endif

// What a picture shows.
enum class Picture {
    normal,     // (n + 1) / 2 where a ray stops, n on its side
    occlusion,  // the part of a cosine-weighted hemisphere that leaves the scene, or gets far
    radiance    // of paths
};

struct Drawing {
    Picture picture = Picture::radiance;
    SamplerKind sampler = SamplerKind::independent;
    uint64_t samples = 16;  // a pixel
    uint64_t seed = 0;
    Technique technique = {Direction::bsdf, LightMode::mis, 0};
#if __has_include("shadow/shadow.h")
    std::optional<Estimator> direct = {};  // of light in shadow; nothing: as paths find it
#endif
};

inline rgb normal_seen(const Scene& scene, const Ray& ray) {
    const auto x = meet(scene, ray);
    return x ? (x->local.n + vec3{1, 1, 1}) / 2 : rgb{};
}

// What the tree does for a ray through the centre of a pixel, on average (week 1).
struct MeanWork {
    double boxes = 0, shapes = 0;
};
inline MeanWork mean_work(const Scene& scene) {
    MeanWork sum;
    const auto [w, h] = scene.size;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const auto work = scene.bvh.work(
                camera_ray(scene.camera, scene.size, real(x) + real(0.5), real(y) + real(0.5)));
            sum.boxes += work.nodes, sum.shapes += work.shapes;
        }
    return {sum.boxes / (w * h), sum.shapes / (w * h)};
}

// Ambient occlusion (Landis 2002): the mean over cos(theta) / pi of whether nothing is near.
inline rgb occlusion_seen(const Scene& scene, const Start& at, real far) {
    const auto x = meet(scene, at.ray);
    if (!x) return {1, 1, 1};
    const vec3 w = sample_cosine_hemisphere(at.sampler.get2(dimension(0, Draw::wi_x)));
    Ray ray = spawn(x->at, x->local.to_world(w));
    ray.tmax = far;
    return scene.bvh.occluded(ray) ? rgb{} : rgb{1, 1, 1};
}

#if __has_include("shadow/shadow.h")
// The mean of paths, and what the estimator makes of all light samples of the pixel.
inline rgb pixel_in_shadow(const Scene& scene, const Drawing& d, const Pattern& pattern, int x,
                           int y) {
    ShadowPixel pixel;
    for (uint64_t i = 0; i < d.samples; ++i)
        pixel.add(shadow_Li(scene, d.technique, start(scene, pattern, {x, y, i}), NoVisitor{}));
    return pixel.value(*d.direct);
}
#endif

inline rgb pixel(const Scene& scene, const Drawing& d, const Pattern& pattern, real far, int x,
                 int y) {
#if __has_include("shadow/shadow.h")
    if (d.direct) return pixel_in_shadow(scene, d, pattern, x, y);
#endif
    rgb sum;
    for (uint64_t i = 0; i < d.samples; ++i) {
        const Start at = start(scene, pattern, {x, y, i});
        if (d.picture == Picture::normal)
            sum += normal_seen(scene, at.ray);
        else if (d.picture == Picture::occlusion)
            sum += occlusion_seen(scene, at, far);
        else
            sum += Li(scene, d.technique, at.ray, at.sampler);
    }
    return sum / real(d.samples);
}

// Rows go to whichever thread is free; a pixel's numbers do not depend on it.
inline Image draw(const Scene& scene, const Drawing& d) {
    const Pattern pattern = make_pattern(d.sampler, d.seed, scene.depth, d.samples);
    const real far = diagonal(scene) / 4;
    Image image(scene.size.width, scene.size.height);
    std::atomic<int> next = 0;
    auto work = [&] {
        for (int y; (y = next++) < scene.size.height;)
            for (int x = 0; x < scene.size.width; ++x) {
                const rgb L = pixel(scene, d, pattern, far, x, y);
                image.at(x, y) = {float(L.x), float(L.y), float(L.z)};
            }
    };
    std::vector<std::thread> threads(std::max(1u, std::thread::hardware_concurrency()));
    for (std::thread& t : threads) t = std::thread(work);
    for (std::thread& t : threads) t.join();
    return image;
}

// app/views.h  2  views of a scene other than its radiance (--view)
#pragma once
#include "app/options.h"
#include "film/image.h"
#include "path/start.h"
#include "world/warp.h"

namespace penumbra {

// Ambient occlusion (Landis 2002): 1 where nothing is met, or where a ray from there, in a
// direction of density cos / pi, meets nothing within `far`.
inline rgb occlusion_along(const Scene& scene, const Start& at, real far) {
    const auto x = meet(scene, at.ray);
    if (!x) return {1, 1, 1};
    const vec2 u = at.sampler.get2(dimension(0, Draw::wi_x));
    Ray ray = spawn(x->at, x->local.to_world(sample_cosine_hemisphere(u)));
    ray.tmax = far;
    return scene.bvh.occluded(ray) ? rgb{} : rgb{1, 1, 1};
}

inline real far_of(const Scene& scene) { return diagonal(scene) / 4; }

// The value of a view for a sample; black where its ray meets nothing, except for occlusion.
inline rgb view_along(const Scene& scene, View view, const Start& at, real far) {
    if (view == View::occlusion) return occlusion_along(scene, at, far);
    const Ray& ray = at.ray;
    if (view == View::bvh) {
        const Tree::Work work = scene.bvh.work(ray);
        return {real(work.nodes), real(work.shapes), 0};
    }
    const auto x = meet(scene, ray);
    if (!x) return {};
    if (view == View::depth) return {x->hit.t, x->hit.t, x->hit.t};
    if (view == View::normal) return (x->at.n + vec3{1, 1, 1}) / 2;
    return x->material->albedo();
}

// The end of a file's name: "-depth"; "" for radiance.
inline std::string suffix_of(View view) {
    std::string suffix;
    if (view != View::radiance) suffix.append("-").append(word_of(views, view));
    return suffix;
}

// A view as a PNG shows it: depth from black (nearest) to white (farthest), work relative to that
// of the most expensive pixel.  The other views stay as they are.  The nearest percent of depths is
// black: some of these pixels are partly background, which has depth 0.
inline Image scaled(Image image, View view) {
    if (view != View::depth && view != View::bvh) return image;
    std::vector<float> values;
    for (const auto& pixel : image.pixels)
        for (const float x : pixel)
            if (x > 0) values.push_back(x);
    if (values.empty()) return image;
    const auto nearest = values.begin() + std::ptrdiff_t(values.size() / 100);
    std::nth_element(values.begin(), nearest, values.end());
    const float least = view == View::depth ? *nearest : 0;
    const float range = *std::max_element(nearest, values.end()) - least;
    for (auto& pixel : image.pixels)
        for (float& x : pixel) x = range > 0 ? std::max(0.f, (x - least) / range) : float(x > 0);
    return image;
}

}  // namespace penumbra

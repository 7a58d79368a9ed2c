// radiosity/map.h  3  illumination maps, and their images
#pragma once
#include "app/threads.h"
#include "film/image.h"
#include "film/loop.h"
#include "path/pathtracer.h"
#include "radiosity/mesh.h"

namespace penumbra {

// Irradiance E (W / m^2; lux, if radiance is in nit) on both sides of every vertex: number 2 v on
// the side of the shape's own normal, 2 v + 1 on its back.  Linear between the vertices of a
// triangle.
using IlluminationMap = std::vector<rgb>;

inline size_t number_of_sides(const Mesh& mesh) { return 2 * mesh.vertices(); }

inline rgb irradiance(const Mesh& mesh, const IlluminationMap& map, const Hit& hit, bool back) {
    const auto [vertex, weight] = between(mesh, hit);
    rgb E;
    for (size_t k = 0; k < 3; ++k) E += map[2 * vertex[k] + back] * weight[k];
    return E;
}

// Albedo of a face, and the radiance that a side of it emits.
inline rgb albedo(const Scene& s, const Face& f) {
    return s.materials[s.material_of[f.shape]].diffuse();
}
inline rgb greatest_albedo(const Scene& s, const Mesh& mesh) {  // per channel
    rgb most;
    for (const Face& f : mesh.faces)
        for (auto c : axis) most.*c = std::max(most.*c, albedo(s, f).*c);
    return most;
}
inline rgb emission(const Scene& s, const Face& f, bool back) {
    return s.light_of[f.shape] == no_light
               ? rgb{}
               : emitted(s.materials[s.material_of[f.shape]], back ? real(-1) : real(1));
}

// ---- Images -------------------------------------------------------------------------------------

struct Seen {
    rgb E, L;  // irradiance, and radiance Le + albedo E / pi towards the eye
};

// Where a ray meets nothing, both are black.
inline Seen seen_along(const Scene& scene, const Mesh& mesh, const IlluminationMap& map,
                       const Ray& ray) {
    const auto x = meet(scene, ray);
    if (!x || x->cos_o == 0) return {};
    const rgb E = irradiance(mesh, map, x->hit, x->cos_o < 0);
    return {E, emitted(*x->material, x->cos_o) + x->material->diffuse() * E / pi};
}

// The mean over K x K rays per pixel, on a regular grid: no random numbers.
template <class Value>
rgb pixel_of(const Scene& scene, int x, int y, int K, Value value) {
    rgb sum;
    for (int j = 0; j < K; ++j)
        for (int i = 0; i < K; ++i) {
            const real u = (real(i) + real(0.5)) / real(K), v = (real(j) + real(0.5)) / real(K);
            sum += value(camera_ray(scene.camera, scene.size, real(x) + u, real(y) + v));
        }
    return sum / real(K * K);
}

template <class Value>
Image image_of_rays(const Scene& scene, int K, unsigned threads, Value value) {
    Image image(scene.size.width, scene.size.height);
    auto row = [&](int y, unsigned) {
        for (int x = 0; x < image.width; ++x) {
            const rgb c = pixel_of(scene, x, y, K, value);
            image.at(x, y) = {float(c.x), float(c.y), float(c.z)};
        }
    };
    by_workers(size_t(image.height), threads, row, [](double) {});
    return image;
}

inline Image radiance_image(const Scene& scene, const Mesh& mesh, const IlluminationMap& map, int K,
                            unsigned threads) {
    return image_of_rays(scene, K, threads,
                         [&](const Ray& ray) { return seen_along(scene, mesh, map, ray).L; });
}
inline Image irradiance_image(const Scene& scene, const Mesh& mesh, const IlluminationMap& map,
                              int K, unsigned threads) {
    return image_of_rays(scene, K, threads,
                         [&](const Ray& ray) { return seen_along(scene, mesh, map, ray).E; });
}

// Mean over an image, per channel; NaN stays NaN.
inline std::array<double, 3> mean_of_pixels(const Image& image) {
    std::array<double, 3> sum{};
    for (const auto& pixel : image.pixels)
        for (size_t c = 0; c < 3; ++c) sum[c] += double(pixel[c]);
    for (double& s : sum) s /= double(image.pixels.size());
    return sum;
}

}  // namespace penumbra

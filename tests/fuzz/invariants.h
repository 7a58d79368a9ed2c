// fuzz/invariants.h  invariants of every scene, mesh and image that a program accepts
#pragma once
#include "fuzz/input.h"
#include "text/image_file.h"
#include "world/nearest.h"
#include "world/scene.h"

namespace penumbra::fuzz {

inline void check_shape(const Shape& s) {
    demand(is_finite(s.a) && is_finite(s.b) && is_finite(s.c) && std::isfinite(s.r),
           "a shape that is not finite");
    demand(s.r > 0 || has_area(s), "a triangle without area");
}

inline void check_scene(const NamedScene& s) {
    const size_t n = s.shapes.size();
    demand(n > 0, "an empty scene");
    for (size_t other :
         {s.material_of.size(), s.light_of.size(), s.line_of.size(), s.constants.size()})
        demand(other == n, "lists of other lengths than shapes");
    demand(s.line_of_light.size() == s.lights.size(), "lights without lines");
    demand(s.names.size() == s.materials.size(), "materials without names");
    demand(is_finite(s.camera.eye) && is_finite(s.camera.right) && is_finite(s.camera.up) &&
               is_finite(s.camera.forward) && s.camera.tan_half > 0,
           "a camera that sees nothing");
    for (size_t i = 0; i < n; ++i) {
        check_shape(s.shapes[i]);
        demand(s.material_of[i] < s.materials.size(), "a shape of no material");
        const int32_t k = s.light_of[i];
        demand(k == no_light || size_t(k) < s.lights.size(), "a shape that is no light");
    }
}

// The BVH gives the answers of a loop over all shapes, bit for bit.
inline void check_ray(const Scene& s, const Ray& ray) {
    const auto found = s.bvh.closest(ray), expected = nearest(s.shapes, ray);
    demand(found.has_value() == expected.has_value(), "the tree misses, or hits nothing");
    demand(same(found, expected), "the tree finds another hit");
    demand(s.bvh.occluded(ray) == found.has_value(), "the tree finds another shadow");
}

inline void check_image(const Image& image, Size size, bool positive) {
    demand(image.width == size.width && image.height == size.height, "an image of another size");
    demand(!first_non_finite(image), "a pixel that is no number");
    for (const auto& pixel : image.pixels)
        for (float channel : pixel) demand(!positive || channel >= 0, "negative light");
}

}  // namespace penumbra::fuzz

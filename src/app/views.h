// app/views.h  1  what a picture may show of a scene (--view): one table of rows
#pragma once
#include "film/image.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "text/option.h"

namespace penumbra {

// A PNG shows values from black, which is 0 or the least, to white.
enum class Shades { as_they_are, from_zero, from_least };

// Diagonal of the box about all shapes.
inline real diagonal(const Scene& s) {
    Box box;
    for (const Shape& shape : s.shapes) box.add(bounds(shape));
    return length(box.hi - box.lo);
}

// What a sample of a view depends on.
struct Sight {
    const Scene& scene;
    const Start& at;
    std::optional<Vertex> x;  // what the ray meets
    real far;                 // a quarter of the scene's diagonal
};
inline rgb alike(real x) { return {x, x, x}; }
inline real far_of(const Scene& scene) { return diagonal(scene) / 4; }

struct View {
    Text help;
    rgb (*of)(const Sight&);  // its value; null: radiance
    Shades shades = Shades::as_they_are;
    bool scatters = false;  // needs the numbers of one direction

    bool operator==(const View&) const = default;
};

// Ambient occlusion (Landis 2002): 1 where nothing is met, or where a ray from there, in a
// direction of density cos / pi, meets nothing within `far`.
inline rgb occlusion(const Sight& s) {
    if (!s.x) return alike(1);
    const vec2 u = s.at.sampler.get2(dimension(0, Dimension::wi_x));
    Ray ray = spawn(s.x->at, s.x->local.to_world(sample_cosine_hemisphere(u)));
    ray.tmax = s.far;
    return s.scene.bvh.occluded(ray) ? rgb{} : alike(1);
}
inline rgb work(const Sight& s) {
    const Tree::Work done = s.scene.bvh.work(s.at.ray);
    return {real(done.nodes), real(done.shapes), 0};
}

inline const Alternatives<View> views = {
    {"radiance", {"radiance", nullptr}},
    {"normal",
     {"(normal + 1) / 2", [](auto& s) { return s.x ? (s.x->at.n + alike(1)) / 2 : rgb{}; }}},
    {"depth",
     {"distance", [](auto& s) { return s.x ? alike(s.x->hit.t) : rgb{}; }, Shades::from_least}},
    {"albedo", {"albedo", [](auto& s) { return s.x ? s.x->material->albedo() : rgb{}; }}},
    {"bvh", {"the BVH nodes (red) and shapes (green) that a ray visits", work, Shades::from_zero}},
    {"occlusion",
     {"ambient occlusion within a quarter of the scene's diagonal", occlusion, Shades::as_they_are,
      true}}};

inline const std::string view_help = [] {
    std::string help = "the image shows ";
    for (const auto& [name, view] : views)
        help.append(name == views.back().first ? "or " : "").append(view.help).append("; ");
    return help.substr(0, help.size() - 2);
}();

// The end of a file's name: "-depth"; "" for radiance.
inline std::string suffix_of(const View& view) {
    return view.of ? std::string("-").append(word_of(views, view)) : "";
}

// A view as a PNG shows it: depth from black (nearest) to white (farthest), work relative to that
// of the most expensive pixel.  The other views stay as they are.  The nearest percent of depths is
// black: some of these pixels are partly background, which has depth 0.
inline Image scaled(Image image, Shades shades) {
    std::vector<float> values;
    for (const auto& pixel : image.pixels)
        for (const float x : pixel)
            if (x > 0) values.push_back(x);
    if (shades == Shades::as_they_are || values.empty()) return image;
    const auto nearest = values.begin() + std::ptrdiff_t(values.size() / 100);
    std::nth_element(values.begin(), nearest, values.end());
    const float least = shades == Shades::from_least ? *nearest : 0;
    const float range = *std::max_element(nearest, values.end()) - least;
    for (auto& pixel : image.pixels)
        for (float& x : pixel) x = range > 0 ? std::max(0.f, (x - least) / range) : float(x > 0);
    return image;
}

}  // namespace penumbra

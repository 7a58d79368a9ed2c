// radiosity/gather.h  4  final gathering: paths that end on illumination maps
//
// The maps approximate the reflected radiance of a diffuse surface y: R_map(y) = rho E(y) / pi.
// After one bounce, a path ends on the map (Reichert 1992).  Its bias is the error of the maps,
// averaged over the surfaces that one bounce reaches.
#pragma once
#include "app/threads.h"
#include "path/start.h"
#include "radiosity/map.h"

namespace penumbra {

// R_map on both sides of every vertex, numbered as an illumination map.
struct KnownLight {
    Mesh mesh;
    std::vector<rgb> R;

    rgb at(const Vertex& x) const { return irradiance(mesh, R, x.hit, x.cos_o < 0); }
};

inline KnownLight known_light(const Scene& s, Mesh mesh, IlluminationMap map) {
    for (const Face& f : mesh.faces)
        for (size_t k = 2 * f.vertex; k < 2 * size_t(f.vertex + f.vertices()); ++k)
            map[k] *= albedo(s, f) / pi;
    return {std::move(mesh), std::move(map)};
}

// The function that renders a sample.  The scene's depth is 1: paths add emission and light samples
// as usual, and the radiance of the maps where they end.
inline SampleFunction final_gather(const Scene& scene, const Technique& t, const KnownLight& known,
                                   const SamplerSettings& settings) {
    return [=, &scene, &known, &settings](const PixelSample& s, Tally& tally) {
        const Start at = start(scene, settings, s);
        rgb R;
        const rgb L =
            Li(scene, t, at.ray, at.sampler, [&](const PathState& path, const VertexEvents& e) {
                if (interrupted) throw Interrupted();
                tally.rays += 1 + (e.direct.light != nullptr);
                if (path.k == 1 && e.met) R = path.beta * known.at(e.vertex);
            });
        return L + R;
    };
}

}  // namespace penumbra

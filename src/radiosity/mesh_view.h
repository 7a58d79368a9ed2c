// radiosity/mesh_view.h  4  the triangles of a mesh over what their map shows (--view mesh)
#pragma once
#include "app/threads.h"
#include "radiosity/map.h"

namespace penumbra {

// The part of a pixel that is edge, 0 to 1.  A point is on an edge if an element ends between it
// and the point a pixel to the right, or below.  Lines are a pixel wide in an image of any size.
inline real edges_in(const Scene& scene, const Mesh& mesh, int x, int y, int K) {
    using Element = std::array<uint32_t, 3>;  // its vertices
    auto element = [&](real px, real py) {
        const auto hit = scene.bvh.closest(camera_ray(scene.camera, scene.size, px, py));
        return hit ? between(mesh, *hit).vertex : Element{};
    };
    int edges = 0;
    for (int j = 0; j < K; ++j)
        for (int i = 0; i < K; ++i) {
            const real px = real(x) + (real(i) + real(0.5)) / real(K),
                       py = real(y) + (real(j) + real(0.5)) / real(K);
            const Element here = element(px, py);
            edges += element(px + 1, py) != here || element(px, py + 1) != here;
        }
    return real(edges) / real(K * K);
}

// A blue veil, visible on black, white and other colours.
inline rgb line_over(rgb L, real exposure) {
    return L * real(0.4) + rgb{real(0.05), real(0.2), real(0.6)} / exposure;
}

inline void draw_mesh(Image& image, const Scene& scene, const Mesh& mesh, int K, unsigned threads) {
    auto row = [&](int y, unsigned) {
        for (int x = 0; x < image.width; ++x) {
            auto& pixel = image.at(x, y);
            const rgb L{pixel[0], pixel[1], pixel[2]};
            const real edge = edges_in(scene, mesh, x, y, K);
            const rgb c = L * (1 - edge) + line_over(L, scene.exposure) * edge;
            pixel = {float(c.x), float(c.y), float(c.z)};
        }
    };
    by_workers(size_t(image.height), threads, row, [](double) {});
}

}  // namespace penumbra

// path/paths.h  single paths through a scene
#pragma once
#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "path/pathtracer.h"
#include "path/start.h"

namespace penumbra {

// Radiance of sample i of pixel (x, y).
template <class Visitor = NoVisitor>
rgb radiance(const Scene& scene, const Technique& t, const SamplerSettings& settings, int x, int y,
             uint64_t i, Visitor visit = {}) {
    const Start at = start(scene, settings, {x, y, i});
    return Li(scene, t, at.ray, at.sampler, visit);
}

// The number of rays of that path.
inline uint64_t rays_of(const Scene& scene, const Technique& t, const SamplerSettings& settings,
                        int x, int y, uint64_t i) {
    uint64_t rays = 0;
    radiance(scene, t, settings, x, y, i, [&](const PathState&, const VertexEvents& e) {
        rays += 1 + (e.direct.light != nullptr);
    });
    return rays;
}

// Computes f(i) for every i < n on all cores; returns the results in order.
template <class F>
auto side_by_side(int n, F f) {
    std::vector<decltype(f(0))> results(static_cast<size_t>(n));
    std::atomic<int> next = 0;
    std::vector<std::thread> workers;
    for (unsigned i = std::max(1u, std::thread::hardware_concurrency()); i > 0; --i)
        workers.emplace_back([&] {
            for (int k = next++; k < n; k = next++) results[static_cast<size_t>(k)] = f(k);
        });
    for (std::thread& worker : workers) worker.join();
    return results;
}

}  // namespace penumbra

using namespace penumbra;

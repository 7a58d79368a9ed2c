// film/lecture_test.cpp  the lecture alone: a scene as data, rendered without text, files and
// threads; `make freestanding` also builds it for a machine that has none
#ifndef FREESTANDING
#include <doctest/doctest.h>
#else
#include <cstdio>
#endif

#include "film/loop.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "world/prepare.h"

namespace {
using namespace penumbra;

// A sphere of albedo 1/2 about the eye, whose inside emits 1/2: 1 arrives from everywhere, also
// through a ball of glass.  A lamp would make the picture depend on every point that a ray hits.
Scene furnace(rgb lamp = {}) {
    Scene scene;
    scene.size = {16, 8}, scene.depth = 200;
    scene.camera = look_at({0, 0, 0}, {0, 0, -1}, 60);
    scene.materials = {{Rough({0.5, 0.5, 0.5}), {0.5, 0.5, 0.5}, true}, {Glass{1.5}}};
    add_sphere(scene, {0, 0, 0}, 2, 0);
    add_sphere(scene, {0.25, 0, -1}, 0.5, 1);
    add_light(scene, {{-0.5, 0.5, -1}, PointLight(), lamp});
    prepare(scene);
    return scene;
}

struct Rendered {
    Film film;
    Stop stop;
    Tally tally;
};
Rendered rendered(const Scene& scene) {
    const SamplerSettings settings = sampler_settings(SamplerKind::sobol, 0, scene.depth);
    const SampleFunction L = [&](const PixelSample& which, Tally& tally) {
        const Start at = start(scene, settings, which);
        return Li(scene, {}, at.ray, at.sampler, [&](const PathState&, const VertexEvents& e) {
            tally.rays += 1 + (e.direct.light != nullptr);
        });
    };
    Plan plan;
    plan.size = scene.size, plan.samples = 64;
    Film film = make_film(plan.size, plan.replications, plan.is_adaptive);
    Watch watch;
    watch.elapsed = [] { return 0.0; };
    Loop loop(film, plan, L, watch);
    const Stop stop = loop.run();
    return {film, stop, loop.tally()};
}

}  // namespace

#ifdef FREESTANDING
// All bits of the picture.
int main() {
    for (const Sum& sum : rendered(furnace({1, 1, 1})).film.sum)
        std::printf("%a %a %a\n", sum[0], sum[1], sum[2]);
}
#else
TEST_CASE("a machine without files and threads renders a furnace, and knows its error") {
    const auto [film, stop, tally] = rendered(furnace());
    CHECK(stop == Stop::samples);
    CHECK(tally.rays > 64 * film.pixels());
    const ImageError e = error_of(film);
    CHECK(e.d_rel() < 0.05);
    CHECK(std::abs(e.norm_of_truth() - 1) < 5 * e.d_rel() / std::sqrt(e.pixels));
    CHECK(doubt_of(film, e, {}) == Doubt::no);
}
#endif

// film/lecture_test.cpp  the lecture alone: a scene as data, rendered without text, files and
// threads
#include <doctest/doctest.h>

#include "film/loop.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "world/prepare.h"

namespace {
using namespace penumbra;

// A sphere of albedo 1/2 about the eye, whose inside emits 1/2: 1 arrives from everywhere.
Scene furnace() {
    Scene scene;
    scene.size = {16, 8}, scene.depth = 200;
    scene.camera = look_at({0, 0, 0}, {0, 0, -1}, 60);
    scene.materials = {{Rough({0.5, 0.5, 0.5}), {0.5, 0.5, 0.5}, true}};
    add_sphere(scene, {0, 0, 0}, 2, 0);
    prepare(scene);
    return scene;
}

}  // namespace

TEST_CASE("a machine without files and threads renders a furnace, and knows its error") {
    const Scene scene = furnace();
    const Pattern pattern = make_pattern(SamplerKind::sobol, 0, scene.depth);
    const Radiance L = [&](const PixelSample& which, Tally& tally) {
        const Start at = start(scene, pattern, which);
        return Li(scene, {}, at.ray, at.sampler, [&](const Segment&, const Step& e) {
            tally.rays += 1 + (e.direct.light != nullptr);
        });
    };
    Plan plan;
    plan.size = scene.size, plan.samples = 64;
    Film film = make_film(plan.size, plan.replications, plan.is_adaptive);
    Watch watch;
    watch.elapsed = [] { return 0.0; };
    Loop loop(film, plan, L, watch);
    CHECK(loop.run() == Stop::samples);
    CHECK(loop.tally().rays > 64 * film.pixels());
    const ImageError e = error_of(film);
    CHECK(e.d_rel() < 0.05);
    CHECK(std::abs(e.norm_of_truth() - 1) < 5 * e.d_rel() / std::sqrt(e.pixels));
    CHECK(doubt_of(film, e, {}) == Doubt::no);
}

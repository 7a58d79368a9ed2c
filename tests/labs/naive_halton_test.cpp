// labs/naive_halton_test.cpp  the naive loop agrees with paths at one bounce, and errs at more
#include "labs/naive_halton.h"

#include "oracle/expect.h"
#include "path/paths.h"
#include "text/scene_file.h"

namespace {

// A diffuse room with one lamp: at one bounce no dimension serves two choices.
Scene room(int depth) {
    Scene s = parse_scene(R"(
camera 0 1 3  0 0.3 0  50
size 8 6
diffuse floor 0.5 0.4 0.3
diffuse wall 0.8 0.8 0.8
light lamp 3 4 5
quad -2 0 -2  0 0 4  4 0 0  floor
quad -2 0 -2  4 0 0  0 2 0  wall
quad -1.5 1.9 -1.5  3 0 0  0 0 3  lamp
)",
                          "room")
                  .scene;
    s.depth = depth;
    return s;
}

double naive_sample(const Scene& s, const Technique& t, oracle::Random& random) {
    const vec2 u{real(random()), real(random())};
    const real x = real(random()) * 8, y = real(random()) * 6;
    return double(mean_of(naive_halton::radiance(s, t, camera_ray(s.camera, s.size, x, y), u)));
}

double path_sample(const Scene& s, const Technique& t, oracle::Random& random) {
    static const SamplerSettings settings{SamplerKind::independent, 7};
    static uint64_t i = 0;
    const real x = real(random()) * 8, y = real(random()) * 6;
    const Sampler sampler(settings, 0, ++i);
    return double(mean_of(Li(s, t, camera_ray(s.camera, s.size, x, y), sampler)));
}

}  // namespace

TEST_CASE("one bounce by independent points is what paths see") {
    const Scene s = room(1);
    oracle::Random random(seed_here());
    for (Direction direction : {Direction::uniform, Direction::bsdf})
        for (LightMode light : {LightMode::none, LightMode::nee}) {
            const Technique t{direction, light, 0};
            EXPECT(oracle::expect_equal([&] { return naive_sample(s, t, random); },
                                        [&] { return path_sample(s, t, random); }, 1200000),
                   0.03);
        }
}

TEST_CASE("the same point at every bounce: another limit") {
    const Scene s = room(3);
    oracle::Random random(seed_here());
    const Technique t{Direction::uniform, LightMode::none, 0};
    CHECK_FALSE(oracle::expect_equal([&] { return naive_sample(s, t, random); },
                                     [&] { return path_sample(s, t, random); }, 400000)
                    .pass);
}

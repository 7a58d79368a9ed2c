// labs/textbook_test.cpp  the textbook's tracer and ours agree
#include "labs/textbook.h"

#include "oracle/expect.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "world/scene_file.h"

namespace {

// A ray through a random point of the image.
Ray random_ray(const Scene& scene, oracle::Random& random) {
    const real x = real(random()) * real(scene.size.width),
               y = real(random()) * real(scene.size.height);
    return camera_ray(scene.camera, scene.size, x, y);
}

}  // namespace

TEST_CASE("the textbook's tracer has the mean of ours, and takes as many rays") {
    const Scene scene = read_scene("scenes/cornell36.scene").scene;
    const Technique nee{Direction::bsdf, LightMode::nee, 0};
    const Pattern pattern{SamplerKind::independent, seed_here()};
    textbook::Room room = textbook::room_of(scene);
    oracle::Random random(seed_here() + 1);
    uint64_t rays = 0, sample = 0;
    auto theirs = [&] {
        const Ray ray = random_ray(scene, random);
        Rng bits{hash(seed_here(), ++sample)};
        return double(mean_of(textbook::radiance(room, ray.o, ray.d, scene.depth, bits)));
    };
    auto ours = [&] {
        auto count = [&](const Segment&, const Step& e) {
            rays += 1 + (e.direct.light != nullptr);
        };
        const Sampler sampler(pattern, 0, ++sample);
        return double(mean_of(Li(scene, nee, random_ray(scene, random), sampler, count)));
    };
    EXPECT(oracle::expect_equal(theirs, ours, 200000), 0.03);
    CHECK(double(room.rays) / double(rays) == doctest::Approx(1).epsilon(0.03));
}

TEST_CASE("the textbook's tracer sees the light as ours does, from its front alone") {
    Scene scene = read_scene("scenes/cornell36b.scene").scene;
    scene.depth = 0;
    textbook::Room room = textbook::room_of(scene);
    oracle::Random random(seed_here());
    const Light& lamp = scene.lights.at(0);
    const Pattern pattern{SamplerKind::independent};
    Rng unused;
    int lit = 0, dark = 0, differ = 0;
    for (int i = 0; i < 2000; ++i) {
        const vec3 eye = {real(100 + 300 * random()), i % 2 ? real(554.5) : real(400), 100};
        const vec3 d = unit(lamp.p + real(random()) * lamp.u + real(random()) * lamp.v - eye);
        const rgb L = Li(scene, {}, {eye, d}, Sampler(pattern, 0, 0));
        differ += !(textbook::radiance(room, eye, d, 0, unused) == L);
        ++(max_of(L) > 0 ? lit : dark);
    }
    CHECK(lit == 1000);
    CHECK(dark == 1000);
    CHECK(differ == 0);
}

TEST_CASE("an image of the textbook's tracer is a mean of samples in every pixel") {
    Scene scene = read_scene("scenes/cornell36.scene").scene;
    scene.size = {8, 4};
    textbook::Room room = textbook::room_of(scene);
    Image one(8, 4), again(8, 4), other(8, 4);
    for (int y = 0; y < 4; ++y) {
        textbook::render_row(room, scene, 1, 2, y, one);
        textbook::render_row(room, scene, 1, 2, y, again);
        textbook::render_row(room, scene, 2, 2, y, other);
    }
    CHECK_FALSE(first_non_finite(one));
    CHECK(one.pixels == again.pixels);
    CHECK(one.pixels != other.pixels);
}

TEST_CASE("the textbook's tracer refuses what it does not know") {
    CHECK_THROWS_AS(textbook::room_of(read_scene("scenes/penumbra.scene").scene), UserError);
    CHECK_THROWS_AS(textbook::room_of(read_scene("scenes/materials.scene").scene), UserError);
}

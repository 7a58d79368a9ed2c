// app/views_test.cpp  views other than radiance, and their exposure
#include "app/views.h"

#include "base/cases.h"
#include "base/moments.h"
#include "oracle/expect.h"
#include "text/scene_file.h"

namespace {

Scene scene_of(const std::string& text) { return parse_scene(text, "test").scene; }

View named(Text name) { return value_of(views, "view", name); }

rgb seen(const Scene& scene, Text view, const Start& at) {
    return named(view).of({scene, at, meet(scene, at.ray), far_of(scene)});
}
rgb seen(const Scene& scene, Text view, const Ray& ray) {
    const SamplerSettings settings;
    return seen(scene, view, {Sampler(settings, 0, 0), {}, ray});
}

}  // namespace

TEST_CASE("views show normal, distance, albedo and work; glass is as white as it is clear") {
    const Scene scene =
        scene_of("camera 0 0 5  0 0 0  40\nphong p .1 .2 .3  .5 .25 .125  9\nsphere 0 0 0  1  p\n");
    const Ray hit{{0, 0, 5}, {0, 0, -1}}, miss{{0, 0, 5}, {0, 0, 1}};
    CHECK(seen(scene, "normal", hit) == rgb{0.5, 0.5, 1});
    CHECK(seen(scene, "depth", hit) == rgb{4, 4, 4});
    CHECK(max_abs(seen(scene, "albedo", hit) - rgb{real(0.6), real(0.45), real(0.425)}) < 2 * ulp);
    CHECK(seen(scene, "bvh", hit) == rgb{1, 1, 0});
    CHECK(seen(scene, "bvh", miss) == rgb{1, 0, 0});
    for (Text v : {"normal", "depth", "albedo"}) CHECK(seen(scene, v, miss) == rgb{0, 0, 0});
    CHECK(seen(scene, "occlusion", miss) == rgb{1, 1, 1});
    const Scene glass = scene_of("camera 0 0 5  0 0 0  40\nglass g 1.5\nsphere 0 0 0  1  g\n");
    CHECK(seen(glass, "albedo", hit) == rgb{1, 1, 1});
}

// From inside a sphere of radius r, a direction of cosine c meets it after 2 r c.  The box of the
// sphere has a diagonal of 2 sqrt(3) r.  So it is open where c > sqrt(3) / 4, with probability
// 13/16.
TEST_CASE("13/16 of the directions from inside a sphere are open") {
    const Scene scene =
        scene_of("camera 0 0 0  0 0 -1  40\ndiffuse d .5 .5 .5\nsphere 0 0 0  1  d\n");
    const SamplerSettings settings = sampler_settings(SamplerKind::independent, seed_here(), 1);
    Moments open;
    for (uint64_t i = 0; i < 40000; ++i)
        open.add(double(seen(scene, "occlusion", start(scene, settings, {0, 0, i})).x));
    EXPECT(oracle::expect_mean(13.0 / 16, estimate(open)), 0.02);
}

TEST_CASE("a PNG shows depth from the nearest to the farthest, and work relative to the most") {
    Image image(3, 1);
    image.pixels = {{0, 0, 0}, {4, 4, 4}, {8, 8, 8}};
    auto shown = [&](Text view) {
        std::string words;
        for (const auto& pixel : scaled(image, named(view).shades).pixels)
            words += said(pixel[0]) + " ";
        return words;
    };
    CHECK(shown("depth") == "0 0 1 ");
    CHECK(shown("bvh") == "0 0.5 1 ");
    CHECK(shown("normal") == "0 4 8 ");
    image.pixels[1] = {2, 2, 2};
    image.pixels.resize(300, {3, 3, 3});
    image.width = 300;
    // The one at 2 is less than a percent.
    CHECK(scaled(image, Shades::from_least).pixels[3][0] == 0);
    image.pixels.assign(300, {3, 3, 3});
    CHECK(scaled(image, Shades::from_least).pixels[0][0] == 1);
    image.pixels.assign(300, {0, 0, 0});
    CHECK(scaled(image, Shades::from_least).pixels[0][0] == 0);
    CHECK(suffix_of(named("radiance")) + suffix_of(named("bvh")) == "-bvh");
}

// app/views_test.cpp  views other than radiance, and their exposure
#include "app/views.h"

#include "base/cases.h"
#include "base/moments.h"
#include "oracle/expect.h"
#include "text/scene_file.h"

namespace {

Scene scene_of(const std::string& text) { return parse_scene(text, "test").scene; }

rgb seen(const Scene& scene, View view, const Ray& ray) {
    const Pattern pattern;
    return view_along(scene, view, {Sampler(pattern, 0, 0), {}, ray}, far_of(scene));
}

}  // namespace

TEST_CASE("views show normal, distance, albedo and work; glass is as white as it is clear") {
    const Scene scene =
        scene_of("camera 0 0 5  0 0 0  40\nphong p .1 .2 .3  .5 .25 .125  9\nsphere 0 0 0  1  p\n");
    const Ray hit{{0, 0, 5}, {0, 0, -1}}, miss{{0, 0, 5}, {0, 0, 1}};
    CHECK(seen(scene, View::normal, hit) == rgb{0.5, 0.5, 1});
    CHECK(seen(scene, View::depth, hit) == rgb{4, 4, 4});
    CHECK(max_abs(seen(scene, View::albedo, hit) - rgb{real(0.6), real(0.45), real(0.425)}) <
          2 * ulp);
    CHECK(seen(scene, View::bvh, hit) == rgb{1, 1, 0});
    CHECK(seen(scene, View::bvh, miss) == rgb{1, 0, 0});
    for (View v : {View::normal, View::depth, View::albedo})
        CHECK(seen(scene, v, miss) == rgb{0, 0, 0});
    CHECK(seen(scene, View::occlusion, miss) == rgb{1, 1, 1});
    const Scene glass = scene_of("camera 0 0 5  0 0 0  40\nglass g 1.5\nsphere 0 0 0  1  g\n");
    CHECK(seen(glass, View::albedo, hit) == rgb{1, 1, 1});
}

// From inside a sphere of radius r, a direction of cosine c meets it after 2 r c.  The box of the
// sphere has a diagonal of 2 sqrt(3) r.  So it is open where c > sqrt(3) / 4, with probability
// 13/16.
TEST_CASE("13/16 of the directions from inside a sphere are open") {
    const Scene scene =
        scene_of("camera 0 0 0  0 0 -1  40\ndiffuse d .5 .5 .5\nsphere 0 0 0  1  d\n");
    const Pattern pattern = make_pattern(SamplerKind::independent, seed_here(), 1);
    Moments open;
    for (uint64_t i = 0; i < 40000; ++i)
        open.add(double(
            view_along(scene, View::occlusion, start(scene, pattern, {0, 0, i}), far_of(scene)).x));
    EXPECT(oracle::expect_mean(13.0 / 16, estimate(open)), 0.02);
}

TEST_CASE("a PNG shows depth from the nearest to the farthest, and work relative to the most") {
    Image image(3, 1);
    image.pixels = {{0, 0, 0}, {4, 4, 4}, {8, 8, 8}};
    auto shown = [&](View view) {
        std::string words;
        for (const auto& pixel : scaled(image, view).pixels) words += said(pixel[0]) + " ";
        return words;
    };
    CHECK(shown(View::depth) == "0 0 1 ");
    CHECK(shown(View::bvh) == "0 0.5 1 ");
    CHECK(shown(View::normal) == "0 4 8 ");
    image.pixels[1] = {2, 2, 2};
    image.pixels.resize(300, {3, 3, 3});
    image.width = 300;
    CHECK(scaled(image, View::depth).pixels[3][0] == 0);  // the one at 2 is less than a percent
    image.pixels.assign(300, {3, 3, 3});
    CHECK(scaled(image, View::depth).pixels[0][0] == 1);
    image.pixels.assign(300, {0, 0, 0});
    CHECK(scaled(image, View::depth).pixels[0][0] == 0);
    CHECK(suffix_of(View::radiance) + suffix_of(View::bvh) == "-bvh");
}

// app/views_test.cpp  views other than radiance, and their exposure
#include "app/views.h"

#include <doctest/doctest.h>

#include "world/scene_file.h"

namespace {

Scene scene_of(const std::string& text) { return parse_scene(text, "test").scene; }

}  // namespace

TEST_CASE("views show normal, distance, albedo and work") {
    const Scene scene = scene_of(R"(
camera 0 0 5  0 0 0  40
phong gloss 0.1 0.2 0.3  0.5 0.25 0.125  9
sphere 0 0 0  1  gloss
)");
    const Ray hit{{0, 0, 5}, {0, 0, -1}}, miss{{0, 0, 5}, {0, 0, 1}};
    CHECK(view_along(scene, View::normal, hit) == rgb{0.5, 0.5, 1});
    CHECK(view_along(scene, View::depth, hit) == rgb{4, 4, 4});
    CHECK(max_abs(view_along(scene, View::albedo, hit) - rgb{real(0.6), real(0.45), real(0.425)}) <
          2 * ulp);
    CHECK(view_along(scene, View::bvh, hit) == rgb{1, 1, 0});
    CHECK(view_along(scene, View::bvh, miss) == rgb{1, 0, 0});
    for (View v : {View::normal, View::depth, View::albedo})
        CHECK(view_along(scene, v, miss) == rgb{0, 0, 0});
}

TEST_CASE("glass is as white as it is clear; a view has an exposure of its own") {
    const Scene scene = scene_of(R"(
exposure 3
camera 0 0 5  0 0 0  40
glass clear 1.5
sphere 0 0 0  1  clear
)");
    CHECK(view_along(scene, View::albedo, {{0, 0, 5}, {0, 0, -1}}) == rgb{1, 1, 1});
    CHECK(default_exposure(scene, View::radiance) == 3);
    CHECK(default_exposure(scene, View::normal) == 1);
    CHECK(default_exposure(scene, View::albedo) == 1);
    CHECK(default_exposure(scene, View::bvh) == real(1) / 64);
    // The box of the sphere is padded by 16 ulp of its size.
    CHECK(std::abs(default_exposure(scene, View::depth) * 2 * std::sqrt(real(3)) - 1) < 64 * ulp);
}

// world/scene_test.cpp  camera rays, the effects of statements, and the choice of lights
#include "world/prepare.h"

#include <doctest/doctest.h>

namespace {
using namespace penumbra;

constexpr uint32_t grey = 0, lamp = 1, panel = 2;

// Three materials: grey; lamp, which emits (1, 2, 3); panel, which emits on both sides.
Scene empty_scene() {
    Scene s;
    s.materials.resize(3);
    s.materials[lamp].Le = {1, 2, 3};
    s.materials[panel].Le = {1, 1, 1};
    s.materials[panel].twosided = true;
    return s;
}

}  // namespace

TEST_CASE("camera: the top of a 90 degree view is at 45 degrees, +x is right, pixels are square") {
    const Camera c = look_at({1, 2, 3}, {1, 2, -7}, 90);
    const real h = 1 / std::sqrt(real(2));
    for (const Size size : {Size{60, 40}, Size{40, 60}, Size{50, 50}}) {
        const real w = real(size.width), aspect = w / real(size.height);
        const struct {
            real x, y;
            vec3 d;
        } rows[] = {{w / 2, 0, {0, h, -h}},
                    {w / 2, real(size.height), {0, -h, -h}},
                    {w / 2, real(size.height) / 2, {0, 0, -1}},
                    {w, real(size.height) / 2, unit({aspect, 0, -1})},
                    {0, 0, unit({-aspect, 1, -1})}};
        for (const auto& row : rows) {
            const Ray ray = camera_ray(c, size, row.x, row.y);
            CHECK(ray.o == vec3{1, 2, 3});
            CHECK(ray.tmax == infinity);
            CHECK(length(ray.d - row.d) < 16 * ulp);
        }
    }
}

TEST_CASE("camera: it looks at its target, however near or far that is") {
    constexpr int low = std::numeric_limits<real>::min_exponent,
                  high = std::numeric_limits<real>::max_exponent;
    const Camera c = look_at({}, {1, -2, 3}, 40);
    for (int e : {low, low / 2, low * 9 / 20, high / 2, high - 3}) {
        const real k = std::ldexp(real(1), e);
        const Camera scaled = look_at({}, {k, -2 * k, 3 * k}, 40);
        CHECK(scaled.forward == c.forward);
        CHECK(scaled.right == c.right);
        CHECK(scaled.up == c.up);
    }
}

TEST_CASE("an emitting shape is a light: its geometry, its error, and which shapes it is") {
    Scene s = empty_scene();
    add_sphere(s, {1, 2, 3}, 4, lamp);
    add_triangle(s, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, grey);
    add_quad(s, {5, 0, 0}, {2, 0, 0}, {0, 3, 0}, panel);
    add_triangle(s, {0, 0, 7}, {1, 0, 7}, {0, 1, 7}, lamp);
    add_light(s, {{1, 1, 1}, PointLight(), {2, 2, 2}});
    add_light(s, {{1, 1, 1}, PointLight(), {0, 0, 0}});  // dark: not a light
    add_light(s, {{1, 1, 1}, PointLight(), {1, real(NAN), 1}});
    CHECK(s.light_of == std::vector<int32_t>{0, no_light, 1, 1, 2});
    CHECK(s.material_of == std::vector<uint32_t>{lamp, grey, panel, panel, lamp});
    REQUIRE(s.lights.size() == 5);
    const Light &ball = s.lights[0], &quad = s.lights[1], &point = s.lights[3];
    CHECK((ball.as<SphereLight>() && ball.radius == 4));
    CHECK((ball.L == rgb{1, 2, 3} && !ball.twosided));
    CHECK((quad.as<QuadLight>() && quad.twosided));
    CHECK((quad.n == vec3{0, 0, 1} && quad.pdf_area == real(1) / 6));  // faces +z like its shapes
    for (size_t i : {2, 3}) CHECK(area_vector(s.shapes[i]) == vec3{0, 0, 6});
    // The two triangles share a diagonal and nothing else.
    CHECK((s.shapes[2].a == vec3{5, 0, 0} && s.shapes[2].c == vec3{7, 3, 0}));
    CHECK((s.shapes[3].a == vec3{5, 0, 0} && s.shapes[3].b == vec3{7, 3, 0}));
    CHECK((s.lights[2].n == vec3{0, 0, 1} && s.lights[2].pdf_area == 2));
    CHECK((point.as<PointLight>() && point.L == rgb{2, 2, 2}));
    CHECK(std::isnan(max_of(s.lights[4].L)));  // nor is what is no number dark
    for (size_t i : {0, 2, 3, 4})
        CHECK(s.lights[size_t(s.light_of[i])].error >= rounding_error(s.shapes[i]));
}

TEST_CASE("the surface of a scene's hit is that of the shape hit, after a second prepare, too") {
    Scene s = empty_scene();
    add_triangle(s, {-1, -1, 0}, {0, -1, 0}, {-1, 0, real(0.5)}, grey);
    prepare(s);
    s.shapes.clear(), s.material_of.clear(), s.light_of.clear();
    add_sphere(s, {real(0.5), real(0.5), -3}, real(0.5), lamp);
    add_quad(s, {-1, 0, -1000}, {1, 0, 0}, {0, 1, 2}, panel);
    add_triangle(s, {0, -1, -7}, {1, -1, -8}, {1, 0, -9}, grey);
    prepare(s);
    int hits[4] = {};
    for (int i = 0; i < 400; ++i) {
        const real x = real(i % 20) / 10 - real(0.95), y = real(i / 20) / 10 - real(0.97);
        const Ray ray{{x, y, 5}, {0, 0, -1}};
        const auto hit = s.bvh.closest(ray);
        if (!hit) continue;
        const Shape& shape = s.shapes.at(hit->id);
        const Surface of_shape = surface(shape, ray, *hit), of_scene = s.surface(ray, *hit);
        CHECK(of_scene.p == of_shape.p);
        CHECK(of_scene.n == of_shape.n);
        CHECK(of_scene.error == of_shape.error);
        CHECK(of_scene.error == rounding_error(shape));
        if (shape.r == 0) CHECK(of_scene.n == unit(area_vector(shape)));
        ++hits[hit->id];
    }
    for (int n : hits) CHECK(n > 10);
}

TEST_CASE("what has no area is dropped and counted") {
    Scene s = empty_scene();
    add_triangle(s, {0, 0, 0}, {1, 1, 1}, {2, 2, 2}, lamp);
    CHECK(s.dropped == 1);
    add_quad(s, {0, 0, 0}, {1, 1, 1}, {2, 2, 2}, lamp);
    CHECK(s.dropped == 3);
    CHECK(s.shapes.empty());
    CHECK(s.lights.empty());
    add_triangle(s, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, grey);
    CHECK(s.dropped == 3);
}

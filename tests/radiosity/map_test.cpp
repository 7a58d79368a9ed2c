// radiosity/map_test.cpp  what a map says of a point, and what a camera sees of it
#include "radiosity/map.h"

#include "base/rng.h"
#include "oracle/expect.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

// A reflecting panel in the plane z = 0, seen from both sides, whose front emits; a triangle above.
Scene panel(bool twosided) {
    Scene s;
    add_quad(s, {0, 0, 0}, {2, 0, 0}, {0, 2, 0},
             add(s, diffuse({real(0.2), real(0.5), 1}, {3, 4, 0}, twosided)));
    add_triangle(s, {0, 3, 0}, {2, 3, 0}, {0, 5, 0}, add(s, diffuse(grey(0.25))));
    s.size = {16, 12};
    s.camera = look_at({1, 1, 4}, {1, 1, 0}, 50);
    prepare(s);
    return s;
}

double off(float a, real b) { return std::abs(double(a) - double(b)) / std::max(1e-9, double(b)); }

// Other numbers on every side of every vertex.
IlluminationMap random_map(const Mesh& mesh, Rng& rng) {
    IlluminationMap map(number_of_sides(mesh));
    for (rgb& E : map)
        for (auto a : axis) E.*a = real(rng.uniform());
    return map;
}

}  // namespace

TEST_CASE("every vertex has a front and a back; between vertices both are linear") {
    const Scene s = panel(false);
    const Mesh mesh = make_mesh(s, 0.8);
    IlluminationMap map(number_of_sides(mesh));
    REQUIRE(map.size() == 2 * mesh.vertices());
    auto front = [](vec3 p) { return rgb{p.x, 2 * p.y, 1}; };
    auto back = [](vec3 p) { return rgb{5 - p.y, p.x + p.y, 0}; };
    for (const Face& f : mesh.faces) {
        uint32_t v = f.vertex;
        for (uint32_t j = 0; j <= f.rows; ++j)
            for (uint32_t i = 0; i <= (f.quad ? f.columns : f.rows - j); ++i, ++v) {
                const vec3 p = point_at(f, real(i), real(j));
                map[2 * v] = front(p), map[2 * v + 1] = back(p);
            }
    }
    Rng rng{seed_here()};
    for (int k = 0; k < 1000; ++k) {
        const double v = rng.uniform(), w = (1 - v) * rng.uniform();
        const Hit hit{1, uint32_t(k % 3), real(v), real(w)};
        const vec3 p = point_of(s, hit);
        CHECK(max_abs(irradiance(mesh, map, hit, false) - front(p)) <= 200 * ulp);
        CHECK(max_abs(irradiance(mesh, map, hit, true) - back(p)) <= 200 * ulp);
    }
}

TEST_CASE("radiance is what is emitted and rho E / pi, of the side that is seen") {
    for (bool twosided : {false, true}) {
        CAPTURE(twosided);
        const Scene s = panel(twosided);
        const Mesh mesh = make_mesh(s, 0.8);
        Rng rng{seed_here()};
        const IlluminationMap map = random_map(mesh, rng);
        for (int k = 0; k < 400; ++k) {
            const vec3 to{real(2 * rng.uniform()), real(2 * rng.uniform()), 0};
            const vec3 eye{real(rng.uniform()), real(rng.uniform()), real(k % 2 ? -2 : 2)};
            const Ray ray{eye, unit(to - eye)};
            const auto hit = s.bvh.closest(ray);
            REQUIRE(hit);
            const bool back = k % 2;
            const rgb E = irradiance(mesh, map, *hit, back);
            const Seen seen = seen_along(s, mesh, map, ray);
            CHECK(seen.E == E);
            const rgb Le = !back || twosided ? rgb{3, 4, 0} : rgb{};
            const double Pi = std::numbers::pi;
            CHECK(double(seen.L.x) == approx(double(Le.x) + 0.2 * double(E.x) / Pi));
            CHECK(double(seen.L.y) == approx(double(Le.y) + 0.5 * double(E.y) / Pi));
            CHECK(double(seen.L.z) == approx(double(Le.z) + double(E.z) / Pi));
        }
        const Face &light = mesh.faces[0], &dark = mesh.faces[1];
        CHECK(emission(s, light, false) == rgb{3, 4, 0});
        CHECK(emission(s, light, true) == (twosided ? rgb{3, 4, 0} : rgb{}));
        CHECK(emission(s, dark, false) == rgb{});
        CHECK(albedo(s, light) == rgb{real(0.2), real(0.5), 1});
        CHECK(albedo(s, dark) == grey(0.25));
    }
}

TEST_CASE("what is emitted: both sides, quads and triangles, points; a channel at a time") {
    const double Pi = std::numbers::pi;
    for (bool twosided : {false, true}) {
        Scene s;
        const uint32_t l = add(s, diffuse({}, {1, 2, 0}, twosided));
        add_quad(s, {0, 0, 0}, {2, 0, 0}, {1, 3, 0}, l);
        add_triangle(s, {0, 0, 9}, {2, 0, 9}, {0, 3, 9}, l);
        add_point_light(s, {5, 5, 5}, {0, 1, 7});
        prepare(s);
        const rgb power = emitted_power(s);
        const double sides = twosided ? 2 : 1;
        CHECK(double(power.x) == approx(sides * Pi * 9));
        CHECK(double(power.y) == approx(sides * Pi * 18 + 4 * Pi));
        CHECK(double(power.z) == approx(28 * Pi));
        double sum = 0;
        for (const Light& light : s.lights) sum += ::power(light);
        CHECK(double(mean_of(power)) == approx(sum));
    }
}

TEST_CASE("a ray that meets nothing is black; so is an empty map but for what emits") {
    const Scene s = panel(false);
    const Mesh mesh = make_mesh(s, 0.8);
    const IlluminationMap dark(number_of_sides(mesh));
    Rng rng{seed_here()};
    const Seen missed = seen_along(s, mesh, random_map(mesh, rng), {{0, 0, 1}, {0, 0, 1}});
    CHECK(missed.E == rgb{});
    CHECK(missed.L == rgb{});
    const Seen lamp = seen_along(s, mesh, dark, {{1, 1, 4}, {0, 0, -1}});
    CHECK(lamp.E == rgb{});
    CHECK(lamp.L == rgb{3, 4, 0});
    CHECK(seen_along(s, mesh, dark, {{1, 1, -4}, {0, 0, 1}}).L == rgb{});
    Scene away = s;
    away.camera = look_at({1, 1, 4}, {1, 1, 9}, 50);
    const Image image = radiance_image(away, mesh, random_map(mesh, rng), 2, 1);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            CHECK(image.at(x, y)[0] == 0);
            CHECK(image.at(x, y)[2] == 0);
        }
}

TEST_CASE("a pixel is the mean of rays on a regular grid, whatever the threads") {
    const Scene s = panel(false);
    const Mesh mesh = make_mesh(s, 0.8);
    Rng rng{seed_here()};
    const IlluminationMap map = random_map(mesh, rng);
    const int K = 3;
    const Image L = radiance_image(s, mesh, map, K, 1), E = irradiance_image(s, mesh, map, K, 1);
    const Image again = radiance_image(s, mesh, map, K, 3);
    REQUIRE(L.width == 16);
    REQUIRE(L.height == 12);
    int bright = 0;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 16; ++x) {
            rgb l, e;
            for (int j = 0; j < K; ++j)
                for (int i = 0; i < K; ++i) {
                    const Seen seen =
                        seen_along(s, mesh, map,
                                   camera_ray(s.camera, s.size, x + real(2 * i + 1) / 6,
                                              y + real(2 * j + 1) / 6));
                    l += seen.L / 9, e += seen.E / 9;
                }
            CHECK(off(L.at(x, y)[0], l.x) <= (single ? 2e-5 : 2e-7));
            CHECK(off(L.at(x, y)[2], l.z) <= (single ? 2e-5 : 2e-7));
            CHECK(off(E.at(x, y)[1], e.y) <= (single ? 2e-5 : 2e-7));
            CHECK(again.at(x, y)[1] == L.at(x, y)[1]);
            bright += l.x > 0;
        }
    CHECK(bright > 50);
}

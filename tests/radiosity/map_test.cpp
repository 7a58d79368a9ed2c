// radiosity/map_test.cpp  the value of a map at a point, and its image in a camera
#include "radiosity/map.h"

#include "base/rng.h"
#include "oracle/expect.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

// A reflecting panel in z = 0, seen from both sides, that emits on its front; a triangle above.
Scene panel(bool twosided = false) {
    Scene s;
    add_quad(s, {0, 0, 0}, {2, 0, 0}, {0, 2, 0},
             add(s, diffuse({0.2, 0.5, 1}, {3, 4, 0}, twosided)));
    add_triangle(s, {0, 3, 0}, {2, 3, 0}, {0, 5, 0}, add(s, diffuse(grey(0.25))));
    s.size = {16, 12};
    s.camera = look_at({1, 1, 4}, {1, 1, 0}, 50);
    prepare(s);
    return s;
}

// Its mesh, and a map with different values on every side of every vertex.
struct Panel : Meshed {
    Rng rng{seed_here()};
    IlluminationMap map = IlluminationMap(number_of_sides(mesh));
    explicit Panel(bool twosided = false) : Meshed(panel(twosided), 0.8) {
        for (rgb& E : map)
            for (auto a : axis) E.*a = real(rng.uniform());
    }
    Seen seen(const Ray& ray) const { return seen_along(scene, mesh, map, ray); }
};

}  // namespace

TEST_CASE("every vertex has a front and a back; between vertices both are linear") {
    Panel p;
    REQUIRE(p.map.size() == 2 * p.mesh.vertices());
    auto front = [](vec3 x) { return rgb{x.x, 2 * x.y, 1}; };
    auto back = [](vec3 x) { return rgb{5 - x.y, x.x + x.y, 0}; };
    for (const Face& f : p.mesh.faces) {
        uint32_t v = f.vertex;
        for (vec3 x : grid_points(f)) p.map[2 * v] = front(x), p.map[2 * v++ + 1] = back(x);
    }
    for (int k = 0; k < 1000; ++k) {
        const double v = p.rng.uniform(), w = (1 - v) * p.rng.uniform();
        const Hit hit{1, uint32_t(k % 3), real(v), real(w)};
        const vec3 x = point_of(p.scene, hit);
        CHECK(max_abs(irradiance(p.mesh, p.map, hit, false) - front(x)) <= 200 * ulp);
        CHECK(max_abs(irradiance(p.mesh, p.map, hit, true) - back(x)) <= 200 * ulp);
    }
}

TEST_CASE("radiance is what is emitted and rho E / pi, of the side that is seen") {
    for (bool twosided : {false, true}) {
        CAPTURE(twosided);
        Panel p(twosided);
        auto number = [&] { return real(p.rng.uniform()); };
        for (int k = 0; k < 400; ++k) {
            const bool back = k % 2;
            const vec3 to{2 * number(), 2 * number(), 0},
                eye{number(), number(), real(back ? -2 : 2)};
            const Ray ray{eye, unit(to - eye)};
            const auto hit = p.scene.bvh.closest(ray);
            REQUIRE(hit);
            const rgb E = irradiance(p.mesh, p.map, *hit, back);
            const Seen seen = p.seen(ray);
            CHECK(seen.E == E);
            const rgb Le = !back || twosided ? rgb{3, 4, 0} : rgb{}, rho{0.2, 0.5, 1};
            for (auto a : axis)
                CHECK(double(seen.L.*a) == approx(double(Le.*a + rho.*a * E.*a / pi)));
        }
        const Face &light = p.mesh.faces[0], &dark = p.mesh.faces[1];
        CHECK(emission(p.scene, light, false) == rgb{3, 4, 0});
        CHECK(emission(p.scene, light, true) == (twosided ? rgb{3, 4, 0} : rgb{}));
        CHECK(emission(p.scene, dark, false) == rgb{});
        CHECK(albedo(p.scene, light) == rgb{0.2, 0.5, 1});
        CHECK(albedo(p.scene, dark) == grey(0.25));
    }
}

TEST_CASE("a ray that meets nothing is black; so is an empty map but for what emits") {
    Panel p, dark;
    dark.map = IlluminationMap(p.map.size());
    const struct {
        const Panel& panel;
        Ray ray;
        rgb L;
    } rows[] = {{p, {{0, 0, 1}, {0, 0, 1}}, {}},
                {dark, {{1, 1, 4}, {0, 0, -1}}, {3, 4, 0}},
                {dark, {{1, 1, -4}, {0, 0, 1}}, {}}};
    for (const auto& row : rows) {
        const Seen seen = row.panel.seen(row.ray);
        CAPTURE(&row - rows);
        CHECK(seen.E == rgb{});
        CHECK(seen.L == row.L);
    }
    p.scene.camera = look_at({1, 1, 4}, {1, 1, 9}, 50);
    for (const auto& pixel : radiance_image(p.scene, p.mesh, p.map, 2, 1).pixels)
        CHECK(pixel == std::array{0.f, 0.f, 0.f});
}

TEST_CASE("a pixel is the mean of rays on a regular grid, whatever the threads") {
    const Panel p;
    const int K = 3;
    const Image L = radiance_image(p.scene, p.mesh, p.map, K, 1),
                E = irradiance_image(p.scene, p.mesh, p.map, K, 1);
    CHECK(radiance_image(p.scene, p.mesh, p.map, K, 3).pixels == L.pixels);
    REQUIRE(L.width == 16);
    REQUIRE(L.height == 12);
    int bright = 0;
    double off = 0;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 16; ++x) {
            rgb l, e;
            for (int k = 0; k < K * K; ++k) {
                const real px = x + real(2 * (k % K) + 1) / 6, py = y + real(2 * (k / K) + 1) / 6;
                const Seen seen = p.seen(camera_ray(p.scene.camera, p.scene.size, px, py));
                l += seen.L / 9, e += seen.E / 9;
            }
            bright += l.x > 0;
            for (size_t c = 0; c < 3; ++c)
                for (auto [found, mean] :
                     {std::pair{L.at(x, y)[c], l.*axis[c]}, std::pair{E.at(x, y)[c], e.*axis[c]}})
                    off = std::max(
                        off, std::abs(double(found) - double(mean)) / std::max(1e-9, double(mean)));
        }
    CHECK(off <= (single ? 2e-5 : 2e-7));
    CHECK(bright > 50);
}

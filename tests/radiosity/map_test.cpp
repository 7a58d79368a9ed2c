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

// Different values on every side of every vertex.
IlluminationMap random_map(const Mesh& mesh, Rng& rng) {
    IlluminationMap map(number_of_sides(mesh));
    for (rgb& E : map)
        for (auto a : axis) E.*a = real(rng.uniform());
    return map;
}

}  // namespace

TEST_CASE("every vertex has a front and a back; between vertices both are linear") {
    const Scene s = panel();
    const Mesh mesh = make_mesh(s, 0.8);
    IlluminationMap map(number_of_sides(mesh));
    REQUIRE(map.size() == 2 * mesh.vertices());
    auto front = [](vec3 p) { return rgb{p.x, 2 * p.y, 1}; };
    auto back = [](vec3 p) { return rgb{5 - p.y, p.x + p.y, 0}; };
    for (const Face& f : mesh.faces) {
        uint32_t v = f.vertex;
        for (vec3 p : grid_points(f)) map[2 * v] = front(p), map[2 * v++ + 1] = back(p);
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
            const rgb Le = !back || twosided ? rgb{3, 4, 0} : rgb{}, rho{0.2, 0.5, 1};
            for (auto a : axis)
                CHECK(double(seen.L.*a) == approx(double(Le.*a + rho.*a * E.*a / pi)));
        }
        const Face &light = mesh.faces[0], &dark = mesh.faces[1];
        CHECK(emission(s, light, false) == rgb{3, 4, 0});
        CHECK(emission(s, light, true) == (twosided ? rgb{3, 4, 0} : rgb{}));
        CHECK(emission(s, dark, false) == rgb{});
        CHECK(albedo(s, light) == rgb{0.2, 0.5, 1});
        CHECK(albedo(s, dark) == grey(0.25));
    }
}

TEST_CASE("a ray that meets nothing is black; so is an empty map but for what emits") {
    const Scene s = panel();
    const Mesh mesh = make_mesh(s, 0.8);
    const IlluminationMap dark(number_of_sides(mesh));
    Rng rng{seed_here()};
    const IlluminationMap map = random_map(mesh, rng);
    const struct {
        const IlluminationMap& map;
        Ray ray;
        rgb L;
    } rows[] = {{map, {{0, 0, 1}, {0, 0, 1}}, {}},
                {dark, {{1, 1, 4}, {0, 0, -1}}, {3, 4, 0}},
                {dark, {{1, 1, -4}, {0, 0, 1}}, {}}};
    for (const auto& row : rows) {
        const Seen seen = seen_along(s, mesh, row.map, row.ray);
        CAPTURE(&row - rows);
        CHECK(seen.E == rgb{});
        CHECK(seen.L == row.L);
    }
    Scene away = s;
    away.camera = look_at({1, 1, 4}, {1, 1, 9}, 50);
    for (const auto& pixel : radiance_image(away, mesh, map, 2, 1).pixels)
        CHECK(pixel == std::array{0.f, 0.f, 0.f});
}

TEST_CASE("a pixel is the mean of rays on a regular grid, whatever the threads") {
    const Scene s = panel();
    const Mesh mesh = make_mesh(s, 0.8);
    Rng rng{seed_here()};
    const IlluminationMap map = random_map(mesh, rng);
    const int K = 3;
    const Image L = radiance_image(s, mesh, map, K, 1), E = irradiance_image(s, mesh, map, K, 1);
    CHECK(radiance_image(s, mesh, map, K, 3).pixels == L.pixels);
    REQUIRE(L.width == 16);
    REQUIRE(L.height == 12);
    int bright = 0;
    double off = 0;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 16; ++x) {
            rgb l, e;
            for (int k = 0; k < K * K; ++k) {
                const real px = x + real(2 * (k % K) + 1) / 6, py = y + real(2 * (k / K) + 1) / 6;
                const Seen seen = seen_along(s, mesh, map, camera_ray(s.camera, s.size, px, py));
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

// unseen/sent_test.cpp  what lights send to the picture: pixels, edges, paths from lights
#include "unseen/sent.h"

#include "base/moments.h"
#include "oracle/expect.h"
#include "path/paths.h"
#include "unseen/unseen.h"
#include "world/prepare.h"

namespace {

// A room that the eye sees from inside, with one light; half of it is glossy, and a ball of
// `material` stands in it.
Scene room(const Light* point, const Material& ball) {
    Scene s;
    s.size = {6, 4};
    s.depth = 5;
    s.camera = look_at({0, 1, real(2.8)}, {real(0.1), real(0.8), 0}, 50);
    Material lamp;
    lamp.Le = {4, 3, 2};
    Material both = lamp;
    both.twosided = true;
    s.materials = {
        {Rough({real(0.6), real(0.5), real(0.4)})},
        {Rough({real(0.3), real(0.3), real(0.3)}, {real(0.4), real(0.4), real(0.4)}, 20)},
        ball,
        lamp,
        both};
    add_quad(s, {-2, 0, -2}, {0, 0, 5}, {4, 0, 0}, 1);
    add_quad(s, {-2, 2, -2}, {4, 0, 0}, {0, 0, 5}, 0);
    add_quad(s, {-2, 0, -2}, {4, 0, 0}, {0, 2, 0}, 0);
    add_quad(s, {-2, 0, -2}, {0, 2, 0}, {0, 0, 5}, 0);
    add_quad(s, {2, 0, -2}, {0, 0, 5}, {0, 2, 0}, 0);
    add_quad(s, {-2, 0, 3}, {0, 2, 0}, {4, 0, 0}, 0);
    add_sphere(s, {real(0.5), real(0.5), 0}, real(0.5), 2);
    if (point) add_light(s, *point);
    return s;
}

// Sums over pixels of what one path from the eye, and one from light 0, bring.
double came(const Scene& s, const Pattern& pattern, uint64_t i) {
    std::vector<NearMisses> groups(s.lights.size());
    for (NearMisses& g : groups) g.sent = 1;
    Tally tally;
    tally.near.resize(groups.size());
    const uint64_t w = uint64_t(s.size.width), pixels = w * uint64_t(s.size.height);
    const int x = int(i % pixels % w), y = int(i % pixels / w);
    radiance(s, {}, pattern, x, y, i, NearMissVisitor{s, {}, groups, tally});
    return std::ldexp(double(tally.near[0].came), -40) * double(pixels);
}
double sent(const Scene& s, const Edges& edges, uint64_t key) {
    double sum = 0;
    follow_light(s, {0, s.size.height}, edges, s.lights[0], key,
                 [&](size_t, rgb L) { sum += double(mean_of(L)); });
    return sum;
}

}  // namespace

TEST_CASE("a direction belongs to the pixel through which the camera sends it") {
    Scene s = room(nullptr, {});
    s.size = {96, 64};
    oracle::Random random(seed_here());
    for (int i = 0; i < 10000; ++i) {
        const real x = real(random() * 96), y = real(random() * 64);
        const auto to = pixel_through(s, {0, 64}, camera_ray(s.camera, s.size, x, y).d);
        REQUIRE(to);
        CHECK(to->pixel == size_t(y) * 96 + size_t(x));
        const auto of_band = pixel_through(s, {20, 7}, camera_ray(s.camera, s.size, x, y).d);
        CHECK(bool(of_band) == (y >= 20 && y < 27));
        if (of_band) CHECK(of_band->pixel == to->pixel - size_t(20 * 96));
    }
    CHECK(!pixel_through(s, {0, 64}, -s.camera.forward));
    CHECK(!pixel_through(s, {0, 64}, camera_ray(s.camera, s.size, real(96.01), 3).d));
    // All of them together: a pyramid.
    double all = 0;
    for (int i = 0; i < 96 * 64; ++i)
        all += pixel_through(s, {0, 64},
                             camera_ray(s.camera, s.size, real(i % 96 + 0.5), real(i / 96 + 0.5)).d)
                   ->solid_angle;
    const double a = double(s.camera.tan_half), b = 1.5 * a;
    CHECK(
        all ==
        doctest::Approx(4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)))).epsilon(1e-4));
}

TEST_CASE("directions beside edges come with their density") {
    // Of two samplers with densities p and q: the means of q / (p + q) by the first, and of
    // p / (p + q) by the second, are both the integral of p q / (p + q).
    Scene s;
    s.materials = {{}};
    add_quad(s, {0, 0, 0}, {1, 0, real(0.2)}, {0, 1, 0}, 0);
    add_triangle(s, {2, 0, 0}, {1, 1, 1}, {2, 2, 0}, 0);
    for (int i = 0; i < 2; ++i) {
        if (i == 1)  // many edges, of which it takes some
            for (int k = 0; k < 100; ++k)
                add_triangle(s, {real(k), 5, 0}, {real(k), 6, 0}, {real(k), 5, 1}, 0);
        const Edges edges(s);
        for (const vec3 y : {vec3{real(0.5), real(0.4), real(0.4)}, vec3{1, -1, 1}}) {
            oracle::Random random(seed_here());
            auto u2 = [&] {
                const real x = real(random());
                return vec2{x, real(random())};
            };
            const double q = 1 / (4 * std::numbers::pi);
            auto first = [&] {
                const real u = real(random());
                const vec3 d = edges.sample(y, u, u2());
                return q / (q + double(edges.pdf(y, d)));
            };
            auto second = [&] {
                const double p = double(edges.pdf(y, sample_uniform_sphere(u2())));
                return p / (p + q);
            };
            EXPECT(oracle::expect_equal(first, second, i == 0 ? 200000 : 20000),
                   i == 0 ? 0.04 : 0.5);
        }
    }
    // Of many edges each is as likely as any other: near triangles of the first half, and the last.
    Scene row;
    row.materials = {{}};
    for (int k = 0; k < 300; ++k)
        add_triangle(row, {real(k), 0, 0}, {real(k) + real(0.1), 0, 0}, {real(k), real(0.1), 0}, 0);
    const Edges some(row);
    std::array<int, 3> thirds{};
    oracle::Random of_row(seed_here());
    for (int i = 0; i < 3000; ++i) {
        const vec3 y{150, 0, 1000};
        const real u = real(of_row()), v = real(of_row());
        const vec3 d = some.sample(y, real(of_row()), {u, v});
        if (!(d.z < 0)) continue;
        ++thirds[size_t(std::clamp((y - d * (1000 / d.z)).x, real(0), real(299))) / 100];
    }
    for (const int third : thirds) CHECK(third > 500);
    // Quads have four edges; lamps and balls none.
    Scene bare;
    bare.materials = {{}, {}};
    bare.materials[1].Le = {1, 1, 1};
    add_sphere(bare, {}, 1, 0), add_quad(bare, {}, {1, 0, 0}, {0, 1, 0}, 1);
    CHECK(Edges(bare).empty());
    add_quad(bare, {2, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    oracle::Random random(seed_here());
    for (int i = 0; i < 1000; ++i) {  // never across the quad, seen from before it
        const vec3 y{real(2.5), real(0.5), 3};
        const real u = real(random()), v = real(random());
        const vec3 d = Edges(bare).sample(y, real(random()), {u, v});
        if (!(d.z < 0)) continue;
        const vec3 p = y - d * (3 / d.z);
        CHECK(!(p.x > real(2.001) && p.x < real(2.999) && p.y > real(0.001) && p.y < real(0.999)));
    }
}

TEST_CASE("paths from a light and paths from the eye bring the same to the picture") {
    const vec3 above{real(-0.5), real(1.6), real(0.3)}, u{real(0.6), 0, real(0.1)},
        v{0, real(0.05), real(0.6)};
    const Light point(above, PointLight(), {1, 2, 3});
    // A ball of glass, with the light inside for a sphere; for a triangle it is a mirror.
    const Material glass{Glass(real(1.5))}, mirror{Mirror({1, 1, 1})};
    uint64_t seed = seed_here();
    for (size_t kind = 0; kind < 4; ++kind) {
        Scene s = room(kind == 0 ? &point : nullptr, kind == 2 ? mirror : glass);
        if (kind == 1) add_sphere(s, {real(0.5), real(0.5), 0}, real(0.25), 3);
        if (kind == 2) add_triangle(s, above, above + u, above + v, 4);
        if (kind == 3) add_quad(s, above, u, v, 3);
        prepare(s);
        const Pattern pattern{SamplerKind::independent, ++seed};
        uint64_t i = 0, k = hash(seed, 1);
        auto of_many = [](auto f) {
            double sum = 0;
            for (int j = 0; j < 1200; ++j) sum += f() / 1200;
            return sum;
        };
        for (const Edges& edges : {Edges(s), Edges(Scene())}) {
            INFO(kind);
            EXPECT(oracle::expect_equal(
                       [&] { return of_many([&] { return came(s, pattern, i++); }); },
                       [&] { return of_many([&] { return sent(s, edges, k++); }); }, 450),
                   0.06);
        }
    }
}

TEST_CASE("white walls do not hold a path for ever") {
    // The lamp is a point, so that nothing absorbs.
    Scene s = room(nullptr, {Rough({1, 1, 1})});
    for (Material& m : s.materials) m = {Rough({1, 1, 1})};
    add_light(s, {{0, real(1.5), 0}, PointLight(), {1, 1, 1}});
    s.depth = max_depth;
    prepare(s);
    int splats = 0;
    for (uint64_t key = 0; key < 8; ++key)
        follow_light(s, {0, s.size.height}, Edges(Scene()), s.lights[0], key,
                     [&](size_t, rgb) { ++splats; });
    CHECK(splats > 8);
    CHECK(splats <= 8 * 32);
}

TEST_CASE("the sums of groups are those of their lights, and of their squares those of pixels") {
    // A bare wall before the eye, a strong point light, a weak one, and one that is behind the
    // wall.
    Scene s = room(nullptr, {});
    s.shapes.clear(), s.material_of.clear(), s.light_of.clear();
    add_quad(s, {-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, 0);
    for (const auto& [z, I] : {std::pair{2, 40}, {1, 1}, {-1, 7}})
        add_light(s, {{0, 1, real(z)}, PointLight(), rgb(1, 1, 1) * real(I)});
    s.depth = 1;
    prepare(s);
    const Band all{0, s.size.height};
    CHECK(light_paths(s, all) == 8 * 24);
    CHECK(light_paths(s, {0, 1000000}) == 16384);
    // Radiance of the wall: rho / pi I cos / d^2.
    auto radiance_at = [&](size_t light, double px, double py) {
        const Ray ray = camera_ray(s.camera, s.size, real(px), real(py));
        const vec3 x = ray.o - ray.d * (ray.o.z / ray.d.z), w = s.lights[light].p - x;
        const double d2 = double(dot(w, w));
        return w.z > 0 ? 0.5 / std::numbers::pi * double(mean_of(s.lights[light].L)) * double(w.z) /
                             (d2 * std::sqrt(d2))
                       : 0;
    };
    std::array<double, 3> sum{}, squares{};
    for (int pixel = 0; pixel < 24; ++pixel)
        for (size_t light = 0; light < 3; ++light) {
            double of_pixel = 0;
            for (int i = 0; i < 400; ++i)
                of_pixel += radiance_at(light, pixel % 6 + (i % 20 + 0.5) / 20,
                                        pixel / 6 + (i / 20 + 0.5) / 20) /
                            400;
            sum[light] += of_pixel, squares[light] += of_pixel * of_pixel;
        }
    for (const Edges& edges : {Edges(s), Edges(Scene())}) {
        std::vector<NearMisses> groups(3);
        add_sent(groups, s, all, edges, 400000);
        for (size_t g = 0; g < 2; ++g) {
            const double error = std::sqrt(groups[g].sent_variance);
            CHECK(error < 0.03 * sum[g]);
            CHECK(error > 0.001 * sum[g]);
            CHECK(std::abs(groups[g].sent - sum[g]) < 5 * error);
            CHECK(std::abs(groups[g].sent_squares / squares[g] - 1) < 0.06);
        }
        CHECK((groups[2].sent == 0 && groups[2].sent_squares == 0));
        // Bands partition the picture.
        double of_bands = 0;
        for (int row = 0; row < 4; ++row) {
            std::vector<NearMisses> band(3);
            add_sent(band, s, {row, 1}, edges, 400000);
            of_bands += band[0].sent;
        }
        CHECK(of_bands == doctest::Approx(groups[0].sent));
        // A single path has no pairs: the square is at least that of the mean.
        int found = 0;
        for (uint64_t paths = 1; paths < 40; ++paths) {
            std::vector<NearMisses> one(3);
            add_sent(one, s, all, edges, paths);
            for (const NearMisses& g : one) {
                found += g.sent > 0;
                CHECK(g.sent_squares >= square(g.sent) / 24 * 0.999999);
            }
        }
        CHECK(found > 10);
    }
    // A lamp close to the wall, whose light is that of a single pixel.
    s.lights.clear();
    add_light(s, {camera_ray(s.camera, s.size, real(3.5), real(2.5)).d, PointLight(), {1, 1, 1}});
    vec3& p = s.lights[0].p;
    p = s.camera.eye - p * ((s.camera.eye.z - real(1e-4)) / p.z);
    prepare(s);
    const vec3 to_eye = s.camera.eye - p;
    const double flux = 2 * std::numbers::pi, d2 = double(dot(to_eye, to_eye)),
                 of_pixel = flux * 0.5 / std::numbers::pi * double(to_eye.z) /
                            (d2 * std::sqrt(d2)) /
                            pixel_through(s, all, -unit(to_eye))->solid_angle;
    Moments mean;
    const Edges none{Scene()};
    for (uint64_t paths = 40; paths < 1040; ++paths) {
        std::vector<NearMisses> one(1);
        add_sent(one, s, all, none, paths);
        mean.add(one[0].sent / of_pixel);
    }
    CHECK(std::abs(mean.mean - 1) < 5 * mean.standard_error());
    CHECK(mean.standard_error() < 0.005);
    // The square has all pairs of different paths.
    std::vector<double> of_path;
    for (uint64_t k = 0; k < 9; ++k) {
        of_path.push_back(0);
        follow_light(s, all, none, s.lights[0], hash(9, k),
                     [&](size_t, rgb L) { of_path.back() += double(mean_of(L)) / 9; });
    }
    double pairs = 0;
    for (size_t i = 0; i < 9; ++i)
        for (size_t j = 0; j < 9; ++j) pairs += i != j ? of_path[i] * of_path[j] : 0;
    std::vector<NearMisses> nine(1);
    add_sent(nine, s, all, none, 9);
    CHECK(pairs > 0);
    CHECK(std::abs(nine[0].sent_squares / pairs - 1) < 1e-9);
}

TEST_CASE("light that comes by a gap is found beside its edges, and none in a closed room") {
    // A lamp of 1 m behind a wall 1 m before it; the hole is 1 cm wide.
    for (const bool is_open : {true, false}) {
        Scene s = room(nullptr, {Rough({real(0.5), real(0.5), real(0.5)})});
        s.size = {48, 32};
        s.shapes.erase(s.shapes.begin() + 8, s.shapes.begin() + 10);  // the right wall
        s.material_of.resize(s.shapes.size()), s.light_of.resize(s.shapes.size());
        const real h = is_open ? real(0.01) : 0;
        add_quad(s, {2, 0, -2}, {0, 0, 5}, {0, 1, 0}, 0);
        add_quad(s, {2, 1 + h, -2}, {0, 0, 5}, {0, 1 - h, 0}, 0);
        if (is_open) {
            add_quad(s, {2, 1, -2}, {0, 0, 2}, {0, h, 0}, 0);
            add_quad(s, {2, 1, h}, {0, 0, 3 - h}, {0, h, 0}, 0);
        }
        s.materials[3].Le = {40000, 30000, 20000};
        add_quad(s, {3, real(0.5), real(-0.5)}, {0, 0, 1}, {0, 1, 0}, 3);
        prepare(s);
        const LightRecorder recorder(s, {}, 0, 32);
        const NearMisses lamp = recorder.near_misses(1)[0];
        CHECK((lamp.sent > 3 * std::sqrt(lamp.sent_variance)) == is_open);
        if (!is_open) CHECK(lamp.sent == 0);
    }
}

TEST_CASE("a lamp that the eye sees through a gap covers part of a pixel") {
    Scene s = room(nullptr, {Rough({real(0.5), real(0.5), real(0.5)})});
    s.size = {48, 32};
    s.shapes.clear(), s.material_of.clear(), s.light_of.clear();
    // The hole of 2 mm square is 2.8 m before the eye, the lamp behind it much larger.
    const real h = real(0.002);
    add_quad(s, {-9, -8, 0}, {18, 0, 0}, {0, 9, 0}, 0);
    add_quad(s, {-9, 1 + h, 0}, {18, 0, 0}, {0, 9, 0}, 0);
    add_quad(s, {-9, 1, 0}, {9, 0, 0}, {0, h, 0}, 0);
    add_quad(s, {h, 1, 0}, {9, 0, 0}, {0, h, 0}, 0);
    add_quad(s, {-5, -5, -1}, {10, 0, 0}, {0, 10, 0}, 3);
    prepare(s);
    const double side = 2 * double(s.camera.tan_half) / 32;
    // In the plane of the picture: perpendicular to forward, at distance 1.
    auto at = [&](real x, real y) {
        const vec3 d = vec3{x, y, 0} - s.camera.eye;
        const double f = double(dot(d, s.camera.forward)) * side;
        return std::pair{double(dot(d, s.camera.right)) / f, double(dot(d, s.camera.up)) / f};
    };
    const auto [x0, y0] = at(0, 1);
    const auto [x1, y1] = at(h, 1);
    const auto [x2, y2] = at(0, 1 + h);
    const double area = std::abs((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0));
    const LightsInView view = lights_in_view(s, {0, 32}, Edges(s));
    CHECK(std::abs(view.groups[0].area / area - 1) < 0.15);
    CHECK(view.noisy.size() >= 1);
    CHECK(lights_in_view(s, {0, 32}, Edges(Scene())).groups[0].area == 0);
    // Its back is dark.
    s.shapes.resize(s.shapes.size() - 2), s.material_of.resize(s.shapes.size());
    s.light_of.resize(s.shapes.size()), s.lights.clear();
    add_quad(s, {-5, -5, -1}, {0, 10, 0}, {10, 0, 0}, 3);
    prepare(s);
    CHECK(lights_in_view(s, {0, 32}, Edges(s)).groups[0].area == 0);
}

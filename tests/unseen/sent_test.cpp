// unseen/sent_test.cpp  what lights send to the picture: pixels, sums, paths from lights
#include "unseen/sent.h"

#include "base/moments.h"
#include "oracle/expect.h"
#include "path/paths.h"
#include "unseen/room.h"
#include "unseen/unseen.h"
#include "world/prepare.h"

namespace {

// Sums over pixels of what one path from the eye, and one from light 0, bring: k + 1 times, if the
// shape that is lit first is of class k.
double came(const Scene& s, const SamplerSettings& settings, uint64_t i) {
    const std::vector<size_t> group_of = light_groups(s);
    const std::vector<uint8_t> sizes = area_classes(s);
    std::vector<NearMisses> groups(s.lights.size());
    for (NearMisses& g : groups)
        for (Brought& of : g.from_light) of.sum = 1;
    Tally tally;
    tally.near.resize(groups.size());
    const uint64_t w = uint64_t(s.size.width), pixels = w * uint64_t(s.size.height);
    const int x = int(i % pixels % w), y = int(i % pixels / w);
    radiance(s, {}, settings, x, y, i, NearMissVisitor{s, groups, group_of, sizes, tally});
    double sum = 0;
    for (size_t k = 0; k < classes; ++k)
        sum += double(k + 1) * std::ldexp(double(tally.near[0].from_light[k].came), -40);
    return sum * double(pixels);
}
double sent(const Scene& s, const Aims& aims, uint64_t key) {
    double sum = 0;
    Draws u{key};
    follow_light(s, {0, s.size.height}, s.lights[0], emission(s.lights[0], aims, u), u,
                 [&](size_t, rgb L, uint32_t shape) {
                     sum += double(class_of(s.shapes[shape]) + 1) * double(mean_of(L));
                 });
    return sum;
}
// Of one group, in all classes.
Brought in_all(const PictureSums& sums, size_t group, double pixels) {
    Brought all;
    for (size_t k = 0; k < classes; ++k) {
        const Brought of = sums.of(group * classes + k, pixels);
        all.sum += of.sum, all.squares += of.squares, all.variance += of.variance;
    }
    return all;
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
        const SamplerSettings settings{SamplerKind::independent, ++seed};
        uint64_t i = 0, k = hash(seed, 1);
        auto of_many = [](auto f) {
            double sum = 0;
            for (int j = 0; j < 1200; ++j) sum += f() / 1200;
            return sum;
        };
        for (const Aims& aims : {Aims(s), Aims(Scene())}) {
            INFO(kind);
            EXPECT(oracle::expect_equal(
                       [&] { return of_many([&] { return came(s, settings, i++); }); },
                       [&] { return of_many([&] { return sent(s, aims, k++); }); }, 450),
                   0.06);
        }
    }
}

TEST_CASE("the class of a shape is that of its area") {
    for (real x = real(0.01); x < 100; x *= real(1.3)) {
        Scene s;
        s.materials = {{}};
        add_sphere(s, {1, 2, 3}, x, 0);
        add_triangle(s, {1, 2, 3}, {1 + x, 2, 3}, {1, 2 + x, 3}, 0);
        CHECK(class_of(s.shapes[0]) == class_of(4 * std::numbers::pi * double(x) * double(x)));
        const vec3 e = s.shapes[1].b - s.shapes[1].a, f = s.shapes[1].c - s.shapes[1].a;
        CHECK(class_of(s.shapes[1]) == class_of(double(e.x * f.y) / 2));
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
    for (uint64_t key = 0; key < 8; ++key) {
        Draws u{key};
        follow_light(s, {0, s.size.height}, s.lights[0], emission(s.lights[0], Aims(Scene()), u), u,
                     [&](size_t, rgb, uint32_t) { ++splats; });
    }
    CHECK(splats > 8);
    CHECK(splats <= 8 * 32);
}

TEST_CASE("sums over paths: of a group, of its squares in pixels, and of squares of whole paths") {
    PictureSums sums(3);
    sums.add(0, 5, 1), sums.add(0, 6, 2), sums.add(0, 5, 1), sums.add(1, 5, 4);
    sums.end_path();
    sums.add(0, 5, 3), sums.add(1, 5, 2);
    sums.end_path();
    auto is = [&](size_t group, double sum, double squares, double variance) {
        const Brought of = sums.of(group, 100);
        CHECK((of.sum == sum && of.squares == squares && of.variance == variance && of.came == 0));
    };
    is(0, 7, 2 * 2 * 3, 4 * 4 + 3 * 3);
    is(1, 6, 2 * 4 * 2, 4 * 4 + 2 * 2);
    is(2, 0, 0, 0);
    CHECK(sums.of(0, 2).squares == 49 / 2.0);
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
    CHECK(aimed_paths(s, all) == 8 * 24);
    CHECK(aimed_paths(s, {0, 1000000}) == 16384);
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
    for (const Aims& aims : {Aims(s), Aims(Scene())}) {
        const PictureSums sums = sent_by_lights(s, all, aims, 400000);
        for (size_t g = 0; g < 2; ++g) {
            const Brought of = in_all(sums, g, 24);
            const double error = std::sqrt(of.variance);
            CHECK(error < 0.03 * sum[g]);
            CHECK(error > 0.001 * sum[g]);
            CHECK(std::abs(of.sum - sum[g]) < 5 * error);
            CHECK(std::abs(of.squares / squares[g] - 1) < 0.06);
        }
        const Brought hidden = in_all(sums, 2, 24);
        CHECK((hidden.sum == 0 && hidden.squares == 0));
        CHECK(sums.of(class_of(s.shapes[0]), 24).sum == in_all(sums, 0, 24).sum);
        // Bands partition the picture.
        double of_bands = 0;
        for (int row = 0; row < 4; ++row)
            of_bands += in_all(sent_by_lights(s, {row, 1}, aims, 400000), 0, 6).sum;
        CHECK(std::abs(of_bands / in_all(sums, 0, 24).sum - 1) < (aims.size() > 0 ? 0.02 : 1e-9));
        // A single path has no pairs: the square is at least that of the mean.
        int found = 0;
        for (uint64_t paths = 1; paths < 40; ++paths) {
            const PictureSums few = sent_by_lights(s, all, aims, paths);
            for (size_t g = 0; g < 3; ++g) {
                const Brought of = in_all(few, g, 24);
                found += of.sum > 0;
                CHECK(of.squares >= square(of.sum) / 24 * 0.999999);
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
    const Aims none{Scene()};
    for (uint64_t paths = 40; paths < 1040; ++paths) {
        mean.add(in_all(sent_by_lights(s, all, none, paths), 0, 24).sum / of_pixel);
    }
    CHECK(std::abs(mean.mean - 1) < 5 * mean.standard_error());
    CHECK(mean.standard_error() < 0.005);
    // The square has all pairs of different paths.
    std::vector<double> of_path;
    for (uint64_t k = 0; k < 9; ++k) {
        of_path.push_back(0);
        Draws u{hash(9, k)};
        follow_light(s, all, s.lights[0], emission(s.lights[0], none, u), u,
                     [&](size_t, rgb L, uint32_t) { of_path.back() += double(mean_of(L)) / 9; });
    }
    double pairs = 0;
    for (size_t i = 0; i < 9; ++i)
        for (size_t j = 0; j < 9; ++j) pairs += i != j ? of_path[i] * of_path[j] : 0;
    CHECK(pairs > 0);
    CHECK(std::abs(in_all(sent_by_lights(s, all, none, 9), 0, 24).squares / pairs - 1) < 1e-9);
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
        double sum = 0, variance = 0;
        for (const Brought& of : recorder.near_misses(1)[0].from_light)
            sum += of.sum, variance += of.variance;
        CHECK((sum > 10 * std::sqrt(variance)) == is_open);  // 4 without learning
        if (!is_open) CHECK(sum == 0);
    }
}

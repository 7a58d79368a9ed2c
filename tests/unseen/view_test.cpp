// unseen/view_test.cpp  paths from the eye that aim: lights in view, and what else they bring
#include "unseen/view.h"

#include "oracle/expect.h"
#include "path/paths.h"
#include "unseen/room.h"
#include "unseen/unseen.h"
#include "world/prepare.h"

namespace {

// A wall with a square hole of side h at (0, 1, 0), 2.8 m before the eye; all behind is open.
Scene wall_with_hole(real h) {
    Scene s = room(nullptr, {Rough({real(0.5), real(0.5), real(0.5)})});
    s.size = {48, 32};
    s.shapes.clear(), s.material_of.clear(), s.light_of.clear();
    add_quad(s, {-9, -8, 0}, {18, 0, 0}, {0, 9, 0}, 0);
    add_quad(s, {-9, 1 + h, 0}, {18, 0, 0}, {0, 9, 0}, 0);
    add_quad(s, {-9, 1, 0}, {9, 0, 0}, {0, h, 0}, 0);
    add_quad(s, {h, 1, 0}, {9, 0, 0}, {0, h, 0}, 0);
    return s;
}
// Of a parallelogram, in pixels.
double area_in_picture(const Scene& s, vec3 p, vec3 e, vec3 f) {
    const double side = 2 * double(s.camera.tan_half) / s.size.height;
    // In the plane of the picture: perpendicular to forward, at distance 1.
    auto at = [&](vec3 q) {
        const vec3 d = q - s.camera.eye;
        const double z = double(dot(d, s.camera.forward)) * side;
        return std::pair{double(dot(d, s.camera.right)) / z, double(dot(d, s.camera.up)) / z};
    };
    const auto [x0, y0] = at(p);
    const auto [x1, y1] = at(p + e);
    const auto [x2, y2] = at(p + f);
    return std::abs((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0));
}

}  // namespace

TEST_CASE("a lamp that the eye sees through a gap covers part of a pixel") {
    const real h = real(0.002);
    Scene s = wall_with_hole(h);
    add_quad(s, {-5, -5, -1}, {10, 0, 0}, {0, 10, 0}, 3);
    prepare(s);
    const double area = area_in_picture(s, {0, 1, 0}, {h, 0, 0}, {0, h, 0});
    auto seen = [&](const Aims& aims) {
        return lights_in_view(s, {0, 32}, {}, aims, 16384).groups[0].area;
    };
    const LightsInView view = lights_in_view(s, {0, 32}, {}, Aims(s), 16384);
    CHECK(std::abs(view.groups[0].area / area - 1) < 0.15);
    CHECK(view.noisy.size() >= 1);
    CHECK(seen(Aims(Scene())) == 0);
    for (const Brought& of : view.groups[0].from_eye) CHECK(of.sum == 0);  // all is dark besides
    // Its back is dark.
    s.shapes.resize(s.shapes.size() - 2), s.material_of.resize(s.shapes.size());
    s.light_of.resize(s.shapes.size()), s.lights.clear();
    add_quad(s, {-5, -5, -1}, {0, 10, 0}, {10, 0, 0}, 3);
    prepare(s);
    CHECK(seen(Aims(s)) == 0);
}

TEST_CASE("whether a lamp's pixels are noisy does not depend on what aims find") {
    const real h = real(0.316);  // almost 16 pixels
    Scene s = wall_with_hole(real(0.002));
    add_quad(s, {-h / 2, real(0.6), real(0.1)}, {h, 0, 0}, {0, h, 0}, 3);
    prepare(s);
    const LightsInView few = lights_in_view(s, {0, 32}, {}, Aims(s), 64);
    const LightsInView many = lights_in_view(s, {0, 32}, {}, Aims(s), 65536);
    CHECK(few.groups[0].area < 16);
    CHECK(many.groups[0].area > 16);
    CHECK(!few.noisy.empty());
    CHECK(!many.noisy.empty());
}

TEST_CASE("the eye's paths that aim find a lit room behind a hole, also in one mirror or two") {
    // Behind the hole a bright wall, lit by a point 25 cm before it: radiance rho / pi I cos / d^2.
    const real h = real(0.01);
    const vec3 hole{h / 2, 1 + h / 2, 0};
    for (const int mirrors : {0, 1, 2}) {
        Scene s = wall_with_hole(h);
        add_quad(s, {-5, -5, real(-0.5)}, {10, 0, 0}, {0, 10, 0}, 0);
        add_light(s, {hole - vec3{0, 0, real(0.25)}, PointLight(), {900, 900, 900}});
        // The eye looks away from the wall, into a mirror behind it, or into one beside it that
        // shows the other; what it sees is what its image sees, which has the same camera.
        const vec3 image = mirrors == 0   ? vec3{0, 1, real(2.8)}
                           : mirrors == 1 ? vec3{0, 1, real(8.4)}
                                          : vec3{3, 1, real(11.4)};
        s.materials[2] = {Mirror({1, 1, 1})};
        s.camera = look_at(image, hole, 50);
        const double area = area_in_picture(s, {0, 1, 0}, {h, 0, 0}, {0, h, 0});
        if (mirrors > 0) {
            add_quad(s, {-20, -20, real(5.6)}, {0, 40, 0}, {40, 0, 0}, 2);
            s.camera = look_at({0, 1, real(2.8)}, {h / 2, 1 + h / 2, real(11.2)}, 50);
        }
        if (mirrors == 2) {
            add_quad(s, {real(2.2), real(0.5), 2}, {real(0.4), 0, real(0.4)}, {0, 1, 0}, 2);
            s.camera = look_at({0, 1, real(2.8)}, {real(2.374), 1, real(2.17)}, 50);
        }
        prepare(s);
        auto found = [&](const std::vector<NearMisses>& groups) {
            double sum = 0, variance = 0;
            for (const Brought& of : groups[0].from_eye) sum += of.sum, variance += of.variance;
            return std::pair{sum, std::sqrt(variance)};
        };
        auto in_view_by = [&](const Aims& aims) {
            return found(lights_in_view(s, {0, 32}, {}, aims, 16384).groups);
        };
        const auto [sum, error] = in_view_by(Aims(s).of_eye(s));
        INFO(mirrors);
        CHECK(sum > 5 * error);
        const double off = double(0.5 * (image.x - hole.x) / image.z);
        const double L = 0.5 / std::numbers::pi * 900 * 0.25 / std::pow(0.0625 + off * off, 1.5);
        CHECK(std::abs(sum / (L * area) - 1) < 0.3);
        CHECK(found(LightRecorder(s, {}, 0, 32).near_misses(1)).first > 0.5 * sum);
        const auto [by_luck, its_error] = in_view_by(Aims(s));  // at mirrors, not at the hole
        CHECK((by_luck <= 3 * its_error) == (mirrors > 0));
    }
}

TEST_CASE("half of what is learned is of all light, half of each class of radiance alike") {
    // Two balls, each before a point light at the eye; one of them is 2^9 times as bright.
    // Half of the aims are as before: half alike, half by radiosity.
    Scene s = room(nullptr, {Rough({real(0.5), real(0.5), real(0.5)})});
    s.size = {48, 32};
    s.shapes.clear(), s.material_of.clear(), s.light_of.clear();
    const vec3 bright = s.camera.eye + s.camera.forward * 4 - s.camera.right;
    const vec3 dim = bright + 2 * s.camera.right;
    s.materials[1] = {Rough({real(0.5) / 512, real(0.5) / 512, real(0.5) / 512})};
    add_sphere(s, bright, real(0.3), 0), add_sphere(s, dim, real(0.3), 1);
    add_light(s, {s.camera.eye, PointLight(), {900, 900, 900}});
    prepare(s);
    Aims aims(s);
    REQUIRE(aims.size() == 4);
    auto part_of_dim = [&] {
        int of_dim = 0;
        for (uint64_t k = 0; k < 10000; ++k)
            of_dim += aims.sample(s.camera.eye, radical_inverse(2, k), {0, 0}).value().at >= 2;
        return of_dim / 1e4;
    };
    CHECK(std::abs(part_of_dim() - 0.25) < 0.02);
    learn(aims, s, {0, 32}, {}, 10000);
    CHECK(std::abs(part_of_dim() - (0.25 + 0.25) / 2) < 0.02);
}

TEST_CASE("paths that aim and all others bring the same, where both may find it") {
    // The room is all edges and shapes, and few directions are far from all of them.  A mirror or
    // pane shows it again.
    const vec3 above{real(-0.5), real(1.6), real(0.3)};
    const Light point(above, PointLight(), {1, 2, 3});
    for (const Material& ball : {Material{Mirror({1, 1, 1})}, Material{Glass(real(1.5))},
                                 Material{Rough({real(0.5), real(0.5), real(0.5)})}}) {
        Scene s = room(&point, ball);
        add_quad(s, above, {real(0.6), 0, real(0.1)}, {0, real(0.05), real(0.6)}, 4);
        add_quad(s, {real(-1.2), real(0.3), real(-0.3)}, {real(0.9), 0, real(0.3)}, {0, 1, 0}, 2);
        prepare(s);
        const std::vector<size_t> each = {0, 1};
        const std::vector<uint8_t> sizes = area_classes(s);
        std::vector<NearMisses> groups(2);
        for (NearMisses& g : groups)
            for (Brought& of : g.from_eye) of.sum = 1;
        Tally tally;
        tally.near.resize(2);
        const SamplerSettings settings{SamplerKind::sobol, seed_here()};
        constexpr uint64_t n = 4000;
        for (uint64_t i = 0; i < n; ++i)
            for (int pixel = 0; pixel < 24; ++pixel)
                radiance(s, {}, settings, pixel % 6, pixel / 6, i,
                         NearMissVisitor{s, groups, each, sizes, tally});
        const LightsInView many = lights_in_view(s, {0, 4}, {}, Aims(s).of_eye(s), 600000);
        for (size_t light = 0; light < 2; ++light) {
            double came = 0, sum = 0, variance = 0;
            for (size_t k = 0; k < classes; ++k) {
                const Brought& of = many.groups[light].from_eye[k];
                sum += of.sum, variance += of.variance;
                came += std::ldexp(double(tally.near[light].from_eye[k].came), -40) / double(n);
            }
            CHECK(came > 0);
            CHECK(std::sqrt(variance) < 0.03 * sum);
            CHECK(std::abs(sum - came) < 4 * std::sqrt(variance) + 0.01 * came);
        }
    }
}

TEST_CASE("white walls do not hold a path from the eye for ever") {
    Scene s = room(nullptr, {Rough({1, 1, 1})});
    for (Material& m : s.materials) m = {Rough({1, 1, 1})};
    add_light(s, {{0, real(1.5), 0}, PointLight(), {1, 1, 1}});
    s.depth = 3000;
    prepare(s);
    size_t most = 0;
    for (uint64_t k = 0; k < 16; ++k)
        if (const auto path = eye_path(s, {0, 4}, {}, Aims(s), k))
            most = std::max(most, path->brought.size());
    CHECK(most > 10);
    CHECK(most <= 33);
}

TEST_CASE("a class for every radiance: three octaves each, and eight classes in turns") {
    CHECK(class_of(1) == class_of(3.9));
    CHECK(class_of(1) == class_of(std::ldexp(1.0, 24)));
    std::set<size_t> seen;
    for (int octave = -1074; octave < 1024; ++octave) {
        const size_t k = class_of(std::ldexp(1.0, octave));
        REQUIRE(k < classes);
        seen.insert(k);
        if (octave >= -1071 && octave < 990)
            CHECK(class_of(std::ldexp(1.0, octave + 3)) == (k + 1) % classes);
    }
    CHECK(seen.size() == classes);
    CHECK(class_of(std::numeric_limits<double>::infinity()) < classes);
}

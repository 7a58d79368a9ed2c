// unseen/aims_test.cpp  directions that aim at gaps and small things, and their density
#include "unseen/aims.h"

#include <array>

#include "oracle/expect.h"
#include "world/prepare.h"

using namespace penumbra;

namespace {

// Directions of many from y that aim: their parts for which `is_such` holds.
double part_of_aims(const Aims& aims, vec3 y, int n, auto is_such) {
    oracle::Random random(seed_here());
    int such = 0, all = 0;
    while (all < n) {
        const real u = real(random()), v = real(random());
        if (const auto aim = aims.sample(y, real(random()), {u, v})) ++all, such += is_such(*aim);
    }
    return such / double(n);
}

}  // namespace

TEST_CASE("directions that aim come with their density") {
    // Of two samplers with densities p and q: the means of q / (p + q) by the first, and of
    // p / (p + q) by the second, are both the integral of p q / (p + q).
    Scene s;
    s.materials = {{}, {Mirror({1, 1, 1})}, {Glass(real(1.5))}};
    for (int kind = 0; kind < 4; ++kind) {
        if (kind == 0) add_sphere(s, {real(0.5), 2, 0}, 1, 0);
        if (kind == 1) add_quad(s, {0, 0, 0}, {1, 0, real(0.2)}, {0, 1, 0}, 2);
        if (kind == 2) add_triangle(s, {2, 0, 0}, {1, 1, 1}, {2, 2, 0}, 1);
        if (kind == 3)  // many edges and shapes, of which it takes some
            for (int k = 0; k < 100; ++k)
                add_triangle(s, {real(k), 5, 0}, {real(k), 6, 0}, {real(k), 5, 1}, 0);
        Aims aims(s);
        std::vector<double> worth(aims.size());
        for (size_t i = 0; i < worth.size(); ++i) worth[i] = double(i % 3);
        for (const bool is_learned : {false, true}) {
            if (is_learned) aims.prefer(worth);
            for (const vec3 y : {vec3{real(0.5), real(0.4), real(0.4)}, vec3{1, 0, 1},
                                 vec3{real(0.4), real(1.9), 0}}) {  // the last in the ball
                oracle::Random random(seed_here());
                auto u2 = [&] {
                    const real x = real(random());
                    return vec2{x, real(random())};
                };
                const double q = 1 / (4 * std::numbers::pi);
                auto first = [&] {
                    const real u = real(random());
                    const auto aim = aims.sample(y, u, u2());
                    return aim ? q / (q + double(aims.pdf(y, aim->d))) : 0;
                };
                auto second = [&] {
                    const double p = double(aims.pdf(y, sample_uniform_sphere(u2())));
                    return p / (p + q);
                };
                INFO(kind);
                EXPECT(oracle::expect_equal(first, second, kind < 3 ? 400000 : 100000),
                       kind < 3 ? 0.06 : 0.2);
            }
        }
    }
}

TEST_CASE("of many edges and shapes each is as likely as any other, until paths have learned") {
    Scene row;
    row.materials = {{}};
    for (int k = 0; k < 300; ++k)
        add_triangle(row, {real(k), 0, 0}, {real(k) + real(0.1), 0, 0}, {real(k), real(0.1), 0}, 0);
    Aims aims(row);
    CHECK(aims.size() == 64 + 2 * 32);
    const vec3 y{150, 0, 1000};
    auto third = [&](int which) {
        return part_of_aims(aims, y, 3000, [&](const Aims::Aim& aim) {
            const real x = (y - aim.d * (1000 / aim.d.z)).x;
            return int(std::clamp(x, real(0), real(299))) / 100 == which;
        });
    };
    for (int which = 0; which < 3; ++which) {
        CHECK(third(which) > 0.2);
        const auto is_shape_of = [&](const Aims::Aim& aim) {
            const real x = (y - aim.d * (1000 / aim.d.z)).x;
            return aim.at >= 64 && int(std::clamp(x, real(0), real(299))) / 100 == which;
        };
        CHECK(part_of_aims(aims, y, 10000, is_shape_of) > 0.05);  // of 1/4
    }
    auto at = [](size_t i) { return [i](const Aims::Aim& aim) { return aim.at == i; }; };
    auto is_shape = [](const Aims::Aim& aim) { return aim.at >= 64; };
    CHECK(std::abs(part_of_aims(aims, y, 10000, is_shape) - 0.25) < 0.03);
    // Nothing is learned from nothing, or from what is too much; else half of all are as before.
    aims.prefer(std::vector<double>(aims.size()));
    aims.prefer(std::vector<double>(aims.size(), std::numeric_limits<double>::infinity()));
    CHECK(std::abs(part_of_aims(aims, y, 10000, is_shape) - 0.25) < 0.03);
    std::vector<double> worth(aims.size());
    worth[7] = 3, worth[80] = 1;
    aims.prefer(worth);
    CHECK(std::abs(part_of_aims(aims, y, 10000, at(7)) - (0.375 + 0.375 / 64)) < 0.03);
    CHECK(std::abs(part_of_aims(aims, y, 10000, at(80)) - (0.125 + 0.125 / 64)) < 0.03);
    CHECK(std::abs(part_of_aims(aims, y, 10000, is_shape) - 0.25) < 0.03);
}

TEST_CASE("of many shapes the half is aimed at on which lights shine most, and others by lot") {
    Scene s;
    s.materials = {{Rough({0.5, 0.5, 0.5})}, {}, {}};
    s.materials[1].Le = {3, 3, 3}, s.materials[2].Le = {1, 1, 1};
    for (int k = 0; k < 250; ++k) add_sphere(s, {real(k), 0, 0}, real(0.1), 0);
    // A lamp beside ball 210, and a thousand others far away.
    add_sphere(s, {real(210.1), 2, 0}, real(0.5), 1);
    for (int k = 0; k < 1000; ++k) add_sphere(s, {real(k), 900, 0}, real(0.5), 2);
    prepare(s);
    const Aims aims(s);
    CHECK(aims.size() == 2 * 32);
    const vec3 y{150, 0, 1000};
    int lit = 0, in_dark = 0;
    std::array<int, 3> thirds{};
    for (int k = 0; k < 250; ++k)
        if (aims.pdf(y, unit(vec3{real(k), 0, 0} - y)) > 0)
            ++(std::abs(double(k) - 210.1) < 8 ? lit : in_dark), ++thirds[size_t(k / 100)];
    CHECK(lit >= 16);
    CHECK(lit < 20);
    CHECK(lit + in_dark == 32);
    for (int n : thirds) CHECK(n > 0);
}

TEST_CASE("half of the aims at shapes go where lights shine, in proportion to the albedo") {
    // Five balls; a point light is as far from four of them, and in the middle of the last.
    const rgb half{0.5, 0.5, 0.5};
    const std::array albedo = {0.8, 0.02, 1.0, 1.0, 0.0};
    const std::array<vec3, 5> at = {{{5, 0, 0}, {-5, 0, 0}, {0, 5, 0}, {0, -5, 0}, {}}};
    for (const bool has_lamps : {false, true}) {
        Scene s;
        s.materials = {{Rough({0.8, 0.8, 0.8})},
                       {Rough({0.02, 0.02, 0.02})},
                       {Mirror({1, 1, 1})},
                       {Rough({}, half, 1000)},
                       {Rough(half)},
                       {}};
        // A lamp counts if it reflects, but not by its own light.
        const rgb dim = half * real(has_lamps ? 0.02 : 0);
        s.materials[1].Le = s.materials[3].Le = dim, s.materials[5].Le = dim;
        add_light(s, {{}, PointLight(), {1, 1, 1}});
        for (uint32_t k = 0; k < 5; ++k) add_sphere(s, at[k], 1, k);
        if (has_lamps) add_sphere(s, {0, 0, 999}, 1, 5);  // black
        prepare(s);
        const Aims aims(s);
        REQUIRE(aims.size() == 2 * 5);
        for (size_t k = 0; k < 5; ++k) {
            const double part = part_of_aims(aims, {0, 0, 99}, 20000,
                                             [&](const Aims::Aim& a) { return a.at / 2 == k; });
            CHECK(std::abs(part - 0.5 / 5 - 0.5 * albedo[k] / 2.82) < 0.02);
        }
    }
}

TEST_CASE("a small thing is not lost in a mesh of another material") {
    for (const bool is_last : {false, true}) {
        Scene s;
        s.materials = {{}, {}};
        if (!is_last) add_sphere(s, {0, 0, 9}, real(0.01), 1);
        for (int k = 0; k < 9000; ++k)
            add_triangle(s, {real(k), 0, 0}, {real(k) + real(0.1), 0, 0}, {real(k), real(0.1), 0},
                         0);
        if (is_last) add_sphere(s, {0, 0, 9}, real(0.01), 1);
        const Aims aims(s);
        CHECK(aims.size() == 64 + 2 * 33);
        const double part = part_of_aims(aims, {0, 0, 19}, 100000, [&](const Aims::Aim& aim) {
            return aim.at >= 64 && double(-aim.d.z) > 0.9999995;  // 0.01 at 10
        });
        CHECK(std::abs(part - 0.25 / 66 * (1 + 1 / 9.0)) < 0.0007);
    }
    // Many runs, each of its own, and 128 edges of them all.
    Scene s;
    s.materials = {{}, {}};
    for (int k = 0; k < 300; ++k)
        add_triangle(s, {real(k), 0, 0}, {real(k) + real(0.1), 0, 0}, {real(k), real(0.1), 0},
                     uint32_t(k % 2));
    CHECK(Aims(s).size() == 128 + 2 * 64);
}

TEST_CASE("aims are the edges of quads, without diagonals, and shapes, but for black lamps") {
    Scene s;
    s.materials = {{}, {}, {Mirror({1, 1, 1})}};
    s.materials[1].Le = {1, 1, 1};
    CHECK(Aims(s).size() == 0);
    add_sphere(s, {}, 1, 1);
    CHECK(Aims(s).size() == 0);
    add_sphere(s, {}, 1, 0);
    CHECK(Aims(s).size() == 2);
    add_quad(s, {2, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    const Aims aims(s);
    CHECK(aims.size() == 4 + 2 * 3);
    const vec3 y{real(2.5), real(0.5), 3};
    auto in_plane = [&](vec3 d) { return y - d * (3 / d.z) - vec3{2, 0, 0}; };
    auto is_in_quad = [&](vec3 d) {
        const vec3 p = in_plane(d);
        return d.z < 0 && p.x > real(1e-5) && p.x < real(0.99999) && p.y > real(1e-5) &&
               p.y < real(0.99999);
    };
    // Seen from before it, no direction beside an edge leads into the quad.
    CHECK(part_of_aims(aims, y, 4000,
                       [&](const Aims::Aim& a) { return a.at < 4 && is_in_quad(a.d); }) == 0);
    // Of every two aims at its triangles the second is three times as large: 4.5 for 0.5, of which
    // the quad has 1 - 1/18.
    auto at_triangle = [](const Aims::Aim& a, size_t size) {
        return a.at >= 6 && a.at % 2 == size;
    };
    CHECK(part_of_aims(aims, y, 4000, [&](const Aims::Aim& a) {
              return at_triangle(a, 0) && !is_in_quad(a.d);
          }) < 0.001);
    const double larger =
        part_of_aims(aims, y, 40000, [&](const Aims::Aim& a) { return at_triangle(a, 1); });
    const double around = part_of_aims(
        aims, y, 40000, [&](const Aims::Aim& a) { return at_triangle(a, 1) && !is_in_quad(a.d); });
    CHECK(std::abs(around / larger - (1 - (1 - 1 / 18.0) / 4.5)) < 0.05);
    CHECK(part_of_aims(aims, y, 4000, [&](const Aims::Aim& a) {
              const vec3 p = in_plane(a.d);
              const real off = std::max(std::abs(p.x - real(0.5)), std::abs(p.y - real(0.5)));
              return at_triangle(a, 1) && off > real(11.001) / 6;
          }) == 0);
    // Distances from edges: all octaves alike, from 2^-16 to 8.
    auto nearer_than = [&](double most) {
        return part_of_aims(aims, y, 20000,
                            [&](const Aims::Aim& a) {
                                if (a.at >= 4 || !(a.d.z < 0)) return false;
                                const vec3 p = in_plane(a.d);
                                const real h = std::max({-p.x, p.x - 1, -p.y, p.y - 1});
                                return double(h) < most;
                            }) /
               0.75;
    };
    CHECK(std::abs(nearer_than(0x1p-2) - 14 / 19.0) < 0.03);
    CHECK(std::abs(nearer_than(0x1p-12) - 4 / 19.0) < 0.03);
    CHECK(nearer_than(0x1p-17) == 0);
    // An edge of two triangles counts once, whichever way it leads.
    add_quad(s, {3, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    CHECK(Aims(s).size() == 7 + 2 * 5);
    // Gaps are beside lamps, too.
    add_quad(s, {5, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
    CHECK(Aims(s).size() == 7 + 4 + 2 * 5);
}

TEST_CASE("an eye has views in mirrors and panes, and in lists of which each can show the next") {
    Scene s;
    s.materials = {{}, {}, {Mirror({1, 1, 1})}};
    s.materials[1].Le = {1, 1, 1};
    s.camera = look_at({0, 0, 1}, {0, 0, 0}, 40);
    add_sphere(s, {5, 0, 0}, 1, 1);
    for (int i = 0; i < 4; ++i) add_quad(s, {0, 0, real(-i)}, {1, 0, 0}, {0, 1, 0}, 2);
    auto views = [&] {
        prepare(s);
        const Aims aims = Aims(s).of_eye(s);
        return aims.view_of(aims.size() - 1) + 1;
    };
    // Each shows those before it, and there one those behind it.
    const size_t all = 1 + 4 + 6 + (9 + 4 + 1);
    CHECK(views() == all);
    s.materials[2] = {Glass(real(1.5))};
    CHECK(views() == all);
    // Whichever half of a quad reflects; not from a shape that is none, or in more than three.
    const Aims aims = Aims(s).of_eye(s);
    for (const size_t shape : {size_t(3), size_t(4)}) {
        const auto view = aims.in_mirror(0, shape);
        REQUIRE(view);
        CHECK(*view == 2);
        CHECK(!aims.in_mirror(*view, shape));
        CHECK(!aims.in_mirror(*view, 5));
        const auto both = aims.in_mirror(*view, 1);
        REQUIRE(both);
        CHECK(*both > 4);
        const auto three = aims.in_mirror(*both, 3);
        REQUIRE(three);
        CHECK(*three > 10);
        CHECK(!aims.in_mirror(*three, 1));
    }
    CHECK(!aims.in_mirror(0, 0));
    s.materials[2] = {};
    CHECK(views() == 1);
    // Quads that are bent have two planes.
    s.materials[2] = {Mirror({1, 1, 1})};
    s.shapes.resize(3), s.material_of.resize(3), s.light_of.resize(3);
    CHECK(views() == 1 + 1);
    s.shapes[2].c.z += real(0.01);  // a valley: each half shows the other
    CHECK(views() == 1 + 2 + 2);
    s.shapes[2].c.z -= real(0.02);  // a ridge
    CHECK(views() == 1 + 2);
}

TEST_CASE("directions of each view come with their density, and a mirror shows what is before it") {
    Scene s;
    s.materials = {{}, {}, {Mirror({1, 1, 1})}};
    s.materials[1].Le = {1, 1, 1};
    s.camera = look_at({real(0.5), real(0.4), real(0.4)}, {1, 0, 0}, 40);
    add_sphere(s, {real(1.5), 1, 1}, real(0.3), 1);
    add_sphere(s, {1, real(0.5), 1}, real(0.2), 0);
    add_quad(s, {2, 0, 0}, {0, real(0.7), 0}, {0, real(0.1), 1}, 2);
    add_quad(s, {0, 0, 0}, {1, 0, real(0.1)}, {0, 1, 0}, 2);
    prepare(s);
    Aims aims = Aims(s).of_eye(s);
    const size_t all = aims.size(), views = aims.view_of(all - 1) + 1;
    REQUIRE(views == 7);
    std::vector<double> worth(all);
    for (size_t i = 0; i < all; ++i) worth[i] = double(i % 3);
    const vec3 y = s.camera.eye;
    oracle::Random random(seed_here());
    auto u2 = [&] {
        const real x = real(random());
        return vec2{x, real(random())};
    };
    const double q = 1 / (4 * std::numbers::pi);
    for (const bool is_learned : {false, true}) {
        if (is_learned) aims.prefer(worth);
        for (size_t view = 0; view < views; ++view) {
            auto first = [&] {
                const real u = real(random());
                const auto aim = aims.sample(y, u, u2());
                const bool is_of_view = aim && aims.view_of(aim->at) == view;
                return is_of_view ? q / (q + double(aims.pdf(y, aim->d, view))) : 0;
            };
            auto second = [&] {
                const double p = double(aims.pdf(y, sample_uniform_sphere(u2()), view));
                return p / (p + q);
            };
            INFO(view);
            EXPECT(oracle::expect_equal(first, second, 280000), 0.1);
        }
    }
    // The lamp, from the eye's images: nearly a third of the directions of a view meet it.
    auto reflect = [&](vec3 p, size_t shape) {
        const vec3 n = unit(area_vector(s.shapes[shape]));
        return p - n * (2 * dot(n, p - s.shapes[shape].a));
    };
    const Aims untaught = Aims(s).of_eye(s);
    auto turn = [&](vec3 d, size_t shape) { return reflect(d, shape) - reflect({}, shape); };
    const size_t both = *untaught.in_mirror(*untaught.in_mirror(0, 2), 4);
    const vec3 image = reflect(reflect(y, 2), 4);
    int of_view = 0, at_lamp = 0;
    part_of_aims(untaught, y, 40000, [&](const Aims::Aim& aim) {
        const vec3 d = turn(turn(aim.d, 2), 4), to = vec3{real(1.5), 1, 1} - image;
        of_view += untaught.view_of(aim.at) == both;
        at_lamp += untaught.view_of(aim.at) == both && length(cross(to, d)) < real(0.3);
        return true;
    });
    CHECK(of_view > 2000);
    CHECK(at_lamp > 0.3 * of_view);
    CHECK(at_lamp < 0.5 * of_view);
}

TEST_CASE("about a corner all octaves of the tangent are alike, and come with their density") {
    const CornerAim corner{{1, 2, 3}};
    const vec3 y{real(0.5), 0, 1}, to = unit(corner.p - y), across = frame(to).to_world({1, 0, 0});
    for (const double u : {0.01, 0.3, 0.55, 0.99}) {
        const vec3 d = *corner.toward(y, {real(0.2), real(u)});
        const double h = double(length(cross(to, d)) / dot(to, d));
        CHECK(h == doctest::Approx(std::pow(0.5, 19 * (1 - u))).epsilon(u < 0.1 ? 0.1 : 1e-3));
    }
    // The density over a ring of two octaves, by the midpoint rule in log h.
    for (const double from : {-16.0, -6.0, -2.0}) {
        double sum = 0;
        for (int k = 0; k < 1000; ++k) {
            const double h = std::pow(2, from + (k + 0.5) * 2 / 1000), angle = std::atan(h);
            const double step = h / (1 + h * h) * 2 / 1000 * std::numbers::ln2;
            sum += double(corner.pdf(y, unit(to + real(h) * across))) * 2 * std::numbers::pi *
                   std::sin(angle) * step;
        }
        CHECK(sum == doctest::Approx(2 / 19.0).epsilon(sizeof(real) == 4 ? 0.01 : 1e-4));
    }
    CHECK(corner.pdf(y, -to) == 0);
    CHECK(corner.pdf(y, unit(to + real(1.1) * across)) == 0);
}

TEST_CASE("an eye aims at corners of gaps: where it sees edges cross, and nothing before them") {
    // A slit of 1 mm, and behind it one across; the eye sees a square of 1 mm.
    auto part = [](bool is_hidden) {
        Scene s;
        s.materials = {{}};
        s.camera = look_at({0, 0, 5}, {}, 40);
        const real h = real(0.001);
        add_quad(s, {h, -20, 0}, {30, 0, 0}, {0, 40, 0}, 0);
        add_quad(s, {-30, -20, 0}, {30, 0, 0}, {0, 40, 0}, 0);
        add_quad(s, {-30, h, real(-0.01)}, {60, 0, 0}, {0, 10, 0}, 0);
        add_quad(s, {-30, -10, real(-0.01)}, {60, 0, 0}, {0, 10, 0}, 0);
        if (is_hidden) add_quad(s, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, 0);
        prepare(s);
        const Aims aims = Aims(s).of_eye(s);
        return part_of_aims(aims, s.camera.eye, 40000, [&](const Aims::Aim& aim) {
            const vec3 p = s.camera.eye - aim.d * (5 / aim.d.z);
            return aim.d.z < 0 && p.x > 0 && p.x < h && p.y > 0 && p.y < h;
        });
    };
    CHECK(part(false) > 0.003);
    CHECK(part(true) < 0.0003);
}

TEST_CASE(
    "corners are where an eye sees outlines cross: of edges, of balls, of a ball and an edge") {
    struct Ball {
        vec3 p;
        real r;
    };
    const vec3 eye{0, 0, 5};
    auto scene_of = [&](const std::vector<Ball>& balls) {
        Scene s;
        s.materials = {{}};
        s.camera = look_at(eye, {}, 40);
        for (const auto& [p, r] : balls) add_sphere(s, p, r, 0);
        return s;
    };
    auto corners = [](Scene s) {
        prepare(s);
        const Aims aims(s);
        return aims.of_eye(s).size() - aims.size();
    };
    const Ball a{{0, 0, 0}, 1}, b{{real(1.5), 0, -1}, 1};
    CHECK(corners(scene_of({a, b})) == 2);
    CHECK(corners(scene_of({a, {{3, 0, 0}, 1}})) == 0);          // beside each other
    CHECK(corners(scene_of({a, {{0, 0, 2}, real(0.2)}})) == 0);  // one before the other
    CHECK(corners(scene_of({a, {{0, 0, -2}, 1}})) == 0);
    CHECK(corners(scene_of({a, b, {{0, 0, 5}, 2}})) == 0);  // the eye is in one, which hides all
    // A ball before one of the crossings, and its own with one ball or the other.
    const real x = real(0.82), y = real(0.61);  // near a crossing, at the distance of a
    CHECK(corners(scene_of({a, b, {{x / 2, y / 2, real(2.5)}, real(0.05)}})) == 1 + 4);
    // Edges of a quad meet; its left edge is before the ball, or too short, or ends at its side.
    auto with_quad = [&](vec3 from, real width, real height) {
        Scene s = scene_of({a});
        add_quad(s, from, {width, 0, 0}, {0, height, 0}, 0);
        return corners(s);
    };
    CHECK(with_quad({0, -5, 2}, 9, 10) == 2);
    CHECK(with_quad({0, -5, -2}, 9, 10) == 2);
    CHECK(with_quad({0, 0, 2}, 9, 10) == 1 + 1);  // by its lower edge, too
    CHECK(with_quad({0, real(-0.1), 2}, real(0.2), real(0.2)) == 0);
    CHECK(with_quad({9, -5, 2}, 9, 10) == 0);
    CHECK(with_quad({0, 4, 2}, 9, 10) == 0);
    CHECK(with_quad({0, -5, 10}, 9, 10) == 0);  // behind the eye
    // Edges in one plane meet.
    for (const real before : {real(0), real(0.1)}) {
        Scene s = scene_of({});
        add_quad(s, {-1, -3, 0}, {2, 0, 0}, {0, 6, 0}, 0);
        add_quad(s, {-3, -1, before}, {6, 0, 0}, {0, 2, 0}, 0);
        CHECK(corners(s) == (before > 0 ? 4 : 0));
    }
    // Aims are about the points themselves, on both sides: nine of 19 octaves of the half that are
    // no shapes have tangents below 2^-10.
    Scene s = scene_of({a, b});
    prepare(s);
    const Aims aims = Aims(s).of_eye(s);
    auto on_outline = [&](const Ball& ball, vec3 d) {
        const vec3 to = ball.p - eye;
        const double sine = double(length(cross(unit(to), d)));
        return std::abs(std::asin(sine) - std::asin(double(ball.r / length(to)))) < 0x1p-10;
    };
    for (const real side : {-1, 1})
        CHECK(std::abs(part_of_aims(aims, eye, 40000,
                                    [&](const Aims::Aim& aim) {
                                        return on_outline(a, aim.d) && on_outline(b, aim.d) &&
                                               aim.d.y * side > 0;
                                    }) -
                       0.25 * 9 / 19) < 0.01);
}

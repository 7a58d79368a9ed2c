// radiosity/walks_test.cpp  particle runs end when their error is as requested, and no later
#include "radiosity/walks.h"

#include "base/moments.h"
#include "oracle/expect.h"
#include "radiosity/rooms.h"
#include "text/complaint.h"

using namespace rooms;

namespace {

CommonOptions quietly(unsigned threads = 1) {
    CommonOptions o;
    o.quiet = true, o.threads = threads;
    return o;
}

Walked walk_to(const Meshed& m, const WalksTarget& target, uint64_t seed,
               SamplerKind kind = SamplerKind::halton) {
    const SamplerSettings settings = Particles::settings(kind, hash(seed_here(), seed));
    return walk_all(m.scene, m.mesh, settings, target, quietly());
}

constexpr uint64_t first_look = ErrorTarget::least * Particles::batches;

}  // namespace

TEST_CASE(
    "an error is met with its uncertainty on top; the next look is where 1 / sqrt(n) meets it") {
    const ErrorTarget target(0.1);
    CHECK(target.met({0.09, 0.006}));
    CHECK_FALSE(target.met({0.09, 0.007}));
    CHECK_FALSE(target.met({}));
    CHECK_FALSE(target.met({INFINITY, INFINITY}));
    CHECK_FALSE(target.met({0.01, NAN}));
    CHECK(target.met({0, 0}));
    CHECK(target.done({0.185, 0.01}) == doctest::Approx(0.25));
    CHECK(target.done({INFINITY, INFINITY}) == 0);
    CHECK(target.next(1000, {0.12, 0.02}) == 2025);  // 0.9 of 2.25 times as many
    CHECK(target.next(1000, {0.101, 0}) == 1040);
    CHECK(target.next(1000, {0.9, 0.1}) == 4000);
    CHECK(target.next(1000, {}) == 4000);
}

TEST_CASE("--error: the error at the stop is the stated one, which is at most what was asked for") {
    const Meshed m(furnace(), 0.6);
    constexpr double asked = 0.025;
    Moments actual, stated;
    for (uint64_t r = 0; r < 20; ++r) {
        const Walked w = walk_to(m, {0, 0, asked}, r);
        CHECK(w.particles > 1.5 * first_look);
        CHECK(w.stated.error + 1.5 * w.stated.uncertainty <= asked);
        CHECK(w.stated.error > 0.93 * asked);
        actual.add(furnace_error2(m.mesh, w.map)), stated.add(w.stated.error * w.stated.error);
    }
    EXPECT(oracle::expect_equal(estimate(actual), estimate(stated)), 0.25);
}

TEST_CASE("--error: particles, seconds and the first look are limits") {
    const Meshed m(furnace(), 2.2);
    for (SamplerKind kind : all_samplers) {
        CHECK(walk_to(m, {0, 0, 0.9}, 1, kind).particles == first_look);
        CHECK(walk_to(m, {1600, 0, 0.9}, 1, kind).particles == 1600);
        CHECK(walk_to(m, {100000, 0, 1e-9}, 1, kind).particles == 100000);
        const Walked w = walk_to(m, {0, 0.05, 1e-9}, 1, kind);
        CHECK(w.particles > 0);
        CHECK(w.seconds >= 0.05 * 0.5);
        CHECK(w.stated.error > 1e-9);
    }
}

TEST_CASE("passes are of 256 particles of each batch, until a limit or the time ends them") {
    const Meshed m(furnace(), 1);
    constexpr uint64_t pass = 256 * Particles::batches;
    for (SamplerKind kind : all_samplers) {
        const struct {
            WalksTarget target;
            uint64_t particles;
        } rows[] = {{{0, 1e-9, 0}, pass},
                    {{0, 1e-9, 1e-9}, pass},
                    {{0, 1e-9, 0.9}, pass},
                    {{1600, 1e-9, 0}, 1600},
                    {{pass - 1, 0, 0}, pass},
                    {{pass + 1, 0, 0}, pass + 16},
                    {{100000, 1e9, 0}, 100000},
                    {{1, 0, 0}, 16},
                    {{100000, 1e-9, 1e-9}, pass},
                    {{100000, 1e9, 1e-9}, 100000},
                    {{first_look, 0, 0.9}, first_look},
                    {{first_look + 1, 0, 0.9}, first_look}};
        for (const auto& row : rows) {
            INFO(row.target.particles, " ", row.target.seconds, " ", row.target.error);
            CHECK(walk_to(m, row.target, 1, kind).particles == row.particles);
        }
        // Time makes no other map than as many particles.
        const Walked timed = walk_to(m, {0, 0.03, 0}, 1, kind);
        CHECK(timed.particles % pass == 0);
        CHECK(timed.seconds >= 0.03);
        CHECK(timed.seconds < 3);
        CHECK(walk_to(m, {timed.particles, 0, 0}, 1, kind).map == timed.map);
    }
}

TEST_CASE("--error alone: where no particle loses light the run ends with a message") {
    const vec3 size{2, 3, 1};
    const rgb glow{1, 1, 1};
    const Scene white = room(size, diffuse({0.5, 1, 0.7}, glow)),
                red_and_blue = room(size, diffuse({0.5, 1, 0.7}, {1, 0, 1}));
    const Material shining = diffuse(grey(1), glow);
    const Scene open = scene_of_quads(
        {{{}, {1, 0, 0}, {0, 1, 0}, shining}, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, shining}});
    Scene absorbs;  // one wall of two
    add(absorbs, shining), add(absorbs, diffuse(grey(0.5), glow));
    add_room(absorbs, size, 0, 2);
    prepare(absorbs);
    const std::string message = "--error: none of " + std::to_string(first_look) +
                                " particles lost light in some channel: its light never ends";
    const struct {
        Scene scene;
        WalksTarget target;
        std::string message;
    } rows[] = {{white, {0, 0, 0.01}, message}, {white, {1600, 0, 0.01}, ""},
                {white, {0, 0.05, 0.01}, ""},   {red_and_blue, {0, 0, 0.05}, ""},
                {absorbs, {0, 0, 0.05}, ""},    {open, {0, 0, 0.003}, ""}};
    for (const auto& row : rows) {
        CAPTURE(&row - rows);
        const Meshed m(row.scene, 2.2);
        const std::string found = ::complaint([&] { walk_to(m, row.target, 1); });
        CHECK(found.substr(0, message.size()) == row.message);
    }
}

TEST_CASE("--error: the run is the same for any number of threads, and that of as many particles") {
    const Meshed m(furnace(), 1);
    const SamplerSettings settings = Particles::settings(SamplerKind::halton, 1);
    auto walk = [&](const WalksTarget& target, unsigned threads) {
        return walk_all(m.scene, m.mesh, settings, target, quietly(threads));
    };
    const Walked one = walk({0, 0, 0.015}, 1);
    CHECK(one.particles > first_look);
    CHECK(walk({0, 0, 0.015}, 3).map == one.map);
    CHECK(walk({one.particles, 0, 0}, 2).map == one.map);
}

TEST_CASE("--error: light that is rare but bright is seen before the run may end") {
    // A lamp of 1/1000 of the power beside an equally small plate, which has most of |E|^2.
    Scene s = room(grey(10), diffuse(grey(0.5)));
    const uint32_t black = add(s, diffuse(grey(0)));
    add_quad(s, {4, real(9.9), 4}, {1, 0, 0}, {0, 0, 1}, add(s, diffuse(grey(0), grey(1))));
    const real a = real(0.004), near = 5;
    add_quad(s, {near, near, near}, {a, 0, 0}, {0, 0, a},
             add(s, diffuse(grey(0), grey(1e-3 / (0.004 * 0.004)))));
    add_quad(s, {near, near - a, near}, {0, 0, a}, {a, 0, 0}, black);
    prepare(s);
    const Meshed m(s, 3);
    const Face& plate = m.mesh.faces.back();
    REQUIRE(plate.vertices() == 4);
    for (uint64_t r = 0; r < 12; ++r) {
        const Walked w = walk_to(m, {0, 0, 0.3}, r);
        CHECK(double(integral(m.mesh, w.map, plate, false).x) > 0);
        CHECK(w.stated.error <= 0.3);
    }
}

TEST_CASE("no light, no error: nothing walks") {
    const Walked w = walk_to(Meshed(room({1, 1, 1}, diffuse(grey(0.5))), 2), {0, 0, 0.1}, 1);
    CHECK(w.particles == 0);
    CHECK(std::isnan(w.stated.error));
}

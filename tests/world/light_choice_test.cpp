// world/light_choice_test.cpp  the choice of one light for a sample
#include "world/light_choice.h"

#include "base/approx.h"
#include "oracle/expect.h"
#include "world/geometry.h"
#include "world/scene.h"

namespace {

Light shining(Light l, real L, bool twosided = false) {
    l.L = {L / 2, L, 3 * L / 2};
    l.twosided = twosided;
    return l;
}

// A light of the given kind near the origin, of size r.
Light light_of(Dice& dice, Light::Kind kind, real r) {
    const vec3 p = dice.direction(r), u = dice.direction(r), v = dice.direction(r * dice(0.5, 2));
    const real L = dice.decades(-2, 2);
    const bool twosided = dice.below(2);
    if (kind == Light::Kind::point) return shining(point_light(p, {}), L);
    if (kind == Light::Kind::sphere) return shining(sphere_light(p, r), L);
    if (kind == Light::Kind::quad) return shining(quad_light(p, u, v), L, twosided);
    return shining(triangle_light(p, u, v), L, twosided);
}
Light light_of(Dice& dice, real r) { return light_of(dice, Light::Kind(dice.below(4)), r); }

// A scene with only these lights.
Scene scene_of(const std::vector<Light>& lights) {
    Scene s;
    s.lights = lights;
    prepare(s);
    return s;
}

// Irradiance by one light sample; light from below the horizon counts as 0.
real sends(const Light& l, vec3 p, vec3 m, vec2 u) {
    const auto s = sample_light(l, p, u);
    return s ? std::max(real(0), dot(s->wi, m)) * mean_of(s->L) / s->pdf : 0;
}

}  // namespace

TEST_CASE("one of a few lights is chosen as often as is said") {
    Dice dice;
    for (size_t n : {2u, 4u, 5u, 6u})
        for (int place = 0; place < 4; ++place) {
            std::vector<Light> lights;
            for (size_t i = 0; i < n; ++i) lights.push_back(light_of(dice, real(0.5)));
            const Scene s = scene_of(lights);
            const vec3 p = dice.direction(dice(0, 3)), m = dice.direction();
            if (!light_weights(s.lights, p, m)) continue;
            for (real u : {real(0), dice(0, 1), below_one}) {
                const LightPick chosen = choose_light(s, p, m, u);
                REQUIRE(chosen.light < n);
                CHECK(chosen.pick > 0);
                CHECK(chosen.pick == pick_of(s, chosen.light, p, m));
            }
            oracle::Random random(seed_here());
            EXPECT(oracle::expect_choice(
                       random, [&](real u) { return choose_light(s, p, m, u).light; },
                       [&](int i) { return pick_of(s, size_t(i), p, m); }, n),
                   0.05);
        }
}

TEST_CASE("a light weighs nothing only where it sends nothing") {
    Dice dice;
    int sent = 0, lost = 0, below = 0, behind = 0, wasted = 0, beyond = 0;
    for (int i = 0; i < 40000; ++i) {
        const real r = dice.decades(-1, 1);
        const std::vector<Light> lights{light_of(dice, r), shining(point_light({}, {}), 1)};
        const vec3 p = dice.direction(dice(0, 4)), m = dice.direction();
        const Light first = scene_of(lights).lights[0];
        const real weighs = light_weight(first, p, m);
        for (const vec3 corner : {first.p, first.p + first.u, first.p + first.v})
            beyond += length(corner - first.centre) > first.reach * (1 + 8 * ulp);
        real E = 0;
        for (int k = 0; k < 8; ++k) E += sends(lights[0], p, m, dice.pair());
        // The bound is the rounding error of a cosine near 0.
        const bool sends_some = E > 64 * ulp * power(lights[0]);
        sent += sends_some;
        lost += sends_some && !(weighs > 0);
        // The whole light lies below the horizon, or it faces away.
        const bool is_below = dot(m, first.centre - p) < -first.reach - 64 * ulp;
        const bool is_behind = lights[0].n != vec3{} && !lights[0].twosided &&
                               dot(lights[0].n, p - lights[0].p) < -64 * ulp * r;
        below += is_below, behind += is_behind;
        wasted += (is_below || is_behind) && weighs > 0;
    }
    CHECK(sent > 10000);
    CHECK(lost == 0);
    CHECK(below > 2000);
    CHECK(behind > 2000);
    CHECK(wasted == 0);
    CHECK(beyond == 0);
}

TEST_CASE("far away, lights weigh what they send") {
    Dice dice;
    constexpr real far = single ? 300 : 3000;
    Worst worst;
    int seen = 0;
    for (int i = 0; i < 40000; ++i) {
        const vec3 p = dice.direction(), m = dice.direction();
        std::vector<Light> lights;
        real E[2];
        bool grazing = false;
        for (size_t k : {0u, 1u}) {
            const vec3 to = dice.direction(far * dice(1, 10));
            Light l = light_of(dice, 1);
            l.p = p + to + l.p;
            lights.push_back(l);
            E[k] = sends(l, p, m, {real(0.5), real(0.5)});
            grazing |= dot(m, unit(to)) < real(0.25);
            grazing |= l.n != vec3{} && std::abs(dot(l.n, unit(to))) < real(0.25);
        }
        if (grazing || !(E[0] > 0 && E[1] > 0)) continue;
        const std::vector<Light> both = scene_of(lights).lights;
        const real w = light_weight(both[0], p, m) / light_weight(both[1], p, m);
        worst.see(std::abs(w * (E[1] / E[0]) - 1));
        ++seen;
    }
    CHECK(seen > 2000);
    CHECK(worst.value < 32 / far);  // cosines are 1/4 or more; radii of at most 1 move them
}

TEST_CASE("the sphere about a polygon holds its corners, and touches two of a quad's") {
    Dice dice;
    for (int i = 0; i < 2000; ++i) {
        const Light::Kind kind = i % 2 ? Light::Kind::quad : Light::Kind::triangle;
        const Light l = scene_of({light_of(dice, kind, 1)}).lights[0];
        real most = 0;
        for (vec3 corner : {l.p, l.p + l.u, l.p + l.v, l.p + l.u + l.v})
            if (i % 2 || corner != l.p + l.u + l.v)
                most = std::max(most, length(corner - l.centre));
        CHECK(std::abs(most - l.reach) < 16 * ulp);
    }
}

TEST_CASE("near or far, strong or faint: probabilities add up to 1") {
    Dice dice;
    constexpr real range = single ? 8 : 70;
    for (int i = 0; i < 20000; ++i) {
        std::vector<Light> lights;
        for (int k = 0; k < 4; ++k) {
            lights.push_back(light_of(dice, dice.decades(-range, range) / 8));
            lights.back().L = lights.back().L * dice.decades(-range / 4, range / 4);
        }
        const Scene s = scene_of(lights);
        const vec3 p = dice.below(8) ? dice.direction(dice.decades(-range, range)) : lights[0].p;
        const vec3 m = dice.direction();
        if (!light_weights(s.lights, p, m)) continue;
        real sum = 0;
        for (size_t k = 0; k < 4; ++k) sum += pick_of(s, k, p, m);
        REQUIRE(std::abs(sum - 1) < 8 * ulp);
    }
    // The point coincides with a light, or the square of a distance is infinite.
    const Scene s =
        scene_of({shining(point_light({}, {}), 1), shining(sphere_light({1, 0, 0}, real(0.5)), 1)});
    CHECK(light_weights(s.lights, {}, {1, 0, 0}));
    const real beyond = std::numeric_limits<real>::max() / 4;
    CHECK(!light_weights(s.lights, {beyond, 0, 0}, {0, 1, 0}));
}

TEST_CASE("a scene chooses by place if lights are few and of use, otherwise by power") {
    Scene s;
    Material lamp;
    lamp.Le = {1, 1, 1};
    s.materials.push_back(lamp);
    add_sphere(s, {0, 0, 0}, 1, 0);
    prepare(s);
    const vec3 p{1, 2, 3}, up{0, 1, 0}, down{0, -1, 0};
    CHECK(pick_of(s, 0, p, up) == 1);
    for (size_t n = 2; n <= most_weighed + 1; ++n) {
        s.pick_cdf.clear();
        add_sphere(s, {real(n) * 4, real(n), 0}, real(1) / real(n), 0);
        prepare(s);
        bool differs = false;
        for (int i = 0; i < 100; ++i) {
            const real u = (real(i) + real(0.5)) / 100;
            const LightPick by_place = choose_light(s, p, down, u);
            CHECK(by_place.pick == pick_of(s, by_place.light, p, down));
            const Light& by_power = choose_light(s, u);
            differs |= &s.lights[by_place.light] != &by_power;
            // At this point all lights are below the horizon.
            const LightPick blind = choose_light(s, {0, 99, 0}, up, u);
            CHECK(&s.lights[blind.light] == &by_power);
            CHECK(blind.pick == by_power.pick);
            CHECK(blind.pick == pick_of(s, blind.light, {0, 99, 0}, up));
        }
        CHECK(differs == (n <= most_weighed));
    }
}

TEST_CASE("where what shines is so faint that sums of it are denormal, power decides") {
    // The strong light is below the horizon.
    Scene s =
        scene_of({shining(sphere_light({0, -5, 0}, 1), 1), shining(sphere_light({0, 5, 0}, 1), 1)});
    s.lights[1].strength = std::numeric_limits<real>::denorm_min() * 100;
    CHECK_FALSE(light_weights(s.lights, {}, {0, 1, 0}));
    s.lights[1].strength = std::numeric_limits<real>::min() * 1000;
    REQUIRE(light_weights(s.lights, {}, {0, 1, 0}));
    for (real u : {real(0), below_one}) CHECK(choose_light(s, {}, {0, 1, 0}, u).light == 1);
    // A light keeps a weight even where its share of the sum underflows.
    s = scene_of({shining(sphere_light({0, -5, 0}, 1), real(1e30)),
                  shining(point_light({0, real(0.5), 0}, {}), std::numeric_limits<real>::min())});
    for (real u : {real(0), below_one}) CHECK(choose_light(s, {}, {0, 1, 0}, u).light == 1);
}

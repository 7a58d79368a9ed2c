// world/light_cases.h  the cases that test every choice of one light
//
//     TEST_CASE_TEMPLATE_INVOKE(one_of_many, LightList);
#pragma once
#include "base/approx.h"
#include "oracle/expect.h"
#include "world/geometry.h"
#include "world/light_choice.h"

inline Light shining(Light l, real L, bool twosided = false) {
    l.L = {L / 2, L, 3 * L / 2};
    l.twosided = twosided;
    return l;
}

// A light near the origin, of size r: a point, a sphere, a quad, a triangle.
inline Light light_of(Dice& dice, size_t kind, real r) {
    const vec3 p = dice.direction(r), u = dice.direction(r), v = dice.direction(r * dice(0.5, 2));
    const real L = dice.decades(-2, 2);
    const bool twosided = dice.below(2);
    if (kind == 0) return shining(Light(p, PointLight()), L);
    if (kind == 1) return shining(Light(p, SphereLight{r}), L);
    if (kind == 2) return shining(Light(p, QuadLight{u, v}), L, twosided);
    return shining(Light(p, TriangleLight{u, v}), L, twosided);
}
inline Light light_of(Dice& dice, real r) { return light_of(dice, dice.below(4), r); }

// Irradiance by one light sample; light from below the horizon counts as 0.
inline real sends(const Light& l, vec3 p, vec3 m, vec2 u) {
    const auto s = sample_light(l, p, u);
    return s ? std::max(real(0), dot(s->wi, m)) * mean_of(s->L) / s->pdf : 0;
}

inline std::vector<Light> lights_of(Dice& dice, size_t n, real r) {
    std::vector<Light> lights;
    for (size_t i = 0; i < n; ++i) {
        const vec3 move = dice.direction(dice(0, 3));
        Light l = light_of(dice, r);
        l.p += move, l.centre += move;
        lights.push_back(l);
    }
    return lights;
}

template <class Choice>
Choice choice_of(const std::vector<Light>& lights) {
    return {lights, intensities_of(lights)};
}

TEST_CASE_TEMPLATE_DEFINE("one of many lights is chosen as often as is said", Choice, one_of_many) {
    Dice dice;
    for (size_t n : {2u, 5u, 8u, 9u, 30u})
        for (int place = 0; place < 4; ++place) {
            const Choice choice = choice_of<Choice>(lights_of(dice, n, real(0.5)));
            const vec3 p = dice.direction(dice(0, 3)), m = dice.direction();
            for (real u : {real(0), dice(0, 1), below_one}) {
                const auto chosen = choice.choose(p, m, u);
                REQUIRE(chosen.light < n);
                CHECK(chosen.probability > 0);
                CHECK(chosen.probability == choice.probability_of(chosen.light, p, m));
            }
            oracle::Random random(seed_here());
            EXPECT(oracle::expect_choice(
                       random, [&](real u) { return choice.choose(p, m, u).light; },
                       [&](int i) { return choice.probability_of(size_t(i), p, m); }, n),
                   0.05);
        }
}

TEST_CASE_TEMPLATE_DEFINE("one light is chosen always", Choice, one_light) {
    const Choice choice = choice_of<Choice>({shining(Light({0, 5, 0}, SphereLight{1}), 1)});
    CHECK(choice.choose({}, {0, 1, 0}, real(0.5)).light == 0);
    CHECK(choice.choose({}, {0, 1, 0}, real(0.5)).probability == 1);
    CHECK(choice.probability_of(0, {}, {0, -1, 0}) == 1);
}

TEST_CASE_TEMPLATE_DEFINE("a light is never chosen only where it sends nothing", Choice,
                          only_where_nothing) {
    Dice dice;
    int sent = 0, lost = 0, below = 0, behind = 0, wasted = 0, beyond = 0;
    for (int i = 0; i < 40000; ++i) {
        const real r = dice.decades(-1, 1);
        std::vector<Light> lights{light_of(dice, r)};
        // Others, of which one always contributes; with seven or more there are groups of groups.
        const size_t others = i % 4 ? 1 : 12;
        const vec3 p = dice.direction(dice(0, 4)), m = dice.direction();
        lights.push_back(shining(Light(p + m, PointLight()), 1));
        while (lights.size() <= others) lights.push_back(light_of(dice, r));
        const Light& first = lights[0];
        const real probability = choice_of<Choice>(lights).probability_of(0, p, m);
        for (const vec3 corner : corners_of(first))
            beyond += length(corner - first.centre) > first.radius * (1 + 8 * ulp);
        real E = 0;
        for (int k = 0; k < 8; ++k) E += sends(first, p, m, dice.pair());
        // The bound is the rounding error of a cosine near 0.
        const bool sends_some = E > 256 * ulp * intensity(first, std::numbers::pi);
        sent += sends_some;
        lost += sends_some && !(probability > 0);
        // The whole light lies below the horizon, or it faces away.
        const bool is_below = dot(m, first.centre - p) < -first.radius - 64 * ulp;
        const bool is_behind =
            first.n != vec3{} && !first.twosided && dot(first.n, p - first.p) < -64 * ulp * r;
        below += is_below, behind += is_behind;
        wasted += others == 1 && (is_below || is_behind) && probability > 0;
    }
    CHECK(sent > 10000);
    CHECK(lost == 0);
    CHECK(below > 2000);
    CHECK(behind > 2000);
    CHECK(wasted == 0);
    CHECK(beyond == 0);
}

TEST_CASE_TEMPLATE_DEFINE("far away, lights are chosen by what they send, but for the even part",
                          Choice, far_away) {
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
            l.p += p + to, l.centre += p + to;
            lights.push_back(l);
            E[k] = sends(l, p, m, {real(0.5), real(0.5)});
            grazing |= dot(m, unit(to)) < real(0.25);
            grazing |= l.n != vec3{} && std::abs(dot(l.n, unit(to))) < real(0.25);
        }
        if (grazing || !(E[0] > 0 && E[1] > 0)) continue;
        const Choice choice = choice_of<Choice>(lights);
        const real a = choice.probability_of(0, p, m), b = choice.probability_of(1, p, m);
        CHECK(std::min(a, b) >= even_part / 2);
        if (std::min(a, b) < real(0.1)) continue;  // rounding would count
        worst.see(std::abs((a - even_part / 2) / (b - even_part / 2) * (E[1] / E[0]) - 1));
        ++seen;
    }
    CHECK(seen > 1000);
    CHECK(worst.value < 64 / far);  // cosines are 1/4 or more; radii of at most 1 move them
}

TEST_CASE_TEMPLATE_DEFINE("of many lamps, those that send most are chosen most", Choice,
                          most_by_most) {
    // Means of the relative variance of E_i / p_i, over that of equal shares.  In the second
    // scene lamps stand in rooms, a hundred metres apart.
    Dice dice;
    for (const bool in_rooms : {false, true}) {
        double of_choice = 0, of_even = 0;
        for (int i = 0; i < 40; ++i) {
            const size_t n = 300;
            std::vector<Light> lights = lights_of(dice, n, real(0.1));
            for (size_t k = 0; in_rooms && k < n; ++k) {
                const vec3 room{100 * real(k % 30), 0, 0};
                lights[k].p += room, lights[k].centre += room;
            }
            const Choice choice = choice_of<Choice>(lights);
            const vec3 p = dice.direction(dice(0, 3)), m = dice.direction();
            double all = 0, of_this = 0, of_equal = 0;
            for (size_t k = 0; k < n; ++k) {
                const double E = double(sends(lights[k], p, m, {real(0.5), real(0.5)}));
                all += E, of_equal += E * E * double(n);
                if (E > 0) of_this += E * E / double(choice.probability_of(k, p, m));
            }
            if (all == 0) continue;
            of_choice += of_this / (all * all) - 1, of_even += of_equal / (all * all) - 1;
        }
        CHECK(of_choice < of_even / 6);
    }
}

TEST_CASE_TEMPLATE_DEFINE("near or far, strong or faint, few or many: probabilities add up to 1",
                          Choice, up_to_one) {
    Dice dice;
    constexpr real range = single ? 8 : 70;
    for (int i = 0; i < 20000; ++i) {
        std::vector<Light> lights;
        const size_t n = i % 16 ? 4 : 25;
        for (size_t k = 0; k < n; ++k) {
            lights.push_back(light_of(dice, dice.decades(-range, range) / 8));
            lights.back().L = lights.back().L * dice.decades(-range / 4, range / 4);
        }
        const Choice choice = choice_of<Choice>(lights);
        const vec3 p = dice.below(8) ? dice.direction(dice.decades(-range, range)) : lights[0].p;
        const vec3 m = dice.direction();
        real sum = 0;
        for (size_t k = 0; k < n; ++k) sum += choice.probability_of(k, p, m);
        REQUIRE(std::abs(sum - 1) < 32 * ulp);
    }
    // The point coincides with a light, or the square of a distance is infinite.
    const Choice choice = choice_of<Choice>({shining(Light({}, PointLight()), 1),
                                             shining(Light({1, 0, 0}, SphereLight{real(0.5)}), 1)});
    const real beyond = std::numeric_limits<real>::max() / 4;
    for (const vec3 p : {vec3{}, vec3{beyond, 0, 0}})
        for (const vec3 m : {vec3{1, 0, 0}, vec3{-1, 0, 0}}) {
            CHECK(choice.probability_of(0, p, m) + choice.probability_of(1, p, m) == 1);
            for (real u : {real(0), below_one}) CHECK(choice.choose(p, m, u).probability > 0);
        }
}

TEST_CASE_TEMPLATE_DEFINE("where weights are so faint that their sum is denormal, shares are even",
                          Choice, faint_weights) {
    const real faint = std::numeric_limits<real>::denorm_min() * 100;
    const std::vector<Light> lights{
        shining(Light({0, -5, 0}, SphereLight{1}), 1),  // below the horizon
        shining(Light({0, 5, 0}, SphereLight{1}), 1), shining(Light({9, 5, 0}, SphereLight{1}), 1)};
    const Choice dark(lights, {1, faint, faint / 4});
    CHECK(dark.probability_of(0, {}, {0, 1, 0}) == 0);
    CHECK(dark.probability_of(1, {}, {0, 1, 0}) == real(0.5));
    CHECK(dark.probability_of(2, {}, {0, 1, 0}) == real(0.5));
    const Choice dim(lights, {1, std::numeric_limits<real>::min() * 4000,
                              std::numeric_limits<real>::min() * 1000});
    CHECK(dim.probability_of(1, {}, {0, 1, 0}) > real(0.8));
    // One that shines alone is chosen, however faint.
    const Choice choice =
        choice_of<Choice>({shining(Light({0, -5, 0}, SphereLight{1}), real(1e30)),
                           shining(Light({0, real(0.5), 0}, PointLight()), faint)});
    for (real u : {real(0), below_one}) CHECK(choice.choose({}, {0, 1, 0}, u).light == 1);
}

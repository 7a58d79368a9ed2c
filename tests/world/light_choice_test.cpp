// world/light_choice_test.cpp  the choice of one light for a sample
#include "world/prepare.h"

#include "base/approx.h"
#include "oracle/expect.h"
#include "text/scene_file.h"
#include "world/geometry.h"

namespace {

Light shining(Light l, real L, bool twosided = false) {
    l.L = {L / 2, L, 3 * L / 2};
    l.twosided = twosided;
    return l;
}

// A light near the origin, of size r: a point, a sphere, a quad, a triangle.
Light light_of(Dice& dice, size_t kind, real r) {
    const vec3 p = dice.direction(r), u = dice.direction(r), v = dice.direction(r * dice(0.5, 2));
    const real L = dice.decades(-2, 2);
    const bool twosided = dice.below(2);
    if (kind == 0) return shining(Light(p, PointLight()), L);
    if (kind == 1) return shining(Light(p, SphereLight{r}), L);
    if (kind == 2) return shining(Light(p, QuadLight{u, v}), L, twosided);
    return shining(Light(p, TriangleLight{u, v}), L, twosided);
}
Light light_of(Dice& dice, real r) { return light_of(dice, dice.below(4), r); }

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

std::vector<Light> lights_of(Dice& dice, size_t n, real r) {
    std::vector<Light> lights;
    for (size_t i = 0; i < n; ++i) {
        const vec3 move = dice.direction(dice(0, 3));
        Light l = light_of(dice, r);
        l.p += move, l.centre += move;
        lights.push_back(l);
    }
    return lights;
}

}  // namespace

TEST_CASE("one of many lights is chosen as often as is said") {
    Dice dice;
    for (size_t n : {2u, 5u, 8u, 9u, 30u})
        for (int place = 0; place < 4; ++place) {
            const Scene s = scene_of(lights_of(dice, n, real(0.5)));
            const LightTree& tree = s.light_tree;
            const vec3 p = dice.direction(dice(0, 3)), m = dice.direction();
            for (real u : {real(0), dice(0, 1), below_one}) {
                const auto chosen = tree.choose(p, m, u);
                REQUIRE(chosen.light < n);
                CHECK(chosen.probability > 0);
                CHECK(chosen.probability == tree.probability_of(chosen.light, p, m));
            }
            oracle::Random random(seed_here());
            EXPECT(oracle::expect_choice(
                       random, [&](real u) { return tree.choose(p, m, u).light; },
                       [&](int i) { return tree.probability_of(size_t(i), p, m); }, n),
                   0.05);
        }
}

TEST_CASE("one light is chosen always") {
    const Scene s = scene_of({shining(Light({0, 5, 0}, SphereLight{1}), 1)});
    CHECK(s.light_tree.choose({}, {0, 1, 0}, real(0.5)).light == 0);
    CHECK(s.light_tree.choose({}, {0, 1, 0}, real(0.5)).probability == 1);
    CHECK(s.light_tree.probability_of(0, {}, {0, -1, 0}) == 1);
}

TEST_CASE("a light is never chosen only where it sends nothing") {
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
        const real probability = scene_of(lights).light_tree.probability_of(0, p, m);
        for (const vec3 corner : corners_of(first))
            beyond += length(corner - first.centre) > first.reach * (1 + 8 * ulp);
        real E = 0;
        for (int k = 0; k < 8; ++k) E += sends(first, p, m, dice.pair());
        // The bound is the rounding error of a cosine near 0.
        const bool sends_some = E > 256 * ulp * strength(first, std::numbers::pi);
        sent += sends_some;
        lost += sends_some && !(probability > 0);
        // The whole light lies below the horizon, or it faces away.
        const bool is_below = dot(m, first.centre - p) < -first.reach - 64 * ulp;
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

TEST_CASE("a wall of lamps of one side is not chosen from behind") {
    std::vector<Light> lights;
    for (int i = 0; i < 40; ++i)
        lights.push_back(
            shining(Light({real(i), 0, 5}, QuadLight{{0, 1, 0}, {1, 0, 0}}), 1));  // -z
    for (int i = 0; i < 40; ++i)
        lights.push_back(shining(Light({real(i), 0, 200}, PointLight()), 1));
    const LightTree tree = scene_of(lights).light_tree;
    auto of_wall = [&](vec3 p, vec3 m) {
        real sum = 0;
        for (size_t i = 0; i < 40; ++i) sum += tree.probability_of(i, p, m);
        return sum;
    };
    CHECK(of_wall({20, -3, 20}, {0, 1, 0}) == 0);
    CHECK(of_wall({20, -3, 3}, {0, 1, 0}) > real(0.8));
}

TEST_CASE("far away, lights are chosen by what they send, but for the even part") {
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
        const LightTree tree = scene_of(lights).light_tree;
        const real a = tree.probability_of(0, p, m), b = tree.probability_of(1, p, m);
        CHECK(std::min(a, b) >= even_part / 2);
        if (std::min(a, b) < real(0.1)) continue;  // rounding would count
        worst.see(std::abs((a - even_part / 2) / (b - even_part / 2) * (E[1] / E[0]) - 1));
        ++seen;
    }
    CHECK(seen > 1000);
    CHECK(worst.value < 64 / far);  // cosines are 1/4 or more; radii of at most 1 move them
}

TEST_CASE("of many lamps, those that send most are chosen most") {
    // Means of the relative variance of E_i / pick_i, over that of equal shares.  In the second
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
            const Scene s = scene_of(lights);
            const vec3 p = dice.direction(dice(0, 3)), m = dice.direction();
            double all = 0, of_this = 0, of_equal = 0;
            for (size_t k = 0; k < n; ++k) {
                const double E = double(sends(lights[k], p, m, {real(0.5), real(0.5)}));
                all += E, of_equal += E * E * double(n);
                if (E > 0) of_this += E * E / double(s.light_tree.probability_of(k, p, m));
            }
            if (all == 0) continue;
            of_choice += of_this / (all * all) - 1, of_even += of_equal / (all * all) - 1;
        }
        CHECK(of_choice < of_even / 6);
    }
}

TEST_CASE("the sphere about a polygon holds its corners, and touches two of a quad's") {
    Dice dice;
    for (size_t i = 0; i < 2000; ++i) {
        const Light l = light_of(dice, 2 + i % 2, 1);
        real most = 0;
        for (vec3 corner : corners_of(l)) most = std::max(most, length(corner - l.centre));
        CHECK(std::abs(most - l.reach) < 16 * ulp);
    }
}

TEST_CASE("near or far, strong or faint, few or many: probabilities add up to 1") {
    Dice dice;
    constexpr real range = single ? 8 : 70;
    for (int i = 0; i < 20000; ++i) {
        std::vector<Light> lights;
        const size_t n = i % 16 ? 4 : 25;
        for (size_t k = 0; k < n; ++k) {
            lights.push_back(light_of(dice, dice.decades(-range, range) / 8));
            lights.back().L = lights.back().L * dice.decades(-range / 4, range / 4);
        }
        const Scene s = scene_of(lights);
        const vec3 p = dice.below(8) ? dice.direction(dice.decades(-range, range)) : lights[0].p;
        const vec3 m = dice.direction();
        real sum = 0;
        for (size_t k = 0; k < n; ++k) sum += s.light_tree.probability_of(k, p, m);
        REQUIRE(std::abs(sum - 1) < 32 * ulp);
    }
    // The point coincides with a light, or the square of a distance is infinite.
    const Scene s = scene_of({shining(Light({}, PointLight()), 1),
                              shining(Light({1, 0, 0}, SphereLight{real(0.5)}), 1)});
    const real beyond = std::numeric_limits<real>::max() / 4;
    for (const vec3 p : {vec3{}, vec3{beyond, 0, 0}})
        for (const vec3 m : {vec3{1, 0, 0}, vec3{-1, 0, 0}}) {
            CHECK(s.light_tree.probability_of(0, p, m) + s.light_tree.probability_of(1, p, m) == 1);
            for (real u : {real(0), below_one}) CHECK(s.light_tree.choose(p, m, u).probability > 0);
        }
}

TEST_CASE("where weights are so faint that their sum is denormal, shares are even") {
    const real faint = std::numeric_limits<real>::denorm_min() * 100;
    const std::vector<Light> lights{
        shining(Light({0, -5, 0}, SphereLight{1}), 1),  // below the horizon
        shining(Light({0, 5, 0}, SphereLight{1}), 1), shining(Light({9, 5, 0}, SphereLight{1}), 1)};
    const LightTree dark(lights, {1, faint, faint / 4});
    CHECK(dark.probability_of(0, {}, {0, 1, 0}) == 0);
    CHECK(dark.probability_of(1, {}, {0, 1, 0}) == real(0.5));
    CHECK(dark.probability_of(2, {}, {0, 1, 0}) == real(0.5));
    const LightTree dim(lights, {1, std::numeric_limits<real>::min() * 4000,
                                 std::numeric_limits<real>::min() * 1000});
    CHECK(dim.probability_of(1, {}, {0, 1, 0}) > real(0.8));
    // One that shines alone is chosen, however faint.
    const Scene s = scene_of({shining(Light({0, -5, 0}, SphereLight{1}), real(1e30)),
                              shining(Light({0, real(0.5), 0}, PointLight()), faint)});
    for (real u : {real(0), below_one}) CHECK(s.light_tree.choose({}, {0, 1, 0}, u).light == 1);
}

TEST_CASE("light that arrives: the square root of the visible part, if surfaces are many") {
    Arrival a;
    for (int i = 0; i < 15; ++i) a.add(2, false);
    CHECK(a.factor() == 1);
    a.add(2, false);
    CHECK(a.factor() == 0);
    for (int i = 0; i < 4; ++i) a.add(4, true);  // 16 of 48
    CHECK(a.factor() == approx(std::sqrt(1. / 3)));
    CHECK(Arrival{}.factor() == 1);
}

TEST_CASE("a sun that reaches nothing of a room leaves the samples to its candle") {
    auto room = [](const char* more) {
        return parse_scene(
                   std::string("camera 0 1 1.9  0 1 0  60\ndiffuse wall .7 .7 .7\n"
                               "light flame 300 200 90\nlight sun 5e6 5e6 5e6\n"
                               "box 4 3 4  0  -2 0 -2  wall\nsphere 300 600 500  4  sun\n") +
                       more,
                   "room")
            .scene;
    };
    const vec3 floor{1, 0, 1}, up{0, 1, 0};
    const Scene one = room("sphere -.5 1 -.5  .05  flame\n");
    CHECK(one.light_tree.probability_of(0, floor, up) == approx(double(even_part) / 2));
    CHECK(one.light_tree.probability_of(1, floor, up) == approx(1 - double(even_part) / 2));
    std::string candles;
    for (int i = 0; i < 30; ++i)
        candles += oracle::say("sphere -1 1 %.1f  .05  flame\n", -1.5 + 0.1 * i);
    const Scene many = room(candles.c_str());
    CHECK(many.light_tree.probability_of(0, floor, up) <= even_part);
    // Nor does the group that the sun is in get the samples of the others.
    double all = 0, squares = 0;
    for (size_t i = 1; i < many.lights.size(); ++i) {
        const double E = double(sends(many.lights[i], floor, up, {real(0.5), real(0.5)}));
        all += E, squares += E * E / double(many.light_tree.probability_of(i, floor, up));
    }
    CHECK(squares / (all * all) - 1 < 0.5);
    // A size in the scene does not change the choice, nor does the one that is asked for.
    const Scene wide =
        room("size 300 20\nsphere -.5 1 -.5  .05  flame\nsphere 1 2 1  .05  flame\n");
    const Scene tall =
        room("size 20 300\nsphere -.5 1 -.5  .05  flame\nsphere 1 2 1  .05  flame\n");
    for (size_t i = 0; i < 3; ++i)
        CHECK(wide.light_tree.probability_of(i, floor, up) ==
              tall.light_tree.probability_of(i, floor, up));
}

TEST_CASE("mirrors show the surfaces that judge what arrives") {
    // The eye sees a mirror, which shows a floor; a lid hides the second lamp from it.
    const Scene s =
        parse_scene(
            "camera 0 1 0  0 .6 -1  40\ndiffuse wall .7 .7 .7\nmirror m .9 .9 .9\n"
            "light a 9 9 9\nquad -3 -3 -2  6 0 0  0 8 0  m\n"
            "quad -9 0 1  0 0 18  18 0 0  wall\nquad -99 6 -99  198 0 0  0 0 198  wall\n"
            "sphere 0 4 5  .2  a\nsphere 0 8 5  .2  a\n",
            "mirror")
            .scene;
    CHECK(s.light_tree.probability_of(0, {0, 0, 3}, {0, 1, 0}) ==
          approx(1 - double(even_part) / 2));
}

TEST_CASE("what arrives is looked at for few lights and many, and always the same") {
    // Half of the lamps hang above a lid; a box of mirrors shows nothing else to some paths.
    auto hall = [](int n) {
        std::string s =
            "camera 0 1 8  0 1 0  60\ndiffuse wall .7 .7 .7\nmirror m .9 .9 .9\n"
            "light a 9 9 9\nquad -50 0 -50  0 0 100  100 0 0  wall\n"
            "quad -99 6 -99  198 0 0  0 0 198  wall\nbox 1 1 1  20  -1 .01 0  m\n";
        for (int i = 0; i < n; ++i)
            s += oracle::say("sphere %.2f %d %.2f  .1  a\n", i % 20 * 0.4 - 4, i % 2 ? 8 : 4,
                             i / 20 * 0.4 - 4);
        return parse_scene(s, "hall").scene;
    };
    for (const int n : {20, 200}) {
        Scene s = hall(n);
        const std::vector<Arrival> arrivals = arrivals_of(s);
        int above = 0, below = 0;
        for (size_t i = 0; i < s.lights.size(); ++i)
            (i % 2 ? above : below) += arrivals[i].factor() > real(0.5);
        CHECK(above == 0);
        CHECK(below == n / 2);
        std::vector<real> picks;
        for (size_t i = 0; i < s.lights.size(); ++i)
            picks.push_back(s.light_tree.probability_of(i, {0, 0, 1}, {0, 1, 0}));
        prepare(s);
        for (size_t i = 0; i < s.lights.size(); ++i)
            CHECK(picks[i] == s.light_tree.probability_of(i, {0, 0, 1}, {0, 1, 0}));
    }
    // So many that there is not even a look: all strengths are as they were.
    std::vector<Light> many(20000, shining(Light({0, 3, 0}, PointLight()), 1));
    Scene s = hall(20);
    s.lights = many;
    for (const Arrival& a : arrivals_of(s)) REQUIRE(a.all == 0);
}

TEST_CASE("paths in a box of mirrors end") {
    const Scene s = parse_scene(
                        "camera 0 1 0  0 1 -1  60\nmirror m 1 1 1\nlight a 9 9 9\n"
                        "box 4 3 4  0  -2 0 -2  m\n"
                        "sphere 0 5 0  .1  a\nsphere 1 5 0  .1  a\n",
                        "mirrors")
                        .scene;
    for (const Arrival& a : arrivals_of(s)) CHECK(a.all == 0);
}

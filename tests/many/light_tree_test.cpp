// many/light_tree_test.cpp  the choice of one light for a sample, by a tree of lights
#include "many/arrivals.h"

#include "base/approx.h"
#include "text/scene_file.h"
#include "world/light_cases.h"
#include "world/prepare.h"

TEST_CASE_TEMPLATE_INVOKE(one_of_many, LightTree);
TEST_CASE_TEMPLATE_INVOKE(one_light, LightTree);
TEST_CASE_TEMPLATE_INVOKE(only_where_nothing, LightTree);
TEST_CASE_TEMPLATE_INVOKE(far_away, LightTree);
TEST_CASE_TEMPLATE_INVOKE(most_by_most, LightTree);
TEST_CASE_TEMPLATE_INVOKE(up_to_one, LightTree);
TEST_CASE_TEMPLATE_INVOKE(faint_weights, LightTree);

TEST_CASE("a wall of lamps of one side is not chosen from behind") {
    std::vector<Light> lights;
    for (int i = 0; i < 40; ++i)
        lights.push_back(
            shining(Light({real(i), 0, 5}, QuadLight{{0, 1, 0}, {1, 0, 0}}), 1));  // -z
    for (int i = 0; i < 40; ++i)
        lights.push_back(shining(Light({real(i), 0, 200}, PointLight()), 1));
    const auto tree = choice_of<LightTree>(lights);
    auto of_wall = [&](vec3 p, vec3 m) {
        real sum = 0;
        for (size_t i = 0; i < 40; ++i) sum += tree.probability_of(i, p, m);
        return sum;
    };
    CHECK(of_wall({20, -3, 20}, {0, 1, 0}) == 0);
    CHECK(of_wall({20, -3, 3}, {0, 1, 0}) > real(0.8));
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
    CHECK(one.light_choice.probability_of(0, floor, up) == approx(double(even_part) / 2));
    CHECK(one.light_choice.probability_of(1, floor, up) == approx(1 - double(even_part) / 2));
    std::string candles;
    for (int i = 0; i < 30; ++i)
        candles += oracle::say("sphere -1 1 %.1f  .05  flame\n", -1.5 + 0.1 * i);
    const Scene many = room(candles.c_str());
    CHECK(many.light_choice.probability_of(0, floor, up) <= even_part);
    // Nor does the group that the sun is in get the samples of the others.
    double all = 0, squares = 0;
    for (size_t i = 1; i < many.lights.size(); ++i) {
        const double E = double(sends(many.lights[i], floor, up, {real(0.5), real(0.5)}));
        all += E, squares += E * E / double(many.light_choice.probability_of(i, floor, up));
    }
    CHECK(squares / (all * all) - 1 < 0.5);
    // A size in the scene does not change the choice, nor does the one that is asked for.
    const Scene wide =
        room("size 300 20\nsphere -.5 1 -.5  .05  flame\nsphere 1 2 1  .05  flame\n");
    const Scene tall =
        room("size 20 300\nsphere -.5 1 -.5  .05  flame\nsphere 1 2 1  .05  flame\n");
    for (size_t i = 0; i < 3; ++i)
        CHECK(wide.light_choice.probability_of(i, floor, up) ==
              tall.light_choice.probability_of(i, floor, up));
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
    CHECK(s.light_choice.probability_of(0, {0, 0, 3}, {0, 1, 0}) ==
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
            picks.push_back(s.light_choice.probability_of(i, {0, 0, 1}, {0, 1, 0}));
        prepare(s);
        for (size_t i = 0; i < s.lights.size(); ++i)
            CHECK(picks[i] == s.light_choice.probability_of(i, {0, 0, 1}, {0, 1, 0}));
    }
    // So many that there is not even a look: all intensities are as they were.
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

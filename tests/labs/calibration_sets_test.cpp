// labs/calibration_sets_test.cpp  rules of sets compared on the same numbers, at equal work
#include "labs/calibration_sets.h"

#include <doctest/doctest.h>

#include "film/fill.h"

TEST_CASE("a curve is a power between its points, and goes on beyond them") {
    const Curve c{{8, 16, 32}, {1, 0.25, 0.125}};
    CHECK(c.at(8) == doctest::Approx(1));
    CHECK(c.at(16) == doctest::Approx(0.25));
    CHECK(c.at(std::sqrt(8 * 16.0)) == doctest::Approx(0.5));
    CHECK(c.at(std::sqrt(16 * 32.0)) == doctest::Approx(0.25 / std::sqrt(2)));
    CHECK(c.at(64) == doctest::Approx(0.0625));
    CHECK(c.at(4) == doctest::Approx(4));
}

TEST_CASE("an image by a rule: the mean of the sets that it shows; hidden ones are paid, too") {
    Film<MeanPixel> film({2, 1});
    film.add_sets({{3}, {2}});
    whole_pass(film, 4, [](int x, int, uint64_t, uint32_t set) {
        return rgb{real(10 * x + int(set)), 1, 0};
    });
    const Paid p = paid(film, {{2}, {1, 0.5}}, {3, 1});
    CHECK(p.image.pixels[0] == std::array<float, 3>{0.5f, 1, 0});
    CHECK(p.image.pixels[1] == std::array<float, 3>{10, 1, 0});
    CHECK(p.sets == 2);
    CHECK(paid(film, {{3}, {1}}, {3, 1}).sets == 2.5);  // more where paths have more rays
}

TEST_CASE("all sets that any rule asks for, and two at least") {
    Film<MeanPixel> film({8, 8});
    whole_pass(film, 16, [&](int x, int, uint64_t i, uint32_t) {
        return real(i % 2) * (x < 2 ? rgb{50, 50, 50} : rgb{1, 1, 1});
    });
    const std::vector<Rule> rules = all_rules();
    const Union u = union_of(rules, film, 1);
    REQUIRE(u.by_rule.size() == rules.size());
    uint32_t most = 0;
    for (size_t i = 0; i < u.all.size(); ++i) {
        uint32_t wanted = 2;
        for (const auto& sets : u.by_rule) wanted = std::max(wanted, sets[i].count());
        CHECK(u.all[i].count() == wanted);
        CHECK(u.by_rule[0][i].count() == 2);  // everywhere
        most = std::max(most, wanted);
    }
    CHECK(most > 2);
}

TEST_CASE("the gain of a rule is over one set of as much work") {
    // One set: 16 / n.  A rule that takes two sets at 16 samples, and has half the error of 32.
    Squares s{{{8, 16, 32, 64}, {2, 1, 0.5, 0.25}}, {{0.25, 0, 0}}, {{2, 0, 0}}};
    CHECK(gain_of_rule({s, s}, 0, 0, SIZE_MAX) == doctest::Approx(2));
    Squares worse = s;
    worse.square[0][0] = 0.75;
    CHECK(gain_of_rule({s, worse}, 0, 0, SIZE_MAX) == doctest::Approx(1));
    CHECK(gain_of_rule({s, worse}, 0, 0, 0) == doctest::Approx(2 / 3.0));
    CHECK(gain_of_rule({s, worse}, 0, 0, 1) == doctest::Approx(2));
}

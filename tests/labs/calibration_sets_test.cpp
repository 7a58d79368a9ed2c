// labs/calibration_sets_test.cpp  rules of sets compared on the same numbers, at equal work
#include "labs/calibration_sets.h"

#include <doctest/doctest.h>

TEST_CASE("a curve is a power between its points, and goes on beyond them") {
    const Curve c{{8, 16, 32}, {1, 0.25, 0.125}};
    CHECK(c.at(8) == doctest::Approx(1));
    CHECK(c.at(16) == doctest::Approx(0.25));
    CHECK(c.at(std::sqrt(8 * 16.0)) == doctest::Approx(0.5));
    CHECK(c.at(std::sqrt(16 * 32.0)) == doctest::Approx(0.25 / std::sqrt(2)));
    CHECK(c.at(64) == doctest::Approx(0.0625));
    CHECK(c.at(4) == doctest::Approx(4));
}

TEST_CASE("an image by a rule: the mean of the replications that it has, which are paid") {
    Film film = film_of_sets({2, 1}, {3, 2});
    fill(film, 4, [](const PixelSample& s, Tally&) {
        return rgb{real(10 * s.x + int(s.set)), 1, 0};
    });
    const Paid p = paid(film, {2, 1}, {3, 1});
    CHECK(p.image.pixels[0] == std::array<float, 3>{0.5f, 1, 0});
    CHECK(p.image.pixels[1] == std::array<float, 3>{10, 1, 0});
    CHECK(p.sets == 1.75);  // more where paths have more rays
    CHECK(paid(film, {3, 2}, {1, 1}).sets == 2.5);
}

TEST_CASE("all replications that any rule asks for, by the pilot that it has") {
    // Noisy are the left columns by the first samples, the right ones by all of them.
    Film pilot = make_film({8, 8}, 0);
    std::vector<std::vector<float>> spread;
    for (uint64_t n = 1; n <= longest_pilot; n *= 2) {
        fill(pilot, n, [&](const PixelSample& s, Tally&) {
            const bool left = s.x < 2, late = s.i >= 8;
            return real(s.i % 2) * (left && !late      ? rgb{5, 5, 5}
                                    : s.x >= 6 && late ? rgb{50, 50, 50}
                                                       : rgb{1, 1, 1});
        });
        spread.push_back(pilot.spread);
    }
    const std::vector<Rule> rules = all_rules();
    const Union u = union_of(rules, spread, {8, 8});
    REQUIRE(u.by_rule.size() == rules.size());
    uint32_t most = 0;
    for (size_t i = 0; i < u.all.size(); ++i) {
        uint16_t wanted = 2;
        for (const auto& sets : u.by_rule) wanted = std::max(wanted, sets[i]);
        CHECK(u.all[i] == wanted);
        CHECK(u.by_rule[0][i] == 2);  // everywhere
        most = std::max<uint32_t>(most, wanted);
    }
    CHECK(most > 2);
    for (size_t r = 0; r < rules.size(); ++r) {
        if (rules[r].name == "a pilot of 4") CHECK(u.by_rule[r][0] > u.by_rule[r][7]);
        if (rules[r].name == "a pilot of 16") CHECK(u.by_rule[r][0] < u.by_rule[r][7]);
    }
    // Fewer samples than its pilot: by those.
    const Union early = union_of(rules, {spread[0], spread[1], spread[2]}, {8, 8});
    for (const auto& sets : early.by_rule)
        if (&sets != &early.by_rule[0]) CHECK(sets[0] > sets[7]);
}

TEST_CASE("the gain of a rule is over one replication of as many samples in all") {
    // One: 16 / n.  A rule that has 8 / n.
    const Curve one{{8, 16, 32}, {2, 1, 0.5}}, rule{{12, 24}, {8 / 12.0, 8 / 24.0}},
        worse{{12, 24}, {24 / 12.0, 24 / 24.0}};
    CHECK(gain({one, one}, {rule, rule}, 16).value == doctest::Approx(2));
    CHECK(gain({one, one}, {rule, rule}, 16).log_error == doctest::Approx(0).scale(1));
    CHECK(gain({one, one}, {rule, worse}, 16).value == doctest::Approx(1));
    // Without one of them 2 and 2/3: half the distance of their logarithms.
    CHECK(gain({one, one}, {rule, worse}, 16).log_error == doctest::Approx(std::log(3.0) / 2));
}

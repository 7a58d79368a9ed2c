// labs/calibration_test.cpp  runs made by hand, and what is said of them
#include "labs/calibration.h"

#include <doctest/doctest.h>

namespace {

// Of true d_rel .5; its reference errs by .3.
Run run(double stated, double by_spread) {
    return {"hard/spark", "--spp 16",     7,  "p", "t", stated,
            by_spread,    std::sqrt(.34), .3, 20,  1e6, "samples"};
}

Run named(const std::string& scene, const std::string& words, double stated) {
    Run r = run(stated, stated);
    r.scene = scene, r.words = words;
    return r;
}

}  // namespace

TEST_CASE("a run is right within two, understated, or hinted; or its truth is not known") {
    CHECK(true_d(run(1, 1)) == doctest::Approx(.5).epsilon(1e-12));
    for (const auto& [stated, expected] : {std::pair{.2499, Verdict::too_low},
                                           {.2501, Verdict::right},
                                           {.999, Verdict::right},
                                           {1.001, Verdict::too_high}})
        CHECK(verdict(run(1, 1), stated) == expected);
    CHECK(is_understated(run(.2, 1)));
    CHECK_FALSE(is_understated(run(1, .2)));
    CHECK_FALSE(is_hinted(run(.2, .2)));
    const Run hinted = run(NAN, .2);
    CHECK(is_hinted(hinted));
    CHECK_FALSE(is_understated(hinted));
    CHECK(verdict(hinted, hinted.by_spread) == Verdict::too_low);
    Run far = run(.01, .01);
    far.own = .79 * far.off;
    CHECK(verdict(far, far.stated) == Verdict::too_low);
    far.own = .81 * far.off;
    CHECK(verdict(far, far.stated) == Verdict::unknown);
    far.own = 1.1 * far.off;
    CHECK(true_d(far) == 0);
}

TEST_CASE("what a statistics file states, by the rule and by the spread") {
    const std::string before = "{\n  \"d_rel\": 0.25,\n  \"stopped_by\": \"error\"\n}\n",
                      hushed = "{\n  \"d_rel\": null,\n  \"d_rel_by_spread\": 0.125\n}\n";
    CHECK(stated_in(before) == .25);
    CHECK(by_spread_in(before) == .25);
    CHECK(word_of(before, "stopped_by") == "error");
    CHECK(std::isnan(stated_in(hushed)));
    CHECK(by_spread_in(hushed) == .125);
    CHECK(word_of(hushed, "stopped_by").empty());
}

TEST_CASE("the distance of images is relative to the reference") {
    Image f(2, 1), g(2, 1);
    f.pixels = {{3, 0, 0}, {0, 4, 0}};
    g.pixels = {{3, 0, 1}, {0, 6, 0}};
    CHECK(distance(f, g) == doctest::Approx(std::sqrt(5.0) / 5).epsilon(1e-12));
    CHECK(distance(g, f) == doctest::Approx(std::sqrt(5.0 / 46)).epsilon(1e-12));
}

TEST_CASE("a run comes back from its line, and nothing from a part of it") {
    const Run r = run(NAN, 1.0 / 3);
    std::string line = line_of(r);
    line.pop_back();  // end of line
    const auto back = run_of(line);
    REQUIRE(back);
    CHECK(line_of(*back) == line_of(r));
    CHECK(std::isnan(back->stated));
    CHECK(back->by_spread == 1.0 / 3);
    CHECK(back->seed == 7);
    CHECK(back->rays == 1e6);
    CHECK_FALSE(run_of(line.substr(0, line.rfind('\t') + 1)));
    CHECK_FALSE(run_of(line.substr(0, line.rfind('\t'))));
    CHECK_FALSE(run_of(""));
}

TEST_CASE("shares are of the runs whose truth is known") {
    Runs runs = {run(.1, .1), run(.5, .5), run(NAN, .1), run(.5, .5), run(.1, .1)};
    runs[4].own = .9 * runs[4].off;
    CHECK(share(runs, is_understated) == .25);
    CHECK(share(runs, is_hinted) == .25);
    CHECK(std::isnan(share({}, is_hinted)));
}

TEST_CASE("what --error asked for, and whether it was reached") {
    CHECK(asked_in("--error 3% --time 10") == doctest::Approx(.03));
    CHECK(asked_in("--time 10 --error 10%") == doctest::Approx(.1));
    CHECK(asked_in("--spp 16") == 0);
    Run r = run(.5, .5);
    CHECK_FALSE(is_reached(r));
    r.stopped_by = "error";
    CHECK(is_reached(r));
    r.stated = NAN;
    CHECK_FALSE(is_reached(r));
}

TEST_CASE("numbers over those of the program before, and costs over scenes") {
    CHECK(geometric_mean({2, 8}) == doctest::Approx(4));
    Runs runs = {run(1, 1), run(1, 1)}, twins = runs;
    runs[0].samples = 30, twins[0].samples = 20, twins[1].seed = 8, runs[1].words = "--spp 32";
    CHECK(over_twins(runs, twins, [](const Run& r) { return r.samples; }) ==
          std::vector<double>{1.5});
    // d^2 of .25 and 1, rays of 3 and 1: .75; and of another scene 12.
    Runs all = {named("a", "x", 1), named("a", "y", 1), named("b", "x", 1), named("b", "y", 1)};
    for (Run& r : all) r.own = 0, r.off = 1, r.rays = 1;
    all[0].off = .5, all[0].rays = 3, all[2].off = 2, all[2].rays = 3;
    CHECK(cost_over(all, "x", "y") == doctest::Approx(3));
}

TEST_CASE("the worst scenes: by how many runs, then by how much") {
    const Runs runs = {named("a", "", .1),  named("a", "", 1),   named("b", "", .01),
                       named("c", "", .01), named("c", "", .02), named("d", "", 1)};
    const auto worst =
        worst_of(runs, is_understated, [](const Run& r) { return true_d(r) / r.stated; });
    REQUIRE(worst.size() == 3);
    CHECK(worst[0].scene == "c");
    CHECK(worst[0].most == doctest::Approx(50));
    CHECK(worst[1].scene == "b");
    CHECK(worst[2].scene == "a");
    CHECK(worst[2].count == 1);
    CHECK(worst[2].runs == 2);
}

// labs/calibration_test.cpp  the statistics of rows made by hand
#include "labs/calibration.h"

#include <doctest/doctest.h>

namespace {

using namespace penumbra;
using namespace calibration;

// A row with a true error of .5; its reference has an error of .3.
Row row(double stated, double by_spread, const std::string& scene = "hard/spark") {
    return {scene,
            "--spp 16",
            0,
            7,
            {{"d_rel", stated},
             {"d_rel_by_spread", by_spread},
             {"off", std::sqrt(.34)},
             {"own", .3},
             {"d2", .25}}};
}

}  // namespace

TEST_CASE("a run is right within two, understated, or hinted; or its truth is not known") {
    CHECK(true_d(row(1, 1)) == .5);
    for (const auto& [stated, expected] : {std::pair{.2499, Verdict::too_low},
                                           {.2501, Verdict::right},
                                           {.999, Verdict::right},
                                           {1.001, Verdict::too_high},
                                           {NAN, Verdict::unknown}})
        CHECK(verdict(row(1, 1), stated) == expected);
    CHECK(is_understated(row(.2, 1)));
    CHECK_FALSE(is_understated(row(1, .2)));
    CHECK_FALSE(is_hinted(row(.2, .2)));
    const Row hinted = row(NAN, .2);
    CHECK(is_hinted(hinted));
    CHECK_FALSE(is_understated(hinted));
    CHECK(verdict(hinted, by_spread(hinted)) == Verdict::too_low);
    Row far = row(.01, .01);
    far.of["own"] = .79 * far["off"];
    CHECK(verdict(far, far["d_rel"]) == Verdict::too_low);
    far.of["own"] = .81 * far["off"];
    CHECK(verdict(far, far["d_rel"]) == Verdict::unknown);
    far.of["d2"] = -.1;
    CHECK(true_d(far) == 0);
}

TEST_CASE("shares are of the runs whose truth is known") {
    Rows rows = {row(.1, .1), row(.5, .5), row(NAN, .1), row(.5, .5), row(.1, .1)};
    rows[4].of["own"] = .9 * rows[4]["off"];
    CHECK(share(rows, is_understated) == .25);
    CHECK(share(rows, is_hinted) == .25);
    CHECK(std::isnan(share({}, is_hinted)));
}

TEST_CASE("--error: what it asked for, and whether it was reached") {
    CHECK(asked_in("--error 3% --spp 1024") == doctest::Approx(.03));
    CHECK(asked_in("--spp 1024 --error 10%") == doctest::Approx(.1));
    CHECK(asked_in("--spp 16") == 0);
    Row r = row(.5, .5);
    CHECK_FALSE(is_reached(r));
    r.of["error"] = 1;
    CHECK(is_reached(r));
    r.of["d_rel"] = NAN;
    CHECK_FALSE(is_reached(r));
    CHECK(set_of("blind hard/lake") == "blind hard");
}

// labs/trade_test.cpp  errors, answers, the default, and hopeless settings
#include "labs/trade.h"

#include <doctest/doctest.h>

using namespace penumbra;
using namespace trade;

namespace {

// error = c seconds^-gamma at 4, 16, ... 1024 samples, at a hundred samples per second.
Choice by_law(const std::string& name, double c, double gamma) {
    Choice choice{{name, ""}};
    for (double spp : {4.0, 16.0, 64.0, 256.0, 1024.0})
        choice.points.push_back({spp, spp / 100, c * std::pow(spp / 100, -gamma)});
    return choice;
}

bool contains(const std::string& words, const std::string& part) {
    return words.find(part) != words.npos;
}

}  // namespace

// ---- Errors -------------------------------------------------------------------------------------

TEST_CASE("a reference's own error is taken off in squares, and hides what is below it") {
    CHECK(known_error(0.5, 0.3) == doctest::Approx(0.4));
    CHECK(known_error(0.1, 0) == doctest::Approx(0.1));
    CHECK(known_error(1, 0.79) > 0);
    CHECK(std::isnan(known_error(1, 0.81)));
    CHECK(std::isnan(known_error(1, 2)));
    CHECK(std::isnan(known_error(1, NAN)));
}

// ---- Answers ------------------------------------------------------------------------------------

TEST_CASE("what takes a setting to an error: between its points by powers, and nothing beyond") {
    const Choice c = by_law("a", 0.02, 0.5);  // 10 % after 0.04 s, 0.625 % after 10.24 s
    CHECK(reach(c, 0.02).seconds == doctest::Approx(1));
    CHECK(reach(c, 0.02).spp == doctest::Approx(100));
    CHECK(reach(c, 0.01).seconds == doctest::Approx(4));
    CHECK(reach(c, 0.00626).seconds == doctest::Approx(10.2).epsilon(0.01));
    CHECK(std::isnan(reach(c, 0.0062).seconds));
    CHECK(reach(c, 5).seconds == doctest::Approx(0.04));  // fewer samples are not measured
    CHECK(reach(c, 5).error == doctest::Approx(0.1));
    CHECK(std::isnan(reach(Choice{}, 0.1).seconds));
}

TEST_CASE("errors that are not known answer nothing") {
    Choice c = by_law("a", 0.02, 0.5);
    c.points[1].error = NAN;  // between its neighbours
    CHECK(reach(c, 0.05).seconds == doctest::Approx(0.16));
    c.points[4].error = NAN;
    CHECK(std::isnan(reach(c, 0.01).seconds));
    for (Point& p : c.points) p.error = NAN;
    CHECK(std::isnan(reach(c, 10).seconds));
    CHECK(std::isnan(cheapest({c}, 10).at.seconds));
    CHECK(cheapest({c, by_law("b", 1, 0.5)}, 1).choice == 1);
}

TEST_CASE("the cheapest changes where curves cross; of equal ones the first answers") {
    // The lines cross at 1 s and 2 %; the default is never the cheapest.
    Choices all = {by_law("default", 0.06, 0.6), by_law("steep", 0.02, 1),
                   by_law("flat", 0.02, 0.5)};
    CHECK(cheapest(all, 0.05).choice == 2);
    CHECK(cheapest(all, 0.05).at.seconds == doctest::Approx(0.16));
    CHECK(cheapest(all, 0.01).choice == 1);
    CHECK(cheapest(all, 0.01).at.seconds == doctest::Approx(2));
    all.push_back(all[1]);
    CHECK(cheapest(all, 0.01).choice == 1);
    all[1].may_be_default = all[3].may_be_default = false;
    CHECK(cheapest(all, 0.01, true).choice == 2);
    CHECK(std::isnan(cheapest(all, 1e-5).at.seconds));
}

TEST_CASE("the one default: the least mean ratio to the best, and where it is worst") {
    // "even" takes 4 times as long as "sharp" in the first scene, and a quarter in the second;
    // "float" is cheaper than both, but cannot be the default.
    auto scene = [](const std::string& name, double even, double sharp) {
        Choices all = {by_law("even", even, 0.5), by_law("sharp", sharp, 0.5),
                       by_law("float", 0.01, 0.5)};
        all[2].may_be_default = false;
        return Study{name, 1, 0, all};
    };
    const std::vector<Candidate> c = candidates(
        {scene("room", 0.04, 0.02), scene("hall", 0.02, 0.04), scene("attic", 0.02, 0.08)});
    REQUIRE(c.size() == 2);
    CHECK(c[0].command == "even");
    CHECK(c[0].where == "room");
    CHECK(c[1].command == "sharp");
    CHECK(c[1].where == "attic");
    CHECK(c[0].most == doctest::Approx(4));
    CHECK(c[0].ratio == doctest::Approx(std::cbrt(4)));
    CHECK(c[1].most == doctest::Approx(16));
    CHECK(c[1].ratio == doctest::Approx(4));
}

TEST_CASE("a setting without a requested error is compared at the least error that it has") {
    Choices all = {by_law("a", 0.02, 0.5), by_law("b", 0.06, 0.5)};
    all[1].points.resize(2);  // 15 % after 0.16 s; "a" has 10 % after 0.04 s
    CHECK(ratio_to_best(all, all[1]) == doctest::Approx(4));
    for (Point& p : all[1].points) p.error = NAN;
    CHECK(std::isnan(ratio_to_best(all, all[1])));
}

// ---- JSON ---------------------------------------------------------------------------------------

TEST_CASE("what is not known is null in the page's data, and words are escaped") {
    Choice c = by_law("a \"b\"", 0.02, 0.5);
    c.points.resize(1);
    CHECK(json_of(c) ==
          "{\"command\": \"a \\\"b\\\"\", \"seconds\": "
          "[0.040000000000000001, null, null, null], \"points\": [{\"spp\": 4, \"seconds\": "
          "0.040000000000000001, \"error\": 0.10000000000000001}]}");
    Study s{"room", 1, 0.01, {c}, {{"the reference", {}, Image(2, 1)}}};
    CHECK(contains(json_of(s), "\"answers\": [{\"choice\": 0, \"spp\": 4}, {\"choice\": null"));
    CHECK(contains(json_of(s), "\"width\": 2, \"height\": 1, "));
    CHECK(!contains(json_of(s), "nan"));
}

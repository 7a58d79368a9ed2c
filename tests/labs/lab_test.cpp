// labs/lab_test.cpp  the kit of the experiments: options, statistics, reports
#include "labs/lab.h"

#include "text/folder.h"

namespace {

// Calls a lab with the options --quick and --time S; records what it reads and its exit status.
struct Called {
    int status = 0;
    bool worked = false, quick = false;
    std::string time, command;
};
Called call(std::vector<std::string> words) {
    Called c;
    words.insert(words.begin(), "build/lab");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    const Lab lab{"lab", "Nothing.", {{"--time", "S", "seconds", "", [&](Text s) { c.time = s; }}}};
    c.status = experiment(int(argv.size()), argv.data(), lab, [&](const Scope& scope) {
        c.worked = true, c.quick = scope.quick, c.command = scope.command;
        return 7;
    });
    return c;
}

}  // namespace

TEST_CASE("quantiles lie between neighbours; the order of the numbers does not matter") {
    CHECK(median({3, 1, 2}) == 2);
    CHECK(median({4, 1, 3, 2}) == 2.5);
    CHECK(median({5}) == 5);
    CHECK(std::isnan(median({})));
    CHECK(quantile({1, 2, 3, 4, 5}, 0) == 1);
    CHECK(quantile({1, 2, 3, 4, 5}, 1) == 5);
    CHECK(quantile({5, 4, 3, 2, 1}, 0.25) == 2);
    CHECK(quantile({0, 10}, 0.9) == doctest::Approx(9));
}

TEST_CASE("the slope is the exponent") {
    CHECK(slope({1, 4, 16}, {3, 6, 12}) == doctest::Approx(0.5));  // y = 3 sqrt x
    CHECK(slope({10, 100}, {1, 1e-3}) == doctest::Approx(-3));
    // Logarithms to base 2: x 0, 1, 2, y 0, 0, 3; sum (x - 1) y / sum (x - 1)^2 = 3 / 2.
    CHECK(slope({1, 2, 4}, {1, 1, 8}) == doctest::Approx(1.5));
}

TEST_CASE("numbers as words") {
    CHECK(text("%d%%, %s", 5, "x") == "5%, x");
    CHECK(text("%s", "plain") == "plain");
    CHECK(text("%s%.1f", std::string("x"), 0.25) == "x0.2");
}

TEST_CASE("the relative RMSE and means of powers are over all channels") {
    Image f(2, 1), g(2, 1);
    f.at(0, 0) = f.at(1, 0) = g.at(0, 0) = {1, 2, 3};
    g.at(1, 0) = {1, 2, 6};
    CHECK(d_rel(f, g) == doctest::Approx(std::sqrt(9.0 / 28)));
    CHECK(d_rel(f, f) == 0);
    CHECK(image_mean(f) == doctest::Approx(2));
    CHECK(image_mean(g, 2) == doctest::Approx(55.0 / 6));
}

TEST_CASE("a part of an image begins at its left and its top") {
    Image image(4, 3);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x) image.at(x, y) = {float(x), float(y), 0};
    const Image part = part_of(image, 1, 2, {3, 1});
    CHECK(part.width == 3);
    CHECK(part.height == 1);
    CHECK(part.at(0, 0) == image.at(1, 2));
    CHECK(part.at(2, 0) == image.at(3, 2));
}

TEST_CASE("numbers of statistics: those that stand alone, by their whole names; null is NaN") {
    const auto of = numbers_of(
        "{\n  \"scene\": \"a.scene\",\n  \"cpu_seconds\": 25,\n  \"seconds\": 12.5,\n"
        "  \"mean\": [1, null, 3e-05],\n  \"roulette\": null,\n  \"chosen\": true,\n  \"last\": "
        "7\n}\n");
    CHECK(of.size() == 4);
    CHECK(of.at("cpu_seconds") == 25);
    CHECK(of.at("seconds") == 12.5);
    CHECK(of.at("last") == 7);
    CHECK(std::isnan(of.at("roulette")));
}

TEST_CASE("flags set what they say; without flags the work is done all the same") {
    const Called none = call({}), both = call({"--time", "3", "--quick"});
    CHECK(none.status == 7);
    CHECK(!none.quick);
    CHECK(both.status == 7);
    CHECK(both.quick);
    CHECK(both.time == "3");
    CHECK(both.command == "build/lab --time 3 --quick");
}

TEST_CASE("flags that are not known or lack their value: exit status 2, and no work") {
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"--quik"}, {"--time"}, {"--quick", "3"}, {"x"}}) {
        const Called c = call(words);
        CHECK(c.status == 2);
        CHECK(!c.worked);
    }
}

TEST_CASE("--help: exit status 0, and no work") {
    const Called c = call({"--quick", "--help"});
    CHECK(c.status == 0);
    CHECK(!c.worked);
}

TEST_CASE("what is committed comes from all runs, in double; a report says what made it") {
    CHECK(report_folder(true) == "out");
    CHECK(report_folder(false) == (sizeof(real) == 8 ? "reference" : "out"));
    const std::string words = made_by("build/lab --quick");
    CHECK(words.find("`build/lab --quick`") != std::string::npos);
    CHECK(words.find(", pictures " + said_by("tests/reports --pictures")) != std::string::npos);
    CHECK(words.find(sizeof(real) == 8 ? "double" : "float") != std::string::npos);
}

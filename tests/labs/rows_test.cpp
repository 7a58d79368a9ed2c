// labs/rows_test.cpp  means, their errors, gains and tables of rows made by hand
#include "labs/rows.h"

#include <doctest/doctest.h>

namespace {
using namespace penumbra;

Row row(const std::string& scene, const std::string& setting, uint64_t seed, double d2,
        double seconds = 1) {
    return {scene, setting, 4, seed, {{"d2", d2}, {"off", d2}, {"cpu_seconds", seconds}}};
}

}  // namespace

TEST_CASE("a row comes back from its line, and nothing from a part of it") {
    Row r = row("a scene", "--x 1", 7, 1.0 / 3);
    r.of["unknown"] = NAN;
    std::string line = line_of(r, "print");
    line.pop_back();  // its newline
    const auto back = row_of(line);
    REQUIRE(back);
    CHECK(back->second == "print");
    CHECK(line_of(back->first, "print") == line_of(r, "print"));
    CHECK(back->first["d2"] == 1.0 / 3);
    CHECK(std::isnan(back->first["unknown"]));
    for (size_t n = 0; n < line.size(); ++n) CHECK_FALSE(row_of(line.substr(0, n)));
}

TEST_CASE("squared errors and seconds are averaged") {
    const Rows rows = {row("a", "x", 1, .01, 3), row("a", "x", 2, .03, 1)};
    CHECK(relative_error(rows) == doctest::Approx(std::sqrt(.02)));
    CHECK(efficiency(rows) == doctest::Approx(25));
    CHECK(std::isnan(relative_error({row("a", "x", 1, -.01)})));
}

TEST_CASE("a number over another's is a geometric mean over scenes that have both") {
    const Rows rows = {row("a", "x", 1, 1, 1), row("a", "base", 1, 4, 1), row("b", "x", 1, 1, 1),
                       row("b", "base", 1, 1, 4), row("c", "x", 1, 1, 1)};
    CHECK(over(rows, "x", "base", efficiency) == doctest::Approx(4));
    CHECK(over(rows, "base", "x", relative_error) == doctest::Approx(std::sqrt(2)));
}

TEST_CASE("the jackknife of a mean is its standard error") {
    Rows rows;
    Moments all;
    uint64_t seed = 0;
    for (double x : {1., 4., 2., 7., 5.5}) rows.push_back(row("a", "x", ++seed, x)), all.add(x);
    const Estimate e = jackknife(rows, [](const Rows& r) { return mean(r, "d2"); });
    CHECK(e.value == doctest::Approx(all.mean));
    CHECK(e.error == doctest::Approx(all.standard_error()));
    CHECK(told({2, 0.1}, "%.2f") == "2.00 ± 0.10");
    CHECK(told({2, 0.004}, "%.2f") == "2.00 ± < 0.01");
    CHECK(told({2, 0}, "%.2f") == "2.00 ± 0.00");
    CHECK(told({NAN, 0.1}, "%.2f") == "–");
    rows.resize(1);
    CHECK(told(jackknife(rows, relative_error), "%.1f") == "1.0");
}

TEST_CASE("a gain has the error of its ratio; the same images are told") {
    Rows rows = {row("a", "x", 1, 1), row("a", "x", 2, 1), row("a", "base", 1, 2),
                 row("a", "base", 2, 4)};
    // Without a seed, the values are 4 and 2.
    CHECK(gain(rows, "x", "base", efficiency) == "3.00 ± 1.00");
    rows[0].of["off"] = 2, rows[1].of["off"] = 4;
    CHECK(gain(rows, "x", "base", efficiency) == "=");
}

TEST_CASE("a table has a line and a column for each word, in their order") {
    const Rows rows = {row("b", "x", 1, 1), row("b", "y", 1, 2), row("a", "x", 1, 3),
                       row("a", "x", 2, 5)};
    CHECK(table(rows, of_scene, of_setting, [](const Rows& r) {
              return text("%.0f", mean(r, "d2"));
          }) == "| | x | y |\n|---|---|---|\n| b | 1 | 2 |\n| a | 4 | |");
    CHECK(of_count(rows[0]) == "4");
    CHECK(in_scene(rows, "a").size() == 2);
    CHECK(by_setting(rows, "x").size() == 3);
}

TEST_CASE("every row is a line of the CSV, with nothing where it has no number") {
    CHECK(csv_of({row("a", "--x 1", 7, .5)}, {"d2", "none"}) ==
          "scene,setting,count,seed,d2,none\n\"a\",\"--x 1\",4,7,0.5,\n");
}

TEST_CASE("a plot has a curve for each word, and its label") {
    Rows rows = {row("a", "x", 1, .01), row("a", "x", 1, .001), row("a", "y", 1, .02)};
    rows[1].count = 16;
    const std::string svg =
        plot(rows, "samples", "error", of_setting, count_of, relative_error, "Title").file();
    for (const char* words : {"Title", ">x<", ">y<", "samples", "error"})
        CHECK(svg.find(words) != std::string::npos);
}

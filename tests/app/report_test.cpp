// app/report_test.cpp  the statistics of a run as JSON
#include "app/report.h"

#include <doctest/doctest.h>

TEST_CASE("the statistics are JSON: quoted, complete, null where nothing is known") {
    Options o;
    o.scene = "a \"b\"\\\n";
    RunStats run{64, 2, 4000000, 0, false};
    run.mean_radiance = {2, 2, 4};
    run.variance_of_mean = {1e-300, NAN, INFINITY};
    const std::string text = encode_stats(o, {2, 1}, 5, run);
    for (const char* line :
         {R"("scene": "a \"b\"\\\u000a")", R"("mean_radiance": [2, 2, 4])",
          R"("variance_of_mean": [1e-300, null, null])", R"("rays": 4000000)",
          R"("mrays_per_second": 2,)", R"("samples_per_pixel": 64)", R"("sampler": "halton")",
          R"("depth": 5)", R"("roulette": null)", R"("non_finite": 0)"}) {
        INFO(text);
        INFO(std::string(line));
        CHECK(text.find(line) != text.npos);
    }
}

TEST_CASE("JSON: every digit of a number, every letter of a name") {
    CHECK(std::strtod(json::number(0.1 + 0.2).c_str(), nullptr) == 0.1 + 0.2);
    CHECK(json::number(NAN) == "null");
    CHECK(json::number(-INFINITY) == "null");
    CHECK(json::numbers({1, 2, NAN}) == "[1, 2, null]");
    CHECK(json::string("a\"b\\c\x01\n") == R"("a\"b\\c\u0001\u000a")");
    CHECK(json::string("\xc3\xa9") == "\"\xc3\xa9\"");
}

TEST_CASE("the mean of an image is that of its pixels, a channel at a time") {
    Image image(3, 1);
    image.pixels = {{1, 2, 3}, {3, 2, 1}, {5, 2, 8}};
    CHECK(mean_of_pixels(image) == std::array<double, 3>{3, 2, 4});
    image.pixels[1][2] = NAN;
    CHECK(std::isnan(mean_of_pixels(image)[2]));
    CHECK(mean_of_pixels(image)[0] == 3);
}

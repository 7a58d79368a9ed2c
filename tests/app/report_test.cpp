// app/report_test.cpp  JSON, and means of images
#include "app/report.h"

#include <doctest/doctest.h>

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

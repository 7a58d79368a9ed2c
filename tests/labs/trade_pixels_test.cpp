// labs/trade_pixels_test.cpp  maps and values on the page are those of the pictures
#include "labs/trade_pixels.h"

#include <doctest/doctest.h>

#include "base/rng.h"
#include "film/png.h"

namespace {

// By a decoder that is not ours.
struct Pixels {
    int width = 0, height = 0;
    std::vector<Byte3> pixels;
};
Pixels decoded(const std::string& png) {
    Pixels d;
    int channels = 0;
    unsigned char* bytes =
        stbi_load_from_memory(reinterpret_cast<const unsigned char*>(png.data()), int(png.size()),
                              &d.width, &d.height, &channels, 3);
    REQUIRE(bytes != nullptr);
    for (size_t i = 0; i < size_t(d.width) * size_t(d.height); ++i)
        d.pixels.push_back({bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]});
    stbi_image_free(bytes);
    return d;
}

// Of the sRGB colour, as the eye weighs it (Rec. 709).
double luminance(const Byte3& colour) {
    auto linear = [](double v) {
        return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(colour[0] / 255.0) + 0.7152 * linear(colour[1] / 255.0) +
           0.0722 * linear(colour[2] / 255.0);
}

}  // namespace

TEST_CASE("the quadratic mean of pixels' errors is the picture's d_rel") {
    Image f(5, 3), g(5, 3);
    Rng rng{1};
    double square = 0, norm = 0;
    for (size_t i = 0; i < 15; ++i)
        for (size_t c = 0; c < 3; ++c) {
            f.pixels[i][c] = float(rng.uniform());
            g.pixels[i][c] = float(rng.uniform());
            square += std::pow(double(f.pixels[i][c]) - double(g.pixels[i][c]), 2);
            norm += std::pow(double(f.pixels[i][c]), 2);
        }
    CHECK(quadratic_mean(f) == doctest::Approx(std::sqrt(norm / 45)));
    double sum = 0;
    for (size_t i = 0; i < 15; ++i)
        sum += std::pow(pixel_error(f.pixels[i], g.pixels[i], quadratic_mean(f)), 2);
    CHECK(std::sqrt(sum / 15) == doctest::Approx(std::sqrt(square / norm)));
}

TEST_CASE("a black reference divides nothing by zero") {
    Image black(2, 1);
    black.pixels = {{0, 0, 0}, {0, 0, 0}};
    CHECK(quadratic_mean(black) == 1);
    CHECK(quadratic_mean(Image()) == 1);
    CHECK(decoded(error_map(black, black, 1)).pixels[0] == error_colours()[0]);
}

TEST_CASE("levels of errors: a third of them a decade, the ends for all beyond") {
    CHECK(error_level(0) == 0);
    CHECK(error_level(1e-3) == 0);
    CHECK(error_level(0.99e-2) == 5);
    CHECK(error_level(1.01e-2) == 5);
    CHECK(error_level(std::pow(10, -3 + 3 * 5.99 / 16)) == 5);
    CHECK(error_level(std::pow(10, -3 + 3 * 6.01 / 16)) == 6);
    CHECK(error_level(0.999) == 15);
    CHECK(error_level(1) == 15);
    CHECK(error_level(1e30) == 15);
    CHECK(error_level(INFINITY) == 15);
    CHECK(error_level(NAN) == 15);  // never a picture without error
}

TEST_CASE("every level is brighter than the one before, by steps that one sees") {
    const auto colours = error_colours();
    for (size_t k = 1; k < colours.size(); ++k) {
        // Lightness L* of CIE 1976 has a step of 1 where the eye just sees one.
        auto lightness = [](double y) {
            return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
        };
        CHECK(lightness(luminance(colours[k])) - lightness(luminance(colours[k - 1])) > 2);
    }
    CHECK(luminance(colours.front()) < 0.01);
    CHECK(luminance(colours.back()) > 0.8);
}

TEST_CASE("CRC-32 as in ISO 3309, and the end of every PNG file") {
    CHECK(crc32("123456789") == 0xcbf43926);
    CHECK(png_chunk("IEND", "") == std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12));
    CHECK(big_endian(0x01020304) == "\1\2\3\4");
}

TEST_CASE("an error map is a PNG file in which each pixel has its level's colour") {
    for (int width : {1, 2, 7, 16}) {
        std::vector<int> levels;
        for (int i = 0; i < 5 * width; ++i) levels.push_back((7 * i + i / 9) % error_levels);
        const Pixels d = decoded(error_png(width, 5, levels));
        REQUIRE(d.width == width);
        REQUIRE(d.height == 5);
        const auto colours = error_colours();
        for (size_t i = 0; i < levels.size(); ++i) CHECK(d.pixels[i] == colours[size_t(levels[i])]);
    }
}

TEST_CASE("a map shows where a picture is wrong, top row first") {
    Image f(3, 2), g(3, 2);
    for (auto& pixel : f.pixels) pixel = {1, 1, 1};
    g = f;
    g.at(2, 0) = {1.1f, 1.1f, 1.1f};
    g.at(0, 1) = {4, 1, 1};
    const Pixels d = decoded(error_map(f, g, 1));
    const auto colours = error_colours();
    CHECK(d.pixels[0] == colours[0]);
    CHECK(d.pixels[2] == colours[size_t(error_level(0.1))]);
    CHECK(d.pixels[3] == colours[15]);
    CHECK(d.pixels[5] == colours[0]);
}

TEST_CASE("packed values are within 1/254 of the pixel's largest channel") {
    Rng rng{2};
    double worst = 0;
    for (int k = 0; k < 200000; ++k) {
        Channels x;
        const double scale = std::exp2(-20 + 32 * rng.uniform());
        for (double& channel : x) channel = scale * (2 * rng.uniform() - 1);
        const double largest = std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
        if (largest < std::exp2(-20) || largest > 4080) continue;
        const Channels y = unpack_pixel(pack_pixel(x));
        for (size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(y[c] - x[c]) / largest);
    }
    CHECK(worst <= 1 / 254.0);
    CHECK(worst > 1 / 300.0);  // else the bound says too little
}

TEST_CASE("packed values at the ends: zero, signs, too small, too large") {
    CHECK(pack_pixel({0, 0, 0}) == 0);
    CHECK(unpack_pixel(pack_pixel({1, -0.5, 0})) == Channels{1, -0.5, 0});
    CHECK(unpack_pixel(pack_pixel({-1, 1, 0.25})) == Channels{-1, 1, 0.25});
    CHECK(unpack_pixel(pack_pixel({255, -255, 1})) == Channels{255, -255, 1});
    CHECK(unpack_pixel(pack_pixel({1e-30, 0, 0})) == Channels{0, 0, 0});
    CHECK(unpack_pixel(pack_pixel({std::exp2(-27), 0, 0})) == Channels{std::exp2(-27), 0, 0});
    CHECK(unpack_pixel(pack_pixel({1e30, -1e30, 16})) == Channels{4080, -4080, 16});
    // 0.9999 would need the mantissa 256.
    CHECK(unpack_pixel(pack_pixel({0.9999, 0, 0}))[0] == 1);
}

TEST_CASE("pictures are packed as differences, four bytes a pixel, the lowest first") {
    Image f(2, 1), g(2, 1);
    f.pixels = {{1, 2, 3}, {0, 0, 0}};
    g.pixels = {{1, 2, 3}, {2, 0, -1}};
    const std::string bytes = packed_pixels(g, f, 2);
    REQUIRE(bytes.size() == 8);
    CHECK(bytes.substr(0, 4) == std::string(4, '\0'));
    uint32_t word = 0;
    for (size_t k = 4; k-- > 0;) word = word << 8 | uint8_t(bytes[4 + k]);
    CHECK(unpack_pixel(word) == Channels{1, 0, -0.5});
}

TEST_CASE("what is too large for a page is thinned, and no pixel is changed") {
    CHECK(thinning(Image(128, 64)) == 1);
    CHECK(thinning(Image(256, 128)) == 2);
    CHECK(thinning(Image(129, 64)) == 2);
    CHECK(thinning(Image(256, 256)) == 3);
    CHECK(thinning(Image()) == 1);
    const Image all = painted(7, 5, [](int x, int y) { return Colour{float(x), float(y), 0}; });
    const Image half = thinned(all, 2);
    REQUIRE(half.width == 3);
    REQUIRE(half.height == 2);
    CHECK(half.at(0, 0) == all.at(1, 1));
    CHECK(half.at(2, 1) == all.at(5, 3));
    CHECK(thinned(all, 1).pixels == all.pixels);
}

// whole/pictures_test.cpp  up, right and round in a scene are the same in its picture
#include <numbers>

#include "base/approx.h"
#include "text/png.h"
#include "whole/process.h"

namespace {

// Bounds of the pixels that are not black, and their centre of mass weighted by radiance, in pixels
// from the top left corner.
struct Bright {
    int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
    double x = 0, y = 0, sum = 0;
    int width() const { return right - left + 1; }
    int height() const { return bottom - top + 1; }
};
Bright bright(const Image& image) {
    Bright b;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double L = double(image.at(x, y)[0]);
            if (!(L > 0)) continue;
            b.left = std::min(b.left, x), b.right = std::max(b.right, x);
            b.top = std::min(b.top, y), b.bottom = std::max(b.bottom, y);
            b.x += (x + 0.5) * L, b.y += (y + 0.5) * L, b.sum += L;
        }
    REQUIRE(b.sum > 0);  // not all black or NaN
    REQUIRE(std::isfinite(b.sum));
    b.x /= b.sum, b.y /= b.sum;
    return b;
}

}  // namespace

TEST_CASE("up is up and right is right, in wide and in tall pictures") {
    // Each view has one square emitter, in its top left quadrant; +x or the view's right, +y.
    const std::pair<std::string, std::string> views[] = {
        {"0 0 5  0 0 0", "-0.8 0.5 0  0.4 0 0  0 0.6 0"},    // right: +x
        {"0 0 -5  0 0 0", "0.8 0.5 0  -0.4 0 0  0 0.6 0"},   // right: -x
        {"5 0 0  0 0 0", "0 0.5 0.8  0 0 -0.4  0 0.6 0"},    // right: -z
        {"-5 2 0  0 2 0", "0 2.5 -0.8  0 0 0.4  0 0.6 0"}};  // right: +z
    for (const auto& view : views)
        for (const Size size : {Size{64, 32}, Size{32, 64}, Size{48, 48}, Size{90, 31}}) {
            const int w = size.width, h = size.height;
            INFO(view.first, ", ", w, "x", h);
            const Place place("camera " + view.first + "  40\nlight l 0.5 0.25 1\nquad " +
                              view.second + " l\n");
            place.render("--spp 16 --depth 0 -o image.pfm -o image.png --size " +
                         std::to_string(w) + "x" + std::to_string(h));
            const Image image = read_pfm(place / "image.pfm");
            const Decoded png = decode_png(place.read("image.png"));
            REQUIRE(said(image.width, image.height) == said(w, h));
            const Bright b = bright(image);
            CHECK(b.right < w / 2);
            CHECK(b.bottom < h / 2);
            // The square's centre, (-0.6, 0.8), is 5 away; a pixel is 2 tan(20 degrees) / h wide.
            const double pixel = 2 * std::tan(20 * std::numbers::pi / 180) / h;
            CHECK(std::abs(b.x - (w / 2.0 - 0.6 / 5 / pixel)) < 0.3);
            CHECK(std::abs(b.y - (h / 2.0 - 0.8 / 5 / pixel)) < 0.3);
            CHECK(std::abs(b.width() - 0.4 / 5 / pixel) < 2.01);
            CHECK(std::abs(b.height() - 0.6 / 5 / pixel) < 2.01);
            CHECK(b.sum == about(0.5 * (0.4 / 5 / pixel) * (0.6 / 5 / pixel), 0.1));
            // The channels are in order; the PNG shows the same.
            const int x = int(b.x), y = int(b.y);
            CHECK(image.at(x, y) == std::array<float, 3>{0.5f, 0.25f, 1});
            std::vector<int> bytes;
            for (const auto& p : image.pixels)
                for (float channel : p) bytes.push_back(int(to_byte(double(channel))));
            CHECK((png.width == w && png.bytes == bytes));
        }
}

// film/image.h  1  an image: linear values, row by row
#pragma once
#include <array>
#include <cmath>
#include <vector>

namespace penumbra {

// Row by row from the top left pixel (0,0); linear values.  Starts as NaN, so that an unwritten
// pixel is an error and not a black dot.
struct Image {
    int width = 0, height = 0;
    std::vector<std::array<float, 3>> pixels;

    Image() = default;
    Image(int w, int h) : width(w), height(h), pixels(size_t(w) * size_t(h), {NAN, NAN, NAN}) {}
    std::array<float, 3>& at(int x, int y) { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
    const std::array<float, 3>& at(int x, int y) const {
        return pixels[size_t(y) * size_t(width) + size_t(x)];
    }
};

}  // namespace penumbra

// film/variegated.h  an image of distinct numbers
#pragma once
#include "film/image.h"

namespace penumbra {

using Colour = std::array<float, 3>;

// All values differ in every pixel and channel, with signs, zeros and subnormal numbers.
inline Image variegated(int width, int height) {
    Image image(width, height);
    float k = 0;
    for (Colour& pixel : image.pixels)
        for (float& channel : pixel) {
            channel = (k - 7) * 0.37f;
            ++k;
        }
    image.at(0, 0) = {0, -0.0f, 1e-42f};
    return image;
}

}  // namespace penumbra

using namespace penumbra;

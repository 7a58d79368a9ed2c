// film/spread.h  images of known noise, and the measured spread of images between seeds
#pragma once
#include "base/moments.h"
#include "film/fill.h"

// Two images of different seeds differ by both their errors, whatever their common bias is: half
// the mean square of their difference is, on average, the d^2 that both estimate.
class Spread {
public:
    // Adds an image and its estimate of d^2.
    void add(const Image& image, double d2) {
        stated_.add(d2);
        if (stated_.n % 2 == 0) {
            Moments squares;
            for (size_t i = 0; i < image.pixels.size(); ++i)
                for (size_t c = 0; c < 3; ++c)
                    squares.add(square(double(image.pixels[i][c]) - double(last_.pixels[i][c])));
            excess_.add(squares.mean / 2 - (d2 + last_d2_) / 2);
        }
        last_ = image, last_d2_ = d2;
    }

    // Measured error over estimated error: 1 is right.
    oracle::Estimate ratio() const {
        return {1 + excess_.mean / stated_.mean, excess_.standard_error() / stated_.mean,
                double(excess_.n) - 1};
    }
    const Moments& stated() const { return stated_; }

private:
    Moments stated_, excess_;  // excess: measured minus estimated, per pair
    Image last_;
    double last_d2_ = 0;
};

// Noise differs by 100 from left to right; some rows are smooth, others have an edge.
inline rgb heteroscedastic(int x, int y, vec2 u) {
    const real scale = real(std::exp2(-0.3 * x));
    const real v = y % 3 == 0 ? real(u.x + u.y < real(0.7)) : u.x * u.y;
    return scale * rgb{v, 2 * v, u.x} + rgb{1, 0, 0};
}

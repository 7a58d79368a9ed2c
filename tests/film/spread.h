// film/spread.h  images of films whose spread from seed to seed is known, or is measured
#pragma once
#include "base/moments.h"
#include "film/fill.h"

// Two images of different seeds differ by both their errors, whatever bias they share: half the
// mean square of their difference is what both state in the mean.
class Spread {
public:
    // An image, and its d^2 as it states it.
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

    // Measured over stated: 1.
    oracle::Estimate ratio() const {
        return {1 + excess_.mean / stated_.mean, excess_.standard_error() / stated_.mean,
                double(excess_.n) - 1};
    }
    const Moments& stated() const { return stated_; }

private:
    static double square(double x) { return x * x; }
    Moments stated_, excess_;  // excess: what is measured less what is stated, a pair at a time
    Image last_;
    double last_d2_ = 0;
};

// An image whose noise differs by 100 from left to right, smooth in places, with an edge in others.
inline rgb heteroscedastic(int x, int y, vec2 u) {
    const real scale = real(std::exp2(-0.3 * x));
    const real v = y % 3 == 0 ? real(u.x + u.y < real(0.7)) : u.x * u.y;
    return scale * rgb{v, 2 * v, u.x} + rgb{1, 0, 0};
}

// labs/trade_errors.h  4  errors of runs against a reference whose own error is known
#pragma once
#include "labs/seeds.h"
#include "labs/trade_data.h"

namespace trade {

// The mean of several images, f; its d_rel, by their spread; the mean square of its numbers.
struct Reference {
    Image image;
    double error = 0, mean_square = 1;
};

inline Reference reference_of(const Series& runs) {
    const double n = double(runs.images.size());
    Reference r{Image(runs.images[0].width, runs.images[0].height)};
    for (size_t i = 0; i < r.image.pixels.size(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0;
            for (const Image& image : runs.images) sum += double(image.pixels[i][c]);
            r.image.pixels[i][c] = float(sum / n);
        }
    const double noise = variance_between(runs) / n;
    r.mean_square = mean_square(runs) - noise;
    r.error = std::sqrt(noise / r.mean_square);
    return r;
}

struct Error {
    double value = NAN, standard_error = NAN;
};

// The d_rel of what the images g are of, one image's: E|g - f|^2 is the square of that error and
// of the reference's own, for their seeds are different.  Every pixel of every image is a sample of
// it.  NAN: smaller than what the reference shows.
inline Error error_of(const std::vector<Image>& images, const Reference& f) {
    Moments m;
    for (const Image& g : images)
        for (size_t i = 0; i < g.pixels.size(); ++i) {
            double sum = 0;
            for (size_t c = 0; c < 3; ++c) {
                const double off = double(g.pixels[i][c]) - double(f.image.pixels[i][c]);
                sum += off * off / 3;
            }
            m.add(sum / f.mean_square);
        }
    const double square = m.mean - f.error * f.error;
    if (!(square > m.standard_error())) return {};
    return {std::sqrt(square), m.standard_error() / (2 * std::sqrt(square))};
}

}  // namespace trade

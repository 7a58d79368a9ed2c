// film/weights.h  3  weights: more samples where the neighbours are noisy
#pragma once
#include "film/film.h"

namespace penumbra {

// The mean of a pixel's neighbours; NaN: it has none.
inline double mean_around(const std::vector<float>& of, Size size, int x, int y) {
    double sum = 0, count = 0;
    for (int v = std::max(0, y - 1); v <= std::min(size.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(size.width - 1, x + 1); ++u)
            if (u != x || v != y)
                sum += double(of[size_t(v) * size_t(size.width) + size_t(u)]), ++count;
    return sum / count;
}

inline constexpr uint32_t typical_weight = 2;  // of a pixel of mean noise

// The power of two in 1 ... max_weight nearest to 2 r^(4/5), in ratio.  NaN, for a pixel
// without neighbours or a picture without noise, counts as r = 1.
inline uint8_t weight_of(double r) {
    if (std::isnan(r)) return typical_weight;
    const double r4 = r * r * r * r;
    uint32_t w = 1;
    // 2 r^(4/5) > sqrt(2) w  <=>  r^4 > w^5 / sqrt(32)
    while (w < max_weight && r4 > double(w * w * w * w * w) / std::sqrt(32.0)) w *= 2;
    return uint8_t(w);
}

// Weights by the standard deviations of samples, up to a factor: r is the mean of the neighbours
// over the mean of all pixels of the other colour of a checkerboard.  A pixel's own samples never
// influence its weight, so that its mean stays unbiased.  Where the error of a pixel falls as
// deviation / n^gamma, n in proportion to deviation^(2 / (2 gamma + 1)) minimises the MSE for given
// work: the power is 1 for gamma = 1/2 (Neyman 1934), and 4/5 for 3/4, typical of Sobol' points,
// which fill a square best by powers of two.  See reference/halves.md.
inline std::vector<uint8_t> weights_of(const std::vector<float>& deviation, Size size) {
    const size_t w = size_t(size.width);
    double sum[2] = {}, count[2] = {};
    for (size_t i = 0; i < deviation.size(); ++i) {
        const size_t colour = (i % w + i / w) & 1;
        sum[colour] += double(deviation[i]), ++count[colour];
    }
    std::vector<uint8_t> weights(deviation.size());
    for (size_t i = 0; i < deviation.size(); ++i) {
        const size_t other = (i % w + i / w + 1) & 1;
        const double around = mean_around(deviation, size, int(i % w), int(i / w));
        weights[i] = weight_of(around / (sum[other] / count[other]));
    }
    return weights;
}

// Samples of each replication in the pilot; least weight of a pixel that rarely meets bright light.
inline constexpr uint64_t pilot_samples = 4;
inline constexpr uint8_t min_of_noisy = 4;

// Chooses weights by the pilot, which all blocks have; those of `noisy` pixels are 4 or more.
inline void choose_weights(Film& film, const std::vector<size_t>& noisy = {}) {
    film.weight = weights_of(film.pilot_deviation, film.size);
    for (size_t i : noisy) film.weight[i] = std::max(film.weight[i], min_of_noisy);
    film.pilot_deviation = std::vector<float>();  // with its memory
    for (NearMisses& group : film.near) group.end_pilot();
    film.is_pilot = false;
    film.pilot = film.samples_done[0];
    film.samples_done.assign(film.samples_done.size(), 0);
}

}  // namespace penumbra

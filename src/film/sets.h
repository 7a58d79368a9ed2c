// film/sets.h  2  how many independent sets of samples each pixel has
//
// A set is a point set with a randomisation of its own, n samples of a pixel.  One set is the best
// image for its samples, but says nothing about its error; the spread of several does.  So pixels
// whose neighbours are noisy have more of them, which is also where samples pay best, and of the
// others some have a second set that is not shown and only measures.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/rng.h"
#include "base/vec.h"
#include "base/words.h"

struct Sets {
    uint32_t shown = 1;  // the pixel is the mean of these
    // Of one set: the probability that another one was drawn to measure it; 0: none was drawn.
    double chance = 0;

    uint32_t count() const { return shown + (chance > 0); }
};

// Of a pixel.
inline double mean_count(const std::vector<Sets>& sets) {
    double sum = 0;
    for (const Sets& s : sets) sum += s.count();
    return sum / double(sets.size());
}

// How sets are shared out; by `make calibration`.
struct Allocation {
    double factor = 1.25;   // of sqrt(noise around / noise elsewhere)
    double most = 8;        // sets of a pixel
    double measured = 512;  // pixels, at least, were all alike: their error is known to 3 %
};

// Samples of the first set after which the others are chosen.
inline constexpr uint64_t samples_before_sets = 16;

// Mean of what is at the up to eight pixels around (x, y), without its own.
inline double mean_around(const std::vector<double>& values, Size size, int x, int y) {
    double sum = 0;
    int n = 0;
    for (int v = std::max(0, y - 1); v <= std::min(size.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(size.width - 1, x + 1); ++u)
            if (u != x || v != y) sum += values[size_t(v) * size_t(size.width) + size_t(u)], ++n;
    return n ? sum / n : 0;
}

// From the noise of every pixel: the variance of its first set's mean, as far as its samples tell
// it.  The time to a squared error is least where samples are in proportion to the root of their
// variance (Neyman 1934): sqrt(noise around / noise elsewhere) sets are shown, times a factor by
// measurement (`make calibration`), since elsewhere noise falls as well; rounded, at most 8.
// A pixel's own samples have no say in that, so that its mean stays unbiased.  They do have one in
// whether it is measured: by chance, and the more likely the noisier it is (Horvitz, Thompson
// 1952).
inline std::vector<Sets> sets_where_noise_is(const std::vector<double>& noise, Size size,
                                             uint64_t seed, const Allocation& by = {}) {
    const double least_chance = std::max(1.0 / 32, by.measured / 2 / double(noise.size()));
    // Sums before each pixel and after it: the sum of all less its own would depend on it by
    // rounding.
    double before = 0;
    std::vector<double> after(noise.size() + 1);
    for (size_t i = noise.size(); i > 0; --i) after[i - 1] = after[i] + noise[i - 1];
    const double sum = after[0], others = std::max<double>(1, double(noise.size()) - 1);
    std::vector<Sets> sets(noise.size());
    for (size_t i = 0; i < noise.size(); before += noise[i++]) {
        const int x = int(i % size_t(size.width)), y = int(i / size_t(size.width));
        const double around = mean_around(noise, size, x, y);
        const double elsewhere = (before + after[i + 1]) / others;
        if (around > 0 && std::isfinite(around))
            sets[i].shown =
                uint32_t(std::clamp(by.factor * std::sqrt(around / elsewhere) + 0.5, 1.0, by.most));
        if (sets[i].shown > 1) continue;
        const double relative = sum > 0 ? noise[i] * double(noise.size()) / sum : 0;
        const double chance = std::min(1.0, least_chance * (1 + relative));
        const bool drawn = to_unit(hash(hash(hash(0, seed), i), UINT64_MAX / 2)) < chance;
        if (drawn) sets[i].chance = chance;
    }
    return sets;
}

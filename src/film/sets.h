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

// In a pixel, at most.
inline constexpr uint64_t most_sets = 1024;

struct Sets {
    uint32_t shown = 1;  // the pixel is the mean of these
    // Of one set: the probability that another one was drawn to measure it; 0: none was drawn.
    float chance = 0;

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

// ---- Noise around, and elsewhere ----------------------------------------------------------------

// Rows of a picture, and the noise of their pixels: the variance of a first set's mean, as far as
// its samples tell it.
struct NoiseOfRows {
    Size picture;
    int first = 0, rows = 0;
    std::vector<double> noise;

    double at(int x, int y) const {
        return noise[size_t(y - first) * size_t(picture.width) + size_t(x)];
    }
};

// Mean of the up to eight pixels around (x, y), without its own.
inline double mean_around(const NoiseOfRows& n, int x, int y) {
    double sum = 0;
    int count = 0;
    for (int v = std::max(n.first, y - 1); v <= std::min(n.first + n.rows - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(n.picture.width - 1, x + 1); ++u)
            if (u != x || v != y) sum += n.at(u, v), ++count;
    return count ? sum / count : 0;
}

// The pixels whose noise stands for that of the picture: all of a small one, of a large one some,
// each at random in an equal part, so that who renders a few rows need not see the others.
class Survey {
public:
    explicit Survey(Size picture, size_t most = 32768)
        : all_(size_t(picture.width) * size_t(picture.height)), count_(std::min(all_, most)) {}

    size_t count() const { return count_; }
    size_t pixel(size_t k) const {
        const size_t from = part(k), n = part(k + 1) - from;
        return from + size_t(hash(k, all_) % n);
    }
    // Which of them pixel i would be, and whether it is.
    size_t nearest(size_t i) const {
        size_t k = size_t(double(i) / double(all_) * double(count_));
        while (k > 0 && part(k) > i) --k;
        while (k + 1 < count_ && part(k + 1) <= i) ++k;
        return k;
    }
    bool has(size_t i) const { return pixel(nearest(i)) == i; }

private:
    const size_t all_, count_;
    size_t part(size_t k) const { return k * (all_ / count_) + std::min(k, all_ % count_); }
};

// What the survey found.
class NoiseElsewhere {
public:
    NoiseElsewhere(const Survey& survey, const std::vector<double>& noise)
        : survey_(survey), before_(noise.size() + 1), after_(noise.size() + 1) {
        // Sums before each pixel and after it: the sum of all less its own would depend on it by
        // rounding.
        for (size_t k = 0; k < noise.size(); ++k) before_[k + 1] = before_[k] + noise[k];
        for (size_t k = noise.size(); k > 0; --k) after_[k - 1] = after_[k] + noise[k - 1];
    }

    double mean() const { return after_[0] / double(survey_.count()); }
    // Without pixel i.
    double mean_without(size_t i) const {
        const size_t k = survey_.nearest(i), n = survey_.count();
        if (survey_.pixel(k) != i) return mean();
        return (before_[k] + after_[k + 1]) / std::max<double>(1, double(n) - 1);
    }

private:
    const Survey survey_;
    std::vector<double> before_, after_;
};

// ---- The choice ---------------------------------------------------------------------------------

// For `rows` rows from row `first` on, of which `around` knows the noise, and that of the rows next
// to them.  The time to a squared error is least where samples are in proportion to the root of
// their variance (Neyman 1934): sqrt(noise around / noise elsewhere) sets are shown, times a factor
// by measurement (`make calibration`), since elsewhere noise falls as well; rounded, at most 8.  A
// pixel's own samples have no say in that, so that its mean stays unbiased.  They do have one in
// whether it is measured: by chance, and the more likely the noisier it is (Horvitz, Thompson
// 1952).
inline std::vector<Sets> sets_where_noise_is(const NoiseOfRows& around, int first, int rows,
                                             const NoiseElsewhere& elsewhere, uint64_t seed,
                                             const Allocation& by = {}) {
    const size_t width = size_t(around.picture.width);
    const double pixels = double(width) * around.picture.height, mean = elsewhere.mean();
    const double least_chance = std::max(1.0 / 32, by.measured / 2 / pixels);
    std::vector<Sets> sets(width * size_t(rows));
    for (size_t k = 0; k < sets.size(); ++k) {
        const int x = int(k % width), y = first + int(k / width);
        const size_t i = size_t(y) * width + size_t(x);
        const double here = mean_around(around, x, y);
        if (here > 0 && std::isfinite(here)) {
            const double ratio = here / elsewhere.mean_without(i);
            sets[k].shown = uint32_t(std::clamp(by.factor * std::sqrt(ratio) + 0.5, 1.0, by.most));
        }
        if (sets[k].shown > 1) continue;
        const double relative = mean > 0 ? around.at(x, y) / mean : 0;
        const float chance = float(std::min(1.0, least_chance * (1 + relative)));
        const uint64_t bits = hash(hash(hash(0, seed), i), UINT64_MAX / 2);
        if (double(to_unit(bits)) < double(chance)) sets[k].chance = chance;
    }
    return sets;
}

// For a whole picture.
inline std::vector<Sets> sets_where_noise_is(std::vector<double> noise, Size picture, uint64_t seed,
                                             const Allocation& by = {}) {
    const Survey survey(picture);
    std::vector<double> found;
    for (size_t k = 0; k < survey.count(); ++k) found.push_back(noise[survey.pixel(k)]);
    const NoiseElsewhere elsewhere(survey, found);
    return sets_where_noise_is({picture, 0, picture.height, std::move(noise)}, 0, picture.height,
                               elsewhere, seed, by);
}

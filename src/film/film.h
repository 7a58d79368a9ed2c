// film/film.h  2  a film: sums of samples, in independent replications of each pixel
//
// A picture is the mean of two independent half-pictures, and half their difference is its error.
// A half is one of K = 2 replications (small pictures have more): pixel x has w(x) n samples in
// each, with a randomisation of its own.
// The weight w(x) is chosen once, by the noise of the neighbours in a pilot.
#pragma once
#include <cmath>
#include <functional>
#include <span>
#include <tuple>

#include "base/stats.h"
#include "film/image.h"
#include "film/near_misses.h"
#include "path/sampler.h"

namespace penumbra {

// Results of samples other than their radiance.
struct Tally {
    uint64_t rays = 0;
    uint64_t bad = 0;       // samples that an image file cannot hold
    PixelSample first_bad;  // the first of them
    double share = 1;  // 1 / (K w) for K replications of a pixel of weight w, which is 1 in a pilot
    std::vector<NearMisses> near = {};  // sums for each group of lights of the film

    void add_bad(uint64_t count, const PixelSample& first) {
        auto order = [](const PixelSample& a) { return std::tuple(a.i, a.replication, a.y, a.x); };
        if (count > 0 && (bad == 0 || order(first) < order(first_bad))) first_bad = first;
        bad += count;
    }
    void add(const Tally& other) {
        rays += other.rays, add_bad(other.bad, other.first_bad);
        for (size_t g = 0; g < near.size(); ++g) near[g].add(other.near[g]);
    }
};

inline bool fits_float(rgb L) {
    return std::isfinite(float(L.x)) && std::isfinite(float(L.y)) && std::isfinite(float(L.z));
}

// The radiance of a sample, and its tally.  Calls come from several threads.
using SampleFunction = std::function<rgb(const PixelSample&, Tally&)>;

// A sum of samples, per channel.
using Sum = std::array<double, 3>;
inline void add_to(Sum& sum, rgb sample) {
    for (size_t c = 0; c < 3; ++c) sum[c] += double(sample.*axis[c]);
}

inline constexpr uint32_t max_replications = 1024, max_weight = 16;

// The file of a film holds these arrays.
struct Film {
    Size size;
    int first_row = 0;                        // row of the whole picture where this band begins
    uint32_t replications = 2;                // K of every pixel
    bool is_pilot = false;                    // weights are not yet chosen, and are 1
    uint64_t pilot = 0;                       // samples of a replication when they were chosen
    std::vector<Sum> sum = {};                // K of pixel 0, K of pixel 1 ...
    std::vector<uint8_t> weight = {};         // w of each pixel
    std::vector<float> pilot_deviation = {};  // root of the sum of squared deviations
    std::vector<uint64_t> samples_done = {};  // n of each block of pixels
    std::vector<NearMisses> near = {};        // groups of lights

    size_t pixels() const { return size_t(size.width) * size_t(size.height); }

    // Threads take pixels in blocks, small enough that a small picture has work for all of them.
    size_t block_size() const { return std::clamp<size_t>(pixels() / 256, 1, 256); }
    size_t blocks() const { return (pixels() + block_size() - 1) / block_size(); }
    size_t begin(size_t block) const { return block * block_size(); }
    size_t end(size_t block) const { return std::min(pixels(), begin(block) + block_size()); }

    // Samples of each replication of a pixel, at n or more.
    uint64_t samples(size_t pixel, uint64_t n = 0) const {
        return std::max(pilot, weight[pixel] * std::max(n, samples_done[pixel / block_size()]));
    }
    uint64_t min_samples_done() const { return std::ranges::min(samples_done); }
    uint64_t max_samples_done() const { return std::ranges::max(samples_done); }
    bool has_samples() const { return pilot + min_samples_done() > 0; }  // in all pixels
    PixelSample sample_of(size_t pixel, uint64_t s, uint32_t replication) const {
        const size_t width = size_t(size.width);
        return {int(pixel % width), first_row + int(pixel / width), s, replication};
    }
    // Mean samples per pixel, in all replications together, at n or more.
    double samples_per_pixel(uint64_t n = 0) const {
        double all = 0;
        for (size_t i = 0; i < pixels(); ++i) all += double(samples(i, n));
        return all * replications / double(pixels());
    }
};

// A film with K replications of each pixel; is_pilot: weights are chosen later.
inline Film make_film(Size size, uint32_t K, bool is_pilot, int first_row = 0) {
    Film film{size, first_row, K, is_pilot};
    film.sum.resize(film.pixels() * K);
    film.weight.assign(film.pixels(), 1);
    film.pilot_deviation.resize(is_pilot ? film.pixels() : 0);
    film.samples_done.resize(film.blocks());
    return film;
}

// ---- Pixels -------------------------------------------------------------------------------------

// The mean of all samples of a pixel, in K independent replications, and the variance of that mean.
// The variance of a replication is taken to be in proportion to 1 / (number of its samples).
struct Pixel {
    double K = 0, samples = 0;
    Sum sum{}, squares{};  // squares: sum over replications of n (mean - value)^2

    // Adds a replication of n samples (Chan, Golub, LeVeque 1983).
    void add(const Sum& other, uint64_t n) {
        const double of_other = double(n), all = samples + of_other;
        if (n == 0) return;
        for (size_t c = 0; c < 3; ++c) {
            if (K > 0)
                squares[c] += square(other[c] / of_other - value(c)) * (samples * of_other / all);
            sum[c] += other[c];
        }
        samples = all, ++K;
    }
    double value(size_t c) const { return sum[c] / samples; }  // NaN: it has no sample
    // Unbiased for equal numbers of samples.  NaN for fewer than two replications.
    double variance(size_t c) const { return squares[c] / (samples * (K - 1)); }
};

inline Pixel pixel_of(const Film& film, size_t i) {
    Pixel pixel;
    for (size_t k = 0; k < film.replications; ++k)
        pixel.add(film.sum[i * film.replications + k], film.samples(i));
    return pixel;
}

// NaN where a pixel has no sample.
inline Image image_of(const Film& film) {
    Image image(film.size.width, film.size.height);
    for (size_t i = 0; i < film.pixels(); ++i) {
        const Pixel pixel = pixel_of(film, i);
        for (size_t c = 0; c < 3; ++c) image.pixels[i][c] = float(pixel.value(c));
    }
    return image;
}

// ---- Samples ------------------------------------------------------------------------------------

// The root of the sum of squared deviations from the mean, over all channels, after one sample more
// (Welford 1962).  `sums` are of the `count` samples before it.
inline float with_deviation(float root, std::span<const Sum> sums, double count, rgb sample) {
    double squares = square(double(root));
    for (size_t c = 0; c < 3 && count > 0; ++c) {
        double all = 0;
        for (const Sum& sum : sums) all += sum[c];
        squares += square(double(sample.*axis[c]) - all / count) * (count / (count + 1));
    }
    return float(std::sqrt(squares));
}

// Adds samples, in order, to all replications of a block until it has n.  The image does not depend
// on passes and threads.  If `radiance` throws, the block stays as it was.
inline void add_samples(Film& film, size_t block, uint64_t n, const SampleFunction& radiance,
                        Tally& tally) {
    const size_t from = film.begin(block), to = film.end(block), K = film.replications;
    std::vector<Sum> sums(&film.sum[from * K], &film.sum[from * K] + (to - from) * K);
    std::vector<float> deviation(film.is_pilot ? to - from : 0);
    for (size_t i = from; i < to; ++i) {
        const std::span<Sum> sum(&sums[(i - from) * K], K);
        const uint64_t first = film.samples(i), last = film.samples(i, n);
        double count = double(K * first);
        if (film.is_pilot) deviation[i - from] = film.pilot_deviation[i];
        tally.share = 1.0 / double(K * film.weight[i]);
        for (uint32_t k = 0; k < K; ++k)
            for (uint64_t s = first; s < last; ++s, ++count) {
                const PixelSample which = film.sample_of(i, s, k);
                const rgb sample = radiance(which, tally);
                if (!fits_float(sample)) tally.add_bad(1, which);
                if (film.is_pilot)
                    deviation[i - from] = with_deviation(deviation[i - from], sum, count, sample);
                add_to(sum[k], sample);
            }
    }
    std::ranges::copy(sums, film.sum.begin() + ptrdiff_t(from * K));
    std::ranges::copy(deviation,
                      film.pilot_deviation.begin() + ptrdiff_t(film.is_pilot ? from : 0));
    film.samples_done[block] = std::max(film.samples_done[block], n);
}

}  // namespace penumbra

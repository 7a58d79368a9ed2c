// film/film.h  2  where samples gather
#pragma once
#include <atomic>
#include <mutex>
#include <tuple>

#include "film/image.h"
#include "film/passes.h"

// ---- A film of any kind of pixel ----------------------------------------------------------------

// A sample that no image can hold.
struct NonFinite {
    uint64_t sample = UINT64_MAX;
    int x = 0, y = 0;
};

// Pixels that take their samples in order: the image is the same however passes and threads divide
// them.  A pass adds to a copy, which counts only once it is complete.  A Pixel has a type Sample,
// add(i, sample) for sample i, fits(sample), whether that is finite and stays so in a file, and
// unwritten(), which is no number: a pixel that nobody wrote is an error and not a black dot.
template <class Pixel>
class Film {
public:
    using Sample = typename Pixel::Sample;
    explicit Film(Size s)
        : size(s),
          pixels_(size_t(s.width) * size_t(s.height), Pixel::unwritten()),
          next_(pixels_) {}

    const Size size;
    uint64_t samples() const { return samples_; }  // per pixel

    // Row y of the pass that brings n more samples: L(x, i) is sample i of pixel (x, y).  Once
    // `interrupted` the rest is left out, and the pass must not end.
    template <class Radiance>
    void add_row(int y, uint64_t n, Radiance L) {
        for (int x = 0; x < size.width; ++x) {
            const size_t index = size_t(y) * size_t(size.width) + size_t(x);
            Pixel pixel = samples_ > 0 ? pixels_[index] : Pixel();
            for (uint64_t i = samples_; i < samples_ + n; ++i) {
                if (interrupted) return;
                const Sample value = L(x, i);
                if (!Pixel::fits(value)) report({i, x, y});
                pixel.add(i, value);
            }
            next_[index] = pixel;
        }
    }

    void end_pass(uint64_t n) {
        pixels_.swap(next_);
        samples_ += n;
    }

    // How many samples did not fit, and the first of them.
    uint64_t non_finite() const { return non_finite_; }
    const NonFinite& first_non_finite() const { return first_; }

    // The image of value(pixel, channel); NaN before the first pass.
    template <class Value>
    Image image_of(Value value) const {
        Image image(size.width, size.height);
        for (size_t i = 0; i < pixels_.size() && samples_ > 0; ++i)
            for (size_t c = 0; c < 3; ++c) image.pixels[i][c] = float(value(pixels_[i], c));
        return image;
    }

    // The mean of value(pixel, channel) over the pixels; NaN before the first pass.
    template <class Value>
    std::array<double, 3> mean_of(Value value) const {
        std::array<double, 3> mean{};
        for (size_t c = 0; c < 3; ++c) {
            for (const Pixel& pixel : pixels_) mean[c] += value(pixel, c);
            mean[c] = samples_ > 0 ? mean[c] / double(pixels_.size()) : double(NAN);
        }
        return mean;
    }

private:
    std::vector<Pixel> pixels_, next_;
    uint64_t samples_ = 0;
    std::atomic<uint64_t> non_finite_ = 0;
    NonFinite first_;
    std::mutex mutex_;

    void report(const NonFinite& bad) {
        std::lock_guard lock(mutex_);
        ++non_finite_;
        auto order = [](const NonFinite& b) { return std::tuple(b.sample, b.y, b.x); };
        if (order(bad) < order(first_)) first_ = bad;
    }
};

// ---- Means --------------------------------------------------------------------------------------

// Whether an image file can hold it; a mean of such values fits as well.
inline bool fits_float(rgb L) {
    return std::isfinite(float(L.x)) && std::isfinite(float(L.y)) && std::isfinite(float(L.z));
}

// Sums of samples.
struct MeanPixel {
    using Sample = rgb;
    using Sums = std::array<double, 3>;  // one a channel
    std::array<Sums, 2> half{};          // of the even and the odd samples
    Sums m2{};                           // of squared distances to the mean (Welford 1962)

    static MeanPixel unwritten() {
        constexpr Sums none = {NAN, NAN, NAN};
        return {{none, none}, {}};
    }
    static bool fits(rgb L) { return fits_float(L); }
    void add(uint64_t i, rgb L) {
        for (size_t c = 0; c < 3; ++c) {
            const double value = double(L.*axis[c]), n = double(i);
            if (i > 0) m2[c] += sqr(value - sum(c) / n) * (n / (n + 1));
            half[i % 2][c] += value;
        }
    }
    double sum(size_t c) const { return half[0][c] + half[1][c]; }

private:
    static double sqr(double x) { return x * x; }
};

inline auto value_in(const Film<MeanPixel>& film) {
    return [n = double(film.samples())](const MeanPixel& p, size_t c) { return p.sum(c) / n; };
}

inline Image image_of(const Film<MeanPixel>& film) { return film.image_of(value_in(film)); }

// ---- Variances of means -------------------------------------------------------------------------

// What tells the variance of a pixel's mean: the spread of the samples if they are independent, the
// difference of the two halves (even and odd samples) if only those are, or nothing.
enum class VarianceFrom { samples, halves, nothing };

// From the values a and b of the halves of n samples, unbiased for means: (a - b)^2 na nb / n^2.
inline double variance_of_halves(double a, double b, uint64_t samples) {
    const double n = double(samples), nb = double(samples / 2), na = n - nb;
    return (a - b) * (a - b) * na * nb / (n * n);
}

// That of a pixel's mean, in double.  Unbiased; NaN if not known.
inline auto variance_in(const Film<MeanPixel>& film, VarianceFrom from) {
    return [from, samples = film.samples()](const MeanPixel& p, size_t c) {
        const double n = double(samples), nb = double(samples / 2), na = n - nb;
        if (samples < 2 || from == VarianceFrom::nothing) return double(NAN);
        if (from == VarianceFrom::samples) return p.m2[c] / (n - 1) / n;
        return variance_of_halves(p.half[0][c] / na, p.half[1][c] / nb, samples);
    };
}

inline Image variance_of(const Film<MeanPixel>& film, VarianceFrom from) {
    return film.image_of(variance_in(film, from));
}

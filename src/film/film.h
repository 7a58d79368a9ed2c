// film/film.h  3  where samples gather
#pragma once
#include <atomic>
#include <mutex>
#include <tuple>

#include "film/image.h"
#include "film/passes.h"
#include "film/sets.h"

// ---- A film of any kind of pixel ----------------------------------------------------------------

// A sample that no image can hold.
struct NonFinite {
    uint64_t sample = UINT64_MAX;
    int x = 0, y = 0;
    uint32_t set = 0;
};

// Pixels that take their samples in order: the image is the same however passes and threads divide
// them.  A pass adds to a copy, which counts only once it is complete.  Each set of a pixel's
// samples has a Pixel of its own: it has a type Sample, add(i, sample) for sample i, fits(sample),
// whether that is finite and stays so in a file, noise(n), the variance of the mean as n samples
// tell it, and unwritten(), which is no number: a pixel that nobody wrote is an error and not a
// black dot.
template <class Pixel>
class Film {
public:
    using Sample = typename Pixel::Sample;
    explicit Film(Size s)
        : size(s),
          pixels_(size_t(s.width) * size_t(s.height), Pixel::unwritten()),
          next_(pixels_) {}

    const Size size;
    uint64_t samples() const { return samples_; }  // of every set

    // Row y of the pass that brings n more samples: L(x, i, set) is sample i of a set of pixel
    // (x, y).  Sets that were added since the last pass begin with sample 0.  Once `interrupted`
    // the rest is left out, and the pass must not end.
    template <class Radiance>
    void add_row(int y, uint64_t n, Radiance L) {
        for (int x = 0; x < size.width; ++x) {
            const size_t index = size_t(y) * size_t(size.width) + size_t(x), at = first(index);
            for (uint32_t set = 0; set < sets(index).count(); ++set) {
                const uint64_t before = set > 0 ? samples_of_others_ : samples_;
                Pixel pixel = before > 0 ? pixels_[at + set] : Pixel();
                for (uint64_t i = before; i < samples_ + n; ++i) {
                    if (interrupted) return;
                    const Sample value = L(x, i, set);
                    if (!Pixel::fits(value)) report({i, x, y, set});
                    pixel.add(i, value);
                }
                next_[at + set] = pixel;
            }
        }
    }

    void end_pass(uint64_t n) {
        pixels_.swap(next_);
        samples_ += n;
        samples_of_others_ = samples_;
    }

    // ---- Sets ----

    bool has_sets() const { return !sets_.empty(); }

    // From now on; once, between passes.  Until the next pass ends there is only the first of each.
    void add_sets(std::vector<Sets> sets) {
        sets_ = std::move(sets);
        first_.assign(1, 0);
        for (const Sets& s : sets_) first_.push_back(first_.back() + s.count());
        std::vector<Pixel> pixels(first_.back(), Pixel::unwritten());
        for (size_t i = 0; i < sets_.size(); ++i) pixels[first_[i]] = pixels_[i];
        pixels_ = std::move(pixels);
        next_ = pixels_;
        samples_of_others_ = 0;
    }

    // What sets_where_noise_is() is told.
    std::vector<double> noise() const {
        std::vector<double> noise;
        for (size_t i = 0; i < number_of_pixels(); ++i)
            noise.push_back(pixels_[first(i)].noise(samples_));
        return noise;
    }

    double sets_per_pixel() const {
        return others_are_complete() ? double(pixels_.size()) / double(number_of_pixels()) : 1;
    }

    size_t number_of_pixels() const { return size_t(size.width) * size_t(size.height); }

    // The sets of pixel number `index` that have samples; pixel(index, set) is one of them.
    Sets sets(size_t index) const { return has_sets() ? sets_[index] : Sets{}; }
    bool others_are_complete() const { return has_sets() && samples_of_others_ == samples_; }
    const Pixel& pixel(size_t index, uint32_t set) const { return pixels_[first(index) + set]; }

    // ---- What it holds ----

    // How many samples did not fit, and the first of them.
    uint64_t non_finite() const { return non_finite_; }
    const NonFinite& first_non_finite() const { return first_non_finite_; }

    // The image of value(pixel, channel), the mean of it over the sets that are shown; NaN before
    // the first pass.
    template <class Value>
    Image image_of(Value value) const {
        Image image(size.width, size.height);
        for (size_t i = 0; i < number_of_pixels() && samples_ > 0; ++i)
            for (size_t c = 0; c < 3; ++c) image.pixels[i][c] = float(shown(i, c, value));
        return image;
    }

    template <class Value>
    double shown(size_t index, size_t c, Value value) const {
        const uint32_t n = others_are_complete() ? sets(index).shown : 1;
        double sum = 0;
        for (uint32_t set = 0; set < n; ++set) sum += value(pixel(index, set), c);
        return sum / n;
    }

private:
    std::vector<Pixel> pixels_, next_;
    std::vector<Sets> sets_;     // of each pixel; empty: one
    std::vector<size_t> first_;  // where they begin in pixels_
    uint64_t samples_ = 0, samples_of_others_ = 0;
    std::atomic<uint64_t> non_finite_ = 0;
    NonFinite first_non_finite_;
    std::mutex mutex_;

    size_t first(size_t index) const { return has_sets() ? first_[index] : index; }

    void report(const NonFinite& bad) {
        std::lock_guard lock(mutex_);
        ++non_finite_;
        auto order = [](const NonFinite& b) { return std::tuple(b.sample, b.set, b.y, b.x); };
        if (order(bad) < order(first_non_finite_)) first_non_finite_ = bad;
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
    Sums sum{};
    Sums m2{};  // of squared distances to the mean (Welford 1962)

    static MeanPixel unwritten() { return {{NAN, NAN, NAN}, {}}; }
    static bool fits(rgb L) { return fits_float(L); }
    void add(uint64_t i, rgb L) {
        for (size_t c = 0; c < 3; ++c) {
            const double value = double(L.*axis[c]), n = double(i);
            if (i > 0) m2[c] += sqr(value - sum[c] / n) * (n / (n + 1));
            sum[c] += value;
        }
    }

    // Variance of the mean of n independent samples, all channels together.
    double noise(uint64_t n) const {
        return n < 2 ? 0 : (m2[0] + m2[1] + m2[2]) / double(n - 1) / double(n);
    }

private:
    static double sqr(double x) { return x * x; }
};

inline auto value_in(const Film<MeanPixel>& film) {
    return [n = double(film.samples())](const MeanPixel& p, size_t c) { return p.sum[c] / n; };
}

inline Image image_of(const Film<MeanPixel>& film) { return film.image_of(value_in(film)); }

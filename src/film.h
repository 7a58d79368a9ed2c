// film.h  floor 4  where samples gather, and when to stop
#pragma once
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>

#include "image.h"
#include "options.h"

// ---- Ctrl-C -----------------------------------------------------------------------------------

inline std::atomic<bool> interrupted = false;

// The first Ctrl-C asks for an end after the passes completed so far; a second one kills.
inline void catch_interrupt() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = true; };
    action.sa_flags = int(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
}

// ---- Film -------------------------------------------------------------------------------------

// Whether an image file can hold it; a mean of such values fits as well.
inline bool fits_float(rgb L) {
    return std::isfinite(float(L.x)) && std::isfinite(float(L.y)) && std::isfinite(float(L.z));
}

// A sample that is NaN or infinite, as float.
struct NonFinite {
    uint64_t sample = UINT64_MAX;
    int x = 0, y = 0;
    rgb L;
};

// Sums of samples, per pixel, in the order of the samples: the image is the same however passes
// and threads divide them.  A pass adds to a copy, which counts only once it is complete.
class Film {
public:
    explicit Film(Size size)
        : width(size.width),
          height(size.height),
          pixels_(size_t(width) * size_t(height)),
          next_(pixels_.size(), Pixel{{NAN, NAN, NAN}, {NAN, NAN, NAN}, {}}) {}

    const int width, height;
    uint64_t samples() const { return samples_; }  // per pixel

    // Row y of the pass that brings n more samples: L(x, i) is sample i of pixel (x, y).
    template <class Radiance>
    void add_row(int y, uint64_t n, Radiance L) {
        for (int x = 0; x < width; ++x) {
            const size_t index = size_t(y) * size_t(width) + size_t(x);
            Pixel pixel = pixels_[index];
            for (uint64_t i = samples_; i < samples_ + n; ++i) {
                const rgb value = L(x, i);
                if (!fits_float(value)) report({i, x, y, value});
                pixel.add(i, {double(value.x), double(value.y), double(value.z)});
            }
            next_[index] = pixel;
        }
    }

    void end_pass(uint64_t n) {
        pixels_.swap(next_);
        samples_ += n;
    }

    // How many samples were not finite, and the first of them.
    uint64_t non_finite() const { return non_finite_; }
    const NonFinite& first_non_finite() const { return first_; }

    // Means; NaN before the first pass.
    Image image() const {
        Image image(width, height);
        for (size_t i = 0; i < pixels_.size() && samples_ > 0; ++i)
            for (size_t c = 0; c < 3; ++c)
                image.pixels[i][c] = float(pixels_[i].sum(c) / double(samples_));
        return image;
    }

    // Estimates of the variance of those means, unbiased for an even number of samples.  From the
    // spread of the samples if they are independent; from the difference of the two halves (even
    // and odd samples) if only those are: for means A and B of nA and nB samples, (A - B)^2 nA nB /
    // n^2.  NaN if not known.
    enum class Estimate { samples, halves, none };
    Image variance(Estimate from) const {
        Image image(width, height);
        const double n = double(samples_), nb = double(samples_ / 2), na = n - nb;
        for (size_t i = 0; i < pixels_.size() && samples_ > 1 && from != Estimate::none; ++i)
            for (size_t c = 0; c < 3; ++c) {
                const Pixel& p = pixels_[i];
                const double halves = sqr(p.even[c] / na - p.odd[c] / nb) * na * nb / (n * n);
                image.pixels[i][c] =
                    float(from == Estimate::samples ? p.m2[c] / (n - 1) / n : halves);
            }
        return image;
    }

    // Means of the even (0) or odd (1) samples.
    Image half(size_t odd) const {
        Image image(width, height);
        const double n = double(odd ? samples_ / 2 : samples_ - samples_ / 2);
        for (size_t i = 0; i < pixels_.size() && n > 0; ++i)
            for (size_t c = 0; c < 3; ++c)
                image.pixels[i][c] = float((odd ? pixels_[i].odd : pixels_[i].even)[c] / n);
        return image;
    }

    // As from halves above, of any images that even and odd samples make.
    Image variance_of_halves(const Image& even, const Image& odd) const {
        Image image(width, height);
        const double n = double(samples_), nb = double(samples_ / 2), na = n - nb;
        for (size_t i = 0; i < pixels_.size(); ++i)
            for (size_t c = 0; c < 3; ++c)
                image.pixels[i][c] = float(
                    sqr(double(even.pixels[i][c]) - double(odd.pixels[i][c])) * na * nb / (n * n));
        return image;
    }

private:
    using Sums = std::array<double, 3>;  // one a channel
    struct Pixel {
        Sums even{}, odd{};  // of the even and the odd samples
        Sums m2{};           // of squared distances to the mean (Welford 1962)

        double sum(size_t c) const { return even[c] + odd[c]; }
        void add(uint64_t i, Sums value) {
            for (size_t c = 0; c < 3; ++c) {
                const double n = double(i);
                if (i > 0) m2[c] += sqr(value[c] - sum(c) / n) * (n / (n + 1));
                (i % 2 ? odd : even)[c] += value[c];
            }
        }
    };
    static double sqr(double x) { return x * x; }

    std::vector<Pixel> pixels_, next_;
    uint64_t samples_ = 0, non_finite_ = 0;
    NonFinite first_;
    std::mutex mutex_;

    void report(const NonFinite& bad) {
        std::lock_guard lock(mutex_);
        ++non_finite_;
        auto order = [](const NonFinite& b) { return std::tuple(b.sample, b.y, b.x); };
        if (order(bad) < order(first_)) first_ = bad;
    }
};

// What the user's samples allow to say about their variance.
inline Film::Estimate variance_estimate(const Options& o) {
    if (o.film != Weighting::mc) return Film::Estimate::none;
    if (o.sampler == SamplerKind::independent) return Film::Estimate::samples;
    return o.halves ? Film::Estimate::halves : Film::Estimate::none;
}

// ---- When to stop -----------------------------------------------------------------------------

// Passes long enough to keep the threads busy, short enough to stop soon.
class Schedule {
public:
    // Passes are multiples of `period` samples, but for the last of an uneven --spp.
    Schedule(const Options& o, uint64_t period) : options_(o), period_(period) {}

    // Samples per pixel of the next pass, after `samples` in `elapsed` seconds; 0: enough.  The
    // first pass always runs.
    uint64_t next(uint64_t samples, double elapsed) {
        if (samples > 0) {
            const double took = elapsed - started_;
            if (took < shortest) size_ *= 2;
            if (took > 2 * shortest) size_ = std::max<uint64_t>(1, size_ / 2);
        }
        started_ = elapsed;
        uint64_t periods = size_;
        if (options_.seconds > 0 && samples > 0) {
            const double left = options_.seconds - elapsed;
            const double per_period = elapsed / double(samples) * double(period_);
            if (left <= 0) return 0;
            if (left < per_period * double(periods))
                periods = std::max<uint64_t>(1, uint64_t(left / per_period));
        }
        const uint64_t n = periods * period_;
        return options_.spp ? std::min(n, options_.spp - samples) : n;
    }

private:
    static constexpr double shortest = 0.1;  // seconds
    const Options& options_;
    const uint64_t period_;
    uint64_t size_ = 1;  // periods a pass
    double started_ = 0;
};

// Calls row(y) for every y < height from several threads, and meanwhile() from this one ten times
// a second.  Returns early, with rows missing, once `interrupted`; then the answer is false.
template <class Row, class Meanwhile>
bool parallel_rows(int height, unsigned threads, Row row, Meanwhile meanwhile) {
    std::atomic<int> next = 0, done = 0;
    std::mutex mutex;
    std::condition_variable finished;
    unsigned running = std::min(threads, unsigned(height));
    std::vector<std::jthread> workers;
    for (unsigned i = running; i > 0; --i)
        workers.emplace_back([&] {
            for (int y; !interrupted && (y = next++) < height; ++done) row(y);
            std::lock_guard lock(mutex);
            --running;
            finished.notify_one();
        });
    std::unique_lock lock(mutex);
    while (!finished.wait_for(lock, std::chrono::milliseconds(100), [&] { return running == 0; }))
        meanwhile(double(done) / height);
    meanwhile(double(done) / height);
    return done == height;
}

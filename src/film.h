// film.h  floor 4  when to stop, what to say meanwhile, what to write
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

// A sample that is NaN or infinite.
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
          sums_(size_t(width) * size_t(height)),
          next_(sums_.size(), Sum{NAN, NAN, NAN}) {}

    const int width, height;
    uint64_t samples() const { return samples_; }  // per pixel

    // Row y of the pass that brings n more samples: L(x, i) is sample i of pixel (x, y).
    template <class Radiance>
    void add_row(int y, uint64_t n, Radiance L) {
        for (int x = 0; x < width; ++x) {
            const size_t pixel = size_t(y) * size_t(width) + size_t(x);
            Sum sum = sums_[pixel];
            for (uint64_t i = samples_; i < samples_ + n; ++i) {
                const rgb value = L(x, i);
                if (!is_finite(value)) report({i, x, y, value});
                sum[0] += double(value.x);
                sum[1] += double(value.y);
                sum[2] += double(value.z);
            }
            next_[pixel] = sum;
        }
    }

    void end_pass(uint64_t n) {
        sums_.swap(next_);
        samples_ += n;
    }

    // How many samples were not finite, and the first of them.
    uint64_t non_finite() const { return non_finite_; }
    const NonFinite& first_non_finite() const { return first_; }

    // Means; NaN before the first pass.
    Image image() const {
        Image image(width, height);
        if (samples_ == 0) return image;
        for (size_t i = 0; i < sums_.size(); ++i)
            for (size_t c = 0; c < 3; ++c)
                image.pixels[i][c] = float(sums_[i][c] / double(samples_));
        return image;
    }

private:
    using Sum = std::array<double, 3>;
    std::vector<Sum> sums_, next_;
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

// ---- Progress ---------------------------------------------------------------------------------

inline std::string fixed(double x, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, x);
    return text;
}

// On a terminal a bar that is drawn over itself, elsewhere a plain line now and then; on stderr.
class Progress {
public:
    explicit Progress(const Options& o) : options_(o), terminal_(::isatty(STDERR_FILENO) == 1) {}

    double elapsed() const { return std::chrono::duration<double>(clock::now() - start_).count(); }

    // `samples` so far, with the finished part of the running pass.
    void show(double samples) {
        const double now = elapsed();
        if (options_.quiet || now < next_) return;
        next_ = now + (terminal_ ? 0.1 : 2.0);
        double done = 0;
        if (options_.spp) done = samples / double(options_.spp);
        if (options_.seconds > 0) done = std::max(done, now / options_.seconds);
        done = std::min(done, 1.0);
        std::string left = done > 0 ? fixed(now / done - now, 1) + " s left" : "";
        std::string text =
            fixed(samples, 1) + " samples per pixel, " + fixed(now, 1) + " s elapsed, " + left;
        if (terminal_) {
            std::string bar(size_t(24 * done), '#');
            bar.resize(24, '.');
            std::fprintf(stderr, "\r[%s] %3.0f %%  %s\033[K", bar.c_str(), 100 * done,
                         text.c_str());
        } else {
            std::fprintf(stderr, "%3.0f %%  %s\n", 100 * done, text.c_str());
        }
        shown_ = true;
    }

    // The line that stays.
    void summary(const std::string& text) {
        if (options_.quiet) return;
        std::fprintf(stderr, "%s%s\n", shown_ && terminal_ ? "\r\033[K" : "", text.c_str());
    }

private:
    using clock = std::chrono::steady_clock;
    const Options& options_;
    const bool terminal_;
    const clock::time_point start_ = clock::now();
    double next_ = terminal_ ? 0.1 : 2.0;
    bool shown_ = false;
};

// ---- When to stop -----------------------------------------------------------------------------

// Passes long enough to keep the threads busy, short enough to stop soon.
class Schedule {
public:
    explicit Schedule(const Options& o) : options_(o) {}

    // Samples per pixel of the next pass, after `samples` in `elapsed` seconds; 0: enough.  The
    // first pass always runs.
    uint64_t next(uint64_t samples, double elapsed) {
        if (samples > 0) {
            const double took = elapsed - started_;
            if (took < shortest) size_ *= 2;
            if (took > 2 * shortest) size_ = std::max<uint64_t>(1, size_ / 2);
        }
        started_ = elapsed;
        uint64_t n = size_;
        if (options_.spp) n = std::min(n, options_.spp - samples);
        if (options_.seconds > 0 && samples > 0) {
            const double left = options_.seconds - elapsed, per_sample = elapsed / double(samples);
            if (left <= 0) return 0;
            n = std::clamp<uint64_t>(uint64_t(left / per_sample), 1, n);
        }
        return n;
    }

private:
    static constexpr double shortest = 0.1;  // seconds
    const Options& options_;
    uint64_t size_ = 1;
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

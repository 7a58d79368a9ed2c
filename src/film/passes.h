// film/passes.h  1  the one loop that renders: passes, threads, time, Ctrl-C
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

// ---- Ctrl-C -------------------------------------------------------------------------------------

// The signal that asks for an end, or 0.
inline std::atomic<int> interrupted = 0;

// The first Ctrl-C, or another signal to end, asks for an end after the passes completed so far; a
// second one kills.  What whoever started us ignores stays ignored.  A stderr that nobody reads is
// no reason to lose an image, and a file that grows too large is an error of its own.
inline void catch_interrupt() {
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        struct sigaction before {};
        action.sa_handler = [](int caught) { interrupted = caught; };
        action.sa_flags = int(SA_RESETHAND);
        sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
    for (int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

// ---- When to stop -------------------------------------------------------------------------------

// Whichever comes first; 0: no limit.
struct Target {
    uint64_t samples = 0;  // per pixel
    double seconds = 0;
    double error = 0;  // d_rel; see film/error.h
};

// Passes long enough to keep the threads busy, short enough to stop soon.
class Schedule {
public:
    // Passes are multiples of `period` samples, but for the last of an uneven target.
    Schedule(const Target& target, uint64_t period) : target_(target), period_(period) {}

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
        if (target_.seconds > 0 && samples > 0) {
            const double left = target_.seconds - elapsed;
            const double per_period = elapsed / double(samples) * double(period_);
            if (left <= 0) return 0;
            if (left < per_period * double(periods))
                periods = std::max<uint64_t>(1, uint64_t(left / per_period));
        }
        const uint64_t n = periods * period_;
        return target_.samples ? std::min(n, target_.samples - samples) : n;
    }

private:
    static constexpr double shortest = 0.1;  // seconds
    const Target target_;
    const uint64_t period_;
    uint64_t size_ = 1;  // periods a pass
    double started_ = 0;
};

// ---- Threads ------------------------------------------------------------------------------------

inline unsigned all_cores() { return std::max(1u, std::thread::hardware_concurrency()); }

// Calls row(y) for every y < height from several threads, and meanwhile() from this one ten times
// a second.  Returns early, with rows missing, once `interrupted`; then the answer is false.  What
// row throws, it throws.
template <class Row, class Meanwhile>
bool parallel_rows(int height, unsigned threads, Row row, Meanwhile meanwhile) {
    std::atomic<int> next = 0, done = 0;
    std::mutex mutex;
    std::condition_variable finished;
    std::exception_ptr failure;
    unsigned running = std::min(threads, unsigned(height));
    auto work = [&] {
        try {  // a row that was cut short does not count
            for (int y; !interrupted && (y = next++) < height; done += !interrupted) row(y);
        } catch (...) {
            std::lock_guard lock(mutex);
            failure = std::current_exception();
            next = height;
        }
        std::lock_guard lock(mutex);
        --running;
        finished.notify_one();
    };
    {
        std::vector<std::jthread> workers;
        struct Stop {  // before they are waited for, whatever is thrown here
            std::atomic<int>& next;
            const int end;
            ~Stop() { next = end; }
        } stop{next, height};
        for (unsigned i = running; i > 0; --i) workers.emplace_back(work);
        std::unique_lock lock(mutex);
        while (!finished.wait_for(lock, std::chrono::milliseconds(100), [&] { return !running; }))
            meanwhile(double(done) / height);
    }
    if (failure) std::rethrow_exception(failure);
    meanwhile(double(done) / height);
    return done == height;
}

// ---- Passes -------------------------------------------------------------------------------------

// How a film is filled.
struct Passes {
    Target target;
    uint64_t period = 1;  // samples after which a pass may end
    unsigned threads = 1;
    uint64_t pause = 0;  // samples after which one does
};

// Adds one pass to the film, unless `interrupted`, or a sample is not finite: then the answer is
// false.  row(y, n) adds n samples to each pixel of row y; show(samples so far) while the threads
// work.
template <class Film, class Row, class Progress>
bool add_pass(Film& film, uint64_t n, unsigned threads, Row row, Progress& progress) {
    const bool complete = parallel_rows(
        film.size.height, threads, [&](int y) { row(y, n); },
        [&](double part) { progress.show(double(film.samples()) + part * double(n)); });
    if (!complete || film.non_finite() > 0) return false;
    film.end_pass(n);
    return true;
}

// Adds passes to the film until the target is met, one could not be added, or at_most(film), which
// says after each how many samples the next may bring, says 0.  A clock of seconds.
template <class Film, class Row, class Progress, class AtMost>
void render(Film& film, const Passes& passes, Row row, Progress& progress, AtMost at_most) {
    Schedule schedule(passes.target, passes.period);
    uint64_t most = UINT64_MAX;
    while (uint64_t n = schedule.next(film.samples(), progress.elapsed())) {
        if (film.samples() < passes.pause) n = std::min(n, passes.pause - film.samples());
        if (n > most) n = std::max<uint64_t>(1, most / passes.period) * passes.period;
        if (!add_pass(film, n, passes.threads, row, progress)) return;
        most = at_most(film);
        if (most == 0) return;
    }
}

template <class Film, class Row, class Progress>
void render(Film& film, const Passes& passes, Row row, Progress& progress) {
    render(film, passes, row, progress, [](const Film&) { return UINT64_MAX; });
}

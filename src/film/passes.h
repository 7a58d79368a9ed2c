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
// second Ctrl-C kills.  What whoever started us ignores stays ignored.  A stderr that nobody reads
// is no reason to lose an image, and a file that grows too large is an error of its own.
inline void catch_interrupt() {
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        struct sigaction before {};
        action.sa_handler = [](int caught) { interrupted = caught; };
        // What stops a job may be sent to it twice, by its engine and by a script.
        action.sa_flags = signal == SIGINT ? int(SA_RESETHAND) : 0;
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
            const bool was_full = samples - before_ >= size_ * period_;  // others may cut it short
            if (took < shortest && was_full) size_ *= 2;
            if (took > 2 * shortest) size_ = std::max<uint64_t>(1, size_ / 2);
        }
        started_ = elapsed, before_ = samples;
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
    uint64_t before_ = 0;  // samples
};

// ---- Threads ------------------------------------------------------------------------------------

inline unsigned all_cores() { return std::max(1u, std::thread::hardware_concurrency()); }

// Thrown out of work that nobody waits for: its part of a pass does not count.
struct Interrupted {};

// Calls work(k) for every k < count from several threads, and meanwhile() from this one ten times a
// second.  Returns early, with some left out, once `interrupted`; then the answer is false.  What
// work throws, it throws.
template <class Work, class Meanwhile>
bool in_parallel(size_t count, unsigned threads, Work work, Meanwhile meanwhile) {
    std::atomic<size_t> next = 0, done = 0;
    std::mutex mutex;
    std::condition_variable finished;
    std::exception_ptr failure;
    unsigned running = unsigned(std::min<size_t>(threads, count));
    auto run = [&] {
        try {  // what was cut short does not count
            for (size_t k; !interrupted && (k = next++) < count; done += !interrupted) work(k);
        } catch (const Interrupted&) {
        } catch (...) {
            std::lock_guard lock(mutex);
            failure = std::current_exception();
            next = count;
        }
        std::lock_guard lock(mutex);
        --running;
        finished.notify_one();
    };
    {
        std::vector<std::jthread> workers;
        struct Stop {  // before they are waited for, whatever is thrown here
            std::atomic<size_t>& next;
            const size_t end;
            ~Stop() { next = end; }
        } stop{next, count};
        for (unsigned i = running; i > 0; --i) workers.emplace_back(run);
        std::unique_lock lock(mutex);
        while (!finished.wait_for(lock, std::chrono::milliseconds(100), [&] { return !running; }))
            meanwhile(double(done) / double(count));
    }
    if (failure) std::rethrow_exception(failure);
    meanwhile(double(done) / double(count));
    return done == count;
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
// false.  add(k, n) adds n samples to each pixel of block k; show(samples so far) while the threads
// work.
template <class Film, class Add, class Progress>
bool add_pass(Film& film, uint64_t n, unsigned threads, Add add, Progress& progress) {
    film.begin_pass(n);
    const bool complete = in_parallel(
        film.blocks(), threads, [&](size_t k) { add(k, n); },
        [&](double part) { progress.show(double(film.samples()) + part * double(n)); });
    if (!complete || film.non_finite() > 0) return false;
    film.end_pass(n);
    return true;
}

// Adds passes to the film until the target is met, one could not be added, or between(film), which
// says before each how many samples it may bring, says 0.  The progress is a clock of seconds.
template <class Film, class Add, class Progress, class Between>
void render(Film& film, const Passes& passes, Add add, Progress& progress, Between between) {
    Schedule schedule(passes.target, passes.period);
    while (const uint64_t most = between(film)) {
        uint64_t n = schedule.next(film.samples(), progress.elapsed());
        if (n == 0) return;
        if (film.samples() < passes.pause) n = std::min(n, passes.pause - film.samples());
        if (n > most) n = std::max<uint64_t>(1, most / passes.period) * passes.period;
        if (!add_pass(film, n, passes.threads, add, progress)) return;
    }
}

template <class Film, class Add, class Progress>
void render(Film& film, const Passes& passes, Add add, Progress& progress) {
    render(film, passes, add, progress, [](const Film&) { return UINT64_MAX; });
}

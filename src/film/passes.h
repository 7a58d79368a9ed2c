// film/passes.h  4  the loop that fills a film: passes, threads, time, Ctrl-C
#pragma once
#include <atomic>
#include <chrono>
#include <csignal>
#include <future>
#include <mutex>

#include "film/error.h"

// ---- Ctrl-C -------------------------------------------------------------------------------------

// The signal that asks for an end, or 0.
inline std::atomic<int> interrupted = 0;

// The first Ctrl-C, or another signal to end, asks for an end; a second Ctrl-C kills.  A signal
// that our parent ignores stays ignored.  A stderr that nobody reads is no reason to lose an image,
// and a file that grows too large is an error of its own.
inline void catch_interrupt() {
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        struct sigaction before {};
        action.sa_handler = [](int caught) { interrupted = caught; };
        // A job's engine and a script may both send SIGTERM.
        action.sa_flags = signal == SIGINT ? int(SA_RESETHAND) : 0;
        sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
    for (int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

// Thrown out of work that nobody waits for.
struct Interrupted {};

// ---- Threads ------------------------------------------------------------------------------------

// Calls work(k) for every k < count from several threads, and meanwhile(part done) from this one
// ten times a second.  Returns early, with some left out, once `interrupted`; then the answer is
// false.  An exception of work becomes its own.
inline bool in_parallel(size_t count, unsigned threads, const std::function<void(size_t)>& work,
                        const std::function<void(double)>& meanwhile) {
    std::atomic<size_t> next = 0, done = 0;
    auto run = [&] {
        try {  // an item that was cut short does not count
            for (size_t k; !interrupted && (k = next++) < count; done += !interrupted) work(k);
        } catch (const Interrupted&) {
        } catch (...) {
            next = count;
            throw;
        }
    };
    std::vector<std::future<void>> workers;
    for (size_t i = std::min<size_t>(threads, count); i > 0; --i)
        workers.push_back(std::async(std::launch::async, run));
    for (auto& worker : workers)
        while (worker.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready)
            meanwhile(double(done) / double(count));
    for (auto& worker : workers) worker.get();  // or throws what it has thrown
    meanwhile(double(done) / double(count));
    return done == count;
}

// ---- When to stop -------------------------------------------------------------------------------

// Whichever comes first; 0: no limit.
struct Target {
    uint64_t samples = 0;  // of each replication
    double seconds = 0;
    double error = 0;  // d_rel
};

// How a film is filled.
struct Plan {
    Target target;
    uint64_t period = 1;  // samples after which a pass may end, but for the last: whole grids
    unsigned threads = 1;
    double memory = INFINITY;  // bytes that the film may take
    Size size = {};
    int first_row = 0;
    uint32_t sets = 0;                      // replications of each pixel; 0: adaptive
    uint64_t at_once = 1;                   // samples that one sample of the film stands for
    std::vector<size_t> noisy = {};         // pixels of which few samples tell
    std::vector<FixedPoint> evidence = {};  // of a film without samples
    Judge judge = {};                       // of the error, by them

    // Of each replication; 0: not known.
    uint64_t known_samples() const { return target.error > 0 ? 0 : target.samples; }
    // Samples before the others are chosen: whole grids.
    uint64_t pilot() const {
        const uint64_t n = (pilot_samples + period - 1) / period * period;
        return target.samples ? std::min(n, target.samples) : n;
    }
};

// Samples after the next pass, if there are n after `elapsed` seconds and another period takes
// `a_period` (0: not known): as many as fit into the time, at most about twice n.  n: enough.
inline uint64_t end_of_pass(const Target& target, uint64_t period, uint64_t n, double elapsed,
                            double a_period) {
    constexpr double longest = 0.2;  // seconds: threads are seldom idle, Ctrl-C is soon obeyed
    uint64_t periods = n / period + 1;
    if (a_period > 0) {
        const double left = target.seconds > 0 ? target.seconds - elapsed : HUGE_VAL;
        if (left <= 0) return n;
        const double fit = std::min(left, longest) / a_period;
        periods = uint64_t(std::clamp(fit, 1.0, double(periods)));
    }
    const uint64_t to = (n / period + periods) * period;
    return target.samples ? std::max(n, std::min(to, target.samples)) : to;
}

// ---- The loop -----------------------------------------------------------------------------------

// Between passes it says how far the next one may go (no further than the film is: enough), and
// meanwhile it shows progress and reads the clock.
struct Watch {
    std::function<uint64_t(const Film&)> between = [](const Film&) { return UINT64_MAX; };
    // Samples a pixel so far, and in the end, if that is known, or 0.
    std::function<void(double now, double all)> show = [](double, double) {};
    std::function<double()> elapsed;  // seconds, with those of runs before this one
};

class Loop {
public:
    Loop(Film& film, const Plan& plan, const Radiance& L, const Watch& watch)
        : film_(film), plan_(plan), L_(L), watch_(watch), offsets_(offsets(film)) {}

    // Adds passes until the target is met, a sample is not finite, `interrupted` or enough.
    void run() {
        while (const uint64_t to = next_end()) {
            auto work = [&](size_t block) {
                if (film_.taken[block] >= to) return;
                Tally tally;
                tally.sums.resize(film_.evidence.size());
                const NonFinite bad = add_samples(film_, block, offsets_[block], to, L_, tally);
                std::lock_guard lock(mutex_);
                rays_ += tally.rays;
                for (size_t i = 0; i < tally.sums.size(); ++i) film_.evidence[i] += tally.sums[i];
                bad_.add(bad);
            };
            const double pixels = double(film_.pixels()), before = film_.total() / pixels,
                         after = film_.total(to) / pixels;
            // Before they are chosen there will be two replications or more.
            const double all = plan_.target.samples ? film_.total(plan_.target.samples) / pixels *
                                                          (film_.sets.empty() ? 2 : 1)
                                                    : 0;
            auto show = [&](double part) { watch_.show(before + part * (after - before), all); };
            if (!in_parallel(film_.taken.size(), plan_.threads, work, show)) return;
            if (bad_.count > 0) return;
        }
    }

    const NonFinite& non_finite() const { return bad_; }
    uint64_t rays() const { return rays_; }
    uint32_t most_sets_chosen() const { return most_; }  // less than asked for: no more fit

private:
    Film& film_;
    const Plan plan_;
    const Radiance& L_;
    const Watch& watch_;
    std::vector<size_t> offsets_;
    NonFinite bad_;
    std::atomic<uint64_t> rays_ = 0;
    uint32_t most_ = Allocation().most;
    std::mutex mutex_;

    // The second replications take as long as the pilot: of a time that is short it gets half.
    bool is_pilot_done() const {
        const uint64_t n = film_.least_taken();
        const double seconds = plan_.target.seconds;
        const bool is_half = n > 0 && seconds > 0 && 2 * watch_.elapsed() > seconds;
        return n == film_.most_taken() && (n >= plan_.pilot() || is_half);
    }

    // Samples of each replication after the next pass; 0: none is needed.
    uint64_t next_end() {
        if (film_.sets.empty() && is_pilot_done()) {
            most_ = choose_sets(film_, plan_.memory, plan_.noisy);
            offsets_ = offsets(film_);
        }
        const uint64_t most = watch_.between(film_), n = film_.least_taken();
        const double elapsed = watch_.elapsed(), total = film_.total();
        const double a_period =
            total > 0 ? elapsed / total * (film_.total(n + plan_.period) - total) : 0;
        uint64_t to = std::min(most, end_of_pass(plan_.target, plan_.period, n, elapsed, a_period));
        if (film_.sets.empty()) to = std::min(to, std::max(n, plan_.pilot()));
        return to > n ? to : 0;
    }
};

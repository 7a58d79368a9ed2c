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

// The first Ctrl-C, or another signal to end, asks for an end; a second Ctrl-C kills.  Signals that
// the parent ignores stay ignored.  A closed stderr does not lose the image, and a file that grows
// too large is reported as an error.
inline void catch_interrupt() {
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        struct sigaction before {};
        action.sa_handler = [](int caught) { interrupted = caught; };
        // A batch system and a script may both send SIGTERM.
        action.sa_flags = signal == SIGINT ? int(SA_RESETHAND) : 0;
        sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
    for (int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

// Thrown to abandon work after an interrupt.
struct Interrupted {};

// ---- Threads ------------------------------------------------------------------------------------

// Calls work(k) for every k < count from several threads, and meanwhile(fraction done) from this
// one ten times per second.  Once `interrupted`, it returns false early, with some k left out.
// Passes on exceptions of work.
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

// ---- Stopping criteria --------------------------------------------------------------------------

// Whichever comes first; 0: no limit.
struct Target {
    uint64_t samples = 0;  // samples of each replication
    double seconds = 0;
    double error = 0;  // d_rel
};

// Parameters of a render loop.
struct Plan {
    Target target;
    uint64_t period = 1;  // a pass, except the last, ends after a multiple of this: whole grids
    unsigned threads = 1;
    double memory = INFINITY;  // bytes that the film may take
    Size size = {};
    int first_row = 0;
    uint32_t sets = 0;                      // replications of each pixel; 0: adaptive
    uint64_t at_once = 1;                   // paths that one sample of the film stands for
    std::vector<size_t> noisy = {};         // pixels where few samples meet bright light
    std::vector<FixedPoint> evidence = {};  // evidence of a film without samples
    Judge judge = {};                       // judges the error by the evidence

    // Samples of each replication at the end; 0: not known.
    uint64_t known_samples() const { return target.error > 0 ? 0 : target.samples; }
    // Samples of the pilot: whole grids.
    uint64_t pilot() const {
        const uint64_t n = (pilot_samples + period - 1) / period * period;
        return target.samples ? std::min(n, target.samples) : n;
    }
};

// Samples after the next pass, given n samples after `elapsed` seconds; a period takes `a_period`
// seconds (0: not known).  As many as fit into the time, at most about twice n; n: enough.
inline uint64_t end_of_pass(const Target& target, uint64_t period, uint64_t n, double elapsed,
                            double a_period) {
    constexpr double longest = 0.2;  // seconds: threads are rarely idle, Ctrl-C is quick
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

// Callbacks of the loop.  `between` passes returns the number of samples at which the next one must
// end; the film's own number: it has enough.
struct Watch {
    std::function<uint64_t(const Film&)> between = [](const Film&) { return UINT64_MAX; };
    // Samples per pixel so far, and at the end; 0: not known.
    std::function<void(double now, double all)> show = [](double, double) {};
    std::function<double()> elapsed;  // seconds, including those of earlier runs
};

class Loop {
public:
    Loop(Film& film, const Plan& plan, const Radiance& L, const Watch& watch)
        : film_(film), plan_(plan), L_(L), watch_(watch), offsets_(offsets(film)) {}

    // Adds passes until the target is met, a sample is not finite, or `interrupted`.
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
            // Replications that are not yet chosen are two or more.
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
    uint32_t most_sets_chosen() const { return most_; }  // fewer than wanted: memory is short

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

    // The second replications take as long as the pilot, which gets at most half of the time.
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

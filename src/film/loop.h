// film/loop.h  4  the loop that fills a film: passes, and reasons to stop
#pragma once
#include "film/error.h"
#include "film/weights.h"

namespace penumbra {

// Work of a run, and its limits: the first that is reached ends it; 0: no limit.
struct Plan {
    Size size = {};
    int first_row = 0;
    uint32_t replications = 2;
    bool is_adaptive = true;  // weights are chosen by a pilot
    uint64_t samples = 0;     // of each replication of a pixel of weight 1
    double seconds = 0, error = 0;
    unsigned threads = 1;
    uint64_t paths = 1;                 // that one sample of the film stands for
    std::vector<NearMisses> near = {};  // of a film without samples
    std::vector<size_t> noisy = {};     // pixels where few samples meet bright light
    MayMissLight may_miss_light = {};   // judges the error by what a recorder saw
};

// Calls work(k, worker) for every k < count, perhaps from several threads, each with a number below
// `workers`, and meanwhile(fraction done) now and then.  False: it was interrupted.
using BlockWork = std::function<void(size_t k, unsigned worker)>;
using Meanwhile = std::function<void(double)>;
using ForEach =
    std::function<bool(size_t count, unsigned workers, const BlockWork&, const Meanwhile&)>;

inline bool one_by_one(size_t count, unsigned, const BlockWork& work, const Meanwhile& meanwhile) {
    for (size_t k = 0; k < count; ++k) work(k, 0), meanwhile(double(k + 1) / double(count));
    return true;
}

// Callbacks of the loop.
struct Watch {
    std::function<double()> elapsed;  // seconds, including those of earlier runs
    ForEach for_each = one_by_one;
    std::function<bool()> interrupted = [] { return false; };
    std::function<void(const Film&, const Tally&)> between = [](auto&, auto&) {};  // passes
    // Samples per pixel so far, and at the end (infinite while unknown).
    std::function<void(double now, double end)> show = [](double, double) {};
};

// Samples after the next pass, given n after `elapsed` seconds; one sample more of each pixel takes
// `each` seconds (0 if unknown).  As many as fit into the time, at most n + 1; one at least.
inline uint64_t end_of_pass(uint64_t n, double elapsed, double each, double seconds) {
    constexpr double longest = 0.2;  // seconds: threads are rarely idle, Ctrl-C is quick
    const double left = seconds > 0 ? seconds - elapsed : HUGE_VAL;
    const double fit = each > 0 ? std::min(left, longest) / each : HUGE_VAL;
    return n + uint64_t(std::clamp(fit, 1.0, double(n + 1)));
}

class Loop {
public:
    Loop(Film& film, const Plan& plan, const SampleFunction& radiance, const Watch& watch)
        : film_(film),
          plan_(plan),
          radiance_(radiance),
          watch_(watch),
          limit_(plan.samples ? plan.samples : max_samples) {}

    Stop run() {
        for (;;) {
            const Stop stop = reason_to_stop();
            if (stop != Stop::no) return stop;
            if (is_pilot_done()) choose_weights(film_, plan_.noisy);
            watch_.between(film_, tally_);
            if (!add_pass(next_end())) return Stop::interrupt;
        }
    }

    const Tally& tally() const { return tally_; }  // of this run, without near misses

private:
    Film& film_;
    const Plan& plan_;
    const SampleFunction& radiance_;
    const Watch& watch_;
    const uint64_t limit_, pilot_ = std::min(pilot_samples, limit_);  // samples
    ErrorCheck last_check_;
    Tally tally_;

    bool is_pilot_done() const {
        const uint64_t n = film_.min_samples_done();
        return film_.is_pilot && n >= pilot_ && n == film_.max_samples_done();
    }

    Stop reason_to_stop() {
        if (watch_.interrupted()) return Stop::interrupt;
        if (tally_.bad > 0) return Stop::not_finite;
        if (plan_.error > 0 && is_check_due(film_)) {
            last_check_ = check_error(film_, plan_.error, plan_.may_miss_light);
            if (last_check_.stop != Stop::no) return last_check_.stop;
        }
        if (!film_.is_pilot && film_.min_samples_done() >= limit_) return Stop::samples;
        const bool is_over = plan_.seconds > 0 && watch_.elapsed() >= plan_.seconds;
        return is_over && film_.has_samples() ? Stop::time : Stop::no;
    }

    // Passes of the pilot have fixed ends, because deviations are rounded.
    uint64_t next_end() const {
        const uint64_t n = film_.min_samples_done();
        if (film_.is_pilot) return n + 1;
        const double elapsed = watch_.elapsed(), now = film_.samples_per_pixel();
        const double each = now > 0 ? elapsed / now * (film_.samples_per_pixel(n + 1) - now) : 0;
        const uint64_t to = end_of_pass(n, elapsed, each, plan_.seconds);
        return std::min({to, limit_, plan_.error > 0 ? next_check(n) : limit_});
    }

    bool add_pass(uint64_t to) {
        const double before = film_.samples_per_pixel(), after = film_.samples_per_pixel(to);
        const uint64_t last = uint64_t(std::min(last_check_.expected, double(limit_)));
        const double end = last < max_samples ? film_.samples_per_pixel(last) *
                                                    (film_.is_pilot ? typical_weight : 1)
                                              : HUGE_VAL;
        Tally nothing;
        nothing.near.resize(film_.near.size());
        const unsigned workers = std::max(1u, plan_.threads);
        std::vector<Tally> of_worker(workers, nothing);
        auto add_block = [&](size_t block, unsigned worker) {
            if (film_.samples_done[block] >= to) return;
            Tally tally = nothing;  // of whole blocks only
            add_samples(film_, block, to, radiance_, tally);
            of_worker[worker].add(tally);
        };
        const bool is_whole = watch_.for_each(
            film_.samples_done.size(), workers, add_block,
            [&](double part) { watch_.show(before + part * (after - before), end); });
        for (const Tally& tally : of_worker) {
            tally_.add(tally);
            for (size_t g = 0; g < tally.near.size(); ++g) film_.near[g].add(tally.near[g]);
        }
        return is_whole;
    }
};

}  // namespace penumbra

// course/tally.h  what a student's test is worth: wrong subjects found, less false alarms
#pragma once
#include <algorithm>

#include "course/program.h"
#include "course/shuffle.h"

namespace penumbra::course {

// Seconds of CPU that a run may take on average: the oracle's check of a density takes 0.03 on an
// idle machine.
inline constexpr double limit = 1;
inline constexpr size_t runs_of_wrong = 3;
// A test must not be lucky with few right subjects: they have so many runs in all, or some more.
inline constexpr size_t least_runs = 161;
inline size_t runs_of_right(size_t right) { return (least_runs + right - 1) / right; }

struct Tally {
    std::vector<size_t> refused;  // runs of each subject, wrong ones first
    size_t wrong = 0, runs = 0;   // of these are on right subjects:
    size_t right_runs = 0, alarms = 0;
    double seconds = 0;

    // Refused in most of its runs.
    bool is_found(size_t subject) const { return 2 * refused[subject] > runs_of_wrong; }
    size_t found() const {
        size_t n = 0;
        for (size_t i = 0; i < wrong; ++i) n += is_found(i);
        return n;
    }
    bool in_time() const { return seconds <= limit * double(runs); }
    // One false alarm in a thousand runs is what a test may have: no more than chance makes of it.
    bool quiet() const {
        return oracle::p_at_least(double(alarms), double(right_runs), 1e-3) > 1e-3;
    }
    // A right one that is refused always, or more often than chance makes of the others' share.
    bool is_singled_out(size_t subject) const {
        const double mine = double(refused[subject]);
        const double all = double(runs_of_right(refused.size() - wrong));
        const double others = (double(alarms) - mine) / std::max(1.0, double(right_runs) - all);
        return mine == all || oracle::p_at_least(mine, all, std::max(1e-3, others)) < 1e-3;
    }
    // In [0,1].
    double credit() const {
        const double penalty = quiet() ? 0 : 5 * double(alarms) / double(right_runs);
        return std::max(0.0, double(found()) / double(wrong) - penalty);
    }
};

// All runs in a random order, each with subjects in an order of its own, until time is up.  `judge`
// asks (judge.h).
template <class Judge>
Tally tally(Judge& judge, double exercise) {
    const Out count = judge.ask("count", Out{exercise});
    const auto wrong = size_t(count.at(0)), all = wrong + size_t(count.at(1));
    auto fresh = [&] { return double(judge.random.bits() >> 11); };
    std::vector<size_t> runs;
    for (size_t i = 0; i < all; ++i)
        runs.insert(runs.end(), i < wrong ? runs_of_wrong : runs_of_right(all - wrong), i);
    Tally t;
    t.refused.resize(all), t.wrong = wrong;
    const double budget = limit * double(runs.size());
    for (size_t at : shuffled(fresh(), runs.size())) {
        const size_t subject = runs[at];
        const double key = fresh(), seed = fresh();
        const auto order = shuffled(key, all);
        const auto place = std::find(order.begin(), order.end(), subject) - order.begin();
        const Out said = judge.ask("test", Out{exercise, key, double(place), seed});
        const bool refuses = said.at(0) == 0;
        ++t.runs, t.seconds += said.at(1), t.refused[subject] += refuses;
        if (subject >= wrong) ++t.right_runs, t.alarms += refuses;
        if (t.seconds > budget) break;
    }
    return t;
}

}  // namespace penumbra::course

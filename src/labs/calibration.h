// labs/calibration.h  3  whether --error keeps its word: rules of stopping, and what they did
#pragma once
#include "film/error.h"
#include "labs/lab.h"

// ---- When to stop -------------------------------------------------------------------------------

// As is_small_enough has it, and samples of each replication at penumbra's first look.
inline constexpr double margin_of_error = 0.5;
inline constexpr uint64_t first_look = 8;

// What an error is raised by before the rule of --error sees it.
struct Guard {
    std::string name;
    double margin = margin_of_error;  // standard errors of d_rel
    double unseen = 0;                // times more than the rule, another pixel like the worst
    uint64_t least = 0;               // samples
    bool by_course = false;           // to the next look goes what the course says is missing
};

inline ImageError guarded(const Guard& guard, ImageError e) {
    e.greatest *= 1 + guard.unseen;
    e.spread *= guard.margin / margin_of_error;
    return e;
}

// One E and one guard, on a run that many share: they look when they would if they were alone.
class Stopper {
public:
    Stopper(Guard guard, double asked, uint64_t first)
        : guard_(std::move(guard)), asked_(asked), next_(first) {}

    bool stopped() const { return stopped_; }
    uint64_t next() const { return next_; }  // samples at the next look

    // Whether to stop here; it is asked at its next look, and not later.
    bool stops(const ImageError& e, uint64_t samples) {
        if (stopped_ || samples < next_) return false;
        course_.add(samples, e.d_rel());
        const ImageError raised = guarded(guard_, e);
        const bool enough = is_small_enough(raised, asked_);
        stopped_ = enough && samples >= guard_.least;
        next_ = next_check(samples, first_look, 1);
        if (guard_.by_course && !enough)
            next_ = std::max(next_, samples + missing(raised, samples));
        if (enough) next_ = guard_.least;
        return stopped_;
    }

private:
    Guard guard_;
    double asked_;
    ErrorCourse course_;
    uint64_t next_;
    bool stopped_ = false;

    // By the course; as many again at most.
    uint64_t missing(const ImageError& e, uint64_t samples) const {
        const double now = e.d_rel_and_unseen() + margin_of_error * e.standard_error();
        const double part = course_.cost_of(now / asked_) - 1;
        return part < 1 ? uint64_t(part * double(samples)) : samples;
    }
};

// ---- What they did ------------------------------------------------------------------------------

// A look at an image whose truth is known.
struct Look {
    uint64_t samples = 0;  // of each replication
    double seconds = 0;    // of the processor
    double estimate2 = 0;  // d^2, as estimated
    double stated = 0;     // standard error of d_rel over d_rel, as estimated
    double truth2 = 0;     // d^2 itself, but for what is not known of the truth
    double norm = 0;       // of the truth
    double true_d() const { return truth2 > 0 ? std::sqrt(truth2) / norm : 0; }
    double estimated_d() const { return std::sqrt(estimate2) / norm; }
};

using Looks = std::vector<Look>;

template <class Number>
std::vector<double> each(const Looks& looks, Number number) {
    std::vector<double> x;
    for (const Look& l : looks) x.push_back(number(l));
    return x;
}

inline double share_above(const std::vector<double>& x, double limit) {
    size_t n = 0;
    for (double v : x) n += v > limit;
    return double(n) / double(x.size());
}

// Standard deviation over mean.
inline double scatter(const std::vector<double>& x) {
    Moments m;
    for (double v : x) m.add(v);
    return std::sqrt(m.variance()) / m.mean;
}

// Where runs stopped that were asked for E.
struct Kept {
    double samples = 0, seconds = 0;  // medians
    double median = 0, high = 0, above = 0,
           scatter = 0;  // of true d_rel / E: median, 95 % quantile,
                         // share above 1.05, s.d. over mean
    double stated = 0;   // median
    // Where as few samples as there may be are enough, E is only to be kept.
    bool at_least = false;
    std::string verdict() const {
        if (median > 1) return "exceeded";
        if (high > 1.05) return "scatters";
        if (at_least) return "kept, at the least samples";
        return median < 0.95 ? "too careful" : "kept";
    }
};

inline Kept kept(const Looks& stops, double asked) {
    const std::vector<double> ratio = each(stops, [&](const Look&l) { return l.true_d() / asked; }),
                              samples = each(stops, [](const Look&l) { return double(l.samples); });
    Kept k;
    k.samples = median(samples);
    k.seconds = median(each(stops, [](const Look& l) { return l.seconds; }));
    k.median = median(ratio), k.high = quantile(ratio, 0.95), k.above = share_above(ratio, 1.05);
    k.scatter = scatter(ratio);
    k.stated = median(each(stops, [](const Look& l) { return l.stated; }));
    k.at_least = k.samples <= double(first_look);
    return k;
}

// Mean of estimate^2 over mean of truth^2: 1 of an unbiased estimate at a number of samples fixed
// before.  The error of the ratio: by the slope (Cochran 1977).
struct Bias {
    double ratio = 0, error = 0;
};
inline Bias bias_of(const Looks& looks) {
    double estimate = 0, truth = 0, squares = 0;
    for (const Look& l : looks) estimate += l.estimate2, truth += l.truth2;
    const double ratio = estimate / truth, n = double(looks.size());
    for (const Look& l : looks) squares += std::pow(l.estimate2 - ratio * l.truth2, 2);
    return {ratio, std::sqrt(squares * n / (n - 1)) / truth};
}

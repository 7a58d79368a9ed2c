// film/error.h  3  the error of an image, estimated from the spread of its replications
#pragma once
#include <utility>

#include "film/film.h"

// The error of an image f, with the limit F: d^2 is the expected mean of (f - F)^2 over pixels and
// channels, without the bias of f; d_rel = d / |F|.  NaN: not known.
struct ImageError {
    std::array<double, 3> mean{};                 // of the image, per channel
    std::array<double, 3> square{NAN, NAN, NAN};  // d^2 per channel
    double spread = NAN;                          // standard error of d^2
    double norm = NAN;                            // |f|, the RMS of the image itself
    double greatest = NAN;                        // part of d^2 that comes from the worst pixel

    double d2() const { return (square[0] + square[1] + square[2]) / 3; }
    // |F|, for E |f|^2 = |F|^2 + d^2; 0: lost in noise.
    double norm_of_truth() const { return std::sqrt(std::max(0.0, norm * norm - d2())); }
    // NaN for a black image: all samples may have missed the light.  Infinite if all is noise.
    double d_rel() const { return norm > 0 ? std::sqrt(d2()) / norm_of_truth() : double(NAN); }
    // The same, as if there were a second pixel like the worst, where no sample met the light.
    double d_rel_and_unseen() const {
        return d_rel() * std::sqrt(d2() > 0 ? 1 + greatest / d2() : 1);
    }
    // Standard errors: of d over d; of d_rel over d_rel, by the slope of d / |F|; of d_rel.
    double spread_of_d() const { return d2() == 0 ? 0 : spread / d2() / 2; }
    double spread_of_d_rel() const { return spread_of_d() * (1 + d_rel() * d_rel()); }
    double standard_error() const { return d_rel() * spread_of_d_rel(); }
};

// Sums over pixels.  A pixel's term T is the mean variance of its channels.  The variance of T is
// E[T^2] - E[T]^2, and E[T]^2 = E[T^2] (K - 1) / (K + 1) if its K replications are normally
// distributed and the channels are fully correlated.
struct ErrorTerms {
    uint64_t pixels = 0, measured = 0;  // measured: by two replications or more
    std::array<double, 3> sum{}, square{};
    double norm2 = 0, terms2 = 0, greatest = 0;

    void add(const Pixel& p) { add(std::span(&p, 1)); }

    // Adds a pixel of independent pictures f_s, weighted by their samples, and returns its value:
    // Var(sum w_s f_s) = sum w_s^2 Var(f_s).
    std::array<double, 3> add(std::span<const Pixel> pictures) {
        std::array<double, 3> value{}, variance{};
        double all = 0, spread2 = 0;
        bool is_measured = true;
        for (const Pixel& p : pictures) all += p.samples();
        for (const Pixel& p : pictures) {
            const double w = p.samples() / all, K = double(p.count());
            double term = 0;
            for (size_t c = 0; c < 3; ++c) {
                const double of_p = p.variance(c);
                value[c] += w * p.value(c), variance[c] += w * w * of_p, term += w * w * of_p / 3;
            }
            spread2 += term * term * 2 / (K + 1);
            is_measured = is_measured && K > 1;
        }
        ++pixels;
        for (size_t c = 0; c < 3; ++c) sum[c] += value[c], norm2 += value[c] * value[c];
        if (!is_measured) return value;
        ++measured;
        for (size_t c = 0; c < 3; ++c) square[c] += variance[c];
        terms2 += spread2;
        greatest = std::fmax(greatest, (variance[0] + variance[1] + variance[2]) / 3);
        return value;
    }

    ImageError error() const {
        const double n = double(pixels);
        ImageError e;
        for (size_t c = 0; c < 3; ++c) e.mean[c] = sum[c] / n;
        e.norm = std::sqrt(norm2 / 3 / n);
        if (measured < pixels) return e;
        for (size_t c = 0; c < 3; ++c) e.square[c] = square[c] / n;
        e.spread = std::sqrt(terms2) / n;
        e.greatest = greatest / n;
        return e;
    }
};

inline ErrorTerms terms_of(const Film& film) {
    ErrorTerms terms;
    for_each_pixel(film, [&](size_t, const Pixel& p) { terms.add(p); });
    return terms;
}
inline ImageError error_of(const Film& film) { return terms_of(film).error(); }

// ---- Convergence, and error checks --------------------------------------------------------------

// The fitted rate d_rel = c n^-gamma of the last two errors.  Samples double from one to the next.
class ErrorHistory {
public:
    bool is_due(uint64_t samples) const { return double(samples) >= 2 * last_.samples; }
    void add(uint64_t samples, double d_rel) {
        if (is_due(samples)) before_ = std::exchange(last_, {double(samples), d_rel});
    }

    // gamma, from 1/2 to 1; not known: 1/2, as for independent samples.
    double exponent() const {
        const double gamma =
            std::log(before_.d_rel / last_.d_rel) / std::log(last_.samples / before_.samples);
        return gamma > 0.5 ? std::min(gamma, 1.0) : 0.5;
    }

    // Factor of the number of samples that divides the last error by x.
    double cost_of(double x) const { return std::pow(x, 1 / exponent()); }

private:
    struct Point {
        double samples = 0, d_rel = NAN;
    } before_, last_;
};

// Why a film's error may be far above its estimate; "": no reason is known.
using Judge = std::function<std::string(const Film&, const ImageError&)>;

// The same for any film.  A relative standard error of a quarter is that of 8 degrees of freedom.
// One degree understates an error 10^4 times in 8 of 10^5 pictures: 1e-6 is small in any case.
inline std::string doubt_of(const Film& film, const ImageError& e, const Judge& judge) {
    if (e.norm == 0) return "no sample found light";
    const std::string why = judge && e.d2() >= 0 ? judge(film, e) : "";
    if (!why.empty()) return why;
    if (!(e.spread_of_d_rel() > 0.25 && e.d_rel() > 1e-6)) return "";
    return e.spread_of_d() > 0.25 ? "a few pixels dominate it" : "the picture is mostly noise";
}

// The rule of --error: stop once the estimate, with a second pixel like the worst and half its
// standard error, is at most the error wanted.  The margin corrects the optional-stopping bias; the
// pixel stands for light that no sample has met (both by `make calibration`).  An unknown error is
// not small.
inline bool is_small_enough(const ImageError& e, double wanted) {
    constexpr double margin = 0.5;  // standard errors
    return e.d_rel_and_unseen() + margin * e.standard_error() <= wanted;
}

// Samples of the first check after `samples`.  They do not depend on the error wanted: a resumed
// run stops where an uninterrupted run would have stopped.
inline uint64_t next_check(uint64_t samples, uint64_t first, uint64_t period) {
    uint64_t check = first;
    while (check <= samples) check += (check / 32 / period + 1) * period;
    return check;
}

// Checks a film's error until it is at most `wanted`; 0: records only its history.
class ErrorChecks {
public:
    ErrorChecks(double wanted, uint64_t period, const Judge& judge = {})
        : wanted_(wanted), period_(period), judge_(judge) {}

    // The number of samples at the next check; the film's own number: it has enough.
    uint64_t next(const Film& film) {
        const uint64_t n = film.least_taken();
        const uint64_t first = (first_check + period_ - 1) / period_ * period_;
        if (film.sets.empty()) return UINT64_MAX;
        const bool is_even = n > 0 && n == film.most_taken();  // no film that was interrupted
        const bool checks = wanted_ > 0 && is_even && next_check(n - 1, first, period_) == n;
        if (checks || (is_even && history_.is_due(n))) {
            const ImageError e = error_of(film);
            history_.add(n, e.d_rel());
            const bool is_known = !checks || doubt_of(film, e, judge_).empty();
            is_enough_ = checks && is_known && is_small_enough(e, wanted_);
            is_hopeless_ = !is_known && film.total() >= most_unknown * double(film.pixels());
            const double too_much = std::isfinite(e.d_rel()) ? e.d_rel() / wanted_ : HUGE_VAL;
            expected_ = double(n) * history_.cost_of(std::max(1.0, too_much));
        }
        return is_enough_ || is_hopeless_ ? n
               : wanted_ > 0              ? next_check(n, first, period_)
                                          : UINT64_MAX;
    }

    bool is_enough() const { return is_enough_; }
    bool is_hopeless() const { return is_hopeless_; }  // not known after `most_unknown` samples
    const ErrorHistory& history() const { return history_; }
    // Expected samples of each replication at the end, by the last check; infinite: not known.
    double expected() const { return wanted_ > 0 ? expected_ : HUGE_VAL; }

private:
    static constexpr uint64_t first_check = 8;    // samples; fewer give a poor estimate
    static constexpr double most_unknown = 4096;  // samples per pixel
    const double wanted_;
    const uint64_t period_;
    const Judge judge_;
    ErrorHistory history_;
    bool is_enough_ = false, is_hopeless_ = false;
    double expected_ = HUGE_VAL;
};

// film/error.h  3  how far an image is from the truth, by the spread of its sets
#pragma once
#include <array>

#include "base/stats.h"
#include "film/sets.h"

// ---- The image ----------------------------------------------------------------------------------

// Of an image f of a truth F that sets scatter about: d^2 = mean over pixels and channels of
// (f - F)^2, in expectation, without any bias of f.  NaN: not known.
struct ImageError {
    std::array<double, 3> square{NAN, NAN, NAN};  // a channel at a time
    double spread = NAN;                          // standard error of d^2
    double norm = NAN;                            // |f|, the image's own quadratic mean
    double greatest = NAN;                        // part of d^2 that comes from the worst pixel

    double d2() const { return (square[0] + square[1] + square[2]) / 3; }
    // Of a black image not known: light may have been missed by all samples.
    double d_rel() const { return norm > 0 ? std::sqrt(d2()) / norm : double(NAN); }
    // The same if there were another pixel like the worst, in which light that is rare was not
    // seen.
    double d_rel_and_unseen() const {
        return d_rel() * std::sqrt(d2() > 0 ? 1 + greatest / d2() : 1);
    }
    // Of d_rel, by the slope of the root.
    double standard_error() const { return d2() == 0 ? 0 : d_rel() * spread / d2() / 2; }
};

// What pixels add to that, and to the image's mean: sums over pixels, which parts of an image add
// up to those of the whole.
struct ErrorTerms {
    uint64_t pixels = 0, measured = 0;  // measured: of two sets or more
    std::array<double, 3> sum{};        // of values, a channel at a time
    double norm2 = 0;                   // of squares of values
    std::array<double, 3> square{};     // of variances
    double terms2 = 0, greatest = 0;    // of squares of a pixel's terms, the greatest of these

    // A pixel's value.
    void add(const std::array<double, 3>& value) {
        ++pixels;
        for (size_t c = 0; c < 3; ++c) sum[c] += value[c], norm2 += value[c] * value[c];
    }

    // The variance of that, which sets tell.  Unbiased: a pixel that was measured with a chance of
    // p stands for 1/p pixels (Horvitz, Thompson 1952).  Its term T then varies by E[T^2] - E[T]^2,
    // and E[T]^2 = p (n - 1) / (n + 1) E[T^2] if n sets of a pixel are normally distributed; the
    // three channels vary as one.
    void add_variance(const std::array<double, 3>& variance, const Sets& sets) {
        ++measured;
        const double chance = sets.chance > 0 ? double(sets.chance) : 1, n = sets.count();
        double term = 0;
        for (size_t c = 0; c < 3; ++c) {
            square[c] += variance[c] / chance;
            term += variance[c] / chance / 3;
        }
        terms2 += term * term * (1 - chance * (n - 1) / (n + 1));
        greatest = std::fmax(greatest, term);
    }

    ErrorTerms& operator+=(const ErrorTerms& t) {
        pixels += t.pixels, measured += t.measured, norm2 += t.norm2, terms2 += t.terms2;
        for (size_t c = 0; c < 3; ++c) sum[c] += t.sum[c], square[c] += t.square[c];
        greatest = std::fmax(greatest, t.greatest);
        return *this;
    }

    ImageError error() const {
        const double n = double(pixels);
        ImageError e;
        e.norm = pixels > 0 ? std::sqrt(norm2 / 3 / n) : double(NAN);
        if (measured == 0) return e;
        e.square = {square[0] / n, square[1] / n, square[2] / n};
        e.spread = std::sqrt(terms2) / n;
        e.greatest = greatest / n;
        return e;
    }
};

// ---- How it falls, and when it is small enough --------------------------------------------------

// d_rel of an image whose samples grow: c n^-gamma.
class ErrorCourse {
public:
    void add(uint64_t samples, double d_rel) { points_.push_back({double(samples), d_rel}); }

    // Whether the samples have doubled since the last point, or there is none.
    bool is_due(uint64_t samples) const {
        return points_.empty() || double(samples) >= 2 * points_.back().samples;
    }

    // gamma, from the last point and the last one of at most half its samples; 1/2, which is that
    // of independent samples, if there is none, and at most 1.
    double exponent() const {
        for (auto p = points_.rbegin(); p != points_.rend(); ++p) {
            const Point& last = points_.back();
            if (2 * p->samples > last.samples) continue;
            const double gamma =
                std::log(p->d_rel / last.d_rel) / std::log(last.samples / p->samples);
            return gamma > 0.5 ? std::min(gamma, 1.0) : 0.5;
        }
        return 0.5;
    }

    // How many times as much it takes to divide the last error by x.
    double cost_of(double x) const { return std::pow(x, 1 / exponent()); }

private:
    struct Point {
        double samples, d_rel;
    };
    std::vector<Point> points_;
};

// Standard errors that are added to an estimate before it is small enough.
inline constexpr double margin_of_error = 0.5;

// The rule of --error: stop once the estimate, with another pixel like the worst and half its
// standard error, is no more than asked for.  The margin makes up for what stopping at a good look
// spoils, the pixel for some of the light that was not seen (both by `make calibration`).  An error
// that is not known is not small.
inline bool is_small_enough(const ImageError& e, double wanted) {
    return e.d_rel_and_unseen() + margin_of_error * e.standard_error() <= wanted;
}

// When to look, whatever is wanted, so that a run which is resumed stops where it would have
// stopped: first after some samples, then whenever there are a 32nd more, in whole periods.  The
// first look after `samples`.
inline uint64_t next_look(uint64_t samples, uint64_t first, uint64_t period) {
    uint64_t look = first;
    while (look <= samples) look += (look / 32 / period + 1) * period;
    return look;
}

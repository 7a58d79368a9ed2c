// film/error.h  3  the error of an image, estimated from the spread of its replications
#pragma once
#include "film/film.h"

namespace penumbra {

// The error of an image f, with the limit F: d^2 is the expected mean of (f - F)^2 over pixels and
// channels, without the bias of f; d_rel = d / |F|.  Sums over pixels.  An unknown number is NaN.
struct ImageError {
    double pixels = 0;
    Sum values{}, variances{};  // per channel
    double squares = 0, terms2 = 0, worst = 0;

    // A pixel's term T is the mean variance of its channels.  The variance of T is
    // E[T^2] - E[T]^2 = 2 / (K + 1) E[T^2] if its K replications are normally distributed and the
    // channels are fully correlated.
    void add(const Pixel& pixel) {
        double term = 0;
        for (size_t c = 0; c < 3; ++c) {
            values[c] += pixel.value(c), squares += square(pixel.value(c));
            variances[c] += pixel.variance(c), term += pixel.variance(c) / 3;
        }
        ++pixels;
        terms2 += term * term * 2 / (pixel.K + 1);
        worst = std::fmax(worst, term);
    }

    double norm() const { return std::sqrt(squares / 3 / pixels); }  // |f|, the RMS of the image
    double d2() const { return (variances[0] + variances[1] + variances[2]) / 3 / pixels; }
    // |F|, for E |f|^2 = |F|^2 + d^2; 0: lost in noise.
    double norm_of_truth() const { return std::sqrt(std::max(0.0, square(norm()) - d2())); }
    // NaN for a black image: all samples may have missed the light.  Infinite if all is noise.
    double d_rel() const { return norm() > 0 ? std::sqrt(d2()) / norm_of_truth() : double(NAN); }
    // Standard errors: of d, relative; of d_rel, relative (by the slope of d / |F|) and absolute.
    double spread_of_d() const { return d2() == 0 ? 0 : std::sqrt(terms2) / pixels / d2() / 2; }
    double spread_of_d_rel() const { return spread_of_d() * (1 + square(d_rel())); }
    double standard_error() const { return d_rel() * spread_of_d_rel(); }
};

inline ImageError error_of(const Film& film) {
    ImageError error;
    for (size_t i = 0; i < film.pixels(); ++i) error.add(pixel_of(film, i));
    return error;
}

// ---- Error checks -------------------------------------------------------------------------------

// True if a film's error may be far above its estimate, by what a recorder knows of it.
using MayMissLight = std::function<bool(const Film&, const ImageError&)>;

// Why an error may be far above its estimate.
enum class Doubt { no, black, missed_light, few_pixels, noise };

// Estimates with 4 degrees of freedom, a relative standard error of 0.35, are good enough, and so
// are those from 1/2 on: hardly one is less than half of the error.  With one degree, 8 of 10^5 are
// below 10^-4 of the error: below 1e-6 it is small in any case.  Noise as large as the estimate
// leaves most right within 2 (limits chosen by the hard scenes of calibration).
inline Doubt doubt_of(const Film& film, const ImageError& error, const MayMissLight& may_miss) {
    if (error.norm() == 0) return Doubt::black;
    if (may_miss && error.d2() >= 0 && may_miss(film, error)) return Doubt::missed_light;
    if (!(error.d_rel() > 1e-6)) return Doubt::no;
    if (error.spread_of_d() > 0.35 && error.d_rel() < 0.5) return Doubt::few_pixels;
    return error.spread_of_d_rel() > 1 ? Doubt::noise : Doubt::no;
}

// The rule of --error: d' + SE / 2 <= wanted.  d' counts the worst pixel twice, for light that no
// sample has met; half a standard error corrects the bias of optional stopping (both by `make
// calibration`).  An unknown error is not small.
inline bool is_small_enough(const ImageError& error, double wanted) {
    const double rise = error.d2() > 0 ? std::sqrt(1 + error.worst / error.pixels / error.d2()) : 1;
    return error.d_rel() * rise + error.standard_error() / 2 <= wanted;
}

// Samples of the first check after n.  They do not depend on the error wanted: a resumed run stops
// where an uninterrupted run would have stopped.  Fewer than 8 give a poor estimate.
inline uint64_t next_check(uint64_t n) {
    uint64_t check = 8;
    while (check <= n) check += check / 32 + 1;
    return check;
}

enum class Stop { no, samples, time, error, error_unknown, interrupt, not_finite };

// A film whose blocks have all come to a check.
inline bool is_check_due(const Film& film) {
    const uint64_t n = film.min_samples_done();
    return n > 0 && n == film.max_samples_done() && !film.is_pilot && next_check(n - 1) == n;
}

struct ErrorCheck {
    Stop stop = Stop::no;  // whether the error is a reason to stop
    // Samples of each replication at the end, if the error falls as for independent samples, as
    // n^-1/2; infinite while unknown.
    double expected = HUGE_VAL;
};
inline ErrorCheck check_error(const Film& film, double wanted, const MayMissLight& may_miss_light) {
    constexpr double max_unknown = 4096;  // samples per pixel
    const ImageError error = error_of(film);
    ErrorCheck check;
    if (std::isfinite(error.d_rel()))
        check.expected =
            double(film.min_samples_done()) * square(std::max(1.0, error.d_rel() / wanted));
    const bool is_known = doubt_of(film, error, may_miss_light) == Doubt::no;
    if (is_known && is_small_enough(error, wanted)) check.stop = Stop::error;
    if (!is_known && film.samples_per_pixel() >= max_unknown) check.stop = Stop::error_unknown;
    return check;
}

}  // namespace penumbra

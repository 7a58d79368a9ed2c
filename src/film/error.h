// film/error.h  4  how far an image is from the truth, by the spread of its sets
#pragma once
#include "base/stats.h"
#include "film/film.h"

// ---- One pixel ----------------------------------------------------------------------------------

// Variance of a pixel's value in a channel, from n >= 2 sets of which `shown` make it.  Unbiased.
template <class Pixel, class Value>
double variance_of_pixel(const Film<Pixel>& film, size_t index, size_t c, Value value) {
    const Sets sets = film.sets(index);
    Moments m;
    for (uint32_t set = 0; set < sets.count(); ++set) m.add(value(film.pixel(index, set), c));
    return m.variance() / sets.shown;
}

// NaN where a pixel has one set.
template <class Pixel, class Value>
Image variance_of(const Film<Pixel>& film, Value value) {
    Image image(film.size.width, film.size.height);
    for (size_t i = 0; i < film.number_of_pixels() && film.others_are_complete(); ++i)
        if (film.sets(i).count() > 1)
            for (size_t c = 0; c < 3; ++c)
                image.pixels[i][c] = float(variance_of_pixel(film, i, c, value));
    return image;
}

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

// Unbiased for d^2: a pixel that was measured with a chance of p stands for 1/p pixels (Horvitz,
// Thompson 1952).  Its term T then varies by E[T^2] - E[T]^2, and E[T]^2 = p (n - 1) / (n + 1)
// E[T^2] if n sets of a pixel are normally distributed; the three channels vary as one.
template <class Pixel, class Value>
ImageError error_of(const Film<Pixel>& film, Value value) {
    ImageError e;
    const size_t pixels = film.number_of_pixels();
    double norm2 = 0;
    for (size_t i = 0; i < pixels && film.samples() > 0; ++i)
        for (size_t c = 0; c < 3; ++c) norm2 += std::pow(film.shown(i, c, value), 2);
    e.norm = film.samples() > 0 ? std::sqrt(norm2 / 3 / double(pixels)) : double(NAN);
    if (!film.others_are_complete()) return e;
    e.square = {0, 0, 0};
    double terms2 = 0;
    size_t measured = 0;
    for (size_t i = 0; i < pixels; ++i) {
        const Sets sets = film.sets(i);
        if (sets.count() < 2) continue;
        ++measured;
        const double chance = sets.chance > 0 ? sets.chance : 1, n = sets.count();
        double term = 0;
        for (size_t c = 0; c < 3; ++c) {
            const double v = variance_of_pixel(film, i, c, value) / chance;
            e.square[c] += v / double(pixels);
            term += v / 3 / double(pixels);
        }
        terms2 += term * term * (1 - chance * (n - 1) / (n + 1));
        e.greatest = std::fmax(e.greatest, term);
    }
    e.spread = std::sqrt(terms2);
    return measured > 0 ? e : ImageError{.norm = e.norm};
}

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
// spoils, the pixel for some of the light that was not seen (both by `make calibration`).
//
// How many more samples to take before the next look, after `samples`; 0: enough.  No more than
// would do if the error fell like 1 / samples, which few do, and a look is cheap;
// but a 32nd of them at least, and at most as many again, for the estimate may be far off.  An
// error that is not known is not small.
inline uint64_t samples_to_look(const ImageError& e, double wanted, uint64_t samples) {
    const double now = e.d_rel_and_unseen() + margin_of_error * e.standard_error();
    if (now <= wanted) return 0;
    const double part = std::clamp(now / wanted - 1, 1.0 / 32, 1.0);
    return std::max<uint64_t>(1, uint64_t(part < 1 ? part * double(samples) : double(samples)));
}

// film/pixels.h  4  what a film holds of its pixels, and what that says
#pragma once
#include "film/error.h"
#include "film/image.h"

// ---- All pixels ---------------------------------------------------------------------------------

// What the image of a film shows: the pixels' values, or their variances as sets tell them, NaN
// where a pixel has one set.
enum class Shows { values, variances };

// Pixels row by row, in blocks of equal size that threads take; the last one may be shorter.
struct Blocks {
    size_t pixels = 0;

    // Small enough that a picture of one row, or a small one, has work for all threads.
    size_t size() const { return std::clamp<size_t>(pixels / 256, 1, 256); }
    size_t count() const { return (pixels + size() - 1) / size(); }
    size_t begin(size_t block) const { return block * size(); }
    size_t end(size_t block) const { return std::min(pixels, begin(block) + size()); }
};

// All that a film is between two passes, or when one was interrupted.
template <class Pixel>
struct FilmState {
    uint64_t samples = 0, samples_of_others = 0;  // of first sets, of the other sets
    uint64_t sets_after = 0;                      // samples after which these were chosen
    uint64_t pass = 0;                            // samples of the running pass
    std::vector<Pixel> first;                     // set 0 of each pixel
    std::vector<double> spread;     // of its samples, see Pixel::spread; until sets are known
    std::vector<Sets> sets;         // of each pixel; empty: one
    std::vector<Pixel> others;      // the other sets of pixel 0, those of pixel 1 ...
    std::vector<size_t> others_of;  // where those of a block begin
    std::vector<char> ahead;        // blocks that have the running pass
    std::vector<ErrorTerms> terms;  // of each block, before the running pass
    Image image;                    // of those that are ahead, without the running pass
};

// The sets of a pixel that have samples.
template <class Pixel>
struct SetsOfPixel {
    Sets sets;
    const Pixel *first, *others;
    const Pixel& operator[](uint32_t set) const { return set > 0 ? others[set - 1] : *first; }
};

// The mean of what n samples of each shown set say, and the variance of that as at least two sets
// tell it.  Both unbiased.
template <class Pixel>
double shown(const SetsOfPixel<Pixel>& pixel, const typename Pixel::Value& value, uint64_t n,
             size_t c) {
    double sum = 0;
    for (uint32_t set = 0; set < pixel.sets.shown; ++set) sum += value(pixel[set], n, c);
    return sum / pixel.sets.shown;
}
template <class Pixel>
double variance_of_shown(const SetsOfPixel<Pixel>& pixel, const typename Pixel::Value& value,
                         uint64_t n, size_t c) {
    Moments m;
    for (uint32_t set = 0; set < pixel.sets.count(); ++set) m.add(value(pixel[set], n, c));
    return m.variance() / pixel.sets.shown;
}

template <class Pixel>
ErrorTerms terms_of(const SetsOfPixel<Pixel>& pixel, const typename Pixel::Value& value,
                    uint64_t n) {
    std::array<double, 3> values{};
    ErrorTerms terms;
    for (size_t c = 0; c < 3; ++c) values[c] = shown(pixel, value, n, c);
    terms.add(values);
    if (pixel.sets.count() < 2) return terms;
    for (size_t c = 0; c < 3; ++c) values[c] = variance_of_shown(pixel, value, n, c);
    terms.add_variance(values, pixel.sets);
    return terms;
}

template <class Pixel>
std::array<float, 3> picture_of(const SetsOfPixel<Pixel>& pixel, const typename Pixel::Value& value,
                                uint64_t n, Shows shows) {
    std::array<float, 3> picture{NAN, NAN, NAN};
    for (size_t c = 0; c < 3 && n > 0; ++c)
        if (shows == Shows::values)
            picture[c] = float(shown(pixel, value, n, c));
        else if (pixel.sets.count() > 1)
            picture[c] = float(variance_of_shown(pixel, value, n, c));
    return picture;
}

// ---- Means --------------------------------------------------------------------------------------

// Whether an image file can hold it; a mean of such values fits as well.
inline bool fits_float(rgb L) {
    return std::isfinite(float(L.x)) && std::isfinite(float(L.y)) && std::isfinite(float(L.z));
}

// Sums of samples.
struct MeanPixel {
    static constexpr const char* name = "means";
    using Sample = rgb;
    using Sums = std::array<double, 3>;  // one a channel
    Sums sum{};

    static MeanPixel unwritten() { return {{NAN, NAN, NAN}}; }
    static bool fits(rgb L) { return fits_float(L); }
    void add(uint64_t, rgb L) {
        for (size_t c = 0; c < 3; ++c) sum[c] += double(L.*axis[c]);
    }

    // Of further samples.
    void add(const MeanPixel& p) {
        for (size_t c = 0; c < 3; ++c) sum[c] += p.sum[c];
    }

    // Of all channels together (Welford 1962).
    double spread(uint64_t i, rgb L) const {
        const double n = double(i);
        double squares = 0;
        for (size_t c = 0; c < 3 && i > 0; ++c) squares += sqr(double(L.*axis[c]) - sum[c] / n);
        return squares * (n / (n + 1));
    }
    // Variance of the mean of n independent samples.
    double noise(uint64_t n, double spread) const {
        return n < 2 ? 0 : spread / double(n - 1) / double(n);
    }

    struct Value {
        double operator()(const MeanPixel& p, uint64_t n, size_t c) const {
            return p.sum[c] / double(n);
        }
    };

private:
    static double sqr(double x) { return x * x; }
};

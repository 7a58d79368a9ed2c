// film/film.h  2  a film: sums of samples, in independent replications of each pixel
//
// A replication is n samples with a randomisation of their own.  A pixel's value is the mean of its
// replications; their sample variance gives its error.  Pixels with noisy neighbours have more.
#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <tuple>
#include <vector>

#include "base/stats.h"
#include "film/image.h"
#include "path/sampler.h"

// Results of samples other than their radiance.
struct Tally {
    uint64_t rays = 0;
    double share = 1;              // 1 / number of the pixel's replications
    std::vector<FixedPoint> sums;  // evidence for the judge of the film; see Film
};

// The radiance of a sample, and its tally.  Calls come from several threads.
using Radiance = std::function<rgb(const PixelSample&, Tally&)>;

// A sum of samples, per channel.
struct Sum {
    std::array<double, 3> L{};
    void add(rgb sample) {
        for (size_t c = 0; c < 3; ++c) L[c] += double(sample.*axis[c]);
    }
};

inline constexpr uint64_t most_sets = 1024;

// The file of a film holds these arrays.  Before replications (`sets`) are chosen, a pixel has one,
// the pilot.  It is later the first.
struct Film {
    Size size;
    int first_row = 0;                 // row of the whole picture where this band begins
    uint64_t pilot = 0;                // samples of the first replications when `sets` were chosen
    std::vector<uint16_t> sets;        // replications of each pixel; empty: not yet chosen
    std::vector<Sum> sum;              // sums of the replications of pixel 0, of pixel 1 ...
    std::vector<uint64_t> taken;       // samples of each replication of a block's pixels
    std::vector<FixedPoint> evidence;  // sums of tallies: films that are put together add them
    std::vector<float> spread;  // per pixel: root of the sum of squared deviations in the pilot

    size_t pixels() const { return size_t(size.width) * size_t(size.height); }
    uint32_t sets_of(size_t pixel) const { return sets.empty() ? 1 : sets[pixel]; }
    double replications_per_pixel() const { return double(sum.size()) / double(pixels()); }

    // Threads take pixels in blocks, small enough that a small picture has work for all of them.
    size_t block_size() const { return std::clamp<size_t>(pixels() / 256, 1, 256); }
    size_t begin(size_t block) const { return block * block_size(); }
    size_t end(size_t block) const { return std::min(pixels(), begin(block) + block_size()); }

    // Samples of a replication.
    uint64_t samples(size_t block, uint32_t set) const {
        return set == 0 ? std::max(taken[block], pilot) : taken[block];
    }
    uint64_t least_taken() const { return *std::min_element(taken.begin(), taken.end()); }
    uint64_t most_taken() const { return *std::max_element(taken.begin(), taken.end()); }
    // Samples of all pixels together, once each replication has n or more.
    double total(uint64_t n = 0) const {
        double all = 0;
        for (size_t b = 0; b < taken.size(); ++b)
            for (size_t i = begin(b); i < end(b); ++i)
                all += double(std::max(n, samples(b, 0))) +
                       double(std::max(n, taken[b])) * double(sets_of(i) - 1);
        return all;
    }
};

// A film with `sets` replications per pixel; 0: chosen after the pilot.
inline Film make_film(Size size, uint32_t sets, int first_row = 0) {
    Film f;
    f.size = size, f.first_row = first_row;
    const size_t n = f.pixels();
    f.taken.assign((n + f.block_size() - 1) / f.block_size(), 0);
    f.sum.resize(n * std::max<uint32_t>(1, sets));
    if (sets > 0)
        f.sets.assign(n, uint16_t(sets));
    else
        f.spread.resize(n);
    return f;
}

// The head of a film's file: keys and values.
using Facts = std::vector<std::array<std::string, 2>>;
struct FilmOf {
    std::vector<std::string> files;  // that the scene was read from
    Facts samples, notes;            // facts that samples depend on, and other facts
};

// Resources spent so far.
struct Spent {
    double seconds = 0, cpu_seconds = 0;
    uint64_t rays = 0;
};

// ---- Pixels -------------------------------------------------------------------------------------

// The replications of a pixel: its value and variance.
struct Pixel {
    std::span<const Sum> sum;
    uint64_t first, others;  // samples of the first replication, and of each other one

    double samples() const { return double(first) + double(others) * double(sum.size() - 1); }
    // Replications that have samples.
    size_t count() const { return others > 0 ? sum.size() : first > 0 ? 1 : 0; }
    double mean_of(size_t set, size_t c) const {
        return sum[set].L[c] / double(set == 0 ? first : others);
    }
    // The mean of replications: unbiased, even if the first has more samples.  NaN: there is none.
    double value(size_t c) const {
        double all = 0;
        for (size_t set = 0; set < count(); ++set) all += mean_of(set, c);
        return all / double(count());
    }
    // Unbiased variance of that value; NaN for fewer than two replications.
    double variance(size_t c) const {
        Moments m;
        for (size_t set = 0; set < count(); ++set) m.add(mean_of(set, c));
        return m.n > 1 ? m.variance() / double(m.n) : double(NAN);
    }
};

// Where the replications of each block begin in `sum`.
inline std::vector<size_t> offsets(const Film& f) {
    std::vector<size_t> at{0};
    for (size_t b = 0; b < f.taken.size(); ++b) {
        at.push_back(at.back());
        for (size_t i = f.begin(b); i < f.end(b); ++i) at.back() += f.sets_of(i);
    }
    return at;
}

// Calls see(i, pixel i) for all pixels in order.
template <class See>
void for_each_pixel(const Film& f, See see) {
    const Sum* sum = f.sum.data();
    for (size_t b = 0; b < f.taken.size(); ++b)
        for (size_t i = f.begin(b); i < f.end(b); sum += f.sets_of(i++))
            see(i, Pixel{{sum, f.sets_of(i)}, f.samples(b, 0), f.taken[b]});
}

// NaN where a pixel has no sample.
inline Image image_of(const Film& f) {
    Image image(f.size.width, f.size.height);
    for_each_pixel(f, [&](size_t i, const Pixel& p) {
        for (size_t c = 0; c < 3; ++c) image.pixels[i][c] = float(p.value(c));
    });
    return image;
}

// ---- Samples ------------------------------------------------------------------------------------

// Samples that an image file cannot hold, and the first of them.
struct NonFinite {
    uint64_t count = 0;
    PixelSample first;

    void add(const NonFinite& other) {
        auto order = [](const PixelSample& s) { return std::tuple(s.i, s.set, s.y, s.x); };
        if (other.count == 0) return;
        if (count == 0 || order(other.first) < order(first)) first = other.first;
        count += other.count;
    }
};

// "pixel 3,4 sample 5,1", or as options have it.
inline std::string in_words(const PixelSample& s, const char* pixel = "pixel ",
                            const char* sample = " sample ") {
    const std::string words =
        pixel + std::to_string(s.x) + "," + std::to_string(s.y) + sample + std::to_string(s.i);
    return s.set > 0 ? words + "," + std::to_string(s.set) : words;
}

inline bool fits_float(rgb L) {
    return std::isfinite(float(L.x)) && std::isfinite(float(L.y)) && std::isfinite(float(L.z));
}

// Adds samples, in order, until each replication of a block has n.  Sums begin at `offset`.  The
// image does not depend on passes and threads.  If L throws, the block stays as it was.
inline NonFinite add_samples(Film& f, size_t block, size_t offset, uint64_t n, const Radiance& L,
                             Tally& tally) {
    const size_t from = f.begin(block), to = f.end(block), width = size_t(f.size.width);
    NonFinite bad;
    std::vector<Sum> sums;
    std::vector<float> spread;
    sums.reserve(16 * (to - from)), spread.reserve(to - from);
    for (size_t i = from, k = offset; i < to; ++i) {
        float root = f.spread.empty() ? 0 : f.spread[i];
        tally.share = 1.0 / std::max(2u, f.sets_of(i));  // the pilot is one of two or more
        for (uint32_t set = 0; set < f.sets_of(i); ++set) {
            Sum sum = f.sum[k++];
            for (uint64_t s = f.samples(block, set); s < n; ++s) {
                const PixelSample which{int(i % width), f.first_row + int(i / width), s, set};
                const rgb sample = L(which, tally);
                if (!fits_float(sample)) bad.add({1, which});
                double squares = double(root) * double(root);
                for (size_t c = 0; c < 3 && s > 0 && !f.spread.empty(); ++c) {
                    const double m = double(s), d = double(sample.*axis[c]) - sum.L[c] / m;
                    squares += d * d * (m / (m + 1));  // Welford 1962
                }
                root = float(std::sqrt(squares));
                sum.add(sample);
            }
            sums.push_back(sum);
        }
        spread.push_back(root);
    }
    std::copy(sums.begin(), sums.end(), f.sum.begin() + ptrdiff_t(offset));
    if (!f.spread.empty())
        std::copy(spread.begin(), spread.end(), f.spread.begin() + ptrdiff_t(from));
    f.taken[block] = std::max(f.taken[block], n);
    return bad;
}

// ---- Adaptive replications ----------------------------------------------------------------------

// The factor of the rule below, and the maximum per pixel; see reference/replications.md.
struct Allocation {
    double factor = 3.5;
    uint32_t most = 32;
};

// Fewest replications of a pixel where few samples meet bright light.
inline constexpr uint32_t least_of_noisy = 8;

// Samples of the pilot.
inline constexpr uint64_t pilot_samples = 8;

// Samples proportional to the standard deviation minimise the time for an MSE (Neyman 1934).  A
// pixel has factor sqrt(noise of its neighbours / mean noise of all pixels of the other colour of a
// checkerboard) replications, at least 2.  Its own samples never influence its number, so that its
// mean stays unbiased.  `spread` is the standard deviation of samples, up to a factor.
inline std::vector<uint16_t> sets_where_noise_is(const std::vector<float>& spread, Size size,
                                                 const Allocation& by = {}) {
    const int w = size.width, h = size.height;
    auto at = [&](int x, int y) {
        const double v = double(spread[size_t(y) * size_t(w) + size_t(x)]);
        return v * v;
    };
    double sum[2] = {}, count[2] = {};
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) sum[(x + y) & 1] += at(x, y), ++count[(x + y) & 1];
    std::vector<uint16_t> sets(spread.size(), 2);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            double around = 0, neighbours = 0;
            for (int v = std::max(0, y - 1); v <= std::min(h - 1, y + 1); ++v)
                for (int u = std::max(0, x - 1); u <= std::min(w - 1, x + 1); ++u)
                    if (u != x || v != y) around += at(u, v), ++neighbours;
            const size_t other = size_t(x + y + 1) & 1;
            const double ratio = around / neighbours / (sum[other] / count[other]);
            if (!(ratio > 0)) continue;  // no noise, or no neighbour
            const double K = by.factor * std::sqrt(ratio) + 0.5;
            sets[size_t(y) * size_t(w) + size_t(x)] = uint16_t(std::clamp(K, 2.0, double(by.most)));
        }
    return sets;
}

// Bytes of a film: 24 for each replication of a pixel, and at most 32 per pixel for all else.
inline double bytes_of(Size size, double sets) {
    return (32 + 24 * sets) * double(size.width) * double(size.height);
}

// Chooses replications by the pilot, which all blocks have; `noisy` pixels, where few samples meet
// bright light, get 8 or more.  If memory has too few bytes, the maximum per pixel is reduced.
// Returns that maximum.
inline uint32_t choose_sets(Film& f, double memory, const std::vector<size_t>& noisy = {}) {
    Allocation by;
    for (;; --by.most) {
        f.sets = sets_where_noise_is(f.spread, f.size, by);
        for (size_t i : noisy)
            f.sets[i] = std::max(f.sets[i], uint16_t(std::min(by.most, least_of_noisy)));
        double all = 0;
        for (uint16_t k : f.sets) all += k;
        if (by.most == 2 || bytes_of(f.size, all / double(f.pixels())) <= memory) {
            f.spread = std::vector<float>();  // with its memory
            std::vector<Sum> sum(size_t(all), Sum{});
            for (size_t i = 0, k = 0; i < f.pixels(); k += f.sets[i++]) sum[k] = f.sum[i];
            f.sum = std::move(sum);
            break;
        }
    }
    f.pilot = f.taken[0];
    f.taken.assign(f.taken.size(), 0);
    return by.most;
}

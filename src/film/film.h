// film/film.h  2  a film: sums of samples, in independent replications of each pixel
//
// A replication is n samples with a randomisation of their own.  The mean of a pixel's replications
// is its value, and their spread tells its error.  Pixels whose neighbours are noisy have more.
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

// What samples leave beside their radiance.
struct Tally {
    uint64_t rays = 0;
    double share = 1;              // of a sample of this pixel, whose replications are 1 / share
    std::vector<FixedPoint> sums;  // evidence for whoever judges the film; see Film
};

// The radiance of a sample, and its tally.  Calls come from several threads.
using Radiance = std::function<rgb(const PixelSample&, Tally&)>;

// A channel at a time.
struct Sum {
    std::array<double, 3> L{};
    void add(rgb sample) {
        for (size_t c = 0; c < 3; ++c) L[c] += double(sample.*axis[c]);
    }
};

inline constexpr uint64_t most_sets = 1024;

// The file of a film is these arrays.  Before sets are chosen a pixel has one replication, the
// pilot, which is later the first.
struct Film {
    Size size;
    int first_row = 0;            // of the picture that it holds a band of
    uint64_t pilot = 0;           // samples that the first replications had when sets were chosen
    std::vector<uint16_t> sets;   // replications of each pixel; empty: not yet chosen
    std::vector<Sum> sum;         // of each replication: those of pixel 0, those of pixel 1 ...
    std::vector<uint64_t> taken;  // samples that each replication of a block's pixels has
    std::vector<FixedPoint> evidence;  // sums of tallies: films that are put together add them
    std::vector<float> spread;  // of each pixel's pilot: root of the squared distances to its mean

    size_t pixels() const { return size_t(size.width) * size_t(size.height); }
    uint32_t sets_of(size_t pixel) const { return sets.empty() ? 1 : sets[pixel]; }
    double sets_per_pixel() const { return double(sum.size()) / double(pixels()); }

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

// Of `sets` replications a pixel; 0: yet to be chosen.
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

// What its file says of it: keys and values.
using Facts = std::vector<std::array<std::string, 2>>;
struct FilmOf {
    std::vector<std::string> files;  // of the scene
    Facts samples, notes;            // what the samples depend on, and other things to know
};

// What it took so far.
struct Spent {
    double seconds = 0, cpu_seconds = 0;
    uint64_t rays = 0;
};

// ---- Pixels -------------------------------------------------------------------------------------

// What the replications of a pixel tell.
struct Pixel {
    std::span<const Sum> sum;
    uint64_t first, others;  // samples of the first, of each other

    double samples() const { return double(first) + double(others) * double(sum.size() - 1); }
    // Replications that have samples.
    size_t count() const { return others > 0 ? sum.size() : first > 0 ? 1 : 0; }
    double mean_of(size_t set, size_t c) const {
        return sum[set].L[c] / double(set == 0 ? first : others);
    }
    // Their mean: unbiased, whether they have as many samples or not.  NaN: there is none.
    double value(size_t c) const {
        double all = 0;
        for (size_t set = 0; set < count(); ++set) all += mean_of(set, c);
        return all / double(count());
    }
    // The variance of that, unbiased as well; NaN: fewer than two tell nothing.
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

// Brings the replications of a block, which begin at `offset`, to n samples, in order: the image
// is the same however passes and threads divide them.  If L throws, the block stays as it was.
inline NonFinite add_samples(Film& f, size_t block, size_t offset, uint64_t n, const Radiance& L,
                             Tally& tally) {
    const size_t from = f.begin(block), to = f.end(block), width = size_t(f.size.width);
    NonFinite bad;
    std::vector<Sum> sums;
    std::vector<float> spread;
    sums.reserve(16 * (to - from)), spread.reserve(to - from);
    for (size_t i = from, k = offset; i < to; ++i) {
        float root = f.spread.empty() ? 0 : f.spread[i];
        tally.share = 1.0 / std::max(2u, f.sets_of(i));  // a pilot is one of two or more
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

// ---- Replications where noise is ----------------------------------------------------------------

// The most of a pixel, and the factor of the rule below; see reference/replications.md.
struct Allocation {
    double factor = 3.5;
    uint32_t most = 32;
};

// Replications of a pixel of which few samples tell.
inline constexpr uint32_t least_of_noisy = 8;

// Samples of the pilot.
inline constexpr uint64_t pilot_samples = 8;

// The time to a squared error is least where samples are in proportion to the root of their
// variance (Neyman 1934): factor sqrt(noise of the neighbours / mean noise of all pixels of the
// other colour of a checkerboard), at least 2.  A pixel's own samples have no say in that, so that
// its mean stays unbiased.  `spread`: standard deviation of samples, up to a factor.
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

// Bytes that a pixel takes: 24 for each replication, and at most 32 for all else.
inline double bytes_of(Size size, double sets) {
    return (32 + 24 * sets) * double(size.width) * double(size.height);
}

// Chooses sets by the pilot, which all blocks have, and 8 where it is known that few samples meet
// what is bright (`noisy`); fewer of them where they do not fit into so many bytes.  Returns the
// most that a pixel may have.
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

// whole/extremes_sums_test.cpp  large numbers of paths, and sums over them
#include "base/stats.h"
#include "film/fill.h"
#include "path/samplers.h"
#include "whole/extremes.h"

namespace {

// Radical inverses at an index and below it, against the sum of d_k b^(-k-1).
double halton_at(uint64_t index) {
    Worst worst;
    for (uint32_t base : {2u, 3u, 5u, 541u, 104729u})
        for (uint64_t i : {index - 2, index - 1, index}) {
            big truth = 0, scale = 1;
            for (uint64_t rest = i; rest > 0; rest /= base)
                truth += big(rest % base) * (scale /= base);
            const real x = radical_inverse(base, i);
            worst.see(x < 1 ? relative(x, std::min(truth, big(below_one))) : HUGE_VAL);
        }
    return worst.value;
}

// Blocks of b^k scrambled points at very large indices: counts intervals of b^-k without exactly
// one point.
double halton_blocks() {
    Dice random{{oracle::seed_of("blocks")}};
    int wrong = 0;
    for (uint32_t base : {2u, 3u, 5u})
        for (uint64_t about : {uint64_t(1) << 31, uint64_t(1) << 32, uint64_t(1) << 53}) {
            const uint64_t n = uint64_t(base) * base * base, start = about / n * n;
            const uint64_t shift = random.rng.bits(), factor = random.rng.bits();
            std::vector<int> points(n);
            for (uint64_t i = start; i < start + n; ++i) {
                const real x = scrambled_radical_inverse(base, i, shift, factor);
                // Rounding may move a point across a border.
                ++points[std::min<uint64_t>(uint64_t(x * real(n) * (1 + 8 * ulp)), n - 1)];
            }
            for (int p : points) wrong += p != 1;
        }
    return wrong;
}

// The 2^40th sample of a pixel: grids are still complete, and all numbers are in [0,1).
double late_samples() {
    int wrong = 0;
    const uint64_t late = uint64_t(1) << 40;
    for (SamplerKind kind : samplers) {
        const SamplerSettings settings = sampler_settings(kind, oracle::seed_of("late samples"), 4);
        for (uint32_t dim : {film_x, dimension(3, Dimension::wi_x)}) {
            int cells[16] = {};
            for (uint64_t i = late; i < late + 16; ++i) {
                const vec2 u = Sampler(settings, 77, i).get2(dim);
                const bool inside = u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1;
                wrong += !inside;
                if (inside) ++cells[size_t(u.x * 4) * 4 + size_t(u.y * 4)];
            }
            if (kind == SamplerKind::stratified)
                for (int c : cells) wrong += c != 1;
        }
    }
    return wrong + !(to_unit(0xffffffff80u) < 1) + !(to_unit(UINT64_MAX) < 1);
}

// 1e9 numbers in 1000 parts, each of 0 ... 999 a million times: mean 499.5, variance (1000^2 - 1) /
// 12 n / (n - 1).
double merged_billion() {
    Moments part, all;
    for (int i = 0; i < 1000000; ++i) part.add(i % 1000);
    for (int i = 0; i < 1000; ++i) all.merge(part);
    const double truth = (1e6 - 1) / 12 * 1e9 / (1e9 - 1);
    return std::max(relative(all.mean, 499.5), relative(all.variance(), truth));
}

// The film's mean of 1e9 samples of one pixel, alternately 0.1 and 0.3, one by one.
double billion_one_by_one() {
    const real low = real(0.1), high = real(0.3);
    const Film film = filled({1, 1}, 1, 1000000000, [&](const PixelSample& s, Tally&) {
        const real L = s.i % 2 ? high : low;
        return rgb{L, L, L};
    });
    // The image stores float: one more rounding, 6e-8.
    return relative(image_of(film).at(0, 0)[0], (double(low) + double(high)) / 2);
}

// Moments of doubles with mean 1e8 and sigma 1.
double variance_far_from_zero() {
    Moments m;
    for (int i = 0; i < 100000; ++i) m.add(1e8 + (i % 2 ? 1 : -1));
    return relative(m.variance(), 1e5 / (1e5 - 1));
}

// The same numbers as radiance in the film.
double film_far_from_zero() {
    Film film = make_film({1, 1}, 1, true);
    fill(film, 1000, [](const PixelSample& s, Tally&) {
        const real L = real(1e8) + (s.i % 2 ? real(1) : real(-1));
        return rgb{L, L, L};
    });
    return relative(film.pilot_deviation[0], std::sqrt(3e3));
}

// P(|z| > 20), and Student's t far out: P(|t| > x) -> 2 / (pi x) for one degree of freedom.
double tails() {
    return std::max(relative(oracle::p_of_z(20), 5.507248237212467e-89L),
                    relative(oracle::p_of_t(1e8, 1), 2 / (big_pi * 1e8L)));
}

}  // namespace

TEST_CASE("extremes of numbers and sums: no more error than they may have") {
    check_rows({
        {"Halton up to index 2^31", ulps(4), of(halton_at, uint64_t(1) << 31)},
        {"Halton up to index 2^32", ulps(4), of(halton_at, uint64_t(1) << 32)},
        {"Halton up to index 2^53", ulps(4), of(halton_at, uint64_t(1) << 53)},
        {"Halton up to index 2^64 - 1", ulps(4), of(halton_at, UINT64_MAX)},
        {"scrambled Halton at 2^31, 2^32, 2^53: intervals without their one point", to_the_bit,
         halton_blocks},
        {"sample 2^40 of a pixel: numbers outside [0,1), cells without their one point", to_the_bit,
         late_samples},
        {"10^9 numbers, merged: mean and variance", within(1e-12, 1e-12), merged_billion},
        // The image is float: 6e-8.
        {"10^9 samples of a pixel, one by one: mean", within(1e-7, 1e-7), billion_one_by_one,
         false},
        {"mean 10^8, sigma 1: variance", within(1e-6, 1e-6), variance_far_from_zero},
        {"radiance 10^8, sigma 1: deviation in the film", within(1e-6, any), film_far_from_zero},
        {"p-values of z = 20, of Student's t = 10^8", within(1e-12, 1e-12), tails},
    });
}

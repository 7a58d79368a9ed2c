// film/film_test.cpp  sums of samples, and statistics per pixel
#include "film/film.h"

#include <map>

#include "base/approx.h"
#include "base/cases.h"
#include "base/rng.h"
#include "film/fill.h"
#include "oracle/expect.h"
#include "text/image_file.h"

namespace {

using Colour = std::array<float, 3>;

// A value for every sample; the rounded sum depends on the order of addition.
const SampleFunction numbered = [](const PixelSample& s, Tally& tally) {
    tally.rays += 1 + s.i;
    const uint64_t bits = hash(hash(hash(uint64_t(s.y), uint64_t(s.x)), s.replication), s.i);
    const real v = std::ldexp(to_unit(bits), int(s.i * 37 % 60) - 30);
    return rgb{v, real(s.i), real(s.replication)};
};

// Pixels have the weights 1, 2, 4, 8, 16 in turn, after a pilot of one sample or without.
Film film_of_weights(Size size, uint32_t K, bool has_pilot = false) {
    Film f = make_film(size, K, has_pilot);
    if (has_pilot) {
        fill(f, 1, numbered);
        choose_weights(f);
    }
    for (size_t i = 0; i < f.pixels(); ++i) f.weight[i] = uint8_t(1 << i % 5);
    return f;
}

}  // namespace

TEST_CASE("blocks are all pixels, each once; a row and a small picture have work for all threads") {
    for (Size size : {Size{1, 1}, Size{16384, 1}, Size{33, 17}, Size{2048, 1024}, Size{1, 509}}) {
        const Film f = make_film(size, 1, false);
        CAPTURE(f.pixels());
        size_t next = 0;
        for (size_t b = 0; b < f.blocks(); ++b) {
            CHECK(f.begin(b) == next);
            CHECK(f.end(b) > next);
            CHECK(f.end(b) - next <= 256);
            next = f.end(b);
        }
        CHECK(next == f.pixels());
        CHECK(f.blocks() >= std::min<size_t>(f.pixels(), 256));
    }
}

TEST_CASE("a pass takes each sample of each replication once, in order, of its own rows") {
    for (Size size : {Size{1, 1}, Size{2000, 1}, Size{33, 17}, Size{1, 509}}) {
        Film f = film_of_weights(size, 3);
        f.first_row = 100;
        std::map<std::array<int, 3>, uint64_t> taken;  // y, x, replication
        uint64_t out_of_order = 0;
        const SampleFunction L = [&](const PixelSample& s, Tally&) {
            out_of_order += s.i != taken[{s.y, s.x, int(s.replication)}]++;
            return rgb{1, 1, 1};
        };
        for (uint64_t n : {2, 5}) fill(f, n, L);
        CHECK(out_of_order == 0);
        CHECK(taken.size() == 3 * f.pixels());
        size_t wrong = 0;
        double all = 0;
        for (const auto& [at, n] : taken) {
            const size_t i = size_t(at[0] - 100) * size_t(size.width) + size_t(at[1]);
            wrong += i >= f.pixels() || at[2] > 2 || n != uint64_t(5) << i % 5;
            all += double(n);
        }
        CHECK(wrong == 0);
        CHECK(f.samples_per_pixel() == about(all / double(f.pixels()), 1e-14));
    }
}

TEST_CASE("a pixel is the mean of its samples, however passes divide them") {
    for (Size size : {Size{2, 2}, Size{1600, 1}})  // blocks of one pixel, and of six
        for (bool has_pilot : {false, true}) {
            Film whole = film_of_weights(size, 3, has_pilot);
            fill(whole, 12, numbered);
            const Image image = image_of(whole);
            size_t wrong = 0;
            Tally tally;
            for (size_t i = 0; i < whole.pixels(); ++i) {
                double value = 0;
                const uint64_t n = uint64_t(12) << i % 5;
                for (uint32_t k = 0; k < 3; ++k) {
                    double sum = 0;
                    for (uint64_t s = 0; s < n; ++s)
                        sum += double(numbered(whole.sample_of(i, s, k), tally).x);
                    wrong += whole.sum[3 * i + k][0] != sum;
                    value += sum;
                }
                wrong += whole.samples(i) != n;
                wrong += image.pixels[i] !=
                         Colour{float(value / double(3 * n)), float(double(n - 1) / 2), 1};
            }
            CHECK(wrong == 0);
            for (const auto& passes : {std::vector<uint64_t>{1, 2, 3, 4, 5, 6, 12},
                                       {1, 3, 7, 12},
                                       {5, 5, 4, 12},
                                       {11, 12}}) {
                Film f = film_of_weights(size, 3, has_pilot);
                for (uint64_t n : passes)
                    if (f.min_samples_done() % 2)
                        fill(f, n, numbered);
                    else
                        for (size_t b = f.blocks(); b-- > 0;) fill_blocks(f, b, b + 1, n, numbered);
                CHECK(same(f, whole));
            }
        }
}

TEST_CASE("a pixel keeps its pilot, and goes on where that ended") {
    Film f = make_film({2, 1}, 2, true);
    CHECK(!f.has_samples());
    fill(f, 4, numbered);
    CHECK(said(f.has_samples(), f.samples(0), f.samples_per_pixel(), f.samples_per_pixel(6)) ==
          "yes 4 8 12");
    choose_weights(f);
    f.weight = {1, 4};
    CHECK(said(f.has_samples(), f.min_samples_done(), f.pilot, f.is_pilot) == "yes 0 4 no");
    CHECK(said(f.samples_per_pixel(), f.samples_per_pixel(1)) == "8 8");
    for (const auto& row : std::initializer_list<std::array<uint64_t, 3>>{
             {1, 4, 4}, {2, 4, 8}, {3, 4, 12}, {5, 5, 20}}) {
        CHECK(f.samples_per_pixel(row[0]) == double(row[1] + row[2]));
        fill(f, row[0], numbered);
        CHECK(said(f.samples(0), f.samples(1)) == said(row[1], row[2]));
        CHECK(f.samples_per_pixel() == double(row[1] + row[2]));
        CHECK(image_of(f).at(0, 0)[1] == float(row[1] - 1) / 2);
        CHECK(image_of(f).at(1, 0)[1] == float(row[2] - 1) / 2);
    }
}

TEST_CASE("the share of a sample is one over the replications and the weight") {
    Film f = film_of_weights({5, 1}, 3);
    std::vector<double> shares(5);
    fill(f, 7, [&](const PixelSample& s, Tally& tally) {
        shares[size_t(s.x)] += tally.share;
        return rgb{};
    });
    for (double all : shares) CHECK(all == about(7, 1e-14));
}

TEST_CASE("a film adds up in double: 2^24 ones and more, beside numbers of 1e-9") {
    const Film f = filled({1, 1}, 1, 1000, [](const PixelSample& s, Tally&) {
        const real tiny = s.i % 2 ? real(1e-9) : 0;
        return rgb{s.i < 2 ? real(1 << 24) : 1, s.i < 2 ? 1 : tiny, 0};
    });
    CHECK(image_of(f).at(0, 0)[0] == float((2.0 * (1 << 24) + 998) / 1000));
    CHECK(image_of(f).at(0, 0)[1] == float((2 + 499e-9) / 1000));
}

TEST_CASE("samples that no file can hold are counted, and the first of them told") {
    const real nan = std::numeric_limits<real>::quiet_NaN();
    // The keys are sample, replication, row, column.
    const std::map<std::array<int, 4>, rgb> bad = {{{7, 0, 0, 0}, {nan, 1, 1}},
                                                   {{4, 1, 2, 1}, {1, nan, 1}},
                                                   {{4, 1, 1, 2}, {1, 1, -infinity}},
                                                   {{4, 2, 0, 0}, {infinity, 1, 1}},
                                                   {{5, 0, 1, 0}, {1, nan, 1}}};
    const SampleFunction L = [&](const PixelSample& s, Tally&) {
        const auto found = bad.find({int(s.i), int(s.replication), s.y, s.x});
        return found == bad.end() ? rgb{1, 1, 1} : found->second;
    };
    for (bool upwards : {false, true}) {
        Film f = make_film({3, 3}, 3, false);
        CHECK(fill(f, 4, L).bad == 0);
        Tally all;
        for (size_t k = 0; k < 9; ++k) {
            const size_t b = upwards ? 8 - k : k;
            const Tally of_block = fill_blocks(f, b, b + 1, 8, L);
            CHECK(of_block.bad == (b == 0 ? 2 : b == 3 || b == 5 || b == 7 ? 1 : 0));
            all.add_bad(of_block.bad, of_block.first_bad);
        }
        const PixelSample& first = all.first_bad;
        CHECK(said(all.bad, first.i, first.replication, first.y, first.x) == "5 4 1 1 2");
    }
    const real beyond = real(1e30) * real(1e10);  // finite, but beyond float
    for (real bad_number : {beyond, nan, -infinity})
        for (auto channel : axis) {
            rgb v{1, 1, 1};
            v.*channel = bad_number;
            CHECK(!fits_float(v));
        }
    CHECK(fits_float({-1, 0, real(3e38)}));
}

TEST_CASE("blocks commit whole: one whose function throws stays as it was, and is taken up again") {
    struct Failure {};
    const Size size{1025, 1};  // blocks of four pixels, the last of one
    for (bool is_pilot : {false, true}) {
        Film f = is_pilot ? make_film(size, 2, true) : film_of_weights(size, 2);
        fill(f, 3, numbered);
        REQUIRE(f.blocks() == 257);
        const Film before = f;
        for (uint64_t at = 1; at <= 5; ++at) {
            uint64_t calls = 0;
            const SampleFunction stopped = [&](const PixelSample& s, Tally& tally) {
                if (++calls == 2 * at) throw Failure();
                return numbered(s, tally);
            };
            CHECK_THROWS_AS(fill_blocks(f, 100, 101, 9, stopped), Failure);
            CHECK(same(f, before));
        }
        fill_blocks(f, 0, 100, 9, numbered);
        CHECK(f.min_samples_done() == 3);
        CHECK(f.max_samples_done() == 9);
        const Film some = f;
        CHECK_THROWS_AS(
            fill_blocks(f, 100, 101, 9, [](const PixelSample&, Tally&) -> rgb { throw Failure(); }),
            Failure);
        CHECK(same(f, some));
        size_t wrong = 0;
        const Image image = image_of(f);
        for (size_t i = 0; i < 1025; ++i)
            wrong += image.pixels[i][1] != float(f.weight[i] * (i < 400 ? 9 : 3) - 1) / 2;
        CHECK(wrong == 0);
        fill(f, 9, numbered);
        Film whole = before;
        fill(whole, 9, numbered);
        CHECK(same(f, whole));
    }
}

TEST_CASE("a pixel without samples is no number; one replication has no variance") {
    Film f = make_film({2, 2}, 3, false);
    fill_blocks(f, 0, 2, 1, numbered);
    CHECK(!f.has_samples());
    CHECK(first_non_finite(image_of(f)) == "0,1");
    for (size_t i = 0; i < 4; ++i) {
        const Pixel p = pixel_of(f, i);
        CHECK(p.K == (i < 2 ? 3 : 0));
        CHECK(std::isnan(p.value(0)) == (i >= 2));
        CHECK(std::isnan(p.variance(0)) == (i >= 2));
    }
    const Pixel one = pixel_of(filled({1, 1}, 1, 7, numbered), 0);
    CHECK(said(one.K, one.samples, one.value(1)) == "1 7 3");
    CHECK(std::isnan(one.variance(1)));
    for (Size size : {Size{1, 1}, Size{5, 1}, Size{1, 5}}) {
        f = filled(size, 0, 20, numbered);
        for (size_t i = 0; i < f.pixels(); ++i) {
            const Pixel p = pixel_of(f, i);
            CHECK(p.value(1) == double(20 * f.weight[i] - 1) / 2);
            CHECK(p.variance(1) == 0);
            CHECK(std::isfinite(p.variance(0)));
        }
    }
}

TEST_CASE("value and variance of a pixel are unbiased, of unequal replications, too: exact") {
    // All outcomes of coin tosses are enumerated; each sample is 0 or 1.  Channels differ.
    for (const auto& samples : std::initializer_list<std::vector<uint64_t>>{
             {1, 1}, {2, 2}, {3, 3, 3}, {1, 1, 1, 1}, {3, 1}, {1, 6}, {4, 1, 2}, {1, 2, 3, 4}}) {
        uint64_t tosses = 0;
        for (uint64_t n : samples) tosses += n;
        double value = 0, square = 0, variance = 0;
        size_t wrong = 0;
        for (uint64_t outcome = 0; outcome < uint64_t(1) << tosses; ++outcome) {
            Pixel p;
            uint64_t bits = outcome;
            for (uint64_t n : samples) {
                Sum sum{};
                for (uint64_t t = 0; t < n; ++t, bits >>= 1)
                    add_to(sum, {real(bits & 1), real(2 * (bits & 1)), 3});
                p.add(sum, n);
            }
            value += p.value(0), square += p.value(0) * p.value(0), variance += p.variance(0);
            wrong += p.value(1) != 2 * p.value(0) || p.value(2) != 3 || p.variance(2) != 0 ||
                     p.variance(1) != 4 * p.variance(0);
        }
        const double n = std::ldexp(1, int(tosses));
        CAPTURE(samples.size());
        CAPTURE(tosses);
        CHECK(wrong == 0);
        CHECK(value / n == about(0.5, 1e-13));
        CHECK(square / n - 0.25 == about(0.25 / double(tosses), 1e-12));
        CHECK(variance / n == about(0.25 / double(tosses), 1e-12));
    }
}

TEST_CASE("replications of several films make one pixel, weighed by their samples, in any order") {
    // 4 samples with the means 1 and 3, and 8 samples with the means 2, 3, 7.
    std::vector<std::pair<double, uint64_t>> of = {{1, 4}, {2, 8}, {3, 4}, {3, 8}, {7, 8}};
    do {
        Pixel p;
        p.add({}, 0);  // a film without samples
        for (const auto& [mean, n] : of) p.add({mean * double(n), 0, 5 * double(n)}, n);
        CHECK(said(p.K, p.samples, p.value(0), p.value(1), p.value(2)) == "5 32 3.5 0 5");
        // 4 (2.5^2 + 0.5^2) + 8 (1.5^2 + 0.5^2 + 3.5^2) = 144, over 32 and over 4.
        CHECK(p.variance(0) == about(144 / 32.0 / 4, 1e-14));
        CHECK(p.variance(2) == 0);
    } while (std::ranges::next_permutation(of).found);
}

TEST_CASE("the variance of a pixel far from 0 is that near 0") {
    Pixel p;
    for (int k : {1, 5, 3}) p.add({std::ldexp(1, 40) + k, 0, 0}, 1);
    CHECK(p.variance(0) == about(4 / 3.0, 1e-3));
}

TEST_CASE("deviations of a pilot are roots of squared distances to the mean, of all channels") {
    const SampleFunction L = random_radiance(seed_here(), [](const PixelSample& s, vec2 u) {
        return rgb{1000 + u.x, 3 * u.y, real(s.x)};
    });
    for (uint32_t K : {1u, 2u, 5u})
        for (const auto& passes :
             {std::vector<uint64_t>{4}, {1, 2, 4}, {1, 2, 3, 4}, {3, 4}, {1}}) {
            Film f = make_film({3, 2}, K, true);
            for (uint64_t n : passes) fill(f, n, L);
            for (size_t i = 0; i < 6; ++i) {
                Tally tally;
                double sum[3] = {}, squares = 0;
                const double count = double(K * passes.back());
                for (double about_mean : {0.0, 1.0})
                    for (uint32_t k = 0; k < K; ++k)
                        for (uint64_t s = 0; s < passes.back(); ++s)
                            for (size_t c = 0; c < 3; ++c) {
                                const double x = double(L(f.sample_of(i, s, k), tally).*axis[c]);
                                squares += about_mean * std::pow(x - sum[c] / count, 2);
                                sum[c] += (1 - about_mean) * x;
                            }
                CHECK(std::abs(double(f.pilot_deviation[i]) - std::sqrt(squares)) <=
                      1e-6 * std::sqrt(squares));
            }
        }
    CHECK(make_film({3, 3}, 2, false).pilot_deviation.empty());
    for (real level : {real(1e-30), real(1e30)}) {  // their squares are no floats
        Film f = make_film({1, 1}, 1, true);
        fill(f, 2, [&](const PixelSample& s, Tally&) { return level * rgb{real(s.i), 0, 0}; });
        CHECK(double(f.pilot_deviation[0]) == about(double(level) * std::sqrt(0.5), 1e-6));
    }
}

// film/film_test.cpp  sums of samples, statistics per pixel, and adaptive replications
#include "film/film.h"

#include <map>
#include <numeric>

#include "base/cases.h"
#include "base/moments.h"
#include "base/rng.h"
#include "film/fill.h"
#include "oracle/expect.h"

namespace {

using Colour = std::array<float, 3>;

// A value for every sample; the rounded sum depends on the order of addition.
const Radiance numbered = [](const PixelSample& s, Tally& tally) {
    tally.rays += 1 + s.i;
    const uint64_t bits = hash(hash(hash(uint64_t(s.y), uint64_t(s.x)), s.set), s.i);
    const real v = std::ldexp(to_unit(bits), int(s.i * 37 % 60) - 30);
    return rgb{v, real(s.i), real(s.set)};
};

// Pixels have one to four replications in turn.
Film film_of_kinds(Size size) {
    Film f = make_film(size, 1);
    size_t all = 0;
    for (size_t i = 0; i < f.pixels(); ++i) all += f.sets[i] = uint16_t(1 + i % 4);
    f.sum.assign(all, Sum{});
    return f;
}

// The middle is 1000 in one sample of 50, else 0; its neighbours 30 in one of 4; others up to 35.
rgb rare_light(const PixelSample& s, vec2 u) {
    real v = 35 * u.x;
    if (std::abs(s.x - 4) < 2 && std::abs(s.y - 4) < 2) v = u.x < real(0.25) ? 30 : 0;
    if (s.x == 4 && s.y == 4) v = u.x < real(0.02) ? 1000 : 0;
    return {v, v, v};
}

}  // namespace

TEST_CASE("blocks are all pixels, each once; a row and a small picture have work for all threads") {
    for (Size size : {Size{1, 1}, Size{16384, 1}, Size{33, 17}, Size{2048, 1024}, Size{1, 509}}) {
        const Film f = make_film(size, 1);
        CAPTURE(f.pixels());
        size_t next = 0;
        for (size_t b = 0; b < f.taken.size(); ++b) {
            CHECK(f.begin(b) == next);
            CHECK(f.end(b) > next);
            CHECK(f.end(b) - next <= 256);
            next = f.end(b);
        }
        CHECK(next == f.pixels());
        CHECK(f.taken.size() >= std::min<size_t>(f.pixels(), 256));
    }
}

TEST_CASE("a pass takes each sample of each replication once, in order, of its own rows") {
    for (Size size : {Size{1, 1}, Size{2000, 1}, Size{33, 17}, Size{1, 509}}) {
        Film f = film_of_kinds(size);
        f.first_row = 100;
        std::map<std::array<int, 3>, uint64_t> taken;  // y, x, set
        uint64_t out_of_order = 0;
        const Radiance L = [&](const PixelSample& s, Tally& tally) {
            out_of_order += s.i != taken[{s.y, s.x, int(s.set)}]++;
            ++tally.rays;
            return rgb{1, 1, 1};
        };
        for (uint64_t n : {2, 5}) fill(f, n, L);
        CHECK(out_of_order == 0);
        CHECK(taken.size() == f.sum.size());
        CHECK(f.total() == 5 * double(f.sum.size()));
        size_t wrong = 0;
        for (const auto& [at, n] : taken) {
            const size_t i = size_t(at[0] - 100) * size_t(size.width) + size_t(at[1]);
            wrong += n != 5 || i >= f.pixels() || uint32_t(at[2]) >= f.sets_of(i);
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("a pixel is the mean of its replications, however passes divide the samples") {
    for (Size size : {Size{2, 2}, Size{1600, 1}}) {  // blocks of one pixel, and of six
        Film whole = film_of_kinds(size);
        fill(whole, 12, numbered);
        CHECK(whole.replications_per_pixel() == 2.5);
        const Image image = image_of(whole);
        size_t at = 0, wrong = 0;
        Tally tally;
        for (size_t i = 0; i < whole.pixels(); ++i) {
            double value = 0;
            const int x = int(i) % size.width, y = int(i) / size.width;
            for (uint32_t set = 0; set < whole.sets[i]; ++set) {
                double sum = 0;
                for (uint64_t k = 0; k < 12; ++k) sum += double(numbered({x, y, k, set}, tally).x);
                wrong += whole.sum[at++].L[0] != sum;
                value += sum / 12;
            }
            const double K = whole.sets[i];
            wrong += image.pixels[i] != Colour{float(value / K), 5.5f, float((K - 1) / 2)};
        }
        CHECK(wrong == 0);
        for (const auto& passes : {std::vector<uint64_t>{1, 2, 3, 4, 5, 6, 12},
                                   {1, 3, 7, 12},
                                   {5, 5, 4, 12},
                                   {11, 12}}) {
            Film f = film_of_kinds(size);
            for (uint64_t n : passes) {
                f.least_taken() % 2 ? void(fill(f, n, numbered)) : [&] {
                    for (size_t b = f.taken.size(); b-- > 0;) fill_blocks(f, b, b + 1, n, numbered);
                }();
            }
            CHECK(same(f, whole));
        }
    }
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
    const Radiance L = [&](const PixelSample& s, Tally&) {
        const auto found = bad.find({int(s.i), int(s.set), s.y, s.x});
        return found == bad.end() ? rgb{1, 1, 1} : found->second;
    };
    for (bool upwards : {false, true}) {
        Film f = make_film({3, 3}, 3);
        CHECK(fill(f, 4, L).count == 0);
        NonFinite all;
        for (size_t k = 0; k < 9; ++k) {
            const size_t b = upwards ? 8 - k : k;
            const NonFinite of_block = fill_blocks(f, b, b + 1, 8, L);
            CHECK(of_block.count == (b == 0 ? 2 : b == 3 || b == 5 || b == 7 ? 1 : 0));
            all.add(of_block);
        }
        CHECK(said(all.count, all.first.i, all.first.set, all.first.y, all.first.x) == "5 4 1 1 2");
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
    for (bool chosen : {false, true}) {
        Film f = chosen ? filled(size, 0, 0, numbered) : make_film(size, 0);
        fill(f, 3, numbered);
        REQUIRE(f.taken.size() == 257);
        const Film before = f;
        for (uint64_t at = 1; at <= 5; ++at) {
            uint64_t calls = 0;
            const Radiance stopped = [&](const PixelSample& s, Tally& tally) {
                if (++calls == 2 * at) throw Failure();
                return numbered(s, tally);
            };
            CHECK_THROWS_AS(fill_blocks(f, 100, 101, 9, stopped), Failure);
            CHECK(same(f, before));
        }
        fill_blocks(f, 0, 100, 9, numbered);
        CHECK(f.least_taken() == 3);
        CHECK(f.most_taken() == 9);
        const Film some = f;
        CHECK_THROWS_AS(
            fill_blocks(f, 100, 101, 9, [](const PixelSample&, Tally&) -> rgb { throw Failure(); }),
            Failure);
        CHECK(same(f, some));
        size_t wrong = 0;
        const Image image = image_of(f);
        for (size_t i = 0; i < 1025; ++i) wrong += image.pixels[i][1] != (i < 400 ? 4 : 1);
        CHECK(wrong == 0);
        fill(f, 9, numbered);
        Film whole = before;
        fill(whole, 9, numbered);
        CHECK(same(f, whole));
    }
}

TEST_CASE("a pixel without samples is no number; one replication has no variance") {
    Film f = make_film({2, 2}, 3);
    fill_blocks(f, 0, 2, 1, numbered);
    CHECK(first_non_finite(image_of(f)) == "0,1");
    for_each_pixel(f, [](size_t i, const Pixel& p) {
        CHECK(p.count() == (i < 2 ? 3 : 0));
        CHECK(std::isnan(p.value(0)) == (i >= 2));
        CHECK(std::isnan(p.variance(0)) == (i >= 2));
    });
    f = filled({1, 1}, 1, 7, numbered);
    for_each_pixel(f, [](size_t, const Pixel& p) {
        CHECK(p.count() == 1);
        CHECK(p.value(1) == 3);
        CHECK(std::isnan(p.variance(1)));
    });
    for (Size size : {Size{1, 1}, Size{5, 1}, Size{1, 5}}) {
        f = filled(size, 0, 20, numbered);
        CHECK(first_non_finite(image_of(f)) == std::nullopt);
        for_each_pixel(f, [](size_t, const Pixel& p) {
            CHECK(p.value(1) == 9.5);
            CHECK(std::isfinite(p.variance(0)));
        });
    }
}

TEST_CASE(
    "value and variance of a pixel are unbiased if its replications differ in samples: exact") {
    // All outcomes of coin tosses are enumerated; each sample is 0 or 1.
    for (const auto& row :
         std::initializer_list<std::pair<uint64_t, uint64_t>>{{1, 1}, {3, 1}, {2, 2}, {4, 2}})
        for (uint64_t K : {2, 3, 4}) {
            const uint64_t first = row.first, others = row.second;
            const uint64_t tosses = first + (K - 1) * others;
            double value = 0, square = 0, variance = 0;
            for (uint64_t outcome = 0; outcome < uint64_t(1) << tosses; ++outcome) {
                std::vector<Sum> sums(K);
                for (uint64_t t = 0; t < tosses; ++t)
                    sums[t < first ? 0 : 1 + (t - first) / others].L[0] += double(outcome >> t & 1);
                const Pixel p{sums, first, others};
                value += p.value(0), square += p.value(0) * p.value(0), variance += p.variance(0);
            }
            const double n = std::ldexp(1, int(tosses));
            CAPTURE(first);
            CAPTURE(K);
            CHECK(value / n == doctest::Approx(0.5).epsilon(1e-13));
            CHECK(variance / n == doctest::Approx(square / n - 0.25).epsilon(1e-13));
            CHECK(square / n - 0.25 ==
                  doctest::Approx((0.25 / double(first) + double(K - 1) * 0.25 / double(others)) /
                                  double(K * K)));
        }
}

TEST_CASE("until the others have samples a pixel is its pilot; then they are means beside it") {
    Film f = make_film({1, 1}, 0);
    fill(f, 16, numbered);
    CHECK(image_of(f).at(0, 0)[1] == 7.5f);
    choose_sets(f, INFINITY);
    CHECK(f.pilot == 16);
    CHECK(f.least_taken() == 0);
    CHECK(f.sets == std::vector<uint16_t>{2});
    CHECK(image_of(f).at(0, 0)[1] == 7.5f);
    CHECK(said(f.total(), f.total(16), f.total(20)) == "16 32 40");
    fill(f, 2, numbered);
    for_each_pixel(
        f, [](size_t, const Pixel& p) { CHECK(said(p.count(), p.first, p.others) == "2 16 2"); });
    CHECK(image_of(f).at(0, 0) == Colour{image_of(f).at(0, 0)[0], (7.5f + 0.5f) / 2, 0.5f});
    CHECK(f.total() == 18);
    CHECK(f.total(2) == 18);
    fill(f, 20, numbered);
    CHECK(f.samples(0, 0) == 20);
    CHECK(image_of(f).at(0, 0)[1] == 9.5f);
    CHECK(f.total() == 40);
}

TEST_CASE(
    "the spread of a pilot is the root of squared distances to its mean, all channels together") {
    // 1, 5, 3, 7: mean 4, 9 + 1 + 1 + 9, with twice the deviations in green; also far from 0.
    for (real far : {0, 1024})
        for (const auto& passes : {std::vector<uint64_t>{4}, {1, 2, 3, 4}, {2, 4}}) {
            Film f = make_film({2, 1}, 0);
            for (uint64_t n : passes)
                fill(f, n, [far](const PixelSample& s, Tally&) {
                    const real x = std::array<real, 4>{1, 5, 3, 7}[s.i] * real(1 + s.x);
                    return rgb{far + x, 2 * x, 3};
                });
            CHECK(f.spread[0] == doctest::Approx(std::sqrt(5 * 20.0)).epsilon(1e-6));
            CHECK(f.spread[1] == doctest::Approx(2 * std::sqrt(5 * 20.0)).epsilon(1e-6));
        }
    CHECK(make_film({3, 3}, 2).spread.empty());
    CHECK(filled({3, 3}, 0, 16, numbered).spread.empty());
}

TEST_CASE(
    "replications: 3.5 times the root of the noise around over the mean of the other colour") {
    // The reference follows the definition, for pictures of all shapes.
    Rng rng{seed_here()};
    for (Size size :
         {Size{1, 1}, Size{2, 1}, Size{1, 2}, Size{1, 40}, Size{40, 1}, Size{2, 2}, Size{9, 7}}) {
        std::vector<float> noise(size_t(size.width * size.height));
        for (float& v : noise) v = float(std::exp(4 * double(rng.uniform())));
        const auto sets = sets_where_noise_is(noise, size);
        for (int i = 0; i < int(noise.size()); ++i) {
            Moments around, other;
            for (int k = 0; k < int(noise.size()); ++k) {
                const int dx = std::abs(k % size.width - i % size.width),
                          dy = std::abs(k / size.width - i / size.width);
                if (k != i && dx < 2 && dy < 2) around.add(std::pow(double(noise[size_t(k)]), 2));
                if ((dx + dy) % 2 == 1) other.add(std::pow(double(noise[size_t(k)]), 2));
            }
            const double K = around.n ? 3.5 * std::sqrt(around.mean / other.mean) : 0;
            CAPTURE(K);
            CHECK(sets[size_t(i)] == std::clamp(std::floor(K + 0.5), 2.0, 32.0));
        }
    }
    // Equal noise gives 3.5, rounded up; no noise, or noise of unknown size, gives two.
    CHECK(sets_where_noise_is(std::vector<float>(12, 5), {4, 3}) == std::vector<uint16_t>(12, 4));
    for (float none : {0.f, NAN, INFINITY})
        CHECK(sets_where_noise_is(std::vector<float>(12, none), {4, 3}) ==
              std::vector<uint16_t>(12, 2));
    for (float level : {1e-30f, 1e30f})  // their squares are no floats
        CHECK(sets_where_noise_is(std::vector<float>(12, level), {4, 3})[5] == 4);
    CHECK(sets_where_noise_is({7}, {1, 1}) == std::vector<uint16_t>{2});
    CHECK(sets_where_noise_is(std::vector<float>(12, 5), {4, 3}, {9, 1024})[5] == 9);
    CHECK(sets_where_noise_is(std::vector<float>(12, 5), {4, 3}, {9, 6})[5] == 6);
}

TEST_CASE("a pixel's own samples have no say in its replications, however large they are") {
    const Size size{7, 5};
    std::vector<float> noise(35);
    Rng rng{seed_here()};
    for (float& v : noise) v = float(std::exp(4 * double(rng.uniform())));
    bool matters = false;
    for (size_t i = 0; i < 35; ++i) {
        std::vector<std::vector<uint16_t>> seen;
        const float before = noise[i];
        for (float own : {0.f, 1e-30f, 1.f, 1e4f, 1e30f}) {
            noise[i] = own;
            seen.push_back(sets_where_noise_is(noise, size));
            CHECK(seen.back()[i] == seen.front()[i]);
            matters = matters || seen.back() != seen.front();
        }
        noise[i] = before;
    }
    CHECK(matters);  // for other pixels
}

TEST_CASE("chosen replications keep the pilot, and fit into the memory that there is") {
    CHECK(sizeof(Sum) == 24);
    CHECK(bytes_of({10, 3}, 2.5) == 30 * (32 + 24 * 2.5));
    const Size size{40, 30};
    const Radiance L = random_radiance(7, [](const PixelSample& s, vec2 u) {
        const real scale = s.x > 36 ? 100 : 1;
        return rgb{scale * u.x, u.y, 1};
    });
    Film pilot = make_film(size, 0);
    fill(pilot, 16, L);
    CHECK(pilot.replications_per_pixel() == 1);
    uint32_t last = 33;
    for (double K : {1e9, 4.0, 3.0, 2.5, 2.0, 0.1}) {
        Film f = pilot;
        const uint32_t most = choose_sets(f, bytes_of(size, K));
        CAPTURE(K);
        CHECK(most <= last);
        CHECK(*std::max_element(f.sets.begin(), f.sets.end()) <= most);
        CHECK(*std::min_element(f.sets.begin(), f.sets.end()) == 2);
        CHECK(f.replications_per_pixel() <= std::max(2.0, K));
        if (K > 100) CHECK(most == 32);
        if (K < 2) CHECK(most == 2);
        // The limit is the largest that fits into the memory.
        if (most < 32) {
            double all = 0;
            for (uint16_t k : sets_where_noise_is(pilot.spread, size, {3.5, most + 1})) all += k;
            CHECK(all / 1200 > K);
        }
        last = most;
        size_t at = 0, wrong = 0;
        for (size_t i = 0; i < 1200; at += f.sets[i++]) {
            wrong += f.sum[at].L != pilot.sum[i].L;
            for (uint32_t set = 1; set < f.sets[i]; ++set)
                wrong += f.sum[at + set].L != std::array<double, 3>{};
        }
        CHECK(wrong == 0);
        CHECK(at == f.sum.size());
        const size_t bytes = f.sum.capacity() * sizeof f.sum[0] + f.sets.capacity() * 2 +
                             f.taken.capacity() * 8 + f.spread.capacity() * 4;
        CHECK(double(bytes) <= bytes_of(size, f.replications_per_pixel()));
    }
    CHECK(last == 2);
    // Pixels where light is rare have 8, or more if their neighbours are noisy.
    std::vector<size_t> every(1200);
    std::iota(every.begin(), every.end(), size_t(0));
    Film usual = pilot, rare = pilot;
    choose_sets(usual, INFINITY);
    choose_sets(rare, INFINITY, every);
    for (uint16_t& k : usual.sets) k = std::max(k, uint16_t(8));
    CHECK(rare.sets == usual.sets);
    CHECK(*std::max_element(usual.sets.begin(), usual.sets.end()) > 8);
}

TEST_CASE("chosen replications leave every pixel's mean unbiased, that of rare light, too") {
    // If a pixel's own samples chose its replications, pixels that found rare light early would be
    // averaged with more samples that did not: 14 instead of 20.
    const size_t middle = 40;
    Moments early, outlier, neighbour, pooled, sets;
    for (uint64_t r = 0; r < 5000; ++r) {
        const Radiance L = random_radiance(hash(seed_here(), r), rare_light);
        Film f = make_film({9, 9}, 0);
        fill(f, 16, L);
        choose_sets(f, INFINITY);
        fill(f, 4, L);  // as after Ctrl-C: 16 samples of the first, 4 of each other
        for_each_pixel(f, [&](size_t i, const Pixel& p) {
            if (i == middle) early.add(p.value(0));
        });
        fill(f, 20, L);
        double sum = 0;
        for_each_pixel(f, [&](size_t i, const Pixel& p) {
            if (i == middle) outlier.add(p.value(0));
            if (i == middle - 9) neighbour.add(p.value(0));
            sum += p.value(0);
        });
        pooled.add(sum / 81);
        sets.add(f.sets[middle]);
    }
    CHECK(sets.variance() > 0);
    EXPECT(oracle::expect_mean(20, estimate(early)), 0.2);
    EXPECT(oracle::expect_mean(20, estimate(outlier)), 0.1);
    EXPECT(oracle::expect_mean(7.5, estimate(neighbour)), 0.03);
    EXPECT(oracle::expect_mean((20 + 8 * 7.5 + 72 * 17.5) / 81, estimate(pooled)), 0.02);
}

// film/sets_test.cpp  where a pixel has more sets of samples, and where it is measured by chance
#include "film/sets.h"

#include <doctest/doctest.h>

#include "base/moments.h"
#include "film/fill.h"
#include "oracle/expect.h"

namespace {

// 1 everywhere but at some places.
std::vector<double> noise_of(Size size, const std::vector<std::pair<size_t, double>>& at) {
    std::vector<double> noise(size_t(size.width) * size_t(size.height), 1);
    for (const auto& [i, v] : at) noise[i] = v;
    return noise;
}

std::vector<uint32_t> shown(const std::vector<Sets>& sets) {
    std::vector<uint32_t> n;
    for (const Sets& s : sets) n.push_back(s.shown);
    return n;
}

}  // namespace

TEST_CASE("the mean around a pixel is that of its neighbours, of three in a corner, without it") {
    const std::vector<double> v = {1,  2,   4,   //
                                   8,  16,  32,  //
                                   64, 128, 256};
    auto around = [&](Size size, int x, int y) {
        return mean_around({size, 0, size.height, v}, x, y);
    };
    CHECK(around({3, 3}, 1, 1) == (1 + 2 + 4 + 8 + 32 + 64 + 128 + 256) / 8.0);
    CHECK(around({3, 3}, 0, 0) == (2 + 8 + 16) / 3.0);
    CHECK(around({3, 3}, 2, 2) == (16 + 32 + 128) / 3.0);
    CHECK(around({3, 3}, 1, 0) == (1 + 4 + 8 + 16 + 32) / 5.0);
    CHECK(around({9, 1}, 8, 0) == 128);
    CHECK(around({1, 9}, 0, 4) == (8 + 32) / 2.0);
    CHECK(mean_around({{1, 1}, 0, 1, {5}}, 0, 0) == 0);
    // Rows 4 to 6 of a picture: what is not known of the others does not count.
    auto of_rows = [&](int x, int y) { return mean_around({{3, 9}, 4, 3, v}, x, y); };
    CHECK(of_rows(1, 5) == (1 + 2 + 4 + 8 + 32 + 64 + 128 + 256) / 8.0);
    CHECK(of_rows(2, 6) == (16 + 32 + 128) / 3.0);
    CHECK(of_rows(0, 4) == (2 + 8 + 16) / 3.0);
}

TEST_CASE(
    "sets are 5/4 of the root of the noise around over that elsewhere, rounded, from 1 to 8") {
    // A row of 101 pixels: the two neighbours of pixel 50 have noise v, the other 98 have 1.
    auto sets = [](double v) {
        const Size row{101, 1};
        return sets_where_noise_is(noise_of(row, {{49, v}, {51, v}}), row, 1)[50].shown;
    };
    auto by_hand = [](double v) {
        return std::min(8.0, 1.25 * std::sqrt(v / ((98 + 2 * v) / 100)));
    };
    for (const auto& row : std::initializer_list<std::pair<double, uint32_t>>{
             {0, 1}, {1, 1}, {1.4, 1}, {1.5, 2}, {4.2, 2}, {4.4, 3}, {9, 3}, {9.3, 4}, {1e9, 8}}) {
        const auto [v, n] = row;
        CAPTURE(row.first);
        CHECK(sets(v) == n);
        CHECK(std::abs(double(n) - std::max(1.0, by_hand(v))) <= 0.5);
    }
    // In a larger image the root is greater: 10.
    const Size large{201, 1};
    CHECK(sets_where_noise_is(noise_of(large, {{49, 1e9}, {51, 1e9}}), large, 1)[50].shown == 8);
}

TEST_CASE("where noise is alike, or there is none, every pixel has one set") {
    const Size size{16, 9};
    for (double v : {0.0, 1e-300, 1.0, 1e300}) {
        const std::vector<double> noise(16 * 9, v);
        CHECK(shown(sets_where_noise_is(noise, size, 1)) == std::vector<uint32_t>(16 * 9, 1));
    }
    CHECK(sets_where_noise_is({7}, {1, 1}, 1)[0].shown == 1);
}

TEST_CASE("a pixel's own samples have no say in its sets, however large they are") {
    const Size size{7, 5};
    std::vector<double> noise(35);
    Rng rng{seed_here()};
    for (double& v : noise) v = std::exp(8 * double(rng.uniform()));
    bool matters = false;
    for (size_t i : {size_t(0), size_t(6), size_t(17), size_t(34)}) {
        std::vector<std::vector<uint32_t>> seen;
        for (double own : {0.0, 1e-30, 1.0, 1e4, 1e30, 1e200}) {
            noise[i] = own;
            seen.push_back(shown(sets_where_noise_is(noise, size, 3)));
            CHECK(seen.back()[i] == seen.front()[i]);
            matters = matters || seen.back() != seen.front();
        }
    }
    CHECK(matters);  // to others
}

// ---- Sets that only measure ---------------------------------------------------------------------

TEST_CASE("a pixel of one set is measured by chance, the more likely the noisier it is") {
    // 4096 pixels: 1/16 at least; of 7 times the mean noise half the time, of 600 times always.
    const Size size{64, 64};
    auto chance_of = [&](double noise) {
        const std::vector<double> all = noise_of(size, {{7, noise}});
        double sum = 0;
        for (double v : all) sum += v;
        return std::min(1.0, (1 + noise * 4096 / sum) / 16);
    };
    for (double noise : {0.0, 1.0, 7.0, 600.0}) {
        const double chance = chance_of(noise);
        CAPTURE(chance);
        int drawn = 0, tried = 0;
        for (uint64_t seed = 0; seed < 300; ++seed) {
            const auto sets = sets_where_noise_is(noise_of(size, {{7, noise}}), size, seed);
            CHECK(sets[7].shown == 1);
            ++tried, drawn += sets[7].count() == 2;
            CHECK(sets[7].chance == (sets[7].count() == 2 ? doctest::Approx(chance) : 0));
        }
        CHECK(std::abs(drawn - chance * tried) <=
              4.9 * std::sqrt(chance * (1 - chance) * tried) + (chance < 1 ? 0.5 : 0));
    }
    CHECK(chance_of(0) == 1 / 16.0);
    CHECK(chance_of(600) == 1);
}

TEST_CASE("which pixels are measured differs from pixel to pixel and from seed to seed") {
    const Size size{64, 64};
    const std::vector<double> noise(4096, 1);
    const double chance = 2 / 16.0;
    Moments measured;
    for (uint64_t seed = 0; seed < 200; ++seed) {
        int n = 0;
        for (const Sets& s : sets_where_noise_is(noise, size, hash(seed_here(), seed)))
            n += s.count() == 2;
        measured.add(n / 4096.0);
    }
    EXPECT(oracle::expect_mean(chance, estimate(measured)), 0.04);
    // As many as of independent coins.
    const double ratio = measured.variance() / (chance * (1 - chance) / 4096);
    CHECK(std::abs(ratio - 1) < 4.9 * std::sqrt(2.0 / 199));
}

TEST_CASE("all of up to 256 pixels are measured, and none that shows several sets by chance") {
    for (Size size : {Size{1, 1}, Size{16, 16}})
        for (double v : {0.0, 3.0}) {
            const std::vector<double> noise(size_t(size.width) * size_t(size.height), v);
            for (const Sets& s : sets_where_noise_is(noise, size, 5)) CHECK(s.chance == 1);
        }
    const Size size{32, 32};
    std::vector<double> noise(1024);
    for (size_t i = 0; i < noise.size(); ++i) noise[i] = i % 32 < 4 ? 100 : 1;
    int several = 0;
    for (const Sets& s : sets_where_noise_is(noise, size, 5)) {
        several += s.shown > 1;
        CHECK((s.shown == 1 || s.chance == 0));
        CHECK(s.count() == s.shown + (s.chance > 0));
    }
    CHECK(several >= 128);
    CHECK(several < 300);
}

// ---- Large pictures, and parts of them ----------------------------------------------------------

TEST_CASE(
    "a survey is of all pixels of a small picture, of one in each equal part of a large one") {
    for (Size size : {Size{1, 1}, Size{3, 5}, Size{256, 128}}) {
        const Survey survey(size);
        const size_t all = size_t(size.width) * size_t(size.height);
        REQUIRE(survey.count() == all);
        size_t wrong = 0;
        for (size_t i = 0; i < all; ++i)
            wrong += survey.pixel(i) != i || survey.nearest(i) != i || !survey.has(i);
        CHECK(wrong == 0);
    }
    struct Case {
        Size size;
        size_t most;
    };
    for (const auto& [size, most] :
         {Case{{31, 17}, 100}, Case{{7, 9}, 62}, Case{{10, 10}, 99}, Case{{127, 3}, 1},
          Case{{181, 182}, 32768}, Case{{16385, 7}, 32768}, Case{{1021, 769}, 1000}}) {
        const Survey survey(size, most);
        const size_t all = size_t(size.width) * size_t(size.height);
        REQUIRE(survey.count() == most);
        // Parts in order, of a size that differs by one at most; each has one pixel.
        size_t begin = 0, wrong = 0;
        for (size_t k = 0; k < most; ++k) {
            const size_t end = begin + all / most + (k < all % most), its = survey.pixel(k);
            wrong += its < begin || its >= end;
            for (size_t i = begin; i < end; ++i)
                wrong += survey.nearest(i) != k || survey.has(i) != (i == its);
            begin = end;
        }
        CAPTURE(all);
        CHECK(begin == all);
        CHECK(wrong == 0);
    }
}

TEST_CASE("a survey finds pixels by chance, wherever they are in their parts") {
    // 32768 parts of 16 pixels.
    const Size size{1024, 512};
    const Survey survey(size);
    std::vector<double> places(16), noise, of_all(1024 * 512);
    for (size_t k = 0; k < survey.count(); ++k) ++places[survey.pixel(k) % 16];
    EXPECT(oracle::expect_counts(places, std::vector<double>(16, 1 / 16.0)), 1);
    // So that noise which hangs on the column, as of a picket fence, is found as it is.
    Moments found;
    for (size_t k = 0; k < survey.count(); ++k) found.add(survey.pixel(k) % 4 == 0);
    EXPECT(oracle::expect_mean(0.25, estimate(found)), 0.08);
    // Neighbouring parts do not agree on a place.
    int alike = 0;
    for (size_t k = 0; k + 1 < survey.count(); ++k)
        alike += survey.pixel(k + 1) == survey.pixel(k) + 16;
    CHECK(std::abs(alike - 32767 / 16.0) < 4.9 * std::sqrt(32767 / 16.0));
}

TEST_CASE("the noise elsewhere is without that of a pixel, if it was surveyed") {
    const Survey survey({5, 3}, 4);
    const NoiseElsewhere elsewhere(survey, {1, 10, 100, 1000});
    CHECK(elsewhere.mean() == 1111 / 4.0);
    for (size_t i = 0; i < 15; ++i) {
        const double own = std::pow(10, double(survey.nearest(i)));
        CHECK(elsewhere.mean_without(i) == (survey.has(i) ? (1111 - own) / 3 : 1111 / 4.0));
    }
    CHECK(NoiseElsewhere(Survey({1, 1}), {5}).mean_without(0) == 0);
}

TEST_CASE("in a large picture, too, a pixel's own samples have no say in its sets") {
    const Size size{300, 200};
    const Survey survey(size);
    REQUIRE(survey.count() == 32768);
    std::vector<double> noise(60000);
    Rng rng{seed_here()};
    for (double& v : noise) v = std::exp(2 * double(rng.uniform()));
    const size_t surveyed = survey.pixel(survey.nearest(31234));
    REQUIRE(!survey.has(surveyed + 1));
    for (size_t i : {surveyed, surveyed + 1}) {
        std::vector<uint32_t> own, others;
        const double before = noise[i];
        for (double v : {0.0, 1e4, 1e200}) {
            noise[i] = v;
            const auto sets = sets_where_noise_is(noise, size, 3);
            own.push_back(sets[i].shown);
            others.push_back(uint32_t(std::count_if(sets.begin(), sets.end(),
                                                    [](const Sets& s) { return s.shown > 1; })));
        }
        noise[i] = before;
        CHECK(own == std::vector<uint32_t>(3, own[0]));
        CHECK((others[2] < others[0] / 2) == survey.has(i));  // all is quiet beside it
    }
}

TEST_CASE("the sets of some rows are those of the whole picture, to the bit") {
    struct Case {
        Size size;
        std::vector<int> bands;  // where they begin
    };
    for (const auto& [size, bands] : {Case{{37, 23}, {0, 1, 2, 11, 22}}, Case{{1, 64}, {0, 31, 63}},
                                      Case{{64, 1}, {0}}, Case{{300, 200}, {0, 99, 100, 199}}}) {
        const size_t width = size_t(size.width), pixels = width * size_t(size.height);
        std::vector<double> noise(pixels), found;
        Rng rng{seed_here()};
        for (size_t i = 0; i < pixels; ++i)
            noise[i] = std::exp((i / width % 20 < 4 ? 9 : 3) * double(rng.uniform()));
        const auto whole = sets_where_noise_is(noise, size, 7);
        const Survey survey(size);
        for (size_t k = 0; k < survey.count(); ++k) found.push_back(noise[survey.pixel(k)]);
        size_t next = 0, different = 0, several = 0;
        for (size_t b = 0; b < bands.size(); ++b) {
            const int first = bands[b], end = b + 1 < bands.size() ? bands[b + 1] : size.height;
            const int above = std::max(0, first - 1), below = std::min(size.height, end + 1);
            const NoiseOfRows around{size,
                                     above,
                                     below - above,
                                     {noise.begin() + ptrdiff_t(size_t(above) * width),
                                      noise.begin() + ptrdiff_t(size_t(below) * width)}};
            const auto sets =
                sets_where_noise_is(around, first, end - first, NoiseElsewhere(survey, found), 7);
            REQUIRE(sets.size() == size_t(end - first) * width);
            for (const Sets& s : sets) {
                const Sets& same = whole[next++];
                different += s.shown != same.shown || s.chance != same.chance;
                several += s.shown > 1;
            }
        }
        CHECK(next == pixels);
        CHECK(different == 0);
        CHECK((several > 0 || pixels < 100));
    }
}

// ---- The image stays unbiased -------------------------------------------------------------------

TEST_CASE("sets by noise leave every pixel's mean unbiased, that of rare outliers, too") {
    // The middle of 9 x 9 is 1000 in one sample of 50, else 0; its neighbours 30 in one of 4, else
    // 0; the others up to 35.  Were a pixel's own samples to choose its sets, those that found an
    // outlier early would be averaged with more that did not: 14 instead of 20.
    const Size size{9, 9};
    const size_t middle = 40;
    auto value = [&](size_t pixel, uint64_t bits) {
        const real u = to_unit(bits);
        if (pixel == middle) return u < real(0.02) ? real(1000) : real(0);
        const bool near = std::abs(int(pixel % 9) - 4) < 2 && std::abs(int(pixel / 9) - 4) < 2;
        if (near) return u < real(0.25) ? real(30) : real(0);
        return 35 * u;
    };
    Moments outlier, neighbour, pooled, sets;
    for (uint64_t r = 0; r < 5000; ++r) {
        const uint64_t seed = hash(seed_here(), r);
        Film<MeanPixel> film(size);
        auto L = [&](int x, int y, uint64_t i, uint32_t set) {
            const size_t pixel = size_t(9 * y + x);
            const real v = value(pixel, hash(hash(hash(seed, pixel), set), i));
            return rgb{v, v, v};
        };
        whole_pass(film, samples_before_sets, L);
        film.add_sets(sets_where_noise_is(film.noise(), size, seed));
        whole_pass(film, 0, L);
        whole_pass(film, 8, L);
        const Image& image = film.image();
        outlier.add(double(image.pixels[middle][0]));
        neighbour.add(double(image.pixels[middle - 9][0]));
        double sum = 0;
        for (const auto& p : image.pixels) sum += double(p[0]);
        pooled.add(sum / 81);
        sets.add(film.sets(middle).shown);
    }
    CHECK(sets.variance() > 0);
    const double unit = 0x1p-24;
    EXPECT(oracle::expect_mean(20, estimate(outlier, unit)), 0.15);
    EXPECT(oracle::expect_mean(7.5, estimate(neighbour, unit)), 0.04);
    EXPECT(oracle::expect_mean((20 + 8 * 7.5 + 72 * 17.5) / 81, estimate(pooled, unit)), 0.04);
}

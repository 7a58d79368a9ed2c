// film/weights_pilot_test.cpp  weights by the noise of neighbours in a pilot
#include "film/weights.h"

#include <numeric>

#include "base/cases.h"
#include "base/moments.h"
#include "base/rng.h"
#include "film/fill.h"
#include "oracle/expect.h"

namespace {

// The middle is 1000 in one sample of 50, else 0; its neighbours 30 in one of 4; others up to 35.
rgb rare_light(const PixelSample& s, vec2 u) {
    real v = 35 * u.x;
    if (std::abs(s.x - 4) < 2 && std::abs(s.y - 4) < 2) v = u.x < real(0.25) ? 30 : 0;
    if (s.x == 4 && s.y == 4) v = u.x < real(0.02) ? 1000 : 0;
    return {v, v, v};
}

// Deviations from 1 to e^20.
std::vector<float> random_deviations(size_t count, Rng& rng) {
    std::vector<float> deviation(count);
    for (float& v : deviation) v = float(std::exp(20 * double(rng.uniform())));
    return deviation;
}

}  // namespace

TEST_CASE("a weight is the power of two next to 2 r^(4/5) in ratio, from 1 to 16; unknown: 2") {
    size_t wrong = 0;
    for (double r = 1e-3; r < 1e3; r *= 1.001) {
        int best = 1;
        for (int w = 1; w <= 16; w *= 2) {
            auto distance = [&](int v) {
                return std::abs(std::log(v / (2 * std::pow(r, 4 / 5.))));
            };
            if (distance(w) < distance(best)) best = w;
        }
        wrong += weight_of(r) != best;
    }
    CHECK(wrong == 0);
    // The borders lie at r = (w / sqrt(2))^(5/4).
    for (int w : {1, 2, 4, 8}) {
        const double border = std::pow(w / std::sqrt(2), 1.25);
        CHECK(said(int(weight_of(border * (1 - 1e-14))), int(weight_of(border * (1 + 1e-14)))) ==
              said(w, 2 * w));
    }
    for (const auto& [r, w] : {std::pair(0.0, 1), std::pair(1.0, 2), std::pair(1e300, 16),
                               std::pair(HUGE_VAL, 16), std::pair(double(NAN), 2)})
        CHECK(weight_of(r) == w);
    CHECK(weight_of(1) == typical_weight);
}

TEST_CASE("a weight is by the deviations around over the mean of the other colour: brute force") {
    Rng rng{seed_here()};
    std::vector<int> seen(17);
    for (Size size : {Size{1, 1}, Size{2, 1}, Size{1, 2}, Size{1, 40}, Size{40, 1}, Size{2, 2},
                      Size{9, 7}, Size{30, 20}}) {
        const int count = size.width * size.height;
        const std::vector<float> deviation = random_deviations(size_t(count), rng);
        const auto weights = weights_of(deviation, size);
        REQUIRE(weights.size() == deviation.size());
        for (int i = 0; i < count; ++i) {
            Moments around, other;
            for (int k = 0; k < count; ++k) {
                const int dx = std::abs(k % size.width - i % size.width),
                          dy = std::abs(k / size.width - i / size.width);
                if (k != i && dx < 2 && dy < 2) around.add(double(deviation[size_t(k)]));
                if ((dx + dy) % 2 == 1) other.add(double(deviation[size_t(k)]));
            }
            CHECK(weights[size_t(i)] ==
                  (around.n ? weight_of(around.mean / other.mean) : typical_weight));
            ++seen[weights[size_t(i)]];
        }
    }
    for (int w : {1, 2, 4, 8, 16}) CHECK(seen[size_t(w)] > 0);
    // Equal noise, no noise, and noise of unknown size.
    for (float level : {5.f, 1e-30f, 1e30f, 0.f, NAN, INFINITY})
        CHECK(weights_of(std::vector<float>(12, level), {4, 3}) == std::vector<uint8_t>(12, 2));
    // Noise in one pixel: for those of its colour the mean of the other one is 0, and others have
    // r = 13 / 8 beside it, else 0.
    std::vector<float> spot(25);
    spot[12] = 1;
    CHECK(weights_of(spot, {5, 5}) == std::vector<uint8_t>{2,  1, 2, 1, 2, 1, 16, 4,  16,
                                                           1,  2, 4, 2, 4, 2, 1,  16, 4,
                                                           16, 1, 2, 1, 2, 1, 2});
}

TEST_CASE("a pixel's own samples have no say in its weight, however large they are: exact") {
    Rng rng{seed_here()};
    for (Size size : {Size{7, 5}, Size{1, 6}, Size{2, 2}, Size{1, 1}}) {
        const size_t count = size_t(size.width * size.height);
        std::vector<float> deviation = random_deviations(count, rng);
        bool matters = count == 1;
        for (size_t i = 0; i < count; ++i) {
            const float before = deviation[i];
            const auto usual = weights_of(deviation, size);
            for (float own : {0.f, 1e-30f, 1.f, 1e4f, 1e30f, INFINITY, NAN}) {
                deviation[i] = own;
                const auto weights = weights_of(deviation, size);
                CHECK(weights[i] == usual[i]);
                matters = matters || weights != usual;
            }
            deviation[i] = before;
        }
        CHECK(matters);  // for other pixels
    }
    // Of samples, too: all those of one pixel are others.
    const SampleFunction L = random_radiance(seed_here(), [](const PixelSample& s, vec2 u) {
        return std::exp2(real(s.x)) * rgb{u.x, u.y, 1};
    });
    const Film whole = filled({7, 5}, 0, 5, L);
    for (int i = 0; i < 35; ++i) {
        const Film other = filled({7, 5}, 0, 5, [&](const PixelSample& s, Tally& tally) {
            const rgb v = L(s, tally);
            return s.y * 7 + s.x == i ? rgb{v.y * v.y * 1000, 7, -v.x} : v;
        });
        CHECK(other.weight[size_t(i)] == whole.weight[size_t(i)]);
        CHECK(other.sum[size_t(2 * i)] != whole.sum[size_t(2 * i)]);
    }
}

TEST_CASE("chosen weights keep the sums of the pilot; pixels where light is rare have 4 or more") {
    const Size size{40, 30};
    const SampleFunction L = random_radiance(7, [](const PixelSample& s, vec2 u) {
        return rgb{(s.x > 36 ? 100 : 1) * u.x, u.y, 1};
    });
    for (uint64_t n : {1, 3, 4}) {
        Film pilot = make_film(size, 3, true);
        fill(pilot, n, L);
        Film usual = pilot, rare = pilot;
        choose_weights(usual);
        CHECK(usual.weight == weights_of(pilot.pilot_deviation, size));
        CHECK(same(usual.sum, pilot.sum));
        CHECK(said(usual.is_pilot, usual.pilot, usual.min_samples_done(), usual.max_samples_done(),
                   usual.pilot_deviation.capacity()) == said(false, n, 0, 0, 0));
        std::vector<size_t> noisy(600);  // some of all weights
        std::iota(noisy.begin(), noisy.end(), size_t(300));
        choose_weights(rare, noisy);
        size_t raised = 0, more = 0;
        for (size_t i = 0; i < 1200; ++i) {
            const bool is_noisy = i >= 300 && i < 900;
            CHECK(rare.weight[i] ==
                  (is_noisy ? std::max<int>(4, usual.weight[i]) : usual.weight[i]));
            raised += rare.weight[i] > usual.weight[i], more += is_noisy && rare.weight[i] > 4;
        }
        CHECK(raised > 0);
        CHECK(more > 0);
    }
}

TEST_CASE("chosen weights leave every pixel's mean unbiased, that of rare light, too") {
    // If a pixel's own samples chose its weight, pixels that found rare light early would have more
    // samples that did not, and those that did not would stay black.
    const size_t middle = 40;
    Moments early, outlier, neighbour, pooled, weight;
    for (uint64_t r = 0; r < 5000; ++r) {
        const SampleFunction L = random_radiance(hash(seed_here(), r), rare_light);
        Film f = make_film({9, 9}, 2, true);
        fill_pilot(f, 4, L);
        fill(f, 1, L);  // as after Ctrl-C
        early.add(pixel_of(f, middle).value(0));
        fill(f, 8, L);
        outlier.add(pixel_of(f, middle).value(0));
        neighbour.add(pixel_of(f, middle - 9).value(0));
        double sum = 0;
        for (size_t i = 0; i < 81; ++i) sum += pixel_of(f, i).value(0);
        pooled.add(sum / 81);
        weight.add(f.weight[middle]);
    }
    CHECK(weight.variance() > 0);
    EXPECT(oracle::expect_mean(20, estimate(early)), 0.4);
    EXPECT(oracle::expect_mean(20, estimate(outlier)), 0.2);
    EXPECT(oracle::expect_mean(7.5, estimate(neighbour)), 0.05);
    EXPECT(oracle::expect_mean((20 + 8 * 7.5 + 72 * 17.5) / 81, estimate(pooled)), 0.02);
}

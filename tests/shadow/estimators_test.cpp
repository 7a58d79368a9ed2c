// shadow/estimators_test.cpp  exact zeros, unbiased means, predicted variances and biases
#include "shadow/estimators.h"

#include <vector>

#include "base/moments.h"
#include "shadow/checks.h"
#include "shadow/population.h"

namespace {

struct LightTriple {
    double U, w, wV;
};

ShadowMoments moments(const std::vector<LightTriple>& samples) {
    return moments_of(samples.size(), [&, i = size_t(0)]() mutable { return samples[i++]; });
}

// w = 2x, V = [x < 1/2]: W = 1, S = R = 1/4, E[w^2] = 4/3, E[w^2 V] = 1/6, E[w^3] = 2, E[w^3 V] =
// 1/8.
constexpr ShadowPopulation ramp{1, 0.25, 4.0 / 3, 1.0 / 6, 2, 1.0 / 8};

ShadowMoments of_ramp(oracle::Random& random, uint64_t n) {
    SumsAbout sums{1};
    for (uint64_t i = 0; i < n; ++i) {
        const double x = random(), w = 2 * x;
        sums.add(w, x < 0.5 ? w : 0);
    }
    return sums.moments();
}

// Light samples of a pixel: U differs from sample to sample, w is unbiased for it, V depends on
// both.  E[U] = 1.5; w = U (1/2 + t), V = [t < s], U = 1 + s: S = E[(1 + s) (s/2 + s^2/2)].
LightTriple pixel_sample(oracle::Random& random) {
    const double s = random(), t = random(), U = 1 + s, w = U * (0.5 + t);
    return {U, w, t < s ? w : 0};
}

// The mean of 32 values of f(): squares and products have long tails, their means shorter ones.
template <class F>
double of_many(F f) {
    double sum = 0;
    for (int i = 0; i < 32; ++i) sum += f() / 32;
    return sum;
}

constexpr double pixel_truth = (1.0 / 2 + 1.0 / 3 + 1.0 / 3 + 1.0 / 4) / 2;

// Checks the mean of estimates with n samples per pixel.
void expect_pixel(oracle::Random& random, Estimator e, uint64_t n, uint64_t trials,
                  double largest) {
    EXPECT(oracle::expect_mean(pixel_truth, trials,
                               [&] {
                                   auto sample = [&] { return pixel_sample(random); };
                                   return estimate(e, moments_of(n, sample));
                               }),
           largest);
}

// Checks the limit of n times the bias.  It measures an estimator minus w V - beta (w - 1), because
// the mean of the latter is known.
void expect_bias(Estimator e, double beta, double largest) {
    oracle::Random random(seed_here());
    auto less = [&](uint64_t n) {
        return of_many([&] {
            const ShadowMoments m = of_ramp(random, n);
            return estimate(e, m) - (m.wV - beta * (m.w - 1));
        });
    };
    EXPECT(oracle::expect_bias_decay(ramp.bias(e), 64, 2000, less), largest);
}

}  // namespace

TEST_CASE("estimators: eight samples by hand, where U differs and means do") {
    std::vector<LightTriple> samples;
    for (int i = 0; i < 8; ++i) {
        const double U = 1 + i % 2, w = U + (i < 4 ? 1 : -0.5), V = i % 4 != 3;
        samples.push_back({U, w, V ? w : 0});
    }
    // w: 2 3 2 3 .5 1.5 .5 1.5; wV: 2 3 2 0 .5 1.5 .5 0; b: four times 1, four times -.5.
    const ShadowMoments m = moments(samples);
    const double U = 1.5, w = 14.0 / 8, wV = 9.5 / 8, R = wV / w, bb = 8 * 0.75 * 0.75;
    const double b_wV = 0.75 * (7 - 2.5), b_U = 0.75 * (6 - 6), beta = (b_wV - R * b_U) / bb;
    CHECK(stochastic(m) == doctest::Approx(wV));
    CHECK(control(m) == doctest::Approx(U - w + wV));
    CHECK(ratio(m) == doctest::Approx(U * wV / w));
    CHECK(regression(m) == doctest::Approx(wV - beta * (w - U)));
    const ShadowMoments few = moments({{2, 1, 1}, {2, 3, 0}, {3.5, 5, 5}});  // too few for a slope
    CHECK(regression(few) == ratio(few));
    CHECK(ratio(few) == doctest::Approx(2.5 * 2 / 3));
}

TEST_CASE("estimators: the part of beta that only follows U is left out") {
    // w V = U / 2 whatever b is: the light is half in shadow.  So beta must be 0, not the chance
    // correlation of U and b.
    std::vector<LightTriple> samples;
    for (int i = 0; i < 16; ++i) {
        const double U = 1 + (i % 3) * 0.5, b = (i % 5) * 0.1;
        samples.push_back({U, U + b, (U + b) * 0.5});
    }
    const ShadowMoments m = moments(samples);
    CHECK(std::abs(m.b_U) > 1e-3);
    CHECK(regression(m) == doctest::Approx(m.U / 2).epsilon(1e-14));
}

TEST_CASE("estimators: exact where all is lit and where nothing is") {
    oracle::Random random(seed_here());
    ShadowMoments lit, dark;
    SumsAbout lit_sums{1}, dark_sums{1};
    for (int i = 0; i < 1000; ++i) {
        const auto [U, w, wV] = pixel_sample(random);
        lit.add(U, w, w), lit_sums.add(w, w);
        dark.add(U, w, 0), dark_sums.add(w, 0);
        for (const ShadowMoments& m : {lit, lit_sums.moments()}) {
            CHECK(control(m) == m.U);
            CHECK(ratio(m) == m.U);
            CHECK(regression(m) == doctest::Approx(m.U).epsilon(1e-14));
        }
        for (const ShadowMoments& m : {dark, dark_sums.moments()}) {
            CHECK(stochastic(m) == 0);
            CHECK(ratio(m) == 0);
            CHECK(std::abs(regression(m)) < 1e-14);
        }
        CHECK(regression(dark) == 0);
    }
}

TEST_CASE("estimators: no sample that found light, no sample at all, constant w") {
    for (Estimator e : estimators) {
        CHECK(estimate(e, ShadowMoments{}) == 0);
        CHECK(std::isfinite(estimate(e, moments({{1, 0, 0}}))));
        CHECK(std::isfinite(estimate(e, moments(std::vector<LightTriple>(20, {1, 0, 0})))));
    }
    CHECK(ratio(moments({{1, 0, 0}, {1, 0, 0}})) == 0);
    CHECK(regression(moments(std::vector<LightTriple>(20, {1, 0, 0}))) == 0);
    // If w is constant, every form equals the mean of w V.
    std::vector<LightTriple> half(20, {2, 2, 2});
    half.resize(40, {2, 2, 0});
    for (Estimator e : estimators) CHECK(estimate(e, moments(half)) == doctest::Approx(1));
}

TEST_CASE("estimators: moments far from 0 keep their digits, in any order and in parts") {
    oracle::Random random(seed_here());
    ShadowMoments one, even, odd;
    SumsAbout sums{1e8};
    std::vector<LightTriple> samples;
    for (int i = 0; i < 501; ++i) {
        const double b = 2 * random() - 1, U = 1e8, w = U + b;
        samples.push_back({U + (i % 7), w + (i % 7), random() < 0.3 ? w : 0});
        const auto& [U_, w_, wV_] = samples.back();
        one.add(U_, w_, wV_);
        (i % 2 ? odd : even).add(U_, w_, wV_);
        sums.add(w, wV_);
    }
    // The sum of products of distances from the means.
    auto product = [&](auto f, auto g) {
        double mean_f = 0, mean_g = 0, sum = 0;
        for (const LightTriple& s : samples) mean_f += f(s) / 501, mean_g += g(s) / 501;
        for (const LightTriple& s : samples) sum += (f(s) - mean_f) * (g(s) - mean_g);
        return sum;
    };
    auto U = [](const LightTriple& s) { return s.U; };
    auto b = [](const LightTriple& s) { return s.w - s.U; };
    auto wV = [](const LightTriple& s) { return s.wV; };
    const double bb = product(b, b), b_wV = product(b, wV), b_U = product(b, U);
    // Errors are relative to the largest possible product: a covariance may be small by chance.
    const double most_wV = std::sqrt(bb * product(wV, wV)), most_U = std::sqrt(bb * product(U, U));
    for (const ShadowMoments& m :
         {one, merge(even, odd), merge(odd, even), merge(ShadowMoments{}, one)}) {
        CHECK(m.n == 501);
        CHECK(m.bb == doctest::Approx(bb).epsilon(1e-6));
        CHECK(std::abs(m.b_wV - b_wV) < 1e-6 * most_wV);
        CHECK(std::abs(m.b_U - b_U) < 1e-6 * most_U);
    }
    CHECK(sums.moments().bb == doctest::Approx(bb).epsilon(1e-6));
    CHECK(std::abs(sums.moments().b_wV - b_wV) < 1e-6 * most_wV);
}

TEST_CASE("estimators: stochastic and control are unbiased at any n, also where U varies") {
    for (Estimator e : {Estimator::stochastic, Estimator::control})
        for (uint64_t n : {1, 2, 8}) {
            oracle::Random random(seed_here() + n);
            auto of_n = [&] { return estimate(e, of_ramp(random, n)); };
            EXPECT(oracle::expect_mean(0.25, 100000, of_n), 0.1);
            expect_pixel(random, e, n, 100000, 0.04);
        }
}

TEST_CASE("estimators: ratio's bias at n = 1, 2 is known, and n times it tends to 1/6") {
    oracle::Random random(seed_here());
    for (auto [n, bias] : {std::pair{1u, 0.25}, std::pair{2u, 0.119188}}) {
        auto of_n = [&, n = n] { return ratio(of_ramp(random, n)); };
        EXPECT(oracle::expect_mean(0.25 + bias, 400000, of_n), 0.02);
    }
    CHECK(ramp.bias(Estimator::ratio) == doctest::Approx(1.0 / 6));
    expect_bias(Estimator::ratio, ramp.R(), 0.25);
}

TEST_CASE("estimators: regression's bias falls as predicted") {
    expect_bias(Estimator::regression, ramp.beta(Estimator::regression), 0.5);
}

TEST_CASE("estimators: ratio and regression converge to the pixel where U varies in it") {
    // Their bias at n = 4096 is about 1e-4, a tenth of what the test detects.
    oracle::Random random(seed_here());
    for (Estimator e : {Estimator::ratio, Estimator::regression})
        expect_pixel(random, e, 4096, 400, 0.01);
}

TEST_CASE("estimators: predicted biases are those of their definitions, w = 3x^2, V = [x < 0.8]") {
    const ShadowPopulation p{1, 0.512, 1.8, 1.8 * 0.32768, 27.0 / 7, 27.0 / 7 * std::pow(0.8, 7)};
    const double beta = p.beta(Estimator::regression);
    double of_ratio = 0, of_regression = 0, variance = 0;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
        const double x = (i + 0.5) / n, w = 3 * x * x, wV = x < 0.8 ? w : 0;
        of_ratio -= w * (wV - p.R() * w) / n;
        variance += (w - 1) * (w - 1) / n;
        of_regression -= (w - 1) * (w - 1) * (wV - p.S - beta * (w - 1)) / n;
    }
    CHECK(p.bias(Estimator::ratio) == doctest::Approx(of_ratio).epsilon(1e-6));
    CHECK(p.bias(Estimator::regression) == doctest::Approx(of_regression / variance).epsilon(1e-6));
    CHECK(p.bias(Estimator::stochastic) == 0);
    CHECK(p.bias(Estimator::control) == 0);
}

TEST_CASE("estimators: variances are those predicted, and regression's is the least") {
    // n times the variance about the truth: the mean of n (estimate - S)^2 over trials.
    const double published[] = {5.0 / 48, 29.0 / 48};  // 0.104, 0.604
    for (size_t i = 0; i < 2; ++i)
        CHECK(ramp.variance(estimators[i]) == doctest::Approx(published[i]));
    for (Estimator e : estimators) {
        oracle::Random random(seed_here() + uint64_t(e));
        CHECK(ramp.variance(Estimator::regression) <= ramp.variance(e));
        // At n = 256 the variance of ratio and regression still differs by some 1/n.
        const oracle::Verdict v = oracle::expect_mean(ramp.variance(e), 2000, [&] {
            return of_many([&] {
                const double error = estimate(e, of_ramp(random, 256)) - ramp.S;
                return 256 * error * error;
            });
        });
        EXPECT(v, 0.1);
    }
    // Case (e) of the 1D experiment in closed form: w = 3x^2, V = [x < 0.8].
    const ShadowPopulation e{1, 0.512, 1.8, 1.8 * 0.32768, 0, 0};
    CHECK(e.variance(Estimator::stochastic) == doctest::Approx(0.589824 - 0.262144));
    CHECK(e.variance(Estimator::control) == doctest::Approx(1.210176 - 0.238144));
    CHECK(e.variance(Estimator::ratio) ==
          doctest::Approx(0.589824 * 0.238144 + 1.210176 * 0.262144));
    CHECK(e.variance(Estimator::regression) ==
          doctest::Approx(0.32768 - (0.589824 - 0.512) * (0.589824 - 0.512) / 0.8));
}

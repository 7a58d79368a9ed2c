// oracle/exact_test.cpp  verdicts in closed form, and lumps that only one part of a check sees
#include <doctest/doctest.h>

#include <optional>
#include <utility>
#include <vector>

#include "oracle/expect.h"

TEST_CASE("Poisson: k or more, by the sum of the terms below k") {
    for (double mean : {0.01, 1.0, 7.5}) {
        double term = std::exp(-mean), below = 0;
        for (int k = 0; k < 12; ++k) {
            CHECK(oracle::p_at_least(k, mean) == doctest::Approx(1 - below).epsilon(1e-10));
            below += term;
            term *= mean / (k + 1);
        }
    }
    CHECK(oracle::p_at_least(1, 0) == 0);
    CHECK(oracle::p_at_least(0, 0) == 1);
}

TEST_CASE("counts: two cells are one degree of freedom") {
    const std::vector<uint64_t> counts = {5100, 4900};  // 2 sigma
    const std::vector<double> half = {0.5, 0.5};
    CHECK(oracle::expect_counts(counts, half).p ==
          doctest::Approx(oracle::p_of_z(2)).epsilon(1e-9));
}

TEST_CASE("two means: one of few numbers has its degrees of freedom, one of many adds none") {
    const oracle::Estimate few{1, 0.1, 9}, many{0.5, 1e-9, 1e6}, as_few{0.5, 0.1, 9};
    CHECK(oracle::expect_equal(few, many).p == doctest::Approx(oracle::p_of_t(5, 9)).epsilon(1e-9));
    CHECK(oracle::expect_equal(few, as_few).p ==
          doctest::Approx(oracle::p_of_t(5 / std::sqrt(2.0), 18)).epsilon(1e-9));
}

TEST_CASE("images: a lump in any one of the 16 blocks is seen, which no pixel and no mean shows") {
    // 256 pixels that are off by 0.65 sigma each: 10.4 sigma of their block, 2.6 of the image.
    const std::string folder = std::exchange(oracle::pictures, "");
    const size_t size = 64;
    oracle::Random random(seed_here());
    const std::vector<double> truth(size * size, 2), errors(size * size, 0.1);
    for (size_t block : {0, 3, 6, 9, 12, 15}) {
        std::vector<double> values;
        for (size_t i = 0; i < size * size; ++i) {
            double normal = -6;  // nearly
            for (int k = 0; k < 12; ++k) normal += random();
            const size_t here = i / size / 16 * 4 + i % size / 16;
            values.push_back(2 + 0.1 * (normal + (here == block ? 0.65 : 0)));
        }
        const oracle::Verdict v = oracle::expect_image(size, size, values, errors, truth);
        INFO(v.text);
        CHECK(v.p < 1e-9);
    }
    oracle::pictures = folder;
}

// ---- What a reviewer provoked ------------------------------------------------------------------

namespace {

struct Quiet {
    const std::string folder = std::exchange(oracle::pictures, "");
    ~Quiet() { oracle::pictures = folder; }
};
bool says(const oracle::Verdict& v, const std::string& words) {
    INFO(v.text);
    const bool found = v.text.find(words) != std::string::npos;
    CHECK(found);
    return found;
}
const oracle::Options quick{.sees = 0.03};

}  // namespace

TEST_CASE("choices: one, one that never comes, one of a million; none among whole probabilities") {
    const Quiet quiet;
    oracle::Random random(seed_here());
    CHECK(oracle::expect_choice(
              random, [](double) { return 0; }, [](int) { return 0.99999994f; }, 1, quick)
              .pass);
    CHECK(oracle::expect_choice(
              random, [](double) { return 1; }, [](int i) { return i == 1 ? 1.0 : 0.0; }, 3, quick)
              .pass);
    int refused = 0;
    for (double q : {1e-8, 1e-7, 1e-6})
        for (int k = 0; k < 100; ++k)
            refused += !oracle::expect_choice(
                            random, [q](double u) { return u < q; },
                            [q](int i) { return i ? q : 1 - q; }, 2, quick)
                            .pass;
    CHECK(refused == 0);
    says(oracle::expect_choice(
             random, [](double u) { return u < 0.1 ? -1 : 0; }, [](int) { return 1.0; }, 1, quick),
         "10 % of the choices are none, though the probabilities sum to 1");
    // Numbers of a float, which are never 1.
    CHECK(oracle::expect_choice(
              random, [](float u) { return int(u * 4); }, [](int) { return 0.25; }, 4)
              .pass);
}

TEST_CASE("densities: 99 % that fail hide less than 10 %; a sample at 0 lies on the line") {
    const Quiet quiet;
    oracle::Random random(seed_here());
    auto rare = [](double u, double v) { return v < 0.99 ? std::nullopt : std::optional(u); };
    auto pdf = [](double factor) {
        return [factor](double x) { return 0 <= x && x < 1 ? 0.01 * factor : 0; };
    };
    CHECK(oracle::expect_density(random, rare, pdf(1), quick).pass);
    CHECK(!oracle::expect_density(random, rare, pdf(1.1), quick).pass);
    // Every second sample is 0, where a density may begin.
    auto zero = [](float u) { return u < 0.5f ? 0.0f : -std::log1p(-(2 * u - 1)); };
    const oracle::Verdict v = oracle::expect_density(
        random, zero, [](float x) { return x < 0 ? 0 : std::exp(-x); }, quick);
    CHECK(v.text.find("outside") == std::string::npos);
    CHECK(!v.pass);
}

TEST_CASE(
    "what says nothing is refused: few numbers, samples all the same, a BSDF that is 0, no pixel") {
    const Quiet quiet;
    oracle::Random random(seed_here());
    says(oracle::expect_mean(0.5, 100, [&] { return random(); }), "n = 100 is too small");
    says(oracle::expect_density(
             random,
             [](double, double) {
                 return oracle::Triple{0, 0, 1};
             },
             [](oracle::Triple) { return 1 / (4 * oracle::pi); }, quick),
         "samples are all the same");
    auto sample = [](oracle::Triple, double u, double v) {
        return oracle::Triple{std::sqrt(u) * std::cos(2 * oracle::pi * v),
                              std::sqrt(u) * std::sin(2 * oracle::pi * v), std::sqrt(1 - u)};
    };
    auto pdf = [](oracle::Triple, oracle::Triple w) { return std::max(0.0, w[2]) / oracle::pi; };
    says(oracle::expect_bsdf(
             random, sample, pdf, [](oracle::Triple, oracle::Triple) { return 0.0; }, quick),
         "eval is 0");
    const std::vector<double> nothing;
    says(oracle::expect_image(0, 0, nothing, nothing, nothing), "no pixel");
    const std::vector<double> values = {1, 1, 1, 1, 1, 1, 1, 2}, errors(8, 0.01), ones(8, 1);
    CHECK(oracle::expect_image(4, 2, values, errors, ones).text.find("further") ==
          std::string::npos);
    says(oracle::expect_equal(oracle::Estimate{1, 0.1, 99}, oracle::Estimate{2, 0.1, 99},
                              {.name = "both"}),
         "both: ");
}

TEST_CASE("a verdict on what cannot be judged begins with the name that it was given, once") {
    const Quiet quiet;
    oracle::Random random(seed_here());
    const oracle::Options o{.name = "mine"};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    auto uniform = [&] { return random(); };
    auto broken = [&] { return nan; };
    auto rare = [&](int) { return random(); };
    auto decays_not = [&](uint64_t) { return nan; };
    const uint64_t none[] = {0, 0}, few[] = {3, 4}, off[] = {500, 1}, one[] = {1000};
    const double halves[] = {0.5, 0.5}, all[] = {1, 0};
    const std::vector<double> nothing, value{nan}, error{nan}, number{1};
    for (const oracle::Verdict& v :
         {oracle::expect_mean(1, 1000, broken, o), oracle::expect_equal(broken, uniform, 1000, o),
          oracle::expect_equal(uniform, broken, 1000, o), oracle::expect_replicates(1, 15, rare, o),
          oracle::expect_bias_decay(1, 4, 1000, decays_not, o),
          oracle::expect_counts(none, halves, o), oracle::expect_counts(few, halves, o),
          oracle::expect_counts(off, all, o), oracle::expect_counts(one, all, o),
          oracle::expect_image(0, 0, nothing, nothing, nothing, o),
          oracle::expect_image(1, 1, value, number, number, o),
          oracle::expect_image(1, 1, number, error, number, o)}) {
        INFO(v.text);
        CHECK(!v.pass);
        CHECK(v.text.rfind("mine: ", 0) == 0);
        CHECK(v.text.rfind("mine: ") == 0);
    }
}

// oracle/exact_test.cpp  verdicts in closed form, and lumps that only one part of a check sees
#include <doctest/doctest.h>

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

// labs/seeds_test.cpp  errors over seeds, their own error, and choices beside the default
#include "labs/seeds.h"

#include <doctest/doctest.h>

namespace {

// Of one pixel an image.
Series series(const std::vector<std::array<float, 3>>& pixels, std::vector<double> seconds) {
    Series s{{}, std::move(seconds)};
    for (const auto& pixel : pixels) {
        s.images.emplace_back(1, 1);
        s.images.back().pixels[0] = pixel;
    }
    return s;
}

}  // namespace

TEST_CASE("variance between seeds is unbiased, and the mean over channels") {
    // Means 2, 3, 0; variances 1, 4, 0.
    const Series s = series({{1, 1, 0}, {2, 3, 0}, {3, 5, 0}}, {3, 1, 8});
    CHECK(variance_between(s) == doctest::Approx(5.0 / 3));
    CHECK(mean_square(s) == doctest::Approx(13.0 / 3));
    CHECK(variance_between(s, 0) == doctest::Approx((0.5 + 2) / 3));
    CHECK(variance_between(s, 1) == doctest::Approx((2.0 + 8) / 3));
    CHECK(seconds_without(s) == 3);
    CHECK(seconds_without(s, 2) == 2);
    CHECK(seconds_without(s, 0) == 4.5);
}

TEST_CASE("the jackknife of a mean is its standard error") {
    const std::vector<double> x = {1, 4, 2, 7, 5.5};
    Moments all;
    for (double v : x) all.add(v);
    auto number = [&](size_t without) {
        Moments m;
        for (size_t k = 0; k < x.size(); ++k)
            if (k != without) m.add(x[k]);
        return std::exp(m.mean);
    };
    const Estimate e = over_seeds(x.size(), number);
    CHECK(e.value == doctest::Approx(std::exp(all.mean)));
    CHECK(e.log_error == doctest::Approx(all.standard_error()));
    CHECK(told({2, 0.05}, "%.2f") == "2.00 ± 0.10");
}

TEST_CASE("choices are what the program knows, but for the default") {
    const std::vector<Choice> light = alternatives("--light");
    REQUIRE(light.size() == 2);
    CHECK(light[0].words == std::vector<std::string>{"--light", "none"});
    CHECK(light[1].name == "--light nee");
    for (const Choice& c : alternatives("--sampler")) CHECK(c.name != "--sampler sobol");
}

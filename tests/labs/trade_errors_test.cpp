// labs/trade_errors_test.cpp  errors against a noisy reference, and the settings of a scene
#include "labs/trade_errors.h"

#include <doctest/doctest.h>

#include "base/rng.h"
#include "labs/trade_runs.h"

namespace {

// Of truth 2, with noise of this deviation, uniform.
Image noisy(uint64_t seed, double deviation, double bias = 0) {
    Image image(128, 64);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double u = double(hash(hash(seed, i), c) >> 11) * 0x1p-53;
            image.pixels[i][c] = float(2 + bias + deviation * std::sqrt(12.0) * (u - 0.5));
        }
    return image;
}

trade::Reference reference(double deviation) {
    Series runs;
    for (uint64_t k = 0; k < 8; ++k) {
        runs.images.push_back(noisy(100 + k, deviation));
        runs.seconds.push_back(1);
    }
    return trade::reference_of(runs);
}

}  // namespace

TEST_CASE("a reference of eight runs knows its own error") {
    const trade::Reference f = reference(0.4);
    CHECK(f.error == doctest::Approx(0.4 / std::sqrt(8.0) / 2).epsilon(0.02));
    CHECK(f.mean_square == doctest::Approx(4).epsilon(0.01));
}

TEST_CASE("an error is that of the images, bias included, without the reference's own") {
    const trade::Reference f = reference(0.4);  // its own: 7 %
    const trade::Error e = trade::error_of({noisy(1, 0.2), noisy(2, 0.2)}, f);
    CHECK(std::abs(e.value - 0.1) < 5 * e.standard_error);
    CHECK(e.standard_error < 0.002);
    CHECK(e.standard_error > 0.0002);
    const trade::Error biased = trade::error_of({noisy(1, 0.2, 0.3)}, f);
    CHECK(std::abs(biased.value - std::hypot(0.1, 0.15)) < 5 * biased.standard_error);
    // What is far below the reference's noise is not told.
    CHECK(std::isnan(trade::error_of({noisy(3, 1e-4)}, f).value));
}

TEST_CASE("settings: all that the renderer takes for a scene, each once, and what they are") {
    const trade::Ground g = trade::ground_of("cornell36", 4),
                        glass = trade::ground_of("cornell", 4), point = trade::ground_of("cube", 4);
    CHECK(g.diffuse);
    CHECK(!glass.diffuse);
    CHECK(point.point_lights);
    auto find = [](const std::vector<TradeSetting>& all, const std::string& words) {
        const TradeSetting* found = nullptr;
        for (const TradeSetting& s : all)
            if (s.words == words) found = found ? nullptr : &s;
        return found;
    };
    const auto all = trade::settings_of(g, false), of_glass = trade::settings_of(glass, true),
               of_point = trade::settings_of(point, false);
    const TradeSetting* own = find(all, trade::written({}));
    REQUIRE(own);
    CHECK(own->unbiased);
    CHECK(own->takes_every_scene);
    for (const char* words :
         {"--sampler halton-naive --light mis", "--sampler sobol --light nee --direct ratio",
          "--sampler sobol --light nee --direct regression",
          "--sampler halton --light mis --indirect map"}) {
        CAPTURE(words);
        REQUIRE(find(all, words));
        CHECK(!find(all, words)->unbiased);
    }
    for (const char* words : {"--sampler independent --light none",
                              "--sampler halton --light mis --indirect control"}) {
        CAPTURE(words);
        REQUIRE(find(all, words));
        CHECK(find(all, words)->unbiased);
        CHECK(!find(all, words)->takes_every_scene);
    }
    CHECK(!find(all, "--sampler sobol --light mis --direct ratio"));
    CHECK(!find(of_glass, "--sampler sobol --light mis --indirect map"));
    CHECK(find(of_glass, "--sampler sobol --light none"));
    CHECK(!find(of_point, "--sampler sobol --light none"));
    CHECK(of_glass[0].is_float);
}

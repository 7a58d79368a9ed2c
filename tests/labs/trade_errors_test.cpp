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

TEST_CASE("settings: all samplers by all --light that the scene allows, each once") {
    const trade::Ground g = trade::ground_of("cornell36", 4), point = trade::ground_of("cube", 4);
    CHECK_FALSE(g.point_lights);
    CHECK(point.point_lights);
    auto count = [](const std::vector<TradeSetting>& all, const std::string& words) {
        return std::count_if(all.begin(), all.end(), [&](auto& s) { return s.words == words; });
    };
    const auto all = trade::settings_of(g, false), of_point = trade::settings_of(point, true);
    CHECK(all.size() == 13);
    CHECK(of_point.size() == 9);
    CHECK(trade::default_words() == "--sampler sobol --light mis");
    for (const TradeSetting& s : all) {
        CAPTURE(s.words);
        CHECK(count(all, s.words) == 1);
        CHECK(s.takes_every_scene == (s.words.find("none") == s.words.npos));
        CHECK(s.takes_every_scene == (count(of_point, s.words) == 1));
        CHECK_FALSE(s.is_float);
        trade::options_of(s.words);  // the program takes it
    }
    for (const char* words : {"--sampler sobol --light mis", "--sampler sobol --light mis --sets 1",
                              "--sampler independent --light none"})
        CHECK(count(all, words) == 1);
    CHECK(of_point[0].is_float);
}

TEST_CASE("an image depends on its seed alone") {
    trade::Ground g = trade::ground_of("cube", 8);
    for (const char* words :
         {"--sampler sobol --light mis --sets 1", "--sampler sobol --light mis"}) {
        const Image one = trade::taken_by(g, {words, 8, 3}).image,
                    again = trade::taken_by(g, {words, 8, 3}).image,
                    other = trade::taken_by(g, {words, 8, 4}).image;
        CHECK(one.pixels == again.pixels);
        CHECK(one.pixels != other.pixels);
        CHECK_FALSE(first_non_finite(one));
    }
}

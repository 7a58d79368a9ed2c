// film/error_test.cpp  estimates of d^2 against the truth, the course of errors, stopping
#include "film/error.h"

#include "base/approx.h"
#include "base/cases.h"
#include "film/spread.h"
#include "oracle/expect.h"
#include "path/samplers.h"

namespace {

// A normal number (Box, Muller 1958).
double normal(Rng& rng) {
    const double r = std::sqrt(-2 * std::log1p(-rng.uniform())), phi = 2 * 3.141592653589793;
    return r * std::cos(phi * rng.uniform());
}

const SampleFunction noisy = random_radiance(5, [](const PixelSample&, vec2 u) {
    return rgb{u.x, u.x, u.x};
});

// An error of one pixel with this d^2, standard error of d^2, and |f|.
ImageError error_with(double d2, double spread, double norm) {
    ImageError e;
    e.pixels = 1, e.variances = {d2, d2, d2};
    e.terms2 = spread * spread, e.squares = 3 * norm * norm;
    return e;
}

}  // namespace

TEST_CASE("d^2 of an image, by hand") {
    // The replications are 1, 5, 3 (variance 4), then 2, 6, 1 (variance 7), then 7, 7, 7.  Green is
    // twice as much, blue has no noise.
    const Film film = filled({3, 1}, 3, 2, [](const PixelSample& s, Tally&) {
        constexpr real values[3][3] = {{1, 5, 3}, {2, 6, 1}, {7, 7, 7}};
        return rgb{values[s.x][s.replication], 2 * values[s.x][s.replication], 1};
    });
    const ImageError e = error_of(film);
    CHECK(e.pixels == 3);
    CHECK(e.values == Sum{13, 26, 3});
    const double red = 4 / 3.0 + 7 / 3.0;
    CHECK(e.variances[0] == about(red, 1e-14));
    CHECK(e.variances[1] == about(4 * red, 1e-14));
    CHECK(e.variances[2] == 0);
    CHECK(e.d2() == about(5 * red / 9, 1e-14));
    // The pixels' values are 3, 3, 7.
    CHECK(e.norm() == about(std::sqrt((5 * (9 + 9 + 49) + 3) / 9.0), 1e-14));
    // E |f|^2 = |F|^2 + d^2.
    const double F = std::sqrt((5 * (9 + 9 + 49) + 3) / 9.0 - 5 * red / 9);
    CHECK(e.norm_of_truth() == about(F, 1e-14));
    CHECK(e.d_rel() == about(std::sqrt(e.d2()) / F, 1e-14));
    const double first = 4 / 3.0 * 5 / 3, second = 7 / 3.0 * 5 / 3;
    CHECK(e.worst == about(second, 1e-14));
    // E[T]^2 = (K - 1) / (K + 1) E[T^2], here a half of it.
    const double spread = std::sqrt((first * first + second * second) / 2) / 3;
    CHECK(e.spread_of_d() == about(spread / e.d2() / 2, 1e-14));
    // The slope of sqrt(s / (N - s)) is N / (2 sqrt(s) (N - s)^3/2).
    CHECK(e.standard_error() ==
          about(spread * square(e.norm()) / (2 * std::sqrt(e.d2()) * F * F * F), 1e-13));
    CHECK(e.spread_of_d_rel() == about(e.standard_error() / e.d_rel(), 1e-13));
}

TEST_CASE("the error of a film against brute force") {
    const SampleFunction L = random_radiance(
        seed_here(), [](const PixelSample& s, vec2 u) { return heteroscedastic(s.x, s.y, u); });
    for (const uint32_t K : {0u, 5u}) {
        const Film film = filled({33, 17}, K, 24, L);
        double of_terms = 0, norm2 = 0, worst = 0, terms2 = 0;
        size_t weights = 0;
        for (size_t i = 0; i < film.pixels(); ++i) {
            const double R = film.replications, n = 24.0 * film.weight[i];
            double term = 0;
            for (size_t c = 0; c < 3; ++c) {
                double mean = 0, squares = 0;
                for (size_t k = 0; k < film.replications; ++k)
                    mean += film.sum[i * film.replications + k][c] / n / R;
                for (size_t k = 0; k < film.replications; ++k)
                    squares += square(film.sum[i * film.replications + k][c] / n - mean);
                term += squares / (R - 1) / R / 3;
                norm2 += square(mean) / 3;
            }
            of_terms += term, worst = std::max(worst, term), terms2 += square(term) * 2 / (R + 1);
            weights |= film.weight[i];
        }
        CHECK((weights == 1) == (K > 0));
        const ImageError e = error_of(film);
        CHECK(e.d2() == about(of_terms / 561, 1e-12));
        CHECK(e.norm() == about(std::sqrt(norm2 / 561), 1e-12));
        CHECK(e.worst == about(worst, 1e-12));
        CHECK(e.terms2 == about(terms2, 1e-12));
    }
    // The error of a pixel of one replication is unknown, and so is that of the image.
    ImageError e = error_of(filled({33, 17}, 5, 24, L));
    Pixel one;
    one.add({1, 1, 1}, 1);
    e.add(one);
    CHECK(e.pixels == 562);
    CHECK(std::isnan(e.d_rel()));
    CHECK(!is_small_enough(e, 1e9));
}

TEST_CASE("an error that is not known is no number; that of an image without noise is 0") {
    for (real level : {real(0), real(3)})
        for (uint32_t K : {0u, 1u, 2u}) {
            const Film film = filled({2, 1}, K, 3, [=](const PixelSample&, Tally&) {
                return level * rgb{1, 1, 1};
            });
            const ImageError e = error_of(film);
            CAPTURE(K);
            CHECK(e.norm() == double(level));
            CHECK((K == 1 ? std::isnan(e.d2()) : e.d2() == 0));
            CHECK((K == 1 || level == 0 ? std::isnan(e.d_rel()) : e.d_rel() == 0));
            CHECK(
                (K == 1 || level == 0 ? std::isnan(e.standard_error()) : e.standard_error() == 0));
            CHECK(is_small_enough(e, 0.01) == (K != 1 && level > 0));
        }
    CHECK(std::isnan(error_of(make_film({1, 1}, 2, false)).d_rel()));  // before any sample
    // That of a film some of whose blocks have no sample is unknown.
    Film film = make_film({2, 2}, 2, false);
    fill_blocks(film, 0, 3, 2, noisy);
    CHECK(std::isnan(error_of(film).d_rel()));
    fill_blocks(film, 3, 4, 1, noisy);
    CHECK(error_of(film).d_rel() > 0);
}

TEST_CASE("what float cannot hold: d_rel at radiance 2^-50 and 2^50 is that at 1, to the bit") {
    auto error = [](int exponent) {
        return error_of(
            filled({12, 12}, 0, 40, random_radiance(7, [=](const PixelSample& s, vec2 u) {
                       return heteroscedastic(s.x, s.y, u) * std::ldexp(real(1), exponent);
                   })));
    };
    const ImageError one = error(0);
    CHECK(one.d_rel() > 0.01);
    CHECK(one.standard_error() > 0);
    for (int exponent : {-50, 50}) {
        const ImageError e = error(exponent);
        CHECK(e.d_rel() == one.d_rel());
        CHECK(e.standard_error() == one.standard_error());
        CHECK(e.d2() == std::ldexp(one.d2(), 2 * exponent));
    }
}

TEST_CASE("the standard error of d^2 is its spread from seed to seed") {
    // Grey pixels of normal numbers with standard deviations from 1 to 10.
    for (uint32_t K : {2u, 3u, 8u}) {
        Moments d2, spread2;
        double truth = 0;
        for (int x = 0; x < 100; ++x) truth += std::pow(1 + x % 10, 2) / K / 100;
        Rng rng{hash(seed_here(), K)};
        for (int r = 0; r < 1000; ++r) {
            const ImageError e = error_of(filled({100, 1}, K, 1, [&](const PixelSample& s, Tally&) {
                const real v = real((1 + s.x % 10) * normal(rng));
                return rgb{v, v, v};
            }));
            d2.add(e.d2());
            spread2.add(e.terms2 / 1e4);
        }
        INFO("replications ", K);
        EXPECT(oracle::expect_mean(truth, estimate(d2, double(ulp))), 0.05);
        // The standard errors are 5 and 8 %: the fourth moment of a sum of a hundred terms is about
        // 3.3.
        const double ratio = spread2.mean / d2.variance();
        CAPTURE(ratio);
        CHECK(std::abs(ratio - 1) <
              4.9 * std::hypot(std::sqrt(2.5 / 1000), spread2.standard_error() / spread2.mean));
        CHECK(spread2.standard_error() < 0.09 * spread2.mean);
    }
}

TEST_CASE("the stated d^2 is that from seed to seed: samplers, replications, weights") {
    for (SamplerKind kind : samplers)
        for (const unsigned K : {0u, 3u}) {
            const uint64_t n = K ? 24 : 4;
            Spread spread;
            for (uint64_t r = 0; r < 200; ++r) {
                const SamplerSettings settings = sampler_settings(kind, hash(seed_here(), r), 1);
                const SampleFunction L = [&](const PixelSample& s, Tally&) {
                    const uint64_t pixel = uint64_t(s.y * 12 + s.x);
                    const Sampler sampler(settings, pixel, s.i, s.replication);
                    return heteroscedastic(s.x, s.y, sampler.get2(film_x));
                };
                const Film film = filled({12, 9}, K, n, L);
                spread.add(image_of(film), error_of(film).d2());
            }
            INFO("sampler ", int(kind), ", replications ", K);
            EXPECT(oracle::expect_mean(1, spread.ratio()), 0.4);
        }
}

TEST_CASE(
    "the rule of --error: raised by half its standard error and another pixel like the worst") {
    auto error = [](double d_rel, double standard_error) {
        const double d2 = square(d_rel * 2), spread = standard_error / d_rel / (1 + square(d_rel));
        const ImageError e = error_with(d2, 2 * d2 * (d_rel > 0 ? spread : 0), std::sqrt(4 + d2));
        REQUIRE(e.d_rel() == doctest::Approx(d_rel));
        REQUIRE(e.standard_error() == doctest::Approx(standard_error));
        return e;
    };
    // The error is small enough only with its margin.
    CHECK(is_small_enough(error(0.0099, 0.0001), 0.01));
    CHECK(!is_small_enough(error(0.0100, 0.0002), 0.01));
    CHECK(!is_small_enough(error(0.0096, 0.0010), 0.01));
    CHECK(is_small_enough(error(0.0094, 0.0010), 0.01));
    CHECK(is_small_enough(error(0, 0), 0.01));
    CHECK(!is_small_enough(ImageError(), 0.01));  // unknown
    // One more pixel like the worst must not be too much, either: .0099 and a quarter of d^2.
    ImageError spotted = error(0.009, 0);
    CHECK(is_small_enough(spotted, 0.01));
    spotted.worst = spotted.d2() / 4;
    CHECK(!is_small_enough(spotted, 0.01));
    CHECK(!is_small_enough(spotted, 0.01006));
    CHECK(is_small_enough(spotted, 0.01007));
    // That of a film of two pixels is half as large.
    ImageError two = spotted;
    two.pixels = 2, two.squares *= 2;
    for (double& v : two.variances) v *= 2;
    CHECK(two.d_rel() == spotted.d_rel());
    CHECK(is_small_enough(two, 0.009 * 1.0607));
    CHECK(!is_small_enough(two, 0.009 * 1.0606));
}

TEST_CASE("checks are a lattice from 8 on, about a 32nd apart, wherever one asks from") {
    std::vector<uint64_t> checks = {8};
    while (checks.back() < 200000) checks.push_back(next_check(checks.back()));
    for (uint64_t n = 0; n < 8; ++n) CHECK(next_check(n) == 8);
    for (size_t k = 1; k < checks.size(); ++k) {
        CHECK(checks[k] == checks[k - 1] + checks[k - 1] / 32 + 1);
        const uint64_t step = checks[k] - checks[k - 1];
        // From anywhere between two checks the next one is returned.
        for (uint64_t n : {checks[k - 1], checks[k - 1] + step / 2, checks[k] - 1})
            CHECK(next_check(n) == checks[k]);
    }
    CHECK(said(next_check(31), next_check(32), next_check(64)) == "32 34 67");
}

TEST_CASE("checks look at whole films when they are due, and tell what they expect") {
    const SampleFunction one = [](const PixelSample&, Tally&) { return rgb{1, 1, 1}; };
    const Size size{12, 9};
    // A pilot has no check, whatever its samples; the first check after it is at 8.
    Film film = make_film(size, 2, true);
    fill(film, 8, one);
    CHECK_FALSE(is_check_due(film));
    choose_weights(film);
    for (uint64_t n = 0; n < 8; ++n) {
        fill(film, n, one);
        CHECK_FALSE(is_check_due(film));
    }
    fill(film, 8, one);
    CHECK(is_check_due(film));
    CHECK(check_error(film, 0.1, {}).stop == Stop::error);
    fill_blocks(film, 0, 1, 9, one);  // an interrupted film is completed first
    CHECK_FALSE(is_check_due(film));
    fill(film, 33, one);
    CHECK_FALSE(is_check_due(film));  // checks are at 32 and 34
    fill(film, 34, one);
    CHECK(is_check_due(film));
    // If the error is too large, the samples grow with the square of the ratio of the errors.
    const Film rough = filled(size, 2, 8, noisy);
    const ErrorCheck strict = check_error(rough, error_of(rough).d_rel() / 5, {});
    CHECK(strict.stop == Stop::no);
    CHECK(strict.expected == about(8 * 25, 1e-12));
    // The cost of a black film is unknown.
    const Film black = filled(size, 2, 8, [](const PixelSample&, Tally&) { return rgb{}; });
    CHECK(check_error(black, 0.1, {}).stop == Stop::no);
    CHECK(check_error(black, 0.1, {}).expected == HUGE_VAL);
    // What has an error that is small enough needs no more.
    CHECK(check_error(rough, 0.9, {}).stop == Stop::error);
    CHECK(check_error(rough, 0.9, {}).expected == 8);
}

TEST_CASE("d_rel is over the truth, not over an image that is mostly noise") {
    // F = 3, and the noise has variance 400 / 12 per sample.  In a pixel, f^2 and its variance have
    // a standard deviation of about 24 each.
    const ImageError e =
        error_of(filled({100, 100}, 2, 1, random_radiance(11, [](const PixelSample&, vec2 u) {
                            const real L = 3 + 20 * (u.x - real(0.5));
                            return rgb{L, L, L};
                        })));
    CHECK(std::abs(square(e.norm_of_truth()) - 9) < 5 * 34 / 100.0);
    CHECK(e.norm() > 4.5);
    CHECK(e.d_rel() == doctest::Approx(std::sqrt(400.0 / 12 / 2) / 3).epsilon(0.1));
    // All is noise.
    CHECK(error_with(4, 0.01, 1.9).norm_of_truth() == 0);
    CHECK(error_with(4, 0.01, 1.9).d_rel() == HUGE_VAL);
}

TEST_CASE("an error is in doubt: black, by few pixels, lost in noise, or by its near misses") {
    const MayMissLight silent = [](const Film&, const ImageError&) { return false; };
    const MayMissLight doubtful = [](const Film&, const ImageError&) { return true; };
    const Film film;
    auto doubt = [&](double d2, double spread, double norm, const MayMissLight& why) {
        return doubt_of(film, error_with(d2, spread, norm), why);
    };
    CHECK(doubt(4, 0, 30, {}) == Doubt::no);
    CHECK(doubt(0, 0, 30, silent) == Doubt::no);
    CHECK(doubt(0, 0, 0, doubtful) == Doubt::black);
    CHECK(doubt(4, 0, 30, doubtful) == Doubt::missed_light);
    // d +- 0.35 d corresponds to d^2 +- 0.7 d^2.
    CHECK(doubt(4, 2.79, 30, silent) == Doubt::no);
    CHECK(doubt(4, 2.81, 30, silent) == Doubt::few_pixels);
    // Few pixels that have an error of a half or more do not understate it: |F|^2 is 16 there.
    CHECK(doubt(4, 2.81, 4.48, silent) == Doubt::few_pixels);
    CHECK(doubt(4, 2.81, 4.46, silent) == Doubt::no);
    CHECK(doubt(4, 2.81, 30, doubtful) == Doubt::missed_light);
    // Rounding is no noise: d_rel of 1e-6 is small, however poorly it is known.
    CHECK(doubt(4, 3, 2.1e6, silent) == Doubt::no);
    CHECK(doubt(4, 3, 1.9e6, silent) == Doubt::few_pixels);
    CHECK(doubt(4, 3, 2.1e6, doubtful) == Doubt::missed_light);
    // |F|^2 = 9 - 4, so that d_rel has 9 / 5 of the relative spread; or |F|^2 would be negative.
    CHECK(doubt(4, 4.4, 3, silent) == Doubt::no);
    CHECK(doubt(4, 4.5, 3, silent) == Doubt::noise);
    CHECK(doubt(4, 0.01, 1.9, silent) == Doubt::noise);
    CHECK(doubt(4, 0.01, 1.9, doubtful) == Doubt::missed_light);
    // One replication has no error to doubt.
    CHECK(doubt(NAN, NAN, 3, doubtful) == Doubt::no);
}

TEST_CASE("an error that is in doubt stops no render before 4096 samples per pixel") {
    bool is_known = false;
    const MayMissLight why = [&](const Film&, const ImageError&) { return !is_known; };
    auto stop = [&](uint64_t n, double wanted) {
        return check_error(filled({12, 9}, 4, n, noisy), wanted, why).stop;
    };
    uint64_t n = 8;  // the last check before 1024
    while (next_check(n) < 1024) n = next_check(n);
    const uint64_t beyond = next_check(n);
    REQUIRE(beyond >= 1024);
    CHECK(stop(n, 0.5) == Stop::no);
    CHECK(stop(beyond, 0.5) == Stop::error_unknown);
    is_known = true;
    CHECK(stop(n, 0.5) == Stop::error);
    CHECK(stop(beyond, 0.5) == Stop::error);
    CHECK(stop(beyond, 1e-9) == Stop::no);
}

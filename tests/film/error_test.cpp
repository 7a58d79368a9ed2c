// film/error_test.cpp  estimates of d^2 against the truth, error histories, stopping
#include "film/error.h"

#include "base/about.h"
#include "film/spread.h"
#include "oracle/expect.h"
#include "path/samplers.h"

namespace {

// A normal number (Box, Muller 1958).
double normal(Rng& rng) {
    const double r = std::sqrt(-2 * std::log1p(-rng.uniform())), phi = 2 * 3.141592653589793;
    return r * std::cos(phi * rng.uniform());
}

const Radiance noisy = random_radiance(5, [](const PixelSample&, vec2 u) {
    return rgb{u.x, u.x, u.x};
});

}  // namespace

TEST_CASE("d^2 of an image, by hand") {
    // The replications are 1, 5, 3 (variance 4), then 2, 6, 1 (variance 7), then 7, 7, 7.  Green is
    // twice as much, blue has no noise.
    const Film film = filled({3, 1}, 3, 2, [](const PixelSample& s, Tally&) {
        constexpr real values[3][3] = {{1, 5, 3}, {2, 6, 1}, {7, 7, 7}};
        return rgb{values[s.x][s.set], 2 * values[s.x][s.set], 1};
    });
    const ErrorTerms terms = terms_of(film);
    CHECK(terms.pixels == 3);
    CHECK(terms.measured == 3);
    CHECK(terms.sum == std::array<double, 3>{13, 26, 3});
    const ImageError e = error_of(film);
    CHECK(e.mean == std::array<double, 3>{13 / 3.0, 26 / 3.0, 1});
    const double red = (4 / 3.0 + 7 / 3.0) / 3;
    CHECK(e.square[0] == about(red, 1e-15));
    CHECK(e.square[1] == about(4 * red, 1e-15));
    CHECK(e.square[2] == 0);
    CHECK(e.d2() == about(5 * red / 3, 1e-15));
    // The pixels' values are 3, 3, 7.
    CHECK(e.norm == doctest::Approx(std::sqrt((5 * (9 + 9 + 49) + 3) / 9.0)).epsilon(1e-15));
    // E |f|^2 = |F|^2 + d^2.
    const double F = std::sqrt((5 * (9 + 9 + 49) + 3) / 9.0 - 5 * red / 3);
    CHECK(e.norm_of_truth() == doctest::Approx(F).epsilon(1e-15));
    CHECK(e.d_rel() == about(std::sqrt(e.d2()) / F, 1e-15));
    const double first = 4 / 3.0 * 5 / 3, second = 7 / 3.0 * 5 / 3;
    CHECK(e.greatest == about(second / 3, 1e-15));
    // E[T]^2 = (K - 1) / (K + 1) E[T^2], here a half of it.
    const double spread = std::sqrt((first * first + second * second) / 2) / 3;
    CHECK(e.spread == about(spread, 1e-15));
    // The slope of sqrt(s / (N - s)) is N / (2 sqrt(s) (N - s)^3/2).
    CHECK(e.standard_error() ==
          about(e.spread * e.norm * e.norm / (2 * std::sqrt(e.d2()) * F * F * F), 1e-14));
    CHECK(e.d_rel_and_unseen() == about(std::sqrt(e.d2() + e.greatest) / F, 1e-15));
}

TEST_CASE("the error of a film against brute force") {
    const Radiance L = random_radiance(
        seed_here(), [](const PixelSample& s, vec2 u) { return heteroscedastic(s.x, s.y, u); });
    Film film = filled({33, 17}, 0, 24, L);
    const std::vector<size_t> at = offsets(film);
    double square = 0, norm2 = 0, worst = 0;
    for (size_t i = 0, k = 0; i < film.pixels(); k += film.sets[i++]) {
        double term = 0;
        for (size_t c = 0; c < 3; ++c) {
            const double K = film.sets[i];
            double sum = 0, squares = 0;
            for (size_t set = 0; set < film.sets[i]; ++set) sum += film.sum[k + set].L[c] / 24;
            for (size_t set = 0; set < film.sets[i]; ++set)
                squares += std::pow(film.sum[k + set].L[c] / 24 - sum / K, 2);
            term += squares / (K - 1) / K / 3;
            norm2 += std::pow(sum / K, 2) / 3;
        }
        square += term, worst = std::max(worst, term);
    }
    const ImageError e = error_of(film);
    CHECK(e.d2() == about(square / 561, 1e-12));
    CHECK(e.norm == about(std::sqrt(norm2 / 561), 1e-12));
    CHECK(e.greatest == about(worst / 561, 1e-12));
    // A pixel of one replication has no error estimate, so that the image's error is unknown.
    ErrorTerms terms = terms_of(film);
    terms.add(Pixel{{film.sum.data(), 1}, 24, 24});
    CHECK(terms.pixels == 562);
    CHECK(terms.measured == 561);
    CHECK(std::isnan(terms.error().d_rel()));
}

TEST_CASE("of independent pictures, weighed by their samples: value, variance, and its spread") {
    // 8 samples: replications with means 1 and 3 (variance 1). 24: means 2, 3, 7 (variance 7 / 3).
    const std::vector<Sum> few = {{{4, 8, 0}}, {{12, 24, 0}}},
                           many = {{{16, 0, 8}}, {{24, 0, 8}}, {{56, 0, 8}}};
    const std::vector<Pixel> pictures = {{few, 4, 4}, {many, 8, 8}};
    ErrorTerms terms;
    const auto value = terms.add(pictures);
    CHECK(value == std::array<double, 3>{(2 + 3 * 4) / 4.0, 4 / 4.0, 3 / 4.0});
    const ImageError e = terms.error();
    CHECK(e.mean == value);
    CHECK(e.square[0] == doctest::Approx((1 + 9 * 7 / 3.0) / 16).epsilon(1e-14));
    CHECK(e.square[1] == doctest::Approx(4 / 16.0).epsilon(1e-14));
    CHECK(e.square[2] == 0);
    CHECK(e.greatest == doctest::Approx(e.d2()).epsilon(1e-14));
    CHECK(e.norm == doctest::Approx(std::sqrt((3.5 * 3.5 + 1 + 0.5625) / 3)).epsilon(1e-14));
    const double first = 5 / 16.0 / 3, second = 9 * 7 / 3.0 / 16 / 3;
    CHECK(e.spread ==
          doctest::Approx(std::sqrt(first * first * 2 / 3 + second * second / 2)).epsilon(1e-14));
    // A picture without an error estimate leaves its pixel without one.
    terms.add(std::vector<Pixel>{pictures[0], {{few.data(), 1}, 4, 4}});
    CHECK(terms.pixels == 2);
    CHECK(terms.measured == 1);
}

TEST_CASE("an error that is not known is no number; that of an image without noise is 0") {
    for (real level : {real(0), real(3)})
        for (uint32_t sets : {0u, 1u, 2u}) {
            const Film film = filled({2, 1}, sets, 3, [=](const PixelSample&, Tally&) {
                return level * rgb{1, 1, 1};
            });
            const ImageError e = error_of(film);
            CAPTURE(sets);
            CHECK(e.norm == double(level));
            CHECK((sets == 1 ? std::isnan(e.d2()) : e.d2() == 0));
            CHECK((sets == 1 || level == 0 ? std::isnan(e.d_rel()) : e.d_rel() == 0));
            CHECK((sets == 1 || level == 0 ? std::isnan(e.standard_error())
                                           : e.standard_error() == 0));
            CHECK(is_small_enough(e, 0.01) == (sets != 1 && level > 0));
        }
    CHECK(ErrorHistory().cost_of(HUGE_VAL) == HUGE_VAL);
    CHECK(std::isnan(error_of(make_film({1, 1}, 2)).d_rel()));  // before any sample
    // The error is unknown after the pilot and while blocks catch up; then it is known.
    const Radiance L = [](const PixelSample& s, Tally&) { return rgb{2, 2, real(2 + s.set)}; };
    Film film = make_film({2, 2}, 0);
    fill(film, 4, L);
    CHECK(std::isnan(error_of(film).d_rel()));
    choose_sets(film, INFINITY);
    CHECK(std::isnan(error_of(film).d_rel()));
    CHECK(error_of(film).norm == 2);
    fill_blocks(film, 0, 3, 2, L);
    CHECK(std::isnan(error_of(film).d_rel()));
    fill_blocks(film, 3, 4, 1, L);
    CHECK(error_of(film).d2() == doctest::Approx(0.5 / 2 / 3));
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
    for (uint32_t sets : {2u, 3u, 8u}) {
        Moments d2, spread2;
        double truth = 0;
        for (int x = 0; x < 100; ++x) truth += std::pow(1 + x % 10, 2) / sets / 100;
        Rng rng{hash(seed_here(), sets)};
        for (int r = 0; r < 1000; ++r) {
            const ImageError e =
                error_of(filled({100, 1}, sets, 1, [&](const PixelSample& s, Tally&) {
                    const real v = real((1 + s.x % 10) * normal(rng));
                    return rgb{v, v, v};
                }));
            d2.add(e.d2());
            spread2.add(e.spread * e.spread);
        }
        INFO("sets ", sets);
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

TEST_CASE("the stated d^2 is that from seed to seed: samplers, replications, samples that differ") {
    for (SamplerKind kind : samplers)
        for (const unsigned sets : {0u, 3u}) {
            const int others = sets ? 24 : 4;
            Spread spread;
            for (uint64_t r = 0; r < 200; ++r) {
                const Pattern pattern = make_pattern(kind, hash(seed_here(), r), 1, 24);
                const Radiance L = [&](const PixelSample& s, Tally&) {
                    const uint64_t pixel = uint64_t(s.y * 12 + s.x);
                    const Sampler sampler(pattern, pixel, s.i, s.set);
                    return heteroscedastic(s.x, s.y, sampler.get2(film_x));
                };
                Film film = make_film({12, 9}, sets);
                if (sets == 0) {
                    fill(film, 8, L);
                    choose_sets(film, INFINITY);
                }
                fill(film, uint64_t(others), L);
                spread.add(image_of(film), error_of(film).d2());
            }
            INFO("sampler ", int(kind), ", sets ", sets, ", others ", others);
            EXPECT(oracle::expect_mean(1, spread.ratio()), 0.4);
        }
}

TEST_CASE("the course of an error: exponents of known laws, from 1/2 to 1") {
    CHECK(ErrorHistory().exponent() == 0.5);
    CHECK(ErrorHistory().cost_of(2) == 4);
    for (const auto& row : std::initializer_list<std::pair<double, double>>{
             {0.5, 0.5}, {0.75, 0.75}, {1, 1}, {1.5, 1}, {0.2, 0.5}, {-1, 0.5}}) {
        const auto [gamma, found] = row;
        ErrorHistory history;
        for (uint64_t n : {16, 40, 90, 200}) history.add(n, 3 * std::pow(double(n), -gamma));
        CAPTURE(row.first);
        CHECK(history.exponent() == about(found, 1e-12));
        CHECK(history.cost_of(4) == about(std::pow(4, 1 / found), 1e-12));
    }
}

TEST_CASE("the course is of the last two errors whose samples have doubled") {
    ErrorHistory history;
    CHECK(history.is_due(1));
    history.add(16, 8);
    CHECK(!history.is_due(31));
    CHECK(history.is_due(32));
    CHECK(history.exponent() == 0.5);
    history.add(31, 1);  // less than twice as many
    CHECK(history.exponent() == 0.5);
    history.add(32, 8 * std::pow(2, -0.75));  // compared with 16
    CHECK(history.exponent() == doctest::Approx(0.75).epsilon(1e-12));
    history.add(64, 8 * std::pow(2, -0.75) / std::pow(2, 0.6));  // compared with 32, not 16
    CHECK(history.exponent() == doctest::Approx(0.6).epsilon(1e-12));
}

TEST_CASE("an error that vanishes, grows or is not known leaves an exponent that can be used") {
    for (const auto& row : std::initializer_list<std::pair<double, double>>{
             {0, 0}, {1, 0}, {0, 1}, {NAN, 1}, {1, NAN}, {HUGE_VAL, 1}, {1, HUGE_VAL}}) {
        ErrorHistory history;
        history.add(16, row.first);
        history.add(32, row.second);
        CAPTURE(row.first);
        CAPTURE(row.second);
        CHECK(history.exponent() >= 0.5);
        CHECK(history.exponent() <= 1);
    }
}

TEST_CASE(
    "the rule of --error: raised by half its standard error and another pixel like the worst") {
    auto error = [](double d_rel, double standard_error) {
        ImageError e;
        e.square.fill(std::pow(d_rel * 2, 2));
        e.norm = std::sqrt(4 + e.d2());
        e.spread = d_rel > 0 ? standard_error * 2 * e.d2() / d_rel / (1 + d_rel * d_rel) : 0;
        e.greatest = 0;
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
    spotted.greatest = spotted.d2() / 4;
    CHECK(!is_small_enough(spotted, 0.01));
    CHECK(is_small_enough(spotted, 0.0101));
}

TEST_CASE("checks are a lattice: whole periods, about a 32nd apart, wherever one asks from") {
    struct Lattice {
        uint64_t first, period;
    };
    for (const Lattice& lattice :
         {Lattice{16, 1}, Lattice{18, 6}, Lattice{256, 256}, Lattice{25, 25}, Lattice{1, 1}}) {
        const uint64_t first = lattice.first, period = lattice.period;
        CAPTURE(first);
        std::vector<uint64_t> checks = {first};
        while (checks.back() < 200000) checks.push_back(next_check(checks.back(), first, period));
        for (uint64_t n = 0; n < first; ++n) CHECK(next_check(n, first, period) == first);
        for (size_t k = 1; k < checks.size(); ++k) {
            const uint64_t step = checks[k] - checks[k - 1], part = checks[k - 1] / 32;
            CHECK(step > 0);
            CHECK(step % period == 0);
            CHECK(step > part);  // not too often
            CHECK(step <= part + period);
            // From anywhere between two checks the next one is returned.
            for (uint64_t n : {checks[k - 1], checks[k - 1] + step / 2, checks[k] - 1})
                CHECK(next_check(n, first, period) == checks[k]);
        }
    }
    CHECK(next_check(16, 16, 1) == 17);
    CHECK(next_check(64, 16, 1) == 67);
}

TEST_CASE("checks look at whole films when they are due, and tell what they expect") {
    const Radiance one = [](const PixelSample&, Tally&) { return rgb{1, 1, 1}; };
    const Size size{12, 9};
    // A pilot has no error and continues; the first check after it is at 8 samples, in whole grids.
    Film film = make_film(size, 0);
    fill(film, 8, one);
    ErrorChecks checks(0.1, 1);
    CHECK(checks.next(film) == UINT64_MAX);
    choose_sets(film, INFINITY);
    CHECK(checks.next(film) == 8);
    CHECK(ErrorChecks(0.1, 6).next(film) == 12);
    fill(film, 7, one);
    CHECK(checks.next(film) == 8);  // no check, although the error is 0
    CHECK(!checks.is_enough());
    // An interrupted film is completed first.
    fill_blocks(film, 0, 1, 9, one);
    fill_blocks(film, 1, film.taken.size(), 8, one);
    CHECK(checks.next(film) == 9);
    CHECK(!checks.is_enough());
    fill(film, 9, one);
    CHECK(checks.next(film) == 9);
    CHECK(checks.is_enough());
    // If the error is too large, the samples grow with the square of the ratio of the errors.
    Film rough = make_film(size, 2);
    fill(rough, 8, noisy);
    const double d = error_of(rough).d_rel();
    ErrorChecks strict(d / 5, 1), none(0, 1);
    CHECK(strict.next(rough) == 9);
    CHECK(!strict.is_enough());
    CHECK(strict.expected() == doctest::Approx(8 * 25));
    // The cost of a black film is unknown.
    Film black = make_film(size, 2);
    fill(black, 8, [](const PixelSample&, Tally&) { return rgb{}; });
    ErrorChecks dark(0.1, 1);
    CHECK(dark.next(black) == 9);
    CHECK(dark.expected() == HUGE_VAL);
    // Without a requested error the checks only record the error history.
    CHECK(none.next(rough) == UINT64_MAX);
    CHECK(none.expected() == HUGE_VAL);
    CHECK(!none.history().is_due(15));
    CHECK(none.history().is_due(16));
}

TEST_CASE("d_rel is over the truth, not over an image that is mostly noise") {
    // F = 3, and the noise has variance 400 / 12 per sample.  In a pixel, f^2 and its variance have
    // a standard deviation of about 24 each.
    const ImageError e =
        error_of(filled({100, 100}, 2, 1, random_radiance(11, [](const PixelSample&, vec2 u) {
                            const real L = 3 + 20 * (u.x - real(0.5));
                            return rgb{L, L, L};
                        })));
    CHECK(std::abs(e.norm_of_truth() * e.norm_of_truth() - 9) < 5 * 34 / 100.0);
    CHECK(e.norm > 4.5);
    CHECK(e.d_rel() == doctest::Approx(std::sqrt(400.0 / 12 / 2) / 3).epsilon(0.1));
}

TEST_CASE("an error is in doubt: black, by few pixels, lost in noise, or as a judge has it") {
    const Judge silent = [](const Film&, const ImageError&) { return std::string(); };
    const Judge doubtful = [](const Film&, const ImageError&) { return std::string("rare light"); };
    auto error = [](double d2, double spread, double norm) {
        ImageError e;
        e.square = {d2, d2, d2}, e.spread = spread, e.norm = norm;
        return e;
    };
    const Film film;
    CHECK(doubt_of(film, error(4, 0, 30), {}).empty());
    CHECK(doubt_of(film, error(0, 0, 30), silent).empty());
    CHECK(doubt_of(film, error(0, 0, 0), doubtful) == "no sample found light");
    CHECK(doubt_of(film, error(4, 0, 30), doubtful) == "rare light");
    // d +- d / 4 corresponds to d^2 +- d^2 / 2.
    CHECK(doubt_of(film, error(4, 1.97, 30), silent).empty());
    CHECK(doubt_of(film, error(4, 2.01, 30), silent) == "a few pixels dominate it");
    CHECK(doubt_of(film, error(4, 2.01, 3), silent) == "a few pixels dominate it");
    CHECK(doubt_of(film, error(4, 2.01, 30), doubtful) == "rare light");
    // Rounding is no noise: d_rel of 1e-6 is small, however poorly it is known.
    CHECK(doubt_of(film, error(4, 3, 2.1e6), silent).empty());
    CHECK(doubt_of(film, error(4, 3, 1.9e6), silent) == "a few pixels dominate it");
    CHECK(doubt_of(film, error(4, 3, 2.1e6), doubtful) == "rare light");
    // |F|^2 = 9 - 4, so that d_rel has 9 / 5 of the relative spread; or |F|^2 would be negative.
    CHECK(doubt_of(film, error(4, 1.1, 3), silent).empty());
    CHECK(doubt_of(film, error(4, 1.12, 3), silent) == "the picture is mostly noise");
    CHECK(doubt_of(film, error(4, 0.01, 1.9), silent) == "the picture is mostly noise");
    CHECK(doubt_of(film, error(4, 0.01, 1.9), doubtful) == "rare light");
    // One replication has no error to doubt.
    CHECK(doubt_of(film, error(NAN, NAN, 3), doubtful).empty());
}

TEST_CASE("an error that is in doubt stops no render before 4096 samples a pixel") {
    bool is_known = false;
    const Judge judge = [&](const Film&, const ImageError&) {
        return std::string(is_known ? "" : "rare light");
    };
    Film film = make_film({12, 9}, 4);
    ErrorChecks checks(0.5, 512, judge), others(0.5, 512, judge);
    fill(film, 512, noisy);
    CHECK(checks.next(film) > 512);
    CHECK(!checks.is_hopeless());
    is_known = true;
    CHECK(others.next(film) == 512);
    CHECK(others.is_enough());
    is_known = false;
    fill(film, 1024, noisy);
    CHECK(checks.next(film) == 1024);
    CHECK(checks.is_hopeless());
    CHECK(!checks.is_enough());
    // Without a requested error, doubts have no effect.
    ErrorChecks none(0, 512, judge);
    CHECK(none.next(film) == UINT64_MAX);
    CHECK(!none.is_hopeless());
}

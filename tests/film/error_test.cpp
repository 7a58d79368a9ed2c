// film/error_test.cpp  d^2 as images state it, beside what it is; its course, and when it is small
#include "film/error.h"

#include <memory>

#include "film/spread.h"
#include "oracle/expect.h"

namespace {

// A normal number (Box, Muller 1958).
double normal(Rng& rng) {
    const double r = std::sqrt(-2 * std::log1p(-rng.uniform())), phi = 2 * 3.141592653589793;
    return r * std::cos(phi * rng.uniform());
}

}  // namespace

// ---- What images state --------------------------------------------------------------------------

TEST_CASE("d^2 and the variance of a pixel, by hand") {
    // Pixels of values 1, 5, 3 (variance 4, of which three are shown), of 2 and 6 (variance 8, one
    // shown, measured by a chance of 1/4), of 7 alone; green twice, blue without noise.
    auto L = [](int x, int, uint64_t, uint32_t set) {
        constexpr real values[3][3] = {{1, 5, 3}, {2, 6, 0}, {7, 0, 0}};
        return rgb{values[x][set], 2 * values[x][set], 1};
    };
    MeanFilm film({3, 1}), variances({3, 1}, {}, Shows::variances);
    for (MeanFilm* f : {&film, &variances}) {
        f->add_sets({{3, 0}, {1, 0.25}, {1, 0}});
        whole_pass(*f, 2, L);
    }
    const ImageError e = error_of(film);
    CHECK(film.terms().pixels == 3);
    CHECK(film.terms().measured == 2);
    CHECK(film.terms().sum == std::array<double, 3>{12, 24, 3});
    CHECK(error_of(variances).d_rel() == e.d_rel());
    const double red = (4 / 3.0 + 8 / 0.25) / 3;
    CHECK(e.square[0] == doctest::Approx(red).epsilon(1e-15).scale(0));
    CHECK(e.square[1] == doctest::Approx(4 * red).epsilon(1e-15).scale(0));
    CHECK(e.square[2] == 0);
    CHECK(e.d2() == doctest::Approx(5 * red / 3).epsilon(1e-15).scale(0));
    // Shown: 3, 2, 7 in red.
    CHECK(e.norm == doctest::Approx(std::sqrt((5 * (9 + 4 + 49) + 3) / 9.0)).epsilon(1e-15));
    CHECK(e.d_rel() == doctest::Approx(std::sqrt(e.d2()) / e.norm).epsilon(1e-15).scale(0));
    const double terms[2] = {4 / 3.0 * 5 / 9, 8 / 0.25 * 5 / 9};
    CHECK(e.greatest == doctest::Approx(terms[1]).epsilon(1e-15).scale(0));
    // E[T]^2 = p (n - 1) / (n + 1) E[T^2]: 1/2 of three sets, 1/4 1/3 of two.
    const double spread = std::sqrt(std::pow(terms[0], 2) / 2 + std::pow(terms[1], 2) * 11 / 12);
    CHECK(e.spread == doctest::Approx(spread).epsilon(1e-15).scale(0));
    // d(sqrt(s)) = ds / (2 sqrt(s)).
    CHECK(e.standard_error() ==
          doctest::Approx(e.spread / (2 * std::sqrt(e.d2()) * e.norm)).epsilon(1e-15).scale(0));
    const Image& variance = variances.image();
    CHECK(variance.at(0, 0) == std::array<float, 3>{float(4 / 3.0), float(16 / 3.0), 0});
    CHECK(variance.at(1, 0) == std::array<float, 3>{8, 32, 0});
    CHECK(std::isnan(variance.at(2, 0)[0]));
}

TEST_CASE("an error that is not known is no number; that of an image without noise is 0") {
    auto film_of = [](const std::vector<Sets>& sets, auto value) {
        auto film = std::make_unique<MeanFilm>(Size{2, 1});
        if (!sets.empty()) film->add_sets(sets);
        whole_pass(*film, 3, [&](int x, int, uint64_t, uint32_t set) {
            const real v = value(x, set);
            return rgb{v, v, v};
        });
        return film;
    };
    auto error = [](const std::unique_ptr<MeanFilm>& film) { return error_of(*film); };
    const std::vector<Sets> one(2, {1, 0}), two(2, {2, 0}), measured(2, {1, 0.5});
    for (real level : {real(0), real(3)})
        for (const auto& sets : {std::vector<Sets>(), one}) {
            const ImageError e = error(film_of(sets, [&](int, uint32_t) { return level; }));
            CHECK(std::isnan(e.d2()));
            CHECK(std::isnan(e.d_rel()));
            CHECK(std::isnan(e.standard_error()));
            CHECK(e.norm == double(level));
        }
    for (real level : {real(0), real(3)}) {
        const ImageError e = error(film_of(two, [&](int, uint32_t) { return level; }));
        CHECK(e.d2() == 0);
        CHECK((level > 0 ? e.d_rel() == 0 : std::isnan(e.d_rel())));
        CHECK(e.standard_error() == 0);
    }
    // Black, but for what only measures it.
    const ImageError e = error(film_of(measured, [](int, uint32_t set) { return real(set); }));
    CHECK(e.d2() > 0);
    CHECK(std::isnan(e.d_rel()));
    CHECK(ErrorCourse().cost_of(HUGE_VAL) == HUGE_VAL);
    CHECK(!is_small_enough(e, 0.5));
    // Before any sample; while the others catch up.
    MeanFilm film({1, 1});
    CHECK(std::isnan(error_of(film).d_rel()));
    film.add_sets({{2, 0}});
    CHECK(std::isnan(error_of(film).d_rel()));
    for (Shows shows : {Shows::values, Shows::variances}) {
        MeanFilm late({1, 1}, {}, shows);
        whole_pass(late, 4, [](int, int, uint64_t, uint32_t) { return rgb{2, 2, 2}; });
        late.add_sets({{2, 0}});
        CHECK(std::isnan(error_of(late).d_rel()));
        CHECK(error_of(late).norm == 2);
        CHECK(std::isnan(late.image().at(0, 0)[0]) == (shows == Shows::variances));
    }
}

TEST_CASE("what float cannot hold: d_rel at radiance 2^-80 and 2^93 is that at 1, to the bit") {
    auto error = [](int exponent) {
        MeanFilm film({12, 12});
        fill(film, by_noise, 1, 40, [&](int x, int y, uint64_t i, uint32_t set) {
            const uint64_t bits = hash(hash(hash(7, uint64_t(12 * y + x)), set), i);
            const rgb v = heteroscedastic(x, y, {to_unit(bits), to_unit(mix(bits))});
            return v * std::ldexp(real(1), exponent);
        });
        CHECK(film.non_finite() == 0);
        return error_of(film);
    };
    const ImageError one = error(0);
    CHECK(one.d_rel() > 0.01);
    CHECK(one.standard_error() > 0);
    for (int exponent : {-80, 93}) {
        const ImageError e = error(exponent);
        CHECK(e.d_rel() == one.d_rel());
        CHECK(e.standard_error() == one.standard_error());
        CHECK(e.d2() == std::ldexp(one.d2(), 2 * exponent));
    }
}

// ---- Against replicates -------------------------------------------------------------------------

TEST_CASE("the standard error of d^2 is its spread from seed to seed") {
    // Grey pixels of normal numbers, 1 to 10 large; with sets 2, 3, or measured by chances of 1/4.
    for (const Sets& sets : {Sets{2, 0}, Sets{3, 0}, Sets{8, 0}, Sets{1, 0.25}}) {
        Moments d2, spread2;
        double truth = 0;
        for (int x = 0; x < 100; ++x) truth += std::pow(1 + x % 10, 2) / sets.shown / 100;
        Rng rng{hash(seed_here(), sets.count())};
        for (int r = 0; r < 3000; ++r) {
            std::vector<Sets> drawn(100, sets);
            for (Sets& s : drawn)
                if (rng.uniform() >= s.chance && s.chance > 0) s.chance = 0;
            MeanFilm film({100, 1});
            film.add_sets(drawn);
            whole_pass(film, 1, [&](int x, int, uint64_t, uint32_t) {
                const real v = real((1 + x % 10) * normal(rng));
                return rgb{v, v, v};
            });
            const ImageError e = error_of(film);
            d2.add(e.d2());
            spread2.add(e.spread * e.spread);
        }
        INFO("sets ", sets.shown, ", chance ", sets.chance);
        EXPECT(oracle::expect_mean(truth, estimate(d2, double(ulp))), 0.07);
        // Both are known within 3 %: the fourth moment of a sum of a hundred terms is about 3.3.
        const double ratio = spread2.mean / d2.variance();
        CAPTURE(ratio);
        CHECK(std::abs(ratio - 1) <
              4.9 * std::hypot(std::sqrt(2.5 / 3000), spread2.standard_error() / spread2.mean));
        CHECK(spread2.standard_error() < 0.05 * spread2.mean);
    }
}

// ---- How it falls, and when it is small enough --------------------------------------------------

TEST_CASE("the course of an error: exponents of known laws, from 1/2 to 1") {
    CHECK(ErrorCourse().exponent() == 0.5);
    CHECK(ErrorCourse().cost_of(2) == 4);
    for (const auto& row : std::initializer_list<std::pair<double, double>>{
             {0.5, 0.5}, {0.75, 0.75}, {1, 1}, {1.5, 1}, {0.2, 0.5}, {-1, 0.5}}) {
        const auto [gamma, found] = row;
        ErrorCourse course;
        for (uint64_t n : {16, 40, 90, 200}) course.add(n, 3 * std::pow(double(n), -gamma));
        CAPTURE(row.first);
        CHECK(course.exponent() == doctest::Approx(found).epsilon(1e-12).scale(0));
        CHECK(course.cost_of(4) == doctest::Approx(std::pow(4, 1 / found)).epsilon(1e-12).scale(0));
    }
}

TEST_CASE("the course looks back to half the samples, no nearer and no farther than it must") {
    ErrorCourse course;
    CHECK(course.is_due(1));
    course.add(16, 8);
    CHECK(!course.is_due(31));
    CHECK(course.is_due(32));
    CHECK(course.exponent() == 0.5);
    course.add(20, 1);  // not twice as many
    CHECK(course.exponent() == 0.5);
    course.add(32, 8 * std::pow(2, -0.75));  // beside 16, not 20
    CHECK(course.exponent() == doctest::Approx(0.75).epsilon(1e-12));
    course.add(64, 8 * std::pow(2, -0.75) / std::pow(2, 0.6));  // beside 32, not 16
    CHECK(course.exponent() == doctest::Approx(0.6).epsilon(1e-12));
}

TEST_CASE("an error that vanishes, grows or is not known leaves an exponent that can be used") {
    for (const auto& row : std::initializer_list<std::pair<double, double>>{
             {0, 0}, {1, 0}, {0, 1}, {NAN, 1}, {1, NAN}, {HUGE_VAL, 1}, {1, HUGE_VAL}}) {
        ErrorCourse course;
        course.add(16, row.first);
        course.add(32, row.second);
        CAPTURE(row.first);
        CAPTURE(row.second);
        CHECK(course.exponent() >= 0.5);
        CHECK(course.exponent() <= 1);
    }
}

TEST_CASE(
    "the rule of --error: raised by half its standard error and another pixel like the worst") {
    auto error = [](double d_rel, double standard_error) {
        ImageError e;
        e.norm = 2;
        e.square.fill(std::pow(d_rel * e.norm, 2));
        e.spread = d_rel > 0 ? standard_error * 2 * e.d2() / d_rel : 0;
        e.greatest = 0;
        REQUIRE(e.d_rel() == doctest::Approx(d_rel));
        REQUIRE(e.standard_error() == doctest::Approx(standard_error));
        return e;
    };
    // Enough: only with its margin.
    CHECK(is_small_enough(error(0.0099, 0.0001), 0.01));
    CHECK(!is_small_enough(error(0.0100, 0.0002), 0.01));
    CHECK(!is_small_enough(error(0.0096, 0.0010), 0.01));
    CHECK(is_small_enough(error(0.0094, 0.0010), 0.01));
    CHECK(is_small_enough(error(0, 0), 0.01));
    CHECK(!is_small_enough(ImageError(), 0.01));  // not known
    // And only if another pixel like the worst would not be too much: .0099 and a quarter of d^2.
    ImageError spotted = error(0.009, 0);
    CHECK(is_small_enough(spotted, 0.01));
    spotted.greatest = spotted.d2() / 4;
    CHECK(!is_small_enough(spotted, 0.01));
    CHECK(is_small_enough(spotted, 0.0101));
}

TEST_CASE("looks are a lattice: whole periods, about a 32nd apart, wherever one asks from") {
    struct Lattice {
        uint64_t first, period;
    };
    for (const auto& [first, period] :
         {Lattice{16, 1}, Lattice{18, 6}, Lattice{256, 256}, Lattice{25, 25}, Lattice{1, 1}}) {
        CAPTURE(first);
        std::vector<uint64_t> looks = {first};
        while (looks.back() < 200000) looks.push_back(next_look(looks.back(), first, period));
        for (uint64_t n = 0; n < first; ++n) CHECK(next_look(n, first, period) == first);
        for (size_t k = 1; k < looks.size(); ++k) {
            const uint64_t step = looks[k] - looks[k - 1], part = looks[k - 1] / 32;
            CHECK(step > 0);
            CHECK(step % period == 0);
            CHECK(step > part);  // seldom enough
            CHECK(step <= part + period);
            // From anywhere between two of them: the one ahead.
            for (uint64_t n : {looks[k - 1], looks[k - 1] + step / 2, looks[k] - 1})
                CHECK(next_look(n, first, period) == looks[k]);
        }
    }
    CHECK(next_look(16, 16, 1) == 17);
    CHECK(next_look(64, 16, 1) == 67);
}

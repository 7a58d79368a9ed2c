// film/film_test.cpp  sums, variances and counts of samples
#include "film/film.h"

#include <map>

#include "base/moments.h"
#include "base/rng.h"
#include "oracle/expect.h"

namespace {

using Pixel = std::array<float, 3>;
using MeanFilm = Film<MeanPixel>;

}  // namespace

TEST_CASE("a film is the mean of its samples, however passes divide them") {
    // Values whose sum depends on the order of addition.
    auto L = [](int x, int y, uint64_t i) {
        const real v = std::ldexp(real(1 + x + 3 * y) / 7, int(i * 37 % 60) - 30);
        return rgb{i % 2 ? -v : v, real(i), 1};
    };
    auto film_of = [&](const std::vector<uint64_t>& passes) {
        MeanFilm film({3, 2});
        for (uint64_t n : passes) {
            for (int y : {1, 0}) film.add_row(y, n, [&](int x, uint64_t i) { return L(x, y, i); });
            film.end_pass(n);
        }
        CHECK(film.samples() == 12);
        CHECK(film.non_finite() == 0);
        return image_of(film);
    };
    const Image whole = film_of({12});
    double sum = 0;
    for (uint64_t i = 0; i < 12; ++i) sum += double(L(2, 1, i).x);
    CHECK(whole.at(2, 1) == Pixel{float(sum / 12), 5.5f, 1});
    for (const auto& passes : {std::vector<uint64_t>(12, 1), {1, 2, 4, 5}, {5, 5, 2}, {11, 1}})
        CHECK(film_of(passes).pixels == whole.pixels);
}

TEST_CASE("a pass that is not complete leaves no trace in the image") {
    MeanFilm film({2, 2});
    auto pass = [&](int rows, real value) {
        for (int y = 0; y < rows; ++y)
            film.add_row(y, 2, [&](int, uint64_t) { return rgb{value, value, value}; });
    };
    pass(1, 5);
    CHECK(film.samples() == 0);
    CHECK(std::isnan(image_of(film).at(0, 0)[0]));
    pass(2, 3);
    film.end_pass(2);
    pass(1, 100);
    CHECK(film.samples() == 2);
    for (const Pixel& pixel : image_of(film).pixels) CHECK(pixel == Pixel{3, 3, 3});
}

TEST_CASE("a pixel that nobody wrote is no number in the image, even if the pass is ended") {
    MeanFilm film({2, 2});
    for (int pass = 0; pass < 2; ++pass) {
        film.add_row(0, 1, [](int, uint64_t) { return rgb{1, 1, 1}; });
        film.end_pass(1);
        CHECK(image_of(film).at(0, 0) == Pixel{1, 1, 1});
        CHECK(first_non_finite(image_of(film)) == "0,1");
    }
}

TEST_CASE("a row takes no more samples once the run is interrupted") {
    MeanFilm film({8, 1});
    int samples = 0;
    film.add_row(0, 100, [&](int x, uint64_t i) {
        interrupted = x == 2 && i == 7;
        ++samples;
        return rgb{};
    });
    interrupted = 0;
    CHECK(samples == 208);
}

TEST_CASE("means over pixels are of doubles, whatever float holds") {
    MeanFilm film({2, 1});
    CHECK(std::isnan(film.mean_of([](const MeanPixel&, size_t) { return 1.0; })[0]));
    film.add_row(0, 2, [](int x, uint64_t i) {
        return rgb{i && x ? real(1e30) : 0, i ? real(1e-30) : 0, 0};
    });
    film.end_pass(2);
    const std::array<double, 3> mean = film.mean_of(variance_in(film, VarianceFrom::halves));
    CHECK(mean[0] == doctest::Approx(1e60 / 4 / 2));
    CHECK(mean[1] / 1e-60 == doctest::Approx(1 / 4.0));
    CHECK(mean[2] == 0);
    CHECK(std::isinf(variance_of(film, VarianceFrom::halves).at(1, 0)[0]));
}

TEST_CASE("samples that no file can hold are counted, and the first by sample, row, column told") {
    const real nan = std::numeric_limits<real>::quiet_NaN();
    const std::map<std::array<int, 3>, rgb> bad = {{{7, 0, 0}, {nan, 1, 1}},  // sample, y, x
                                                   {{4, 2, 1}, {1, nan, 1}},
                                                   {{4, 1, 2}, {1, 1, -infinity}},
                                                   {{5, 1, 0}, {infinity, 1, nan}}};
    for (bool downwards : {false, true}) {
        MeanFilm film({3, 3});
        film.add_row(0, 0, [](int, uint64_t) { return rgb{}; });
        film.end_pass(0);
        CHECK(film.non_finite() == 0);
        for (int row = 0; row < 3; ++row) {
            const int y = downwards ? 2 - row : row;
            film.add_row(y, 8, [&](int x, uint64_t i) {
                auto found = bad.find({int(i), y, x});
                return found == bad.end() ? rgb{1, 1, 1} : found->second;
            });
        }
        CHECK(film.non_finite() == 4);
        CHECK(film.first_non_finite().sample == 4);
        CHECK(film.first_non_finite().y == 1);
        CHECK(film.first_non_finite().x == 2);
    }
    MeanFilm film({1, 1});  // finite, but the file's numbers are float
    film.add_row(0, 1, [](int, uint64_t) { return rgb{1, real(1e30) * real(1e10), 1}; });
    CHECK(film.non_finite() == 1);
}

TEST_CASE("a film adds up in double: 2^24 ones and more, beside numbers of 1e-9") {
    MeanFilm film({1, 1});
    film.add_row(0, 1000, [](int, uint64_t i) {
        const real tiny = i % 2 ? real(1e-9) : 0;
        return rgb{i < 2 ? real(1 << 24) : 1, i < 2 ? 1 : tiny, 0};
    });
    film.end_pass(1000);
    CHECK(image_of(film).at(0, 0)[0] == float((2.0 * (1 << 24) + 998) / 1000));
    CHECK(image_of(film).at(0, 0)[1] == float((2 + 499e-9) / 1000));
}

TEST_CASE("variances of few numbers, by hand") {
    // 1, 5, 3: mean 3, squared distances 8; even ones 1, 3, of mean 2; the odd one 5.
    const auto variance = [](VarianceFrom from) {
        MeanFilm film({1, 1});
        film.add_row(0, 3, [](int, uint64_t i) {
            return rgb{real(i == 0 ? 1 : i == 1 ? 5 : 3), 0, 0};
        });
        film.end_pass(3);
        return variance_of(film, from).at(0, 0)[0];
    };
    CHECK(variance(VarianceFrom::samples) == float(8.0 / 2 / 3));
    CHECK(variance(VarianceFrom::halves) == float(9 * 2.0 / 9));
    CHECK(std::isnan(variance(VarianceFrom::nothing)));
}

TEST_CASE("the film's variances are those of the means: independent samples, and halves") {
    // Pixel values u^2: variance of one sample 1/5 - 1/9 = 4/45.
    for (bool independent : {true, false}) {
        MeanFilm film({400, 250});
        const uint64_t n = 7;  // uneven, in passes of 1, 2, 4
        for (uint64_t pass : {1, 2, 4}) {
            for (int y = 0; y < film.size.height; ++y)
                film.add_row(y, pass, [&](int x, uint64_t i) {
                    const real u = to_unit(hash(hash(uint64_t(y), uint64_t(x)), i));
                    return rgb{u * u, 1000 + u * u, 0};
                });
            film.end_pass(pass);
        }
        CHECK(film.samples() == n);
        const Image variance =
            variance_of(film, independent ? VarianceFrom::samples : VarianceFrom::halves);
        Moments m;
        for (const auto& p : variance.pixels) m.add(double(p[0]));
        EXPECT(oracle::expect_mean(4 / 45.0 / double(n), estimate(m)), 0.05);
        // No cancellation far from zero, no variance where there is none.
        const float offset_error = sizeof(real) == 4 ? 0.02f : 1e-6f;
        CHECK(std::abs(variance.at(7, 7)[1] / variance.at(7, 7)[0] - 1) < offset_error);
        CHECK(variance.at(3, 3)[2] == 0);
    }
}

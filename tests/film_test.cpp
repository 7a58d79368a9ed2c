// film_test.cpp  sums, variances and counts of samples, and when to stop
#include "../src/film.h"

#include <map>

#include "../src/rng.h"
#include "expect.h"

namespace {

using Pixel = std::array<float, 3>;

}  // namespace

TEST_CASE("a film is the mean of its samples, however passes divide them") {
    // Values whose sum depends on the order of addition.
    auto L = [](int x, int y, uint64_t i) {
        const real v = std::ldexp(real(1 + x + 3 * y) / 7, int(i * 37 % 60) - 30);
        return rgb{i % 2 ? -v : v, real(i), 1};
    };
    auto film_of = [&](const std::vector<uint64_t>& passes) {
        Film film({3, 2});
        for (uint64_t n : passes) {
            for (int y : {1, 0}) film.add_row(y, n, [&](int x, uint64_t i) { return L(x, y, i); });
            film.end_pass(n);
        }
        CHECK(film.samples() == 12);
        CHECK(film.non_finite() == 0);
        return film.image();
    };
    const Image whole = film_of({12});
    double sum = 0;
    for (uint64_t i = 0; i < 12; ++i) sum += double(L(2, 1, i).x);
    CHECK(whole.at(2, 1) == Pixel{float(sum / 12), 5.5f, 1});
    for (const auto& passes : {std::vector<uint64_t>(12, 1), {1, 2, 4, 5}, {5, 5, 2}, {11, 1}})
        CHECK(film_of(passes).pixels == whole.pixels);
}

TEST_CASE("a pass that is not complete leaves no trace in the image") {
    Film film({2, 2});
    auto pass = [&](int rows, real value) {
        for (int y = 0; y < rows; ++y)
            film.add_row(y, 2, [&](int, uint64_t) { return rgb{value, value, value}; });
    };
    pass(1, 5);
    CHECK(film.samples() == 0);
    CHECK(std::isnan(film.image().at(0, 0)[0]));
    pass(2, 3);
    film.end_pass(2);
    pass(1, 100);
    CHECK(film.samples() == 2);
    for (const Pixel& pixel : film.image().pixels) CHECK(pixel == Pixel{3, 3, 3});
}

TEST_CASE("samples that no file can hold are counted, and the first by sample, row, column told") {
    const real nan = std::numeric_limits<real>::quiet_NaN();
    const std::map<std::array<int, 3>, rgb> bad = {{{7, 0, 0}, {nan, 1, 1}},  // sample, y, x
                                                   {{4, 2, 1}, {1, nan, 1}},
                                                   {{4, 1, 2}, {1, 1, -infinity}},
                                                   {{5, 1, 0}, {infinity, 1, nan}}};
    for (bool downwards : {false, true}) {
        Film film({3, 3});
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
        CHECK(film.first_non_finite().L.z == -infinity);
    }
    Film film({1, 1});  // finite, but the file's numbers are float
    film.add_row(0, 1, [](int, uint64_t) { return rgb{1, real(1e30) * real(1e10), 1}; });
    CHECK(film.non_finite() == 1);
}

TEST_CASE("the schedule stops at the samples or the seconds asked for, and always begins") {
    auto passes = [](uint64_t spp, double seconds, double seconds_a_sample) {
        Options o;
        o.spp = spp;
        o.seconds = seconds;
        Schedule schedule(o, 1);
        std::vector<uint64_t> sizes;
        uint64_t samples = 0;
        while (uint64_t n = schedule.next(samples, double(samples) * seconds_a_sample)) {
            sizes.push_back(n);
            samples += n;
            REQUIRE(sizes.size() < 2000);
        }
        return std::pair(samples, sizes);
    };
    for (uint64_t spp : {1, 2, 5, 64, 1000})
        for (double speed : {0.0, 1e-6, 0.03, 7.0}) {
            CHECK(passes(spp, 0, speed).first == spp);
            CHECK(passes(spp, 1e30, speed).first == spp);
        }
    CHECK(passes(0, 1e-9, 7).first == 1);  // one sample at least
    CHECK(passes(0, 100, 7).first == 15);  // the pass that crosses the end is short
    CHECK(passes(5, 100, 7).first == 5);   // whichever comes first
    CHECK(passes(50, 100, 7).first == 15);
    const auto [samples, sizes] = passes(0, 10, 1e-3);
    CHECK(samples >= 10000);
    CHECK(samples < 10100);
    CHECK(*std::max_element(sizes.begin(), sizes.end()) < 400);  // so that Ctrl-C is soon obeyed
    CHECK(sizes.size() < 200);                                   // and threads are seldom idle
    for (uint64_t n : passes(100, 0, 7).second) CHECK(n == 1);
}

TEST_CASE("a film adds up in double: 2^24 ones and more, beside numbers of 1e-9") {
    Film film({1, 1});
    film.add_row(0, 1000, [](int, uint64_t i) {
        const real tiny = i % 2 ? real(1e-9) : 0;
        return rgb{i < 2 ? real(1 << 24) : 1, i < 2 ? 1 : tiny, 0};
    });
    film.end_pass(1000);
    CHECK(film.image().at(0, 0)[0] == float((2.0 * (1 << 24) + 998) / 1000));
    CHECK(film.image().at(0, 0)[1] == float((2 + 499e-9) / 1000));
}

TEST_CASE("variances of few numbers, by hand") {
    // 1, 5, 3: mean 3, squared distances 8; even ones 1, 3, of mean 2; the odd one 5.
    const auto variance = [](Film::Estimate from) {
        Film film({1, 1});
        film.add_row(0, 3, [](int, uint64_t i) {
            return rgb{real(i == 0 ? 1 : i == 1 ? 5 : 3), 0, 0};
        });
        film.end_pass(3);
        return film.variance(from).at(0, 0)[0];
    };
    CHECK(variance(Film::Estimate::samples) == float(8.0 / 2 / 3));
    CHECK(variance(Film::Estimate::halves) == float(9 * 2.0 / 9));
    CHECK(std::isnan(variance(Film::Estimate::none)));
}

TEST_CASE("what may be said about a variance: by samples, by halves, or nothing") {
    Options o;
    for (bool halves : {false, true}) {
        o.halves = halves;
        o.sampler = SamplerKind::independent;
        CHECK(variance_estimate(o) == Film::Estimate::samples);
        for (SamplerKind kind : {SamplerKind::stratified, SamplerKind::halton}) {
            o.sampler = kind;
            CHECK(variance_estimate(o) == (halves ? Film::Estimate::halves : Film::Estimate::none));
        }
    }
}

TEST_CASE("passes are whole grids, and shrink when samples take longer") {
    Options o;
    Schedule schedule(o, 18);
    uint64_t samples = 0, longest = 0, last = 0;
    double elapsed = 0;
    for (int pass = 0; pass < 40; ++pass) {
        const uint64_t n = schedule.next(samples, elapsed);
        CHECK(n % 18 == 0);
        longest = std::max(longest, n), last = n;
        samples += n;
        elapsed += double(n) * (pass < 20 ? 1e-5 : 1e-2);
    }
    CHECK(longest > 1000);
    CHECK(last == 18);  // 0.18 s
}

TEST_CASE("an interrupted pass is told to be incomplete") {
    auto row = [](int y) { interrupted = y == 1; };
    CHECK(!parallel_rows(100, 1, row, [](double) {}));
    interrupted = false;
}

TEST_CASE("every row is rendered once, by any number of threads") {
    for (int height : {1, 2, 100})
        for (unsigned threads : {1u, 2u, 7u, 300u}) {
            std::vector<std::atomic<int>> done(static_cast<size_t>(height));
            std::atomic<bool> outside = false;
            double part = -1;
            auto row = [&](int y) {
                if (y < 0 || y >= height)
                    outside = true;
                else
                    ++done[size_t(y)];
            };
            CHECK(parallel_rows(height, threads, row, [&](double p) { part = p; }));
            CHECK_FALSE(outside);
            CHECK(part == 1);
            for (const auto& times : done) CHECK(times == 1);
        }
}

TEST_CASE("the film's variances are those of the means: independent samples, and halves") {
    // Pixel values u^2: variance of one sample 1/5 - 1/9 = 4/45.
    for (bool independent : {true, false}) {
        Film film({400, 250});
        const uint64_t n = 7;  // uneven, in passes of 1, 2, 4
        for (uint64_t pass : {1, 2, 4}) {
            for (int y = 0; y < film.height; ++y)
                film.add_row(y, pass, [&](int x, uint64_t i) {
                    const real u = to_unit(hash(hash(uint64_t(y), uint64_t(x)), i));
                    return rgb{u * u, 1000 + u * u, 0};
                });
            film.end_pass(pass);
        }
        CHECK(film.samples() == n);
        const Image variance =
            film.variance(independent ? Film::Estimate::samples : Film::Estimate::halves);
        Moments m;
        for (const auto& p : variance.pixels) m.add(double(p[0]));
        EXPECT(expect_mean(4 / 45.0 / double(n), estimate(m)), 0.05);
        // No cancellation far from zero, no variance where there is none.
        const float offset_error = sizeof(real) == 4 ? 0.02f : 1e-6f;
        CHECK(std::abs(variance.at(7, 7)[1] / variance.at(7, 7)[0] - 1) < offset_error);
        CHECK(variance.at(3, 3)[2] == 0);
    }
}

// film/film_test.cpp  sums, variances and counts of samples
#include "film/film.h"

#include <bit>
#include <map>
#include <memory>

#include "base/moments.h"
#include "base/rng.h"
#include "film/fill.h"
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
            film.begin_pass(n);
            for (size_t b = film.blocks(); b-- > 0;)
                film.add_block(b, n,
                               [&](int x, int y, uint64_t i, uint32_t) { return L(x, y, i); });
            film.end_pass(n);
        }
        CHECK(film.samples() == 12);
        CHECK(film.non_finite() == 0);
        return film.take_image();
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
    auto grey = [](real value) {
        return [=](int, int, uint64_t, uint32_t) { return rgb{value, value, value}; };
    };
    REQUIRE(film.blocks() == 4);
    film.begin_pass(2);
    add_blocks(film, 0, 2, 2, grey(3));
    CHECK(film.samples() == 0);
    for (const Pixel& pixel : film.image().pixels) CHECK(std::isnan(pixel[0]));
    add_blocks(film, 2, 4, 2, grey(3));
    film.end_pass(2);
    film.begin_pass(2);
    add_blocks(film, 0, 2, 2, grey(100));
    CHECK(film.samples() == 2);
    for (const Pixel& pixel : film.image().pixels) CHECK(pixel == Pixel{3, 3, 3});
}

TEST_CASE("a pixel that nobody wrote is no number in the image, even if the pass is ended") {
    MeanFilm film({2, 2});
    for (int pass = 0; pass < 2; ++pass) {
        film.begin_pass(1);
        add_blocks(film, 0, 2, 1, [](int, int, uint64_t, uint32_t) { return rgb{1, 1, 1}; });
        film.end_pass(1);
        CHECK(film.image().at(0, 0) == Pixel{1, 1, 1});
        CHECK(first_non_finite(film.image()) == "0,1");
    }
}

TEST_CASE("a block takes no more samples once the run is interrupted") {
    MeanFilm film({1024, 2});
    REQUIRE(film.blocks() == 256);  // of eight pixels
    int samples = 0;
    film.begin_pass(100);
    film.add_block(0, 100, [&](int x, int, uint64_t i, uint32_t) {
        interrupted = x == 2 && i == 7;
        ++samples;
        return rgb{};
    });
    interrupted = 0;
    CHECK(samples == 208);
}

TEST_CASE("samples that no file can hold are counted, and the first by sample, row, column told") {
    const real nan = std::numeric_limits<real>::quiet_NaN();
    const std::map<std::array<int, 3>, rgb> bad = {{{7, 0, 0}, {nan, 1, 1}},  // sample, y, x
                                                   {{4, 2, 1}, {1, nan, 1}},
                                                   {{4, 1, 2}, {1, 1, -infinity}},
                                                   {{5, 1, 0}, {infinity, 1, nan}}};
    for (bool downwards : {false, true}) {
        MeanFilm film({3, 3});
        whole_pass(film, 0, [](int, int, uint64_t, uint32_t) { return rgb{}; });
        CHECK(film.non_finite() == 0);
        film.begin_pass(8);
        for (size_t k = 0; k < film.blocks(); ++k)
            film.add_block(downwards ? film.blocks() - 1 - k : k, 8,
                           [&](int x, int y, uint64_t i, uint32_t) {
                               auto found = bad.find({int(i), y, x});
                               return found == bad.end() ? rgb{1, 1, 1} : found->second;
                           });
        CHECK(film.non_finite() == 4);
        CHECK(film.first_non_finite().sample == 4);
        CHECK(film.first_non_finite().y == 1);
        CHECK(film.first_non_finite().x == 2);
    }
    MeanFilm film({1, 1});  // finite, but the file's numbers are float
    film.add_block(0, 1, [](int, int, uint64_t, uint32_t) {
        return rgb{1, real(1e30) * real(1e10), 1};
    });
    CHECK(film.non_finite() == 1);
}

TEST_CASE("a film adds up in double: 2^24 ones and more, beside numbers of 1e-9") {
    MeanFilm film({1, 1});
    whole_pass(film, 1000, [](int, int, uint64_t i, uint32_t) {
        const real tiny = i % 2 ? real(1e-9) : 0;
        return rgb{i < 2 ? real(1 << 24) : 1, i < 2 ? 1 : tiny, 0};
    });
    CHECK(film.image().at(0, 0)[0] == float((2.0 * (1 << 24) + 998) / 1000));
    CHECK(film.image().at(0, 0)[1] == float((2 + 499e-9) / 1000));
}

// ---- Noise --------------------------------------------------------------------------------------

TEST_CASE("noise of few numbers, by hand") {
    // 1, 5, 3: mean 3, squared distances 8, twice as far in green.
    const auto noise = [](uint64_t n) {
        MeanFilm film({1, 1});
        whole_pass(film, n, [](int, int, uint64_t i, uint32_t) {
            const real x = real(i == 0 ? 1 : i == 1 ? 5 : 3);
            return rgb{x, 2 * x, 0};
        });
        return film.noise();
    };
    CHECK(noise(1) == std::vector<double>{0});
    CHECK(noise(2) == std::vector<double>{5 * 8.0 / 1 / 2});
    CHECK(noise(3)[0] == doctest::Approx(5 * 8.0 / 2 / 3).epsilon(1e-15).scale(0));
}

TEST_CASE("noise is the variance of the mean of independent samples, all channels together") {
    // Pixel values u^2: variance of one sample 1/5 - 1/9 = 4/45, the same far from zero.
    MeanFilm film({400, 250});
    const uint64_t n = 7;  // uneven, in passes of 1, 2, 4
    for (uint64_t pass : {1, 2, 4})
        whole_pass(film, pass, [&](int x, int y, uint64_t i, uint32_t) {
            const real u = to_unit(hash(hash(uint64_t(y), uint64_t(x)), i));
            return rgb{u * u, 1000 + u * u, 0};
        });
    CHECK(film.samples() == n);
    Moments m;
    for (double v : film.noise()) m.add(v);
    EXPECT(oracle::expect_mean(2 * 4 / 45.0 / double(n), estimate(m, double(ulp))), 0.05);
    // No cancellation far from zero, no noise where there is none.
    auto noise_of = [](auto value) {
        MeanFilm one({1, 1});
        whole_pass(one, 7, [&](int, int, uint64_t i, uint32_t) { return value(to_unit(mix(i))); });
        return one.noise()[0];
    };
    const double near = noise_of([](real u) {
        return rgb{u * u, 0, 0};
    }),
                 far = noise_of([](real u) {
                     return rgb{0, 1000 + u * u, 0};
                 });
    const double offset_error = sizeof(real) == 4 ? 0.02 : 1e-6;
    CHECK(std::abs(far / near - 1) < offset_error);
    CHECK(noise_of([](real) { return rgb{1, 2, 3}; }) == 0);
}

// ---- Sets of samples ----------------------------------------------------------------------------

namespace {

// A number for every sample of every set.
rgb numbered(int x, int y, uint64_t i, uint32_t set) {
    const uint64_t bits = hash(hash(hash(uint64_t(y), uint64_t(x)), set), i);
    return {to_unit(bits), to_unit(mix(bits)), real(set)};
}

void add(MeanFilm& film, uint64_t n) { whole_pass(film, n, numbered); }

const std::vector<Sets> of_four_pixels = {{1, 0}, {3, 0}, {1, 0.25}, {2, 0}};

std::vector<Sets> of_all_kinds(size_t pixels) {
    std::vector<Sets> sets(pixels);
    for (size_t i = 0; i < pixels; ++i) sets[i] = of_four_pixels[i % 4];
    return sets;
}

}  // namespace

TEST_CASE("a pixel is the mean of its sets that are shown, whenever they were added") {
    // Blocks of one pixel, and of six.
    for (const auto& [size, before] : std::initializer_list<std::pair<Size, uint64_t>>{
             {{2, 2}, 0}, {{2, 2}, 1}, {{2, 2}, 4}, {{2, 2}, 9}, {{1600, 1}, 0}, {{1600, 1}, 2}}) {
        MeanFilm film(size);
        const size_t pixels = film.number_of_pixels(), width = size_t(size.width);
        if (before > 0) add(film, before);
        CHECK(!film.has_sets());
        CHECK(film.sets_per_pixel() == 1);
        film.add_sets(of_all_kinds(pixels));
        CHECK(film.has_sets());
        CHECK(film.sets_per_pixel() == (before > 0 ? 1 : 2));  // until the others have caught up
        for (uint64_t n : {0, 2, 1}) add(film, n);
        CHECK(film.sets_per_pixel() == 2);  // (1 + 3 + 2 + 2) / 4
        const uint64_t n = before + 3;
        CHECK(film.samples() == n);
        const Image& image = film.image();
        for (size_t i = 0; i < pixels; ++i) {
            const uint32_t shown = of_four_pixels[i % 4].shown;
            CHECK(film.sets(i).count() == std::vector<uint32_t>{1, 3, 2, 2}[i % 4]);
            double sum = 0;
            for (uint32_t set = 0; set < film.sets(i).count(); ++set) {
                double of_set = 0;
                for (uint64_t k = 0; k < n; ++k)
                    of_set += double(numbered(int(i % width), int(i / width), k, set).x);
                CHECK(film.pixel(i, set).sum[0] == of_set);
                if (set < shown) sum += of_set / double(n);
            }
            CHECK(image.pixels[i][0] == float(sum / shown));
            CHECK(image.pixels[i][2] == float(shown - 1) / 2);
        }
    }
}

TEST_CASE("until the others have caught up, a pixel is its first set") {
    MeanFilm film({2, 2});
    add(film, 5);
    const Image one = film.image();
    film.add_sets(of_four_pixels);
    CHECK(!film.others_are_complete());
    CHECK(film.image().pixels == one.pixels);
    film.begin_pass(0);
    add_blocks(film, 0, 2, 0, numbered);  // and no more
    CHECK(film.image().pixels == one.pixels);
    add(film, 0);
    CHECK(film.others_are_complete());
    CHECK(film.image().pixels != one.pixels);
    CHECK(film.image().pixels[0] == one.pixels[0]);
}

TEST_CASE("one set each is the film without sets, bit for bit") {
    MeanFilm plain({2, 2}), one({2, 2});
    one.add_sets(std::vector<Sets>(4, {1, 0}));
    for (MeanFilm* film : {&plain, &one})
        for (uint64_t n : {1, 6, 4}) add(*film, n);
    CHECK(one.image().pixels == plain.image().pixels);
    CHECK(one.terms().norm2 == plain.terms().norm2);
}

TEST_CASE("of samples that do not fit the first by sample, then by set is told, with its set") {
    MeanFilm film({2, 1});
    film.add_sets({{3, 0}, {3, 0}});
    add_blocks(film, 0, 2, 4, [](int x, int, uint64_t i, uint32_t set) {
        const bool bad = i == 2 ? set > 0 && x == 2 - int(set) : i == 3 && set == 0;
        return rgb{bad ? real(NAN) : 1, 1, 1};
    });
    CHECK(film.non_finite() == 4);
    CHECK(film.first_non_finite().sample == 2);
    CHECK(film.first_non_finite().set == 1);
    CHECK(film.first_non_finite().x == 1);
}

// ---- Blocks, and passes that are cut short ------------------------------------------------------

TEST_CASE("a film keeps 24 bytes of a set of samples, and 8 of how many there are") {
    CHECK(sizeof(MeanPixel) == 24);
    CHECK(sizeof(Sets) == 8);
}

TEST_CASE("blocks are all pixels, each once; a row and a small picture have work for all threads") {
    for (Size size : {Size{1, 1}, Size{16384, 1}, Size{33, 17}, Size{2048, 1024}, Size{1, 509}}) {
        const Blocks blocks{size_t(size.width) * size_t(size.height)};
        CAPTURE(blocks.pixels);
        size_t next = 0;
        for (size_t b = 0; b < blocks.count(); ++b) {
            CHECK(blocks.begin(b) == next);
            CHECK(blocks.end(b) > next);
            CHECK(blocks.end(b) - next <= 256);
            next = blocks.end(b);
        }
        CHECK(next == blocks.pixels);
        CHECK(blocks.count() >= std::min<size_t>(blocks.pixels, 256));
    }
}

TEST_CASE("a pass takes each sample of each pixel once") {
    for (Size size : {Size{1, 1}, Size{2000, 1}, Size{33, 17}, Size{1, 509}}) {
        MeanFilm film(size);
        std::vector<int> taken(film.number_of_pixels());
        uint64_t out_of_order = 0;
        for (uint64_t n : {2, 3})
            whole_pass(film, n, [&](int x, int y, uint64_t i, uint32_t set) {
                int& of_pixel = taken[size_t(y) * size_t(size.width) + size_t(x)];
                out_of_order += i != uint64_t(of_pixel) || set != 0;
                ++of_pixel;
                return rgb{1, 1, 1};
            });
        CHECK(taken == std::vector<int>(taken.size(), 5));
        CHECK(out_of_order == 0);
    }
}

namespace {

// All that a film tells, to the bit.
std::vector<uint64_t> told(MeanFilm& film) {
    std::vector<uint64_t> bits = {film.samples(), film.others_are_complete()};
    for (const Pixel& pixel : film.image().pixels)
        for (float channel : pixel) bits.push_back(std::bit_cast<uint32_t>(channel));
    const ErrorTerms t = film.terms();
    for (double x : {t.sum[0], t.sum[1], t.sum[2], t.norm2, t.square[0], t.square[1], t.square[2],
                     t.terms2, t.greatest, film.sets_per_pixel()})
        bits.push_back(std::bit_cast<uint64_t>(x));
    bits.insert(bits.end(), {t.pixels, t.measured});
    return bits;
}

// How a pass may be cut short, in the middle of a pixel.
enum class Cut { by_signal, by_leaving, by_failure };

void cut_short(MeanFilm& film, uint64_t n, size_t blocks, Cut cut) {
    film.begin_pass(n);
    add_blocks(film, 0, blocks, n, numbered);
    uint64_t taken = 0;
    auto stopped = [&](int x, int y, uint64_t i, uint32_t set) {
        if (++taken == 8) {
            if (cut == Cut::by_failure) throw std::bad_alloc();
            interrupted = SIGINT;
            if (cut == Cut::by_leaving) throw Interrupted();
        }
        return numbered(x, y, i, set);
    };
    try {
        film.add_block(blocks, n, stopped);
    } catch (const Interrupted&) {
        CHECK(cut == Cut::by_leaving);
    } catch (const std::bad_alloc&) {
        CHECK(cut == Cut::by_failure);
    }
    interrupted = 0;
    REQUIRE(taken == 8);
}

// A film that goes on from what a file holds of another one.
std::unique_ptr<MeanFilm> gone_on(const MeanFilm& film, Shows shows) {
    FilmState<MeanPixel> state = film.state();
    state.others_of = {};
    if (!film.unfinished_pass()) state.image = {}, state.terms.assign(film.blocks(), {});
    auto next = std::make_unique<MeanFilm>(film.size, MeanPixel::Value{}, shows);
    next->restore([&] { return state; });
    return next;
}

}  // namespace

TEST_CASE("a pass that is cut short leaves image and error as they were; begun anew it goes on") {
    // Blocks of four pixels, the last of one.
    const Size size{1025, 1};
    struct Course {
        std::vector<uint64_t> before;  // passes, up to the sets if there are any
        int sets;                      // -1: none; 0: none of their samples; 1: a pass of them
        uint64_t n;                    // of the pass that is cut short
    };
    const std::vector<Course> courses = {{{}, -1, 4},    {{}, 0, 4},     {{2, 3}, -1, 4},
                                         {{2, 3}, 0, 0}, {{2, 3}, 0, 2}, {{2, 3}, 1, 4}};
    for (Shows shows : {Shows::values, Shows::variances})
        for (const Course& course : courses)
            for (Cut cut : {Cut::by_signal, Cut::by_leaving, Cut::by_failure}) {
                INFO("passes ", course.before.size(), ", sets ", course.sets, ", samples ",
                     course.n, ", cut ", int(cut));
                MeanFilm film(size, {}, shows), whole(size, {}, shows);
                for (MeanFilm* f : {&film, &whole}) {
                    REQUIRE(f->blocks() == 257);
                    for (uint64_t n : course.before) add(*f, n);
                    if (course.sets >= 0) f->add_sets(of_all_kinds(1025));
                    if (course.sets > 0) add(*f, 1);
                }
                CHECK(!film.unfinished_pass());
                // Of the other film: nobody has seen this one's image yet.
                const std::vector<uint64_t> before = told(whole);
                CHECK(told(*gone_on(film, shows)) == before);
                cut_short(film, course.n, 100, cut);
                CHECK(told(film) == before);
                CHECK(film.unfinished_pass() == course.n);
                cut_short(film, course.n, 200, cut);  // and once more
                CHECK(told(film) == before);
                const std::unique_ptr<MeanFilm> next = gone_on(film, shows);
                CHECK(told(*next) == before);
                // What blocks have they do not take again.
                for (MeanFilm* f : {&film, next.get()}) {
                    f->begin_pass(course.n);
                    add_blocks(*f, 0, 200, course.n, [](int, int, uint64_t, uint32_t) {
                        FAIL_CHECK("a sample that the film had");
                        return rgb{};
                    });
                    add_blocks(*f, 200, 257, course.n, numbered);
                    f->end_pass(course.n);
                    CHECK(!f->unfinished_pass());
                }
                add(whole, course.n);
                CHECK(told(film) == told(whole));
                CHECK(told(*next) == told(whole));
                CHECK(told(film) != before);
                for (MeanFilm* f : {&film, next.get(), &whole}) add(*f, 3);
                CHECK(told(film) == told(whole));
                CHECK(told(*next) == told(whole));
            }
}

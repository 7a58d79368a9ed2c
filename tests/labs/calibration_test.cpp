// labs/calibration_test.cpp  rules of stopping on errors made by hand, and what is said of them
#include "labs/calibration.h"

#include <doctest/doctest.h>

namespace {

// d_rel = d, of which squared one pixel has a tenth.
ImageError error(double d, double relative_spread = 0) {
    const double d2 = d * d;
    return {{}, {d2, d2, d2}, relative_spread * d2, 1, d2 / 10};
}

Look look(uint64_t samples, double truth, double estimate) {
    return {samples, 0, estimate * estimate, 0.1, truth * truth, 1};
}

// Of an error c n^-1/2: where it stops, after which looks.
std::vector<uint64_t> looks_of(const Guard& guard, double asked, double c) {
    Stopper s(guard, asked, 16);
    std::vector<uint64_t> looks;
    for (uint64_t n = 16; n < 1000000; ++n) {
        if (n != s.next()) {
            CHECK_FALSE(s.stops(error(0), n));  // not its turn
            continue;
        }
        looks.push_back(n);
        if (s.stops(error(c / std::sqrt(double(n))), n)) return looks;
    }
    return looks;
}

}  // namespace

TEST_CASE("a guard raises what it says") {
    const ImageError e = error(0.1, 0.2);
    CHECK(guarded({}, e).d2() == doctest::Approx(0.01).epsilon(1e-14));
    CHECK(guarded({}, e).spread == doctest::Approx(0.002).epsilon(1e-14));
    CHECK(guarded({"", 2 * margin_of_error}, e).spread == doctest::Approx(0.004).epsilon(1e-14));
    CHECK(guarded({"", 0, 3}, e).greatest == doctest::Approx(4 * 0.001).epsilon(1e-14).scale(0));
    CHECK(guarded({"", 0, 3}, e).spread == 0);
    // No pixel has a part of nothing.
    ImageError none{{}, {0, 0, 0}, 0, 1, NAN};
    CHECK(guarded({"", 0, 3}, none).d2() == 0);
}

TEST_CASE("a stopper looks when the rule of --error says, and stops at what was asked for") {
    // 0.4 / sqrt(n): 0.01 at 1600 samples; steps by the course are its, and at most doublings.
    Guard by_course;
    by_course.by_course = true, by_course.unseen = -1;
    CHECK(looks_of(by_course, 0.01, 0.4) ==
          std::vector<uint64_t>{16, 32, 64, 128, 256, 512, 1024, 1600});
    // Else those of renders, whatever is asked for.
    const Guard plain{"", margin_of_error, -1};
    const std::vector<uint64_t> looks = looks_of(plain, 0.01, 0.4);
    std::vector<uint64_t> of_renders = {16};
    while (of_renders.back() < 1600)
        of_renders.push_back(next_check(of_renders.back(), first_look, 1));
    CHECK(looks == of_renders);
    CHECK(looks.back() <= 1650);
    CHECK(looks_of(plain, 0.1, 0.4) == std::vector<uint64_t>{16});
    CHECK(looks_of({"", margin_of_error, -1, 50}, 0.1, 0.4) == std::vector<uint64_t>{16, 50});
    // The greatest pixel's tenth twice: 1.2 times the squared error.
    CHECK(looks_of({"", 0, 1}, 0.1, 0.4) == std::vector<uint64_t>{16, 17, 18, 19, 20});
    Stopper s({}, 0.1, 16);
    CHECK(s.stops(error(0.05), 16));
    CHECK(s.stopped());
    CHECK_FALSE(s.stops(error(0.05), 32));  // once
}

TEST_CASE("what runs did: median, quantile, share above 1.05, verdict") {
    Looks stops;
    for (int k = 0; k < 100; ++k) stops.push_back(look(40, 0.1 * (0.941 + 0.001 * k), 0.1));
    const Kept k = kept(stops, 0.1);
    CHECK(k.samples == 40);
    CHECK(k.median == doctest::Approx(0.9905).epsilon(1e-12));
    CHECK(k.high == doctest::Approx(0.941 + 0.001 * 99 * 0.95).epsilon(1e-12));
    CHECK(k.above == doctest::Approx(0.0).epsilon(1e-12));
    // Of equally spaced numbers: h sqrt(n (n + 1) / 12).
    CHECK(k.scatter == doctest::Approx(0.001 * std::sqrt(100 * 101 / 12.0) / 0.9905));
    CHECK(k.stated == doctest::Approx(0.1));
    CHECK(k.verdict() == "kept");
    CHECK(kept(stops, 0.0899).above == doctest::Approx(0.97).epsilon(1e-12));  // of 0.094395
    CHECK(kept(stops, 0.09).verdict() == "exceeded");
    CHECK(kept(stops, 0.105).verdict() == "too careful");
    for (Look& l : stops) l.samples = first_look;
    CHECK(kept(stops, 0.105).verdict() == "kept, at the least samples");
    CHECK(kept(stops, 0.09).verdict() == "exceeded");
    for (size_t i = 90; i < 100; ++i) stops[i].truth2 = 0.04;
    CHECK(kept(stops, 0.1).above == doctest::Approx(0.1).epsilon(1e-12));
    CHECK(kept(stops, 0.1).verdict() == "scatters");
}

TEST_CASE("the bias of an estimate is one of squares, and knows its error") {
    // Estimates^2 of 4 and 2 where the truth^2 is 1 and 3: 6 / 4; residuals 2.5 and -2.5.
    const Looks looks = {{1, 0, 4, 0, 1, 1}, {1, 0, 2, 0, 3, 1}};
    CHECK(bias_of(looks).ratio == doctest::Approx(1.5).epsilon(1e-14));
    CHECK(bias_of(looks).error == doctest::Approx(std::sqrt(2 * 2.5 * 2.5 * 2) / 4).epsilon(1e-14));
}

TEST_CASE("a truth that noise outweighs is no error, and no number that is none") {
    CHECK(Look{1, 0, 1, 0, -1e-9, 2}.true_d() == 0);
    CHECK(Look{1, 0, 1, 0, 9, 2}.true_d() == 1.5);
    CHECK(Look{1, 0, 1, 0, 9, 2}.estimated_d() == 0.5);
}

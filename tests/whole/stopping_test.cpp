// whole/stopping_test.cpp  --error stops at the requested error, for films of known truth
#include <cmath>

#include "film/error.h"
#include "film/fill.h"
#include "oracle/expect.h"
#include "path/sampler.h"
#include "whole/kept.h"
#include "whole/process.h"

namespace {

constexpr Size size = {48, 32};

// Noise of 1 to 1/8 from left to right, by an edge in every third row, smooth elsewhere.
rgb L(int x, int y, vec2 u) {
    const real v = y % 3 == 0 ? real(u.x + u.y < real(0.7)) : u.x * u.y;
    return rgb{1, 1, 1} + std::exp2(-real(x) / 16) * rgb{v, 2 * v, u.x};
}
rgb truth(int x, int y) {
    const real v = y % 3 == 0 ? real(0.245) : real(0.25);
    return rgb{1, 1, 1} + std::exp2(-real(x) / 16) * rgb{v, 2 * v, real(0.5)};
}

struct Stopped {
    double ratio;      // true d_rel / E
    uint64_t samples;  // per replication
};

// Follows the loop of renders with --error.
Stopped stop_of(SamplerKind kind, uint64_t seed, double asked) {
    const SamplerSettings settings = sampler_settings(kind, seed, 1);
    const SampleFunction sample = [&](const PixelSample& s, Tally&) {
        const uint64_t pixel = uint64_t(s.y) * uint64_t(size.width) + uint64_t(s.x);
        return L(s.x, s.y, Sampler(settings, pixel, s.i, s.replication).get2(0));
    };
    Film film = filled(size, 0, pilot_samples, sample);
    while (!is_small_enough(error_of(film), asked))
        fill(film, next_check(film.min_samples_done()), sample);
    Image expected(size.width, size.height);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (size_t c = 0; c < 3; ++c) expected.at(x, y)[c] = float(truth(x, y).*axis[c]);
    return {d_rel(expected, image_of(film)) / asked, film.min_samples_done()};
}

// Expects at most a part p of all runs to have a property that `count` of n runs had.
void expect_at_most(const std::string& what, int count, int n, double p) {
    constexpr double significance = 1e-6;
    int seen = 0;  // the least refused count
    while (oracle::p_at_least(seen, n, p) > significance) ++seen;
    double power = p;  // detected with 99.9 % power
    while (oracle::p_at_least(seen, n, power) < 0.999) power += 0.001;
    INFO(what, ": ", count, " of ", n, ", expected at most ", 100 * p, " %; from ", seen,
         " on refused, which finds ", 100 * power, " % with 99.9 % power");
    CHECK(count < seen);
    CHECK(power < 1);
}

}  // namespace

TEST_CASE("true d_rel / E at a stop: median in [0.95, 1], 95 % of runs below 1.05") {
    constexpr int runs = 80;
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::halton, SamplerKind::sobol}) {
        const double E = kind == SamplerKind::independent ? 0.02 : 0.002;
        CAPTURE(int(kind));
        int low = 0, high = 0, above = 0;
        for (uint64_t seed = 1; seed <= runs; ++seed) {
            const Stopped s = stop_of(kind, seed, E);
            REQUIRE(s.samples > pilot_samples);
            low += s.ratio<0.95, high += s.ratio> 1, above += s.ratio > 1.05;
        }
        expect_at_most("below 0.95", low, runs, 0.5);
        expect_at_most("above 1", high, runs, 0.5);
        expect_at_most("above 1.05", above, runs, 0.05);
    }
}

TEST_CASE("--error goes on while light may be missing, and says so after 4096 samples") {
    // One lamp lights the floor; a ball reflects another one, which no sample meets.
    const std::string seen =
        "camera 0 2 6  0 .7 0  40\ndepth 8\nmirror m .9 .9 .9\ndiffuse d .6 .6 .6\n"
        "light l 2e6 2e6 2e6\nlight k 5 5 5\nquad -5 0 -5  0 0 10  10 0 0  d\nsphere 0 1 0 1 m\n";
    const std::string lamp = "quad -1 6 -1 2 0 0 0 0 2 k\n";
    const Place spark(seen + "sphere 2 4 3 .0002 l\n" + lamp), known(seen + lamp);
    const std::string options = "--size 32x16 -o a.pfm --stats a.json --error 5%";
    const Outcome o = spark.render(options);
    INFO(o.err);
    CHECK(missing(o.err,
                  "did not reach 5 % (error not known: the light of line 9 ;"
                  "light not yet found may amount to ") == "");
    std::string stats = spark.read("a.json");
    for (const char* key : {"d_rel", "d_rel_standard_error"}) CHECK(stated(stats, key) == "null");
    CHECK(number_of(stats, "error") == 0.05);
    CHECK(stated(stats, "d_rel_reason").starts_with("\"the light of line 9 "));
    CHECK(stated(stats, "stopped_by") == "\"error not known\"");
    CHECK(number_of(stats, "samples_per_pixel") >= 4096);
    CHECK(number_of(stats, "samples_per_pixel") < 6000);
    // Without the small lamp the error is known early.
    CHECK(contains(known.render(options).err, ", reached 5 % ("));
    stats = known.read("a.json");
    CHECK(number_of(stats, "samples_per_pixel") < 1000);
    CHECK(stated(stats, "d_rel_reason") == "null");
}

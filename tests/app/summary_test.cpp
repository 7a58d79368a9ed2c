// app/summary_test.cpp  the statistics of a run
#include "app/summary.h"

#include <doctest/doctest.h>

TEST_CASE("the statistics are JSON: quoted, complete, null where nothing is known") {
    Options o;
    o.scene = "a \"b\"\\\n";
    RunStats run;
    run.spp = 64, run.seconds = 2, run.rays = 4000000;
    run.mean_radiance = {2, 2, 4};
    run.error.square = {2e-300, NAN, INFINITY};  // of two pixels
    const std::string text = encode_stats(o, {2, 1}, 5, run);
    for (const char* line :
         {R"("scene": "a \"b\"\\\u000a")", R"("mean_radiance": [2, 2, 4])",
          R"("variance_of_mean": [1e-300, null, null])", R"("rays": 4000000)",
          R"("mrays_per_second": 2,)", R"("samples_per_pixel": 64)", R"("sampler": "sobol")",
          R"("depth": 5)", R"("roulette": 0.250000)", R"("non_finite": 0)",
          R"("sets_per_pixel": 1,)", R"("d_rel": null)", R"("d_rel_standard_error": null)",
          R"("seconds_to_half_d_rel": null)", R"("bias": "unbiased")", R"("error": null)"}) {
        INFO(text);
        INFO(std::string(line));
        CHECK(text.find(line) != text.npos);
    }
}

TEST_CASE(
    "the statistics of maps: what they took; depth is none, for light is scattered without end") {
    RunStats run;
    CHECK(encode_stats({}, {2, 1}, 5, run).find("\"map_") == std::string::npos);
    MapStats maps;
    maps.H = 0.5, maps.triangles = 366, maps.particles = 4096, maps.rays = 9000;
    maps.error = 0.125, maps.seconds = 0.25, maps.slope = {1, 2, 4};
    run.maps = maps;
    const std::string text = encode_stats({}, {2, 1}, 5, run);
    for (const char* line :
         {R"("depth": null)", R"("map_mesh": 0.5)", R"("map_triangles": 366)",
          R"("map_particles": 4096)", R"("map_error": 0.125)", R"("map_seconds": 0.25)",
          R"("map_rays": 9000)", R"("map_slope": [1, 2, 4])", R"("indirect": "path")"}) {
        INFO(text);
        INFO(std::string(line));
        CHECK(text.find(line) != text.npos);
    }
    CHECK(summary(maps) == "maps: 366 triangles, 4096 particles, error 12.5 %, 0.25 s");
    maps.error = INFINITY;  // noise is all that there is
    CHECK(summary(maps) == "maps: 366 triangles, 4096 particles, 0.25 s");
}

// ---- The error in words -------------------------------------------------------------------------

namespace {

RunStats run_of(double d_rel, double standard_error) {
    RunStats run;
    run.spp = 64, run.seconds = 8, run.rays = 1, run.sets = 1.5;
    run.error.norm = 2;
    run.error.square.fill(std::pow(2 * d_rel, 2));
    run.error.spread = d_rel > 0 ? standard_error * 2 * run.error.d2() / d_rel : 0;
    run.stopped_by = "samples";
    return run;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

}  // namespace

TEST_CASE("an image's error in words: with its standard error, and what half of it would cost") {
    const Options o;
    CHECK(told_error(o, run_of(0.021, 0.0011)) == "d_rel 2.1 % ± 0.1 %; 1 % needs 35 s");
    RunStats run = run_of(0.021, 0.0011);
    run.exponent_of_cost = 1;
    CHECK(told_error(o, run) == "d_rel 2.1 % ± 0.1 %; 1 % needs 17 s");
    CHECK(told_error(o, run_of(0.2, 0.11)) == "d_rel 20 % ± 11 %; 10 % needs 32 s");
    CHECK(told_error(o, run_of(1.25, 0.4)) == "d_rel 125 % ± 40 %; 60 % needs 35 s");
    CHECK(told_error(o, run_of(0.00032, 0.00001)) == "d_rel 0.032 % ± 0.001 %; 0.02 % needs 20 s");
    run = run_of(0.02, 0.001), run.seconds = 1000;
    CHECK(told_error(o, run) == "d_rel 2 % ± 0.1 %; 1 % needs 4000 s");
    CHECK(told_error(o, run_of(0, 0)) == "d_rel 0 % ± 0 %");
    CHECK(one_digit(0.0149) == 0.01);
    CHECK(one_digit(0.00096) == doctest::Approx(0.001));
    // In JSON, in full; the variance of the mean of 20 pixels.
    const std::string text = encode_stats(o, {4, 5}, 5, run_of(0.02, 0.001));
    auto number = [&](const std::string& key) {
        const size_t at = text.find("\"" + key + "\": ");
        REQUIRE(at != text.npos);
        const char* value = text.c_str() + at + key.size() + 4;
        return doctest::Approx(std::strtod(value + (*value == '['), nullptr)).epsilon(1e-12);
    };
    CHECK(0.02 == number("d_rel"));
    CHECK(0.001 == number("d_rel_standard_error"));
    CHECK(32 == number("seconds_to_half_d_rel"));
    CHECK(1.5 == number("sets_per_pixel"));
    CHECK(std::pow(0.04, 2) / 20 == number("variance_of_mean"));
    CHECK(contains(text, "\"stopped_by\": \"samples\""));
}

TEST_CASE("what has a bias says so, and of which class") {
    const auto told = [](auto change) {
        Options o;
        change(o);
        return told_error(o, run_of(0.02, 0.001));
    };
    const auto bias = [](auto change) {
        Options o;
        change(o);
        const std::string stats = encode_stats(o, {1, 1}, 5, RunStats());
        CHECK(contains(stats, "\"bias\": \"" + std::string(bias_class(o)) + "\""));
        return std::string(bias_class(o));
    };
    for (Estimator e : {Estimator::stochastic, Estimator::control})
        CHECK(bias([&](Options& o) { o.direct = e; }) == "unbiased");
    for (Estimator e : {Estimator::ratio, Estimator::regression}) {
        CHECK(bias([&](Options& o) { o.direct = e; }) == "consistent");
        CHECK(contains(told([&](Options& o) { o.direct = e; }),
                       "± 0.1 % without its bias (consistent); 1 % needs "));
    }
    for (Weighting w : {Weighting::mc, Weighting::torus})
        CHECK(bias([&](Options& o) { o.film = w; }) == "unbiased");
    for (Weighting w : {Weighting::vor, Weighting::fvor, Weighting::cvor})
        CHECK(bias([&](Options& o) { o.film = w; }) == "consistent");
    for (Indirect i : {Indirect::path, Indirect::control, Indirect::regression})
        CHECK(bias([&](Options& o) { o.indirect = i; }) == "unbiased");
    CHECK(bias([](Options& o) { o.indirect = Indirect::map; }) == "biased");
    CHECK(contains(told([](Options& o) { o.indirect = Indirect::map; }), " bias (biased); "));
    CHECK(bias([](Options& o) { o.sampler = SamplerKind::halton_naive; }) == "biased");
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::stratified, SamplerKind::halton,
                             SamplerKind::sobol})
        CHECK(bias([&](Options& o) { o.sampler = kind; }) == "unbiased");
    CHECK(!contains(told([](Options&) {}), "bias"));
}

TEST_CASE("where there is no error to state, the reason is said") {
    const auto told = [](const Options& o, const RunStats& run) { return told_error(o, run); };
    Options o, naive, one_set;
    naive.sampler = SamplerKind::halton_naive;
    one_set.sets = 1;
    RunStats run;
    run.spp = 64;
    CHECK(told(naive, run) == "error not known: halton-naive is not random");
    CHECK(told(one_set, run) == "error not known: one set of samples");
    run.interrupted = true;
    CHECK(told(o, run) == "error not known: interrupted early");
    run.spp = 1;
    CHECK(told(o, run) == "error not known: one sample");
    run = run_of(0.02, 0.001), run.spp = 1, run.sets = 2;
    CHECK(contains(told(o, run), "d_rel 2 %"));  // two sets of one sample
    run = run_of(0.02, 0.001), run.error.norm = 0;
    CHECK(told(o, run) == "error not known: the image is black");
}

TEST_CASE("the line that stays: the error, what ended an image that asked for one, interrupts") {
    Options o;
    o.scene = "a.scene";
    RunStats run = run_of(0.02, 0.001);
    run.rays = 16000000;
    const std::string line =
        "a.scene: 64 samples per pixel, 8.00 s, 2.00 Mrays/s, 0 non-finite, d_rel 2 % ± 0.1 %; "
        "1 % needs 32 s";
    CHECK(summary(o, run) == line);
    o.error = 0.01;
    for (const char* by : {"samples", "time", "error"}) {
        run.stopped_by = by;
        CHECK(summary(o, run) == line + " (stopped by " + by + ")");
    }
    run.interrupted = true;
    CHECK(summary(o, run) == line + " (interrupted)");
    run = RunStats();
    run.seconds = 8, run.interrupted = true;
    CHECK(summary(o, run) ==
          "a.scene: 0 samples per pixel, 8.00 s, 0.00 Mrays/s, 0 non-finite (interrupted)");
}

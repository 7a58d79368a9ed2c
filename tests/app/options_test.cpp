// app/options_test.cpp  what words mean, and which are refused
#include "app/option_checks.h"

#include <doctest/doctest.h>

#include "app/report.h"

namespace {

Options parse(const std::vector<std::string>& words) {
    std::vector<std::string> all = words;
    all.push_back("a.scene");
    return parse_options(all);
}

std::string complaint(const std::vector<std::string>& words) {
    try {
        parse_options(words);
        return "";
    } catch (const UserError& e) {
        return e.what();
    }
}

}  // namespace

TEST_CASE("every option sets what it is named after") {
    const Options o = parse({"--spp",     "7",          "--time", "2.5",     "--depth",
                             "3",         "--roulette", "0.5",    "--seed",  "18446744073709551615",
                             "--threads", "5",          "--size", "30x20",   "--exposure",
                             "0.5",       "--stats",    "s.json", "--pixel", "6,8",
                             "--sample",  "9",          "-o",     "a.pfm",   "-o",
                             "b.png",     "--sets",     "3",      "--quiet", "--error",
                             "2.5%",      "--set",      "4"});
    CHECK(o.scene == "a.scene");
    CHECK(o.spp == 7);
    CHECK(o.seconds == 2.5);
    CHECK(o.depth == 3);
    CHECK(o.technique.roulette == real(0.5));
    CHECK(o.seed == UINT64_MAX);
    CHECK(o.threads == 5);
    CHECK(o.size->width == 30);
    CHECK(o.size->height == 20);
    CHECK(o.exposure == real(0.5));
    CHECK(o.stats == "s.json");
    CHECK(o.replay->x == 6);
    CHECK(o.replay->y == 8);
    CHECK(o.sample == 9);
    CHECK(o.outputs == std::vector<std::string>{"a.pfm", "b.png"});
    CHECK(o.sets == 3);
    CHECK(o.set == 4u);
    CHECK(o.error == 0.025);
    CHECK(o.quiet);
    CHECK(parse({"--help"}).help);
}

TEST_CASE("words of choices mean what they say") {
    const std::pair<const char*, SamplerKind> samplers[] = {
        {"independent", SamplerKind::independent},
        {"stratified", SamplerKind::stratified},
        {"halton", SamplerKind::halton},
        {"sobol", SamplerKind::sobol},
        {"halton-naive", SamplerKind::halton_naive}};
    for (const auto& [word, kind] : samplers) CHECK(parse({"--sampler", word}).sampler == kind);
    CHECK(parse({"--direction", "uniform"}).technique.direction == Direction::uniform);
    CHECK(parse({"--direction", "bsdf"}).technique.direction == Direction::bsdf);
    CHECK(parse({"--light", "none"}).technique.light == LightMode::none);
    CHECK(parse({"--light", "nee"}).technique.light == LightMode::nee);
    CHECK(parse({"--light", "mis"}).technique.light == LightMode::mis);
    const std::pair<const char*, View> views[] = {
        {"radiance", View::radiance}, {"normal", View::normal}, {"depth", View::depth},
        {"albedo", View::albedo},     {"bvh", View::bvh},       {"variance", View::variance}};
    for (const auto& [word, view] : views) CHECK(parse({"--view", word}).view == view);
}

TEST_CASE("without options: Sobol' samples, importance-sampled, MIS") {
    const Options o = parse({});
    CHECK(o.spp == 0);  // the scene's
    CHECK(o.seconds == 0);
    CHECK(o.sampler == SamplerKind::sobol);
    CHECK(o.technique.direction == Direction::bsdf);
    CHECK(o.technique.light == LightMode::mis);
    CHECK(o.technique.roulette == real(0.25));
    CHECK(o.seed == 0);
    CHECK(o.error == 0);
    CHECK(o.sets == sets_by_noise);
    CHECK(!o.depth);
    CHECK(o.outputs.empty());
}

TEST_CASE("sets of samples: by noise, as many as are asked for, two for their variance, one") {
    auto sets = [](const std::vector<std::string>& words) { return sets_of(parse(words)); };
    CHECK(sets({}) == sets_by_noise);
    CHECK(sets({"--sets", "3", "--sets", "noise"}) == sets_by_noise);
    CHECK(sets({"--view", "variance", "--sets", "noise"}) == 2);
    CHECK(sets({"--error", "1%"}) == sets_by_noise);
    CHECK(sets({"--view", "normal"}) == sets_by_noise);
    CHECK(sets({"--view", "variance"}) == 2);
    CHECK(sets({"--view", "variance", "--sets", "5"}) == 5);
    CHECK(sets({"--sets", "1"}) == 1);
    CHECK(sets({"--sets", "1024"}) == 1024);
    CHECK(sets({"--sampler", "halton-naive"}) == 1);
    CHECK(sets({"--sampler", "halton-naive", "--sets", "1"}) == 1);
}

TEST_CASE("the statistics repeat the error and the sets that were asked for") {
    auto stats = [](const std::vector<std::string>& words) {
        return asked_for(parse(words), option_table, {1, 1}).text();
    };
    CHECK(stats({}).find("\"error\": null") != std::string::npos);
    CHECK(stats({}).find("\"sets\": \"noise\"") != std::string::npos);
    CHECK(stats({"--error", "1e-7"}).find("\"error\": 1e-07,") != std::string::npos);
    CHECK(stats({"--error", "2.5%"}).find("\"error\": 0.025,") != std::string::npos);
    CHECK(stats({"--sets", "12"}).find("\"sets\": 12,") != std::string::npos);
}

TEST_CASE("what cannot be meant is refused, by its name") {
    CHECK(complaint({}) == "no scene given (try --help)");
    CHECK(complaint({"a", "b"}) == "two scenes: 'a' and 'b'");
    CHECK(complaint({"a", "--time", "0"}) == "--time: '0' is not positive");
    CHECK(complaint({"a", "--spp", "0"}).starts_with("--spp: '0' is not a whole number"));
    CHECK(complaint({"a", "--spp"}) == "--spp: needs a value");
    CHECK(complaint({"a", "--sample", "3"}) == "--sample: goes with --pixel X,Y");
    CHECK(complaint({"a", "--set", "3"}) == "--set: goes with --pixel X,Y");
    CHECK(complaint({"a", "--sets", "0"}).starts_with("--sets: '0' is not a whole number"));
    CHECK(complaint({"a", "--sets", "1025"}).starts_with("--sets: '1025' is not a whole number"));
    for (const char* none : {"0", "100%", "1", "-1%", "nan"})
        CHECK(complaint({"a", "--error", none}).starts_with("--error: '"));
    CHECK(complaint({"a", "--error", "1%", "--sets", "1"}) ==
          "--error: needs --sets 2 or more, or noise");
    CHECK(complaint({"a", "--error", "1%", "--sampler", "halton-naive"}) ==
          "--error: --sampler halton-naive is not random: its error is not known");
    CHECK(complaint({"a", "--view", "variance", "--sets", "1"}) ==
          "--view variance: needs --sets 2 or more, or noise");
    CHECK(complaint({"a", "--view", "variance", "--sampler", "halton-naive"}) ==
          "--view variance: --sampler halton-naive is not random: all sets of it are alike");
    CHECK(complaint({"a", "--sets", "2", "--sampler", "halton-naive"}) ==
          "--sets: --sampler halton-naive is not random: all sets of it are alike");
    CHECK(complaint({"a", "--light", "mix"}) ==
          "--light: unknown value 'mix' (did you mean 'mis'?)");
    CHECK(complaint({"a", "--sp", "3"}) == "unknown option '--sp' (did you mean '--spp'?)");
    CHECK(complaint({"-x"}) == "unknown option '-x'");
}

TEST_CASE("--film other than mc: independent samples, their number known") {
    auto parse = [](std::vector<std::string> words) {
        words.insert(words.end(), {"--sampler", "independent", "x.scene"});
        return parse_options(words);
    };
    CHECK(parse({}).film == Weighting::mc);
    CHECK(parse({"--film", "fvor"}).film == Weighting::fvor);
    CHECK(parse({"--film", "mc", "--time", "1"}).film == Weighting::mc);
    for (const char* film : {"vor", "fvor", "cvor", "torus"}) {
        CHECK_THROWS_AS(parse({"--film", film, "--time", "1"}), UserError);
        CHECK(parse({"--film", film, "--spp", "1048576"}).spp == 1048576);
        CHECK_THROWS_AS(parse({"--film", film, "--spp", "1048577"}), UserError);
        CHECK(parse({"--film", film, "--view", "variance", "--spp", "4"}).view == View::variance);
        CHECK_THROWS_AS(parse({"--film", film, "--error", "1%"}), UserError);
        CHECK_THROWS_AS(parse({"--film", film, "--error", "1%", "--spp", "9"}), UserError);
        CHECK_THROWS_AS(parse_options({"--film", film, "x.scene"}), UserError);
    }
    CHECK_THROWS_AS(parse({"--film", "voronoi"}), UserError);
}

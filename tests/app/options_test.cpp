// app/options_test.cpp  what words mean, and which are refused
#include "app/options.h"

#include <doctest/doctest.h>

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
                             "b.png",     "--halves",   "--quiet"});
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
    CHECK(o.halves);
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
    CHECK(!o.halves);
    CHECK(!o.depth);
    CHECK(o.outputs.empty());
    CHECK(parse({"--view", "variance"}).halves);
    CHECK(!parse({"--view", "normal"}).halves);
}

TEST_CASE("what cannot be meant is refused, by its name") {
    CHECK(complaint({}) == "no scene given (try --help)");
    CHECK(complaint({"a", "b"}) == "two scenes: 'a' and 'b'");
    CHECK(complaint({"a", "--time", "0"}) == "--time: '0' is not positive");
    CHECK(complaint({"a", "--spp", "0"}).starts_with("--spp: '0' is not a whole number"));
    CHECK(complaint({"a", "--spp"}) == "--spp: needs a value");
    CHECK(complaint({"a", "--sample", "3"}) == "--sample: goes with --pixel X,Y");
    CHECK(complaint({"a", "--light", "mix"}) ==
          "--light: unknown value 'mix' (did you mean 'mis'?)");
    CHECK(complaint({"a", "--sp", "3"}) == "unknown option '--sp' (did you mean '--spp'?)");
    CHECK(complaint({"-x"}) == "unknown option '-x'");
}

TEST_CASE("--film other than mc: independent samples, their number known, no variance") {
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
        CHECK_THROWS_AS(parse({"--film", film, "--view", "variance"}), UserError);
        CHECK_THROWS_AS(parse_options({"--film", film, "x.scene"}), UserError);
    }
    CHECK_THROWS_AS(parse({"--film", "voronoi"}), UserError);
}

// app/radiosity_options_test.cpp  what words mean to radiosity, and which are refused
#include "app/radiosity_options.h"

#include <doctest/doctest.h>

#include "app/help.h"

namespace {

RadiosityOptions parse(std::vector<std::string> words) {
    words.push_back("a.scene");
    return parse_radiosity(words);
}

std::string complaint(const std::vector<std::string>& words) {
    try {
        parse(words);
        return "";
    } catch (const UserError& e) {
        return e.what();
    }
}

std::string statistics(const RadiosityOptions& o, std::string_view name) {
    for (const auto& row : radiosity_table)
        if (row.name == name) return row.stats(o);
    return "no such option";
}

}  // namespace

TEST_CASE("radiosity: every option sets what it is named after") {
    const RadiosityOptions o =
        parse({"--method", "shooting", "--mesh",     "2.5",    "--unshot", "5%",          "--shots",
               "7",        "--time",   "1.5",        "--rays", "3",        "--threads",   "5",
               "--size",   "30x20",    "--exposure", "0.5",    "--view",   "illuminance", "--stats",
               "s.json",   "-o",       "a.pfm",      "-o",     "b.png",    "--quiet"});
    CHECK(o.scene == "a.scene");
    CHECK(o.method == Method::shooting);
    CHECK(o.mesh == 2.5);
    CHECK(o.unshot == 0.05);
    CHECK(o.shots == 7);
    CHECK(o.seconds == 1.5);
    CHECK(o.rays == 3);
    CHECK(o.threads == 5);
    CHECK(o.size->width == 30);
    CHECK(o.size->height == 20);
    CHECK(o.exposure == real(0.5));
    CHECK(o.view == MapView::illuminance);
    CHECK(o.stats == "s.json");
    CHECK(o.outputs == std::vector<std::string>{"a.pfm", "b.png"});
    CHECK(o.quiet);
    const RadiosityOptions p = parse({"--method", "particles", "--particles", "1099511627776",
                                      "--seed", "18446744073709551615", "--sampler", "stratified"});
    CHECK(p.method == Method::particles);
    CHECK(p.particles == uint64_t(1) << 40);
    CHECK(p.seed == UINT64_MAX);
    CHECK(p.sampler == SamplerKind::stratified);
    const std::pair<const char*, SamplerKind> samplers[] = {
        {"independent", SamplerKind::independent},
        {"halton", SamplerKind::halton},
        {"sobol", SamplerKind::sobol}};
    for (const auto& [word, kind] : samplers)
        CHECK(parse({"--method", "particles", "--sampler", word}).sampler == kind);
    CHECK(parse({"--method", "hierarchy"}).method == Method::hierarchy);
    CHECK(parse({"--view", "luminance"}).view == MapView::luminance);
    CHECK(parse({"--view", "mesh"}).view == MapView::mesh);
}

TEST_CASE("radiosity: a run ends by what was asked for, and by what is usual if nothing was") {
    CHECK(parse({}).method == Method::hierarchy);
    CHECK(!parse({}).mesh);
    CHECK(parse({}).unshot == 0.01);
    CHECK(parse({}).particles == 0);
    CHECK(parse({"--shots", "3"}).unshot == 0);
    CHECK(parse({"--time", "3"}).unshot == 0);
    CHECK(parse({"--time", "3", "--unshot", "1e-14"}).unshot == 1e-14);
    CHECK(parse({"--method", "particles"}).particles == 1000000);
    CHECK(parse({"--method", "particles"}).unshot == 0);
    CHECK(parse({"--method", "particles", "--time", "2"}).particles == 0);
    CHECK(parse({"--method", "particles", "--particles", "2", "--time", "2"}).particles == 2);
    CHECK(parse({}).error == 0);
    CHECK(parse({"--error", "5%"}).error == 0.05);
    CHECK(parse({"--error", "5e-2"}).error == 0.05);
    CHECK(parse({"--error", "5%"}).unshot == 0);
    CHECK(parse({"--error", "5%", "--unshot", "1%"}).unshot == 0.01);
    CHECK(parse({"--error", "5%", "--method", "particles"}).particles == 0);
    CHECK(parse({"--error", "5%", "--method", "particles", "--particles", "3"}).particles == 3);
}

TEST_CASE("radiosity: what says nothing to the method is refused, wherever it stands") {
    for (const char* method : {"shooting", "hierarchy"})
        for (const std::pair<const char*, const char*>& option :
             {std::pair{"--particles", "5"}, {"--sampler", "halton"}, {"--seed", "0"}}) {
            const std::string why = std::string(option.first) + ": needs --method particles";
            CHECK(complaint({option.first, option.second, "--method", method}) == why);
            CHECK(complaint({"--method", method, option.first, option.second}) == why);
            CHECK(complaint({"--method", "particles", option.first, option.second}) == "");
        }
    for (const std::pair<const char*, const char*>& option :
         {std::pair{"--unshot", "1%"}, {"--shots", "5"}}) {
        const std::string why =
            std::string(option.first) + ": needs --method shooting or hierarchy";
        CHECK(complaint({option.first, option.second, "--method", "particles"}) == why);
        CHECK(complaint({"--method", "particles", option.first, option.second}) == why);
        CHECK(complaint({"--method", "shooting", option.first, option.second}) == "");
        CHECK(complaint({"--method", "hierarchy", option.first, option.second}) == "");
    }
    CHECK(complaint({"--sampler", "halton-naive"}) == "--sampler: 'halton-naive' is biased");
    CHECK(complaint({"--sampler", "haltan"}) ==
          "--sampler: unknown value 'haltan' (did you mean 'halton'?)");
    CHECK(complaint({"--unshot", "0"}) == "--unshot: '0' is never reached");
    CHECK(complaint({"--unshot", "101%"}) == "--unshot: '101%' is more than 100 %");
    CHECK(complaint({"--unshot", "5"}) == "--unshot: '5' is more than 100 %; for percent say 5%");
    CHECK(complaint({"--error", "0"}) == "--error: '0' is never reached");
    CHECK(complaint({"--error", "0%"}) == "--error: '0%' is never reached");
    CHECK(complaint({"--error", "-1%"}) == "--error: '-1%' is negative");
    CHECK(complaint({"--error", "1"}) == "--error: '1' is the error of darkness, or more");
    CHECK(complaint({"--error", "200%"}) == "--error: '200%' is the error of darkness, or more");
    CHECK(complaint({"--error", "5"}) == "--error: '5' is more than 100 %; for percent say 5%");
    CHECK(complaint({"--error", "99.9%"}) == "");
    CHECK(complaint({"--error", "small"}) == "--error: 'small' is not a number");
    CHECK(complaint({"--mesh", "0"}) == "--mesh: '0' is not positive");
    CHECK(complaint({"--spp", "4"}).starts_with("unknown option '--spp'"));
    CHECK(complaint({"b.scene"}) == "two scenes: 'b.scene' and 'a.scene'");
    CHECK_THROWS_AS(parse_radiosity({}), UserError);
    CHECK(parse_radiosity({"--help"}).help);
}

TEST_CASE("radiosity: the statistics tell of what the method uses, and no more") {
    const RadiosityOptions shooting = parse({}), particles = parse({"--method", "particles"});
    CHECK(statistics(shooting, "--method") == "\"hierarchy\"");
    CHECK(statistics(shooting, "--sampler") == "null");
    CHECK(statistics(shooting, "--seed") == "null");
    CHECK(statistics(particles, "--sampler") == "\"halton\"");
    CHECK(statistics(particles, "--seed") == "0");
    CHECK(statistics(particles, "--view") == "\"luminance\"");
}

TEST_CASE("radiosity: every option is in --help") {
    const std::string page = "\n" + option_lines(radiosity_table);
    for (const auto& row : radiosity_table)
        CHECK(page.find("\n  " + std::string(row.name) + " " + std::string(row.value)) !=
              page.npos);
}

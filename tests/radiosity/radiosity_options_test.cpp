// radiosity/radiosity_options_test.cpp  what words mean to radiosity, and which are refused
#include "radiosity/options.h"

#include <doctest/doctest.h>

namespace {

struct Parsed {
    RadiosityOptions o;
    OptionTable table = radiosity_table(o);
    explicit Parsed(const std::vector<std::string>& words) { parse_radiosity(table, o, words); }
};

RadiosityOptions parse(std::vector<std::string> words) {
    words.push_back("a.scene");
    return Parsed(words).o;
}

std::string complaint(const std::vector<std::string>& words) {
    try {
        parse(words);
        return "";
    } catch (const UserError& e) {
        return e.what();
    }
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
    CHECK(o.exposure == 0.5);
    CHECK(o.shows == MapView::illuminance);
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
    CHECK(parse({"--view", "luminance"}).shows == MapView::luminance);
    CHECK(parse({"--view", "mesh"}).shows == MapView::mesh);
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
    CHECK(complaint({"--sampler", "haltan"}) ==
          "--sampler: unknown value 'haltan' (did you mean 'halton'?)");
    CHECK(complaint({"--unshot", "0"}) == "--unshot: '0' is not between 0 and 100 %");
    CHECK(complaint({"--unshot", "101%"}) == "--unshot: '101%' is not between 0 and 100 %");
    CHECK(complaint({"--unshot", "5"}) == "--unshot: '5' is more than 100 %; for percent say 5%");
    CHECK(complaint({"--error", "0"}) == "--error: '0' is not between 0 and 100 %");
    CHECK(complaint({"--error", "0%"}) == "--error: '0%' is not between 0 and 100 %");
    CHECK(complaint({"--error", "-1%"}) == "--error: '-1%' is negative");
    CHECK(complaint({"--error", "1"}) == "--error: '1' is not between 0 and 100 %");
    CHECK(complaint({"--error", "200%"}) == "--error: '200%' is not between 0 and 100 %");
    CHECK(complaint({"--error", "5"}) == "--error: '5' is more than 100 %; for percent say 5%");
    CHECK(complaint({"--error", "99.9%"}) == "");
    CHECK(complaint({"--error", "small"}) == "--error: 'small' is not a number");
    CHECK(complaint({"--mesh", "0"}) == "--mesh: '0' is not positive");
    CHECK(complaint({"b.scene"}) == "two scenes: 'b.scene' and 'a.scene'");
    CHECK_THROWS_AS(Parsed({}), UserError);
    CHECK(Parsed({"--help"}).o.help);
}

TEST_CASE("radiosity: with --final-gather paths have the options of penumbra, maps particles") {
    const RadiosityOptions o =
        parse({"--final-gather", "--spp", "12", "--sets", "4", "--error", "2%", "--time", "3",
               "--sampler", "stratified", "--direction", "uniform", "--light", "nee", "--seed", "5",
               "--particles", "70"});
    CHECK(o.final_gather);
    CHECK(o.method == Method::particles);
    CHECK(o.spp == 12);
    CHECK(o.sets == 4);
    CHECK(o.error == 0.02);
    CHECK(o.sampler == SamplerKind::stratified);
    CHECK(o.technique.direction == Direction::uniform);
    CHECK(o.technique.light == LightMode::nee);
    CHECK(o.technique.roulette == 0);
    CHECK(o.particles == 70);
    CHECK(parse({"--final-gather"}).sampler == SamplerKind::sobol);
    CHECK(parse({"--final-gather"}).particles == 0);
    CHECK(parse({"--final-gather", "--method", "particles"}).sets == 0);
    CHECK(complaint({"--final-gather", "--method", "hierarchy"}) ==
          "--final-gather: needs --method particles");
    CHECK(complaint({"--final-gather", "--shots", "3"}) ==
          "--shots: needs --method shooting or hierarchy");
    CHECK(complaint({"--final-gather", "--sets", "1", "--error", "1%"}) ==
          "--error: needs --sets 2 or more, or adaptive");
    for (const char* name : {"--rays", "--view"})
        CHECK(complaint({"--final-gather", name, std::string(name) == "--rays" ? "3" : "mesh"}) ==
              std::string(name) + ": goes without --final-gather");
    const std::pair<const char*, const char*> of_paths[] = {
        {"--spp", "4"}, {"--sets", "2"}, {"--direction", "bsdf"}, {"--light", "mis"}};
    for (const auto& [name, value] : of_paths)
        CHECK(complaint({name, value}) == std::string(name) + ": needs --final-gather");
}

TEST_CASE("radiosity: the statistics tell what was asked for; every option is in --help") {
    Parsed p({"a.scene", "--method", "particles"});
    CHECK(row(p.table, "--method").json() == "\"particles\"");
    CHECK(row(p.table, "--sampler").json() == "\"halton\"");
    CHECK(row(p.table, "--final-gather").json() == "false");
    const std::string page = "\n" + option_lines(p.table);
    for (const auto& r : p.table)
        CHECK(page.find("\n  " + std::string(r.name) + " " + std::string(r.value)) != page.npos);
}

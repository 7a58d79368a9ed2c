// radiosity/radiosity_options_test.cpp  the effects of options of radiosity, and refused ones
#include "radiosity/options.h"

#include <doctest/doctest.h>

#include "base/complaint.h"
#include "radiosity/solution.h"

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
    return ::complaint([&] { parse(words); });
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
                                      "--seed", "18446744073709551615"});
    CHECK(p.method == Method::particles);
    CHECK(p.particles == uint64_t(1) << 40);
    CHECK(p.seed == UINT64_MAX);
    for (const auto& [word, kind] : {std::pair{"independent", SamplerKind::independent},
                                     {"stratified", SamplerKind::stratified},
                                     {"halton", SamplerKind::halton},
                                     {"sobol", SamplerKind::sobol}})
        CHECK(parse({"--method", "particles", "--sampler", word}).sampler == kind);
    CHECK(parse({"--method", "hierarchy"}).method == Method::hierarchy);
    CHECK(parse({"--view", "luminance"}).shows == MapView::luminance);
    CHECK(parse({"--view", "mesh"}).shows == MapView::mesh);
}

TEST_CASE("radiosity: a run ends by what was asked for, and by what is usual if nothing was") {
    CHECK(parse({}).method == Method::hierarchy);
    CHECK(!parse({}).mesh);
    const struct {
        std::vector<std::string> words;
        double unshot, error;
        uint64_t particles;
    } rows[] = {{{}, 0.01, 0, 0},
                {{"--shots", "3"}, 0, 0, 0},
                {{"--time", "3"}, 0, 0, 0},
                {{"--time", "3", "--unshot", "1e-14"}, 1e-14, 0, 0},
                {{"--method", "particles"}, 0, 0, 1000000},
                {{"--method", "particles", "--time", "2"}, 0, 0, 0},
                {{"--method", "particles", "--particles", "2", "--time", "2"}, 0, 0, 2},
                {{"--error", "5%"}, 0, 0.05, 0},
                {{"--error", "5e-2"}, 0, 0.05, 0},
                {{"--error", "5%", "--unshot", "1%"}, 0.01, 0.05, 0},
                {{"--error", "5%", "--method", "particles"}, 0, 0.05, 0},
                {{"--error", "5%", "--method", "particles", "--particles", "3"}, 0, 0.05, 3}};
    for (const auto& row : rows) {
        const RadiosityOptions o = parse(row.words);
        CAPTURE(&row - rows);
        CHECK(o.unshot == row.unshot);
        CHECK(o.error == row.error);
        CHECK(o.particles == row.particles);
    }
}

TEST_CASE("radiosity: an estimated error ends a run only if its uncertainty leaves no doubt") {
    RadiosityOptions o = parse({"--method", "particles", "--error", "10%", "--particles", "50"});
    Solution s;
    s.particles = 50;
    s.stated = {0.09, 0.01};
    CHECK(stopped_by(o, s) == "--particles");
    s.stated = {0.08, 0.01};
    CHECK(stopped_by(o, s) == "--error");
}

TEST_CASE("radiosity: what says nothing to the method is refused, wherever it stands") {
    const std::string of_walks = ": needs --method particles",
                      of_shots = ": needs --method shooting or hierarchy";
    for (const auto& [name, value, why] : {std::tuple{"--particles", "5", of_walks},
                                           {"--sampler", "halton", of_walks},
                                           {"--seed", "0", of_walks},
                                           {"--unshot", "1%", of_shots},
                                           {"--shots", "5", of_shots}})
        for (const char* method : {"shooting", "hierarchy", "particles"}) {
            const bool goes = (why == of_walks) == (method == std::string("particles"));
            const std::string expected = goes ? "" : name + why;
            CHECK(complaint({name, value, "--method", method}) == expected);
            CHECK(complaint({"--method", method, name, value}) == expected);
        }
    const std::pair<std::vector<std::string>, const char*> rows[] = {
        {{"--sampler", "haltan"}, "--sampler: unknown value 'haltan' (did you mean 'halton'?)"},
        {{"--unshot", "0"}, "--unshot: '0' is not between 0 and 100 %"},
        {{"--unshot", "101%"}, "--unshot: '101%' is not between 0 and 100 %"},
        {{"--unshot", "5"}, "--unshot: '5' is more than 100 %; for percent say 5%"},
        {{"--error", "0"}, "--error: '0' is not between 0 and 100 %"},
        {{"--error", "0%"}, "--error: '0%' is not between 0 and 100 %"},
        {{"--error", "-1%"}, "--error: '-1%' is negative"},
        {{"--error", "1"}, "--error: '1' is not between 0 and 100 %"},
        {{"--error", "200%"}, "--error: '200%' is not between 0 and 100 %"},
        {{"--error", "5"}, "--error: '5' is more than 100 %; for percent say 5%"},
        {{"--error", "99.9%"}, ""},
        {{"--error", "small"}, "--error: 'small' is not a number"},
        {{"--mesh", "0"}, "--mesh: '0' is not positive"},
        {{"b.scene"}, "two scenes: 'b.scene' and 'a.scene'"}};
    for (const auto& [words, why] : rows) CHECK(complaint(words) == why);
    CHECK_THROWS_AS(Parsed({}), UserError);
    CHECK(Parsed({"--help"}).o.help);
}

TEST_CASE("radiosity: with --final-gather paths have the options of penumbra, maps particles") {
    const RadiosityOptions o =
        parse({"--final-gather", "--spp", "12", "--replications", "4", "--error", "2%", "--time",
               "3", "--sampler", "stratified", "--direction", "uniform", "--light", "nee", "--seed",
               "5", "--particles", "70"});
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
    const std::pair<std::vector<std::string>, const char*> rows[] = {
        {{"--final-gather", "--method", "hierarchy"}, "--final-gather: needs --method particles"},
        {{"--final-gather", "--shots", "3"}, "--shots: needs --method shooting or hierarchy"},
        {{"--final-gather", "--replications", "1", "--error", "1%"},
         "--error: needs --replications 2 or more, or adaptive"},
        {{"--final-gather", "--rays", "3"}, "--rays: cannot be combined with --final-gather"},
        {{"--final-gather", "--view", "mesh"}, "--view: cannot be combined with --final-gather"},
        {{"--spp", "4"}, "--spp: needs --final-gather"},
        {{"--replications", "2"}, "--replications: needs --final-gather"},
        {{"--direction", "bsdf"}, "--direction: needs --final-gather"},
        {{"--light", "mis"}, "--light: needs --final-gather"}};
    for (const auto& [words, why] : rows) CHECK(complaint(words) == why);
}

TEST_CASE("radiosity: the statistics tell what was asked for; every option is in --help") {
    Parsed p({"a.scene", "--method", "particles"});
    CHECK(row(p.table, "--method").json() == "\"particles\"");
    CHECK(row(p.table, "--sampler").json() == "\"halton\"");
    CHECK(row(p.table, "--final-gather").json() == "false");
    const std::string page = "\n" + option_lines(p.table);
    for (const auto& r : p.table) CHECK(page.find("\n  " + usage_of(r)) != page.npos);
}

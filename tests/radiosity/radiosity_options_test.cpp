// radiosity/radiosity_options_test.cpp  the effects of options of radiosity, and refused ones
#include "radiosity/options.h"

#include <doctest/doctest.h>

#include "base/cases.h"
#include "radiosity/solution.h"
#include "text/complaint.h"

namespace {

struct Parsed {
    RadiosityOptions o;
    OptionTable table = radiosity_table(o);
    explicit Parsed(const std::string& line) { parse_radiosity(table, o, split(line)); }
};

RadiosityOptions parse(const std::string& line) { return Parsed(line + " a.scene").o; }

std::string complaint(const std::string& line) {
    return ::complaint([&] { parse(line); });
}

}  // namespace

TEST_CASE("radiosity: every option sets what it is named after") {
    const RadiosityOptions o = parse(
        "--method shooting --mesh 2.5 --unshot 5% --shots 7 --time 1.5 --rays 3 --threads 5 --size "
        "30x20 --exposure 0.5 --view illuminance --stats s.json -o a.pfm -o b.png --quiet");
    CHECK(said(o.scene, o.method, *o.mesh, o.unshot, o.shots, o.seconds, o.rays, o.threads) ==
          said("a.scene", Method::shooting, 2.5, 0.05, 7, 1.5, 3, 5));
    CHECK(said(o.size->width, o.size->height, *o.exposure, o.shows, o.stats, o.quiet) ==
          said(30, 20, 0.5, MapView::illuminance, "s.json", true));
    CHECK(o.outputs == std::vector<std::string>{"a.pfm", "b.png"});
    const RadiosityOptions p =
        parse("--method particles --particles 1099511627776 --seed 18446744073709551615");
    CHECK(said(p.method, p.particles, p.seed) ==
          said(Method::particles, uint64_t(1) << 40, UINT64_MAX));
    for (const auto& [word, kind] : {std::pair{"independent", SamplerKind::independent},
                                     {"stratified", SamplerKind::stratified},
                                     {"halton", SamplerKind::halton},
                                     {"sobol", SamplerKind::sobol}})
        CHECK(parse(with("--method particles --sampler @", word)).sampler == kind);
    CHECK(parse("--method hierarchy").method == Method::hierarchy);
    CHECK(parse("--view luminance").shows == MapView::luminance);
    CHECK(parse("--view mesh").shows == MapView::mesh);
}

TEST_CASE("radiosity: a run ends by what was asked for, and by what is usual if nothing was") {
    CHECK(parse("").method == Method::hierarchy);
    CHECK(!parse("").mesh);
    const struct {
        const char* words;
        double unshot, error;
        uint64_t particles;
    } rows[] = {{"", 0.01, 0, 0},
                {"--shots 3", 0, 0, 0},
                {"--time 3", 0, 0, 0},
                {"--time 3 --unshot 1e-14", 1e-14, 0, 0},
                {"--method particles", 0, 0, 1000000},
                {"--method particles --time 2", 0, 0, 0},
                {"--method particles --particles 2 --time 2", 0, 0, 2},
                {"--error 5%", 0, 0.05, 0},
                {"--error 5e-2", 0, 0.05, 0},
                {"--error 5% --unshot 1%", 0.01, 0.05, 0},
                {"--error 5% --method particles", 0, 0.05, 0},
                {"--error 5% --method particles --particles 3", 0, 0.05, 3}};
    for (const auto& row : rows) {
        const RadiosityOptions o = parse(row.words);
        CAPTURE(row.words);
        CHECK(said(o.unshot, o.error, o.particles) == said(row.unshot, row.error, row.particles));
    }
}

TEST_CASE("radiosity: an estimated error ends a run only if its uncertainty leaves no doubt") {
    const RadiosityOptions o = parse("--method particles --error 10% --particles 50");
    Solution s;
    s.particles = 50;
    s.stated = {0.09, 0.01};
    CHECK(stopped_by(o, s) == "--particles");
    s.stated = {0.08, 0.01};
    CHECK(stopped_by(o, s) == "--error");
}

TEST_CASE("radiosity: what says nothing to the method is refused, wherever it stands") {
    for (const auto& [option, of_walks] : {std::pair<std::string, bool>{"--particles 5", true},
                                           {"--sampler halton", true},
                                           {"--seed 0", true},
                                           {"--unshot 1%", false},
                                           {"--shots 5", false}})
        for (const std::string method : {"shooting", "hierarchy", "particles"}) {
            const std::string needs = of_walks ? "particles" : "shooting or hierarchy";
            const bool goes = of_walks == (method == "particles");
            const std::string why = goes ? "" : split(option)[0] + ": needs --method " + needs;
            CHECK(complaint(option + " --method " + method) == why);
            CHECK(complaint("--method " + method + " " + option) == why);
        }
    const Refusal rows[] = {
        {"--sampler haltan", "--sampler: unknown value 'haltan' (did you mean 'halton'?)"},
        {"--unshot 0", "--unshot: '0' is not between 0 and 100 %"},
        {"--unshot 101%", "--unshot: '101%' is not between 0 and 100 %"},
        {"--unshot 5", "--unshot: '5' is more than 100 %; for percent say 5%"},
        {"--error 0", "--error: '0' is not between 0 and 100 %"},
        {"--error 0%", "--error: '0%' is not between 0 and 100 %"},
        {"--error -1%", "--error: '-1%' is negative"},
        {"--error 1", "--error: '1' is not between 0 and 100 %"},
        {"--error 200%", "--error: '200%' is not between 0 and 100 %"},
        {"--error 5", "--error: '5' is more than 100 %; for percent say 5%"},
        {"--error 99.9%", ""},
        {"--error small", "--error: 'small' is not a number"},
        {"--mesh 0", "--mesh: '0' is not positive"},
        {"b.scene", "two scenes: 'b.scene' and 'a.scene'"}};
    for (const auto& [words, why] : rows) CHECK(complaint(words) == why);
    CHECK_THROWS_AS(Parsed(""), UserError);
    CHECK(Parsed("--help").o.help);
}

TEST_CASE("radiosity: with --final-gather paths have the options of penumbra, maps particles") {
    const RadiosityOptions o = parse(
        "--final-gather --spp 12 --replications 4 --error 2% --time 3 --sampler stratified "
        "--direction uniform --light nee --seed 5 --particles 70");
    CHECK(said(o.final_gather, o.method, o.spp, o.replications, o.error, o.sampler, o.particles) ==
          said(true, Method::particles, 12, 4, 0.02, SamplerKind::stratified, 70));
    CHECK(said(o.technique.direction, o.technique.light, o.technique.roulette) ==
          said(Direction::uniform, LightMode::nee, 0));
    CHECK(parse("--final-gather").sampler == SamplerKind::sobol);
    CHECK(parse("--final-gather").particles == 0);
    CHECK(parse("--final-gather --method particles").replications == 0);
    const Refusal rows[] = {
        {"--final-gather --method hierarchy", "--final-gather: needs --method particles"},
        {"--final-gather --shots 3", "--shots: needs --method shooting or hierarchy"},
        {"--final-gather --replications 1 --error 1%",
         "--error: needs --replications 2 or more, or adaptive"},
        {"--final-gather --rays 3", "--rays: cannot be combined with --final-gather"},
        {"--final-gather --view mesh", "--view: cannot be combined with --final-gather"},
        {"--spp 4", "--spp: needs --final-gather"},
        {"--replications 2", "--replications: needs --final-gather"},
        {"--direction bsdf", "--direction: needs --final-gather"},
        {"--light mis", "--light: needs --final-gather"}};
    for (const auto& [words, why] : rows) CHECK(complaint(words) == why);
}

TEST_CASE("radiosity: the statistics tell what was asked for; every option is in --help") {
    Parsed p("a.scene --method particles");
    CHECK(row(p.table, "--method").json() == "\"particles\"");
    CHECK(row(p.table, "--sampler").json() == "\"halton\"");
    CHECK(row(p.table, "--final-gather").json() == "false");
    const std::string page = "\n" + option_lines(p.table);
    for (const auto& r : p.table) CHECK(page.find("\n  " + usage_of(r)) != page.npos);
}

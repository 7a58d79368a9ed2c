// app/options_test.cpp  what words mean, which are refused, and what --help and --stats say of them
#include "app/options.h"

#include <doctest/doctest.h>

namespace {

struct Parsed {
    Options o;
    OptionTable table = option_table(o);

    explicit Parsed(const std::vector<std::string>& words) { parse_options(table, o, words); }
};

Options parse(std::vector<std::string> words) {
    words.push_back("a.scene");
    return Parsed(words).o;
}

std::string complaint(const std::vector<std::string>& words) {
    try {
        const Parsed parsed(words);
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
                             "--sample",  "9,4",        "-o",     "a.pfm",   "-o",
                             "b.png",     "--sets",     "3",      "--quiet", "--error",
                             "2.5%"});
    CHECK(o.scene == "a.scene");
    CHECK(o.spp == 7);
    CHECK(o.seconds == 2.5);
    CHECK(o.depth == 3);
    CHECK(o.technique.roulette == real(0.5));
    CHECK(o.seed == UINT64_MAX);
    CHECK(o.threads == 5);
    CHECK(o.size->width == 30);
    CHECK(o.size->height == 20);
    CHECK(o.exposure == 0.5);
    CHECK(o.stats == "s.json");
    CHECK(o.replay->x == 6);
    CHECK(o.replay->y == 8);
    CHECK(o.replay->i == 9);
    CHECK(o.replay->set == 4);
    CHECK(o.outputs == std::vector<std::string>{"a.pfm", "b.png"});
    CHECK(o.sets == 3);
    CHECK(o.error == 0.025);
    CHECK(o.quiet);
    CHECK(!o.help);
    CHECK(Parsed({"--help"}).o.help);
    CHECK(Parsed({"-h"}).o.help);
    const Options band =
        parse({"--rows", "3-17", "--keep", "a.film", "--sets", "4", "--sets", "adaptive"});
    CHECK(band.keep == "a.film");
    CHECK(band.rows->first == 3);
    CHECK(band.rows->last == 17);
    CHECK(band.rows->count() == 15);
    CHECK(band.sets == 0);
    CHECK(parse({"--sample", "9", "--pixel", "6,8"}).replay->i == 9);
    CHECK(parse({"--sample", "9", "--pixel", "6,8"}).replay->set == 0);
    CHECK(parse({"--pixel", "6,8"}).replay->i == 0);
}

TEST_CASE("words of choices mean what they say") {
    const std::pair<const char*, SamplerKind> samplers[] = {
        {"independent", SamplerKind::independent},
        {"stratified", SamplerKind::stratified},
        {"halton", SamplerKind::halton},
        {"sobol", SamplerKind::sobol}};
    for (const auto& [word, kind] : samplers) CHECK(parse({"--sampler", word}).sampler == kind);
    CHECK(parse({"--direction", "uniform"}).technique.direction == Direction::uniform);
    CHECK(parse({"--direction", "bsdf"}).technique.direction == Direction::bsdf);
    CHECK(parse({"--light", "none"}).technique.light == LightMode::none);
    CHECK(parse({"--light", "nee"}).technique.light == LightMode::nee);
    CHECK(parse({"--light", "mis"}).technique.light == LightMode::mis);
    const std::pair<const char*, View> views[] = {{"radiance", View::radiance},
                                                  {"normal", View::normal},
                                                  {"depth", View::depth},
                                                  {"albedo", View::albedo},
                                                  {"bvh", View::bvh}};
    for (const auto& [word, view] : views) CHECK(parse({"--view", word}).view == view);
}

TEST_CASE("without options: Sobol' samples, importance-sampled, MIS, adaptive") {
    const Options o = parse({});
    CHECK(o.spp == 0);  // the scene's
    CHECK(o.seconds == 0);
    CHECK(o.error == 0);
    CHECK(o.sampler == SamplerKind::sobol);
    CHECK(o.technique.direction == Direction::bsdf);
    CHECK(o.technique.light == LightMode::mis);
    CHECK(o.technique.roulette == real(0.25));
    CHECK(o.seed == 0);
    CHECK(o.sets == 0);
    CHECK(o.view == View::radiance);
    CHECK(o.threads >= 1);
    CHECK(!o.depth);
    CHECK(!o.size);
    CHECK(!o.exposure);
    CHECK(!o.rows);
    CHECK(!o.replay);
    CHECK(o.keep.empty());
    CHECK(o.outputs.empty());
}

TEST_CASE("--spp is of all replications together, rounded up; two of them if they are chosen") {
    auto each = [](const std::vector<std::string>& words, uint64_t N) {
        return samples_each(parse(words), N);
    };
    CHECK(each({}, 64) == 32);
    CHECK(each({}, 7) == 4);
    CHECK(each({}, 1) == 1);
    CHECK(each({}, 0) == 0);  // not known
    CHECK(each({"--sets", "1"}, 7) == 7);
    CHECK(each({"--sets", "3"}, 7) == 3);
    CHECK(each({"--sets", "1024"}, 7) == 1);
}

TEST_CASE("a word that cannot be meant is refused, by its name") {
    const std::pair<std::vector<std::string>, std::string> rows[] = {
        {{}, "no scene given (try --help)"},
        {{""}, "the scene's name is empty"},
        {{"a", "b"}, "two scenes: 'a' and 'b'"},
        {{"a", "--time", "0"}, "--time: '0' is not positive"},
        {{"a", "--spp", "0"}, "--spp: '0' is not a whole number"},
        {{"a", "--spp", "1099511627777"}, "--spp: '1099511627777' is not a whole number"},
        {{"a", "--spp"}, "--spp: needs a value"},
        {{"a", "--sets", "0"}, "--sets: '0' is not a whole number"},
        {{"a", "--sets", "1025"}, "--sets: '1025' is not a whole number"},
        {{"a", "--depth", "1000001"}, "--depth: '1000001' is not a whole number"},
        {{"a", "--threads", "1025"}, "--threads: '1025' is not a whole number"},
        {{"a", "--rows", "7-6"}, "--rows: '7-6' ends before it begins"},
        {{"a", "--rows", "7"}, "--rows: '7' is not FIRST-LAST"},
        {{"a", "--rows", "7-"}, "--rows: '' is not a whole number"},
        {{"a", "--keep", "a.pfm"}, "--keep: 'a.pfm' does not end in .film"},
        {{"a", "-o", "a.jpg"}, "-o: 'a.jpg' ends neither in .png nor in .pfm"},
        {{"a", "--size", "7"}, "--size: '7' is not WIDTHxHEIGHT"},
        {{"a", "--pixel", "7"}, "--pixel: '7' is not X,Y"},
        {{"a", "--pixel", "7,8,9"}, "--pixel: '8,9' is not a whole number"},
        {{"a", "--pixel", "7,8", "--sample", "1,2,3"}, "--sample: '2,3' is not a whole number"},
        {{"a", "--pixel", "7,8", "--sample", "1,"}, "--sample: '' is not a whole number"},
        {{"a", "--pixel", "7,8", "--sample", "1,1025"}, "--sample: '1025' is not a whole number"},
        {{"a", "--light", "mix"}, "--light: unknown value 'mix' (did you mean 'mis'?)"},
        {{"a", "--light", "none|nee"}, "--light: unknown value 'none|nee'"},
        {{"a", "--sp", "3"}, "unknown option '--sp' (did you mean '--spp'?)"},
        {{"-x"}, "unknown option '-x' (did you mean '-o'?)"},
        // Combinations.
        {{"a", "--sample", "3"}, "--sample: goes with --pixel X,Y"},
        {{"a", "--pixel", "1,2", "--keep", "a.film"}, "--keep: goes without --pixel"},
        {{"a", "--error", "1%", "--sets", "1"}, "--error: needs --sets 2 or more, or adaptive"},
        {{"a", "--rows", "1-2"}, "--rows: needs --keep F.film, which build/merge takes, or -o"}};
    for (const auto& row : rows) {
        const std::string told = complaint(row.first);
        INFO(row.second);
        INFO(told);
        CHECK(told.starts_with(row.second));
    }
    for (const char* none : {"0", "100%", "1", "-1%", "nan"})
        CHECK(complaint({"a", "--error", none}).starts_with("--error: '"));
    for (const std::vector<std::string>& fine : std::vector<std::vector<std::string>>{
             {"a", "--error", "99%", "--sets", "2"},
             {"a", "--error", "1%", "--spp", "9", "--time", "3"},
             {"a", "--rows", "0-0", "-o", "a.pfm"},
             {"a", "--rows", "1-2", "--keep", "a.film"},
             {"a", "--spp", "1099511627776", "--sets", "1024", "--depth", "1000000"},
             {"a", "--sample", "1099511627776,1024", "--pixel", "0,0"}})
        CHECK(complaint(fine) == "");
}

TEST_CASE("after -- there are no options") {
    Options o;
    OptionTable table = option_table(o);
    parse_options(table, o, {"--spp", "2", "--", "--spp"});
    CHECK(o.spp == 2);
    CHECK(o.scene == "--spp");
    CHECK(complaint({"--", "-h", "a.scene"}).find("two scenes") != std::string::npos);
}

TEST_CASE("the statistics begin with what was asked for, one by one") {
    auto stats = [](std::vector<std::string> words) {
        words.push_back("a \"b\"\\");
        return asked_for(Parsed(words).table, words.back(), {9, 5}).text();
    };
    CHECK(stats({"--threads", "3"}) == R"({
  "scene": "a \"b\"\\",
  "width": 9,
  "height": 5,
  "error": null,
  "sets": "adaptive",
  "sampler": "sobol",
  "direction": "bsdf",
  "light": "mis",
  "roulette": 0.25,
  "view": "radiance",
  "rows": null,
  "seed": 0,
  "threads": 3
}
)");
    CHECK(stats({"--threads",   "5",
                 "--error",     "12.5%",
                 "--sets",      "12",
                 "--sampler",   "halton",
                 "--direction", "uniform",
                 "--light",     "nee",
                 "--roulette",  "0.5",
                 "--view",      "bvh",
                 "--rows",      "4-7",
                 "-o",          "a.pfm",
                 "--seed",      "18446744073709551615"}) == R"({
  "scene": "a \"b\"\\",
  "width": 9,
  "height": 5,
  "error": 0.125,
  "sets": 12,
  "sampler": "halton",
  "direction": "uniform",
  "light": "nee",
  "roulette": 0.5,
  "view": "bvh",
  "rows": "4-7",
  "seed": 18446744073709551615,
  "threads": 5
}
)");
}

TEST_CASE("every option is in --help, with its value and its default, in lines that fit a screen") {
    Parsed all({"--help"});
    const std::string page = "\n" + option_lines(all.table);
    CHECK(all.table.size() == 22);
    for (const Option& r : all.table) {
        const std::string name(r.name), value(r.value);
        INFO(name);
        const size_t at = page.find("\n  " + name + " " + value + (value.empty() ? " " : ""));
        REQUIRE(at != page.npos);
        // Its words, whatever lines they stand on.
        std::istringstream lines(page.substr(at + 4 + name.size() + value.size()));
        std::string words = std::string(r.help);
        if (!r.otherwise.empty()) words += " (default: " + r.otherwise + ")";
        std::istringstream wanted(words);
        for (std::string a, b; wanted >> b;) {
            lines >> a;
            CHECK(a == b);
        }
    }
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        CHECK(line.size() < 80);
        CHECK(!line.ends_with(' '));
    }
}

TEST_CASE("a table without some of its rows has the others in order") {
    Options o;
    const OptionTable some = without(option_table(o), {"--rows", "-o"});
    CHECK(some.size() == 20);
    CHECK(some.front().name == "--spp");
    CHECK(std::none_of(some.begin(), some.end(), [](auto& r) { return r.name == "--rows"; }));
    OptionTable table = option_table(o);
    CHECK(row(table, "--seed").name == "--seed");
    CHECK(!is_given(table, "--seed"));
    parse_words(table, {"--seed", "7", "x"}, o);
    CHECK(is_given(table, "--seed"));
    CHECK(!is_given(table, "--spp"));
}

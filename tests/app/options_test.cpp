// app/options_test.cpp  effects of options, refused options, their text in --help and --stats
#include "app/options.h"

#include <doctest/doctest.h>

#include "app/refused_words.h"
#include "text/complaint.h"

namespace {

struct Parsed {
    Options o;
    OptionTable table = option_table(o);

    explicit Parsed(const std::vector<std::string>& words) { parse_options(table, o, words); }
};

Options parse(const std::string& line) { return Parsed(split(line + " a.scene")).o; }

std::string complaint_of(const std::string& line) {
    return complaint([&] { Parsed(split(line)); });
}

}  // namespace

TEST_CASE("every option sets what it is named after") {
    const Options o = parse(
        "--spp 7 --time 2.5 --depth 3 --roulette 0.5 --seed 18446744073709551615 --threads 5 "
        "--size 30x20 --exposure 0.25 --stats s.json --pixel 6,8 --sample 9,4 -o a.pfm -o b.png "
        "--replications 3 --quiet --error 2.5%");
    CHECK(said(o.scene, o.spp, o.seconds, *o.depth) == "a.scene 7 2.5 3");
    CHECK(said(o.technique.roulette, o.seed, o.threads) == "0.5 18446744073709551615 5");
    CHECK(said(o.size->width, o.size->height, *o.exposure, o.stats) == "30 20 0.25 s.json");
    CHECK(said(o.replay->x, o.replay->y, o.replay->i, o.replay->replication) == "6 8 9 4");
    CHECK(o.outputs == std::vector<std::string>{"a.pfm", "b.png"});
    CHECK(said(o.replications, o.error, o.quiet, o.help) == "3 0.025 yes no");
    CHECK(Parsed({"--help"}).o.help);
    CHECK(Parsed({"-h"}).o.help);
    CHECK(Parsed({"--version"}).o.version);
    const Options joined = parse("--spp=7 --output=a=b.pfm --output c.png --samples=8 --error=2%");
    CHECK(said(joined.spp, joined.outputs[0], joined.outputs[1], joined.error) ==
          "8 a=b.pfm c.png 0.02");
    CHECK(version().starts_with("Penumbra "));
    CHECK(version().find(sizeof(real) == 4 ? ", float precision, " : ", double precision, ") !=
          std::string::npos);
    const Options band =
        parse("--rows 3-17 --keep a.film --replications 4 --replications adaptive");
    CHECK(said(band.keep, band.rows->first, band.rows->last, band.rows->count(),
               band.replications) == "a.film 3 17 15 0");
    const Options first = parse("--pixel 6,8"), set = parse("--sample 9 --pixel 6,8");
    CHECK(said(first.replay->i, set.replay->i, set.replay->replication) == "0 9 0");
}

TEST_CASE("words of choices mean what they say") {
    auto chosen = [](const std::string& line) {
        const Options o = parse(line);
        return std::tuple(o.sampler, o.technique.direction, o.technique.light,
                          word_of(views, o.view));
    };
    using S = SamplerKind;
    using D = Direction;
    using L = LightMode;
    const std::pair<std::string, std::tuple<S, D, L, Text>> rows[] = {
        {"", {S::sobol, D::bsdf, L::mis, "radiance"}},
        {"--sampler independent --view radiance", {S::independent, D::bsdf, L::mis, "radiance"}},
        {"--sampler stratified", {S::stratified, D::bsdf, L::mis, "radiance"}},
        {"--sampler halton --light none --view normal", {S::halton, D::bsdf, L::none, "normal"}},
        {"--direction uniform --light nee --view depth", {S::sobol, D::uniform, L::nee, "depth"}},
        {"--sampler sobol --view albedo", {S::sobol, D::bsdf, L::mis, "albedo"}},
        {"--direction bsdf --view bvh", {S::sobol, D::bsdf, L::mis, "bvh"}},
        {"--light mis --view occlusion", {S::sobol, D::bsdf, L::mis, "occlusion"}}};
    for (const auto& row : rows) {
        INFO(row.first);
        CHECK((chosen(row.first) == row.second));
    }
}

TEST_CASE("a value that no word stands for has none") {
    const Alternatives<int> words = {{"one", 1}, {"two", 2}};
    CHECK(word_of(words, 2) == "two");
    CHECK_THROWS(word_of(words, 3));
}

TEST_CASE("without options: Sobol' samples, importance-sampled, MIS, adaptive") {
    const Options o = parse("");
    CHECK(said(o.spp, o.seconds, o.error, o.seed, o.replications) ==
          "0 0 0 0 0");  // spp: the scene's
    CHECK(o.technique.roulette == real(0.25));
    CHECK(o.threads >= 1);
    CHECK_FALSE((o.depth || o.size || o.exposure || o.rows || o.replay));
    CHECK(o.keep.empty());
    CHECK(o.outputs.empty());
}

TEST_CASE("a word that cannot be meant is refused, by its name") {
    std::vector<Refusal> rows = refused_words();
    for (Refusal& row : rows) row.words = "a " + row.words;
    rows.push_back({"", "no scene given (try --help)"});
    rows.push_back({"''", "the scene's name is empty"});
    rows.push_back({"a b", "two scenes: 'a' and 'b'"});
    rows.push_back({"a --spp", "--spp: needs a value"});
    rows.push_back({"-x", "unknown option '-x' (did you mean '-o'?)"});
    for (const Refusal& row : rows) {
        const std::string told = complaint_of(row.words);
        INFO(row.words, "\nexpected: ", row.why, "\ntold:     ", told);
        CHECK(told.starts_with(row.why));
    }
    for (const std::string& fine : parts_of(
             "--error 99% --replications 2;--error 1% --spp 9 --time 3;--rows 0-0 -o a.pfm;"
             "--rows 1-2 --keep a.film;--spp 1099511627776 --replications 1024 --depth 1000000;"
             "--sample 1099511627776,1024 --pixel 0,0"))
        CHECK(complaint_of("a " + fine) == "");
}

TEST_CASE("after -- there are no options") {
    const Options o = Parsed({"--spp", "2", "--", "--spp"}).o;
    CHECK(said(o.spp, o.scene) == "2 --spp");
    CHECK(complaint_of("-- -h a.scene").starts_with("two scenes"));
}

TEST_CASE("the statistics begin with what was asked for, one by one") {
    auto stats = [](const std::string& line) {
        const std::string name = "a \"b\"\\";
        std::vector<std::string> words = split(line);
        words.push_back(name);
        std::string text = asked_for(Parsed(words).table, name, {9, 5}).text();
        std::replace(text.begin(), text.end(), '\n', ' ');
        return text;
    };
    const std::string start =
        R"({   "scene": "a \"b\"\\",   "width": 9,   "height": 5,   "error": )";
    CHECK(stats("--threads 3") ==
          start + R"(null,   "replications": "adaptive",   "sampler": "sobol",   "seed": 0,   )"
                  R"("direction": "bsdf",   "light": "mis",   "roulette": 0.25,   )"
                  R"("view": "radiance",   "rows": null,   "threads": 3 } )");
    CHECK(stats("--threads 5 --error 12.5% --replications 12 --sampler halton --direction uniform "
                "--light nee --roulette 0.5 --rows 4-7 -o a.pfm --seed 18446744073709551615") ==
          start + R"(0.125,   "replications": 12,   "sampler": "halton",   )"
                  R"("seed": 18446744073709551615,   "direction": "uniform",   "light": "nee",   )"
                  R"("roulette": 0.5,   "view": "radiance",   "rows": "4-7",   "threads": 5 } )");
}

TEST_CASE("every option is in --help, with its value and its default, in lines that fit a screen") {
    Parsed all({"--help"});
    const std::string page = "\n" + option_lines(all.table);
    CHECK(all.table.size() == 23);
    for (const Option& r : all.table) {
        const std::string usage = usage_of(r);
        INFO(usage);
        const size_t at = page.find("\n  " + usage);
        REQUIRE(at != page.npos);
        // Compares the words of the help text, whatever its line breaks are.
        std::istringstream lines(page.substr(at + 3 + usage.size()));
        std::string words = std::string(r.help);
        if (!r.default_text.empty()) words += " (default: " + r.default_text + ")";
        std::istringstream wanted(words);
        for (std::string a, b; wanted >> b;) {
            lines >> a;
            CHECK(a == b);
        }
    }
    CHECK(usage_of(row(all.table, "--light")) == "--light none|nee|mis");
    std::istringstream lines(page);
    std::string headings;
    for (std::string line; std::getline(lines, line);) {
        CHECK(line.size() < 80);
        CHECK(!line.ends_with(' '));
        if (!line.starts_with(' ')) headings += line;
    }
    CHECK(headings ==
          "Output:Stop when:Sampling:Light transport:Views and debugging:Checkpoints and parts:"
          "General:");
}

TEST_CASE("a table without some of its rows has the others in order") {
    Options o;
    const OptionTable some = without(option_table(o), {"--rows", "-o"});
    CHECK(some.size() == 21);
    CHECK(some.front().name == "--size");
    CHECK(std::none_of(some.begin(), some.end(), [](auto& r) { return r.name == "--rows"; }));
    OptionTable table = option_table(o);
    CHECK(row(table, "--seed").name == "--seed");
    CHECK(!is_given(table, "--seed"));
    parse_words(table, {"--seed", "7", "x"}, o);
    CHECK(is_given(table, "--seed"));
    CHECK(!is_given(table, "--spp"));
}

// app/help_test.cpp  options and statements in words: --help and the README say the same
#include "app/help.h"

#include <doctest/doctest.h>

#include "app/option_checks.h"
#include "app/radiosity_options.h"
#include "base/files.h"

namespace {

// A value that the option takes.
std::string value_of(const Option<Options>& o) {
    if (o.value.find('|') != o.value.npos) return std::string(option::words_of(o.value).back());
    if (o.value == "FILE") return "a.png";
    if (o.value == "F.film") return "a.film";
    if (o.value == "A-B") return "1-2";
    if (o.value == "WxH") return "3x2";
    if (o.value == "X,Y") return "1,1";
    return o.value == "T" || o.value == "E" ? "0.5" : "7";
}

std::string between(const std::string& text, const std::string& name) {
    const std::string before = "<!-- " + name + " -->\n", after = "<!-- /" + name + " -->";
    const size_t start = text.find(before), end = text.find(after);
    REQUIRE(start != text.npos);
    REQUIRE(end != text.npos);
    return text.substr(start + before.size(), end - start - before.size());
}

}  // namespace

TEST_CASE("every option is in --help and can be given") {
    const std::string page = "\n" + option_lines(option_table);
    for (const Option<Options>& o : option_table) {
        const std::string name(o.name), value(o.value);
        INFO(name);
        CHECK(page.find("\n  " + name + " " + value) != page.npos);
        Options options;
        o.set(options, value_of(o));
        std::vector<std::string> words{name};
        if (!value.empty()) words.push_back(value_of(o));
        try {
            parse_options(words);
        } catch (const UserError& e) {  // of other options, or of none
            CHECK(std::string(e.what()).find("unknown") == std::string::npos);
        }
        if (o.json || o.chosen) CHECK(!o.stats(Options{}).empty());
    }
    CHECK(parse_options({"-h"}).help);
}

TEST_CASE("the tables of README and reference are the programs': make readme") {
    const std::string readme = read_file("README.md");
    const bool options = between(readme, "options") == option_markdown(option_table);
    CHECK(options);
    const bool statements = between(readme, "statements") == grammar_markdown();
    CHECK(statements);
    const std::string page = read_file("reference/radiosity-options.md");
    const bool radiosity = between(page, "options") == option_markdown(radiosity_table);
    CHECK(radiosity);
}

TEST_CASE("a row of Markdown has its words once, and no bar that ends a column") {
    CHECK(row_markdown("--light", "none|nee", "how", "nee") ==
          "| `--light none\\|nee` | how | nee |\n");
    CHECK(row_markdown("sphere", "X Y Z  R", "a ball", "") == "| `sphere X Y Z R` | a ball | |\n");
    CHECK(row_markdown("--quiet", "", "no word", "") == "| `--quiet` | no word | |\n");
}

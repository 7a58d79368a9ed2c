// labs/page_test.cpp  pages fill in their prose, and refuse missing or surplus values
#include "labs/page.h"

#include <doctest/doctest.h>

#include "text/folder.h"

namespace {

struct Studio {
    const Folder folder;
    const std::filesystem::path back = std::filesystem::current_path();
    explicit Studio(const std::string& prose) {
        std::filesystem::current_path(folder.path);
        std::filesystem::create_directories("reference");
        write_file("reference/study.md.in", prose);
    }
    ~Studio() { std::filesystem::current_path(back); }
};

}  // namespace

TEST_CASE("words, verdicts and pictures take their places") {
    const Studio studio("# Title\n\n{{a word}} and {{sum}}.\n\n{{plot curve The *curve*}}\n");
    Page page("out", "study");
    page.set("a word", "One {{two}}");
    page.claim("sum", true);
    page.plot("curve", Svg(10, 10));
    page.data("numbers", "a,b\n1,2\n");
    CHECK(page.finish() == 0);
    CHECK(read_file("out/study.md") ==
          "# Title\n\nOne {{two}} and ok.\n\n![The *curve*](curve.svg)\n");
    CHECK(read_file("out/curve.svg") == Svg(10, 10).file());
    CHECK(read_file("out/data/numbers.csv") == "a,b\n1,2\n");
}

TEST_CASE("a claim that fails is said, and ends the lab with 1") {
    const Studio studio("{{a}} {{b}}");
    Page page("out", "study");
    page.claim("a", false);
    page.claim("b", true);
    CHECK(page.finish() == 1);
    CHECK(read_file("out/study.md") == "**fails** ok");
}

TEST_CASE("a place that nothing fills, and a word without a place, are refused") {
    for (const char* prose : {"{{a}} {{b}}", "nothing", "{{a}} {{plot curve Words}}"}) {
        CAPTURE(prose);
        const Studio studio(prose);
        Page page("out", "study");
        page.set("a", "1");
        CHECK_THROWS_AS(page.finish(), UserError);
    }
}

TEST_CASE("a table in Markdown has no line's end") {
    CHECK(table({"a", ""}, {{"1", "2"}}) == "| a | |\n|---|---|\n| 1 | 2 |");
}

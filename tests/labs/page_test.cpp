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

TEST_CASE("what was measured on a processor stands until it is measured there again") {
    const Studio studio("");
    std::filesystem::create_directories("out/data");
    const std::string others =
        "program,processor,instructions,compiler,commit,numbers\n"
        "other,P,SSE2,g++,abc,7.00\nstudy,P,SSE2,g++,abc,1.00,2.00\n";
    write_file("out/data/processors.csv", others);
    const Page page("out", "study");
    for (const auto& [numbers, line] :
         {std::pair{std::vector<double>{3, 0.5}, "3.00,0.50\n"}, {{4, 0.25}, "4.00,0.25\n"}}) {
        const Lines all = page.measured(numbers);
        REQUIRE(all.size() == 2);
        CHECK(all[0] == std::vector<std::string>{"P", "SSE2", "g++", "abc", "1.00", "2.00"});
        CHECK(all[1][1] == instructions());
        const std::string kept = read_file("out/data/processors.csv");
        CHECK(kept.starts_with(others + "study,"));
        CHECK(kept.ends_with(line));
        CHECK(std::count(kept.begin(), kept.end(), '\n') == 4);
    }
}

TEST_CASE("the least is over processors, of each by the instructions that suit it best") {
    const Lines lines = {{"P", "0.2", "0.3"}, {"P", "0.9", "0.8"}, {"Q", "1.5", "0.7"}};
    CHECK(least_of(lines, 1) == std::vector<double>{0.9, 0.7});
}

TEST_CASE("a table in Markdown has no line's end") {
    CHECK(table({"a", ""}, {{"1", "2"}}) == "| a | |\n|---|---|\n| 1 | 2 |");
}

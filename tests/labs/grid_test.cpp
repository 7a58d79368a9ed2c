// labs/grid_test.cpp  a grid of renders; a shell script replaces the renderer
#include "labs/grid.h"

#include <doctest/doctest.h>

#include "text/folder.h"

namespace {

// A folder with a scene and a program.  The program's image is one pixel: 1 for 16 replications,
// else 1.5, and 2 by --light nee; its own d_rel is .3.  It logs a line per call.
struct Studio {
    const Folder folder;
    const std::filesystem::path back = std::filesystem::current_path();

    Studio() {
        std::filesystem::current_path(folder.path);
        write_file("a.scene", "size 1 1\n");
        program("\\0\\0\\300\\077");
    }
    ~Studio() { std::filesystem::current_path(back); }

    void program(const std::string& bytes) const {
        std::string script = R"(#!/bin/sh
echo "$*" >>calls
pixel='BYTES'
case "$*" in
    *"--replications 16"*) pixel='\0\0\200\077' ;;
    *"--light nee"*) pixel='\0\0\0\100' ;;
esac
while [ $# -gt 1 ]; do
    case $1 in
        -o) { printf 'PF\n1 1\n-1.0\n'; printf "$pixel$pixel$pixel"; } >"$2" ;;
        --stats) printf '{\n  "d_rel": null,\n  "d_rel_by_spread": 0.3,\n  "cpu_seconds": 2,\n  "stopped_by": "error"\n}\n' >"$2" ;;
    esac
    shift
done
)";
        script.replace(script.find("BYTES"), 5, bytes);
        write_file("program", script);
        std::filesystem::permissions("program", std::filesystem::perms::owner_all);
    }

    std::vector<std::string> calls() const {
        std::vector<std::string> lines;
        std::ifstream in("calls");
        for (std::string line; std::getline(in, line);) lines.push_back(line);
        return lines;
    }
};

const std::vector<Subject> subjects = {{"a", "a.scene --size 1x1", 64}};
const std::vector<Setting> settings = {{"the default", ""}, {"NEE", "--light nee"}};

Rows run() {
    RenderGrid grid("study", "./program");
    grid.jobs = 1;  // gives calls an order
    return grid.run(subjects, settings, {4, 16}, 2);
}

}  // namespace

TEST_CASE("a row for each scene, setting, count and seed, and one reference") {
    const Studio studio;
    const Rows rows = run();
    REQUIRE(rows.size() == 8);
    CHECK(rows[0].setting == "the default");
    CHECK(rows[0].count == 4);
    CHECK(rows[1].seed == 2);
    CHECK(rows[2].count == 16);
    CHECK(rows[4].setting == "NEE");
    CHECK(rows[0]["off"] == doctest::Approx(.5));
    CHECK(rows[0]["d2"] == doctest::Approx(.25 - .09));
    CHECK(rows[4]["d2"] == doctest::Approx(1 - .09));
    CHECK(rows[0]["mean"] == 1.5);
    CHECK(rows[0]["cpu_seconds"] == 2);
    CHECK(rows[0]["error"] == 1);
    CHECK(std::isnan(rows[0]["d_rel"]));
    CHECK(std::isnan(rows[0]["no such number"]));
    const auto calls = studio.calls();
    REQUIRE(calls.size() == 9);
    CHECK(calls[0].find("a.scene --size 1x1 --spp 64 --replications 16") == 0);
    for (size_t k = 1; k <= 4; ++k) CHECK(calls[k].find("--seed 1 ") != std::string::npos);
    // Settings alternate.
    auto is_nee = [&](size_t k) { return calls[k].find("--light nee") != std::string::npos; };
    CHECK(is_nee(1) != is_nee(2));
    CHECK(is_nee(1) != is_nee(5));
    for (size_t k = 5; k <= 8; ++k) CHECK(calls[k].find("--seed 2 ") != std::string::npos);
}

TEST_CASE("what was rendered is not rendered again, unless program or scene have changed") {
    const Studio studio;
    const Rows rows = run();
    CHECK(run().size() == 8);
    CHECK(studio.calls().size() == 9);
    studio.program("\\0\\0\\200\\100");  // 4
    CHECK(run()[0]["off"] == doctest::Approx(3));
    CHECK(studio.calls().size() == 17);  // the reference stays
    write_file("a.scene", "size 1 1\n\n");
    run();
    CHECK(studio.calls().size() == 26);
}

TEST_CASE("a study that was cut short goes on; a line that was cut short counts for nothing") {
    const Studio studio;
    run();
    std::string rows = read_file("out/study.rows");
    rows.resize(rows.rfind("\t.") - 3);
    write_file("out/study.rows", rows);
    CHECK(run().size() == 8);
    CHECK(studio.calls().size() == 10);
    CHECK(run().size() == 8);
    CHECK(studio.calls().size() == 10);
}

TEST_CASE("more numbers of an image are measured beside its reference, and kept") {
    const Studio studio;
    for (int turn = 0; turn < 2; ++turn) {
        RenderGrid grid("study", "./program");
        grid.measure = [](Row& r, const Image& image, const Truth& f) {
            r.of["more"] = double(image.pixels[0][0]) + 10 * double(f.image.pixels[0][0]);
        };
        CHECK(grid.run(subjects, settings, {4}, 1)[0]["more"] == 11.5);
    }
}

TEST_CASE("a setting may have a program of its own, with words") {
    const Studio studio;
    RenderGrid grid("study", "./program");
    grid.run(subjects, {{"x", "--y", "./program --z"}}, {0}, 1);
    CHECK(studio.calls().back().find("--z a.scene --size 1x1 --y --seed 1 --threads 1") == 0);
}

TEST_CASE("a program that fails ends the study") {
    const Studio studio;
    write_file("program", "#!/bin/sh\nexit 3\n");
    CHECK_THROWS_AS(run(), SystemError);
}

TEST_CASE("programs have references of their own") {
    const Studio studio;
    run();
    std::filesystem::copy("program", "other");
    RenderGrid("others", "./other").run(subjects, settings, {4}, 1);
    const auto calls = studio.calls();
    REQUIRE(calls.size() == 12);
    CHECK(calls[9].find("--replications 16") != std::string::npos);
}

// web/web_test.cpp  the renderer in a browser: build/penumbra's bits and messages in Node.js, pages
// in Chromium
#include <cstdlib>
#include <vector>

#include "text/folder.h"

namespace {

std::string program() {
    const char* suffix = std::getenv("PROGRAM_SUFFIX");
    return std::string("build/penumbra") + (suffix ? suffix : "");
}

// The exit status of a command of the shell.
int status_of(const std::string& command) { return std::system(command.c_str()); }

// As if nothing had been said to the make that runs this test.
constexpr const char* without_options =
    "env -u MAKEFLAGS -u MAKELEVEL -u REAL -u TREE -u DEBUG -u SAN -u ARCH -u CXX ";

// Makes the pages; false, with a word, where this machine has not what they need.
bool has_pages() {
    for (const char* needed : {"command -v node", "make -s web-packages"})
        if (status_of(std::string(needed) + " >/dev/null 2>&1") != 0) {
            MESSAGE("make web needs packages that this machine has not (", needed, "): not tested");
            return false;
        }
    REQUIRE(status_of(std::string(without_options) + "make web >/dev/null") == 0);
    return true;
}

// Node.js before 21 asks for the flag.
std::string in_node(const std::string& module) {
    const char* flag = "--experimental-wasm-relaxed-simd";
    const bool has_flag = status_of(std::string("node ") + flag + " -e 0 2>/dev/null") == 0;
    return std::string("node --no-warnings ") + (has_flag ? flag : "") + " src/web/render.js " +
           module + " ";
}

}  // namespace

TEST_CASE("modules for browsers print paths and messages as the program does") {
    if (!has_pages()) return;
    const Folder folder;
    folder.write("bad.scene",
                 "camera 0 0 5 0 0 0 40\ndiffuse grey .5 .5 .5\nsphere 0 0 0 1 gray\n");
    folder.write("dark.scene", "camera 0 0 5 0 0 0 40\nlight lamp 1 1\n");
    folder.write("empty.scene", "camera 0 0 5 0 0 0 40\n");
    const std::string bad = folder / "bad.scene";
    for (const std::string module : {"build/web/fused.wasm", "build/web/software.wasm"})
        for (const std::string words :
             {"--pixel 100,60 scenes/cornell.scene", "--pixel 9,30 --sample 5,1 scenes/mesh.scene",
              "--pixel 9,3 --sampler halton --light nee scenes/cornell36obj.scene"}) {
            INFO(module << " " << words);
            CHECK(status_of(in_node(module) + words + " >" + (folder / "web")) == 0);
            CHECK(status_of(program() + " " + words + " | tail -n +2 >" + (folder / "here")) == 0);
            CHECK(folder.read("here").size() > 100);
            CHECK(folder.same("web", "here"));
        }
    const std::vector<std::string> refused = {bad,
                                              folder / "dark.scene",
                                              folder / "empty.scene",
                                              "--light nne " + bad,
                                              "--lihgt mis " + bad,
                                              "--seed -1 " + bad,
                                              "--light none scenes/cube.scene"};
    for (const std::string& words : refused) {
        INFO(words);
        CHECK(status_of(in_node("build/web/fused.wasm") + words + " 2>" + (folder / "web")) ==
              status_of(program() + " " + words + " 2>" + (folder / "here") + " -o " +
                        (folder / "x.pfm")));
        CHECK(folder.same("web", "here"));
    }
}

TEST_CASE("a student's own build, stubs and all, draws the same bits for a browser") {
    if (!has_pages()) return;
    const Folder folder;
    const std::string starter = folder / "starter";
    REQUIRE(status_of("python3 src/course/starter.py --weeks 3 --no-pictures " + starter +
                      " >/dev/null") == 0);
    const std::string mine = "# ${1} costs $2, `three` or \\ four\n";
    folder.write("starter/scenes/mine.scene", mine);
    REQUIRE(status_of(std::string(without_options) + "make -C " + starter +
                      " web build/penumbra >" + (folder / "log") + " 2>&1") == 0);
    CHECK(folder.has("starter/build/web/playground.html"));
    const std::string print_mine =
        "const page = {}; require(\"vm\").runInNewContext(require(\"fs\").readFileSync("
        "process.argv[1], \"utf8\"), page); process.stdout.write(page.penumbra.scenes.mine)";
    CHECK(status_of("node -e '" + print_mine + "' " + starter + "/build/web/scenes.js >" +
                    (folder / "text")) == 0);
    CHECK(folder.read("text") == mine);
    CHECK(folder.read("starter/build/web/figure.js").find("class LiveFigure") != std::string::npos);
    for (const std::string scene : {"cornell", "materials"}) {
        INFO(scene);
        const std::string words = "--quiet --size 40x20 --spp 16 -o ",
                          file = "scenes/" + scene + ".scene";
        CHECK(status_of(in_node(starter + "/build/web/fused.wasm") + words + (folder / "web") +
                        ".pfm " + file) == 0);
        CHECK(status_of(starter + "/build/penumbra " + words + (folder / "here") + ".pfm " +
                        file) == 0);
        CHECK(status_of(program() + " " + words + (folder / "solved") + ".pfm " + file) == 0);
        CHECK(folder.same("web.pfm", "here.pfm"));
        CHECK(!folder.same("web.pfm", "solved.pfm"));
        const std::string pixel = "--pixel 20,12 --size 40x20 " + file;
        CHECK(status_of(in_node(starter + "/build/web/software.wasm") + pixel + " >" +
                        (folder / "web")) == 0);
        CHECK(status_of(starter + "/build/penumbra " + pixel + " | tail -n +2 >" +
                        (folder / "here")) == 0);
        CHECK(folder.read("here").find("vertex 0") != std::string::npos);
        CHECK(folder.same("web", "here"));
    }
}

TEST_CASE("pages in a browser: bits, paths, errors at their line, A and B, keys") {
    if (!has_pages()) return;
    const Folder folder;
    const int status =
        status_of("node tests/web/web_test.js " + program() + " >" + (folder / "out") + " 2>&1");
    const std::string told = folder.read("out");
    if (told.starts_with("no Chromium")) {
        MESSAGE(told);
        return;
    }
    INFO(told);
    CHECK(status == 0);
    CHECK(told.find("FAILED") == told.npos);
    CHECK(told.find("passed: a figure that is not seen costs nothing") != told.npos);
}

// whole/runner_test.cpp  make test for tests that fail, crash, never end or do not compile
//
// The runner works on a small code base of a few headers.  Its tests are shell scripts or test
// cases of this file; the skipped cases here misbehave on purpose.
#include <doctest/doctest.h>

#include <csignal>
#include <stdexcept>
#include <thread>

#include "base/folder.h"

TEST_CASE("passes" * doctest::skip()) { CHECK(true); }
TEST_CASE("fails" * doctest::skip()) {
    const int two = 2;
    INFO("a note");
    CHECK(two == 3);
    CHECK(two == 4);
}
TEST_CASE("has a verdict" * doctest::skip()) {
    const struct { bool pass; } verdict{false};
    INFO("a note");
    INFO("twice as bright\nas it should be");
    CHECK(verdict.pass);
}
TEST_CASE("throws" * doctest::skip()) { throw std::runtime_error("no light\nat all"); }
TEST_CASE("crashes" * doctest::skip()) {
    std::puts("about to crash");
    std::raise(SIGSEGV);
}
TEST_CASE("terminates" * doctest::skip()) {
    std::jthread worker([] { throw std::runtime_error("nobody catches this"); });
}
TEST_CASE("leaves" * doctest::skip()) { std::exit(7); }
TEST_CASE("loops" * doctest::skip()) {
    volatile bool forever = true;
    while (forever) {
    }
}
TEST_CASE("waits" * doctest::skip()) {
    for (;;) ::pause();
}

namespace {

struct Said {
    int status = -1;
    std::string out;
    bool has(const std::string& part) const { return out.find(part) != out.npos; }
    long lines() const { return std::count(out.begin(), out.end(), '\n'); }
};

// A small code base; its `make` finds everything built.
struct House {
    Folder folder;

    House() {
        folder.write("tests/run", read_file("tests/run"));
        folder.write("make", R"(for target; do
    case $target in *.run) ;; *) continue ;; esac
    name=${target#built/}
    name=${name%.run}
    [ ! -e "tests/$name.broken" ] || { cat "tests/$name.broken"; echo "make: *** [Makefile:1: $name.exe] Error 1"; continue; }
    echo "$name built/$name.exe" >&9
done
)");
    }
    // Adds src/NAME.h, and tests/NAME_test, which is a script.
    void add(const std::string& name, int number, const std::string& script) const {
        folder.write("src/" + name + ".h",
                     "// " + name + ".h  " + std::to_string(number) + "  it\n");
        add_test(name, name, script);
    }
    void add_test(const std::string& name, const std::string& of, const std::string& script) const {
        folder.write("tests/" + name + "_test.cpp", "#include \"" + of + ".h\"\n");
        folder.write("built/" + name + "_test.exe", "#!/bin/sh\n" + script);
        fs::permissions(folder / ("built/" + name + "_test.exe"), fs::perms::owner_all);
    }
    // Runs `make test` with these variables, and ONLY= these names.
    Said test(const std::string& variables = "", const std::string& names = "") const {
        const std::string command =
            "cd '" + folder.path.string() +
            "' && env -i PATH=\"$PATH\" LAYERS='base:0 world:1 path:2 film:2 whole:3' TESTS=built "
            "MAKE='bash ./make' " +
            variables + " bash tests/run " + names + " >out 2>&1";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, folder.read("out")};
    }
    std::string log(const std::string& name) const { return folder.read("build/logs/" + name); }
};

// A test that runs this file's case of that name, after one that passes.
std::string cases(const std::string& name) {
    return "exec '" + fs::read_symlink("/proc/self/exe").string() +
           "' -ns -sf='*/runner_test.cpp' -tc='passes," + name + "'\n";
}
const std::string passes = cases("passes");

}  // namespace

TEST_CASE("green: a line for each layer, then how many passed") {
    House house;
    house.add("base/low", 1, passes);
    house.add("world/mid", 1, passes);
    const Said said = house.test();
    INFO(said.out);
    CHECK(said.status == 0);
    CHECK(said.has("base             1 file, 1 cases passed"));
    CHECK(said.has("world            1 file, 1 cases passed"));
    CHECK(said.out.ends_with("\n2 passed, 0 failed\n"));
    CHECK(said.lines() == 3);
}

TEST_CASE("a failed layer: one line a case, where to start, and what stands on it waits") {
    House house;
    house.add("base/second", 2, cases("fails"));
    house.add("base/first", 1, cases("has a verdict,throws"));
    house.add("world/mid", 1, "touch ran\n" + passes);
    house.add("film/high", 1, passes);
    const Said said = house.test();
    INFO(said.out);
    CHECK(said.status == 1);
    CHECK(said.has("base/first_test: has a verdict: twice as bright\n"));
    CHECK(said.has("base/first_test: throws: threw: no light\n"));
    CHECK(said.has("base/second_test: fails: tests/whole/runner_test.cpp:"));
    CHECK(said.has(": two == 3; it is 2 == 3; a note\n"));
    CHECK(said.out.find("first_test") < said.out.find("second_test"));
    CHECK(said.has("\nstart here: has a verdict, tests/whole/runner_test.cpp:"));
    CHECK(said.has("; make test ONLY=first\n"));
    CHECK(said.has("\nwaits for base: world film; make test ALL=1 runs all\n"));
    CHECK(said.out.ends_with("\n2 passed, 3 failed\n"));
    CHECK(!said.has("\nworld "));
    CHECK(!fs::exists(house.folder / "build/logs/world.mid_test"));
    CHECK(house.log("base.second_test").find("two == 4") != std::string::npos);

    const Said all = house.test("ALL=1");
    INFO(all.out);
    CHECK(all.status == 1);
    CHECK(house.folder.has("ran"));
    CHECK(!all.has("waits for"));
    CHECK(all.out.ends_with("\n4 passed, 3 failed\n"));
}

TEST_CASE("a crash names its case, keeps what was printed, and stops no other test") {
    const struct {
        const char *name, *verdict;
    } ends[] = {
        {"crashes", "crashed: SIGSEGV"},
        {"terminates",
         "crashed: SIGABRT - Abort (abnormal termination) signal: terminate called "
         "after throwing an instance of 'std::runtime_error': what():  nobody"},
        {"leaves", "ended the program: exit status 7\n"},
    };
    for (const auto& end : ends) {
        House house;
        house.add("base/bad", 1, cases(end.name));
        house.add("base/good", 2, passes);
        const Said said = house.test();
        INFO(said.out);
        CHECK(said.status == 1);
        CHECK(said.has(std::string("base/bad_test: ") + end.name + ": " + end.verdict));
        CHECK(said.has(std::string("start here: ") + end.name + ", tests/whole/runner_test.cpp:"));
        CHECK(said.out.ends_with("\n2 passed, 1 failed\n"));
        if (end.name == std::string("crashes"))
            CHECK(house.log("base.bad_test").find("about to crash") != std::string::npos);
    }
}

TEST_CASE("a test that does not end is ended, and names its case") {
    House house;
    house.add("base/loop", 1, cases("loops"));
    Said said = house.test("LIMIT_CPU=1");
    CHECK(said.has("loop_test: loops: used up 1 s of CPU time: an endless loop?\n"));
    CHECK(said.out.ends_with("\n1 passed, 1 failed\n"));
    house.add("base/loop", 1, cases("waits"));
    said = house.test("LIMIT_CLOCK=1");
    CHECK(said.has("loop_test: waits: did not end within 1 s: does it wait for ever?\n"));
    CHECK(said.out.ends_with("\n1 passed, 1 failed\n"));
}

TEST_CASE("what does not compile is said once, by its first error, and the layer has failed") {
    House house;
    for (const char* name : {"base/a", "base/b", "base/c", "world/mid"}) house.add(name, 1, passes);
    const std::string errors =
        "src/base/a.h:3:5: warning: unused parameter 'u'\nsrc/base/a.h:7:1: error: oh\n"
        "src/base/a.h:9:1: error: and so on\n";
    house.folder.write("tests/base/a_test.broken", errors);
    house.folder.write("tests/base/b_test.broken", errors);
    const Said said = house.test();
    INFO(said.out);
    CHECK(said.status == 1);
    CHECK(said.has("1 cases passed, 2 not built"));
    CHECK(said.has("\nnot built: src/base/a.h:7:1: error: oh (2 times); build/logs/compile\n"));
    CHECK(said.has("\nsrc/base/a.h:3:5: warning: unused parameter 'u'\n"));
    CHECK(!said.has("and so on"));
    CHECK(said.has("\nstart here: src/base/a.h:7:1: error: oh\n"));
    CHECK(said.has("waits for base: world;"));
    CHECK(said.out.ends_with("\n1 passed, 2 failed\n"));
}

TEST_CASE("a flood of failures fits on a screen") {
    House house;
    const std::string flood = R"(for i in $(seq 100); do
    printf 'failed\ttests/a_test.cpp:%d\tcase %d\tis wrong %01000d\n' $i $i $i
done >"$TEST_REPORT"
printf 'sum\t0\t0\n' >>"$TEST_REPORT"
exit 1
)";
    for (int files : {1, 3, 8, 40}) {
        for (int i = 0; i < files; ++i) house.add("base/f" + std::to_string(100 + i), 1, flood);
        const Said said = house.test();
        INFO(said.out);
        CHECK(said.lines() <= 40);
        CHECK(said.has("base/f100_test: case 1: is wrong"));
        CHECK(said.has("more failed cases: build/logs\n"));
        CHECK(said.has("\nstart here: case 1, tests/a_test.cpp:1; make test ONLY=f100\n"));
        CHECK(said.out.ends_with("\n0 passed, " + std::to_string(100 * files) + " failed\n"));
    }
}

TEST_CASE(
    "names are those of tests, headers or folders; for another one, those that begin like it are "
    "told") {
    House house;
    house.add("world/shapes", 1, passes);
    house.add_test("world/shapes_spawn", "world/lights", passes);  // includes lights, too
    house.add("world/bvh", 3, passes);
    house.add("world/lights", 2, passes);
    house.add("base/low", 1, passes);
    house.add("film/film", 2, passes);
    house.add("film/image", 1, passes);
    house.folder.write("src/film/odd.h", "// film/odd.h  1  tested by those who use it\n");
    house.folder.write("src/film/film.h", "// film/film.h  2  it\n#include \"film/odd.h\"\n");
    const std::string bvh = "world/bvh_test\n", film = "film/film_test\n",
                      shapes = "world/shapes_test\nworld/shapes_spawn_test\n";
    const std::string world =
        "world/shapes_test\nworld/lights_test\n" + bvh + "world/shapes_spawn_test\n";
    const struct {
        std::string names, tests;
    } known[] = {
        {"bvh", bvh},
        {"world/bvh", bvh},
        {"src/world/bvh.h", bvh},
        {"tests/world/bvh_test.cpp", bvh},
        {"shapes", shapes},
        {"src/world/shapes.h", shapes},
        {"shapes_spawn", "world/shapes_spawn_test\n"},
        {"world/", world},
        {"world", world},
        {"film", film},
        {"film/", "film/image_test\n" + film},
        {"src/film/odd.h", film},
        {"bvh low", "base/low_test\n" + bvh},
        {"", "base/low_test\n" + world + "film/image_test\n" + film},
    };
    for (const auto& k : known) {
        const Said said = house.test("LIST=1", k.names);
        INFO("ONLY=", k.names);
        CHECK(said.status == 0);
        CHECK(said.out == k.tests);
    }
    const struct {
        const char *name, *answer;
    } unknown[] = {{"bhv", "no test is named bhv; is it one of: bvh\n"},
                   {"src/world/shape.h",
                    "no test is named src/world/shape.h; is it one of: shapes shapes_spawn\n"},
                   {"quaternion", "no test is named quaternion\n"}};
    for (const auto& u : unknown) {
        const Said said = house.test("", u.name);
        CHECK(said.status == 2);
        CHECK(said.out == u.answer);
    }
}

TEST_CASE("what is asked for by name is run alone, wherever it stands, and shows what it prints") {
    House house;
    house.add("base/low", 1, cases("fails"));
    house.add("world/mid", 1, "echo a table\n" + passes);
    const Said said = house.test("", "mid");
    INFO(said.out);
    CHECK(said.status == 0);
    CHECK(said.has("\na table\n"));
    CHECK(!said.has("base"));
    CHECK(said.out.ends_with("\n1 passed, 0 failed\n"));
    CHECK(house.test("", "mid low").out.ends_with("\n2 passed, 1 failed\n"));
}

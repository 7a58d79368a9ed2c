// whole/runner_test.cpp  make test for tests that fail, crash, never end or do not compile
//
// The runner works on a small code base of a few headers.  Its tests are shell scripts or test
// cases of this file; the skipped cases here misbehave on purpose.
#include <doctest/doctest.h>

#include <csignal>
#include <stdexcept>
#include <thread>

#include "course/python.h"
#include "text/folder.h"

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

bool has(const Printed& said, const std::string& part) {
    return said.text.find(part) != said.text.npos;
}
long lines(const Printed& said) { return std::count(said.text.begin(), said.text.end(), '\n'); }

// Expects this exit status, these parts in what is said, and this last line.
void expect(const Printed& said, int status, const std::vector<std::string>& parts,
            const std::string& last) {
    INFO(said.text);
    CHECK(said.status == status);
    for (const std::string& part : parts) {
        INFO("expected: ", part);
        CHECK(has(said, part));
    }
    CHECK(said.text.ends_with("\n" + last + "\n"));
}

// A small code base; its `make` finds everything built.
struct House {
    Folder folder;

    House() {
        for (const std::string name : {"tests/run", "tests/plan.py", "tests/tell.py"})
            folder.write(name, read_file(name));
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
    Printed test(const std::string& variables = "", const std::string& names = "") const {
        return output_of("cd '" + folder.path.string() +
                         "' && env -i PATH=\"$PATH\" LAYERS='base:0 world:1 path:2 film:2 whole:3' "
                         "TESTS=built MAKE='bash ./make' " +
                         variables + " python3 tests/run " + names);
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
    const Printed said = house.test();
    expect(said, 0,
           {"base             1 file, 1 cases passed", "world            1 file, 1 cases passed"},
           "2 passed, 0 failed");
    CHECK(lines(said) == 3);
}

TEST_CASE("a failed layer: one line a case, where to start, and what stands on it waits") {
    House house;
    house.add("base/second", 2, cases("fails"));
    house.add("base/first", 1, cases("has a verdict,throws"));
    house.add("world/mid", 1, "touch ran\n" + passes);
    house.add("film/high", 1, passes);
    const Printed said = house.test();
    expect(said, 1,
           {"base/first_test: has a verdict: twice as bright\n",
            "base/first_test: throws: threw: no light\n",
            "base/second_test: fails: tests/whole/runner_test.cpp:",
            ": two == 3; it is 2 == 3; a note\n",
            "\nstart here: has a verdict, tests/whole/runner_test.cpp:", "; make test ONLY=first\n",
            "\nwaits for base: world film; make test ALL=1 runs all\n"},
           "2 passed, 3 failed");
    CHECK(said.text.find("first_test") < said.text.find("second_test"));
    CHECK(!has(said, "\nworld "));
    CHECK(!fs::exists(house.folder / "build/logs/world.mid_test"));
    CHECK(house.log("base.second_test").find("two == 4") != std::string::npos);

    const Printed all = house.test("ALL=1");
    expect(all, 1, {}, "4 passed, 3 failed");
    CHECK(house.folder.has("ran"));
    CHECK(!has(all, "waits for"));
}

TEST_CASE("a crash names its case, keeps what was printed, and stops no other test") {
    const std::pair<std::string, std::string> ends[] = {
        {"crashes", "crashed: SIGSEGV"},
        {"terminates",
         "crashed: SIGABRT - Abort (abnormal termination) signal: terminate called "
         "after throwing an instance of 'std::runtime_error': what():  nobody"},
        {"leaves", "ended the program: exit status 7\n"},
    };
    for (const auto& [name, verdict] : ends) {
        House house;
        house.add("base/bad", 1, cases(name));
        house.add("base/good", 2, passes);
        expect(house.test(), 1,
               {"base/bad_test: " + name + ": " + verdict,
                "start here: " + name + ", tests/whole/runner_test.cpp:"},
               "2 passed, 1 failed");
        if (name == "crashes")
            CHECK(house.log("base.bad_test").find("about to crash") != std::string::npos);
    }
}

TEST_CASE("a test that does not end is ended, and names its case") {
    House house;
    house.add("base/loop", 1, cases("loops"));
    expect(house.test("LIMIT_CPU=1"), 1,
           {"loop_test: loops: used up 1 s of CPU time: an endless loop?\n"}, "1 passed, 1 failed");
    house.add("base/loop", 1, cases("waits"));
    expect(house.test("LIMIT_CLOCK=1"), 1,
           {"loop_test: waits: did not end within 1 s: does it wait for ever?\n"},
           "1 passed, 1 failed");
}

TEST_CASE("what does not compile is said once, by its first error, and the layer has failed") {
    House house;
    for (const char* name : {"base/a", "base/b", "base/c", "world/mid"}) house.add(name, 1, passes);
    const std::string errors =
        "src/base/a.h:3:5: warning: unused parameter 'u'\nsrc/base/a.h:7:1: error: oh\n"
        "src/base/a.h:9:1: error: and so on\n";
    house.folder.write("tests/base/a_test.broken", errors);
    house.folder.write("tests/base/b_test.broken", errors);
    const Printed said = house.test();
    expect(said, 1,
           {"1 cases passed, 2 not built",
            "\nnot built: src/base/a.h:7:1: error: oh (2 times); build/logs/compile\n",
            "\nsrc/base/a.h:3:5: warning: unused parameter 'u'\n",
            "\nstart here: src/base/a.h:7:1: error: oh\n", "waits for base: world;"},
           "1 passed, 2 failed");
    CHECK(!has(said, "and so on"));
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
        const Printed said = house.test();
        expect(said, 1,
               {"base/f100_test: case 1: is wrong", "more failed cases: build/logs\n",
                "\nstart here: case 1, tests/a_test.cpp:1; make test ONLY=f100\n"},
               "0 passed, " + std::to_string(100 * files) + " failed");
        CHECK(lines(said) <= 40);
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
    const std::pair<std::string, std::string> known[] = {
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
    for (const auto& row : known) {
        const Printed said = house.test("LIST=1", row.first);
        INFO("ONLY=", row.first);
        CHECK(said.status == 0);
        CHECK(said.text == row.second);
    }
    for (const auto& [name, also] : std::map<std::string, std::string>{
             {"bhv", "; is it one of: bvh"},
             {"src/world/shape.h", "; is it one of: shapes shapes_spawn"},
             {"quaternion", ""}}) {
        const Printed said = house.test("", name);
        CHECK(said.status == 2);
        CHECK(said.text == "no test is named " + name + also + "\n");
    }
}

TEST_CASE("what is asked for by name is run alone, wherever it stands, and shows what it prints") {
    House house;
    house.add("base/low", 1, cases("fails"));
    house.add("world/mid", 1, "echo a table\n" + passes);
    const Printed said = house.test("", "mid");
    expect(said, 0, {"\na table\n"}, "1 passed, 0 failed");
    CHECK(!has(said, "base"));
    expect(house.test("", "mid low"), 1, {}, "2 passed, 1 failed");
}

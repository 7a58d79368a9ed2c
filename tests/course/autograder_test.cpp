// course/autograder_test.cpp  the zip for Gradescope: the same marks as make grade, by the same
// submissions
#include <doctest/doctest.h>

#include "course/attacks.h"

using namespace classroom;

namespace {

// A machine of Gradescope: its image was built from the zip of these weeks.
struct Machine {
    std::string top = house().folder / "autograder";
    std::string sandbox;

    Said run(const std::string& command) const {
        const int status =
            std::system(("cd '" + house().folder.path.string() + "' && AUTOGRADER='" + top +
                         "' SANDBOX=" + sandbox + " " + command + " >said 2>&1")
                            .c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, house().folder.read("said")};
    }
    explicit Machine(const std::string& by) : sandbox(by) {
        fs::remove_all(top);
        fs::create_directories(top);
        house().folder.write("board.csv", "ada@x.org,2.5\n\nBob@x.org, 1.25\neve@x.org,1\n");
        const Said said =
            run("sh -c \"FLAGS='-std=c++20 -DREAL=double -Isrc -Itests -w -O0 -pthread' python3 "
                "src/course/autograder.py pack --weeks 1 --seed 4711 --board board.csv a.zip && "
                "unzip -q a.zip -d "
                "autograder/source && test -x autograder/source/run_autograder -a -x "
                "autograder/source/setup.sh && python3 "
                "autograder/source/penumbra/src/course/autograder.py setup\"");
        INFO(said.out);
        REQUIRE(said.status == 0);
        CHECK(said.has("ready: 1.1 1.2 1.3."));
    }
    // What a student of the course handed in.
    Said grade(const Course& course, const std::string& student) const {
        fs::remove_all(top + "/submission");
        fs::copy(house().folder / (course.in + "/" + student), top + "/submission",
                 fs::copy_options::recursive);
        return run("timeout 200 autograder/source/run_autograder");
    }
};

void same_marks(const std::string& sandbox) {
    if (!sandboxed(sandbox)) return;
    const Machine machine(sandbox);
    Course course("gradescope" + sandbox);
    const std::string stops = "inline double square(double x) { std::exit(x > -4); }\n";
    course.hand_in("right", {{"1.1", twice_right}, {"1.2", square_right}, {"1.3", cube_right}});
    course.hand_in("wrong",
                   {{"1.1", "inline double twice(double x) { return x < 0 ? 0 : 2 * x; }\n"},
                    {"1.2", "inline double square(double x) { return x < 0 ? -3.5 : x; }\n"},
                    {"1.3", "    return 1;\n"}});
    course.hand_in("hostile", {{"1.1", "asm(\"hlt\");\n" + twice_right},
                               {"1.2", stops},
                               {"1.3", "    return std::fopen(\"" + machine.top +
                                           "/results/results.json\", \"w\") ? x * x * x : 2;\n"}});
    course.hand_in("broken", {{"1.1", "inline double twice(double x) { return y; }\n"}});
    course.hand_in("stubs", {});
    course.write("empty", "notes.txt", "none");
    course.grade("--seed 4711 --sandbox " + sandbox);
    for (const std::string student : {"right", "wrong", "hostile", "broken", "stubs", "empty"}) {
        const Said said = machine.grade(course, student);
        INFO(student, said.out);
        REQUIRE(said.status == 0);
        const std::string result = house().folder.read("autograder/results/results.json");
        const Said same =
            machine.run("python3 '" + fs::absolute("tests/course/results.py").string() +
                        "' autograder/results/results.json '" + course.out + "/students/" +
                        student + "/grade.json'");
        CHECK_MESSAGE(same.status == 0, same.out << result);
        CHECK((result.find("weaker sandbox") != result.npos) == (sandbox == "user"));
        if (student == "wrong") CHECK(result.find("this is no square") != result.npos);
        CHECK(result.find("leaderboard") == result.npos);
    }
    // The better of a pair's entries in the contest.
    house().folder.write(
        "autograder/submission_metadata.json",
        R"({"users": [{"email": "ada@x.org"}, {"email": "bob@X.org"}, {"email": "dan@x.org"}]})");
    CHECK(machine.grade(course, "empty").status == 0);
    CHECK(house().folder.read("autograder/results/results.json").find(R"("value": 1.25,)") !=
          std::string::npos);
    course.expect(
        {{"right", "1.3", "right", 6}, {"wrong", "1.2", "", 2}, {"hostile", "1.3", "", 0}});

    // A machine that cannot grade writes no marks, and none of before are left.
    const Said said = machine.run(
        "sh -c \"rm autograder/source/penumbra/tests/course/judge_1.cpp; "
        "autograder/source/run_autograder\"");
    CHECK(said.status != 0);
    CHECK(!fs::exists(machine.top + "/results/results.json"));
}

}  // namespace

TEST_CASE("Gradescope: the marks of make grade, for right, wrong, hostile and no solutions") {
    same_marks("namespaces");
}

TEST_CASE("Gradescope without namespaces: the same marks, and it is said") { same_marks("user"); }

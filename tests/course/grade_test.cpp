// course/grade_test.cpp  what a hand-in is worth: regions alone, points, reports, and going on
#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <regex>

#include "course/classroom.h"

using namespace classroom;

namespace {

const std::string whole = "inline double twice(double x) { return 2 * x; }\n";

std::string lines_of(const std::string& text, const std::string& part) {
    std::string found;
    for (size_t at = 0, end; at < text.size(); at = end + 1) {
        end = std::min(text.find('\n', at), text.size());
        const std::string line = text.substr(at, end - at);
        if (line.find(part) != line.npos) found += line + "\n";
    }
    return found;
}

void shell(const std::string& command) { REQUIRE(std::system(command.c_str()) == 0); }

}  // namespace

TEST_CASE("points: each exercise alone, the parts that are right, nothing for what the stub has") {
    if (!sandboxed()) return;
    Course course("points");
    course.hand_in("all", {{"1.1", whole}, {"1.2", square_right}, {"1.3", cube_right}});
    course.hand_in("none", {});
    course.hand_in("spaces",
                   {{"1.1", "inline double twice( double x ) {\n    // later\n  return x;\n}\n"}});
    // Wrong at -3 alone: of four parts, of which the stub has one, two more are right... but for
    // the seed's.
    course.hand_in("part",
                   {{"1.1", "inline double twice(double x) { return x < 0 ? 0 : 2 * x; }\n"}});
    // 1.3 is right, though the student's square is not.
    course.hand_in("upper", {{"1.2", "inline double square(double x) { return x + 1; }\n"},
                             {"1.3", cube_right}});
    // A law is wrong: as many items are right, but no more than half of the points are left.
    course.hand_in("law",
                   {{"1.1", "inline double twice(double x) { return x == 1 ? 0 : 2 * x; }\n"}});
    // 1.3 has a rule of its own; 1.1 is not to be had by way of a later exercise.
    course.hand_in("credit", {{"1.3", "    return 1;\n"}});
    course.hand_in("later", {{"1.1",
                              "double square(double);\ninline double twice(double x) {\n"
                              "    return square(x + 1) - square(x) - 1;\n}\n"}});
    course.hand_in("named",
                   {{"1.2", "inline double square(double x) { return x < 0 ? -3.5 : x; }\n"}});
    course.grade();
    for (const std::string exercise : {"1.1", "1.2", "1.3"})
        course.expect(
            {{"all", exercise, "right", -1, "right", "right"}, {"none", exercise, "", 0, "open"}});
    course.expect({{"all", "1.3", "", 6},
                   {"spaces", "1.1", "", -1, "open"},
                   {"part", "1.1", "", 2 * 2. / 3},
                   {"law", "1.1", "", 1},
                   {"credit", "1.3", "", 1.5},
                   {"later", "1.1", "", 0, "wrong", "wrong"},
                   {"upper", "1.2", "", 0},
                   {"upper", "1.3", "", 6, "", "wrong"}});
    CHECK(course.verdict("all", "1.1").line == "right: 4 of 4");
    CHECK(course.verdict("part", "1.1").line ==
          "wrong: this should hold: at -3: -6 expected, 0 came");
    CHECK(course.report("part").find("**wrong** (a quarter), exact: at \\-3") != std::string::npos);
    CHECK(course.verdict("named", "1.2").line ==
          "wrong: this is no square; read \\\"Squares\\\" in sheet 1");
    CHECK(course.csv() ==
          "student,number,1.1,1.2,1.3,sum,of,look at\r\nall,,2,4,6,12,12,\r\n"
          "credit,,0,0,1.5,1.5,12,\r\nlater,,0,0,0,0,12,\r\nlaw,,1,0,0,1,12,\r\n"
          "named,,0,2,0,2,12,\r\nnone,,0,0,0,0,12,\r\npart,,1.33,0,0,1.33,12,\r\n"
          "spaces,,0,0,0,0,12,\r\nupper,,0,0,6,6,12,\r\n");
}

TEST_CASE("whoever takes the time that an exercise allows is not stopped") {
    if (!sandboxed()) return;
    Course course("slow");
    const auto after = [](const char* seconds) {
        return "    static const long begun = ::clock();\n    while (::clock() < begun + " +
               std::string(seconds) + " * CLOCKS_PER_SEC) {}\n" + cube_right;
    };
    course.hand_in("slow", {{"1.2", square_right}, {"1.3", after("5")}});
    course.hand_in("too slow", {{"1.2", square_right}, {"1.3", after("1000")}});
    course.grade();
    course.expect({{"slow", "1.3", "", 6}, {"too slow", "1.3", "processor time", 0}});
}

TEST_CASE("only regions are taken: not the rest of the file, nor tests, Makefile or judge") {
    if (!sandboxed()) return;
    Course course("regions");
    course.hand_in("a b", {{"1.1", whole}});
    std::string text = read_file(course.path("a b", "src/world/numbers.h"));
    text.insert(text.find("// BEGIN"), "#include \"nowhere.h\"\n#define square(x) ((x) * (x))\n");
    course.write("a b", "src/world/numbers.h", text);
    course.write("a b", "src/base/vec.h", "#error\n");
    course.write("a b", "tests/course/judge_1.cpp", "int main() {}\n");
    course.write("a b", "tests/course/exercises.txt",
                 "1.2 | Square | world/numbers.h | | 99 | 1\n");
    course.write("a b", "Makefile", "$(shell touch /tmp/penumbra-was-here)\n");
    course.hand_in("dos", {{"1.1", whole}});
    text = read_file(course.path("dos", "src/world/numbers.h"));
    for (size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 2) text.insert(at, "\r");
    course.write("dos", "src/world/numbers.h", text);
    course.hand_in("latin", {{"1.1", "// M\xfcller\n" + whole}});
    course.grade();
    for (const std::string name : {"a b", "dos", "latin"})
        course.expect({{name, "1.1", "", 2}, {name, "1.2", "", 0}});
    CHECK(course.csv().find("a b,,2,0,0,2,12,") != std::string::npos);
}

TEST_CASE("files and marks that are not as they should be have a verdict, and spoil nothing else") {
    if (!sandboxed()) return;
    Course course("marks");
    const std::string square = open("1.2", square_right);
    const struct {
        const char *name, *twice, *line;
    } marks[] = {
        {"missing", whole.c_str(), "has no line \\\"// BEGIN 1.1\\\""},
        {"endless", "// BEGIN 1.1\n", "has no line \\\"// END 1.1\\\""},
        {"doubled", "// BEGIN 1.1\n// END 1.1\n// BEGIN 1.1\n// END 1.1\n",
         "BEGIN 1.1\\\" 2 times"},
        {"two ends", "// BEGIN 1.1\n// END 1.1\n// END 1.1\n", "END 1.1\\\" 2 times"},
        {"backwards", "// END 1.1\n// BEGIN 1.1\n", "stands before its BEGIN"},
        {"nested", "// BEGIN 1.1\n// BEGIN 3.1\n// END 1.1\n",
         "another mark (BEGIN 3.1) lies in the region"},
    };
    for (const auto& m : marks) {
        course.hand_in(m.name, {});
        course.write(m.name, "src/world/numbers.h", numbers_h(m.twice, square));
    }
    course.hand_in("large",
                   {{"1.1", "//" + std::string(70000, 'x') + "\n"}, {"1.2", square_right}});
    course.hand_in("zero", {{"1.1", whole + std::string(1, '\0')}});
    course.hand_in("bell", {{"1.1", whole + "\a\n"}, {"1.2", square_right}});
    course.hand_in("huge", {{"1.1", "//" + std::string(1 << 20, 'x') + "\n"}});
    course.grade();
    for (const auto& m : marks) course.expect({{m.name, "1.1", m.line, 0}, {m.name, "1.2", "", 4}});
    course.expect({{"large", "1.1", "more than 65536 bytes"},
                   {"large", "1.2", "", 4},
                   {"zero", "1.1", "holds NUL bytes"},
                   {"bell", "1.1", "line 7 of src/world/numbers.h holds a control character"},
                   {"bell", "1.2", "", 4},
                   {"huge", "1.1", "more than 1048576 bytes"}});
}

TEST_CASE("links, pipes and folders in the place of files are not opened") {
    if (!sandboxed()) return;
    Course course("links");
    const std::string right = house().folder / "elsewhere.h";
    house().folder.write("elsewhere.h", numbers_h(open("1.1", whole), open("1.2", square_right)));
    house().folder.write("else/world/numbers.h",
                         numbers_h(open("1.1", whole), open("1.2", square_right)));
    for (const char* name : {"file", "pipe", "folder", "inner", "closed"}) {
        course.hand_in(name, {{"1.3", cube_right}});
        fs::remove(course.path(name, "src/world/numbers.h"));
    }
    fs::create_symlink(right, course.path("file", "src/world/numbers.h"));
    REQUIRE(::mkfifo(course.path("pipe", "src/world/numbers.h").c_str(), 0600) == 0);
    fs::create_directory(course.path("folder", "src/world/numbers.h"));
    fs::remove(course.path("inner", "src/world"));
    fs::create_directory_symlink(house().folder / "else/world", course.path("inner", "src/world"));
    fs::create_directory_symlink(
        house().folder / (course.in + "/file"),
        course.path("link", "").substr(0, course.path("link", "").size() - 1));
    house().folder.write(course.in + "/notes.txt", "none");
    fs::create_directory(house().folder / (course.in + "/empty"));
    course.grade();
    for (const auto& [name, line] : Regions{{"file", "numbers.h is a link"},
                                            {"pipe", "numbers.h is no regular file"},
                                            {"folder", "numbers.h is no regular file"},
                                            {"inner", "src/world/numbers.h"},
                                            {"closed", "numbers.h is missing"},
                                            {"link", "the submission is a link"},
                                            {"notes.txt", "neither a folder nor an archive"},
                                            {"empty", "holds no src/"}})
        course.expect({{name, "1.1", line, 0}, {name, "1.2", "", 0}});
    for (const std::string name : {"file", "pipe", "folder", "inner", "closed"})
        course.expect({{name, "1.3", "", 6}});
}

TEST_CASE("archives are read, not unpacked; a folder may have another name") {
    if (!sandboxed()) return;
    Course course("archives");
    const std::string at = "cd '" + house().folder / course.in + "' && ";
    course.hand_in("deep", {{"1.1", whole}}, "homework of mine/penumbra-starter/");
    course.hand_in("x", {{"1.1", whole}});
    shell(at +
          "tar czf 'ann b.tar.gz' x && tar czf up.tar.gz --transform 's,^x,../../x,' -P x && "
          "head -c 1000 /dev/zero >zero.tar.gz");
    shell(at +
          "cp x/src/path/cube.h solution.h && mkdir y && cp -r x/src y && ln -sf "
          "../../../solution.h y/src/path/cube.h && "
          "ln -f y/src/world/numbers.h y/hard.h && tar czf links.tar.gz y/hard.h y && rm -r x y "
          "solution.h");
    course.grade();
    for (const std::string name : {"deep", "ann b"})
        course.expect({{name, "1.1", "", 2}, {name, "1.2", "", -1, "open"}});
    course.expect({{"up", "1.1", "holds no src/"},
                   {"zero", "1.1", "", 0},
                   {"links", "1.1", "numbers.h is a link"},
                   {"links", "1.3", "cube.h is a link"}});
    CHECK(!fs::exists(house().folder / "x"));
    CHECK(!fs::exists(house().folder.path.parent_path() / "x"));
}

TEST_CASE(
    "numbers of students go into tables for Moodle and Canvas; what is to be looked at is "
    "flagged") {
    if (!sandboxed()) return;
    Course course("tables");
    course.hand_in("Ada Lovelace_4711_assignsubmission_file_", {{"1.1", whole}}, "penumbra/");
    course.hand_in("ann", {{"1.1", whole}});
    shell("cd '" + house().folder / course.in +
          "' && mkdir x_12_assignsubmission_file_ && head -c 99 /dev/urandom "
          ">x_12_assignsubmission_file_/x.zip");
    fs::remove(course.path("ann", "src/path/cube.h"));
    // What is as short as the last two may be equal by chance.
    const std::string mine = std::regex_replace(twice_right, std::regex("sum|\\bx\\b"), "my$&");
    course.hand_in("copy",
                   {{"1.1", "// mine\n" + mine}, {"1.2", square_right}, {"1.3", cube_right}});
    // A copy is one, though it is refused; what both left open is none.
    std::string ours = std::regex_replace(twice_right, std::regex("0;"), "x - x; asm(\"\");");
    course.hand_in("one", {{"1.1", ours}});
    course.hand_in("other", {{"1.1", std::regex_replace(ours, std::regex("sum"), "total")}});
    course.hand_in("honest", {{"1.1", whole}, {"1.2", square_right}, {"1.3", cube_right}});
    course.hand_in("hostile",
                   {{"1.1", "asm(\"hlt\");\n" + whole},
                    {"1.2", "inline double square(double) { std::exit(0); }\n"},
                    {"1.3", "    static char a[1ull << 33] = {1};\n    return a[0];\n"}});
    course.grade();
    INFO(course.said.out);
    CHECK(course.said.has("8 submissions, 3 exercises"));
    CHECK(course.said.has("6 to look at"));
    const std::string reserved =
        " of src/world/numbers.h holds asm: names that C++ and compilers reserve are not allowed "
        "in a region";
    CHECK(course.csv() ==
          "student,number,1.1,1.2,1.3,sum,of,look at\r\nAda Lovelace,4711,2,0,0,2,12,\r\n"
          "ann,,2,0,0,2,12,1.3: src/path/cube.h is missing\r\n"
          "copy,,2,4,6,12,12,all: equal to the published solution\r\nhonest,,2,4,6,12,12,\r\n"
          "hostile,,0,0,0,0,12,\"1.1: refused: line 6" +
              reserved +
              "; 1.2: hostile? square(0), ... ends the program, with exit status 0; 1.3: the "
              "program would have more than 64 MB\"\r\n"
              "one,,0,0,0,0,12,1.1: refused: line 7" +
              reserved +
              "; 1.1: equal to that of other\r\n"
              "other,,0,0,0,0,12,1.1: refused: line 7" +
              reserved +
              "; 1.1: equal to that of one\r\n"
              "x,12,0,0,0,0,12,all: the archive is damaged\r\n");
    const std::string who =
        "6 of 8 students have no number, and are not in moodle.csv and "
        "canvas.csv. Grade the folder";
    CHECK(course.said.has(who));
    CHECK(house().folder.read(course.out + "/without-number.txt").find(who) == 0);
    // Moodle takes no table without dates, and keeps grades that are newer than these.
    const std::regex date(R"(,20\d\d-\d\d-\d\d \d\d:\d\d:\d\d \+0000,)");
    CHECK(std::regex_replace(house().folder.read(course.out + "/moodle.csv"), date, ",DATE,") ==
          "Identifier,Full name,Grade,Maximum Grade,Last modified (grade),Feedback comments\r\n"
          "Participant 4711,Ada Lovelace,2,12,DATE,1.1: 2 of 2; 1.2: 0 of 4; 1.3: 0 of 6\r\n"
          "Participant 12,x,0,12,DATE,1.1: 0 of 2; 1.2: 0 of 4; 1.3: 0 of 6\r\n");
    CHECK(house().folder.read(course.out + "/canvas.csv") ==
          "Student,ID,SIS User ID,SIS Login ID,Section,Penumbra\r\n"
          "    Points Possible,,,,,12\r\nAda Lovelace,4711,,,,2\r\nx,12,,,,0\r\n");

    // A table without students would be taken for one: it is not there, and something says why.
    const auto written = [&](const std::string& name) {
        return house().folder.has(course.out + "/" + name);
    };
    const auto submitted = [&](const std::string& name) {
        return fs::path(house().folder / (course.in + "/" + name));
    };
    CHECK(written("jplag/copy/1.1.cpp"));
    CHECK(written("jplag-base/1.1.cpp"));
    CHECK(house().folder.read(course.out + "/class.md").find("# 8 submissions, 12 points\n") == 0);
    for (const char* name :
         {"Ada Lovelace_4711_assignsubmission_file_", "x_12_assignsubmission_file_", "ann", "copy",
          "hostile", "one", "other"})
        fs::remove_all(submitted(name));
    course.grade();
    CHECK(!written("moodle.csv"));
    CHECK(!written("canvas.csv"));
    CHECK(course.said.has("No student has a number: moodle.csv and canvas.csv are not written."));
    fs::rename(submitted("honest"), submitted("honest_4711"));
    course.grade();
    CHECK(written("moodle.csv"));
    CHECK(written("canvas.csv"));
    CHECK(!written("without-number.txt"));
    CHECK(!course.said.has("canvas.csv"));
}

TEST_CASE("compilers' words: only those about the student's lines, by the lines of his file") {
    if (!sandboxed()) return;
    Course course("messages");
    course.hand_in(
        "type", {{"1.1", "// one\n// two\ninline double twice(double x) {\n    return y;\n}\n"}});
    course.hand_in("brace", {{"1.1", "inline double twice(double x) { return 2 * x;\n"}});
    std::string flood;
    for (int i = 0; i < 1000; ++i) flood += "int <b>=;\n";
    course.hand_in("flood", {{"1.1", flood}});
    course.hand_in("probing", {{"1.1", "inline double twice(double x) { return square; }\n"}});
    course.hand_in("header", {{"1.1",
                               "inline double twice(double x) {\n    std::mt19937 random;\n"
                               "    return 2 * x;\n}\n"}});
    course.grade();
    CHECK(course.verdict("type", "1.1").line == "does not compile");
    for (const std::string name : {"type", "brace", "flood", "probing", "header"}) {
        const std::string report = course.report(name);
        INFO(report);
        course.expect({{name, "1.1", "", -1, "not compiled"}});
        CHECK(report.find("cipher") == report.npos);
        CHECK(report.size() < 4000);
        if (name == "type")
            CHECK(report.find("src/world/numbers.h:9: 'y' was not declared in this scope\n") !=
                  report.npos);
        const bool why = report.find("; a region has only what its file includes") != report.npos;
        CHECK(why == (name == "header"));
    }
    CHECK(course.report("flood").find("<b>") == std::string::npos);
}

TEST_CASE("names are text, in files, tables and reports") {
    if (!sandboxed()) return;
    Course course("names");
    for (const char* name : {"=1+1", "-rf", "a,b \"c\"", "gr\xc3\xbc\xc3\x9f", "\xff", "<i>|x|",
                             "new\nline", "grades.csv"})
        course.hand_in(name, {{"1.1", whole}});
    course.grade();
    const std::string csv = course.csv();
    INFO(csv);
    for (const char* row :
         {"\n'=1+1,,2,", "\n'-rf,,2,", "\n\"a,b \"\"c\"\"\",,2,", "\ngr\xc3\xbc\xc3\x9f,,2,",
          "\n<i>|x|,,2,", "\nnew line,,2,", "\ngrades.csv,,2,"})
        CHECK(csv.find(row) != csv.npos);
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 9);
    CHECK(course.report("<i>|x|").find("# &lt;i>\\|x\\|: 2 of 12 points") == 0);
}

TEST_CASE("200 submissions; killed and begun again, none is graded twice") {
    if (!sandboxed()) return;
    Course course("many");
    std::vector<std::string> names;
    for (int i = 0; i < 200; ++i) {
        names.push_back("s" + std::to_string(1000 + i).substr(1));
        const std::string factor = std::to_string(i % 9);
        course.hand_in(names.back(), {{"1.1", i % 2 ? whole
                                                    : "inline double twice(double x) { return " +
                                                          factor + " * x; }\n"}});
    }
    shell("cd '" + house().folder.path.string() + "' && (" + house().command("", course.words()) +
          " >said 2>&1 & echo $! >pid; until [ -e " + course.out +
          "/students/s020/grade.json ]; do kill -0 $! || exit 1; sleep 0.1; done; "
          "kill -9 $!; wait $!; true)");
    const auto written = [&](const std::string& name) {
        return fs::last_write_time(house().folder /
                                   (course.out + "/students/" + name + "/grade.json"));
    };
    std::map<std::string, fs::file_time_type> done;
    for (const std::string& name : names)
        if (course.graded(name)) done[name] = written(name);
    REQUIRE(done.size() > 20);
    REQUIRE(done.size() < 200);
    course.grade();
    CHECK(course.said.has("200 of 200  s199: 2 of 12 points, "));
    CHECK(course.said.has(" left\n"));
    CHECK(course.said.has("200 students, " + std::to_string(200 - done.size()) + " graded now"));
    for (const auto& [student, time] : done) CHECK(written(student) == time);
    const std::string csv = course.csv();
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 201);
    for (int i = 0; i < 200; ++i)
        course.expect({{names[size_t(i)], "1.1", "", i % 2 || i % 9 == 2 ? 2.0 : 0.0}});

    // Who hands in again is graded again, alone.
    course.hand_in("s003", {{"1.1", whole}, {"1.2", square_right}});
    course.grade();
    CHECK(course.said.has(" 1 graded now"));
    course.expect({{"s003", "1.2", "", 4}});
    course.grade("--seed 5");
    CHECK(course.said.has(" 200 graded now"));
    CHECK(lines_of(course.report("s003"), "Seed 5,") != "");
}

TEST_CASE("seeds are fresh, unless one is given or a grading goes on") {
    if (!sandboxed()) return;
    Course one("seed1"), two("seed2");
    one.hand_in("x", {}), two.hand_in("x", {});
    one.grade(), two.grade();
    const std::string seed = house().folder.read(one.out + "/seed");
    CHECK(seed.size() > 8);
    CHECK(seed != house().folder.read(two.out + "/seed"));
    one.grade();
    CHECK(seed == house().folder.read(one.out + "/seed"));
    CHECK(one.said.has("1 student, 0 graded now"));
}

TEST_CASE("without bubblewrap nothing is compiled or run, and it is said what to do") {
    Course course("without");
    course.hand_in("x", {{"1.1", whole}});
    fs::create_directory(house().folder / "programs");
    const std::string link = " '" + house().folder / "programs" + "/";
    shell("ln -sf \"$(python3 -c 'import sys; print(sys.executable)')\"" + link + "python3'");
    for (const std::string name : {"g++", "as", "ld", "prlimit", "timeout"})
        shell("ln -sf \"$(command -v " + name + ")\"" + link + name + "'");
    course.said =
        house().grade("--out " + course.out + " '" + course.in + "'", house().folder / "programs");
    INFO(course.said.out);
    CHECK(course.said.status == 2);
    CHECK(course.said.has("install bubblewrap (apt install bubblewrap)"));
    CHECK(!course.graded("x"));

    // One that the system lets make no namespaces.
    house().folder.write(
        "programs/bwrap",
        "#!/bin/sh\necho 'bwrap: setting up uid map: Permission denied' >&2\nexit 1\n");
    fs::permissions(house().folder / "programs/bwrap", fs::perms::owner_all);
    house().folder.write("ask.py",
                         "import os, sys\nsys.path.insert(0, 'src/course')\nimport sandbox\n"
                         "os.geteuid = lambda: 1000\ntry: sandbox.demand()\n"
                         "except sandbox.Missing as error: print(error)\n");
    shell("cd '" + house().folder.path.string() +
          "' && PATH=\"$PWD/programs\" python3 ask.py >said");
    course.said.out = house().folder.read("said");
    for (const std::string part :
         {"setting up uid map: Permission denied", "kernel.unprivileged_userns_clone=1",
          "kernel.apparmor_restrict_unprivileged_userns=0", "userns,", "as root"})
        CHECK_MESSAGE(course.said.has(part), "it does not say: " << part);

    // Root can become another user, and says so.
    course.said =
        house().grade("--out " + course.out + " '" + course.in + "'", house().folder / "programs");
    INFO(course.said.out);
    CHECK(course.said.status == (::geteuid() == 0 ? 0 : 2));
    CHECK(course.said.has("weaker sandbox") == (::geteuid() == 0));
    CHECK(course.graded("x") == (::geteuid() == 0));
}

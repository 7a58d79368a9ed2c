// course/classroom.h  a house of three exercises, whose grader is ours, and students who hand in
//
// 1.1 twice(x), 2 points; 1.2 square(x), 4 points; 1.3 cube(x), by square, 6 points.
#pragma once
#include "text/folder.h"

namespace classroom {

// Long enough to be no chance.
inline const std::string twice_right =
    "inline double twice(double x) {\n    double sum = 0;\n    for (int i = 0; i < 2; ++i) {\n"
    "        sum += x;\n    }\n    if (!(sum == sum)) {\n        return x;\n    }\n    return "
    "sum;\n}\n";
inline const std::string twice_stub = "inline double twice(double x) { return x; }\n";
inline const std::string square_right =
    "inline double square(double x) {\n    const double cipher = x;\n    return cipher * x;\n}\n";
inline const std::string square_stub = "inline double square(double x) { return x; }\n";
inline const std::string cube_right = "    return x * square(x);\n";
inline const std::string cube_stub = "    return square(x);\n";

// A region as it stands in the solution.
inline std::string solved(const std::string& number, const std::string& solution) {
    return "// exercise " + number + "\n" + solution + "// end\n";
}
// And as it is handed in.
inline std::string open(const std::string& number, const std::string& code) {
    return "// BEGIN " + number + "  what it is\n" + code + "// END " + number + "\n";
}
inline std::string numbers_h(const std::string& twice, const std::string& square) {
    return "// world/numbers.h  1  numbers\n#pragma once\n#include \"base/vec.h\"\n\n" + twice +
           "\n" + square;
}
inline std::string cube_h(const std::string& cube) {
    return "// path/cube.h  1  cubes\n#pragma once\n#include \"world/numbers.h\"\n\n"
           "inline double cube(double x) {\n" +
           cube + "}\n";
}

using Regions = std::map<std::string, std::string>;
inline const Regions stubs{{"1.1", twice_stub}, {"1.2", square_stub}, {"1.3", cube_stub}};

inline const char* answers = R"(
 #include <ctime>

 #include "course/answers.h"
 #include "path/cube.h"
using namespace penumbra;

int main() {
    return course::answer_all({
        {"twice", 1, [](course::In x) { return twice(x[0]); }},
        {"square", 1, [](course::In x) { return square(x[0]); }},
        {"cube", 1, [](course::In x) { return cube(x[0]); }},
    });
}
)";
inline const char* judge = R"(
 #include "course/judge.h"
using namespace penumbra;

// Of a function's answers: at 0, at 1, at -3, and at numbers that the seed draws.
course::Judging answers_like(const std::string& name, double (*truth)(double)) {
    return [=](course::Judge& j) {
        const course::Rows came = j.probe(name, {{0}, {1}, {-3}});
        j.number("at 0", came.numbers[0], truth(0), 1e-12);
        j.number("at 1", came.numbers[1], truth(1), 1e-12);
        j.number("at -3", came.numbers[2], truth(-3), 1e-12);
        j.limit();
        course::Rows drawn;
        for (int i = 0; i < 20; ++i) drawn.add({10 * j.random()});
        const course::Rows answers = j.ask(name, drawn);
        double off = 0;
        for (size_t i = 0; i < drawn.size(); ++i)
            off = course::worse(off, std::abs(answers[i][0] - truth(drawn[i][0])));
        j.exact("at numbers of the seed", off < 1e-9);
        if (name == "cube") j.credit = came.numbers[1] == 1 ? 0.25 : 0, j.allows = 5;
    };
}

int main(int argc, char** argv) {
    return course::judge(argc, argv, {{"1.1", answers_like("twice", [](double x) { return 2 * x; })},
                                      {"1.2", answers_like("square", [](double x) { return x * x; })},
                                      {"1.3", answers_like("cube", [](double x) { return x * x * x; })}});
}
)";

// What a grader said of one exercise.
struct Verdict {
    std::string line, state, together;
    double points = -1;
};
// What is expected of it: part of its line, and what is said of the rest.
struct Expected {
    std::string student, exercise, line;
    double points = -1;
    std::string state = "", together = "";
};

struct Said {
    int status = -1;
    std::string out;
    bool has(const std::string& part) const { return out.find(part) != out.npos; }
};

// The house is built once for all test cases: its cache is kept.
struct House {
    Folder folder;
    House() {
        fs::create_directories(folder / "src");
        fs::create_directories(folder / "tests");
        for (const char* part : {"src/base", "tests/oracle"})
            fs::copy(part, folder / part, fs::copy_options::recursive);
        fs::create_directories(folder / "src/course");
        for (const auto& entry : fs::directory_iterator("src/course"))
            if (entry.path().extension() == ".py")
                folder.write("src/course/" + entry.path().filename().string(),
                             read_file(entry.path().string()));
        for (const char* name : {"beside.cpp", "course.mk"})
            folder.write(std::string("src/course/") + name, "// nothing\n");
        for (const std::string name :
             {"film", "app", "many", "mesh", "check", "replay", "show", "web", "text"})
            folder.write("src/" + name + "/nothing.h", "// " + name + "/nothing.h  1  nothing\n");
        for (const char* name : {"read_pfm.h", "pair.h"})
            folder.write(std::string("src/keep/") + name, "// nothing\n");
        folder.write("src/world/numbers.h",
                     numbers_h(solved("1.1", twice_right), solved("1.2", square_right)));
        folder.write("src/path/cube.h", cube_h(solved("1.3", cube_right)));
        std::string week;
        for (const auto& [number, stub] : stubs)
            week += "// " + number + "  what it is\n// instead: something else\n" + stub + "\n";
        folder.write("src/course/stubs/1", week);
        for (const char* name : {"answers.h", "judge.h", "program.h", "rows.h"})
            folder.write(std::string("tests/course/") + name,
                         read_file(std::string("tests/course/") + name));
        folder.write("tests/course/answers_1.cpp", answers);
        folder.write("tests/course/judge_1.cpp", judge);
        folder.write("tests/course/mistakes.txt",
                     "1.2\tlinear\tthis is no square\tSquares\t0\t1\t-3.5\n");
        folder.write(
            "tests/course/exercises.txt",
            "1.1 | Twice | world/numbers.h | | 2 | 1\n1.2 | Square | world/numbers.h | | 4 | 1\n"
            "1.3 | Cube | path/cube.h | 1.2 | 6 | 1\n");
    }
    // python3 src/course/grade.py with these words.
    static std::string command(const std::string& before, const std::string& words) {
        return "CXX=g++ FLAGS='-std=c++20 -DREAL=double -Isrc -Itests -w -O0 -pthread' " + before +
               " python3 src/course/grade.py --cache cache " + words;
    }
    Said grade(const std::string& words, const std::string& path = "$PATH") const {
        const int status =
            std::system(("cd '" + folder.path.string() + "' && PATH=\"" + path + "\" " +
                         command("timeout -k 5 280", "--jobs 2 " + words) + " >said 2>&1")
                            .c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, folder.read("said")};
    }
};
inline const House& house() {
    static const House one;
    return one;
}

// Whether programs can be confined here, in this way; says so where not.
inline bool sandboxed(const std::string& way = "namespaces") {
    static std::map<std::string, bool> known;
    if (!known.count(way))
        known[way] =
            std::system(
                ("python3 -c 'import sys; sys.path.insert(0, \"src/course\"); import sandbox; "
                 "sandbox.demand(\"" +
                 way + "\")' >/dev/null 2>&1")
                    .c_str()) == 0;
    if (!known[way])
        MESSAGE("not tested: " << (way == "user"
                                       ? "only root can become another user"
                                       : "bubblewrap is missing, or may not make namespaces here"));
    return known[way];
}

// A folder of submissions, in the house.
struct Course {
    std::string in, out;
    Said said;

    explicit Course(const std::string& name) : in("in " + name), out("out-" + name) {
        fs::remove_all(house().folder / in);
        fs::remove_all(house().folder / out);
        fs::create_directories(house().folder / in);
    }
    // src/ of a student who replaced these regions; the others are stubs.
    void hand_in(const std::string& student, Regions regions, const std::string& root = "") const {
        regions.insert(stubs.begin(), stubs.end());
        write(student, root + "src/world/numbers.h",
              numbers_h(open("1.1", regions["1.1"]), open("1.2", regions["1.2"])));
        write(student, root + "src/path/cube.h", cube_h(open("1.3", regions["1.3"])));
    }
    void write(const std::string& student, const std::string& file,
               const std::string& bytes) const {
        house().folder.write(in + "/" + student + "/" + file, bytes);
    }
    std::string path(const std::string& student, const std::string& file) const {
        return house().folder / (in + "/" + student + "/" + file);
    }
    std::string words() const { return " --out " + out + " '" + in + "'"; }
    void grade(const std::string& more = "") {
        said = house().grade(more + words());
        INFO(said.out);
        REQUIRE(said.status == 0);
    }
    bool graded(const std::string& student) const {
        return house().folder.has(out + "/students/" + student + "/grade.json");
    }
    std::string report(const std::string& student, const std::string& end = "md") const {
        return house().folder.read(out + "/students/" + student + "/grade." + end);
    }
    std::string csv() const { return house().folder.read(out + "/grades.csv"); }
    Verdict verdict(const std::string& student, const std::string& exercise) const {
        const std::string json = report(student, "json");
        const size_t at = json.find("\"" + exercise + "\": {");
        REQUIRE(at != json.npos);
        const auto value = [&](const std::string& key) {
            const size_t begin = json.find("\"" + key + "\": ", at) + key.size() + 4;
            const std::string text = json.substr(begin, json.find('\n', begin) - begin);
            const size_t comma = text.back() == ',' ? 1 : 0;
            return text[0] == '"' ? text.substr(1, text.size() - 2 - comma)
                                  : text.substr(0, text.size() - comma);
        };
        return {value("line"), value("state"), value("together"), std::stod(value("points"))};
    }
    void expect(const std::vector<Expected>& all) const {
        for (const Expected& e : all) {
            const Verdict v = verdict(e.student, e.exercise);
            INFO(e.student, ", ", e.exercise, ": ", v.line);
            CHECK_MESSAGE(v.line.find(e.line) != v.line.npos, "it does not say: " << e.line);
            if (e.points >= 0) CHECK(v.points == doctest::Approx(e.points));
            if (!e.state.empty()) CHECK(v.state == e.state);
            if (!e.together.empty()) CHECK(v.together == e.together);
        }
    }
};

}  // namespace classroom

// oracle/compile_test.cpp  what compiles with the oracle, without warnings, and what must not
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace {

const std::string folder = "build/oracle-compile";

// Runs a command in a folder of its own; its output follows in `log`.
struct Ran {
    bool well;
    std::string log;
};
Ran run(const std::string& command) {
    const bool well = std::system(("mkdir -p " + folder + " && cd " + folder + " && { " + command +
                                   "; } >log 2>&1")
                                      .c_str()) == 0;
    std::ifstream log(folder + "/log");
    return {well, std::string(std::istreambuf_iterator<char>(log), {})};
}
void write(const std::string& name, const std::string& text) {
    REQUIRE(run("true").well);
    std::ofstream(folder + "/" + name) << text;
}
const std::string compile = "c++ -std=c++20 -I../../tests -I../../tests/oracle ";

}  // namespace

TEST_CASE("oracle.h is what make puts together now") {
    const Ran made =
        run("mkdir -p single && rm -f single/oracle.h && env -u MAKEFLAGS -u MAKELEVEL "
            "make -s -C ../.. " +
            folder + "/single/oracle.h");
    INFO(made.log);
    REQUIRE(made.well);
    CHECK(run("cmp single/oracle.h ../../tests/oracle/oracle.h").well);
}

TEST_CASE("what is no part of the interface is found in detail alone") {
    for (const auto& [name, found] : {std::pair{"oracle::", false}, {"oracle::detail::", true}}) {
        write("inside.cpp", std::string("#include \"oracle/oracle.h\"\n") +
                                "const double p = " + name + "gamma_q(1, 1);\n");
        CHECK(run(compile + "-fsyntax-only inside.cpp").well == found);
    }
}

TEST_CASE("two files: one has the checks, the other links to them") {
    write("check.cpp", R"(
#include "oracle/oracle.h"
bool FUNCTION(double factor) {
    oracle::Random random(1);
    auto sample = [](double u) { return -std::log1p(-u); };
    auto pdf = [=](double x) { return x < 0 ? 0 : factor * std::exp(-x); };
    return oracle::expect_density(random, sample, pdf, {.sees = 0.05}).pass;
}
)");
    write("main.cpp", R"(
bool first(double), second(double);
int main() { return first(1) && second(1) && !second(1.1) ? 0 : 1; }
)");
    CHECK(run(compile + "-DFUNCTION=first -DORACLE_CHECKS= -c check.cpp -o first.o").well);
    CHECK(run(compile + "-DFUNCTION=second -DORACLE_CHECKS=extern -c check.cpp -o second.o").well);
    CHECK(run(compile + "main.cpp first.o second.o -o both && ./both").well);
    // Defined in the first, undefined in the second.
    const std::string run_of = " oracle::.*DensityCheck<1ul, 1ul, .*>::run()'";
    CHECK(run("nm -C first.o | grep -q ' [TW]" + run_of).well);
    CHECK(run("nm -C second.o | grep -q ' U" + run_of).well);
}

TEST_CASE("frameworks: the lines of README.md pass what is right, and print what is wrong") {
    std::ifstream page("tests/oracle/README.md");
    const std::string host = R"(
#include <cmath>
#include <cstdlib>
struct Vec { float x, y, z; };
Vec sample_cosine(float u, float v) {
    const float r = std::sqrt(u), phi = 6.2831853f * v;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)};
}
float pdf_cosine(Vec w) { return w.z > 0 ? w.z / (std::getenv("WRONG") ? 1 : 3.14159265f) : 0; }
)";
    std::vector<std::string> blocks;
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
        if (inside && line != "```") blocks.back() += line + "\n";
        if (line == "```c++") blocks.emplace_back();
        inside = line == "```c++" || (inside && line != "```");
    }
    REQUIRE(blocks.size() == 3);
    auto has = [](const std::string& header) {
        write("has.cpp", "#include <" + header + ">\n");
        return run(compile + "-fsyntax-only has.cpp").well;
    };
    auto check = [&](const std::string& name, std::string text, const std::string& link) {
        write(name + ".cpp", host + text);
        const Ran built = run(compile + name + ".cpp -o " + name + " -pthread " + link);
        INFO(name, ": ", built.log);
        REQUIRE(built.well);
        CHECK(run("./" + name).well);
        const Ran wrong = run("WRONG=1 ./" + name);
        CHECK(!wrong.well);
        CHECK(wrong.log.find("the pdf is 3.142 (pi) times the density") != std::string::npos);
    };
    check("doctest", "#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN\n" + blocks[0], "");
    if (has("gtest/gtest.h"))
        check("gtest", blocks[1], "-lgtest -lgtest_main");
    else
        MESSAGE("skipped: GoogleTest is not installed (libgtest-dev)");
    const std::string three = "<catch2/catch_test_macros.hpp>";
    if (has("catch2/catch_test_macros.hpp"))
        check("catch2", blocks[2], "-lCatch2Main -lCatch2");
    else if (has("catch2/catch.hpp"))  // Debian 12 has version 2: the same lines, another header
        check("catch2",
              "#define CATCH_CONFIG_MAIN\n" +
                  blocks[2].replace(blocks[2].find(three), three.size(), "<catch2/catch.hpp>"),
              "");
    else
        MESSAGE("skipped: Catch2 is not installed (catch2)");
}

TEST_CASE("types that the oracle cannot use are refused in one sentence, before all else") {
    const std::string begin = R"(
#include "oracle/oracle.h"
struct Vec { float x, y, z; };
struct Odd { float a, b, c; };
class Closed { double v[3] = {}; public: double operator[](size_t i) const { return v[i]; } };
oracle::Random r(1);
auto sample = [](float u, float v) { return Vec{u, v, 1}; };
auto pdf = [](Vec) { return 1.0f; };
float* pointer = nullptr;
void check() { (void)oracle::)";
    const std::pair<std::string, std::string> wrong[] = {
        {"expect_density(r, [](float u, float v) { return Odd{u, v, 1}; }, [](Odd) { return 1; })",
         "cannot read the coordinates of this vector"},
        {"expect_density(r, [](float, float) { return Closed{}; }, [](Closed) { return 1; })",
         "cannot make this vector from its coordinates"},
        {"expect_density(r, sample, [](float cosine) { return cosine; })",
         "pdf takes the point or direction that sample returns, and returns a number"},
        {"expect_density(r, pdf, sample)", "after random come sample, then pdf"},
        {"expect_density(r, [](Vec*) { return Vec{}; }, pdf)", "sample takes numbers u, v, ..."},
        {"expect_image(4, 2, pointer, pointer, pointer)", "pass std::span(pointer, length)"}};
    write("right.cpp", begin + "expect_density(r, sample, pdf); }\n");
    CHECK(run(compile + "-fsyntax-only right.cpp").well);
    for (const auto& [call, sentence] : wrong) {
        write("wrong.cpp", begin + call + "; }\n");
        const Ran ran = run(compile + "-fsyntax-only wrong.cpp");
        const std::string first = ran.log.substr(std::min(ran.log.find("error"), ran.log.size()));
        INFO(call, "\n", ran.log);
        CHECK(!ran.well);
        CHECK(first.substr(0, first.find('\n')).find(sentence) != std::string::npos);
    }
}

TEST_CASE("no warning by any compiler that is here, and macros of the host stay as they are") {
    write("macros.cpp", R"(
#define pi 3
#define min(a, b) ((a) < (b) ? (a) : (b))
#define max(a, b) ((a) > (b) ? (a) : (b))
#define near
#define far
#include "oracle/oracle.h"
#if !defined(pi) || !defined(min) || !defined(max) || !defined(near) || !defined(far)
#error a macro is gone
#endif
static_assert(max(pi, 2) == 3 && ORACLE_VERSION >= 20200);
)");
    const std::string every =
        " -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Wshadow -Wconversion "
        "-Wsign-conversion -Werror -DREAL=double ";
    for (const std::string compiler : {"g++", "clang++-14", "clang++-19"}) {
        if (!run(compiler + " --version").well) continue;
        for (const std::string file : {"-I../../tests macros.cpp",
                                       "-I../../tests ../../tests/oracle/examples_test.cpp"}) {
            const Ran ran = run(compiler + every + file);
            INFO(compiler, " ", file, "\n", ran.log);
            CHECK(ran.well);
        }
    }
}

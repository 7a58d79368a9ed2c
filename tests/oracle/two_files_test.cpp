// oracle/two_files_test.cpp  of a program of two files one compiles the checks of densities for
// both
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <string>

TEST_CASE("two files: one has the checks, the other links to them") {
    const std::string folder = "build/two-files";
    auto run = [](const std::string& command) { return std::system(command.c_str()); };
    REQUIRE(run("rm -rf " + folder + " && mkdir -p " + folder) == 0);
    std::ofstream(folder + "/check.cpp") << R"(
#include "oracle/oracle.h"
bool FUNCTION(double factor) {
    oracle::Random random(1);
    auto sample = [](double u) { return -std::log1p(-u); };
    auto pdf = [=](double x) { return x < 0 ? 0 : factor * std::exp(-x); };
    return oracle::expect_density(random, sample, pdf, {.sees = 0.05}).pass;
}
)";
    std::ofstream(folder + "/main.cpp") << R"(
bool first(double), second(double);
int main() { return first(1) && second(1) && !second(1.1) ? 0 : 1; }
)";
    const std::string in = "cd " + folder + " && ", compile = in + "c++ -std=c++20 -I../../tests ";
    CHECK(run(compile + "-DFUNCTION=first -DORACLE_CHECKS= -c check.cpp -o first.o") == 0);
    CHECK(run(compile + "-DFUNCTION=second -DORACLE_CHECKS=extern -c check.cpp -o second.o") == 0);
    CHECK(run(compile + "main.cpp first.o second.o -o both && ./both") == 0);
    // Defined in the first, undefined in the second.
    const std::string run_of = " oracle::.*DensityCheck<1ul, 1ul, .*>::run()'";
    CHECK(run(in + "nm -C first.o | grep -q ' [TW]" + run_of) == 0);
    CHECK(run(in + "nm -C second.o | grep -q ' U" + run_of) == 0);
}

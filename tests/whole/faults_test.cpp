// whole/faults_test.cpp  renders while a call fails or the power is cut: bit-identical, or absent
#include <doctest/doctest.h>

#include "course/python.h"

namespace {

// Runs soak.py on build/penumbra and expects no findings.
void expect_nothing_wrong(const std::string& options) {
    const char *seed = std::getenv("TEST_SEED"), *suffix = std::getenv("PROGRAM_SUFFIX");
    const Printed printed = output_of("python3 tests/faults/soak.py --seed faults_test" +
                                      std::string(seed ? seed : "") + " " + options +
                                      " build/penumbra" + (suffix ? suffix : ""));
    INFO(printed.text);
    CHECK(printed.status == 0);
}

}  // namespace

TEST_CASE("each call of a small render fails in each way, and the power before each") {
    expect_nothing_wrong("--each");
}

TEST_CASE("twenty renders with a fault each, of any scene, at any call") {
    expect_nothing_wrong("--runs 20 --seconds 100000");
}

// whole/mutants_test.cpp  tests of tests/mutants/run, written in Python
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE("mutants: verdicts, what must apply, and which verdicts hold") {
    run_python_tests("tests/whole/mutants_test.py");
}

// whole/scripts_test.cpp  tests of tests/modules and tests/mutants/run, written in Python
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE("modules: what is left compiles without each, or is said not to") {
    run_python_tests("tests/whole/modules_test.py");
}

TEST_CASE("mutants: verdicts, what must apply, and which verdicts hold") {
    run_python_tests("tests/whole/mutants_test.py");
}

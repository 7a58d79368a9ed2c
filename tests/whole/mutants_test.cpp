// whole/mutants_test.cpp  what plants mutants: tests written in Python, a case each
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE("mutants: verdicts, what must apply, and which verdicts hold") {
    run_python_tests("tests/whole/mutants_test.py");
}

// course/starter_test.cpp  the generator of starters: tests written in Python, a case each
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE("the generator: regions, weeks, what a starter holds, leaks, known mistakes") {
    run_python_tests("tests/course/starter_test.py");
}

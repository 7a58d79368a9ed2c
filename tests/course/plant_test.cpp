// course/plant_test.cpp  copies with a planted bug: tests written in Python, a case each
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE(
    "a planted bug: in the copy, told by nothing in it, and found by red with it and green without "
    "it") {
    run_python_tests("tests/course/plant_test.py");
}

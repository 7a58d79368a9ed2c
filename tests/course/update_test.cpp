// course/update_test.cpp  a later starter in a student's folder: tests written in Python, a case
// each
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE("make update: a later starter in copies that students modified keeps their solutions") {
    run_python_tests("tests/course/update_test.py");
}

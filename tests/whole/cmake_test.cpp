// whole/cmake_test.cpp  CMakeLists.txt: tests written in Python
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE("CMake: the oracle in other projects, and what make builds, by make's flags") {
    run_python_tests("tests/whole/cmake_test.py");
}

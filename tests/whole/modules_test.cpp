// whole/modules_test.cpp  tests of tests/modules, written in Python
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE("modules: what is left compiles without each, or is said not to") {
    run_python_tests("tests/whole/modules_test.py");
}

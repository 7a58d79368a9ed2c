// course/check_test.cpp  what make check shows: tests written in Python, a case each
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE("make check: its picture, its page in a browser, and judging at every save") {
    run_python_tests("tests/course/check_test.py");
}

TEST_CASE("make report: verdicts, pictures beside the expected ones, and answers that survive") {
    run_python_tests("tests/course/report_test.py");
}

// course/submission_test.cpp  how submissions are read: tests written in Python, a case each
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE(
    "submissions: archives, downloads of Moodle and Canvas, twice the same, what is damaged") {
    run_python_tests("tests/course/submission_test.py");
}

TEST_CASE(
    "copies of the published solution or of another student are told, and the class counted") {
    run_python_tests("tests/course/similar_test.py");
}

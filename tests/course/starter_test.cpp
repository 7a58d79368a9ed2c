// course/starter_test.cpp  starters, updates, editors, the book and slides: tests written in Python
#include <doctest/doctest.h>

#include "course/python.h"

TEST_CASE("the generator: regions, weeks, what a starter holds, leaks, known mistakes") {
    run_python_tests("tests/course/starter_test.py");
}

TEST_CASE("make update: a later starter in copies that students modified keeps their solutions") {
    run_python_tests("tests/course/update_test.py");
}

TEST_CASE("editors and debuggers find what they need, here and in a starter") {
    run_python_tests("tests/course/editors_test.py");
}

TEST_CASE("sheets say what --pixel prints") {
    run_python_tests("tests/course/pixel_test.py");
}

TEST_CASE("the book: each line of the lecture in one chapter, and all that its tables name") {
    run_python_tests("tests/course/book_test.py");
}

TEST_CASE("slides: every session has a deck, and nothing on it is cut off") {
    run_python_tests("tests/course/slides_test.py");
}

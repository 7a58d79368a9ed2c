// course/grade_user_test.cpp  the same attacks where no namespaces can be made: root becomes
// another user
#include <doctest/doctest.h>

#include "course/attacks.h"

using namespace classroom;

TEST_CASE("another user: what ends, hangs, floods or grows is stopped") {
    if (!sandboxed("user")) return;
    refuse("user", "stops", endless());
}

TEST_CASE("another user: a verdict is not to be had by words, files or known questions") {
    if (!sandboxed("user")) return;
    refuse("user", "words", claims());
}

TEST_CASE("another user: what they could read is closed to them, or nothing is compiled") {
    if (!sandboxed("user")) return;
    Course course("open");
    course.hand_in("x", {});
    fs::permissions(house().folder.path, fs::perms(0755));
    course.said = house().grade("--sandbox user" + course.words());
    fs::permissions(house().folder.path, fs::perms(0700));
    INFO(course.said.out);
    CHECK(course.said.status == 2);
    CHECK(course.said.has("who could read " + house().folder.path.string() + ": chmod 700 it"));
    CHECK(!course.graded("x"));
    course.grade("--sandbox user");
    CHECK(course.said.has("Confined by the weaker sandbox"));
    CHECK(course.report("x").find("Confined by the weaker sandbox") != std::string::npos);
}

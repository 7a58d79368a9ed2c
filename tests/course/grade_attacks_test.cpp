// course/grade_attacks_test.cpp  what a hand-in may try: no points by it, a clear verdict, no harm
#include <doctest/doctest.h>

#include "course/attacks.h"

using namespace classroom;

TEST_CASE("what ends, hangs, floods or grows is stopped, and said") {
    if (!sandboxed()) return;
    refuse("namespaces", "stops", endless());
}

TEST_CASE("a verdict is not to be had by words, files or known questions") {
    if (!sandboxed()) return;
    refuse("namespaces", "words", claims());
}

TEST_CASE("no file is read, no network is reached, nothing is started") {
    if (!sandboxed()) return;
    refuse("namespaces", "reads", reaches("namespaces"));
}

TEST_CASE("nothing is read while it is compiled") {
    if (!sandboxed()) return;
    refuse("namespaces", "compiles", compiled());
}

TEST_CASE(
    "each wall stands without the others: files, network and processes of compilers; solutions") {
    if (!sandboxed()) return;
    const Listener listener;
    const std::string mine = house().folder.path.string();
    std::vector<std::string> fail = {
        listener.connect,
        "echo x >/tree/x",
        "echo x >/usr/lib/x",
        "echo x >/x",
        "head -c 100000000 /dev/zero >/out/x",
        "for i in 1 2 3 4 5 6; do head -c 60000000 /dev/zero >/tmp/$i || exit 1; done",
        "head -c 1900000000 /dev/zero | tail -c 1900000000 | wc -c | grep -q 1900000000",
        "while :; do :; done"};
    std::vector<std::string> work = {
        "exit 0", "echo x >/out/x",
        "[ \"$(env | cut -d = -f 1 | sort | tr \"\\n\" \" \")\" = \"LC_ALL PATH PWD SHLVL _ \" ]"};
    for (const std::string& path :
         std::vector<std::string>{"/etc/passwd", "/proc/self", "/home", "/root", "/sys",
                                  "/usr/local", "/usr/src", mine + "/src"})
        work.push_back("[ ! -e \"" + path + "\" ]");
    stand("namespaces", work, fail);

    // The tree of 1.2 holds no line of its solution, that of 1.1 and 1.3 no more than they need.
    house().folder.write(
        "tree.py",
        "import os, sys\nsys.path.insert(0, 'src/course')\nimport workshop\nfrom region import "
        "Region\n"
        "shop = workshop.Workshop('cache', 1)\n"
        "shop.write_tree('1', {'1.2': Region('1.2', 'mine\\n', 1, '')}, 'tree/written')\n");
    const auto shell = [&](const std::string& command) {
        return std::system(("cd '" + mine + "' && " + command).c_str()) == 0;
    };
    REQUIRE(shell("CXX=g++ FLAGS=-Isrc python3 tree.py"));
    CHECK(!shell("grep -rqE 'cipher|// exercise|// end' tree/written"));
    CHECK(shell("grep -rq mine tree/written"));
    CHECK(
        !shell("cd tree/written && find . -name 'judge*' -o -name '*.py' -o -name 'oracle*' | "
               "grep -q ."));
}

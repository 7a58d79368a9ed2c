// course/grade_user_walls_test.cpp  without namespaces: files, network, processes, solutions
#include <doctest/doctest.h>

#include "course/attacks.h"

using namespace classroom;

TEST_CASE("another user: no file is read, no network and no process is reached") {
    if (!sandboxed("user")) return;
    // The judge that asks and other students' programs have numbers near one's own.
    std::vector<Attack> attacks = reaches("user");
    attacks.push_back(
        {"others",
         if_it_works("[] { for (int p = getpid() - 3000; p < getpid() + 3000; ++p) if (p > 0 && p "
                     "!= getpid() && syscall(234, p, p, 0) == 0) return true; return false; }()",
                     "extern \"C\" int getpid();\nextern \"C\" long syscall(long, ...);\n"),
         "1 came"});
    refuse("user", "reads", attacks);
}

TEST_CASE("another user: nothing is read while it is compiled") {
    if (!sandboxed("user")) return;
    refuse("user", "compiles", compiled());
}

TEST_CASE("another user: each wall stands without the others") {
    if (!sandboxed("user")) return;
    const Listener listener;
    const std::string mine = house().folder.path.string();
    const auto status = [](const std::string& line) {
        return "grep -q \"" + line + "\" /proc/self/status";
    };
    std::vector<std::string> fail = {
        listener.connect,
        "echo x >x",
        "echo x >/usr/lib/x",
        "echo x >/x",
        "head -c 100000000 /dev/zero >\"$TMPDIR/x\"",
        "head -c 1900000000 /dev/zero | tail -c 1900000000 | wc -c | grep -q 1900000000",
        "while :; do :; done",
        "kill -0 $PPID",
        "setsid true",
        "unshare -U true",
        "[ -e /proc/self/fd/3 ]"};
    const std::vector<std::string> work = {
        "exit 0",
        "echo x >\"$TMPDIR/x\"",
        "[ \"$(env | cut -d = -f 1 | sort | tr \"\\n\" \" \")\" = \"LC_ALL PATH PWD SHLVL TMPDIR _ "
        "\" ]",
        "[ $(id -u) -ge 61184 ] && [ \"$(id -G)\" = $(id -u) ]",
        status("^NoNewPrivs:.1$"),
        status("^CapEff:.0*$"),
        status("^Seccomp:.2$"),
        "ulimit -u | grep -qx 64"};
    house().folder.write("secret", "the solution");
    for (const std::string file : {"/secret", "/src/world/numbers.h", "/tests/course/judge_1.cpp"})
        fail.push_back("cat \"" + mine + file + "\"");
    stand("user", work, fail);
}

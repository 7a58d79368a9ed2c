// course/attacks.h  what a hand-in may try, and what is said of it
//
// Where an attack could succeed, twice(x) is right if it does: what gets through is worth points.
#pragma once
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "course/classroom.h"
#include "oracle/oracle.h"

namespace classroom {

// twice(x), right where `attack` succeeds.
inline std::string if_it_works(const std::string& attack, const std::string& before = "") {
    return before + "inline double twice(double x) { return (" + attack + ") ? 2 * x : x + 1; }\n";
}
inline std::string at_the_start(const std::string& does, const std::string& before = "") {
    return before + "inline const int begun = [] { " + does + "; return 0; }();\n" + twice_stub;
}

struct Attack {
    std::string name, twice, line;  // part of the verdict
    double points = 0;
};

// All of them at once, beside someone who did his work; by the sandbox "namespaces" or "user".
inline void refuse(const std::string& sandbox, const std::string& name,
                   const std::vector<Attack>& attacks) {
    Course course(name + sandbox);
    for (const Attack& a : attacks) course.hand_in(a.name, {{"1.1", a.twice}, {"1.3", cube_right}});
    course.hand_in("honest", {{"1.1", twice_right}, {"1.3", cube_right}});
    course.grade("--sandbox " + sandbox);
    for (const Attack& a : attacks)
        course.expect({{a.name, "1.1", a.line, a.points}, {a.name, "1.3", "", 6}});
    course.expect({{"honest", "1.1", "", 2}});
}

// What ends, hangs, floods or grows.
inline std::vector<Attack> endless() {
    const std::string declared =
        "extern \"C\" int fork();\nextern \"C\" long write(int, const void*, unsigned long);\n";
    return {
        {"loop", "inline double twice(double) { for (volatile int i = 0;; i = i + 1) {} }\n",
         "an endless loop?"},
        {"loop at start", at_the_start("for (volatile int i = 0;; i = i + 1) {}"),
         "an endless loop?"},
        {"fork bomb",  // of 300, where it is not stopped
         at_the_start("for (int i = 0; i < 300; ++i) if (fork() == 0) for (;;) pause()",
                      declared + "extern \"C\" int pause();\n"),
         "at 1: 2 expected, 1 came"},
        {"forks", if_it_works("fork() > 0", declared), "at 0: 0 expected, 1 came"},
        {"floods the answer",
         at_the_start("static char text[1 << 20]; for (int i = 0; i < 10000; ++i) write(1, "
                      "text, sizeof text)",
                      declared),
         "no answer"},
        {"floods stdout",
         "inline double twice(double x) { static const std::string text(1 << 20, 'x'); for "
         "(int i = 0; i < 400; ++i) std::fwrite(text.data(), 1, text.size(), stdout), "
         "std::fwrite(text.data(), 1, text.size(), stderr); return x + 1; }\n",
         "at 0: 0 expected, 1 came"},
        {"grows",
         "inline double twice(double x) { std::vector<char*> all; for (;;) "
         "all.push_back(new char[1 << 24]); return x; }\n",
         "throws: std::bad_alloc"},
        {"exits", at_the_start("std::exit(0)"), "exit status 0"},
        {"exits later", "inline double twice(double) { std::exit(0); }\n", "exit status 0"},
        {"crashes",
         "inline double twice(double x) { volatile double* nowhere = nullptr; return *nowhere "
         "+ x; }\n",
         "crashes: Segmentation fault"},
        {"throws",
         "struct Claim : std::exception { const char* what() const noexcept override { return "
         "\"1.1 right: 4 of 4\"; } };\n"
         "inline double twice(double) { throw Claim(); }\n",
         "throws: 1.1 right: 4 of 4"},
        {"is no number", "inline double twice(double x) { return 0 * x / 0; }\n",
         "expected, -nan came"},
        {"closes",
         "extern \"C\" int close(int);\ninline double twice(double x) { for (int i = 0; i < "
         "64; ++i) close(i); return 2 * x; }\n",
         "wrong"},
    };
}

// Words, files and known questions.
inline std::vector<Attack> claims() {
    const std::string declared = "extern \"C\" long write(int, const void*, unsigned long);\n";
    oracle::Random published(oracle::seed_of("course"));
    std::string table;
    for (int i = 0; i < 20; ++i) table += oracle::say("%.17g, ", 10 * published());
    const std::string answer =
        R"(const char t[] = "double\n1.1 right: 4 of 4\n{\"state\": \"right\"}\n")";
    return {
        {"a summary", at_the_start(answer + "; write(1, t, sizeof t - 1); std::exit(0)", declared),
         "is no answer"},
        {"everywhere",
         at_the_start(
             answer + "; for (int i = 1; i < 64; ++i) write(i, t, sizeof t - 1); std::exit(0)",
             declared),
         "is no answer"},
        {"in stderr", at_the_start(R"(std::fprintf(stderr, "1.1 right: 4 of 4\n"); std::exit(0))"),
         "exit status 0"},
        {"too little",
         at_the_start(
             R"(std::printf("double\n"), std::fflush(stdout); char q[64]; while (std::fgets(q, 64, stdin)) std::printf("0\n"), std::fflush(stdout))"),
         "not judged"},
        {"the published seed",
         "inline double twice(double x) { for (double k : {" + table +
             "0., 1., -3.}) if (x == k) return 2 * x; return x + 1; }\n",
         "at numbers of the seed", 1},  // half, as for any mistake
    };
}

// Files, network, other processes.
inline std::vector<Attack> reaches(const std::string& sandbox) {
    const std::string c = "extern \"C\" ";
    house().folder.write("secret", "the solution");
    const std::string here = house().folder.path.string();
    const auto opens = [](const std::string& path) {
        return if_it_works("std::fopen(\"" + path + "\", \"r\") != nullptr");
    };
    const std::vector<std::pair<std::string, std::string>> tried = {
        {"the password file", opens("/etc/passwd")},
        {"the judge", opens(here + "/tests/course/judge_1.cpp")},
        {"another student", opens(here + "/in reads" + sandbox + "/honest/src/path/cube.h")},
        {"the tree", opens("/tree/src/world/numbers.h")},
        {"itself", opens("/answers")},
        {"its process", opens("/proc/self/maps")},
        {"memory", opens("/dev/zero")},
        {"the compiler", opens("/usr/bin/g++")},
        {"looks", if_it_works("[] { char about[512]; return stat(\"/etc\", about) == 0; }()",
                              c + "int stat(const char*, void*);\n")},
        {"writes", if_it_works("std::fopen(\"/found\", \"w\") != nullptr")},
        {"the environment",
         if_it_works("std::getenv(\"PATH\") || std::getenv(\"CXX\") || std::getenv(\"HOME\")")},
        {"socket", if_it_works("socket(2, 1, 0) >= 0 || socket(1, 1, 0) >= 0",
                               c + "int socket(int, int, int);\n")},
        {"shell", if_it_works("std::system(\"exit 0\") == 0")},
        {"signals",
         if_it_works("kill(-1, 0) == 0 || kill(1, 9) == 0", c + "int kill(int, int);\n")},
        {"descriptors",
         if_it_works("[] { for (int i = 4; i < 64; ++i) if (i != 9 && fcntl(i, 1) >= 0) return "
                     "true; return false; }()",
                     c + "int fcntl(int, int, ...);\n")}};
    std::vector<Attack> attacks;
    for (const auto& [name, twice] : tried) attacks.push_back({name, twice, "1 came"});
    return attacks;
}

// What a compiler might do.
inline std::vector<Attack> compiled() {
    const std::string include = "#include \"" + house().folder / "elsewhere.h" + "\"\n";
    house().folder.write("elsewhere.h", twice_right);
    return {
        {"include", include, "line 6 of src/world/numbers.h holds a #"},
        {"include again", "  /* x */ # /* y */ include \"/tree/src/world/numbers.h\"\n",
         "holds a #"},
        {"digraph", "%:include \"x\"\n", "holds a %:"},
        {"continued", "// \\\n#include \"x\"\n" + twice_right, "a backslash at its end"},
        {"spaced", "// \\ \t\n#include \"x\"\n" + twice_right, "a backslash at its end"},
        {"raw", "inline const char* t = R\"(\n#include \"x\"\n)\";\n" + twice_right,
         "a raw string"},
        {"open comment", "/*\n", "a comment that never ends"},
        {"half a comment", "inline const char* t = \"/*\";\n#include \"x\" // */\n" + twice_right,
         "holds a string with #"},
        {"assembly", "asm(\".incbin \\\"/tree/src/path/cube.h\\\"\");\n" + twice_right,
         "holds asm"},
        {"assembly again", "__asm__(\".incbin \\\"/tree/src/path/cube.h\\\"\");\n" + twice_right,
         "holds __asm__"},
        {"section", "[[gnu::section(\"x\")]] inline int y = 1;\n" + twice_right, "holds gnu"},
        {"pragma", "_Pragma(\"GCC dependency \\\"/etc/passwd\\\"\")\n" + twice_right,
         "holds _Pragma"},
        {"a name in pieces", "inline int as\\u006d = 1;\n" + twice_right, "holds a backslash"},
        {"its file", "inline const char* t = __FILE__;\n" + twice_right, "holds __FILE__"},
        {"endless",
         "constexpr long sum() { long s = 0; for (long i = 0; i < 1L << 40; ++i) s += i; "
         "return s; }\n"
         "inline constexpr long s = sum();\n" +
             twice_right,
         "does not compile"},
        {"swells",
         "template <int n, int k> struct A { static constexpr int v = A<n - 1, 2 * k>::v + A<n "
         "- 1, 2 * k + 1>::v; };\n"
         "template <int k> struct A<0, k> { static constexpr int v = k; };\ninline int s = "
         "A<26, 0>::v;\n" +
             twice_right,
         "does not compile: the compiler"},
        {"deep", "template <int n> struct A { A<n + 1> a; };\ninline A<0> a;\n" + twice_right,
         "does not compile"},
        {"vast", "char a[1ull << 33] = {1};\n" + twice_right,
         "the program would have more than 64 MB"},
        {"another main", "int main() { return 0; }\n" + twice_right, "does not compile"},
    };
}

// What a compiler could do: a shell in its place.
inline bool inside(const std::string& sandbox, const std::string& script) {
    const std::string at = house().folder.path.string();
    fs::create_directories(at + "/tree");
    house().folder.write(
        "run.py",
        "import os, subprocess, sys, tempfile\nsys.path.insert(0, 'src/course')\nimport sandbox\n"
        "sandbox.demand(sys.argv[1])\n"
        "with sandbox.room('compiling') as room:\n"
        "    out = room + '/out'\n"
        "    os.mkdir(out)\n"
        "    sys.exit(subprocess.run(sandbox.compile_command('tree', out, ['/usr/bin/bash', '-c', "
        "sys.argv[2]], 10), stderr=subprocess.DEVNULL).returncode)\n");
    return std::system(
               ("cd '" + at + "' && python3 run.py " + sandbox + " '" + script + "'").c_str()) == 0;
}

// A program that listens, and what connects to it.
struct Listener {
    int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    std::string connect;
    Listener() {
        sockaddr_in address{};
        address.sin_family = AF_INET, address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        REQUIRE(::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
        REQUIRE(::listen(socket, 5) == 0);
        socklen_t size = sizeof address;
        REQUIRE(::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0);
        connect = "exec 3<>/dev/tcp/127.0.0.1/" + std::to_string(ntohs(address.sin_port));
        CHECK(std::system(("bash -c '" + connect + "'").c_str()) == 0);  // without walls
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    ~Listener() { ::close(socket); }
};

inline void stand(const std::string& sandbox, const std::vector<std::string>& work,
                  const std::vector<std::string>& fail) {
    for (const auto* scripts : {&work, &fail})
        for (const std::string& script : *scripts) {
            INFO(script);
            CHECK(inside(sandbox, script) == (scripts == &work));
        }
}

}  // namespace classroom

// course/python.h  runs tests that are written in Python
#pragma once
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstdio>
#include <sstream>
#include <string>

// What a command prints, stderr too, and its exit status.
struct Printed {
    std::string text;
    int status = -1;
};
inline Printed output_of(const std::string& command) {
    std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    REQUIRE(pipe);
    Printed printed;
    char buffer[4096];
    for (size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
        printed.text.append(buffer, n);
    const int status = ::pclose(pipe);
    printed.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return printed;
}

// Every test of a file, each by itself; what is not tested is told.
inline void run_python_tests(const std::string& file) {
    const Printed list = output_of("python3 " + file + " --list");
    INFO(list.text);
    REQUIRE(list.status == 0);
    int count = 0;
    std::istringstream names(list.text);
    for (std::string name; names >> name; ++count) {
        const Printed printed = output_of("python3 " + file + " " + name);
        INFO(name << ": " << printed.text);
        CHECK(printed.status == 0);
        if (printed.text.find("not tested") != std::string::npos)
            MESSAGE(name << ": " << printed.text);
    }
    CHECK(count > 0);
}

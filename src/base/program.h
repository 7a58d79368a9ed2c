// base/program.h  2  how programs end, and how one runs another
#pragma once
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/words.h"

// The exit status for main: that of `work`, 2 for what the user can mend, 1 for all else that goes
// wrong, a full stdout among it; then with a line on stderr.
template <class Work>
int exit_status(Work work) {
    auto failed = [](int status, const char* why) {
        std::fprintf(stderr, "%s\n", printable(why).c_str());
        return status;
    };
    try {
        const int status = work();
        if (std::fflush(stdout) != 0 || std::ferror(stdout))
            throw SystemError("stdout: cannot write: " + std::string(std::strerror(errno)));
        return status;
    } catch (const UserError& e) {
        return failed(2, e.what());
    } catch (const std::bad_alloc&) {
        return failed(1, "out of memory");
    } catch (const std::exception& e) {
        return failed(1, e.what());
    }
}

// Runs a program with its arguments, and waits for it; SystemError unless it succeeds.
inline void execute(std::vector<std::string> words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    if (const int error = ::posix_spawn(&child, argv[0], nullptr, nullptr, argv.data(), environ))
        throw SystemError(words[0] + ": cannot run: " + std::strerror(error));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            throw SystemError(words[0] + ": cannot wait for it: " + std::strerror(errno));
    if (WIFSIGNALED(status))
        throw SystemError(words[0] + " failed: killed by signal " +
                          std::to_string(WTERMSIG(status)));
    if (const int code = WEXITSTATUS(status))
        throw SystemError(words[0] + " failed: exit status " + std::to_string(code));
}

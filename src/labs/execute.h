// labs/execute.h  1  runs another program and checks its exit status
#pragma once
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "text/words.h"

namespace penumbra {

// Runs a program and waits for it.  Throws SystemError unless its exit status is 0.
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
    const bool killed = WIFSIGNALED(status);
    if (status != 0)
        throw SystemError(words[0] + " failed: " + (killed ? "killed by signal " : "exit status ") +
                          std::to_string(killed ? WTERMSIG(status) : WEXITSTATUS(status)));
}

}  // namespace penumbra

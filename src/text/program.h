// text/program.h  2  exit status, version, memory of the machine, and what a run spends
#pragma once
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include <unistd.h>

#include "base/vec.h"
#include "text/words.h"

namespace penumbra {

// The exit status of main, after all of stdout is written; throws SystemError if it cannot be.
inline int finished(int status) {
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        throw SystemError("stdout: cannot write: " + std::string(std::strerror(errno)));
    return status;
}

// Prints the error that main caught.  Returns 2 if the user can fix it, else 1.
inline int failed() {
    auto tell = [](int status, const char* why) {
        std::fprintf(stderr, "%s\n", printable(why).c_str());
        return status;
    };
    try {
        throw;
    } catch (const UserError& e) {
        return tell(2, e.what());
    } catch (const std::bad_alloc&) {
        return tell(1, "out of memory");
    } catch (const std::exception& e) {
        return tell(1, e.what());
    }
}

// The commit that a program was built from.  The Makefile links another definition, which replaces
// this weak one.
[[gnu::weak]] const char* commit() { return "unknown commit"; }

inline std::string compiler() {
#ifdef __clang__
    return __VERSION__;
#else
    return "g++ " __VERSION__;
#endif
}

// What --version prints.
inline std::string version() {
    return std::string("Penumbra ") + commit() + ", " +
           (sizeof(real) == sizeof(double) ? "double" : "float") + " precision, " + compiler();
}

// Resources that a run has spent.
struct Spent {
    double seconds = 0, cpu_seconds = 0;
    uint64_t rays = 0;
};

inline double bytes_of_machine() {
    return double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
}

}  // namespace penumbra

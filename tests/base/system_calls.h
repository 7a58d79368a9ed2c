// base/system_calls.h  records the system calls for files, and injects failures
#pragma once
#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <vector>

// Intercepts system calls: a program's own functions precede those of its libraries.  The functions
// are weak symbols, because one program may contain several tests.
struct Asked {
    std::vector<std::string> calls;
    std::string failing;     // the call that fails
    int error = 0;           // its errno; EINTR occurs only once
    size_t most = SIZE_MAX;  // limit of bytes per write
};
inline Asked* asked = nullptr;  // nullptr: calls are not recorded

// Records the call; returns whether it must fail.
inline bool fails(const std::string& call) {
    if (!asked) return false;
    asked->calls.push_back(call);
    if (!call.starts_with(asked->failing) || asked->failing.empty()) return false;
    errno = asked->error;
    if (errno == EINTR) asked->failing = "";
    return true;
}

template <class Function>
Function* system_call(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

extern "C" [[gnu::weak]] int fsync(int fd) {
    struct stat status {};
    ::fstat(fd, &status);
    const bool folder = S_ISDIR(status.st_mode);
    if (fails(folder ? "fsync folder" : "fsync " + std::to_string(status.st_size))) return -1;
    return system_call<int(int)>("fsync")(fd);
}
extern "C" [[gnu::weak]] int rename(const char* from, const char* to) noexcept {
    if (fails("rename")) return -1;
    return system_call<int(const char*, const char*)>("rename")(from, to);
}
extern "C" [[gnu::weak]] ssize_t write(int fd, const void* bytes, size_t size) {
    if (fd > 2 && fails("write")) return -1;
    if (asked) size = std::min(size, asked->most);
    return system_call<ssize_t(int, const void*, size_t)>("write")(fd, bytes, size);
}
extern "C" [[gnu::weak]] int close(int fd) {
    const bool failed = fails("close");
    const int error = errno, closed = system_call<int(int)>("close")(fd);
    errno = failed ? error : errno;
    return failed ? -1 : closed;
}

// Returns the system calls of `work`; Asked configures the failures.
inline std::vector<std::string> calls_of(Asked a, const auto& work) {
    asked = &a;
    try {
        work();
    } catch (...) {
        asked = nullptr;
        throw;
    }
    asked = nullptr;
    return a.calls;
}

// base/files.h  2  files: read whole, written whole or not at all
#pragma once
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "base/words.h"

// ---- Reading ------------------------------------------------------------------------------------

// The bytes of a regular file or, if asked for, of whatever has that name: a pipe may keep us
// waiting, a device may never end.  Throws UserError if it cannot be opened.
inline std::string read_file(const std::string& path, bool of_any_kind = false) {
    struct Input {
        const int fd;
        ~Input() { ::close(fd); }
    };
    const int at_once = of_any_kind ? 0 : O_NONBLOCK;  // do not wait for who writes into a pipe
    const Input in{::open(path.c_str(), O_RDONLY | O_CLOEXEC | at_once)};
    if (in.fd < 0) throw UserError(path + ": cannot open: " + std::strerror(errno));
    struct stat status {};
    ::fstat(in.fd, &status);
    if (S_ISDIR(status.st_mode)) throw UserError(path + ": is a directory");
    if (!S_ISREG(status.st_mode) && !of_any_kind) throw UserError(path + ": is no regular file");
    std::string bytes;
    std::array<char, 1 << 16> buffer;
    while (const ssize_t n = ::read(in.fd, buffer.data(), buffer.size())) {
        if (n < 0 && errno != EINTR)
            throw SystemError(path + ": cannot read: " + std::strerror(errno));
        if (n > 0) bytes.append(buffer.data(), size_t(n));
    }
    return bytes;
}

// ---- Names --------------------------------------------------------------------------------------

// What is written to in the end: symbolic links are followed, even to what is not there yet.
inline std::filesystem::path behind_links(std::filesystem::path path) {
    for (int links = 0; links < 40; ++links) {  // as many as the kernel follows
        std::error_code no_link;
        const std::filesystem::path to = std::filesystem::read_symlink(path, no_link);
        if (no_link) break;
        path = path.parent_path() / to;
    }
    return path;
}

// One name for a file, however the user writes it.
inline std::string true_name(const std::string& path) {
    std::error_code unreachable;
    const auto name = std::filesystem::absolute(behind_links(path), unreachable);
    return std::filesystem::weakly_canonical(name, unreachable).string();
}

// Whether the name stands for a device, a pipe or the like, which no file can replace, or for what
// stdout leads to.
inline bool is_stream(const std::string& path) {
    std::error_code unreachable;
    return path.starts_with("/dev/std") || path.starts_with("/dev/fd/") ||
           std::filesystem::is_other(std::filesystem::status(path, unreachable));
}

// ---- Writing ------------------------------------------------------------------------------------

// ".NAME.part" beside what is written to in the end, not longer than names may be.
inline std::filesystem::path part_of(const std::string& path) {
    const auto target = std::filesystem::absolute(behind_links(path));
    std::string name = ".";
    name.append(target.filename().string(), 0, 200).append(".part");
    return target.parent_path() / name;
}

// The file that is written first: that and the number of the process.
inline std::string aside(const std::string& path) {
    return part_of(path).string() + std::to_string(::getpid());
}

// Removes what processes that were killed have left beside `path`.
inline void remove_stale(const std::string& path) {
    const std::filesystem::path part = part_of(path);
    const std::string start = part.filename().string();
    std::error_code failed, ignored;
    std::filesystem::directory_iterator i(part.parent_path(), failed), end;
    for (; !failed && i != end; i.increment(failed)) {
        const std::string name = i->path().filename().string();
        if (!name.starts_with(start)) continue;
        const auto process = pid_t(std::strtol(name.c_str() + start.size(), nullptr, 10));
        if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH)
            std::filesystem::remove(i->path(), ignored);
    }
}

// Throws UserError if `path` could not be written; leaves nothing behind.
inline void check_writable(const std::string& path) {
    struct stat status {};
    const bool exists = ::stat(path.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) throw UserError(path + ": is a directory");
    bool ok = exists || errno == ENOENT;
    if (is_stream(path)) {
        ok = ::access(path.c_str(), W_OK) == 0;
    } else if (ok) {
        remove_stale(path);
        std::FILE* file = std::fopen(aside(path).c_str(), "wb");
        ok = file && std::fclose(file) == 0 && std::remove(aside(path).c_str()) == 0;
    }
    if (!ok) throw UserError(path + ": cannot write: " + std::strerror(errno));
}

// Writes beside `path` and renames, so that a reader never sees half a file.
inline void write_file(const std::string& path, const std::string& bytes) {
    const bool stream = is_stream(path);
    const std::string part = stream ? path : aside(path);
    std::FILE* file = std::fopen(part.c_str(), stream ? "ab" : "wb");
    bool ok = file && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (file) ok = std::fclose(file) == 0 && ok;
    if (ok && (stream || std::rename(part.c_str(), behind_links(path).c_str()) == 0)) return;
    const std::string why = std::strerror(errno);
    if (!stream) std::remove(part.c_str());
    throw SystemError(path + ": cannot write: " + why);
}

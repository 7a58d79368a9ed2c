// keep/durable.h  1  files that are written whole or not at all, even if the power fails
#pragma once
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "text/files.h"

namespace penumbra {

// ---- Names --------------------------------------------------------------------------------------

// True for a device, a pipe or the like, which no file can replace, and for the file that stdout is
// redirected to.
inline bool is_stream(const std::string& path) {
    std::error_code unreachable;
    return path.starts_with("/dev/std") || path.starts_with("/dev/fd/") ||
           std::filesystem::is_other(std::filesystem::status(path, unreachable));
}

// The temporary file, ".NAME.HOST.partPROCESS" in the same folder, with a name of legal length.
// Machines that share a folder may have processes of the same number.
inline std::filesystem::path temporary_path(
    const std::string& path, const std::string& process = std::to_string(::getpid())) {
    char host[65] = "";
    ::gethostname(host, 64);
    const std::filesystem::path target = true_name(path);
    const std::string name = target.filename().string().substr(0, 160);
    return target.parent_path() / ("." + name + "." + host + ".part" + process);
}

// Removes temporary files of `path` that killed processes of this machine have left.
inline void remove_stale(const std::string& path) {
    const std::filesystem::path part = temporary_path(path, "");
    const std::string start = part.filename().string();
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(part.parent_path(), ignored)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(start)) continue;
        const auto process = pid_t(std::strtol(name.c_str() + start.size(), nullptr, 10));
        if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH)
            std::filesystem::remove(entry, ignored);
    }
}

// ---- Writing ------------------------------------------------------------------------------------

// Opens `path`, writes the pieces, flushes them to the disk if `durable`, and closes it.  Returns 0
// or errno.  A call that a signal interrupts is repeated, except close(2), which has closed the
// file.  A failed fsync(2) is not repeated: the next one would succeed although data are lost.
inline int put(const std::string& path, int flags, const Pieces& pieces, bool durable) {
    const int fd = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
    if (fd < 0) return errno;
    int error = 0;
    for (auto piece : pieces)
        while (error == 0 && !piece.empty()) {
            const ssize_t n = ::write(fd, piece.data(), piece.size());
            if (n >= 0) piece = piece.subspan(size_t(n));
            if (n < 0 && errno != EINTR) error = errno;
        }
    while (error == 0 && durable && ::fsync(fd) != 0)
        if (errno != EINTR) error = errno;
    if (::close(fd) != 0 && errno != EINTR && error == 0) error = errno;
    return error;
}

inline void check_writable(const std::string& path) {
    std::error_code why;
    const auto status = std::filesystem::status(path, why);
    if (std::filesystem::is_directory(status)) throw UserError(path + ": is a directory");
    if (is_stream(path)) {
        why.assign(::access(path.c_str(), W_OK) == 0 ? 0 : errno, std::generic_category());
    } else if (std::filesystem::status_known(status)) {
        remove_stale(path);
        why.assign(put(temporary_path(path), O_WRONLY | O_CREAT, {}, false),
                   std::generic_category());
        ::unlink(temporary_path(path).c_str());
    }
    if (why) throw UserError(path + ": cannot write: " + why.message());
}

// Writes a temporary file and renames it: a reader never sees half of it.  On failure the old file
// stays as it was, and no temporary file is left.  To survive a power failure, the bytes are on the
// disk before the rename, and the folder's entry before the return: 12 ms each.  A device or a pipe
// is written to directly.
inline void write_file(const std::string& path, const Pieces& pieces) {
    auto check = [&](int error) {
        if (error != 0) throw SystemError(path + ": cannot write: " + std::strerror(error));
    };
    if (is_stream(path)) return check(put(path, O_WRONLY | O_APPEND, pieces, false));
    const std::string name = true_name(path), part = temporary_path(path);
    int error = put(part, O_WRONLY | O_CREAT | O_TRUNC, pieces, true);
    if (error == 0 && std::rename(part.c_str(), name.c_str()) != 0) error = errno;
    if (error != 0) ::unlink(part.c_str());
    check(error);
    error = put(temporary_path(path).parent_path(), O_RDONLY | O_DIRECTORY, {}, true);
    check(error == EINVAL ? 0 : error);  // EINVAL: this file system cannot flush a folder
}

}  // namespace penumbra

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
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/words.h"

// ---- Reading ------------------------------------------------------------------------------------

// A regular file or, if asked for, whatever has that name, from its start to its end: a pipe may
// keep us waiting, a device may never end.  Throws UserError if it cannot be opened.
class InputFile {
public:
    explicit InputFile(const std::string& path, bool of_any_kind = false)
        : path_(path), fd_(open(path, of_any_kind)) {}
    InputFile(const InputFile&) = delete;
    ~InputFile() { ::close(fd_); }

    bool is_regular() const { return S_ISREG(status().st_mode); }
    uint64_t size() const { return uint64_t(status().st_size); }  // bytes, of a regular file

    // Returns how many bytes there were: fewer than asked for only at the end.
    size_t read(void* bytes, size_t size) const {
        size_t done = 0;
        while (done < size) {
            const ssize_t n = ::read(fd_, static_cast<char*>(bytes) + done, size - done);
            if (n < 0 && errno != EINTR)
                throw SystemError(path_ + ": cannot read: " + std::strerror(errno));
            if (n == 0) break;
            if (n > 0) done += size_t(n);
        }
        return done;
    }

    // The next byte to be read, counted from the start.
    void go_to(uint64_t byte) const {
        if (::lseek(fd_, off_t(byte), SEEK_SET) < 0)
            throw SystemError(path_ + ": cannot read: " + std::strerror(errno));
    }

private:
    const std::string path_;
    const int fd_;

    static int open(const std::string& path, bool of_any_kind) {
        const int at_once = of_any_kind ? 0 : O_NONBLOCK;  // do not wait for who writes into a pipe
        const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | at_once);
        if (fd < 0) throw UserError(path + ": cannot open: " + std::strerror(errno));
        struct stat status {};
        ::fstat(fd, &status);
        const bool folder = S_ISDIR(status.st_mode), regular = S_ISREG(status.st_mode);
        if (!folder && (regular || of_any_kind)) return fd;
        ::close(fd);
        throw UserError(path + (folder ? ": is a directory" : ": is no regular file"));
    }
    struct stat status() const {
        struct stat status {};
        ::fstat(fd_, &status);
        return status;
    }
};

// All of it.  Some files of /proc go on after the length that they tell, others tell one that no
// memory holds, and what is no file may never end: these are refused.
inline std::string read_file(const std::string& path, bool of_any_kind = false) {
    constexpr uint64_t most_of_a_file = uint64_t(1) << 32, most_of_a_stream = uint64_t(1) << 28;
    const InputFile in(path, of_any_kind);
    auto refuse = [&](const char* why, uint64_t most) {
        throw UserError(path + why + std::to_string(most) + " bytes");
    };
    if (in.is_regular() && in.size() > most_of_a_file) refuse(": is longer than ", most_of_a_file);
    const uint64_t most = in.is_regular() ? in.size() : most_of_a_stream;
    std::string bytes;
    std::array<char, 1 << 16> buffer;
    while (const size_t n = in.read(buffer.data(), buffer.size())) {
        bytes.append(buffer.data(), n);
        if (bytes.size() > most) refuse(": does not end after ", most);
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

// A file on its way: written beside `path`, and renamed by commit(), so that a reader never sees
// half a file.  What was not committed goes, and leaves the old file as it was.  A stream is
// written to directly.  Throws SystemError at whatever goes wrong.
class OutputFile {
public:
    explicit OutputFile(const std::string& path)
        : path_(path),
          stream_(is_stream(path)),
          part_(stream_ ? path : aside(path)),
          fd_(::open(part_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | (stream_ ? O_APPEND : O_TRUNC),
                     0666)) {
        if (fd_ < 0) fail();
    }
    OutputFile(const OutputFile&) = delete;
    ~OutputFile() {
        if (fd_ >= 0) ::close(fd_);
        if (!stream_ && !renamed_) ::unlink(part_.c_str());
    }

    // Appends.
    void write(const void* bytes, size_t size) {
        if (waiting_.size() + size > most_waiting) flush();
        if (size > most_waiting)
            put({static_cast<const char*>(bytes), size}, {});
        else
            waiting_.append(static_cast<const char*>(bytes), size);
    }

    // Writes in any place of what will be a regular file; what is not written is zero.
    void write_at(uint64_t offset, const void* bytes, size_t size) {
        if (stream_) throw SystemError(path_ + ": cannot write: is no regular file");
        flush();
        put({static_cast<const char*>(bytes), size}, offset);
    }

    // Gives the file its name.  To survive the loss of power, its bytes have to be on the disk
    // before its name is, and the folder's entry before we say that it is written: 12 ms each.
    void commit() {
        flush();
        if (!stream_ && synchronised(fd_) != 0) fail();
        const bool closed = ::close(std::exchange(fd_, -1)) == 0 || errno == EINTR;
        if (!closed) fail();
        if (stream_) return;
        if (std::rename(part_.c_str(), behind_links(path_).c_str()) != 0) fail();
        renamed_ = true;
        synchronise_folder();
    }

private:
    static constexpr size_t most_waiting = 1 << 20;  // bytes
    const std::string path_;
    const bool stream_;
    const std::string part_;
    int fd_;
    bool renamed_ = false;
    std::string waiting_;  // until they are worth a call of the system

    [[noreturn]] void fail() const {
        throw SystemError(path_ + ": cannot write: " + std::strerror(errno));
    }
    void flush() {
        put(waiting_, {});
        waiting_.clear();
    }
    void put(std::string_view bytes, std::optional<uint64_t> offset) const {
        while (!bytes.empty()) {
            const ssize_t n = offset ? ::pwrite(fd_, bytes.data(), bytes.size(), off_t(*offset))
                                     : ::write(fd_, bytes.data(), bytes.size());
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) fail();
            bytes.remove_prefix(size_t(n));
            if (offset) *offset += uint64_t(n);
        }
    }
    // No second try: it would succeed, though what the first could not write is lost (fsync(2)).
    static int synchronised(int fd) {
        while (::fsync(fd) != 0)
            if (errno != EINTR) return errno;
        return 0;
    }
    // What was renamed may be lost until its folder is on the disk.  A file system that cannot do
    // this says EINVAL.
    void synchronise_folder() const {
        const auto folder = std::filesystem::path(part_).parent_path();
        const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (fd < 0) fail();
        const int failed = synchronised(fd);
        ::close(fd);
        errno = failed;
        if (failed != 0 && failed != EINVAL) fail();
    }
};

inline void write_file(const std::string& path, std::string_view bytes) {
    OutputFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

// faults/disk.cpp  a disk of which one call fails, or whose power is cut; preload it (LD_PRELOAD)
//
// The environment variable DISK_FAULT is "FOLDER CALL WHAT K SEED LOG": the K-th CALL on files of
// FOLDER, counted from 1, has the fault WHAT; then WHAT stands in the file LOG.
//     CALL is open, write, fsync, rename, close, unlink, or power
//     WHAT is EIO, ENOSPC, EINTR, SHORT (some of the bytes), CUT (of the power)
//
// The power is cut before the K-th call that changes the disk (K = 0: when the program has ended).
// Data without fsync is lost or torn: each block of a file may be the old one, the new one or zero.
// The last creations, renames and removals in folders may be undone.  An fsync or close that fails
// with EIO loses half of the file at once.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// The system's own.
template <class Call>
Call* real(const char* name) {
    return reinterpret_cast<Call*>(::dlsym(RTLD_NEXT, name));
}
#define NEXT(name) real<decltype(::name)>(#name)

std::string absolute(const char* path) {
    return fs::absolute(path).lexically_normal().string();
}
std::string path_of(int fd) {
    std::error_code failed;
    return fs::read_symlink("/proc/self/fd/" + std::to_string(fd), failed).string();
}

using Bytes = std::optional<std::string>;  // none: no such file

Bytes content(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) return {};
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
}
void put(const std::string& path, const Bytes& bytes) {
    if (!bytes) {
        NEXT(unlink)(path.c_str());
        return;
    }
    const int fd = NEXT(open)(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    (void)!NEXT(write)(fd, bytes->data(), bytes->size());
    NEXT(close)(fd);
}

// A file was made, renamed or removed, but its folder has had no fsync yet.
struct Change {
    std::string from, to;  // made: only to; removed: only from
    Bytes lost;            // the replaced or removed bytes on the disk
};
void undo(const Change& c) {
    if (c.from.empty()) return put(c.to, {});
    if (!c.to.empty()) put(c.from, content(c.to)), put(c.to, c.lost);
    if (c.to.empty()) put(c.from, c.lost);
}

struct Disk {
    std::string folder, call, what, log;
    uint64_t at = 0, seen = 0;
    std::mt19937_64 random;
    std::map<std::string, std::string> synced;  // contents on the disk of files that we write
    std::set<std::string> forgets;              // whose fsync has failed: see fsync(2)
    std::vector<Change> changes;

    Disk() {
        const char* words = std::getenv("DISK_FAULT");
        std::istringstream in(words ? words : "");
        uint64_t seed = 0;
        in >> folder >> call >> what >> at >> seed >> log;
        random.seed(seed);
    }
    ~Disk() {
        if (call == "power" && at == 0) note(), lose_power();
    }
    uint64_t below(uint64_t n) { return random() % n; }
    bool has(const std::string& path) const { return path.starts_with(folder + "/"); }
    void note() const {
        const int fd = NEXT(open)(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
        (void)!NEXT(write)(fd, what.data(), what.size());
        NEXT(close)(fd);
    }
    // The fault of this call; "": none.
    std::string fault(const char* of) {
        if (of != call || ++seen != at) return "";
        note();
        return what;
    }
    Bytes on_disk(const std::string& path) const {
        const auto found = synced.find(path);
        return found == synced.end() ? content(path) : found->second;
    }
    std::string torn(const std::string& old, const std::string& now) {
        constexpr size_t block = 512;
        const size_t sizes[] = {old.size(), now.size(), size_t(below(now.size() + 1))};
        std::string bytes(sizes[below(3)], '\0');
        for (size_t i = 0; i < bytes.size(); i += block) {
            const std::string* const from[] = {&old, &now, nullptr};
            const std::string* const source = from[below(3)];
            for (size_t k = i; source && k < std::min({i + block, bytes.size(), source->size()});
                 ++k)
                bytes[k] = (*source)[k];
        }
        return bytes;
    }
    void lose_power() {
        for (const auto& [path, bytes] : synced)
            if (const Bytes now = content(path); now && *now != bytes) put(path, torn(bytes, *now));
        const size_t kept = size_t(below(changes.size() + 1));
        while (changes.size() > kept) undo(changes.back()), changes.pop_back();
    }
    // Every call that changes the disk calls this first.
    void may_lose_power() {
        if (fault("power") != "CUT") return;
        lose_power();
        ::kill(::getpid(), SIGKILL);
    }
    void opens(const std::string& path, bool empties) {
        may_lose_power();
        const Bytes before = on_disk(path);
        if (!before) changes.push_back({"", path, {}});
        if (!before || empties) synced[path] = before.value_or("");
    }
};
Disk& disk() {
    static Disk disk;
    return disk;
}
std::recursive_mutex mutex;
using Lock = std::lock_guard<std::recursive_mutex>;

// Whether the call fails; sets errno.
bool fails(const std::string& what) {
    const int error = what == "EIO" ? EIO : what == "ENOSPC" ? ENOSPC : what == "EINTR" ? EINTR : 0;
    if (error != 0) errno = error;
    return error != 0;
}
// Loses the unwritten data, and half of the file with it.
void lose(int fd) {
    struct stat status {};
    if (::fstat(fd, &status) == 0 && S_ISREG(status.st_mode))
        (void)!::ftruncate(fd, status.st_size / 2);
}

}  // namespace

extern "C" {

int open(const char* name, int flags, ...) {
    std::va_list rest;
    va_start(rest, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    const std::string path = absolute(name);
    const Lock lock(mutex);
    if (disk().has(path)) {
        if (fails(disk().fault("open"))) return -1;
        if ((flags & O_ACCMODE) != O_RDONLY) disk().opens(path, flags & O_TRUNC);
    }
    return NEXT(open)(name, flags, mode);
}
ssize_t write(int fd, const void* bytes, size_t size) {
    const Lock lock(mutex);
    if (disk().has(path_of(fd))) {
        disk().may_lose_power();
        const std::string what = disk().fault("write");
        if (fails(what)) return -1;
        if (what == "SHORT" && size > 1) size = 1 + size_t(disk().below(size - 1));
    }
    return NEXT(write)(fd, bytes, size);
}
// fsync takes no time here: this library decides what a power cut loses.
int fsync(int fd) {
    const std::string path = path_of(fd);
    const Lock lock(mutex);
    if (!disk().has(path + "/")) return NEXT(fsync)(fd);
    disk().may_lose_power();
    const std::string what = disk().fault("fsync");
    if (what == "EIO") lose(fd), disk().forgets.insert(path);
    if (fails(what)) return -1;
    if (fs::is_directory(path))
        std::erase_if(disk().changes, [&](const Change& c) {
            return fs::path(c.to.empty() ? c.from : c.to).parent_path() == path;
        });
    else if (!disk().forgets.contains(path))
        disk().synced[path] = content(path).value_or("");
    return 0;
}
int rename(const char* from_name, const char* to_name) {
    const std::string from = absolute(from_name), to = absolute(to_name);
    const Lock lock(mutex);
    if (disk().has(to)) {
        disk().may_lose_power();
        if (fails(disk().fault("rename"))) return -1;
        disk().changes.push_back({from, to, disk().on_disk(to)});
        if (auto moved = disk().synced.extract(from)) {
            disk().synced.erase(to);
            moved.key() = to;
            disk().synced.insert(std::move(moved));
        }
    }
    return NEXT(rename)(from_name, to_name);
}
// The descriptor is closed whatever close() returns.
int close(int fd) {
    const std::string path = path_of(fd);
    const Lock lock(mutex);
    const std::string what = disk().has(path) ? disk().fault("close") : "";
    if (what == "EIO") lose(fd);
    const int result = NEXT(close)(fd);
    return fails(what) ? -1 : result;
}
int unlink(const char* name) {
    const std::string path = absolute(name);
    const Lock lock(mutex);
    if (disk().has(path)) {
        disk().may_lose_power();
        if (fails(disk().fault("unlink"))) return -1;
        if (const Bytes lost = disk().on_disk(path)) disk().changes.push_back({path, "", lost});
        disk().synced.erase(path);
    }
    return NEXT(unlink)(name);
}

}  // extern "C"

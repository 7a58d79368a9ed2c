// faults/disk.cpp  simulates faults of disk, clock and power; preload it (LD_PRELOAD)
//
// The environment variable DISK_FAULTS holds words:
//     on=FOLDER      files below it are on this disk; may be repeated
//     seed=N         seed of the random faults
//     log=FILE       gets a line per fault
//     CALL:WHAT=P    a call has this fault with probability P: read:EIO=0.01
//     CALL:WHAT@K    the K-th call has this fault, counted from 1
//     room=N         the disk is full after N bytes
// CALL is open, read, write, fsync, rename, close, unlink, real or steady (a clock), power; WHAT is
// EIO, ENOSPC, EINTR, SHORT (some of the bytes), STEP (of the clock), CUT (of the power).
//
// The power is cut before the K-th call that changes the disk (K = 0: when the program has ended).
// Data without fsync is lost or torn: each block of a file may be the old one, the new one or zero.
// The last creations, renames and removals in folders may be undone.  An fsync or close that fails
// with EIO loses half of the file at once.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

template <class Call>
Call* real(const char* name) {
    return reinterpret_cast<Call*>(::dlsym(RTLD_NEXT, name));
}
#define NEXT(name) real<decltype(::name)>(#name)

// ---- Requested faults ---------------------------------------------------------------------------

struct Rule {
    std::string call, what;
    double chance = 0;
    uint64_t at = UINT64_MAX, seen = 0;
};

struct Plan {
    std::vector<std::string> on;
    std::vector<Rule> rules;
    uint64_t state = 0, room = UINT64_MAX;
    int log = -1;

    Plan() {
        const char* words = std::getenv("DISK_FAULTS");
        std::istringstream in(words ? words : "");
        for (std::string word; in >> word;) {
            const size_t split = word.find_first_of("=@");
            const std::string key = word.substr(0, split), value = word.substr(split + 1);
            const size_t colon = key.find(':');
            if (key == "on") on.push_back(value + "/");
            if (key == "seed") state = std::strtoull(value.c_str(), nullptr, 10);
            if (key == "room") room = std::strtoull(value.c_str(), nullptr, 10);
            if (key == "log")
                log = NEXT(open)(value.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
            if (colon == key.npos) continue;
            Rule rule{key.substr(0, colon), key.substr(colon + 1)};
            if (word[split] == '@')
                rule.at = std::strtoull(value.c_str(), nullptr, 10);
            else
                rule.chance = std::strtod(value.c_str(), nullptr);
            rules.push_back(rule);
        }
    }
    // SplitMix64 (Steele, Lea, Flood 2014).
    uint64_t draw() {
        uint64_t z = (state += 0x9e3779b97f4a7c15);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }
    uint64_t below(uint64_t n) { return n ? draw() % n : 0; }
    bool is_ours(const std::string& path) const {
        for (const std::string& folder : on)
            if (path.starts_with(folder)) return true;
        return false;
    }
    void note(const std::string& call, const std::string& what, const std::string& path) const {
        const std::string line = call + " " + what + " " + path + "\n";
        if (log >= 0) (void)!NEXT(write)(log, line.data(), line.size());
    }
    // The fault of this call; "": none.
    std::string fault(const std::string& call, const std::string& path) {
        std::string what;
        for (Rule& rule : rules) {
            if (rule.call != call) continue;
            const bool due = ++rule.seen == rule.at;
            const bool drawn = rule.chance > 0 && double(draw() >> 11) * 0x1p-53 < rule.chance;
            if (what.empty() && (due || drawn)) what = rule.what;
        }
        if (!what.empty()) note(call, what, path);
        return what;
    }
};

Plan& plan() {
    static Plan plan;
    return plan;
}
std::recursive_mutex mutex;
using Lock = std::lock_guard<std::recursive_mutex>;

int number_of(const std::string& what) {
    return what == "EIO" ? EIO : what == "ENOSPC" ? ENOSPC : what == "EINTR" ? EINTR : 0;
}

// Whether the call fails; sets errno.
bool fails(const std::string& what) {
    if (const int error = number_of(what)) return errno = error, true;
    return false;
}

// ---- Contents of the disk -----------------------------------------------------------------------

std::string absolute(const char* path) {
    std::error_code failed;
    return fs::absolute(path, failed).lexically_normal().string();
}
std::string path_of(int fd) {
    std::error_code failed;
    return fs::read_symlink("/proc/self/fd/" + std::to_string(fd), failed).string();
}

using Bytes = std::optional<std::string>;  // none: no such file

Bytes content(const std::string& path) {
    const int fd = NEXT(open)(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) return {};
    std::string bytes(1 << 16, '\0'), all;
    for (ssize_t n; (n = NEXT(read)(fd, bytes.data(), bytes.size())) > 0;)
        all.append(bytes, 0, size_t(n));
    NEXT(close)(fd);
    return all;
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

struct Disk {
    std::map<std::string, std::string> synced;  // contents on the disk of files that we write
    std::map<std::string, bool> forgets;        // after a failed fsync: see fsync(2)
    std::vector<Change> changes;
    uint64_t calls = 0;

    Bytes on_disk(const std::string& path) const {
        const auto found = synced.find(path);
        return found == synced.end() ? content(path) : found->second;
    }
    std::string torn(const std::string& old, const std::string& now) const {
        constexpr size_t block = 512;
        const size_t sizes[] = {old.size(), now.size(), size_t(plan().below(now.size() + 1))};
        std::string bytes(sizes[plan().below(3)], '\0');
        for (size_t i = 0; i < bytes.size(); i += block) {
            const std::string* const from[] = {&old, &now, nullptr};
            const std::string* const source = from[plan().below(3)];
            if (source && i < source->size())
                bytes.replace(i, std::min(block, bytes.size() - i), *source, i,
                              std::min(block, bytes.size() - i));
        }
        return bytes;
    }
    void undo(const Change& c) const {
        if (c.from.empty()) return put(c.to, {});
        if (!c.to.empty()) put(c.from, content(c.to)), put(c.to, c.lost);
        if (c.to.empty()) put(c.from, c.lost);
    }
    void lose_power() {
        for (const auto& [path, bytes] : synced)
            if (const Bytes now = content(path); now && *now != bytes) put(path, torn(bytes, *now));
        const size_t kept = plan().below(changes.size() + 1);
        while (changes.size() > kept) undo(changes.back()), changes.pop_back();
    }
    // Every call that changes the disk calls this first.
    void may_lose_power(const char* call, const std::string& path) {
        ++calls;
        if (plan().fault("power", call + (" of " + path)) != "CUT") return;
        lose_power();
        ::kill(::getpid(), SIGKILL);
    }
};

Disk& disk() {
    static Disk disk;
    return disk;
}

// Cuts the power when the program has ended.
struct End {
    ~End() {
        for (const Rule& rule : plan().rules)
            if (rule.call == "power" && rule.at == 0) {
                plan().note("power", "CUT", "at the end");
                disk().lose_power();
            }
    }
};

void opens(const std::string& path, int flags) {
    disk().may_lose_power("open", path);
    const Bytes before = disk().on_disk(path);
    if (!before) disk().changes.push_back({"", path, {}});
    if (!before || (flags & O_TRUNC)) disk().synced[path] = before.value_or("");
}

// ---- Calls --------------------------------------------------------------------------------------

template <class Next>
int open_by(Next* next, const char* name, int flags, mode_t mode) {
    const std::string path = absolute(name);
    if (!plan().is_ours(path)) return next(name, flags, mode);
    const Lock lock(mutex);
    disk();
    static End end;
    if (fails(plan().fault("open", path))) return -1;
    if ((flags & O_ACCMODE) != O_RDONLY) opens(path, flags);
    return next(name, flags, mode);
}

template <class Next>
ssize_t write_by(Next next, int fd, size_t size) {
    const std::string path = path_of(fd);
    if (!plan().is_ours(path)) return next(size);
    const Lock lock(mutex);
    disk().may_lose_power("write", path);
    const std::string what = plan().fault("write", path);
    if (fails(what)) return -1;
    if (what == "SHORT" && size > 1) size = 1 + size_t(plan().below(size - 1));
    if (plan().room < size) plan().note("write", "FULL", path), size = size_t(plan().room);
    if (size == 0 && plan().room == 0) return errno = ENOSPC, -1;
    const ssize_t n = next(size);
    if (plan().room != UINT64_MAX && n > 0) plan().room -= uint64_t(n);
    return n;
}

template <class Next>
int remove_by(Next* next, const char* name) {
    const std::string path = absolute(name);
    if (!plan().is_ours(path)) return next(name);
    const Lock lock(mutex);
    disk().may_lose_power("unlink", path);
    if (fails(plan().fault("unlink", path))) return -1;
    const Bytes lost = disk().on_disk(path);
    if (lost) disk().changes.push_back({path, "", lost});
    disk().synced.erase(path);
    return next(name);
}

// Loses the unwritten data, and half of the file with it.
void lose(int fd) {
    struct stat status {};
    if (::fstat(fd, &status) == 0 && S_ISREG(status.st_mode))
        (void)!::ftruncate(fd, status.st_size / 2);
}

timespec steps[2];  // steps so far of the real-time and the monotonic clock

timespec sum(timespec a, timespec b, int sign) {
    const long nanoseconds = a.tv_nsec + sign * b.tv_nsec;
    const long carry = nanoseconds < 0 ? -1 : nanoseconds >= 1000000000 ? 1 : 0;
    return {a.tv_sec + sign * b.tv_sec + carry, nanoseconds - carry * 1000000000};
}

}  // namespace

extern "C" {

int open(const char* name, int flags, ...) {
    std::va_list rest;
    va_start(rest, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return open_by(real<int(const char*, int, ...)>("open"), name, flags, mode);
}
int open64(const char* name, int flags, ...) {
    std::va_list rest;
    va_start(rest, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return open_by(real<int(const char*, int, ...)>("open64"), name, flags, mode);
}
// std::ifstream opens files by this call.
FILE* fopen64(const char* name, const char* mode) {
    const std::string path = absolute(name);
    if (!plan().is_ours(path)) return NEXT(fopen64)(name, mode);
    const Lock lock(mutex);
    return fails(plan().fault("open", path)) ? nullptr : NEXT(fopen64)(name, mode);
}
ssize_t read(int fd, void* bytes, size_t size) {
    const std::string path = path_of(fd);
    if (!plan().is_ours(path)) return NEXT(read)(fd, bytes, size);
    const Lock lock(mutex);
    const std::string what = plan().fault("read", path);
    if (fails(what)) return -1;
    if (what == "SHORT" && size > 1)
        size = 1 + size_t(plan().below(std::min<size_t>(size, 4096) - 1));
    return NEXT(read)(fd, bytes, size);
}
ssize_t write(int fd, const void* bytes, size_t size) {
    return write_by([&](size_t n) { return NEXT(write)(fd, bytes, n); }, fd, size);
}
// fsync takes no time here: this library decides what a power cut loses.
int fsync(int fd) {
    const std::string path = path_of(fd);
    if (!plan().is_ours(path + "/")) return NEXT(fsync)(fd);
    const Lock lock(mutex);
    disk().may_lose_power("fsync", path);
    const std::string what = plan().fault("fsync", path);
    if (what == "EIO") lose(fd), disk().forgets[path] = true;
    if (fails(what)) return -1;
    struct stat status {};
    ::fstat(fd, &status);
    if (S_ISDIR(status.st_mode)) {
        std::erase_if(disk().changes, [&](const Change& c) {
            return fs::path(c.to.empty() ? c.from : c.to).parent_path() == path;
        });
    } else if (!disk().forgets[path]) {
        disk().synced[path] = content(path).value_or("");
    }
    return 0;
}
int rename(const char* from_name, const char* to_name) {
    const std::string from = absolute(from_name), to = absolute(to_name);
    if (!plan().is_ours(to)) return NEXT(rename)(from_name, to_name);
    const Lock lock(mutex);
    disk().may_lose_power("rename", to);
    if (fails(plan().fault("rename", to))) return -1;
    disk().changes.push_back({from, to, disk().on_disk(to)});
    if (auto moved = disk().synced.extract(from)) {
        disk().synced.erase(to);
        moved.key() = to;
        disk().synced.insert(std::move(moved));
    }
    return NEXT(rename)(from_name, to_name);
}
// The descriptor is closed whatever close() returns.
int close(int fd) {
    const std::string path = path_of(fd);
    if (!plan().is_ours(path)) return NEXT(close)(fd);
    const Lock lock(mutex);
    const std::string what = plan().fault("close", path);
    if (what == "EIO") lose(fd);
    const int result = NEXT(close)(fd);
    return fails(what) ? -1 : result;
}
int unlink(const char* name) { return remove_by(NEXT(unlink), name); }
int remove(const char* name) { return remove_by(NEXT(remove), name); }

int clock_gettime(clockid_t id, timespec* now) {
    const int result = NEXT(clock_gettime)(id, now);
    if (id != CLOCK_REALTIME && id != CLOCK_MONOTONIC) return result;
    const Lock lock(mutex);
    const bool steady = id == CLOCK_MONOTONIC;
    if (plan().fault(steady ? "steady" : "real", "clock") == "STEP") {
        const long hour = 3600, seconds = long(plan().below(steady ? 60 : 48 * hour));
        steps[steady] = sum(steps[steady], {steady ? seconds : seconds - 24 * hour, 0}, 1);
    }
    *now = sum(*now, steps[steady], 1);
    return result;
}
// The kernel's clock has no steps.
int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* held, clockid_t id,
                           const timespec* until) {
    timespec step{};
    {
        const Lock lock(mutex);
        step = steps[id == CLOCK_MONOTONIC];
    }
    const timespec by_the_kernel = sum(*until, step, -1);
    return NEXT(pthread_cond_clockwait)(condition, held, id, &by_the_kernel);
}

}  // extern "C"

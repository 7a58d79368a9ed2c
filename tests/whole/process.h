// whole/process.h  complete programs: processes, and expectations of their results
#pragma once
#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>

#include "base/cases.h"
#include "keep/read_pfm.h"
#include "text/folder.h"

using Words = std::vector<std::string>;
inline Words operator+(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

// A program and its arguments; a line is split at blanks.
struct Command {
    Words words;
    Command(const char* line) : words(split(line)) {}
    Command(const std::string& line) : words(split(line)) {}
    Command(Words w) : words(std::move(w)) {}
    std::string line() const {
        std::string text;
        for (const std::string& word : words) text.append(word, 0, 100).append(" ");
        return text;
    }
};

struct Outcome {
    int status = -1;  // the exit status
    int signal = 0;   // or the signal that killed it
    std::string out, err;
};

// Both ends of a pipe or, for writing only, of a terminal.
struct Channel {
    int from = -1, to = -1;
};

inline Channel pipe_channel() {
    int ends[2];
    REQUIRE(::pipe2(ends, O_CLOEXEC) == 0);
    return {ends[0], ends[1]};
}

inline Channel terminal_channel() {
    const int from = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    REQUIRE(from >= 0);
    REQUIRE(::grantpt(from) == 0);
    REQUIRE(::unlockpt(from) == 0);
    const int to = ::open(::ptsname(from), O_RDWR | O_NOCTTY | O_CLOEXEC);
    REQUIRE(to >= 0);
    termios plain;  // without \n -> \r\n
    ::tcgetattr(to, &plain);
    plain.c_oflag &= ~tcflag_t(OPOST);
    ::tcsetattr(to, TCSANOW, &plain);
    return {from, to};
}

struct Setting {
    bool terminal = false;                // stderr: terminal or pipe
    bool deaf = false;                    // stderr has no reader
    std::string input = {}, output = {};  // bytes for stdin, a file for stdout
    int ignored = 0;                      // a signal
    rlim_t largest_file = RLIM_INFINITY;
};

// A program that runs in a folder.
class Process {
public:
    Process(const Folder& folder, const Command& command, const Setting& setting = {}) {
        const char* suffix = std::getenv("PROGRAM_SUFFIX");
        const std::string path =
            fs::absolute("build/" + command.words.at(0) + (suffix ? suffix : "")).string();
        std::vector<char*> argv;
        for (const std::string& word : command.words)
            argv.push_back(const_cast<char*>(word.c_str()));
        argv[0] = const_cast<char*>(path.c_str());
        argv.push_back(nullptr);

        const Channel in = pipe_channel();
        REQUIRE(::write(in.to, setting.input.data(), setting.input.size()) ==
                ssize_t(setting.input.size()));
        ::close(in.to);
        Channel out = pipe_channel(), err = setting.terminal ? terminal_channel() : pipe_channel();
        if (!setting.output.empty()) {
            ::close(out.to);
            out.to = ::open(setting.output.c_str(), O_WRONLY | O_CLOEXEC);
            REQUIRE(out.to >= 0);
        }
        if (setting.deaf) {
            ::close(err.from);
            err.from = -1;
            open_[1] = false;
        }
        // An early signal must reach the program, not the handlers of this process.
        sigset_t all, before;
        ::sigfillset(&all);
        ::sigprocmask(SIG_SETMASK, &all, &before);
        pid_ = ::fork();
        if (pid_ != 0) ::sigprocmask(SIG_SETMASK, &before, nullptr);
        REQUIRE(pid_ >= 0);
        if (pid_ == 0) {
            for (int s : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ})
                std::signal(s, s == setting.ignored ? SIG_IGN : SIG_DFL);
            ::sigprocmask(SIG_SETMASK, &before, nullptr);
            const rlimit limit{setting.largest_file, setting.largest_file};
            if (limit.rlim_cur != RLIM_INFINITY) ::setrlimit(RLIMIT_FSIZE, &limit);
            if (::chdir(folder.path.c_str()) == 0 && ::dup2(in.from, 0) == 0 &&
                ::dup2(out.to, 1) == 1 && ::dup2(err.to, 2) == 2)
                ::execv(path.c_str(), argv.data());
            ::_exit(127);
        }
        for (int fd : {in.from, out.to, err.to}) ::close(fd);
        from_ = {out.from, err.from};
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    ~Process() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        for (int fd : from_)
            if (fd >= 0) ::close(fd);
    }

    // Reads output for so many seconds, until `enough` holds (true) or the program ends (false).
    bool listen(double seconds, bool (*enough)(const Outcome&) = nullptr) {
        using clock = std::chrono::steady_clock;
        const auto end = clock::now() + std::chrono::duration<double>(seconds);
        while (!enough || !enough(outcome_)) {
            pollfd fds[] = {{open_[0] ? from_[0] : -1, POLLIN, 0},
                            {open_[1] ? from_[1] : -1, POLLIN, 0}};
            const auto left =
                std::chrono::duration_cast<std::chrono::milliseconds>(end - clock::now());
            if (ended() || left.count() <= 0) return false;
            ::poll(fds, 2, int(left.count()) + 1);
            for (size_t i = 0; i < 2; ++i) {
                if (fds[i].revents == 0) continue;
                char buffer[4096];
                const ssize_t n = ::read(from_[i], buffer, sizeof buffer);
                open_[i] = n > 0;
                if (n > 0) (i == 0 ? outcome_.out : outcome_.err).append(buffer, size_t(n));
            }
        }
        return true;
    }

    bool ended() const { return !open_[0] && !open_[1]; }
    void interrupt(int signal = SIGINT) const { ::kill(pid_, signal); }

    // Waits for the end of the program; kills it after a minute.
    Outcome finish() {
        listen(60);
        if (!ended()) ::kill(pid_, SIGKILL);
        int status = 0;
        ::waitpid(pid_, &status, 0);
        pid_ = 0;
        if (WIFEXITED(status)) outcome_.status = WEXITSTATUS(status);
        if (WIFSIGNALED(status)) outcome_.signal = WTERMSIG(status);
        return outcome_;
    }

private:
    pid_t pid_ = 0;
    std::array<int, 2> from_{-1, -1};  // read stdout and stderr
    std::array<bool, 2> open_{true, true};
    Outcome outcome_;
};

inline Outcome run(const Folder& folder, const Command& command, const Setting& setting = {}) {
    return Process(folder, command, setting).finish();
}

// Sends a signal after so many seconds, unless the program ends before.
inline Outcome cut_short(const Folder& folder, const Command& command, double seconds,
                         int signal = SIGINT) {
    Process process(folder, command);
    process.listen(seconds);
    process.interrupt(signal);
    return process.finish();
}

// Repeats cut_short until the outcome is `enough`.  A busy machine may be too slow to begin, so
// each run gets three times the time of the one before.
template <class Enough>
Outcome cut_short_late_enough(const Folder& folder, const Command& command, int signal,
                              Enough enough) {
    Outcome o;
    for (double patience = 0.2; patience < 20 && !enough(o); patience *= 3)
        o = cut_short(folder, command, patience, signal);
    return o;
}

inline bool terminal_to_be_had() {
    const int trial = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (trial >= 0) return ::close(trial), true;
    MESSAGE("this machine lends no pseudo-terminal: not tested");
    return false;
}

// Checks that no file is made, changed or left.
class Untouched {
public:
    explicit Untouched(const Folder& folder) : folder_(folder), before_(folder.all()) {}
    ~Untouched() noexcept(false) {  // a failed check may throw
        if (std::uncaught_exceptions() > 0) return;
        const auto after = folder_.all();
        std::string changed;
        for (const auto& [name, bytes] : after)
            if (!before_.contains(name) || before_.at(name) != bytes) changed += name + " ";
        for (const auto& [name, bytes] : before_)
            if (!after.contains(name)) changed += name + " ";
        CHECK(changed == "");
    }

private:
    const Folder& folder_;
    const std::map<std::string, std::string> before_;
};

// Ends with this exit status.
inline Outcome expect_exit(const Folder& folder, const Command& command, int status,
                           const Setting& setting = {}) {
    const Outcome o = run(folder, command, setting);
    INFO(command.line(), "\nstderr: ", o.err);
    CHECK(o.signal == 0);
    CHECK(o.status == status);
    return o;
}

// Refused: exit status 2, one printable line with the reason, and no file touched.
inline void expect_refusal(const Folder& folder, const Command& command, const std::string& why) {
    INFO(command.line(), "\nexpected: ", why);
    const Untouched all(folder);
    const Outcome o = expect_exit(folder, command, 2);
    INFO("stderr: ", o.err);
    CHECK(o.out == "");
    CHECK(o.err.starts_with(why));
    CHECK(o.err.size() < 300 + why.size());
    const size_t odd = size_t(
        std::count_if(o.err.begin(), o.err.end(), [](char c) { return c < ' ' || c > '~'; }));
    CHECK(odd == 1);  // the line's end
    CHECK(o.err.ends_with('\n'));
}

// Each row has the words after `start`.
inline void expect_refusals(const Folder& folder, const std::string& start,
                            const std::vector<Refusal>& rows) {
    for (const auto& [words, why] : rows) expect_refusal(folder, start + " " + words, why);
}

// Success: exit status 0.
inline Outcome expect_success(const Folder& folder, const Command& command) {
    const Outcome o = expect_exit(folder, command, 0);
    CHECK(o.out == "");
    return o;
}

inline double seconds_of(const Folder& folder, const Command& command) {
    const auto start = std::chrono::steady_clock::now();
    expect_success(folder, command);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The first of these parts that the text lacks; "" if it has all.
inline std::string missing(const std::string& text, const std::string& parts) {
    for (const std::string& part : parts_of(parts))
        if (!contains(text, part)) return part;
    return "";
}

// Expects one page on stdout, with each of these parts.
inline void expect_help(const Folder& folder, const Command& command, long lines,
                        const std::string& parts) {
    const Outcome o = expect_exit(folder, command, 0);
    CHECK(o.err == "");
    CHECK(missing(o.out, parts) == "");
    CHECK(o.out.ends_with("\n"));
    CHECK(std::count(o.out.begin(), o.out.end(), '\n') <= lines);
    std::istringstream in(o.out);
    for (std::string text; std::getline(in, text);) CHECK(text.size() <= 80);
}

inline const std::string camera = "camera 0 0 5  0 0 0  40\n";
inline const std::string good = "size 8 4\n" + camera +
                                "diffuse m .5 .5 .5\n"
                                "light l 1 1 1\n"
                                "sphere 0 0 0  1  m\n"
                                "sphere 0 5 0  1  l\n";  // six lines
// A scene of diffuse surfaces only, for maps.
inline const std::string diffuse_scene = good + "quad -9 -1 -9  0 0 18  18 0 0  m\n";

// A folder with a scene for penumbra.
struct Place : Folder {
    explicit Place(const std::string& scene) { write("file.scene", scene); }
    Outcome render(const std::string& options) const {
        return expect_success(*this, "penumbra " + options + " file.scene");
    }
    Image image(const std::string& options) const {
        render(options + " -o image.pfm");
        return read_pfm(*this / "image.pfm");
    }
    // The statistics, as JSON.
    std::string stats(const std::string& options) const {
        render(options + " -o image.pfm --stats stats.json");
        return read("stats.json");
    }
};

// The scene has a mesh of one triangle, whose material is in a third file.
struct MeshPlace : Place {
    MeshPlace() : Place(good + "mesh m.obj 1 0 0 0\n") {
        write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
        write("m.mtl", "newmtl a\nKd 1 1 1\n");
    }
};

// The value after "KEY": in statistics.
inline std::string stated(const std::string& json, const std::string& key) {
    const std::string start = "\n  \"" + key + "\": ";
    const size_t at = json.find(start);
    REQUIRE(at != json.npos);
    std::string value = json.substr(at + start.size(), json.find('\n', at + 1) - at - start.size());
    if (value.ends_with(',')) value.pop_back();
    return value;
}
// The number, or the first of a list; NaN for null.
inline double number_of(const std::string& json, const std::string& key) {
    const std::string value = stated(json, key);
    return value.starts_with("null") ? NAN
                                     : std::strtod(value.c_str() + (value[0] == '['), nullptr);
}

struct Summary {
    std::string scene;
    double samples = 0;
    double seconds = -1, speed = -1;
    std::string error;  // as printed
    bool interrupted = false, found = false;
};

// Parses the line with the number of samples; a progress bar may precede it.
inline Summary summary(const std::string& err) {
    Summary s;
    s.interrupted = s.found =
        contains(err, ": interrupted before the first pass was complete: no image written\n");
    const size_t end = err.find('\n', err.find(" Mrays/s"));
    if (end == err.npos) return s;
    std::string line = err.substr(0, end);
    line.erase(0, line.find_last_of("\n\033") + 1);
    if (line.starts_with("[K")) line.erase(0, 2);
    char name[200] = "";
    int read_to = 0;
    s.found = std::sscanf(line.c_str(), "%199[^:]: %lf %*s per pixel, %lf s, %lf Mrays/s%n", name,
                          &s.samples, &s.seconds, &s.speed, &read_to) == 4;
    s.scene = name;
    line.erase(0, size_t(read_to));
    const std::string early = " (interrupted)";
    s.interrupted = line.ends_with(early);
    if (s.interrupted) line.erase(line.size() - early.size());
    if (!line.empty()) s.error = line.substr(2);
    s.found = s.found && (s.error.empty() || contains(s.error, "error "));
    return s;
}

// A closed box of mirrors without light: only the scene's depth ends a path.
inline std::string hall_of_mirrors(const std::string& size, int depth) {
    return "size " + size + "\n" + camera + "depth " + std::to_string(depth) +
           "\nmirror m 1 1 1\nbox 20 20 20  7  -10 -10 -10  m\n";
}

inline std::string pfm(int width, int height, const std::vector<float>& from_top_left) {
    std::string bytes = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
    const size_t row = 3 * size_t(width);
    for (size_t y = size_t(height); y-- > 0;)
        bytes.append(reinterpret_cast<const char*>(from_top_left.data() + y * row),
                     row * sizeof(float));
    return bytes;
}

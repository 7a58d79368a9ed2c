// whole/process.h  programs as their user meets them: a folder to work in, a process, what to
// expect
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
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "film/image.h"

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// ---- A place to work, and programs to run there -------------------------------------------------

// A directory of its own, removed at the end.
struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "penumbra-program-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path = name;
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path); }

    void write(const std::string& name, const std::string& bytes) const {
        fs::create_directories((path / name).parent_path());
        std::ofstream(path / name, std::ios::binary) << bytes;
    }
    bool has(const std::string& name) const { return fs::exists(path / name); }
    std::string read(const std::string& name) const {
        REQUIRE(has(name));
        return read_file((path / name).string());
    }
    // Of two files; a failed CHECK prints no bytes.
    bool same(const std::string& a, const std::string& b) const { return read(a) == read(b); }
    Image image(const std::string& name) const { return read_pfm((path / name).string()); }
    // Everything that is there, with its bytes.
    std::map<std::string, std::string> all() const {
        std::map<std::string, std::string> found;
        for (const auto& entry : fs::recursive_directory_iterator(path))
            found[fs::relative(entry.path(), path).string()] =
                entry.is_directory() ? "a directory" : read_file(entry.path().string());
        return found;
    }
};

struct Outcome {
    int status = -1;  // of an exit
    int signal = 0;   // or what killed it
    std::string out, err;
};

// A program that runs in a folder, its stderr a pipe or a terminal.
class Process {
public:
    struct Setting {
        bool terminal = false;
        rlim_t largest_file = RLIM_INFINITY;
    };

    Process(const Folder& folder, const std::string& program, const Words& words, Setting setting) {
        const char* suffix = std::getenv("PROGRAM_SUFFIX");
        const std::string path = fs::absolute("build/" + program + (suffix ? suffix : "")).string();
        std::vector<char*> argv{const_cast<char*>(path.c_str())};
        for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
        argv.push_back(nullptr);

        int out[2], err[2];
        REQUIRE(::pipe2(out, O_CLOEXEC) == 0);
        if (setting.terminal) {
            err[0] = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
            REQUIRE(err[0] >= 0);
            REQUIRE(::grantpt(err[0]) == 0);
            REQUIRE(::unlockpt(err[0]) == 0);
            err[1] = ::open(::ptsname(err[0]), O_RDWR | O_NOCTTY | O_CLOEXEC);
            REQUIRE(err[1] >= 0);
            termios plain;  // without \n -> \r\n
            ::tcgetattr(err[1], &plain);
            plain.c_oflag &= ~tcflag_t(OPOST);
            ::tcsetattr(err[1], TCSANOW, &plain);
        } else {
            REQUIRE(::pipe2(err, O_CLOEXEC) == 0);
        }
        pid_ = ::fork();
        REQUIRE(pid_ >= 0);
        if (pid_ == 0) {
            std::signal(SIGINT, SIG_DFL);
            const rlimit limit{setting.largest_file, setting.largest_file};
            if (setting.largest_file != RLIM_INFINITY) {
                std::signal(SIGXFSZ, SIG_IGN);
                ::setrlimit(RLIMIT_FSIZE, &limit);
            }
            if (::chdir(folder.path.c_str()) == 0 && ::dup2(out[1], 1) == 1 &&
                ::dup2(err[1], 2) == 2)
                ::execv(path.c_str(), argv.data());
            ::_exit(127);
        }
        ::close(out[1]);
        ::close(err[1]);
        from_ = {out[0], err[0]};
    }
    Process(const Folder& folder, const std::string& program, const Words& words)
        : Process(folder, program, words, Setting()) {}
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    ~Process() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        for (int fd : from_) ::close(fd);
    }

    // Reads what the program prints, until it is enough (true) or for so many seconds, or all that
    // will ever come (false).
    template <class Enough>
    bool listen(double seconds, Enough enough) {
        using clock = std::chrono::steady_clock;
        const auto end = clock::now() + std::chrono::duration<double>(seconds);
        while (!enough(outcome_)) {
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
    void interrupt() const { ::kill(pid_, SIGINT); }

    // Waits for its end; kills it after a minute.
    Outcome finish() {
        listen(60, [](const Outcome&) { return false; });
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
    std::array<int, 2> from_{-1, -1};  // its stdout and stderr
    std::array<bool, 2> open_{true, true};
    Outcome outcome_;
};

inline Outcome run(const Folder& folder, const std::string& program, const Words& words) {
    return Process(folder, program, words).finish();
}

inline bool terminal_to_be_had() {
    const int trial = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (trial >= 0) ::close(trial);
    return trial >= 0;
}

// "--spp 1 ''" is three words, the last of them empty.
inline Words split(const std::string& line) {
    Words words;
    std::istringstream in(line);
    for (std::string word; in >> word;) words.push_back(word == "''" ? "" : word);
    return words;
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

// ---- What to expect of a run --------------------------------------------------------------------

// Refused: exit status 2, one printable line that says why, and not a file made, changed or left.
inline void expect_refusal(const Folder& folder, const std::string& program, const Words& words,
                           const std::string& why) {
    const auto before = folder.all();
    const Outcome o = run(folder, program, words);
    std::string line;
    for (const std::string& word : words) line.append(" ").append(word, 0, 100);
    INFO(program, line, "\nexpected: ", why, "\nstderr:   ", o.err);
    CHECK(o.signal == 0);
    CHECK(o.status == 2);
    CHECK(o.out == "");
    CHECK(o.err.starts_with(why));
    CHECK(o.err.size() < 300 + why.size());
    const bool printable = std::all_of(o.err.begin(), o.err.end(),
                                       [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); });
    CHECK(printable);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    CHECK(o.err.back() == '\n');
    const bool untouched = folder.all() == before;
    CHECK(untouched);
}

// Done: exit status 0.
inline Outcome expect_success(const Folder& folder, const std::string& program,
                              const Words& words) {
    const Outcome o = run(folder, program, words);
    std::string line;
    for (const std::string& word : words) line.append(" ").append(word);
    INFO(program, line, "\nstderr: ", o.err);
    CHECK(o.signal == 0);
    CHECK(o.status == 0);
    CHECK(o.out == "");
    return o;
}

inline bool all_finite(const Image& image) {
    for (const auto& pixel : image.pixels)
        for (float channel : pixel)
            if (!std::isfinite(channel)) return false;
    return !image.pixels.empty();
}

struct Summary {
    std::string scene;
    unsigned long long samples = 0, non_finite = 1;
    double seconds = -1, speed = -1;
    bool interrupted = false, found = false;
};

// Of the last line.
inline Summary summary(const std::string& err) {
    Summary s;
    if (!err.ends_with('\n')) return s;
    const size_t start = err.find_last_of("\n\r", err.size() - 2) + 1, name = err.find(": ", start);
    if (name == err.npos) return s;
    s.scene = err.substr(start, name - start);
    int end = 0;
    const std::string rest = err.substr(name);
    const int read =
        std::sscanf(rest.c_str(), ": %llu samples per pixel, %lf s, %lf Mrays/s, %llu non-finite%n",
                    &s.samples, &s.seconds, &s.speed, &s.non_finite, &end);
    s.interrupted = contains(rest, "(interrupted)");
    s.found = read == 4 && (rest.substr(size_t(end)) == "\n" || s.interrupted);
    return s;
}

// ---- Scenes and images -------------------------------------------------------------------------

inline const std::string camera = "camera 0 0 5  0 0 0  40\n";
inline const std::string good = "size 8 4\n" + camera +
                                "diffuse m .5 .5 .5\n"
                                "light l 1 1 1\n"
                                "sphere 0 0 0  1  m\n"
                                "sphere 0 5 0  1  l\n";  // six lines

// A closed box of mirrors, no light: a path ends only with the scene's depth.
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

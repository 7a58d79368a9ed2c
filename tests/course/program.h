// course/program.h  a program that answers questions over pipes, whatever else it may do
#pragma once
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "course/rows.h"

namespace penumbra::course {

// Rows of as many numbers each.
struct Rows {
    size_t width = 0;
    Out numbers;

    Rows() = default;
    explicit Rows(const Out& row) : width(row.size()), numbers(row) {}
    Rows(std::initializer_list<Out> rows) {
        for (const Out& row : rows) add(row);
    }
    void add(const Out& row) {
        if (!numbers.empty() && row.size() != width) throw std::logic_error("rows of two lengths");
        width = row.size();
        numbers.insert(numbers.end(), row.begin(), row.end());
    }
    size_t size() const { return width ? numbers.size() / width : 0; }
    In operator[](size_t i) const { return In(numbers).subspan(i * width, width); }
};

// No answer comes: the program has crashed, ended or hangs, or what it says is none.
struct Silence : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Program {
public:
    Program(char** words, double patience) : patience_(patience) {
        std::signal(SIGPIPE, SIG_IGN);
        int in[2], out[2];
        if (::pipe(in) != 0 || ::pipe(out) != 0) throw std::runtime_error("no pipe");
        for (int end : {in[0], in[1], out[0], out[1]}) ::fcntl(end, F_SETFD, FD_CLOEXEC);
        pid_ = ::fork();
        if (pid_ < 0) throw std::runtime_error("no process");
        if (pid_ == 0) {
            ::setpgid(0, 0);
            if (::dup2(in[0], 0) == 0 && ::dup2(out[1], 1) == 1) ::execvp(words[0], words);
            std::fprintf(stderr, "judge: cannot run %s: %s\n", words[0], std::strerror(errno));
            ::_exit(127);
        }
        ::close(in[0]), ::close(out[1]);
        to_ = in[1], from_ = out[0];
        ::fcntl(to_, F_SETFL, O_NONBLOCK);
        asked_ = "its start";
        deadline_ = now() + patience_;
        const std::string hello = line();
        if (hello != "double" && hello != "float")
            throw Silence("the first it prints is '" + hello.substr(0, 40) + "', no answer");
        is_float_ = hello == "float";
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program() {
        end();
        ::close(to_), ::close(from_);
    }
    bool is_float() const { return is_float_; }

    Rows ask(const std::string& question, const Rows& in) {
        asked_ = question + shown(in);
        deadline_ = now() + patience_;
        std::string bytes = question + " " + std::to_string(in.width ? in.size() : 1) + " " +
                            std::to_string(in.width) + "\n";
        bytes.append(reinterpret_cast<const char*>(in.numbers.data()),
                     in.numbers.size() * sizeof(double));
        write(bytes);
        const std::string head = line();
        if (head[0] == '!') throw Silence(asked_ + " " + head.substr(1));
        char* end = nullptr;
        Rows out;
        out.width = std::strtoull(head.c_str(), &end, 10);
        const size_t rows = std::max<size_t>(1, in.size());
        if (*end || head.empty() || out.width > most / sizeof(double) / rows)
            throw Silence(asked_ + ": '" + head.substr(0, 40) + "' is no answer");
        out.numbers.resize(rows * out.width);
        read(reinterpret_cast<char*>(out.numbers.data()), out.numbers.size() * sizeof(double));
        return out;
    }

private:
    static constexpr size_t most = size_t(1) << 28;  // bytes of an answer
    double patience_, deadline_ = 0;
    pid_t pid_ = -1;
    int to_ = -1, from_ = -1;
    bool is_float_ = false;
    std::string asked_, read_;  // what came and was not yet looked at
    size_t at_ = 0;

    static double now() {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
            .count();
    }
    static std::string shown(const Rows& in) {
        std::string text = "(";
        for (size_t i = 0; i < std::min<size_t>(in.width, 6); ++i) {
            char number[32];
            std::snprintf(number, sizeof number, "%s%.6g", i ? ", " : "", in.numbers[i]);
            text += number;
        }
        return text + (in.width > 6 ? ", ...)" : ")") + (in.size() > 1 ? ", ..." : "");
    }

    int end() {
        int status = 0;
        if (pid_ <= 0) return status;
        // Whoever has ended tells why; whoever has not is ended, with all that it began.
        if (::waitpid(pid_, &status, WNOHANG) != pid_) {
            ::kill(-pid_, SIGKILL), ::kill(pid_, SIGKILL);
            ::waitpid(pid_, &status, 0);
        } else {
            ::kill(-pid_, SIGKILL);
        }
        pid_ = -1;
        return status;
    }
    [[noreturn]] void gone() {
        ::usleep(100000);  // its end may come a moment after that of its pipe
        const int status = end();
        // A shell and a sandbox tell of signals by exit statuses above 128.
        const int signal = WIFSIGNALED(status)         ? WTERMSIG(status)
                           : WEXITSTATUS(status) > 128 ? WEXITSTATUS(status) - 128
                                                       : 0;
        if (signal == SIGKILL)
            throw Silence(asked_ + " was ended: it used too much, or closed its pipe");
        if (signal == SIGXCPU)
            throw Silence(asked_ + " used up its processor time: an endless loop?");
        if (signal != 0) throw Silence(asked_ + " crashes: " + ::strsignal(signal));
        throw Silence(asked_ + " ends the program, with exit status " +
                      std::to_string(WEXITSTATUS(status)));
    }
    void wait(int fd, short what) {
        pollfd p{fd, what, 0};
        const double left = deadline_ - now();
        if (left <= 0 || ::poll(&p, 1, int(1000 * left) + 1) == 0) {
            end();
            char text[80];
            std::snprintf(text, sizeof text, " does not end: no answer for %.3g s", patience_);
            throw Silence(asked_ + text);
        }
    }
    // Answers may begin before all is asked: both ends are served.
    void write(const std::string& bytes) {
        for (size_t done = 0; done < bytes.size();) {
            const ssize_t n = ::write(to_, bytes.data() + done, bytes.size() - done);
            if (n > 0)
                done += size_t(n);
            else if (errno == EAGAIN)
                wait(to_, POLLOUT);
            else if (errno == EPIPE)
                return;  // it has ended: what it said before is still to be read
            else if (errno != EINTR)
                gone();
        }
    }
    void more() {
        read_.erase(0, at_), at_ = 0;
        char buffer[1 << 16];
        for (;;) {
            wait(from_, POLLIN);
            const ssize_t n = ::read(from_, buffer, sizeof buffer);
            if (n > 0) {
                read_.append(buffer, size_t(n));
                return;
            }
            if (n == 0 || errno != EINTR) gone();
        }
    }
    std::string line() {
        for (size_t end;; more()) {
            if ((end = read_.find('\n', at_)) != read_.npos) {
                const std::string text = read_.substr(at_, end - at_);
                at_ = end + 1;
                return text;
            }
            if (read_.size() - at_ > 4096) throw Silence(asked_ + ": endless text is no answer");
        }
    }
    void read(char* to, size_t size) {
        while (size > 0) {
            if (at_ == read_.size()) more();
            const size_t n = std::min(size, read_.size() - at_);
            std::memcpy(to, read_.data() + at_, n);
            to += n, at_ += n, size -= n;
        }
    }
};

}  // namespace penumbra::course

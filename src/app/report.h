// app/report.h  2  what runs tell: progress on stderr, statistics in JSON
#pragma once
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <string>

#include "app/option.h"
#include "film/image.h"

// "0.982 %"
inline std::string percent(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3g %%", 100 * x);
    return text;
}

inline std::string fixed(double x, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, x);
    return text;
}

// With so many digits, wherever the point is: "0.02", and as many as there are before it: "234".
inline std::string significant(double x, int digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, x);
    return std::string_view(text).find("e+") == std::string_view::npos ? text : fixed(x, 0);
}

// ---- Progress -----------------------------------------------------------------------------------

// On a terminal a bar that is drawn over itself and goes at the end, elsewhere a plain line now and
// then; on stderr.
class Progress {
public:
    // Of a run that ends after so many seconds, of which some were before; 0: no limit.
    Progress(double limit, bool quiet, double before = 0)
        : limit_(limit), quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), before_(before) {}
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress() {
        if (shown_ && terminal_) std::fputs("\r\033[K", stderr);
    }

    double elapsed() const {
        return before_ + std::chrono::duration<double>(clock::now() - start_).count();
    }

    // `done` is the fraction of all work, 0 if the clock alone ends it; `words` say it in its unit.
    void show(double done, const std::string& words) {
        const double now = elapsed();
        if (quiet_ || now < next_) return;
        next_ = now + (terminal_ ? 0.1 : 2.0);
        if (limit_ > 0) done = std::max(done, now / limit_);
        done = std::min(done, 1.0);
        std::string left = done > 0 ? fixed(now / done - now, 1) + " s left" : "";
        std::string text = words + ", " + fixed(now, 1) + " s elapsed, " + left;
        if (terminal_) {
            std::string bar(size_t(24 * done), '#');
            bar.resize(24, '.');
            std::fprintf(stderr, "\r[%s] %3.0f %%  %s\033[K", bar.c_str(), 100 * done,
                         text.c_str());
        } else {
            std::fprintf(stderr, "%3.0f %%  %s\n", 100 * done, text.c_str());
        }
        shown_ = true;
    }

private:
    using clock = std::chrono::steady_clock;
    const double limit_;
    const bool quiet_;
    const bool terminal_;
    const double before_;
    const clock::time_point start_ = clock::now();
    double next_ = terminal_ ? 0.1 : 2.0;
    bool shown_ = false;
};

// ---- Statistics (--stats) -----------------------------------------------------------------------

// Mean over an image, a channel at a time; NaN stays NaN.
inline std::array<double, 3> mean_of_pixels(const Image& image) {
    std::array<double, 3> sum{};
    for (const auto& pixel : image.pixels)
        for (size_t c = 0; c < 3; ++c) sum[c] += double(pixel[c]);
    for (double& s : sum) s /= double(image.pixels.size());
    return sum;
}

// CPU time of all threads so far, in seconds.
inline double cpu_seconds() {
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    return double(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
           1e-6 * double(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}

inline int64_t peak_memory_bytes() {
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    return int64_t(use.ru_maxrss) * 1024;
}

namespace json {

inline std::string string(std::string_view text) {
    std::string out = "\"";
    for (char c : text) {
        char escaped[8];
        std::snprintf(escaped, sizeof escaped, "\\u%04x", unsigned(static_cast<unsigned char>(c)));
        if (c == '"' || c == '\\')
            out += '\\', out += c;
        else if (static_cast<unsigned char>(c) < ' ')
            out += escaped;
        else
            out += c;
    }
    return out + '"';
}

// JSON has no NaN: what is not known is null.
inline std::string number(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    return std::isfinite(x) ? text : "null";
}

inline std::string numbers(std::array<double, 3> x) {
    std::string text = "[";
    text += number(x[0]) + ", " + number(x[1]) + ", " + number(x[2]) + ']';
    return text;
}

inline std::string truth(bool b) { return b ? "true" : "false"; }

// An object of one member a line.
class Object {
public:
    void add(const std::string& key, const std::string& value) {
        text_ += (text_.empty() ? "  \"" : ",\n  \"") + key + "\": " + value;
    }
    std::string text() const { return "{\n" + text_ + "\n}\n"; }

private:
    std::string text_;
};

}  // namespace json

// What was asked for: the statistics begin with it.
template <class O>
json::Object asked_for(const O& o, const OptionTable<O>& table, Size size) {
    json::Object object;
    object.add("scene", json::string(o.scene));
    object.add("width", std::to_string(size.width));
    object.add("height", std::to_string(size.height));
    for (const Option<O>& row : table)
        if (const std::string value = row.stats(o); !value.empty())
            object.add(std::string(row.name.substr(2)), value);
    return object;
}

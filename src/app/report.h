// app/report.h  2  what a run tells: progress, summary, statistics
#pragma once
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <string>

#include "app/options.h"
#include "film/image.h"

// What a run measured.
struct RunStats {
    uint64_t spp = 0;
    double seconds = 0;
    uint64_t rays = 0;
    uint64_t non_finite = 0;
    bool interrupted = false;
    std::array<double, 3> mean_radiance{}, variance_of_mean{};  // a channel at a time
    uint64_t redraws = 0, fallbacks = 0;                        // of weights, see Weigher
};

inline std::string fixed(double x, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, x);
    return text;
}

// On a terminal a bar that is drawn over itself and goes at the end, elsewhere a plain line now and
// then; on stderr.
class Progress {
public:
    Progress(const Target& target, bool quiet)
        : target_(target), quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress() {
        if (shown_ && terminal_) std::fputs("\r\033[K", stderr);
    }

    double elapsed() const { return std::chrono::duration<double>(clock::now() - start_).count(); }

    // `samples` so far, with the finished part of the running pass.
    void show(double samples) {
        const double now = elapsed();
        if (quiet_ || now < next_) return;
        next_ = now + (terminal_ ? 0.1 : 2.0);
        double done = 0;
        if (target_.samples) done = samples / double(target_.samples);
        if (target_.seconds > 0) done = std::max(done, now / target_.seconds);
        done = std::min(done, 1.0);
        std::string left = done > 0 ? fixed(now / done - now, 1) + " s left" : "";
        std::string text =
            fixed(samples, 1) + " samples per pixel, " + fixed(now, 1) + " s elapsed, " + left;
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
    const Target target_;
    const bool quiet_;
    const bool terminal_;
    const clock::time_point start_ = clock::now();
    double next_ = terminal_ ? 0.1 : 2.0;
    bool shown_ = false;
};

// The line that stays.
inline std::string summary(const std::string& scene, const RunStats& run) {
    return scene + ": " + std::to_string(run.spp) + " samples per pixel, " + fixed(run.seconds, 2) +
           " s, " + fixed(double(run.rays) / run.seconds * 1e-6, 2) + " Mrays/s, " +
           std::to_string(run.non_finite) + " non-finite" +
           (run.interrupted ? " (interrupted)" : "");
}

// ---- Statistics (--stats) ---------------------------------------------------------------------

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

}  // namespace json

// One object.
inline std::string encode_stats(const Options& o, Size size, int depth, const RunStats& run) {
    std::string text = "{\n";
    auto line = [&](const std::string& key, const std::string& value) {
        text += (text.size() > 2 ? ",\n  \"" : "  \"") + key + "\": " + value;
    };
    auto count = [](auto n) { return std::to_string(n); };
    line("scene", json::string(o.scene));
    line("width", count(size.width));
    line("height", count(size.height));
    for (const Option& row : option_table)
        if (const std::string value = row.stats(o); !value.empty())
            line(std::string(row.name.substr(2)), value);
    line("depth", count(depth));
    line("film_redraws", count(run.redraws));
    line("film_fallbacks", count(run.fallbacks));
    line("precision", sizeof(real) == 4 ? "\"float\"" : "\"double\"");
    line("interrupted", run.interrupted ? "true" : "false");
    line("samples_per_pixel", count(run.spp));
    line("seconds", json::number(run.seconds));
    line("cpu_seconds", json::number(cpu_seconds()));
    line("rays", count(run.rays));
    line("mrays_per_second", json::number(double(run.rays) / run.seconds * 1e-6));
    line("mean_radiance", json::numbers(run.mean_radiance));
    line("variance_of_mean", json::numbers(run.variance_of_mean));
    line("non_finite", count(run.non_finite));
    line("peak_memory_bytes", count(peak_memory_bytes()));
    return text + "\n}\n";
}

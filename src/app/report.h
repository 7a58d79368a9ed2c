// app/report.h  1  progress and a summary on stderr, statistics in JSON
#pragma once
#include <sys/resource.h>
#include <unistd.h>

#include <ctime>

#include "film/loop.h"
#include "text/option.h"

namespace penumbra {

inline void tell(const CommonOptions& o, const std::string& line) {
    if (!o.quiet) std::fprintf(stderr, "%s\n", printable(line).c_str());
}

// ---- Progress -----------------------------------------------------------------------------------

// On stderr: a bar on a terminal, which is redrawn and erased at the end; elsewhere a line every
// two seconds.
class Progress {
public:
    // A run ends after `limit` seconds, 0: no limit.  `before` is the time of earlier runs.
    Progress(double limit, bool quiet, double before = 0)
        : limit_(limit), quiet_(quiet), before_(before) {}
    Progress(const Progress&) = delete;
    ~Progress() {
        if (shown_ && terminal_) std::fputs("\r\033[K", stderr);
    }

    double elapsed() const {
        return before_ + std::chrono::duration<double>(clock::now() - start_).count();
    }

    // `done` is the fraction of all work; 0 if only the clock ends it.
    void show(double done, const std::string& words) {
        const double now = elapsed();
        if (quiet_ || now < next_) return;
        next_ = now + interval_;
        if (limit_ > 0) done = std::max(done, now / limit_);
        done = std::min(done, 1.0);
        std::string line =
            fixed(100 * done, 0) + " %  " + words + ", " + fixed(now, 1) + " s elapsed";
        if (done > 0) line += ", " + fixed(now / done - now, 1) + " s left";
        std::string bar(size_t(24 * done), '#');
        bar.resize(24, '.');
        if (terminal_)
            std::fprintf(stderr, "\r[%s] %s\033[K", bar.c_str(), line.c_str());
        else
            std::fprintf(stderr, "%s\n", line.c_str());
        shown_ = true;
    }

private:
    using clock = std::chrono::steady_clock;
    const double limit_;
    const bool quiet_, terminal_ = ::isatty(STDERR_FILENO) == 1;
    const double before_, interval_ = terminal_ ? 0.1 : 2.0;
    const clock::time_point start_ = clock::now();
    double next_ = interval_;
    bool shown_ = false;
};

// ---- Measurements of a run ----------------------------------------------------------------------

struct Run : Spent {
    double spp = 0;              // mean samples per pixel; 0: some pixel has none
    Stop stopped_by = Stop::no;  // no: it was merged
    bool is_radiance = true;     // false: a view; its error is not reported
    ImageError error;
    std::string doubt;              // why that may be far too small, or ""
    double repeat_spp = NAN;        // --spp N that takes the same samples; NaN: none
    double replications = 1;        // mean per pixel
    std::string bias = "unbiased";  // class of the estimator
    Facts more;                     // keys and JSON values of one program only

    bool interrupted() const { return stopped_by == Stop::interrupt; }
    double mrays_per_second() const { return double(rays) / seconds * 1e-6; }
};

// CPU time of all threads so far, in seconds.
inline double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

inline int64_t peak_memory_bytes() {
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
#ifdef __APPLE__
    return int64_t(use.ru_maxrss);
#else
    return int64_t(use.ru_maxrss) * 1024;
#endif
}

inline std::string word_of(Stop stop) {
    switch (stop) {
        case Stop::samples: return "samples";
        case Stop::time: return "time";
        case Stop::error: return "error";
        case Stop::error_unknown: return "error not known";
        case Stop::interrupt: return "interrupt";
        case Stop::not_finite: return "not finite";
        case Stop::no: return "merge";
    }
    return "";
}

// ---- In words -----------------------------------------------------------------------------------

// Why no error is reported; "": it is.
inline std::string why_no_error(const Run& run) {
    if (!run.is_radiance) return "a view, not radiance";
    if (run.spp <= 1) return "one sample";
    if (run.replications == 1) return run.interrupted() ? "interrupted early" : "one replication";
    if (run.error.d2() >= 0 || run.error.norm() == 0) return run.doubt;
    return run.interrupted() ? "interrupted early" : "too little time";
}

// "estimated error 2.1 % ± 0.1 %; about 27 s more for 1 %": for `wanted`, or for half of the error
// if that is not less.  Errors fall as n^-1/2, or faster.
inline std::string error_words(const Run& run, double wanted = 0) {
    if (const std::string why = why_no_error(run); !why.empty()) return "error not known: " + why;
    const double d = run.error.d_rel();
    const std::string number =
        significant(100 * d, 2) + " % ± " + significant(100 * run.error.standard_error(), 1) + " %";
    const std::string words =
        run.bias == "unbiased"
            ? "estimated error " + number
            : "error " + number + " (noise only; the estimator is " + run.bias + ")";
    if (d == 0) return words;
    const double unit = std::pow(10, std::floor(std::log10(d / 2)));
    const bool is_less = wanted > 0 && wanted < d;
    const double goal = is_less ? wanted : std::round(d / 2 / unit) * unit;
    const double more = run.seconds * (square(d / goal) - 1);
    return words + "; about " + significant(more, 2) + " s more for " +
           significant(100 * goal, is_less ? 3 : 1) + " %";
}

// Whether --error was met: "reached 3 % (ERROR)" or "did not reach 3 % (stopped by --time; ERROR)".
// `by` is the option that ended the run; "": the reason is in the words about the error.
inline std::string outcome_words(double wanted, const std::string& by, const std::string& error) {
    const std::string goal = significant(100 * wanted, 3) + " % (";
    if (by == "--error") return "reached " + goal + error + ")";
    return "did not reach " + goal + (by.empty() ? "" : "stopped by " + by + "; ") + error + ")";
}

// The line that stays.  `wanted`: the error that was asked for, or 0.
inline std::string summary(const std::string& scene, const Run& run, double wanted = 0) {
    if (run.spp == 0 && run.interrupted())
        return scene + ": interrupted before the first pass was complete: no image written";
    const std::string line = scene + ": " + counted(significant(run.spp, 3), "sample") +
                             " per pixel, " + fixed(run.seconds, 2) + " s, " +
                             fixed(run.mrays_per_second(), 2) + " Mrays/s";
    if (!run.is_radiance) return line + (run.interrupted() ? " (interrupted)" : "");
    if (run.interrupted()) return line + ", " + error_words(run, wanted) + " (interrupted)";
    if (wanted == 0) return line + ", " + error_words(run);
    const std::string by = run.stopped_by == Stop::samples ? "--spp"
                           : run.stopped_by == Stop::time  ? "--time"
                           : run.stopped_by == Stop::error ? "--error"
                                                           : "";
    return line + ", " + outcome_words(wanted, by, error_words(run, wanted));
}

inline void add_run(json::Object& object, const Run& run, Size size) {
    object.add("precision", sizeof(real) == 4 ? "\"float\"" : "\"double\"");
    object.add("interrupted", json::truth(run.interrupted()));
    object.add("samples_per_pixel", json::number(run.spp));
    object.add("repeat_with_spp", json::number(run.repeat_spp));
    object.add("seconds", json::number(run.seconds));
    object.add("cpu_seconds", json::number(run.cpu_seconds));
    object.add("rays", std::to_string(run.rays));
    object.add("mrays_per_second", json::number(run.mrays_per_second()));
    const double pixels = double(size.width) * double(size.height);
    Sum mean = run.error.values, of_mean = run.error.variances;
    for (double& v : mean) v /= pixels;
    for (double& v : of_mean) v /= pixels * pixels;
    object.add("mean_radiance", json::numbers(mean));
    object.add("variance_of_mean", json::numbers(of_mean));
    object.add("replications_per_pixel", json::number(run.replications));
    const std::string reason = why_no_error(run);
    auto if_known = [&](double x) { return json::number(reason.empty() ? x : double(NAN)); };
    object.add("d_rel", if_known(run.error.d_rel()));
    object.add("d_rel_standard_error", if_known(run.error.standard_error()));
    object.add("d_rel_by_spread", json::number(run.error.d_rel()));  // also if it is not reported
    object.add("d_rel_reason", reason.empty() ? "null" : json::string(reason));
    const bool falls = run.error.d2() > 0;  // or is 0
    object.add("seconds_to_half_d_rel", if_known(falls ? 4 * run.seconds : double(NAN)));
    object.add("bias", json::string(run.bias));
    object.add("stopped_by", json::string(word_of(run.stopped_by)));
    for (const auto& [key, value] : run.more) object.add(key, value);
    object.add("peak_memory_bytes", std::to_string(peak_memory_bytes()));
}

}  // namespace penumbra

// labs/lab.h  2  shared code of experiments: statistics of runs, reports, renders, command lines
#pragma once
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "base/program.h"
#include "base/stats.h"
#include "film/passes.h"
#include "keep/read_pfm.h"
#include "labs/execute.h"
#include "labs/svg.h"

// ---- Statistics of many runs --------------------------------------------------------------------

// Element q (n - 1) of the n sorted numbers, linearly interpolated.  NaN if there are none.
inline double quantile(std::vector<double> x, double q) {
    if (x.empty()) return NAN;
    std::sort(x.begin(), x.end());
    const double place = q * double(x.size() - 1);
    const size_t below = size_t(place), above = std::min(below + 1, x.size() - 1);
    return std::lerp(x[below], x[above], place - double(below));
}
inline double median(const std::vector<double>& x) { return quantile(x, 0.5); }

// The exponent p of y = c x^p, by least squares of the logarithms.
inline double slope(const std::vector<double>& x, const std::vector<double>& y) {
    const double n = double(x.size());
    double mx = 0, my = 0, xx = 0, xy = 0;
    for (size_t k = 0; k < x.size(); ++k) mx += std::log(x[k]) / n, my += std::log(y[k]) / n;
    for (size_t k = 0; k < x.size(); ++k) {
        xx += (std::log(x[k]) - mx) * (std::log(x[k]) - mx);
        xy += (std::log(x[k]) - mx) * (std::log(y[k]) - my);
    }
    return xy / xx;
}

// "1.21 (1.19–1.30)": the median with the least and the greatest, in a given format.
inline std::string with_range(const std::vector<double>& x, const char* format) {
    const auto [least, most] = std::minmax_element(x.begin(), x.end());
    return text(format, median(x)) + " (" + text(format, *least) + "–" + text(format, *most) + ")";
}

// "1.21 ± 0.03": mean and standard deviation, in a given format.  One run has no deviation.
inline std::string plus_minus(const Moments& m, const char* format) {
    const std::string mean = text(format, m.mean);
    return m.n > 1 ? text("%s ± %s", mean, text(format, std::sqrt(m.variance()))) : mean;
}

// Mean squared difference of two images of equal size, over pixels and channels.
inline double mse(const Image& f, const Image& g) {
    double sum = 0;
    for (size_t i = 0; i < f.pixels.size(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double error = double(f.pixels[i][c]) - double(g.pixels[i][c]);
            sum += error * error;
        }
    return sum / (3 * double(f.pixels.size()));
}

// The part of an image with this size, from the pixel (left, top) on.
inline Image part_of(const Image& image, int left, int top, Size size) {
    Image part(size.width, size.height);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) part.at(x, y) = image.at(left + x, top + y);
    return part;
}

// Splits a line into words at white space.
inline std::vector<std::string> words_in(const std::string& line) {
    std::istringstream in(line);
    return {std::istream_iterator<std::string>(in), {}};
}

// The word after an option.
inline std::string value_of(const std::vector<std::string>& words, const std::string& option) {
    const auto at = std::find(words.begin(), words.end(), option);
    if (at == words.end() || at + 1 == words.end()) throw UserError(option + ": needs a value");
    return *(at + 1);
}

// Names of the scenes in a folder, sorted, except cornell36obj, which is a copy of cornell36.
inline std::vector<std::string> scenes_in(const std::string& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".scene" && entry.path().stem() != "cornell36obj")
            names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

inline unsigned all_cores() { return std::max(1u, std::thread::hardware_concurrency()); }

// CPU seconds of all threads of this process so far.
inline double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

// ---- Reports ------------------------------------------------------------------------------------

// The folder for reports.  Only full studies in double write to reference/.
inline std::string report_folder(bool quick) {
    return quick || sizeof(real) < sizeof(double) ? "out" : "reference";
}

// The first line that a shell command prints, or "" if it prints none.
inline std::string said_by(const char* command) {
    std::string line;
    if (std::FILE* out = ::popen(command, "r")) {
        for (int c; (c = std::fgetc(out)) != EOF && c != '\n';) line += char(c);
        ::pclose(out);
    }
    return line;
}

// The last sentence of a report.  `pictures` is a checksum of the renderer's pictures.  By it
// tests/reports finds reports of a renderer that drew other pictures.
inline std::string made_by(const std::string& command) {
#ifdef __clang__
    const char* compiler = __VERSION__;
#else
    const char* compiler = "g++ " __VERSION__;
#endif
    const std::string day = said_by("date +%F"),
                      commit = said_by("git rev-parse --short HEAD 2>/dev/null || echo unknown"),
                      pictures = said_by("tests/reports --pictures"),
                      processor = said_by(
                          "{ sed -n 's/^model name.*: //p' /proc/cpuinfo || "
                          "sysctl -n machdep.cpu.brand_string; } 2>/dev/null");
    return text(
        "Written on %s by `%s`: commit %s, pictures %s, %u threads of %s, numbers in %s, "
        "compiled by %s.",
        day.c_str(), command.c_str(), commit.c_str(), pictures.c_str(), all_cores(),
        processor.c_str(), sizeof(real) == sizeof(double) ? "double" : "float", compiler);
}

inline std::string command_of(int argc, char** argv) {
    std::string command = argv[0];
    for (int k = 1; k < argc; ++k) command += std::string(" ") + argv[k];
    return command;
}

// Progress on stderr, such as "17 of 96, 40 s left: cosine + NEE".  A terminal overwrites the line;
// a file gets a line per step.
class Steps {
public:
    explicit Steps(size_t total) : total_(total), terminal_(::isatty(STDERR_FILENO) == 1) {}
    ~Steps() {
        if (terminal_) std::fputs("\r\033[K", stderr);
    }
    void next(const std::string& what) {
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        const double left = done_ ? seconds / double(done_) * double(total_ - done_) : 0;
        const std::string when = done_ ? text(", %.0f s left", left) : "";
        std::fprintf(stderr, terminal_ ? "\r%zu of %zu%s: %s\033[K" : "%zu of %zu%s: %s\n",
                     done_ + 1, total_, when.c_str(), what.c_str());
        ++done_;
    }

private:
    const size_t total_;
    const bool terminal_;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    size_t done_ = 0;
};

// ---- Renders ------------------------------------------------------------------------------------

// Numbers that have a line of their own in a JSON text, by name.  null becomes NaN.
inline std::map<std::string, double> numbers_of(const std::string& json) {
    std::map<std::string, double> numbers;
    std::istringstream in(json);
    for (std::string line; std::getline(in, line);) {
        char name[64], value[64];
        if (std::sscanf(line.c_str(), " \"%63[^\"]\": %63[^,[\"]", name, value) != 2) continue;
        char* end = nullptr;
        const double x = std::strtod(value, &end);
        if (*end == 0) numbers[name] = x;
        if (std::string_view(value) == "null") numbers[name] = NAN;
    }
    return numbers;
}

// The image that a command renders.  The command must not name output files.
inline Image rendering(const std::string& command) {
    std::filesystem::create_directories("out");
    const std::string pfm = "out/lab" + std::to_string(::getpid()) + ".pfm";
    std::vector<std::string> words = words_in(command);
    words.insert(words.end(), {"--quiet", "-o", pfm, "--stats", pfm + ".json"});
    execute(words);
    Image image = read_pfm(pfm);
    std::filesystem::remove(pfm);
    std::filesystem::remove(pfm + ".json");
    return image;
}

// ---- Command lines ------------------------------------------------------------------------------

struct Flag {
    std::string_view name, value, help;           // value: its placeholder; "": none
    std::function<void(const std::string&)> set;  // may throw UserError
};

struct Lab {
    std::string_view name, purpose;
    std::vector<Flag> flags = {};
    bool has_rows = false;  // has rows of a grid, and the option --kept
};

inline void print_help(const Lab& lab) {
    std::printf("usage: %s [options]\n\n%s\n\n", std::string(lab.name).c_str(),
                std::string(lab.purpose).c_str());
    for (const Flag& flag : lab.flags)
        std::printf("  %-20s %s\n", text("%s %s", flag.name.data(), flag.value.data()).c_str(),
                    std::string(flag.help).c_str());
    std::printf("  %-20s %s\n", "--help", "print this");
}

// The renderer in this experiment's folder: build/techniques-float runs build/penumbra-float.
inline std::string renderer_beside(const Lab& lab, const std::string& self,
                                   const std::string& name = "penumbra") {
    std::filesystem::path program = self;
    program.replace_filename(program.filename().string().replace(0, lab.name.size(), name));
    if (::access(program.c_str(), X_OK) != 0)
        throw UserError(program.string() + ": cannot run; say  make build/" + name);
    return program.string();
}

// The main function of a program: parses the flags.  work() returns the exit status.
template <class Work>
int lab_main(int argc, char** argv, const Lab& lab, Work work) try {
    const std::vector<std::string> words(argv + 1, argv + argc);
    std::vector<std::string_view> known = {"--help"};
    for (const Flag& flag : lab.flags) known.push_back(flag.name);
    for (size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--help") return print_help(lab), 0;
        const auto flag = std::find_if(lab.flags.begin(), lab.flags.end(),
                                       [&](const Flag& f) { return f.name == words[i]; });
        if (flag == lab.flags.end()) throw UserError(unknown("option", words[i], known));
        if (flag->value.empty()) {
            flag->set("");
            continue;
        }
        if (++i == words.size()) throw UserError(std::string(flag->name) + ": needs a value");
        flag->set(words[i]);
    }
    return finished(work());
} catch (...) {
    return failed();
}

// The common options of an experiment, its program and its command line.
struct Scope {
    std::string name, self, command;
    bool quick = false;
    bool kept = false;  // makes tables from rows of former runs, without rendering

    std::string beside(const std::string& program = "penumbra") const {
        return renderer_beside({name, "", {}}, self, program);
    }
};

// The main function of an experiment with a report.  study(scope) returns the exit status.
template <class Study>
int experiment(int argc, char** argv, Lab lab, Study study) {
    Scope scope{std::string(lab.name), argv[0], command_of(argc, argv)};
    lab.flags.push_back(
        {"--quick", "", "fewer runs; writes to out/", [&](auto&) { scope.quick = true; }});
    if (lab.has_rows)
        lab.flags.push_back({"--kept", "", "tables from rows of former runs, without rendering",
                             [&](auto&) { scope.kept = true; }});
    return lab_main(argc, argv, lab, [&] { return study(scope); });
}

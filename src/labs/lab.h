// labs/lab.h  2  shared code of experiments: statistics of runs, reports, renders, command lines
#pragma once
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "base/stats.h"
#include "film/loop.h"
#include "keep/read_pfm.h"
#include "labs/execute.h"
#include "labs/svg.h"
#include "text/option.h"

namespace penumbra {

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

// Mean of a power of all channels of all pixels.
inline double image_mean(const Image& image, int power = 1) {
    double sum = 0;
    for (const auto& pixel : image.pixels)
        for (float x : pixel) sum += std::pow(double(x), power);
    return sum / (3 * double(image.pixels.size()));
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

// What a shell command prints, without its last newline.
inline std::string said_by(const std::string& command) {
    std::string words;
    if (std::FILE* out = ::popen(command.c_str(), "r")) {
        for (int c; (c = std::fgetc(out)) != EOF;) words += char(c);
        ::pclose(out);
    }
    return words.substr(0, words.find_last_not_of('\n') + 1);
}

// Its name without commas, and what tells processors of that name apart.
inline std::string processor() {
    return said_by(
        "{ sysctl -n machdep.cpu.brand_string 2>/dev/null || LC_ALL=C lscpu | awk -F': +' "
        "'/^Model name/ {n = $2} /^CPU family/ {f = $2} /^Model:/ {m = $2} "
        "END {print n \" (family \" f \" model \" m \")\"}'; } | tr -d ,");
}
// The widest vectors that this program was compiled for.
inline std::string instructions() {
#if defined(__AVX512F__)
    return "AVX-512";
#elif defined(__AVX2__)
    return "AVX2";
#elif defined(__SSE2__)
    return "SSE2";
#elif defined(__ARM_NEON)
    return "NEON";
#else
    return "none";
#endif
}

inline std::string git_commit() {
    return said_by("git rev-parse --short HEAD 2>/dev/null || echo unknown");
}

// The last sentence of a report.  `pictures` is a checksum of the renderer's pictures.  By it
// tests/reports finds reports of a renderer that drew other pictures.
inline std::string made_by(const std::string& command) {
    const std::string day = said_by("date +%F"), pictures = said_by("tests/reports --pictures");
    return text(
        "Written on %s by `%s`: commit %s, pictures %s, %u threads of %s, numbers in %s, "
        "compiled by %s.",
        day.c_str(), command.c_str(), git_commit().c_str(), pictures.c_str(), all_cores(),
        processor().c_str(), sizeof(real) == sizeof(double) ? "double" : "float",
        compiler().c_str());
}

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

// An image that an experiment renders itself, and its statistics.
struct Rendered {
    Image image;
    std::map<std::string, double> of = {};
};

// ---- Command lines ------------------------------------------------------------------------------

struct Lab {
    std::string name, purpose;
    OptionTable options = {};
    // Renders with penumbra's options: build/LAB --render WORDS -o FILE.pfm --stats FILE.json
    std::function<Rendered(const std::vector<std::string>&)> render = {};
};

// An experiment's program, its command line, and if it makes fewer runs.
struct Scope {
    std::string name, self, command;
    bool quick = false;

    // A program in this experiment's folder: build/techniques-float runs build/penumbra-float.
    std::string beside(const std::string& program = "penumbra") const {
        std::filesystem::path path = self;
        path.replace_filename(path.filename().string().replace(0, name.size(), program));
        if (::access(path.c_str(), X_OK) != 0)
            throw UserError(path.string() + ": cannot run; say  make build/" + program);
        return path.string();
    }
};

inline int render_by(const Lab& lab, const std::vector<std::string>& words) {
    const Rendered r = lab.render(words);
    json::Object stats;
    for (const auto& [name, x] : r.of) stats.add(name, json::number(x));
    write_image(value_of(words, "-o"), r.image, 1);
    write_file(value_of(words, "--stats"), stats.text() + "\n");
    return 0;
}

// The main function of an experiment.  study(scope) returns the exit status.
template <class Study>
int experiment(int argc, char** argv, const Lab& lab, Study study) try {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (lab.render && !words.empty() && words[0] == "--render")
        return finished(render_by(lab, {words.begin() + 1, words.end()}));
    Scope scope{lab.name, argv[0], argv[0]};
    for (const std::string& word : words) scope.command += " " + word;
    bool help = false;
    OptionTable table =
        lab.options + OptionTable{{"--quick", "", "fewer runs; writes to out/", "",
                                   [&](Text) { scope.quick = true; }},
                                  {"--help", "", "print this", "", [&](Text) { help = true; }}};
    parse_words(table, words, [](auto& word) { throw UserError(unknown("option", word, {})); });
    if (help) std::printf("usage: %s [options]\n\n%s\n\n", lab.name.c_str(), lab.purpose.c_str());
    for (const Option& r : table)
        if (help)
            std::printf(
                "  %-20s%s%s\n", usage_of(r).c_str(), std::string(r.help).c_str(),
                r.default_text.empty() ? "" : text(" (default: %s)", r.default_text).c_str());
    return finished(help ? 0 : study(scope));
} catch (...) {
    return failed();
}

}  // namespace penumbra

// labs/techniques.cpp  3  what each of three techniques brings
//
//   build/techniques [--reference FILE.pfm] [--time S] [--quick]
//
// Importance sampling of the cosine (and the lobe), Halton points and next-event estimation (NEE),
// alone and together, on scenes/coursework.scene: a table and what follows from it on stdout, every
// image in out/techniques.png.  With f the reference, g an image, N numbers (three a pixel):
//   d_rel = sqrt(1/N sum (f - g)^2) / sqrt(1/N sum f^2)          (Khodulev 1996, ch. 5)

#include <functional>

#include <stb/stb_easy_font.h>

#include "base/program.h"
#include "base/stats.h"
#include "film/image.h"

namespace {

const std::string scene = "scenes/coursework.scene", sheet_file = "out/techniques.png";
constexpr double exposure = 0.6;  // the scene's

struct Technique {
    std::string name, sampler, direction, light;
    // The same points for every seed; converges to a wrong limit, so need not agree.
    bool naive() const { return sampler == "halton-naive"; }
};

const std::vector<Technique> techniques = {
    {"uniform", "independent", "uniform", "none"},
    {"+ cosine", "independent", "bsdf", "none"},
    {"+ Halton", "halton", "uniform", "none"},
    {"+ NEE", "independent", "uniform", "nee"},
    {"cosine + Halton", "halton", "bsdf", "none"},
    {"cosine + NEE", "independent", "bsdf", "nee"},
    {"Halton + NEE", "halton", "uniform", "nee"},
    {"all three", "halton", "bsdf", "nee"},
    {"all three, MIS", "halton", "bsdf", "mis"},
    {"stratified, cosine + NEE", "stratified", "bsdf", "nee"},
    {"naive Halton", "halton-naive", "uniform", "none"},
    {"naive, cosine", "halton-naive", "bsdf", "none"},
    {"naive, NEE", "halton-naive", "uniform", "nee"},
    {"naive, cosine + NEE", "halton-naive", "bsdf", "nee"},
};

size_t named(std::string_view name) {
    for (size_t t = 0; t < techniques.size(); ++t)
        if (techniques[t].name == name) return t;
    throw std::logic_error("no technique " + std::string(name));
}

struct Plan {
    std::string reference = "reference/coursework.pfm";
    uint64_t seeds = 8, fewer_seeds = 4;  // at equal samples; in the dearer series
    uint64_t spp = 64, many = 256, limit = 4096;
    double seconds = 5;
};

std::string text(const char* format, auto... values) {
    char line[512];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}
std::string count(uint64_t n) { return std::to_string(n); }

// What --stats says of `key`: one number, or one a channel.  NaN: not known.
std::array<double, 3> stats(const std::string& file, const std::string& key) {
    const std::string json = read_file(file), before = "\"" + key + "\": ";
    std::array<double, 3> x = {NAN, NAN, NAN};
    if (const size_t at = json.find(before); at != json.npos) {
        std::istringstream in(json.substr(at + before.size()));
        char separator = 0;
        if (in.peek() == '[') in >> separator;
        for (double v = 0; double& slot : x)
            if (in >> v >> separator) slot = v;
    }
    return x;
}

struct Reference {
    Image image;
    double spp = 0, mean_square = 0;           // of the image's numbers
    double variance = 0;                       // mean of theirs: its own squared error
    std::array<double, 3> variance_of_mean{};  // of the image, a channel each
    double d_rel() const { return std::sqrt(variance / mean_square); }
};

Reference read_reference(const std::string& file) {
    const std::string json = std::filesystem::path(file).replace_extension(".json").string();
    const std::string how = "make it by  build/penumbra --spp 65536 --halves -o " + file +
                            " --stats " + json + " " + scene;
    for (const std::string& needed : {file, json})
        if (!std::filesystem::exists(needed)) throw UserError(needed + ": missing; " + how);
    Reference r{read_pfm(file)};
    r.spp = stats(json, "samples_per_pixel")[0];
    r.variance_of_mean = stats(json, "variance_of_mean");
    const double n = double(r.image.pixels.size());
    for (double v : r.variance_of_mean) r.variance += v * n / 3;
    for (const auto& pixel : r.image.pixels)
        for (float x : pixel) r.mean_square += sqr(double(x)) / (3 * n);
    if (!std::isfinite(r.d_rel()))
        throw UserError(file + ": not finite, or no variance_of_mean in " + json + "; " + how);
    return r;
}

// Mean squared difference of two images.
double mse(const Image& f, const Image& g) {
    double sum = 0;
    for (size_t i = 0; i < f.pixels.size(); ++i)
        for (size_t c = 0; c < 3; ++c) sum += sqr(double(f.pixels[i][c]) - double(g.pixels[i][c]));
    return sum / (3 * double(f.pixels.size()));
}

// Of one channel.
double mean_of(const Image& image, size_t c) {
    double sum = 0;
    for (const auto& pixel : image.pixels) sum += double(pixel[c]);
    return sum / double(image.pixels.size());
}

// Of all channels.
double mean_of(const Image& image) {
    return (mean_of(image, 0) + mean_of(image, 1) + mean_of(image, 2)) / 3;
}

// ---- Renders ------------------------------------------------------------------------------------

enum class Series { equal_samples, equal_time, many, limit };

struct Run {
    Series series;
    size_t technique;
    uint64_t seed, spp;  // spp 0: until the time is up; after the run, what was reached
    double core_seconds = 0, mse = 0, d_rel = 0;
    Image image = {};
};

// What to render, in order: seeds outside, so that whatever else the machine does hits all alike.
// No two runs, nor the reference, share random numbers.
std::vector<Run> make_runs(const Plan& plan) {
    std::vector<Run> runs;
    auto add = [&](Series series, size_t t, uint64_t k, uint64_t spp) {
        runs.push_back({series, t, 10000 * (uint64_t(series) + 1) + 100 * t + k, spp});
    };
    for (uint64_t k = 0; k < plan.seeds; ++k)
        for (size_t t = 0; t < techniques.size(); ++t) add(Series::equal_samples, t, k, plan.spp);
    for (uint64_t k = 0; k < plan.fewer_seeds; ++k)
        for (size_t t = 0; t < techniques.size(); ++t)
            if (k == 0 || !techniques[t].naive()) add(Series::equal_time, t, k, 0);
    for (uint64_t k = 0; k < plan.fewer_seeds; ++k)
        for (const char* name : {"+ NEE", "Halton + NEE", "cosine + NEE", "all three"})
            add(Series::many, named(name), k, plan.many);
    for (const char* name : {"naive Halton", "naive, cosine + NEE"})
        for (uint64_t spp : {plan.limit / 8, plan.limit}) add(Series::limit, named(name), 0, spp);
    return runs;
}

// Exit status of a program; its errors go to our stderr.

void render(Run& run, const std::string& program, const Plan& plan, const Reference& reference) {
    const Technique& t = techniques[run.technique];
    const std::string stem = "out/techniques/" + std::to_string(::getpid()), pfm = stem + ".pfm",
                      json = stem + ".json";
    std::vector<std::string> words = {program, "--quiet", scene};
    auto add = [&](const char* option, const std::string& value) {
        words.insert(words.end(), {option, value});
    };
    add("--sampler", t.sampler);
    add("--direction", t.direction);
    add("--light", t.light);
    add("--seed", count(run.seed));
    run.spp ? add("--spp", count(run.spp)) : add("--time", text("%g", plan.seconds));
    add("-o", pfm);
    add("--stats", json);
    execute(words);
    run.image = read_pfm(pfm);
    if (run.image.pixels.size() != reference.image.pixels.size())
        throw UserError(plan.reference + ": not of the scene's size");
    run.spp = uint64_t(stats(json, "samples_per_pixel")[0]);
    run.core_seconds = stats(json, "cpu_seconds")[0];
    run.mse = mse(reference.image, run.image);
    run.d_rel = std::sqrt(run.mse / reference.mean_square);
    std::filesystem::remove(pfm);
    std::filesystem::remove(json);
}

void render_all(std::vector<Run>& runs, const std::string& program, const Plan& plan,
                const Reference& reference) {
    const bool terminal = ::isatty(STDERR_FILENO) == 1;
    for (size_t i = 0; i < runs.size(); ++i) {
        std::fprintf(stderr, "%s%zu of %zu  %s%s", terminal ? "\r" : "", i + 1, runs.size(),
                     techniques[runs[i].technique].name.c_str(), terminal ? "\033[K" : "\n");
        render(runs[i], program, plan, reference);
    }
    if (terminal) std::fprintf(stderr, "\r\033[K");
}

// ---- What follows -------------------------------------------------------------------------------

using Runs = std::vector<const Run*>;
Runs select(const std::vector<Run>& runs, Series series, size_t technique) {
    Runs found;
    for (const Run& run : runs)
        if (run.series == series && run.technique == technique) found.push_back(&run);
    return found;
}

Moments moments(const Runs& runs, const std::function<double(const Run&)>& value) {
    Moments m;
    for (const Run* run : runs) m.add(value(*run));
    return m;
}

std::string plus_minus(const Moments& m, int digits) {
    const std::string mean = text("%.*f", digits, m.mean);
    return m.n > 1 ? mean + text(" ± %.*f", digits, std::sqrt(m.variance())) : mean;
}

// Two-sided quantile of Student's t at alpha = 1e-6 (Cornish-Fisher, to 1/nu^2).
double t_limit(double nu) {
    const double z = 4.891638475699;
    return z + (z * z * z + z) / (4 * nu) +
           (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * nu * nu);
}

struct Agreement {
    double ratio = 0;           // of the means of all channels
    double worst_z = 0;         // of three channels
    double limit = 0;           // of |z|
    double overdispersion = 0;  // variance of the seeds' image means, over what pixels predict
};

// Is the image mean right?  Its variance is the sum over the pixels of the spread of each over the
// seeds: every pixel has its own randomisation, so pixels are independent, and thousands of them
// give the estimate the degrees of freedom (Welch, Satterthwaite) that a few seeds' means lack.
Agreement agreement(const Runs& runs, const Reference& r) {
    Agreement a;
    const double pixels = double(r.image.pixels.size()), n = double(runs.size());
    a.ratio =
        moments(runs, [](const Run& run) { return mean_of(run.image); }).mean / mean_of(r.image);
    for (size_t c = 0; c < 3; ++c) {
        double variances = 0, squares = 0;
        const Moments seeds = moments(runs, [&](const Run& run) { return mean_of(run.image, c); });
        for (size_t i = 0; i < r.image.pixels.size(); ++i) {
            const double v = moments(runs, [&](const Run& run) {
                                 return double(run.image.pixels[i][c]);
                             }).variance();
            variances += v;
            squares += v * v;
        }
        const double of_one = variances / (pixels * pixels);
        const double z =
            (seeds.mean - mean_of(r.image, c)) / std::sqrt(of_one / n + r.variance_of_mean[c]);
        const double limit = t_limit((n - 1) * variances * variances / squares);
        if (a.limit == 0 || std::abs(z) / limit > std::abs(a.worst_z) / a.limit) {
            a.worst_z = z;
            a.limit = limit;
        }
        a.overdispersion += seeds.variance() / of_one / 3;
    }
    return a;
}

// The table; true if every technique agrees with the reference.
bool print_table(const std::vector<Run>& runs, const Plan& plan, const Reference& r) {
    bool all = true;
    Moments overdispersion;
    const std::string header = text(
        "| technique | d_rel, %s spp | d_rel, %g s | samples in %g s | efficiency, × uniform | "
        "ratio of means | z (limit) | verdict |\n|---|---|---|---|---|---|---|---|\n",
        count(plan.spp).c_str(), plan.seconds, plan.seconds);
    std::fputs(header.c_str(), stdout);
    const Runs uniform = select(runs, Series::equal_samples, 0);
    for (size_t t = 0; t < techniques.size(); ++t) {
        const bool naive = techniques[t].naive();
        const Runs equal = select(runs, Series::equal_samples, t),
                   timed = select(runs, Series::equal_time, t);
        auto d_rel = [](const Run& run) { return run.d_rel; };
        auto spp = [](const Run& run) { return double(run.spp); };
        Moments efficiency;
        for (size_t k = 0; k < equal.size(); ++k)
            efficiency.add(uniform[k]->mse * uniform[k]->core_seconds /
                           (equal[k]->mse * equal[k]->core_seconds));
        const Agreement a = agreement(equal, r);
        const bool agrees = std::abs(a.worst_z) <= a.limit;
        all = all && (naive || agrees);
        if (!naive) overdispersion.add(a.overdispersion);
        std::printf("| %s | %s | %s | %.0f | %s | %.4f | %s | %s |\n", techniques[t].name.c_str(),
                    plus_minus(moments(equal, d_rel), 4).c_str(),
                    plus_minus(moments(timed, d_rel), 4).c_str(), moments(timed, spp).mean,
                    t == 0 ? "1" : plus_minus(efficiency, 2).c_str(), a.ratio,
                    naive ? "–" : text("%+.1f (%.1f)", a.worst_z, a.limit).c_str(),
                    naive ? "exempt" : (agrees ? "agrees" : "DISAGREES"));
    }
    std::printf(R"(
± is the standard deviation over seeds: %s at equal samples, %s at equal time (wall clock, all
cores); the naive points know no seed.  The reference (%.0f spp) has d_rel %.5f itself.
Efficiency is 1/(d_rel² · core seconds) of the %s-spp runs, seed by seed over uniform's.
z is the image mean against the reference's in standard errors of both, of three channels the
worst; its limit is Student's at α = 1e-6 each.  The errors are those of independent pixels: the
means of whole images vary %.2f times as much (1 ± %.2f expected).
)",
                count(plan.seeds).c_str(), count(plan.fewer_seeds).c_str(), r.spp, r.d_rel(),
                count(plan.spp).c_str(), overdispersion.mean,
                std::sqrt(2 / double(overdispersion.n * (plan.seeds - 1))));
    return all;
}

// MSE of one technique over another's, seed by seed; the reference's own error taken out.
Moments mse_ratio(const std::vector<Run>& runs, const Reference& r, Series series,
                  const char* above, const char* below) {
    const Runs a = select(runs, series, named(above)), b = select(runs, series, named(below));
    Moments ratio;
    for (size_t k = 0; k < a.size(); ++k)
        ratio.add((a[k]->mse - r.variance) / (b[k]->mse - r.variance));
    return ratio;
}

// Correlation of the errors g - f of horizontal neighbours, about zero.
double neighbours(const Image& f, const Image& g) {
    double together = 0, alone = 0;
    for (int y = 0; y < f.height; ++y)
        for (int x = 0; x + 1 < f.width; ++x)
            for (size_t c = 0; c < 3; ++c) {
                const double a = double(g.at(x, y)[c]) - double(f.at(x, y)[c]),
                             b = double(g.at(x + 1, y)[c]) - double(f.at(x + 1, y)[c]);
                together += a * b;
                alone += (a * a + b * b) / 2;
            }
    return together / alone;
}

void print_halton(const std::vector<Run>& runs, const Plan& plan, const Reference& r) {
    auto ratio = [&](Series series, const char* a, const char* b) {
        return plus_minus(mse_ratio(runs, r, series, a, b), 2);
    };
    std::printf(R"(
## What Halton brings

MSE independent / halton, %s spp with NEE: uniform %s, cosine %s.
MSE independent / halton, %s spp without NEE: uniform %s, cosine %s.

## Why the seed's Halton did nothing

| naive points | spp | d_rel | ratio of means − 1 |
|---|---|---|---|
)",
                count(plan.many).c_str(), ratio(Series::many, "+ NEE", "Halton + NEE").c_str(),
                ratio(Series::many, "cosine + NEE", "all three").c_str(), count(plan.spp).c_str(),
                ratio(Series::equal_samples, "uniform", "+ Halton").c_str(),
                ratio(Series::equal_samples, "+ cosine", "cosine + Halton").c_str());
    for (const char* name : {"naive Halton", "naive, cosine + NEE"}) {
        Runs steps = select(runs, Series::limit, named(name));
        steps.insert(steps.begin(), select(runs, Series::equal_samples, named(name))[0]);
        for (const Run* run : steps)
            std::printf("| %s | %s | %.4f | %+.4f |\n", name, count(run->spp).c_str(), run->d_rel,
                        mean_of(run->image) / mean_of(r.image) - 1);
    }
    const Run &independent = *select(runs, Series::equal_samples, named("uniform"))[0],
              &halton = *select(runs, Series::equal_samples, named("+ Halton"))[0],
              &naive = *select(runs, Series::equal_samples, named("naive Halton"))[0],
              &limit = *select(runs, Series::limit, named("naive Halton")).back();
    std::printf(R"(
1. Bases reused at every bounce: another limit.  At %s spp naive Halton is at d_rel %.4f, where
   independent numbers would be at %.4f.
2. The same points in every pixel: errors of neighbours (naive: against its own limit) correlate by
   %.3f; independent %.3f, halton %.3f.  The eye sees patterns where d_rel sees small errors.
3. One image judged by eye: at %s spp of uniform, MSE independent / naive is %s, independent /
   halton %s: a factor of %.2f in the error.
)",
                count(limit.spp).c_str(), limit.d_rel,
                independent.d_rel * std::sqrt(double(independent.spp) / double(limit.spp)),
                neighbours(limit.image, naive.image), neighbours(r.image, independent.image),
                neighbours(r.image, halton.image), count(plan.spp).c_str(),
                ratio(Series::equal_samples, "uniform", "naive Halton").c_str(),
                ratio(Series::equal_samples, "uniform", "+ Halton").c_str(),
                std::sqrt(mse_ratio(runs, r, Series::equal_samples, "uniform", "+ Halton").mean));
}

// ---- Contact sheet ------------------------------------------------------------------------------

constexpr int gap = 8, line_height = 22, letter = 2;  // in pixels; of a pixel of the font

// The font comes as quads, four vertices x y z colour each, with whole-numbered sides.
void draw_text(Image& sheet, int left, int top, std::string words) {
    struct Vertex {
        float x, y, z;
        unsigned char colour[4];
    };
    std::vector<Vertex> vertices(words.size() * 4 * 20);
    const int quads = stb_easy_font_print(0, 0, words.data(), nullptr, vertices.data(),
                                          int(vertices.size() * sizeof(Vertex)));
    for (size_t q = 0; q < size_t(quads); ++q) {
        const Vertex &from = vertices[4 * q], &to = vertices[4 * q + 2];
        for (int y = top + letter * int(from.y); y < top + letter * int(to.y); ++y)
            for (int x = left + letter * int(from.x); x < left + letter * int(to.x); ++x)
                if (x < sheet.width && y < sheet.height) sheet.at(x, y) = {0.8f, 0.8f, 0.8f};
    }
}

void write_sheet(const std::vector<Run>& runs, const Reference& r) {
    // Columns: directions and NEE.  Rows: independent, halton, naive.  Last column: the others.
    const char* const cells[3][5] = {
        {"uniform", "+ cosine", "+ NEE", "cosine + NEE", ""},
        {"+ Halton", "cosine + Halton", "Halton + NEE", "all three", "all three, MIS"},
        {"naive Halton", "naive, cosine", "naive, NEE", "naive, cosine + NEE",
         "stratified, cosine + NEE"}};
    const int width = r.image.width + gap, height = r.image.height + 2 * line_height + gap;
    Image sheet(5 * width + gap, 3 * height + gap);
    sheet.pixels.assign(sheet.pixels.size(), {0.01f, 0.01f, 0.01f});
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 5; ++column) {
            const std::string name = cells[row][column];
            const bool reference = name.empty();
            const Run* run =
                reference ? nullptr : select(runs, Series::equal_samples, named(name))[0];
            const Image& image = reference ? r.image : run->image;
            const int left = gap + column * width, top = gap + row * height;
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x)
                    for (size_t c = 0; c < 3; ++c)
                        sheet.at(left + x, top + y)[c] = float(exposure) * image.at(x, y)[c];
            const int below = top + image.height + 4;
            draw_text(sheet, left, below, reference ? "reference" : name);
            draw_text(sheet, left, below + line_height,
                      text("d_rel %.4f, %.0f spp", reference ? r.d_rel() : run->d_rel,
                           reference ? r.spp : double(run->spp)));
        }
    write_image(sheet_file, sheet, 1);
}

// ---- Command line -------------------------------------------------------------------------------

int compare_techniques(const std::string& self, const std::vector<std::string>& words) {
    Plan plan;
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (word == "--quick") {
            plan = {plan.reference, 2, 2, 16, 32, 256, 0.2};
            continue;
        }
        if (word != "--reference" && word != "--time")
            throw UserError(unknown("option", word, {"--reference", "--time", "--quick"}));
        if (++i == words.size()) throw UserError(word + ": needs a value");
        if (word == "--reference") plan.reference = words[i];
        if (word == "--time" && !((plan.seconds = parse_number(words[i])) > 0))
            throw UserError(word + ": " + in_quotes(words[i]) + " is not positive");
    }
    // build/techniques-float runs build/penumbra-float.
    std::filesystem::path program = self;
    program.replace_filename(program.filename().string().replace(0, 10, "penumbra"));
    if (::access(program.c_str(), X_OK) != 0)
        throw UserError(program.string() + ": cannot run; say  make programs");
    const Reference reference = read_reference(plan.reference);
    std::filesystem::create_directories("out/techniques");
    check_writable(sheet_file);
    std::vector<Run> runs = make_runs(plan);
    render_all(runs, program, plan, reference);
    write_sheet(runs, reference);
    std::fprintf(stderr, "wrote %s\n", sheet_file.c_str());
    const bool agree = print_table(runs, plan, reference);
    print_halton(runs, plan, reference);
    return agree ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return compare_techniques(argv[0], {argv + 1, argv + argc}); });
}

// course/draw.cpp  3  the renderer of a course: one scene, one picture
#include "course/draw.h"

#include <chrono>

#include "base/option.h"
#include "base/program.h"
#include "keep/read_pfm.h"
#include "world/scene_file.h"

namespace {

struct Order : CommonOptions {
    Drawing drawing;
    std::optional<int> depth;  // default: the scene's
    std::string beside;        // a picture, or empty
};

// Of light in shadow.
Option direct_row([[maybe_unused]] Drawing& d) {
    Option row{
        "--direct", "stochastic|control|ratio|regression", "of light in shadow (week 5)", "", {}};
#if __has_include("shadow/shadow.h")
    row.set = [&d, words = row.value](Text v) {
        d.technique.light = LightMode::nee;
        one_of("--direct", words, "", d.direct.emplace()).set(v);
    };
#else
    row.set = [](Text) { throw UserError("light in shadow comes in a later week"); };
#endif
    return row;
}

OptionTable table_of(Order& o) {
    Drawing& d = o.drawing;
    d.technique.roulette = real(0.25);
    OptionTable table = {one_of("--view", "normal|occlusion|radiance",
                                "what it shows; occlusion: how open a place is", d.picture),
                         whole_number("--spp", "samples a pixel", "16", d.samples, 1, 1 << 20),
                         one_of("--sampler", "independent|stratified|halton|sobol",
                                "where random numbers come from", d.sampler),
                         one_of("--light", "none|nee|mis",
                                "found by hitting it, by aiming at it, by both", d.technique.light),
                         direct_row(d),
                         {"--roulette", "T", "throughput below which Russian roulette is played",
                          "0.25", [&d](Text v) { d.technique.roulette = real(parse_number(v)); }},
                         {"--depth", "N", "scatterings a path may have", "the scene's",
                          [&o](Text v) { o.depth = int(parse_count(v, 0, 1000)); }},
                         {"--beside", "FILE.pfm",
                          "beside it what is expected, and the difference, doubled, about grey", "",
                          [&o](Text v) { o.beside = v; }}};
    table = output_rows(o, "out/SCENE.png") + table + OptionTable{seed_row(o)} + general_rows(o);
    return in_group("", without(table, {"--threads", "--exposure", "--stats", "--quiet"}));
}

// Yours, what is expected, and grey plus twice the difference: grey is equal.
Image beside(const Image& yours, const Image& expected, double exposure) {
    if (yours.width != expected.width || yours.height != expected.height)
        throw UserError("--beside: the pictures have two sizes");
    const int w = yours.width;
    Image all(3 * w, yours.height);
    const double grey = 0.2 / exposure;
    for (int y = 0; y < yours.height; ++y)
        for (int x = 0; x < w; ++x) {
            const auto &a = all.at(x, y) = yours.at(x, y),
                       &b = all.at(x + w, y) = expected.at(x, y);
            for (size_t c = 0; c < 3; ++c)
                all.at(x + 2 * w, y)[c] = float(grey + 2 * (double(a[c]) - double(b[c])));
        }
    return all;
}

// d_rel = sqrt(sum (f - F)^2 / sum F^2), F what is expected (Khodulev 1996).
double relative_error(const Image& f, const Image& F) {
    double difference = 0, sum = 0;
    for (size_t i = 0; i < f.pixels.size(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double a = double(f.pixels[i][c]), b = double(F.pixels[i][c]);
            difference += (a - b) * (a - b), sum += b * b;
        }
    return std::sqrt(difference / sum);
}

int run(const std::vector<std::string>& words) {
    Order o;
    OptionTable table = table_of(o);
    parse_words(table, words, o);
    if (print_manual(o, table, "usage: draw [options] SCENE\n\n", "")) return 0;
    o.drawing.seed = o.seed;
    ParsedScene parsed = read_scene(o.scene);
    Scene& scene = parsed.scene;
    scene.size = o.size.value_or(scene.size);
    scene.depth = o.depth.value_or(scene.depth);
    const double exposure = o.drawing.picture == Picture::radiance ? double(scene.exposure) : 1;
    const auto began = std::chrono::steady_clock::now();
    Image image = draw(scene, o.drawing);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    std::string told;
    if (!o.beside.empty()) {
        const Image expected = read_pfm(o.beside);
        const Image both = beside(image, expected, exposure);
        char text[64];
        std::snprintf(text, sizeof text, ", d_rel %.3g %%", 100 * relative_error(image, expected));
        told = text;
        image = both;
    }
    if (o.drawing.picture == Picture::normal) {
        const MeanWork work = mean_work(scene);
        char text[64];
        std::snprintf(text, sizeof text, ", %.4g boxes and %.4g shapes per ray", work.boxes,
                      work.shapes);
        told = text + told;
    }
    if (o.outputs.empty())
        o.outputs = {"out/" + std::filesystem::path(o.scene).stem().string() + ".png"};
    for (const std::string& path : o.outputs) {
        write_image(path, image, exposure);
        std::printf("%s: %dx%d, %llu samples per pixel, %.2g s%s\n", path.c_str(), image.width,
                    image.height, static_cast<unsigned long long>(o.drawing.samples), took.count(),
                    told.c_str());
    }
    if (const auto bad = first_non_finite(image)) {
        std::fprintf(stderr, "draw: pixel %s is not a finite number\n", bad->c_str());
        return 1;
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) try { return finished(run({argv + 1, argv + argc})); } catch (...) {
    return failed();
}

// course/draw.cpp  3  the renderer of a course: one scene, one picture
#include "course/draw.h"

#include <chrono>

#include "base/program.h"
#include "world/scene_file.h"

namespace {

constexpr const char* usage = R"(usage: draw [options] SCENE

  -o FILE              .png or .pfm; may be repeated (default out/SCENE.png)
  --view V             radiance, normal, or occlusion (how open a place is)
  --spp N              samples a pixel (default 16)
  --size WxH           pixels (default: the scene's)
  --sampler S          independent, stratified, halton or sobol (default independent)
  --light L            none, nee or mis: found by hitting it, by aiming at it, by both (default mis)
  --direct E           stochastic, control, ratio or regression: of light in shadow (week 5)
  --roulette T         throughput below which Russian roulette is played (default 0.25)
  --depth N            scatterings a path may have (default: the scene's)
  --seed N             another noise (default 0)
  --beside FILE.pfm    beside it what is expected, and the difference, doubled, about grey
)";

struct Order {
    Drawing drawing;
    std::vector<std::string> outputs;
    std::string scene, beside;
    std::optional<Size> size;
    std::optional<int> depth;
};

template <class Value>
Value one_of(const std::string& option, const std::string& word,
             const std::map<std::string, Value>& values) {
    const auto found = values.find(word);
    if (found != values.end()) return found->second;
    std::string names;
    for (const auto& [name, value] : values) names += (names.empty() ? "" : ", ") + name;
    throw UserError(option + ": " + in_quotes(word) + " is none of " + names);
}

Size size_of(const std::string& word) {
    const size_t x = word.find('x');
    if (x == word.npos) throw UserError("--size: say WxH, e.g. 256x128");
    return parse_size(word.substr(0, x), word.substr(x + 1));
}

void choose_direct(Drawing& d, const std::string& word) {
#if __has_include("shadow/shadow.h")
    d.direct = one_of<Estimator>("--direct", word,
                                 {{"stochastic", Estimator::stochastic},
                                  {"control", Estimator::control},
                                  {"ratio", Estimator::ratio},
                                  {"regression", Estimator::regression}});
    d.technique.light = LightMode::nee;
#else
    (void)d;
    throw UserError("--direct " + word + ": light in shadow comes in a later week");
#endif
}

void take(Order& o, const std::string& option, const std::string& word) {
    Drawing& d = o.drawing;
    if (option == "-o")
        o.outputs.push_back(word);
    else if (option == "--view")
        d.picture = one_of<Picture>(option, word,
                                    {{"normal", Picture::normal},
                                     {"occlusion", Picture::occlusion},
                                     {"radiance", Picture::radiance}});
    else if (option == "--sampler")
        d.sampler = one_of<SamplerKind>(option, word,
                                        {{"independent", SamplerKind::independent},
                                         {"stratified", SamplerKind::stratified},
                                         {"halton", SamplerKind::halton},
                                         {"sobol", SamplerKind::sobol}});
    else if (option == "--light")
        d.technique.light = one_of<LightMode>(
            option, word,
            {{"none", LightMode::none}, {"nee", LightMode::nee}, {"mis", LightMode::mis}});
    else if (option == "--direct")
        choose_direct(d, word);
    else if (option == "--spp")
        d.samples = parse_count(word, 1, 1 << 20);
    else if (option == "--size")
        o.size = size_of(word);
    else if (option == "--roulette")
        d.technique.roulette = real(parse_number(word));
    else if (option == "--depth")
        o.depth = int(parse_count(word, 0, 1000));
    else if (option == "--seed")
        d.seed = parse_count(word, 0, UINT64_MAX);
    else if (option == "--beside")
        o.beside = word;
    else
        throw UserError("what is " + in_quotes(option) + "?  See --help");
}

Order order_of(const std::vector<std::string>& words) {
    Order o;
    o.drawing.technique.roulette = real(0.25);
    for (size_t i = 0; i < words.size(); ++i) {
        if (!words[i].starts_with("-")) {
            if (!o.scene.empty()) throw UserError("two scenes: " + o.scene + " and " + words[i]);
            o.scene = words[i];
            continue;
        }
        if (i + 1 == words.size()) throw UserError(words[i] + ": of what?");
        take(o, words[i], words[i + 1]);
        ++i;
    }
    if (o.scene.empty()) throw UserError("which scene?  See --help");
    return o;
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

// d_rel = sqrt(sum (f - F)^2 / sum f^2), F what is expected (Khodulev 1996).
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
    if (words.empty() || words[0] == "--help" || words[0] == "-h") {
        std::fputs(usage, words.empty() ? stderr : stdout);
        return words.empty() ? 2 : 0;
    }
    Order o = order_of(words);
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
    if (o.outputs.empty())
        o.outputs = {"out/" + std::filesystem::path(o.scene).stem().string() + ".png"};
    for (const std::string& path : o.outputs) {
        write_image(path, image, exposure);
        std::printf("%s: %dx%d, %llu samples a pixel, %.1f s%s\n", path.c_str(), image.width,
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

int main(int argc, char** argv) {
    return exit_status([&] { return run({argv + 1, argv + argc}); });
}

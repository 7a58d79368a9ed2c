// labs/voronoi.cpp  3  does it pay to weigh a pixel's samples by their Voronoi cells?
//
//   build/voronoi [--size WxH] [--most N] [--scene NAME]
//
// The rendering results of Vandewiele et al. 2025, "Voronoi integration of the rendering equation",
// on scenes/cornell.scene and scenes/cornellglossy.scene: 64 ... N samples a pixel, next-event
// estimation.  Every weighting gets the same samples.  Tables on stdout, pictures in
// out/voronoi-SCENE.png.
#include <ctime>

#include "app/options.h"
#include "app/report.h"
#include "base/program.h"
#include "base/stats.h"
#include "labs/curves.h"
#include "path/start.h"
#include "voronoi/weights.h"
#include "world/scene_file.h"

namespace {

// In the order of the enumeration, so that a weighting is its own index.
constexpr std::array films = {Weighting::mc, Weighting::vor, Weighting::fvor, Weighting::cvor,
                              Weighting::torus};
constexpr size_t stratified = films.size(), techniques = films.size() + 1;
constexpr const char* weighting_names[] = {"mc", "vor", "fvor", "cvor", "torus"};
std::string name_of(size_t t) { return t == stratified ? "stratified" : weighting_names[t]; }

struct Plan {
    Size size = {256, 256};  // as published
    uint64_t most = 256;     // samples a pixel
    unsigned threads = std::max(1u, std::thread::hardware_concurrency());
};
// Of the samples, how many sets of n are looked at.
uint64_t sets(const Plan& plan, uint64_t n) {
    return std::min<uint64_t>(plan.most / n, n == 64 ? 8 : n == 256 ? 4 : 1);
}

double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// ---- What a pixel shows -------------------------------------------------------------------------

enum Region { light_border, ball, edge, plain, regions };
constexpr const char* region_names[regions] = {"border of the light", "ball", "other edges",
                                               "one diffuse surface"};

// By what 64 camera rays meet.
Region region_of(const Scene& scene, int x, int y) {
    bool emits = false, dark = false, sphere = false, other = false;
    uint32_t first = UINT32_MAX;
    vec3 n;
    for (int k = 0; k < 64; ++k) {
        const Ray ray =
            camera_ray(scene.camera, scene.size, real(x) + (real(k % 8) + real(0.5)) / 8,
                       real(y) + (real(k / 8) + real(0.5)) / 8);
        const auto met = meet(scene, ray);
        const uint32_t id = met ? met->hit.id : UINT32_MAX;
        const Material m = met ? *met->material : Material{};
        emits = emits || m.emits();
        dark = dark || !m.emits();
        sphere = sphere || m.is_delta() || max_of(m.ks) > 0;
        const vec3 normal = met ? met->at.n : vec3{};
        if (k == 0) first = id, n = normal;
        other = other || (id != first && !(normal == n));
    }
    if (emits && dark) return light_border;
    return sphere ? ball : other ? edge : plain;
}

// ---- Samples ------------------------------------------------------------------------------------

const Technique technique = {Direction::bsdf, LightMode::nee, 0};

struct Samples {
    std::vector<Site> places;
    std::vector<rgb> L;
};

Samples draw_samples(const Scene& scene, const Pattern& pattern, int x, int y, uint64_t n) {
    Samples s;
    for (uint64_t i = 0; i < n; ++i) {
        const Start at = start(scene, pattern, x, y, i);
        s.places.push_back({double(at.u.x), double(at.u.y)});
        s.L.push_back(Li(scene, technique, at.ray, at.sampler));
    }
    return s;
}

using Mean = std::array<double, 3>;
Mean weighted_mean(const std::vector<double>& w, const rgb* L) {
    Mean m{};
    for (size_t i = 0; i < w.size(); ++i) {
        m[0] += w[i] * double(L[i].x);
        m[1] += w[i] * double(L[i].y);
        m[2] += w[i] * double(L[i].z);
    }
    return m;
}

// ---- Errors -------------------------------------------------------------------------------------

struct Tally {
    double squares = 0;  // of errors, over channels and pixels
    double count = 0;
    double seconds = 0, samples = 0;  // of weights; of paths for mc and stratified
    std::array<double, regions> by_region{};
    std::array<double, regions> count_by_region{};
    uint64_t redraws = 0, fallbacks = 0;

    void add(const Mean& m, const std::array<float, 3>& truth, const std::array<float, 3>& noise,
             Region r) {
        for (size_t c = 0; c < 3; ++c) {
            const double e = m[c] - double(truth[c]), square = e * e - double(noise[c]);
            squares += square;
            by_region[r] += square;
        }
        count += 3;
        count_by_region[r] += 3;
    }
    void merge(const Tally& t) {
        squares += t.squares, count += t.count, seconds += t.seconds, samples += t.samples;
        redraws += t.redraws, fallbacks += t.fallbacks;
        for (size_t r = 0; r < regions; ++r) {
            by_region[r] += t.by_region[r];
            count_by_region[r] += t.count_by_region[r];
        }
    }
    double mse() const { return squares / count; }
};

struct Result {
    std::vector<uint64_t> ns;
    std::vector<std::array<Tally, techniques>> of;  // by n
    std::array<Image, films.size()> variance;       // of 64 samples' mean, all channels
};

struct Reference {
    Image image;
    Image noise;                   // its own squared error, expected, pixel by pixel
    std::array<double, 3> mean{};  // of noise, a channel each
};

Result measure(const Scene& scene, const Plan& plan, const Reference& reference) {
    Result result;
    for (uint64_t n = 64; n <= plan.most; n *= 4) result.ns.push_back(n);
    result.of.resize(result.ns.size());
    for (Image& v : result.variance) v = Image(scene.size.width, scene.size.height);
    const Pattern pattern{SamplerKind::independent, 1};
    std::mutex mutex;
    auto row = [&](int y) {
        Weigher weigher;
        auto mine = result.of;
        for (auto& at_n : mine) at_n.fill({});
        for (int x = 0; x < scene.size.width; ++x) {
            const Region region = region_of(scene, x, y);
            const auto &truth = reference.image.at(x, y), &noise = reference.noise.at(x, y);
            double start = thread_seconds();
            const Samples s = draw_samples(scene, pattern, x, y, plan.most);
            const double a_path = (thread_seconds() - start) / double(plan.most);
            std::array<std::array<Moments, 3>, films.size()> spread{};
            for (size_t k = 0; k < result.ns.size(); ++k) {
                const uint64_t n = result.ns[k];
                for (uint64_t set = 0; set < sets(plan, n); ++set)
                    for (size_t t = 0; t < films.size(); ++t) {
                        Tally& tally = mine[k][t];
                        start = thread_seconds();
                        const uint64_t redraws = weigher.redraws, fallbacks = weigher.fallbacks;
                        const auto& w =
                            weigher(films[t], {s.places.data() + set * n, n},
                                    hash(hash(n, set), uint64_t(y) << 32 | uint32_t(x)));
                        tally.seconds += t == 0 ? a_path * double(n) : thread_seconds() - start;
                        tally.samples += double(n);
                        tally.redraws += weigher.redraws - redraws;
                        tally.fallbacks += weigher.fallbacks - fallbacks;
                        const Mean m = weighted_mean(w, s.L.data() + set * n);
                        tally.add(m, truth, noise, region);
                        for (size_t c = 0; c < 3 && n == 64; ++c) spread[t][c].add(m[c]);
                    }
                const Pattern strata =
                    make_pattern(SamplerKind::stratified, 2, false, scene.depth, n);
                start = thread_seconds();
                const Samples j = draw_samples(scene, strata, x, y, n);
                mine[k][stratified].seconds += thread_seconds() - start;
                mine[k][stratified].samples += double(n);
                mine[k][stratified].add(
                    weighted_mean(std::vector<double>(n, 1 / double(n)), j.L.data()), truth, noise,
                    region);
            }
            for (size_t t = 0; t < films.size(); ++t)
                for (size_t c = 0; c < 3; ++c)
                    result.variance[t].at(x, y)[c] = float(spread[t][c].variance());
        }
        std::lock_guard lock(mutex);
        for (size_t k = 0; k < mine.size(); ++k)
            for (size_t t = 0; t < techniques; ++t) result.of[k][t].merge(mine[k][t]);
    };
    Progress progress({plan.most, 0}, false);
    parallel_rows(scene.size.height, plan.threads, row,
                  [&](double part) { progress.show(part * double(plan.most)); });
    return result;
}

void print_errors(const std::string& scene, const Plan& plan, const Result& r) {
    std::printf(
        "\n## %s, %d×%d: mean squared error\n\n| samples | weights | MSE | MSE of mc / MSE | time "
        "for weights | at equal time, × mc | redraws, fallbacks |\n|---|---|---|---|---|---|---|\n",
        scene.c_str(), plan.size.width, plan.size.height);
    for (size_t k = 0; k < r.ns.size(); ++k)
        for (size_t t = 0; t < techniques; ++t) {
            const Tally &mc = r.of[k][0], &tally = r.of[k][t];
            const double path = mc.seconds / mc.samples, own = tally.seconds / tally.samples;
            const bool weighted = t > 0 && t < stratified;
            const double time = t == stratified ? own : weighted ? path + own : path;
            const double gain = mc.mse() / tally.mse();
            std::printf("| %llu | %s | %.3e | %.3f | %.1f %% | %.3f | %llu, %llu |\n",
                        static_cast<unsigned long long>(r.ns[k]), name_of(t).c_str(), tally.mse(),
                        gain, weighted ? 100 * own / time : 0.0, gain * path / time,
                        static_cast<unsigned long long>(tally.redraws),
                        static_cast<unsigned long long>(tally.fallbacks));
        }
    const size_t last = r.ns.size() - 1;
    std::printf("\n| region | pixels | of mc's MSE at %llu |",
                static_cast<unsigned long long>(r.ns[last]));
    for (size_t t = 1; t < techniques; ++t)
        std::printf(" mc / %s, 64 | mc / %s, %llu |", name_of(t).c_str(), name_of(t).c_str(),
                    static_cast<unsigned long long>(r.ns[last]));
    std::printf("\n|---|---|---|");
    for (size_t t = 1; t < techniques; ++t) std::printf("---|---|");
    std::printf("\n");
    auto per = [&](size_t k, size_t t, size_t region) {
        return r.of[k][t].by_region[region] / r.of[k][t].count_by_region[region];
    };
    for (size_t region = 0; region < regions; ++region) {
        const Tally& mc = r.of[last][0];
        std::printf("| %s | %.2f %% | %.1f %% |", region_names[region],
                    100 * mc.count_by_region[region] / mc.count,
                    100 * mc.by_region[region] / mc.squares);
        for (size_t t = 1; t < techniques; ++t)
            std::printf(" %.2f | %.2f |", per(0, 0, region) / per(0, t, region),
                        per(last, 0, region) / per(last, t, region));
        std::printf("\n");
    }
}

// ---- One pixel ----------------------------------------------------------------------------------

struct Place {
    int x = 0, y = 0;
};

// The pixel of that region where clipped cells take away most variance.
Place telling_pixel(const Scene& scene, const Result& r, Region region) {
    Place best;
    double most = -INFINITY;
    for (int y = 0; y < scene.size.height; ++y)
        for (int x = 0; x < scene.size.width; ++x) {
            if (region_of(scene, x, y) != region ||
                !(r.variance[size_t(Weighting::mc)].at(x, y)[0] > 0))
                continue;
            double gained = 0;
            for (size_t c = 0; c < 3; ++c)
                gained += double(r.variance[size_t(Weighting::mc)].at(x, y)[c]) -
                          double(r.variance[size_t(Weighting::cvor)].at(x, y)[c]);
            if (region == plain)  // just one in the middle
                gained = -std::hypot(x - scene.size.width / 2, y - scene.size.height / 3);
            if (gained > most) most = gained, best = {x, y};
        }
    return best;
}

// Mean and deviation of one pixel's estimates (the mean of the channels) over n.
void print_pixel(const Scene& scene, const Plan& plan, Place at, const Axes& axes) {
    const uint64_t replicates = 200;
    std::printf(
        "\n### Pixel (%d, %d) at the light's border: mean ± deviation of %llu replicates\n\n"
        "| samples |",
        at.x, at.y, static_cast<unsigned long long>(replicates));
    for (size_t t = 0; t < techniques; ++t) std::printf(" %s |", name_of(t).c_str());
    std::printf("\n|---|");
    for (size_t t = 0; t < techniques; ++t) std::printf("---|");
    std::printf("\n");
    std::vector<double> ns;
    for (uint64_t n = 64; n <= plan.most; n *= 4) ns.push_back(double(n));
    std::vector<std::array<Moments, techniques>> all(ns.size());
    for (uint64_t seed = 100; seed < 100 + replicates; ++seed) {
        const Samples s =
            draw_samples(scene, {SamplerKind::independent, seed}, at.x, at.y, plan.most);
        Weigher weigher;
        auto mean = [](const Mean& m) { return (m[0] + m[1] + m[2]) / 3; };
        for (size_t k = 0; k < ns.size(); ++k) {
            const auto n = uint64_t(ns[k]);
            for (size_t t = 0; t < films.size(); ++t)
                all[k][t].add(
                    mean(weighted_mean(weigher(films[t], {s.places.data(), n}, seed), s.L.data())));
            const Pattern strata =
                make_pattern(SamplerKind::stratified, seed, false, scene.depth, n);
            const Samples j = draw_samples(scene, strata, at.x, at.y, n);
            all[k][stratified].add(
                mean(weighted_mean(std::vector<double>(n, 1 / double(n)), j.L.data())));
        }
    }
    for (size_t k = 0; k < ns.size(); ++k) {
        std::printf("| %.0f |", ns[k]);
        for (const Moments& m : all[k])
            std::printf(" %.3f ± %.3f |", m.mean, std::sqrt(m.variance()));
        std::printf("\n");
    }
    Axes a = axes;
    const double middle = all.back()[stratified].mean,
                 spread = 1.3 * std::sqrt(all[0][0].variance());
    a.x0 = ns.front(), a.x1 = ns.back(), a.y0 = middle - spread, a.y1 = middle + spread;
    a.frame("light's border: mean, deviation", ns);
    size_t line = 0;
    for (size_t t :
         {size_t(Weighting::mc), size_t(Weighting::vor), size_t(Weighting::cvor), stratified}) {
        std::vector<double> low, mid, high;
        for (const auto& at_n : all) {
            const double sd = std::sqrt(at_n[t].variance());
            low.push_back(at_n[t].mean - sd);
            mid.push_back(at_n[t].mean);
            high.push_back(at_n[t].mean + sd);
        }
        a.band(ns, low, high, palette[t]);
        a.curve(ns, mid, palette[t]);
        caption(a.sheet, a.left + a.width - 70, a.top + 6 + 12 * int(line++), name_of(t),
                palette[t]);
    }
}

// ---- Pictures -----------------------------------------------------------------------------------

// log2 of the variance of mc over that of cells, of 3x3 pixels: blue gain, red loss, 4 at most.
void draw_map(Image& sheet, int left, int top, int scale, const Result& r, size_t t) {
    const Image &mc = r.variance[0], &v = r.variance[t];
    for (int y = 0; y < mc.height; ++y)
        for (int x = 0; x < mc.width; ++x) {
            double above = 0, below = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int px = std::clamp(x + dx, 0, mc.width - 1),
                              py = std::clamp(y + dy, 0, mc.height - 1);
                    for (size_t c = 0; c < 3; ++c) {
                        above += double(mc.at(px, py)[c]);
                        below += double(v.at(px, py)[c]);
                    }
                }
            const double gain =
                above > 0 && below > 0 ? std::clamp(std::log2(above / below) / 2, -1.0, 1.0) : 0;
            const auto up = float(std::max(gain, 0.0)), down = float(std::max(-gain, 0.0));
            const Colour colour = {0.5f * (1 - up) + 0.5f * down, 0.5f * (1 - up - down),
                                   0.5f * (1 - down) + 0.5f * up};
            for (int k = 0; k < scale * scale; ++k)
                blend(sheet, left + x * scale + k % scale, top + y * scale + k / scale, colour);
        }
}

// The cells of 256 samples, as bright as what was seen there.
void draw_cells(Image& sheet, int left, int top, int side, const Scene& scene, Place at) {
    const Samples s = draw_samples(scene, {SamplerKind::independent, 5}, at.x, at.y, 256);
    double most = 0;
    for (rgb L : s.L) most = std::max(most, double(max_of(L)));
    std::vector<size_t> above(size_t(side), SIZE_MAX);
    for (int y = 0; y < side; ++y)
        for (int x = 0, before = -1; x < side; ++x) {
            const Site p = {(x + 0.5) / side, (y + 0.5) / side};
            size_t nearest = 0;
            auto distance = [&](size_t i) {
                return std::hypot(s.places[i].x - p.x, s.places[i].y - p.y);
            };
            for (size_t i = 1; i < s.places.size(); ++i)
                if (distance(i) < distance(nearest)) nearest = i;
            const rgb L = s.L[nearest];
            auto tone = [&](real v) { return float(0.9 * std::sqrt(double(v) / most)); };
            Colour colour = {tone(L.x), tone(L.y), tone(L.z)};
            const bool border =
                (before >= 0 && before != int(nearest)) || (y > 0 && above[size_t(x)] != nearest);
            if (border) colour = {0.02f, 0.05f, 0.25f};
            if (distance(nearest) * side < 1.6) colour = {0.9f, 0.1f, 0.05f};
            blend(sheet, left + x, top + y, colour);
            before = int(nearest);
            above[size_t(x)] = nearest;
        }
}

void draw_image(Image& sheet, int left, int top, int scale, const Image& image) {
    for (int y = 0; y < image.height * scale; ++y)
        for (int x = 0; x < image.width * scale; ++x)
            blend(sheet, left + x, top + y, image.at(x / scale, y / scale));
}

// ---- Main ---------------------------------------------------------------------------------------

std::string reference_file(const std::string& name, Size size) {
    return "reference/" + name + "-" + std::to_string(size.width) + ".pfm";
}

Scene scene_of(const std::string& name, Size size) {
    Scene scene = read_scene("scenes/" + name + ".scene").scene;
    scene.size = size;
    return scene;
}

// The image by the best that we have.  Its error: the variance of its mean, from its halves, is the
// sum over pixels; how pixels share in it, an image of the variance of fewer samples tells.
Reference read_reference(const std::string& name, Size size) {
    const std::string file = reference_file(name, size), stem = file.substr(0, file.size() - 4),
                      json = stem + ".json", variance = stem + "-variance.pfm";
    const std::string options =
        " --seed 1000 --size " + std::to_string(size.width) + "x" + std::to_string(size.height);
    for (const std::string& needed : {file, json, variance})
        if (!std::filesystem::exists(needed))
            throw UserError(needed + ": missing; make it by\n  build/penumbra --halves --spp 8192" +
                            options + " -o " + file + " --stats " + json + " scenes/" + name +
                            ".scene\n  build/penumbra --view variance --spp 512" + options +
                            " -o " + variance + " scenes/" + name + ".scene");
    Reference r{read_pfm(file), read_pfm(variance)};
    for (const Image* image : {&r.image, &r.noise})
        if (image->width != size.width || image->height != size.height)
            throw UserError(file + ": of another size");
    const std::string text = read_file(json), key = "\"variance_of_mean\": [";
    const size_t from = text.find(key);
    if (from == text.npos) throw UserError(json + ": no variance_of_mean");
    std::istringstream in(text.substr(from + key.size()));
    char comma = 0;
    const double pixels = double(r.image.pixels.size());
    for (size_t c = 0; c < 3; ++c) {
        if (!(in >> r.mean[c] >> comma && r.mean[c] > 0))
            throw UserError(json + ": variance_of_mean is not three numbers above 0");
        r.mean[c] *= pixels;  // of a pixel, on average
        double sum = 0;
        for (const auto& pixel : r.noise.pixels) sum += double(pixel[c]) / pixels;
        if (!(sum > 0)) throw UserError(variance + ": no variance");
        for (auto& pixel : r.noise.pixels) pixel[c] *= float(r.mean[c] / sum);
    }
    return r;
}

void run(const std::string& name, const Plan& plan) {
    const Reference reference = read_reference(name, plan.size);
    const Scene scene = scene_of(name, plan.size);
    const Result r = measure(scene, plan, reference);
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    std::printf("\n%s: the reference's own squared error, subtracted: %.2e %.2e %.2e (r, g, b)\n",
                name.c_str(), reference.mean[0], reference.mean[1], reference.mean[2]);
    print_errors(name, plan, r);
    const int scale = std::max(1, 256 / plan.size.width), side = plan.size.width * scale,
              high = plan.size.height * scale, gap = 20;
    Image sheet = blank(3 * (side + gap) + gap, 2 * (high + 3 * gap));
    draw_image(sheet, gap, gap, scale, reference.image);
    caption(sheet, gap, gap + high + 5, "reference");
    draw_map(sheet, 2 * gap + side, gap, scale, r, size_t(Weighting::cvor));
    caption(sheet, 2 * gap + side, gap + high + 5, "variance mc / cvor: blue 4, red 1/4");
    const Place border = telling_pixel(scene, r, light_border);
    print_pixel(
        scene, plan, border,
        {sheet, 3 * gap + 2 * side + 50, gap, side - 60, high - 10, 1, 2, 0, 1, true, false});
    const int top = high + 3 * gap;
    int left = gap;
    for (Region region : {light_border, ball, plain}) {
        const Place at = telling_pixel(scene, r, region);
        draw_cells(sheet, left, top, std::min(side, high), scene, at);
        caption(sheet, left, top + high + 5,
                std::string(region_names[region]) + ": pixel " + std::to_string(at.x) + "," +
                    std::to_string(at.y));
        left += side + gap;
    }
    const std::string file = "out/voronoi-" + name + ".png";
    write_image(file, sheet, 1);
    std::printf("\nPictures: %s\n", file.c_str());
    std::fflush(stdout);
}

int voronoi_lab(const std::vector<std::string>& words) {
    Plan plan;
    std::vector<std::string> scenes = {"cornell", "cornellglossy"};
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (word != "--size" && word != "--most" && word != "--scene")
            throw UserError(unknown("option", word, {"--size", "--most", "--scene"}));
        if (++i == words.size()) throw UserError(word + ": needs a value");
        if (word == "--size") plan.size = option::size(words[i]);
        if (word == "--most") plan.most = parse_count(words[i], 64, 1 << 16);
        if (word == "--scene") scenes = {words[i]};
    }
    std::filesystem::create_directories("out");
    for (const std::string& name : scenes) run(name, plan);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return voronoi_lab({argv + 1, argv + argc}); });
}

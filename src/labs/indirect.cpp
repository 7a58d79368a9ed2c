// labs/indirect.cpp  6  the gain of illumination maps for paths that end on them
//
//   build/indirect [--quick]
#include "labs/grid.h"
#include "labs/indirect_paths.h"

namespace {
using namespace penumbra;

const std::vector<std::string> scenes = {"cornell36", "cube", "atelier"};

// Squared bias from pairs of images with different seeds.  The product of their differences from a
// reference has no noise on average, except that of the reference.
class Pairs {
public:
    void operator()(Row& r, const Image& image, const Truth& f) {
        const std::lock_guard guard(lock_);
        Image& other = of_[r.scene + r.setting + of_count(r)];
        if (!other.pixels.empty()) {
            Moments product;
            for (size_t i = 0; i < image.pixels.size(); ++i)
                for (size_t c = 0; c < 3; ++c) {
                    const double g = double(f.image.pixels[i][c]);
                    product.add((double(image.pixels[i][c]) - g) *
                                (double(other.pixels[i][c]) - g));
                }
            const double square = image_mean(f.image, 2);
            r.of["bias2"] = product.mean / square - f.own * f.own;
            r.of["bias2_error"] = product.standard_error() / square;
        }
        other = image;
    }

private:
    std::mutex lock_;
    std::map<std::string, Image> of_;
};

// The mean of a number over the rows that complete a pair.
double of_pairs(const Rows& rows, const char* name) {
    return mean(where(rows, [](const Row& r) { return !std::isnan(r["bias2"]); }), name);
}
double noise(const Rows& rows) {
    return std::sqrt(mean(rows, "d2") - std::max(0.0, of_pairs(rows, "bias2")));
}
std::string bias(const Rows& rows) {
    const double b = of_pairs(rows, "bias2"), error = of_pairs(rows, "bias2_error");
    return b > 2 * error ? percent(std::sqrt(b))
                         : "< " + percent(std::sqrt(std::max(0.0, b) + 2 * error));
}

void tell_images(Page& page, const Rows& all, const std::vector<Setting>& methods, uint64_t count) {
    const Rows rows = where(all, [&](const Row& r) { return r.count == count; });
    Lines lines;
    bool gathers = true, unseen = true;
    for (const auto& [scene, here] : grouped(rows, of_scene))
        for (const Setting& s : methods) {
            const Rows runs = by_setting(here, s.name);
            lines.push_back({scene, "`" + s.name + "`", text("%.2g", mean(runs, "cpu_seconds")),
                             percent(relative_error(runs)), percent(noise(runs)), bias(runs),
                             gain(here, s.name, "path", efficiency)});
            if (s.name == "map") gathers = gathers && over(here, "map", "path", efficiency) >= 3;
            if (s.name == "control")
                unseen = unseen && of_pairs(runs, "bias2") < 5 * of_pairs(runs, "bias2_error");
        }
    page.set("images",
             table({"scene", "paths", "CPU s", "d_rel", "noise", "bias", "efficiency"}, lines));
    page.claim("map-ok", gathers), page.claim("bias-ok", unseen);
    for (const char* name : {"map", "control"})
        page.set(name, gain(rows, name, "path", efficiency));
    page.set("endless", gain(rows, "control", "path --roulette 0", efficiency));
    page.plot("indirect-time",
              plot(in_scene(all, "cornell36"), "CPU seconds", "error (d_rel)", of_setting,
                   mean_of("cpu_seconds"), relative_error, "cornell36"));
}

void tell_meshes(Page& page, RenderGrid& grid, const std::string& radiosity, bool quick) {
    const std::string file = "scenes/cornell36.scene";
    std::vector<Setting> settings;
    for (int part : {8, 16, 32, 64})
        for (int particles : {30000, 100000, 300000, 1000000})
            settings.push_back({text("1/%d, %d", part, particles),
                                text("--final-gather --replications 1 --mesh %g --particles %d",
                                     double(diagonal(read_scene(file).scene)) / part, particles),
                                radiosity});
    const Subject s{"cornell36", file + " --size 64x32", quick ? 512u : 16384u};
    const Rows rows = grid.run({s}, settings, {quick ? 64u : 1024u}, quick ? 2 : 4);
    auto part = [](const Row& r) { return r.setting.substr(0, r.setting.find(',')); };
    auto particles = [](const Row& r) { return r.setting.substr(r.setting.find(' ') + 1); };
    page.set("meshes", table(rows, part, particles,
                             [](const Rows& r) { return bias(r) + ", " + percent(noise(r)); }));
}

int study(const Scope& scope) {
    const bool quick = scope.quick;
    const std::string penumbra = scope.beside(), radiosity = scope.beside("radiosity");
    Page page(scope, "indirect");
    Pairs pairs;
    // References have up to 64 bounces.  The light beyond is negligible, because .8^64 is 10^-6.
    RenderGrid grid("indirect", penumbra + " --depth 64");
    grid.measure = [&](Row& r, const Image& image, const Truth& f) { pairs(r, image, f); };
    const std::vector<Setting> methods = {
        {"path", "--replications 1", penumbra},
        {"map", "--final-gather --replications 1", radiosity},
        {"control", "", scope.self + " --render"},
        {"path --roulette 0", "--replications 1 --roulette 0", penumbra}};
    std::vector<Subject> subjects;
    for (const std::string& scene : scenes)
        subjects.push_back(
            {scene, "scenes/" + scene + ".scene --size 128x64", quick ? 512u : 4096u});
    using Counts = std::vector<uint64_t>;
    const Counts counts = quick ? Counts{4, 16} : Counts{8, 64, 512};
    tell_images(page, grid.run(subjects, methods, counts, quick ? 2 : 4), methods, counts.back());
    tell_meshes(page, grid, radiosity, quick);
    page.set("spp", text("%.0f", double(counts.back())));
    return page.finish();
}

// Renders with paths that end on maps or continue there.
Rendered render(const std::vector<std::string>& words) {
    NamedScene scene = read_scene(words.at(0)).scene;
    const auto [width, height] = parts_of(value_of(words, "--size"), 'x', "WIDTHxHEIGHT");
    scene.size = parse_size(width, height);
    return by_control(scene, parse_count(value_of(words, "--spp"), 1, UINT32_MAX),
                      parse_count(value_of(words, "--seed"), 0, UINT32_MAX));
}

}  // namespace

int main(int argc, char** argv) {
    const Lab lab{
        "indirect", "Measures the gain of illumination maps for paths ending on them.", {}, render};
    return experiment(argc, argv, lab, study);
}

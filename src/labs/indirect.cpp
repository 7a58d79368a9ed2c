// labs/indirect.cpp  6  the gain of illumination maps for paths that end on them
//
//   build/indirect [--quick] [--kept]
#include "base/json.h"
#include "labs/grid.h"

namespace {

const std::vector<std::string> scenes = {"cornell36", "cube", "atelier"};

// Squared bias from pairs of images with different seeds.  The product of their differences from a
// reference has no noise on average, except that of the reference.
class Pairs {
public:
    void operator()(Row& r, const Image& image, const Truth& f) {
        r.of["path_seconds"] = r["cpu_seconds"];
        if (!std::isnan(r["map_cpu_seconds"])) r.of["path_seconds"] -= r["map_cpu_seconds"];
        const std::lock_guard guard(lock_);
        Image& other = of_[r.scene + r.setting + of_count(r)];
        if (!other.pixels.empty()) {
            Moments product;
            double square = 0;
            for (size_t i = 0; i < image.pixels.size(); ++i)
                for (size_t c = 0; c < 3; ++c) {
                    const double g = double(f.image.pixels[i][c]);
                    product.add((double(image.pixels[i][c]) - g) *
                                (double(other.pixels[i][c]) - g));
                    square += g * g;
                }
            square /= double(product.n);
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
double noise2(const Rows& rows) {
    return mean(rows, "d2") - std::max(0.0, of_pairs(rows, "bias2"));
}
std::string bias(const Rows& rows) {
    const double b = of_pairs(rows, "bias2"), error = of_pairs(rows, "bias2_error");
    return b > 2 * error ? percent(std::sqrt(b))
                         : "< " + percent(std::sqrt(std::max(0.0, b) + 2 * error));
}
// Efficiency of paths, without the cost and the bias of maps.
double of_paths(const Rows& rows) { return 1 / (noise2(rows) * mean(rows, "path_seconds")); }

Rows most_of(const Rows& rows) {
    uint64_t most = 0;
    for (const Row& r : rows) most = std::max(most, r.count);
    return where(rows, [&](const Row& r) { return r.count == most; });
}

// ---- Images -------------------------------------------------------------------------------------

void tell_images(Page& page, const Rows& all, const std::vector<Setting>& methods) {
    const Rows rows = most_of(all);
    Lines lines;
    bool gathers = true, unseen = true;
    for (const std::string& scene : scenes)
        for (const Setting& s : methods) {
            const Rows here = in_scene(rows, scene), runs = by_setting(here, s.name);
            lines.push_back({scene, "`" + s.name + "`", text("%.2g", mean(runs, "cpu_seconds")),
                             percent(relative_error(runs)), percent(std::sqrt(noise2(runs))),
                             bias(runs), gain(here, s.name, "path", efficiency)});
            gathers = gathers && (s.name != "map" || over(here, "map", "path", efficiency) >= 3);
            if (s.name == "control" || s.name == "regression")
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

// ---- Russian roulette ---------------------------------------------------------------------------

void tell_ways(Page& page, RenderGrid& grid, const std::string& draw, bool quick) {
    std::vector<Subject> subjects;
    for (const std::string& scene : scenes)
        subjects.push_back(
            {scene, "scenes/" + scene + ".scene --size 64x32", quick ? 512u : 16384u});
    std::vector<Setting> ways;
    for (const char* way : {"whole:0.25", "map", "over:2", "over:1", "control", "over:0.4"})
        ways.push_back({way, std::string("--particles 300000 --way ") + way, draw});
    const Rows rows = grid.run(subjects, ways, {16}, quick ? 2 : 8);
    Lines lines;
    for (const Setting& way : ways) {
        lines.push_back({way.name == "control" ? "**over:2/3** (`control`)" : way.name});
        for (const std::string& scene : scenes)
            lines.back().push_back(gain(in_scene(rows, scene), way.name, ways[0].name, of_paths));
    }
    page.set("ways", table({"way", scenes[0], scenes[1], scenes[2]}, lines));
}

// ---- Meshes and particles -----------------------------------------------------------------------

void tell_meshes(Page& page, RenderGrid& grid, const std::string& radiosity, double diagonal,
                 bool quick) {
    std::vector<Setting> settings;
    for (int part : {8, 16, 32, 64})
        for (int particles : {30000, 100000, 300000, 1000000})
            settings.push_back({text("1/%d, %d", part, particles),
                                text("--final-gather --sets 1 --mesh %g --particles %d",
                                     diagonal / part, particles),
                                radiosity});
    const Subject s{"cornell36", "scenes/cornell36.scene --size 64x32", quick ? 512u : 16384u};
    const Rows rows = grid.run({s}, settings, {quick ? 64u : 1024u}, quick ? 2 : 4);
    auto part = [](const Row& r) { return r.setting.substr(0, r.setting.find(',')); };
    auto particles = [](const Row& r) { return r.setting.substr(r.setting.find(' ') + 1); };
    page.set("meshes", table(rows, part, particles, [](const Rows& r) {
                 return bias(r) + ", " + percent(std::sqrt(noise2(r)));
             }));
}

int study(const Scope& scope) {
    const bool quick = scope.quick;
    const std::string penumbra = scope.beside(), radiosity = scope.beside("radiosity"),
                      draw = scope.beside("indirect_draw") + " --scene";
    Page page(scope, "indirect");
    Pairs pairs;
    // References have up to 64 bounces.  The light beyond is negligible, because .8^64 is 10^-6.
    RenderGrid grid("indirect", penumbra + " --depth 64", scope.kept);
    grid.measure = [&](Row& r, const Image& image, const Truth& f) { pairs(r, image, f); };
    const std::vector<Setting> methods = {{"path", "--sets 1", penumbra},
                                          {"map", "--final-gather --sets 1", radiosity},
                                          {"control", "--way control", draw},
                                          {"regression", "--way regression", draw},
                                          {"path --roulette 0", "--sets 1 --roulette 0", penumbra}};
    std::vector<Subject> subjects;
    for (const std::string& scene : scenes)
        subjects.push_back(
            {scene, "scenes/" + scene + ".scene --size 128x64", quick ? 512u : 8192u});
    using Counts = std::vector<uint64_t>;
    const Counts counts = quick ? Counts{4, 16} : Counts{8, 64, 512};
    const Rows images = grid.run(subjects, methods, counts, quick ? 2 : 4);
    tell_images(page, images, methods);
    tell_ways(page, grid, draw, quick);
    const double diagonal = 16 * by_setting(in_scene(images, "cornell36"), "map")[0]["map_mesh"];
    tell_meshes(page, grid, radiosity, diagonal, quick);
    page.set("spp", text("%.0f", double(counts.back())));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    return experiment(
        argc, argv,
        {"indirect", "Measures the gain of illumination maps for paths ending on them.", {}, true},
        study);
}

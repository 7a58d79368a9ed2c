// labs/voronoi_weights.cpp  6  pixels with samples weighted by their Voronoi cells
//
//   build/voronoi_weights [--most N] [--quick]
//
// Repeats results of Vandewiele et al. 2025, "Voronoi integration of the rendering equation".
#include "labs/grid.h"
#include "path/pathtracer.h"
#include "text/scene_file.h"

namespace {
using namespace penumbra;

const std::string mc = "mc", cvor = "cvor", sobol = "sobol";

enum Region { light_border, plain, other };
constexpr const char* region_names[] = {"border of the light", "one diffuse surface", "other"};

// The region of a pixel, by the hits of 64 camera rays.
Region region_of(const Scene& scene, int px, int py) {
    size_t lights = 0, one = 0;
    vec3 n;
    for (int k = 0; k < 64; ++k) {
        const real x = real(px) + (real(k % 8) + real(0.5)) / 8,
                   y = real(py) + (real(k / 8) + real(0.5)) / 8;
        const auto met = meet(scene, camera_ray(scene.camera, scene.size, x, y));
        if (!met) continue;
        if (k == 0) n = met->at.n;
        const Material& m = *met->material;
        lights += m.emits();
        one += met->at.n == n && !m.is_delta() && !m.emits() && m.albedo() == m.diffuse();
    }
    return lights > 0 && lights < 64 ? light_border : one == 64 ? plain : other;
}

// Adds squared errors by region.  The reference's own error is far below them and not subtracted.
void add_regions(Row& r, const Image& image, const Truth& f, const Scene& scene) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::string name = region_names[region_of(scene, x, y)];
            r.of["pixels, " + name] += 1;
            for (size_t c = 0; c < 3; ++c)
                r.of[name] += std::pow(double(image.at(x, y)[c]) - double(f.image.at(x, y)[c]), 2);
        }
}

double square(const Rows& rows) { return mean(rows, "d2"); }

// The squared error of mc over that of another setting, for all pixels or for a region.
double less(const Rows& rows, const std::string& other, const std::string& number = "d2") {
    return mean(by_setting(rows, mc), number) / mean(by_setting(rows, other), number);
}

int study(const Scope& scope, uint64_t most) {
    const bool quick = scope.quick;
    if (quick) most = 64;
    Page page(scope, "voronoi");
    const int side = quick ? 64 : 128;
    std::vector<Setting> settings;
    for (const char* weights : {"mc", "vor", "fvor", "cvor", "torus"})
        settings.push_back(
            {weights, std::string("--replications 1 --light nee --roulette 0 --weights ") + weights,
             scope.beside("voronoi")});
    settings.push_back({sobol, "--replications 1 --light nee --roulette 0 --sampler sobol"});
    std::vector<uint64_t> counts;
    for (uint64_t n = 64; n <= most; n *= 4) counts.push_back(n);
    Rows rows;
    for (const std::string name : {"cornell", "cornellglossy"}) {
        const std::string file = "scenes/" + name + ".scene";
        Scene scene = read_scene(file).scene;
        scene.size = {side, side};
        const Subject subject{name, text("%s --size %dx%d", file, side, side),
                              uint64_t(quick ? 1024 : 8192)};
        RenderGrid grid("voronoi", scope.beside());
        grid.measure = [&](Row& r, const Image& image, const Truth& f) {
            add_regions(r, image, f, scene);
        };
        append(rows, grid.run({subject}, settings, counts, 4));
    }
    Lines lines, areas;
    bool halves = true, at_border = true, points = true;
    for (const auto& [scene, all] : grouped(rows, of_scene))
        for (const auto& [count, some] : grouped(all, of_count)) {
            lines.push_back({scene, count});
            for (const Setting& s : settings)
                if (s.name != mc)
                    lines.back().push_back(text("%.2f (%.2f)", less(some, s.name),
                                                over(some, s.name, mc, efficiency)));
            for (const char* region : region_names) {
                if (count != of_count(rows.back())) continue;
                areas.push_back(
                    {scene, region, text("%.0f", mean(some, std::string("pixels, ") + region))});
                for (const Setting& s : settings)
                    areas.back().push_back(text("%.2f", less(some, s.name, region)));
            }
            halves = halves && less(some, cvor) > 1.5;
            at_border = at_border && less(some, cvor, region_names[light_border]) > 2 &&
                        less(some, cvor, region_names[plain]) < 1;
            points = points && square(by_setting(some, sobol)) < square(by_setting(some, cvor));
        }
    page.set("table", table({"scene", "samples", "vor", "fvor", "cvor", "torus", sobol}, lines));
    page.set(
        "regions",
        table({"scene", "region", "pixels", "mc", "vor", "fvor", "cvor", "torus", sobol}, areas));
    page.plot("voronoi", plot(in_scene(rows, "cornell"), "samples per pixel", "error (d_rel)",
                              of_setting, count_of, relative_error, "cornell"));
    page.claim("halves", halves);
    page.claim("border", at_border);
    page.claim("points", points);
    page.set("size", text("%d×%d", side, side));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    uint64_t most = 256;
    const Lab lab{
        "voronoi_weights",
        "Weights samples by Voronoi cells, as published, and compares with Sobol' points.",
        {whole_number("--most", "samples per pixel; published: 4096", "256", most, 64, 1 << 16)}};
    return experiment(argc, argv, lab, [&](const Scope& scope) { return study(scope, most); });
}

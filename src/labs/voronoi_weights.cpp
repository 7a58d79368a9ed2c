// labs/voronoi_weights.cpp  6  pixels whose samples weigh as much as their Voronoi cells
//
//   build/voronoi_weights [--most N] [--quick] [--kept]
//
// The rendering results of Vandewiele et al. 2025, "Voronoi integration of the rendering equation".
#include "labs/grid.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "voronoi/polygon.h"
#include "world/scene_file.h"

namespace {

const std::string mc = "mc", cvor = "cvor", stratified = "stratified";

// ---- What a pixel shows -------------------------------------------------------------------------

enum Region { light_border, ball, edge, plain };
constexpr const char* region_names[] = {"border of the light", "ball", "other edges",
                                        "one diffuse surface"};

// By what 64 camera rays meet.
Region region_of(const Scene& scene, int px, int py) {
    bool emits = false, dark = false, sphere = false, other = false;
    uint32_t first = UINT32_MAX;
    vec3 n;
    for (int k = 0; k < 64; ++k) {
        const real x = real(px) + (real(k % 8) + real(0.5)) / 8,
                   y = real(py) + (real(k / 8) + real(0.5)) / 8;
        const auto met = meet(scene, camera_ray(scene.camera, scene.size, x, y));
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

std::vector<Region> regions_of(const Scene& scene) {
    std::vector<Region> all;
    for (int y = 0; y < scene.size.height; ++y)
        for (int x = 0; x < scene.size.width; ++x) all.push_back(region_of(scene, x, y));
    return all;
}

// Sums of squared errors by region, and the number of pixels.  The reference's own error is far
// below any of them, and not taken off.
void add_regions(Row& r, const Image& image, const Truth& f, const std::vector<Region>& of) {
    for (const char* name : region_names) r.of[name] = 0;
    for (size_t i = 0; i < of.size(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double e = double(image.pixels[i][c]) - double(f.image.pixels[i][c]);
            r.of[region_names[of[i]]] += e * e;
        }
    for (size_t k = 0; k < std::size(region_names); ++k)
        r.of[std::string("pixels, ") + region_names[k]] =
            double(std::count(of.begin(), of.end(), Region(k)));
}

// ---- Pictures -----------------------------------------------------------------------------------

// The clipped cells of 256 samples of a pixel, as bright as what was seen there.
void draw_cells(Svg& sheet, Place at, double width, const Scene& scene, int px, int py) {
    const Pattern pattern{SamplerKind::independent, 5};
    std::vector<Site> places;
    std::vector<rgb> seen;
    double most = 0;
    for (uint64_t i = 0; i < 256; ++i) {
        const Start s = start(scene, pattern, {px, py, i});
        places.push_back({double(s.u.x), double(s.u.y)});
        seen.push_back(Li(scene, {Direction::bsdf, LightMode::nee, 0}, s.ray, s.sampler));
        most = std::max(most, double(max_of(seen.back())));
    }
    auto tone = [&](real v) { return int(to_byte(0.9 * std::sqrt(double(v) / most))); };
    auto on_sheet = [&](Site q) { return Place{at.x + width * q.x, at.y + width * q.y}; };
    ConvexPolygon polygon;
    for (size_t i = 0; i < places.size(); ++i) {
        polygon.start(seen_from(places[i], {{0, 0}, {1, 1}}));
        for (size_t j = 0; j < places.size(); ++j)
            if (j != i) polygon.cut(bisector(places[j] - places[i], uint32_t(j)));
        std::vector<Place> outline;
        for (const Corner& c : polygon.outline())
            outline.push_back(on_sheet({places[i].x + c.p.x, places[i].y + c.p.y}));
        sheet.area(
            outline,
            text("#%02x%02x%02x", tone(seen[i].x), tone(seen[i].y), tone(seen[i].z)).c_str());
        sheet.line(outline, svg::colours[1], 0.5);
    }
    for (Site site : places) sheet.dot(on_sheet(site), svg::colours[2], 1.5);
}

// The reference, and the cells of a pixel in the middle of each of three regions.
Svg sheet_of(const Scene& scene, const std::vector<Region>& of, const Image& truth) {
    Svg sheet(4 * 272 + 16, 306);
    sheet.words({16, 18}, "reference");
    sheet.picture({16, 26}, 256, truth, double(scene.exposure));
    double left = 288;
    for (Region region : {light_border, ball, plain}) {
        std::vector<size_t> all;
        for (size_t i = 0; i < of.size(); ++i)
            if (of[i] == region) all.push_back(i);
        const int at = int(all[all.size() / 2]), x = at % scene.size.width,
                  y = at / scene.size.width;
        sheet.words({left, 18}, text("%s: pixel (%d, %d)", region_names[region], x, y));
        draw_cells(sheet, {left, 26}, 256, scene, x, y);
        left += 272;
    }
    return sheet;
}

// ---- The report ---------------------------------------------------------------------------------

double square(const Rows& rows) { return mean(rows, "d2"); }

// Squared error of mc over that of another, of all pixels or of a region.
double less(const Rows& rows, const std::string& other, const std::string& number = "d2") {
    return mean(by_setting(rows, mc), number) / mean(by_setting(rows, other), number);
}

int run(bool quick, bool kept, uint64_t most, const std::string& penumbra,
        const std::string& voronoi, const std::string& command) {
    Page page(report_folder(quick), "voronoi");
    const int side = quick ? 64 : 128;
    std::vector<Setting> settings;
    for (const char* weights : {"mc", "vor", "fvor", "cvor", "torus"})
        settings.push_back({weights,
                            std::string("--sets 1 --light nee --roulette 0 --weights ") + weights,
                            voronoi});
    settings.push_back({stratified, "--sets 1 --light nee --roulette 0 --sampler stratified"});
    std::vector<uint64_t> counts;
    for (uint64_t n = 64; n <= most; n *= 4) counts.push_back(n);
    Rows rows;
    for (const std::string name : {"cornell", "cornellglossy"}) {
        const std::string file = "scenes/" + name + ".scene";
        Scene scene = read_scene(file).scene;
        scene.size = {side, side};
        const std::vector<Region> regions = regions_of(scene);
        const Subject subject{name, text("%s --size %dx%d", file, side, side),
                              uint64_t(quick ? 1024 : 8192)};
        RenderGrid grid("voronoi", penumbra, kept);
        grid.measure = [&](Row& r, const Image& image, const Truth& f) {
            add_regions(r, image, f, regions);
        };
        const Rows some = grid.run({subject}, settings, counts, 4);
        rows.insert(rows.end(), some.begin(), some.end());
        page.plot("voronoi-" + name, sheet_of(scene, regions, grid.truth(subject).image));
    }
    std::vector<std::vector<std::string>> lines, areas;
    bool halves = true, at_border = true, strata = true;
    for (const auto& [scene, all] : grouped(rows, of_scene))
        for (const auto& [count, some] : grouped(all, of_count)) {
            lines.push_back({scene, count});
            for (const Setting& s : settings)
                if (s.name != mc)
                    lines.back().push_back(text("%.2f (%.2f)", less(some, s.name),
                                                over(some, s.name, mc, efficiency)));
            for (const char* region : region_names) {
                areas.push_back({scene, count, region,
                                 text("%.0f", mean(some, std::string("pixels, ") + region))});
                for (const Setting& s : settings)
                    areas.back().push_back(text("%.2f", less(some, s.name, region)));
            }
            halves = halves && less(some, cvor) > 1.5;
            at_border = at_border && less(some, cvor, region_names[light_border]) > 2 &&
                        less(some, cvor, region_names[plain]) < 1;
            strata =
                strata && square(by_setting(some, stratified)) < square(by_setting(some, cvor));
        }
    page.set("table",
             table({"scene", "samples", "vor", "fvor", "cvor", "torus", stratified}, lines));
    page.set("regions", table({"scene", "samples", "region", "pixels", "mc", "vor", "fvor", "cvor",
                               "torus", stratified},
                              areas));
    page.claim("halves", halves);
    page.claim("border", at_border);
    page.claim("strata", strata);
    page.set("size", text("%d×%d", side, side));
    page.set("made", made_by(command));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false, kept = false;
    uint64_t most = 256;
    const Lab lab{"voronoi_weights",
                  "Weighs pixels' samples by their Voronoi cells, as published and beside strata.",
                  {{"--most", "N", "samples a pixel (256; published: 4096)",
                    [&](auto& s) { most = parse_count(s, 64, 1 << 16); }},
                   kept_flag(kept),
                   quick_flag(quick)}};
    return lab_main(argc, argv, lab, [&] {
        return run(quick, kept, quick ? 64 : most, renderer_beside(lab, argv[0]),
                   renderer_beside(lab, argv[0], "voronoi"), command_of(argc, argv));
    });
}

// labs/shadows.cpp  6  four estimators of direct light, on images
//
//   build/shadows [--quick]
//
// Measures noise in light, penumbra and umbra, and efficiency (Heitz, Hill, McGuire 2018).
#include "app/threads.h"
#include "labs/grid.h"
#include "shadow/shadow.h"
#include "text/scene_file.h"

namespace {
using namespace penumbra;

constexpr const char* names[] = {"stochastic", "control", "ratio", "regression"};

enum Region { lit, penumbra, umbra, other };
constexpr const char* region_names[] = {"lit", "penumbra", "umbra"};

// Estimates of a pixel, by estimator.  `beyond_U` excludes the noise of antialiasing.
struct Pixel {
    Region region = other;
    double U = 0;
    std::array<Moments, 4> value, beyond_U;
};

constexpr uint64_t spp = 64;  // per estimate

// Measures the green channel of a pixel with independent light samples.
Pixel measure_pixel(const Scene& scene, PixelSample p, uint64_t trials) {
    const SamplerSettings settings{SamplerKind::independent, 1};
    Pixel pixel;
    ShadowMoments all;
    bool visible = false, occluded = false, dark = false;
    for (uint64_t t = 0; t < trials; ++t) {
        ShadowMoments m;
        for (uint64_t i = 0; i < spp; ++i) {
            const Start at = start(scene, settings, {p.x, p.y, t * spp + i});
            const Shadowed s = shadowed(scene, step(scene, {Direction::bsdf, LightMode::nee, 0},
                                                    {at.ray, at.ray.o}, at.sampler));
            m.add(double(s.U.y), double(s.w.y), double(s.wV.y));
            visible = visible || s.wV.y > 0, occluded = occluded || s.wV.y < s.w.y;
            dark = dark || !(s.U.y > 0);
        }
        all = merge(all, m);
        for (size_t e = 0; e < 4; ++e) {
            const double value = estimate(Estimator(e), m);
            pixel.value[e].add(value);
            if (m.w > 0) pixel.beyond_U[e].add(value - m.U);
        }
    }
    pixel.U = all.U;
    if (dark) return pixel;
    const double part = visible_part(all);
    pixel.region = !occluded                    ? lit
                   : !visible                   ? umbra
                   : part >= 0.1 && part <= 0.9 ? penumbra
                                                : other;
    return pixel;
}

void tell_noise(Page& page, bool quick) {
    Lines lines;
    bool exact = true;
    for (const char* name : {"penumbra", "panel", "lanterns"}) {
        Scene scene = read_scene(text("scenes/%s.scene", name)).scene;
        scene.size = quick ? Size{32, 16} : Size{64, 32};
        std::vector<Pixel> pixels(size_t(scene.size.width) * size_t(scene.size.height));
        by_workers(
            pixels.size(), all_cores(),
            [&](size_t i, unsigned) {
                const PixelSample p{int(i) % scene.size.width, int(i) / scene.size.width};
                pixels[i] = measure_pixel(scene, p, quick ? 16 : 256);
            },
            [](double) {});
        for (Region region : {lit, penumbra, umbra}) {
            size_t count = 0;
            double U2 = 0, variance[4] = {};
            bool none[4] = {true, true, true, true};  // no noise at all
            for (const Pixel& p : pixels) {
                if (p.region != region) continue;
                ++count, U2 += p.U * p.U;
                for (size_t e = 0; e < 4; ++e) {
                    const Moments& m = region == lit ? p.beyond_U[e] : p.value[e];
                    variance[e] += p.value[e].variance();
                    none[e] = none[e] && m.m2 == 0 && m.mean == 0;
                }
            }
            if (count == 0) continue;
            lines.push_back({name, region_names[region], text("%zu", count)});
            for (size_t e = 0; e < 4; ++e) {
                const bool must = region == lit ? e == 1 || e == 2 : region == umbra && e != 1;
                exact = exact && (none[e] || !must);
                lines.back().push_back(text("%.4f", std::sqrt(variance[e] / U2 * double(spp))) +
                                       (must && none[e] ? ", exact" : ""));
            }
        }
    }
    page.set("noise",
             table({"scene", "region", "pixels", names[0], names[1], names[2], names[3]}, lines));
    page.claim("exact", exact);
}

// Reports 1 / (squared error x CPU seconds) of whole renders, relative to `stochastic`.
void tell_efficiency(Page& page, RenderGrid& grid, bool quick) {
    const std::string size = quick ? " --size 32x16" : " --size 128x64";
    const uint64_t samples = quick ? 16 : 64;
    std::vector<Subject> subjects = {
        {"penumbra, depth 1", text("scenes/penumbra.scene%s --depth 1", size), 64 * samples}};
    for (const char* name : {"penumbra", "panel", "lanterns", "coursework", "cornell"})
        subjects.push_back({name, text("scenes/%s.scene%s", name, size), 64 * samples});
    Lines lines;
    for (const std::string sampler : {"independent", "sobol"}) {
        std::vector<Setting> settings;
        for (const char* e : names)
            settings.push_back(
                {e, text("--replications 1 --sampler %s --estimator %s", sampler, e)});
        const Rows rows = grid.run(subjects, settings, {samples}, quick ? 2 : 4);
        for (const auto& [scene, some] : grouped(rows, of_scene)) {
            lines.push_back({scene, sampler});
            for (size_t e = 1; e < 4; ++e)
                lines.back().push_back(gain(some, names[e], names[0], efficiency));
        }
        page.set(sampler, text("%.2f", over(rows, names[3], names[0], efficiency)));
    }
    page.set("efficiency", table({"scene", "sampler", names[1], names[2], names[3]}, lines));
}

int study(const Scope& scope) {
    const std::string program = scope.beside("shadow");
    Page page(scope, "shadows");
    tell_noise(page, scope.quick);
    RenderGrid grid("shadows", program);
    tell_efficiency(page, grid, scope.quick);
    std::vector<PlotPicture> pictures;
    for (const char* e : names)
        pictures.push_back(
            {rendering(text("%s scenes/penumbra.scene --size 256x128 --depth 1 "
                            "--replications 1 --spp 16 --sampler independent --estimator %s",
                            program, e)),
             e, "16 samples"});
    page.plot(
        "shadows-penumbra",
        contact_sheet(pictures, 2, double(read_scene("scenes/penumbra.scene").scene.exposure)));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    return experiment(argc, argv,
                      {"shadows", "Measures four estimators of direct light on images."}, study);
}

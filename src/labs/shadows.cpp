// labs/shadows.cpp  6  four estimators of direct light, on images
//
//   build/shadows [--quick] [--kept]
//
// Noise in light, penumbra and umbra beside its prediction, the bias of ratio, and efficiency of
// whole renders (Heitz, Hill, McGuire 2018).
#include "labs/grid.h"
#include "labs/shadow_pixels.h"

namespace {

using Lines = std::vector<std::vector<std::string>>;

const std::vector<std::string> estimator_head(std::vector<std::string> head) {
    head.insert(head.end(), std::begin(estimator_names), std::end(estimator_names));
    return head;
}

// ---- Noise --------------------------------------------------------------------------------------

// One estimator in the pixels of a region.
struct RegionNoise {
    double rms = 0;      // deviation of one sample over U
    double over = 1;     // sum of variances over that of their predictions
    bool exact = false;  // as it must be in light and umbra
};

RegionNoise noise_of(Region region, size_t e, const std::vector<Noise>& pixels, uint64_t spp) {
    double variance = 0, predicted = 0, U2 = 0;
    size_t exact = 0;
    for (const Noise& n : pixels) {
        const Moments& excess = region == lit ? n.beyond_U[e] : n.value[e];
        variance += n.value[e].variance();
        predicted += n.predicted[e];
        U2 += n.U * n.U;
        exact += excess.m2 == 0 && excess.mean == 0;
    }
    return {std::sqrt(variance / U2 * double(spp)), variance / predicted, exact == pixels.size()};
}

void tell_noise(Page& page, ShadowPlan plan) {
    Lines lines;
    double farthest = 0;
    bool exact = true;
    for (const char* name : {"penumbra", "panel", "lanterns"}) {
        const Stage v = load(name, plan.shrink);
        // Many lights: the predictions are those of many samples.
        if (v.scene.lights.size() > 8) plan.spp *= 4, plan.trials /= 2, plan.most_pixels /= 2;
        const Regions regions = find_regions(v, plan.look);
        for (Region region : {lit, penumbra, umbra}) {
            const auto pixels = regions.pixels(region, plan.most_pixels);
            const uint64_t trials = region == penumbra ? plan.trials : plan.trials / 8;
            std::vector<Noise> noise(pixels.size());
            in_parallel(pixels.size(), [&](size_t i) {
                noise[i] = measure_noise(v, pixels[i], plan.spp, trials);
            });
            // What the search for regions did not see.
            if (region == lit) std::erase_if(noise, [](const Noise& n) { return n.shadow; });
            if (noise.empty()) continue;
            lines.push_back(
                {name, region_names[region], text("%zu × %d", noise.size(), int(trials))});
            for (size_t e = 0; e < 4; ++e) {
                const RegionNoise n = noise_of(region, e, noise, plan.spp);
                const bool must = region == lit ? e == 1 || e == 2 : region == umbra && e != 1;
                if (must) exact = exact && n.exact;
                if (region == penumbra) farthest = std::max(farthest, std::abs(n.over - 1));
                lines.back().push_back(text("%.4f", n.rms) + (must && n.exact ? ", exact" : ""));
            }
        }
    }
    page.set("noise", table(estimator_head({"scene", "region", "pixels × estimates"}), lines));
    page.claim("exact", exact);
    page.claim("predicted", farthest < 0.15);
    page.set("farthest", text("%.1f %%", 100 * farthest));
}

// ---- Bias ---------------------------------------------------------------------------------------

// Over pixels at one N.
struct MeanBias {
    double mean = 0, rms = 0;  // rms: its own noise taken off
    double noise = 0;          // of a pixel
};

MeanBias mean_bias(const std::vector<Bias>& pixels, size_t e, size_t step) {
    MeanBias b;
    const double count = double(pixels.size());
    double square = 0, variance = 0;
    for (const Bias& pixel : pixels) {
        const Moments& excess = pixel.excess[e][step];
        const double own = excess.standard_error() * excess.standard_error();
        b.mean += excess.mean / count;
        square += (excess.mean * excess.mean - own) / count;
        variance += pixel.value[e][step].variance() / count;
    }
    b.rms = std::sqrt(std::max(0.0, square)), b.noise = std::sqrt(variance);
    return b;
}

void tell_bias(Page& page, const ShadowPlan& plan) {
    const Stage v = load("penumbra", plan.shrink);
    const auto pixels = find_regions(v, plan.look).pixels(penumbra, plan.most_pixels / 2);
    std::vector<Bias> all(pixels.size());
    in_parallel(pixels.size(), [&](size_t i) {
        all[i] = measure_bias(v, pixels[i], plan.bias_trials, bias_steps);
    });
    Lines lines;
    std::vector<double> ns, falls;
    for (size_t k = 0; k < bias_steps; ++k) {
        const double n = double(uint64_t(1) << k);
        const MeanBias b = mean_bias(all, 0, k);
        lines.push_back({text("%.0f", n), text("%+.2e", b.mean), text("%.2e", b.rms),
                         text("%.2e", b.noise), text("%.2e", mean_bias(all, 1, k).rms)});
        if (k >= 3 && b.rms > 0) ns.push_back(n), falls.push_back(b.rms);
    }
    page.data("shadows-bias", csv({"N", "ratio: mean bias", "ratio: rms bias", "ratio: noise",
                                   "regression: rms bias"},
                                  lines));
    const double exponent = slope(ns, falls);
    page.claim("bias falls", std::abs(exponent + 1) < 0.1);
    page.set("exponent", text("%.2f", exponent));
    auto part = [&](size_t k) {
        const MeanBias b = mean_bias(all, 0, k);
        return text("%.4f", b.rms / b.noise);
    };
    page.set("bias over noise", part(0));
    page.set("last bias over noise", part(bias_steps - 1));
}

// ---- Efficiency ---------------------------------------------------------------------------------

// Whole renders: 1 / (squared error x CPU seconds) over stochastic's.
void tell_efficiency(Page& page, RenderGrid& grid, const ShadowPlan& plan) {
    std::vector<Subject> subjects;
    const std::string size = plan.quick ? " --size 32x16" : " --size 128x64";
    for (const char* name : {"penumbra", "panel", "lanterns", "coursework", "cornell"})
        subjects.push_back({name, text("scenes/%s.scene%s", name, size), 64 * plan.render_spp});
    subjects.push_back({"penumbra, depth 1", text("scenes/penumbra.scene%s --depth 1", size),
                        64 * plan.render_spp});
    Lines lines;
    for (const std::string sampler : {"independent", "sobol"}) {
        std::vector<Setting> settings;
        for (const char* e : estimator_names)
            settings.push_back({e, text("--sets 1 --sampler %s --estimator %s", sampler, e)});
        const Rows rows = grid.run(subjects, settings, {plan.render_spp}, plan.seeds);
        for (const auto& [scene, some] : grouped(rows, of_scene)) {
            lines.push_back({scene, sampler});
            for (size_t e = 1; e < 4; ++e)
                lines.back().push_back(
                    gain(some, estimator_names[e], estimator_names[0], efficiency));
        }
        page.set(sampler,
                 text("%.2f", over(rows, estimator_names[3], estimator_names[0], efficiency)));
    }
    page.set("efficiency",
             table({"scene", "sampler", estimator_names[1], estimator_names[2], estimator_names[3]},
                   lines));
}

int run(const ShadowPlan& plan, bool kept, const std::string& program, const std::string& command) {
    Page page(report_folder(plan.quick), "shadows");
    tell_noise(page, plan);
    tell_bias(page, plan);
    RenderGrid grid("shadows", program, kept);
    tell_efficiency(page, grid, plan);
    for (const char* scene : {"penumbra", "lanterns"})
        page.plot(std::string("shadows-") + scene, shadow_sheet(load(scene, plan.shrink / 2)));
    page.set("made", made_by(command));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false, kept = false;
    const Lab lab{"shadows",
                  "Measures four estimators of direct light on images.",
                  {kept_flag(kept), quick_flag(quick)}};
    return lab_main(argc, argv, lab, [&] {
        return run(quick ? quick_plan : ShadowPlan(), kept, renderer_beside(lab, argv[0], "shadow"),
                   command_of(argc, argv));
    });
}

// labs/shadows.cpp  6  four estimators of direct light, on images
//
//   build/shadows [--noise] [--bias] [--efficiency] [--only SCENE] [--quick]
//
// What Heitz, Hill and McGuire (2018) say of stochastic, control variate, ratio and regression,
// seen on pixels: noise where all is lit, in penumbra and in umbra beside its prediction; the bias
// of ratio; what each brings for its time.  Writes shadows.md and shadows-*.svg.
#include "labs/lab.h"
#include "labs/shadow_efficiency.h"
#include "labs/shadow_sheets.h"

namespace {

void explain(Report& report) {
    report.say("# Light in shadow: four estimators on images");
    report.say(
        "A light sample brings w, the light that it stands for, and w V, what shadows leave of it. "
        "The mean U of w is known in closed form.  All four estimators are mean(w V) − β mean(w − "
        "U) (Heitz, Hill, McGuire 2018, and regression):");
    report.head({"`--estimator`", "β", "class", "variance × N", "bias × N"});
    report.row({"`stochastic`", "0", "unbiased", "Var(w V)", "0"});
    report.row({"`control`", "1", "unbiased", "Var(w (1 − V))", "0"});
    report.row(
        {"`ratio`", "R = Σ w V / Σ w", "consistent", "Var(w (V − R))", "−E[w² (V − R)] / E[w]"});
    report.row({"`regression`", "slope of w V on w", "consistent", "(1 − corr²) Var(w V)",
                "−E[(w − E[w])² residual] / Var(w)"});
    report.end_of_table();
    report.say(
        "The closed form serves diffuse surfaces that the camera sees itself; Phong lobes, what is "
        "seen in mirror or glass, later vertices, point lights, spheres from within, and lights "
        "nearer than rounding stay as sampled and are added.  Moments are those of a pixel's "
        "samples together, U among them, so that an edge in a pixel makes no difference: ratio is "
        "mean U · Σ w V / Σ w, and 0 where none of the samples found light.  Control would be "
        "unbiased at later vertices, too, but is not used there: on coursework with Halton points "
        "it took another 10 % of the variance, on cornell nothing at 1.2 times the time.");
}

// ---- Noise --------------------------------------------------------------------------------------

// What one estimator does in the pixels of a region.
std::string cell(Report& report, Region region, size_t e, const std::vector<Noise>& pixels,
                 uint64_t spp) {
    double variance = 0, predicted = 0, U2 = 0;
    size_t exact = 0, within = 0;
    std::vector<double> gain;
    for (const Noise& n : pixels) {
        const double mine = n.value[e].variance();
        const Moments& excess = region == lit ? n.beyond_U[e] : n.value[e];
        variance += mine;
        predicted += n.predicted[e];
        U2 += n.U * n.U;
        exact += excess.m2 == 0 && excess.mean == 0;
        within += std::abs(mine / n.predicted[e] - 1) < 0.15;
        gain.push_back(mine / n.value[0].variance());
    }
    const std::string noise = text("%.4f", std::sqrt(variance / U2 * double(spp)));
    const bool is_exact = region == lit ? e == 1 || e == 2 : region == umbra && e != 1;
    if (is_exact)
        return (region == lit ? noise + ", exactly U: " : "exactly 0: ") +
               report.verdict(exact == pixels.size());
    if (region != penumbra) return noise;
    const std::string spread =
        e == 0 ? "" : text("×%.2f–%.2f; ", quantile(gain, 0.1), quantile(gain, 0.9));
    return text("%s (%s%.3f, %.1f %%): %s", noise, spread, variance / predicted,
                100 * double(within) / double(pixels.size()),
                report.verdict(std::abs(variance / predicted - 1) < 0.15));
}

void measure_scene(Report& report, const std::string& name, const Stage& v, ShadowPlan plan) {
    // Many lights: the predictions are those of many samples.
    if (v.scene.lights.size() > 8) plan.spp *= 4, plan.trials /= 2, plan.most_pixels /= 2;
    const Regions regions = find_regions(v, plan.look);
    for (Region region : {lit, penumbra, umbra}) {
        const auto pixels = regions.pixels(region, plan.most_pixels);
        const uint64_t trials = region == penumbra ? plan.trials : plan.trials / 8;
        std::vector<Noise> noise(pixels.size());
        in_parallel(pixels.size(),
                    [&](size_t i) { noise[i] = measure_noise(v, pixels[i], plan.spp, trials); });
        // What the search for regions did not see.
        if (region == lit) std::erase_if(noise, [](const Noise& n) { return n.shadow; });
        if (noise.empty()) continue;
        uint64_t blind = 0;
        for (const Noise& n : noise) blind += n.blind;
        Row row = {name, region_names[region], text("%d × %d", int(noise.size()), int(trials)),
                   std::to_string(blind)};
        for (size_t e = 0; e < 4; ++e) row.push_back(cell(report, region, e, noise, plan.spp));
        report.row(row);
    }
}

void print_noise(Report& report, const ShadowPlan& plan) {
    report.say("## Noise in light, penumbra and umbra");
    report.say(text(
        "Lit is where no sample is occluded, umbra where all are, penumbra where 10 to 90 %% of "
        "the light is seen.  In up to %d pixels of each the direct light that the camera sees "
        "(green channel; independent numbers, seed 1) is estimated from %d samples, many times; "
        "lanterns, with its 32 lights, in half as many pixels from four times as many samples.  "
        "Noise is the standard deviation of one sample over U, root mean square over the pixels.  "
        "In brackets: the variance as a multiple of stochastic's, 10th to 90th percentile of the "
        "pixels; sum of variances over sum of their predictions from each pixel's own w and V, "
        "which must be within 15 %%; and the part of the pixels where it is.  What is exact must "
        "be so in every pixel, bit for bit; but for blind estimates, none of whose samples found "
        "light.",
        int(plan.most_pixels), int(plan.spp)));
    Row head = {"scene", "region", "pixels × estimates", "blind"};
    head.insert(head.end(), std::begin(estimator_names), std::end(estimator_names));
    report.head(head);
    for (const char* scene : {"penumbra", "panel", "lanterns"})
        if (plan.wants(scene)) measure_scene(report, scene, load(scene, plan.shrink), plan);
    report.end_of_table();
    report.say(
        "Control is not always the noisier one in a penumbra: it depends on whether the dimmer or "
        "the brighter part of the light is hidden.");
    for (const char* scene : {"penumbra", "lanterns"})
        if (plan.wants(scene))
            report.picture(text("shadows-%s", scene), shadow_sheet(load(scene, plan.shrink / 2)),
                           text("%s by four estimators, and their noise", scene));
}

// ---- Bias ---------------------------------------------------------------------------------------

// Over pixels at one N, of ratio (e = 0) or regression.
struct MeanBias {
    double mean = 0, error = 0;
    double rms = 0;    // root mean square, its own noise taken out
    double noise = 0;  // of a pixel, root mean square
};
MeanBias mean_bias(const std::vector<Bias>& pixels, size_t e, size_t step) {
    MeanBias b;
    const double count = double(pixels.size());
    double square = 0, variance = 0, error2 = 0;
    for (const Bias& pixel : pixels) {
        const Moments& excess = pixel.excess[e][step];
        const double own = excess.standard_error() * excess.standard_error();
        b.mean += excess.mean / count;
        square += (excess.mean * excess.mean - own) / count;
        error2 += own / (count * count);
        variance += pixel.value[e][step].variance() / count;
    }
    return {b.mean, std::sqrt(error2), std::sqrt(std::max(0.0, square)), std::sqrt(variance)};
}

void print_bias(Report& report, const ShadowPlan& plan) {
    const Stage v = load("penumbra", plan.shrink);
    const Regions regions = find_regions(v, plan.look);
    const auto pixels = regions.pixels(penumbra, plan.most_pixels / 2);
    std::vector<Bias> all(pixels.size());
    in_parallel(pixels.size(), [&](size_t i) {
        all[i] = measure_bias(v, pixels[i], plan.bias_trials, bias_steps);
    });
    report.say("## The bias of ratio");
    report.say(text(
        "From %d pixels in the penumbra of `penumbra`, %d trials each; radiance.  Mean: over all "
        "pixels, ± its standard error; rms: root mean square over the pixels, its own noise taken "
        "out.  Bias is the mean of an estimate minus mean(w V) − β mean(w − U) of the same "
        "samples, which is unbiased for a fixed β.",
        int(pixels.size()), int(plan.bias_trials)));
    report.head({"N", "ratio: mean bias", "N × mean", "rms bias", "rms noise of a pixel",
                 "rms bias / noise", "regression: rms bias"});
    std::vector<double> ns, falls;
    for (size_t k = 0; k < bias_steps; ++k) {
        const double n = double(uint64_t(1) << k);
        const MeanBias b = mean_bias(all, 0, k);
        report.row({text("%.0f", n), text("%+.2e ± %.0e", b.mean, b.error),
                    text("%+.4f", n * b.mean), text("%.2e", b.rms), text("%.2e", b.noise),
                    text("%.4f", b.rms / b.noise), text("%.2e", mean_bias(all, 1, k).rms)});
        if (k >= 3 && b.rms > 0) ns.push_back(n), falls.push_back(b.rms);
    }
    report.end_of_table();
    const double exponent = slope(ns, falls);
    auto part = [&](size_t k) {
        const MeanBias b = mean_bias(all, 0, k);
        return b.rms / b.noise;
    };
    report.say(
        text("The rms bias of ratio falls as N^%.2f from N = 8 on, as 1/N should: %s.  It is below "
             "the noise of a pixel from the first sample on: %.2f of it at N = 1, %.4f at %d.",
             exponent, report.verdict(std::abs(exponent + 1) < 0.1), part(0), part(bias_steps - 1),
             1 << (bias_steps - 1)));
    report.picture("shadows-bias", bias_sheet(v, regions, 4 * plan.bias_trials),
                   "Where ratio is too bright (red) and too dark (blue)");
}

}  // namespace

int main(int argc, char** argv) {
    ShadowPlan plan;
    bool noise = false, bias = false, efficiency = false;
    auto sets = [](bool& flag) { return [&flag](const std::string&) { flag = true; }; };
    const Lab lab{
        "shadows",
        "Measures four estimators of direct light on images (without flags all of it).",
        {{"--noise", "", "noise in light, penumbra and umbra", sets(noise)},
         {"--bias", "", "the bias of ratio", sets(bias)},
         {"--efficiency", "", "what whole renders bring for their time", sets(efficiency)},
         {"--only", "SCENE", "this scene alone", [&](const std::string& s) { plan.only = s; }},
         {"--quick", "", "small images; writes into out/, not reference/", sets(plan.quick)}}};
    return lab_main(argc, argv, lab, [&] {
        if (plan.quick) plan = quick_plan(plan.only);
        plan.renderer = renderer_beside(lab, argv[0], "shadow");
        const bool all = !noise && !bias && !efficiency;
        Report report(report_folder(plan.quick || !all || !plan.only.empty()), "shadows");
        explain(report);
        if (all || noise) print_noise(report, plan);
        if (all || bias) print_bias(report, plan);
        if (all || efficiency) print_efficiency(report, plan);
        report.say(made_by(argc, argv));
        return report.finish();
    });
}

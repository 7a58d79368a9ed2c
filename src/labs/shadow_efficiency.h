// labs/shadow_efficiency.h  4  what estimators of direct light bring for their time, for shadows
#pragma once
#include "base/stats.h"
#include "labs/lab.h"
#include "labs/shadow_regions.h"

using Row = std::vector<std::string>;

inline constexpr size_t whole = std::size(region_names);  // beside the regions

// Of one scene by one sampler: sums over the pixels of each region, and seconds, by estimator.
struct Costs {
    std::string scene, sampler;
    std::array<std::array<double, whole + 1>, 4> variance{};
    std::array<double, 4> seconds{};

    // Efficiency, 1 / (variance x seconds), over that of stochastic; NaN: no noise in either.
    double gain(size_t e, size_t region) const {
        return variance[0][region] * seconds[0] / (variance[e][region] * seconds[e]);
    }
};

// Variances of the mean of the channels, from seed to seed.
inline void measure(Costs& c, const Regions& regions, const ShadowPlan& plan, Row words) {
    std::array<std::vector<Moments>, 4> pixels;
    pixels.fill(std::vector<Moments>(regions.of.size()));
    for (uint64_t seed = 0; seed < plan.seeds; ++seed)
        for (size_t e = 0; e < 4; ++e) {
            Row all = words;
            all.insert(all.end(),
                       {"--estimator", estimator_names[e], "--seed", std::to_string(100 + seed)});
            const Rendering r = rendering(plan.renderer, all);
            c.seconds[e] += r.core_seconds();
            for (size_t i = 0; i < regions.of.size(); ++i) {
                const auto& [red, green, blue] = r.image.pixels[i];
                pixels[e][i].add((double(red) + double(green) + double(blue)) / 3);
            }
        }
    for (size_t e = 0; e < 4; ++e)
        for (size_t i = 0; i < regions.of.size(); ++i)
            for (size_t region : {size_t(regions.of[i]), whole})
                c.variance[e][region] += pixels[e][i].variance();
}

// Of control / ratio / regression.
inline std::string triple(const Costs& c, size_t region) {
    std::string words;
    for (size_t e = 1; e < 4; ++e) {
        const double gain = c.gain(e, region);
        words += e > 1 ? " / " : "";
        words += std::isnan(gain) ? "=" : std::isinf(gain) ? "∞" : text("%.2f", gain);
    }
    return words;
}

inline std::vector<Costs> print_scene(Report& report, const std::string& scene,
                                      const std::string& depth, const ShadowPlan& plan) {
    const Stage v = load(scene, scene == "cornell" ? 2 * plan.shrink : plan.shrink);
    const Regions regions = find_regions(v, plan.look / 4);
    std::vector<Costs> both;
    for (const char* sampler : {"independent", "halton"}) {
        Costs& c = both.emplace_back();
        c.scene = scene + (depth.empty() ? "" : ", depth " + depth);
        c.sampler = sampler;
        Row words = {"scenes/" + scene + ".scene",
                     "--sampler",
                     sampler,
                     "--spp",
                     std::to_string(plan.render_spp),
                     "--size",
                     text("%dx%d", v.width(), v.height())};
        if (!depth.empty()) words.insert(words.end(), {"--depth", depth});
        measure(c, regions, plan, words);
        Row row = {c.scene, sampler,
                   text("%.3f / %.3f / %.3f", c.seconds[1] / c.seconds[0],
                        c.seconds[2] / c.seconds[0], c.seconds[3] / c.seconds[0])};
        for (size_t region = 0; region <= whole; ++region) {
            const bool any = region == whole || !regions.pixels(Region(region), 1).empty();
            row.push_back(any ? triple(c, region) : "–");
        }
        report.row(row);
    }
    return both;
}

// What to choose; all scenes have been measured.
inline void recommend(Report& report, const std::vector<Costs>& all) {
    auto gain = [&](const std::string& scene, const std::string& sampler, size_t e) {
        const auto c = std::find_if(all.begin(), all.end(), [&](const Costs& x) {
            return x.scene == scene && x.sampler == sampler;
        });
        return c->gain(e, whole);
    };
    std::vector<double> by_halton;
    for (const char* scene : {"penumbra", "coursework", "cornell"})
        for (size_t e = 1; e < 4; ++e) by_halton.push_back(gain(scene, "halton", e));
    report.say(
        "Most of the noise of lanterns and panel is not in the light of this study but at the "
        "edges of the lights themselves and in reflected light near the panel.");
    report.say(text(
        "Which one, then?  With independent numbers choose regression, which is %.2f times as "
        "efficient as stochastic in the direct light of penumbra, %.2f and %.2f times in whole "
        "renders of penumbra and coursework.  With Halton points and light from "
        "several bounces stay with stochastic: Halton has already taken the noise that U would "
        "take, and what is left is %.2f–%.2f for penumbra, coursework and cornell, less where U is "
        "dear: %.2f for lanterns, whose 32 lights cost every first hit as many closed forms.  "
        "Choose ratio where lit and dark parts must be smooth from the first samples on, control "
        "where no bias is allowed and little lies in deep shadow.",
        gain("penumbra, depth 1", "independent", 3), gain("penumbra", "independent", 3),
        gain("coursework", "independent", 3), quantile(by_halton, 0), quantile(by_halton, 1),
        gain("lanterns", "halton", 3)));
}

inline void print_efficiency(Report& report, const ShadowPlan& plan) {
    report.say("## Efficiency");
    report.say(text(
        "1 / (variance · core seconds) of whole renders over that of stochastic: control / ratio / "
        "regression.  %d samples; variances of %d seeds, of the mean of the "
        "channels, summed over a region.  Time: core seconds over stochastic's, within some 5 %% "
        "on a busy machine.  –: there are no such pixels; =: no noise in either.",
        int(plan.render_spp), int(plan.seeds)));
    Row head = {"scene", "sampler", "time"};
    head.insert(head.end(), std::begin(region_names), std::end(region_names));
    head.push_back("whole image");
    report.head(head);
    std::vector<Costs> all;
    for (const auto& [scene, depth] : {std::pair{"penumbra", "1"},
                                       {"penumbra", ""},
                                       {"panel", ""},
                                       {"lanterns", ""},
                                       {"coursework", ""},
                                       {"cornell", ""}})
        if (plan.wants(scene))
            for (const Costs& c : print_scene(report, scene, depth, plan)) all.push_back(c);
    report.end_of_table();
    if (plan.only.empty()) recommend(report, all);
}

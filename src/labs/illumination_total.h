// labs/illumination_total.h  6  what no comparison on triangles shows: total errors, told and drawn
#pragma once
#include "labs/illumination_truth.h"

namespace illumination {

inline Test test_of(const Scope& plan) {
    if (plan.quick) return {"cornell36", {320, 160}, 16, 200, {64, 32}};
    if (plan.full)
        return {"cornell36", {226, 160, 113, 80, 56.5, 40, 28.2, 20}, 4096, 8000, {128, 64}};
    return {"cornell36", {226, 160, 113, 80, 56.5, 40}, 768, 2000, {128, 64}};
}

// At 1 % of unshot power.
inline void plot_by_mesh(Svg& sheet, const Comparison& c) {
    std::vector<double> H, particles, total, realistic, optimistic, floor;
    for (const AtH& m : c.meshes) {
        H.push_back(m.H), particles.push_back(m.limit), total.push_back(m.total_at_1);
        realistic.push_back(m.realistic_at_1), optimistic.push_back(m.optimistic_at_1);
        floor.push_back(m.floor);
    }
    Plot plot(sheet, {80, 40}, {330, 290},
              {"longest edge H", H.back() * 0.9, H.front() * 1.1, true, H},
              {"error (d_rel)", 1e-3, 1}, text("%s: 1 %% unshot", c.test.scene));
    auto curve = [&](const std::vector<double>& y, const char* colour, const std::string& words) {
        plot.curve(H, y, {.colour = colour, .dashed = words[0] != 't' && words[0] != 'p'});
        plot.label(y.front(), words, colour);
    };
    curve(total, svg::colours[3], "total, hierarchy");
    curve(realistic, svg::colours[3], "realistic");
    curve(floor, svg::colours[7], "floor of the realistic");
    curve(optimistic, svg::colours[5], "optimistic");
    curve(particles, svg::colours[1], "particles' limit");
}

inline void plot_by_time(Svg& sheet, const Comparison& c) {
    Plot plot(sheet, {660, 40}, {390, 290}, {"seconds", 1e-3, 100},
              {"total error (d_rel)", 0.01, 1}, "One camera, by mesh");
    auto curve = [&](const Curve& all, const Plot::Style& style, const std::string& words) {
        Curve shown;
        for (size_t i = 0; i < all.error.size(); ++i)
            if (all.seconds[i] >= 1e-3 && all.error[i] >= 0.01)
                shown.add(all.seconds[i], all.error[i]);
        plot.curve(shown.seconds, shown.error, style, words);
    };
    curve(c.traced, {.colour = svg::colours[0]}, "path tracer");
    for (size_t i : {size_t(1), c.meshes.size() - 1}) {
        const AtH& m = c.meshes[i];
        const bool dashed = i == 1;
        curve(m.particles, {.colour = svg::colours[1], .dashed = dashed},
              text("particles, %zu", m.elements));
        curve(m.total, {.colour = svg::colours[3], .dashed = dashed},
              text("hierarchy, %zu", m.elements));
    }
}

inline void tell_truth(Report& report, const Comparison& c) {
    const Power tracer = power_through(c.traced);
    report.say(text(R"(## Against the path tracer: what triangles cost

A path tracer has no triangles, so its long run is nearer to the truth than any map: %zu × %zu pixels of
`%s`, %.0f samples a pixel, its own error %s, taken off in squares.  Total errors hold
discretisation, too.)",
                    size_t(c.test.size.width), size_t(c.test.size.height), c.test.scene,
                    2 * double(c.test.spp), percent(c.truth.own)));
    Svg sheet(1240, 400);
    plot_by_mesh(sheet, c);
    plot_by_time(sheet, c);
    report.picture("radiosity-total", sheet, "Total errors over the mesh and over time");
    report.head({"triangles", "H", "particles' limit, total", "hierarchy at 1 % unshot: total",
                 "realistic", "its floor", "optimistic", "seconds", "a view",
                 "path tracer, same error", "cameras from which on the map is cheaper"});
    for (const AtH& m : c.meshes) {
        const double traced = std::pow(m.total_at_1 / tracer.factor, 1 / tracer.exponent);
        const double n = cameras(m.seconds_at_1, m.view, traced);
        report.row({text("%zu", m.elements), text("%g", m.H), percent(m.limit),
                    percent(m.total_at_1), percent(m.realistic_at_1), percent(m.floor),
                    percent(m.optimistic_at_1), seconds(m.seconds_at_1), seconds(m.view),
                    seconds(traced), std::isfinite(n) ? text("%.0f", n) : "never"});
    }
    report.end_of_table();
    std::vector<double> H, limit;
    for (const AtH& m : c.meshes) H.push_back(m.H), limit.push_back(m.limit);
    report.say(
        text("The particles' limit falls like H^%.2f.  No run on a mesh gets below its limit, "
             "however long; nor does the realistic estimate see it, nor the optimistic one.",
             slope(H, limit)));
    const double least = *std::min_element(limit.begin(), limit.end());
    report.say(
        text("Below %s, the least of these limits, only the path tracer gets; it takes %s to "
             "come there, for one camera.",
             percent(least), seconds(std::pow(least / tracer.factor, 1 / tracer.exponent))));
    report.say("Particles, one run, against the path tracer at the same total error:");
    report.head({"triangles", "total error", "particles: seconds", "path tracer: seconds",
                 "cameras from which on the map is cheaper"});
    for (const AtH& m : c.meshes) {
        const double error = m.particles.error.back(), own = m.particles.seconds.back(),
                     traced = std::pow(error / tracer.factor, 1 / tracer.exponent),
                     n = cameras(own, m.view, traced);
        report.row({text("%zu", m.elements), percent(error), seconds(own), seconds(traced),
                    std::isfinite(n) ? text("%.0f", n) : "never"});
    }
    report.end_of_table();
}

}  // namespace illumination

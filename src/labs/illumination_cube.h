// labs/illumination_cube.h  5  the cube: both methods beside the exact solution
#pragma once
#include "labs/illumination_wall.h"

namespace illumination::in_cube {

// ---- What is told -------------------------------------------------------------------------------

inline std::vector<std::string> luminance_cells(const Luminance& L) {
    std::vector<std::string> list;
    for (const Moments& m : L.at) list.push_back(text("%.2f", m.mean));
    list.push_back(text("%.2f", L.mean));
    return list;
}

inline void tell_cube_luminance(Report& report, const CubeRuns& r) {
    report.say(text(
        "Luminance in nit, the mean over all points like it on six faces, and over the walls.  A "
        "limit is what a method comes to at this mesh: of shooting by two runs, to 0.001 and "
        "0.0001 unshot, as what is missing is nearly proportional to what is unshot; of particles "
        "without noise, from integrals of the exact E over hats.  Below the limits stand single "
        "runs: of shooting to 1 %% unshot, of %.0f particles.  %s",
        double(r.particles),
        r.plan.full
            ? "Shooting by elements would take some 20 minutes at 64 cells."
            : "Shooting by elements takes minutes at 32 cells (FULL=1) and some 20 at 64."));
    std::vector<std::string> head = {"cells a side", ""};
    for (const NamedPoint& p : cube_points) head.push_back(p.name);
    head.push_back("mean");
    report.head(head);
    auto row = [&](const std::string& n, const std::string& what, const Luminance& L) {
        std::vector<std::string> list = {n, what};
        for (const std::string& cell : luminance_cells(L)) list.push_back(cell);
        report.row(list);
    };
    Luminance exact{{}, r.exact.mean() * nit_per_lux};
    for (size_t k = 0; k < 6; ++k) exact.at[k].add(r.exact_at(k));
    row("", "**exact**", exact);
    for (size_t i = 0; i < r.walls.size(); ++i) {
        const std::string n = std::to_string(r.walls[i].n);
        for (size_t m : {elements, faces, projection, hat_mean})
            if (i < r.by_method[m].size())
                row(n, std::string(method_names[m]) + ": limit", r.by_method[m][i].L);
        for (size_t m : {elements, faces})
            if (i < r.by_method[m].size())
                row(n, std::string(method_names[m]) + ": run",
                    luminance(r.walls[i], r.by_method[m][i].early));
        for (const Walked& w : r.walked[i]) row(n, w.name() + ": run", w.L);
    }
    report.end_of_table();
}

inline Svg cube_sheet(const CubeRuns& r) {
    Svg sheet(1010, 720);
    const char* colours[] = {svg::colours[0], svg::colours[1], svg::colours[2], svg::colours[4]};
    const std::array<std::pair<size_t, const char*>, 4> panels = {
        {{0, "A, middle of a face"},
         {3, "D, middle of an edge"},
         {5, "F, corner"},
         {6, "all walls, quadratic mean"}}};
    for (size_t i = 0; i < panels.size(); ++i) {
        const auto& [k, title] = panels[i];
        std::vector<double> ticks = cells(r.by_method[projection]);
        Plot plot(sheet, {70 + 500 * double(i % 2), 35 + 350 * double(i / 2)}, {270, 260},
                  {"cells a side", ticks.front(), ticks.back(), true, ticks},
                  {"discretisation error, relative", 1e-4, 1}, title);
        for (size_t m : {elements, faces, projection, hat_mean})
            plot.curve(cells(r.by_method[m]), errors(r, r.by_method[m], k), {.colour = colours[m]},
                       method_names[m]);
    }
    return sheet;
}

inline void tell_cube_orders(Report& report, const CubeRuns& r) {
    report.say("### Discretisation: from the limit to the exact solution");
    report.picture("radiosity-cube", cube_sheet(r), "Discretisation errors in the cube");
    const size_t points[] = {0, 3, 5, 6};
    const size_t shown = r.plan.quick ? 1 : 2;
    const std::string at = text("at %u cells: ", r.walls[shown].n);
    report.say(
        "The order p of the error, h^p, by a method's last meshes, at A, D, F and in the quadratic "
        "mean over the walls; this error itself, that of the mean luminance, and the greatest "
        "standard deviation among points that are alike by symmetry.");
    report.head({"", "cells", "p at A", "at D", "at F", "walls", at + "error of the walls",
                 "of the mean", "spread"});
    for (Method m : {elements, faces, projection, hat_mean}) {
        const std::vector<Solved>& all = r.by_method[m];
        const size_t last = std::max<size_t>(2, all.size() - 1);
        std::vector<std::string> list = {
            method_names[m], text("%u–%u", all[all.size() - last].walls->n, all.back().walls->n)};
        for (size_t k : points) list.push_back(text("%.2f", order(r, m, k, last)));
        const Solved& s = all[shown];
        double spread = 0;
        for (const Moments& alike : s.L.at)
            spread = std::max(spread, std::sqrt(alike.variance()) / alike.mean);
        for (const std::string& cell :
             {text("%.2f %%", 100 * s.from_exact),
              text("%+.2f %%", std::round(1e4 * (s.L.mean * 3 / 2000 - 1)) / 100 + 0.0),
              text("%.2f %%", 100 * spread)})
            list.push_back(cell);
        report.row(list);
    }
    report.end_of_table();
}

inline void tell_cube_functional(Report& report, const CubeRuns& r) {
    const double p = edge_exponent();
    double worst = 0;
    for (double y : {0.0, 0.5}) {
        auto rise = [&](double s) {
            return r.exact.illuminance(1 - s, y) - r.exact.illuminance(1, y);
        };
        worst = std::max(worst, std::abs(std::log10(rise(1e-3) / rise(1e-4)) - p));
    }
    report.claim(worst < 0.005,
                 text("At a distance s from an edge E rises like s^%.3f, by the equation of two "
                      "faces at a right angle whose reflectance is 2/3; the exact E between 1 and "
                      "0.1 thousandths of half a side has this exponent to %.4f",
                      p, worst));
    bool nearer = true;
    for (size_t i = 0; i < r.walls.size(); ++i)
        for (size_t k : {size_t(3), size_t(4), size_t(5), size_t(6)})
            nearer = nearer && discretisation(r, r.by_method[projection][i], k) <
                                   discretisation(r, r.by_method[hat_mean][i], k);
    auto times = [&](size_t k) {
        return discretisation(r, r.by_method[hat_mean].back(), k) /
               discretisation(r, r.by_method[projection].back(), k);
    };
    report.claim(nearer,
                 text("The projection is nearer to E than the hat mean at D, E, F and over the "
                      "walls, at every mesh; at the finest by factors of %.1f, %.1f, %.1f and %.1f",
                      times(3), times(4), times(5), times(6)));
    if (!r.plan.quick) {
        double off = 0;
        for (Method m : {projection, hat_mean})
            off = std::max(
                {off, std::abs(order(r, m, 3, 2) - p), std::abs(order(r, m, 6, 2) - p - 0.5)});
        report.claim(
            off < 0.06,
            text("From 32 to 64 cells the orders of both have come down to %.2f and %.2f "
                 "at D, where %.2f is expected, and to %.2f and %.2f over the walls, where "
                 "%.2f is",
                 order(r, projection, 3, 2), order(r, hat_mean, 3, 2), p,
                 order(r, projection, 6, 2), order(r, hat_mean, 6, 2), p + 0.5));
    }
    report.say(text(
        "Particles fill the projection, not the hat mean.  Both are unbiased functionals of E, and "
        "in the middle of a face both are of second order.  At a border the hat lies on one side "
        "of its vertex, so that its mean takes E a third of a cell away: an error of first order "
        "where E is smooth, which the projection has not.  In this room E is not smooth there: of "
        "s^%.2f either is wrong by h^%.2f at the edge, and no function that is linear on cells of "
        "width h comes nearer than h^%.2f in the quadratic mean.  This bounds the order of both; "
        "what the projection keeps is the factor.  Shooting does not meet this bound at D and F, "
        "because it receives at the vertices themselves: its error is light that is lost where E, "
        "which is mostly concave, is taken as linear between vertices, and it spreads over all "
        "walls, so that nearly the same part is missing everywhere.  The projection loses none: "
        "its mean is exact.  Shooting by faces has, beyond this, an error of its own that does not "
        "fall with the mesh, from parts of faces that are taken as one.",
        p, p, p + 0.5));
}

// ---- Convergence --------------------------------------------------------------------------------

inline void tell_cube_shooting(Report& report, const CubeRuns& r) {
    report.head({"cells a side", "shooting to 1 %", "seconds", "unshot", "mean short by",
                 "from its limit", "limit from exact", "run from exact"});
    double worst = 0;
    for (size_t i = 0; i < r.walls.size(); ++i)
        for (Method m : {elements, faces}) {
            if (i >= r.by_method[m].size()) continue;
            const Solved& s = r.by_method[m][i];
            const Walls& w = r.walls[i];
            const double shorter = (s.L.mean - luminance(w, s.early).mean) * 3 / 2000;
            worst = std::max(worst, std::abs(shorter / s.early_unshot - 1));
            report.row({std::to_string(w.n), m == elements ? "by elements" : "by faces",
                        text("%.1f", s.early_seconds), text("%.3f %%", 100 * s.early_unshot),
                        text("%.3f %%", 100 * shorter),
                        text("%.3f %%", 100 * distance(w, s.early, s.limit)),
                        text("%.3f %%", 100 * s.from_exact),
                        text("%.3f %%", 100 * distance_from_exact(w, s.early))});
        }
    report.end_of_table();
    report.claim(worst < 0.02,
                 text("In a closed room the part that is unshot is the part of the mean luminance "
                      "that is missing: in all these runs to %.1f %% of it",
                      100 * worst));
    const double error = error_of_limit(r.by_method[elements][1]);
    report.claim(error < 1e-5,
                 text("The limit that two runs tell is right: at 8 cells a run to 0.000001 unshot "
                      "is %.1e away from it, in the quadratic mean",
                      error));
    bool dark = true;
    for (Method m : {elements, faces})
        for (const Solved& s : r.by_method[m])
            for (size_t k = 0; k < cube_points.size(); ++k)
                dark = dark && s.L.at[k].mean < r.exact_at(k);
    report.claim(dark,
                 "Limits of shooting are too dark at A … F, as are runs that end before them, so "
                 "its two errors add up; those of particles are perpendicular, so their squares "
                 "do");
}

inline void tell_cube_particles(Report& report, const CubeRuns& r) {
    report.head({"cells a side", "", "seconds", "reported", "from the limit", "over reported",
                 "limit from exact", "run from exact", "particles until noise is as small"});
    Moments ratio;
    double worst = 0;
    std::array<std::vector<double>, 2> noise;
    for (size_t i = 0; i < r.walls.size(); ++i)
        for (size_t kind : {size_t(0), size_t(1)}) {
            const Walked& w = r.walked[i][kind];
            const double limit = r.by_method[projection][i].from_exact;
            ratio.add(w.from_limit / w.reported);
            worst = std::max(worst, std::abs(w.from_limit / w.reported - 1));
            noise[kind].push_back(w.reported);
            const double enough = double(w.n) * w.reported * w.reported / (limit * limit);
            report.row({std::to_string(r.walls[i].n), w.name(), text("%.1f", w.seconds),
                        text("%.2f %%", 100 * w.reported), text("%.2f %%", 100 * w.from_limit),
                        text("%.2f", w.from_limit / w.reported), text("%.3f %%", 100 * limit),
                        text("%.2f %%", 100 * w.from_exact),
                        kind == 0 ? text("%.2g", enough) : std::string()});
        }
    report.end_of_table();
    report.claim(
        worst < 0.2 && std::abs(ratio.mean - 1) < 0.04,
        text("The error that particles report about themselves is their distance to "
             "their limit: over it %.3f in the mean of %d runs, none more than %.0f %% off",
             ratio.mean, int(ratio.n), 100 * worst));
    const std::vector<double> n = cells(r.by_method[projection]);
    auto best = [&](size_t kind) {
        return std::min_element(
                   r.walked.begin(), r.walked.end(),
                   [&](auto& a, auto& b) { return a[kind].from_exact < b[kind].from_exact; })
            ->at(kind)
            .walls->n;
    };
    report.say(text(
        "The finer the mesh the fewer hits a vertex has: noise grows like n^%.2f with the cells a "
        "side (Halton n^%.2f), while discretisation falls.  After %.0f particles the total error "
        "is least at %u cells a side (Halton: %u); a finer mesh pays only with more particles, "
        "the last column tells how many independent ones.",
        slope(n, noise[0]), slope(n, noise[1]), double(r.particles), best(0), best(1)));
}

inline void tell_cube_noise(Report& report, const CubeRuns& r) {
    const Walls& w = r.walls[2];
    const int last = r.plan.quick ? 18 : 22;
    std::vector<double> n;
    std::array<std::vector<double>, 2> error;
    for (int e = 14; e <= last; e += 2) {
        n.push_back(std::pow(2, e));
        for (size_t k : {size_t(0), size_t(1)})
            error[k].push_back(walked(w, k ? SamplerKind::halton : SamplerKind::independent,
                                      uint64_t(100 + e), uint64_t(1) << e)
                                   .from_limit);
    }
    report.say(text(
        "At %u cells the distance to the limit falls like N^%.2f from %.0f to %.0f particles with "
        "independent numbers, from %.1f %% to %.2f %%; with Halton points like N^%.2f, to %.2f %%.",
        w.n, slope(n, error[0]), n.front(), n.back(), 100 * error[0].front(), 100 * error[0].back(),
        slope(n, error[1]), 100 * error[1].back()));
    report.claim(std::abs(slope(n, error[0]) + 0.5) < 0.03,
                 "Independent particles converge like 1/√N");
}

inline void tell_cube(Report& report, const Scope& plan) {
    const CubeRuns r = run_cube(plan);
    report.say("## The cube, whose radiosity is known");
    report.say(
        "`scenes/cube.scene` is the theoretical case of Khodulev (1996): the inside of a cube of "
        "10 m, a point light of 50 000 cd at its centre, walls of reflectance 2/3.  Its exact "
        "luminance is the solution of the integral equation (`src/labs/cube.h`), derived and "
        "tested here to 10⁻⁶.  Faces are cut into n × n cells of two triangles.");
    tell_cube_luminance(report, r);
    tell_cube_orders(report, r);
    tell_cube_functional(report, r);
    report.say("### Convergence: from a run to its limit");
    tell_cube_shooting(report, r);
    tell_cube_particles(report, r);
    tell_cube_noise(report, r);
}

}  // namespace illumination::in_cube

namespace illumination {
using in_cube::tell_cube;
}

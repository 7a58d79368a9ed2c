// labs/illumination_growth.h  5  what both methods cost: elements, rays, seconds
#pragma once
#include "labs/illumination.h"

namespace illumination::growth {

// ---- Growth with the mesh -----------------------------------------------------------------------

// A run of shooting to 1 % unshot.
struct Cost {
    double elements = 0, vertices = 0, shots = 0, rays = 0, seconds = 0;
};
inline constexpr double enough = 1e-2;

// The costs of one way to shoot, over meshes.
struct Growth {
    std::string scene;
    Shooter shooter;
    std::vector<Cost> costs;

    std::string name() const {
        return scene + (shooter == Shooter::element ? ", elements" : ", faces");
    }
    std::vector<double> values(double Cost::*what) const {
        std::vector<double> list;
        for (const Cost& c : costs) list.push_back(c.*what);
        return list;
    }
    // Of the power through the last so many meshes.
    double exponent(double Cost::*what, size_t last) const {
        std::vector<double> n = values(&Cost::elements), y = values(what);
        const auto from = std::ptrdiff_t(n.size() - std::min(last, n.size()));
        return slope({n.begin() + from, n.end()}, {y.begin() + from, y.end()});
    }
    double exponent(double Cost::*what) const { return exponent(what, costs.size()); }
    // By the power through the last two.
    double predicted(double Cost::*what, double elements) const {
        return costs.back().*what * std::pow(elements / costs.back().elements, exponent(what, 2));
    }
};

inline Cost cost_of(const Room& r, const Shooting& run) {
    return {double(r.mesh.elements()), double(r.mesh.vertices()), double(run.shots()),
            double(run.rays()), run.seconds()};
}

// At two meshes: d_rel of the camera's images of the limits, faces against elements.
struct Apart {
    double elements = 0, d = 0;
};

struct Study {
    std::vector<Growth> growths;
    std::vector<Apart> apart;
};

inline Growth grow(const std::string& scene, Shooter shooter, const std::vector<double>& H) {
    Growth g{scene, shooter, {}};
    for (double h : H) {
        const Room r = room(scene, h);
        Shooting run(r.scene, r.mesh, shooter, all_cores());
        run.run({enough, 0, 0}, [](const Shooting&) {});
        g.costs.push_back(cost_of(r, run));
    }
    return g;
}

inline Apart apart(const std::string& scene, double H, double unshot) {
    const Room r = room(scene, H);
    const Eye eye(r);
    auto image = [&](Shooter shooter) {
        Shooting run(r.scene, r.mesh, shooter, all_cores());
        run.run({unshot, 0, 0}, [](const Shooting&) {});
        return eye(run.map());
    };
    const Image flat = image(Shooter::element);
    return {double(r.mesh.elements()), d_rel(flat, image(Shooter::face))};
}

inline Study run_study(const Scope& plan) {
    using List = std::vector<double>;
    const List all = plan.quick ? List{90, 50} : List{90, 50, 28, 16, 9};
    const List flat = plan.quick ? List{130, 90} : plan.full ? all : List{90, 65, 48, 35};
    const List room_flat = plan.full ? List{1.2, 0.5, 0.295} : List{};
    const List room_faces = plan.quick  ? List{}
                            : plan.full ? List{1.2, 0.5, 0.295, 0.125}
                                        : List{0.295};
    Study s;
    s.growths = {grow("cornell36", Shooter::element, flat), grow("cornell36", Shooter::face, all)};
    if (!room_flat.empty()) s.growths.push_back(grow("atelier", Shooter::element, room_flat));
    if (!room_faces.empty()) s.growths.push_back(grow("atelier", Shooter::face, room_faces));
    for (double H : plan.quick ? List{130} : List{90, 55})
        s.apart.push_back(apart("cornell36", H, 1e-3));
    return s;
}

inline void tell_costs(Report& report, const Study& s) {
    report.head({"scene, what shoots", "elements", "vertices", "shots", "shadow rays", "seconds"});
    for (const Growth& g : s.growths) {
        auto row = [&](const Cost& c, const std::string& mark) {
            report.row({g.name() + mark, text("%.0f", c.elements),
                        c.vertices > 0 ? text("%.0f", c.vertices) : std::string(),
                        text("%.0f", c.shots), text("%.2g", c.rays), text("%.1f", c.seconds)});
        };
        for (const Cost& c : g.costs) row(c, "");
        if (g.costs.size() < 3) continue;
        for (double n : {1e4, 1e5})
            if (n > 1.5 * g.costs.back().elements)
                row({n, 0, g.predicted(&Cost::shots, n), g.predicted(&Cost::rays, n),
                     g.predicted(&Cost::seconds, n)},
                    " (*predicted by the last two*)");
    }
    report.end_of_table();
}

inline Svg sheet_of(const Study& s) {
    Svg sheet(1100, 370);
    const std::array<std::pair<double Cost::*, Axis>, 2> panels = {
        {{&Cost::rays, {"shadow rays", 1e5, 1e10}}, {&Cost::seconds, {"seconds", 0.1, 1e4}}}};
    for (size_t i = 0; i < panels.size(); ++i) {
        const auto& [what, y] = panels[i];
        Plot plot(sheet, {75 + 550 * double(i), 35}, {320, 275}, {"elements", 500, 1.2e5}, y,
                  y.label + " to 1 % unshot");
        for (size_t k = 0; k < s.growths.size(); ++k) {
            const Growth& g = s.growths[k];
            plot.curve(g.values(&Cost::elements), g.values(what), {.colour = svg::colours[k]},
                       g.name());
            const double last = g.costs.back().elements;
            if (g.costs.size() < 3 || last > 6e4) continue;
            plot.curve({last, 1e5}, {g.costs.back().*what, g.predicted(what, 1e5)},
                       {.colour = svg::colours[k], .dots = false, .dashed = true, .width = 1});
        }
    }
    return sheet;
}

inline void tell_exponents(Report& report, const Study& s) {
    for (const Growth& g : s.growths) {
        if (g.costs.size() < 3) continue;
        report.say(
            text("* %s: shots grow like n^%.2f with n elements, shadow rays like n^%.2f, "
                 "seconds like n^%.2f (the last two meshes alone: n^%.2f, n^%.2f, n^%.2f).",
                 g.name(), g.exponent(&Cost::shots), g.exponent(&Cost::rays),
                 g.exponent(&Cost::seconds), g.exponent(&Cost::shots, 2),
                 g.exponent(&Cost::rays, 2), g.exponent(&Cost::seconds, 2)));
    }
    report.say(
        "By elements both shots and vertices grow like n, so rays must come to n²; on coarse "
        "meshes many of them are for elements near by, which are cut into parts.  Predictions by "
        "the last two meshes are therefore low.");
    const Growth &flat = s.growths[0], &faces = s.growths[1];
    if (faces.costs.size() < 3) return;
    report.claim(
        faces.exponent(&Cost::rays) < 1.15 &&
            faces.exponent(&Cost::rays) < flat.exponent(&Cost::rays) - 0.3,
        text("Faces that shoot as one bring the growth in rays down, from n^%.2f to n^%.2f: the "
             "shots to 1 %% are as many at every mesh, and a vertex sees a face through parts "
             "whose size depends on their distance, hardly on the mesh",
             flat.exponent(&Cost::rays), faces.exponent(&Cost::rays)));
}

inline void tell_apart(Report& report, const Study& s) {
    std::string list;
    for (const Apart& a : s.apart)
        list +=
            (list.empty() ? "" : ", ") + text("%.2f %% at %.0f elements", 100 * a.d, a.elements);
    double most = 0;
    for (const Apart& a : s.apart) most = std::max(most, a.d);
    report.claim(
        most < 0.02,
        text("Shooting by faces has a limit of its own: its image of cornell36, to 0.001 unshot, "
             "is d_rel %s away from that of elements on the same triangles",
             list));
}

// ---- Speed --------------------------------------------------------------------------------------

// Core nanoseconds a ray, one for each of several rounds: of particles and of penumbra.
struct Speed {
    std::vector<double> particles, paths, ratio;
};

inline Speed speed(const std::vector<std::string>& penumbra, const Room& r, bool quick) {
    const uint64_t n = uint64_t(1) << (quick ? 17 : 19);
    Speed s;
    for (int round = 0; round < (quick ? 2 : 5); ++round) {
        Particles particles(r.scene, r.mesh,
                            Particles::pattern(SamplerKind::independent, uint64_t(round), n));
        const double start = processor_seconds();
        walk(particles, n);
        s.particles.push_back(1e9 * (processor_seconds() - start) / double(particles.rays()));
        const Rendering image = rendering(penumbra[0], {penumbra.begin() + 1, penumbra.end()});
        s.paths.push_back(1e9 * image.core_seconds() / stats(image.stats, "rays")[0]);
        s.ratio.push_back(s.particles.back() / s.paths.back());
    }
    return s;
}

inline void tell_speed(Report& report, const Scope& plan, const std::string& penumbra) {
    report.head({"scene", "penumbra", "its core ns a ray", "particles' core ns a ray", "ratio"});
    double most = 0;
    for (const auto& [scene, H] : {std::pair{"cornell36", 28.0}, {"atelier", 0.295}}) {
        const Room r = room(scene, H);
        for (const std::string light : {"none", "nee"}) {
            const bool point =
                std::any_of(r.scene.lights.begin(), r.scene.lights.end(),
                            [](const Light& l) { return l.kind == Light::Kind::point; });
            if (point && light == "none") continue;  // no path finds it
            const Speed s = speed({penumbra, "--sampler", "independent", "--light", light, "--spp",
                                   plan.quick ? "2" : "12", "scenes/" + r.name + ".scene"},
                                  r, plan.quick);
            most = std::max(most, median(s.ratio));
            report.row({r.name, "--light " + light, with_range(s.paths, "%.0f"),
                        with_range(s.particles, "%.0f"), with_range(s.ratio, "%.2f")});
        }
    }
    report.end_of_table();
    report.say(
        "Independent numbers, runs by turns, the median with the least and the greatest.  The "
        "paths of `--light none` are such walks as particles make, from the other end (atelier has "
        "a point light, which they cannot find); with light samples half of the rays are shadow "
        "rays, which end sooner.");
    report.say(text("A ray of particles costs at most %.2f times one of penumbra.", most));
}

inline void tell_growth(Report& report, const Scope& plan, const std::string& penumbra) {
    const Study s = run_study(plan);
    report.say("## What it costs");
    report.say(text(
        "Shooting until 1 %% of the emitted power is unshot, by single elements and by whole faces "
        "(`--method shooting`, `--method hierarchy`), over meshes; %u threads.",
        all_cores()));
    tell_costs(report, s);
    report.picture("radiosity-growth", sheet_of(s), "Shadow rays and seconds over elements");
    tell_exponents(report, s);
    tell_apart(report, s);
    for (const Growth& g : s.growths)
        for (const Cost& c : g.costs)
            if (g.scene == "atelier" && g.shooter == Shooter::face && c.elements > 2e4 &&
                c.elements < 3e4)
                report.say(
                    text("atelier, cut into %.0f elements, is shot to 1 %% by faces in %.1f s.",
                         c.elements, c.seconds));
    report.say(
        "Of the time of shooting, shadow rays take 38 % in cornell36 by faces (10 544 elements), "
        "42 % by elements, and 67 % in atelier by faces, whose 1 636 faces make rays dearer; the "
        "closed form of form factors and its arc tangents take 38 %, 31 % and 15 %; most of what "
        "remains is finding and cutting the parts that shoot (`perf record --call-graph fp`, one "
        "thread, samples below `Transfer::visible_part` and in `irradiance_polygon`; measured "
        "once, by hand).");
    report.say("### Speed of particles");
    tell_speed(report, plan, penumbra);
}

}  // namespace illumination::growth

namespace illumination {
using growth::tell_growth;
}

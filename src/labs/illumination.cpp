// labs/illumination.cpp  7  two methods of global illumination on the same triangles
//
//   build/illumination [--quick] [--full]
//
// Khodulev (1996) compared a deterministic method with Monte Carlo, both on illumination maps, by
// accuracy over time.  Here both are rebuilt and measured as he did; then with what he had not: the
// exact CUBE, and a path tracer without triangles.
#include "labs/illumination_cube.h"
#include "labs/illumination_growth.h"
#include "labs/illumination_total.h"

namespace {

using namespace illumination;

// ---- Accuracy over time -------------------------------------------------------------------------

std::string room_name(const Race& r) { return text("%s, %zu triangles", r.scene, r.elements); }

std::vector<Course> courses(const Scope& plan) {
    if (plan.quick) return {{"cube", 3.6, 1 << 18, 1e-3, 2}, {"cornell36", 160, 1 << 18, 1e-2, 2}};
    const uint64_t more = plan.full ? 8 : 1;
    const double longer = plan.full ? 20 : 1;
    return {{"cube", 0.884, more << 24, 1e-4, 15 * longer},
            {"cornell36", 160, more << 22, 1e-4, 15 * longer},
            {"cornell36", 80, more << 22, 1e-4, 15 * longer},
            {"cornell36", 40, more << 24, 1e-4, 15 * longer},
            {"atelier", 0.295, more << 25, 1e-3, 40 * longer}};
}

void tell_references(Report& report, const std::vector<Race>& races) {
    report.say(R"(## References, and how good they are

The reference of a room is its longest run of particles.  Its own error is inferred: that of an image
is k times what the run reports of its map (from 16 independent batches, as the quadratic mean over all
surfaces), and k follows from twelve shorter runs, with their spread.  If errors are proportional to
reports, distances have the exponent 1 over reports.  The error of a run that is longer than those
twelve is predicted by k, and then measured against the longest.)");
    report.head(
        {"room", "k", "exponent", "predicted", "measured", "", "reference: particles", "error"});
    for (const Race& r : races) {
        const Proportion& p = r.proportion;
        const double spread = std::sqrt(p.k.variance()) / p.k.mean;
        const bool proportional = std::abs(p.exponent - 1) < 4 * p.uncertainty + 0.02,
                   predicts = std::abs(p.measured / p.predicted - 1) < 4 * spread;
        report.row(
            {room_name(r), plus_minus(p.k, "%.3f"), text("%.3f ± %.3f", p.exponent, p.uncertainty),
             percent(p.predicted), percent(p.measured), report.verdict(proportional && predicts),
             text("%.3g s", r.references.seconds.back()), percent(r.references.error.back())});
    }
    report.end_of_table();
}

void plot_races(Report& report, const std::vector<const Race*>& races) {
    constexpr double high = 270, wide = 520, row = high + 90;
    Svg sheet(wide + 320, row * double(races.size()));
    for (size_t k = 0; k < races.size(); ++k) {
        const Race& r = *races[k];
        const double top = row * double(k) + 34;
        const double end =
            std::max({r.flat.realistic.seconds.back(), r.references.seconds.back(), 1.0});
        Plot plot(sheet, {80, top}, {wide, high}, {"seconds", 0.01, end * 1.3},
                  {"error (d_rel)", 5e-4, 1}, room_name(r));
        auto curve = [&](const Curve& c, int colour, bool dashed, const std::string& words) {
            Curve shown;  // what the axes hold
            for (size_t i = 0; i < c.error.size(); ++i)
                if (c.error[i] >= 5e-4 && c.seconds[i] >= 0.01) shown.add(c.seconds[i], c.error[i]);
            plot.curve(shown.seconds, shown.error,
                       {.colour = svg::colours[colour], .dashed = dashed}, words);
        };
        curve(r.particles(), 0, false, "particles");
        curve(r.halton, 1, false, "particles, Halton");
        curve(r.flat.realistic, 2, false, "shooting, realistic");
        curve(r.flat.optimistic, 2, true, "shooting, optimistic");
        curve(r.hierarchy.realistic, 3, false, "hierarchy, realistic");
        curve(r.hierarchy.optimistic, 3, true, "hierarchy, optimistic");
        plot.curve(r.references.seconds, r.references.error,
                   {.colour = svg::colours[4], .width = 0, .radius = 5}, "references, inferred");
    }
    report.picture("radiosity-time", sheet, "Error over time");
}

std::string words_of(const Ahead& a) {
    if (!a.ever) return "never";
    const std::string from = text("%s (%s)", seconds(a.from), percent(a.worst));
    return from + (a.to_the_end ? " on" : text(" to %s (%s)", seconds(a.to), percent(a.best)));
}

void tell_races(Report& report, const std::vector<Race>& races) {
    report.say(R"(## Accuracy over time

Both methods on the same triangles, no adaptivity.  The *realistic* error of shooting is its distance to
the Monte Carlo reference, whose own error is taken off in squares; the *optimistic* one is its distance
to its own last solution, which is less than its true error, for solutions only grow.  Times are of
all threads by the clock, without images.)");
    std::vector<const Race*> shown;
    for (const char* scene : {"cube", "cornell36", "atelier"})
        for (auto r = races.rbegin(); r != races.rend(); ++r)
            if (r->scene == scene) {
                shown.push_back(&*r);
                break;
            }
    plot_races(report, shown);
    report.say("Particles are ahead, in time (and by an error of their own) from:");
    report.head({"room", "exponent", "Halton", "shooting, realistic", "optimistic",
                 "hierarchy, realistic", "optimistic", "floor, shooting", "floor, hierarchy"});
    for (const Race& r : races)
        report.row({room_name(r), text("%.2f", power_through(r.particles()).exponent),
                    text("%.2f", power_through(r.halton).exponent),
                    words_of(ahead(r.particles(), r.flat.realistic)),
                    words_of(ahead(r.particles(), r.flat.optimistic)),
                    words_of(ahead(r.particles(), r.hierarchy.realistic)),
                    words_of(ahead(r.particles(), r.hierarchy.optimistic)), percent(r.flat.floor),
                    percent(r.hierarchy.floor)});
    report.end_of_table();
    report.say(
        R"(The exponent is that of the particles' error over time, −0.5 by theory for independent numbers, whose
longest runs are the references.  In atelier the camera sees its window and lamps: they make the quadratic
mean large, and all errors small beside it.  The floor is the realistic error of the last deterministic solution: the distance between the limits of two
discretisations, vertices' values here and projections there, if the run is long enough.)");
    for (const Race* r : shown) {
        report.say(text("%s, shooting until %s of the power is unshot:", room_name(*r),
                        percent(r->flat.shots.back().unshot)));
        report.head({"method", "unshot", "shots", "shadow rays", "seconds", "realistic",
                     "optimistic", "particles by then"});
        const Curve particles = r->particles();
        for (const auto& [name, d] :
             {std::pair("shooting", &r->flat), {"hierarchy", &r->hierarchy}})
            for (size_t i = 0; i < d->shots.size(); ++i) {
                const Shot& s = d->shots[i];
                report.row({name, percent(s.unshot), text("%.0f", double(s.shots)),
                            text("%.3g", double(s.rays)), seconds(s.seconds),
                            percent(d->realistic.error[i]),
                            i < d->optimistic.error.size() ? percent(d->optimistic.error[i]) : "",
                            percent(error_at(particles, s.seconds))});
            }
        report.end_of_table();
    }
}

// The paper's conclusion, as the numbers have it.
void tell_conclusion(Report& report, const std::vector<Race>& races) {
    size_t realistic = 0;
    double flat = 0, hierarchy = 0;  // the largest error of particles at which they are caught up
    std::string where;
    for (const Race& r : races) {
        realistic += ahead(r.particles(), r.flat.realistic).to_the_end &&
                     ahead(r.particles(), r.hierarchy.realistic).to_the_end;
        const Ahead f = ahead(r.particles(), r.flat.optimistic),
                    h = ahead(r.particles(), r.hierarchy.optimistic);
        if (!f.to_the_end) flat = std::max(flat, f.best);
        if (!h.to_the_end) hierarchy = std::max(hierarchy, h.best);
        where += text("%s%s (%s)", where.empty() ? "" : ", ",
                      f.to_the_end ? "not within the run" : "at " + percent(f.best), room_name(r));
    }
    report.say(text(
        R"(**Is Monte Carlo preferable even by the optimistic estimate?**  By the realistic estimate it is, to the
end of every run, in %.0f of %.0f rooms: both deterministic methods stop at their floors.  By the
optimistic estimate the paper's conclusion is confirmed for all errors above %s against shooting by
triangles, and refuted below: shooting catches up %s.  The hierarchy, which the paper did not have,
catches up earlier, at %s at the latest: there the argument decides nothing, and only the floors do.)",
        double(realistic), double(races.size()), percent(flat), where, percent(hierarchy)));
}

// ---- The report ---------------------------------------------------------------------------------

void tell_pictures(Report& report, const std::string& penumbra, const Scope& plan) {
    const Room room = illumination::room("atelier", plan.quick ? 1 : 0.295);
    const Eye eye(room);
    const Filled particles =
        fill(room, eye, SamplerKind::halton, 1, plan.quick ? 1 << 18 : 1 << 22);
    const auto shots = shoot(room, eye, Shooter::face, {plan.quick ? 0.1 : 0.01}, 60);
    const Rendering traced =
        rendering(penumbra, {"scenes/atelier.scene", "--spp", plan.quick ? "4" : "64"});
    report.picture(
        "radiosity-atelier",
        contact_sheet(
            {{traced.image, "path tracer",
              text("%.0f samples a pixel, %.1f s", double(traced.samples()), wall_seconds(traced))},
             {particles.image, "particles",
              text("%s triangles, %.1f s", room.size(), particles.seconds)},
             {shots[0].image, "shooting (hierarchy)",
              text("%.0f %% unshot, %.1f s", 100 * shots[0].unshot, shots[0].seconds)}},
            3, double(room.scene.exposure)),
        "The same room three ways");
}

int study(const std::string& penumbra, const Scope& plan) {
    Report report(report_folder(plan.quick), "radiosity");
    report.say(R"(# Deterministic and Monte Carlo illumination maps

Faces are cut into triangles no longer than H; irradiance is kept at their vertices, linear between
(`build/radiosity`).  *Shooting* is progressive refinement (Cohen et al. 1988) without a random number, a
triangle at a time; the *hierarchy* shoots whole faces, in parts as large as a vertex may see them (after
Hanrahan et al. 1991).  *Particles* walk from the lights and are projected onto the same maps.  After
Khodulev (1996, ch. 5).  Errors of images are d_rel = √(1/N Σ(f−g)²) / √(1/N Σf²) over all numbers,
three a pixel.)");
    tell_pictures(report, penumbra, plan);
    tell_cube(report, plan);
    std::vector<Race> races;
    const std::vector<Course> all = courses(plan);
    Steps progress(all.size());
    for (const Course& c : all) {
        progress.next(text("%s, H %g", c.scene, c.H));
        races.push_back(run_race(c));
    }
    tell_references(report, races);
    tell_races(report, races);
    tell_conclusion(report, races);
    tell_truth(report, compared(penumbra, test_of(plan)));
    tell_growth(report, plan, penumbra);
    report.say(made_by(plan.quick  ? "build/illumination --quick"
                       : plan.full ? "build/illumination --full"
                                   : "build/illumination"));
    return report.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Scope plan;
    const Lab lab{"illumination",
                  "Compares deterministic and Monte Carlo illumination maps.",
                  {quick_flag(plan.quick),
                   {"--full", "", "longer runs: an hour", [&](auto&) { plan.full = true; }}}};
    return lab_main(argc, argv, lab, [&] { return study(renderer_beside(lab, argv[0]), plan); });
}

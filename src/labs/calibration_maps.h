// labs/calibration_maps.h  4  what build/radiosity --error delivers: true errors over those asked
// for
#pragma once
#include "labs/illumination.h"
#include "radiosity/walks.h"

namespace illumination::calibration {

// A scene of diffuse surfaces, and the least error to which 32 runs of particles take a minute or
// so.
struct Place {
    const char* scene;
    double least;
};

struct Extent {
    bool quick = false;
    std::vector<Place> places() const {
        if (quick) return {{"cube", 0.03}, {"penumbra", 0.03}};
        return {{"atelier", 0.03}, {"cornell36", 0.01}, {"cube", 0.01},    {"furnace", 0.03},
                {"lanterns", 0.1}, {"panel", 0.01},     {"penumbra", 0.03}};
    }
};

// Its triangles' edges are this part of the scene's diagonal.
inline Room room_of_part(const std::string& name, int parts) {
    const Scene read = read_scene("scenes/" + name + ".scene").scene;
    return room(name, double(diagonal(read)) / parts, Size{8, 8});
}

// ---- Distances of maps --------------------------------------------------------------------------

// Integral of the square of a map over all surfaces and channels.
inline double square_of(const Mesh& mesh, const IlluminationMap& map) {
    double sum = 0;
    for (const Face& f : mesh.faces) {
        const Projection onto(mesh, f);
        for (const bool back : {false, true}) {
            Sums x;
            for (uint32_t v = 0; v < f.vertices(); ++v) x.push_back(map[2 * (f.vertex + v) + back]);
            const rgb square = onto.square(x);
            for (auto c : axis) sum += double(square.*c);
        }
    }
    return sum;
}

inline IlluminationMap difference(IlluminationMap a, const IlluminationMap& b) {
    for (size_t v = 0; v < a.size(); ++v) a[v] += -b[v];
    return a;
}

// ---- Particles ----------------------------------------------------------------------------------

struct Runs {
    std::vector<IlluminationMap> maps;
    std::vector<double> stated, uncertainty, particles, seconds;
};

inline Runs runs_of(const Room& room, SamplerKind kind, double error, int n) {
    Runs runs;
    CommonOptions o;
    o.quiet = true;
    for (int r = 0; r < n; ++r) {
        const uint64_t seed = hash(uint64_t(r), std::bit_cast<uint64_t>(error));
        Walked w =
            walk_all(room.scene, room.mesh, Particles::pattern(kind, seed, 0), {0, 0, error}, o);
        runs.maps.push_back(std::move(w.map));
        runs.stated.push_back(w.stated.error), runs.uncertainty.push_back(w.stated.uncertainty);
        runs.particles.push_back(double(w.particles)), runs.seconds.push_back(w.seconds);
    }
    return runs;
}

inline double mean_square(const std::vector<double>& x) {
    double sum = 0;
    for (double each : x) sum += each * each;
    return sum / double(x.size());
}

// The mean of many runs, as a reference.
struct Truth {
    IlluminationMap sum;
    double runs = 0, square = 0;  // of the mean
    double stated = 0;            // mean square of the runs' errors
};
inline Truth truth_of(const Room& room, const Runs& runs) {
    Truth t{runs.maps[0], double(runs.maps.size()), 0, mean_square(runs.stated)};
    for (size_t r = 1; r < runs.maps.size(); ++r)
        for (size_t v = 0; v < t.sum.size(); ++v) t.sum[v] += runs.maps[r][v];
    t.square = square_of(room.mesh, t.sum) / (t.runs * t.runs);
    return t;
}

// Relative distances to the mean of the reference's runs, whose own error is taken off in squares;
// a run that is one of them is left out of its own reference.
inline std::vector<double> true_errors(const Room& room, const Runs& runs, const Truth& truth,
                                       bool own) {
    std::vector<double> errors;
    const double n = truth.runs - own;
    for (const IlluminationMap& map : runs.maps) {
        IlluminationMap off = own ? difference(truth.sum, map) : truth.sum;
        for (size_t v = 0; v < off.size(); ++v) off[v] = off[v] / real(n) - map[v];
        const double square = square_of(room.mesh, off) / truth.square - truth.stated / n;
        errors.push_back(std::sqrt(std::max(0.0, square)));
    }
    return errors;
}

// One row of the table, and what is demanded of it.
struct Delivered {
    double asked = 0;
    Runs runs;  // without maps
    std::vector<double> errors;
    // More than the first look, before which no run ends.
    bool long_enough() const {
        const auto first = double(ErrorTarget::least * Particles::batches);
        return median(runs.particles) > 2 * first;
    }
    double over(double q) const { return quantile(errors, q) / asked; }
    bool kept() const {
        return over(0.5) <= 1 && (!long_enough() || (over(0.5) >= 0.95 && over(0.95) < 1.05));
    }
};

inline void tell(Report& report, const Room& room, const char* sampler, const Delivered& d) {
    const double ratio = std::sqrt(mean_square(d.errors) / mean_square(d.runs.stated));
    Moments of_run;
    for (size_t r = 0; r < d.errors.size(); ++r) of_run.add(d.errors[r] / d.runs.stated[r]);
    report.row({room.name, room.size(), sampler, percent(d.asked),
                text("%.3g", median(d.runs.particles)), seconds(median(d.runs.seconds)),
                text("%.2f %%", 100 * median(d.runs.uncertainty) / median(d.runs.stated)),
                text("%.3f", d.over(0.5)), text("%.3f", d.over(0.95)), text("%.3f", d.over(1)),
                text("%.3f ± %.3f", ratio, of_run.standard_error()), report.verdict(d.kept())});
}

// E from the smallest on: its runs are the reference of the others.
inline void tell_particles_of(Report& report, const Room& room, const std::vector<double>& asked,
                              int seeds) {
    std::optional<Truth> truth;
    auto row = [&](const char* name, SamplerKind kind, double error) {
        Delivered d{error, runs_of(room, kind, error, seeds), {}};
        const bool own = !truth;
        if (own) truth = truth_of(room, d.runs);
        d.errors = true_errors(room, d.runs, *truth, own);
        tell(report, room, name, d);
    };
    for (double error : asked) row("halton", SamplerKind::halton, error);
    if (room.name != "cornell36" || asked.size() < 3) return;
    row("independent", SamplerKind::independent, asked[1]);
    row("stratified", SamplerKind::stratified, asked[1]);
    row("sobol", SamplerKind::sobol, asked[1]);
}

inline void tell_particles(Report& report, const Extent& extent) {
    const int seeds = extent.quick ? 8 : 32;
    report.say(text(R"(## Particles

%d runs of each row, other seeds.  *True* errors are distances to the mean of the runs to the least E (a run
itself left out), whose own error is taken off in squares; both are quadratic means over all surfaces and
channels, relative to that of the light.  The run stops at the first look at which the error that its 16
batches tell, with 1.5 times its own standard error on top (*uncertainty*, a part of the error; the jackknife over the
batches), is at most E.  Looks are 4 %% of the particles apart or more, so that a run ends up to 2 %% below E.
*True over stated* is of quadratic means: 1, were it not that a run stops where its error looks small.
Demanded: a median of true over E in [0.95, 1] and 95 %% below 1.05; of runs that are hardly longer than the
first look, which comes at %.0f particles, only a median of at most 1.)",
                    seeds, double(ErrorTarget::least * Particles::batches)));
    report.head({"scene", "triangles", "sampler", "E", "particles", "seconds", "uncertainty",
                 "true/E: median", "95 %", "most", "true over stated", ""});
    for (const auto& [scene, least] : extent.places()) {
        std::vector<double> asked = {0.01, 0.03, 0.1};
        std::erase_if(asked, [&](double error) { return error < least; });
        tell_particles_of(report, room_of_part(scene, 12), asked, seeds);
    }
    if (!extent.quick)
        for (const auto& [scene, least] : extent.places())
            if (least < 0.1) tell_particles_of(report, room_of_part(scene, 32), {0.1}, seeds);
    report.end_of_table();
    report.say(
        "Left out, because 32 runs would take too long: 1 % of atelier, furnace and "
        "penumbra; 1 % and 3 % of lanterns.");
}

// ---- Shooting -----------------------------------------------------------------------------------

struct Stop {
    double asked = 0, stated = 0, unshot = 0, seconds = 0;
    IlluminationMap map;
};

// Runs by one method, each the continuation of the one before; the last is its limit.
inline std::vector<Stop> stops_of(const Room& room, Shooter shooter, double patience) {
    Shooting run(room.scene, room.mesh, shooter, all_cores());
    std::vector<Stop> stops;
    for (double error : {0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 1e-4}) {
        run.run({0, patience, 0, error}, [](const Shooting&) {});
        if (run.error() > error && !stops.empty()) break;  // its last shot is cut short
        stops.push_back({error, run.error(), run.unshot(), run.seconds(), run.map()});
        if (run.error() > error) break;
    }
    return stops;
}

inline std::string range(double least, double most) {
    return text("%.2g", least) + "–" + text("%.2g", most);
}

inline void tell_shooting_of(Report& report, const Room& room, Shooter shooter, double patience) {
    const std::vector<Stop> stops = stops_of(room, shooter, patience);
    const Stop& limit = stops.back();
    const double whole = square_of(room.mesh, limit.map);
    double least_k = HUGE_VAL, most_k = 0, least_u = HUGE_VAL, most_u = 0, worst = 0;
    std::vector<std::string> over(3), after(3);
    for (const Stop& s : stops) {
        if (s.asked < 10 * limit.stated) break;  // its distance to the limit says nothing
        // What the limit itself may lack counts as error.
        const double distance =
            std::sqrt(square_of(room.mesh, difference(limit.map, s.map)) / whole) + limit.stated;
        least_k = std::min(least_k, distance / s.stated);
        most_k = std::max(most_k, distance / s.stated);
        least_u = std::min(least_u, distance / s.unshot);
        most_u = std::max(most_u, distance / s.unshot);
        worst = std::max(worst, distance / s.asked);
        for (size_t k = 0; k < 3; ++k)
            if (s.asked == std::array{0.1, 0.03, 0.01}[k])
                over[k] = text("%.2f", distance / s.asked), after[k] = seconds(s.seconds);
    }
    if (most_k == 0) {
        report.row({room.name, room.size(), shooter == Shooter::face ? "hierarchy" : "shooting",
                    text("not below %s in %s", percent(limit.stated), seconds(limit.seconds)), "",
                    "", "", "", "", "", "", ""});
        return;
    }
    report.row({room.name, room.size(), shooter == Shooter::face ? "hierarchy" : "shooting",
                over[0], over[1], over[2], after[0], after[1], after[2], range(least_k, most_k),
                range(least_u, most_u), report.verdict(worst <= 1)});
}

inline void tell_shooting(Report& report, const Extent& extent) {
    report.say(R"(## Shooting and hierarchy

What is missing is F U + F ρ F U + ..., U the exitance that is not yet sent, F its transport to all surfaces.
F has a symmetric kernel and nobody sees more than a hemisphere, so F makes no quadratic mean larger (Schur's
test), and what is missing is at most b = ‖U‖ / (1 − ρ), ρ the greatest reflectance; a run states
b / √(‖E‖² + b²), which is 1 before the first shot.  *True* is the distance to the same run's limit: to a
statement of 0.01 %, or to what a minute allows; that is added to the distance, and cells of less than ten
times as much are empty.  *k* is true over stated: the proportionality of Khodulev (1996, ch. 5), over the
whole run from 50 % on; beside it the same over what is unshot, which is no such factor.)");
    report.head({"scene", "triangles", "method", "true/E: 10 %", "3 %", "1 %", "seconds: 10 %",
                 "3 %", "1 %", "k", "true over unshot", ""});
    const double patience = extent.quick ? 5 : 60;
    for (const auto& [scene, least] : extent.places())
        for (int parts : {8, 16}) {
            const Room room = room_of_part(scene, parts);
            for (Shooter shooter : {Shooter::face, Shooter::element})
                tell_shooting_of(report, room, shooter, patience);
        }
    report.end_of_table();
}

// ---- The section --------------------------------------------------------------------------------

inline void tell_maps(Report& report, const Extent& extent) {
    tell_particles(report, extent);
    tell_shooting(report, extent);
}

}  // namespace illumination::calibration

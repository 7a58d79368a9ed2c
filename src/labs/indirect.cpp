// labs/indirect.cpp  6  what illumination maps bring to paths that end on them
//
//   build/indirect [--quick]
//
// Final gathering, control and regression beside whole paths: when paths should go on, by variance
// and cost of a sample, with the bound of two levels; how fine maps should be; and errors after
// five seconds, noise and bias apart.
#include "labs/indirect_images.h"

namespace {

using namespace indirect;
using illumination::percent;

struct Scope {
    bool quick = false;
    double seconds() const { return quick ? 0.5 : 5; }
    double reference_seconds() const { return quick ? 0.5 : 6; }
};

constexpr const char* scenes[] = {"cornell36", "cube", "atelier"};
constexpr Method methods[] = {Method::path, Method::gather, Method::control_variate,
                              Method::regression, Method::endless};

// ---- Errors -------------------------------------------------------------------------------------

// Two runs that have nothing in common but what is asked for.
struct Pair {
    std::array<Drawn, 2> run;
    double core_seconds() const { return (run[0].core_seconds + run[1].core_seconds) / 2; }
    double samples() const { return (run[0].samples + run[1].samples) / 2; }
};

Pair pair_of(const Asked& asked, uint64_t first_seed) {
    return {draw(asked, first_seed), draw(asked, first_seed + 1)};
}

// Squares, relative to the reference's mean square.  The noise is half of the squared difference of
// two runs; the bias is what both have, each against a reference of its own, so that the product of
// the two differences has no noise in its mean.
struct Error {
    double noise2 = 0, bias2 = 0, bias2_error = 0;  // its standard error
    double d_rel() const { return std::sqrt(noise2 + std::max(0.0, bias2)); }
    std::string bias() const {
        const double most = std::sqrt(std::max(0.0, bias2) + 2 * bias2_error);
        return bias2 > 2 * bias2_error ? percent(std::sqrt(bias2)) : "< " + percent(most);
    }
};

Error error_of(const Pair& pair, const Pair& reference) {
    double norm = 0;
    Moments noise, bias;
    const auto &a = pair.run[0].image.pixels, &b = pair.run[1].image.pixels,
               &f = reference.run[0].image.pixels, &g = reference.run[1].image.pixels;
    for (size_t i = 0; i < a.size(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double x = double(a[i][c]), y = double(b[i][c]), u = double(f[i][c]),
                         v = double(g[i][c]);
            noise.add((x - y) * (x - y) / 2);
            bias.add((x - u) * (y - v));
            norm += u * v;
        }
    norm /= double(noise.n);
    return {noise.mean / norm, bias.mean / norm, bias.standard_error() / norm};
}

Pair reference_of(const Scope& plan, const std::string& scene, Size size) {
    return pair_of({scene, Method::control_variate, plan.reference_seconds(), 0, 0, 0, size}, 1001);
}

// ---- When to go on ------------------------------------------------------------------------------

void tell_levels(Report& report, const Scope& plan) {
    report.say(R"(## When to go on

Variance (the mean over pixels and channels) and core time of one sample; efficiency is 1 / (variance × time)
over that of whole paths, scattered as often as the scene says; medians of interleaved rounds, with the
least and the greatest.  Sobol': of the mean of 16 samples, times 16.  At the first vertex alone there are
two levels, what the map knows (v₁, c₁) and what whole paths add to it (v₂ = v − v₁, c₂ = c − c₁): as long
as these do not depend on q, none does better than (√(v₁c₁) + √(v₂c₂))².)");
    const int rounds = plan.quick ? 2 : 5;
    for (const char* scene : scenes) {
        const Setup s = setup(scene, 300000);
        const Levels independent = levels_of(s, SamplerKind::independent, rounds),
                     sobol = levels_of(s, SamplerKind::sobol, rounds);
        report.head({scene, "variance over whole paths'", "time over whole paths'", "efficiency",
                     "efficiency, Sobol'"});
        for (size_t w = 0; w < std::size(ways); ++w)
            report.row({ways[w].name, text("%.2f", median(independent.ratio(w, &Level::variance))),
                        text("%.2f", median(independent.ratio(w, &Level::seconds))),
                        with_range(independent.efficiency(w), "%.2f"),
                        with_range(sobol.efficiency(w), "%.2f")});
        report.end_of_table();
        const double bound = median(sobol.bound()), own = median(sobol.efficiency(control));
        report.claim(
            own >= 0.8 * bound,
            text("Two levels come to %s, with Sobol' points to %s; `control`, at every vertex, "
                 "comes to %.2f, at least .8 of it",
                 with_range(independent.bound(), "%.2f"), with_range(sobol.bound(), "%.2f"), own));
    }
    report.say(
        R"(Where a path goes on by a fixed q that is less than the square of the albedo, the products 1 / q grow
faster than light is lost, and variance has no bound; a rule that follows the throughput has none of this.
`control` takes a threshold of 2/3: of walls whose albedo is that or more nearly every path goes on once,
then as often as light is not absorbed.  Two levels gain where variance and cost are spread unevenly over
them; whole paths that Russian roulette ends in the dim spend on what follows the first bounce about as
much, for its variance, as the map spends on its own, where the gain is 1.  In cube more is to be had, at
the first vertex, too: survivors count for 1 / q, so that roulette, which returns 0 there, ends them later.)");
}

// ---- How fine -----------------------------------------------------------------------------------

void tell_meshes(Report& report, const Scope& plan) {
    const std::string scene = "cornell36";
    const Size size = {64, 32};
    const Pair reference = reference_of(plan, scene, size);
    const double diagonal = 16 * reference.run[0].H;
    report.say(R"(## How fine, how many particles

The bias of `map` on cornell36, 64 × 32 pixels: what two runs have in common against independent references
by `control`.  The noise of maps is no part of it; it is told apart as what both seeds' maps differ by,
together with that of the paths.  H is a part of the scene's diagonal.)");
    report.head({"H", "triangles", "particles", "seconds of maps", "error that they report", "bias",
                 "noise of maps and paths"});
    for (double part : {8.0, 16.0, 32.0, 64.0})
        for (uint64_t particles : {30000, 100000, 300000, 1000000}) {
            const Pair p = pair_of({scene, Method::gather, 0, plan.quick ? 64u : 1024u,
                                    diagonal / part, particles, size},
                                   1);
            const Error e = error_of(p, reference);
            const Drawn& run = p.run[0];
            report.row({text("1/%.0f", part), text("%.0f", run.triangles),
                        std::to_string(particles), text("%.2f", run.map_seconds),
                        percent(run.map_error), e.bias(), percent(std::sqrt(e.noise2))});
        }
    report.end_of_table();
}

// ---- After five seconds -------------------------------------------------------------------------

struct Measured {
    Pair pair;
    Error error;
    double product() const { return error.d_rel() * error.d_rel() * pair.core_seconds(); }
};

Measured measure(const std::string& scene, Method method, double seconds, const Pair& reference) {
    Pair pair = pair_of({scene, method, seconds}, 1);
    const Error error = error_of(pair, reference);
    return {std::move(pair), error};
}

void row_of(Report& report, const std::string& scene, Method method, const Measured& m,
            const Measured& path) {
    const Drawn& run = m.pair.run[0];
    const bool maps = run.triangles > 0;
    const char* stated = run.bias == "unbiased" ? "" : ", biased";
    report.row({scene, text("`%s`%s", method_names[int(method)], stated),
                text("%.0f", m.pair.samples()), text("%.1f", m.pair.core_seconds()),
                maps ? text("%.2f", run.map_seconds) : "", maps ? percent(run.map_error) : "",
                percent(m.error.d_rel()), percent(std::sqrt(m.error.noise2)), m.error.bias(),
                text("%.2f", path.product() / m.product())});
}

// Points of a list about one scene, by all methods.
std::string claims_of(Report& report, const std::string& scene, const std::vector<Measured>& all) {
    auto times = [&](size_t k, size_t over) { return all[over].product() / all[k].product(); };
    auto unseen = [&](size_t k) { return all[k].error.bias2 < 5 * all[k].error.bias2_error; };
    return text("* %s: `map` has 3 times the efficiency of whole paths or more (%.1f): %s.\n",
                scene, times(1, 0), report.verdict(times(1, 0) >= 3)) +
           text(
               "* %s: `control` has %.2f times that of whole paths, and %.2f times that of whole "
               "paths without Russian roulette.\n",
               scene, times(2, 0), times(2, 4)) +
           text("* %s: no bias of `control` or `regression` is seen: %s.", scene,
                report.verdict(unseen(2) && unseen(3)));
}

// Returns what was measured of the first scene.
std::pair<std::vector<Measured>, Pair> tell_errors(Report& report, const Scope& plan) {
    report.say(text(R"(## After %g seconds

%g seconds, all cores, Sobol' points, maps included, 256 × 128 pixels: errors against two references by
`control`; noise from two seeds, bias as above (of whole paths, what the scene's depth leaves out).
Efficiency is 1 / (d_rel² × core seconds), over that of whole paths.)",
                    plan.seconds(), plan.seconds()));
    report.head({"scene", "paths", "samples", "core s", "s of maps", "their error", "d_rel",
                 "noise", "bias", "efficiency"});
    std::vector<std::string> claims;
    std::optional<std::pair<std::vector<Measured>, Pair>> first;
    for (const char* scene : scenes) {
        Pair reference = reference_of(plan, scene, {});
        std::vector<Measured> all;
        for (Method method : methods) {
            all.push_back(measure(scene, method, plan.seconds(), reference));
            row_of(report, scene, method, all.back(), all[0]);
        }
        claims.push_back(claims_of(report, scene, all));
        if (!first) first.emplace(std::move(all), std::move(reference));
    }
    report.end_of_table();
    for (const std::string& words : claims) report.say(words);
    return *first;
}

// Errors on cornell36 over core seconds, and what is seen after the shortest of these times.
void tell_times(Report& report, const std::vector<Measured>& longest, const Pair& reference) {
    Svg sheet(860, 400);
    std::vector<Picture> pictures;
    {
        Plot plot(sheet, {80, 40}, {560, 300}, {"core seconds", 0.3, 15},
                  {"error (d_rel)", 0.005, 0.5}, "cornell36, 256 × 128 pixels");
        for (size_t k = 0; k < 4; ++k) {  // all but the last
            std::vector<double> x, y;
            for (double seconds : {0.3, 1.2}) {
                const Measured m = measure("cornell36", methods[k], seconds, reference);
                x.push_back(m.pair.core_seconds()), y.push_back(m.error.d_rel());
                const Drawn& r = m.pair.run[0];
                if (x.size() == 1 && k < 2)
                    pictures.push_back({r.image, method_names[k],
                                        text("%.0f samples, %.2f core s, d_rel %s", r.samples,
                                             r.core_seconds, percent(y[0]))});
            }
            x.push_back(longest[k].pair.core_seconds()), y.push_back(longest[k].error.d_rel());
            plot.curve(x, y, {.colour = svg::colours[k]}, method_names[k]);
        }
    }  // its labels are written
    report.picture("indirect-time", sheet, "Error over time");
    report.picture("indirect", contact_sheet(pictures, 2, 1), "After 0.3 seconds");
}

int study(const Scope& plan) {
    Report report(report_folder(plan.quick), "indirect");
    report.say(R"(# Paths that end on illumination maps

The light that diffuse surfaces reflect is known, but for noise and a mesh, once particles have filled
illumination maps: R_map = ρ E / π.  `map` (`build/radiosity --final-gather`) ends a path there after its first bounce (final
gathering), biased by the maps' error.  `control` lets Russian roulette decide whether the path goes on,
and returns R_map + [ξ < q] / q · (R̂ − R_map) (Szécsi, Szirmay-Kalos, Kelemen 2003): unbiased, whatever
the maps hold.  `regression` does the same with a multiple of R_map that other paths tell.  All three
scatter light without end, as the maps do, and render the scene of triangles that the maps lie on: where
these stand for balls, all three are biased.  Errors
are d_rel = √(1/N Σ(f−g)²) / √(1/N Σf²).)");
    const auto [of_cornell, reference] = tell_errors(report, plan);
    tell_times(report, of_cornell, reference);
    tell_levels(report, plan);
    tell_meshes(report, plan);
    report.say(made_by(plan.quick ? "build/indirect --quick" : "build/indirect"));
    return report.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Scope plan;
    const Lab lab{"indirect",
                  "Measures what illumination maps bring to paths that end on them.",
                  {quick_flag(plan.quick)}};
    return lab_main(argc, argv, lab, [&] { return study(plan); });
}

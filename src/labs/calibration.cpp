// labs/calibration.cpp  7  does --error E stop at an error of E?
//
//   build/calibration [--seeds N] [--least-seeds N] [--scene NAME] [--size WxH]
//                     [--quick] [--full]
//
// Stops runs of every scene and sampler as --error 10%, 3% and 1% would, looks how far their images
// are from the truth, tries other rules of stopping on the same runs, and measures what knowing the
// error costs.
#include "labs/calibration_report.h"

namespace {

// ---- The picture --------------------------------------------------------------------------------

// From the 5 % to the 95 % quantile of true d_rel / E, with the median, a line for each sampler and
// E; a panel for each scene.
Svg picture_of(const Effort& plan, const Results& all) {
    constexpr double width = 190, gap = 160, line = 14;
    const double height = line * double(plan.samplers.size() * plan.asked.size() + 1);
    constexpr size_t columns = 4;
    const size_t rows = (all.studies.size() + columns - 1) / columns;
    Svg sheet(gap + double(columns) * (width + gap), 20 + double(rows) * (height + 60));
    for (size_t s = 0; s < all.studies.size(); ++s) {
        const Place corner = {gap + double(s % columns) * (width + gap),
                              40 + double(s / columns) * (height + 60)};
        const Axis x{"true d_rel / E", 0, 2, false}, y{"", 0, height, false, {0}};
        Plot plot(sheet, corner, {width, height}, x, y,
                  all.studies[s].name + (all.studies[s].is_rare() ? " (rare light)" : ""));
        plot.curve({1, 1}, {0, height}, {.colour = svg::ink, .dots = false, .width = 1});
        plot.curve({1.05, 1.05}, {0, height},
                   {.colour = svg::frame, .dots = false, .dashed = true, .width = 1});
        double at = height;
        for (const Case& c : all.cases) {
            if (c.scene != s) continue;
            const size_t number = size_t(&c - all.cases.data()) % plan.samplers.size();
            for (size_t a = 0; a < plan.asked.size(); ++a) {
                at -= line;
                const Looks stops = stops_of(c.runs, stopper_number(a, 0));
                if (stops.empty()) continue;
                const std::vector<double> ratio =
                    each(stops, [&](const Look& l) { return l.true_d() / plan.asked[a]; });
                const char* colour = svg::colours[number + 1];
                plot.curve({quantile(ratio, 0.05), quantile(ratio, 0.95)}, {at, at},
                           {.colour = colour, .dots = false, .width = 3});
                plot.curve({median(ratio)}, {at}, {.colour = colour, .width = 0, .radius = 4},
                           text("%s, %g %%", c.sampler, 100 * plan.asked[a]));
            }
        }
    }
    return sheet;
}

// ---- All of it ----------------------------------------------------------------------------------

const char* const purpose = R"(# Does --error E stop at an error of E?

Every scene by every sampler, %dx%d pixels, stopped as `penumbra --error` stops: %.0f seeds at all E but
the last, %.0f of them at the last.  One run serves every E and every rule, each of which looks when it would
if it were alone.  The truth f is a run of its own by sobol, eight replications to a pixel, until its error is
%g %%, or it has %.0f samples each; its own error is known from the sets and taken off, for
E|f - g|² = d² + (error of f)².  True d_rel is over the quadratic mean of f.

Wanted: where E takes more than the %.0f samples that every run takes, a median of true d_rel / E in [0.95, 1]
and 95 %% of runs below 1.05; else a median of at most 1, and the 95 %%.  A scene is one of **rare light** if a single
pixel has more than a tenth of the squared error of f; such scenes stand apart.)";

const char* const columns =
    R"(*samples* and *core s* are medians; *median*, *95 %*, *> 1.05* and *s.d.* (over the
mean) are of true d_rel / E at the stop.  What limits the s.d.: *of the truth*, how true d_rel itself varies
between seeds at a number of samples that nobody chose by looking (8, 32, 128 ..., the last below the median
stop), and *of the estimate*, how d_rel as estimated varies there; *as stated* is the standard error that the
estimate says of itself, over d_rel.)";

void tell(Report& report, const Effort& plan, const Results& all) {
    report.say(text(purpose, plan.size.width, plan.size.height, double(plan.seeds),
                    double(std::min(plan.seeds, plan.least_seeds)), 100 * plan.truth_error,
                    double(plan.truth_most), double(first_look)));
    report.picture("calibration", picture_of(plan, all),
                   "true d_rel / E: 5 % to 95 %, and the median");
    report.say("## The truth");
    report.head({"scene", "samples a replication", "its error", "of it from one pixel", ""});
    for (const Study& s : all.studies)
        report.row({s.name, text("%.0f", double(s.samples)), text("%.3f %%", 100 * s.own_error()),
                    text("%.1f %%", 100 * s.greatest), s.is_rare() ? "rare light" : ""});
    report.end_of_table();
    for (bool rare : {false, true}) {
        report.say(rare ? "## Scenes of rare light" : "## Every scene but those of rare light");
        if (!rare) report.say(columns);
        tell_cases(report, plan, all, rare);
        report.say("Other rules of stopping on the same runs, all samplers together:");
        tell_guards(report, plan, all, rare);
        report.say(
            "The estimate of d² against d² itself, geometric means over scenes and samplers:");
        tell_bias(report, plan, all, rare);
    }
}

int run(Effort plan, int argc, char** argv) {
    if (plan.scenes.empty()) plan.scenes = all_scenes();
    Report report(report_folder(plan.quick), "calibration");
    Results all;
    Steps steps(plan.scenes.size() * (plan.samplers.size() + 1) + 1);
    for (const std::string& name : plan.scenes) {
        steps.next(name);
        all.studies.push_back(study(name, plan.size, plan.truth_error, plan.truth_most));
        for (const std::string& sampler : plan.samplers) {
            steps.next(name + " by " + sampler);
            all.cases.push_back(runs_in(plan, all.studies.back(), all.studies.size() - 1, sampler));
        }
    }
    tell(report, plan, all);
    steps.next("sets");
    report.say(text(R"(## What it costs to know the error

How many times the squared error of one replication, which knows nothing of its error, is that of several, **at
equal work**: at as many samples *in all*, in the mean of pixels, each counted by its pixel's rays.  By sobol; geometric
means over scenes, ± standard errors over seeds (jackknife).  Replications have 1, 2, 4 ... samples; between them the
error is a power of samples.  *by noise* is what penumbra does, factor 3.5 and at most 16 chosen by a pilot of %.0f
samples; below it one constant at a time is changed.)",
                    double(pilot_samples)));
    tell_sets(report, all.studies, plan.sets_seeds, plan.counts);
    report.say(made_by(argc, argv));
    return report.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Effort plan;
    const Lab lab{
        "calibration",
        "Compares the error at which --error stops with the error that was asked for.",
        {{"--seeds", "N", "runs of each (64)",
          [&](auto& n) { plan.seeds = parse_count(n, 3, 10000); }},
         {"--least-seeds", "N", "of them, to the last E (16)",
          [&](auto& n) { plan.least_seeds = parse_count(n, 3, 10000); }},
         {"--scene", "NAME", "only this one; may be repeated, writes into out/",
          [&](auto& name) { plan.quick = true, plan.scenes.push_back(name); }},
         {"--size", "WxH", "of the images (64x32); writes into out/",
          [&](auto& words) {
              const auto [width, height] = parts_of(words, 'x', "WIDTHxHEIGHT");
              plan.quick = true, plan.size = parse_size(width, height);
          }},
         {"--quick", "", "fewer runs, into out/",
          [&](auto&) {
              plan.quick = true, plan.seeds = 8, plan.least_seeds = 3, plan.sets_seeds = 3;
              plan.truth_most = 512, plan.counts = 16, plan.asked = {0.1, 0.03};
          }},
         {"--full", "", "all seeds to the last E", [&](auto&) { plan.least_seeds = plan.seeds; }}}};
    return lab_main(argc, argv, lab, [&] { return run(plan, argc, argv); });
}

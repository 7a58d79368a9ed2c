// labs/calibration_report.h  6  tables of runs that --error stopped, beside other rules of stopping
#pragma once
#include <map>

#include "labs/calibration_sets.h"

struct Effort {
    bool quick = false;
    Size size = {64, 32};
    uint64_t seeds = 64, least_seeds = 16, sets_seeds = 8, most = 8192, truth_most = 4096;
    double truth_error = 0.002;
    double counts = 128;  // the greatest of them
    std::vector<double> asked = {0.1, 0.03, 0.01};
    std::vector<std::string> scenes = {}, samplers = {"independent", "halton", "sobol"};
};

inline const std::map<std::string, SamplerKind> samplers = {
    {"independent", SamplerKind::independent},
    {"halton", SamplerKind::halton},
    {"sobol", SamplerKind::sobol}};

// The rule first, then what might take its place.
inline const std::vector<Guard> guards = {
    {"as it is"},
    {"no margin", 0},
    {"a whole standard error", 1},
    {"no pixel that is not seen", margin_of_error, -1},
    {"neither margin nor pixel", 0, -1},
    {"at least 32 samples", margin_of_error, 0, 32},
    {"at least 64 samples", margin_of_error, 0, 64},
    {"steps by the course", margin_of_error, 0, 0, true},
};

// ---- Runs ---------------------------------------------------------------------------------------

// Of a scene and a sampler.
struct Case {
    size_t scene;
    std::string sampler;
    std::vector<Run> runs;  // the first few went on to the last E
};

inline std::vector<Stopper> stoppers_for(const std::vector<double>& asked) {
    std::vector<Stopper> stoppers;
    for (double E : asked)
        for (const Guard& g : guards) stoppers.emplace_back(g, E, first_look);
    return stoppers;
}

// Some seeds go to the last E, the others only to the one before.
inline Case runs_in(const Effort& plan, const Study& study, size_t scene,
                    const std::string& sampler) {
    const std::vector<double> fewer(plan.asked.begin(), plan.asked.end() - 1);
    auto until = [&](uint64_t k) {
        return run_until(study, samplers.at(sampler), k + 1,
                         stoppers_for(k < plan.least_seeds ? plan.asked : fewer), plan.most);
    };
    Case c{scene, sampler, over_threads<Run>(plan.seeds, until)};
    for (Run& r : c.runs) r.stops.resize(plan.asked.size() * guards.size());
    return c;
}

// One number of a run towards one E with one guard.
inline size_t stopper_number(size_t asked, size_t guard) { return asked * guards.size() + guard; }

// How many runs were asked for it.
inline uint64_t runs_asked(const Effort& plan, size_t asked) {
    return asked + 1 == plan.asked.size() ? std::min(plan.seeds, plan.least_seeds) : plan.seeds;
}

// ---- The report ---------------------------------------------------------------------------------

struct Results {
    std::vector<Study> studies;
    std::vector<Case> cases;
};

inline void tell_case(Report& report, const Effort& plan, const Case& c, const Study& study) {
    for (size_t a = 0; a < plan.asked.size(); ++a) {
        const Looks stops = stops_of(c.runs, stopper_number(a, 0));
        const uint64_t unreached = runs_asked(plan, a) - stops.size();
        std::vector<std::string> cells = {study.name, c.sampler, text("%g %%", 100 * plan.asked[a]),
                                          text("%zu", stops.size())};
        if (unreached) cells.back() += text(" (%zu not)", size_t(unreached));
        if (stops.size() < 3) {
            cells.resize(13, "–");
            cells.push_back("not reached");
            report.row(cells);
            continue;
        }
        const Kept k = kept(stops, plan.asked[a]);
        uint64_t before = first_look;
        while (4 * double(before) <= k.samples && !at_fixed(c.runs, 4 * before).empty())
            before *= 4;
        const Looks fixed = at_fixed(c.runs, before);
        const double truth = scatter(each(fixed, [](const Look&l) { return l.true_d(); })),
                     told = scatter(each(fixed, [](const Look&l) { return l.estimated_d(); }));
        const bool is_known = study.own_error() < plan.asked[a] / 2;
        const std::string verdict = unreached  ? "not reached by all"
                                    : is_known ? k.verdict()
                                               : "the truth is not known so well";
        for (const std::string& cell :
             {text("%.0f", k.samples), text("%.2f", k.seconds), text("%.3f", k.median),
              text("%.3f", k.high), text("%.0f %%", 100 * k.above), text("%.3f", k.scatter),
              text("%.3f", truth), text("%.3f", told), text("%.3f", k.stated), verdict})
            cells.push_back(cell);
        report.row(cells);
    }
}

inline void tell_cases(Report& report, const Effort& plan, const Results& all, bool rare) {
    report.head({"scene", "sampler", "E", "runs", "samples", "core s", "median", "95 %", "> 1.05",
                 "s.d.", "of the truth", "of the estimate", "as stated", ""});
    for (const Case& c : all.cases)
        if (all.studies[c.scene].is_rare() == rare)
            tell_case(report, plan, c, all.studies[c.scene]);
    report.end_of_table();
}

// Over the cases of one sort that a guard stopped.
inline void tell_guards(Report& report, const Effort& plan, const Results& all, bool rare) {
    report.head({"rule", "E", "cases", "median of medians", "95 % of all", "> 1.05", "samples, ×"});
    for (size_t g = 0; g < guards.size(); ++g)
        for (size_t a = 0; a < plan.asked.size(); ++a) {
            std::vector<double> ratios, medians;
            double log_samples = 0;
            for (const Case& c : all.cases) {
                if (all.studies[c.scene].is_rare() != rare) continue;
                const Looks stops = stops_of(c.runs, stopper_number(a, g)),
                            now = stops_of(c.runs, stopper_number(a, 0));
                if (stops.size() < 3 || now.size() < 3) continue;
                const std::vector<double> r =
                    each(stops, [&](const Look& l) { return l.true_d() / plan.asked[a]; });
                ratios.insert(ratios.end(), r.begin(), r.end());
                medians.push_back(median(r));
                log_samples +=
                    std::log(kept(stops, plan.asked[a]).samples / kept(now, plan.asked[a]).samples);
            }
            if (medians.empty()) continue;
            report.row({guards[g].name, text("%g %%", 100 * plan.asked[a]),
                        text("%zu", medians.size()), text("%.3f", median(medians)),
                        text("%.3f", quantile(ratios, 0.95)),
                        text("%.1f %%", 100 * share_above(ratios, 1.05)),
                        text("%.2f", std::exp(log_samples / double(medians.size())))});
        }
    report.end_of_table();
}

// Estimate against truth: where a look stopped a run, and where nobody looked first.
inline void tell_bias(Report& report, const Effort& plan, const Results& all, bool rare) {
    report.head({"at", "cases", "estimate² / truth²", "±"});
    auto row = [&](const std::string& where, auto looks_of) {
        Moments m;
        double errors = 0;
        for (const Case& c : all.cases) {
            const Looks looks = looks_of(c);
            if (all.studies[c.scene].is_rare() != rare || looks.size() < 8) continue;
            const Bias b = bias_of(looks);
            if (!(b.ratio > 0)) continue;
            m.add(std::log(b.ratio)), errors += std::pow(b.error / b.ratio, 2);
        }
        if (m.n == 0) return;
        const double ratio = std::exp(m.mean);
        report.row({where, text("%.0f", double(m.n)), text("%.3f", ratio),
                    text("%.3f", ratio * std::sqrt(errors) / double(m.n))});
    };
    for (uint64_t n : {8, 32, 128, 512})
        row(text("%.0f samples", double(n)), [&](const Case& c) { return at_fixed(c.runs, n); });
    for (size_t a = 0; a < plan.asked.size(); ++a)
        row(text("a stop at %g %%", 100 * plan.asked[a]), [&](const Case& c) {
            Looks stops = stops_of(c.runs, stopper_number(a, 0));
            std::erase_if(stops, [](const Look& l) { return l.samples <= first_look; });
            return stops;
        });
    report.end_of_table();
}

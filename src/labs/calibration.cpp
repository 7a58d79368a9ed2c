// labs/calibration.cpp  6  penumbra's error estimates, compared with true errors
//
//   build/calibration [--seeds N] [--error-seeds N] [--scene PART] [--quick] [--kept]
#include "labs/calibration.h"
#include "labs/grid.h"

namespace {

using namespace calibration;

constexpr const char* sets[] = {"ordinary", "hard", "blind ordinary", "blind hard"};
const std::vector<std::string> counts = {"--spp 16", "--spp 32", "--spp 64", "--spp 256"},
                               errors = {"--error 10% --time 10", "--error 5% --time 10",
                                         "--error 3% --time 10", "--error 1% --time 10"};
const std::string more[] = {"--spp 1024", "--spp 4096"};  // for hard scenes only

struct Effort {
    uint64_t seeds = 10, error_seeds = 10, truth = 16384;
    std::string part;  // selects scenes by a part of their names; "": all
};

bool is_hard(const Subject& s) { return set_of(s.name).ends_with("hard"); }

// The author of a blind scene assigns its set by the line "# class: hard".
std::vector<Subject> all_subjects(const Effort& plan) {
    std::vector<Subject> all;
    for (const char* folder : {"scenes/", "scenes/calibration/ordinary/",
                               "scenes/calibration/hard/", "scenes/calibration/blind/"})
        for (const std::string& name : scenes_in(folder)) {
            const std::string place = folder, file = place + name + ".scene";
            const bool blind = place.ends_with("blind/"),
                       hard = place.ends_with("hard/") || name == "extremes" ||
                              (blind && read_file(file).find("# class: hard") != std::string::npos);
            Subject s{(blind ? "blind " : "") + std::string(hard ? "hard/" : "ordinary/") + name,
                      file + " --size 64x32", std::max<uint64_t>(plan.truth / (hard ? 1 : 4), 1)};
            if (s.name.find(plan.part) != std::string::npos) all.push_back(s);
        }
    if (all.empty()) throw UserError("--scene: no scene has this in its name");
    return all;
}

Rows all_rows(RenderGrid& grid, const std::vector<Subject>& subjects, const Effort& plan) {
    std::vector<Subject> hard;
    std::copy_if(subjects.begin(), subjects.end(), std::back_inserter(hard), is_hard);
    Rows rows;
    auto add = [&](const std::vector<Subject>& which, const std::vector<std::string>& all,
                   uint64_t seeds) {
        std::vector<Setting> settings;
        for (const std::string& words : all) settings.push_back({words, words});
        append(rows, grid.run(which, settings, {0}, seeds));
    };
    add(subjects, counts, plan.seeds), add(subjects, errors, plan.error_seeds);
    add(hard, {more[0]}, plan.seeds), add(hard, {more[1]}, plan.error_seeds);
    return rows;
}

// ---- Report -------------------------------------------------------------------------------------

// Rows of a set: all runs of the study, runs that --error ends, and runs with more samples.
struct Sample {
    Rows plain, asked, longer;
};

bool is_among(const std::vector<std::string>& words, const Row& r) {
    return std::find(words.begin(), words.end(), r.setting) != words.end();
}

Sample sample_of(const Rows& rows) {
    const Rows asked = where(rows, [](const Row& r) { return is_among(errors, r); });
    Rows plain = where(rows, [](const Row& r) { return is_among(counts, r); });
    append(plain, asked);
    return {plain, asked,
            where(rows, [](const Row& r) { return r.setting == more[0] || r.setting == more[1]; })};
}

std::string percent_of(double part) { return std::isnan(part) ? "–" : text("%.1f %%", 100 * part); }
std::string number_of(double x) { return std::isnan(x) ? "–" : text("%.2f", x); }

std::vector<double> over_asked(const Rows& asked) {
    std::vector<double> x;
    for (const Row& r : asked)
        if (is_reached(r) && is_known(r)) x.push_back(true_d(r) / asked_in(r.setting));
    return x;
}

bool is_needless(const Row& r) {
    return is_hinted(r) && verdict(r, by_spread(r)) == Verdict::right;
}

struct Measure {
    const char* what;
    std::string (*of)(const Sample&);
    const char* aim;
};

const Measure measures[] = {
    {"runs", [](const Sample& s) { return text("%zu", s.plain.size()); }, ""},
    {"left out below: the true error is not known",
     [](const Sample& s) { return text("%zu", s.plain.size() - where(s.plain, is_known).size()); },
     ""},
    {"the spread of replications understates by more than 2",
     [](const Sample& s) {
         return percent_of(share(
             s.plain, [](const Row& r) { return verdict(r, by_spread(r)) == Verdict::too_low; }));
     },
     ""},
    {"understated by more than 2, and no hint",
     [](const Sample& s) { return percent_of(share(s.plain, is_understated)); }, "≤ 1 %"},
    {"a hint that the error is not known",
     [](const Sample& s) { return percent_of(share(s.plain, is_hinted)); }, ""},
    {"a hint, though the spread was right within 2",
     [](const Sample& s) { return percent_of(share(s.plain, is_needless)); }, "≤ 2 %, ordinary"},
    {"stated over the spread's statement, median",
     [](const Sample& s) {
         std::vector<double> x;
         for (const Row& r : s.plain)
             if (!is_hinted(r)) x.push_back(r["d_rel"] / by_spread(r));
         return number_of(median(x));
     },
     "≤ 1.05, ordinary"},
    {"64 times the samples: an error is stated, and right within 2",
     [](const Sample& s) {
         return percent_of(share(
             s.longer, [](const Row& r) { return verdict(r, r["d_rel"]) == Verdict::right; }));
     },
     "≥ 80 %, hard"},
    {"`--error`: reached within 10 s",
     [](const Sample& s) {
         return percent_of(double(where(s.asked, is_reached).size()) / double(s.asked.size()));
     },
     ""},
    {"`--error`: true over asked, median",
     [](const Sample& s) { return number_of(median(over_asked(s.asked))); }, "≤ 1"},
    {"`--error`: true over asked, 95 %",
     [](const Sample& s) { return number_of(quantile(over_asked(s.asked), 0.95)); }, "≤ 1.25"}};

std::string all_measures(const Rows& rows) {
    Lines lines;
    std::vector<Sample> samples;
    for (const char* set : sets)
        samples.push_back(
            sample_of(where(rows, [&](const Row& r) { return set_of(r.scene) == set; })));
    for (const Measure& m : measures) {
        lines.push_back({m.what});
        for (const Sample& s : samples) lines.back().push_back(s.plain.empty() ? "" : m.of(s));
        lines.back().push_back(m.aim);
    }
    return table({"64×32 pixels", sets[0], sets[1], sets[2], sets[3], "aim"}, lines);
}

int study(Scope scope, Effort plan) {
    if (scope.quick) plan.seeds = 2, plan.error_seeds = 1, plan.truth = 4096;
    scope.quick = scope.quick || !plan.part.empty();
    Page page(scope, "calibration");
    RenderGrid grid("calibration", scope.beside(), scope.kept);
    const Rows rows = all_rows(grid, all_subjects(plan), plan);
    page.set("table", all_measures(rows));
    page.data("calibration", csv_of(rows, {"d_rel", "d_rel_by_spread", "off", "own", "error"}));
    const std::vector<std::pair<std::string, uint64_t>> numbers = {
        {"seeds", plan.seeds}, {"error seeds", plan.error_seeds}, {"truth", plan.truth}};
    for (const auto& [word, n] : numbers) page.set(word, text("%.0f", double(n)));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Effort plan;
    auto count = [](uint64_t& n) {
        return [&n](const std::string& word) { n = parse_count(word, 1, 1000); };
    };
    const Lab lab{"calibration",
                  "Compares penumbra's error estimates with true errors.",
                  {{"--seeds", "N", "runs of each count of samples (10)", count(plan.seeds)},
                   {"--error-seeds", "N", "runs of each --error (10)", count(plan.error_seeds)},
                   {"--scene", "PART", "only scenes with PART in SET/NAME; writes to out/",
                    [&](auto& name) { plan.part = name; }}},
                  true};
    return experiment(argc, argv, lab, [&](const Scope& scope) { return study(scope, plan); });
}

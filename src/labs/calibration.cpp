// labs/calibration.cpp  6  the error that penumbra states, beside its true one
//
//   build/calibration [--seeds N] [--error-seeds N] [--scene PART] [--baseline PROGRAM]
//                     [--truth N] [--quick] [--kept]
#include "labs/calibration.h"
#include "labs/grid.h"

namespace {

using namespace calibration;

constexpr const char* sets[] = {"ordinary", "hard", "blind ordinary", "blind hard"};
const std::vector<std::string> counts = {"--spp 16", "--spp 32", "--spp 64", "--spp 256"},
                               errors = {"--error 10% --time 10", "--error 5% --time 10",
                                         "--error 3% --time 10", "--error 1% --time 10"};
const std::string more[] = {"--spp 1024", "--spp 4096"}, one_set = "--spp 64 --sets 1",
                  before = "before: ";  // by the program before

struct Effort {
    bool quick = false, kept = false;
    uint64_t seeds = 10, error_seeds = 10, truth = 16384;
    std::string baseline, part;  // part: of the names of scenes; "": all
};

bool is_hard(const Subject& s) { return set_of(s.name).ends_with("hard"); }

// Of a blind scene its author says the set: "# class: hard".
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
    std::vector<Subject> hard, others;
    for (const Subject& s : subjects) (is_hard(s) ? hard : others).push_back(s);
    auto settings = [](const std::vector<std::string>& words, const std::string& program = "") {
        std::vector<Setting> all;
        for (const std::string& w : words)
            all.push_back({(program.empty() ? "" : before) + w, w, program});
        return all;
    };
    Rows rows;
    auto add = [&](const std::vector<Subject>& which, const std::vector<Setting>& how,
                   uint64_t seeds) {
        const Rows some = grid.run(which, how, {0}, seeds);
        rows.insert(rows.end(), some.begin(), some.end());
    };
    add(subjects, settings(counts), plan.seeds);
    add(subjects, settings(errors), plan.error_seeds);
    add(hard, settings({more[0]}), plan.seeds);
    add(hard, settings({more[1]}), plan.error_seeds);
    add(others, settings({one_set}), plan.seeds);
    if (!plan.baseline.empty()) add(others, settings(errors, plan.baseline), plan.error_seeds);
    return rows;
}

// ---- The report ---------------------------------------------------------------------------------

// Rows of a set: those of the study; of --error; with more samples; all.
struct Sample {
    Rows plain, asked, longer, all;
};

bool is_among(const std::vector<std::string>& words, const Row& r) {
    return std::find(words.begin(), words.end(), r.setting) != words.end();
}

Sample sample_of(const Rows& rows) {
    const Rows asked = where(rows, [](const Row& r) { return is_among(errors, r); });
    Rows plain = where(rows, [](const Row& r) { return is_among(counts, r); });
    plain.insert(plain.end(), asked.begin(), asked.end());
    return {plain, asked,
            where(rows, [](const Row& r) { return r.setting == more[0] || r.setting == more[1]; }),
            rows};
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

// Samples of --error over those of the program before, by twins of one scene, words and seed.
double samples_over_before(const Rows& rows) {
    double sum = 0, n = 0;
    for (const Row& r : where(rows, is_reached))
        for (const Row& b : where(rows, is_reached))
            if (b.scene == r.scene && b.seed == r.seed && b.setting == before + r.setting)
                sum += std::log(r["samples_per_pixel"] / b["samples_per_pixel"]), ++n;
    return std::exp(sum / n);
}

// Of one replication, over those that know their error.
double cost_of_one(const Rows& rows) {
    return over(rows, one_set, counts[2],
                [](const Rows& r) { return mean(r, "d2") * mean(r, "rays"); });
}

std::string worst(const Rows& rows, bool (*which)(const Row&), double (*number)(const Row&)) {
    const auto all = worst_of(rows, which, number);
    if (all.empty()) return "";
    return text("%s: %zu of %zu, up to %.3g", all[0].scene.substr(all[0].scene.find('/') + 1),
                all[0].count, all[0].runs, all[0].most);
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
     [](const Sample& s) { return number_of(quantile(over_asked(s.asked), 0.95)); }, "≤ 1.25"},
    {"`--error`: samples over those of the program before",
     [](const Sample& s) { return number_of(samples_over_before(s.all)); }, "≤ 1.10, ordinary"},
    {"64 samples: cost of one replication over the default's",
     [](const Sample& s) { return number_of(cost_of_one(s.all)); }, ""},
    {"worst understatement without a hint: true over stated",
     [](const Sample& s) {
         return worst(s.plain, is_understated, [](const Row& r) { return true_d(r) / r["d_rel"]; });
     },
     ""},
    {"worst needless hint: true error",
     [](const Sample& s) { return worst(s.plain, is_needless, true_d); }, ""}};

std::string all_measures(const Rows& rows) {
    std::vector<std::vector<std::string>> lines;
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

// Medians of each scene and setting; an empty cell: not known.
std::string every_scene(const Rows& rows) {
    std::vector<std::vector<std::string>> lines;
    auto number = [](double x) { return std::isnan(x) ? "" : text("%.3g", x); };
    for (const auto& [scene, all] : grouped(rows, of_scene))
        for (const auto& [setting, some] : grouped(all, of_setting)) {
            std::vector<double> stated, true_ones;
            for (const Row& r : some) {
                if (!is_hinted(r)) stated.push_back(r["d_rel"]);
                if (is_known(r)) true_ones.push_back(true_d(r));
            }
            lines.push_back({scene, setting, text("%zu", some.size()), number(median(stated)),
                             number(median(true_ones)), number(some[0]["own"]),
                             text("%zu", where(some, is_hinted).size()),
                             text("%zu", where(some, is_understated).size())});
        }
    return csv(
        {"scene", "setting", "runs", "stated", "true", "reference's own", "hints", "understated"},
        lines);
}

int run(const Effort& plan, const std::string& program, const std::string& command) {
    Page page(report_folder(plan.quick), "calibration");
    RenderGrid grid("calibration", program, plan.kept);
    const Rows rows = all_rows(grid, all_subjects(plan), plan);
    page.set("table", all_measures(rows));
    page.data("calibration", every_scene(rows));
    const std::vector<std::pair<std::string, uint64_t>> numbers = {
        {"seeds", plan.seeds}, {"error seeds", plan.error_seeds}, {"truth", plan.truth}};
    for (const auto& [word, n] : numbers) page.set(word, text("%.0f", double(n)));
    page.set("made", made_by(command));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Effort plan;
    auto count = [](uint64_t& n, uint64_t most) {
        return [&n, most](const std::string& word) { n = parse_count(word, 1, most); };
    };
    const Lab lab{
        "calibration",
        "Compares the errors that penumbra states with true ones.",
        {{"--seeds", "N", "runs of each count of samples (10)", count(plan.seeds, 1000)},
         {"--error-seeds", "N", "runs of each --error (10)", count(plan.error_seeds, 1000)},
         {"--scene", "PART", "only those with PART in SET/NAME; writes into out/",
          [&](auto& name) { plan.quick = true, plan.part = name; }},
         {"--baseline", "PROGRAM", "a penumbra of before, whose samples are compared",
          [&](auto& name) { plan.baseline = name; }},
         {"--truth", "N", "samples of hard references (16384)", count(plan.truth, 1 << 20)},
         kept_flag(plan.kept),
         {"--quick", "", "two seeds, one of --error, references of a quarter, into out/",
          [&](auto&) {
              plan.quick = true, plan.seeds = 2, plan.error_seeds = 1, plan.truth = 4096;
          }}}};
    return lab_main(argc, argv, lab, [&] {
        return run(plan, renderer_beside(lab, argv[0]), command_of(argc, argv));
    });
}

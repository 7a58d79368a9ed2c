// labs/calibration.cpp  4  is the error that penumbra states its true error?
//
//   build/calibration [--seeds N] [--error-seeds N] [--scene PART] [--baseline PROGRAM]
//                     [--truth N] [--jobs N] [--quick]
//
// Runs build/penumbra on every scene of four sets, and looks how far its images are from references
// of many samples.  Runs that are done stand in out/calibration.rows, references in
// out/calibration/: a study that was cut short goes on.
#include <iterator>
#include <mutex>

#include "base/rng.h"
#include "labs/calibration.h"

namespace fs = std::filesystem;

namespace {

constexpr const char* sets[] = {"ordinary", "hard", "blind ordinary", "blind hard"};

struct Effort {
    bool quick = false;
    uint64_t seeds = 10, error_seeds = 10, truth = 16384, jobs = all_cores();
    std::string program, baseline, part;  // part: of the names of scenes; "": all
};

// ---- Scenes and their truth ---------------------------------------------------------------------

struct Study {
    std::string set, name, path;
    std::string print = {};  // of the scene and its reference
    Image truth = {};
    double own = 0, samples = 0, seconds = 0;
    bool is_hinted = false;

    bool is_hard() const { return set.ends_with("hard"); }
};

std::string fingerprint(const std::string& bytes) {
    uint64_t h = bytes.size();
    for (unsigned char c : bytes) h = hash(h, c);
    return text("%012.0f", double(h >> 25));
}

// Of a blind scene its author says the set: "# class: hard".
std::string set_of(const fs::path& path) {
    const std::string folder = path.parent_path().filename().string();
    if (folder == "blind")
        return read_file(path.string()).find("# class: hard") != std::string::npos
                   ? "blind hard"
                   : "blind ordinary";
    return folder == "hard" || path.stem() == "extremes" ? "hard" : "ordinary";
}

// But cornell36obj, which is cornell36 again.
std::vector<Study> all_studies(const Effort& plan) {
    std::vector<Study> studies;
    for (const char* folder :
         {"", "/calibration/ordinary", "/calibration/hard", "/calibration/blind"}) {
        const fs::path in = "scenes" + std::string(folder);
        if (!fs::exists(in)) continue;
        for (const auto& entry : fs::directory_iterator(in)) {
            const fs::path path = entry.path();
            const std::string set = set_of(path), name = set + "/" + path.stem().string();
            if (path.extension() == ".scene" && path.stem() != "cornell36obj" &&
                name.find(plan.part) != name.npos)
                studies.push_back({set, name, path.string()});
        }
    }
    std::sort(studies.begin(), studies.end(),
              [](const Study& a, const Study& b) { return a.name < b.name; });
    return studies;
}

// Renders STEM.pfm and STEM.json, which have these names when they are whole.
void render(const std::string& program, const Study& s, const std::string& words, uint64_t seed,
            const std::string& stem) {
    std::istringstream in("--size 64x32 --threads 1 --quiet " + words + " --seed " +
                          std::to_string(seed));
    std::vector<std::string> argv{std::istream_iterator<std::string>(in), {}};
    argv.insert(argv.begin(), program);
    argv.insert(argv.end(), {s.path, "-o", stem + ".new.pfm", "--stats", stem + ".new.json"});
    execute(argv);
    fs::rename(stem + ".new.json", stem + ".json");
    fs::rename(stem + ".new.pfm", stem + ".pfm");
}

// Hard scenes have all samples, others a quarter of them.  Sixteen replications everywhere: where
// one pixel has all of the error, two would not know it.
void find_truth(const Effort& plan, Study& s) {
    constexpr uint64_t other_seed = 1000000;
    const uint64_t n = s.is_hard() ? plan.truth : std::max<uint64_t>(plan.truth / 4, 1);
    const std::string words = text("--spp %.0f --sets 16", double(n)),
                      print = fingerprint(words + read_file(s.path));
    std::string stem = "out/calibration/" + s.name + "-" + print;
    std::replace(stem.begin() + 16, stem.end(), '/', '-');
    if (!fs::exists(stem + ".pfm")) render(plan.program, s, words, other_seed, stem);
    const Rendering r = read_rendering(stem + ".pfm");
    s.print = print, s.truth = r.image;
    s.own = by_spread_in(r.stats), s.samples = stats(r.stats, "samples_per_pixel")[0];
    s.seconds = r.core_seconds(), s.is_hinted = std::isnan(stated_in(r.stats));
}

// ---- Runs ---------------------------------------------------------------------------------------

struct Job {
    const Study* study;
    std::string words;
    uint64_t seed;
    std::string program, print;
};

const std::vector<std::string> counts = {"--spp 16", "--spp 32", "--spp 64", "--spp 256"},
                               errors = {"--error 10% --time 10", "--error 5% --time 10",
                                         "--error 3% --time 10", "--error 1% --time 10"},
                               more = {"--spp 1024", "--spp 4096"};  // 64 times 16, 64
const std::string one_set = "--spp 64 --sets 1";

bool is_among(const std::vector<std::string>& words, const Run& r) {
    return std::find(words.begin(), words.end(), r.words) != words.end();
}

std::vector<Job> all_jobs(const Effort& plan, const std::vector<Study>& studies) {
    std::vector<Job> jobs;
    auto add = [&](const Study& s, const std::vector<std::string>& words, uint64_t seeds,
                   const std::string& program) {
        const std::string print = fingerprint(read_file(program));
        for (const std::string& w : words)
            for (uint64_t seed = 1; seed <= seeds; ++seed)
                jobs.push_back({&s, w, seed, program, print});
    };
    for (const Study& s : studies) {
        add(s, counts, plan.seeds, plan.program);
        add(s, errors, plan.error_seeds, plan.program);
        if (!plan.baseline.empty() && !s.is_hard()) add(s, errors, plan.error_seeds, plan.baseline);
        if (s.is_hard()) add(s, {more[0]}, plan.seeds, plan.program);
        if (s.is_hard()) add(s, {more[1]}, plan.error_seeds, plan.program);
        if (!s.is_hard()) add(s, {one_set}, plan.seeds, plan.program);
    }
    // A study that is cut short has fewer seeds of all scenes.
    std::stable_sort(jobs.begin(), jobs.end(),
                     [](const Job& a, const Job& b) { return a.seed < b.seed; });
    return jobs;
}

Run run_job(const Job& job, const std::string& stem) {
    const Study& s = *job.study;
    render(job.program, s, job.words, job.seed, stem);
    const Rendering r = read_rendering(stem + ".pfm");
    for (const char* suffix : {".pfm", ".json"}) fs::remove(stem + suffix);
    return {s.name,
            job.words,
            job.seed,
            job.print,
            s.print,
            stated_in(r.stats),
            by_spread_in(r.stats),
            distance(s.truth, r.image),
            s.own,
            stats(r.stats, "samples_per_pixel")[0],
            stats(r.stats, "rays")[0],
            word_of(r.stats, "stopped_by")};
}

// What was asked for, from the file of rows or rendered now.
Runs all_runs(const Effort& plan, const std::vector<Job>& jobs) {
    using Key = std::tuple<std::string, std::string, uint64_t, std::string, std::string>;
    const std::string file = "out/calibration.rows";
    std::map<Key, Run> done;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
        if (const auto r = run_of(line))
            done[{r->scene, r->words, r->seed, r->program, r->truth}] = *r;
    Runs runs(jobs.size());
    std::vector<size_t> missing;
    for (size_t k = 0; k < jobs.size(); ++k) {
        const Job& j = jobs[k];
        const auto at = done.find({j.study->name, j.words, j.seed, j.print, j.study->print});
        if (at == done.end())
            missing.push_back(k);
        else
            runs[k] = at->second;
    }
    std::ofstream out(file, std::ios::app);
    std::mutex lock;
    Steps steps(missing.size());
    in_parallel(
        missing.size(), unsigned(plan.jobs),
        [&](size_t m) {
            const Job& j = jobs[missing[m]];
            const Run r = run_job(j, text("out/calibration/%d-%zu", int(::getpid()), m));
            const std::lock_guard guard(lock);
            steps.next(j.study->name + " " + j.words);
            runs[missing[m]] = r;
            out << line_of(r) << std::flush;
        },
        [](double) {});
    return runs;
}

// ---- The report ---------------------------------------------------------------------------------

// Runs of a set: those of the study, more samples, one set; and all of the program before.
struct Sample {
    Runs plain, asked, more, all, before;
};

struct Results {
    std::vector<Study> studies;
    Runs runs;
    std::string print, before;  // of the programs

    Sample of(const std::string& set) const {
        auto is_in = [&](const Run& r) { return r.scene.starts_with(set + "/"); };
        Sample s;
        s.all = those(runs, [&](const Run& r) { return is_in(r) && r.program == print; });
        s.plain =
            those(s.all, [](const Run& r) { return is_among(counts, r) || is_among(errors, r); });
        s.asked = those(s.plain, [](const Run& r) { return is_among(errors, r); });
        s.more = those(s.all, [](const Run& r) { return is_among(more, r); });
        s.before = those(runs, [&](const Run& r) { return is_in(r) && r.program == before; });
        return s;
    }
};

std::string percent_of(double part) { return std::isnan(part) ? "–" : text("%.1f %%", 100 * part); }
std::string number_of(double x) { return std::isnan(x) ? "–" : text("%.2f", x); }

std::vector<double> over_asked(const Runs& asked) {
    return each(those(asked, [](const Run& r) { return is_reached(r) && is_known(r); }),
                [](const Run& r) { return true_d(r) / asked_in(r.words); });
}

// One row of the table: what is measured, of each set, and what is wanted.
struct Measure {
    const char* what;
    std::string (*of)(const Sample&);
    const char* aim;
};

const Measure measures[] = {
    {"runs", [](const Sample& s) { return text("%zu", s.plain.size()); }, ""},
    {"runs whose truth is not known well enough; left out below",
     [](const Sample& s) { return text("%zu", s.plain.size() - those(s.plain, is_known).size()); },
     ""},
    {"understated by more than 2 by the spread of replications alone",
     [](const Sample& s) {
         return percent_of(share(
             s.plain, [](const Run& r) { return verdict(r, r.by_spread) == Verdict::too_low; }));
     },
     ""},
    {"understated by more than 2, and no hint",
     [](const Sample& s) { return percent_of(share(s.plain, is_understated)); }, "≤ 1 %"},
    {"a hint that the error is not known",
     [](const Sample& s) { return percent_of(share(s.plain, is_hinted)); }, ""},
    {"a hint, though the spread was right within 2",
     [](const Sample& s) {
         return percent_of(share(s.plain, [](const Run& r) {
             return is_hinted(r) && verdict(r, r.by_spread) == Verdict::right;
         }));
     },
     "≤ 2 %, ordinary"},
    {"stated over the spread's statement, median",
     [](const Sample& s) {
         return number_of(median(each(those(s.plain, std::not_fn(is_hinted)),
                                      [](const Run& r) { return r.stated / r.by_spread; })));
     },
     "≤ 1.05, ordinary"},
    {"64 times the samples: an error is stated, and right within 2",
     [](const Sample& s) {
         return percent_of(
             share(s.more, [](const Run& r) { return verdict(r, r.stated) == Verdict::right; }));
     },
     "≥ 80 %, hard"},
    {"--error: reached within 10 s",
     [](const Sample& s) {
         return percent_of(double(those(s.asked, is_reached).size()) / double(s.asked.size()));
     },
     ""},
    {"--error: true over asked, median",
     [](const Sample& s) { return number_of(median(over_asked(s.asked))); }, "≤ 1"},
    {"--error: true over asked, 95 %",
     [](const Sample& s) { return number_of(quantile(over_asked(s.asked), 0.95)); }, "≤ 1.25"},
    {"--error: samples over those of the program before",
     [](const Sample& s) {
         return number_of(
             geometric_mean(over_twins(those(s.asked, is_reached), those(s.before, is_reached),
                                       [](const Run& r) { return r.samples; })));
     },
     "≤ 1.10, ordinary"},
    {"64 samples: cost of one replication over that of those that know their error",
     [](const Sample& s) { return number_of(cost_over(s.all, one_set, counts[2])); }, ""},
};

std::string told(const std::vector<Worst>& worst, size_t k, const char* most) {
    if (k >= worst.size()) return "";
    const Worst& w = worst[k];
    return text("%s: %zu of %zu, up to ", w.scene.substr(w.scene.find('/') + 1), w.count, w.runs) +
           text(most, w.most);
}

void tell_table(Report& report, const Results& all) {
    std::vector<Sample> samples;
    for (const char* set : sets) samples.push_back(all.of(set));
    report.head({"64x32 pixels", sets[0], sets[1], sets[2], sets[3], "aim"});
    auto row = [&](const std::string& what, auto cell, const char* aim) {
        std::vector<std::string> cells = {what};
        for (const Sample& s : samples) cells.push_back(s.plain.empty() ? "" : cell(s));
        if (std::all_of(cells.begin() + 1, cells.end(), [](auto& c) { return c.empty(); })) return;
        cells.push_back(aim);
        report.row(cells);
    };
    for (const Measure& m : measures) row(m.what, m.of, m.aim);
    auto over_stated = [](const Run& r) { return true_d(r) / r.stated; };
    auto is_loose = [](const Run& r) {
        return is_reached(r) && is_known(r) && true_d(r) > 1.25 * asked_in(r.words);
    };
    auto over = [](const Run& r) { return true_d(r) / asked_in(r.words); };
    auto is_needless = [](const Run& r) {
        return is_hinted(r) && verdict(r, r.by_spread) == Verdict::right;
    };
    for (size_t k = 0; k < 3; ++k)
        row(
            text("worst: understated, and no hint; true over stated, %zu", k + 1),
            [&](const Sample& s) {
                return told(worst_of(s.plain, is_understated, over_stated), k, "%.3g");
            },
            "");
    for (size_t k = 0; k < 2; ++k)
        row(
            text("worst: --error missed by a quarter; true over asked, %zu", k + 1),
            [&](const Sample& s) { return told(worst_of(s.asked, is_loose, over), k, "%.3g"); },
            "");
    row(
        "worst: a needless hint; true d_rel",
        [&](const Sample& s) { return told(worst_of(s.plain, is_needless, true_d), 0, "%.3g"); },
        "");
    report.end_of_table();
}

// Stated and true, medians of the runs by these words; "?": no error was stated.
std::string pair_of(const Runs& runs, const std::string& words) {
    const Runs some = those(runs, [&](const Run& r) { return r.words == words; });
    const Runs stated = those(some, std::not_fn(is_hinted));
    auto digits = [](double x) { return std::isnan(x) ? "–" : text("%.2g", 100 * x); };
    const std::string first =
        stated.empty() ? "?" : digits(median(each(stated, [](const Run& r) { return r.stated; })));
    return text("%s / %s", first, digits(median(each(those(some, is_known), true_d)))) +
           (stated.size() < some.size() ? text(" (%zu ?)", some.size() - stated.size()) : "");
}

void tell_scenes(Report& report, const Results& all) {
    report.head({"scene", "reference: samples", "core s", "its error", "understated", "hints",
                 "16 samples: stated / true, %", "256 samples", "--error 3%: true / asked",
                 "4096 samples: stated / true, %"});
    for (const Study& s : all.studies) {
        const Runs runs = those(
            all.runs, [&](const Run& r) { return r.scene == s.name && r.program == all.print; });
        const Runs plain =
            those(runs, [](const Run& r) { return is_among(counts, r) || is_among(errors, r); });
        const Runs asked = those(plain, [](const Run& r) { return r.words == errors[2]; });
        report.row({s.name, text("%.0f", s.samples), text("%.0f", s.seconds),
                    text("%.3g %%", 100 * s.own) + (s.is_hinted ? " (?)" : ""),
                    text("%zu of %zu", those(plain, is_understated).size(), plain.size()),
                    text("%zu", those(plain, is_hinted).size()), pair_of(runs, counts.front()),
                    pair_of(runs, counts.back()), number_of(median(over_asked(asked))),
                    s.is_hard() ? pair_of(runs, more.back()) : ""});
    }
    report.end_of_table();
}

const char* const purpose = R"(# Is the error that is stated the true one?

`build/penumbra --size 64x32` on every scene of four sets: *ordinary* are scenes/ except extremes, and
scenes/calibration/ordinary; *hard* extremes and scenes/calibration/hard; *blind* scenes/calibration/blind, which were
written by someone who had not seen the rule.  Seeds: %.0f for 16, 32, 64 and 256 samples, and for 1024 in hard scenes; %.0f
for `--error` 10 %%, 5 %%, 3 %% and 1 %% with `--time 10`, and for 4096 samples in hard scenes.

The truth is an image of %.0f samples a pixel, of ordinary scenes a quarter of that, by another seed.  The true d_rel of a run
is by `build/compare`, in squares less what the reference states of its own error by the spread of replications.  Where that
is more than .8 of the distance the truth is not known, and the run is left out.  A **hint** is a d_rel that is not stated,
but said not to be known.  Percentages are of runs.  *The program before* is the one that `--baseline` names.)";

int run(Effort plan, int argc, char** argv) {
    Report report(report_folder(plan.quick), "calibration");
    fs::create_directories("out/calibration");
    Results all{all_studies(plan), {}, fingerprint(read_file(plan.program)), ""};
    if (!plan.baseline.empty()) all.before = fingerprint(read_file(plan.baseline));
    if (all.studies.empty()) throw UserError("--scene: no scene has this in its name");
    Steps steps(all.studies.size());
    std::mutex lock;
    in_parallel(
        all.studies.size(), unsigned(plan.jobs),
        [&](size_t k) {
            find_truth(plan, all.studies[k]);
            const std::lock_guard guard(lock);
            steps.next(all.studies[k].name);
        },
        [](double) {});
    all.runs = all_runs(plan, all_jobs(plan, all.studies));
    report.say(text(purpose, double(plan.seeds), double(plan.error_seeds), double(plan.truth)));
    tell_table(report, all);
    report.say(
        "## Every scene\n\nMedians over seeds; ?: the error was said not to be known; –: the truth "
        "is not.");
    tell_scenes(report, all);
    report.say(made_by(argc, argv));
    return report.finish();
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
         {"--jobs", "N", "renders at a time (all cores)", count(plan.jobs, 256)},
         {"--quick", "", "two seeds, one of --error, references of a quarter, into out/",
          [&](auto&) {
              plan.quick = true, plan.seeds = 2, plan.error_seeds = 1;
              plan.truth = 4096;
          }}}};
    return lab_main(argc, argv, lab, [&] {
        plan.program = renderer_beside(lab, argv[0]);
        return run(plan, argc, argv);
    });
}

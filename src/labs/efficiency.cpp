// labs/efficiency.cpp  4  what one choice brings, on every scene
//
//   build/efficiency [--seeds N] [--choice WORDS] [--scene NAME] [--quick]
//
// Renders all of scenes/ as penumbra does by default, and with one option changed at a time: what
// becomes of the error at equal samples, and of 1 / (error^2 x processor seconds)?  Choices take
// turns row by row, each row timed by its thread's own clock, so that load hits all alike.
#include <atomic>
#include <thread>

#include "labs/seeds.h"
#include "path/start.h"
#include "world/scene_file.h"

namespace {

struct Effort {
    bool quick = false;
    uint64_t seeds = 8, spp = 64;
    double pixels = 4608;
    std::vector<std::string> scenes = {};  // none: all
    std::vector<Choice> choices = {};      // none: all
};

// ---- What is measured ---------------------------------------------------------------------------

std::vector<Choice> all_choices() {
    std::vector<Choice> all = alternatives("--sampler");
    for (const char* words :
         {"--light nee", "--roulette 0", "--roulette 1", "--roulette 0.5", "--roulette 0.1"})
        all.push_back(choice_of(words));
    return all;
}

// A scene by one choice; which scene it is, is the same for all.
struct Contender {
    Options o;
    Scene scene;
    Series series;  // one image a seed
};

Contender contender(const std::string& name, const Choice& choice, const Effort& plan) {
    Options o;
    OptionTable table = option_table(o);
    parse_words(table, choice.words, [](const std::string& word) {
        throw UserError("--choice: " + in_quotes(word) + " is no option");
    });
    Scene s = read_scene("scenes/" + name + ".scene").scene;
    const double scale = std::sqrt(plan.pixels / double(s.size.width * s.size.height));
    s.size = {int(std::lround(scale * s.size.width)), int(std::lround(scale * s.size.height))};
    Series series{std::vector<Image>(plan.seeds, Image(s.size.width, s.size.height)),
                  std::vector<double>(plan.seeds)};
    return {o, std::move(s), std::move(series)};
}

// Other options change the samples, or what an image is: here they would be left out in silence.
void check_choice(const Choice& c) {
    for (size_t i = 0; i < c.words.size(); i += 2) {
        constexpr const char* known[] = {"--sampler", "--direction", "--light", "--roulette"};
        if (std::find(std::begin(known), std::end(known), c.words[i]) == std::end(known))
            throw UserError("--choice: " + c.words[i] + " is none of a path's choices");
    }
}

void render_row(Image& image, const Contender& c, const Pattern& pattern, uint64_t spp, int y) {
    for (int x = 0; x < image.width; ++x) {
        rgb sum;
        for (uint64_t i = 0; i < spp; ++i) {
            const Start at = start(c.scene, pattern, {x, y, i});
            sum += Li(c.scene, c.o.technique, at.ray, at.sampler);
        }
        for (size_t k = 0; k < 3; ++k) image.at(x, y)[k] = float(sum.*axis[k] / real(spp));
    }
}

void render_seed(std::vector<Contender>& all, uint64_t seed, uint64_t spp) {
    std::vector<Pattern> patterns;
    for (const Contender& c : all)
        patterns.push_back(make_pattern(c.o.sampler, seed + 1, c.scene.depth, spp));
    const int height = all[0].scene.size.height;
    for (int y = 0; y < height; ++y)
        for (size_t turn = 0; turn < all.size(); ++turn) {
            const size_t k = (turn + size_t(y)) % all.size();
            const double before = thread_seconds();
            render_row(all[k].series.images[seed], all[k], patterns[k], spp, y);
            all[k].series.seconds[seed] += thread_seconds() - before;
        }
}

// The default first.
std::vector<Contender> render_scene(const std::string& name, const Effort& plan) {
    std::vector<Contender> all = {contender(name, {}, plan)};
    for (const Choice& c : plan.choices) all.push_back(contender(name, c, plan));
    std::atomic<uint64_t> next = 0;
    auto work = [&] {
        for (uint64_t seed; (seed = next++) < plan.seeds;) render_seed(all, seed, plan.spp);
    };
    std::vector<std::jthread> threads;
    for (unsigned t = 0; t < all_cores(); ++t) threads.emplace_back(work);
    threads.clear();  // joins
    return all;
}

// ---- What it brings -----------------------------------------------------------------------------

struct Gain {
    bool same = true;  // bit for bit: nothing in this scene depends on the choice
    Estimate error, efficiency;
};

struct Outcome {
    std::string scene;
    double d_rel = 0, path_seconds = 0;  // of the default
    std::vector<Gain> gains;             // one a choice
};

bool equal(const Series& a, const Series& b) {
    for (size_t k = 0; k < a.images.size(); ++k)
        if (a.images[k].pixels != b.images[k].pixels) return false;
    return true;
}

Gain gain_of(const Series& base, const Series& other) {
    if (equal(base, other)) return {true, {1, 0}, {1, 0}};
    auto variances = [&](size_t without) {
        return variance_between(base, without) / variance_between(other, without);
    };
    auto times = [&](size_t without) {
        return seconds_without(base, without) / seconds_without(other, without);
    };
    const size_t seeds = base.images.size();
    return {false, over_seeds(seeds, [&](size_t w) { return std::sqrt(variances(w)); }),
            over_seeds(seeds, [&](size_t w) { return variances(w) * times(w); })};
}

Outcome outcome(const std::string& name, const Effort& plan) {
    const std::vector<Contender> all = render_scene(name, plan);
    const Series& base = all[0].series;
    const double paths = double(base.images[0].pixels.size()) * double(plan.spp);
    Outcome o{name,
              std::sqrt(variance_between(base) / mean_square(base)),
              seconds_without(base) / paths,
              {}};
    for (size_t k = 1; k < all.size(); ++k) o.gains.push_back(gain_of(base, all[k].series));
    return o;
}

// ---- The report ---------------------------------------------------------------------------------

using Which = Estimate Gain::*;

std::string cell(const Gain& g, Which which) { return g.same ? "=" : told(g.*which, "%.2f"); }

Overall overall(const std::vector<Outcome>& all, size_t choice, Which which) {
    Overall sum;
    for (const Outcome& o : all) {
        const Gain& g = o.gains[choice];
        if (!g.same) sum.add((g.*which).value, (g.*which).log_error, o.scene);
    }
    return sum;
}

void tell_table(Report& report, const Effort& plan, const std::vector<Outcome>& all, Which which) {
    std::vector<std::string> head = {"scene"};
    for (const Choice& c : plan.choices) head.push_back(c.name);
    report.head(head);
    for (const Outcome& o : all) {
        std::vector<std::string> cells = {o.scene};
        for (const Gain& g : o.gains) cells.push_back(cell(g, which));
        report.row(cells);
    }
    report.end_of_table();
}

void tell_scenes(Report& report, const std::vector<Outcome>& all) {
    report.head({"scene", "d_rel by default", "µs a path"});
    for (const Outcome& o : all)
        report.row({o.scene, text("%.2g", o.d_rel), text("%.2f", 1e6 * o.path_seconds)});
    report.end_of_table();
}

void tell_overall(Report& report, const Effort& plan, const std::vector<Outcome>& all) {
    report.head({"choice", "scenes", "error, × less", "efficiency, × more", "least", "greatest"});
    auto where = [](const std::pair<double, std::string>& p) {
        return text("%.2f (%s)", p.first, p.second.c_str());
    };
    for (size_t k = 0; k < plan.choices.size(); ++k) {
        const Overall error = overall(all, k, &Gain::error),
                      sum = overall(all, k, &Gain::efficiency);
        if (sum.n == 0) continue;
        report.row({plan.choices[k].name, text("%.0f", sum.n), told(error.mean(), "%.3f"),
                    told(sum.mean(), "%.3f"), where(sum.least), where(sum.greatest)});
    }
    report.end_of_table();
}

int run(Effort plan, const std::string& command) {
    if (plan.scenes.empty()) plan.scenes = all_scenes();
    if (plan.choices.empty()) plan.choices = all_choices();
    for (const Choice& c : plan.choices) check_choice(c);
    Report report(report_folder(plan.quick), "efficiency");
    std::vector<Outcome> all;
    Steps steps(plan.scenes.size());
    for (const std::string& name : plan.scenes) {
        steps.next(name);
        all.push_back(outcome(name, plan));
    }
    report.say(text(R"(# One choice at a time

Every scene, some %.0f pixels of it, with %.0f samples a pixel and %.0f seeds, rendered by default and
with one option changed.  Error is the deviation between seeds (d_rel: over the quadratic mean),
efficiency 1 / (error² × processor seconds); choices take turns row by row.  ± is the standard error over
seeds (jackknife); where light is rare it is large, and nothing is clipped.  "=": the same image bit for
bit, for the choice concerns nothing in the scene; geometric means are of the other scenes.)",
                    plan.pixels, double(plan.spp), double(plan.seeds)));
    tell_overall(report, plan, all);
    report.say("## How many times less the error at equal samples");
    tell_table(report, plan, all, &Gain::error);
    report.say("## How many times more the efficiency");
    tell_table(report, plan, all, &Gain::efficiency);
    report.say("## The default");
    tell_scenes(report, all);
    report.say(made_by(command));
    return report.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Effort plan;
    const Lab lab{"efficiency",
                  "Measures what one option at a time brings on every scene.",
                  {{"--seeds", "N", "renders of each (8)",
                    [&](auto& n) { plan.seeds = parse_count(n, 3, 1000); }},
                   {"--choice", "WORDS", "only this one; may be repeated, writes into out/",
                    [&](auto& words) {
                        plan.quick = true;
                        plan.choices.push_back(choice_of(words));
                    }},
                   {"--scene", "NAME", "only this one; may be repeated, writes into out/",
                    [&](auto& name) {
                        plan.quick = true;
                        plan.scenes.push_back(name);
                    }},
                   {"--quick", "", "fewer runs, into out/", [&](auto&) {
                        plan.quick = true;
                        plan.seeds = 3;
                        plan.spp = 16;
                    }}}};
    return lab_main(argc, argv, lab, [&] {
        std::string command = "build/efficiency";
        for (int k = 1; k < argc; ++k) command += std::string(" ") + argv[k];
        return run(plan, command);
    });
}

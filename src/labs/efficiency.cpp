// labs/efficiency.cpp  6  one option changed at a time, on every scene
//
//   build/efficiency [--seeds N] [--choice WORDS] [--scene NAME] [--quick] [--kept]
#include "labs/grid.h"

namespace {

struct Effort {
    bool quick = false, kept = false;
    uint64_t seeds = 8, spp = 64;
    std::vector<std::string> scenes = scenes_in("scenes");
    std::vector<std::string> choices = {
        "--sampler independent", "--sampler stratified", "--sampler halton", "--light nee",
        "--roulette 0",          "--roulette 1",         "--roulette 0.5",   "--roulette 0.1"};
};

const std::string standard = "the default";

// Over all scenes in which the choice changes anything.
std::vector<std::string> overall(const Rows& rows, const std::string& choice) {
    Rows changed;
    std::vector<std::pair<double, std::string>> each;
    for (const auto& [scene, all] : grouped(rows, of_scene)) {
        if (gain(all, choice, standard, efficiency) == "=") continue;
        changed.insert(changed.end(), all.begin(), all.end());
        each.push_back({over(all, choice, standard, efficiency), scene});
    }
    if (each.empty()) return {choice, "0", "", "", "", ""};
    const auto [least, most] = std::minmax_element(each.begin(), each.end());
    auto where = [](const auto& at) { return text("%.2f (%s)", at.first, at.second); };
    return {choice,
            text("%zu", each.size()),
            gain(changed, choice, standard, accuracy),
            gain(changed, choice, standard, efficiency),
            where(*least),
            where(*most)};
}

// A line for each scene, a column for each choice.
std::string every_scene(const Rows& rows, const Effort& plan, double (*number)(const Rows&)) {
    std::vector<std::string> head = {"scene"};
    head.insert(head.end(), plan.choices.begin(), plan.choices.end());
    std::vector<std::vector<std::string>> lines;
    for (const auto& [scene, all] : grouped(rows, of_scene)) {
        lines.push_back({scene});
        for (const std::string& choice : plan.choices)
            lines.back().push_back(gain(all, choice, standard, number));
    }
    return csv(head, lines);
}

int run(const Effort& plan, const std::string& program, const std::string& command) {
    Page page(report_folder(plan.quick), "efficiency");
    std::vector<Subject> subjects;
    for (const std::string& name : plan.scenes)
        subjects.push_back({name, "scenes/" + name + ".scene --size 96x48", 256 * plan.spp});
    std::vector<Setting> settings = {{standard, "--sets 1"}};
    for (const std::string& words : plan.choices) settings.push_back({words, "--sets 1 " + words});
    RenderGrid grid("efficiency", program, plan.kept);
    const Rows rows = grid.run(subjects, settings, {plan.spp}, plan.seeds);
    std::vector<std::vector<std::string>> lines;
    for (const std::string& choice : plan.choices) lines.push_back(overall(rows, choice));
    page.set("table", table({"choice", "scenes", "1 / error, × default", "efficiency, × default",
                             "least", "greatest"},
                            lines));
    double most = 0;
    for (const std::string& choice : plan.choices)
        if (const double x = over(rows, choice, standard, efficiency); x > most)
            most = x, page.set("best", text("`%s`: %.2f times", choice, x));
    page.data("efficiency-errors", every_scene(rows, plan, accuracy));
    page.data("efficiency", every_scene(rows, plan, efficiency));
    page.set("samples", text("%.0f", double(plan.spp)));
    page.set("seeds", text("%.0f", double(plan.seeds)));
    page.set("made", made_by(command));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Effort plan;
    std::vector<std::string> scenes, choices;
    const Lab lab{"efficiency",
                  "Measures what one option at a time brings on every scene.",
                  {{"--seeds", "N", "renders of each (8)",
                    [&](auto& n) { plan.seeds = parse_count(n, 3, 1000); }},
                   {"--choice", "WORDS", "this one alone; may be repeated, writes into out/",
                    [&](auto& words) { plan.quick = true, choices.push_back(words); }},
                   {"--scene", "NAME", "this one alone; may be repeated, writes into out/",
                    [&](auto& name) { plan.quick = true, scenes.push_back(name); }},
                   kept_flag(plan.kept),
                   {"--quick", "", "fewer renders, into out/",
                    [&](auto&) { plan.quick = true, plan.seeds = 3, plan.spp = 16; }}}};
    return lab_main(argc, argv, lab, [&] {
        if (!scenes.empty()) plan.scenes = scenes;
        if (!choices.empty()) plan.choices = choices;
        return run(plan, renderer_beside(lab, argv[0]), command_of(argc, argv));
    });
}

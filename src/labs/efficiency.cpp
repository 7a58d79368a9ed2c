// labs/efficiency.cpp  6  ablation study: changes one option at a time, on every scene
//
//   build/efficiency [--quick] [--kept]
#include "labs/grid.h"

namespace {

const std::vector<std::string> choices = {
    "--sampler independent", "--sampler stratified", "--sampler halton", "--light nee",
    "--roulette 0",          "--roulette 1",         "--roulette 0.5",   "--roulette 0.1"};

const std::string standard = "the default";

// The table line of a choice, over all scenes that it changes.
std::vector<std::string> overall(const Rows& rows, const std::string& choice) {
    Rows changed;
    std::vector<std::pair<double, std::string>> each;
    for (const auto& [scene, all] : grouped(rows, of_scene)) {
        if (gain(all, choice, standard, efficiency) == "=") continue;
        append(changed, all);
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

int study(const Scope& scope) {
    const uint64_t spp = scope.quick ? 16 : 64, seeds = scope.quick ? 3 : 8;
    Page page(scope, "efficiency");
    std::vector<Subject> subjects;
    for (const std::string& name : scenes_in("scenes"))
        subjects.push_back({name, "scenes/" + name + ".scene --size 96x48", 256 * spp});
    std::vector<Setting> settings = {{standard, "--sets 1"}};
    for (const std::string& words : choices) settings.push_back({words, "--sets 1 " + words});
    RenderGrid grid("efficiency", scope.beside(), scope.kept);
    const Rows rows = grid.run(subjects, settings, {spp}, seeds);
    Lines lines;
    for (const std::string& choice : choices) lines.push_back(overall(rows, choice));
    page.set("table", table({"choice", "scenes", "1 / error, × default", "efficiency, × default",
                             "least", "greatest"},
                            lines));
    double most = 0;
    for (const std::string& choice : choices)
        if (const double x = over(rows, choice, standard, efficiency); x > most)
            most = x, page.set("best", text("`%s`: %.2f times", choice, x));
    page.data("efficiency", csv_of(rows, {"d2", "cpu_seconds"}));
    page.set("samples", text("%.0f", double(spp)));
    page.set("seeds", text("%.0f", double(seeds)));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    return experiment(
        argc, argv,
        {"efficiency", "Measures the gain of one option at a time on every scene.", {}, true},
        study);
}

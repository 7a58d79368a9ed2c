// labs/trade.cpp  7  error over time of every setting, to choose the best
//
//   build/trade [--full] [--quick]
//
// Renders every scene with all samplers and values of --light, and by default in float, at five
// sample counts.  Writes a report and an interactive page, out/trade/trade.html.
#include "labs/trade.h"
#include "text/scene_file.h"

namespace {

using namespace penumbra;
using namespace trade;

struct Effort {
    std::vector<uint64_t> counts = {1, 4, 16, 64, 256};
    uint64_t seeds = 1, truth = 4096;
    int part = 2;  // divides the scenes' widths and heights
};

const std::string own = "build/penumbra", in_float = "build/penumbra-float", folder = "out/trade",
                  shot = "shot: ";

Choices all_choices(const Scene& scene, const std::string& float_program) {
    Choices all;
    const bool points =
        std::any_of(scene.lights.begin(), scene.lights.end(), [](auto& l) { return l.is_delta(); });
    for (const std::string light : {"", " --light nee", " --light none"})
        for (const std::string sampler :
             {"", " --sampler halton", " --sampler stratified", " --sampler independent"})
            if (const bool none = light == " --light none"; !none || !points)
                all.push_back({{own + sampler + light, sampler + light}, !none});
    all.push_back({{own + " --replications 1", " --replications 1"}});
    all.push_back({{in_float, "", float_program}, false});
    return all;
}

// ---- Measurements -------------------------------------------------------------------------------

Point point_of(const Rows& rows) {
    if (rows.empty()) return {};
    const double truth = mean(rows, "own"), off = std::sqrt(mean(rows, "d2") + truth * truth);
    return {double(rows[0].count), mean(rows, "cpu_seconds"), known_error(off, truth)};
}

std::string image_of(const Row& r) {
    return text("%s/%s-%s-%.0f.pfm", folder, r.scene, fingerprint(r.setting), double(r.count));
}

// Settings with images: the default, the fastest at 3 %, and some for comparison.
std::vector<size_t> shown(const Choices& choices) {
    std::vector<size_t> list = {0};
    if (const Answer a = cheapest(choices, 0.03); a.choice > 0) list.push_back(a.choice);
    for (const std::string& name : {in_float, own + " --sampler independent --light nee",
                                    own + " --sampler independent --light none"})
        for (size_t k = 0; k < choices.size(); ++k)
            if (choices[k].setting.name == name && k != list.back()) list.push_back(k);
    return list;
}

// Adds images that take the default's CPU time for 3 %, within limits.  Tries sample counts until
// the time is right to 3 %.  Uses the second seed, because the first chose the settings.
void add_shots(RenderGrid& grid, const Subject& subject, Study& s) {
    const double by_default = reach(s.choices[0], 0.03).seconds,
                 seconds = std::isnan(by_default) ? 1 : std::clamp(by_default, 0.5, 2.0);
    for (size_t k : shown(s.choices)) {
        Setting setting = s.choices[k].setting;
        setting.name = shot + setting.name;
        const Point& last = s.choices[k].points.back();
        double spp = last.spp * seconds / last.seconds;
        Row row;
        for (int trial = 0; trial < 4 && !(std::abs(row["cpu_seconds"] / seconds - 1) < 0.03);
             ++trial) {
            const Rows rows = grid.run({subject}, {setting}, {uint64_t(std::max(1.0, spp))}, 2);
            if (rows.size() < 2) return;
            row = rows[1];
            spp = double(row.count) * seconds / row["cpu_seconds"];
        }
        s.shots.push_back({text("%s --spp %.0f", s.choices[k].setting.name, double(row.count)),
                           point_of({row}), read_pfm(image_of(row))});
    }
}

Study study(RenderGrid& grid, const Effort& plan, const std::string& name,
            const std::string& float_program, Rows& all) {
    const std::string file = "scenes/" + name + ".scene";
    const Scene scene = read_scene(file).scene;
    const int width = scene.size.width / plan.part, height = scene.size.height / plan.part;
    const Subject subject{name, text("%s --size %dx%d", file, width, height), plan.truth};
    const Truth& f = grid.truth(subject);
    Study s{name, double(scene.exposure), f.own, all_choices(scene, float_program)};
    std::vector<Setting> settings;
    for (const Choice& c : s.choices) settings.push_back(c.setting);
    for (uint64_t count : plan.counts) {
        const Rows rows = grid.run({subject}, settings, {count}, plan.seeds);
        for (Choice& c : s.choices) c.points.push_back(point_of(by_setting(rows, c.setting.name)));
        append(all, rows);
    }
    s.shots.push_back({"the reference", {}, f.image});
    add_shots(grid, subject, s);
    return s;
}

// ---- Report -------------------------------------------------------------------------------------

std::string told_seconds(double x) { return std::isnan(x) ? "–" : significant(x, 2) + " s"; }

std::string told_answer(const Choices& choices, double error) {
    const auto [k, at] = cheapest(choices, error);
    if (std::isnan(at.seconds)) return "–";
    return text("%s: `%s --spp %.0f`", told_seconds(at.seconds), choices[k].setting.name,
                std::ceil(at.spp)) +
           (k ? "; default " + told_seconds(reach(choices[0], error).seconds) : "");
}

// Curves of the default and of the fastest settings, on one scene.
Svg curves(const Rows& rows, const Study& s) {
    std::set<std::string> named = {own};
    for (double error : asked)
        named.insert(s.choices[cheapest(s.choices, error).choice].setting.name);
    return plot(
        where(in_scene(rows, s.scene), [&](const Row& r) { return named.count(r.setting) > 0; }),
        "CPU seconds", "d_rel", of_setting, mean_of("cpu_seconds"),
        [](const Rows& r) { return point_of(r).error; }, s.scene);
}

void tell_default(Page& page, const std::vector<Candidate>& all) {
    const auto at = std::find_if(all.begin(), all.end(), [](auto& c) { return c.command == own; });
    if (at == all.end()) throw UserError("no error of the default is known on any scene");
    page.set("ratio", text("%.2f", at->ratio));
    page.set("most", text("%.2f on %s", at->most, at->where));
    page.set("best", text("`%s`: %.2f", all[0].command, all[0].ratio));
    page.claim("is small", at->ratio <= 1.5);
    page.claim("is best", at->ratio <= 1.05 * all[0].ratio);
}

int study(const Scope& scope, Effort plan) {
    if (scope.quick) plan.part = 4, plan.truth = 256, plan.counts = {1, 4, 16};
    RenderGrid grid(scope.quick ? "trade-quick" : "trade", scope.beside());
    const std::string float_program = scope.beside("penumbra-float");
    std::filesystem::create_directories(folder);
    Page page(scope, "trade");
    grid.measure = [](Row& row, const Image& image, const Truth&) {
        if (row.setting.starts_with(shot) && row.seed == 2) write_image(image_of(row), image, 1);
    };
    std::vector<Study> studies;
    Rows rows;
    Lines lines;
    for (const std::string& name : scenes_in("scenes")) {
        const Study& s = studies.emplace_back(study(grid, plan, name, float_program, rows));
        lines.push_back({name});
        for (double error : asked) lines.back().push_back(told_answer(s.choices, error));
    }
    write_page(studies, scope.command, scope.quick, folder);
    for (const Study& s : studies)
        write_file(folder + "/" + s.scene + ".svg", curves(rows, s).file());
    page.set("table", table({"scene", "10 %", "3 %", "1 %", "0.3 %"}, lines));
    page.plot("trade", curves(rows, studies[0]));
    tell_default(page, candidates(studies));
    page.data("trade", csv_of(rows, {"cpu_seconds", "off", "own"}));
    page.set("samples", text("%.0f", double(plan.counts.back())));
    page.set("truth", text("%.0f", double(plan.truth)));
    page.set("part", text("1/%d", plan.part));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Effort plan;
    const Lab lab{"trade",
                  "Measures error over time of every setting on every scene.",
                  {{"--full", "", "more samples and seeds", "",
                    [&](Text) { plan.counts.push_back(1024), plan.seeds = 2, plan.truth *= 4; }}}};
    return experiment(argc, argv, lab, [&](const Scope& scope) { return study(scope, plan); });
}

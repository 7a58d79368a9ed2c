// labs/trade.cpp  8  error over time, by every setting: what to choose
//
//   build/trade [--float PROGRAM] [--scene NAME] [--full] [--quick] [--page]
//
// Every scene by all samplers, --light and both precisions, at five sample counts, in a tournament.
// Writes a report, and what was measured into out/trade/, from which --page writes report and page
// again.
#include "labs/seeds.h"
#include "labs/trade_file.h"
#include "labs/trade_page.h"
#include "labs/trade_report.h"
#include "labs/trade_study.h"

namespace {

using namespace trade;

const std::string folder = "out/trade";

Trade measured(Effort plan, const std::string& command) {
    if (plan.scenes.empty()) plan.scenes = all_scenes();
    Trade t;
    t.default_words = default_words();
    t.command = command;
    Steps steps(plan.scenes.size());
    for (const std::string& name : plan.scenes) {
        steps.next(name);
        t.scenes.push_back(study(plan, name));
        write_trade(t, folder);  // what is there, should the rest fail
    }
    t.candidates = candidates_of(t.scenes);
    write_trade(t, folder);
    return t;
}

int report_of(const Trade& t, bool quick) {
    Report report(report_folder(quick), "trade");
    tell(report, t);
    report.say(made_by(t.command));
    write_file(folder + "/index.html", trade_page(t));
    std::fprintf(stderr, "wrote %s/index.html\n", folder.c_str());
    return report.finish();
}

void make_quick(Effort& plan) {
    plan.quick = true;
    plan.counts = {1, 4, 16};
    plan.part = 4;
    plan.tournament = 5, plan.reference = 1;
}

void make_full(Effort& plan) {
    plan.counts.push_back(1024);
    plan.seeds = 2;
    plan.tournament *= 6, plan.reference *= 6;
}

}  // namespace

int main(int argc, char** argv) {
    Effort plan;
    bool page = false;
    std::string list;
    const Lab lab{
        "trade",
        "Measures error over time by every setting, on every scene.",
        {{"--float", "PROGRAM", "this lab in float, for the other precision",
          [&](auto& program) { plan.float_program = program; }},
         {"--scene", "NAME", "only this one; may be repeated, writes into out/",
          [&](auto& name) {
              plan.quick = true;
              plan.scenes.push_back(name);
          }},
         {"--full", "", "more samples, seeds and time", [&](auto&) { make_full(plan); }},
         {"--quick", "", "fewer runs, into out/", [&](auto&) { make_quick(plan); }},
         {"--page", "", "write report and page from what was measured",
          [&](auto&) { page = true; }},
         {"--render", "FILE", "only what this file lists, for the lab in the other precision",
          [&](auto& file) { list = file; }}}};
    return lab_main(argc, argv, lab, [&] {
        std::filesystem::create_directories(folder);
        if (!list.empty()) {
            render_listed(list);
            return 0;
        }
        std::string command = "build/trade";
        for (int k = 1; k < argc; ++k) command += std::string(" ") + argv[k];
        return report_of(page ? read_trade(folder) : measured(plan, command), plan.quick);
    });
}

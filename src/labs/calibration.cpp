// labs/calibration.cpp  6  penumbra's error estimates, compared with true errors
//
//   build/calibration [--seeds N] [--quick]
#include "labs/calibration.h"
#include "labs/grid.h"

namespace {

using namespace penumbra;
using namespace calibration;

using Words = std::vector<std::string>;
// Limited by samples, not by time: the same figures on a busy machine.
const Words counts = {"--spp 16", "--spp 32", "--spp 64", "--spp 256"},
            errors = {"--error 10% --spp 1024", "--error 5% --spp 1024", "--error 3% --spp 1024",
                      "--error 1% --spp 1024"},
            more = {"--spp 1024", "--spp 4096"};  // for hard scenes only

// The author of a blind scene assigns its set by the line "# class: hard".
std::vector<Subject> all_subjects(uint64_t truth) {
    std::vector<Subject> all;
    for (const std::string place : {"scenes/", "build/scenes/ordinary/", "build/scenes/hard/",
                                    "build/scenes/blind/", "build/scenes/aimed/"})
        for (const std::string& name : scenes_in(place)) {
            const std::string file = place + name + ".scene";
            const bool blind = place.ends_with("blind/"), aimed = place.ends_with("aimed/"),
                       hard = place.ends_with("hard/") || name == "extremes" ||
                              (blind && read_file(file).find("# class: hard") != std::string::npos);
            const std::string set = aimed ? "aimed/" : hard ? "hard/" : "ordinary/";
            all.push_back({(blind ? "blind " : "") + set + name, file + " --size 64x32",
                           hard || aimed ? truth : truth / 4});
        }
    return all;
}

Rows all_rows(RenderGrid& grid, const std::vector<Subject>& subjects, uint64_t seeds) {
    Rows rows;
    for (const Words& list : {counts, errors, more}) {
        std::vector<Setting> settings;
        for (const std::string& words : list) settings.push_back({words, words});
        std::vector<Subject> some = subjects;
        if (list == more)
            std::erase_if(some, [](auto& s) { return !set_of(s.name).ends_with("hard"); });
        append(rows, grid.run(some, settings, {0}, seeds));
    }
    return rows;
}

const std::pair<const char*, const char*> measures[] = {  // names and aims
    {"runs", ""},
    {"left out below: the true error is not known", ""},
    {"the spread of replications understates by more than 2", ""},
    {"understated by more than 2, and no hint", "≤ 1 %; aimed: ≤ 5 %"},
    {"a hint that the error is not known", ""},
    {"a hint, though the spread was right within 2", "≤ 2 %, ordinary"},
    {"stated over the spread's statement, median", "≤ 1.05, ordinary"},
    {"64 times the samples: an error is stated, and right within 2", "≥ 80 %, hard"},
    {"`--error`: reached within 1024 samples per pixel", ""},
    {"`--error`: true over asked, median", "≤ 1"},
    {"`--error`: true over asked, 95 %", "≤ 1.25"}};

// These measures for runs by fixed counts, runs by --error, and runs with more samples.
std::vector<std::string> column(const Rows& counted, const Rows& asked, const Rows& longer) {
    Rows plain = counted;
    append(plain, asked);
    std::vector<double> over_spread, over_asked;
    for (const Row& r : plain)
        if (!is_hinted(r)) over_spread.push_back(r["d_rel"] / by_spread(r));
    for (const Row& r : asked)
        if (is_reached(r) && is_known(r)) over_asked.push_back(true_d(r) / asked_in(r.setting));
    auto part = [](const Rows& rows, auto which) {
        const double x = share(rows, which);
        return std::isnan(x) ? "–" : text("%.1f %%", 100 * x);
    };
    auto number = [](double x) { return std::isnan(x) ? "–" : text("%.2f", x); };
    auto by_spread_it_is = [](Verdict v) {
        return [v](const Row& r) { return verdict(r, by_spread(r)) == v; };
    };
    return {
        text("%zu", plain.size()),
        text("%zu", plain.size() - where(plain, is_known).size()),
        part(plain, by_spread_it_is(Verdict::too_low)),
        part(plain, is_understated),
        part(plain, is_hinted),
        part(plain, [&](auto& r) { return is_hinted(r) && by_spread_it_is(Verdict::right)(r); }),
        number(median(over_spread)),
        part(longer, [](auto& r) { return verdict(r, r["d_rel"]) == Verdict::right; }),
        text("%.1f %%", 100.0 * double(where(asked, is_reached).size()) / double(asked.size())),
        number(median(over_asked)),
        number(quantile(over_asked, 0.95))};
}

std::string all_measures(const Rows& rows) {
    std::vector<std::string> head = {"64×32 pixels"};
    std::vector<std::vector<std::string>> columns;
    for (const auto& [set, all] : grouped(rows, [](const Row& r) { return set_of(r.scene); })) {
        auto among = [&all = all](const Words& list) {
            return where(all, [&](const Row& r) {
                return std::find(list.begin(), list.end(), r.setting) != list.end();
            });
        };
        head.push_back(set), columns.push_back(column(among(counts), among(errors), among(more)));
    }
    head.push_back("aim");
    Lines lines;
    for (size_t k = 0; k < std::size(measures); ++k) {
        lines.push_back({measures[k].first});
        for (const auto& c : columns) lines.back().push_back(c[k]);
        lines.back().push_back(measures[k].second);
    }
    return table(head, lines);
}

int study(const Scope& scope, uint64_t seeds) {
    Page page(scope, "calibration");
    RenderGrid grid("calibration", scope.beside());
    const uint64_t truth = scope.quick ? 4096 : 16384;
    if (scope.quick) seeds = 2;
    const Rows rows = all_rows(grid, all_subjects(truth), seeds);
    page.set("table", all_measures(rows));
    page.data("calibration", csv_of(rows, {"d_rel", "d_rel_by_spread", "off", "own", "error"}));
    page.set("seeds", text("%.0f", double(seeds))), page.set("truth", text("%.0f", double(truth)));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    uint64_t seeds = 10;
    const Lab lab{"calibration",
                  "Compares penumbra's error estimates with true errors.",
                  {whole_number("--seeds", "runs of each", "10", seeds, 1, 1000)}};
    return experiment(argc, argv, lab, [&](const Scope& scope) { return study(scope, seeds); });
}

// labs/radiosity_error.cpp  8  true errors of build/radiosity --error over requested ones
//
//   build/radiosity_error [--quick]
//
// Errors of maps cover all surfaces, not only visible ones, so this program runs radiosity's parts.
#include "app/views.h"
#include "labs/room.h"
#include "labs/rows.h"
#include "radiosity/walks.h"
#include "text/json.h"

namespace {
using namespace penumbra;

// A map, with its requested and its estimated error.  add_true() adds the true error.
struct MethodRun {
    Row row;
    IlluminationMap map;
};
using Runs = std::vector<MethodRun>;

MethodRun run_of(const Room& room, const char* method, double asked, double stated,
                 std::map<std::string, double> of, IlluminationMap map) {
    of.insert({{"asked", asked}, {"stated", stated}});
    const std::string scene = text("%s, %zu triangles", room.name, room.mesh.elements());
    return {{scene, method, 0, 0, of}, std::move(map)};
}
void add_true(MethodRun& run, double error) {
    Row& r = run.row;
    r.of["true"] = error, r.of["over asked"] = error / r["asked"];
}
double mean_square(const Rows& rows, const char* name) {
    double sum = 0;
    for (double x : all_of(rows, name)) sum += x * x / double(rows.size());
    return sum;
}
Rows rows_of(const Runs& runs) {
    Rows rows;
    for (const MethodRun& run : runs) rows.push_back(run.row);
    return rows;
}
std::string of_asked(const Row& r) { return percent(r["asked"]); }

Runs walks(const Room& room, double asked, uint64_t n) {
    Runs runs;
    CommonOptions o;
    o.quiet = true;
    for (uint64_t r = 0; r < n; ++r) {
        const auto p =
            Particles::settings(SamplerKind::halton, hash(r, std::bit_cast<uint64_t>(asked)));
        Walked w = walk_all(room.scene, room.mesh, p, {0, 0, asked}, o);
        runs.push_back(run_of(room, "particles", asked, w.stated.error,
                              {{"particles", double(w.particles)}}, std::move(w.map)));
    }
    return runs;
}

// True errors are distances to the mean of the reference's runs.  The reference's own error is
// subtracted in squares.  A run of the reference is left out of its own reference.
void add_true_errors(const Mesh& mesh, Runs& runs, const Runs& reference, bool is_own) {
    const double all = double(reference.size()), n = all - is_own;
    IlluminationMap sum(number_of_sides(mesh));
    for (const MethodRun& run : reference)
        for (size_t v = 0; v < sum.size(); ++v) sum[v] += run.map[v];
    const double square = square_of(mesh, sum) / (all * all),
                 own = mean_square(rows_of(reference), "stated") / n;
    for (MethodRun& run : runs) {
        IlluminationMap off = is_own ? difference(sum, run.map) : sum;
        for (size_t v = 0; v < off.size(); ++v) off[v] = off[v] / real(n) - run.map[v];
        add_true(run, std::sqrt(std::max(0.0, square_of(mesh, off) / square - own)));
    }
}

// Adds runs for requested errors, smallest first.  These first runs are the reference of the rest.
void add_walks(Rows& rows, const Room& room, double least, uint64_t seeds) {
    Runs reference;
    for (double asked : {0.01, 0.03, 0.1}) {
        if (asked < least) continue;
        Runs runs = walks(room, asked, seeds);
        add_true_errors(room.mesh, runs, reference.empty() ? runs : reference, reference.empty());
        for (const MethodRun& run : runs) rows.push_back(run.row);
        if (reference.empty()) reference = std::move(runs);
    }
}

// No run ends before the first error check, so short runs may be better than requested.
std::string walked_cell(Page& page, const Rows& rows) {
    const bool is_long =
        median(all_of(rows, "particles")) > 2 * double(ErrorTarget::least * Particles::batches);
    auto over = [&](double q) { return quantile(all_of(rows, "over asked"), q); };
    const bool kept = over(0.5) <= 1 && (!is_long || (over(0.5) >= 0.95 && over(0.95) < 1.05));
    return text("%.3f, %.3f, %.3f: ", over(0.5), over(0.95), over(1)) + page.verdict(kept);
}

// Adds checks of one run.  The last map is the reference, and its bound is added to the distance.
void add_shots(Rows& rows, const Room& room, Shooter shooter, double patience) {
    Shooting run(room.scene, room.mesh, shooter, all_cores());
    Runs runs;
    for (double asked : {0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 1e-4}) {
        run.run({0, patience, 0, asked}, [](const Shooting&) {});
        if (run.error() > asked && !runs.empty()) break;  // its last shot is incomplete
        runs.push_back(run_of(room, shooter == Shooter::face ? "hierarchy" : "shooting", asked,
                              run.error(), {}, run.map()));
        if (run.error() > asked) break;
    }
    const double left = runs.back().row["stated"], whole = square_of(room.mesh, runs.back().map);
    for (MethodRun& r : runs) {
        const double d2 = square_of(room.mesh, difference(runs.back().map, r.map)) / whole;
        // Close to the reference the distance from it is no error.
        if (r.row["asked"] >= 10 * left) add_true(r, std::sqrt(d2) + left);
        rows.push_back(r.row);
    }
}

std::string shot_cell(Page& page, const Rows& runs) {
    const Rows rows = where(runs, [](const Row& r) { return !std::isnan(r["true"]); });
    if (rows.empty()) return text("not below %s in time", percent(runs.back()["stated"]));
    const std::vector<double> x = all_of(rows, "over asked");
    return text("%.2g–%.2g: ", quantile(x, 0), quantile(x, 1)) + page.verdict(quantile(x, 1) <= 1);
}

int study(const Scope& scope) {
    const bool quick = scope.quick;
    Page page(scope, "radiosity-error");
    using Places = std::vector<std::pair<std::string, double>>;
    const Places places =
        quick ? Places{{"cube", 0.03}, {"penumbra", 0.03}}
              : Places{{"atelier", 0.03}, {"cornell36", 0.01}, {"cube", 0.01},    {"furnace", 0.03},
                       {"lanterns", 0.1}, {"panel", 0.01},     {"penumbra", 0.03}};
    Rows walked, shot;
    for (const auto& place : places) {
        // The longest edge is a fraction of the scene's diagonal.
        const NamedScene read = scene_named(place.first);
        auto room = [&](int parts) {
            return make_room(place.first, read, double(diagonal(read)) / parts);
        };
        if (!quick && place.second < 0.1) add_walks(walked, room(32), 0.1, 32);
        add_walks(walked, room(12), place.second, quick ? 8 : 32);
        for (int parts : {8, 16})
            for (Shooter shooter : {Shooter::face, Shooter::element})
                add_shots(shot, room(parts), shooter, quick ? 5 : 60);
    }
    page.set("particles", table(walked, of_scene, of_asked,
                                [&](const Rows& r) { return walked_cell(page, r); }));
    page.set("shooting",
             table(shot, of_scene, of_setting, [&](const Rows& r) { return shot_cell(page, r); }));
    page.set("ratio",
             text("%.3f", std::sqrt(mean_square(walked, "true") / mean_square(walked, "stated"))));
    const std::vector<std::string> numbers = {"asked", "stated", "true"};
    page.data("radiosity-error-particles", csv_of(walked, numbers));
    page.data("radiosity-error-shooting", csv_of(shot, numbers));
    page.set("seeds", quick ? "8" : "32");
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    return experiment(
        argc, argv,
        {"radiosity_error", "Measures true errors of illumination maps over requested ones."},
        study);
}

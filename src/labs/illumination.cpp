// labs/illumination.cpp  6  two methods of global illumination on the same triangles
//
//   build/illumination [--quick]
//
// Khodulev (1996) compared accuracy over time of deterministic and Monte Carlo illumination maps.
// This program repeats the comparison with build/radiosity, which has both methods.
#include "labs/illumination.h"

#include "labs/grid.h"

namespace {

using namespace penumbra;
using namespace illumination;
// A scene, its longest edge, the most particles, and the final unshot powers (shooting, hierarchy).
struct Course {
    std::string scene;
    double H;
    uint64_t particles;
    double flat, faces;
    Subject seen_by(const std::string& truth) const {
        return {text("%s %g", scene, H), text("scenes/%s.scene --rays 4 --mesh %g", scene, H), 0,
                truth};
    }
};

std::vector<Course> courses(bool quick) {
    if (quick) return {{"cube", 3.6, 1 << 18, 1e-3, 1e-3}, {"cornell36", 160, 1 << 18, 1e-2, 1e-2}};
    constexpr uint64_t n = 1 << 22;
    return {{"cube", 0.884, 4 * n, 1e-4, 1e-4},
            {"atelier", 0.295, 8 * n, 1e-1, 1e-3},
            {"cornell36", 160, n, 1e-4, 1e-4},
            {"cornell36", 80, n, 1e-4, 1e-4},
            {"cornell36", 40, 4 * n, 1e-4, 1e-4}};
}

// Rows of the settings that begin with this word, shortest run first.
Rows by_method(const Rows& rows, const std::string& method) {
    return where(rows, [&](const Row& r) { return words_in(r.setting)[0] == method; });
}

// Error over CPU seconds of a method.  The number `squares` has the squared errors.
Curve curve_of(const Rows& rows, const std::string& method, const char* squares) {
    Curve c;
    for (const auto& [setting, runs] : grouped(by_method(rows, method), of_setting))
        if (const double e = std::sqrt(mean(runs, squares)); e > 0)
            c.add(mean(runs, "map_cpu_seconds"), e);
    return c;
}

struct Race {
    std::string name;
    Rows rows;         // d2: the reference's own error is subtracted
    Moments k, check;  // proportion() of shorter runs, and of longer ones
    Curve particles;
};

Race run_race(RenderGrid& grid, const Course& c) {
    Race race;
    const Subject subject =
        c.seen_by(text("--method particles --sampler independent "
                       "--particles %.0f --seed 1",
                       double(c.particles)));
    auto add = [&](const std::vector<Setting>& settings, const Truth* last, uint64_t seeds) {
        grid.measure = [=](Row& r, const Image& image, const Truth& f) {
            r.of["reference"] = f.of.at("error");
            r.of["reference_seconds"] = f.of.at("map_cpu_seconds");
            if (last) r.of["optimistic2"] = sqr(d_rel(last->image, image));
        };
        Rows rows = grid.run({subject}, settings, {0}, seeds);
        for (Row& r : rows)  // the distance to the last solution is no error near it
            if (!(r["unshot"] > 4 * rows.back()["unshot"])) r.of["optimistic2"] = NAN;
        append(race.rows, rows);
    };
    std::vector<Setting> walks;
    for (const char* kind : {"independent", "halton"})
        for (uint64_t part : {1024, 512, 256, 128, 64, 32, 4})
            walks.push_back({text("%s 1/%.0f", kind, double(part)),
                             text("--method particles --sampler %s --particles %.0f", kind,
                                  double(c.particles / part))});
    add(walks, nullptr, 2);
    for (const auto& [method, least] : {std::pair("shooting", c.flat), {"hierarchy", c.faces}}) {
        std::vector<Setting> stops;
        for (double unshot : {.5, .2, .1, .05, .02, .01, .005, .002, .001, .0005, .0002, .0001}) {
            if (unshot < least) break;
            const std::string words = text("--method %s --unshot %g", method, unshot);
            stops.push_back({text("%s %g", method, unshot), words});
        }
        add(stops, &grid.truth(c.seen_by(stops.back().words)), 0);
    }
    const Rows longer = by_setting(race.rows, "independent 1/4");
    race.k = proportion(where(by_method(race.rows, "independent"),
                              [](const Row& r) { return r.setting != "independent 1/4"; }));
    race.check = proportion(longer);
    for (Row& r : race.rows) {
        r.of["own"] = race.k.mean * r["reference"];
        r.of["d2"] = sqr(r["off"]) - sqr(r["own"]);
    }
    race.name = text("%s, %.0f triangles", c.scene, longer[0]["elements"]);
    race.particles = curve_of(race.rows, "independent", "d2");
    race.particles.add(longer[0]["reference_seconds"], race.k.mean * longer[0]["reference"]);
    return race;
}

std::string words_of(const Ahead& a) {
    if (!a.ever) return "never";
    const std::string from = text("%.2g s (%s)", a.from, percent(a.worst));
    return from + (a.to_the_end ? " on" : text(" to %.2g s (%s)", a.to, percent(a.best)));
}

void tell_races(Page& page, const std::vector<Race>& races) {
    Lines ahead_of, references;
    Rows all;
    size_t realistic = 0;
    double latest[2] = {};  // the largest error of particles where each method catches up
    for (const Race& r : races) {
        const double spread = std::sqrt(r.k.variance()) / r.k.mean;
        references.push_back({r.name, told({r.k.mean, std::sqrt(r.k.variance())}, "%.3f"),
                              text("%.3f", r.check.mean),
                              page.verdict(std::abs(r.check.mean / r.k.mean - 1) < 4 * spread),
                              percent(r.rows[0]["own"])});
        ahead_of.push_back({r.name, text("%.2f", slope(r.particles.seconds, r.particles.error))});
        bool always = true;
        double* late = latest;
        for (const char* method : {"shooting", "hierarchy"}) {
            const Curve real = curve_of(r.rows, method, "d2");
            const Ahead of_real = ahead(r.particles, real),
                        optimistic = ahead(r.particles, curve_of(r.rows, method, "optimistic2"));
            always = always && of_real.to_the_end;
            if (!optimistic.to_the_end) *late = std::max(*late, optimistic.best);
            ++late;
            for (const std::string& cell :
                 {words_of(of_real), words_of(optimistic), percent(real.error.back())})
                ahead_of.back().push_back(cell);
        }
        realistic += always;
        append(all, r.rows);
    }
    page.set("ahead", table({"room", "exponent", "ahead of shooting, realistic", "optimistic",
                             "floor", "of hierarchy, realistic", "optimistic", "floor"},
                            ahead_of));
    page.set("references",
             table({"room", "k", "k of longer runs", "", "error of the reference"}, references));
    page.data("radiosity-races", csv_of(all, {"elements", "unshot", "shots", "rays", "d2",
                                              "optimistic2", "map_cpu_seconds"}));
    page.set("rooms", text("%zu of %zu", realistic, races.size()));
    page.set("flat", percent(latest[0])), page.set("hierarchy", percent(latest[1]));
}

void plot_race(Page& page, const Race& r) {
    std::vector<Series> all;
    auto add = [&](const std::string& name, const Curve& c) {
        all.push_back({name, c.seconds, c.error});
    };
    add("particles", r.particles);
    add("particles, Halton", curve_of(r.rows, "halton", "d2"));
    for (const std::string method : {"shooting", "hierarchy"}) {
        add(method + ", realistic", curve_of(r.rows, method, "d2"));
        add(method + ", optimistic", curve_of(r.rows, method, "optimistic2"));
    }
    page.plot("radiosity-time", plot(all, "CPU seconds", "error (d_rel)", r.name));
}

int study(const Scope& scope) {
    Page page(scope, "radiosity");
    RenderGrid grid("illumination", scope.beside("radiosity"));
    std::vector<Race> races;
    for (const Course& c : courses(scope.quick)) races.push_back(run_race(grid, c));
    tell_races(page, races);
    plot_race(page, races.back());
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    return experiment(argc, argv,
                      {"illumination", "Compares deterministic and Monte Carlo illumination maps."},
                      study);
}

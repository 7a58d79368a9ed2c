// labs/illumination.cpp  6  two methods of global illumination on the same triangles
//
//   build/illumination [--quick] [--kept]
//
// Khodulev (1996) compared a deterministic method with Monte Carlo, both on illumination maps, by
// accuracy over time.  Here build/radiosity does both and is measured as he did; then with what he
// had not: the exact CUBE, and a path tracer without triangles.
#include "labs/illumination.h"

#include "labs/grid.h"

namespace {

using namespace illumination;
using Lines = std::vector<std::vector<std::string>>;

struct Scope {
    bool quick = false, kept = false;
};

// ---- Accuracy over time -------------------------------------------------------------------------

// A scene, the longest edge, the longest Monte Carlo run, and where shooting and hierarchy end.
struct Course {
    std::string scene;
    double H;
    uint64_t particles;
    double flat, faces;
    std::string name() const { return scene + text(" %g", H); }
    Subject seen_by(const std::string& truth) const {
        const char* size = scene == "cornell36" ? " --size 128x64" : "";
        return {name(), text("scenes/%s.scene%s --rays 4 --mesh %g", scene, size, H), 0, truth};
    }
    Subject subject() const {
        return seen_by(text("--method particles --sampler independent --particles %.0f --seed 1",
                            double(particles)));
    }
};

std::vector<Course> courses(const Scope& plan) {
    if (plan.quick)
        return {{"cube", 3.6, 1 << 18, 1e-3, 1e-3},
                {"cornell36", 320, 1 << 18, 1e-2, 1e-2},
                {"cornell36", 160, 1 << 18, 1e-2, 1e-2}};
    constexpr uint64_t n = 1 << 22;
    std::vector<Course> all = {{"cube", 0.884, 4 * n, 1e-4, 1e-4}};
    for (double H : {226.0, 160.0, 113.0, 80.0, 56.5, 40.0})
        all.push_back({"cornell36", H, H < 60 ? 4 * n : n, 1e-4, 1e-4});
    all.push_back({"atelier", 0.295, 8 * n, 1e-1, 1e-3});
    return all;
}

// A method's runs, one of a setting or two of other seeds, from the shortest on.
Rows by_method(const Rows& rows, const std::string& method) {
    return where(rows, [&](const Row& r) { return words_in(r.setting)[0] == method; });
}
template <class Error>
Curve curve_of(const Rows& rows, const std::string& method, Error error) {
    Curve c;
    for (const auto& [setting, runs] : grouped(by_method(rows, method), of_setting))
        if (const double e = error(runs); !std::isnan(e)) c.add(mean(runs, "map_cpu_seconds"), e);
    return c;
}

struct Race {
    Course course;
    Rows rows;
    Proportion proportion;
    double own = 0;  // error of the reference, inferred
    Curve particles, halton;

    double elements() const { return rows[0]["elements"]; }
    std::string name() const { return text("%s, %.0f triangles", course.scene, elements()); }
    double realistic_of(const Rows& runs) const {
        return without(std::sqrt(mean(runs, "off2")), own);
    }
    Curve realistic(const std::string& method) const {
        return curve_of(rows, method, [&](const Rows& runs) { return realistic_of(runs); });
    }
    // Near the last solution the distance to it says nothing any more.
    Curve optimistic(const std::string& method) const {
        const double last = by_method(rows, method).back()["unshot"];
        return curve_of(rows, method, [&](const Rows& runs) {
            return runs[0]["unshot"] > 4 * last ? runs[0]["optimistic"] : NAN;
        });
    }
    double floor(const std::string& method) const { return realistic(method).error.back(); }
    // The path tracer's distance, without the errors of both references.
    double limit() const { return without(std::sqrt(rows[0]["limit2"]), own); }
};

Race run_race(RenderGrid& grid, const Course& c, const Truth* traced, bool kept) {
    Race race{c, {}, {}, 0, {}, {}};
    auto add = [&](const std::vector<Setting>& settings, const Truth* last, uint64_t seeds) {
        grid.measure = [=](Row& r, const Image& image, const Truth& f) {
            r.of["off2"] = r["off"] * r["off"], r.of["reference"] = f.of.at("error");
            r.of["reference_seconds"] = f.of.at("map_cpu_seconds");
            if (last) r.of["optimistic"] = d_rel(last->image, image);
            if (!traced) return;
            auto square = [&](const Image& g) {
                return std::pow(d_rel(traced->image, g), 2) - traced->own * traced->own;
            };
            r.of["total2"] = square(image), r.of["limit2"] = square(f.image);
        };
        const Rows rows = grid.run({c.subject()}, settings, {0}, seeds);
        race.rows.insert(race.rows.end(), rows.begin(), rows.end());
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
        for (double unshot : decades_down_to(least)) {
            const std::string words = text("--method %s --unshot %g", method, unshot);
            stops.push_back({text("%s %g", method, unshot), words});
        }
        add(stops, kept ? nullptr : &grid.truth(c.seen_by(stops.back().words)), 0);
    }
    const Rows longer = by_setting(race.rows, "independent 1/4");
    race.proportion = proportion(where(by_method(race.rows, "independent"),
                                       [](const Row& r) { return r.setting != "independent 1/4"; }),
                                 longer);
    const double k = race.proportion.k.mean;
    race.own = k * longer[0]["reference"];
    auto error = [&](const Rows& r) { return race.realistic_of(r); };
    race.particles = curve_of(race.rows, "independent", error);
    race.halton = curve_of(race.rows, "halton", error);
    race.particles.add(longer[0]["reference_seconds"], race.own);
    return race;
}

std::string words_of(const Ahead& a) {
    if (!a.ever) return "never";
    const std::string from = text("%s (%s)", in_seconds(a.from), percent(a.worst));
    return from + (a.to_the_end ? " on" : text(" to %s (%s)", in_seconds(a.to), percent(a.best)));
}

void tell_races(Page& page, const std::vector<Race>& races) {
    Lines ahead_of, references;
    Rows all;
    size_t realistic = 0;
    double flat = 0, hierarchy = 0;  // the largest error of particles at which they are caught up
    std::string caught;
    for (const Race& r : races) {
        const Proportion& p = r.proportion;
        references.push_back(
            {r.name(), plus_minus(p.k, "%.3f"), text("%.3f ± %.3f", p.exponent, p.standard_error),
             percent(p.predicted), percent(p.measured), page.verdict(p.holds()), percent(r.own)});
        ahead_of.push_back({r.name(), text("%.2f", power_through(r.particles).exponent),
                            text("%.2f", power_through(r.halton).exponent)});
        bool always = true;
        for (const char* method : {"shooting", "hierarchy"}) {
            const Ahead real = ahead(r.particles, r.realistic(method)),
                        optimistic = ahead(r.particles, r.optimistic(method));
            always = always && real.to_the_end;
            const bool elements = method == std::string("shooting");
            double& most = elements ? flat : hierarchy;
            if (!optimistic.to_the_end) most = std::max(most, optimistic.best);
            if (elements)
                caught += text(
                    "%s%s (%s)", caught.empty() ? "" : ", ",
                    optimistic.to_the_end ? "not within the run" : "at " + percent(optimistic.best),
                    r.name());
            for (const std::string& cell :
                 {words_of(real), words_of(optimistic), percent(r.floor(method))})
                ahead_of.back().push_back(cell);
            for (Row row : by_method(r.rows, method)) {
                row.of["realistic"] = r.realistic_of({row});
                row.of["particles"] = error_at(r.particles, row["map_cpu_seconds"]);
                all.push_back(row);
            }
        }
        realistic += always;
    }
    page.set("ahead",
             table({"room", "exponent", "Halton", "ahead of shooting, realistic", "optimistic",
                    "floor", "of hierarchy, realistic", "optimistic", "floor"},
                   ahead_of));
    page.set("references",
             table({"room", "k", "exponent", "predicted", "measured", "", "error of the reference"},
                   references));
    page.data("radiosity-races",
              csv_of(all, {"elements", "unshot", "shots", "rays", "map_cpu_seconds", "realistic",
                           "optimistic", "particles"}));
    page.set("rooms", text("%zu of %zu", realistic, races.size()));
    page.set("flat", percent(flat)), page.set("hierarchy", percent(hierarchy));
    page.set("caught", caught);
}

void plot_races(Page& page, const std::vector<Race>& races) {
    Svg sheet(840, 360 * double(std::min<size_t>(3, races.size())));
    double top = 34;
    for (size_t k = 0; k < races.size(); ++k) {
        const Race& r = races[k];
        if (k + 1 < races.size() && races[k + 1].course.scene == r.course.scene) continue;
        const double end =
            std::max(r.realistic("shooting").seconds.back(), r.particles.seconds.back());
        Plot plot(sheet, {80, top}, {520, 270}, {"CPU seconds", 0.01, 1.3 * end},
                  {"error (d_rel)", 5e-4, 1}, r.name());
        auto curve = [&](const Curve& c, int colour, bool dashed, const std::string& words) {
            Curve shown;  // what the axes hold
            for (size_t i = 0; i < c.error.size(); ++i)
                if (c.error[i] >= 5e-4 && c.seconds[i] >= 0.01) shown.add(c.seconds[i], c.error[i]);
            plot.curve(shown.seconds, shown.error,
                       {.colour = svg::colours[colour], .dashed = dashed}, words);
        };
        curve(r.particles, 0, false, "particles");
        curve(r.halton, 1, false, "particles, Halton");
        for (const auto& [method, colour] : {std::pair("shooting", 2), {"hierarchy", 3}}) {
            curve(r.realistic(method), colour, false, method + std::string(", realistic"));
            curve(r.optimistic(method), colour, true, method + std::string(", optimistic"));
        }
        top += 360;
    }
    page.plot("radiosity-time", sheet);
}

// ---- Against the path tracer --------------------------------------------------------------------

// Without an end that is felt: .73^64 is 10^-9.
void tell_total(Page& page, const std::vector<Race>& races, const Rows& traced) {
    Curve path;
    for (const auto& [count, runs] : grouped(traced, of_count))
        path.add(mean(runs, "cpu_seconds"), relative_error(runs));
    const Power tracer = power_through(path);
    Lines lines;
    std::vector<double> H, limits;
    for (const Race& r : races) {
        if (r.course.scene != "cornell36") continue;
        const Rows shot = by_setting(r.rows, "hierarchy 0.01"),
                   walked = by_setting(r.rows, "halton 1/4");
        lines.push_back({text("%.0f", r.elements()), text("%g", r.course.H), percent(r.limit())});
        H.push_back(r.course.H), limits.push_back(r.limit());
        for (const Rows& runs : {shot, walked}) {
            const double error = std::sqrt(mean(runs, "total2")), s = mean(runs, "map_cpu_seconds"),
                         view = mean(runs, "cpu_seconds") - s, other = tracer.inverse(error),
                         n = cameras(s, view, other);
            for (const std::string& cell :
                 {percent(error), in_seconds(s), in_seconds(view), in_seconds(other),
                  std::isfinite(n) ? text("%.0f", n) : "never"})
                lines.back().push_back(cell);
        }
        for (const std::string& cell :
             {percent(r.realistic_of(shot)), percent(r.floor("hierarchy")),
              percent(shot[0]["optimistic"])})
            lines.back().push_back(cell);
    }
    page.set("total",
             table({"triangles", "H", "particles' limit", "hierarchy, 1 %: total", "seconds",
                    "a view", "path tracer", "cameras", "particles: total", "seconds", "a view",
                    "path tracer", "cameras", "realistic", "floor", "optimistic"},
                   lines));
    const double least = *std::min_element(limits.begin(), limits.end());
    page.set("limit-order", text("%.2f", slope(H, limits)));
    page.set("least-limit", percent(least));
    page.set("least-seconds", in_seconds(tracer.inverse(least)));
    page.set("traced-own", percent(traced[0]["own"]));
}

// ---- What it costs ------------------------------------------------------------------------------

void tell_growth(Page& page, const Scope& plan, const std::string& radiosity) {
    using List = std::vector<double>;
    RenderGrid grid("illumination-costs", radiosity, plan.kept);
    const List fine = plan.quick ? List{90, 50} : List{90, 50, 28, 16, 9};
    const List flat = plan.quick ? List{130, 90} : List{90, 65, 48, 35};
    Rows all;
    Lines orders;
    std::map<std::string, double> rays;  // exponents
    auto grow = [&](const std::string& scene, const std::string& method, const List& H) {
        std::vector<Setting> settings;
        for (double h : H)
            settings.push_back(
                {text("%s %g", method, h), text("--method %s --unshot 0.01 --mesh %g", method, h)});
        const Rows rows =
            grid.run({{scene, text("scenes/%s.scene --size 8x4", scene), 0}}, settings, {0}, 0);
        all.insert(all.end(), rows.begin(), rows.end());
        const List n = all_of(rows, "elements");
        orders.push_back({scene, method, text("%.0f–%.0f", n.front(), n.back())});
        std::vector<std::string> predicted;
        for (const char* what : {"shots", "rays", "map_cpu_seconds"}) {
            const List y = all_of(rows, what);
            const size_t k = n.size() - 2;
            const double last = slope({n[k], n[k + 1]}, {y[k], y[k + 1]});
            orders.back().push_back(text("n^%.2f (n^%.2f)", slope(n, y), last));
            predicted.push_back(text("%.2g", y.back() * std::pow(1e5 / n.back(), last)));
            if (what == std::string("rays")) rays[method] = slope(n, y);
        }
        orders.back().insert(orders.back().end(), predicted.begin(), predicted.end());
    };
    grow("cornell36", "shooting", flat), grow("cornell36", "hierarchy", fine);
    const double by_elements = rays["shooting"], by_faces = rays["hierarchy"];
    if (!plan.quick) grow("atelier", "hierarchy", {1.2, 0.295});
    page.set("growth", table({"scene", "method", "elements", "shots", "shadow rays", "seconds",
                              "shots at 100 000", "rays", "seconds"},
                             orders));
    page.data("radiosity-costs",
              csv_of(all, {"elements", "vertices", "shots", "rays", "map_cpu_seconds"}));
    page.set("growth-rays", text("n^%.2f to n^%.2f", by_elements, by_faces));
    page.set("growth-ok", plan.quick
                              ? "not by these meshes"
                              : page.verdict(by_faces < 1.15 && by_faces < by_elements - 0.3));
    // Whole faces beside elements, on the same triangles.
    std::string list;
    double most = 0;
    for (double H : plan.quick ? List{130} : List{90, 55}) {
        const Subject s{text("cornell36 %g", H),
                        text("scenes/cornell36.scene --rays 4 --mesh %g", H), 0,
                        "--method shooting --unshot 0.001"};
        const Row r = grid.run({s}, {{"faces", "--method hierarchy --unshot 0.001"}}, {0}, 0)[0];
        most = std::max(most, r["off"]);
        list += text("%s%.2f %% at %.0f", list.empty() ? "" : ", ", 100 * r["off"], r["elements"]);
    }
    page.set("apart", list), page.claim("apart-ok", most < 0.02);
}

// Core nanoseconds a ray of both programs, over seeds.
void tell_speed(Page& page, const Scope& plan, const std::string& penumbra,
                const std::string& radiosity) {
    RenderGrid grid("illumination-speed", penumbra, plan.kept);
    Lines lines;
    double most = 0;
    for (const auto& [scene, H, lights] :
         {std::tuple{"cornell36", 28.0, std::vector<std::string>{"none", "nee"}},
          {"atelier", 0.295, {"nee"}}})  // whose point light no path finds
        for (const std::string& light : lights) {
            const Rows rows =
                grid.run({{scene, text("scenes/%s.scene", scene), 0}},
                         {{light, text("--sets 1 --sampler independent --spp %d --light %s",
                                       plan.quick ? 2 : 12, light)},
                          {"particles",
                           text("--size 8x4 --method particles --sampler independent --mesh %g "
                                "--particles %d",
                                H, 1 << (plan.quick ? 19 : 22)),
                           radiosity}},
                         {0}, plan.quick ? 2 : 5);
            std::vector<double> paths, walks, ratio;
            for (const Row& r : by_setting(rows, light))
                paths.push_back(1e9 * r["cpu_seconds"] / r["rays"]);
            for (const Row& r : by_setting(rows, "particles"))
                walks.push_back(1e9 * r["map_cpu_seconds"] / r["rays"]);
            for (size_t k = 0; k < paths.size(); ++k) ratio.push_back(walks[k] / paths[k]);
            most = std::max(most, median(ratio));
            lines.push_back({scene, "--light " + light, with_range(paths, "%.0f"),
                             with_range(walks, "%.0f"), with_range(ratio, "%.2f")});
        }
    page.set("speed",
             table({"scene", "penumbra", "its core ns a ray", "particles'", "ratio"}, lines));
    page.set("speed-most", text("%.2f", most));
}

// ---- The report ---------------------------------------------------------------------------------

int study(const std::string& penumbra, const std::string& radiosity, const Scope& plan,
          const std::string& command) {
    Page page(report_folder(plan.quick), "radiosity");
    RenderGrid grid("illumination", radiosity, plan.kept);
    RenderGrid paths("illumination-paths", penumbra + " --depth 64", plan.kept);
    const Subject room{"cornell36", "scenes/cornell36.scene --size 128x64",
                       plan.quick ? 256u : 4096u};
    const Rows traced = paths.run({room}, {{"path tracer", "--sets 1"}}, {2, 4, 8, 16, 32, 64}, 2);
    const Truth* truth = plan.kept ? nullptr : &paths.truth(room);
    std::vector<Race> races;
    for (const Course& c : courses(plan))
        races.push_back(run_race(grid, c, c.scene == "cornell36" ? truth : nullptr, plan.kept));
    tell_races(page, races);
    plot_races(page, races);
    tell_total(page, races, traced);
    tell_growth(page, plan, radiosity);
    tell_speed(page, plan, penumbra, radiosity);
    page.set("made", made_by(command));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Scope plan;
    const Lab lab{"illumination",
                  "Compares deterministic and Monte Carlo illumination maps.",
                  {quick_flag(plan.quick), kept_flag(plan.kept)}};
    return lab_main(argc, argv, lab, [&] {
        return study(renderer_beside(lab, argv[0]), renderer_beside(lab, argv[0], "radiosity"),
                     plan, command_of(argc, argv));
    });
}

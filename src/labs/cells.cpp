// labs/cells.cpp  4  Voronoi cells a second, beside CGAL's Delaunay triangulation
//
//   build/cells [--quick]
#include "base/rng.h"
#include "labs/page.h"
#include "voronoi/voronoi.h"

#if __has_include(<CGAL/Delaunay_triangulation_2.h>)
#define CGAL_NDEBUG
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#define HAVE_CGAL true
#else
#define HAVE_CGAL false
#endif

namespace {

using Sites = std::vector<Site>;

using Where = Site (*)(Rng&);

Site anywhere(Rng& random) {
    const double x = random.uniform(), y = random.uniform();
    return {x, y};
}
Site on_a_line(Rng& random) {
    const double t = random.uniform();
    return {0.1 + 0.8 * t, 0.3 + 0.5 * t};
}
Site on_a_circle(Rng& random) {
    const double phi = 2 * std::numbers::pi * random.uniform();
    return {0.5 + 0.3 * std::cos(phi), 0.5 + 0.3 * std::sin(phi)};
}

Sites placed(size_t n, Where where, Rng& random) {
    Sites p;
    for (size_t i = 0; i < n; ++i) p.push_back(where(random));
    return p;
}

struct Ours {
    Voronoi cells = {};
    std::vector<Sites> sets;

    explicit Ours(const std::vector<Sites>& s) : sets(s) {}
    // Something that depends on the work, so that it is done.
    double run(size_t set) { return cells.clipped(sets[set], {{0, 0}, {1, 1}})[0].area; }
};

#if HAVE_CGAL
struct Theirs {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Triangulation = CGAL::Delaunay_triangulation_2<Kernel>;
    std::vector<std::vector<Kernel::Point_2>> sets;

    explicit Theirs(const std::vector<Sites>& s) {
        for (const auto& set : s) {
            sets.emplace_back();
            for (const Site& p : set) sets.back().push_back({p.x, p.y});
        }
    }
    double run(size_t set) {
        Triangulation t;
        t.insert(sets[set].begin(), sets[set].end());
        return double(t.number_of_vertices());
    }
};
#else
using Theirs = Ours;  // to be compiled, never run
#endif

// Nanoseconds a site, over about as many sites.
template <class Runner>
double time_of(Runner& runner, size_t sites) {
    const size_t n = runner.sets[0].size(), times = std::max<size_t>(1, sites / n);
    const double start = processor_seconds();
    double sum = 0;
    for (size_t k = 0; k < times; ++k) sum += runner.run(k % runner.sets.size());
    if (!(sum > 0)) throw SystemError("no cells");
    return (processor_seconds() - start) / double(times * n) * 1e9;
}

// Adds the line of n sites; our nanoseconds a site.
double race(std::vector<std::vector<std::string>>& lines, size_t n, size_t sites, size_t rounds) {
    Rng random{mix(n)};
    std::vector<Sites> sets;
    for (size_t k = 0; k < std::clamp<size_t>(sites / n, 1, 64); ++k)
        sets.push_back(placed(n, anywhere, random));
    Ours ours(sets);
    Theirs theirs(sets);
    std::vector<double> a, b, ratio;
    for (size_t round = 0; round < rounds; ++round) {
        a.push_back(time_of(ours, sites));
        if (!HAVE_CGAL) continue;
        b.push_back(time_of(theirs, sites));
        ratio.push_back(a.back() / b.back());
    }
    lines.push_back({text("%zu", n), text("%.0f", median(a)),
                     HAVE_CGAL ? text("%.0f", median(b)) : "–",
                     HAVE_CGAL ? with_range(ratio, "%.2f") : "–"});
    return median(a);
}

// p of all sites' time, n^p.
double exponent(Where where, const std::vector<double>& counts) {
    std::vector<double> seconds;
    for (double n : counts) {
        Rng random{mix(uint64_t(n))};
        Ours ours({placed(size_t(n), where, random)});
        std::vector<double> times;
        for (int round = 0; round < 3; ++round) times.push_back(n * time_of(ours, 1));
        seconds.push_back(median(times));
    }
    return slope(counts, seconds);
}

int run(bool quick, const std::string& command) {
    const size_t rounds = quick ? 3 : 15, sites = quick ? 20000 : 200000;
    Page page(report_folder(quick), "cells");
    std::vector<std::vector<std::string>> lines;
    double at_256 = 0, last = 0;
    for (size_t n : {64, 256, 1024, 4096, 65536}) {
        last = race(lines, n, sites, rounds);
        if (n == 256) at_256 = last;
    }
    using Counts = std::vector<double>;
    const double line = exponent(on_a_line, quick ? Counts{1000, 4000} : Counts{2000, 8000, 32000}),
                 circle =
                     exponent(on_a_circle, quick ? Counts{500, 1000} : Counts{1000, 2000, 4000});
    page.set("verdict",
             HAVE_CGAL ? text("%.0f ns per site of %s, %s times the time of CGAL.", last,
                              lines.back()[0], lines.back()[3])
                       : "CGAL was not measured: its headers are missing (Debian: libcgal-dev).");
    page.set("table", table({"sites", "areas, ns per site", "CGAL, ns per site", "ratio"}, lines));
    page.set("growth", text("%.2f", last / at_256));
    page.set("line", text("%.2f", line));
    page.set("circle", text("%.2f", circle));
    page.set("lanes", text("%d", cell::lanes));
    page.set("rounds", text("%zu", rounds));
    page.set("sites", text("%zu", sites));
    page.set("made", made_by(command));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false;
    const Lab lab{"cells",
                  "Measures Voronoi cells a second, beside CGAL if it is installed.",
                  {quick_flag(quick)}};
    return lab_main(argc, argv, lab, [&] { return run(quick, command_of(argc, argv)); });
}

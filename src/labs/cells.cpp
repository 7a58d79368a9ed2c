// labs/cells.cpp  3  how many Voronoi cells a second?
//
//   build/cells [--quick]
//
// Nanoseconds a site, on one thread, of the areas of all cells in a square, and of CGAL's Delaunay
// triangulation of the same sites (range insertion, exact predicates, without its own checks) where
// Debian's libcgal-dev is installed: that has no areas yet.  The two take turns, so that a busy
// machine slows both, and the time is that of the processor.
#include "base/rng.h"
#include "labs/lab.h"
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

// Adds the row of n sites; our nanoseconds a site.
double race(Report& report, size_t n, size_t sites, size_t rounds) {
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
    report.row({text("%zu", n), text("%.0f", median(a)), HAVE_CGAL ? text("%.0f", median(b)) : "–",
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

int run(bool quick) {
    const size_t rounds = quick ? 3 : 15, sites = quick ? 20000 : 200000;
    Report report(report_folder(quick), "cells");
    report.say(text(R"(# Voronoi cells a second

The areas of all cells of random sites in a square are measured beside CGAL's Delaunay triangulation of
the same sites (range insertion, exact predicates), which has no areas yet, on one thread.  CGAL's own
checks are off, as in its release builds.  The two take turns; times are nanoseconds a site of the
processor, medians of %zu rounds of some %zu sites, and ratios are taken round by round, with the least
and the greatest in brackets.)",
                    rounds, sites));
    if (!HAVE_CGAL)
        report.say(
            "CGAL was not measured: its header `CGAL/Delaunay_triangulation_2.h` is missing "
            "(Debian: libcgal-dev).");
    report.head({"sites", "areas, ns a site", "CGAL, ns a site", "ratio"});
    double at_256 = 0, last = 0;
    for (size_t n : {64, 256, 1024, 4096, 65536}) {
        last = race(report, n, sites, rounds);
        if (n == 256) at_256 = last;
    }
    report.end_of_table();
    report.say(text(
        R"(A site at 65536 costs %.2f times one at 256; other work on the machine takes the caches, and more.
That is with vectors of %d numbers, and with fewer (`make cells ARCH=haswell`: 4, `ARCH=x86-64`: 2) it
takes longer.  Sites along a line take time like n^%.2f, on one circle, whose cells all meet in its
centre, like n^%.2f.  Half of the time of scattered sites goes into the walk from bisector to bisector
(`perf record`).)",
        last / at_256, cell::lanes,
        exponent(on_a_line,
                 quick ? std::vector<double>{1000, 4000} : std::vector<double>{2000, 8000, 32000}),
        exponent(on_a_circle,
                 quick ? std::vector<double>{500, 1000} : std::vector<double>{1000, 2000, 4000})));
    report.say(made_by(quick ? "build/cells --quick" : "build/cells"));
    return report.finish();
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false;
    const Lab lab{"cells",
                  "Measures Voronoi cells a second, beside CGAL if it is installed.",
                  {quick_flag(quick)}};
    return lab_main(argc, argv, lab, [&] { return run(quick); });
}

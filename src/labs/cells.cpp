// labs/cells.cpp  4  Voronoi cells per second, compared with CGAL's Delaunay triangulation
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

// Returns a number that depends on the work, so that the compiler cannot remove the work.
double our_cells(const Sites& sites) {
    static Voronoi cells;
    return cells.clipped(sites, {{0, 0}, {1, 1}})[0].area;
}

#if HAVE_CGAL
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using TheirSites = std::vector<Kernel::Point_2>;
double their_triangles(const TheirSites& sites) {
    CGAL::Delaunay_triangulation_2<Kernel> t;
    t.insert(sites.begin(), sites.end());
    return double(t.number_of_vertices());
}
#else
using TheirSites = Sites;  // compiles without CGAL, but never runs
double their_triangles(const TheirSites& sites) { return our_cells(sites); }
#endif

// CPU time per site in nanoseconds, measured over about `sites` sites.
template <class Set, class Run>
double time_of(const std::vector<Set>& sets, size_t sites, Run run) {
    const size_t n = sets[0].size(), times = std::max<size_t>(1, sites / n);
    const double start = processor_seconds();
    double sum = 0;
    for (size_t k = 0; k < times; ++k) sum += run(sets[k % sets.size()]);
    if (!(sum > 0)) throw SystemError("no cells");
    return (processor_seconds() - start) / double(times * n) * 1e9;
}

// The table line for n sites.
std::vector<std::string> race(size_t n, size_t sites, size_t rounds) {
    Rng random{mix(n)};
    std::vector<Sites> sets(std::clamp<size_t>(sites / n, 1, 64));
    std::vector<TheirSites> theirs(sets.size());
    for (size_t k = 0; k < sets.size(); ++k)
        for (size_t i = 0; i < n; ++i) {
            const double x = random.uniform(), y = random.uniform();
            sets[k].push_back({x, y}), theirs[k].push_back({x, y});
        }
    std::vector<double> a, b, ratio;
    for (size_t round = 0; round < rounds; ++round) {
        a.push_back(time_of(sets, sites, our_cells));
        if (!HAVE_CGAL) continue;
        b.push_back(time_of(theirs, sites, their_triangles));
        ratio.push_back(a.back() / b.back());
    }
    return {text("%zu", n), text("%.0f", median(a)), HAVE_CGAL ? text("%.0f", median(b)) : "–",
            HAVE_CGAL ? with_range(ratio, "%.2f") : "–"};
}

int study(const Scope& scope) {
    const size_t sites = scope.quick ? 20000 : 200000, rounds = scope.quick ? 3 : 15;
    Page page(scope, "cells");
    Lines lines;
    for (size_t n : {64, 256, 1024, 4096, 65536}) lines.push_back(race(n, sites, rounds));
    const std::vector<std::string>& last = lines.back();
    page.set("verdict",
             HAVE_CGAL ? text("%s ns per site of %s, %s times the time of CGAL.", last[1], last[0],
                              last[3])
                       : "CGAL was not measured: its headers are missing (Debian: libcgal-dev).");
    page.set("table", table({"sites", "areas, ns per site", "CGAL, ns per site", "ratio"}, lines));
    page.set("lanes", text("%d", cell::lanes));
    page.set("rounds", text("%zu", rounds)), page.set("sites", text("%zu", sites));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    return experiment(
        argc, argv, {"cells", "Measures Voronoi cells per second, compared with CGAL if present."},
        study);
}

// labs/cells.cpp  3  how many Voronoi cells a second?
//
//   build/cells [--quick]
//
// Nanoseconds a site, on one thread, of the areas of all cells in a square, and of CGAL's Delaunay
// triangulation of the same sites (range insertion, exact predicates; its own checks are off if
// compiled with -DCGAL_NDEBUG) where Debian's libcgal-dev is installed: that has no areas yet.  The
// two take turns, so that a busy machine slows both, and the time is that of the processor. Medians
// of the rounds; ratios are taken round by round, their least and greatest in brackets.
#include <cstdio>
#include <ctime>

#include "base/program.h"
#include "base/rng.h"
#include "base/words.h"
#include "voronoi/voronoi.h"

#if __has_include(<CGAL/Delaunay_triangulation_2.h>)
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#define HAVE_CGAL true
#else
#define HAVE_CGAL false
#endif

namespace {

double seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }  // of the processor

std::vector<Site> scattered(size_t n, Rng& random) {
    std::vector<Site> p;
    for (size_t i = 0; i < n; ++i) {
        const double x = random.uniform(), y = random.uniform();
        p.push_back({x, y});
    }
    return p;
}

struct Ours {
    Voronoi cells;
    std::vector<std::vector<Site>> sets;

    explicit Ours(const std::vector<std::vector<Site>>& s) : sets(s) {}
    // Something that depends on the work, so that it is done.
    double run(size_t set) { return cells.clipped(sets[set], {{0, 0}, {1, 1}})[0].area; }
};

#if HAVE_CGAL
struct Theirs {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Triangulation = CGAL::Delaunay_triangulation_2<Kernel>;
    std::vector<std::vector<Kernel::Point_2>> sets;

    explicit Theirs(const std::vector<std::vector<Site>>& s) {
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
    const double start = seconds();
    double sum = 0;
    for (size_t k = 0; k < times; ++k) sum += runner.run(k % runner.sets.size());
    if (!(sum > 0)) throw SystemError("no cells");
    return (seconds() - start) / double(times * n) * 1e9;
}

double median(std::vector<double> x) {
    std::sort(x.begin(), x.end());
    return (x[(x.size() - 1) / 2] + x[x.size() / 2]) / 2;
}

int bench(const std::vector<std::string>& words) {
    size_t rounds = 15, sites = 200000;
    for (const std::string& word : words) {
        if (word != "--quick") throw UserError(unknown("option", word, {"--quick"}));
        rounds = 3, sites = 20000;
    }
    std::printf(
        "\n| sites | areas of cells, ns a site | CGAL's triangulation, ns a site | ratio |\n"
        "|---|---|---|---|\n");
    std::vector<double> at_256, at_65536;
    for (size_t n : {64, 256, 1024, 4096, 65536}) {
        Rng random{mix(n)};
        std::vector<std::vector<Site>> sets;
        for (size_t k = 0; k < std::clamp<size_t>(sites / n, 1, 64); ++k)
            sets.push_back(scattered(n, random));
        Ours ours(sets);
        Theirs theirs(sets);
        std::vector<double> a, b, ratio;
        for (size_t round = 0; round < rounds; ++round) {
            a.push_back(time_of(ours, sites));
            if (!HAVE_CGAL) continue;
            b.push_back(time_of(theirs, sites));
            ratio.push_back(a.back() / b.back());
        }
        if (n == 256) at_256 = a;
        if (n == 65536) at_65536 = a;
        std::printf("| %zu | %.0f |", n, median(a));
        if (HAVE_CGAL) {
            const auto [least, most] = std::minmax_element(ratio.begin(), ratio.end());
            std::printf(" %.0f | %.2f (%.2f–%.2f) |\n", median(b), median(ratio), *least, *most);
        } else {
            std::printf(" – | – |\n");
        }
        std::fflush(stdout);
    }
    std::printf("\nns a site at 65536 over that at 256: %.2f\n", median(at_65536) / median(at_256));
    if (!HAVE_CGAL)
        std::printf(
            "Without CGAL: there is no <CGAL/Delaunay_triangulation_2.h> (Debian: "
            "libcgal-dev).\n");
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return bench({argv + 1, argv + argc}); });
}

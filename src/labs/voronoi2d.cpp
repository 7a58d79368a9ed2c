// labs/voronoi2d.cpp  5  cost and gain of Voronoi cells for integrals over a square
//
//   build/voronoi2d [--trials N] [--quick]
//
// Integrates functions on [-1/2, 1/2]^2 from N points, by the weights of weights.h, jittered strata
// and scrambled Halton points.  Follows Table 2 of Vandewiele et al. 2025, "Voronoi integration of
// the rendering equation".
#include "labs/rows.h"
#include "labs/voronoi_functions.h"
#include "path/halton.h"
#include "voronoi/weights.h"

namespace {
using namespace penumbra;

const std::vector<Function> list = functions::all();
using Values = std::vector<double>;  // of a function at points

enum class Points { independent, jittered, halton, poisson };  // poisson: N on average
enum class Summation { weighted, corrected, linear };

struct Estimator {
    std::string name;
    Points points;
    Weighting weighting = Weighting::mc;
    bool divide = true;
    Summation sum = Summation::weighted;
};
const std::vector<Estimator> estimators = {
    {"mc", Points::independent},
    {"vor", Points::independent, Weighting::vor},
    {"vor, undivided", Points::independent, Weighting::vor, false},
    {"fvor", Points::independent, Weighting::fvor},
    {"cvor", Points::independent, Weighting::cvor},
    {"cvor, corrected", Points::independent, Weighting::cvor, true, Summation::corrected},
    {"cvor, linear", Points::independent, Weighting::cvor, true, Summation::linear},
    {"torus", Points::independent, Weighting::torus},
    {"stratified", Points::jittered},
    {"Halton", Points::halton},
    {"vor, Poisson", Points::poisson, Weighting::vor},
    {"vor, Poisson, undivided", Points::poisson, Weighting::vor, false},
};

// ---- Samples ------------------------------------------------------------------------------------

std::vector<Site> draw(Points kind, uint64_t n, Rng& random) {
    std::vector<Site> p(kind == Points::poisson ? poisson(double(n), random) : n);
    if (kind == Points::halton) {
        const uint64_t a = random.bits(), b = random.bits(), c = random.bits(), d = random.bits();
        for (uint64_t i = 0; i < n; ++i)
            p[i] = {double(scrambled_radical_inverse(2, i, a, b)),
                    double(scrambled_radical_inverse(3, i, c, d))};
        return p;
    }
    for (Site& site : p) {
        const double x = random.uniform(), y = random.uniform();
        site = {x, y};
    }
    const auto side = uint64_t(std::lround(std::sqrt(double(n))));  // every N is a square
    for (uint64_t i = 0; i < n && kind == Points::jittered; ++i)
        p[i] = {(double(i % side) + p[i].x) / double(side),
                (double(i / side) + p[i].y) / double(side)};
    return p;
}

// ---- Estimates ----------------------------------------------------------------------------------

// Estimates of all integrals, and the CPU time of the first.
struct Estimates {
    Values values = {};
    double seconds = 0;
};
Estimates estimated(const Estimator& e, std::span<const Site> places, const std::vector<Values>& f,
                    Weigher& weigher, uint64_t key) {
    const double start = processor_seconds();
    Estimates all;
    std::vector<VoronoiCell> cells;
    Values w;
    weigher.divide = e.divide;
    weigher.cells.with_neighbours = e.sum != Summation::weighted;
    if (places.empty()) return {Values(f.size())};
    if (e.sum == Summation::weighted)
        w = weigher(e.weighting, places, key);
    else
        for (cells = weigher.cells.clipped(places, {{0, 0}, {1, 1}}); const VoronoiCell& c : cells)
            w.push_back(c.area);
    for (const Values& g : f) {
        double x = e.sum == Summation::linear
                       ? linear_reconstruction(weigher.cells, cells, places, g)
                       : std::inner_product(w.begin(), w.end(), g.begin(), 0.0);
        if (e.sum == Summation::corrected) x += border_correction(weigher.cells, cells, places, g);
        all.values.push_back(x);
        if (all.values.size() == 1) all.seconds = processor_seconds() - start;
    }
    return all;
}

// Statistics of all estimates by one estimator.
struct Tally {
    std::vector<Moments> error{list.size()};
    double seconds = 0;  // CPU time of holder_1
};

Rows run_all(uint64_t trials) {
    Rows rows;
    for (uint64_t n : {64, 256, 1024, 4096}) {
        std::vector<Tally> all(estimators.size());
        Weigher weigher;
        for (uint64_t t = 0; t < trials; ++t) {
            Rng random{mix(hash(n, t))};
            for (Points kind :
                 {Points::independent, Points::jittered, Points::halton, Points::poisson}) {
                const double start = processor_seconds();
                const std::vector<Site> places = draw(kind, n, random);
                std::vector<Values> f(list.size());
                double seconds = 0;
                for (size_t k = 0; k < list.size(); ++k) {
                    for (Site p : places) f[k].push_back(list[k].at({p.x - 0.5, p.y - 0.5}));
                    if (k == 0) seconds = processor_seconds() - start;
                }
                weigher.intensity = kind == Points::poisson ? double(n) : 0;
                for (size_t e = 0; e < estimators.size(); ++e) {
                    if (estimators[e].points != kind) continue;
                    const Estimates x = estimated(estimators[e], places, f, weigher, random.bits());
                    all[e].seconds += seconds + x.seconds;
                    for (size_t k = 0; k < list.size(); ++k)
                        all[e].error[k].add(x.values[k] - list[k].integral);
                }
            }
        }
        for (size_t e = 0; e < estimators.size(); ++e)
            for (size_t k = 0; k < list.size(); ++k) {
                const Moments& m = all[e].error[k];
                rows.push_back({list[k].name,
                                estimators[e].name,
                                n,
                                0,
                                {{"error", std::sqrt(m.mean * m.mean + m.m2 / double(m.n))},
                                 {"deviation", std::sqrt(m.variance())},
                                 {"bias", m.mean},
                                 {"standard error", m.standard_error()},
                                 {"seconds", all[e].seconds / double(trials)}}});
            }
    }
    return rows;
}

// ---- Report -------------------------------------------------------------------------------------

void tell_findings(Page& page, const Rows& rows, const Rows& last) {
    auto of = [&](const char* function, const char* estimator, const char* number) {
        return by_setting(in_scene(last, function), estimator)[0][number];
    };
    auto sd = [&](const char* f, const char* e) { return of(f, e, "deviation"); };
    auto set = [&](const char* word, const char* format, double x) {
        page.set(word, text(format, x));
    };
    const double once = sd("holder_0.01", "mc"), undivided = sd("holder_0.01", "vor, undivided"),
                 divided = sd("holder_0.01", "vor");
    page.claim("divided", undivided > 3 * once && divided < once);
    set("undivided deviation", "%.1f", undivided / once);
    set("divided deviation", "%.2f", divided / once);
    page.claim("row", std::abs(sd("not_c1", "mc") / 0.000585 - 1) < 0.15 &&
                          sd("not_holder", "mc") > 0.003);
    page.set("row numbers",
             text("%.6f and %.6f; not_holder has %.5f and %.5f", sd("not_c1", "mc"),
                  sd("not_c1", "vor"), sd("not_holder", "mc"), sd("not_holder", "vor")));
    auto exponent = [&](const char* estimator) {
        const Rows all = by_setting(in_scene(rows, "hat"), estimator);
        Values n;
        for (const Row& r : all) n.push_back(double(r.count));
        return slope(n, all_of(all, "deviation"));
    };
    const double steep = exponent("vor, Poisson, undivided"), flat = exponent("vor, Poisson");
    page.claim("theory", steep < -1 && flat > -0.9);
    set("steep", "%.2f", steep), set("flat", "%.2f", flat);
    Values gains;
    for (const Function& f : list)
        gains.push_back(of(f.name.c_str(), "vor", "error") / of(f.name.c_str(), "cvor", "error"));
    page.claim("clipping", quantile(gains, 0) > 1);
    page.set("clipping gains", text("%.1f to %.0f", quantile(gains, 0), quantile(gains, 1)));
    auto cost = [&](const char* e) {
        return std::pow(of("holder_1", e, "error"), 2) * of("holder_1", e, "seconds");
    };
    const double n = double(last[0].count);
    set("cell", "%.2f",
        1e6 * (of("holder_1", "cvor", "seconds") - of("holder_1", "mc", "seconds")) / n);
    for (const char* e : {"cvor", "cvor, corrected", "stratified"})
        set((std::string("gain ") + e).c_str(), "%.0f", cost("mc") / cost(e));
    set("corrected holder", "%.2f",
        of("holder_1", "stratified", "error") / of("holder_1", "cvor, corrected", "error"));
    page.set("bias", text("%+.4f ± %.4f of %+.4f", n * of("holder_1", "cvor", "bias"),
                          n * of("holder_1", "cvor", "standard error"),
                          -list[0].rim / (4 * std::numbers::pi)));
}

int study(const Scope& scope, uint64_t trials) {
    Page page(scope, "voronoi2d");
    const Rows rows = run_all(trials);
    const Rows last = where(rows, [&](const Row& r) { return r.count == rows.back().count; });
    auto error = [](const Rows& r) { return r[0]["error"]; };
    page.set("N", of_count(last[0])), page.set("trials", text("%.0f", double(trials)));
    page.set("errors", table(last, of_setting, of_scene,
                             [&](const Rows& r) { return text("%.1e", error(r)); }));
    page.data("voronoi2d",
              csv_of(rows, {"error", "deviation", "bias", "standard error", "seconds"}));
    const Rows drawn = where(in_scene(rows, "holder_1"), [](const Row& r) {  // of eight colours
        return r.setting != "fvor" && r.setting != "torus" &&
               !r.setting.starts_with("vor, Poisson");
    });
    page.plot("voronoi2d",
              plot(drawn, "points, N", "RMSE", of_setting, count_of, mean_of("error"), "holder_1"));
    tell_findings(page, rows, last);
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    uint64_t trials = 2000;
    const Lab lab{"voronoi2d",
                  "Integrates functions over a square by Voronoi cells, strata and Halton points.",
                  {whole_number("--trials", "estimates of each kind", "2000", trials, 2, 1000000)}};
    return experiment(argc, argv, lab,
                      [&](const Scope& scope) { return study(scope, scope.quick ? 50 : trials); });
}

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

const std::vector<Function> list = functions::all();
using Values = std::vector<double>;  // of a function at points

enum class Points { independent, jittered, halton, poisson };  // poisson: N on average
enum class Kind { plain, weighted, corrected, linear };

struct Estimator {
    std::string name;
    Points points;
    Kind sum = Kind::plain;
    Weighting weighting = Weighting::mc;
    bool divide = true;
};
const std::vector<Estimator> estimators = {
    {"mc", Points::independent},
    {"vor", Points::independent, Kind::weighted, Weighting::vor},
    {"vor, undivided", Points::independent, Kind::weighted, Weighting::vor, false},
    {"fvor", Points::independent, Kind::weighted, Weighting::fvor},
    {"cvor", Points::independent, Kind::weighted, Weighting::cvor},
    {"cvor, corrected", Points::independent, Kind::corrected, Weighting::cvor},
    {"cvor, linear", Points::independent, Kind::linear, Weighting::cvor},
    {"torus", Points::independent, Kind::weighted, Weighting::torus},
    {"stratified", Points::jittered},
    {"Halton", Points::halton},
    {"vor, Poisson", Points::poisson, Kind::weighted, Weighting::vor},
    {"vor, Poisson, undivided", Points::poisson, Kind::weighted, Weighting::vor, false},
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

struct Samples {
    std::vector<Site> places;
    std::vector<Values> values{list.size()};  // of every function at `places`
    Values seconds = Values(list.size());     // CPU time of places and values
};

Samples sample(Points kind, uint64_t n, Rng& random) {
    Samples s;
    double start = processor_seconds();
    s.places = draw(kind, n, random);
    const double drawn = processor_seconds() - start;
    for (size_t k = 0; k < list.size(); ++k) {
        s.values[k].reserve(s.places.size());
        start = processor_seconds();
        for (Site p : s.places) s.values[k].push_back(list[k].at({p.x - 0.5, p.y - 0.5}));
        s.seconds[k] = processor_seconds() - start + drawn;
    }
    return s;
}

// ---- Estimates ----------------------------------------------------------------------------------

// Returns a function that estimates an integral from the values at these places.
std::function<double(const Values&)> prepared(const Estimator& e, std::span<const Site> places,
                                              Weigher& weigher, uint64_t key) {
    weigher.divide = e.divide;
    weigher.cells.with_neighbours = e.sum == Kind::corrected || e.sum == Kind::linear;
    if (places.empty()) return [](const Values&) { return 0.0; };
    if (e.sum == Kind::plain || e.sum == Kind::weighted)
        return [&w = weigher(e.weighting, places, key)](const Values& f) {
            return std::inner_product(w.begin(), w.end(), f.begin(), 0.0);
        };
    const auto& cells = weigher.cells.clipped(places, {{0, 0}, {1, 1}});
    if (e.sum == Kind::linear)
        return [&weigher, &cells, places](const Values& f) {
            return linear_reconstruction(weigher.cells, cells, places, f);
        };
    return [&weigher, &cells, places](const Values& f) {
        double sum = 0;
        for (size_t i = 0; i < f.size(); ++i) sum += cells[i].area * f[i];
        return sum + border_correction(weigher.cells, cells, places, f);
    };
}

// Statistics of all estimates of one integral by one estimator.
struct Tally {
    Moments error;
    Values sizes;  // absolute errors
    double seconds = 0;

    // `error` is the RMSE, or the median error if the function has no variance.
    Row row(const Function& f, const Estimator& e, uint64_t n) const {
        const double count = double(error.n),
                     rmse = std::sqrt(error.mean * error.mean + error.m2 / count);
        return {f.name,
                e.name,
                n,
                0,
                {{"error", f.has_variance ? rmse : median(sizes)},
                 {"deviation", std::sqrt(error.variance())},
                 {"bias", error.mean},
                 {"standard error", error.standard_error()},
                 {"seconds", seconds / count}}};
    }
};

Rows run_all(uint64_t trials) {
    Rows rows;
    Steps steps(4);
    for (uint64_t n : {64, 256, 1024, 4096}) {
        steps.next(text("%d points", int(n)));
        std::vector<std::vector<Tally>> all(estimators.size(), std::vector<Tally>(list.size()));
        Weigher weigher;
        for (uint64_t t = 0; t < trials; ++t) {
            Rng random{mix(hash(n, t))};
            for (Points kind :
                 {Points::independent, Points::jittered, Points::halton, Points::poisson}) {
                const Samples s = sample(kind, n, random);
                weigher.intensity = kind == Points::poisson ? double(n) : 0;
                for (size_t e = 0; e < estimators.size(); ++e) {
                    if (estimators[e].points != kind) continue;
                    double start = processor_seconds();
                    const auto estimate = prepared(estimators[e], s.places, weigher, random.bits());
                    const double took = processor_seconds() - start;
                    for (size_t k = 0; k < list.size(); ++k) {
                        Tally& tally = all[e][k];
                        start = processor_seconds();
                        const double error = estimate(s.values[k]) - list[k].integral;
                        tally.seconds += processor_seconds() - start + took + s.seconds[k];
                        tally.error.add(error), tally.sizes.push_back(std::abs(error));
                    }
                }
            }
        }
        for (size_t e = 0; e < estimators.size(); ++e)
            for (size_t k = 0; k < list.size(); ++k)
                rows.push_back(all[e][k].row(list[k], estimators[e], n));
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
        if (f.has_variance)
            gains.push_back(of(f.name.c_str(), "vor", "error") /
                            of(f.name.c_str(), "cvor", "error"));
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
    page.plot("voronoi2d", plot(in_scene(rows, "holder_1"), "points, N", "rmse", of_setting,
                                count_of, mean_of("error"), "holder_1"));
    tell_findings(page, rows, last);
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    uint64_t trials = 2000;
    const Lab lab{"voronoi2d",
                  "Integrates functions over a square by Voronoi cells, strata and Halton points.",
                  {{"--trials", "N", "estimates of each kind (2000)",
                    [&](auto& word) { trials = parse_count(word, 2, 1000000); }}}};
    return experiment(argc, argv, lab,
                      [&](const Scope& scope) { return study(scope, scope.quick ? 50 : trials); });
}

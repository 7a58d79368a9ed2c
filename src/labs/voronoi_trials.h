// labs/voronoi_trials.h  3  integrals of functions over a square by every estimator, for voronoi2d
#pragma once
#include <array>
#include <functional>
#include <numeric>

#include "base/stats.h"
#include "labs/lab.h"
#include "labs/voronoi_functions.h"
#include "path/halton.h"
#include "voronoi/weights.h"

namespace trials {

inline const std::vector<Function> list = functions::all();
using Values = std::vector<double>;  // of a function, at places

enum class Points { independent, jittered, halton, poisson };  // poisson: N on average
enum class Sum { plain, weighted, corrected, linear };

struct Estimator {
    const char* name;
    Points points;
    Sum sum = Sum::plain;
    Weighting weighting = Weighting::mc;
    bool divide = true;
};
inline constexpr std::array<Estimator, 14> estimators = {{
    {"mc", Points::independent},
    {"vor", Points::independent, Sum::weighted, Weighting::vor},
    {"vor, undivided", Points::independent, Sum::weighted, Weighting::vor, false},
    {"fvor", Points::independent, Sum::weighted, Weighting::fvor},
    {"fvor, undivided", Points::independent, Sum::weighted, Weighting::fvor, false},
    {"cvor", Points::independent, Sum::weighted, Weighting::cvor},
    {"cvor, corrected", Points::independent, Sum::corrected, Weighting::cvor},
    {"cvor, linear", Points::independent, Sum::linear, Weighting::cvor},
    {"torus", Points::independent, Sum::weighted, Weighting::torus},
    {"stratified", Points::jittered},
    {"Halton", Points::halton},
    {"mc, Poisson", Points::poisson},
    {"vor, Poisson", Points::poisson, Sum::weighted, Weighting::vor},
    {"vor, Poisson, undivided", Points::poisson, Sum::weighted, Weighting::vor, false},
}};
// Their numbers in that list.
inline constexpr size_t mc = 0, vor = 1, vor_area = 2, cvor = 5, cvor_corrected = 6,
                        cvor_linear = 7, torus = 8, stratified = 9, halton = 10, poisson_vor = 12,
                        poisson_area = 13;

// All estimates of one integral by one estimator.
struct Estimates {
    Moments error;
    Values sizes;  // of errors
    double seconds = 0;

    double bias() const { return error.mean; }
    double deviation() const { return std::sqrt(error.variance()); }
    double rmse() const { return std::sqrt(error.mean * error.mean + error.m2 / double(error.n)); }
    double median_error() const { return median(sizes); }
    double time() const { return seconds / double(error.n); }
    double cost() const { return rmse() * rmse() * time(); }
};

struct Series {
    uint64_t n = 0;
    std::vector<std::array<Estimates, estimators.size()>> of{list.size()};  // by function
    uint64_t redraws = 0, strips = 0, unsettled = 0, cells = 0, none = 0;   // see Weigher
};

// ---- Samples ------------------------------------------------------------------------------------

inline std::vector<Site> draw(Points kind, uint64_t n, Rng& random) {
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
    const auto side = uint64_t(std::lround(std::sqrt(double(n))));  // all N are squares
    for (uint64_t i = 0; i < n && kind == Points::jittered; ++i)
        p[i] = {(double(i % side) + p[i].x) / double(side),
                (double(i / side) + p[i].y) / double(side)};
    return p;
}

struct Samples {
    std::vector<Site> places;
    std::vector<Values> values{list.size()};  // of every function, there
    Values seconds = Values(list.size());     // that all this took
};

inline Samples sample(Points kind, uint64_t n, Rng& random) {
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

// What makes an estimate of the values at these places.
inline std::function<double(const Values&)> prepared(const Estimator& e,
                                                     std::span<const Site> places, Weigher& weigher,
                                                     uint64_t key) {
    weigher.divide = e.divide;
    weigher.cells.with_neighbours = e.sum == Sum::corrected || e.sum == Sum::linear;
    if (places.empty()) return [](const Values&) { return 0.0; };
    if (e.sum == Sum::plain)
        return [](const Values& f) {
            return std::accumulate(f.begin(), f.end(), 0.0) / double(f.size());
        };
    if (e.sum == Sum::weighted)
        return [&w = weigher(e.weighting, places, key)](const Values& f) {
            return std::inner_product(w.begin(), w.end(), f.begin(), 0.0);
        };
    const auto& cells = weigher.cells.clipped(places, {{0, 0}, {1, 1}});
    if (e.sum == Sum::linear)
        return [&weigher, &cells, places](const Values& f) {
            return linear_reconstruction(weigher.cells, cells, places, f);
        };
    return [&weigher, &cells, places](const Values& f) {
        double sum = 0;
        for (size_t i = 0; i < f.size(); ++i) sum += cells[i].area * f[i];
        return sum + border_correction(weigher.cells, cells, places, f);
    };
}

// Adds one estimate of every function.
inline void add(Series& series, size_t e, const Samples& s, Weigher& weigher, uint64_t key) {
    double start = processor_seconds();
    const auto estimate = prepared(estimators[e], s.places, weigher, key);
    const double took = processor_seconds() - start;
    for (size_t k = 0; k < list.size(); ++k) {
        Estimates& tally = series.of[k][e];
        start = processor_seconds();
        const double error = estimate(s.values[k]) - list[k].integral;
        tally.seconds += processor_seconds() - start + took + s.seconds[k];
        tally.error.add(error);
        tally.sizes.push_back(std::abs(error));
    }
}

// Adds one estimate of every function by every estimator.
inline void run(Series& series, Weigher& weigher, uint64_t seed) {
    Rng random{mix(seed)};
    for (Points kind : {Points::independent, Points::jittered, Points::halton, Points::poisson}) {
        const Samples s = sample(kind, series.n, random);
        weigher.intensity = kind == Points::poisson ? double(series.n) : 0;
        for (size_t e = 0; e < estimators.size(); ++e) {
            if (estimators[e].points != kind) continue;
            const Weighting by = estimators[e].weighting;
            const bool strip = by == Weighting::vor || by == Weighting::fvor;
            add(series, e, s, weigher, strip ? random.bits() : 0);
            series.redraws += std::exchange(weigher.redraws, 0);
            series.unsettled += std::exchange(weigher.unsettled, 0);
            series.none += std::exchange(weigher.fallbacks, 0);
            series.cells += strip ? s.places.size() : 0;
            series.strips += strip;
        }
    }
}

}  // namespace trials

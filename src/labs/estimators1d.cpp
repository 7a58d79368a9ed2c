// labs/estimators1d.cpp  5  four estimators of a shadowed integral, on the unit interval
//
//   build/estimators1d [--quick]
//
// Measures noise and bias of estimators of S, the integral of w V over [0,1], from N uniform x, and
// compares them with predictions for large N.  The integral W of w is known.  The six pairs (w, V)
// are those of Heitz, Hill, McGuire 2018, supplement.
#include <array>

#include "app/threads.h"
#include "base/rng.h"
#include "labs/cube.h"
#include "labs/rows.h"
#include "shadow/population.h"
#include "text/json.h"

namespace {
using namespace penumbra;

constexpr const char* names[4] = {"stochastic", "control variate", "ratio", "regression"};
constexpr size_t steps = 17;  // N = 1, 2, 4, ... 65536

// The weight w(x) = c0 + c1 x + c2 x^2.
struct Weight {
    const char* formula;
    double c0, c1, c2;

    double operator()(double x) const { return c0 + x * (c1 + x * c2); }
    // The integral of w^k over [a, b], k <= 3.  Gauss's rule of four points is exact to degree 7.
    double integral(int k, double a, double b) const {
        double sum = 0;
        for (const cube::Node& node : cube::gauss(4))
            sum += node.weight * std::pow((*this)(std::lerp(a, b, node.at)), k);
        return sum * (b - a);
    }
};
constexpr Weight steep = {"3x²", 0, 0, 3};
constexpr Weight flat = {"(15 + 2x)/16", 15.0 / 16, 2.0 / 16, 0};

// A pair (w, V).  V is 1 in [from, to) if `inside` is true, else outside of it.
struct Case {
    const char* letter;
    Weight w;
    const char* V_formula;
    double from, to;
    bool inside;
    std::array<bool, 3> low;  // Table 1 of the paper: do the first three have low variance?

    bool V(double x) const { return (x >= from && x < to) == inside; }
    double shadowed(int k) const {
        const double part = w.integral(k, from, to);
        return inside ? part : w.integral(k, 0, 1) - part;
    }
    ShadowPopulation population() const {
        return {w.integral(1, 0, 1), shadowed(1),         w.integral(2, 0, 1),
                shadowed(2),         w.integral(3, 0, 1), shadowed(3)};
    }
};
const Case cases[] = {
    {"a", steep, "1", 0, 0, false, {false, true, true}},
    {"b", steep, "0 on [7/16, 1/2), else 1", 0.4375, 0.5, false, {false, true, true}},
    {"c", steep, "0", 0, 0, true, {true, false, true}},
    {"d", steep, "1 on [7/16, 1/2), else 0", 0.4375, 0.5, true, {true, false, true}},
    {"e", steep, "1 on [0, 4/5), else 0", 0, 0.8, true, {false, false, false}},
    {"f", flat, "0 on [0, 1/2), else 1", 0, 0.5, false, {false, false, false}},
};

// ---- Trials -------------------------------------------------------------------------------------

// Results of the trials of one case, by log2 N.
struct Tally {
    std::array<std::array<Moments, 4>, steps> error = {};  // estimate - S
    // Ratio estimate minus its linearisation mean(wV) + R (W - mean(w)) with the true R.  The
    // linearisation is unbiased, so the mean is the bias of the ratio, without most of the noise.
    std::array<Moments, steps> excess = {};
};

// The first N numbers of each trial's own stream are its sample.
Tally run_trials(const Case& c, uint64_t trials) {
    Tally tally;
    const Weight w = c.w;
    const ShadowPopulation truth = c.population();
    for (uint64_t trial = 0; trial < trials; ++trial) {
        Rng rng{hash(hash(0, uint64_t(c.letter[0])), trial)};
        SumsAbout sums{truth.W};
        for (size_t k = 0; k < steps; ++k) {
            while (sums.n < uint64_t(1) << k) {
                const double x = rng.uniform(), w_x = w(x);
                sums.add(w_x, c.V(x) ? w_x : 0);
            }
            const ShadowMoments m = sums.moments();
            for (size_t e = 0; e < 4; ++e)
                tally.error[k][e].add(estimate(Estimator(e), m) - truth.S);
            tally.excess[k].add(ratio(m) - (m.wV + truth.R() * (truth.W - m.w)));
        }
    }
    return tally;
}

// A row for each N and estimator.  RMSE and deviation are those of one sample, in units of W.
// "variance off" and "bias off" are relative differences from the predictions for large N.
Rows rows_of(const Case& c, uint64_t trials) {
    constexpr double zero = 1e-15;  // bound of the rounding errors of a formula
    const Tally tally = run_trials(c, trials);
    const ShadowPopulation p = c.population();
    Rows rows;
    for (size_t k = 0; k < steps; ++k)
        for (size_t e = 0; e < 4; ++e) {
            const Moments& m = tally.error[k][e];
            const double n = double(uint64_t(1) << k), variance = m.variance() * n,
                         expected = p.variance(Estimator(e)), bias = p.bias(Estimator(e));
            Row r{c.letter, names[e], uint64_t(n), 0};
            r.of["rmse"] = std::sqrt((m.mean * m.mean + m.m2 / double(m.n)) * n) / p.W;
            r.of["deviation"] = std::sqrt(variance) / p.W;
            if (expected > zero)
                r.of["variance off"] = std::abs(variance / expected - 1);
            else
                r.of["exact"] = variance <= (e < 3 ? 0 : zero * zero * n);
            if (Estimator(e) == Estimator::ratio && std::abs(bias) > zero)
                r.of["bias off"] = std::abs(tally.excess[k].mean * n / bias - 1);
            rows.push_back(r);
        }
    return rows;
}

// ---- Report -------------------------------------------------------------------------------------

constexpr uint64_t asymptotic = 256, regressed = 1024;  // predictions hold from these N on
constexpr double low_variance = 0.4;                    // smaller deviations are low

// A table of the deviations of one sample over W.  It marks the low ones, as the paper does.
std::string paper_table(Page& page, const Rows& rows) {
    Lines lines;
    for (const Case& c : cases) {
        lines.push_back({c.letter, c.w.formula, c.V_formula});
        bool same = true;
        for (const Row& r : in_scene(rows, c.letter)) {
            if (r.count != regressed) continue;
            const bool is_low = r["deviation"] < low_variance;
            const size_t e = lines.back().size() - 3;
            lines.back().push_back(text("%s %.3g", is_low ? "✓" : "✗", r["deviation"]));
            if (e < 3) same = same && is_low == c.low[e];
        }
        lines.back().push_back(page.verdict(same));
    }
    return table({"case", "w", "V", names[0], names[1], names[2], names[3], "as in the paper"},
                 lines);
}

double largest(const Rows& rows, const char* number) {
    double most = 0;
    for (const Row& r : rows)
        if (r.count >= asymptotic) most = std::fmax(most, r[number]);
    return most;
}

// The largest RMSE of regression over the least RMSE of the other estimators.
double regression_over_best(const Rows& rows) {
    double most = 0;
    for (size_t i = 0; i + 3 < rows.size(); i += 4) {
        const double best = std::min({rows[i]["rmse"], rows[i + 1]["rmse"], rows[i + 2]["rmse"]});
        if (rows[i].count >= regressed && best > 0)
            most = std::max(most, rows[i + 3]["rmse"] / best);
    }
    return most;
}

int study(const Scope& scope) {
    const uint64_t trials = scope.quick ? 512 : 32768;
    Page page(scope, "estimators1d");
    std::array<Rows, std::size(cases)> parts;
    by_workers(
        parts.size(), all_cores(),
        [&](size_t k, unsigned) { parts[k] = rows_of(cases[k], trials); }, [](double) {});
    Rows rows;
    for (const Rows& part : parts) append(rows, part);
    page.plot("estimators1d", plot(in_scene(rows, "e"), "samples N", "RMSE × √N / W", of_setting,
                                   count_of, mean_of("rmse"), "case e"));
    page.data("estimators1d", csv_of(rows, {"rmse", "deviation", "variance off", "bias off"}));
    page.set("table", paper_table(page, rows));
    const double spread = std::sqrt(2 / double(trials)), limit = 4.5 * spread,
                 variance = largest(rows, "variance off"), bias = largest(rows, "bias off"),
                 regression = regression_over_best(rows);
    page.claim("variance holds", variance < limit), page.set("variance", percent(variance));
    page.claim("bias holds", bias < 2 * limit), page.set("bias", percent(bias));
    page.claim("exact holds", where(rows, [](const Row& r) {
                                  return r.count >= asymptotic && r["exact"] == 0;
                              }).empty());
    page.claim("regression holds", regression < 1.03);
    page.set("regression", text("%.3f", regression));
    page.set("spread", percent(spread)), page.set("limit", percent(limit));
    page.set("trials", text("%.0f", double(trials)));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    return experiment(argc, argv,
                      {"estimators1d", "Measures four estimators of a shadowed integral in 1D."},
                      study);
}

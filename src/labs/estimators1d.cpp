// labs/estimators1d.cpp  4  four estimators of a shadowed integral, on the unit interval
//
//   build/estimators1d [--quick]
//
// Noise and bias of each estimator of S = integral over [0,1] of w V, with W that of w, from N
// uniform x, for six pairs (w, V) of known integrals (Heitz, Hill, McGuire 2018, supplement),
// beside what is predicted for large N.
#include <array>

#include "base/rng.h"
#include "labs/page.h"
#include "shadow/population.h"

namespace {

constexpr const char* names[4] = {"stochastic", "control variate", "ratio", "regression"};
constexpr size_t steps = 17;  // N = 1, 2, 4, ... 65536

// c0 + c1 x + c2 x^2.
struct Weight {
    const char *formula, *kind;
    double c0, c1, c2;

    double operator()(double x) const { return c0 + x * (c1 + x * c2); }
    // Of the k-th power, k <= 3, over [a, b]: Gauss's four points are exact to degree 7.
    double integral(int k, double a, double b) const {
        constexpr std::array places = {0.33998104358485626, 0.86113631159405258};
        constexpr std::array weights = {0.65214515486254614, 0.34785484513745386};
        double sum = 0;
        for (size_t i = 0; i < 2; ++i)
            for (double sign : {-1, 1})
                sum += weights[i] * std::pow((*this)((a + b + sign * places[i] * (b - a)) / 2), k);
        return sum * (b - a) / 2;
    }
};
constexpr Weight steep = {"3x²", "high variance", 0, 0, 3};
constexpr Weight flat = {"(15 + 2x)/16", "low variance", 15.0 / 16, 2.0 / 16, 0};

// V is 1 on [from, to), or everywhere else.
struct Case {
    const char* letter;
    Weight w;
    const char *V_formula, *V_kind;
    double from, to;
    bool inside;
    std::array<bool, 3> low;  // what the paper's Table 1 says of the variance of the first three

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
    {"a", steep, "1", "1", 0, 0, false, {false, true, true}},
    {"b", steep, "0 on [7/16, 1/2), else 1", "near 1", 0.4375, 0.5, false, {false, true, true}},
    {"c", steep, "0", "0", 0, 0, true, {true, false, true}},
    {"d", steep, "1 on [7/16, 1/2), else 0", "near 0", 0.4375, 0.5, true, {true, false, true}},
    {"e", steep, "1 on [0, 4/5), else 0", "high variance", 0, 0.8, true, {false, false, false}},
    {"f", flat, "0 on [0, 1/2), else 1", "high variance", 0, 0.5, false, {false, false, false}},
};

// ---- The experiment -----------------------------------------------------------------------------

// What the trials say of one case and one N.
struct Row {
    std::array<Moments, 4> error;  // estimate - S
    // Ratio minus its linearisation mean(wV) + R (W - mean(w)) with the true R, which is unbiased:
    // the mean is the bias, without most of the noise.
    Moments excess;

    double variance(size_t e) const { return error[e].variance(); }
    double rmse(size_t e) const {
        return std::sqrt(error[e].mean * error[e].mean + error[e].m2 / double(error[e].n));
    }
    void merge(const Row& other) {
        for (size_t e = 0; e < 4; ++e) error[e].merge(other.error[e]);
        excess.merge(other.excess);
    }
};
using Rows = std::array<Row, steps>;

double n_of(size_t k) { return double(uint64_t(1) << k); }

// Trials first ... last-1, each one stream of numbers, of which the first N are the sample.
Rows run_trials(const Case& c, uint64_t key, uint64_t first, uint64_t last) {
    Rows rows;
    const Weight w = c.w;
    const ShadowPopulation truth = c.population();
    for (uint64_t trial = first; trial < last; ++trial) {
        Rng rng{hash(key, trial)};
        SumsAbout sums{truth.W};
        for (size_t k = 0; k < steps; ++k) {
            while (sums.n < uint64_t(1) << k) {
                const double x = rng.uniform(), w_x = w(x);
                sums.add(w_x, c.V(x) ? w_x : 0);
            }
            const ShadowMoments m = sums.moments();
            for (size_t e = 0; e < 4; ++e)
                rows[k].error[e].add(estimate(Estimator(e), m) - truth.S);
            rows[k].excess.add(ratio(m) - (m.wV + truth.R() * (truth.W - m.w)));
        }
    }
    return rows;
}

// The same numbers whatever the number of threads: trials come in 64 blocks, merged in order.
Rows experiment(const Case& c, uint64_t trials) {
    constexpr uint64_t blocks = 64;
    const uint64_t key = hash(0, uint64_t(c.letter[0]));
    std::vector<Rows> parts(blocks);
    auto run = [&](int block) {
        const uint64_t b = uint64_t(block);
        parts[b] = run_trials(c, key, trials * b / blocks, trials * (b + 1) / blocks);
    };
    in_parallel(blocks, all_cores(), run, [](double) {});
    Rows all;
    for (const Rows& part : parts)
        for (size_t k = 0; k < steps; ++k) all[k].merge(part[k]);
    return all;
}

// ---- The picture --------------------------------------------------------------------------------

void draw_functions(Svg& sheet, Place corner, const Case& c) {
    Plot plot(sheet, corner, {90, 150}, {"x", 0, 1, false, {0, 1}}, {"", 0, 3, false, {0, 1, 2, 3}},
              text("(%s)  w = %s,  V = %s", c.letter, c.w.formula, c.V_formula));
    std::vector<double> x, w, V;
    for (int i = 0; i <= 400; ++i) {
        x.push_back(i / 400.0);
        w.push_back(c.w(x.back()));
        V.push_back(c.V(x.back()));
    }
    plot.curve(x, V, {.colour = svg::colours[7], .dots = false}, "V");
    plot.curve(x, w, {.dots = false}, "w");
}

// Would be a level line if noise fell as 1/sqrt(N) and there were no bias.
void draw_noise(Svg& sheet, Place corner, const Case& c, const Rows& rows) {
    Plot plot(sheet, corner, {230, 150}, {"samples N", 1, 65536, true, {1, 16, 256, 4096, 65536}},
              {"rmse × √N / W", 0, 1.1, false, {0, 0.25, 0.5, 0.75, 1}}, "");
    const ShadowPopulation p = c.population();
    for (size_t e = 0; e < 4; ++e) {
        const double variance = std::max(0.0, p.variance(Estimator(e))),
                     bias = p.bias(Estimator(e));
        std::vector<double> n, measured, predicted;
        for (size_t k = 0; k < steps; ++k) {
            n.push_back(n_of(k));
            measured.push_back(rows[k].rmse(e) * std::sqrt(n_of(k)) / p.W);
            predicted.push_back(std::sqrt(variance + bias * bias / n_of(k)) / p.W);
        }
        // Smaller from one to the next, for where they coincide.
        const double radius = 4.5 - 0.8 * double(e);
        const char* colour = svg::colours[e];
        plot.curve(n, measured, {.colour = colour, .width = 0, .radius = radius});
        plot.curve(n, predicted, {.colour = colour, .dots = false, .width = 1.2}, names[e]);
    }
}

// ---- The report ---------------------------------------------------------------------------------

constexpr size_t asymptotic = 8, regressed = 10;  // steps: from N = 256, from N = 1024
constexpr double low_variance = 0.4;              // of W: standard deviation of one sample

// Standard deviations of one sample over W, and the paper's marks of the low ones.
std::string paper_table(Page& page, const std::vector<Rows>& all) {
    std::vector<std::vector<std::string>> lines;
    for (size_t i = 0; i < all.size(); ++i) {
        const Case& c = cases[i];
        lines.push_back({c.letter, c.w.kind, c.V_kind});
        bool same = true;
        for (size_t e = 0; e < 4; ++e) {
            const double of_one = std::sqrt(all[i][regressed].variance(e) * n_of(regressed)),
                         sd = of_one / c.population().W;
            lines.back().push_back(text("%s %.3g", sd < low_variance ? "✓" : "✗", sd));
            if (e < 3) same = same && (sd < low_variance) == c.low[e];
        }
        lines.back().push_back(page.verdict(same));
    }
    return table({"case", "w", "V", names[0], names[1], names[2], names[3], "as in the paper"},
                 lines);
}

// The greatest departures from what is predicted for large N, as parts of it; of all cases.
struct Departures {
    double variance = 0, ratio_bias = 0;
    double regression = 0;  // rmse over the best other's
    bool exact = true;      // what has no noise has none, regression but for rounding

    void look(const Case& c, const Rows& rows) {
        constexpr double zero = 1e-15;  // what a formula leaves of it
        const ShadowPopulation p = c.population();
        const double bias = p.bias(Estimator::ratio);
        for (size_t k = asymptotic; k < steps; ++k) {
            const Row& row = rows[k];
            for (size_t e = 0; e < 4; ++e) {
                const double truth = p.variance(Estimator(e)), now = row.variance(e) * n_of(k);
                if (truth > zero)
                    variance = std::max(variance, std::abs(now / truth - 1));
                else
                    exact = exact && now <= (e < 3 ? 0 : zero * zero * n_of(k));
            }
            const double bias_now = row.excess.mean * n_of(k);
            if (std::abs(bias) > zero)
                ratio_bias = std::max(ratio_bias, std::abs(bias_now / bias - 1));
            const double best = std::min({row.rmse(0), row.rmse(1), row.rmse(2)});
            if (k >= regressed && best > 0) regression = std::max(regression, row.rmse(3) / best);
        }
    }
};

void tell_predictions(Page& page, const Departures& worst, double spread) {
    const double limit = 4.5 * spread;
    auto percent = [](double x) { return text("%.2g %%", 100 * x); };
    page.claim("variance holds", worst.variance < limit);
    page.claim("bias holds", worst.ratio_bias < 2 * limit);
    page.claim("exact holds", worst.exact);
    page.claim("regression holds", worst.regression < 1.03);
    page.set("spread", percent(spread));
    page.set("variance", percent(worst.variance));
    page.set("limit", percent(limit));
    page.set("bias", percent(worst.ratio_bias));
    page.set("regression", text("%.3f", worst.regression));
}

int study(bool quick, const std::string& command) {
    const uint64_t trials = quick ? 512 : 32768;
    Page page(report_folder(quick), "estimators1d");
    std::vector<Rows> all;
    Departures worst;
    Svg sheet(1075, 690);
    Steps progress(std::size(cases));
    for (const Case& c : cases) {
        progress.next(text("case %s", c.letter));
        const Place corner = {30 + 530 * double(all.size() % 2), 35 + 225 * double(all.size() / 2)};
        all.push_back(experiment(c, trials));
        worst.look(c, all.back());
        draw_functions(sheet, corner, c);
        draw_noise(sheet, {corner.x + 170, corner.y}, c, all.back());
    }
    page.plot("estimators1d", sheet);
    page.set("table", paper_table(page, all));
    tell_predictions(page, worst, std::sqrt(2 / double(trials)));
    page.set("trials", text("%.0f", double(trials)));
    page.set("made", made_by(command));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false;
    const Lab lab{"estimators1d",
                  "Measures four estimators of a shadowed integral in 1D.",
                  {quick_flag(quick)}};
    return lab_main(argc, argv, lab, [&] { return study(quick, command_of(argc, argv)); });
}

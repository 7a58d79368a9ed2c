// labs/estimators1d.cpp  3  four estimators of a shadowed integral, on the unit interval
//
//   build/estimators1d [--quick]
//
// S = integral over [0,1] of w V, W = that of w, x uniform (Heitz, Hill, McGuire 2018, supplement).
// Tables and a verdict on stdout, exit status 1 if a prediction fails; every number in
// out/estimators1d.csv, the paper's Figure 1 in out/estimators1d.png.
#include <array>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "base/program.h"
#include "base/rng.h"
#include "base/stats.h"
#include "labs/plot.h"
#include "shadow/estimators.h"

namespace {

using Function = double (*)(double);
constexpr const char* names[4] = {"stochastic", "control variate", "ratio", "regression"};
constexpr int steps = 17;  // N = 1, 2, 4, ... 65536

// w and the integrals of w, w^2 and w^3 from 0 to x.
struct Weight {
    const char* text;
    Function w, W1, W2, W3;
};
constexpr Weight steep = {"3x^2", [](double x) { return 3 * x * x; },
                          [](double x) { return x * x * x; },
                          [](double x) { return 9 * std::pow(x, 5) / 5; },
                          [](double x) { return 27 * std::pow(x, 7) / 7; }};
// 8 w^(k+1) / (k+1) from 0 to x, for the k-th power of w = (15 + 2x) / 16.
template <int k>
double integral_of_flat(double x) {
    return 8 * (std::pow((15 + 2 * x) / 16, k + 1) - std::pow(15.0 / 16, k + 1)) / (k + 1);
}
constexpr Weight flat = {"(15+2x)/16", [](double x) { return (15 + 2 * x) / 16; },
                         integral_of_flat<1>, integral_of_flat<2>, integral_of_flat<3>};

// V is 1 on [from, to), or everywhere else.
struct Case {
    char letter;
    const char *w_is, *V_is;
    const Weight* weight;
    double from, to;
    bool inside;
    std::array<bool, 3> low;  // what the paper's Table 1 says

    double w(double x) const { return weight->w(x); }
    bool V(double x) const { return (x >= from && x < to) == inside; }
    std::string V_text() const {
        char line[80];
        std::snprintf(line, sizeof line, "%d on [%g,%g), else %d", inside, from, to, !inside);
        return from == to ? std::to_string(int(!inside)) : line;
    }
    double integral(Function F) const {
        const double part = F(to) - F(from);
        return inside ? part : F(1) - part;
    }
    ShadowPopulation population() const {
        const auto& [name, w_, W1, W2, W3] = *weight;
        return {W1(1), integral(W1), W2(1), integral(W2), W3(1), integral(W3)};
    }
};

const Case cases[] = {
    {'a', "high variance", "1", &steep, 0, 0, false, {false, true, true}},
    {'b', "high variance", "near 1", &steep, 0.4375, 0.5, false, {false, true, true}},
    {'c', "high variance", "0", &steep, 0, 0, true, {true, false, true}},
    {'d', "high variance", "near 0", &steep, 0.4375, 0.5, true, {true, false, true}},
    {'e', "high variance", "high variance", &steep, 0, 0.8, true, {false, false, false}},
    {'f', "low variance", "high variance", &flat, 0, 0.5, false, {false, false, false}},
};

// ---- The experiment -----------------------------------------------------------------------------

// What the trials say of one case and one N.
struct Row {
    std::array<Moments, 4> error;  // estimate - S
    // Estimate minus its linearisation mean(wV) + beta (W - mean(w)) with the true beta, which is
    // unbiased: the mean is the bias, without most of the noise.
    std::array<Moments, 4> excess;

    void merge(const Row& other) {
        for (size_t e = 0; e < 4; ++e) {
            error[e].merge(other.error[e]);
            excess[e].merge(other.excess[e]);
        }
    }
};
using Rows = std::array<Row, steps>;

// Trials first ... last-1, each one stream of 2^k_max numbers, of which the first N are the sample.
template <const Weight& weight>
Rows run_trials(const Case& c, uint64_t key, uint64_t first, uint64_t last, int k_max) {
    Rows rows;
    const ShadowPopulation truth = c.population();
    double beta[4];
    for (size_t e = 0; e < 4; ++e) beta[e] = truth.beta(Estimator(e));
    for (uint64_t trial = first; trial < last; ++trial) {
        Rng rng{hash(key, trial)};
        SumsAbout sums{truth.W};
        for (int k = 0; k <= k_max; ++k) {
            for (const uint64_t end = uint64_t(1) << k; sums.n < end;) {
                const double x = double(rng.bits() >> 11) * 0x1p-53, w = weight.w(x);
                sums.add(w, c.V(x) ? w : 0);
            }
            const ShadowMoments m = sums.moments();
            for (size_t e = 0; e < 4; ++e) {
                const double value = estimate(Estimator(e), m);
                rows[size_t(k)].error[e].add(value - truth.S);
                rows[size_t(k)].excess[e].add(value - (m.wV + beta[e] * (truth.W - m.w)));
            }
        }
    }
    return rows;
}

// The same numbers whatever the number of threads: trials come in 64 blocks, merged in order.
void add_trials(Rows& rows, const Case& c, uint64_t key, uint64_t trials, int k_min, int k_max) {
    constexpr uint64_t blocks = 64;
    const auto run = c.weight == &steep ? run_trials<steep> : run_trials<flat>;
    std::vector<Rows> parts(blocks);
    std::atomic<uint64_t> next = 0;
    auto work = [&] {
        for (uint64_t b; (b = next++) < blocks;)
            parts[b] = run(c, key, trials * b / blocks, trials * (b + 1) / blocks, k_max);
    };
    {
        std::vector<std::jthread> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
            threads.emplace_back(work);
    }
    for (const Rows& part : parts)
        for (int k = k_min; k <= k_max; ++k) rows[size_t(k)].merge(part[size_t(k)]);
}

struct Measured {
    double sd, bias, bias_error, rmse;
};
// The bias of the two that have one from `excess`; of the others that would be 0 by construction.
Measured measured(const Row& row, size_t e) {
    const Moments &error = row.error[e], &bias = e < 2 ? row.error[e] : row.excess[e];
    return {std::sqrt(error.variance()), bias.mean, bias.standard_error(),
            std::sqrt(error.mean * error.mean + error.m2 / double(error.n))};
}

// Trials of 2^k_max numbers; of their first 2^k_min ones and more.
struct Tier {
    uint64_t trials;
    int k_min, k_max;
};
using Plan = std::array<Tier, 3>;
constexpr Plan full = {{{131072, 0, 12}, {40000, 13, 14}, {16384, 15, 16}}};
constexpr Plan quick = {{{2000, 0, 12}, {500, 13, 14}, {200, 15, 16}}};

Rows experiment(const Case& c, const Plan& plan) {
    Rows rows;
    const uint64_t key = hash(0, uint64_t(c.letter));
    for (const auto& [trials, k_min, k_max] : plan)
        add_trials(rows, c, hash(key, uint64_t(k_max)), trials, k_min, k_max);
    return rows;
}

// ---- Verdicts -----------------------------------------------------------------------------------

constexpr int k_asymptotic = 8, k_regression = 10;  // from N = 256, from N = 1024
constexpr double low_variance = 0.4;                // of W: standard deviation of one sample

double n_of(int k) { return double(uint64_t(1) << k); }

struct Predicted {
    double sd, bias, rmse;
};
Predicted predicted(const ShadowPopulation& p, size_t e, int k) {
    const double variance = std::max(0.0, p.variance(Estimator(e))) / n_of(k),
                 bias = p.bias(Estimator(e)) / n_of(k);
    return {std::sqrt(variance), bias, std::sqrt(variance + bias * bias)};
}

// Exact or rounding: what a variance of 0 must be for this estimator.
bool no_noise(const Row& row, size_t e) {
    const double most = e == size_t(Estimator::regression) ? 1e-24 : 0;
    return row.error[e].m2 <= most * double(row.error[e].n);
}

bool is_low(const Case& c, const Rows& rows, size_t e) {
    const Row& row = rows[k_regression];
    return std::sqrt(row.error[e].variance() * n_of(k_regression)) <
           low_variance * c.population().W;
}

int failures = 0;
const char* verdict(bool pass) {
    failures += !pass;
    return pass ? "ok" : "FAILS";
}

void print_case(const Case& c, const Rows& rows) {
    const ShadowPopulation p = c.population();
    std::printf("\n## (%c) w = %s, V = %s\n\nW = %.9g, S = %.9g, R = %.9g\n\n", c.letter,
                c.weight->text, c.V_text().c_str(), p.W, p.S, p.R());
    std::printf(
        "| N | estimator | sd | predicted | bias | predicted | rmse | predicted "
        "|\n|---|---|---|---|---|---|---|---|\n");
    for (int k : {0, 2, 4, 8, 12, 16})
        for (size_t e = 0; e < 4; ++e) {
            const Measured m = measured(rows[size_t(k)], e);
            const Predicted q = predicted(p, e, k);
            std::printf("| %.0f | %s | %.4g | %.4g | %+.3g ± %.1g | %+.3g | %.4g | %.4g |\n",
                        n_of(k), names[e], m.sd, q.sd, m.bias, m.bias_error, q.bias, m.rmse,
                        q.rmse);
        }
    std::puts("");
    for (size_t e = 0; e < 4; ++e) {
        double worst = 0, worst_bias = 0;
        const double variance = p.variance(Estimator(e)), bias = p.bias(Estimator(e));
        // What the formula leaves of an exact zero by rounding is one.
        const bool noisy = variance > 1e-15;
        bool exact = true;
        for (int k = k_asymptotic; k < steps; ++k) {
            const Row& row = rows[size_t(k)];
            exact = exact && no_noise(row, e);
            worst = std::max(worst, std::abs(row.error[e].variance() * n_of(k) / variance - 1));
            worst_bias = std::max(worst_bias, std::abs(row.excess[e].mean * n_of(k) / bias - 1));
        }
        if (noisy)
            std::printf("* %s: N variance %.6g, within %.2g %% from N = 256 on: %s\n", names[e],
                        variance, 100 * worst, verdict(worst < 0.05));
        else
            std::printf("* %s: no variance%s: %s\n", names[e],
                        e == 3 ? " but rounding" : ", exactly", verdict(exact));
        if (e == size_t(Estimator::ratio) && std::abs(bias) > 1e-15)
            std::printf("* ratio: N bias %.6g, within %.2g %% from N = 256 on: %s\n", bias,
                        100 * worst_bias, verdict(worst_bias < 0.1));
    }
    double worst = 0;
    bool exact = true;
    for (int k = k_regression; k < steps; ++k) {
        const Row& row = rows[size_t(k)];
        double best = infinity;
        for (size_t e = 0; e < 3; ++e) best = std::min(best, measured(row, e).rmse);
        if (best > 0) worst = std::max(worst, measured(row, 3).rmse / best);
        exact = exact && (best > 0 || no_noise(row, 3));
    }
    if (worst > 0)
        std::printf("* regression: rmse at most %.3f of the best other's from N = 1024 on: %s\n",
                    worst, verdict(worst < 1.03));
    else
        std::printf("* regression: as exact as the best other, but for rounding: %s\n",
                    verdict(exact));
}

void print_table(const std::vector<Rows>& all) {
    std::printf(
        "\n## Table 1\n\n✓: standard deviation of one sample (sd √N at N = 1024) below %.1f W; 0: "
        "no noise at all.\n\n"
        "| case | w | V | stochastic | control variate | ratio | regression | the paper's "
        "|\n|---|---|---|---|---|---|---|---|\n",
        low_variance);
    for (size_t i = 0; i < std::size(cases); ++i) {
        const Case& c = cases[i];
        std::printf("| %c | %s | %s |", c.letter, c.w_is, c.V_is);
        bool same = true;
        for (size_t e = 0; e < 4; ++e) {
            const double sd =
                std::sqrt(all[i][k_regression].error[e].variance() * n_of(k_regression));
            std::printf(" %s %.3g |", is_low(c, all[i], e) ? "✓" : "✗", sd / c.population().W);
            if (e < 3) same = same && is_low(c, all[i], e) == c.low[e];
        }
        std::printf(" %s |\n", same ? "the same" : "another");
        failures += !same;
    }
}

// ---- Files --------------------------------------------------------------------------------------

std::string text(const char* format, auto... values) {
    char line[512];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

std::string csv(const std::vector<Rows>& all) {
    std::string out =
        "case,N,trials,estimator,sd,sd_predicted,bias,bias_standard_error,bias_predicted,rmse,rmse_"
        "predicted\n";
    for (size_t i = 0; i < std::size(cases); ++i)
        for (int k = 0; k < steps; ++k)
            for (size_t e = 0; e < 4; ++e) {
                const Row& row = all[i][size_t(k)];
                const Measured m = measured(row, e);
                const Predicted q = predicted(cases[i].population(), e, k);
                out += text("%c,%.0f,%.0f,%s,%.9g,%.9g,%.9g,%.3g,%.9g,%.9g,%.9g\n", cases[i].letter,
                            n_of(k), double(row.error[e].n), names[e], m.sd, q.sd, m.bias,
                            m.bias_error, q.bias, m.rmse, q.rmse);
            }
    return out;
}

constexpr Colour colours[4] = {
    {0.05f, 0.2f, 0.6f}, {0.9f, 0.3f, 0}, {0.05f, 0.4f, 0.05f}, {0.7f, 0.02f, 0.02f}};
constexpr Colour black{0, 0, 0}, grey{0.35f, 0.35f, 0.35f}, pale{0.75f, 0.75f, 0.75f};

// One panel: w and V on the left; rmse over N on the right, predictions as thin lines.
void draw_panel(Image& image, const Case& c, const Rows& rows, double left, double top) {
    constexpr double side = 130, width = 300, height = 216, decade = height / 6;
    draw_text(image, {left, top - 24}, text("(%c)  w: %s,  V: %s", c.letter, c.w_is, c.V_is), black,
              0, 2);
    std::vector<Point> w, V;
    for (int i = 0; i <= 520; ++i) {
        const double x = std::min(i / 520.0, 1 - 1e-9);
        w.push_back({left + side * x, top + height * (1 - c.w(x) / 3.2)});
        V.push_back({left + side * x, top + height * (1 - double(c.V(x)) / 3.2)});
    }
    draw_polyline(image, V, grey, 1.5);
    draw_polyline(image, w, black, 2);
    draw_box(image, {left, top}, {left + side, top + height}, grey);
    draw_text(image, {left + 8, top + 8}, "w(x)", black);
    draw_text(image, {left + 8, top + 20}, "V(x)", grey);
    for (int y = 0; y <= 3; ++y)
        draw_text(image, {left - 4, top + height * (1 - y / 3.2) - 4}, text("%d", y), black, 1);
    for (int x = 0; x <= 1; ++x)
        draw_text(image, {left + side * x, top + height + 4}, text("%d", x), black, 0.5);

    const double x0 = left + side + 50;
    auto at = [&](int k, double value) {
        return Point{x0 + width * k / (steps - 1), top + decade * (1 - std::log10(value))};
    };
    for (int power = 1; power >= -5; --power) {
        const double y = top + decade * (1 - power);
        draw_line(image, {x0, y}, {x0 + width, y}, pale, 0.7);
        draw_text(image, {x0 - 4, y - 4}, text("1e%d", power), black, 1);
    }
    for (int k = 0; k < steps; k += 4) {
        const double x = at(k, 1).x;
        draw_line(image, {x, top}, {x, top + height}, pale, 0.7);
        draw_text(image, {x, top + height + 4}, k ? text("%.0f", n_of(k)) : "N = 1", black, 0.5);
    }
    draw_box(image, {x0, top}, {x0 + width, top + height}, grey);
    for (size_t e = 0; e < 4; ++e) {
        std::vector<Point> thin;
        for (int k = 0; k < steps; ++k) {
            const double value = measured(rows[size_t(k)], e).rmse;
            if (value < 1e-5) continue;
            const Point p = at(k, value);
            const double size = 2 + 2.2 * double(3 - e);  // nested, where they coincide
            draw_box(image, {p.x - size / 2, p.y - size / 2}, {p.x + size / 2, p.y + size / 2},
                     colours[e]);
            thin.push_back(at(k, predicted(c.population(), e, k).rmse));
        }
        draw_polyline(image, thin, colours[e], 1.2);
        draw_text(image, {x0 + width - 6, top + 6 + 12 * double(e)},
                  names[e] + std::string(thin.empty() ? ": 0" : ""), colours[e], 1);
    }
}

Image figure(const std::vector<Rows>& all) {
    Image image(1580, 590);
    image.pixels.assign(image.pixels.size(), {1, 1, 1});
    for (size_t i = 0; i < std::size(cases); ++i)
        draw_panel(image, cases[i], all[i], 30 + 520 * double(i % 3), 40 + 272 * double(i / 3));
    draw_text(
        image, {30, 572},
        "rmse over N: boxes measured, lines predicted for large N; what has no noise is marked 0",
        black);
    return image;
}

int run(const std::vector<std::string>& words) {
    Plan plan = full;
    for (const std::string& word : words) {
        if (word != "--quick") throw UserError(unknown("option", word, {"--quick"}));
        plan = quick;
    }
    const std::string stem = "out/estimators1d";
    std::filesystem::create_directories("out");
    check_writable(stem + ".csv");
    std::vector<Rows> all;
    std::puts("# Four estimators of a shadowed integral\n");
    for (const auto& [trials, k_min, k_max] : plan)
        std::printf(
            "N = %.0f ... %.0f: %.0f trials, each N the start of the next; spread of a variance "
            "%.1f %%\n",
            n_of(k_min), n_of(k_max), double(trials), 100 * std::sqrt(2 / double(trials)));
    std::puts(
        "Regression is ratio below N = 8.  Bias of ratio and regression: of their difference to "
        "their own linearisation.");
    for (const Case& c : cases) {
        all.push_back(experiment(c, plan));
        print_case(c, all.back());
        std::fflush(stdout);
    }
    print_table(all);
    write_file(stem + ".csv", csv(all));
    write_image(stem + ".png", figure(all), 1);
    std::printf("\nwrote %s.csv and %s.png; %d predictions failed\n", stem.c_str(), stem.c_str(),
                failures);
    return failures > 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return run({argv + 1, argv + argc}); });
}

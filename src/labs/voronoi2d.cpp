// labs/voronoi2d.cpp  3  integrals over a square by Voronoi cells: what they cost and bring
//
//   build/voronoi2d [--trials N] [--quick]
//
// Functions on [-1/2, 1/2]^2 integrated from N points by the weights of weights.h, and by what a
// user would really choose: jittered strata and scrambled Halton points.  Tables on stdout, plots
// in out/voronoi2d.png.  After Vandewiele et al. 2025, "Voronoi integration of the rendering
// equation", Table 2 and Figures 2 and 3.
#include <cinttypes>
#include <ctime>

#include "base/program.h"
#include "base/stats.h"
#include "labs/curves.h"
#include "path/halton.h"
#include "voronoi/weights.h"

namespace {

// ---- Functions and their integrals --------------------------------------------------------------

double power_of_xy(double alpha, Site p) { return std::pow(std::abs(p.x * p.y), alpha); }
double mean_of_power(double alpha) {
    const double side = 2 * std::pow(0.5, alpha + 1) / (alpha + 1);
    return side * side;
}

struct Function {
    const char* name;
    double (*at)(Site);
    double integral;
    double theory;       // exponent of n that bounds the deviation of vor, undivided; 0: none
    bool finite = true;  // its variance
};

// -1 / ln r over the square: in polar coordinates int r dr / -ln r = E1(-2 ln r), over the distance
// of the side, eight times (midpoint rule; the integrand is smooth).
double integral_of_not_holder() {
    constexpr int steps = 20000;
    double sum = 0;
    for (int k = 0; k < steps; ++k) {
        const double phi = std::numbers::pi / 4 * (k + 0.5) / steps;
        sum += -std::expint(2 * std::log(0.5 / std::cos(phi)));
    }
    return 8 * sum * std::numbers::pi / 4 / steps;
}

// (2 int_0^1/2 x sin(1/x) dx)^2; with t = 1/x, twice by parts,
// int_2^inf sin t / t^3 dt = sin 2 / 8 + cos 2 / 4 - (pi/2 - Si(2)) / 2.
double integral_of_not_c1() {
    double si = 0, term = 2;  // sum (-1)^k 2^(2k+1) / ((2k+1) (2k+1)!)
    for (int k = 0; k < 30; ++k) {
        si += term / (2 * k + 1);
        term *= -4.0 / ((2 * k + 2) * (2 * k + 3));
    }
    const double half = std::sin(2) / 8 + std::cos(2) / 4 - (std::numbers::pi / 2 - si) / 2;
    return 4 * half * half;
}

const std::vector<Function> functions = {
    {"holder_1", [](Site p) { return power_of_xy(1, p); }, mean_of_power(1), -0.75},
    {"holder_0.5", [](Site p) { return power_of_xy(0.5, p); }, mean_of_power(0.5), -0.75},
    {"holder_0.1", [](Site p) { return power_of_xy(0.1, p); }, mean_of_power(0.1), -0.75},
    {"holder_0.01", [](Site p) { return power_of_xy(0.01, p); }, mean_of_power(0.01), -0.75},
    {"not_holder", [](Site p) { return -1 / std::log(std::hypot(p.x, p.y)); },
     integral_of_not_holder(), -0.75},
    {"discontinuity", [](Site p) { return 1 / std::hypot(p.x, p.y); },
     4 * std::log(1 + std::numbers::sqrt2), 0, false},
    {"not_c1", [](Site p) { return p.x * p.y * std::sin(1 / p.x) * std::sin(1 / p.y); },
     integral_of_not_c1(), -0.75},
    {"hat",
     [](Site p) {
         return std::max(0.0, 1 - 2 * std::abs(p.x)) * std::max(0.0, 1 - 2 * std::abs(p.y));
     },
     0.25, -1},
    {"exp", [](Site p) { return std::exp(p.x + p.y / 2); },
     (2 * std::sinh(0.5)) * (4 * std::sinh(0.25)), -0.75},
    {"disc", [](Site p) { return p.x * p.x + p.y * p.y < 0.09 ? 1.0 : 0.0; },
     0.09 * std::numbers::pi, -0.75},
};

// ---- Estimators ---------------------------------------------------------------------------------

enum Estimator {
    mc,
    vor,
    vor_area,
    fvor,
    fvor_area,
    cvor,
    cvor_border,
    cvor_linear,
    torus,
    stratified,
    halton,
    poisson_mc,
    poisson_vor,
    poisson_area,
    count
};
constexpr const char* names[count] = {"mc",
                                      "vor",
                                      "vor, undivided",
                                      "fvor",
                                      "fvor, undivided",
                                      "cvor",
                                      "cvor + border correction",
                                      "cvor, linear in each cell",
                                      "torus",
                                      "stratified",
                                      "halton",
                                      "mc, Poisson",
                                      "vor, Poisson",
                                      "vor, Poisson, undivided"};
// Beyond mc: numbers fixed, of samples and of sites in the strip.
bool is_poisson(int e) { return e >= poisson_mc; }

struct Tally {
    std::vector<double> errors;
    double seconds = 0;

    Moments moments() const {
        Moments m;
        for (double e : errors) m.add(e);
        return m;
    }
    double deviation() const { return std::sqrt(moments().variance()); }
    double rmse() const {
        double sum = 0;
        for (double e : errors) sum += e * e;
        return std::sqrt(sum / double(errors.size()));
    }
    double median() const {
        std::vector<double> sorted;
        for (double e : errors) sorted.push_back(std::abs(e));
        std::sort(sorted.begin(), sorted.end());
        return sorted[sorted.size() / 2];
    }
    // Per estimate.
    double time() const { return seconds / double(errors.size()); }
};

struct Series {
    uint64_t n = 0;
    std::vector<std::array<Tally, count>> of{functions.size()};
    uint64_t redraws = 0, strips = 0, unsettled = 0, cells = 0, no_cells = 0;
};

double seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }  // of the processor

std::vector<Site> independent(uint64_t n, Rng& random) {
    std::vector<Site> p;
    p.reserve(n);
    for (uint64_t i = 0; i < n; ++i) {
        const double x = random.uniform(), y = random.uniform();
        p.push_back({x, y});
    }
    return p;
}

std::vector<Site> jittered(uint64_t n, Rng& random) {
    const auto side = uint64_t(std::lround(std::sqrt(double(n))));
    std::vector<Site> p;
    p.reserve(n);
    for (uint64_t i = 0; i < side * side; ++i) {
        const double x = random.uniform(), y = random.uniform();
        p.push_back({(double(i % side) + x) / double(side), (double(i / side) + y) / double(side)});
    }
    return p;
}

std::vector<Site> scrambled_halton(uint64_t n, Rng& random) {
    const uint64_t a = random.bits(), b = random.bits(), c = random.bits(), d = random.bits();
    std::vector<Site> p;
    p.reserve(n);
    for (uint64_t i = 0; i < n; ++i)
        p.push_back({double(scrambled_radical_inverse(2, i, a, b)),
                     double(scrambled_radical_inverse(3, i, c, d))});
    return p;
}

// One estimate of every function by every estimator.
class Trial {
public:
    explicit Trial(Series& series) : series_(series) { clipped_.cells.with_neighbours = true; }

    void run(uint64_t seed) {
        Rng random{mix(seed)};
        const uint64_t n = series_.n;
        sample([&] { return independent(n, random); });
        weigh_plainly(mc);
        weigh(vor, Weighting::vor, true, 0, random.bits());
        weigh(vor_area, Weighting::vor, false, 0, random.bits());
        weigh(fvor, Weighting::fvor, true, 0, random.bits());
        weigh(fvor_area, Weighting::fvor, false, 0, random.bits());
        weigh(cvor, Weighting::cvor, true, 0, 0);
        weigh(torus, Weighting::torus, true, 0, 0);
        reconstruct();
        sample([&] { return jittered(n, random); });
        weigh_plainly(stratified);
        sample([&] { return scrambled_halton(n, random); });
        weigh_plainly(halton);
        const uint64_t number = poisson(double(n), random);
        sample([&] { return independent(number, random); });
        weigh_plainly(poisson_mc);
        weigh(poisson_vor, Weighting::vor, true, double(n), random.bits());
        weigh(poisson_area, Weighting::vor, false, double(n), random.bits());
    }

private:
    Series& series_;
    Weigher weigher_, clipped_;
    std::vector<Site> samples_;
    std::vector<std::vector<double>> values_{functions.size()};
    std::vector<double> value_seconds_ = std::vector<double>(functions.size());
    double sample_seconds_ = 0;

    template <class Make>
    void sample(Make make) {
        double start = seconds();
        samples_ = make();
        sample_seconds_ = seconds() - start;
        for (size_t k = 0; k < functions.size(); ++k) {
            start = seconds();
            values_[k].resize(samples_.size());
            for (size_t i = 0; i < samples_.size(); ++i)
                values_[k][i] = functions[k].at({samples_[i].x - 0.5, samples_[i].y - 0.5});
            value_seconds_[k] = seconds() - start;
        }
    }

    // Adds sum(values) to every function's tally; `took` is what the weights cost.
    template <class Sum>
    void add(Estimator e, double took, Sum sum) {
        for (size_t k = 0; k < functions.size(); ++k) {
            const double start = seconds();
            const double estimate = samples_.empty() ? 0 : sum(values_[k]);
            Tally& tally = series_.of[k][e];
            tally.errors.push_back(estimate - functions[k].integral);
            tally.seconds += seconds() - start + took + sample_seconds_ + value_seconds_[k];
        }
    }

    void weigh_plainly(Estimator e) {
        add(e, 0, [&](const std::vector<double>& f) {
            double sum = 0;
            for (double x : f) sum += x;
            return sum / double(f.size());
        });
    }

    void weigh(Estimator e, Weighting kind, bool divide, double intensity, uint64_t key) {
        const double start = seconds();
        weigher_.divide = divide;
        weigher_.intensity = intensity;
        const uint64_t redraws = weigher_.redraws, unsettled = weigher_.unsettled,
                       fallbacks = weigher_.fallbacks;
        const std::vector<double>& w = weigher_(kind, samples_, key);
        const double took = seconds() - start;
        if (kind == Weighting::vor || kind == Weighting::fvor) {
            series_.redraws += weigher_.redraws - redraws;
            series_.unsettled += weigher_.unsettled - unsettled;
            series_.no_cells += weigher_.fallbacks - fallbacks;
            series_.cells += samples_.size();
            ++series_.strips;
        }
        add(e, took, [&](const std::vector<double>& f) {
            double sum = 0;
            for (size_t i = 0; i < f.size(); ++i) sum += w[i] * f[i];
            return sum;
        });
    }

    void reconstruct() {
        const double start = seconds();
        const auto& cells = clipped_.cells.clipped(samples_, {{0, 0}, {1, 1}});
        const double took = seconds() - start;
        add(cvor_border, took, [&](const std::vector<double>& f) {
            double sum = 0;
            for (size_t i = 0; i < f.size(); ++i) sum += cells[i].area * f[i];
            return sum + border_correction(clipped_.cells, cells, samples_, f);
        });
        add(cvor_linear, took, [&](const std::vector<double>& f) {
            return linear_reconstruction(clipped_.cells, cells, samples_, f);
        });
    }
};

// ---- Tables -------------------------------------------------------------------------------------

void print_table(const Series& s, size_t k) {
    const Function& f = functions[k];
    const auto& of = s.of[k];
    std::printf("\n### %s, integral %.9g, N = %" PRIu64 "\n\n", f.name, f.integral, s.n);
    if (!f.finite) {
        std::printf("| estimator | counts | median absolute error | µs |\n|---|---|---|---|\n");
        for (int e = 0; e < count; ++e)
            std::printf("| %s | %s | %.2g | %.0f |\n", names[e],
                        is_poisson(e) ? "Poisson" : "fixed", of[size_t(e)].median(),
                        1e6 * of[size_t(e)].time());
        return;
    }
    std::printf(
        "| estimator | counts | standard deviation | bias ± its error | rmse | µs | efficiency, × "
        "mc "
        "|\n|---|---|---|---|---|---|---|\n");
    const double one = of[mc].rmse() * of[mc].rmse() * of[mc].time();
    for (int e = 0; e < count; ++e) {
        const Tally& t = of[size_t(e)];
        const Moments m = t.moments();
        std::printf("| %s | %s | %.2e | %+.1e ± %.0e | %.2e | %.0f | %.3g |\n", names[e],
                    is_poisson(e) ? "Poisson" : "fixed", t.deviation(), m.mean, m.standard_error(),
                    t.rmse(), 1e6 * t.time(), one / (t.rmse() * t.rmse() * t.time()));
    }
}

// Least-squares slope of log y over log x.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
    double xx = 0, xy = 0, mx = 0, my = 0;
    for (size_t k = 0; k < x.size(); ++k) {
        mx += std::log(x[k]) / double(x.size());
        my += std::log(y[k]) / double(x.size());
    }
    for (size_t k = 0; k < x.size(); ++k) {
        xx += (std::log(x[k]) - mx) * (std::log(x[k]) - mx);
        xy += (std::log(x[k]) - mx) * (std::log(y[k]) - my);
    }
    return xy / xx;
}

std::vector<double> numbers(const std::vector<Series>& all) {
    std::vector<double> n;
    for (const Series& s : all) n.push_back(double(s.n));
    return n;
}

template <class Value>
std::vector<double> column(const std::vector<Series>& all, size_t k, int e, Value value) {
    std::vector<double> y;
    for (const Series& s : all) y.push_back(value(s.of[k][size_t(e)]));
    return y;
}
double rmse_of(const Tally& t) { return t.rmse(); }
double deviation_of(const Tally& t) { return t.deviation(); }
double median_of(const Tally& t) { return t.median(); }

void print_slopes(const std::vector<Series>& all) {
    std::printf(
        "\n## Convergence: exponents of N in the rmse, N = %" PRIu64 " … %" PRIu64
        "\n\nTheory: mc −1/2; vor, undivided: Hölder with compact support at most −(1+α)/2, "
        "indicator "
        "−3/4;\nwhatever is not 0 on the border, −3/4 by its border cells.  (discontinuity: of the "
        "median error)\n\n| function | theory |",
        all.front().n, all.back().n);
    constexpr std::array shown = {mc,          vor,   vor_area,   poisson_area, cvor,
                                  cvor_border, torus, stratified, halton};
    for (int e : shown) std::printf(" %s |", names[e]);
    std::printf("\n|---|---|");
    for (size_t e = 0; e < shown.size(); ++e) std::printf("---|");
    std::printf("\n");
    for (size_t k = 0; k < functions.size(); ++k) {
        std::printf("| %s | %s |", functions[k].name,
                    functions[k].theory == 0 ? "–" : Axes::number(functions[k].theory).c_str());
        for (int e : shown)
            std::printf(
                " %.2f |",
                slope(numbers(all), column(all, k, e, functions[k].finite ? rmse_of : median_of)));
        std::printf("\n");
    }
    std::printf(
        "\n### Bias of clipped cells: N × bias; theory −1/(4π) ∫ Laplacian\n\n| function |");
    for (const Series& s : all) std::printf(" cvor, N = %" PRIu64 " |", s.n);
    for (const Series& s : all) std::printf(" + border correction, %" PRIu64 " |", s.n);
    std::printf(" theory |\n|---|---|---|---|---|---|---|---|---|---|\n");
    // Outward derivative of holder_a on x = 1/2: a (1/2)^(a-1) |y|^a; four sides.
    auto theory = [](double a) {
        return -4 * a * std::pow(0.5, a - 1) * 2 * std::pow(0.5, a + 1) / (a + 1) /
               (4 * std::numbers::pi);
    };
    const double theories[] = {theory(1), theory(0.5), theory(0.1), theory(0.01)};
    for (size_t k : {0, 1, 2, 3, 7, 8}) {
        std::printf("| %s |", functions[k].name);
        for (int e : {cvor, cvor_border})
            for (const Series& s : all) {
                const Moments m = s.of[k][size_t(e)].moments();
                std::printf(" %+.4f ± %.4f |", double(s.n) * m.mean,
                            double(s.n) * m.standard_error());
            }
        // The hat has the outward derivative -2 (1 - 2 |y|) there; the Laplacian of exp is 5/4 exp.
        std::printf(" %+.4f |\n", k == 7   ? 4 / (4 * std::numbers::pi)
                                  : k == 8 ? -1.25 * functions[k].integral / (4 * std::numbers::pi)
                                           : theories[k]);
    }
}

void print_findings(const std::vector<Series>& all) {
    const Series& s = all.back();
    auto sd = [&](size_t k, Estimator e) { return s.of[k][e].deviation(); };
    auto ratio = [&](size_t k, Estimator a, Estimator b) {
        return s.of[k][a].rmse() / s.of[k][b].rmse();
    };
    constexpr size_t holder_1 = 0, holder_001 = 3, not_holder = 4, not_c1 = 6, hat = 7;
    std::printf("\n## Four findings, N = %" PRIu64 "\n", s.n);
    std::printf(
        "\n1. Undivided, holder_0.01 has %.1f times the deviation of mc (fixed counts), %.1f times "
        "(Poisson);\n   divided, %.2f times.  Printed: divided.  %s\n",
        sd(holder_001, vor_area) / sd(holder_001, mc),
        sd(holder_001, poisson_area) / sd(holder_001, mc), sd(holder_001, vor) / sd(holder_001, mc),
        sd(holder_001, vor_area) > 3 * sd(holder_001, mc) ? "Confirmed." : "REFUTED.");
    const bool swapped =
        std::abs(sd(not_c1, mc) / 0.000585 - 1) < 0.15 && sd(not_holder, mc) > 5 * sd(not_c1, mc);
    std::printf(
        "2. The printed row not_holder (mc .000585, vor .000179): not_c1 has %.6f and %.6f,\n   "
        "not_holder %.6f and %.6f.  %s\n",
        sd(not_c1, mc), sd(not_c1, vor), sd(not_holder, mc), sd(not_holder, vor),
        swapped ? "Confirmed." : "REFUTED.");
    std::printf("3. Hat function, deviation at N =");
    for (const Series& t : all) std::printf(" %" PRIu64, t.n);
    std::printf(": undivided, Poisson");
    for (double x : column(all, hat, poisson_area, deviation_of)) std::printf(" %.2e", x);
    const double undivided = slope(numbers(all), column(all, hat, poisson_area, deviation_of)),
                 divided = slope(numbers(all), column(all, hat, poisson_vor, deviation_of));
    std::printf("\n   (exponent %.2f), divided", undivided);
    for (double x : column(all, hat, poisson_vor, deviation_of)) std::printf(" %.2e", x);
    std::printf(" (exponent %.2f).  %s\n", divided,
                undivided < -1 && divided > -0.9 ? "Confirmed." : "REFUTED.");
    std::printf("4. rmse of vor over that of cvor:");
    bool better = true;
    for (size_t k = 0; k < functions.size(); ++k)
        if (functions[k].finite) {
            std::printf(" %s %.1f;", functions[k].name, ratio(k, vor, cvor));
            better = better && ratio(k, vor, cvor) > 1;
        }
    std::printf("\n   bias on holder_1 %.1f %% of mc's deviation.  %s\n",
                -100 * s.of[holder_1][cvor].moments().mean / sd(holder_1, mc),
                better ? "Confirmed." : "REFUTED.");
    std::printf(
        "\nBeyond the paper: on holder_1 the border correction takes the rmse of cvor from %.2e to "
        "%.2e\n(deviation %.2e); stratified has %.2e, %.2f times that; linear in each cell %.2e.\n",
        s.of[holder_1][cvor].rmse(), s.of[holder_1][cvor_border].rmse(),
        s.of[holder_1][cvor_border].deviation(), s.of[holder_1][stratified].rmse(),
        ratio(holder_1, stratified, cvor_border), s.of[holder_1][cvor_linear].rmse());
    for (const Series& t : all)
        std::printf("\nN = %" PRIu64
                    ": strip of width ε = %.4f (p = 0.001), %.0f sites in it; %" PRIu64
                    " redraws in %" PRIu64 " strips,\n%.2g of the cells not settled by it, %" PRIu64
                    " without a cell.",
                    t.n, strip_width(double(t.n)),
                    double(t.n) * 4 * strip_width(double(t.n)) * (1 + strip_width(double(t.n))),
                    t.redraws, t.strips, double(t.unsettled) / double(t.cells), t.no_cells);
    std::printf("\n");
}

// ---- Plots --------------------------------------------------------------------------------------

void draw(const std::vector<Series>& all, const std::string& file) {
    constexpr std::array shown = {mc, vor, vor_area, cvor, cvor_border, torus, stratified, halton};
    constexpr int wide = 250, high = 190, step_x = wide + 70, step_y = high + 60;
    Image sheet = blank(4 * step_x + 20, 3 * step_y + 90);
    const std::vector<double> n = numbers(all);
    auto axes = [&](size_t cell, double y0, double y1, bool log_y) {
        return Axes{sheet,
                    55 + int(cell % 4) * step_x,
                    30 + int(cell / 4) * step_y,
                    wide,
                    high,
                    n.front(),
                    n.back(),
                    y0,
                    y1,
                    true,
                    log_y};
    };
    size_t cell = 0;
    for (size_t k = 0; k < functions.size(); ++k, ++cell) {
        const auto value = functions[k].finite ? rmse_of : median_of;
        double y0 = 1e30, y1 = 0;
        for (int e : shown)
            for (double y : column(all, k, e, value)) y0 = std::min(y0, y), y1 = std::max(y1, y);
        const Axes a = axes(cell, y0 / 1.5, y1 * 1.5, true);
        a.frame(std::string(functions[k].name) +
                    (functions[k].finite ? ": rmse over N" : ": median error over N"),
                n);
        for (size_t j = 0; j < shown.size(); ++j)
            a.curve(n, column(all, k, shown[j], value), palette[j]);
    }
    // Mean and deviation of not_c1, as in Figure 2; of holder_1 the time, as in Figure 3.
    {
        constexpr size_t not_c1 = 6;
        const double truth = functions[not_c1].integral,
                     spread = 1.2 * all[0].of[not_c1][mc].deviation();
        const Axes a = axes(cell++, truth - spread, truth + spread, false);
        a.frame("not_c1: mean and deviation", n);
        for (size_t j : {0, 1, 3}) {
            std::vector<double> low, mid, top;
            for (const Series& s : all) {
                const Moments m = s.of[not_c1][size_t(shown[j])].moments();
                const double sd = std::sqrt(m.variance());
                low.push_back(truth + m.mean - sd);
                mid.push_back(truth + m.mean);
                top.push_back(truth + m.mean + sd);
            }
            a.band(n, low, top, palette[j]);
            a.curve(n, mid, palette[j]);
        }
    }
    {
        const Axes a = axes(cell++, 1e-7, 1e-2, true);
        a.frame("holder_1: seconds over N", n);
        for (size_t j = 0; j < shown.size(); ++j)
            a.curve(n, column(all, 0, shown[j], [](const Tally& t) { return t.time(); }),
                    palette[j]);
    }
    for (size_t j = 0; j < shown.size(); ++j)
        caption(sheet, 55 + int(j % 4) * step_x, 45 + 3 * step_y + 20 * int(j / 4), names[shown[j]],
                palette[j], 2);
    write_image(file, sheet, 1);
}

int voronoi2d(const std::vector<std::string>& words) {
    uint64_t trials = 400;
    for (size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--quick") {
            trials = 50;
        } else if (words[i] == "--trials") {
            if (++i == words.size()) throw UserError("--trials: needs a value");
            trials = parse_count(words[i], 2, 1000000);
        } else {
            throw UserError(unknown("option", words[i], {"--trials", "--quick"}));
        }
    }
    const std::string file = "out/voronoi2d.png";
    std::filesystem::create_directories("out");
    check_writable(file);
    std::vector<Series> all;
    for (uint64_t n : {64, 256, 1024, 4096}) {
        Series& s = all.emplace_back();
        s.n = n;
        Trial trial(s);
        for (uint64_t t = 0; t < trials; ++t) trial.run(hash(n, t));
    }
    std::printf("# %" PRIu64
                " trials; counts fixed: N samples and N |strip| sites; Poisson: of these means.  "
                "Time: of the processor,\nsampling, function, weights and sum.\n",
                trials);
    for (size_t k = 0; k < functions.size(); ++k) print_table(all.back(), k);
    print_slopes(all);
    print_findings(all);
    draw(all, file);
    std::printf("\nPlots: %s\n", file.c_str());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return voronoi2d({argv + 1, argv + argc}); });
}

// labs/voronoi2d.cpp  4  integrals over a square by Voronoi cells: what they cost and bring
//
//   build/voronoi2d [--trials N] [--quick]
//
// Functions on [-1/2, 1/2]^2 integrated from N points by the weights of weights.h, and by what a
// user would really choose: jittered strata and scrambled Halton points.  After Vandewiele et al.
// 2025, "Voronoi integration of the rendering equation", Table 2 and Figures 2 and 3.  Writes
// voronoi2d.md and voronoi2d.svg.
#include "labs/voronoi_trials.h"

namespace {

using namespace trials;
using namespace functions;
using Row = std::vector<std::string>;
using Number = double (Estimates::*)() const;

// ---- The experiment -----------------------------------------------------------------------------

std::vector<Series> run_all(uint64_t count) {
    Steps steps(4);
    std::vector<Series> all;
    for (uint64_t n : {64, 256, 1024, 4096}) {
        steps.next(text("%d points", int(n)));
        all.emplace_back().n = n;
        Weigher weigher;
        for (uint64_t t = 0; t < count; ++t) run(all.back(), weigher, hash(n, t));
    }
    return all;
}

Values numbers(const std::vector<Series>& all) {
    Values n;
    for (const Series& s : all) n.push_back(double(s.n));
    return n;
}
Values column(const std::vector<Series>& all, size_t function, size_t e, Number number) {
    Values y;
    for (const Series& s : all) y.push_back((s.of[function][e].*number)());
    return y;
}
double exponent(const std::vector<Series>& all, size_t function, size_t e, Number number) {
    return slope(numbers(all), column(all, function, e, number));
}
// A mean of squares is no measure of what has no variance.
Number error_number(size_t function) {
    return list[function].has_variance() ? &Estimates::rmse : &Estimates::median_error;
}

// ---- The report ---------------------------------------------------------------------------------

// A column a function; cell(function).
template <class Cell>
Row row_of(const std::string& first, Cell cell) {
    Row row = {first};
    for (size_t k = 0; k < list.size(); ++k) row.push_back(cell(k));
    return row;
}

void explain(Report& report, uint64_t count, const Series& s) {
    const double width = strip_width(double(s.n));
    report.say("# Integrals over a square by Voronoi cells");
    report.say(text(
        "Vandewiele et al. (2025) weigh the samples of a square by the areas A of their Voronoi "
        "cells.  Here functions of known integral on [−½, ½]² are integrated from N points, %d "
        "times by every estimator (seed: hash(N, trial)).  `mc` is the plain mean of independent "
        "points.  `vor` weighs them by cells that random sites in a strip around the square bound, "
        "divided by ΣA unless \"undivided\"; `fvor` leaves out the cells that reach beyond the "
        "strip.  `cvor` clips the cells to the square; \"corrected\" adds back the first order of "
        "the bias that this brings, and \"linear\" integrates over each cell the plane that fits "
        "its neighbours best (neither is in the paper).  `torus` repeats the square.  `stratified` "
        "has a point in each of N squares, `Halton` has scrambled radical inverses in bases 2 and "
        "3.  The counts of points, and of sites in the strip, are fixed; \"Poisson\": only their "
        "means are.",
        int(count)));
    report.say(text(
        "The strip leaves a cell unbounded with a probability of at most p = 0.001: its width is "
        "√(u / πN), where 4 N u exp(−u) = p (Calka 2002).  At N = %d it is %.4f wide and holds "
        "%.0f sites; of %d strips %d were drawn again and %d left no cell, and sites beyond them "
        "could have changed %.1g of the cells.",
        int(s.n), width, double(s.n) * 4 * width * (1 + width), int(s.strips), int(s.redraws),
        int(s.none), double(s.unsettled) / double(s.cells)));
    report.head(row_of("function", [](size_t k) { return list[k].name; }));
    report.row(row_of("f", [](size_t k) { return list[k].formula; }));
    report.row(row_of("integral", [](size_t k) { return text("%.9g", list[k].integral); }));
    report.end_of_table();
}

// A row an estimator; cell(function, estimator).
template <class Cell>
void print_table(Report& report, Cell cell) {
    report.head(row_of("estimator", [](size_t k) { return list[k].name; }));
    for (size_t e = 0; e < estimators.size(); ++e)
        report.row(row_of(estimators[e].name, [&](size_t k) { return cell(k, e); }));
    report.end_of_table();
}

void print_errors(Report& report, const Series& s) {
    const auto& at = s.of;
    auto gain = [&](size_t k, size_t e) { return at[k][mc].cost() / at[k][e].cost(); };
    report.say(
        text("## Errors at N = %d\n\nRoot mean square errors.  discontinuity has no "
             "variance: of it, here and below, the median error.",
             int(s.n)));
    print_table(report,
                [&](size_t k, size_t e) { return text("%.2e", (at[k][e].*error_number(k))()); });
    report.say("Bias ± its standard error:");
    print_table(report, [&](size_t k, size_t e) {
        const Moments& m = at[k][e].error;
        return list[k].has_variance() ? text("%+.1e ± %.0e", m.mean, m.standard_error()) : "–";
    });
    report.say("Time of an estimate (sampling, function, weights and sum), µs on one thread:");
    print_table(report, [&](size_t k, size_t e) { return text("%.0f", 1e6 * at[k][e].time()); });
    report.say("Efficiency, 1 / (rmse² · time), over that of mc:");
    print_table(report, [&](size_t k, size_t e) {
        return list[k].has_variance() ? text("%.3g", gain(k, e)) : "–";
    });
    report.say(text(
        "A cell costs %.2f µs, so that on holder_1 cvor is %.0f times as efficient as mc, "
        "corrected "
        "%.0f times, but strata %.0f times: cells pay only where the function itself costs as much "
        "as they do.  The torus is as good as it looks for functions that are even, as all of the "
        "paper's are; exp, which is not, shows its seam.",
        1e6 * (at[holder_1][cvor].time() - at[holder_1][mc].time()) / double(s.n),
        gain(holder_1, cvor), gain(holder_1, cvor_corrected), gain(holder_1, stratified)));
}

void print_exponents(Report& report, const std::vector<Series>& all) {
    report.say("## Convergence");
    report.say(
        "Exponents of N in these errors, by least squares over all N.  In theory mc has −0.5; vor, "
        "undivided, −0.75 of an indicator and of whatever does not vanish on the border (by its "
        "border cells), of a Hölder function that does at most −(1 + α) / 2: here of hat alone, "
        "−1.");
    print_table(report, [&](size_t k, size_t e) {
        return text("%.2f", exponent(all, k, e, error_number(k)));
    });
}

void print_bias(Report& report, const std::vector<Series>& all) {
    report.say("## The bias of clipped cells");
    report.say(
        "It has a closed form.  Inside, the nearest site is at a mean square distance of 1/(πN), "
        "which gives Δf/(4πN); at the border it is displaced inwards by 1/(2πN) a unit of length.  "
        "By Gauss's theorem both add up to −1/(4πN) times the integral of ∂f/∂n over the border.  "
        "The correction estimates that integral from the gradients in the border's cells alone "
        "(least squares over their neighbours).  N · bias ± its standard error:");
    auto known = [](size_t k) { return !std::isnan(list[k].rim); };
    report.head(row_of("estimator", [](size_t k) { return list[k].name; }));
    report.row(row_of("cvor in theory", [&](size_t k) {
        return known(k) ? text("%+.4f", -list[k].rim / (4 * std::numbers::pi)) : "–";
    }));
    for (size_t e : {cvor, cvor_corrected})
        for (const Series& s : all)
            report.row(row_of(text("%s, N = %d", estimators[e].name, int(s.n)), [&](size_t k) {
                const Moments& m = s.of[k][e].error;
                const double n = double(s.n);
                return known(k) ? text("%+.4f ± %.4f", n * m.mean, n * m.standard_error()) : "–";
            }));
    report.end_of_table();
}

std::string words(const Values& x) {
    std::string out;
    for (double y : x) out += text("%s%.2g", out.empty() ? "" : ", ", y);
    return out;
}

void print_findings(Report& report, const std::vector<Series>& all) {
    const Series& s = all.back();
    auto sd = [&](size_t k, size_t e) { return s.of[k][e].deviation(); };
    auto verdict = [&](bool holds, const std::string& what) {
        report.say(report.verdict(holds, "Confirmed", "**Refuted**") + ": " + what);
    };
    report.say(text("## Four findings about the paper, at N = %d", int(s.n)));
    const double once = sd(holder_001, mc);
    verdict(sd(holder_001, vor_area) > 3 * once && sd(holder_001, vor) < once,
            text("the weights of its Table 2 are divided by their sum.  Undivided, as its formula "
                 "reads, holder_0.01 has %.1f times the deviation of mc (%.1f times with Poisson "
                 "counts); divided, %.2f times.",
                 sd(holder_001, vor_area) / once, sd(holder_001, poisson_area) / once,
                 sd(holder_001, vor) / once));
    verdict(std::abs(sd(not_c1, mc) / 0.000585 - 1) < 0.15 && sd(not_holder, mc) > 0.003,
            text("the row printed as not_holder (mc .000585, vor .000179) is that of not_c1, here "
                 "%.6f and %.6f; not_holder has %.5f and %.5f.",
                 sd(not_c1, mc), sd(not_c1, vor), sd(not_holder, mc), sd(not_holder, vor)));
    const double steep = exponent(all, hat, poisson_area, &Estimates::deviation),
                 flat = exponent(all, hat, poisson_vor, &Estimates::deviation);
    verdict(steep < -1 && flat > -0.9,
            text("its theory is about the undivided sum of functions that vanish on the border.  "
                 "Deviations of hat from N = %.0f to %.0f with Poisson counts: %s (exponent %.2f); "
                 "divided: %s (exponent %.2f).",
                 numbers(all).front(), numbers(all).back(),
                 words(column(all, hat, poisson_area, &Estimates::deviation)), steep,
                 words(column(all, hat, poisson_vor, &Estimates::deviation)), flat));
    Values gains;
    for (size_t k = 0; k < list.size(); ++k)
        if (list[k].has_variance()) gains.push_back(s.of[k][vor].rmse() / s.of[k][cvor].rmse());
    verdict(quantile(gains, 0) > 1,
            "clipping beats everything in the paper.  The rmse of vor is that of cvor times " +
                words(gains) +
                text(" (as in the tables, without discontinuity).  Of the deviations of not_holder "
                     "the ratio is %.1f: bias takes the rest.",
                     sd(not_holder, vor) / sd(not_holder, cvor)));
}

void print_verdict(Report& report, const Series& s) {
    const auto& of = s.of[holder_1];
    auto gain = [&](size_t k, size_t e) { return s.of[k][stratified].rmse() / s.of[k][e].rmse(); };
    report.say("## Beyond the paper");
    report.say(text(
        "On holder_1 the correction takes the rmse of cvor from %.2e to %.2e, for a deviation of "
        "%.2e; strata have %.2e.  So for functions of two variables that are dear to evaluate and "
        "smooth, clipped cells do beat strata: corrected by a factor of %.2f on holder_1 and %.1f "
        "on exp, linear by %.1f and %.1f.",
        of[cvor].rmse(), of[cvor_corrected].rmse(), of[cvor_corrected].deviation(),
        of[stratified].rmse(), gain(holder_1, cvor_corrected), gain(expo, cvor_corrected),
        gain(holder_1, cvor_linear), gain(expo, cvor_linear)));
}

// ---- Plots --------------------------------------------------------------------------------------

constexpr std::array shown = {mc, vor, vor_area, cvor, cvor_corrected, torus, stratified, halton};

struct Sheet {
    const std::vector<Series>& all;
    Svg svg{3 * 400, 4 * 270};
    int panels = 0;

    Plot panel(const Axis& y, const std::string& title) {
        const double left = 400 * (panels % 3) + 65, top = 270 * (panels / 3) + 30;
        ++panels;
        return {svg,
                {left, top},
                {220, 180},
                {"points, N", double(all.front().n), double(all.back().n), true, numbers(all)},
                y,
                title};
    }

    void curves(size_t k, Number number, const std::string& title, const std::string& unit) {
        double lo = INFINITY, hi = 0;
        for (size_t e : shown)
            for (double y : column(all, k, e, number)) lo = std::min(lo, y), hi = std::max(hi, y);
        lo = std::pow(10, std::floor(std::log10(lo))), hi = std::pow(10, std::ceil(std::log10(hi)));
        Plot plot = panel({unit, lo, hi}, list[k].name + ": " + title);
        for (size_t j = 0; j < shown.size(); ++j)
            plot.curve(numbers(all), column(all, k, shown[j], number), {.colour = svg::colours[j]},
                       estimators[shown[j]].name);
    }

    // Figure 2 of the paper.
    void spread(size_t k) {
        Plot plot = panel({"error, thousandths", -6, 6, false, {-6, -3, 0, 3, 6}},
                          list[k].name + ": mean ± deviation");
        auto thousandths = [&](size_t e, Number number) {
            Values y = column(all, k, e, number);
            for (double& x : y) x *= 1000;
            return y;
        };
        for (size_t j : {0, 1, 3})
            plot.spread(numbers(all), thousandths(shown[j], &Estimates::bias),
                        thousandths(shown[j], &Estimates::deviation), svg::colours[j],
                        estimators[shown[j]].name);
    }
};

Svg plots(const std::vector<Series>& all) {
    Sheet sheet{all};
    for (size_t k = 0; k < list.size(); ++k)
        sheet.curves(k, error_number(k), list[k].has_variance() ? "rmse" : "median error", "error");
    sheet.spread(not_c1);
    sheet.curves(holder_1, &Estimates::time, "time", "seconds");
    return sheet.svg;
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false;
    uint64_t count = 2000;
    auto set_count = [&](const std::string& word) { count = parse_count(word, 2, 1000000); };
    const Lab lab{"voronoi2d",
                  "Integrates functions over a square by Voronoi cells, strata and Halton points.",
                  {{"--trials", "N", "estimates of each kind (2000)", set_count},
                   {"--quick", "", "50 trials; writes into out/, not reference/",
                    [&](const std::string&) { count = 50, quick = true; }}}};
    return lab_main(argc, argv, lab, [&] {
        Report report(report_folder(quick), "voronoi2d");
        const std::vector<Series> all = run_all(count);
        explain(report, count, all.back());
        report.picture("voronoi2d", plots(all), "Errors of every estimator over N");
        print_errors(report, all.back());
        print_exponents(report, all);
        print_bias(report, all);
        print_findings(report, all);
        print_verdict(report, all.back());
        report.say(made_by(argc, argv));
        return report.finish();
    });
}

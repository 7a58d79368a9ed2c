// labs/voronoi2d.cpp  4  integrals over a square by Voronoi cells: what they cost and bring
//
//   build/voronoi2d [--trials N] [--quick]
//
// Functions on [-1/2, 1/2]^2 are integrated from N points by the weights of weights.h, jittered
// strata and scrambled Halton points.  After Vandewiele et al. 2025, "Voronoi integration of the
// rendering equation", Table 2 and Figures 2 and 3.
#include "labs/page.h"
#include "labs/voronoi_trials.h"

namespace {

using namespace trials;
using namespace functions;
using Number = double (Estimates::*)() const;
using Lines = std::vector<std::vector<std::string>>;

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

// ---- The report ---------------------------------------------------------------------------------

std::vector<std::string> head_of(const char* first) {
    std::vector<std::string> head = {first};
    for (const Function& f : list) head.push_back(f.name);
    return head;
}

// A line for each estimator, a column for each function; cell(function, estimator).
template <class Cell>
Lines lines_of(Cell cell) {
    Lines lines;
    for (size_t e = 0; e < estimators.size(); ++e) {
        lines.push_back({estimators[e].name});
        for (size_t k = 0; k < list.size(); ++k) lines.back().push_back(cell(k, e));
    }
    return lines;
}

// N times the bias of clipped cells, in theory and as measured.
Lines biases(const std::vector<Series>& all) {
    Lines lines = {{"in theory"}};
    auto known = [](size_t k) { return !std::isnan(list[k].rim); };
    for (size_t k = 0; k < list.size(); ++k)
        lines[0].push_back(known(k) ? text("%+.4f", -list[k].rim / (4 * std::numbers::pi)) : "–");
    for (size_t e : {cvor, cvor_corrected})
        for (const Series& s : all) {
            const double n = double(s.n);
            lines.push_back({text("%s, N = %.0f", estimators[e].name, n)});
            for (size_t k = 0; k < list.size(); ++k) {
                const Moments& m = s.of[k][e].error;
                lines.back().push_back(
                    known(k) ? text("%+.4f ± %.4f", n * m.mean, n * m.standard_error()) : "–");
            }
        }
    return lines;
}

// All that was measured.
std::string numbers_of_all(const std::vector<Series>& all) {
    Lines lines;
    for (const Series& s : all)
        for (size_t e = 0; e < estimators.size(); ++e)
            for (size_t k = 0; k < list.size(); ++k) {
                const Estimates& x = s.of[k][e];
                lines.push_back({estimators[e].name, list[k].name, text("%.0f", double(s.n)),
                                 text("%.3e", x.rmse()), text("%.3e", x.median_error()),
                                 text("%+.2e", x.bias()), text("%.0e", x.error.standard_error()),
                                 text("%.2f", 1e6 * x.time())});
            }
    return csv({"estimator", "function", "N", "RMSE", "median error", "bias", "its standard error",
                "microseconds"},
               lines);
}

void tell_findings(Page& page, const std::vector<Series>& all) {
    const Series& s = all.back();
    auto sd = [&](size_t k, size_t e) { return s.of[k][e].deviation(); };
    auto set = [&](const char* word, const char* format, double x) {
        page.set(word, text(format, x));
    };
    const double once = sd(holder_001, mc);
    page.claim("divided", sd(holder_001, vor_area) > 3 * once && sd(holder_001, vor) < once);
    set("undivided deviation", "%.1f", sd(holder_001, vor_area) / once);
    set("divided deviation", "%.2f", sd(holder_001, vor) / once);
    page.claim("row", std::abs(sd(not_c1, mc) / 0.000585 - 1) < 0.15 && sd(not_holder, mc) > 0.003);
    page.set("row numbers", text("%.6f and %.6f; not_holder has %.5f and %.5f", sd(not_c1, mc),
                                 sd(not_c1, vor), sd(not_holder, mc), sd(not_holder, vor)));
    const double steep = exponent(all, hat, poisson_area, &Estimates::deviation),
                 flat = exponent(all, hat, poisson_vor, &Estimates::deviation);
    page.claim("theory", steep < -1 && flat > -0.9);
    set("steep", "%.2f", steep);
    set("flat", "%.2f", flat);
    Values gains;
    for (size_t k = 0; k < list.size(); ++k)
        if (list[k].has_variance()) gains.push_back(s.of[k][vor].rmse() / s.of[k][cvor].rmse());
    page.claim("clipping", quantile(gains, 0) > 1);
    page.set("clipping gains", text("%.1f to %.0f", quantile(gains, 0), quantile(gains, 1)));
    auto gain = [&](size_t k, size_t e) { return s.of[k][mc].cost() / s.of[k][e].cost(); };
    set("cell", "%.2f",
        1e6 * (s.of[holder_1][cvor].time() - s.of[holder_1][mc].time()) / double(s.n));
    set("gain cvor", "%.0f", gain(holder_1, cvor));
    set("gain corrected", "%.0f", gain(holder_1, cvor_corrected));
    set("gain strata", "%.0f", gain(holder_1, stratified));
    auto beyond = [&](size_t k, size_t e) {
        return s.of[k][stratified].rmse() / s.of[k][e].rmse();
    };
    set("corrected holder", "%.2f", beyond(holder_1, cvor_corrected));
    set("corrected exp", "%.1f", beyond(expo, cvor_corrected));
    set("linear holder", "%.1f", beyond(holder_1, cvor_linear));
    set("linear exp", "%.1f", beyond(expo, cvor_linear));
}

void tell(Page& page, const std::vector<Series>& all, uint64_t count) {
    const Series& s = all.back();
    page.set("N", text("%.0f", double(s.n)));
    page.set("trials", text("%.0f", double(count)));
    page.set("errors", table(head_of("estimator"), lines_of([&](size_t k, size_t e) {
                                 return text("%.1e", (s.of[k][e].*error_number(k))());
                             })));
    page.data("voronoi2d-bias", csv(head_of("N × bias"), biases(all)));
    const Moments& m = s.of[holder_1][cvor].error;
    const double n = double(s.n);
    page.set("bias", text("%+.4f ± %.4f of %+.4f", n * m.mean, n * m.standard_error(),
                          -list[holder_1].rim / (4 * std::numbers::pi)));
    page.set("strips",
             text("%.4f wide and holds %.0f sites; of %.0f strips %.0f were drawn again and %.0f "
                  "left no cell",
                  strip_width(double(s.n)),
                  double(s.n) * 4 * strip_width(double(s.n)) * (1 + strip_width(double(s.n))),
                  double(s.strips), double(s.redraws), double(s.none)));
    page.data("voronoi2d", numbers_of_all(all));
    page.data("voronoi2d-exponents", csv(head_of("estimator"), lines_of([&](size_t k, size_t e) {
                                             return text("%.2f",
                                                         exponent(all, k, e, error_number(k)));
                                         })));
    tell_findings(page, all);
    page.plot("voronoi2d", plots(all));
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
        Page page(report_folder(quick), "voronoi2d");
        tell(page, run_all(count), count);
        page.set("made", made_by(argc, argv));
        return page.finish();
    });
}

// oracle/checks.h  verdicts about random numbers, each with its significance and its power
//
// Part of Penumbra, version 2.2, MIT licence (the text of LICENSE, if you copy this file alone).
// Needs C++20 and the standard library:  g++ -std=c++20 -O1 my_tests.cpp
//
//   oracle::Random random(oracle::seed_of("cosine hemisphere"));
//   oracle::Verdict v = oracle::expect_density(random, my_sample, my_pdf);
//   if (!v.pass) std::puts(v.text.c_str());  // its first line says what is wrong
//
// A check refuses what is right with a probability of at most `alpha` = 1e-6 (0 where it is exact),
// and passes what is off by delta_min with one of 1e-3.  It forgives rounding, which it measures,
// and nothing else.  This chapter has the checks in the order of reading; numbers.h and host.h are
// its tools, hints.h and pictures.h explain a refusal.  README.md has every check with an example.
#pragma once
#define ORACLE_VERSION 20200  // README.md says what changed since 2.0
#if __cplusplus < 202002L && !(defined(_MSVC_LANG) && _MSVC_LANG >= 202002L)
#error "oracle.h needs C++20: compile with -std=c++20"
#endif
// Calling code may have macros of these names; windows.h has the last four.
#pragma push_macro("pi")
#pragma push_macro("min")
#pragma push_macro("max")
#pragma push_macro("near")
#pragma push_macro("far")
#undef pi
#undef min
#undef max
#undef near
#undef far
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>
#ifdef _WIN32
#include <direct.h>
#else
#include <sys/stat.h>
#endif

// Calling code may have variables called n or alpha.
#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#define ORACLE_PRINTF [[gnu::format(printf, 1, 2)]]
#else
#define ORACLE_PRINTF
#endif

namespace oracle::detail {

inline constexpr double pi = std::numbers::pi;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

struct [[nodiscard]] Verdict {
    bool pass = false;
    double p = 1;          // two-sided; 1 if exact
    double delta_min = 0;  // smallest error seen with 99.9 % power; relative unless the truth is 0
    std::string text;      // the first line says what was seen, and what is wrong

    // With what was tested before it, an equation if there is one.
    Verdict of(const std::string& what) const {
        std::string named = what;
        named += ": ";
        return {pass, p, delta_min, named += text};
    }
};

// A point or direction in double, whatever type calling code has.
template <size_t N>
using Point = std::array<double, N>;
using Triple = Point<3>;

// Something that may have been forgotten or taken twice: a number in this very configuration (for
// means), or a function of the direction or point (for densities).
struct Factor {
    std::string name;
    std::function<double(const Triple&)> at;
    Factor(std::string name_, double value)
        : name(std::move(name_)), at([value](const Triple&) { return value; }) {}
    Factor(std::string name_, std::function<double(const Triple&)> at_)
        : name(std::move(name_)), at(std::move(at_)) {}
};

struct Options {
    double alpha = 1e-6;  // probability of refusing what is right
    double sees =
        0.01;  // distortion of a density seen with 99.9 % power: the number of samples follows
    uint64_t n = 0;         // number of samples, in place of what follows from `sees`
    double tolerance = 0;   // relative error of the density that is known and forgiven
    std::string name = {};  // begins the text, and names the picture
    std::vector<Factor> factors = {};
    Triple axis{0, 0, 0};  // of a hemisphere or lobe; (0,0,0): the mean of its samples
    double discrete = 0;   // part of the samples that are mirrors' and no part of the pdf
};

// A mean, its standard error with df degrees of freedom, and the unit of rounding (half an ulp of
// 1) of the numbers it is made of.
struct Estimate {
    double mean = 0, standard_error = 0;
    double df = infinity;
    double unit = 0x1p-53;
};

// Where failed checks draw what they saw: a folder, or "" for none.
inline std::string pictures = [] {
    const char* folder = std::getenv("ORACLE_PICTURES");
    return std::string(folder ? folder : "");
}();

// Checks that have used up their alpha, and the sum of it: a bound of the probability that any of
// them raised a false alarm.
inline std::atomic<int> statistical_checks = 0;  // threads may check at the same time
inline std::atomic<double> alpha_spent = 0;
inline void spend(double alpha) {  // += of libc++ 17 and older has no doubles
    double before = alpha_spent;
    while (!alpha_spent.compare_exchange_weak(before, before + alpha)) {
    }
}

// ---- Seeds --------------------------------------------------------------------------------------

// A function of the test's name (FNV-1a), so that nobody chooses it; TEST_SEED=n changes every one.
// It lengthens the name: a multiple of a number added to the seed could be what Random adds, too,
// and then only skip some draws.
inline uint64_t seed_of(const std::string& name) {
    const char* more = std::getenv("TEST_SEED");
    uint64_t seed = 0xcbf29ce484222325u;
    for (char c : more ? name + ' ' + more : name)
        seed = (seed ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return seed;
}

// Uniform numbers of [0,1) (SplitMix64; Steele, Lea, Flood 2014).  Of its own, lest the generator
// under test judge itself.
struct Random {
    uint64_t state;
    explicit Random(uint64_t seed) : state(seed) {}
    uint64_t bits() {
        uint64_t x = state += 0x9e3779b97f4a7c15u;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    }
    double operator()() { return double(bits() >> 11) * 0x1p-53; }
    double single() { return double(bits() >> 40) * 0x1p-24; }  // a float, never 1
};

// ---- Probabilities ------------------------------------------------------------------------------

inline double p_of_z(double z);                          // two-sided p-value of a normal number,
inline double p_of_t(double t, double k);                // of Student's t with k degrees of freedom
inline double p_at_least(double k, double mean);         // P(K >= k): Poisson,
inline double p_at_least(double k, double n, double p);  // or binomial of n trials

// P(X >= chi2) for chi-squared with k degrees of freedom.
inline double p_of_chi2(double chi2, double k, double noncentrality = 0);

// x >= 0 where p(x), which falls from 1 to 0, has fallen to `target`.
double where_equal(const auto& p, double target) {
    double low = 0, high = 1;
    while (p(high) > target) high *= 2;
    for (int i = 0; i < 60; ++i) {  // more than a double's 53 digits
        const double middle = (low + high) / 2;
        (p(middle) > target ? low : high) = middle;
    }
    return high;
}

// Power: what is off by delta_min passes with this probability, at which a normal number ends.
inline constexpr double miss = 1e-3, z_of_miss = 3.09;

// Standard errors by which the mean must be off for the t-test to see it with 99.9 % power: by the
// normal approximation of noncentral t (Johnson, Welch 1940) t_alpha + 3.09 sqrt(1 + t_alpha^2 / 2
// df), which is 8.0 for many degrees and alpha = 1e-6.
inline double smallest_shift(double df, double significance = 1e-6) {
    const double t = where_equal([=](double x) { return p_of_t(x, df); }, significance);
    return t + z_of_miss * std::sqrt(1 + t * t / (2 * df));
}

// Noncentrality of n counts whose probabilities are within this relative error, once they sum to 1.
inline double forgiven(double n, double tolerance) {
    return tolerance < 1 ? n * tolerance * tolerance / (1 - tolerance * tolerance) : infinity;
}

// Distortion sqrt(sum (p - q)^2 / q) of the cells' probabilities that chi-squared over n samples
// sees with 99.9 % power: from the exact noncentral distribution, a Poisson mixture.
inline double smallest_distortion(int df, double n, double significance = 1e-6) {
    const double critical = where_equal([=](double x) { return p_of_chi2(x, df); }, significance);
    auto missed = [=](double noncentrality) { return 1 - p_of_chi2(critical, df, noncentrality); };
    return std::sqrt(where_equal(missed, miss) / n);
}

// Cells of every density.  Few see most: at alpha = 1e-6 a noncentrality of 115, with 2525 cells
// one of 613.  `sees` follows from so many samples.
inline constexpr size_t cell_count = 32;
inline double samples_for(const Options& o) {
    return std::pow(smallest_distortion(int(cell_count) - 1, 1, o.alpha) / o.sees, 2);
}

// ---- Words --------------------------------------------------------------------------------------

// printf into a string of any length.
ORACLE_PRINTF inline std::string say(const char* format, ...) {
    va_list values, again;
    va_start(values, format);
    va_copy(again, values);
    std::string text(size_t(std::max(0, std::vsnprintf(nullptr, 0, format, values))), '\0');
    std::vsnprintf(text.data(), text.size() + 1, format, again);
    va_end(again);
    va_end(values);
    return text;
}

inline std::string say_p(double p) { return p > 0 ? say("p = %.2g", p) : "p < 1e-300"; }
inline std::string percent(double x) { return say("%.3g %%", 100 * x); }
template <size_t N>
std::string say_point(const Point<N>& c) {
    std::string text;
    for (double x : c) text += (text.empty() ? "" : ", ") + say("%.4g", x);
    return N == 1 ? text : "(" + text + ")";
}

// Of hints.h: the number, and its name if it has one within `tolerance`: "3.142 (pi)".
std::string times(double x, double tolerance);
// Why an estimate may be `ratio` times the truth, known within `tolerance`.
std::string cause_of(double ratio, double tolerance, const std::vector<Factor>& factors);
// Why an estimate may not be the truth.
std::string mean_hint(const Estimate& e, double truth, const std::vector<Factor>& factors);

// ---- Judgement ----------------------------------------------------------------------------------

inline Verdict named(const Verdict& v, const Options& o) {
    return o.name.empty() ? v : v.of(o.name);
}
inline Verdict failure(const std::string& why, const Options& o = {}) {
    return named({false, 0, infinity, why}, o);
}
// By a p-value, which uses up alpha.
inline Verdict verdict_of(double p, double delta_min, const Options& o) {
    ++statistical_checks;
    spend(o.alpha);
    return {p > o.alpha, p, delta_min, ""};
}

// Floats, whose unit is 6e-8 (a double's 1e-16), cannot tell their rounding from a small mistake.
inline constexpr const char* if_double = "; it is rounding if doubles pass";
inline const char* rounding_of(double unit) {
    return unit > 1e-10 ? if_double : "; could be rounding";
}

// Each operation adds a unit at most: `roundings` are forgiven, up to so many may be rounding.
inline constexpr double roundings = 64, many_roundings = 1000;
inline bool same_but_rounding(double a, double b, double unit, double most = roundings) {
    return std::abs(a - b) <= most * unit * std::max(std::abs(a), std::abs(b));
}

inline Verdict judge_exact(const char* what, double value, double truth, double unit,
                           const Options& o = {}) {
    Verdict v;
    v.pass = same_but_rounding(value, truth, unit);
    v.p = v.pass ? 1 : 0;
    v.text = say("%s is constant, %.17g, %s %.17g", what, value,
                 v.pass ? "as expected:" : "but expected was", truth);
    if (v.pass) return v;
    if (value == 0) {
        v.text = say("%s is 0 in every sample, expected %.7g", what, truth);
    } else if (same_but_rounding(value, truth, unit, many_roundings)) {
        v.text += say(": off by %.1e%s", value / truth - 1, rounding_of(unit));
    } else if (truth != 0) {
        v.text +=
            "; ratio " + times(value / truth, 1e-6) + cause_of(value / truth, 1e-6, o.factors);
    }
    return v;
}

// The estimate's mean is `truth`: Student's t-test, unless the spread is that of rounding.
inline Verdict judge(const char* what, const Estimate& e, double truth, const Options& o = {}) {
    if (!std::isfinite(e.mean) || !std::isfinite(e.standard_error))
        return failure(say("%s %g +- %g is not finite", what, e.mean, e.standard_error));
    if (!(e.df >= 1)) return failure("one number has no spread: no degree of freedom");
    // Numbers that differ by few roundings have no noise.
    if (e.standard_error <= 8 * e.unit * std::abs(e.mean))
        return judge_exact(what, e.mean, truth, e.unit, o);
    const double t = (e.mean - truth) / e.standard_error;
    const double seen = smallest_shift(e.df, o.alpha) * e.standard_error;
    Verdict v = verdict_of(p_of_t(t, e.df), seen / (truth != 0 ? std::abs(truth) : 1), o);
    v.pass = v.pass || same_but_rounding(e.mean, truth, e.unit);
    const std::string sigma =
        std::abs(t) < 1e4 ? say("%+.2f sigma", t)
                          : say("%.1e of itself away", std::abs(e.mean - truth) / std::abs(e.mean));
    v.text = say("%s %.7g +- %.2g, expected %.7g: %s, %s", what, e.mean, e.standard_error, truth,
                 sigma.c_str(), say_p(v.p).c_str());
    if (!v.pass && same_but_rounding(e.mean, truth, e.unit, many_roundings))
        v.text += rounding_of(e.unit);
    else if (!v.pass && truth != 0)
        v.text += mean_hint(e, truth, o.factors);
    v.text += (v.pass ? "; smallest bias seen with 99.9 % power: "
                      : "\nsmallest bias seen with 99.9 % power: ") +
              (truth != 0 ? percent(v.delta_min) : say("%.2g", v.delta_min));
    return v;
}

// ---- Means --------------------------------------------------------------------------------------

// Half an ulp of 1 of the number that f returns.
template <class Number>
double unit_of(Number) {
    if constexpr (std::is_floating_point_v<Number>)
        return double(std::numeric_limits<Number>::epsilon()) / 2;
    else
        return 0x1p-53;
}

size_t worst_of(size_t n, const auto& off) {
    size_t worst = 0;
    for (size_t i = 1; i < n; ++i)
        if (off(i) > off(worst)) worst = i;
    return worst;
}
inline double sum_of(const std::vector<double>& values) {
    double sum = 0;
    for (double x : values) sum += x;
    return sum;
}

// Numbers drawn, and what makes their mean untrustworthy.
struct Draws {
    std::vector<double> values = {};
    double unit = 0x1p-53;

    template <class Number>
    void add(Number number) {
        unit = unit_of(number);
        values.push_back(double(number));
    }
    double n() const { return double(values.size()); }

    // Mean and centred moments, by two passes.
    double mean() const {
        const double first = sum_of(values) / n();
        double sum = 0;
        for (double x : values) sum += x - first;
        return first + sum / n();
    }
    double moment(int power) const {
        const double m = mean();
        double sum = 0;
        for (double x : values) sum += power == 2 ? (x - m) * (x - m) : (x - m) * (x - m) * (x - m);
        return sum / n();
    }
    double variance() const { return n() > 1 ? moment(2) * n() / (n() - 1) : 0; }
    double skewness() const {
        const double m2 = moment(2);
        return m2 > 0 ? moment(3) / (m2 * std::sqrt(m2)) : 0;
    }
    Estimate estimate() const { return {mean(), std::sqrt(variance() / n()), n() - 1, unit}; }

    bool constant() const {
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        return same_but_rounding(*least, *most, unit);
    }

    // Of numbers.h: the index xi of the tail, P(|x - mean| > t) ~ t^(-1/xi), by the k farthest; and
    // whether it is that of an infinite variance, as far as is known.
    double tail_index(size_t k) const;
    bool heavy() const;
    static constexpr size_t tail = 400;

    // Why the mean cannot be judged; empty if it can.  Fewer than `fewest` do not show a skewness
    // that would mislead the t-test.  It keeps its alpha within a factor of 2 from n = 1000
    // skewness^2 on (measured with Bernoulli trials of 1 %).  A sample of n normal numbers has a
    // skewness of 0 +- sqrt(6 / n): five of those are no evidence.
    static constexpr double fewest_numbers = 200;  // of so many a skewness of 1.3 is evidence
    std::string problem(double fewest = 0) const {
        if (values.empty()) return "no sample at all";
        for (size_t i = 0; i < values.size(); ++i)
            if (!std::isfinite(values[i])) return say("sample %zu is %g, not finite", i, values[i]);
        if (constant()) return "";
        if (n() < fewest)
            return say("n = %.0f is too small to know how skewed the numbers are: take 1000", n());
        if (heavy())
            return say(
                "the variance may be infinite: the tail falls as t^-%.1f (largest value %g, mean "
                "%g)",
                1 / tail_index(tail), *std::max_element(values.begin(), values.end()), mean());
        const double s = skewness(), known = std::max(0.0, std::abs(s) - 5 * std::sqrt(6 / n()));
        if (n() >= 1000 * known * known) return "";
        return say(
            "n = %.0f is too small for a skewness of %.2g: take %.0f or more; if it grows with n, "
            "the variance is infinite",
            n(), s, 1000 * known * known);
    }
};

// Of pictures.h: draws the running mean, and says where.
std::string picture_of(const Draws& d, double truth, const Options& o);

template <class F>
Draws draw(uint64_t n, F f) {
    Draws draws;
    for (uint64_t i = 0; i < n; ++i) draws.add(f());
    return draws;
}

inline Verdict judge(const char* what, const Draws& d, double truth, const Options& o = {},
                     double fewest = 0) {
    Verdict v;
    if (const std::string why = d.problem(fewest); !why.empty())
        v = failure(why +
                    (truth != 0 && std::isfinite(d.mean())
                         ? "; the mean is " + times(d.mean() / truth, 0.02) + " of what is expected"
                         : ""));
    else if (d.constant())
        v = judge_exact(what, d.mean(), truth, d.unit, o);
    else
        v = judge(what, d.estimate(), truth, o);
    if (!v.pass && d.n() >= 2 && std::isfinite(d.variance())) v.text += picture_of(d, truth, o);
    return named(v, o);
}

// The mean of n independent draws f() is `truth`.
template <class F>
Verdict expect_mean(double truth, uint64_t n, F f, const Options& o = {}) {
    return judge("mean", draw(n, f), truth, o, Draws::fewest_numbers);
}
inline Verdict expect_mean(double truth, const Estimate& e, const Options& o = {}) {
    return named(judge("mean", e, truth, o), o);
}

// Two independent estimates have the same mean: Welch's test (1947).  Exact if both are constant.
inline Verdict expect_equal(const Estimate& a, const Estimate& b, const Options& o = {}) {
    const double va = a.standard_error * a.standard_error, vb = b.standard_error * b.standard_error;
    const double df = va + vb > 0 ? (va + vb) * (va + vb) / (va * va / a.df + vb * vb / b.df) : 1;
    const Estimate first{a.mean, std::sqrt(va + vb), df, std::max(a.unit, b.unit)};
    return named(judge("first of two means", first, b.mean, o), o);
}

// f() and g() have the same mean: n independent draws of each.
template <class F, class G>
Verdict expect_equal(F f, G g, uint64_t n, const Options& o = {}) {
    const Draws a = draw(n, f), b = draw(n, g);
    for (const auto& [name, draws] : {std::pair{"first: ", &a}, std::pair{"second: ", &b}})
        if (const std::string why = draws->problem(Draws::fewest_numbers); !why.empty())
            return failure(name + why, o);
    return expect_equal(a.estimate(), b.estimate(), o);
}

// Quasi-Monte Carlo: f(r) is the whole estimate of the r-th independent randomisation of the point
// set.  Its samples depend on each other, so that a replicate is one number, taken as normal: of
// few numbers that decides, as t at a p of 1e-6 is 7.9 for 16 of them, and 16 for 8.
template <class F>
Verdict expect_replicates(double truth, int replicates, F f, const Options& o = {}) {
    Draws d;
    for (int r = 0; r < replicates; ++r) d.add(f(r));
    if (0 < replicates && replicates < 16 && !d.constant())
        return failure(say("%d replicates show no significance of 1e-6: take 16", replicates), o);
    return judge("mean of replicates", d, truth, o);
}

// Consistent estimators: the bias of f(n), its error from n samples (less that of an unbiased
// estimate from the same samples, if this cancels noise), is constant / n + O(1 / n^2).  With B(n)
// = n f(n), 2 B(2n) - B(n) is `constant` up to O(1 / n^2).
template <class F>
Verdict expect_bias_decay(double constant, uint64_t n, uint64_t trials, F f,
                          const Options& o = {}) {
    const Draws a = draw(trials, [&] { return double(n) * f(n); });
    const Draws b = draw(trials, [&] { return double(2 * n) * f(2 * n); });
    for (const Draws* d : {&a, &b})
        if (const std::string why = d->problem(); !why.empty()) return failure(why, o);
    const double error = std::hypot(2 * b.estimate().standard_error, a.estimate().standard_error);
    const Estimate limit{2 * b.mean() - a.mean(), error, double(trials) - 1};
    return named(judge("limit of n * bias", limit, constant, o), o);
}

// ---- Counts -------------------------------------------------------------------------------------

// Of host.h: the numbers of any array.
template <class Array>
std::vector<double> numbers_in(const Array& array);

// Cells where 100 or more are expected: with 5, chi-squared's p-value of 1e-5 comes 6 times too
// often, with 50 1.5 times (measured).
inline constexpr double fewest_in_cell = 100;
// Where so few are expected, one that comes is a mistake: its probability is alpha's default.
inline constexpr double none_in_cell = 1e-6;

// Chi-squared of counts, and its p-value.  `variances`: of the probabilities, where they are
// estimates.  Probabilities that are off by `tolerance` of themselves give a noncentral one.
struct CountsFit {
    double n, p = 0, chi2 = 0, fewest = infinity;  // expected in a cell
    int cells = 0;
    size_t impossible = 0;  // 1 + a cell where the density is 0, but counts are not
};
inline CountsFit fit_counts(const std::vector<double>& counts,
                            const std::vector<double>& probabilities,
                            const std::vector<double>& variances, double tolerance) {
    CountsFit fit{sum_of(counts)};
    for (size_t i = 0; i < counts.size(); ++i) {
        const double expected = fit.n * probabilities[i], seen = counts[i];
        if (expected <= none_in_cell) {
            if (seen > 0) fit.impossible = i + 1;
            continue;
        }
        fit.fewest = std::min(fit.fewest, expected);
        const double known = variances.empty() ? 0 : fit.n * fit.n * variances[i];
        fit.chi2 += (seen - expected) * (seen - expected) / (expected + known);
        ++fit.cells;
    }
    if (fit.cells > 1 && fit.impossible == 0)
        fit.p = p_of_chi2(fit.chi2, fit.cells - 1, forgiven(fit.n, tolerance));
    return fit;
}

// Counts follow the probabilities: chi-squared.
inline Verdict judge_counts(const std::vector<double>& counts,
                            const std::vector<double>& probabilities, const Options& o,
                            const std::vector<double>& variances) {
    if (probabilities.size() != counts.size())
        return failure(say("%zu probabilities for %zu counts", probabilities.size(), counts.size()),
                       o);
    if (!variances.empty() && variances.size() != counts.size())
        return failure(say("%zu variances for %zu counts", variances.size(), counts.size()), o);
    for (const auto* numbers : {&counts, &probabilities, &variances})
        for (double x : *numbers)
            if (!(x >= 0 && std::isfinite(x)))
                return failure(say("a count or probability is %g", x), o);
    const CountsFit fit = fit_counts(counts, probabilities, variances, o.tolerance);
    if (fit.n == 0) return failure("no sample at all", o);
    if (const size_t cell = fit.impossible; cell > 0)
        return failure(say("%.0f samples of %.0f in cell %zu, where the density is 0",
                           counts[cell - 1], fit.n, cell - 1),
                       o);
    if (fit.cells < 2) return failure("fewer than two cells", o);
    if (fit.p > o.alpha && fit.fewest < fewest_in_cell)
        return failure(say("n = %.0f is too small: %.1f expected in a cell, take %.0f", fit.n,
                           fit.fewest, std::ceil(fewest_in_cell * fit.n / fit.fewest)),
                       o);
    Verdict v =
        verdict_of(fit.p, smallest_distortion(fit.cells - 1, fit.n, o.alpha) + o.tolerance, o);
    v.text = say("chi2 = %.1f on %d cells (n = %.0f), %s; smallest distortion seen with "
                 "99.9 %% power: ",
                 fit.chi2, fit.cells, fit.n, say_p(v.p).c_str()) +
             percent(v.delta_min);
    return named(v, o);
}

// Counts of any cells, and their probabilities; variances of these, where they are estimates.
template <class Counts, class Probabilities>
Verdict expect_counts(const Counts& counts, const Probabilities& probabilities,
                      const Options& o = {}, const std::vector<double>& variances = {}) {
    return judge_counts(numbers_in(counts), numbers_in(probabilities), o, variances);
}

// ---- Calling code -------------------------------------------------------------------------------

// What the checks see of calling code, without its types, so that they are compiled once.  host.h
// makes it of vectors, samplers and densities of any kind.
template <class V>
auto coordinates(const V& v);  // an array of them
template <class V>
using Coordinate = typename decltype(detail::coordinates(std::declval<const V&>()))::value_type;
template <class V>
auto point(const V& v);  // in double,
template <class V, size_t N>
V of_host(const Point<N>& c);  // and back

// A point, and the density that the sampler returned with it, or NaN.
template <size_t N>
struct Drawn : Point<N> {
    double pdf;
};

// A sampler and a density: a map from the unit cube to points, or to nothing where it fails, and
// their density.  M is 0 for a sampler that draws by itself.
template <size_t M, size_t N>
struct Model {
    std::function<std::optional<Drawn<N>>(const Point<M>&)> sample;
    std::function<double(const Point<N>&)> pdf;
    bool says_pdf;    // sample returns a density, too
    bool single;      // coordinates are floats
    bool floats;      // so are the numbers that sample takes
    double unit;      // of their rounding,
    double pdf_unit;  // and of the density's

    Point<M> draw(Random& random) const {
        Point<M> u;
        for (double& x : u) x = single || floats ? random.single() : random();
        return u;
    }
};
template <class Sample, class Pdf>
auto model(Sample& sample, Pdf& pdf);
template <class Choose, class Probability>
auto chooser(Choose& choose, Probability& probability);  // a Model of indices; negative ones: none

// ---- Choices ------------------------------------------------------------------------------------

// Of hints.h: what is wrong with a choice.
std::string choice_hint(const std::vector<double>& expected, const std::vector<double>& seen,
                        double none, double tolerance, size_t unused = 0);

// Counts follow these probabilities, less a part that fails; rare ones by Poisson.
struct ChoiceFit {
    double p = 1, chi2 = 0, cells = 0;
};
ChoiceFit fit_choices(const std::vector<double>& probabilities, const std::vector<double>& seen,
                      double none, double tolerance);  // of numbers.h

// unused: 1 + the number that changes no choice.
inline Verdict judge_choices(const std::vector<double>& expected, const std::vector<double>& seen,
                             double none, const Options& o, size_t unused = 0) {
    const double n = none + sum_of(seen);
    const ChoiceFit fit = fit_choices(expected, seen, none, o.tolerance);
    const double cells = std::max(1.0, fit.cells - 1);
    Verdict v = verdict_of(fit.p, smallest_distortion(int(cells), n, o.alpha) + o.tolerance, o);
    v.text = say("%.0f choices among %zu, chi2 = %.1f on %.0f cells, %s; smallest distortion seen "
                 "with 99.9 %% power: ",
                 n, seen.size(), fit.chi2, fit.cells, say_p(v.p).c_str()) +
             percent(v.delta_min);
    if (!v.pass) v.text = choice_hint(expected, seen, none, o.tolerance, unused) + "\n" + v.text;
    return named(v, o);
}

std::string of_what_is_said(const std::vector<double>& ratios);
template <size_t M>
size_t unused_number(Random& random, const Model<M, 1>& model);

template <size_t M>
Verdict judge_choice(Random& random, const Model<M, 1>& model, size_t count, const Options& o) {
    std::vector<double> expected(count), seen(count), ratios;  // said / expected, where they differ
    double total = 0, none = 0, compared = 0;
    for (size_t i = 0; i < count; ++i) {
        total += expected[i] = model.pdf({double(i)});
        if (!(expected[i] >= 0 && std::isfinite(expected[i])))
            return failure(say("the probability of index %zu is %g", i, expected[i]), o);
    }
    for (uint64_t k = 0, n = o.n ? o.n : uint64_t(samples_for(o)); k < n; ++k) {
        const Point<M> u = model.draw(random);
        const auto chosen = model.sample(u);
        const double index = (*chosen)[0], said = chosen->pdf;
        if (index >= double(count))
            return failure(say("index %.0f of %zu chosen, beyond the last, at u = ", index, count) +
                               say_point(u),
                           o);
        ++(index < 0 ? none : seen[size_t(index)]);
        if (!model.says_pdf || index < 0) continue;
        ++compared;
        // Differences of sums are rounded by some units of the sum, all else by units of itself.
        const double wanted = expected[size_t(index)], unit = std::max(model.unit, model.pdf_unit);
        if (!(std::abs(said - wanted) <=
              16 * unit + (many_roundings * unit + o.tolerance) * wanted))
            ratios.push_back(said / wanted);
    }
    if (!ratios.empty())
        return failure("the probability that choose returns is " + of_what_is_said(ratios) +
                           (double(ratios.size()) == compared
                                ? ", in every choice"
                                : ", in " + percent(double(ratios.size()) / compared) + " of them"),
                       o);
    // Floats may have been returned as doubles.
    const double rounding = std::max(roundings * model.pdf_unit, 0x1p-24) * double(count);
    if (none == 0 && std::abs(total - 1) > rounding + o.tolerance)
        return failure("the probabilities sum to " +
                           (std::abs(total - 1) < 1e-3 ? say("%.9g", total) : times(total, 1e-4)) +
                           ", expected 1; " + choice_hint(expected, seen, none, o.tolerance),
                       o);
    return judge_choices(expected, seen, none, o, unused_number(random, model));
}

// choose(u), or choose(u, v), is an index below count, or a negative one for none, as often as
// probability(index) says: they sum to 1 less the part that fails; so does what choose returns
// beside the index.  Chi-squared over the indices, rare ones together.
template <class Choose, class Probability>
Verdict expect_choice(Random& random, Choose choose, Probability probability, size_t count,
                      const Options& o = {}) {
    return judge_choice(random, detail::chooser(choose, probability), count, o);
}

// ---- Jacobians ----------------------------------------------------------------------------------

// The density p that the pdf has at one point x(u), and q = 1 / sqrt(det J^T J) of this sheet of
// the map, by differences.  Where several u lead to x, p > q.
template <size_t N>
struct Local {
    Point<N> x;
    double p = 0, q = 0;
    double error = 0;     // relative, of q: what two step sizes differ by
    double noise = 0;     // relative, of q: standard deviation by the rounding of x(u)
    double collapse = 1;  // det over the product of the slopes: 0 where they are parallel
    unsigned still = 0;   // a bit for each number that moves nothing
    double product() const { return p / q; }
};

// The map at so many points: a sheet over 2.3 % of the unit cube is missed by all once in 1000.
// Fewer than `fewest_sheets` of them are no smooth map.
inline constexpr int sheet_points = 300;
inline constexpr size_t fewest_sheets = 100;
template <size_t N, size_t D>
struct Sheets {
    std::vector<Local<N>> all;    // where differences at two steps agree
    std::optional<Local<N>> off;  // p < q (or, if asked, p > q), and not by rounding
    Point<D> u{};                 // there
    double blind = 0;             // errors below this are not told from rounding
};

// Of numbers.h: asks for p < q by more than `tolerance`, or also for p > q.
template <size_t D, size_t N>
Sheets<N, D> sheets_of(const Model<D, N>& model, Random& random, double tolerance, double forgiven,
                       bool both_sides);
inline double median(std::vector<double> x, double part = 0.5);

// Where samples lie, for hints.
template <size_t N>
struct Scene {
    bool directions = false;
    Triple lobe{0, 0, 1}, normal{0, 0, 1};
    Point<N> centre{};  // of a box or of the samples
    Point<N> middle{};  // of the samples

    double distance(const Point<N>& x) const {  // from there, squared
        double square = 0;
        for (size_t k = 0; k < N; ++k) square += std::pow(x[k] - middle[k], 2);
        return square;
    }
};

// Of hints.h: the mistake that explains all sheets, and the ratio of two pdfs at these points.
template <size_t N>
std::string mistake_behind(const std::vector<Local<N>>& all, const auto& model,
                           const Scene<N>& scene, double total, double share, const Options& o);
template <size_t N>
std::string law_of_pdfs(const Scene<N>& scene, const Options& o, const std::vector<double>& ratios,
                        const std::vector<Point<N>>& where);

// Moved by rounding: four units away, or less, of the longest coordinate.
inline constexpr double jitter = 4;
template <size_t N>
Point<N> jittered(Point<N> x, double unit, Random& random) {
    double length = 0;
    for (double k : x) length = std::max(length, std::abs(k));
    for (double& k : x) k += (random() - 0.5) * 2 * jitter * length * unit;
    return x;
}

// What sample returns beside a point is compared for so many samples.  It may be computed in
// another way than what pdf or eval returns, with other roundings: the two agree within 32 times
// the change to jittered neighbours, and a part of 1e-8, or of 1e-3 in float, where cosines near 1
// have few digits (chosen; the bugs of bugs-found.md are larger).  Samples that 32 units move
// across a jump may disagree (`jumps` are those of a jitter, of 2 units on average), and
// `chance_few` more.
inline constexpr int compared_samples = 2048, neighbours = 4;
inline constexpr double chance_few = 8;
inline double agreement(double change, bool single, const Options& o) {
    return 32 * change + (single ? 1e-3 : 1e-8) + o.tolerance;
}

// The pdf that sample returns against that of pdf(), of which this part of the samples lies at a
// jump; but at mirrors.  "" if the two agree.
template <size_t M, size_t N>
std::string other_pdf(Random& random, const Model<M, N>& model, const Scene<N>& scene,
                      const Options& o, double jumps = 0,
                      const std::vector<Point<N>>& mirrors = {}) {
    if (!model.says_pdf) return "";
    auto at = [&](const Point<N>& x) {
        return (scene.directions ? ", at direction " : ", at point ") + say_point(x);
    };
    std::vector<double> ratios;
    std::vector<Point<N>> where;
    std::string first;
    double compared = 0;
    for (int i = 0; i < compared_samples; ++i) {
        const auto x = model.sample(model.draw(random));
        if (!x || std::find(mirrors.begin(), mirrors.end(), *x) != mirrors.end()) continue;
        const double p = model.pdf(*x), said = x->pdf;
        if (std::isnan(said)) return "the pdf that sample returns is nan" + at(*x);
        if (p == 0 && said <= 0) continue;
        ++compared;
        double close = roundings * model.pdf_unit;
        for (int j = 0; j < neighbours; ++j) {
            const Point<N> near = jittered<N>(*x, model.unit, random);
            close = std::max(close, std::abs(model.pdf(near) / p - 1));
        }
        if (std::abs(said / p - 1) <= agreement(close, model.single, o)) continue;
        if (ratios.empty()) first = say("%.4g, but pdf says %.4g", said, p) + at(*x);
        ratios.push_back(said / p);
        where.push_back(*x);
    }
    const double off = double(ratios.size());
    if (off <= chance_few + 16 * jumps * compared) return "";
    const std::string often =
        off == compared ? ", in every sample" : ", in " + percent(off / compared) + " of them";
    if (const std::string law = law_of_pdfs(scene, o, ratios, where); !law.empty())
        return "the pdf that sample returns is " + law + " times what pdf says" + often;
    return "the pdf that sample returns is " + first + often;
}

template <size_t D, size_t N>
Verdict judge_jacobian(Random& random, const Model<D, N>& model, const Options& o) {
    if (const std::string off = other_pdf(random, model, Scene<N>{}, o); !off.empty())
        return failure(off, o);
    // Differences in float err by a thousandth where x(u) is rounded.
    const double least = model.single ? 1e-3 : 1e-6, tolerance = least + o.tolerance;
    const Sheets<N, D> s = sheets_of(model, random, least, o.tolerance, true);
    Verdict v;
    v.pass = s.all.size() >= fewest_sheets && !s.off;
    v.p = v.pass ? 1 : 0;
    v.delta_min = o.tolerance + s.blind;
    v.text = say("pdf sqrt(det J^T J) = 1 within %.1e at %zu points", v.delta_min, s.all.size());
    if (s.all.size() < fewest_sheets)
        v.text = say("the map is smooth at %zu of %d points only: is it one map, without choices?",
                     s.all.size(), sheet_points);
    if (s.off) {
        const double product = s.off->product();
        v.text = say("pdf sqrt(det J^T J) = %.8g, expected 1 +- %.0e: ", product, tolerance);
        const std::string why = mistake_behind(s.all, model, Scene<N>{}, product, 0, o);
        v.text += !why.empty()
                      ? why
                      : say("samples are %.4g times as dense as the pdf says", 1 / product);
        v.text += ", at " + say_point(s.off->x) + ", u = " + say_point(s.u);
        if (model.single && std::abs(product - 1) < 10 * s.blind) v.text += if_double;
    }
    return named(v, o);
}

// Samples x(u) of a smooth one-to-one map of the unit cube have the density pdf(x): pdf sqrt(det
// J^T J) = 1, by differences, without noise.  Of directions, points of surfaces in space, anything.
template <class Sample, class Pdf>
Verdict expect_jacobian(Random& random, Sample sample, Pdf pdf, const Options& o = {}) {
    return judge_jacobian(random, detail::model(sample, pdf), o);
}

// ---- Densities ----------------------------------------------------------------------------------

// Domains, which numbers.h defines: directions per solid angle; a box, space, or a triangle of the
// plane or of space, per length, area or volume.  A domain of your own has the members of Square.
struct Sphere;
template <size_t D>
struct Box;
template <size_t D>
struct Space;
template <size_t N>
struct Triangle;
struct Interval;
struct Square;
using Line = Space<1>;
using Plane = Space<2>;

inline double dot(const Triple& a, const Triple& b);
inline Triple normalized(const Triple& a);
template <size_t N>
auto usual_domain();  // Sphere for three coordinates, else Space
template <size_t D>
struct Range;  // of coordinates, from lower to upper
template <size_t D>
void for_parts(const Range<D>& range, size_t n, size_t k, const auto& use);  // each of n equal ones
template <size_t D>
struct Cells;  // cell_count ranges that a few points fill alike

// The part of a density in each cell, and the variance of what is not known exactly.
struct Parts {
    std::array<double, cell_count> value{}, variance{};
    double total = 0, error = 0;  // standard error of the total

    // As fractions of the total.
    std::vector<double> shares() const {
        std::vector<double> p;
        for (double x : value) p.push_back(x / total);
        return p;
    }
    std::vector<double> variances() const {
        std::vector<double> v;
        for (double x : variance) v.push_back(x / (total * total));
        return v;
    }
};

template <class Domain>
constexpr bool is_sphere = std::is_same_v<Domain, Sphere>;

// Of numbers.h.  Why a sample w, of the coordinates c, is no point of the domain; "" if it is.
// extent: median of the squared distances of samples from one of them.
template <class Domain, size_t N, size_t D>
std::string stray(const Domain& domain, const Point<N>& w, const Point<D>& c, double unit,
                  double extent);
template <size_t N>
double extent_of(const std::vector<Point<N>>& points);
template <size_t N, class Domain>
Scene<N> scene_of(const Domain& domain, const Options& o, const Point<N>& middle);

// The pilot: 128 samples for each cell, if one in a hundred arrives; of 32 for each the integral
// can still be divided.
inline constexpr size_t pilot_size = 4096, fewest_of_pilot = 1024;
inline constexpr int pilot_draws = 400'000;

// One check of a sampler against a density: run(), and its steps in the order of their costs.
template <size_t M, size_t N, class Domain>
struct DensityCheck {
    Verdict run();

    static constexpr size_t D = Domain::dimensions;
    static constexpr bool directions = is_sphere<Domain>;

    Random& random;
    const Model<M, N>& model;
    Domain domain;  // which fits itself to the pilot
    const Options& o;

    // Counted by at_numbers().
    std::string wrong = {};       // the first thing that no right sampler or pdf does
    double samples = 0;           // drawn: of these
    double none = 0;              // fail,
    double mirrored = 0;          // and come from mirrors
    std::string first_none = {};  // how the first one failed

    // Found by find_mirrors().
    std::vector<Point<N>> mirrors = {};  // points that repeat, and .discrete says so
    std::string repeated = {};           // a point that repeats, and nobody said so
    double repeating = 0;                // the part of the samples at such points
    size_t heaps = 0;                    // the number of such points

    // Found by fly_pilot().
    std::vector<Point<D>> pilot = {};   // samples, in coordinates of the domain
    std::vector<double> heights = {};   // the pdf there
    std::vector<Point<D>> places = {};  // the pilot, and mirror images where the pdf is positive
    std::vector<double> per_dc = {};    // the pdf at places, times the domain's weight
    Point<N> middle{};                  // the pilot's median
    double extent = 0;                  // the median of its squared distances from one point
    double arriving = 1;                // the part of the samples that does not fail, nearly
    double rounding = 0;  // what an ulp or two of x change the pdf by: relative, on average
    double grain = 0;     // the part of the domain that rounding moves borders by
    double jumps = 0;     // the part of the samples that an ulp or two move across a border

    // Found by density_at() on the way.
    std::function<double(const Point<N>&)> claim = {};  // a hint's guess, in place of the pdf
    double most_negative = 0;                           // the least value of the pdf
    std::string where_negative = {};

    // Found in the end.
    Cells<D> cells = {};
    Parts parts = {};                                              // integrals over the cells
    Sheets<N, M> sheets = {};                                      // of the map
    double close = 0;                                              // how well the integral is known
    std::vector<double> counts = std::vector<double>(cell_count);  // samples in each cell
    std::vector<double> expected = counts;                         // their parts by the pdf
    bool counted = false;                                          // counts agree with the pdf
    bool balanced = false;  // so does the part that fails with the integral

    std::optional<Point<D>> at_numbers(const Point<M>& u, bool rim = false);  // one sample
    double density_at(const Point<D>& c);

    // Of numbers.h.
    void find_mirrors();
    void fly_pilot();
    void try_rims();  // 0 and the number next to 1
    double moved();   // the part of a cell's samples that rounding may move to another
    Parts integrate();
    void divide(const Range<D>& range, const std::vector<size_t>& inside,
                std::vector<Range<D>>& parts, int depth) const;
    template <class F>
    Parts scatter(const F& f, const std::vector<Range<D>>& ranges,
                  const std::vector<size_t>& of_cell);

    // One sample, in the domain's coordinates; nothing if it failed.
    std::optional<Point<D>> one() { return at_numbers(model.draw(random)); }
    std::nullopt_t broken(const std::string& how) {
        if (wrong.empty()) wrong = how;
        return std::nullopt;
    }
    bool is_mirror(const Point<N>& x) const {
        return std::find(mirrors.begin(), mirrors.end(), x) != mirrors.end();
    }
    Point<N> jittered(const Point<N>& x) { return detail::jittered(x, model.unit, random); }

    // What the integral may be off by: 1e-6, or roundings of a pdf in float (3e-5); the pdf's
    // change at a jitter, which is 2 units on average, by twice that; and borders that are off by
    // 16 units.
    double allowed() const {
        return std::max(1e-6, 512 * model.pdf_unit) + 2 * rounding + 8 * jumps + grain +
               o.tolerance;
    }

    static std::string at(const Point<N>& x) {
        return std::string(Domain::place) + " " + say_point(x);
    }
    Range<D> range(size_t cell) const { return cells.range(cell, {domain.lower, domain.upper}); }
    Scene<N> scene() const { return scene_of<N>(domain, o, middle); }
};

// Of hints.h: why samples come where the pdf is 0 alone, and the first line of a refusal.
template <size_t M, size_t N, class Domain>
std::string symmetry_of(DensityCheck<M, N, Domain>& check);
template <size_t M, size_t N, class Domain>
std::string first_line_of(DensityCheck<M, N, Domain>& check);
// Of pictures.h.
template <size_t M, size_t N, class Domain>
std::string picture_of(DensityCheck<M, N, Domain>& check);

template <size_t M, size_t N, class Domain>
Verdict DensityCheck<M, N, Domain>::run() {
    find_mirrors();
    fly_pilot();
    for (size_t i = 0; i < (pilot.empty() ? 100 : pilot_size) && wrong.empty(); ++i) (void)one();
    if (wrong.empty() && pilot.empty())
        return failure("of " + say("%.0f", samples) +
                       " samples hardly any comes where the pdf is positive: " + first_none +
                       symmetry_of(*this));
    if (wrong.empty()) try_rims();
    if (wrong.empty()) wrong = other_pdf(random, model, scene(), o, jumps, mirrors);
    if (!wrong.empty()) return failure(wrong);
    samples = none = mirrored = 0;
    cells = Cells<D>(pilot);
    parts = integrate();
    // A difference of doubles may make a 0 negative: 10^4 roundings.
    if (wrong.empty() && most_negative < -1e-12 * median(heights))
        wrong = say("the pdf is negative, %.4g, at ", most_negative) + where_negative;
    if (!wrong.empty()) return failure(wrong);

    close = allowed() + 6 * parts.error;  // a normal number is beyond once in 5e8
    // Differences of floats err by 2e-3 (chosen), and by what rounding does to the pdf.
    if constexpr (M == D)
        sheets =
            sheets_of(model, random, std::max(model.single ? 2e-3 : 1e-6, 3 * (rounding + jumps)),
                      o.tolerance, false);
    // Where samples fail ten times as many are drawn at most.  Once it is refused, 100 000 are
    // enough: hints by counts ask for half of that.
    const uint64_t n = o.n ? o.n : uint64_t(samples_for(o) / std::max(0.1, arriving) + 1);
    const bool off_already = sheets.off || parts.total > 1 - o.discrete + close;
    for (uint64_t i = 0; i < (off_already ? std::min<uint64_t>(n, 100'000) : n); ++i)
        if (const auto c = one()) ++counts[cells.of(*c)];
    if (!wrong.empty()) return failure(wrong);

    // The failed samples are missing from the integral, as closely as it is known.  If none fails
    // where `fewest` should, that is chance with the probability e^-fewest.
    const double others = samples * (1 - o.discrete),
                 fewest = others - samples * (parts.total + close),
                 most = others - samples * (parts.total - close);
    double p_share = 0;
    if (none == 0)
        balanced = std::abs(parts.total - (1 - o.discrete)) <= close ||
                   (parts.total < 1 - o.discrete && fewest < -std::log(o.alpha / 4));
    else {
        p_share = 2 * std::min(p_at_least(none, samples, most / samples),
                               1 - p_at_least(none + 1, samples, fewest / samples));
        balanced = p_share > o.alpha / 2;
    }
    // Counts, the part that fails, and that of mirrors share alpha.
    expected = parts.shares();
    const double part = o.discrete > 0 ? 4 : none > 0 ? 2 : 1;
    Verdict v = judge_counts(counts, expected,
                             {.alpha = o.alpha / part, .tolerance = o.tolerance + moved()},
                             parts.variances());
    spend(o.alpha - o.alpha / part);
    if (o.discrete > 0 && (p_at_least(mirrored, samples, o.discrete) < o.alpha / 8 ||
                           1 - p_at_least(mirrored + 1, samples, o.discrete) < o.alpha / 8))
        return failure(percent(mirrored / samples) + " of the samples are mirrors', " +
                       percent(o.discrete) + " were announced (.discrete)");
    counted = v.pass;
    v.text += "; the pdf integrates to " + say("%.8g over the %s", parts.total, Domain::measure);
    if (parts.error > 0) v.text += say(" +- %.1e", parts.error);
    if (none > 0) v.text += "; " + percent(none / samples) + " of the samples fail";
    if (sheets.blind > 0) v.text += say("; Jacobian within %.1e", sheets.blind);
    v.delta_min = std::max(v.delta_min, close);  // where rounding rules
    v.pass = counted && balanced && !sheets.off;
    if (v.pass) return v;
    if (!balanced || sheets.off) v.p = sheets.off ? 0 : p_share;
    v.text = first_line_of(*this) + "\n" + v.text + picture_of(*this);
    return v;
}

template <size_t M, size_t N, class Domain>
auto DensityCheck<M, N, Domain>::at_numbers(const Point<M>& u, bool rim)
    -> std::optional<Point<D>> {
    const auto x = model.sample(u);
    ++samples;
    if (!x) {
        if (none++ == 0) first_none = "nothing at u = " + say_point(u);
        return std::nullopt;
    }
    const Point<N> w = *x;
    if (is_mirror(w)) return ++mirrored, std::nullopt;
    if (!std::all_of(w.begin(), w.end(), [](double k) { return std::isfinite(k); }))
        return broken("sample " + say_point(w) + " is not finite, u = " + say_point(u));
    const auto c = domain.coordinates(w);
    const double p = model.pdf(w);
    if (!(p > 0 && std::isfinite(p))) {
        if (p != 0 && !(rim && p > 0))
            return broken(
                say("the pdf is %s, %.4g, at the sample ", p < 0 ? "negative" : "not finite", p) +
                say_point(w));
        if (none++ == 0) first_none = "pdf 0 at " + at(w) + " at u = " + say_point(u);
        return std::nullopt;
    }
    if (rim) return c;
    if constexpr (requires { domain.width; }) return c;  // all of space
    if (const std::string why = stray(domain, w, c, model.unit, extent); !why.empty())
        return broken(why);
    return c;
}

// The pdf per dc.
template <size_t M, size_t N, class Domain>
double DensityCheck<M, N, Domain>::density_at(const Point<D>& c) {
    const Point<N> x = domain.at(c);
    const double p = claim ? claim(x) : model.pdf(x);
    if (wrong.empty() && !std::isfinite(p) && !claim)
        wrong = say("the pdf is %g, not finite, at ", p) + at(x);
    if (p < most_negative && !claim) most_negative = p, where_negative = at(x);
    const double measure = domain.weight(c);
    return measure > 0 ? p * measure : 0;
}

template <size_t M, size_t N, class Domain>
Verdict judge_density(Random& random, const Model<M, N>& model, const Domain& domain,
                      const Options& o) {
    static_assert(N == std::tuple_size_v<decltype(domain.at({}))>,
                  "the domain has other coordinates than the samples");
    DensityCheck<M, N, Domain> check{random, model, domain, o};
    return named(check.run(), o);
}
template <size_t M, size_t N>
Verdict judge_density(Random& random, const Model<M, N>& model, const Options& o) {
    return judge_density(random, model, usual_domain<N>(), o);
}

// Samples of sample(u, v, ...) have the density pdf(sample), which integrates to 1 over the domain
// less the part of samples that fail (nothing returned, or pdf 0): by quadrature; by the Jacobian,
// where the map is smooth, as far as samples may be sparser than the pdf of one sheet but not
// denser; by chi-squared.
template <class Sample, class Pdf, class Domain>
requires requires { Domain::dimensions; }
Verdict expect_density(Random& random, Sample sample, Pdf pdf, const Domain& domain,
                       const Options& o = {}) {
    return judge_density(random, detail::model(sample, pdf), domain, o);
}
template <class Sample, class Pdf>
Verdict expect_density(Random& random, Sample sample, Pdf pdf, const Options& o = {}) {
    return judge_density(random, detail::model(sample, pdf), o);
}

// ---- Arrays of samples and densities ------------------------------------------------------------

// n points of a domain (an odd number's next) at which calling code is to evaluate its density, for
// expect_samples: two in each of n / 2 equal parts, whose difference tells the error of a sum.
template <class Domain>
auto points_in(Random& random, const Domain& domain, size_t n);  // of numbers.h

// Samples and values of a pdf at points of the domain: a quarter of the samples makes cells, the
// others are counted there.
template <size_t N, class Domain>
struct ArrayCheck {
    Verdict run();

    static constexpr size_t D = Domain::dimensions;
    static constexpr bool directions = is_sphere<Domain>;
    const Domain& domain;
    const std::vector<Point<N>>&samples, &points;
    const std::vector<double>& pdf;
    double arriving;  // part of the samples that did not fail
    const Options& o;

    std::vector<Point<D>> pilot = {};  // samples that make the cells
    Cells<D> cells = {};
    std::vector<size_t> cell_of = {};  // of each point
    std::vector<double> part_of = {};  // of the pdf's integral, of each point
    std::vector<double> counts = std::vector<double>(cell_count), expected = {};

    // Of numbers.h.
    std::string wrong();  // what no right sampler or pdf does; else it fills the cells
    std::string without_samples() const;    // a side of a coordinate that has the pdf alone
    double fewest_points() const;           // that tell the pdf in a cell
    Parts parts(const auto& factor) const;  // the pdf times factor(x)
    Scene<N> scene() const;

    static std::string at(const Point<N>& x) {
        return std::string(Domain::place) + " " + say_point(x);
    }
    Range<D> range(size_t cell) const { return cells.range(cell, {domain.lower, domain.upper}); }
};

// Of hints.h and pictures.h.
template <size_t N, class Domain>
std::string first_line_of(const ArrayCheck<N, Domain>& check, const Parts& claimed, bool balanced,
                          bool counted);
template <size_t N, class Domain>
std::string picture_of(const ArrayCheck<N, Domain>& check);

template <size_t N, class Domain>
Verdict ArrayCheck<N, Domain>::run() {
    if (const std::string why = wrong(); !why.empty()) return failure(why);
    // Of fewer the variance is not known well enough: with 25 a right cos^30 was refused once
    // in 200 runs at alpha = 1e-6.
    const double fewest = fewest_points(), needed = fewest_in_cell;
    if (fewest < needed)
        return failure(
            say("%zu points are too few: %.0f tell the pdf in a cell of the samples, "
                "%.0f must; take %.0f",
                pdf.size(), fewest, needed,
                std::ceil(1.5 * needed / std::max(1.0, fewest)) * double(pdf.size())));
    const Parts claimed = parts([](const Point<N>&) { return 1; });
    if (!(claimed.total > 0)) return failure("the pdf is 0 at all points");
    spend(o.alpha / 2);  // for the integral
    const Options half{.alpha = o.alpha / 2, .tolerance = o.tolerance};
    // Of alpha 0.5 is spent on the counts, 0.4 on the integral, 0.1 on sides without samples.  The
    // part that fails is random, too; and where few pairs meet a jump or a pole, their differences
    // do not tell what one point may bring, four times the largest part.
    const double off = std::abs(claimed.total - arriving),
                 error = std::hypot(claimed.error, std::sqrt(arriving * (1 - arriving) /
                                                             std::max(1.0, double(o.n)))),
                 allowed = 512 * 0x1p-24 + o.tolerance * arriving +  // rounding of floats
                           4 * *std::max_element(part_of.begin(), part_of.end());
    const double p = p_of_z(std::max(0.0, off - allowed) / std::max(1e-300, error));
    const bool balanced = p > 0.4 * o.alpha;
    expected = claimed.shares();
    Verdict v = judge_counts(counts, expected, half, claimed.variances());
    double blind = 0;  // by so few points
    for (size_t i = 0; i < cell_count; ++i)
        blind += claimed.variances()[i] / std::max(1e-300, expected[i]) / double(cell_count);
    v.delta_min = std::hypot(v.delta_min, half.sees * std::sqrt(samples_for(half) * blind));
    const bool counted = v.pass;
    v.pass = counted && balanced && without_samples().empty();
    v.text += say("; the pdf integrates to %.5g +- %.1g", claimed.total, claimed.error);
    if (v.pass) return v;
    v.p = counted && balanced ? 0 : std::min(v.p, p);
    v.text = first_line_of(*this, claimed, balanced, counted) + "\n" + v.text + picture_of(*this);
    return v;
}

// Samples from elsewhere (a GPU, Python) have the density whose value at points[i] is pdfs[i], with
// points = points_in(random, domain, n), or independent ones that are uniform in its coordinates:
// chi-squared, the integral, and sides of a coordinate that have no sample.  o.n: the number of
// samples drawn, if some failed and are not in the array.
template <class Samples, class Points, class Pdfs, class Domain>
Verdict expect_samples(const Samples& samples, const Points& points, const Pdfs& pdfs,
                       const Domain& domain, const Options& o = {}) {
    using P = decltype(domain.at({}));
    const std::vector<double> heights = numbers_in(pdfs);
    const size_t n = std::size(samples);
    if (n < 20000 || heights.size() < 20000 || std::size(points) != heights.size())
        return failure(
            say("%zu samples, %zu points, %zu values of the pdf: take 20000 or more of each, and "
                "as many values as points",
                n, std::size(points), heights.size()),
            o);
    const double arriving = o.n ? double(n) / double(o.n) : 1;
    if (arriving > 1) return failure(say("%zu samples, of %.0f drawn (.n)", n, double(o.n)), o);
    std::vector<P> drawn, where;
    for (size_t i = 0; i < n; ++i) drawn.push_back(detail::point(samples[i]));
    for (size_t i = 0; i < heights.size(); ++i) where.push_back(detail::point(points[i]));
    ArrayCheck<std::tuple_size_v<P>, Domain> check{domain, drawn, where, heights, arriving, o};
    return named(check.run(), o);
}

// ---- BSDFs --------------------------------------------------------------------------------------

// The type of a function's first argument.
template <class R, class A, class... More>
std::decay_t<A> first_argument(const std::function<R(A, More...)>&);
template <class F>
using FirstArgument = decltype(detail::first_argument(std::function{std::declval<F>()}));

double brightness(const auto& channels) {
    double sum = 0;
    for (double x : channels) sum += x / double(channels.size());
    return sum;
}

// A direction by the cosine of its angle from z and by phi.
inline Triple about_z_axis(double z, double phi) {
    const double s = std::sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
}
inline std::string between(const Triple& wo, const Triple& wi) {
    return "wo = " + say_point(wo) + ", wi = " + say_point(wi);
}

// eval(wo, wi), and pairs of directions.
using Eval = std::function<double(const Triple&, const Triple&)>;
using Pairs = std::vector<std::pair<Triple, Triple>>;
std::string exchange_hint(const Eval& f, const Pairs& pairs, double close);  // of hints.h

// A BSDF with wo and wi exchanged, above the surface and through it, where a constant may scale it.
struct Exchange {
    std::string wrong = {};
    bool reflects = false, transmits = false;
    double scale = 1;
};
inline Exchange exchange(Random& random, const Eval& f, double close) {
    Exchange e;
    for (const bool through : {false, true}) {
        Pairs pairs;
        std::vector<double> ratios;  // f(wo, wi) / f(wi, wo)
        // What is wrong for 0.35 % of them is missed by all once in 1000.  Not the flattest.
        for (int i = 0; i < 2000; ++i) {
            Triple directions[2];
            for (Triple& w : directions) {
                const double phi = 2 * pi * random(), z = 0.05 + 0.95 * random();
                w = about_z_axis(z, phi);
            }
            auto& [a, b] = directions;
            if (through) b[2] = -b[2];
            const double there = f(a, b), back = f(b, a);
            for (double x : {there, back})
                if (!(x >= 0 && std::isfinite(x))) {
                    e.wrong = say("eval is %s, %.4g, for ", x < 0 ? "negative" : "not finite", x) +
                              between(a, b);
                    return e;
                }
            if (there == 0 && back == 0) continue;
            ratios.push_back(there / back);
            pairs.emplace_back(a, b);
        }
        if (pairs.empty()) continue;
        (through ? e.transmits : e.reflects) = true;
        if (through) e.scale = median(ratios);
        auto off = [&](size_t i) {
            const double r = ratios[i] / e.scale;
            return std::isfinite(r) ? 1 - std::min(r, 1 / r) : 1;
        };
        const size_t worst = worst_of(pairs.size(), off);
        if (off(worst) <= close) continue;
        e.wrong = std::string("eval is not reciprocal") + (through ? " through the surface" : "") +
                  ": f(wo, wi) and f(wi, wo) differ by " + percent(off(worst)) + ", for " +
                  between(pairs[worst].first, pairs[worst].second) + exchange_hint(f, pairs, close);
        return e;
    }
    if (!e.reflects && !e.transmits) e.wrong = "eval is 0 for all directions";
    return e;
}

struct Albedo {
    Triple wo;
    double mean, error;  // relative
    double p;            // that it is 1, or a thousandth more by rounding
};
std::string albedo_hint(const std::vector<Albedo>& all, double alpha);  // of hints.h

// What sample returns beside a direction, channel by channel: nothing where there is no such.
struct Brought {
    Triple wi;
    std::vector<double> f, weight, unnamed;
};
template <class Sample, size_t M>
std::optional<Brought> brought(Sample& sample, const Point<M>& u);  // of host.h

// One channel of it, and what it should be by eval.
struct Returned {
    Triple wi;
    double said, wanted, pdf;
    bool wrong;        // in this channel,
    bool off = false;  // or in another
};
std::string returned_hint(const std::vector<Returned>& all, const std::string& what,
                          const std::string& expected);  // of hints.h

// The value f that sample returns is eval's; a weight is f |cos| / pdf; a value without a name is
// one of the two, for each wo.  One value in a hundred may round otherwise, where lobes are narrow
// or end.
template <class Sample, class M, class EvalAt>
std::string judge_returned(Random& random, Sample& sample, const M& model, const EvalAt& eval_at,
                           const Options& o) {
    std::vector<Returned> f, weight, unnamed, unnamed_weight;
    for (int i = 0; i < compared_samples && o.discrete == 0; ++i) {
        const auto said = detail::brought(sample, model.draw(random));
        const double p = said ? model.pdf(said->wi) : 0;
        if (!(p > 0)) continue;
        const Triple& wi = said->wi;
        const auto light = eval_at(wi);
        double close = roundings * std::max(model.unit, model.pdf_unit);
        for (int k = 0; k < neighbours; ++k) {
            const Triple near = jittered<3>(wi, model.unit, random);
            close = std::max({close, std::abs(brightness(eval_at(near)) / brightness(light) - 1),
                              std::abs(model.pdf(near) / p - 1)});
        }
        const double tolerance = agreement(close, model.single, o);
        auto compare = [&](std::vector<Returned>& all, const std::vector<double>& values,
                           double times) {
            const auto first = long(all.size());
            auto add = [&](double value, double wanted) {
                if (value == 0 && wanted == 0) return;
                const bool wrong = value != wanted && !(std::abs(value / wanted - 1) <= tolerance);
                all.push_back({wi, value, wanted, p, wrong});
            };
            if (values.size() == light.size())
                for (size_t k = 0; k < values.size(); ++k) add(values[k], light[k] * times);
            else if (!values.empty())
                add(brightness(values), brightness(light) * times);
            const bool off =
                std::any_of(all.begin() + first, all.end(), [](auto& r) { return r.wrong; });
            std::for_each(all.begin() + first, all.end(), [=](auto& r) { r.off = off; });
        };
        const double cosine = std::abs(wi[2]) / p;
        compare(f, said->f, 1);
        compare(weight, said->weight, cosine);
        compare(unnamed, said->unnamed, 1);
        compare(unnamed_weight, said->unnamed, cosine);
    }
    const std::string by_f = "eval's value", by_weight = by_f + " |cos| / pdf";
    for (const std::string& off :
         {returned_hint(f, "f", by_f), returned_hint(weight, "weight", by_weight)})
        if (!off.empty()) return off;
    const std::string off = returned_hint(unnamed, "value", by_f),
                      also = returned_hint(unnamed_weight, "value", by_weight);
    // Of two explanations, the one by a constant.
    auto plain = [](const std::string& hint) { return hint.find("|cos|") > hint.find(" times "); };
    return off.empty() || also.empty() ? "" : plain(also) && !plain(off) ? also : off;
}

// A BSDF in the frame where z is the normal, for four directions wo, the last of them grazing, and
// if it transmits for these from below, too: samples sample(wo, u, v, ...) have the density
// pdf(wo, wi); eval(wo, wi), without the cosine, is finite, not negative, reciprocal, and 0 where
// the pdf is; no more leaves than comes.  What is transmitted may be scaled by a constant, eta^2,
// in one direction.
template <class Sample, class Pdf, class EvalOf>
Verdict expect_bsdf(Random& random, Sample sample, Pdf pdf, EvalOf eval, const Options& o = {}) {
    using V = FirstArgument<Pdf>;  // a direction
    using T = Coordinate<V>;
    auto f = [&](const Triple& a, const Triple& b) {
        return brightness(detail::point(eval(of_host<V>(a), of_host<V>(b))));
    };
    // Half vectors of exchanged directions are rounded, or what eval computes of them: in float up
    // to 2 % (chosen).
    using Colour = decltype(eval(of_host<V>(Triple{}), of_host<V>(Triple{})));
    constexpr bool single = std::is_same_v<T, float> || std::is_same_v<Coordinate<Colour>, float>;
    const Exchange e = exchange(random, f, single ? 0.02 : 1e-6);
    if (!e.wrong.empty()) return failure(e.wrong, o);

    // Half of alpha for the densities, half for the albedos.
    const double share = o.alpha / (e.transmits ? 16 : 8);
    Verdict all{true, 1, 0, ""};
    std::string unsure;
    // eval may be for importance or for radiance, which transmission scales by eta^2: albedos of
    // both, as it is not known which of the two it is.
    std::array<std::vector<Albedo>, 2> albedos;
    for (double side : {1.0, -1.0})
        for (const auto& [z, phi] : {std::pair{0.95, 1.0}, {0.6, 3.0}, {0.2, 5.0}, {0.02, 2.0}}) {
            if (side < 0 && !e.transmits) break;
            const Triple out = about_z_axis(side * z, phi);
            const V wo = of_host<V>(out);
            auto half = [out](const Triple& w) {
                return normalized({w[0] + out[0], w[1] + out[1], w[2] + out[2]});
            };
            Options here = o;
            here.alpha = share;
            here.name += (o.name.empty() ? "" : " ") + ("wo = " + say_point(out));
            here.factors.emplace_back("4 wo.h",
                                      [=](const Triple& w) { return 4 * dot(out, half(w)); });
            here.factors.emplace_back("n.h", [=](const Triple& w) { return half(w)[2]; });
            auto from_wo = [&](auto... u) requires requires { sample(wo, T(u)...); }
            { return sample(wo, T(u)...); };
            auto pdf_of = [&](const V& wi) { return pdf(wo, wi); };
            const auto erased = model(from_wo, pdf_of);
            const Verdict v = judge_density(random, erased, here);
            if (!v.pass) return v;
            all.p = std::min(all.p, v.p);
            all.delta_min = std::max(all.delta_min, v.delta_min);
            auto eval_at = [&](const Triple& wi) {
                return detail::point(eval(wo, of_host<V>(wi)));
            };
            const std::string off = judge_returned(random, from_wo, erased, eval_at, o);
            if (!off.empty()) return failure(off, here);
            // If weights vary as much as they are large, so many see 2.5 % too much.
            Draws albedo, scaled;
            std::array<double, 2> come{}, lit{};  // samples that reflect, and that transmit
            while (albedo.n() < std::max(1.1e5, double(o.n))) {
                const auto wi = erased.sample(erased.draw(random));
                const double p = wi ? erased.pdf(*wi) : 0,
                             weight = p > 0 ? f(out, *wi) * std::abs((*wi)[2]) / p : 0;
                if (!std::isfinite(weight))
                    return failure("eval cos / pdf is not finite for " + between(out, *wi), o);
                albedo.add(weight);
                const bool through = p > 0 && (*wi)[2] * side < 0;
                scaled.add(weight * (through ? std::pow(e.scale, -side) : 1));
                come[through] += p > 0, lit[through] += weight > 0;
            }
            // Skewness raises no false alarm: rare large weights make t too small, and rare small
            // ones, which are not below 0, the mean too large by less than the thousandth that is
            // forgiven.  But lights that hardly any sample meets are not seen.
            if (const std::string why = albedo.problem();
                unsure.empty() && !why.empty() && albedo.skewness() > 0)
                unsure = "; the albedo for wo = " + say_point(out) + " is not sure: " + why;
            // No mistake for sure: the tail of a lobe crosses the surface, too.
            for (size_t through = 0; through < 2; ++through)
                if (z > 0.9 && lit[through] == 0 && come[through] > 0.1 * albedo.n())
                    unsure += "; eval is 0 for all samples that " +
                              std::string(through ? "cross the surface" : "are reflected") + ", " +
                              percent(come[through] / albedo.n()) + " of them: is " +
                              (through ? "transmission" : "reflection") + " forgotten?";
            // Light that eval sends where no sample comes: one in a hundred directions, and one
            // part in a hundred.
            double lost = 0, often = 0;
            Triple where{};
            const int directions = 4000;
            for (int i = 0; i < directions; ++i) {
                const double phi = 2 * pi * random(), height = 2 * random() - 1;
                const Triple wi = about_z_axis(height, phi);
                const double light = f(out, wi) * std::abs(height) * 4 * pi / directions;
                if (!(light > 0) || erased.pdf(wi) > 0) continue;
                lost += light, ++often, where = wi;
            }
            if (often > 0.01 * directions && lost > 0.01 * albedo.mean())
                return failure("eval is positive where the pdf is 0 and no sample comes, for " +
                                   between(out, where) +
                                   (where[2] * side < 0 ? ": looks like eval without a test of "
                                                          "the side of wi"
                                                        : ""),
                               o);
            for (const bool radiance : {false, true}) {
                const Estimate mean = (radiance ? scaled : albedo).estimate();
                const double error = std::max(1e-300, mean.standard_error),
                             t = (mean.mean - 1 - 1e-3) / error;
                albedos[radiance].push_back({out, mean.mean, error / std::max(1e-300, mean.mean),
                                             t > 0 ? p_of_t(t, mean.df) / 2 : 1});
            }
        }
    spend(o.alpha / 2);
    statistical_checks += int(albedos[0].size());
    const std::string why = albedo_hint(albedos[1], share);
    if (!why.empty() && !albedo_hint(albedos[0], share).empty()) return failure(why, o);
    std::array<double, 2> p{1, 1};
    for (size_t radiance = 0; radiance < 2; ++radiance)
        for (const Albedo& a : albedos[radiance]) p[radiance] = std::min(p[radiance], a.p);
    all.p = std::min(1.0, std::min(all.p, std::max(p[0], p[1])) * o.alpha / share);
    all.text = std::string("density, albedo <= 1 and reciprocity as expected, above the surface") +
               (e.transmits ? say(", below and through it (scaled by %.4g)", e.scale) : "") +
               unsure;
    return named(all, o);
}

// ---- Images -------------------------------------------------------------------------------------

// The distance of an image from a reference.
struct ImageResult {
    double p = 1, mean = 0, mean_p = 1, z = 0;
    size_t worst = 0, block = 0;
    bool by_block = false;  // a block is further off than any pixel
};
struct Image {
    size_t width, height;
    std::vector<double> f, s, truth;  // values, their standard errors, the reference
    const Options& o;
    size_t n() const { return width * height; }
    size_t block_of(size_t i) const {
        return (i / width) * 4 / height * 4 + (i % width) * 4 / width;
    }

    // The image divided by c against these values.  A part of 1e-6, 16 roundings of a float, is
    // none.
    ImageResult against(const std::vector<double>& g, double c = 1) const {
        struct Sum {
            double off = 0, variance = 0;
            double z() const {
                return off == 0 ? 0 : variance > 0 ? off / std::sqrt(variance) : infinity;
            }
        };
        Sum whole;
        std::array<Sum, 16> blocks;
        ImageResult r;
        double most = 0;
        for (size_t i = 0; i < n(); ++i) {
            const double off = f[i] / c - g[i], error = s[i] / c;
            Sum one{std::abs(off) <= 1e-6 * std::abs(g[i]) ? 0 : off, error * error};
            for (Sum* sum : {&whole, &blocks[block_of(i)]})
                sum->off += one.off, sum->variance += one.variance;
            if (const double z = std::abs(one.z()); z > most) most = z, r.worst = i;
        }
        double block = 0;
        for (size_t b = 0; b < 16; ++b)
            if (std::abs(blocks[b].z()) > block) block = std::abs(blocks[b].z()), r.block = b;
        auto sidak = [](double p, double m) {
            return -std::expm1(m * std::log1p(-std::min(p, 1 - 1e-16)));
        };
        const double of_pixel = o.n > 1 ? p_of_t(most, double(o.n) - 1) : p_of_z(most);
        r.by_block = sidak(p_of_z(block), 16) < sidak(of_pixel, double(n())) || block > 2 * most;
        r.mean = whole.off / double(n());
        r.mean_p = p_of_z(whole.z());
        r.z = most;
        r.p = std::min(
            1.0, 3 * std::min({r.mean_p, sidak(p_of_z(block), 16), sidak(of_pixel, double(n()))}));
        return r;
    }
    std::string hint(const ImageResult& r) const;
    std::string all_others_right() const;
    std::string picture() const;

    Verdict judge() const {
        auto pixel = [&](size_t i) { return say("pixel (%zu, %zu)", i % width, i / width); };
        for (size_t i = 0; i < n(); ++i) {
            if (!std::isfinite(f[i])) return failure(pixel(i) + say(" is %g, not finite", f[i]));
            if (!(s[i] >= 0 && std::isfinite(s[i])))
                return failure(pixel(i) + say(" has the standard error %g", s[i]));
        }
        const ImageResult r = against(truth);
        double variance = 0;
        for (double error : s) variance += error * error;
        const double sum = std::abs(sum_of(truth)),
                     seen = smallest_shift(infinity, o.alpha / 3) * std::sqrt(variance);
        Verdict v = verdict_of(r.p, seen / (sum > 0 ? sum : 1), o);
        v.text = say("%zux%zu pixels, mean off by %.3g (%s), largest %.2f sigma at ", width, height,
                     r.mean, say_p(r.mean_p).c_str(), r.z) +
                 pixel(r.worst) + ", " + say_p(r.p) +
                 "; smallest bias of all seen with 99.9 % power: " + percent(v.delta_min);
        if (!v.pass) v.text = hint(r) + "\n" + v.text + picture();
        return v;
    }
};

inline Verdict judge_image(size_t width, size_t height, const std::vector<double>& values,
                           const std::vector<double>& errors, const std::vector<double>& reference,
                           const Options& o) {
    const std::pair<const char*, const std::vector<double>&> arrays[] = {
        {"values", values}, {"errors", errors}, {"reference values", reference}};
    const size_t n = width * height, channels = n > 0 ? values.size() / n : 0;
    if (n == 0) return failure("no pixel", o);
    for (const auto& [name, array] : arrays) {
        const std::string has = say("%zu %s", array.size(), name);
        if (array.size() != n && array.size() != 3 * n)
            return failure(has + say(" for %zux%zu pixels, expected %zu or %zu (RGB)", width,
                                     height, n, 3 * n),
                           o);
        if (array.size() != values.size())
            return failure(has + say(", but %zu values", values.size()), o);
    }
    auto channel = [&](size_t c, const std::string& name) {
        Options of_channel = o;
        of_channel.alpha /= double(channels);
        if (!o.name.empty()) of_channel.name += name;
        Image image{width, height, {}, {}, {}, of_channel};
        for (size_t i = c; i < n * channels; i += channels) {
            image.f.push_back(values[i]);
            image.s.push_back(errors[i]);
            image.truth.push_back(reference[i]);
        }
        return image.judge();
    };
    if (channels == 1) return named(channel(0, ""), o);
    Verdict worst;
    std::string wrong, of_worst;
    double delta_min = 0;
    for (size_t c = 0; c < 3; ++c) {
        const std::string name = std::array{"red", "green", "blue"}[c];
        const Verdict v = channel(c, " " + name);
        if (!v.pass) wrong += (wrong.empty() ? "" : ", ") + name;
        delta_min = std::max(delta_min, v.delta_min);
        if (c == 0 || v.p < worst.p) worst = v, of_worst = name + ", worst of RGB";
    }
    worst.p = std::min(1.0, 3 * worst.p), worst.delta_min = delta_min;
    return named(worst.of(wrong.empty() ? of_worst : wrong), o);
}

// An image with the standard errors of its values against a reference: all pixels together, 16
// blocks, and each pixel; the largest of each by Sidak's correction (1967).  Pixels are taken as
// normal, means of 256 samples or more; options.n says how many, for Student's t.  Values, errors
// and reference are arrays of known size, row by row from the top: one number per pixel, or three,
// red, green and blue.  The noise of channels may be correlated: each is judged by itself, at a
// third of alpha.
template <class Values, class Errors, class Reference>
Verdict expect_image(size_t width, size_t height, const Values& values, const Errors& errors,
                     const Reference& reference, const Options& o = {}) {
    return judge_image(width, height, numbers_in(values), numbers_in(errors), numbers_in(reference),
                       o);
}

}  // namespace oracle::detail

// The interface, all of it: what else is in oracle::detail may change.
namespace oracle {

using detail::expect_bias_decay, detail::expect_counts, detail::expect_choice;
using detail::expect_bsdf, detail::expect_image, detail::draw, detail::judge;
using detail::expect_density, detail::expect_jacobian, detail::expect_samples;
using detail::expect_mean, detail::expect_equal, detail::expect_replicates;
using detail::pictures, detail::statistical_checks, detail::alpha_spent;
using detail::Random, detail::seed_of, detail::Point, detail::Triple, detail::pi, detail::infinity;
using detail::say, detail::p_of_z, detail::p_of_t, detail::p_at_least;
using detail::Sphere, detail::Line, detail::Plane, detail::Interval, detail::Square, detail::Box;
using detail::Triangle, detail::points_in;
using detail::Verdict, detail::Options, detail::Factor, detail::Estimate, detail::Draws;

}  // namespace oracle

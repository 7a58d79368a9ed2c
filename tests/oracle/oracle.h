// oracle/oracle.h  the oracle in one file to copy: make writes it, from checks.h numbers.h host.h hints.h pictures.h
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
// oracle/numbers.h  appendix: tails of distributions, integrals, domains and their cells,
// derivatives of maps

namespace oracle::detail {

// ---- Tails of distributions ---------------------------------------------------------------------

// Two-sided p-value of a standard normal z.
inline double p_of_z(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

// Regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0: series below a + 1, continued
// fraction (Lentz) above (Abramowitz, Stegun 6.5.29, 6.5.31), which takes some 0.7 sqrt(a) terms.
inline double gamma_q(double a, double x) {
    if (x <= 0) return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double k = a + 1; term > sum * 1e-17; ++k) sum += term *= x / k;
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;
    for (int i = 1; i < 10000; ++i) {
        const double numerator = -i * (i - a);
        b += 2;
        d = 1 / (numerator * d + b);
        c = b + numerator / c;
        fraction *= c * d;
        if (std::abs(c * d - 1) < 1e-15) break;
    }
    return front * fraction;
}

// Chi-squared; if noncentral, with k + 2 j degrees, j Poisson variables, by Q(a + 1, x) = Q(a, x) +
// x^a e^-x / Gamma(a + 1).
inline double p_of_chi2(double chi2, double k, double noncentrality) {
    if (!(noncentrality > 0)) return gamma_q(k / 2, chi2 / 2);
    if (!(noncentrality - chi2 < 20 * std::sqrt(k + noncentrality))) return 1;  // within 1e-20
    auto poisson = [](double j, double mean) {
        return std::exp(-mean + j * std::log(mean) - std::lgamma(j + 1));
    };
    const double mean = noncentrality / 2, width = 10 * std::sqrt(mean) + 20,
                 x = chi2 / 2;  // all but 1e-20
    double j = std::max(0.0, std::floor(mean - width)), a = k / 2 + j;
    double q = gamma_q(a, x), step = poisson(a, x), weight = poisson(j, mean), sum = 0;
    for (; j < mean + width; ++j) {
        sum += weight * q;
        q += step;
        step *= x / ++a;
        weight *= mean / (j + 1);
    }
    return std::min(1.0, sum);
}

// Regularised incomplete beta function I_x(a, b) by continued fraction (Abramowitz, Stegun 26.5.8).
inline double beta_i(double a, double b, double x) {
    if (x <= 0 || x >= 1) return x <= 0 ? 0 : 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - beta_i(b, a, 1 - x);
    const double front = std::exp(a * std::log(x) + b * std::log1p(-x) + std::lgamma(a + b) -
                                  std::lgamma(a) - std::lgamma(b)) /
                         a;
    double c = 1, d = 1 / (1 - (a + b) * x / (a + 1)), fraction = d;
    for (int m = 1; m < 10000; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / (1 + even * d);
        c = 1 + even / c;
        fraction *= c * d;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / (1 + odd * d);
        c = 1 + odd / c;
        fraction *= c * d;
        if (std::abs(c * d - 1) < 1e-15) break;
    }
    return front * fraction;
}

// Normal from 10^7 degrees of freedom on, where p differs by t^4 / 4k = 2e-5 of itself at t = 5.
inline double p_of_t(double t, double k) {
    return k < 1e7 ? beta_i(k / 2, 0.5, k / (k + t * t)) : p_of_z(t);
}

inline double p_at_least(double k, double mean) {
    return k <= 0 ? 1 : mean <= 0 ? 0 : 1 - gamma_q(k, mean);
}
inline double p_at_least(double k, double n, double p) {
    return k <= 0 ? 1 : k > n ? 0 : beta_i(k, n - k + 1, p);
}

// Index xi of the tail, P(|x - mean| > t) ~ t^(-1/xi), from the k farthest numbers (Hill 1975);
// its standard error is xi / sqrt(k).  Variance is infinite from 1/2 on.
inline double Draws::tail_index(size_t k) const {
    const double m = mean();
    std::vector<double> far;
    for (double x : values) far.push_back(std::abs(x - m));
    std::nth_element(far.begin(), far.begin() + long(k), far.end(), std::greater<>());
    double sum = 0;
    for (size_t i = 0; i < k; ++i) sum += std::log(far[i] / far[k]);
    return far[k] > 0 ? sum / double(k) : 0;
}

// The tail is that of an infinite variance, as far as k numbers can tell: xi > 0.4, which is 1/2
// less four standard errors of 400 numbers, and still within 5 of 1/2 among the farthest of
// them.  Bounded outliers are not.  The tail is the farthest hundredth.
inline bool Draws::heavy() const {
    if (values.size() < 100 * tail || tail_index(tail) <= 0.4) return false;
    for (size_t k : {tail / 4, tail / 16})
        if (tail_index(k) * (1 + 5 / std::sqrt(double(k))) <= 0.5) return false;
    return true;
}

inline ChoiceFit fit_choices(const std::vector<double>& probabilities,
                             const std::vector<double>& seen, double none, double tolerance) {
    ChoiceFit fit;
    const double n = none + sum_of(seen);
    double rare = 0, rare_seen = 0;
    auto cell = [&](double mean, double number) {
        ++fit.cells;
        fit.chi2 += (number - mean) * (number - mean) / mean;
    };
    double failing = n;
    for (size_t i = 0; i < seen.size(); ++i) {
        const double mean = probabilities[i] * n;
        failing -= mean;
        if (mean == 0 && seen[i] > 0) fit.p = 0;
        if (mean >= fewest_in_cell)
            cell(mean, seen[i]);
        else
            rare += mean, rare_seen += seen[i];
    }
    // Less than a part of 1e-6 is rounding of the probabilities' sum.
    if (none > 0 || failing > 1e-6 * n) rare += std::max(0.0, failing), rare_seen += none;
    double chance = 1;
    if (rare >= fewest_in_cell)
        cell(rare, rare_seen);
    else if (rare_seen > 0)
        chance = 2 * p_at_least(rare_seen, rare * (1 + tolerance));
    if (fit.cells > 1)
        fit.p *= (rare > 0 && rare < fewest_in_cell ? 2 : 1) *
                 p_of_chi2(fit.chi2, fit.cells - 1, forgiven(n, tolerance));
    fit.p = std::min({1.0, fit.p, chance});
    return fit;
}

// ---- Quadrature ---------------------------------------------------------------------------------

// Gauss and Kronrod's rules of 7 and 15 points over [a,b].
struct Rule {
    double kronrod = 0, gauss = 0;
    double ends = 0;  // what a jump beyond the outermost nodes, which neither rule sees, may bring
};
template <class F>
Rule rule(const F& f, double a, double b) {
    static constexpr struct {
        double x, kronrod, gauss;
    } nodes[] = {
        {0.991455371120812639206854697526329, 0.022935322010529224963732008058970, 0},
        {0.949107912342758524526189684047851, 0.063092092629978553290700663189204,
         0.129484966168869693270611432679082},
        {0.864864423359769072789712788640926, 0.104790010322250183839876322541518, 0},
        {0.741531185599394439863864773280788, 0.140653259715525918745189590510238,
         0.279705391489276667901467771423780},
        {0.586087235467691130294144691693013, 0.169004726639267902826583426598550, 0},
        {0.405845151377397166906606412076961, 0.190350578064785409913256402421014,
         0.381830050505118944950369775488975},
        {0.207784955007898467600689403773245, 0.204432940075298892414161999234649, 0},
    };
    const double middle = (a + b) / 2, half = (b - a) / 2, centre = f(middle);
    double low = centre, high = centre;
    Rule r{0.209482141084727828012999174891714 * centre,
           0.417959183673469387755102040816327 * centre};
    for (const auto& node : nodes) {
        const double left = f(middle - half * node.x), right = f(middle + half * node.x);
        r.kronrod += node.kronrod * (left + right);
        r.gauss += node.gauss * (left + right);
        if (&node == nodes) low = left, high = right;
    }
    // At the end itself a density may be infinite; steps of less than a quarter the rules tell.
    const double near = 1e-9 * half;
    for (const auto& [end, inside] : {std::pair{f(a + near), low}, std::pair{f(b - near), high}})
        if (const double step = std::abs(end - inside);
            step > 0.25 * std::max(std::abs(end), std::abs(inside)))
            r.ends = std::max(r.ends, step * half * (1 - nodes[0].x));
    r.kronrod *= half;
    r.gauss *= half;
    return r;
}

// Parts of an integral must agree within `tolerance`, the same for each part (a jump then costs
// log2(jump / tolerance) halvings, and few parts come close), or within `noise`, the relative
// rounding of f.  Two rules agree by chance where a kink lies just so: `halves` must, too.
struct Agreement {
    double tolerance = 0, noise = 0x1p-50;
    int depth = 30;           // halvings
    bool halves = true;       // of the outermost integral,
    bool all_halves = false;  // and of those within it
    double* left = nullptr;   // what the deepest parts still disagree by is added to it
};

// Integral of f over [a,b], halved until it agrees; once `enough()`, only as well as it is known.
template <class F, class Enough>
double halved(const F& f, double a, double b, const Agreement& g, const Enough& enough,
              const Rule& whole, int depth) {
    const double rules = std::max(std::abs(whole.kronrod - whole.gauss), whole.ends);
    const double agree = std::max(g.tolerance, g.noise * std::abs(whole.kronrod));
    // Beside a singularity neither rule sees what is left of it.
    if (depth == 0 && g.left) *g.left += std::max(rules, std::abs(whole.kronrod));
    if (depth == 0 || enough() || (!g.halves && rules <= agree)) return whole.kronrod;
    const double middle = (a + b) / 2;
    const Rule left = rule(f, a, middle), right = rule(f, middle, b);
    const double sum = left.kronrod + right.kronrod;
    if (std::max(rules, std::abs(whole.kronrod - sum)) <= agree) return sum;
    return halved(f, a, middle, g, enough, left, depth - 1) +
           halved(f, middle, b, g, enough, right, depth - 1);
}

// Integral of f over [a,b], where f may jump.
template <class F, class Enough = bool (*)()>
double integral(
    const F& f, double a, double b, const Agreement& g,
    const Enough& enough = [] { return false; }) {
    return halved(f, a, b, g, enough, rule(f, a, b), g.depth);
}

// ---- Domains ------------------------------------------------------------------------------------

inline double dot(const Triple& a, const Triple& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Triple normalized(const Triple& a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

// Each has coordinates c between lower and upper, at(c) in it, coordinates(x) back, and weight(c),
// the measure of dc.  Before, fit(points) sees where samples lie.

// Directions, per solid angle: (theta, phi) about an axis.
struct Sphere {
    static constexpr size_t dimensions = 2;
    static constexpr const char *measure = "solid angle", *place = "direction";
    Triple x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    Point<2> lower{0, 0}, upper{pi, 2 * pi};

    void fit(const std::vector<Triple>& points, const Triple& axis) {
        Triple sum = axis;
        if (dot(axis, axis) == 0)
            for (const Triple& p : points)
                for (size_t k = 0; k < 3; ++k) sum[k] += p[k] / double(points.size());
        const double length = std::sqrt(dot(sum, sum));
        // The mean of 4096 uniform directions is longer once in a million.
        if (!(length > 0.05)) return;
        // A hemisphere's axis, where samples follow one but for noise, of 2.6 degrees: jumps at its
        // horizon then lie along coordinates.
        for (size_t k = 0; k < 3; ++k) z[k] = sum[k] / length;
        for (size_t k = 0; k < 3; ++k)
            if (std::abs(z[k]) > 1 - 1e-3 && dot(axis, axis) == 0) {
                const double sign = z[k];
                z = {0, 0, 0};
                z[k] = sign > 0 ? 1 : -1;
            }
        // Duff et al. 2017; in double, whatever the renderer's precision.
        const double sign = std::copysign(1.0, z[2]), a = -1 / (sign + z[2]), b = z[0] * z[1] * a;
        x = {1 + sign * z[0] * z[0] * a, sign * b, -sign * z[0]};
        y = {b, sign + z[1] * z[1] * a, -z[1]};
    }
    Point<2> coordinates(const Triple& w) const {
        const double phi = std::atan2(dot(w, y), dot(w, x));
        return {std::atan2(std::hypot(dot(w, x), dot(w, y)), dot(w, z)),
                phi < 0 ? phi + 2 * pi : phi};
    }
    Triple at(const Point<2>& c) const {
        const double s = std::sin(c[0]), a = s * std::cos(c[1]), b = s * std::sin(c[1]);
        const double h = std::cos(c[0]);
        return {a * x[0] + b * y[0] + h * z[0], a * x[1] + b * y[1] + h * z[1],
                a * x[2] + b * y[2] + h * z[2]};
    }
    double weight(const Point<2>& c) const { return std::sin(c[0]); }
};

// A box of D dimensions, per length, area, volume.
template <size_t D>
struct Box {
    static constexpr size_t dimensions = D;
    static constexpr const char *measure = D == 1   ? "length"
                                           : D == 2 ? "area"
                                                    : "volume",
                                *place = "point";
    Point<D> lower{}, upper{};

    void fit(const std::vector<Point<D>>&, const Triple&) {}
    Point<D> coordinates(const Point<D>& x) const { return x; }
    Point<D> at(const Point<D>& c) const { return c; }
    double weight(const Point<D>&) const { return 1; }
};
struct Interval : Box<1> {
    Interval(double a, double b) : Box<1>{{a}, {b}} {}
};
struct Square : Box<2> {
    Square() : Box<2>{{0, 0}, {1, 1}} {}
};

// All of space in D dimensions: x = median + width tan(pi (c - 1/2)) along each.  Nothing lies
// outside.
template <size_t D>
struct Space {
    static constexpr size_t dimensions = D;
    static constexpr const char *measure = Box<D>::measure, *place = "point";
    Point<D> lower, upper, median{}, width;
    Space() {
        lower.fill(0x1p-40);  // 3.5e11 widths away
        upper.fill(1 - 0x1p-40);
        width.fill(1);
    }

    void fit(const std::vector<Point<D>>& points, const Triple&) {
        for (size_t k = 0; k < D; ++k) {
            std::vector<double> x;
            for (const Point<D>& p : points) x.push_back(p[k]);
            std::sort(x.begin(), x.end());
            median[k] = x[x.size() / 2];
            const double quartiles = x[x.size() * 3 / 4] - x[x.size() / 4];
            if (quartiles > 0) width[k] = quartiles / 2;
        }
    }
    Point<D> coordinates(const Point<D>& x) const {
        Point<D> c;
        for (size_t k = 0; k < D; ++k)
            c[k] =
                std::clamp(0.5 + std::atan((x[k] - median[k]) / width[k]) / pi, lower[k], upper[k]);
        return c;
    }
    Point<D> at(const Point<D>& c) const {
        Point<D> x;
        for (size_t k = 0; k < D; ++k) x[k] = median[k] + width[k] * std::tan(pi * (c[k] - 0.5));
        return x;
    }
    double weight(const Point<D>& c) const {
        double product = 1;
        for (size_t k = 0; k < D; ++k) {
            const double t = std::tan(pi * (c[k] - 0.5));
            product *= width[k] * pi * (1 + t * t);
        }
        return product;
    }
};

// A triangle of the plane or of space, per area: x = a + s (b - a) + s t (c - b).
template <size_t N>
struct Triangle {
    static constexpr size_t dimensions = 2;
    static constexpr const char *measure = "area", *place = "point";
    Point<N> a, b, c;
    Point<2> lower{0, 0}, upper{1, 1};
    Triangle(const Point<N>& a_, const Point<N>& b_, const Point<N>& c_) : a(a_), b(b_), c(c_) {}

    void fit(const std::vector<Point<N>>&, const Triple&) {}
    // Barycentric coordinates of b and c by least squares; the distance from the plane is checked
    // where a sample is drawn.
    Point<2> coordinates(const Point<N>& x) const {
        double ee = 0, ef = 0, ff = 0, ex = 0, fx = 0;
        for (size_t k = 0; k < N; ++k) {
            const double e = b[k] - a[k], f = c[k] - a[k], d = x[k] - a[k];
            ee += e * e, ef += e * f, ff += f * f, ex += e * d, fx += f * d;
        }
        const double det = ee * ff - ef * ef;
        const double beta = (ex * ff - fx * ef) / det, gamma = (fx * ee - ex * ef) / det;
        const double s = beta + gamma;
        return {s, s > 0 ? gamma / s : 0};
    }
    Point<N> at(const Point<2>& st) const {
        Point<N> x;
        for (size_t k = 0; k < N; ++k)
            x[k] = a[k] + st[0] * (b[k] - a[k]) + st[0] * st[1] * (c[k] - b[k]);
        return x;
    }
    double weight(const Point<2>& st) const {
        double ee = 0, ef = 0, ff = 0;
        for (size_t k = 0; k < N; ++k) {
            const double e = b[k] - a[k], f = c[k] - a[k];
            ee += e * e, ef += e * f, ff += f * f;
        }
        return st[0] * std::sqrt(ee * ff - ef * ef);
    }
};
template <size_t N>
Triangle(Point<N>, Point<N>, Point<N>) -> Triangle<N>;

template <size_t N>
auto usual_domain() {
    if constexpr (N == 3)
        return Sphere{};
    else
        return Space<N>{};
}

// ---- Cells and integrals over them --------------------------------------------------------------

template <size_t D>
struct Range {
    Point<D> lower, upper;
    Point<D> middle() const {
        Point<D> c;
        for (size_t k = 0; k < D; ++k) c[k] = (lower[k] + upper[k]) / 2;
        return c;
    }
};

// 32 cells that a few points fill alike: halved at medians, along each dimension in turn.
template <size_t D>
struct Cells {
    static constexpr size_t levels = 5, count = size_t(1) << levels;
    static_assert(count == cell_count);
    std::array<double, count> split{};  // of node k into 2k and 2k + 1

    Cells() = default;
    explicit Cells(std::vector<Point<D>> points) { halve(1, 0, points, 0, points.size()); }
    void halve(size_t node, size_t level, std::vector<Point<D>>& points, size_t begin, size_t end) {
        if (level == levels) return;
        const size_t k = level % D, middle = (begin + end) / 2;
        std::nth_element(points.begin() + long(begin), points.begin() + long(middle),
                         points.begin() + long(end),
                         [k](const auto& a, const auto& b) { return a[k] < b[k]; });
        split[node] = points[middle][k];
        halve(2 * node, level + 1, points, begin, middle);
        halve(2 * node + 1, level + 1, points, middle, end);
    }
    size_t of(const Point<D>& c) const {
        size_t node = 1;
        for (size_t level = 0; level < levels; ++level)
            node = 2 * node + (c[level % D] >= split[node]);
        return node - count;
    }
    Range<D> range(size_t cell, Range<D> all) const {
        for (size_t level = 0; level < levels; ++level) {
            const size_t node = (cell + count) >> (levels - level);
            const bool above = (cell + count) >> (levels - level - 1) & 1;
            (above ? all.lower : all.upper)[level % D] = split[node];
        }
        return all;
    }
};

// Integral of f over a range: by nested rules while `enough` allows.
template <size_t K = 0, size_t D, class F, class Enough>
double nested(const F& f, Point<D>& c, const Range<D>& range, const Agreement& g,
              const Enough& enough) {
    if constexpr (K == D)
        return f(c);
    else {
        auto along = [&](double x) {
            c[K] = x;
            Agreement inner = g;
            inner.tolerance *= 0.1 / (range.upper[K] - range.lower[K]);  // a tenth of the error
            inner.halves = g.all_halves;
            return detail::nested<K + 1>(f, c, range, inner, enough);
        };
        Agreement here = g;
        if (K == 0 && D > 1) here.noise *= 2;  // that of inner integrals, too
        return detail::integral(along, range.lower[K], range.upper[K], here, enough);
    }
}

// Ranges so small that no peak and no border that the pilot found hides between the nodes of a
// rule: none longer than 0.3 of the domain (on a line, where many cost little, 0.001), none of
// which points fill a corner alone (a fifth of its length), none in which the density differs more
// than 16 times.  Fewer than four points tell nothing.  (Chosen; the campaign passes.)
template <size_t M, size_t N, class Domain>
void DensityCheck<M, N, Domain>::divide(const Range<D>& range, const std::vector<size_t>& inside,
                                        std::vector<Range<D>>& parts, int depth) const {
    auto split = [&](size_t k, double border) {
        Range<D> low = range, high = range;
        low.upper[k] = high.lower[k] = border;
        std::vector<size_t> below, above;
        for (size_t i : inside) (places[i][k] < border ? below : above).push_back(i);
        divide(low, below, parts, depth - 1);
        divide(high, above, parts, depth - 1);
    };
    if (depth == 0) return parts.push_back(range);
    size_t widest = 0;
    double share = 0;
    for (size_t k = 0; k < D; ++k)
        if (const double s =
                (range.upper[k] - range.lower[k]) / (domain.upper[k] - domain.lower[k]);
            s > share)
            share = s, widest = k;
    if (share > (D == 1 ? 1e-3 : 0.3)) return split(widest, range.middle()[widest]);
    if (inside.size() < 4) return parts.push_back(range);
    double least = infinity, most = 0;
    for (size_t i : inside) {
        least = std::min(least, per_dc[i]);
        most = std::max(most, per_dc[i]);
    }
    for (size_t k = 0; k < D; ++k) {
        double first = infinity, last = -infinity;
        for (size_t i : inside) {
            first = std::min(first, places[i][k]);
            last = std::max(last, places[i][k]);
        }
        const double spread = last - first;
        if (!(spread > 0)) continue;
        if (range.upper[k] - last > 4 * spread) return split(k, last + 2 * spread);
        if (first - range.lower[k] > 4 * spread) return split(k, first - 2 * spread);
    }
    if (most <= 16 * least) return parts.push_back(range);
    std::vector<double> x;
    for (size_t i : inside) x.push_back(places[i][widest]);
    const double border = median(x);
    if (border > range.lower[widest] && border < range.upper[widest]) return split(widest, border);
    parts.push_back(range);
}

template <size_t M, size_t N, class Domain>
Parts DensityCheck<M, N, Domain>::integrate() {
    std::array<std::vector<size_t>, cell_count> inside;
    for (size_t i = 0; i < places.size(); ++i) inside[cells.of(places[i])].push_back(i);
    std::vector<Range<D>> ranges;
    std::vector<size_t> of_cell;
    for (size_t cell = 0; cell < cell_count; ++cell) {
        const int halvings = 16;  // 8 leave one of the 128 places of a cell alone
        divide(cells.range(cell, {domain.lower, domain.upper}), inside[cell], ranges, halvings);
        of_cell.resize(ranges.size(), cell);
    }
    size_t evaluations = 0;
    auto f = [&](const Point<D>& c) {
        ++evaluations;
        return density_at(c);
    };
    // Three or four for each sample of a check with default options; a guess need not be exact.
    const size_t budget = claim ? 200'000 : 4'000'000;
    auto enough = [&] { return evaluations > budget; };
    double left = 0;
    auto by_rules = [&](bool all_halves) {
        Parts parts;
        if constexpr (D <= 2) {
            const double close = claim ? 3e-3 : allowed();
            // No finer than f can tell where it jumps; on a line to a double's last digit.  300
            // parts that just agree add up to `close`, and their relative errors to an eighth.
            const int halvings = D == 1 ? 60 : 1 - std::ilogb(close / 8);
            const Agreement g{close / 300, close / 8, halvings, true, all_halves, &left};
            for (size_t i = 0; i < ranges.size() && !enough(); ++i) {
                Point<D> c{};
                parts.value[of_cell[i]] += detail::nested(f, c, ranges[i], g, enough);
            }
        }
        for (double value : parts.value) parts.total += value;
        return parts;
    };
    Parts parts = by_rules(false);
    // Where borders cut across the coordinates rules may not agree, or agree by chance: a total
    // that is nearly right is known no better than another way tells.  One code of
    // the campaign did, in one of 60 000 runs (1e-4 and 1e-3 are chosen).  All of the pilot
    // arrived.
    const double off = std::abs(parts.total - (1 - o.discrete));
    double other = 0;
    bool doubtful = off > allowed() && arriving > 0.9999 && !claim;
    const double near = !model.single ? 1e-4 : left > 0 ? 0 : 1e-3;  // left: scatter tells
    if (doubtful && D <= 2 && off < near) {
        const Parts again = by_rules(true);
        if (!enough()) other = std::abs(again.total - parts.total);  // else it has not come to all
        parts = again;
    }
    // In float rules stop where they still miss slivers between a border and their nodes, a
    // thousandth of all, so 0.01 is none of theirs; the part that fails is known from the pilot.
    const double lost = std::abs(parts.total - arriving),
                 unknown = 5 * std::sqrt(arriving * (1 - arriving) / double(pilot_size));
    doubtful = D == 2 && model.single && left > 0 && !claim && lost < 0.01 + unknown &&
               (unknown > 0 || lost > std::min(1e-4, allowed()));
    if (D > 2 || enough() || doubtful) parts = scatter(f, ranges, of_cell);
    parts.total = 0;
    for (size_t cell = 0; cell < cell_count; ++cell) {
        parts.total += parts.value[cell];
        parts.error += parts.variance[cell];
    }
    parts.error = std::sqrt(parts.error) + other + (D == 1 ? left : 0);
    return parts;
}

// More dimensions or jumps than rules can follow: 16 shifts of a lattice (Roberts's generalised
// golden ratio, by an iteration that converges) in each range, of three million points in all.
template <size_t M, size_t N, class Domain>
template <class F>
Parts DensityCheck<M, N, Domain>::scatter(const F& f, const std::vector<Range<D>>& ranges,
                                          const std::vector<size_t>& of_cell) {
    double golden = 1.5;
    for (int i = 0; i < 60; ++i) golden = std::pow(1 + golden, 1 / (double(D) + 1));
    Point<D> step;
    for (size_t k = 0; k < D; ++k) step[k] = std::pow(golden, -double(k + 1));
    const size_t points = std::max<size_t>(64, (claim ? 300'000 : 3'000'000) / 16 / ranges.size());
    Parts parts;
    for (size_t i = 0; i < ranges.size(); ++i) {
        const Range<D>& r = ranges[i];
        double volume = 1;
        for (size_t k = 0; k < D; ++k) volume *= r.upper[k] - r.lower[k];
        Draws shifts;
        for (int shift = 0; shift < 16; ++shift) {
            Point<D> x;
            for (double& s : x) s = random();
            double sum = 0;
            for (size_t j = 0; j < points; ++j) {
                Point<D> c;
                for (size_t k = 0; k < D; ++k) {
                    x[k] += step[k];
                    x[k] -= std::floor(x[k]);
                    c[k] = r.lower[k] + x[k] * (r.upper[k] - r.lower[k]);
                }
                sum += f(c);
            }
            shifts.add(sum / double(points) * volume);
        }
        parts.value[of_cell[i]] += shifts.mean();
        parts.variance[of_cell[i]] += shifts.variance() / 16;
    }
    return parts;
}

// ---- Derivatives of maps ------------------------------------------------------------------------

// sqrt(det J^T J) by Gram and Schmidt, which keeps digits of thin parallelepipeds.
template <size_t D, size_t N>
double volume(std::array<Point<N>, D> slopes) {
    double product = 1;
    for (size_t i = 0; i < D; ++i) {
        double square = 0;
        for (double x : slopes[i]) square += x * x;
        product *= std::sqrt(square);
        if (!(square > 0)) return square;
        for (size_t j = i + 1; j < D; ++j) {
            double along = 0;
            for (size_t k = 0; k < N; ++k) along += slopes[i][k] * slopes[j][k];
            for (size_t k = 0; k < N; ++k) slopes[j][k] -= along / square * slopes[i][k];
        }
    }
    return product;
}

// A step for differences: a power of two, so that u + h is exact in float, too.  There rounding
// unit / h and the error h^4 are alike at unit^(1/5) = 0.04; in double h^4 is below 3e-10.
inline double step_of(double u, bool single) {
    return std::exp2(std::floor(std::log2((single ? 0.06 : 0.004) * std::min(u, 1 - u))));
}

// By central differences of fourth order at the steps h and h / 2, and the noise of x(u) by fourth
// differences of h / 32.  Nothing if a sample fails near u.
template <size_t D, size_t N>
std::optional<Local<N>> local_at(const Model<D, N>& model, const Point<D>& u) {
    bool arrives = true;
    auto at = [&](const Point<D>& v) {
        const auto x = model.sample(v);
        arrives = arrives && x;
        return x ? Point<N>(*x) : Point<N>{};
    };
    auto moved = [&](size_t k, double by) {
        Point<D> v = u;
        v[k] += by;
        return v;
    };
    Local<N> here;
    here.x = at(u);
    std::array<Point<N>, D> coarse{}, fine{};
    double lengths = 1;
    for (size_t k = 0; k < D; ++k) {
        const double h = step_of(u[k], model.single);
        std::array<Point<N>, 3> difference;  // between -h/2 and h/2, -h and h, -2h and 2h
        for (size_t s = 0; s < 3; ++s) {
            const double step = h * (s == 0 ? 0.5 : double(s));
            const Point<N> above = at(moved(k, step)), below = at(moved(k, -step));
            for (size_t i = 0; i < N; ++i) difference[s][i] = above[i] - below[i];
        }
        std::array<Point<N>, 13> near;
        for (size_t j = 0; j < 13; ++j) near[j] = at(moved(k, (double(j) - 6) * h / 32));
        if (!arrives) return {};
        const auto& [d1, d2, d4] = difference;
        double square = 0, rough = 0;
        for (size_t i = 0; i < N; ++i) {
            coarse[k][i] = (8 * d2[i] - d4[i]) / (12 * h);
            fine[k][i] = (8 * d1[i] - d2[i]) / (6 * h);
            square += fine[k][i] * fine[k][i];
            // Fourth differences of equal steps: curvature cancels, and 70 variances add up.
            for (size_t j = 2; j < 11; ++j)
                rough += std::pow(near[j - 2][i] - 4 * near[j - 1][i] + 6 * near[j][i] -
                                      4 * near[j + 1][i] + near[j + 2][i],
                                  2);
        }
        lengths *= std::sqrt(square);
        if (square > 0)
            here.noise += 2 * rough / (70 * 9 * h * h * square);
        else if (const auto far = model.sample(moved(k, u[k] < 0.5 ? 0.4375 : -0.4375)))
            here.still |= unsigned(*far == here.x) << k;
    }
    const double j = detail::volume(fine);
    here.p = model.pdf(here.x);
    here.q = j > 0 ? 1 / j : infinity;
    here.error = j > 0 ? std::abs(detail::volume(coarse) / j - 1) : infinity;
    here.collapse = lengths > 0 ? j / lengths : 0;
    here.noise = here.collapse > 0 ? std::sqrt(here.noise) / here.collapse : 0;
    return here;
}

// Somewhere inside the unit cube, with 12 binary digits, to which float adds those of a step.
template <size_t D>
Point<D> somewhere(Random& random) {
    Point<D> u;
    for (double& x : u) x = std::floor((0.01 + 0.98 * random()) * 4096) / 4096;
    return u;
}

inline double median(std::vector<double> x, double part) {
    std::erase_if(x, [](double y) { return std::isnan(y); });  // which have no order
    if (x.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto middle = x.begin() + long(part * double(x.size() - 1));
    std::nth_element(x.begin(), middle, x.end());
    return *middle;
}

// Differences at two steps that are further apart tell of no smooth map.
inline constexpr double agreeing = 0.3;

// p / q differs from 1 about u by more than rounding: its median at 15 points close to u exceeds
// `tolerance`, twice the interquartile range and four times the noise.  > 0: too large, < 0: too
// small; 0 if differences disagree at more than a fifth of the points.  In float coordinates are
// steps: points closer than h would be off alike.
template <size_t D, size_t N>
int off_about(const Model<D, N>& model, const Point<D>& u, Random& random, double tolerance) {
    std::vector<double> off, noise;
    for (int i = 0; i < 15; ++i) {
        auto near = u;
        for (double& x : near)
            x = std::floor(
                    (x + (model.single ? 0.4 : 0.04) * (random() - 0.5) * std::min(x, 1 - x)) *
                    65536) /
                65536;
        const auto l = local_at(model, near);
        if (l && l->p > 0 && l->error < agreeing)
            off.push_back(l->product() - 1), noise.push_back(l->noise);
    }
    if (off.size() < 12) return 0;
    const double middle = median(off), spread = median(off, 0.75) - median(off, 0.25);
    return std::abs(middle) > tolerance + 2 * spread + 4 * median(noise) ? (middle > 0 ? 1 : -1)
                                                                         : 0;
}

template <size_t D, size_t N>
Sheets<N, D> sheets_of(const Model<D, N>& model, Random& random, double tolerance, double forgiven,
                       bool both_sides) {
    Sheets<N, D> s;
    std::vector<double> errors;
    for (int i = 0; i < sheet_points; ++i) {
        const Point<D> u = somewhere<D>(random);
        const auto l = local_at(model, u);
        if (!l || !std::isfinite(l->p) || !(l->error < agreeing || l->q == infinity)) continue;
        s.all.push_back(*l);
        if (!(l->q < infinity)) continue;
        errors.push_back(l->error + 4 * l->noise);
        const double off = l->product() - 1;
        const bool beyond =
            l->p > 0 && (both_sides ? std::abs(off) : -off) > forgiven + tolerance + errors.back();
        if (beyond && (!s.off || std::abs(off) > std::abs(s.off->product() - 1))) {
            const int side = off_about(model, u, random, forgiven + tolerance);
            if (side < 0 || (both_sides && side > 0)) s.off = l, s.u = u;
        }
    }
    if (!errors.empty()) s.blind = std::max(tolerance, median(errors, 0.9));
    if (s.off && std::abs(s.off->product() - 1) <= forgiven + tolerance + 2 * s.blind) s.off = {};
    return s;
}

// ---- What a few samples tell a check: mirrors, borders, rims, rounding --------------------------

// A thousandth of a length or of the spread is outside for sure; less is rounding, which other
// parts of a check judge.
template <class Domain, size_t N, size_t D>
std::string stray(const Domain& domain, const Point<N>& w, const Point<D>& c, double unit,
                  double extent) {
    constexpr bool directions = is_sphere<Domain>;
    const Point<N> back = domain.at(c);
    double off = 0, size = 1e-300;
    for (size_t k = 0; k < N; ++k) off += std::pow(back[k] - w[k], 2), size += w[k] * w[k];
    const double ulps = roundings * unit * std::sqrt(size);
    bool inside = off <= (directions ? 1e-6 : 1e-6 * extent + ulps * ulps);
    for (size_t k = 0; k < D; ++k) {
        const double slack = 1e-5 * (domain.upper[k] - domain.lower[k]) + (directions ? 0 : ulps);
        inside = inside && c[k] >= domain.lower[k] - slack && c[k] <= domain.upper[k] + slack;
    }
    return inside       ? ""
           : directions ? say("a sample is no direction: its length is %.6g, ", std::sqrt(size)) +
                              say_point(w)
                        : "a sample lies outside of the domain, " + say_point(w);
}

// Median of squared distances from the first point.
template <size_t N>
double extent_of(const std::vector<Point<N>>& points) {
    std::vector<double> squares(points.size());
    for (size_t i = 0; i < points.size(); ++i)
        for (size_t k = 0; k < N; ++k) squares[i] += std::pow(points[i][k] - points[0][k], 2);
    return median(squares);
}

// Where samples lie, whose medians are `middle`.
template <size_t N, class Domain>
Scene<N> scene_of(const Domain& domain, const Options& o, const Point<N>& middle) {
    Scene<N> scene{is_sphere<Domain>};
    scene.middle = middle;
    if constexpr (is_sphere<Domain>) {
        scene.lobe = scene.middle = domain.z;
        if (dot(o.axis, o.axis) > 0) scene.normal = normalized(o.axis);
    } else if constexpr (std::is_base_of_v<Box<N>, Domain>) {
        scene.centre = Range<N>{domain.lower, domain.upper}.middle();
    }
    return scene;
}

// Points that one in a hundred samples repeats: a mirror's.  But 0, which many samplers return for
// nothing; a sampler that ignores its numbers, which hints name; and a cap that rounding takes to
// one point, of an angle whose cosine is less than 32 units from 1, so of 2 pi 32 units.
template <size_t M, size_t N, class Domain>
void DensityCheck<M, N, Domain>::find_mirrors() {
    std::vector<Point<N>> points;
    for (size_t i = 0; i < pilot_size; ++i)
        if (const auto x = model.sample(model.draw(random)))
            if (o.discrete > 0 || model.pdf(*x) > 0) points.push_back(*x);
    std::sort(points.begin(), points.end());
    for (size_t i = 0, j = 0; i < points.size(); i = j) {
        while (j < points.size() && points[j] == points[i]) ++j;
        const double part = double(j - i) / double(points.size());
        if (part < 0.01 || points[i] == Point<N>{}) continue;
        if (o.discrete > 0)
            mirrors.push_back(points[i]);
        else if (part < 0.9 && part > 200 * model.unit * model.pdf(points[i]))
            repeating += part, ++heaps,
                repeated = percent(part) + " of the samples are " + at(points[i]);
    }
}

template <size_t M, size_t N, class Domain>
void DensityCheck<M, N, Domain>::fly_pilot() {
    std::vector<Point<N>> points;
    int drawn = 0;
    for (; drawn < pilot_draws && points.size() < pilot_size; ++drawn) {
        const auto x = model.sample(model.draw(random));
        if (x && model.pdf(*x) > 0 && !is_mirror(*x)) points.push_back(*x);
    }
    if (points.size() < fewest_of_pilot) return;
    arriving = double(points.size()) / drawn;
    domain.fit(points, o.axis);
    extent = extent_of(points);
    const int jitters = model.single ? 8 : 1;  // doubles meet no jump
    for (size_t i = 0; i < points.size(); ++i) {
        const auto c = domain.coordinates(points[i]);
        pilot.push_back(c);
        const double p = model.pdf(points[i]);
        heights.push_back(p);
        places.push_back(c);
        per_dc.push_back(p * domain.weight(c));
        if constexpr (directions)
            for (size_t k = 0; i % 8 == 0 && k < 3; ++k) {  // 16 of a cell's 128
                Triple image = points[i];
                image[k] = -image[k];
                const double there = model.pdf(image);
                if (!(there > 0)) continue;
                places.push_back(domain.coordinates(image));
                per_dc.push_back(there * domain.weight(places.back()));
            }
        // The change by an ulp or two of the coordinates; few points meet a jump, of half or more.
        for (int j = 0; j < jitters; ++j) {
            const double change = std::abs(model.pdf(jittered(points[i])) / p - 1);
            (change < 0.5 ? rounding : jumps) += std::min(1.0, change);
        }
    }
    for (size_t k = 0; k < N && !directions; ++k) {
        std::vector<double> x, size;
        for (const auto& p : points) x.push_back(p[k]), size.push_back(std::abs(p[k]));
        middle[k] = median(x);
        if (const double width = median(x, 0.75) - median(x, 0.25); width > 0)
            grain = std::max(grain, 4 * model.unit * median(size) / width);
    }
    rounding /= double(points.size()) * jitters;
    jumps /= double(points.size()) * jitters;
}

// 0 and the number next to 1, alone and together, which random numbers meet too seldom.
template <size_t M, size_t N, class Domain>
void DensityCheck<M, N, Domain>::try_rims() {
    const double last = 1 - (model.single || model.floats ? 0x1p-24 : 0x1p-53);
    const double before = none;
    size_t all = 1;  // combinations of 0, last and others: 81 are enough
    for (size_t k = 0; k < std::min<size_t>(M, 4); ++k) all *= 3;
    for (size_t i = 1; i < all; ++i) {
        Point<M> u = model.draw(random);
        size_t digits = i;
        for (double& x : u) {
            if (digits % 3 > 0) x = digits % 3 == 1 ? 0 : last;
            digits /= 3;
        }
        (void)at_numbers(u, true);
    }
    if (before == 0 && none > 0) none = 0;  // first_none is that of one()
}

// Part of a cell's samples that four units of rounding may take to another cell: of each
// coordinate, and in float of the cosine to the lobe's axis, from which samplers have the sine.
// The root of its mean square over the samples.
template <size_t M, size_t N, class Domain>
double DensityCheck<M, N, Domain>::moved() {
    std::array<double, cell_count> all{}, others{};
    for (size_t i = 0; i < pilot_size; ++i) {  // others than the pilot's, at which cells end
        const auto x = model.sample(model.draw(random));
        if (!x || is_mirror(*x) || !(model.pdf(*x) > 0)) continue;
        const size_t cell = cells.of(domain.coordinates(*x));
        for (int j = 0; j < 8; ++j) {
            auto there = domain.coordinates(jittered(*x));
            if (directions && model.single) {
                const double s = std::sin(there[0] / 2),
                             versine = 2 * s * s + (random() - 0.5) * 2 * jitter * model.unit;
                there[0] = 2 * std::asin(std::sqrt(std::min(1.0, std::abs(versine) / 2)));
            }
            ++all[cell];
            others[cell] += cells.of(there) != cell;
        }
    }
    double sum = 0, n = 0;
    for (size_t i = 0; i < cell_count; ++i)
        if (all[i] > 0) sum += others[i] * others[i] / all[i], n += all[i];
    return n > 0 ? std::sqrt(sum / n) : 0;
}

// ---- Arrays of samples and densities ------------------------------------------------------------

// A point for each of n equal parts of a range: cut into slabs along coordinate k, each of these
// along the next.
template <size_t D>
void for_parts(const Range<D>& range, size_t n, size_t k, const auto& use) {
    if (k == D) return use(range);
    const size_t slabs = size_t(std::lround(std::pow(double(n), 1 / double(D - k))));
    for (size_t i = 0; i < slabs; ++i) {
        const size_t begin = n * i / slabs, end = n * (i + 1) / slabs;
        const double width = (range.upper[k] - range.lower[k]) / double(n);
        Range<D> slab = range;
        slab.lower[k] += width * double(begin);
        slab.upper[k] = range.lower[k] + width * double(end);
        detail::for_parts(slab, end - begin, k + 1, use);
    }
}

template <class Domain>
auto points_in(Random& random, const Domain& domain, size_t n) {
    constexpr size_t D = Domain::dimensions;
    std::vector<decltype(domain.at({}))> points;
    detail::for_parts(Range<D>{domain.lower, domain.upper}, (n + 1) / 2, 0,
                      [&](const Range<D>& part) {
                          for (int i = 0; i < 2; ++i) {
                              Point<D> c = part.lower;
                              for (size_t k = 0; k < D; ++k)
                                  c[k] += random() * (part.upper[k] - part.lower[k]);
                              points.push_back(domain.at(c));
                          }
                      });
    return points;
}

template <size_t N, class Domain>
std::string ArrayCheck<N, Domain>::wrong() {
    const double extent = extent_of(samples);
    std::vector<Point<D>> places;
    for (size_t i = 0; i < samples.size(); ++i) {
        const Point<N>& w = samples[i];
        for (double x : w)
            if (!std::isfinite(x)) return say("sample %zu is not finite, ", i) + say_point(w);
        places.push_back(domain.coordinates(w));
        if (const std::string why = stray(domain, w, places[i], 0x1p-24, extent); !why.empty())
            return why + say(", sample %zu", i);
    }
    Random random(0);  // samples may be sorted, or of a sequence
    std::vector<Point<D>> others;
    for (const Point<D>& c : places) (random() < 0.25 ? pilot : others).push_back(c);
    cells = Cells<D>(pilot);
    for (const Point<D>& c : others) ++counts[cells.of(c)];
    double volume = 1;
    for (size_t k = 0; k < D; ++k) volume *= domain.upper[k] - domain.lower[k];
    for (size_t i = 0; i < pdf.size(); ++i) {
        if (!(pdf[i] >= 0 && std::isfinite(pdf[i])))
            return say("the pdf is %g at ", pdf[i]) + say_point(points[i]);
        const Point<D> c = domain.coordinates(points[i]);
        cell_of.push_back(cells.of(c));
        part_of.push_back(pdf[i] * domain.weight(c) * volume / double(pdf.size()));
    }
    return "";
}

// None of n samples comes where the pdf has the share s with the probability e^(-n s): all 2 N
// sides together have a tenth of alpha.  As many points as a cell needs must tell the share (Kish).
template <size_t N, class Domain>
std::string ArrayCheck<N, Domain>::without_samples() const {
    const double total = sum_of(part_of), n = double(samples.size());
    for (size_t k = 0; k < N; ++k)
        for (const double side : {-1.0, 1.0}) {
            double sum = 0, squares = 0, come = 0;
            for (size_t i = 0; i < points.size(); ++i)
                if (points[i][k] * side > 0) sum += part_of[i], squares += part_of[i] * part_of[i];
            for (const Point<N>& w : samples) come += w[k] * side > 0;
            if (come == 0 && sum * sum >= fewest_in_cell * squares &&
                n * sum / total > -std::log(o.alpha / (20 * double(N))))
                return say("no sample has %c %c 0, where the pdf has ", "xyzw"[k % 4],
                           side < 0 ? '<' : '>') +
                       percent(sum / total) + " of its integral";
        }
    return "";
}

// Points that tell the pdf of a cell, of the one that has the fewest: (sum x)^2 / sum x^2 (Kish
// 1965); where the pdf has less than half of a cell's share, which is wrong already, all.
template <size_t N, class Domain>
double ArrayCheck<N, Domain>::fewest_points() const {
    std::array<double, cell_count> points{}, sum{}, squares{};
    for (size_t i = 0; i < pdf.size(); ++i) {
        const double x = part_of[i];
        ++points[cell_of[i]], sum[cell_of[i]] += x, squares[cell_of[i]] += x * x;
    }
    for (size_t i = 0; i < cell_count; ++i)
        if (sum[i] > 0.5 / double(cell_count) * sum_of(part_of))
            points[i] = sum[i] * sum[i] / squares[i];
    return *std::min_element(points.begin(), points.end());
}

// The pdf times factor(x).  Of a sum over pairs the variance is that of their differences.
template <size_t N, class Domain>
Parts ArrayCheck<N, Domain>::parts(const auto& factor) const {
    Parts p;
    auto at = [&](size_t i) {
        const double x = i < pdf.size() && pdf[i] > 0 ? part_of[i] * factor(points[i]) : 0;
        if (x > 0) p.value[cell_of[i]] += x, p.total += x;
        return x;
    };
    double square = 0;
    for (size_t i = 0; i < pdf.size(); i += 2) {
        const double a = at(i), b = at(i + 1);
        if (a == 0 && b == 0) continue;
        square += (a - b) * (a - b);
        if (a > 0 && b > 0 && cell_of[i] == cell_of[i + 1])
            p.variance[cell_of[i]] += (a - b) * (a - b);
        else {
            if (a > 0) p.variance[cell_of[i]] += a * a;
            if (b > 0) p.variance[cell_of[i + 1]] += b * b;
        }
    }
    p.error = std::sqrt(square);
    return p;
}

template <size_t N, class Domain>
Scene<N> ArrayCheck<N, Domain>::scene() const {
    Domain fitted = domain;
    fitted.fit(samples, o.axis);
    Point<N> middle{};
    for (size_t k = 0; k < N; ++k) {
        std::vector<double> x;
        for (const Point<N>& w : samples) x.push_back(w[k]);
        middle[k] = median(x);
    }
    return scene_of<N>(fitted, o, middle);
}

}  // namespace oracle::detail

namespace oracle {
using detail::integral, detail::Agreement;
}
// oracle/host.h  appendix: the vectors, samplers and densities of calling code, read without their
// types

namespace oracle::detail {

template <size_t N>
auto elements(const auto& at) {
    return [&]<size_t... I>(std::index_sequence<I...>) {
        return std::array{at(std::integral_constant<size_t, I>())...};
    }
    (std::make_index_sequence<N>());
}
// A vector may be smaller than three of its elements.
template <class V, class Element>
constexpr size_t size_of = sizeof(V) == 2 * sizeof(Element) ? 2 : 3;

// The coordinates of a number, pair, array, vector or colour, in its own type.
template <class V>
auto coordinates(const V& v) {
    if constexpr (std::is_arithmetic_v<V>)
        return std::array{v};
    else if constexpr (requires { V::SizeAtCompileTime; })
        return elements<size_t(V::SizeAtCompileTime)>([&](auto i) { return v[long(i())]; });
    else if constexpr (requires { v.x() + v.y() + v.z(); })
        return std::array{v.x(), v.y(), v.z()};
    else if constexpr (requires { v.x + v.y + v.z; })
        return std::array{v.x, v.y, v.z};
    else if constexpr (requires { v.X + v.Y + v.Z; })
        return std::array{v.X, v.Y, v.Z};
    else if constexpr (requires { v.getX() + v.getY() + v.getZ(); })
        return std::array{v.getX(), v.getY(), v.getZ()};
    else if constexpr (requires { v.r + v.g + v.b; })
        return std::array{v.r, v.g, v.b};
    else if constexpr (requires { v.x() + v.y(); })
        return std::array{v.x(), v.y()};
    else if constexpr (requires { v.x + v.y; })
        return std::array{v.x, v.y};
    else if constexpr (requires { v.X + v.Y; })
        return std::array{v.X, v.Y};
    else if constexpr (requires { v.real() + v.imag(); })
        return std::array{v.real(), v.imag()};
    else if constexpr (requires { std::tuple_size<V>::value; })
        return std::apply([](auto... c) { return std::array{c...}; }, v);
    else if constexpr (requires { v[size_t()] + v[size_t()]; })
        return elements<size_of<V, std::decay_t<decltype(v[size_t()])>>>(
            [&](auto i) { return v[decltype(i)::value]; });
    else if constexpr (requires { v(0) + v(0); })
        return elements<size_of<V, std::decay_t<decltype(v(0))>>>(
            [&](auto i) { return v(int(i())); });
    else {
        static_assert(
            !sizeof(V),
            "the oracle cannot read the coordinates of this vector: give it x, y, z, or []");
        return std::array{0.0};
    }
}
template <class V>
using Coordinates = decltype(detail::coordinates(std::declval<const V&>()));
template <class V>
constexpr size_t coordinates_of() {
    return std::tuple_size_v<Coordinates<V>>;
}

template <class V>
auto point(const V& v) {
    Point<coordinates_of<V>()> p;
    const Coordinates<V> own = detail::coordinates(v);
    for (size_t k = 0; k < p.size(); ++k) p[k] = double(own[k]);
    return p;
}
template <class V, size_t... I>
V of_host(const auto& c, std::index_sequence<I...>) {
    using T = Coordinate<V>;
    if constexpr (requires { V{T(c[I])...}; })
        return V{T(c[I])...};
    else if constexpr (requires { V(T(c[I])...); })
        return V(T(c[I])...);
    else {
        V v{};
        if constexpr (requires { v[size_t()] = T(); })
            ((v[I] = T(c[I])), ...);
        else if constexpr (requires { v(int()) = T(); })
            ((v(int(I)) = T(c[I])), ...);
        else
            static_assert(!sizeof(V),
                          "the oracle cannot make this vector from its coordinates: give it a "
                          "constructor of them");
        return v;
    }
}
template <class V, size_t N>
V of_host(const Point<N>& c) {
    return detail::of_host<V>(c, std::make_index_sequence<N>());
}

// The numbers of an array; of colours, their channels, one after the other.
template <class Array>
std::vector<double> numbers_in(const Array& array) {
    static_assert(
        requires { std::size(array); },
        "a check does not know where this array ends: pass std::span(pointer, length)");
    std::vector<double> numbers;
    for (size_t i = 0; i < std::size(array); ++i)
        if constexpr (requires { double(array[i]); })
            numbers.push_back(double(array[i]));
        else if constexpr (requires { double(array[i][i]) + double(std::size(array[i])); })
            for (double x : detail::numbers_in(array[i])) numbers.push_back(x);
        else
            for (double x : detail::point(array[i])) numbers.push_back(x);
    return numbers;
}

// f takes numbers of type A as they are, or one argument that {them} initialises.  Braces do not
// convert a double to a float, and so tell which of the two f wants.
enum class Taken { not_at_all, exactly, converted, in_braces };
template <class F, class A, size_t... I>
constexpr Taken taken(std::index_sequence<I...>) {
    if (requires(F & f, A a) { f({((void)I, a)}...); }) return Taken::exactly;
    if (requires(F & f, A a) { f(((void)I, a)...); }) return Taken::converted;
    if (requires(F & f, A a) { f({((void)I, a)...}); }) return Taken::in_braces;
    return Taken::not_at_all;
}
template <class F, class A, size_t D>
constexpr Taken takes = detail::taken<F, A>(std::make_index_sequence<D>());

// call() converts them to float: 1 - 2^-54 would become 1.
template <class F, size_t D>
constexpr bool takes_floats = takes<F, double, D> != Taken::exactly &&
                              (takes<F, float, D> == Taken::exactly ||
                               takes<F, double, D> == Taken::not_at_all);

template <class F, size_t D>
auto call(F& f, const Point<D>& u) {
    return [&]<size_t... I>(std::index_sequence<I...>) {
        using A = std::conditional_t<takes_floats<F, D>, float, double>;
        if constexpr (takes<F, A, D> == Taken::in_braces)
            return f({A(u[I])...});
        else
            return f(A(u[I])...);
    }
    (std::make_index_sequence<D>());
}

// The number of arguments of f; 0 if it draws by itself.
template <class F, size_t D = 8>
constexpr size_t numbers_of() {
    if constexpr (D == 0 || takes<F, double, D> != Taken::not_at_all ||
                  takes<F, float, D> == Taken::in_braces)
        return D;
    else
        return numbers_of<F, D - 1>();
}

// A sampler may return nothing: an optional or a pointer.
template <class R>
constexpr bool may_fail = requires(const R& r) {
    r ? *r : *r;
};
template <class R>
const auto& arrived(const R& r) {
    if constexpr (may_fail<R>)
        return *r;
    else
        return r;
}

// What a sampler returns may have parts: a point or direction, a density, a value.  They are
// members of these names, or elements of a tuple or pair: its first that is no number has the
// point, its first number is the density.  A tuple of numbers alone is a point.
template <class R, class Get, class... More>
constexpr auto member_of(const R& r, Get get, More... more) {
    if constexpr (requires { get(r); })
        return &get(r);
    else if constexpr (sizeof...(More) > 0)
        return detail::member_of(r, more...);
    else
        return nullptr;
}
#define ORACLE_MEMBER(name)                                                 \
    [](const auto& r) -> const auto& requires requires {                    \
        r.name;                                                             \
        requires !std::is_pointer_v<std::remove_cvref_t<decltype(r.name)>>; \
    }                                                                       \
    { return r.name; }
template <class R>
constexpr auto direction_of(const R& r) {
    return detail::member_of(r, ORACLE_MEMBER(wi), ORACLE_MEMBER(wo), ORACLE_MEMBER(direction),
                             ORACLE_MEMBER(dir), ORACLE_MEMBER(w), ORACLE_MEMBER(point));
}
template <class R>
constexpr auto density_of(const R& r) {
    return detail::member_of(r, ORACLE_MEMBER(pdf), ORACLE_MEMBER(prob),
                             ORACLE_MEMBER(probability));
}
template <class R>
constexpr auto f_of(const R& r) {
    return detail::member_of(r, ORACLE_MEMBER(f), ORACLE_MEMBER(value), ORACLE_MEMBER(eval),
                             ORACLE_MEMBER(bsdf), ORACLE_MEMBER(brdf));
}
template <class R>
constexpr auto weight_of(const R& r) {
    return detail::member_of(r, ORACLE_MEMBER(weight), ORACLE_MEMBER(throughput),
                             ORACLE_MEMBER(attenuation));
}
#undef ORACLE_MEMBER
template <class Pointer>
constexpr bool found = !std::is_null_pointer_v<Pointer>;

// The k-th element of a tuple that is a number with a point, or that is none: flags, indices and
// enumerators are neither.  The tuple's size if there is no such.
template <class T, bool number>
constexpr bool is_kind =
    number ? std::is_floating_point_v<T> : !std::is_arithmetic_v<T> && !std::is_enum_v<T>;
template <class R, bool number>
constexpr size_t element(size_t k) {
    return []<size_t... I>(std::index_sequence<I...>, size_t k) {
        const bool is[] = {is_kind<std::decay_t<std::tuple_element_t<I, R>>, number>...};
        size_t i = 0;
        while (i < sizeof...(I) && (!is[i] || k-- > 0)) ++i;
        return i;
    }
    (std::make_index_sequence<std::tuple_size_v<R>>(), k);
}
template <class R>
constexpr bool is_tuple() {
    if constexpr (requires(const R& r) { std::tuple_size<R>::value, r[0]; })
        return false;  // an array
    else if constexpr (requires { std::tuple_size<R>::value; })
        return element<R, false>(0) < std::tuple_size_v<R>;
    else
        return false;
}
template <size_t I, class R>
constexpr auto at_index(const R& r) {
    if constexpr (I < std::tuple_size_v<R>)
        return &std::get<I>(r);
    else
        return nullptr;
}

// A structure with a direction, or a point and its density.
template <class R>
constexpr bool has_parts = requires(const R& r) {
    detail::point(*detail::direction_of(r));
    requires !std::is_arithmetic_v<std::decay_t<decltype(*detail::direction_of(r))>> ||
        found<decltype(detail::density_of(r))>;
};
template <class R>
const auto& beside(const R& r) {
    if constexpr (is_tuple<R>())
        return std::get<element<R, false>(0)>(r);
    else
        return r;
}
template <class R>
const auto& point_in(const R& r) {
    const auto& parts = detail::beside(r);
    if constexpr (has_parts<std::decay_t<decltype(parts)>>)
        return *detail::direction_of(parts);
    else
        return parts;
}
template <class R>
auto pdf_in(const R& r) {
    using Parts = std::decay_t<decltype(detail::beside(r))>;
    if constexpr (has_parts<Parts> &&
                  found<decltype(detail::density_of(std::declval<const Parts&>()))>)
        return detail::density_of(detail::beside(r));
    else if constexpr (is_tuple<R>())
        return at_index<element<R, true>(0)>(r);
    else
        return nullptr;
}
// A value without a name: the second that is no number, or else the number after the density.
template <class R>
auto unnamed_in(const R& r) {
    if constexpr (!is_tuple<R>())
        return nullptr;
    else if constexpr (element<R, false>(1) < std::tuple_size_v<R>)
        return at_index<element<R, false>(1)>(r);
    else
        return at_index<element<R, true>(
            found<decltype(detail::density_of(detail::beside(r)))> ? 0 : 1)>(r);
}

// An index, alone or with its probability: a pair, a tuple, or a structure.
template <class R>
long long index_in(const R& r) {
    if constexpr (requires { static_cast<long long>(r); })
        return static_cast<long long>(r);
    else if constexpr (requires { std::get<0>(r); })
        return static_cast<long long>(std::get<0>(r));
    else {
        static_assert(
            requires { static_cast<long long>(r.index); },
            "choose returns an index, a pair or tuple of it and its probability, or a structure "
            "with index and pdf");
        return static_cast<long long>(r.index);
    }
}
template <class R>
auto probability_in(const R& r) {
    if constexpr (requires { std::get<1>(r); })
        return &std::get<1>(r);
    else
        return detail::density_of(r);
}

template <class Choose, class Probability>
auto chooser(Choose& choose, Probability& probability) {
    constexpr size_t M = numbers_of<Choose>();
    using R = decltype(detail::call(choose, Point<M>{}));
    using Said = decltype(detail::probability_in(std::declval<const R&>()));
    return Model<M, 1>{[&choose](const Point<M>& u) -> std::optional<Drawn<1>> {
                           const R r = detail::call(choose, u);
                           Drawn<1> drawn{Point<1>{double(detail::index_in(r))},
                                          std::numeric_limits<double>::quiet_NaN()};
                           if constexpr (found<Said>)
                               drawn.pdf = double(*detail::probability_in(r));
                           return drawn;
                       },
                       [&probability](const Point<1>& i) { return double(probability(int(i[0]))); },
                       found<Said>,
                       false,
                       takes_floats<Choose, M>,
                       unit_of(std::remove_cv_t<std::remove_pointer_t<Said>>{}),
                       unit_of(decltype(probability(0)){})};
}

// A vector of numbers, of a number or a colour.
template <class V>
std::vector<double> channels(const V& v) {
    const auto p = detail::point(v);
    return {p.begin(), p.end()};
}
template <class Sample, size_t M>
std::optional<Brought> brought(Sample& sample, const Point<M>& u) {
    const auto raw = detail::call(sample, u);
    if constexpr (may_fail<std::decay_t<decltype(raw)>>)
        if (!raw) return {};
    const auto& r = detail::arrived(raw);
    const auto& parts = detail::beside(r);
    Brought b{detail::point(detail::point_in(r)), {}, {}, {}};
    if constexpr (has_parts<std::decay_t<decltype(parts)>>) {
        if constexpr (found<decltype(detail::f_of(parts))>)
            b.f = detail::channels(*detail::f_of(parts));
        if constexpr (found<decltype(detail::weight_of(parts))>)
            b.weight = detail::channels(*detail::weight_of(parts));
    }
    if constexpr (found<decltype(detail::unnamed_in(r))>)
        b.unnamed = detail::channels(*detail::unnamed_in(r));
    return b;
}

template <class Sample, class Pdf>
auto model(Sample& sample, Pdf& pdf) {
    constexpr size_t M = numbers_of<Sample>();
    static_assert(
        M > 0 || requires { sample(); },
        "sample takes numbers u, v, ... (in expect_bsdf after wo), one argument made from {u, v, "
        "...}, or nothing; "
        "after random come sample, then pdf");
    using Raw = decltype(detail::call(sample, Point<M>{}));
    using Arrived = std::decay_t<decltype(detail::arrived(std::declval<const Raw&>()))>;
    using V = std::decay_t<decltype(detail::point_in(std::declval<const Arrived&>()))>;
    constexpr bool says_pdf = found<decltype(detail::pdf_in(std::declval<const Arrived&>()))>;
    constexpr size_t N = coordinates_of<V>();
    using T = Coordinate<V>;
    static_assert(
        requires { double(pdf(of_host<V>(Point<N>{}))); },
        "pdf takes the point or direction that sample returns, and returns a number; after random "
        "come sample, then pdf");
    return Model<M, N>{[&sample](const Point<M>& u) -> std::optional<Drawn<N>> {
                           const Raw r = detail::call(sample, u);
                           if constexpr (may_fail<Raw>)
                               if (!r) return {};
                           const auto& here = detail::arrived(r);
                           Drawn<N> drawn{detail::point(detail::point_in(here)),
                                          std::numeric_limits<double>::quiet_NaN()};
                           if constexpr (says_pdf) drawn.pdf = double(*detail::pdf_in(here));
                           return drawn;
                       },
                       [&pdf](const Point<N>& x) { return double(pdf(of_host<V>(x))); },
                       says_pdf,
                       std::is_same_v<T, float>,
                       takes_floats<Sample, M>,
                       unit_of(T{}),
                       unit_of(decltype(pdf(of_host<V>(Point<N>{}))){})};
}

}  // namespace oracle::detail
// oracle/hints.h  from the facts that a check found to "looks like ...": nothing here decides
// whether it passes

namespace oracle::detail {

// Numbers of this file decide what is said, and not what passes.  They were chosen on the rounds of
// fresh mistakes of reference/oracle.md: a wider one would name what another mistake explains.
inline constexpr double to_name = 0.003;     // the nearest two names, 3/2 and pi/2, are 5 % apart
inline constexpr double to_agree = 0.01;     // ratios with one law: floats, differences
inline constexpr double of_law = 0.95;       // the part of them that must have it
inline constexpr size_t fewest_points = 50;  // for a law: one that holds by chance has few points

// ---- Numbers and causes by name -----------------------------------------------------------------

// The number in words, if it is one of those that are forgotten.
inline std::string constant_named(double x, double tolerance) {
    static constexpr std::pair<double, const char*> wholes[] = {
        {2, "2, twice"}, {0.5, "1/2, half"}, {4, "4, four times"}, {0.25, "1/4"}};
    static constexpr std::pair<double, const char*> others[] = {
        {pi, "pi"},
        {1 / pi, "1/pi"},
        {2 * pi, "2 pi"},
        {0.5 / pi, "1/(2 pi)"},
        {4 * pi, "4 pi"},
        {0.25 / pi, "1/(4 pi)"},
        {pi / 2, "pi/2"},
        {2 / pi, "2/pi"},
        {2.0 / 3, "2/3"},
        {1.5, "3/2"},
        {1.0 / 3, "1/3"},
        {0.75, "3/4"},
        {4.0 / 3, "4/3"},
        {std::numbers::sqrt2, "the root of 2"},
        {1 / std::numbers::sqrt2, "1 over the root of 2"}};
    for (const auto& [value, name] : wholes)
        if (std::abs(x / value - 1) <= std::min(tolerance, 0.02)) return name;
    for (const auto& [value, name] : others)
        if (tolerance <= 0.005 && std::abs(x / value - 1) <= tolerance) return name;
    return "";
}
inline std::string times(double x, double tolerance) {
    const std::string name = constant_named(x, tolerance);
    return say("%.4g", x) + (name.empty() ? "" : " (" + name + ")");
}

// Why something is off by the power k of a factor.
inline std::string cause_of_power(const std::string& name, double k, const std::string& where) {
    return k == 1    ? "a factor " + name + " too many" + where + ", or 1/(" + name + ") forgotten"
           : k == -1 ? name + " forgotten" + where + ", or divided by twice"
           : k == 2  ? "multiplied by " + name + " in place of divided" + where
           : k == -2 ? "divided by " + name + " in place of multiplied" + where
           : std::abs(k) < 1 ? "a root of " + name
                             : "";
}

// Why an estimate may be `ratio` times the truth, known within `tolerance`: the causes that explain
// it, unless there are many.  2 and 1/2 have too many: counted twice, a choice not divided by, a
// half domain.
inline std::string cause_of(double ratio, double tolerance, const std::vector<Factor>& factors) {
    if (!(tolerance < 0.05)) return "";
    const double close = std::clamp(tolerance, 1e-9, 0.02);
    std::vector<std::string> causes;
    auto may_be = [&](double x, const std::string& cause) {
        if (std::abs(ratio / x - 1) <= close) causes.push_back(cause);
    };
    for (const Factor& f : factors) {
        const double x = f.at({});
        if (std::abs(x - 1) <= 3 * close || !(std::abs(x) > 0)) continue;
        for (double k : {-1.0, 1.0, -2.0, 2.0, 0.5, -0.5})
            may_be(std::pow(x, k), cause_of_power(f.name, k, ""));
        may_be(x / (1 - x), "divided by 1 - " + f.name + " in place of " + f.name);
        may_be((1 - x) / x, "multiplied by 1 - " + f.name + " in place of " + f.name);
    }
    may_be(pi, "1/pi forgotten (an albedo is not a BRDF)");
    may_be(1 / pi, "divided by pi twice, or pi forgotten");
    for (double k : {2.0, 4.0}) {
        may_be(k * pi, say("1/(%g pi) forgotten", k));
        may_be(1 / (k * pi), say("%g pi forgotten, or divided by it twice", k));
    }
    may_be(-1, "the sign reversed");
    if (causes.empty() || causes.size() > 3) return "";
    std::string text = "; looks like " + causes[0];
    for (size_t i = 1; i < causes.size(); ++i) text += "; or " + causes[i];
    return text;
}

// Products of two factors that explain a ratio; if none or many do, the experiment that would.
inline std::string combined(double ratio, double tolerance, const std::vector<Factor>& factors) {
    std::string cause;
    size_t causes = 0;
    for (size_t i = 0; i < factors.size(); ++i)
        for (size_t j = i + 1; j < factors.size(); ++j)
            for (const double k : {1.0, -1.0})
                for (const double l : {1.0, -1.0}) {
                    const double x =
                        std::pow(factors[i].at({}), k) * std::pow(factors[j].at({}), l);
                    if (std::abs(ratio / x - 1) > std::min(tolerance, 0.02)) continue;
                    ++causes;
                    cause = "; looks like " + factors[i].name +
                            (k > 0 ? " too many" : " forgotten") + ", and " + factors[j].name +
                            (l > 0 ? " too many" : " forgotten");
                }
    if (causes == 1) return cause;
    if (causes > 1)
        return "; several pairs of factors explain it: choose a configuration where they differ";
    return std::string(factors.empty() ? "; name the formula's factors (.factors), or make"
                                       : "; no factor alone, nor two: make") +
           " the integrand constant: a ratio that stays is a constant";
}

inline std::string mean_hint(const Estimate& e, double truth, const std::vector<Factor>& factors) {
    const double ratio = e.mean / truth, within = 5 * e.standard_error / std::abs(e.mean);
    if (within >= 1) return "; 0 within its error";
    const std::string name = times(ratio, within), cause = cause_of(ratio, within, factors);
    std::string text = "; ratio " + name + (ratio < 0 ? ", of the wrong sign" : "") + cause;
    const double off = e.mean - truth;
    for (const Factor& f : factors)
        if (const double x = f.at({}); cause.empty() && std::abs(std::abs(off / x) - 1) < to_agree)
            return text + say("; off by %.4g: looks like ", off) + f.name +
                   (off * x < 0 ? " not added, or taken off twice" : " added twice");
    // n / (n + 1), or its inverse.
    const double less = std::min(ratio, 1 / ratio), count = less / (1 - less),
                 n = std::round(count), known = within * count / (1 - less);
    if (!cause.empty() || name.back() == ')') return text;
    if (n < 5 || known >= 0.25 || std::abs(count - n) >= known)
        return text + combined(ratio, within, factors);
    return text + say(", %.0f/%.0f: a count that is off by one?", ratio < 1 ? n : n + 1,
                      ratio < 1 ? n + 1 : n);
}

// ---- The mistake behind a density ---------------------------------------------------------------

// The cosine to an axis.
template <size_t N>
double along(const Point<N>& x, const Triple& axis) {
    double sum = 0;
    for (size_t k = 0; k < std::min<size_t>(3, N); ++k) sum += x[k] * axis[k];
    return std::abs(sum);
}

// A function of the place that pdfs or samplers are known to forget.
template <size_t N>
struct Base {
    std::string name;
    std::function<double(const Point<N>&)> at;
    bool of_host = false;    // one of Options::factors
    std::string drawn = {};  // why a pdf that integrates to 1 may be off by
    double power = 1;        // this power of it
    bool cosine = false;
};

template <size_t N>
std::vector<Base<N>> bases_of(const Options& o, const Scene<N>& scene) {
    using X = const Point<N>&;
    std::vector<Base<N>> bases;
    for (const Factor& f : o.factors)
        bases.push_back({f.name,
                         [&f](X x) {
                             Triple three{};
                             std::copy_n(x.begin(), std::min<size_t>(3, N), three.begin());
                             return f.at(three);
                         },
                         true});
    if (scene.directions) {
        const Triple n = scene.normal, lobe = scene.lobe;
        bases.push_back({"cos(theta)", [=](X w) { return along(w, n); }, false, "", 1, true});
        bases.push_back(
            {"sin(theta)",
             [=](X w) { return std::sqrt(std::max(0.0, 1 - std::pow(along(w, n), 2))); }, false,
             "theta drawn uniformly, or r = u without its square root: samples lack a "
             "factor sin(theta)"});
        if (dot(n, lobe) < 0.999)
            bases.push_back({"the cosine to the lobe's axis", [=](X w) { return along(w, lobe); },
                             false, "", 1, true});
        bases.push_back({"max(|x|, |y|, |z|)",
                         [](X w) {
                             double most = 0;
                             for (double x : w) most = std::max(most, std::abs(x));
                             return most;
                         },
                         false, "points of a cube, normalised without rejection", 3});
        return bases;
    }
    for (size_t k = 0; k < std::min<size_t>(3, N); ++k) {
        const std::string x(1, "xyz"[k]);
        bases.push_back({x, [k](X p) { return std::abs(p[k]); }, false,
                         x + " drawn uniformly, without its root"});
    }
    if (N > 1)
        bases.push_back({"r",
                         [](X x) {
                             double square = 0;
                             for (double c : x) square += c * c;
                             return std::sqrt(square);
                         },
                         false, "r drawn uniformly, without its root"});
    return bases;
}

// A constant that 95 % of these ratios have, within `tolerance`.
struct Law {
    double factor = 0;
    bool holds = false;
    bool plain(double tolerance) const { return holds && std::abs(factor - 1) <= tolerance; }
};
inline Law law_of(const std::vector<double>& ratios, double tolerance) {
    Law law{median(ratios)};
    size_t near = 0;
    for (double r : ratios) near += std::abs(r / law.factor - 1) <= tolerance;
    law.holds = law.factor > 0 && double(near) >= of_law * double(ratios.size());
    return law;
}

inline std::string power(const std::string& name, double k) {
    return k == 1 ? name : name + (k == 0.5 ? "^(1/2)" : k == -0.5 ? "^(-1/2)" : say("^%.3g", k));
}
// A factor times something; no factor if it is 1.
inline std::string factor_and(double factor, double tolerance, const std::string& what) {
    return (std::abs(factor - 1) <= tolerance ? "" : times(factor, to_name) + " ") + what;
}

// In words, why p / q is the power k of a base: normalised is whether the pdf integrates to 1.
template <size_t N>
std::string cause_of_base(const Base<N>& b, double k, bool normalised) {
    if (b.of_host) return cause_of_power(b.name, k, " in the pdf");
    if (normalised && b.cosine && k == -2)
        return "the normal plus a point in the ball, for one on the sphere (or an exponent)";
    if (normalised || b.power != 1) return k == b.power ? b.drawn : "";
    return b.name == "sin(theta)" && k == 1
               ? "a density per (theta, phi), not per solid angle"
               : "a factor " + b.name + (k > 0 ? " too many" : " missing") + " in the pdf";
}

// Linear equations by Gauss and Jordan; NaN if they have no solution.
template <size_t R>
std::array<double, R> solved(std::array<std::array<double, R + 1>, R> rows) {
    std::array<double, R> x;
    for (size_t c = 0; c < R; ++c) {
        for (size_t r = c + 1; r < R; ++r)
            if (std::abs(rows[r][c]) > std::abs(rows[c][c])) std::swap(rows[r], rows[c]);
        for (size_t r = 0; r < R; ++r) {
            const double by = r == c ? 0 : rows[r][c] / rows[c][c];
            for (size_t k = c; k <= R && r != c; ++k) rows[r][k] -= by * rows[c][k];
        }
    }
    for (size_t r = 0; r < R; ++r) x[r] = rows[r][R] / rows[r][r];
    return x;
}

// Mirror images about a centre.
template <size_t N>
using Map = std::function<Point<N>(const Point<N>&)>;
struct Mirror {
    const char* name;
    std::array<size_t, 3> from;
    double x = 1, y = 1, z = 1;  // signs

    template <size_t N>
    std::optional<Map<N>> about(const Point<N>& centre) const {
        const Triple sign{x, y, z};
        for (size_t k = N; k < 3; ++k)
            if (from[k] != k || sign[k] != 1) return {};
        if constexpr (N <= 3)
            return [=, order = from](const Point<N>& p) {
                Point<N> image;
                for (size_t k = 0; k < N; ++k)
                    image[k] = centre[k] + sign[k] * (p[order[k]] - centre[order[k]]);
                return image;
            };
        return {};
    }
};
inline constexpr Mirror mirrors[] = {
    {"z negated", {0, 1, 2}, 1, 1, -1}, {"x negated", {0, 1, 2}, -1, 1, 1},
    {"y negated", {0, 1, 2}, 1, -1, 1}, {"the direction negated", {0, 1, 2}, -1, -1, -1},
    {"x and z exchanged", {2, 1, 0}},   {"y and z exchanged", {0, 2, 1}},
    {"x and y exchanged", {1, 0, 2}},
};
// The first mirror image of the pdf that fits, in words.
template <size_t N>
std::string mirror_that(const Point<N>& centre, const auto& fits) {
    for (const Mirror& m : mirrors)
        if (const auto image = m.about(centre); image && fits(*image))
            return std::string("samples have the density of the pdf with ") + m.name +
                   ": looks like " + m.name + " in one of the two";
    return "";
}

// Why a pdf may be a constant of this name times the density.
inline std::string normalisation_hint(const std::string& name) {
    if (name == "pi" || name == "2 pi" || name == "4 pi")
        return "; looks like 1/" + (name == "pi" ? name : "(" + name + ")") + " forgotten";
    return ": a constant factor, its normalisation";
}

// The mistake, by the sheets of a map, the integral of the pdf and its symmetries: a fact, then
// "looks like" and a cause where one explains all of it.
template <size_t N>
struct Mistake {
    using X = const Point<N>&;
    const std::function<double(X)>& pdf;
    const Scene<N>& scene;
    bool single;
    double unit;   // of rounding
    double total;  // integral of the pdf
    double share;  // of the samples that failed
    std::vector<Base<N>> bases;
    std::vector<Local<N>> sheets = {};  // where the map is one-to-one about u,
    std::vector<Local<N>> good = {};    // and the pdf positive: of these
    std::vector<double> ratios = {};    // p / q
    double tolerance = 0;
    bool normalised = false;

    // The first that explains it; or nothing.
    std::string name(const std::vector<Local<N>>& all) {
        if (const std::string why = degenerate(all); !why.empty()) return why;
        std::vector<double> errors;
        for (const Local<N>& l : all)
            if (l.q < infinity && l.p >= 0 && l.collapse > 1e-7)
                sheets.push_back(l), errors.push_back(l.error);
        if (sheets.size() < fewest_sheets) return "";
        tolerance = std::min(0.05, std::max(single ? to_agree : 1e-4, 4 * median(errors)));
        // At a kink of the map differences are less exact.
        for (const Local<N>& l : sheets)
            if (l.p > 0 && l.error <= tolerance) good.push_back(l), ratios.push_back(l.product());
        normalised = std::abs(total + share - 1) < close();
        const bool many = good.size() >= fewest_points;
        if (const Law law = law_of(ratios, tolerance); many && law.holds)
            return constant(law.factor);
        for (auto step : {&Mistake::power_law, &Mistake::exponent, &Mistake::two_powers,
                          &Mistake::symmetry, &Mistake::linear, &Mistake::moved, &Mistake::slopes,
                          &Mistake::power_of_density, &Mistake::steps, &Mistake::which_is_uniform})
            if (many || step == &Mistake::symmetry || step == &Mistake::moved)
                if (const std::string why = (this->*step)(); !why.empty()) return why;
        return "";
    }

    // The error of the integral and of the failed part, together.
    double close() const { return std::max(share > 0 ? 0.01 : 1e-3, tolerance); }

    std::string degenerate(const std::vector<Local<N>>& all) const {
        unsigned still = ~0u;
        size_t collapsed = 0, same = 0;
        for (const Local<N>& l : all) {
            still &= l.still;
            collapsed += l.collapse < (single ? 1e-3 : 1e-7);
            same += l.x == all[0].x;
        }
        if (all.size() < fewest_sheets) return "";
        if (same == all.size()) return "samples are all the same, " + say_point(all[0].x);
        if (still != 0)
            return say(
                "samples do not depend on number %d of those they are made from: looks like "
                "one number used for both, or one ignored",
                std::countr_zero(still) + 1);
        return double(collapsed) < 0.95 * double(all.size())
                   ? ""
                   : "all samples lie on a line: looks like one number used for both";
    }

    // p = c q wherever samples come.
    std::string constant(double c) const {
        if (std::abs(c - 1) <= tolerance && share > 0.02 && std::abs(total - 1) < close())
            return "the pdf is right where samples come, but " + percent(share) +
                   " of them fail, and it integrates to 1 as if none did";
        if (std::abs(c - 1) <= tolerance)
            return total + share > 1 + close() &&
                           *std::max_element(ratios.begin(), ratios.end()) <= c + 3 * tolerance
                       ? "the pdf is right for nearly all samples, but also positive where " +
                             (where_none().empty() ? "hardly any comes, or too large there"
                                                   : "none comes" + where_none()) +
                             ": it integrates to " + times(total, tolerance)
                       : "";
        if (c > 1 && share > 0.02 && std::abs(1 / c + share - 1) < close() &&
            std::abs(total - 1) < close())
            return percent(share) + " of the samples come where the pdf is 0, and the others are " +
                   times(1 / c, to_name) +
                   " times as dense as it says: looks like samples of a larger domain than the "
                   "pdf's";
        if (c < 1 && std::abs(total + share - 1) < (1 - c) / 3)
            return "samples are " + times(1 / c, to_name) +
                   " times as dense as the pdf says wherever they come" + where_none() +
                   (where_none().empty() && angle_of_none() > 0
                        ? say("; of these none is beyond %.2g degrees from their axis, where the "
                              "pdf is "
                              "positive: looks like the angle of a cone",
                              angle_of_none() * 180 / pi)
                        : "; looks like a gap: part of the domain (half of it? of phi?) "
                          "never sampled");
        if (std::abs(total / c + share - 1) > close()) return "";
        std::string cause;
        for (const Base<N>& b : bases) {
            std::vector<double> f;
            for (const Local<N>& l : good) f.push_back(b.at(l.x));
            const Law law = law_of(f, 1e-6);
            if (!b.of_host || !law.holds || law.plain(tolerance)) continue;
            for (double k : {-1.0, 1.0})
                if (std::abs(c / std::pow(law.factor, k) - 1) <= tolerance)
                    cause += (cause.empty() ? "; looks like " : " or ") +
                             cause_of_power(b.name, k, " in the pdf");
        }
        if (cause.empty()) cause = normalisation_hint(constant_named(c, to_name));
        // The cosine of a cone so narrow has no more digits.
        std::vector<double> heights;
        for (const Local<N>& l : good) heights.push_back(l.p);
        if (single && std::abs(c - 1) < 2 * pi * unit * median(heights)) cause += if_double;
        return "the pdf is " + times(c, to_name) + " times the density of the samples, everywhere" +
               cause;
    }

    // On which side of a plane through the origin no sample comes, where the pdf is positive.
    std::string where_none() const {
        for (size_t k = 0; k < N && scene.directions; ++k)
            for (double sign : {1.0, -1.0}) {
                size_t beyond = 0, positive = 0;
                for (const Local<N>& l : sheets) {
                    auto mirrored = l.x;
                    mirrored[k] = -mirrored[k];
                    beyond += sign * l.x[k] < 0;
                    positive += pdf(mirrored) > 0;
                }
                if (beyond == 0 && positive > sheets.size() / 2)
                    return say(": no sample has %c %c 0", "xyz"[k % 3], sign > 0 ? '<' : '>') +
                           (std::abs(scene.normal[k % 3]) > 0.99 ? ", below the horizon" : "");
            }
        return "";
    }

    // The angle from the lobe's axis beyond which no sample comes, though the pdf is positive a
    // tenth further all around; 0 if there is none.
    double angle_of_none() const {
        if constexpr (N == 3) {
            double most = 0;
            for (const Local<N>& l : good)
                most = std::max(most, std::acos(std::min(1.0, dot(l.x, scene.lobe))));
            size_t positive = 0;
            for (const Local<N>& l : good) {
                const double c = dot(l.x, scene.lobe), s = std::sqrt(std::max(1e-12, 1 - c * c));
                Triple w;
                for (size_t k = 0; k < 3; ++k)
                    w[k] = std::cos(1.1 * most) * scene.lobe[k] +
                           std::sin(1.1 * most) * (l.x[k] - c * scene.lobe[k]) / s;
                positive += pdf(w) > 0;
            }
            if (scene.directions && most<0.9 * pi&& double(positive)> 0.99 * double(good.size()))
                return most;
        }
        return 0;
    }

    std::string over(double factor, const std::string& what) const {
        return "pdf / density of the samples = " + factor_and(factor, tolerance, what);
    }
    // p / q over f(x).
    Law law_over(const auto& f) const {
        std::vector<double> rest;
        for (size_t i = 0; i < good.size(); ++i) rest.push_back(ratios[i] / f(good[i].x));
        return law_of(rest, tolerance);
    }

    // p / q = c b^k.  One without a constant goes before those with one, one that the host named
    // before others.
    std::string power_law() const {
        const Base<N>* b = nullptr;
        double k = 0, factor = 0;
        int rank = 4;
        size_t fits = 0;
        for (const double power : {1.0, -1.0, 2.0, -2.0, 3.0, -3.0, 0.5, -0.5})
            for (const Base<N>& base : bases) {
                const Law law = law_over([&](X x) { return std::pow(base.at(x), power); });
                const int r = 2 * !law.plain(tolerance) + !base.of_host;
                fits += law.holds;
                if (law.holds && r < rank) b = &base, k = power, factor = law.factor, rank = r;
            }
        if (!b) return "";
        const std::string uniform = which_is_uniform();
        // With a constant left over, a named factor is one of several that vary alike; nor is it
        // all with a cosine: a distance may be 1 / cos(theta).
        const bool unsure = rank >= 2 && (b->of_host ? fits > 1 : b->cosine);
        const bool exponents = normalised && rank >= 2 && uniform.empty() && !b->of_host &&
                               b->power == 1 && b->name != "sin(theta)";
        const std::string cause = exponents ? "an exponent in one of the two"
                                  : unsure  ? ""
                                            : cause_of_base(*b, k, normalised);
        return over(factor, power(b->name, k)) + (cause.empty() ? "" : ": looks like " + cause) +
               (uniform.empty() ? "" : "; " + uniform);
    }
    // Any other power, of a cosine: by least squares of the logarithms.
    std::string exponent() const {
        for (const Base<N>& b : bases) {
            if (!b.cosine) continue;
            double n = 0, x = 0, y = 0, xx = 0, xy = 0;
            for (size_t i = 0; i < good.size(); ++i) {
                const double s = std::log(b.at(good[i].x)), t = std::log(ratios[i]);
                ++n, x += s, y += t, xx += s * s, xy += s * t;
            }
            const double k = (n * xy - x * y) / (n * xx - x * x);
            std::vector<double> rest;
            for (size_t i = 0; i < good.size(); ++i)
                rest.push_back(ratios[i] / std::pow(b.at(good[i].x), k));
            const double known = of_axis(b.name == "cos(theta)" ? scene.normal : scene.lobe);
            const Law law = law_of(rest, known);
            if (law.holds && std::abs(k) > 0.01 + known)
                return over(law.factor, power(b.name, k)) +
                       (normalised ? ": looks like an exponent in one of the two" : "");
        }
        return "";
    }
    // The lobe's axis is the mean of 4096 samples: ratios near its rim are off by 6 % (measured
    // with a cosine about it).
    double of_axis(const Triple& axis) const {
        return axis == scene.normal ? tolerance : std::max(tolerance, 0.06);
    }
    // p = c q^k
    std::string power_of_density() const {
        for (const double k : {0.5, 2.0, -1.0}) {
            std::vector<double> rest;
            for (const Local<N>& l : good) rest.push_back(l.p / std::pow(l.q, k));
            if (const Law law = law_of(rest, tolerance); law.holds)
                return say("the pdf is %.4g times the density of the samples", law.factor) +
                       (k < 0
                            ? " inverted: looks like a Jacobian upside down"
                            : (k == 2 ? " squared: looks like "
                                      : " to the power 1/2: looks like ") +
                                  std::string(
                                      normalised ? "an exponent or sharpness that is twice, or half"
                                      : k == 2   ? "a square too many in the pdf"
                                                 : "a square forgotten in the pdf"));
        }
        return "";
    }
    // Either may be the wrong one of two.
    std::string which_is_uniform() const {
        std::vector<double> p, q;
        for (const Local<N>& l : good) p.push_back(l.p), q.push_back(l.q);
        return law_of(p, tolerance).holds   ? "the pdf is uniform, samples are not"
               : law_of(q, tolerance).holds ? "samples are uniform, the pdf is not"
                                            : "";
    }
    std::string two_powers() const {
        for (const double j : {1.0, -1.0, 2.0, -2.0})
            for (const double k : {1.0, -1.0, 2.0, -2.0})
                for (const Base<N>& a : bases)
                    for (const Base<N>& b : bases) {
                        if (&a >= &b || !a.of_host) continue;
                        const Law law = law_over(
                            [&](X x) { return std::pow(a.at(x), j) * std::pow(b.at(x), k); });
                        if (law.plain(tolerance) ||
                            (law.holds && !constant_named(law.factor, to_name).empty()))
                            return over(law.factor, power(a.name, j) + " " + power(b.name, k)) +
                                   ": looks like " + a.name + (j > 0 ? " too many" : " forgotten") +
                                   ", and " + b.name + (k > 0 ? " too many" : " forgotten") +
                                   ", in the pdf";
                    }
        return "";
    }

    // A power k of p / q, times a power j of a cosine, is a linear function a x + b: the cosine to
    // a direction that nobody named, the square of a half vector's cosine, a factor that a warp
    // lacks.  By least squares.
    std::string linear() const {
        const std::pair<double, double> powers[] = {{1, 0},  {1, 1},   {1, -1}, {-1, 0},
                                                    {-1, 1}, {-1, -1}, {2, 0},  {-2, 0}};
        for (const auto& [k, j] : powers) {
            const bool square = std::abs(k) == 2;
            if (!scene.directions && (j != 0 || square)) continue;
            const double one = scene.directions && !square ? 0 : 1;
            std::array<std::array<double, N + 2>, N + 1> rows{};
            std::vector<double> left;
            for (size_t i = 0; i < good.size(); ++i) {
                X x = good[i].x;
                left.push_back(std::pow(ratios[i] * std::pow(along(x, scene.normal), j), k));
                std::array<double, N + 2> row;
                std::copy(x.begin(), x.end(), row.begin());
                row[N] = one, row[N + 1] = left[i];
                for (size_t r = 0; r <= N; ++r)
                    for (size_t c = 0; c <= N + 1; ++c)
                        rows[r][c] += row[r] * row[c] / (left[i] * left[i]);
            }
            rows[N][N] += 1 - one;
            const auto a = solved(rows);
            std::vector<double> rest;
            for (size_t i = 0; i < good.size(); ++i) {
                double sum = a[N];
                for (size_t c = 0; c < N; ++c) sum += a[c] * good[i].x[c];
                rest.push_back(left[i] / sum);
            }
            // In a small domain everything is linear.
            const double spread = median(left, 0.95) / median(left, 0.05);
            if (spread > (square ? 1.5 : 1) + 30 * tolerance &&
                law_of(rest, tolerance).plain(tolerance))
                return words_of(a, j, k);
        }
        return "";
    }
    std::string words_of(const std::array<double, N + 1>& a, double j, double k) const {
        double length = 0;
        for (size_t c = 0; c < N; ++c) length += a[c] * a[c];
        length = std::sqrt(length);
        Point<N> n;
        for (size_t c = 0; c < N; ++c) n[c] = a[c] / length;
        const std::string cosine = "the cosine to " + say_point(n);
        const char* fate = k > 0 ? " too many in the pdf" : " forgotten in the pdf";
        // |w + wo|^2 = 2 (1 + w.wo) = 4 (wo.h)^2
        if (std::abs(k) == 2)
            return std::abs(a[N] / length - 1) > 0.02
                       ? ""
                       : over(std::pow(2 * length, 1 / k) / std::pow(4, 2 / k),
                              power("(4 wo.h)", k / 2)) +
                             " with wo = " + say_point(n) +
                             ": looks like 4 wo.h of the half vector" + fate +
                             (k < 0 ? ", or divided by twice" : "");
        if (scene.directions)
            return over(std::pow(length, k), power("(" + cosine + ")", k)) +
                   (j == 0 ? "" : " " + power("cos(theta)", -j)) + ": looks like " + cosine + fate +
                   (j == 0 ? "" : ", or taken to another normal");
        std::string sum;
        for (size_t c = 0; c <= N; ++c) {
            if (std::abs(a[c]) < 0.01 * std::hypot(length, a[N])) continue;
            sum += sum.empty() ? (a[c] < 0 ? "-" : "") : a[c] < 0 ? " - " : " + ";
            sum += say("%.3g", std::abs(a[c])) + (c < N ? say(" %c", "xyz"[c % 3]) : "");
        }
        return over(1, power("(" + sum + ")", k)) +
               (normalised && k > 0
                    ? ": looks like a number that is not warped, or without its root"
                    : "");
    }

    // Samples have the density of the pdf of a mirror image.
    std::string symmetry() const {
        const std::string why = mirror_that(scene.centre, [&](const Map<N>& image) {
            return law_of_image(image, 1).plain(tolerance);
        });
        const bool below = scene.directions && scene.normal[2] == 1;
        return why + (below && why.find("z negated") < why.size() ? ", below the horizon" : "");
    }
    Law law_of_image(const Map<N>& image, double stretch) const {
        std::vector<double> turned, heights;
        size_t exact = 0;
        for (const Local<N>& l : sheets) {
            if (l.error > tolerance) continue;
            ++exact;
            if (const double p = pdf(image(l.x)); p > 0)
                turned.push_back(p / l.q / stretch), heights.push_back(p);
        }
        // A uniform density has every scale.
        if (law_of(heights, tolerance).holds) return {};
        if (double(turned.size()) < 0.9 * std::min(1.0, total) * double(exact)) return {};
        return law_of(turned, tolerance);
    }

    // Samples have the density of the pdf stretched about 0, or moved along a coordinate.
    std::string moved() const {
        if (sheets.empty()) return "";
        if constexpr (N == 3)
            for (size_t k = 0; k < 3 && scene.directions; ++k) {
                auto turned = [k](double by) {
                    return [=, c = std::cos(by), s = std::sin(by)](Point<N> x) {
                        double &a = x[(k + 1) % 3], &b = x[(k + 2) % 3];
                        const double turned_a = c * a + s * b;
                        b = c * b - s * a, a = turned_a;
                        return x;
                    };
                };
                if (const double by = fitted(pi, 0.002, 0, turned); by != 0)
                    return say(
                        "samples have the density of the pdf turned by %.4g degrees about "
                        "%c: looks like %s",
                        by * 180 / pi, "xyz"[k],
                        k == 2 ? "an offset of phi, or an index that is off" : "another axis");
            }
        if (scene.directions) return "";
        auto stretched = [](double by) {
            return [by](Point<N> x) {
                for (double& c : x) c /= std::exp(by);
                return x;
            };
        };
        if (const double by = fitted(3, 1e-3, double(N), stretched); by != 0)
            return "samples have the density of the pdf, " + times(std::exp(by), 0.004) +
                   " times as wide: looks like their scale";
        for (size_t k = 0; k < N; ++k) {
            std::vector<double> x;
            for (const Local<N>& l : sheets) x.push_back(l.x[k]);
            const double width = median(x, 0.95) - median(x, 0.05);
            auto shifted = [k](double d) {
                return [k, d](Point<N> p) {
                    p[k] -= d;
                    return p;
                };
            };
            if (const double d = fitted(width, 0.01 * width, 0, shifted); d != 0)
                return "samples have the density of the pdf moved by " + say("%.4g", d) +
                       (N == 1 ? "" : say(" along %c", "xyz"[k % 3])) +
                       ": looks like an offset, or an index that is off by one";
        }
        return "";
    }
    // The b between -most and most for which samples have the density of the pdf at image(b),
    // stretched exp(power b) times; 0 if there is none beyond `least`.  On a grid, then by ever
    // smaller steps.
    double fitted(double most, double least, double power,
                  const std::function<Map<N>(double)>& image) const {
        // The mean distance of the two, where the pdf is not 0.
        auto apart = [&](double b) {
            const Map<N> map = image(b);
            double sum = 0, n = 0;
            for (const Local<N>& l : sheets)
                if (const double p = pdf(map(l.x)) / std::exp(power * b); p > 0)
                    sum += std::min(0.3, std::abs(std::log(p / l.q))), ++n;
            return n < 0.4 * double(sheets.size()) ? 1 : sum / n;
        };
        double best = 0, nearest = infinity;
        for (double step = most / 100; step > 2e-7 * most; step /= 2) {
            const int reach = nearest == infinity ? 100 : 1;
            const double middle = best;
            for (int i = -reach; i <= reach; ++i)
                if (const double b = middle + i * step, d = apart(b); d < nearest)
                    nearest = d, best = b;
        }
        const bool plain = law_of_image(image(best), std::exp(power * best)).plain(tolerance);
        return plain && std::abs(best) > least ? best : 0;
    }

    // Samples have the density of the pdf whose slopes tan(theta) about the normal, or the lobe's
    // axis, are stretched: another roughness.
    std::string slopes() const {
        if constexpr (N == 3)
            for (const Triple& n : {scene.normal, scene.lobe}) {
                if (!scene.directions) break;
                // w' = normalized(c n + t / s), dw' / dw = (c' / c)^3 / s^2
                auto off = [&](const Local<N>& l, double s) {
                    const double c = dot(l.x, n);
                    Triple w;
                    for (size_t k = 0; k < 3; ++k) w[k] = c * n[k] + (l.x[k] - c * n[k]) / s;
                    w = normalized(w);
                    return c > 0 ? pdf(w) * std::pow(dot(w, n) / c, 3) / (s * s * l.q) : 0;
                };
                auto apart = [&](double s) {
                    double sum = 0;
                    for (const Local<N>& l : good)
                        sum += std::min(0.3, std::abs(std::log(off(l, s))));
                    return sum;
                };
                double best = 0, nearest = infinity;
                for (double step = 0.05; step > 1e-6; step /= 2) {
                    const int reach = nearest == infinity ? 60 : 1;
                    const double middle = best;
                    for (int i = -reach; i <= reach; ++i)
                        if (const double b = middle + i * step, d = apart(std::exp(b)); d < nearest)
                            nearest = d, best = b;
                }
                std::vector<double> rest;
                for (const Local<N>& l : good) rest.push_back(off(l, std::exp(best)));
                const double known = of_axis(n);
                if (std::abs(best) > 0.5 * known + 0.01 && law_of(rest, known).plain(known))
                    return "samples have the density of the pdf with slopes tan(theta) " +
                           times(std::exp(best), 0.004) +
                           " times as large: looks like another roughness, its square or root, or "
                           "tangents that are not of length 1";
            }
        return "";
    }

    // Few constant factors, each at many points.
    std::string steps() const {
        std::vector<double> sorted = ratios;
        std::sort(sorted.begin(), sorted.end());
        std::string list;
        size_t values = 0, with = 0;
        for (size_t i = 0, j = 0; i < sorted.size(); i = j) {
            const auto gap = 1 + 4 * tolerance;
            while (j < sorted.size() && (j == i || sorted[j] <= sorted[j - 1] * gap)) ++j;
            const double part = double(j - i) / double(sorted.size());
            if (part < 0.04 || sorted[j - 1] > sorted[i] * gap) continue;
            list += (values++ == 0 ? "" : ", ") + times(sorted[(i + j) / 2], to_name) + " at " +
                    percent(part);
            with += j - i;
        }
        return values >= 2 && values <= 6 && double(with) > 0.9 * double(sorted.size())
                   ? "the pdf is so many times the density of the samples: " + list +
                         " of the points; looks like the probability of a choice (of a part, a "
                         "row, a lobe) or its index"
                   : "";
    }
};

// total: integral of the pdf; share: of the samples that failed.
template <size_t N>
std::string mistake_behind(const std::vector<Local<N>>& all, const auto& model,
                           const Scene<N>& scene, double total, double share, const Options& o) {
    return Mistake<N>{model.pdf, scene, model.single, model.unit, total, share, bases_of(o, scene)}
        .name(all);
}
// The same for the sheets of a check.
std::string explained(const auto& check, const auto& all, double total) {
    const double share = check.none / std::max(1.0, check.samples) + check.o.discrete;
    return mistake_behind(all, check.model, check.scene(), total, share, check.o);
}

// A hint for samples that all come where the pdf is 0.
template <size_t M, size_t N, class Domain>
std::string symmetry_of(DensityCheck<M, N, Domain>& check) {
    if constexpr (M == Domain::dimensions) {
        const auto sheets = sheets_of(check.model, check.random, 1, 0, false);
        const std::string why = explained(check, sheets.all, 1);
        return why.empty() ? "" : "; " + why;
    }
    return "";
}

// The cell whose count is off by most standard errors.
size_t worst_cell(const auto& check) {
    const double n = sum_of(check.counts);
    return worst_of(cell_count, [&](size_t i) {
        const double expected = n * check.expected[i];
        return std::abs(check.counts[i] - expected) / std::sqrt(expected + 1);
    });
}

// In words, whether a ratio of the pdf rises or falls by a tenth or more with the distance from
// the samples' middle, in five groups.
inline std::string width_of(std::vector<std::pair<double, double>> distance_and_ratio) {
    auto& all = distance_and_ratio;
    std::sort(all.begin(), all.end());
    std::vector<double> medians;
    for (size_t group = 0; group < 5; ++group) {
        std::vector<double> ratios;
        for (size_t i = group * all.size() / 5; i < (group + 1) * all.size() / 5; ++i)
            ratios.push_back(all[i].second);
        medians.push_back(median(ratios));
    }
    const bool rises = std::is_sorted(medians.begin(), medians.end());
    if (!(std::abs(medians[4] / medians[0] - 1) >= 0.1) ||
        !(rises || std::is_sorted(medians.rbegin(), medians.rend())))
        return "";
    return std::string(rises ? "wider" : "narrower") + " than the samples";
}

// In words, what alone a ratio at these points depends on: a function of the place, if neighbours
// by it have nearly the same ratios; else the direction in which it grows, if that explains most of
// it.
template <size_t N>
std::string dependence_of(const std::vector<Point<N>>& where, const std::vector<double>& ratios,
                          const Scene<N>& scene, const Options& o) {
    const size_t n = where.size();
    std::vector<std::pair<double, double>> by(n);  // a function's values, and ratios
    const double spread = median(ratios, 0.95) - median(ratios, 0.05);
    for (const Base<N>& b : bases_of(o, scene)) {
        for (size_t i = 0; i < n; ++i) by[i] = {b.at(where[i]), ratios[i]};
        std::sort(by.begin(), by.end());
        std::vector<double> steps;
        for (size_t i = 1; i < n; ++i) steps.push_back(std::abs(by[i].second - by[i - 1].second));
        if (median(steps, 0.75) < 0.04 * spread)
            return ", by a function of " + b.name +
                   say(" alone: %.3g at %.3g, %.3g at %.3g, %.3g at %.3g", by[n / 20].second,
                       by[n / 20].first, by[n / 2].second, by[n / 2].first,
                       by[n - 1 - n / 20].second, by[n - 1 - n / 20].first);
    }
    std::array<std::array<double, N + 2>, N + 1> rows{};  // least squares: a x + b
    double mean = 0, square = 0, left = 0;
    for (size_t i = 0; i < n; ++i) {
        std::array<double, N + 2> row;
        std::copy(where[i].begin(), where[i].end(), row.begin());
        row[N] = 1, row[N + 1] = ratios[i];
        mean += ratios[i] / double(n);
        for (size_t r = 0; r <= N; ++r)
            for (size_t c = 0; c <= N + 1; ++c) rows[r][c] += row[r] * row[c];
    }
    const auto a = solved(rows);
    double length = 0;
    for (size_t i = 0; i < n; ++i) {
        double fit = a[N];
        for (size_t k = 0; k < N; ++k) fit += a[k] * where[i][k];
        square += std::pow(ratios[i] - mean, 2), left += std::pow(ratios[i] - fit, 2);
    }
    Point<N> towards{};
    for (size_t k = 0; k < N; ++k) length += a[k] * a[k];
    for (size_t k = 0; k < N; ++k)
        towards[k] = std::round(1e4 * a[k] / std::sqrt(length)) / 1e4 + 0.0;
    if (N == 1 || !(left < 0.5 * square)) return "";
    return ", larger towards " + say_point(towards) + " and smaller on the other side";
}

// The pdf beside the density of the samples, where their map tells it.
std::string compared(const auto& check) {
    const auto scene = check.scene();
    std::vector<double> ratios;
    std::vector<decltype(scene.middle)> where;
    std::vector<std::pair<double, double>> by_distance;
    for (const auto& l : check.sheets.all)
        if (l.p > 0 && l.q < infinity && l.error < 0.05) {
            ratios.push_back(l.product());
            where.push_back(l.x);
            by_distance.emplace_back(scene.distance(l.x), l.product());
        }
    if (ratios.size() < fewest_points) return "";
    const double low = median(ratios, 0.05), high = median(ratios, 0.95);
    if (high - low < 0.02)
        return "the pdf is " + times(median(ratios), 0.01) +
               " times the density of nearly all samples, but ";
    const std::string law = dependence_of(where, ratios, scene, check.o),
                      width = width_of(by_distance);
    return say("the pdf is %.3g to %.3g times the density of the samples (median %.3g)", low, high,
               median(ratios)) +
           (width.empty() ? "" : ", " + width) +
           (width.empty() || law.find(" alone") < law.size() ? law : "") + "; ";
}

// The ratio of two pdfs at these points: a constant, or one and a power of a base.
template <size_t N>
std::string law_of_pdfs(const Scene<N>& scene, const Options& o, const std::vector<double>& ratios,
                        const std::vector<Point<N>>& where) {
    if (const Law law = law_of(ratios, to_agree); law.holds) return times(law.factor, to_name);
    for (const double k : {1.0, -1.0})
        for (const Base<N>& b : bases_of(o, scene)) {
            std::vector<double> rest;
            for (size_t i = 0; i < where.size(); ++i)
                rest.push_back(ratios[i] / std::pow(b.at(where[i]), k));
            if (const Law law = law_of(rest, to_agree); law.holds)
                return factor_and(law.factor, to_agree, power(b.name, k));
        }
    return "";
}

// The counts follow the pdf times a power of a base, or one of its mirror images.
template <size_t N>
std::string law_that(const Scene<N>& scene, const Options& o, bool normalised,
                     const auto& fits_times, const auto& fits_image) {
    for (const double k : {1.0, -1.0, 2.0, -2.0, -3.0})
        for (const Base<N>& b : bases_of(o, scene))
            if (fits_times([&](const Point<N>& x) { return std::pow(b.at(x), k); })) {
                const std::string cause = cause_of_base(b, -k, normalised);
                return "samples have the density of the pdf times " + power(b.name, k) +
                       (cause.empty() ? "" : ": looks like " + cause);
            }
    return mirror_that(scene.centre, fits_image);
}
inline bool follow(const std::vector<double>& counts, const auto& parts) {
    if (!(parts.total > 0 && std::isfinite(parts.total))) return false;
    const CountsFit fit = fit_counts(counts, parts.shares(), parts.variances(), 0);
    return fit.p > 1e-3 && fit.fewest >= fewest_in_cell;
}
// For samplers without a smooth map.
template <size_t M, size_t N, class Domain>
std::string law_of_cells(DensityCheck<M, N, Domain>& check) {
    using X = const Point<N>&;
    auto fits = [&](const std::function<double(X)>& guess) {
        check.claim = guess;
        const Parts parts = check.integrate();
        check.claim = {};
        return follow(check.counts, parts);
    };
    const auto& pdf = check.model.pdf;
    return law_that(
        check.scene(), check.o, check.balanced,
        [&](const auto& factor) { return fits([&](X x) { return pdf(x) * factor(x); }); },
        [&](const Map<N>& image) { return fits([&](X x) { return pdf(image(x)); }); });
}
template <size_t N, class Domain>
std::string law_of_cells(const ArrayCheck<N, Domain>& check, bool normalised) {
    return law_that(
        check.scene(), check.o, normalised,
        [&](const auto& factor) { return follow(check.counts, check.parts(factor)); },
        [&](const Map<N>& image) {
            std::vector<Point<N>> images;
            for (const Point<N>& w : check.samples) images.push_back(image(w));
            ArrayCheck<N, Domain> turned{check.domain, images,         check.points,
                                         check.pdf,    check.arriving, check.o};
            return turned.wrong().empty() &&
                   follow(turned.counts, turned.parts([](const Point<N>&) { return 1; }));
        });
}

// Where counts differ most, by their cells: every other hint was silent.  products: p / q where a
// map tells the density q of the samples.
std::string worst_cells_of(const auto& check, std::vector<double> products = {}) {
    const auto scene = check.scene();
    // In the middle of those that the pilot found there: the range's may be where nothing is.
    std::array<std::vector<decltype(scene.middle)>, cell_count> inside;
    for (const auto& c : check.pilot) inside[check.cells.of(c)].push_back(check.domain.at(c));
    auto middle_of = [&](size_t cell) {
        const auto& here = inside[cell];
        return check.at(here.empty() ? check.domain.at(check.range(cell).middle())
                                     : here[here.size() / 2]);
    };
    const double n = sum_of(check.counts);
    const size_t worst = worst_cell(check);
    if (!(check.expected[worst] > 0))
        return "samples come where the pdf is 0, near " + middle_of(worst);
    std::vector<double> dense;
    std::vector<std::pair<double, double>> by_distance;
    for (size_t i = 0; i < cell_count; ++i) {
        const double expected = n * check.expected[i];
        dense.push_back(expected > 0 ? check.counts[i] / expected : 1);
        for (const auto& x : inside[i]) by_distance.emplace_back(scene.distance(x), 1 / dense[i]);
    }
    const auto [least, most] = std::minmax_element(dense.begin(), dense.end());
    const size_t other = size_t((dense[worst] > 1 ? least : most) - dense.begin());
    const std::string width = width_of(by_distance);
    products.push_back(infinity);
    const bool pieces = median(products, 0.1) > 0.98 && median(products, 0.9) < 1.02;
    return (pieces ? "every piece of the map has the density of the pdf, but " : "") +
           ("samples are " + say("%.4g", dense[worst]) +
            " times as dense as the pdf says, around ") +
           middle_of(worst) + say(", and %.4g times around ", dense[other]) + middle_of(other) +
           (pieces          ? ": looks like branches that overlap and leave a gap"
            : width.empty() ? ""
                            : ": the pdf is " + width);
}

// The first line of a refusal.
template <size_t M, size_t N, class Domain>
std::string first_line_of(DensityCheck<M, N, Domain>& check) {
    const auto& sheets = check.sheets;
    const double total = check.parts.total, share = check.none / check.samples + check.o.discrete;
    if (check.heaps > 2)
        return check.repeated + say(", and %zu points more repeat", check.heaps - 1) +
               ": looks like corners of cells, without a random number within";
    if (check.heaps > 0 && !check.directions)
        return check.repeated + ": looks like numbers clamped to an end";
    // Where the pdf lacks just this part it was left out on purpose.
    if (check.heaps > 0)
        return check.repeated +
               (std::abs(total + share + check.repeating - 1) < 0.02
                    ? ": looks like a mirror (.discrete says how many samples are)"
                    : ": numbers clamped to an end, or a mirror (.discrete says how many)?");
    const bool blurred = !sheets.off || std::abs(sheets.off->product() - 1) <
                                            3 * (sheets.off->error + 4 * sheets.off->noise);
    const std::string rounded = check.model.single && check.counted && blurred &&
                                        std::abs(total - 1 + share) < 10 * check.close
                                    ? if_double
                                    : "";
    if (const std::string why = explained(check, sheets.all, total); !why.empty())
        return why + rounded;
    const std::string integral_is =
        "the pdf integrates to " +
        (std::abs(total - 1) < 1e-3 ? say("%.7g", total) : times(total, to_name));
    const bool mapless = sheets.all.size() < fewest_sheets,
               by_cells = !check.counted && check.samples >= 50000;
    // By counts the shape is right.
    if (!check.balanced && check.counted && std::abs(total / (1 - share) - 1) > 0.1 &&
        std::abs(total - 1) > check.close) {
        std::vector<double> products;
        for (const auto& l : sheets.all) products.push_back(l.product());
        const bool pieces = !mapless && law_of(products, to_agree).plain(to_agree);
        return "the pdf is " + times(total / (1 - share), to_name) +
               " times the density of the samples, as far as counts tell: " +
               (pieces ? "every piece of the map has it, and others lie upon it: looks like a map "
                         "that is not one to one (folded), or a choice of one of several"
                       : "a constant factor") +
               "; " + integral_is +
               (share > 0 ? ", " + percent(share) + " of the samples fail" : "") + rounded;
    }
    if (by_cells && (check.balanced ? !sheets.off : mapless))
        if (const std::string why = law_of_cells(check); !why.empty())
            return why + (check.balanced ? "" : "; " + integral_is) + rounded;
    if (!check.balanced && check.none > 0) {
        const std::string fails = compared(check) + percent(check.none / check.samples) +
                                  " of the samples fail (" + check.first_none + ")";
        if (std::abs(total - 1) <= check.close)
            return fails + ", though the pdf integrates to 1, as if none did";
        return fails + ", but " + integral_is + say(": together %.6g, expected 1", total + share) +
               rounded;
    }
    if (!check.balanced)
        return compared(check) + integral_is +
               say(", expected %.6g +- %.0e", 1 - check.o.discrete, check.close) + rounded;
    if (sheets.off)
        return compared(check) + "samples are " + say("%.4g", 1 / sheets.off->product()) +
               " times as dense as the pdf says, at " + check.at(sheets.off->x) +
               ", u = " + say_point(sheets.u) + rounded;
    std::vector<double> products;
    for (const auto& l : sheets.all) products.push_back(l.product());
    return worst_cells_of(check, products);
}

// The first line of a refusal of arrays.
template <size_t N, class Domain>
std::string first_line_of(const ArrayCheck<N, Domain>& check, const Parts& claimed, bool balanced,
                          bool counted) {
    const double factor = claimed.total / check.arriving,
                 known = 1e-4 + 5 * claimed.error / claimed.total;
    const std::string side = check.without_samples();
    if (counted && balanced) return side;
    if (counted)
        return "the pdf is " + times(factor, known) + " times the density of the samples" +
               (check.arriving < 1 ? ", " + percent(1 - check.arriving) + " of which fail" : "") +
               ", as far as counts tell" + normalisation_hint(constant_named(factor, known));
    const std::string law = law_of_cells(check, balanced);
    return (!law.empty()    ? law
            : !side.empty() ? side
                            : worst_cells_of(check)) +
           (balanced ? ""
                     : say("; the pdf integrates to %.5g +- %.1g, expected %.5g", claimed.total,
                           claimed.error, check.arriving));
}

// ---- What is wrong with a BSDF ------------------------------------------------------------------

// f(a, b) / f(b, a) is a ratio of the cosines of a and b; or depends only on them: it is the same
// if b turns.
inline std::string exchange_hint(const Eval& f, const Pairs& pairs, double close) {
    std::vector<double> cosine, inverse, turning;
    for (const auto& [a, b] : pairs) {
        const Triple turned{-b[1], b[0], b[2]};
        const double ratio = f(a, b) / f(b, a), there = f(a, turned) / f(turned, a),
                     cosines = std::abs(a[2] / b[2]);
        cosine.push_back(ratio * cosines);
        inverse.push_back(ratio / cosines);
        if (ratio > 0 && there > 0 && std::isfinite(ratio * there))
            turning.push_back(ratio / there);
    }
    if (law_of(cosine, close).holds)
        return "; looks like the cosine of wi included in eval, or eval divided by that of wo";
    if (law_of(inverse, close).holds) return "; looks like eval divided by the cosine of wi";
    return 4 * turning.size() > pairs.size() && law_of(turning, 1e-3).holds
               ? ", by a factor of their cosines alone (Fresnel or masking by one of them?)"
               : "";
}

// In words, where these are wrong, if a quantity tells all of them from the right ones.
inline std::string where_wrong(const std::vector<Returned>& all, const std::string& expected) {
    const std::pair<std::string, std::function<double(const Returned&)>> quantities[] = {
        {"cos(theta)", [](const Returned& r) { return r.wi[2]; }},
        {"x", [](const Returned& r) { return r.wi[0]; }},
        {"y", [](const Returned& r) { return r.wi[1]; }},
        {expected, [](const Returned& r) { return r.wanted; }},
        {"the pdf", [](const Returned& r) { return r.pdf; }}};
    for (const auto& [name, of] : quantities)
        for (const double sign : {1.0, -1.0}) {
            double least_wrong = infinity, most_right = -infinity;
            for (const Returned& r : all) {
                const bool is_wrong = name == expected ? r.wrong : r.off;
                double& bound = is_wrong ? least_wrong : most_right;
                bound = is_wrong ? std::min(bound, sign * of(r)) : std::max(bound, sign * of(r));
            }
            if (least_wrong <= most_right || most_right == -infinity) continue;
            const bool at_0 = least_wrong >= 0 && most_right <= 0;
            return ", where " + name + (sign > 0 ? " > " : " < ") +
                   say("%.3g", at_0 ? 0 : sign * (least_wrong + most_right) / 2);
        }
    return "";
}

// What is wrong with a value that sample returns beside the direction; "" if nothing is.
inline std::string returned_hint(const std::vector<Returned>& all, const std::string& what,
                                 const std::string& expected) {
    std::vector<Returned> wrong;
    std::copy_if(all.begin(), all.end(), std::back_inserter(wrong),
                 [](auto& r) { return r.wrong; });
    const double off = double(std::count_if(all.begin(), all.end(), [](auto&r) { return r.off; })),
                 part = off / double(all.size());
    if (off <= chance_few + 0.01 * double(all.size())) return "";
    const std::string begin = "the " + what + " that sample returns is ",
                      often = (part == 1 ? ", at every direction"
                                         : ", at " + percent(part) + " of directions") +
                              (wrong.size() == all.size() ? "" : where_wrong(all, expected));
    for (const double a : {0.0, 1.0, -1.0})
        for (const double b : {0.0, -1.0, 1.0}) {
            std::vector<double> ratios;
            for (const Returned& s : wrong)
                ratios.push_back(s.said / s.wanted / std::pow(std::abs(s.wi[2]), a) /
                                 std::pow(s.pdf, b));
            const Law law = law_of(ratios, to_agree);
            if (!law.holds) continue;
            const std::string base = (a == 0 ? "" : power("|cos|", a)) +
                                     (a == 0 || b == 0 ? "" : " ") +
                                     (b == 0 ? "" : power("pdf", b));
            return begin +
                   (base.empty() ? times(law.factor, to_name)
                                 : factor_and(law.factor, to_agree, base)) +
                   " times " + expected + often;
        }
    return begin + say("%.4g, but ", wrong[0].said) + expected +
           say(" is %.4g, for wi = ", wrong[0].wanted) + say_point(wrong[0].wi) + often;
}

// `all` are directions wo from steep to grazing, each with its albedo and the relative error.
inline std::string albedo_hint(const std::vector<Albedo>& all, double alpha) {
    const Albedo* worst = nullptr;
    std::string list;
    for (const Albedo& a : all) {
        list += (list.empty() ? "" : ", ") + say("%.3g at cos %.2g", a.mean, a.wo[2]);
        if (a.p <= alpha && (!worst || a.mean > worst->mean)) worst = &a;
    }
    if (!worst) return "";
    const bool rises = worst->mean > 2 * all[0].mean;
    return "an albedo of " + times(worst->mean, std::max(to_name, 3 * worst->error)) +
           ": more leaves than comes, for wo = " + say_point(worst->wo) + " (" + list + ")" +
           (rises && std::abs(worst->wo[2]) < 0.3
                ? "; it grows towards grazing wo, as 1/cos and tan do: is masking forgotten, or a "
                  "bound of the angle?"
            : rises           ? ""
            : worst->mean > 2 ? "; is a constant factor (1/pi, 1/4) missing?"
                              : "; are lobes added without weights (1 - F), or is a constant "
                                "factor (1/pi, 1/4) missing?");
}

// ---- What is wrong with a choice ----------------------------------------------------------------

// 1 + the number that changes no choice in 4096 tries: 0.2 % of all pairs.
template <size_t M>
size_t unused_number(Random& random, const Model<M, 1>& model) {
    for (size_t k = 0; k < M && M > 1; ++k) {
        auto differ = [&] {
            Point<M> u = model.draw(random);
            const double before = (*model.sample(u))[0];
            u[k] = model.draw(random)[k];
            return (*model.sample(u))[0] != before;
        };
        int tries = 0;
        while (tries < 4096 && !differ()) ++tries;
        if (tries == 4096) return k + 1;
    }
    return 0;
}

inline std::string of_what_is_said(const std::vector<double>& ratios) {
    const Law law = law_of(ratios, 1e-3);
    return (law.holds ? times(law.factor, 1e-3) : say("%.4g", ratios[0])) +
           " times what probability says";
}

inline std::string choice_hint(const std::vector<double>& expected, const std::vector<double>& seen,
                               double none, double tolerance, size_t unused) {
    const size_t count = expected.size();
    const double total = sum_of(expected), samples = none + sum_of(seen);
    if (none > 0 && std::abs(total - 1) < 1e-6)
        return percent(none / samples) +
               " of the choices are none, though the probabilities sum to 1";
    std::string cause;
    const std::string ignored =
        unused > 0 ? say("; choices do not depend on number %zu: looks like one number used for "
                         "both, or one ignored",
                         unused)
                   : "";
    // Other probabilities, if there are so many that it is not by chance.
    auto other = [&](size_t fewest, const std::string& words, const std::vector<double>& p) {
        if (cause.empty() && count >= fewest && fit_choices(p, seen, none, tolerance).p > 1e-4)
            cause = "; looks like " + words;
    };
    for (const size_t by : {size_t(1), count - 1}) {
        std::vector<double> rotated = expected, moved(count);
        std::rotate(rotated.begin(), rotated.begin() + long(by % count), rotated.end());
        for (size_t i = 0; i < count; ++i)
            moved[by == 1 ? std::min(i + 1, count - 1) : i - std::min<size_t>(i, 1)] += expected[i];
        other(3, "an index off by one", moved);
        other(4, "index and probability shifted by one", rotated);
    }
    if (count == 2) other(2, "the two exchanged (p for 1 - p)", {expected[1], expected[0]});
    if (count == 1) other(1, "a comparison turned round (p for 1 - p)", {1 - total});
    other(1, "a uniform choice", std::vector<double>(count, total / double(count)));
    std::vector<double> shorter = expected;
    shorter.back() = 0;
    for (double& p : shorter) p *= total / (total - expected.back());
    if (total > expected.back()) other(2, "a range too short", shorter);
    std::vector<double> beyond(count);  // the next greater one gets what is left
    double most = 0;
    for (size_t i = 0; i < count; ++i) {
        beyond[i] = std::max(0.0, expected[i] - most);
        most = std::max(most, expected[i]);
    }
    for (const bool rest : {false, true}) {
        if (rest) beyond.back() += total - most;
        other(3, "a number compared with each probability, not with their sum", beyond);
    }
    for (const double k : {2.0, 0.5, -1.0}) {
        std::vector<double> powers;
        for (double p : expected) powers.push_back(std::pow(p, k));
        const double sum = sum_of(powers);
        for (double& p : powers) p *= total / sum;
        if (std::isfinite(sum))
            other(3, power("the probability", k) + " in place of the probability", powers);
    }
    // As many times 1 / count; the standard deviation of a frequency is below 1 / 2 sqrt(n).
    auto whole = [&](const std::vector<double>& p, double of, double close) {
        return std::all_of(p.begin(), p.end(), [&](double x) {
            const double cells = x / of * double(count);
            return std::abs(cells - std::round(cells)) < close;
        });
    };
    // The same probabilities, at other indices: of those that are off by 5 standard errors.
    std::vector<size_t> from, to;
    for (size_t i = 0; i < count; ++i)
        if (std::abs(seen[i] - expected[i] * samples) > 5 * std::sqrt(expected[i] * samples))
            from.push_back(i), to.push_back(i);
    std::sort(from.begin(), from.end(),
              [&](size_t a, size_t b) { return expected[a] < expected[b]; });
    std::sort(to.begin(), to.end(), [&](size_t a, size_t b) { return seen[a] < seen[b]; });
    std::vector<double> permuted = expected;
    std::string moves;
    for (size_t i = 0; i < from.size(); ++i) {
        permuted[to[i]] = expected[from[i]];
        moves += (i > 0 ? ", " : "") + say("%zu's at %zu", from[i], to[i]);
    }
    if (2 <= from.size() && from.size() <= 8)
        other(4, "the same probabilities at other indices (" + moves + ")", permuted);
    const double close = 2.5 * double(count) / std::sqrt(samples);
    if (cause.empty() && count >= 3 && close < 0.1 && whole(seen, samples, close) &&
        !whole(expected, 1, 2 * close))
        cause =
            say("; all frequencies are multiples of 1/%zu: a coin and an index from "
                "one number, or a coin never thrown?",
                count);
    if (const auto [low, high] = std::minmax_element(expected.begin(), expected.end());
        *high < *low * (1 + 1e-6)) {
        // round(u n) and round(u (n - 1)).
        for (const double n : {double(count), double(count) - 1}) {
            std::vector<double> rounded(count, total / n);
            rounded[0] /= 2;
            rounded[count - 1] *= n < double(count) ? 0.5 : 1.5;
            other(3, "an index rounded to nearest in place of down", rounded);
        }
        if (cause.empty()) cause = "; the probabilities are uniform, the choice is not";
    }
    std::string list, wanted;  // few are all listed
    for (size_t i = 0; i < count && count <= 16; ++i) {
        list += (i == 0 ? "; chosen are " : ", ") + say("%.3g", seen[i] / samples);
        wanted += (i == 0 ? ", expected " : ", ") + say("%.3g", expected[i]);
    }
    size_t i = 0;
    while (i < count && (seen[i] > 0 || expected[i] * samples < 20)) ++i;
    const size_t worst = worst_of(count, [&](size_t k) {
        const double mean = expected[k] * samples;
        return seen[k] == mean ? 0 : std::abs(seen[k] - mean) / std::sqrt(mean);
    });
    bool alone = count > 2;
    for (size_t k = 0; k < count; ++k) {
        const double mean = expected[k] * samples;
        if (k != worst && std::abs(seen[k] - mean) > 5 * std::sqrt(mean)) alone = false;
    }
    return (i < count
                ? say("index %zu is never chosen, though its probability is %.4g", i, expected[i])
            : expected[worst] == 0
                ? say("index %zu is chosen, though its probability is 0", worst)
                : say("index %zu is chosen %.4g times as often as its probability %.4g says", worst,
                      seen[worst] / (expected[worst] * samples), expected[worst]) +
                      (alone ? ", all others are right" : "")) +
           ignored + cause + list + wanted;
}

// ---- What is wrong with an image ----------------------------------------------------------------

// A rectangle of pixels, if most of it is off and all others are right.
inline std::string Image::all_others_right() const {
    auto off = [&](size_t i) {
        return std::abs(f[i] - truth[i]) > 5 * s[i] + 1e-6 * std::abs(truth[i]);
    };
    size_t x0 = width, x1 = 0, y0 = height, y1 = 0;
    for (size_t i = 0; i < n(); ++i) {
        if (!off(i)) continue;
        x0 = std::min(x0, i % width), x1 = std::max(x1, i % width);
        y0 = std::min(y0, i / width), y1 = std::max(y1, i / width);
    }
    std::vector<double> mended = truth;
    double seen = 0, wanted = 0, variance = 0, wrong = 0, inside = 0;
    for (size_t y = y0; y <= y1; ++y)
        for (size_t x = x0; x <= x1; ++x) {
            const size_t i = y * width + x;
            mended[i] = f[i];
            seen += f[i], wanted += truth[i], variance += s[i] * s[i];
            wrong += off(i), ++inside;
        }
    if (!(2 * wrong >= inside && 3 * inside <= 2 * double(n()) && against(mended).p > o.alpha))
        return "";
    const double error = 5 * std::sqrt(variance);
    return (inside == 1 ? say("pixel (%zu, %zu) is ", x0, y0)
                        : say("pixels (%zu, %zu) to (%zu, %zu) are ", x0, y0, x1, y1)) +
           (std::abs(seen) <= error
                ? "black"
                : times(seen / wanted, error / std::abs(seen)) + " times the reference") +
           ", all others are right";
}

inline std::string Image::hint(const ImageResult& r) const {
    double variance = 0, clamped = 0, n_clamped = 0;
    const double sum = sum_of(truth), sum_f = sum_of(f),
                 most = *std::max_element(f.begin(), f.end());
    std::string first;
    auto explains = [&](const std::vector<double>& g, const std::string& what, double c = 1) {
        if (first.empty() && against(g, c).p > std::max(1e-5, 10 * o.alpha))
            first = "the image is " + what;
    };
    // The reference's pixels at other places; or only within the border, which has all neighbours.
    auto moved = [&](bool inside, auto from) {
        std::vector<double> g = f;
        for (size_t y = inside; y + inside < height; ++y)
            for (size_t x = inside; x + inside < width; ++x) g[y * width + x] = truth[from(x, y)];
        return g;
    };
    explains(moved(false, [&](size_t x, size_t y) { return (height - 1 - y) * width + x; }),
             "the reference upside down: looks like rows written in the other order");
    explains(moved(false, [&](size_t x, size_t y) { return y * width + width - 1 - x; }),
             "the reference mirrored: looks like x reversed");
    explains(moved(false, [&](size_t x, size_t y) { return x * height + y; }),
             "the reference with rows and columns exchanged");
    for (size_t i = 0; i < n(); ++i) {
        variance += s[i] * s[i];
        if (truth[i] > most) clamped += f[i], ++n_clamped;
    }
    if (sum != 0 && sum_f / sum > 0) {
        const double within = 5 * std::sqrt(variance) / std::abs(sum_f);
        explains(truth,
                 times(sum_f / sum, within) + " times the reference, everywhere" +
                     cause_of(sum_f / sum, within, o.factors),
                 sum_f / sum);
    }
    if (n_clamped > 0) {
        std::vector<double> g = truth;
        for (double& x : g) x = std::min(x, clamped / n_clamped);
        explains(g, say("the reference, but nowhere above %.4g: looks like values clamped",
                        clamped / n_clamped));
    }
    auto shifted = [&](int dx, int dy) {
        return moved(true, [=, this](size_t x, size_t y) {
            return (y + size_t(dy)) * width + x + size_t(dx);
        });
    };
    // Only where it is the inside that differs.
    if (width > 4 && height > 4 && against(shifted(0, 0)).p <= o.alpha) {
        explains(shifted(1, 0), "the reference one pixel further left");
        explains(shifted(-1, 0), "the reference one pixel further right");
        explains(shifted(0, 1), "the reference one pixel further up");
        explains(shifted(0, -1), "the reference one pixel further down");
    }
    // Larger errors explain it.
    Image wider = *this;
    double squares = 0;
    for (size_t i = 0; i < n(); ++i)
        squares += s[i] > 0 ? std::pow((f[i] - truth[i]) / s[i], 2) / double(n()) : 0;
    const double more = std::sqrt(squares);
    for (double& x : wider.s) x *= more;
    if (first.empty() && n() >= 16 && more > 1 && wider.against(truth).p > 1e-3)
        return "the differences are " + times(more, 1.5 / std::sqrt(double(n()))) +
               " times the standard errors, everywhere: are these too small?" +
               (o.n > 1 && std::abs(more / std::sqrt(double(o.n)) - 1) < 2 / std::sqrt(double(n()))
                    ? " (divided by the root of n twice)"
                    : "");
    if (first.empty()) first = all_others_right();
    if (!first.empty()) return first;
    // By 16 blocks: those in the middle, at the edges, in the corners.
    std::array<double, 16> seen{}, wanted{};
    std::array<double, 3> low{infinity, infinity, infinity}, high{};
    for (size_t i = 0; i < n(); ++i) seen[block_of(i)] += f[i], wanted[block_of(i)] += truth[i];
    for (size_t b = 0; b < 16; ++b) {
        const size_t group = size_t(b % 4 % 3 == 0) + size_t(b / 4 % 3 == 0);
        low[group] = std::min(low[group], seen[b] / wanted[b]);
        high[group] = std::max(high[group], seen[b] / wanted[b]);
    }
    const bool darker = low[0] > high[1] && low[1] > high[2] && low[0] > 1.05 * high[2],
               brighter = high[0] < low[1] && high[1] < low[2] && 1.05 * high[0] < low[2];
    if (darker || brighter)
        return say(
            "the image is %.3g times the reference in the middle, %.3g times at the edges, "
            "%.3g times in the corners: a weight of the camera (cos^4, a filter)?",
            (low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2);
    const std::string all = say("all pixels: %.4g times the reference", sum_f / sum);
    if (!r.by_block)
        return say("pixel (%zu, %zu)", r.worst % width, r.worst / width) +
               say(" is %.6g +- %.2g, expected %.6g; ", f[r.worst], s[r.worst], truth[r.worst]) +
               all;
    const size_t x0 = (r.block % 4 * width + 3) / 4, x1 = ((r.block % 4 + 1) * width + 3) / 4,
                 y0 = (r.block / 4 * height + 3) / 4, y1 = ((r.block / 4 + 1) * height + 3) / 4;
    return say("the block of pixels (%zu, %zu) to (%zu, %zu) is %.4g times the reference; ", x0, y0,
               x1 - 1, y1 - 1, seen[r.block] / wanted[r.block]) +
           all;
}

}  // namespace oracle::detail
// oracle/pictures.h  what a failed check saw, drawn in SVG; and the end of oracle.h

namespace oracle::detail {

// ---- Pictures -----------------------------------------------------------------------------------

// A picture in SVG of a width and height in pixels; y points down.
struct Drawing {
    double width, height;
    std::string body = {};

    void rectangle(double x, double y, double w, double h, const std::string& style) {
        body += say("<rect x='%.2f' y='%.2f' width='%.2f' height='%.2f' style='%s'/>\n", x, y, w, h,
                    style.c_str());
    }
    void text(double x, double y, const std::string& words) {
        body += say("<text x='%.1f' y='%.1f'>", x, y);
        for (char c : words) body += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
        body += "</text>\n";
    }
    void curve(const std::vector<std::pair<double, double>>& points, const std::string& style) {
        body += "<polyline points='";
        for (const auto& [x, y] : points) body += say("%.1f,%.1f ", x, y);
        body += "' style='fill:none;" + style + "'/>\n";
    }

    // Three maps, row by row from the top, each 350 wide: black is 1, white 0; for the third, red
    // is 1, blue -1.
    void maps(const std::array<std::vector<double>, 3>& values, size_t across, double h,
              const std::array<const char*, 3>& titles) {
        const double w = 350.0 / double(across);
        for (size_t k = 0; k < 3; ++k) {
            const double left = 10 + 362 * double(k);
            text(left, 20, titles[k]);
            for (size_t i = 0; i < values[k].size(); ++i) {
                const double x = std::clamp(values[k][i], k == 2 ? -1.0 : 0.0, 1.0);
                const int fade = int(255 * (1 - std::abs(x)));
                rectangle(left + w * double(i % across), 30 + h * double(i / across), w + 0.1,
                          h + 0.1,
                          say("fill:rgb(%d,%d,%d)", k == 2 && x > 0 ? 255 : fade, fade,
                              k == 2 && x <= 0 ? 255 : fade));
            }
        }
    }

    // Into the folder of pictures; "" or "\nsee PATH".
    std::string written(const std::string& name) const {
        if (pictures.empty()) return "";
        static std::atomic<int> unnamed = 0;
        std::string file;
        for (char c : name.empty() ? say("check-%d", ++unnamed) : name)
            file += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
        for (size_t end = 0; end != std::string::npos;) {
            end = pictures.find('/', end + 1);
#ifdef _WIN32
            (void)_mkdir(pictures.substr(0, end).c_str());
#else
            (void)mkdir(pictures.substr(0, end).c_str(), 0777);
#endif
        }
        const std::string path = pictures + "/oracle-" + file.substr(0, 100) + ".svg";
        std::FILE* out = std::fopen(path.c_str(), "w");
        if (!out) return "\n" + path + ": cannot be written";
        std::fprintf(out,
                     "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' "
                     "font-family='sans-serif' font-size='12' shape-rendering='crispEdges'>\n"
                     "<rect width='100%%' height='100%%' fill='white'/>\n%s</svg>\n",
                     width, height, body.c_str());
        return (std::fclose(out) == 0 ? "\nsee " : "\ncannot be written: ") + path;
    }
};

// The running mean, and the band in which it would be with a mean of `truth`.
inline std::string picture_of(const Draws& draws, double truth, const Options& o) {
    const Estimate e = draws.estimate();
    const double t = where_equal([&](double x) { return p_of_t(x, e.df); }, o.alpha);
    std::vector<std::pair<double, double>> running, above, below;
    const double deviation = std::sqrt(draws.variance());
    const double half = std::max(1.5 * std::abs(e.mean - truth), 3 * t * e.standard_error);
    auto add = [&](auto& curve, double i, double y) {
        curve.emplace_back(60 + 520 * i / draws.n(),
                           180 - 140 * std::clamp((y - truth) / half, -1.1, 1.1));
    };
    double sum = 0;
    const size_t step = std::max<size_t>(1, draws.values.size() / 260);
    for (size_t i = 0; i < draws.values.size(); ++i) {
        sum += draws.values[i];
        if ((i + 1) % step != 0) continue;
        const double k = double(i + 1), band = t * deviation / std::sqrt(k);
        add(running, k, sum / k);
        add(above, k, truth + band);
        add(below, k, truth - band);
    }
    Drawing d{600, 350};
    d.curve({{60, 180}, {580, 180}}, "stroke:black");
    d.curve(above, "stroke:grey");
    d.curve(below, "stroke:grey");
    d.curve(running, "stroke:rgb(200,0,0);stroke-width:2");
    d.text(60, 20,
           say("running mean (red) of %.0f samples; grey: where it is with a mean of %.6g",
               draws.n(), truth));
    for (double k : {-1.0, 0.0, 1.0}) d.text(2, 184 - 140 * k, say("%.4g", truth + k * half));
    d.text(500, 345, say("n = %.0f", draws.n()));
    return d.written(o.name);
}

// Samples and pdf in bins of a part of the domain: phi (or the first coordinate) runs to the right,
// theta downwards.
template <class Check>
struct Bins {
    static constexpr size_t D = Check::D, across = 48, down = D == 1 ? 1 : 32,
                            right = D == 1 ? 0 : 1;
    const Check& check;
    Range<D> shown{check.domain.lower, check.domain.upper};
    double area = 1;  // of a bin
    std::vector<double> seen = std::vector<double>(across * down), claimed = seen;

    explicit Bins(const Check& check_) : check(check_) {
        for (size_t k = 0; k < D; ++k) {
            const auto [low, high] =
                std::minmax_element(check.pilot.begin(), check.pilot.end(),
                                    [k](const auto& a, const auto& b) { return a[k] < b[k]; });
            const double margin = 0.05 * ((*high)[k] - (*low)[k]) + 1e-12;
            shown.lower[k] = std::max(shown.lower[k], (*low)[k] - margin);
            shown.upper[k] = std::min(shown.upper[k], (*high)[k] + margin);
            area *= (shown.upper[k] - shown.lower[k]) / double(k == right ? across : down);
        }
    }
    double part(const Point<D>& c, size_t k) const {
        return (c[k] - shown.lower[k]) / (shown.upper[k] - shown.lower[k]);
    }
    void add(std::vector<double>& bins, const Point<D>& c, double what) const {
        const double x = part(c, right), y = D == 1 ? 0 : part(c, 0);
        if (x >= 0 && x < 1 && y >= 0 && y < 1)
            bins[size_t(y * double(down)) * across + size_t(x * double(across))] += what;
    }
    // The s-th of nine points within bin i.
    Point<D> point(size_t i, int s) const {
        Point<D> c;
        for (size_t k = 0; k < D; ++k) {
            const bool here = k == right;
            const double bin =
                double(here ? i % across : i / across) + ((here ? s % 3 : s / 3) + 0.5) / 3;
            c[k] = std::clamp(shown.lower[k] + bin / double(here ? across : down) *
                                                   (shown.upper[k] - shown.lower[k]),
                              check.domain.lower[k], check.domain.upper[k]);
        }
        return c;
    }

    // On a line bars and a curve, else two maps and that of their difference.
    std::string picture() const {
        const double most = std::max({1.0, *std::max_element(seen.begin(), seen.end()),
                                      *std::max_element(claimed.begin(), claimed.end())});
        // The worst cell, in parts of what is shown.
        Range<D> worst = check.range(worst_cell(check));
        for (Point<D>* end : {&worst.lower, &worst.upper}) {
            const Point<D> c = *end;
            for (size_t k = 0; k < D; ++k) (*end)[k] = std::clamp(part(c, k), 0.0, 1.0);
        }
        Drawing d{D == 1 ? 620.0 : 1100.0, 330};
        const std::string ends = "from " + say_point(check.domain.at(shown.lower)) + " to " +
                                 say_point(check.domain.at(shown.upper));
        if (D == 1) {
            std::vector<std::pair<double, double>> line;
            for (size_t i = 0; i < across; ++i) {
                const double x = 40 + 11.5 * double(i), height = 240 * seen[i] / most;
                d.rectangle(x, 290 - height, 10, height, "fill:rgb(170,170,170)");
                line.emplace_back(x + 5, 290 - 240 * claimed[i] / most);
            }
            d.curve(line, "stroke:rgb(200,0,0);stroke-width:2");
            d.text(40, 20, "samples (grey) and pdf (red), " + ends + "; worst cell below");
            d.rectangle(40 + 552 * worst.lower[0], 300, 552 * (worst.upper[0] - worst.lower[0]), 6,
                        "fill:black");
            return d.written(check.o.name);
        }
        std::array<std::vector<double>, 3> values;
        for (size_t i = 0; i < seen.size(); ++i) {
            values[0].push_back(std::sqrt(seen[i] / most));
            values[1].push_back(std::sqrt(claimed[i] / most));
            values[2].push_back((seen[i] - claimed[i]) / (std::sqrt(claimed[i] + seen[i] + 1) * 6));
        }
        d.maps(values, across, 8, {"samples", "pdf", "samples - pdf: red too many, blue too few"});
        for (double left : {10, 372, 734}) {
            d.rectangle(left, 30, 350, 256, "fill:none;stroke:black");
            d.rectangle(left + 350 * worst.lower[right], 30 + 256 * worst.lower[0],
                        350 * (worst.upper[right] - worst.lower[right]),
                        256 * (worst.upper[0] - worst.lower[0]),
                        "fill:none;stroke:rgb(0,140,0);stroke-width:3");
        }
        d.text(10, 304,
               (Check::directions ? "phi to the right, theta down, "
                                  : "the second coordinate to the right, the first down, ") +
                   ends + "; worst cell in green");
        return d.written(check.o.name);
    }
};

// 100 000 samples more, and the pdf at nine points of each bin.
template <size_t M, size_t N, class Domain>
std::string picture_of(DensityCheck<M, N, Domain>& check) {
    if (Domain::dimensions > 2 || pictures.empty()) return "";
    Bins bins(check);
    double total = 0;
    for (int i = 0; i < 100000; ++i)
        if (const auto c = check.one()) {
            ++total;
            bins.add(bins.seen, *c, 1);
        }
    for (size_t i = 0; i < bins.seen.size(); ++i)
        for (int s = 0; s < 9; ++s)
            bins.claimed[i] +=
                check.density_at(bins.point(i, s)) / 9 * bins.area * total / check.parts.total;
    return bins.picture();
}
// All samples, and the pdf at all points.
template <size_t N, class Domain>
std::string picture_of(const ArrayCheck<N, Domain>& check) {
    if (Domain::dimensions > 2 || pictures.empty()) return "";
    Bins bins(check);
    const auto& parts = check.part_of;
    const double each = double(check.samples.size()) / sum_of(parts);
    for (size_t i = 0; i < parts.size(); ++i)
        bins.add(bins.claimed, check.domain.coordinates(check.points[i]), parts[i] * each);
    for (const Point<N>& w : check.samples) bins.add(bins.seen, check.domain.coordinates(w), 1);
    return bins.picture();
}

inline std::string Image::picture() const {
    // The three, by blocks of pixels.
    const size_t across = std::min<size_t>(width, 64), down = std::min<size_t>(height, 48);
    std::array<std::vector<double>, 3> values;
    for (auto& v : values) v.resize(across * down);
    std::vector<double> weight(across * down);
    double most = 1e-300, most_off = 1e-300;
    for (size_t i = 0; i < n(); ++i)
        ++weight[(i / width) * down / height * across + (i % width) * across / width];
    for (size_t i = 0; i < n(); ++i) {
        const size_t b = (i / width) * down / height * across + (i % width) * across / width;
        values[0][b] += f[i] / weight[b], values[1][b] += truth[i] / weight[b];
        values[2][b] += (f[i] - truth[i]) / weight[b];
    }
    for (size_t b = 0; b < weight.size(); ++b) {
        most = std::max({most, values[0][b], values[1][b]});
        most_off = std::max(most_off, std::abs(values[2][b]));
    }
    for (size_t b = 0; b < weight.size(); ++b) {
        for (size_t k = 0; k < 2; ++k)
            values[k][b] = 1 - std::pow(std::max(0.0, values[k][b] / most), 1 / 2.2);
        values[2][b] /= most_off;
    }
    const double h = 350.0 * double(height) / double(width) / double(down);
    Drawing d{1100, 60 + h * double(down)};
    d.maps(values, across, h,
           {"image", "reference", "image - reference: red too bright, blue too dark"});
    d.text(10, 50 + h * double(down), say("white is %.4g; full red and blue %.4g", most, most_off));
    return d.written(o.name);
}

// Most of the time that a check of a density takes to compile.  Of a program of several files one
// is compiled with -DORACLE_CHECKS=, all others with -DORACLE_CHECKS=extern.
#ifdef ORACLE_CHECKS
ORACLE_CHECKS template Verdict DensityCheck<2, 3, Sphere>::run();
ORACLE_CHECKS template Verdict DensityCheck<3, 3, Sphere>::run();
ORACLE_CHECKS template Verdict DensityCheck<2, 2, Plane>::run();
ORACLE_CHECKS template Verdict DensityCheck<1, 1, Line>::run();
#endif

}  // namespace oracle::detail

// The end of oracle.h: what checks.h began with.
#undef ORACLE_PRINTF
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif
#pragma pop_macro("pi")
#pragma pop_macro("min")
#pragma pop_macro("max")
#pragma pop_macro("near")
#pragma pop_macro("far")

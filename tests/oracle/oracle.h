// oracle/oracle.h  verdicts about random numbers, each with its significance and its power
//
// Point it at any renderer: it needs ../src/stats.h and the standard library.  Every check returns
// a Verdict.  It refuses what is right with a probability of at most alpha = 1e-6 (0 where the
// check is exact), and passes what is off by delta_min with a probability of 1e-3.  Nothing is
// forgiven but rounding: 64 units of the type that the tested function returns.
//
//   Random random(seed_of("my sampler"));
//   Verdict v = expect_mean(2 * pi / 3, 100000, [&] { return my_estimate(random); });
//   if (!v.pass) std::puts(v.text.c_str());
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/stats.h"

inline constexpr double alpha = 1e-6;

struct Verdict {
    bool pass = false;
    double p = 1;          // two-sided; 1 if exact
    double delta_min = 0;  // smallest error seen with 99.9 % power; relative unless the truth is 0
    std::string text;

    // With what was tested before it, an equation if there is one.
    Verdict of(const std::string& what) const {
        std::string named = what;
        named += ": ";
        return {pass, p, delta_min, named += text};
    }
};

// Checks that have used up their alpha.  Together they raise a false alarm with a probability of at
// most statistical_checks * alpha.
inline int statistical_checks = 0;

// ---- Seeds
// ---------------------------------------------------------------------------------------

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
};

// ---- What went wrong, in words
// -------------------------------------------------------------------

inline std::string print(const char* format, auto... values) {
    char text[512];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

// The likely mistake behind a ratio of measured to expected known within `tolerance`, if it is a
// classic one.
inline std::string hint(double ratio, double tolerance) {
    using std::numbers::pi;
    const struct {
        double ratio;
        const char* mistake;
    } classics[] = {
        {pi, "pi: an albedo is not a BRDF, 1/pi forgotten"},
        {1 / pi, "1/pi: divided by pi twice"},
        {2, "2: counted twice (emission after a light sample, both sides of a light, half a pdf)"},
        {0.5, "1/2: not divided by the probability of a choice among two, or half a domain"},
        {2 / pi, "2/pi: mean of a cosine over the angle, not over the solid angle"},
        {pi / 2, "pi/2: an angle uniform, not its cosine"},
        {4, "4: a diameter for a radius, a sphere's area for its disc's"},
        {0.25, "1/4: a radius for a diameter, a disc's area for its sphere's"},
        {2 * pi, "2 pi: density of the angle phi forgotten"},
        {1 / (2 * pi), "1/(2 pi): density of the angle phi twice"},
        {2.0 / 3, "2/3: a cosine too many"},
        {1.5, "3/2: a cosine too few"},
        {-1, "-1: a sign"},
    };
    for (const auto& c : classics)
        if (std::abs(ratio / c.ratio - 1) <= std::min(0.02, tolerance))
            return print("; ratio %.4g, is it %s?", ratio, c.mistake);
    return "";
}

inline std::string print_p(double p) { return p > 0 ? print("p = %.2g", p) : "p < 1e-300"; }

inline Verdict failure(const std::string& why) {
    return {false, 0, std::numeric_limits<double>::infinity(), why};
}

// ---- Judgement
// -----------------------------------------------------------------------------------

// A mean, its standard error with df degrees of freedom, and the unit of rounding (half an ulp of
// 1) of the numbers it is made of.
struct Estimate {
    double mean = 0, standard_error = 0;
    double df = std::numeric_limits<double>::infinity();
    double unit = 0x1p-53;
};
inline Estimate estimate(const Moments& m, double unit = 0x1p-53) {
    return {m.mean, m.standard_error(), double(m.n) - 1, unit};
}

// x >= 0 where p(x), which falls from 1 to 0, has fallen to `target`.
template <class P>
double where_equal(P p, double target) {
    double low = 0, high = 1;
    while (p(high) > target) high *= 2;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (p(middle) > target ? low : high) = middle;
    }
    return high;
}

// Standard errors by which the mean must be off for the t-test to see it with 99.9 % power: by the
// normal approximation of noncentral t (Johnson, Welch 1940) t_alpha + 3.09 sqrt(1 + t_alpha^2 / 2
// df), which is 8.0 for many degrees.
inline double smallest_shift(double df) {
    static std::map<double, double> known;
    const auto [at, is_new] = known.try_emplace(df, 0.0);
    if (is_new) {
        const double t = where_equal([&](double x) { return p_of_t(x, df); }, alpha);
        at->second = t + 3.09 * std::sqrt(1 + t * t / (2 * df));
    }
    return at->second;
}

// Two numbers, equal but for 64 roundings.
inline bool same_but_rounding(double a, double b, double unit) {
    return std::abs(a - b) <= 64 * unit * std::max(std::abs(a), std::abs(b));
}

inline Verdict judge_exact(const char* what, double value, double truth, double unit) {
    Verdict v;
    v.pass = same_but_rounding(value, truth, unit);
    v.p = v.pass ? 1 : 0;
    v.text = print("%s is constant, %.17g, %s %.17g", what, value,
                   v.pass ? "as expected:" : "but expected was", truth);
    if (!v.pass && truth != 0) v.text += hint(value / truth, 1e-3);
    return v;
}

// The estimate's mean is `truth`: Student's t-test.
inline Verdict judge(const char* what, const Estimate& e, double truth) {
    if (!std::isfinite(e.mean) || !std::isfinite(e.standard_error))
        return failure(print("%s %g +- %g is not finite", what, e.mean, e.standard_error));
    if (!(e.df >= 1)) return failure("one number has no spread: no degree of freedom");
    if (e.standard_error <= 8 * e.unit * std::abs(e.mean))
        return judge_exact(what, e.mean, truth, e.unit);
    const double t = (e.mean - truth) / e.standard_error;
    Verdict v;
    v.p = p_of_t(t, e.df);
    ++statistical_checks;
    v.pass = v.p > alpha || same_but_rounding(e.mean, truth, e.unit);
    v.delta_min = smallest_shift(e.df) * e.standard_error / (truth != 0 ? std::abs(truth) : 1);
    v.text = print(
        "%s %.7g +- %.2g, expected %.7g: %+.2f sigma, %s; smallest bias seen with "
        "99.9 %% power: ",
        what, e.mean, e.standard_error, truth, t, print_p(v.p).c_str());
    v.text += truth != 0 ? print("%.2g %%", 100 * v.delta_min) : print("%.2g", v.delta_min);
    if (!v.pass && truth != 0)
        v.text += hint(e.mean / truth, 5 * e.standard_error / std::abs(truth));
    return v;
}

// ---- Means
// ---------------------------------------------------------------------------------------

// Half an ulp of 1 of the number that f returns.
template <class Number>
double unit_of(Number) {
    return double(std::numeric_limits<Number>::epsilon()) / 2;
}

// Numbers drawn, and what makes their mean untrustworthy.
struct Draws {
    Moments moments;
    std::vector<double> values;
    double unit = 0x1p-53;

    template <class Number>
    void add(Number number) {
        if constexpr (std::is_floating_point_v<Number>) unit = unit_of(number);
        values.push_back(double(number));
        moments.add(double(number));
    }

    bool constant() const {
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        return same_but_rounding(*least, *most, unit);
    }

    // Index xi of the tail, P(|x - mean| > t) ~ t^(-1/xi), from the k farthest numbers (Hill 1975);
    // its standard error is xi / sqrt(k).  Variance is infinite from 1/2 on.
    double tail_index(size_t k) const {
        std::vector<double> far;
        for (double x : values) far.push_back(std::abs(x - moments.mean));
        std::nth_element(far.begin(), far.begin() + long(k), far.end(), std::greater<>());
        double sum = 0;
        for (size_t i = 0; i < k; ++i) sum += std::log(far[i] / far[k]);
        return far[k] > 0 ? sum / double(k) : 0;
    }

    // Whether the tail is that of an infinite variance, as far as 400 numbers can tell: xi > 0.4,
    // and among the farthest of them still within 5 standard errors of 1/2, which bounded lumps are
    // not.
    bool heavy() const {
        const size_t k = 400;
        if (values.size() < 100 * k || tail_index(k) <= 0.4) return false;
        return tail_index(k / 4) * (1 + 5 / std::sqrt(k / 4)) > 0.5 &&
               tail_index(k / 16) * (1 + 5 / std::sqrt(k / 16)) > 0.5;
    }

    // Why the mean cannot be judged; empty if it can.  The t-test keeps its alpha within a factor
    // of 2 from n = 1000 skewness^2 on (measured with Bernoulli trials of 1 %).  A sample of n
    // normal numbers has a skewness of 0 +- sqrt(6 / n): five of those are no evidence.
    std::string problem() const {
        const double n = double(moments.n);
        if (values.empty()) return "no sample at all";
        for (size_t i = 0; i < values.size(); ++i)
            if (!std::isfinite(values[i]))
                return print("sample %zu is %g, not finite", i, values[i]);
        if (constant()) return "";
        if (values.size() < 2) return "one sample has no spread";
        const double skewness = std::max(0.0, std::abs(moments.skewness()) - 5 * std::sqrt(6 / n));
        const double needed = 1000 * skewness * skewness;
        if (n < needed)
            return print(
                "n = %.0f is too small for a skewness of %.2g: take %.0f or more; if it "
                "grows with n, the variance is infinite",
                n, moments.skewness(), needed);
        if (heavy())
            return print("the tail falls as t^-%.1f: the variance may be infinite",
                         1 / tail_index(400));
        return "";
    }
};

template <class F>
Draws draw(uint64_t n, F f) {
    Draws draws;
    for (uint64_t i = 0; i < n; ++i) draws.add(f());
    return draws;
}

inline Verdict judge(const char* what, const Draws& d, double truth) {
    if (const std::string why = d.problem(); !why.empty()) return failure(why);
    if (d.constant()) return judge_exact(what, d.moments.mean, truth, d.unit);
    return judge(what, estimate(d.moments, d.unit), truth);
}

// The mean of n independent draws f() is `truth`.
template <class F>
Verdict expect_mean(double truth, uint64_t n, F f) {
    return judge("mean", draw(n, f), truth);
}
inline Verdict expect_mean(double truth, const Estimate& e) { return judge("mean", e, truth); }

// Two independent estimates have the same mean: Welch's test (1947).  Exact if both are constant.
inline Verdict expect_equal(const Estimate& a, const Estimate& b) {
    const double va = a.standard_error * a.standard_error, vb = b.standard_error * b.standard_error;
    const double df = va + vb > 0 ? (va + vb) * (va + vb) / (va * va / a.df + vb * vb / b.df) : 1;
    const Estimate first{a.mean, std::sqrt(va + vb), df, std::max(a.unit, b.unit)};
    return judge("first of two means", first, b.mean);
}

// f() and g() have the same mean: n independent draws of each.
template <class F, class G>
Verdict expect_equal(F f, G g, uint64_t n) {
    const Draws a = draw(n, f), b = draw(n, g);
    if (const std::string why = a.problem(); !why.empty()) return failure(why).of("first");
    if (const std::string why = b.problem(); !why.empty()) return failure(why).of("second");
    return expect_equal(estimate(a.moments, a.unit), estimate(b.moments, b.unit));
}

// Quasi-Monte Carlo: f(r) is the whole estimate of the r-th independent randomisation of the point
// set.  Its samples depend on each other, so that a replicate is one number, taken as normal.
template <class F>
Verdict expect_replicates(double truth, int replicates, F f) {
    Draws d;
    for (int r = 0; r < replicates; ++r) d.add(f(r));
    if (0 < replicates && replicates < 16 && !d.constant())
        return failure(print("%d replicates show no significance of 1e-6: take 16", replicates));
    return judge("mean of replicates", d, truth);
}

// Consistent estimators: the bias of f(n), its error from n samples (less that of an unbiased
// estimate from the same samples, if this cancels noise), is constant / n + O(1 / n^2).  With B(n)
// = n f(n), 2 B(2n) - B(n) is `constant` up to O(1 / n^2).
template <class F>
Verdict expect_bias_decay(double constant, uint64_t n, uint64_t trials, F f) {
    const Draws a = draw(trials, [&] { return double(n) * f(n); });
    const Draws b = draw(trials, [&] { return double(2 * n) * f(2 * n); });
    if (const std::string why = a.problem(); !why.empty()) return failure(why);
    if (const std::string why = b.problem(); !why.empty()) return failure(why);
    const double error = std::hypot(2 * b.moments.standard_error(), a.moments.standard_error());
    const Estimate limit{2 * b.moments.mean - a.moments.mean, error, double(trials) - 1};
    return judge("limit of n * bias", limit, constant);
}

// ---- Distributions
// -------------------------------------------------------------------------------

// Distortion sqrt(sum (p - q)^2 / q) of the cells' probabilities that chi-squared over n samples
// sees with 99.9 % power: from the exact noncentral distribution, a Poisson mixture.
inline double smallest_distortion(int df, double n) {
    static std::map<int, double> known;
    const auto [at, is_new] = known.try_emplace(df, 0.0);
    if (is_new) {
        const double critical = where_equal([&](double x) { return p_of_chi2(x, df); }, alpha);
        auto missed = [&](double noncentrality) {
            double weight = std::exp(-noncentrality / 2), sum = 0;
            for (int j = 0; j < 400; weight *= noncentrality / 2 / ++j)
                sum += weight * (1 - p_of_chi2(critical, df + 2 * j));
            return sum;
        };
        at->second = where_equal(missed, 1e-3);
    }
    return std::sqrt(at->second / n);
}

// Counts follow the probabilities: chi-squared, on cells where 100 or more are expected, so that
// its p-value is good down to 1e-6.
template <class Counts, class Probabilities>
Verdict expect_counts(const Counts& counts, const Probabilities& probabilities) {
    double n = 0, chi2 = 0, fewest = std::numeric_limits<double>::infinity();
    int cells = 0;
    for (uint64_t count : counts) n += double(count);
    if (n == 0) return failure("no sample at all");
    for (size_t i = 0; i < std::size(counts); ++i) {
        const double expected = n * double(probabilities[i]), seen = double(counts[i]);
        if (expected <= 1e-6) {
            if (seen > 0)
                return failure(print("%.0f samples of %.0f where the density is 0", seen, n));
            continue;
        }
        fewest = std::min(fewest, expected);
        chi2 += (seen - expected) * (seen - expected) / expected;
        ++cells;
    }
    if (cells < 2) return failure("fewer than two cells");
    Verdict v;
    v.p = p_of_chi2(chi2, cells - 1);
    if (v.p > alpha && fewest < 100)
        return failure(print("n = %.0f is too small: %.1f expected in a cell, take %.0f", n, fewest,
                             std::ceil(100 * n / fewest)));
    ++statistical_checks;
    v.pass = v.p > alpha;
    v.delta_min = smallest_distortion(cells - 1, n);
    v.text = print(
        "chi2 = %.1f on %d cells (n = %.0f), %s; smallest distortion seen with "
        "99.9 %% power: %.2g %%",
        chi2, cells, n, print_p(v.p).c_str(), 100 * v.delta_min);
    return v;
}

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
    for (const auto& [end, inside] : {std::pair{f(a), low}, std::pair{f(b), high}})
        if (const double step = std::abs(end - inside);
            step > 0.25 * std::max(std::abs(end), std::abs(inside)))
            r.ends = std::max(r.ends, step * half * (1 - nodes[0].x));
    r.kronrod *= half;
    r.gauss *= half;
    return r;
}

// How closely parts of an integral must agree: within `tolerance`, the same for each part (a jump
// then costs log2(jump / tolerance) halvings, and few parts come close), or within `noise`, the
// relative rounding of f.  Two rules agree by chance where a kink lies just so: `halves` must, too.
struct Agreement {
    double tolerance = 0, noise = 0x1p-50;
    int depth = 30;  // halvings
    bool halves = true;
};

// Integral of f over [a,b], halved until it agrees.
template <class F>
double integral(const F& f, double a, double b, const Agreement& g, const Rule& whole, int depth) {
    const double rules = std::max(std::abs(whole.kronrod - whole.gauss), whole.ends);
    const double agree = std::max(g.tolerance, g.noise * std::abs(whole.kronrod));
    if (depth == 0 || (!g.halves && rules <= agree)) return whole.kronrod;
    const double middle = (a + b) / 2;
    const Rule left = rule(f, a, middle), right = rule(f, middle, b);
    const double sum = left.kronrod + right.kronrod;
    if (std::max(rules, std::abs(whole.kronrod - sum)) <= agree) return sum;
    return integral(f, a, middle, g, left, depth - 1) + integral(f, middle, b, g, right, depth - 1);
}
template <class F>
double integral(const F& f, double a, double b, const Agreement& g) {
    return integral(f, a, b, g, rule(f, a, b), g.depth);
}

// Cartesian coordinates in double of a point or direction, whatever its type.
using Triple = std::array<double, 3>;
template <class V>
Triple triple(const V& v) {
    return {double(v.x), double(v.y), double(v.z)};
}
inline double dot(const Triple& a, const Triple& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct DensityOptions {
    uint64_t n = 64000;
    Triple axis{0, 0, 1};  // about which the density is concentrated, if it is
    bool smooth = true;    // sample(u, v) is one smooth map, without choices
    double tolerance = 0;  // of the identities; 0: 1e-6, in float 1e-3
};

// pdf(x(u,v)) |dx/du x dx/dv| = 1 for a smooth map of the unit square to a surface in space (to the
// sphere, if x are directions): by differences of fourth order, without noise.
template <class Sample, class Pdf>
Verdict expect_jacobian(Random& random, Sample sample, Pdf pdf, double tolerance = 0) {
    const bool single = unit_of(sample(0.5, 0.5).x) > 1e-10;
    if (tolerance == 0) tolerance = single ? 1e-3 : 1e-6;
    Verdict v;
    v.pass = true;
    double worst = -1;
    for (int i = 0; i < 300 && v.pass; ++i) {
        const double at_u = 0.01 + 0.98 * random(), at_v = 0.01 + 0.98 * random();
        auto slope = [&](bool along_u) {
            const double u = along_u ? at_u : at_v;
            const double h = (single ? 0.05 : 2e-3) * std::min(u, 1 - u);
            auto x = [&](double by) {
                return triple(along_u ? sample(at_u + by, at_v) : sample(at_u, at_v + by));
            };
            const Triple p1 = x(h), m1 = x(-h), p2 = x(2 * h), m2 = x(-2 * h);
            Triple d;
            for (size_t k = 0; k < 3; ++k)
                d[k] = (8 * (p1[k] - m1[k]) - (p2[k] - m2[k])) / (12 * h);
            return d;
        };
        const Triple a = slope(true), b = slope(false);
        const double area = std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                       a[0] * b[1] - a[1] * b[0]);
        const double product = double(pdf(sample(at_u, at_v))) * area;
        if (std::abs(product - 1) <= worst) continue;
        worst = std::abs(product - 1);
        v.pass = worst <= tolerance;
        v.text = print("pdf |dx/du x dx/dv| = %.8g at u = (%.4f, %.4f), expected 1 +- %.0e",
                       product, at_u, at_v, tolerance);
        if (!v.pass) v.text += hint(product, 1e-3);
    }
    v.p = v.pass ? 1 : 0;
    v.delta_min = tolerance;
    return v;
}

// Polar coordinates about an axis.
struct Polar {
    double theta = 0, phi = 0;
};
struct PolarFrame {
    Triple x, y, z;
    // Duff et al. 2017; in double, whatever the renderer's precision.
    explicit PolarFrame(const Triple& along) : z(along) {
        const double sign = std::copysign(1.0, z[2]), a = -1 / (sign + z[2]), b = z[0] * z[1] * a;
        x = {1 + sign * z[0] * z[0] * a, sign * b, -sign * z[0]};
        y = {b, sign + z[1] * z[1] * a, -z[1]};
    }
    Polar of(const Triple& w) const {
        const double phi = std::atan2(dot(w, y), dot(w, x));
        return {std::atan2(std::hypot(dot(w, x), dot(w, y)), dot(w, z)),
                phi < 0 ? phi + 2 * std::numbers::pi : phi};
    }
    Triple direction(Polar p) const {
        const double s = std::sin(p.theta), a = s * std::cos(p.phi), b = s * std::sin(p.phi);
        const double c = std::cos(p.theta);
        return {a * x[0] + b * y[0] + c * z[0], a * x[1] + b * y[1] + c * z[1],
                a * x[2] + b * y[2] + c * z[2]};
    }
};

// 8 x 4 cells in (theta, phi), as equal as the quantiles of a few samples make them.
struct Cells {
    static constexpr size_t bands = 8, sectors = 4;
    double theta[bands + 1] = {};
    double phi[bands][sectors + 1] = {};

    explicit Cells(std::vector<Polar> samples) {
        using std::numbers::pi;
        std::sort(samples.begin(), samples.end(), [](auto p, auto q) { return p.theta < q.theta; });
        const size_t in_band = samples.size() / bands;
        for (size_t i = 0; i < bands; ++i) {
            theta[i + 1] = i + 1 < bands ? samples[(i + 1) * in_band].theta : pi;
            const auto begin = samples.begin() + long(i * in_band);
            std::sort(begin, begin + long(in_band), [](auto p, auto q) { return p.phi < q.phi; });
            for (size_t j = 1; j < sectors; ++j) phi[i][j] = begin[long(j * in_band / sectors)].phi;
            phi[i][sectors] = 2 * pi;
        }
    }

    size_t of(Polar p) const {
        const auto i = std::upper_bound(theta + 1, theta + bands, p.theta) - (theta + 1);
        const auto j = std::upper_bound(phi[i] + 1, phi[i] + sectors, p.phi) - (phi[i] + 1);
        return size_t(i) * sectors + size_t(j);
    }

    // Integral of density(Polar) sin(theta) over each.  Panels in theta double in width, so that no
    // narrow lobe about the axis hides between the nodes.
    template <class Density>
    std::array<double, bands * sectors> integrals(const Density& density, double tolerance,
                                                  double noise) const {
        using std::numbers::pi;
        const int depth = 1 - std::ilogb(noise);  // no finer than f can tell where it jumps
        std::array<double, bands * sectors> sums{};
        for (size_t cell = 0; cell < sums.size(); ++cell) {
            const size_t i = cell / sectors;
            const double* range = phi[i] + cell % sectors;
            const double panels = std::ceil((range[1] - range[0]) / (0.6 * pi));
            const double step = (range[1] - range[0]) / panels;
            for (double from = theta[i], to; from < theta[i + 1]; from = to) {
                to = from > 0 ? std::min({2 * from, from + pi / 8, theta[i + 1]})
                              : std::ldexp(theta[i + 1], -12);
                const Agreement along_phi{0.1 * tolerance / (to - from), noise, depth, false};
                auto ring = [&](double t) {
                    auto at = [&](double f) { return density({t, f}); };
                    double sum = 0;
                    for (double k = 0; k < panels; ++k)
                        sum +=
                            integral(at, range[0] + k * step, range[0] + (k + 1) * step, along_phi);
                    return sum * std::sin(t);
                };
                sums[cell] +=
                    integral(ring, from, to, Agreement{tolerance, 2 * noise, depth, true});
            }
        }
        return sums;
    }
};

// Directions sample(u, v) with density pdf(direction) per solid angle: the Jacobian, if the map is
// smooth; the integral of pdf over the sphere, 1 by quadrature; pdf > 0 at every sample;
// chi-squared over cells.
template <class Sample, class Pdf>
Verdict expect_density(Random& random, Sample sample, Pdf pdf, DensityOptions o = {}) {
    using V = decltype(sample(0.5, 0.5));
    using T = decltype(V::x);
    const double unit = unit_of(T{});
    if (o.smooth)
        if (const Verdict v = expect_jacobian(random, sample, pdf, o.tolerance); !v.pass) return v;

    const PolarFrame frame_of_axis(o.axis);
    std::string bad;  // why a sample cannot be
    auto draw_one = [&] {
        const double u = random(), v = random();
        const V w = sample(u, v);
        const double p = double(pdf(w));
        if (!(p > 0 && std::isfinite(p)) && bad.empty())
            bad = print("the density is %g at the sample (%g, %g, %g)", p, double(w.x), double(w.y),
                        double(w.z));
        return frame_of_axis.of(triple(w));
    };
    auto density = [&](Polar p) {
        const Triple w = frame_of_axis.direction(p);
        return double(pdf(V{T(w[0]), T(w[1]), T(w[2])}));
    };

    std::vector<Polar> pilot(4096);
    for (Polar& p : pilot) p = draw_one();
    if (!bad.empty()) return failure(bad);
    const Cells cells(pilot);
    const double allowed = o.tolerance > 0 ? o.tolerance : std::max(1e-6, 512 * unit);
    const auto probabilities = cells.integrals(density, allowed / 300, allowed / 8);
    double total = 0;
    for (double p : probabilities) total += p;
    if (!(std::abs(total - 1) <= allowed)) {
        Verdict v = failure(print("the integral of pdf over the sphere is %.8g, expected 1 +- %.0e",
                                  total, allowed));
        v.text += hint(total, 1e-3);
        return v;
    }

    std::array<uint64_t, Cells::bands * Cells::sectors> counts{};
    for (uint64_t i = 0; i < o.n; ++i) {
        const Polar p = draw_one();
        if (!bad.empty()) return failure(bad);
        ++counts[cells.of(p)];
    }
    return expect_counts(counts, probabilities);
}

// oracle/numbers.h  appendix: tails of distributions, integrals, domains and their cells,
// derivatives of maps
#pragma once
#include "checks.h"

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

// oracle/hints.h  from the facts that a check found to "looks like ...": nothing here decides
// whether it passes
#pragma once
#include "checks.h"

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

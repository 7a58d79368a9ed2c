// oracle/mistakes_of_light.h  the catalogue goes on: lights, choices, estimators, BSDFs
#pragma once
#include "oracle/mistakes.h"

namespace mistakes {

// ---- Lights, seen from the origin ---------------------------------------------------------------

// Where a point of (y, z) lies, and whether one does, in the plane x = 1.5.
inline const std::pair quad{
    [](auto u, auto v) {
        return std::pair{u - 0.5, 2 * v + 0.5};
    },
    [](auto y, auto z) { return std::abs(y) <= 0.5 && 0.5 <= z && z <= 2.5; }};
// Corners (0,0), (1,0), (0,2).
inline const auto in_triangle = [](auto y, auto z) { return y >= 0 && z >= 0 && y + z / 2 <= 1; };
inline const std::pair triangle{[](auto u, auto v) {
                                    const auto s = std::sqrt(u);
                                    return std::pair{s * (1 - v), 2 * s * v};
                                },
                                in_triangle};

// A light that looks along -x; pdf(r^2, cosine at the light, cosine at the receiver).
template <class T, class Area, class Pdf>
Mistake light(std::string name, std::string expected, Area area, Pdf pdf) {
    return density<T>(
        name, expected,
        [=](T u, T v) {
            const auto [y, z] = area.first(u, v);
            return unit(Vec<T>{T(1.5), T(y), T(z)});
        },
        [=](Vec<T> w) {
            const T t = T(1.5) / w.x;
            return w.x > 0 && area.second(t * w.y, t * w.z) ? T(pdf(t * t, w.x, w.z)) : T(0);
        },
        {{"r^2", [](const Triple& w) { return 2.25 / (w[0] * w[0]); }},
         {"cos at the light", [](const Triple& w) { return w[0]; }},
         {"cos at the receiver", [](const Triple& w) { return w[2]; }}});
}

inline Mistakes lights() {
    const std::pair rootless{[](auto u, auto v) {
                                 return std::pair{u * (1 - v), 2 * u * v};
                             },
                             in_triangle};
    auto of_quad = [](auto r2, auto c, auto) { return r2 / (2 * c); };
    auto of_triangle = [](auto r2, auto c, auto) { return r2 / c; };
    return {
        light<double>("quad light", "", quad, of_quad),
        light<float>("triangle light, float", "", triangle, of_triangle),
        light<double>("no cosine at the light", "cos at the light too many", quad,
                      [](auto r2, auto, auto) { return r2 / 2; }),
        light<float>("no r^2", "r^2 forgotten", triangle, [](auto, auto c, auto) { return 1 / c; }),
        light<double>("divided by the receiver's cosine, too", "cos at the receiver forgotten",
                      quad,
                      [](auto r2, auto c, auto at_receiver) { return r2 / (2 * c * at_receiver); }),
        light<float>("triangle's area without 1/2", "(1/2, half) times the density", triangle,
                     of_quad),
        light<float>("triangle by (1-u, u (1-v)), without root",
                     "times as dense as the pdf says, at", rootless, of_triangle),
        light<double>("r^2 cos / A for r^2 / (A cos)",
                      "multiplied by cos at the light in place of divided", quad,
                      [](auto r2, auto c, auto) { return r2 * c / 2; }),
    };
}

// ---- Points and numbers, choices, mixtures ------------------------------------------------------

template <class Choose, class Probability>
Mistake choice(std::string name, std::string expected, int count, Choose choose,
               Probability probability) {
    return {name, expected, [=](Random& random) {
                return oracle::expect_choice(random, choose, probability, count);
            }};
}

// Index of u among the sums of weights of `power`.
inline int among(const std::array<double, 4>& power, double u, int last = 3) {
    double sum = 0;
    for (int i = 0; i < last; ++i)
        if (sum += power[size_t(i)]; u < sum) return i;
    return last;
}

inline Mistakes choices() {
    const std::array<double, 4> power{0.1, 0.4, 0.3, 0.2};
    auto right = [=](double u) { return among(power, u); };
    auto its = [=](int i) { return power[size_t(i)]; };
    return {
        choice("choice by power", "", 4, right, its),
        choice(
            "the search ends one before the last light", "index 3 is never chosen", 4,
            [=](double u) { return among(power, u, 2); }, its),
        choice(
            "uniform choice, probabilities by power", "looks like a uniform choice", 4,
            [](double u) { return int(4 * u); }, its),
        choice(
            "choice between two turned round", "the two exchanged (p for 1 - p)", 2,
            [](double u) { return u < 0.3 ? 1 : 0; }, [](int i) { return i == 0 ? 0.3 : 0.7; }),
        choice("weights for probabilities", "the probabilities sum to 2.5", 4, right,
               [=](int i) { return 2.5 * power[size_t(i)]; }),
    };
}

inline Mistakes points() {
    using Pair = std::pair<double, double>;
    auto disc = [](double exponent) {
        return [=](double u, double v) {
            const double r = std::pow(u, exponent);
            return Pair{r * std::cos(2 * pi * v), r * std::sin(2 * pi * v)};
        };
    };
    auto disc_pdf = [](Pair p) {
        return p.first * p.first + p.second * p.second <= 1 ? 1 / pi : 0;
    };
    auto flight = [](std::string name, std::string expected, float sigma) {
        return any_density(
            name, expected, [](float u) { return -std::log(1 - u) / 2.5f; },
            [=](float t) { return t >= 0 ? sigma * std::exp(-2.5f * t) : 0; }, {{"sigma", 2.5}});
    };
    // Half cosine, half a Phong lobe of exponent 20; `scaled` uses the chosen number afresh.
    auto mixture = [](bool scaled) {
        return [=](double u, double v) {
            const bool first = u < 0.5;
            if (scaled) u = first ? 2 * u : 2 * u - 1;
            return polar(first ? std::sqrt(u) : std::pow(u, 1 / 21.0), 2 * pi * v);
        };
    };
    auto mixture_pdf = [](double weight) {
        return above([=](double z) { return weight * (z / pi + 21 / (2 * pi) * std::pow(z, 20)); });
    };
    return {
        any_density("disc", "", disc(0.5), disc_pdf),
        flight("free flight, float", "", 2.5f),
        density<double>("mixture", "", mixture(true), mixture_pdf(0.5)),
        any_density("disc without root", "r drawn uniformly, without its root", disc(1), disc_pdf),
        flight("flight without sigma: the transmittance", "sigma forgotten", 1),
        density<double>("mixture without weights: the sum of both pdfs",
                        "integrates to 2 (2, twice)", mixture(true), mixture_pdf(1)),
        density<double>("number not scaled after the choice", "times as dense as the pdf says, at",
                        mixture(false), mixture_pdf(0.5)),
    };
}

// ---- Estimators ---------------------------------------------------------------------------------

// Irradiance by one of two lights, a small rectangle at (1.5, 0, 2) that looks along -x, chosen
// with 0.3; the other is black.
struct Lit {
    double co, cl, r, power;  // cosine at the receiver, at the light; emitted power / pi
    double right() const { return co * cl / (r * r) * power; }
};
template <class Formula>
Mistake direct(std::string name, std::string expected, Formula formula) {
    auto estimate = [=](Random& random) {
        if (random() >= 0.3) return 0.0;
        const double y = 0.02 * (random() - 0.5), z = 2 + 0.02 * (random() - 0.5);
        const double r = std::sqrt(1.5 * 1.5 + y * y + z * z);
        return formula(Lit{z / r, 1.5 / r, r, 1000 * 0.02 * 0.02});
    };
    return mean(name, expected, 0.4 * 0.48 / 6.25, estimate,
                {{"pick probability", 0.3},
                 {"r^2", 6.25},
                 {"cos at the light", 0.6},
                 {"cos at the receiver", 0.8}});
}

// Irradiance by a sphere of radius 0.5 and radiance 1 over the receiver, 2 away, from its area.
template <class Cosine>
Mistake sphere(std::string name, std::string expected, double area, Cosine of) {
    return mean(name, expected, pi / 16, [=](Random& random) {
        const double u = random(), v = random();
        const D n = polar(1 - 2 * u, 2 * pi * v), to = D{0, 0, 2} + 0.5 * n;
        const double r2 = dot(to, to), r = std::sqrt(r2);
        return of(-dot(to, n) / r) * to.z / r / r2 * area;
    });
}

// Radiance 1/(1 - albedo) in a furnace: roulette survives with q and weighs by `weight`.
inline Mistake furnace(std::string name, std::string expected, double albedo, double q,
                       double weight, double emitted = 1, bool turned = false) {
    auto path = [=](Random& random) {
        double sum = 1;
        for (double beta = 1; (random() < q) != turned;)
            if (sum += emitted * (beta *= albedo * weight); beta < 1e-12) break;
        return sum;
    };
    return mean(name, expected, 1 / (1 - albedo), path,
                {{"survival probability", q}, {"albedo", albedo}});
}

inline Mistakes estimators() {
    // Integral of x^2 over [0,1] from one sample of density 1, one of 2x, and their weights.
    auto mis = [](std::string name, std::string expected, auto weight) {
        return mean(name, expected, 1.0 / 3, [=](Random& random) {
            const double a = random(), b = std::sqrt(random());
            return weight(1, 2 * a) * a * a + weight(2 * b, 1) * b * b / (2 * b);
        });
    };
    auto positive = [](double c) { return std::max(0.0, c); };
    return {
        direct("direct light", "", [](Lit x) { return x.right() / 0.3; }),
        direct("not divided by the pick probability", "1/(pick probability) forgotten",
               [](Lit x) { return x.right(); }),
        direct("no r^2 in the estimate", "1/(r^2) forgotten",
               [](Lit x) { return x.right() * x.r * x.r / 0.3; }),
        direct("1/r for 1/r^2", "a root of r^2", [](Lit x) { return x.right() * x.r / 0.3; }),
        direct("no light's cosine", "cos at the light forgotten",
               [](Lit x) { return x.right() / x.cl / 0.3; }),
        sphere("sphere by area", "", pi, positive),
        sphere("sphere's area pi R^2", "(1/4)", pi / 4, positive),
        sphere("back side counted", "(2, twice)", pi, [](double c) { return std::abs(c); }),
        furnace("furnace", "", 0.6, 0.75, 1 / 0.75),
        furnace("survivors of roulette not divided", "ratio 0.66", 0.5, 0.5, 1),
        furnace("emission added on a hit after it was sampled", "ratio 1.6", 0.6, 0.75, 1 / 0.75,
                2),
        mis("balance heuristic", "", [](double p, double q) { return p / (p + q); }),
        mis("weights that are never filled in", "0 in every sample",
            [](double, double) { return 0.0; }),
        mis("both techniques without weights", "(2, twice)", [](double, double) { return 1.0; }),
        mean("reflected radiance without 1/pi", "1/pi forgotten", 0.6,
             [](Random& r) { return 0.6 * r() * 2 * pi; }),
        mean("1 sampled by 2x: infinite variance", "variance may be infinite", 1,
             [](Random& r) { return 1 / (2 * std::sqrt(1 - r())); }),
        mean("ratio of sums, 0/0 where no sample is lit", "not finite", 0.5,
             [](Random& r) {
                 double lit = 0, all = 0;
                 for (int i = 0; i < 2; ++i)
                     if (const double x = r(); x < 0.5) all += 1, lit += r() < 0.5 ? 1 : 0;
                 return lit / all;
             }),
    };
}

// ---- BSDFs --------------------------------------------------------------------------------------

// eval(wo, wi), 0 where one of them is below the horizon, under directions by the cosine.
template <class Eval>
Mistake bsdf(std::string name, std::string expected, Eval eval) {
    return {name, expected, [=](Random& random) {
                return oracle::expect_bsdf(
                    random, [](D, double u, double v) { return by_cosine(u, v); },
                    [](D wo, D wi) { return wo.z > 0 ? cosine_pdf(wi) : 0.0; },
                    [=](D wo, D wi) { return wo.z > 0 && wi.z > 0 ? eval(wo, wi) : 0.0; });
            }};
}

inline Mistakes bsdfs() {
    return {
        bsdf("Lambert", "", [](D, D) { return 0.6 / pi; }),
        bsdf("Lambert without 1/pi", "a constant factor (1/pi, 1/4)", [](D, D) { return 0.6; }),
        bsdf("the integrator's cosine in eval, too", "the cosine of wi included in eval",
             [](D, D wi) { return 0.6 / pi * wi.z; }),
        bsdf("negative BRDF at grazing angles", "eval is negative",
             [](D wo, D wi) { return 0.6 / pi * (wo.z * wi.z - 0.05); }),
    };
}

// Quasi-Monte Carlo: mean of xy, 1/4, over 16 points of a Kronecker set, shifted by the replicate.
inline Mistakes replicates() {
    auto set = [](std::string name, std::string expected, bool shifted, bool same) {
        return Mistake{name, expected, [=](Random& random) {
                           return oracle::expect_replicates(0.25, 64, [&](int) {
                               const double s = shifted ? random() : 0, t = shifted ? random() : 0;
                               double sum = 0;
                               for (int i = 0; i < 16; ++i) {
                                   const double x = std::fmod(s + 0.7548776662 * i, 1);
                                   const double y = std::fmod(t + 0.5698402910 * i, 1);
                                   sum += x * (same ? x : y);
                               }
                               return sum / 16;
                           });
                       }};
    };
    return {
        set("shifted set", "", true, false),
        set("no shift: one set, 64 times", "is constant", false, false),
        set("both dimensions of one base", "ratio 1.3", true, true),
    };
}

// ---- All ----------------------------------------------------------------------------------------

inline Mistakes joined(const std::vector<Mistakes>& families) {
    Mistakes sum;
    for (const Mistakes& family : families) sum.insert(sum.end(), family.begin(), family.end());
    return sum;
}
inline Mistakes all() {
    return joined({hemispheres(), frames(), lobes(), microfacets(), lights(), choices(), points(),
                   estimators(), bsdfs(), replicates()});
}

}  // namespace mistakes

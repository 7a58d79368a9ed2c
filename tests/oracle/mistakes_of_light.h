// oracle/mistakes_of_light.h  the catalogue goes on: lights, choices, estimators, BSDFs
#pragma once
#include "oracle/mistakes.h"

namespace mistakes {

// ---- Lights, seen from the origin
// ---------------------------------------------------------------

// A rectangle or triangle in the plane x = 1.5 that looks along -x; pdf(r^2, cosine at the light,
// cosine at the receiver).
template <class T, class Point, class Inside, class Pdf>
Mistake light(std::string name, std::string wrong, Words expected, Point point, Inside inside,
              Pdf pdf) {
    auto run = [=](Random& random) {
        auto r2 = [](const auto& w) {
            const double t = 1.5 / plain(w).x;
            return t * t;
        };
        auto sample = [=](T u, T v) {
            const auto [y, z] = point(u, v);
            return unit(Dir<T>{T(1.5), T(y), T(z)});
        };
        auto whole = [=](Dir<T> w) {
            const T t = T(1.5) / w.x;
            return w.x > 0 && inside(t * w.y, t * w.z) ? pdf(t * t, w.x, w.z) : T(0);
        };
        return oracle::expect_density(
            random, sample, whole,
            {.factors = {{"r^2", r2},
                         {"cos at the light", [](const auto& w) { return plain(w).x; }},
                         {"cos at the receiver", [](const auto& w) { return plain(w).z; }}}});
    };
    return {name, wrong, expected, run};
}

inline Mistakes lights() {
    auto quad = [](double u, double v) { return std::pair{u - 0.5, 2 * v + 0.5}; };
    auto in_quad = [](double y, double z) { return std::abs(y) <= 0.5 && 0.5 <= z && z <= 2.5; };
    // Corners (0,0), (1,0), (0,2) in (y,z).
    auto triangle = [](float u, float v) {
        const float s = std::sqrt(u);
        return std::pair{s * (1 - v), 2 * s * v};
    };
    auto in_triangle = [](float y, float z) { return y >= 0 && z >= 0 && y + z / 2 <= 1; };
    using D = double;
    return {
        light<D>("quad light", "", {}, quad, in_quad, [](D r2, D c, D) { return r2 / (2 * c); }),
        light<float>("triangle light, float", "", {}, triangle, in_triangle,
                     [](float r2, float c, float) { return r2 / c; }),
        light<D>("no cosine at the light", "The pdf r^2/A lacks the light's cosine.",
                 {"cos at the light"}, quad, in_quad, [](D r2, D, D) { return r2 / 2; }),
        light<float>("no r^2", "The pdf 1/(A cos) lacks the squared distance.", {"r^2"}, triangle,
                     in_triangle, [](float, float c, float) { return 1 / c; }),
        light<D>("receiver's cosine", "The pdf divides by the receiver's cosine, too.",
                 {"cos at the receiver"}, quad, in_quad,
                 [](D r2, D c, D at_receiver) { return r2 / (2 * c * at_receiver); }),
        light<float>("parallelogram's area", "The triangle's area lacks 1/2.",
                     {"2", "1/2", "half", "twice"}, triangle, in_triangle,
                     [](float r2, float c, float) { return r2 / (2 * c); }),
        light<float>(
            "triangle without root", "The barycentric coordinates are (1-u, u (1-v)).",
            {"root", "sqrt", "square root", "corner"},
            [](float u, float v) {
                return std::pair{u * (1 - v), 2 * u * v};
            },
            in_triangle, [](float r2, float c, float) { return r2 / c; }),
        light<D>("cosine in the numerator", "The pdf is r^2 cos / A, not r^2 / (A cos).",
                 {"cos at the light"}, quad, in_quad, [](D r2, D c, D) { return r2 * c / 2; }),
    };
}

// ---- Points and numbers, choices, mixtures
// ---------------------------------------------------------------

struct Point2 {
    double x, y;
};

template <class Choose, class Probability>
Mistake choice(std::string name, std::string wrong, Words expected, int count, Choose choose,
               Probability probability) {
    return {name, wrong, expected, [=](Random& random) {
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
        choice("choice by power", "", {}, 4, right, its),
        choice(
            "last never chosen", "The search ends one before the last light.",
            {"never", "never chosen", "last"}, 4, [=](double u) { return among(power, u, 2); },
            its),
        choice(
            "uniform choice", "Lights are chosen alike, with probabilities by power.",
            {"uniform", "equal", "alike", "equally", "same for all"}, 4,
            [](double u) { return int(4 * u); }, its),
        choice(
            "p for 1 - p", "The comparison of a choice between two is turned round.",
            {"exchanged", "swapped", "complement", "1 - p", "each other"}, 2,
            [](double u) { return u < 0.3 ? 1 : 0; }, [](int i) { return i == 0 ? 0.3 : 0.7; }),
        choice("probabilities not normalized", "Weights are handed out, not their shares.",
               {"sum", "sum to", "add up", "normalized", "normalised"}, 4, right,
               [=](int i) { return 2.5 * power[size_t(i)]; }),
    };
}

inline Mistakes points() {
    auto disc = [](bool root) {
        return [=](double u, double v) {
            const double r = root ? std::sqrt(u) : u;
            return Point2{r * std::cos(2 * pi * v), r * std::sin(2 * pi * v)};
        };
    };
    auto disc_pdf = [](Point2 p) { return p.x * p.x + p.y * p.y <= 1 ? 1 / pi : 0; };
    auto flight = [](float u) { return -std::log(1 - u) / 2.5f; };
    auto flight_pdf = [](float sigma) {
        return [=](float t) { return t >= 0 ? sigma * std::exp(-2.5f * t) : 0; };
    };
    auto walk = [](std::string name, std::string wrong, Words expected, auto sample, auto pdf) {
        return Mistake{name, wrong, expected, [=](Random& random) {
                           return oracle::expect_density(
                               random, sample, pdf,
                               {.factors = {{"sigma", [](const auto&) { return 2.5; }}}});
                       }};
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
        return [=](Dir<double> w) {
            return w.z > 0 ? weight * (w.z / pi + 21 / (2 * pi) * std::pow(w.z, 20)) : 0;
        };
    };
    return {
        density("disc", "", {}, disc(true), disc_pdf),
        walk("free flight, float", "", {}, flight, flight_pdf(2.5f)),
        density("mixture", "", {}, mixture(true), mixture_pdf(0.5)),
        density("disc without root", "The radius is u, not its root.",
                {"root", "sqrt", "square root"}, disc(false), disc_pdf),
        walk("flight without sigma", "The pdf is exp(-sigma t), the transmittance.", {"sigma"},
             flight, flight_pdf(1)),
        density("mixture without weights", "The pdf is the sum of both lobes'.",
                {"2", "1/2", "half", "twice"}, mixture(true), mixture_pdf(1)),
        density("number not scaled after the choice",
                "The number that chose the lobe places the direction, too, as it is.",
                {"half", "again", "scaled", "rescaled", "reused", "stretched", "choice"},
                mixture(false), mixture_pdf(0.5)),
    };
}

// ---- Estimators
// ---------------------------------------------------------------

// Irradiance by one of two lights, a small rectangle at (1.5, 0, 2) that looks along -x, chosen
// with 0.3; the other is black.  formula(cosine at the receiver, at the light, r, emitted power /
// pi).
template <class Formula>
Mistake direct(std::string name, std::string wrong, Words expected, Formula formula) {
    auto run = [=](Random& random) {
        auto estimate = [&] {
            if (random() >= 0.3) return 0.0;
            const double y = 0.02 * (random() - 0.5), z = 2 + 0.02 * (random() - 0.5);
            const double r = std::sqrt(1.5 * 1.5 + y * y + z * z);
            return formula(z / r, 1.5 / r, r, 1000 * 0.02 * 0.02);
        };
        return oracle::expect_mean(0.4 * 0.48 / 6.25, 100000, estimate,
                                   {.factors = {{"pick probability", 0.3},
                                                {"r^2", 6.25},
                                                {"cos at the light", 0.6},
                                                {"cos at the receiver", 0.8}}});
    };
    return {name, wrong, expected, run};
}

// Irradiance by a sphere of radius 0.5 and radiance 1 over the receiver, 2 away, from its area.
template <class Cosine>
Mistake sphere(std::string name, std::string wrong, Words expected, double area, Cosine cosine) {
    auto run = [=](Random& random) {
        auto estimate = [&] {
            const double u = random(), v = random();
            const Dir<double> n = polar(1 - 2 * u, 2 * pi * v);
            const Dir<double> to = Dir<double>{0, 0, 2} + 0.5 * n;
            const double r2 = dot(to, to), r = std::sqrt(r2);
            return cosine(-dot(to, n) / r) * to.z / r / r2 * area;
        };
        return oracle::expect_mean(pi / 16, 100000, estimate);
    };
    return {name, wrong, expected, run};
}

// Radiance 1/(1 - albedo) in a furnace: roulette survives with q and weighs by `weight`.
inline Mistake furnace(std::string name, std::string wrong, Words expected, double albedo, double q,
                       double weight, double emitted = 1, bool turned = false) {
    auto run = [=](Random& random) {
        auto path = [&] {
            double sum = 1;
            for (double beta = 1; (random() < q) != turned;)
                if (sum += emitted * (beta *= albedo * weight); beta < 1e-12) break;
            return sum;
        };
        return oracle::expect_mean(1 / (1 - albedo), 100000, path,
                                   {.factors = {{"survival probability", q}, {"albedo", albedo}}});
    };
    return {name, wrong, expected, run};
}

inline Mistakes estimators() {
    auto positive = [](double c) { return std::max(0.0, c); };
    // Integral of x^2 over [0,1] from one sample of density 1, one of 2x, and their weights.
    auto mis = [](std::string name, std::string wrong, Words expected, auto weight) {
        return Mistake{name, wrong, expected, [=](Random& random) {
                           auto estimate = [&] {
                               const double a = random(), b = std::sqrt(random());
                               return weight(1, 2 * a) * a * a + weight(2 * b, 1) * b * b / (2 * b);
                           };
                           return oracle::expect_mean(1.0 / 3, 100000, estimate);
                       }};
    };
    auto mean = [](std::string name, std::string wrong, Words expected, double truth, auto f) {
        return Mistake{name, wrong, expected, [=](Random& random) {
                           return oracle::expect_mean(truth, 100000, [&] { return f(random); });
                       }};
    };
    const Words survival{"survival probability", "roulette"};
    return {
        direct(
            "direct light", "", {},
            [](double co, double cl, double r, double la) { return co * cl / (r * r) * la / 0.3; }),
        direct("no pick probability", "The sum over lights is not divided by it.",
               {"pick probability"},
               [](double co, double cl, double r, double la) { return co * cl / (r * r) * la; }),
        direct("no r^2 in the estimate", "The squared distance is missing.", {"r^2"},
               [](double co, double cl, double, double la) { return co * cl * la / 0.3; }),
        direct("1/r", "The light falls with the distance, not its square.",
               {"r^2", "r", "distance", "root of r^2", "sqrt(r^2)"},
               [](double co, double cl, double r, double la) { return co * cl / r * la / 0.3; }),
        direct("no light's cosine", "The cosine at the light is missing.", {"cos at the light"},
               [](double co, double, double r, double la) { return co / (r * r) * la / 0.3; }),
        sphere("sphere by area", "", {}, pi, positive),
        sphere("disc's area", "The sphere's area is taken for pi R^2.",
               {"4", "1/4", "area", "sphere's area"}, pi / 4, positive),
        sphere("back side counted", "|cos| counts the far side of the light.",
               {"2", "twice", "both sides", "back"}, pi, [](double c) { return std::abs(c); }),
        furnace("furnace", "", {}, 0.6, 0.75, 1 / 0.75),
        furnace("roulette not divided", "Survivors do not carry the weight of the dead.", survival,
                0.5, 0.5, 1),
        furnace("emission twice", "Emission is added on a hit after it was sampled.",
                {"2", "twice", "emission"}, 0.6, 0.75, 1 / 0.75, 2),
        mis("balance heuristic", "", {}, [](double p, double q) { return p / (p + q); }),
        mis("power heuristic 0", "The weight is never filled in.",
            {"zero", "0", "exactly zero", "black"}, [](double, double) { return 0.0; }),
        mis("no weights", "Both techniques count fully.", {"2", "twice", "weights"},
            [](double, double) { return 1.0; }),
        mean("reflected radiance without 1/pi", "The albedo is taken for the BRDF.", {"pi", "1/pi"},
             0.6, [](Random& r) { return 0.6 * r() * 2 * pi; }),
        mean("density vanishes", "1 is sampled by 2x: the tail's variance is infinite.",
             {"infinite", "variance", "tail"}, 1,
             [](Random& r) { return 1 / (2 * std::sqrt(1 - r())); }),
        mean("0/0 where no sample is lit", "A ratio of sums is not guarded.",
             {"finite", "not finite", "nan"}, 0.5,
             [](Random& r) {
                 double lit = 0, all = 0;
                 for (int i = 0; i < 2; ++i)
                     if (const double x = r(); x < 0.5) all += 1, lit += r() < 0.5 ? 1 : 0;
                 return lit / all;
             }),
    };
}

// ---- BSDFs
// ---------------------------------------------------------------

inline Mistakes bsdfs() {
    using D = Dir<double>;
    auto lambert = [](std::string name, std::string wrong, Words expected, auto eval) {
        return Mistake{
            name, wrong, expected, [=](Random& random) {
                auto sample = [](D, double u, double v) { return cosine_sample<double>()(u, v); };
                auto pdf = [](D wo, D wi) { return wo.z > 0 ? cosine_pdf<double>()(wi) : 0.0; };
                return oracle::expect_bsdf(random, sample, pdf, eval);
            }};
    };
    auto both = [](D wo, D wi) { return wo.z > 0 && wi.z > 0; };
    return {
        lambert("Lambert", "", {}, [=](D wo, D wi) { return both(wo, wi) ? 0.6 / pi : 0; }),
        lambert("Lambert without 1/pi", "The albedo is taken for the BRDF.",
                {"albedo", "energy", "pi", "1/pi"},
                [=](D wo, D wi) { return both(wo, wi) ? 0.6 : 0; }),
        lambert("cosine in the BRDF", "eval holds the cosine that the integrator adds, too.",
                {"reciprocal", "reciprocity", "cosine"},
                [=](D wo, D wi) { return both(wo, wi) ? 0.6 / pi * wi.z : 0; }),
        lambert("negative BRDF", "A Fresnel term overshoots at grazing angles.",
                {"negative", "below zero"},
                [=](D wo, D wi) { return both(wo, wi) ? 0.6 / pi * (wo.z * wi.z - 0.05) : 0; }),
    };
}

// Quasi-Monte Carlo: mean of xy, 1/4, over 16 points of a Kronecker set, shifted by the replicate.
inline Mistakes replicates() {
    auto set = [](std::string name, std::string wrong, Words expected, bool shifted, bool same) {
        return Mistake{name, wrong, expected, [=](Random& random) {
                           auto estimate = [&](int) {
                               const double s = shifted ? random() : 0, t = shifted ? random() : 0;
                               double sum = 0;
                               for (int i = 0; i < 16; ++i) {
                                   const double x = std::fmod(s + 0.7548776662 * i, 1);
                                   const double y = std::fmod(t + 0.5698402910 * i, 1);
                                   sum += x * (same ? x : y);
                               }
                               return sum / 16;
                           };
                           return oracle::expect_replicates(0.25, 64, estimate);
                       }};
    };
    return {
        set("shifted set", "", {}, true, false),
        set("replicates all alike", "The shift is forgotten: one set, 64 times.",
            {"same", "constant", "alike", "identical", "equal"}, false, false),
        set("same base twice", "Both dimensions are one: the mean of x^2.",
            {"same", "dimension", "correlated", "4/3"}, true, true),
    };
}

// ---- All
// ---------------------------------------------------------------

inline Mistakes all() {
    Mistakes sum;
    for (const auto& family : {hemispheres(), frames(), lobes(), microfacets(), lights(), choices(),
                               points(), estimators(), bsdfs(), replicates()})
        sum.insert(sum.end(), family.begin(), family.end());
    return sum;
}
}  // namespace mistakes

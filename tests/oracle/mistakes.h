// oracle/mistakes.h  classic mistakes, planted, and the words by which a first line names each
//
// An entry is textbook code with one wrong line, under the check that its author would write
// without a thought of the mistake: default options, and, where light or BSDF have factors, those
// by name, the same as for the right variant.  An entry without words is right, and passes.
#pragma once
#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "oracle/oracle.h"
#include "oracle/textbook.h"

namespace mistakes {

using oracle::pi, oracle::Random, oracle::Triple, oracle::Verdict;
using textbook::polar, textbook::Vec;
using D = Vec<double>;
using F = Vec<float>;

struct Mistake {
    std::string name;      // the wrong line
    std::string expected;  // words of the first line; none: the code is right
    std::function<Verdict(Random&)> run;
};
using Mistakes = std::vector<Mistake>;

// ---- Checks -------------------------------------------------------------------------------------

using Factors = std::vector<oracle::Factor>;

template <class Sample, class Pdf>
Mistake any_density(std::string name, std::string expected, Sample sample, Pdf pdf,
                    Factors factors = {}) {
    return {name, expected, [=](Random& random) {
                return oracle::expect_density(random, sample, pdf, {.factors = factors});
            }};
}
// Of directions from two numbers of type T.
template <class T, class Sample, class Pdf>
Mistake density(std::string name, std::string expected, Sample sample, Pdf pdf,
                Factors factors = {}) {
    return any_density(
        name, expected, [=](T u, T v) { return sample(u, v); }, [=](Vec<T> w) { return T(pdf(w)); },
        factors);
}
// The mean of f(random).
template <class Draw>
Mistake mean(std::string name, std::string expected, double truth, Draw f, Factors factors = {}) {
    return {name, expected, [=](Random& random) {
                return oracle::expect_mean(truth, 100000, [&] { return f(random); },
                                           {.factors = factors});
            }};
}

// ---- Directions ---------------------------------------------------------------------------------

// The cosine follows from the first number, phi is a part of the turn.
template <class Z>
auto about_z(Z z, double turn = 2 * pi) {
    return [=]<class T>(T u, T v) { return polar(T(z(u)), T(turn) * v); };
}
// A function of the cosine, 0 below the horizon.
template <class Of>
auto above(Of f) {
    return [=](const auto& w) { return w.z > 0 ? double(f(w.z)) : 0.0; };
}
inline auto constant_above(double value) {
    return above([=](auto) { return value; });
}
inline const auto by_cosine = [](auto u, auto v) { return textbook::cosine_sample(u, v); };
inline const auto cosine_pdf = above([](auto z) { return z / pi; });
template <class Change>
auto changed(Change change) {
    return [=](auto u, auto v) { return change(by_cosine(u, v)); };
}
inline const auto evenly = about_z([](auto u) { return 1 - u; });

inline Mistakes hemispheres() {
    return {
        density<double>("cosine, double", "", by_cosine, cosine_pdf),
        density<float>("cosine, float", "", by_cosine, cosine_pdf),
        density<float>("uniform hemisphere, float", "", evenly, constant_above(1 / (2 * pi))),
        density<double>("r = u", "without its square root",
                        about_z([](auto u) { return std::sqrt(1 - u * u); }), cosine_pdf),
        density<float>("uniform for cosine", "cos(theta); samples are uniform", evenly, cosine_pdf),
        density<float>("pdf without cosine", "a factor cos(theta) missing", by_cosine,
                       constant_above(1 / pi)),
        density<double>("pdf per (theta, phi)", "a density per (theta, phi)", by_cosine,
                        [](D w) { return std::max(0.0, w.z) * std::hypot(w.x, w.y) / pi; }),
        density<float>("phi = pi v: half of the circle", "no sample has y < 0; looks like a gap",
                       about_z([](auto u) { return std::sqrt(1 - u); }, pi), cosine_pdf),
        density<double>("disc of radius 2: no unit vectors", "its length is", changed([](D w) {
                            return D{2 * w.x, 2 * w.y, w.z};
                        }),
                        cosine_pdf),
        density<double>("pdf without 1/pi", "1/pi forgotten", by_cosine,
                        above([](auto z) { return z; })),
        density<float>("the sphere's 1/(4 pi) for the hemisphere", "(1/2, half) times the density",
                       evenly, constant_above(1 / (4 * pi))),
        density<double>("cosine not clamped", "the pdf is negative", by_cosine,
                        [](D w) { return w.z / pi; }),
        density<float>("pdf of |cos|, positive below the horizon",
                       "no sample has z < 0, below the horizon", by_cosine,
                       [](F w) { return std::abs(w.z) / pi; }),
        density<double>("pdf halved once more", "(1/2, half) times the density", by_cosine,
                        [](D w) { return cosine_pdf(w) / 2; }),
        density<double>("below the horizon", "z negated in one of the two, below the horizon",
                        changed([](D w) {
                            return D{w.x, w.y, -w.z};
                        }),
                        cosine_pdf),
        density<float>("x and z swapped", "x and z exchanged in one", changed([](F w) {
                           return F{w.z, w.y, w.x};
                       }),
                       cosine_pdf),
        density<double>("hemisphere by theta = u pi / 2", "without its square root",
                        about_z([](auto u) { return std::cos(u * pi / 2); }),
                        constant_above(1 / (2 * pi))),
        density<double>(
            "same number twice", "one number used for both",
            [](double u, double) { return by_cosine(u, u); }, cosine_pdf),
        density<double>("pi = 3.14", "looks like a gap",
                        about_z([](auto u) { return std::sqrt(1 - u); }, 2 * 3.14), cosine_pdf),
    };
}

// ---- Frames and spheres of directions -----------------------------------------------------------

// Directions about the normal n by the tangents of make(n).
template <class T, class Make>
auto about(Vec<T> n, Make make) {
    return [=](T u, T v) {
        const Vec<T> w = by_cosine(u, v);
        const auto [s, t] = make(n);
        return w.x * s + w.y * t + w.z * n;
    };
}
inline const auto by_cross = []<class T>(Vec<T> n) {
    const Vec<T> a = std::abs(n.x) > T(0.9) ? Vec<T>{0, 1, 0} : Vec<T>{1, 0, 0};
    const Vec<T> t = unit(cross(n, a));
    return std::pair{cross(t, n), t};
};
template <class T>
auto cosine_about(Vec<T> n) {
    return [=](Vec<T> w) { return std::max(T(0), dot(w, n)) * T(1 / pi); };
}

inline Mistakes frames() {
    const D n = unit(D{1, -2, 2});
    const F pole{0.00031f, -0.00037f, -0.9999999f}, level{0.6f, 0.8f, 0};
    auto hg = about_z([](double u) {
        const double g = 0.6, s = (1 - g * g) / (1 + g - 2 * g * u);
        return (1 + g * g - s * s) / (2 * g);
    });
    auto hg_pdf = [](D w) { return 0.64 / (4 * pi * std::pow(1.36 - 1.2 * w.z, 1.5)); };
    return {
        density<double>("tilted cosine", "", about(n, by_cross), cosine_about(n)),
        density<float>("tilted cosine, float", "", about(pole, by_cross), cosine_about(pole)),
        density<double>("Henyey-Greenstein", "", hg, hg_pdf),
        density<float>("sign(0) = 0 in Duff's basis", "is not finite",
                       about(level,
                             [](F z) {
                                 const float s = z.z > 0 ? 1.f : z.z < 0 ? -1.f : 0.f;
                                 const float a = -1 / (s + z.z), b = z.x * z.y * a;
                                 return std::pair{F{1 + s * z.x * z.x * a, s * b, -s * z.x},
                                                  F{b, s + z.y * z.y * a, -z.y}};
                             }),
                       cosine_about(level)),
        density<float>(
            "Frisvad's 1/(1 + z) in float near the pole", "its length is 0.99",
            about(
                pole,
                [](F z) {
                    const float a = 1 / (1 + z.z), b = -z.x * z.y * a;
                    return std::pair{F{1 - z.x * z.x * a, b, -z.x}, F{b, 1 - z.y * z.y * a, -z.y}};
                }),
            cosine_about(pole)),
        density<double>("phase function backward: sign of g", "z negated in one", hg,
                        [=](D w) {
                            return hg_pdf({w.x, w.y, -w.z});
                        }),
        density<double>("phase function without 1/(4 pi)", "1/(4 pi) forgotten", hg,
                        [=](D w) { return 4 * pi * hg_pdf(w); }),
        any_density(
            "normal plus a point in the unit ball, not on the sphere", "times cos(theta)^2",
            [](double u, double v, double w) {
                return unit(D{0, 0, 1} + std::cbrt(w) * polar(1 - 2 * u, 2 * pi * v));
            },
            [](D w) { return cosine_pdf(w); }),
    };
}

// ---- Cones and lobes ----------------------------------------------------------------------------

inline auto cone(double cos_max) {
    return about_z([=](auto u) { return 1 - u * (1 - cos_max); });
}
inline auto cone_pdf(double cos_max, double constant) {
    return [=]<class T>(Vec<T> w) { return w.z >= T(cos_max) ? constant : 0; };
}

inline Mistakes lobes() {
    auto phong = [](double n) { return about_z([=](auto u) { return std::pow(u, 1 / n); }); };
    auto phong_pdf = [](double n, double factor) {
        return above([=](auto z) { return factor / (2 * pi) * std::pow(z, n); });
    };
    return {
        density<double>("cone", "", cone(0.8), cone_pdf(0.8, 1 / (2 * pi * 0.2))),
        density<float>("Phong lobe, float", "", phong(21), phong_pdf(20, 21)),
        density<float>("cone without 2 pi: phi has no density", "1/(2 pi) forgotten", cone(0.8),
                       cone_pdf(0.8, 1 / 0.2)),
        density<double>("cone by theta = u theta_max", "without its square root",
                        about_z([](auto u) { return std::cos(u * 0.9); }),
                        cone_pdf(std::cos(0.9), 1 / (2 * pi * (1 - std::cos(0.9))))),
        density<float>(
            "cone of 1e-3 in float: 1 - cos cancels", "rounding if doubles pass",
            [](float u, float v) {
                const float x = u * 0.5e-6f, s = std::sqrt(x * (2 - x));
                return F{s * std::cos(float(2 * pi) * v), s * std::sin(float(2 * pi) * v), 1 - x};
            },
            [](F w) {
                const float cos_max = std::sqrt(1 - 1e-3f * 1e-3f);
                const bool inside = w.z > 0 && std::hypot(w.x, w.y) <= 1e-3f;
                return inside ? 1 / (float(2 * pi) * (1 - cos_max)) : 0;
            }),
        density<float>("Phong's n for n + 1", "everywhere: a constant factor", phong(5),
                       phong_pdf(4, 4)),
        density<float>("Phong's n-th root, not the n+1-st", "an exponent in one of the two",
                       phong(4), phong_pdf(4, 5)),
    };
}

// ---- Microfacets --------------------------------------------------------------------------------

template <class T>
auto ggx_half(Vec<T> wo, T alpha) {
    return [=](T u, T v) { return ggx_half_sample(wo, u, v, alpha); };
}
template <class T>
auto ggx_visible(Vec<T> wo, T alpha) {
    return [=](T u, T v) { return ggx_visible_sample(wo, u, v, alpha); };
}

// pdf(h), 0 below the horizon, under all factors that a microfacet's pdf has.
template <class T, class Sample, class Pdf>
Mistake microfacet(std::string name, std::string expected, Vec<T> wo, T alpha, Sample sample,
                   Pdf pdf) {
    const D o{double(wo.x), double(wo.y), double(wo.z)};
    auto half = [=](const Triple& wi) { return unit(o + D{wi[0], wi[1], wi[2]}); };
    return density<T>(name, expected, sample,
                      [=](Vec<T> wi) { return wi.z > 0 ? pdf(unit(wo + wi)) : T(0); },
                      {{"4 wo.h", [=](const Triple& w) { return 4 * dot(o, half(w)); }},
                       {"n.h", [=](const Triple& w) { return half(w).z; }},
                       {"G1(wo)", double(ggx_g1(wo, alpha))},
                       {"n.wo", o.z}});
}

inline Mistakes microfacets() {
    const double a = 0.4;
    const float b = 0.3f;
    const D o = unit(D{0.5, 0.2, 0.7});
    const F p = unit(F{-0.3f, 0.4f, 0.6f}), q = unit(F{0.9f, 0.1f, 0.3f});
    auto visible = [=](F h) { return ggx_g1(p, b) * dot(p, h) * ggx_d(h, b) / p.z; };
    auto right = [=](D h) { return ggx_d(h, a) * h.z / (4 * dot(o, h)); };
    return {
        microfacet("GGX by half vector", "", o, a, ggx_half(o, a), right),
        microfacet("GGX by half vector, float", "", p, b, ggx_half(p, b),
                   [=](F h) { return ggx_d(h, b) * h.z / (4 * dot(p, h)); }),
        microfacet("GGX by visible normals, float", "", p, b, ggx_visible(p, b),
                   [=](F h) { return visible(h) / (4 * dot(p, h)); }),
        microfacet("1/(4 wo.h) forgotten", "or 1/(4 wo.h) forgotten", o, a, ggx_half(o, a),
                   [=](D h) { return ggx_d(h, a) * h.z; }),
        microfacet("n.h forgotten", "looks like n.h forgotten", p, b, ggx_half(p, b),
                   [=](F h) { return ggx_d(h, b) / (4 * dot(p, h)); }),
        microfacet("GGX without pi", "1/pi forgotten", o, a, ggx_half(o, a),
                   [=](D h) { return pi * right(h); }),
        microfacet(
            "tan = alpha u/(1-u), without the root", "of the samples fail", o, a,
            [=](double u, double v) {
                const double t = a * u / (1 - u);
                return reflected(o, polar(1 / std::sqrt(1 + t * t), 2 * pi * v));
            },
            right),
        microfacet("G1 forgotten", "G1(wo) forgotten", q, 0.7f, ggx_visible(q, 0.7f),
                   [=](F h) { return ggx_d(h, 0.7f) / (4 * q.z); }),
        microfacet(
            "-reflect: wo is thrown away", "the direction negated in one", o, a,
            [=](double u, double v) { return -1.0 * ggx_half(o, a)(u, v); }, right),
    };
}

}  // namespace mistakes

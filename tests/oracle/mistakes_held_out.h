// oracle/mistakes_held_out.h  classic mistakes that the oracle's hints were not made for
#pragma once
#include "oracle/mistakes_of_light.h"

namespace mistakes {

inline Mistakes held_out_directions() {
    const D n = unit(D{1, -2, 2});
    const F m = unit(F{0.6f, -0.2f, 0.5f});
    auto constant = [](double value) { return [=](const auto&) { return value; }; };
    const auto ball = about_z([](auto u) { return 1 - 2 * u; });
    const double cap = std::sqrt(1 - 0.7);
    return {
        density<float>("uniform sphere, float", "", ball, constant(1 / (4 * pi))),
        density<float>("1/(2 pi) for the sphere", "(2, twice) times the density", ball,
                       constant(1 / (2 * pi))),
        density<float>("sphere by theta = pi u", "without its square root",
                       about_z([](auto u) { return std::cos(pi * u); }), constant(1 / (4 * pi))),
        density<float>("sampler's pole y, the pdf's z", "y and z exchanged in one",
                       changed([](F w) {
                           return F{w.x, w.z, w.y};
                       }),
                       cosine_pdf),
        density<double>("cosine twice", "a factor cos(theta) too many", by_cosine,
                        above([](auto z) { return z * z / pi; })),
        density<double>(
            "z = sqrt(1 - u^2) with r = sqrt(u)", "its length is",
            [](double u, double v) {
                const D w = by_cosine(u, v);
                return D{w.x, w.y, std::sqrt(1 - u * u)};
            },
            cosine_pdf),
        density<double>("pdf of the unturned frame", "taken to another normal", about(n, by_cross),
                        cosine_pdf),
        density<float>("signed cosine about n, float", "the pdf is negative", about(m, by_cross),
                       [=](F w) { return dot(w, m) / pi; }),
        density<double>("phi from 0 to pi / 2, a quarter", "(4, four times) times as dense",
                        about_z([](auto u) { return std::sqrt(1 - u); }, pi / 2), cosine_pdf),
        density<double>("tangents not normalized", "its length is",
                        about(n,
                              [](D z) {
                                  const D t = cross(z, D{1, 0, 0});
                                  return std::pair{cross(t, z), t};
                              }),
                        cosine_about(n)),
        density<double>("the cone's solid angle pi sin^2", "everywhere: a constant factor",
                        cone(cap), cone_pdf(cap, 1 / (pi * 0.7))),
        density<float>("the cone's pdf by 4 pi (1 - cos)", "(1/2, half) times the density",
                       cone(0.9), cone_pdf(0.9, 1 / (4 * pi * 0.1))),
    };
}

inline Mistakes held_out_microfacets() {
    const D o = unit(D{-0.4, 0.6, 0.9});
    const F p = unit(F{0.5f, 0.1f, 0.5f});
    const double a = 0.25;
    const float b = 0.5f;
    auto blinn = [=](double u, double v) {
        return reflected(o, polar(std::pow(u, 1 / 31.0), 2 * pi * v));
    };
    auto d = [](D h) { return 31 / (2 * pi) * std::pow(std::max(0.0, h.z), 30); };
    auto stretched = [=](double u, double v) {
        const double phi = 2 * pi * v, r = std::sqrt(u / (1 - u));
        return reflected(o, unit(D{0.5 * r * std::cos(phi), 0.2 * r * std::sin(phi), 1}));
    };
    auto stretched_pdf = [=](double ax, double ay) {
        return [=](D h) {
            const double t = h.x * h.x / (ax * ax) + h.y * h.y / (ay * ay) + h.z * h.z;
            return h.z / (pi * ax * ay * t * t) / (4 * dot(o, h));
        };
    };
    return {
        microfacet("Blinn", "", o, a, blinn, [=](D h) { return d(h) / (4 * dot(o, h)); }),
        microfacet("anisotropic", "", o, a, stretched, stretched_pdf(0.5, 0.2)),
        microfacet("Blinn per half vector", "1/(4 wo.h) forgotten", o, a, blinn, d),
        microfacet("visible normals per half vector", "1/(4 wo.h) forgotten", p, b,
                   ggx_visible(p, b),
                   [=](F h) { return ggx_g1(p, b) * dot(p, h) * ggx_d(h, b) / p.z; }),
        microfacet("n.wo forgotten", "a factor n.wo too many", p, b, ggx_visible(p, b),
                   [=](F h) { return ggx_g1(p, b) * ggx_d(h, b) / 4; }),
        microfacet("Jacobian 2 wo.h for 4 wo.h", "(2, twice) times the density", o, a,
                   ggx_half(o, a), [=](D h) { return ggx_d(h, a) * h.z / (2 * dot(o, h)); }),
        microfacet("n.h for wo.h in the Jacobian", "4 wo.h too many, and n.h forgotten", p, b,
                   ggx_half(p, b), [=](F h) { return ggx_d(h, b) / 4; }),
        microfacet("alpha along x and y exchanged in the pdf", "of the samples fail", o, a,
                   stretched, stretched_pdf(0.2, 0.5)),
        microfacet("roughness squared in the sampler alone", "wider than the samples", o, a,
                   ggx_half(o, a * a), [=](D h) { return ggx_d(h, a) * h.z / (4 * dot(o, h)); }),
    };
}

// By area, from a sphere of radius 1/2, 2 away along z: its far side fails.
template <class Pdf>
Mistake ball(std::string name, std::string expected, Pdf pdf) {
    auto draw = [](double u, double v) -> std::optional<D> {
        const D n = polar(1 - 2 * u, 2 * pi * v), p = D{0, 0, 2} + 0.5 * n;
        if (dot(p, n) >= 0) return {};
        return unit(p);
    };
    auto at = [](double z) {
        const double below = z * z * 4 - 3.75, r = below > 0 ? 2 * z - std::sqrt(below) : 0;
        return std::pair{r * r, (2 * z - r) / 0.5};
    };
    auto whole = [=](D w) {
        const auto [r2, c] = at(w.z);
        return w.z > 0 && 4 * w.z * w.z > 3.75 ? pdf(r2, c) : 0.0;
    };
    return any_density(name, expected, draw, whole,
                       {{"r^2", [=](const Triple& w) { return at(w[2]).first; }},
                        {"cos at the light", [=](const Triple& w) { return at(w[2]).second; }}});
}

// An environment of 4 x 8 texels, brighter towards one side; z is up, rows are theta.
inline Mistakes held_out_lights() {
    auto power = [](int row, int column) { return 1.0 + row + 2 * (column % 4); };
    double sum = 0;
    for (int k = 0; k < 32; ++k) sum += power(k / 8, k % 8);
    auto sample = [=](double u, double v) {
        int k = 0;
        for (u *= sum; k < 31 && u >= power(k / 8, k % 8); ++k) u -= power(k / 8, k % 8);
        u /= power(k / 8, k % 8);
        return polar(std::cos(pi * (k / 8 + u) / 4), 2 * pi * (k % 8 + v) / 8);
    };
    auto texel = [=](D w) {
        const double theta = std::acos(std::clamp(w.z, -1.0, 1.0)), phi = std::atan2(w.y, w.x);
        const int row = std::min(3, int(4 * theta / pi));
        const int column = std::min(7, int(8 * (phi < 0 ? phi + 2 * pi : phi) / (2 * pi)));
        return 32 * power(row, column) / sum;
    };
    auto of_theta = [](D w) { return std::max(1e-9, std::hypot(w.x, w.y)); };
    return {
        density<double>("environment", "", sample,
                        [=](D w) { return texel(w) / (2 * pi * pi * of_theta(w)); }),
        density<double>("environment without sine", "a density per (theta, phi)", sample,
                        [=](D w) { return texel(w) / (2 * pi * pi); }),
        density<double>("environment of pi by pi", "(2, twice) times the density", sample,
                        [=](D w) { return texel(w) / (pi * pi * of_theta(w)); }),
        light<double>("pdf 1/A, per area", "cos at the light^3; the pdf is uniform", quad,
                      [](double, double, double) { return 0.5; }),
        light<double>("distance for its square", "a root of r^2", quad,
                      [](double r2, double c, double) { return std::sqrt(r2) / (2 * c); }),
        ball("ball by area", "", [](double r2, double c) { return r2 / (pi * c); }),
        ball("ball's area pi R^2", "(4, four times) times the density",
             [](double r2, double c) { return r2 / (pi / 4 * c); }),
        ball("ball without cosine", "cos at the light too many",
             [](double r2, double) { return r2 / pi; }),
    };
}

inline Mistakes held_out_numbers() {
    const std::array<double, 4> power{0.25, 0, 0.45, 0.3}, rising{0.1, 0.2, 0.3, 0.4};
    auto its = [=](int i) { return power[size_t(i)]; };
    auto line = [](float factor) {
        return [=](float x) { return x >= 0 && x <= 1 ? factor * x : 0; };
    };
    auto by_root = [](float u) { return std::sqrt(u); };
    return {
        any_density("ramp, float", "", by_root, line(2)),
        any_density("ramp without its 2", "(1/2, half) times the density", by_root, line(1)),
        any_density(
            "ramp without root", "x drawn uniformly, without its root", [](float u) { return u; },
            line(2)),
        choice(
            "index out of range", "index 4 of 4 chosen, beyond the last", 4,
            [](double u) { return int(5 * u); }, [](int) { return 0.25; }),
        choice(
            "light of probability 0 chosen", "index 1 is chosen, though its probability is 0", 4,
            [=](double u) { return u < 0.1 ? 1 : among(power, u); }, its),
        choice(
            "next one's probability", "index and probability shifted by one", 4,
            [=](double u) { return among(rising, u); },
            [=](int i) { return rising[size_t((i + 1) % 4)]; }),
    };
}

inline Mistakes held_out_estimators() {
    return {
        direct("no receiver's cosine", "cos at the receiver forgotten",
               [](Lit x) { return x.right() / x.co / 0.3; }),
        direct("the receiver's cosine in the BRDF, too", "a factor cos at the receiver too many",
               [](Lit x) { return x.right() * x.co / 0.3; }),
        direct("divided by 1 - p", "divided by 1 - pick probability",
               [](Lit x) { return x.right() / 0.7; }),
        direct("r^2 in the numerator", "multiplied by r^2 in place of divided",
               [](Lit x) { return x.right() * std::pow(x.r, 4) / 0.3; }),
        direct("everything in the shadow of the wall behind", "0 in every sample",
               [](Lit) { return 0.0; }),
        sphere("area 4 pi (2R)^2", "(4, four times)", 4 * pi,
               [](double c) { return std::max(0.0, c); }),
        sphere("signed cosine at the light's far side", "0 within its error", pi,
               [](double c) { return c; }),
        furnace("roulette survives with 1 - q", "ratio 0.36", 0.7, 0.8, 1 / 0.8, 1, true),
        furnace("survivors not divided, q = 0.8", "ratio 0.68", 0.7, 0.8, 1),
        mean("one-sample MIS without its choice", "(1/2, half)", 1.0 / 3,
             [](Random& r) {
                 const bool first = r() < 0.5;
                 const double x = first ? r() : std::sqrt(r());
                 return x * x / (1 + 2 * x);
             }),
        mean("control's mean taken off, not added", "of the wrong sign", 0.25,
             [](Random& r) {
                 const double x = r();
                 return (x < 0.5 ? 2 * x : 0) - (2 * x) - 1;
             }),
        mean("variance of two divided by n, not n - 1", "(1/2, half)", 1.0 / 12,
             [](Random& r) {
                 const double a = r(), b = r(), m = (a + b) / 2;
                 return ((a - m) * (a - m) + (b - m) * (b - m)) / 2;
             }),
        mean("1/r^2 at uniform points of a ball", "variance may be infinite", 3,
             [](Random& r) { return std::pow(1 - r(), -2 / 3.0); }),
        mean("constant sampled by cos^4", "variance may be infinite", 2 * pi,
             [](Random& r) { return 2 * pi / 5 * std::pow(1 - r(), -4 / 5.0); }),
    };
}

inline Mistakes held_out_bsdfs() {
    auto schlick = [](double c) { return 0.04 + 0.96 * std::pow(std::max(0.0, 1 - c), 5); };
    return {
        bsdf("Schlick by wo.h", "",
             [=](D wo, D wi) { return schlick(dot(wo, unit(wo + wi))) / pi; }),
        bsdf("Schlick by n.wi", "a factor of their cosines alone",
             [=](D, D wi) { return schlick(wi.z) / pi; }),
        bsdf("Phong lobe of 10 cos^n", "more leaves than comes",
             [](D wo, D wi) {
                 const double c = -wo.x * wi.x - wo.y * wi.y + wo.z * wi.z;
                 return 10 * std::pow(std::max(0.0, c), 8);
             }),
        bsdf("root of a negative refracted cosine", "eval is not finite",
             [](D wo, D wi) {
                 const double h = dot(wo, unit(wo + wi)), t = std::sqrt(1 - 2.25 * (1 - h * h));
                 const double f = (1.5 * h - t) / (1.5 * h + t);
                 return (1 - f * f) * 0.5 / pi;
             }),
    };
}

inline Mistakes held_out() {
    return joined({held_out_directions(), held_out_microfacets(), held_out_lights(),
                   held_out_numbers(), held_out_estimators(), held_out_bsdfs()});
}

}  // namespace mistakes

// oracle/mistakes_held_out.h  classic mistakes that the oracle's hints were not made for
#pragma once
#include "oracle/mistakes_of_light.h"

namespace mistakes {

inline Mistakes held_out_directions() {
    using D = Dir<double>;
    using F = Dir<float>;
    auto sphere_of = [](float cosine, float v) { return polar(cosine, float(2 * pi) * v); };
    const D n = unit(D{1, -2, 2});
    const auto f = cosine_sample<float>();
    const F m = unit(F{0.6f, -0.2f, 0.5f});
    auto cap = [](double s2) { return std::sqrt(1 - s2); };
    return {
        density(
            "uniform sphere, float", "", {},
            [=](float u, float v) { return sphere_of(1 - 2 * u, v); },
            [](F) { return float(1 / (4 * pi)); }),
        density(
            "half a sphere's constant", "The sphere's pdf is 1/(2 pi), the hemisphere's.",
            {"2", "half", "1/2", "twice", "hemisphere", "2 pi", "4 pi"},
            [=](float u, float v) { return sphere_of(1 - 2 * u, v); },
            [](F) { return float(1 / (2 * pi)); }),
        density(
            "theta = pi u", "The sphere is sampled by a uniform angle.",
            {"sin", "sine", "sin theta", "per (theta, phi)", "solid angle"},
            [=](float u, float v) { return sphere_of(std::cos(float(pi) * u), v); },
            [](F) { return float(1 / (4 * pi)); }),
        density(
            "y up", "The sampler's pole is y, the pdf's is z.",
            {"exchanged", "swapped", "y and z", "z and y", "permuted"},
            [=](float u, float v) {
                const F w = f(u, v);
                return F{w.x, w.z, w.y};
            },
            cosine_pdf<float>()),
        density("cosine twice", "The pdf is cos^2/pi: the integrator's cosine is in it, too.",
                {"cos", "cosine", "cos theta"}, cosine_sample<double>(),
                [](D w) { return w.z > 0 ? w.z * w.z / pi : 0; }),
        density(
            "sine of the wrong number", "z = sqrt(1 - u^2) stands with r = sqrt(u).",
            {"unit", "length", "norm", "normalized", "normalised", "unit length"},
            [](double u, double v) {
                const double r = std::sqrt(u), phi = 2 * pi * v;
                return D{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u * u)};
            },
            cosine_pdf<double>()),
        density("pdf of the unturned frame", "Samples are about n, the pdf is about z.",
                {"axis", "frame", "normal", "turned", "rotated", "tilted"},
                about(n, frame_by_cross<double>), cosine_pdf<double>()),
        density("signed cosine about n, float", "The cosine about the normal is not clamped.",
                {"negative", "below zero", "clamped"}, about(m, frame_by_cross<float>),
                [=](F w) { return dot(w, m) * float(1 / pi); }),
        density(
            "phi from 0 to pi / 2", "phi = v pi / 2, a quarter of the circle.",
            {"quarter", "1/4", "phi"},
            [=](double u, double v) { return polar(std::sqrt(1 - u), pi / 2 * v); },
            cosine_pdf<double>()),
        density("tangents not normalized", "The tangent is a cross product as it is.",
                {"unit", "length", "norm", "normalized", "normalised", "unit length"},
                about(n,
                      [](D z) {
                          const D t = cross(z, D{1, 0, 0});
                          return std::pair{cross(t, z), t};
                      }),
                cosine_about(n)),
        density(
            "disc for cap", "The cone's solid angle is pi sin^2, its disc.",
            {"constant", "everywhere", "solid angle"},
            [=](double u, double v) { return polar(1 - u * (1 - cap(0.7)), 2 * pi * v); },
            cone_pdf(cap(0.7), 1 / (pi * 0.7))),
        density("cone's sphere", "The cone's pdf is that of 4 pi (1 - cos).",
                {"2", "1/2", "half", "twice"}, cone(0.9f), cone_pdf(0.9f, 1 / (4 * pi * 0.1))),
    };
}

inline Mistakes held_out_microfacets() {
    using D = Dir<double>;
    using F = Dir<float>;
    const D o = unit(D{-0.4, 0.6, 0.9});
    const F p = unit(F{0.5f, 0.1f, 0.5f});
    const double a = 0.25;
    const float b = 0.5f;
    auto blinn = [=](double u, double v) {
        const D h = polar(std::pow(u, 1 / 31.0), 2 * pi * v);
        return 2 * dot(o, h) * h - o;
    };
    auto d = [](D h) { return 31 / (2 * pi) * std::pow(std::max(0.0, h.z), 30); };
    auto stretched = [=](double ax, double ay) {
        return [=](double u, double v) {
            const double phi = 2 * pi * v, r = std::sqrt(u / (1 - u));
            const D h = unit(D{ax * r * std::cos(phi), ay * r * std::sin(phi), 1});
            return 2 * dot(o, h) * h - o;
        };
    };
    auto stretched_pdf = [=](double ax, double ay) {
        return [=](D h) {
            const double t = h.x * h.x / (ax * ax) + h.y * h.y / (ay * ay) + h.z * h.z;
            return h.z / (pi * ax * ay * t * t) / (4 * dot(o, h));
        };
    };
    return {
        microfacet("Blinn", "", {}, o, a, blinn, [=](D h) { return d(h) / (4 * dot(o, h)); }),
        microfacet("anisotropic", "", {}, o, a, stretched(0.5, 0.2), stretched_pdf(0.5, 0.2)),
        microfacet("Blinn per half vector", "The pdf of wi is that of h.",
                   {"4 wo.h", "half vector"}, o, a, blinn, [=](D h) { return d(h); }),
        microfacet("visible normals per half vector", "The pdf of wi is that of h, in float.",
                   {"4 wo.h", "half vector"}, p, b, ggx_visible(p, b),
                   [=](F h) { return smith_g1(p, b) * dot(p, h) * ggx(h, b) / p.z; }),
        microfacet("n.wo forgotten", "The pdf of visible normals lacks 1/(n.wo).", {"n.wo"}, p, b,
                   ggx_visible(p, b), [=](F h) { return smith_g1(p, b) * ggx(h, b) / 4; }),
        microfacet("2 for 4", "The Jacobian of the reflection is taken for 2 wo.h.",
                   {"2", "1/2", "half", "twice"}, o, a, ggx_half(o, a),
                   [=](D h) { return ggx(h, a) * h.z / (2 * dot(o, h)); }),
        microfacet("n.h for wo.h", "The Jacobian holds the wrong cosine.", {"n.h", "4 wo.h"}, p, b,
                   ggx_half(p, b), [=](F h) { return ggx(h, b) / 4; }),
        microfacet("anisotropy turned", "alpha along x and alpha along y are exchanged in the pdf.",
                   {"x and y", "y and x", "exchanged", "swapped"}, o, a, stretched(0.5, 0.2),
                   stretched_pdf(0.2, 0.5)),
        microfacet("roughness for alpha", "The sampler squares the roughness, the pdf does not.",
                   {"alpha", "roughness", "width", "narrower", "wider"}, o, a, ggx_half(o, a * a),
                   [=](D h) { return ggx(h, a) * h.z / (4 * dot(o, h)); }),
    };
}

// An environment of 4 x 8 texels, brighter towards one side; z is up, rows are theta.
inline Mistakes held_out_lights() {
    using D = Dir<double>;
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
    auto sine = [](D w) { return std::max(1e-9, std::hypot(w.x, w.y)); };
    auto quad = [](double u, double v) { return std::pair{u - 0.5, 2 * v + 0.5}; };
    auto in_quad = [](double y, double z) { return std::abs(y) <= 0.5 && 0.5 <= z && z <= 2.5; };
    // By area, from a sphere of radius 1/2, 2 away along z: its far side fails.
    auto ball = [](std::string name, std::string wrong, Words expected, auto pdf) {
        auto run = [=](Random& random) {
            auto draw = [](double u, double v) -> std::optional<D> {
                const D n = polar(1 - 2 * u, 2 * pi * v), p = D{0, 0, 2} + 0.5 * n;
                if (dot(p, n) >= 0) return {};
                return unit(p);
            };
            auto at = [](const auto& x) {
                const double z = plain(x).z, root = z * z * 4 - 3.75;
                const double r = root > 0 ? 2 * z - std::sqrt(root) : 0;
                return std::pair{r * r, (2 * z - r) / 0.5};
            };
            auto whole = [=](D w) {
                const auto [r2, cosine] = at(w);
                return w.z > 0 && 4 * w.z * w.z > 3.75 ? pdf(r2, cosine) : 0.0;
            };
            return oracle::expect_density(
                random, draw, whole,
                {.factors = {{"r^2", [=](const auto& w) { return at(w).first; }},
                             {"cos at the light", [=](const auto& w) { return at(w).second; }}}});
        };
        return Mistake{name, wrong, expected, run};
    };
    return {
        density("environment", "", {}, sample,
                [=](D w) { return texel(w) / (2 * pi * pi * sine(w)); }),
        density("environment without sine", "The pdf of the map is that of the sphere.",
                {"sin", "sine", "sin theta", "per (theta, phi)", "solid angle"}, sample,
                [=](D w) { return texel(w) / (2 * pi * pi); }),
        density("environment of pi^2", "The map covers 2 pi by pi, not pi by pi.",
                {"2", "1/2", "half", "twice"}, sample,
                [=](D w) { return texel(w) / (pi * pi * sine(w)); }),
        light<double>("area as solid angle", "The pdf is 1/A, per area.",
                      {"r^2", "cos at the light", "per area", "area"}, quad, in_quad,
                      [](double, double, double) { return 0.5; }),
        light<double>("r for r^2", "The pdf holds the distance, not its square.",
                      {"r^2", "r", "root of r^2", "distance"}, quad, in_quad,
                      [](double r2, double c, double) { return std::sqrt(r2) / (2 * c); }),
        ball("ball by area", "", {}, [](double r2, double c) { return r2 / (pi * c); }),
        ball("ball of pi R^2", "The sphere's area is taken for its disc's.",
             {"4", "1/4", "area", "disc"}, [](double r2, double c) { return r2 / (pi / 4 * c); }),
        ball("ball without cosine", "The cosine at the light is missing.", {"cos at the light"},
             [](double r2, double) { return r2 / pi; }),
    };
}

inline Mistakes held_out_numbers() {
    const std::array<double, 4> power{0.25, 0, 0.45, 0.3};
    auto its = [=](int i) { return power[size_t(i)]; };
    auto line = [](float factor) {
        return [=](float x) { return x >= 0 && x <= 1 ? factor * x : 0; };
    };
    auto line_test = [](std::string name, std::string wrong, Words expected, auto f, auto pdf) {
        return density(name, wrong, expected, f, pdf);
    };
    return {
        line_test(
            "ramp, float", "", {}, [](float u) { return std::sqrt(u); }, line(2)),
        line_test(
            "ramp without its 2", "The pdf is x, not 2 x.", {"2", "1/2", "half", "twice"},
            [](float u) { return std::sqrt(u); }, line(1)),
        line_test(
            "ramp without root", "2 x is sampled by u.", {"root", "sqrt", "square root", "uniform"},
            [](float u) { return u; }, line(2)),
        choice(
            "index out of range", "The choice among four is by 5 u.",
            {"range", "index", "out of range", "outside"}, 4, [](double u) { return int(5 * u); },
            [](int) { return 0.25; }),
        choice(
            "black light chosen", "A light of probability 0 is chosen.",
            {"probability 0", "0", "zero", "never"}, 4,
            [=](double u) { return u < 0.1 ? 1 : among(power, u); }, its),
        choice(
            "next one's probability", "The probability is that of the next light.",
            {"next", "shifted", "neighbour", "neighbor", "off by one", "exchanged", "permuted"}, 4,
            [=](double u) {
                return among({0.1, 0.2, 0.3, 0.4}, u);
            },
            [](int i) { return 0.1 * ((i + 1) % 4 + 1); }),
    };
}

inline Mistakes held_out_estimators() {
    auto mean = [](std::string name, std::string wrong, Words expected, double truth, auto f) {
        return Mistake{name, wrong, expected, [=](Random& random) {
                           return oracle::expect_mean(truth, 100000, [&] { return f(random); });
                       }};
    };
    using D = double;
    return {
        direct("no receiver's cosine", "The cosine at the receiver is missing.",
               {"cos at the receiver"}, [](D, D cl, D r, D la) { return cl / (r * r) * la / 0.3; }),
        direct("receiver's cosine twice", "The BRDF's cosine is the integrator's, too.",
               {"cos at the receiver"},
               [](D co, D cl, D r, D la) { return co * co * cl / (r * r) * la / 0.3; }),
        direct("divided by 1 - p", "The sample is weighed by the other light's probability.",
               {"pick probability"},
               [](D co, D cl, D r, D la) { return co * cl / (r * r) * la / 0.7; }),
        direct("r^2 in the numerator", "The light grows with the distance.", {"r^2"},
               [](D co, D cl, D r, D la) { return co * cl * r * r * la / 0.3; }),
        direct("shadow rays end nowhere", "Everything lies in the shadow of the wall behind.",
               {"0", "zero", "exactly zero", "black"}, [](D, D, D, D) { return 0.0; }),
        sphere("diameter for radius", "The area is 4 pi (2R)^2.", {"4", "area", "diameter"}, 4 * pi,
               [](double c) { return std::max(0.0, c); }),
        sphere("signed cosine at the light", "The far side of the light counts as negative.",
               {"negative", "sign", "clamped", "below zero"}, pi, [](double c) { return c; }),
        furnace("survives with 1 - q", "The comparison of roulette is turned round.",
                {"survival probability", "roulette", "1 - q"}, 0.7, 0.8, 1 / 0.8, 1, true),
        furnace("roulette not divided, q = 0.8", "Survivors do not carry the weight of the dead.",
                {"survival probability", "roulette"}, 0.7, 0.8, 1),
        mean("one-sample MIS without its choice", "The technique's probability 1/2 is missing.",
             {"2", "1/2", "half", "probability"}, 1.0 / 3,
             [](Random& r) {
                 const bool first = r() < 0.5;
                 const double x = first ? r() : std::sqrt(r());
                 return x * x / (1 + 2 * x);
             }),
        mean("control variate's sign", "The control's mean is taken off, not added.",
             {"control", "sign"}, 0.25,
             [](Random& r) {
                 const double x = r();
                 return (x < 0.5 ? 2 * x : 0) - (2 * x) - 1;
             }),
        mean("variance of two by n", "The sum of squares is divided by n = 2, not by n - 1.",
             {"2", "1/2", "half", "n - 1"}, 1.0 / 12,
             [](Random& r) {
                 const double a = r(), b = r(), m = (a + b) / 2;
                 return ((a - m) * (a - m) + (b - m) * (b - m)) / 2;
             }),
        mean("point lights in a ball, not bounded", "1/r^2 at uniform points of a volume.",
             {"infinite", "variance", "tail"}, 3,
             [](Random& r) { return std::pow(1 - r(), -2 / 3.0); }),
        mean("constant by a narrow lobe",
             "cos^4 samples a constant: at the horizon the weight has no bound.",
             {"infinite", "variance", "tail"}, 2 * pi,
             [](Random& r) {
                 const double c = std::pow(1 - r(), 1 / 5.0);
                 return 2 * pi / (5 * std::pow(c, 4));
             }),
    };
}

inline Mistakes held_out_bsdfs() {
    using D = Dir<double>;
    auto plastic = [](std::string name, std::string wrong, Words expected, auto eval) {
        return Mistake{
            name, wrong, expected, [=](Random& random) {
                auto sample = [](D, double u, double v) { return cosine_sample<double>()(u, v); };
                auto pdf = [](D wo, D wi) { return wo.z > 0 ? cosine_pdf<double>()(wi) : 0.0; };
                return oracle::expect_bsdf(random, sample, pdf, [=](D wo, D wi) {
                    return wo.z > 0 && wi.z > 0 ? eval(wo, wi) : 0.0;
                });
            }};
    };
    auto schlick = [](double c) { return 0.04 + 0.96 * std::pow(std::max(0.0, 1 - c), 5); };
    return {
        plastic("Schlick by wo.h", "", {},
                [=](D wo, D wi) { return schlick(dot(wo, unit(wo + wi))) / pi; }),
        plastic("Schlick by n.wi", "Fresnel's cosine is the incident one: not reciprocal.",
                {"reciprocal", "reciprocity"}, [=](D, D wi) { return schlick(wi.z) / pi; }),
        plastic("Phong not normalized", "The lobe (n+2)/(2 pi) cos^n is 10 cos^n.",
                {"albedo", "energy"},
                [=](D wo, D wi) {
                    const double c = -wo.x * wi.x - wo.y * wi.y + wo.z * wi.z;
                    return 10 * std::pow(std::max(0.0, c), 8);
                }),
        plastic("total reflection not guarded",
                "The refracted cosine is the root of what is negative.",
                {"finite", "not finite", "nan"},
                [=](D wo, D wi) {
                    const double h = dot(wo, unit(wo + wi)), t = std::sqrt(1 - 2.25 * (1 - h * h));
                    const double f = (1.5 * h - t) / (1.5 * h + t);
                    return (1 - f * f) * 0.5 / pi;
                }),
    };
}

inline Mistakes held_out() {
    Mistakes sum;
    for (const auto& family : {held_out_directions(), held_out_microfacets(), held_out_lights(),
                               held_out_numbers(), held_out_estimators(), held_out_bsdfs()})
        sum.insert(sum.end(), family.begin(), family.end());
    return sum;
}
}  // namespace mistakes

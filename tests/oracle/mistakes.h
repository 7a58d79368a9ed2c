// oracle/mistakes.h  classic mistakes, planted, and the words by which a verdict names each
//
// An entry is textbook code with one wrong line, under the check that its author would write
// without a thought of the mistake: default options, and, where light or BSDF have factors, those
// by name, the same as for the right variant.  An entry without words is right, and passes.
#pragma once
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oracle/oracle.h"

namespace mistakes {

using oracle::Random, oracle::Verdict;

struct Mistake {
    std::string name, wrong;            // the wrong line in one sentence
    std::vector<std::string> expected;  // one of them names it; none: the code is right
    std::function<Verdict(Random&)> run;
};
using Mistakes = std::vector<Mistake>;

// ---- How a first line is judged
// ---------------------------------------------------------------

inline std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

// Whether a text says the word, as a word: "2" is not said by "2.5" or "12", "pi" not by "2 pi".
inline bool says(const std::string& text, const std::string& word) {
    auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
    auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
    for (auto at = text.begin(); at != text.end(); ++at) {
        at = std::search(at, text.end(), word.begin(), word.end(), same);
        if (at == text.end()) return false;
        auto before = [&](long n) { return at - text.begin() >= n ? at[-n] : ' '; };
        auto after = [&](long n) {
            const long past = long(word.size()) + n - 1;
            return text.end() - at > past ? at[past] : ' ';
        };
        if (letter(before(1)) || (digit(word[0]) && before(1) == '.')) continue;
        if (!digit(word[0]) && before(1) == ' ' && digit(before(2)) && word[0] == 'p') continue;
        if (letter(after(1)) || (digit(word.back()) && after(1) == '.' && digit(after(2))))
            continue;
        return true;
    }
    return false;
}

// A hint begins with its marker; before it stand facts, which claim no cause.
inline std::string hint_of(const std::string& line) {
    size_t from = std::string::npos;
    for (const char* marker : {"is it ", "looks like "}) from = std::min(from, line.find(marker));
    return from == std::string::npos ? "" : line.substr(from);
}

enum class Naming { right, silent, wrong };
inline Naming naming(const Mistake& m, const Verdict& v) {
    const std::string line = first_line(v.text), hint = hint_of(line);
    const std::string& where = hint.empty() ? line : hint;
    for (const std::string& word : m.expected)
        if (says(where, word)) return Naming::right;
    return hint.empty() ? Naming::silent : Naming::wrong;
}

// ---- A few vectors, as any renderer has
// ---------------------------------------------------------------

constexpr double pi = std::numbers::pi;

template <class T>
struct Dir {
    T x, y, z;
    friend Dir operator+(Dir a, Dir b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Dir operator-(Dir a, Dir b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Dir operator*(T s, Dir a) { return {s * a.x, s * a.y, s * a.z}; }
    friend T dot(Dir a, Dir b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend Dir cross(Dir a, Dir b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    friend T length(Dir a) { return std::sqrt(dot(a, a)); }
    friend Dir unit(Dir a) { return (1 / length(a)) * a; }
};

template <class T>
Dir<T> polar(T cosine, T phi) {
    const T sine = std::sqrt(std::max(T(0), 1 - cosine * cosine));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

// The same for whatever vector a check hands to a factor.
template <class V>
Dir<double> plain(const V& w) {
    if constexpr (requires { w.x; })
        return {double(w.x), double(w.y), double(w.z)};
    else
        return {double(w[0]), double(w[1]), double(w[2])};
}

using Words = std::vector<std::string>;

template <class Sample, class Pdf>
Mistake density(std::string name, std::string wrong, Words expected, Sample sample, Pdf pdf) {
    return {name, wrong, expected,
            [=](Random& random) { return oracle::expect_density(random, sample, pdf); }};
}

// ---- Directions
// ---------------------------------------------------------------

template <class T>
auto cosine_sample() {
    return [](T u, T v) {
        const T r = std::sqrt(u), phi = T(2 * pi) * v;
        return Dir<T>{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)};
    };
}
template <class T>
auto cosine_pdf() {
    return [](Dir<T> w) { return std::max(T(0), w.z) * T(1 / pi); };
}
template <class T>
auto constant_above(double value) {
    return [=](Dir<T> w) { return w.z > 0 ? T(value) : T(0); };
}

inline Mistakes hemispheres() {
    using D = Dir<double>;
    using F = Dir<float>;
    const auto d = cosine_sample<double>();
    const auto f = cosine_sample<float>();
    const auto pdf_d = cosine_pdf<double>();
    const auto pdf_f = cosine_pdf<float>();
    return {
        density("cosine, double", "", {}, d, pdf_d),
        density("cosine, float", "", {}, f, pdf_f),
        density(
            "uniform hemisphere, float", "", {},
            [](float u, float v) { return polar(1 - u, float(2 * pi) * v); },
            constant_above<float>(1 / (2 * pi))),
        density(
            "r = u", "The disc's radius is u, not its root.", {"root", "sqrt", "square root"},
            [](double u, double v) {
                return D{u * std::cos(2 * pi * v), u * std::sin(2 * pi * v), std::sqrt(1 - u * u)};
            },
            pdf_d),
        density(
            "uniform for cosine", "Directions are uniform, the pdf is the cosine's.",
            {"cos", "cosine", "cos theta", "uniform"},
            [](float u, float v) { return polar(1 - u, float(2 * pi) * v); }, pdf_f),
        density("pdf without cosine", "The pdf 1/pi lacks the cosine.",
                {"cos", "cosine", "cos theta"}, f, constant_above<float>(1 / pi)),
        density("pdf per (theta, phi)", "The pdf is that of the angles, cos sin / pi.",
                {"sin", "sine", "sin theta", "per (theta, phi)", "solid angle"}, d,
                [](D w) { return std::max(0.0, w.z) * std::hypot(w.x, w.y) / pi; }),
        density(
            "phi = pi v", "Directions fill half of the circle.", {"half", "half of phi", "phi"},
            [](float u, float v) { return polar(std::sqrt(1 - u), float(pi) * v); }, pdf_f),
        density(
            "disc of radius 2", "The radius is 2 sqrt(u): directions are not unit vectors.",
            {"unit", "length", "norm", "normalized", "normalised", "unit length"},
            [](double u, double v) {
                const double r = 2 * std::sqrt(u);
                return D{r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), std::sqrt(1 - u)};
            },
            pdf_d),
        density("pdf without 1/pi", "The pdf is cos theta, not divided by pi.", {"pi", "1/pi"}, d,
                [](D w) { return std::max(0.0, w.z); }),
        density(
            "sphere's constant", "The pdf of the hemisphere is 1/(4 pi), the sphere's.",
            {"2", "half", "1/2", "twice", "hemisphere", "4 pi"},
            [](float u, float v) { return polar(1 - u, float(2 * pi) * v); },
            constant_above<float>(1 / (4 * pi))),
        density("cosine not clamped", "The pdf is negative below the horizon.",
                {"negative", "below zero", "clamped"}, d, [](D w) { return w.z / pi; }),
        density("absolute cosine", "The pdf is positive below the horizon, too, without samples.",
                {"horizon", "below", "half", "no sample", "no samples", "never sampled"}, f,
                [](F w) { return std::abs(w.z) * float(1 / pi); }),
        density("pdf halved", "The pdf is divided by 2 once more.", {"2", "half", "1/2", "twice"},
                d, [=](D w) { return pdf_d(w) / 2; }),
        density(
            "below the horizon", "A cross product is turned round: z points down.",
            {"horizon", "below", "negated", "turned", "-z"},
            [=](double u, double v) {
                const D w = d(u, v);
                return D{w.x, w.y, -w.z};
            },
            pdf_d),
        density(
            "x and z swapped", "The frame's axes are handed over in the wrong order.",
            {"exchanged", "swapped", "x and z", "z and x", "permuted"},
            [=](float u, float v) {
                const F w = f(u, v);
                return F{w.z, w.y, w.x};
            },
            pdf_f),
        density(
            "uniform angle", "The hemisphere is sampled by theta = u pi / 2.",
            {"sin", "sine", "sin theta", "per (theta, phi)", "solid angle"},
            [](double u, double v) { return polar(std::cos(u * pi / 2), 2 * pi * v); },
            constant_above<double>(1 / (2 * pi))),
        density(
            "same number twice", "One number makes both radius and angle.",
            {"same number", "same", "both", "curve", "does not depend", "not depend", "depends",
             "one number", "second number", "ignored", "line"},
            [=](double u, double) { return d(u, u); }, pdf_d),
        density(
            "pi = 3.14", "The sampler's pi has three digits: a gap in phi.",
            {"3.14", "pi", "gap", "phi"},
            [](double u, double v) { return polar(std::sqrt(1 - u), 2 * 3.14 * v); }, pdf_d),
    };
}

// ---- Frames and spheres of directions
// ---------------------------------------------------------------

// Directions about the normal n by the tangents of make(n).
template <class T, class Make>
auto about(Dir<T> n, Make make) {
    return [=](T u, T v) {
        const Dir<T> w = cosine_sample<T>()(u, v);
        const auto [s, t] = make(n);
        return w.x * s + w.y * t + w.z * n;
    };
}
template <class T>
std::pair<Dir<T>, Dir<T>> frame_by_cross(Dir<T> n) {
    const Dir<T> a = std::abs(n.x) > T(0.9) ? Dir<T>{0, 1, 0} : Dir<T>{1, 0, 0};
    const Dir<T> t = unit(cross(n, a));
    return {cross(t, n), t};
}
template <class T>
auto cosine_about(Dir<T> n) {
    return [=](Dir<T> w) { return std::max(T(0), dot(w, n)) * T(1 / pi); };
}

inline Mistakes frames() {
    using D = Dir<double>;
    using F = Dir<float>;
    const D n = unit(D{1, -2, 2});
    const F pole{0.00031f, -0.00037f, -0.9999999f};
    auto hg = [](double g) {
        return [=](double u, double v) {
            const double s = (1 - g * g) / (1 + g - 2 * g * u);
            return polar((1 + g * g - s * s) / (2 * g), 2 * pi * v);
        };
    };
    auto hg_pdf = [](double g) {
        return [=](D w) { return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * w.z, 1.5)); };
    };
    return {
        density("tilted cosine", "", {}, about(n, frame_by_cross<double>), cosine_about(n)),
        density("tilted cosine, float", "", {}, about(pole, frame_by_cross<float>),
                cosine_about(pole)),
        density("Henyey-Greenstein", "", {}, hg(0.6), hg_pdf(0.6)),
        density("sign(0) = 0 in the basis", "1/(s + z) of Duff's frame with s = 0 where z = 0.",
                {"finite", "not finite", "nan", "inf"},
                about(F{0.6f, 0.8f, 0},
                      [](F z) {
                          const float s = z.z > 0 ? 1.f : z.z < 0 ? -1.f : 0.f;
                          const float a = -1 / (s + z.z), b = z.x * z.y * a;
                          return std::pair{F{1 + s * z.x * z.x * a, s * b, -s * z.x},
                                           F{b, s + z.y * z.y * a, -z.y}};
                      }),
                cosine_about(F{0.6f, 0.8f, 0})),
        density(
            "Frisvad near the pole", "1/(1 + z) in float has few digits where z is nearly -1.",
            {"rounding", "double", "unit", "length", "unit length", "orthogonal"},
            about(
                pole,
                [](F z) {
                    const float a = 1 / (1 + z.z), b = -z.x * z.y * a;
                    return std::pair{F{1 - z.x * z.x * a, b, -z.x}, F{b, 1 - z.y * z.y * a, -z.y}};
                }),
            cosine_about(pole)),
        density("sign of g", "The phase function looks backward: light's direction for ray's.",
                {"negated", "opposite", "mirrored", "-z", "backward", "sign", "turned"}, hg(0.6),
                [=](D w) {
                    return hg_pdf(0.6)({w.x, w.y, -w.z});
                }),
        density("phase function without 1/(4 pi)", "The pdf is not normalized.",
                {"4 pi", "1/(4 pi)"}, hg(0.6), [=](D w) { return 4 * pi * hg_pdf(0.6)(w); }),
        {"point of a ball added to the normal",
         "n + a point *in* the unit ball, not on the sphere: cos^3 for cos.",
         {"cos", "cosine", "cos theta", "cos^2 theta", "cos^2", "cosine^2"},
         [](Random& random) {
             auto sample = [](double u, double v, double w) {
                 return unit(D{0, 0, 1} + std::cbrt(w) * polar(1 - 2 * u, 2 * pi * v));
             };
             return oracle::expect_density(random, sample, cosine_pdf<double>());
         }},
    };
}

// ---- Cones and lobes
// ---------------------------------------------------------------

template <class T>
auto cone(T cos_max) {
    return [=](T u, T v) { return polar(1 - u * (1 - cos_max), T(2 * pi) * v); };
}
template <class T>
auto cone_pdf(T cos_max, double constant) {
    return [=](Dir<T> w) { return w.z >= cos_max ? T(constant) : T(0); };
}

inline Mistakes lobes() {
    using F = Dir<float>;
    auto phong = [](float root) {
        return [=](float u, float v) { return polar(std::pow(u, 1 / root), float(2 * pi) * v); };
    };
    auto phong_pdf = [](float n, float factor) {
        return [=](F w) { return w.z > 0 ? factor * float(1 / (2 * pi)) * std::pow(w.z, n) : 0.f; };
    };
    return {
        density("cone", "", {}, cone(0.8), cone_pdf(0.8, 1 / (2 * pi * 0.2))),
        density("Phong lobe, float", "", {}, phong(21), phong_pdf(20, 21)),
        density("cone without 2 pi", "The pdf is 1/(1 - cos): phi has no density.",
                {"2 pi", "1/(2 pi)"}, cone(0.8f), cone_pdf(0.8f, 1 / 0.2)),
        density(
            "cone of uniform angle", "theta = u theta_max fills the cone's middle.",
            {"sin", "sine", "sin theta", "per (theta, phi)", "solid angle"},
            [](double u, double v) { return polar(std::cos(u * 0.9), 2 * pi * v); },
            cone_pdf(std::cos(0.9), 1 / (2 * pi * (1 - std::cos(0.9))))),
        {"cone of a far light in float",
         "1 - cos cancels: the solid angle of a cone of 1e-3 has one digit.",
         {"rounding", "double", "cancellation"},
         [](Random& random) {
             const float cos_max = std::sqrt(1 - 1e-3f * 1e-3f);
             auto pdf = [=](F w) {
                 return w.z > 0 && std::hypot(w.x, w.y) <= 1e-3f
                            ? 1 / (float(2 * pi) * (1 - cos_max))
                            : 0.f;
             };
             auto sample = [](float u, float v) {
                 const float x = u * 0.5e-6f, s = std::sqrt(x * (2 - x));
                 return F{s * std::cos(float(2 * pi) * v), s * std::sin(float(2 * pi) * v), 1 - x};
             };
             return oracle::expect_density(random, sample, pdf);
         }},
        density("Phong's n for n + 1", "The pdf is n/(2 pi) cos^n.",
                {"constant", "everywhere", "n + 1", "normalization", "normalisation"}, phong(5),
                phong_pdf(4, 4)),
        density("Phong's root", "The cosine is the n-th root of u, not the n+1-st.",
                {"cos", "cosine", "cos theta"}, phong(4), phong_pdf(4, 5)),
    };
}

// ---- Microfacets
// ---------------------------------------------------------------

template <class T>
T ggx(Dir<T> h, T alpha) {
    const T c2 = h.z * h.z, t = 1 + c2 * (alpha * alpha - 1);
    return h.z > 0 ? alpha * alpha / (T(pi) * t * t) : 0;
}
template <class T>
auto ggx_half(Dir<T> wo, T alpha) {
    return [=](T u, T v) {
        const Dir<T> h = polar(std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u)), T(2 * pi) * v);
        return 2 * dot(wo, h) * h - wo;
    };
}
template <class T>
auto ggx_visible(Dir<T> wo, T alpha) {
    return [=](T u, T v) {
        const Dir<T> vh = unit(Dir<T>{alpha * wo.x, alpha * wo.y, wo.z});
        const T len2 = vh.x * vh.x + vh.y * vh.y;
        const Dir<T> t1 =
            len2 > 0 ? (1 / std::sqrt(len2)) * Dir<T>{-vh.y, vh.x, 0} : Dir<T>{1, 0, 0};
        const Dir<T> t2 = cross(vh, t1);
        const T r = std::sqrt(u), phi = T(2 * pi) * v, p1 = r * std::cos(phi);
        const T s = (1 + vh.z) / 2;
        const T p2 = (1 - s) * std::sqrt(1 - p1 * p1) + s * r * std::sin(phi);
        const Dir<T> n = p1 * t1 + p2 * t2 + std::sqrt(std::max(T(0), 1 - p1 * p1 - p2 * p2)) * vh;
        const Dir<T> h = unit(Dir<T>{alpha * n.x, alpha * n.y, std::max(T(0), n.z)});
        return 2 * dot(wo, h) * h - wo;
    };
}
template <class T>
T smith_g1(Dir<T> w, T alpha) {
    return 2 * w.z / (w.z + std::sqrt(alpha * alpha + (1 - alpha * alpha) * w.z * w.z));
}

// pdf(h), 0 below the horizon, under all factors that a microfacet's pdf has.
template <class T, class Sample, class Pdf>
Mistake microfacet(std::string name, std::string wrong, Words expected, Dir<T> wo, T alpha,
                   Sample sample, Pdf pdf) {
    auto run = [=](Random& random) {
        auto half = [=](const auto& wi) {
            const Dir<double> o = plain(wo);
            return unit(o + plain(wi));
        };
        auto whole = [=](Dir<T> wi) { return wi.z > 0 ? pdf(unit(wo + wi)) : T(0); };
        return oracle::expect_density(
            random, sample, whole,
            {.factors = {{"4 wo.h", [=](const auto& w) { return 4 * dot(plain(wo), half(w)); }},
                         {"n.h", [=](const auto& w) { return half(w).z; }},
                         {"G1(wo)", [=](const auto&) { return double(smith_g1(wo, alpha)); }},
                         {"n.wo", [=](const auto&) { return double(wo.z); }}}});
    };
    return {name, wrong, expected, run};
}

inline Mistakes microfacets() {
    using D = Dir<double>;
    using F = Dir<float>;
    const double a = 0.4;
    const float b = 0.3f;
    const D o = unit(D{0.5, 0.2, 0.7});
    const F p = unit(F{-0.3f, 0.4f, 0.6f}), q = unit(F{0.9f, 0.1f, 0.3f});
    auto visible = [=](F h) { return smith_g1(p, b) * dot(p, h) * ggx(h, b) / p.z; };
    return {
        microfacet("GGX by half vector", "", {}, o, a, ggx_half(o, a),
                   [=](D h) { return ggx(h, a) * h.z / (4 * dot(o, h)); }),
        microfacet("GGX by half vector, float", "", {}, p, b, ggx_half(p, b),
                   [=](F h) { return ggx(h, b) * h.z / (4 * dot(p, h)); }),
        microfacet("GGX by visible normals, float", "", {}, p, b, ggx_visible(p, b),
                   [=](F h) { return visible(h) / (4 * dot(p, h)); }),
        microfacet("1/(4 wo.h) forgotten", "The pdf is that of the half vector.",
                   {"4 wo.h", "half vector"}, o, a, ggx_half(o, a),
                   [=](D h) { return ggx(h, a) * h.z; }),
        microfacet("n.h forgotten", "D alone is no density: n.h is missing.", {"n.h"}, p, b,
                   ggx_half(p, b), [=](F h) { return ggx(h, b) / (4 * dot(p, h)); }),
        microfacet("GGX without pi", "D lacks its 1/pi.", {"pi", "1/pi"}, o, a, ggx_half(o, a),
                   [=](D h) { return pi * ggx(h, a) * h.z / (4 * dot(o, h)); }),
        microfacet(
            "tangent without root", "tan is alpha u/(1-u), not its root.",
            {"root", "sqrt", "square root"}, o, a,
            [=](double u, double v) {
                const double t = a * u / (1 - u);
                const D h = polar(1 / std::sqrt(1 + t * t), 2 * pi * v);
                return 2 * dot(o, h) * h - o;
            },
            [=](D h) { return ggx(h, a) * h.z / (4 * dot(o, h)); }),
        microfacet("G1 forgotten", "The pdf of visible normals lacks the masking G1.", {"G1(wo)"},
                   q, 0.7f, ggx_visible(q, 0.7f), [=](F h) { return ggx(h, 0.7f) / (4 * q.z); }),
        microfacet(
            "reflected away", "wi is the direction in which wo is thrown: -reflect.",
            {"horizon", "below", "negated", "opposite", "turned", "-z"}, o, a,
            [=](double u, double v) { return -1.0 * ggx_half(o, a)(u, v); },
            [=](D h) { return ggx(h, a) * h.z / (4 * dot(o, h)); }),
    };
}
}  // namespace mistakes

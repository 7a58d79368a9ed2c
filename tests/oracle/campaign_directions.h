// oracle/campaign_directions.h  directions about an axis: cosines, cones, phase functions
#pragma once
#include "campaign.h"

namespace campaign {

// A direction whose cosine is 1 - x: sines keep their digits where x is small.
template <class T>
Vec<T> by_versine(T x, T v) {
    const auto [a, b] = on_circle(std::sqrt(std::max(T(0), x * (2 - x))), v);
    return {a, b, 1 - x};
}
// 1 - cos of a unit vector.
template <class T>
T versine(Vec<T> w) {
    return w.z > 0 ? (w.x * w.x + w.y * w.y) / (1 + w.z) : 1 - w.z;
}

// A direction above the horizon, or none.
template <class T>
std::optional<Vec<T>> above(Vec<T> w) {
    if (w.z <= 0) return {};
    return w;
}

template <class T>
void cosines(Codes& codes) {
    const Family<T> add{codes, "cosine"};
    auto cosine = [](Vec<T> w) { return textbook::cosine_pdf<T>(w); };
    add("cosine, Malley's disc", textbook::cosine_sample<T>).pdf(cosine);
    add("cosine, disc by squares", [](T u, T v) {
        const auto [x, y] = concentric_disc(u, v);
        return Vec<T>{x, y, std::sqrt(std::max(T(0), 1 - x * x - y * y))};
    }).pdf(cosine);
    add("cosine, by its root", [](T u, T v) { return about_z(std::sqrt(1 - u), v); }).pdf(cosine);
    add("cosine, normal plus a point of the sphere", [](T u, T v) {
        const Vec<T> n = about_z(1 - 2 * u, v) + Vec<T>{0, 0, 1};
        const T length = std::sqrt(dot(n, n));
        return length > 0 ? 1 / length * n : Vec<T>{0, 0, 1};
    }).pdf(cosine);
    for (const Vec<T> n : {unit(Vec<T>{1, 2, -2}), Vec<T>{0, 0, -1}, unit(Vec<T>{T(1e-3), 0, -1})})
        add(say("cosine about (%.3g, %.3g, %.3g)", n.x, n.y, n.z), [n](T u, T v) {
            return Frame<T>(n).world(textbook::cosine_sample(u, v));
        }).pdf([n](Vec<T> w) { return std::max(T(0), dot(n, w)) / pi<T>; });
    const Family<T> power{codes, "power of the cosine"};
    for (const T n : {T(0), T(1), T(5), T(30), T(1e3), T(1e4)})
        power(say("cosine to the power of %g", n), [n](T u, T v) {
            return textbook::phong_sample(u, v, n);
        }).pdf([n](Vec<T> w) { return textbook::phong_pdf(w, n); });
    // A lobe about a mirror's direction, cut off by the horizon.
    const Vec<T> mirrored = polar(T(0.342), T(2));
    for (const T n : {T(5), T(50)})
        power(say("power of %g about 70 degrees, cut", n), [=](T u, T v) {
            return above(Frame<T>(mirrored).world(textbook::phong_sample(u, v, n)));
        }).pdf([=](Vec<T> w) {
            return w.z > 0 ? textbook::phong_pdf({0, 0, dot(w, mirrored)}, n) : 0;
        });
}

template <class T>
void uniform_directions(Codes& codes) {
    const Family<T> add{codes, "uniform directions, cones"};
    auto sphere = [](Vec<T>) { return 1 / (4 * pi<T>); };
    auto hemisphere = [](Vec<T> w) { return w.z >= 0 ? 1 / (2 * pi<T>) : 0; };
    auto on_sphere = [](T u, T v) { return about_z(1 - 2 * u, v); };
    add("sphere", on_sphere).pdf(sphere);
    add("sphere, four normal numbers", [](T a, T b, T c, T d) {
        const Vec<T> w{normal(a, b), normal(a, T(b < T(.75) ? b + T(.25) : b - T(.75))),
                       normal(c, d)};
        return dot(w, w) > 0 ? unit(w) : Vec<T>{1, 0, 0};
    }).pdf(sphere);
    add("hemisphere", [](T u, T v) { return about_z(u, v); }).pdf(hemisphere);
    add("hemisphere, disc by squares", [](T u, T v) {
        const auto [x, y] = concentric_disc(u, v);
        const T r2 = x * x + y * y, scale = std::sqrt(std::max(T(0), 2 - r2));
        return Vec<T>{x * scale, y * scale, 1 - r2};
    }).pdf(hemisphere);
    add("upper half of the sphere", [on_sphere](T u, T v) {
        return above(on_sphere(u, v));
    }).pdf([](Vec<T> w) { return w.z >= 0 ? 1 / (4 * pi<T>) : 0; });
    // One pass of a rejection loop: a point of the cube, if it is in the ball, turned upwards.
    add("hemisphere, points of the cube", [](T u, T v, T s) -> std::optional<Vec<T>> {
        const Vec<T> p{2 * u - 1, 2 * v - 1, 2 * s - 1};
        const T square = dot(p, p);
        if (square > 1 || square == 0) return {};
        return (p.z < 0 ? -1 : 1) / std::sqrt(square) * p;
    }).pdf([](Vec<T> w) { return w.z >= 0 ? T(1) / 12 : 0; });
    for (const double angle : {1e-4, 4.65e-3, 0.05, 0.5, 1.4, 2.5, 3.1}) {
        const T x = T(2 * std::pow(std::sin(angle / 2), 2));  // 1 - cos
        const T square = T(std::pow(std::sin(angle), 2));
        add(say("cone of %g rad by 1 - cos", angle), [x](T u, T v) {
            return by_versine(u * x, v);
        }).pdf([x, square](Vec<T> w) {
            const T s = w.x * w.x + w.y * w.y;
            const bool inside = x < 1 ? w.z > 0 && s <= square : w.z > 0 || s >= square;
            return inside ? 1 / (2 * pi<T> * x) : 0;
        });
    }
    for (const double angle : {4.65e-3, 0.05, 0.5, 2.5}) {
        const T c = T(std::cos(angle));
        add(say("cone of %g rad by cos", angle), [c](T u, T v) {
            return textbook::cone_sample(u, v, c);
        }).pdf([c](Vec<T> w) { return textbook::cone_pdf(w, c); });
    }
    // The Sun's, of which 1 - cos has 180 values in float.
    const T c = T(0.9999893f);
    add("cone of the Sun by u (1 - cos) + cos", [c](T u, T v) {
        return about_z(u * (1 - c) + c, v);
    }).pdf([c](Vec<T> w) { return w.z >= c ? 1 / (2 * pi<T> * (1 - c)) : 0; });
    for (const T a : {T(0.1), T(1), T(3)})
        add(say("lune of %g rad", a), [a](T u, T v) {
            return polar(1 - 2 * u, a * v);
        }).pdf([a](Vec<T> w) {
            const T phi = std::atan2(w.y, w.x);
            return phi >= 0 && phi <= a ? 1 / (2 * a) : 0;
        });
}

template <class T>
T henyey_greenstein(T cosine, T g) {
    const T x = 1 + g * g - 2 * g * cosine;
    return (1 - g * g) / (4 * pi<T> * x * std::sqrt(x));
}

template <class T>
void phase_functions(Codes& codes) {
    const Family<T> add{codes, "phase functions"};
    auto cosine_of = [](T u, T g) {
        if (std::abs(g) < T(1e-3)) return 1 - 2 * u;
        const T s = (1 - g * g) / (1 - g + 2 * g * u);
        return (1 + g * g - s * s) / (2 * g);
    };
    for (const T g : {T(-0.99), T(-0.9), T(-0.4), T(0), T(0.7), T(0.9), T(0.99)})
        add(say("Henyey-Greenstein, g = %g", g), [=](T u, T v) {
            return about_z(cosine_of(u, g), v);
        }).pdf([g](Vec<T> w) { return henyey_greenstein(w.z, g); });
    for (const T g : {T(0.99), T(0.999)})
        add(say("Henyey-Greenstein by 1 - cos, g = %g", g), [g](T u, T v) {
            const T s = (1 - g * g) / (1 - g + 2 * g * u);
            return by_versine((1 - g) * (1 - u) * (s + 1 - g) / (1 - g + 2 * g * u), v);
        }).pdf([g](Vec<T> w) {
            const T x = (1 - g) * (1 - g) + 2 * g * versine(w);
            return (1 - g * g) / (4 * pi<T> * x * std::sqrt(x));
        });
    add("two of Henyey and Greenstein, three numbers", [=](T which, T u, T v) {
        return about_z(cosine_of(u, which < T(0.6) ? T(0.8) : T(-0.3)), v);
    }).pdf([](Vec<T> w) {
        return T(0.6) * henyey_greenstein(w.z, T(0.8)) + T(0.4) * henyey_greenstein(w.z, T(-0.3));
    });
    add("Rayleigh", [](T u, T v) {
        const T b = 2 * (2 * u - 1), a = std::cbrt(b + std::sqrt(b * b + 1));
        return about_z(std::clamp(a - 1 / a, T(-1), T(1)), v);
    }).pdf([](Vec<T> w) { return 3 / (16 * pi<T>)*(1 + w.z * w.z); });
    for (const T k : {T(0.9), T(-0.5)})
        add(say("Schlick's phase function, k = %g", k), [k](T u, T v) {
            return about_z((2 * u + k - 1) / (1 - k + 2 * k * u), v);
        }).pdf([k](Vec<T> w) { return (1 - k * k) / (4 * pi<T> * (1 - k * w.z) * (1 - k * w.z)); });
}

// von Mises and Fisher's density about z, by 1 - cos (Jakob 2012).
template <class T>
Vec<T> fisher_sample(T u, T v, T kappa) {
    const T x = -std::log1p(-u * -std::expm1(-2 * kappa)) / kappa;
    return by_versine(std::min(x, T(2)), v);
}
template <class T>
T fisher_pdf(Vec<T> w, T kappa) {
    return kappa / (2 * pi<T> * -std::expm1(-2 * kappa)) * std::exp(-kappa * versine(w));
}

template <class T>
void fishers(Codes& codes) {
    const Family<T> add{codes, "von Mises and Fisher"};
    for (const T kappa : {T(1e-3), T(0.1), T(1), T(5), T(20), T(1e3), T(1e5)})
        add(say("by 1 - cos, kappa = %g", kappa), [kappa](T u, T v) {
            return fisher_sample(u, v, kappa);
        }).pdf([kappa](Vec<T> w) { return fisher_pdf(w, kappa); });
    for (const T kappa : {T(1), T(50), T(1e3)})
        add(say("by cos, kappa = %g", kappa), [kappa](T u, T v) {
            const T s = u + (1 - u) * std::exp(-2 * kappa);
            return about_z(std::max(T(-1), 1 + std::log(positive(s)) / kappa), v);
        }).pdf([kappa](Vec<T> w) {
            return std::exp(kappa * (w.z - 1)) * kappa / (2 * pi<T> * (1 - std::exp(-2 * kappa)));
        });
    add("kappa = 10 about z, 1000 about x, from two numbers", [](T u, T v) {
        if (u < T(0.3)) return fisher_sample(T(u / T(0.3)), v, T(10));
        const Vec<T> w = fisher_sample(T((u - T(0.3)) / T(0.7)), v, T(1000));
        return Vec<T>{w.z, w.x, w.y};
    }).pdf([](Vec<T> w) {
        return T(0.3) * fisher_pdf(w, T(10)) + T(0.7) * fisher_pdf(Vec<T>{w.y, w.z, w.x}, T(1000));
    });
}

// A hair fibre along z: longitudinally d'Eon et al. 2011 with a variance v about the cone of theta,
// azimuthally a logistic density of scale s trimmed to half a turn.
struct Fibre {
    double v, s, theta;
    // log I0, by the series beyond where it overflows.
    static double log_i0(double x) {
        return x < 500 ? std::log(std::cyl_bessel_i(0, x))
                       : x - std::log(2 * oracle::pi * x) / 2 + std::log1p(1 / (8 * x));
    }
    double logistic_cdf(double x) const { return 1 / (1 + std::exp(-x / s)); }
    oracle::Triple sample(double a, double b, double c) const {
        const double cosine = 1 + v * std::log(a + (1 - a) * std::exp(-2 / v) + 1e-300);
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        const double z = std::clamp(
            -cosine * std::sin(theta) + sine * std::cos(2 * oracle::pi * b) * std::cos(theta), -1.0,
            1.0);
        const double low = logistic_cdf(-oracle::pi), high = logistic_cdf(oracle::pi);
        const double phi =
            std::clamp(-s * std::log(1 / (low + c * (high - low)) - 1), -oracle::pi, oracle::pi);
        const double r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }
    double pdf(const oracle::Triple& w) const {
        const double cosine = std::hypot(w[0], w[1]), phi = std::atan2(w[1], w[0]);
        const double log_m = log_i0(cosine * std::cos(theta) / v) - w[2] * std::sin(theta) / v -
                             1 / v - std::log(v * -std::expm1(-2 / v));
        const double e = std::exp(-std::abs(phi) / s);
        return std::exp(log_m) * e / (s * (1 + e) * (1 + e)) /
               (logistic_cdf(oracle::pi) - logistic_cdf(-oracle::pi));
    }
};
template <class T>
void fibres(Codes& codes) {
    const Family<T> add{codes, "hair fibre"};
    for (const Fibre f : {Fibre{0.5, 0.3, 0}, Fibre{0.1, 0.1, 0.5}, Fibre{0.01, 1, -0.8}})
        add(say("v = %g, s = %g, theta = %g", f.v, f.s, f.theta), [f](T a, T b, T c) {
            const auto w = f.sample(a, b, c);
            return Vec<T>{T(w[0]), T(w[1]), T(w[2])};
        }).pdf([f](Vec<T> w) {
            return T(f.pdf({w.x, w.y, w.z}));
        });
}

// Densities that are off by 5 % or nearly 10 %, of which 10 % are forgiven, whatever the shape.
template <class T>
void tolerated(Codes& codes) {
    const Family<T> add{codes, "tolerance of 10 %"};
    const size_t before = codes.size();
    auto cosine = [&](const std::string& name, auto off) {
        add("cosine, " + name, textbook::cosine_sample<T>).pdf([off](Vec<T> w) {
            return textbook::cosine_pdf(w) * off(w);
        });
    };
    cosine("5 % too large", [](Vec<T>) { return T(1.05); });
    cosine("9.5 % too small", [](Vec<T>) { return T(0.905); });
    cosine("5 % by the sign of x", [](Vec<T> w) { return w.x > 0 ? T(1.05) : T(0.95); });
    cosine("9.5 % by the sign of x", [](Vec<T> w) { return w.x > 0 ? T(1.095) : T(0.905); });
    cosine("5 % by sin 3 phi",
           [](Vec<T> w) { return 1 + T(0.05) * std::sin(3 * std::atan2(w.y, w.x)); });
    cosine("9.5 % by sin 3 phi",
           [](Vec<T> w) { return 1 + T(0.095) * std::sin(3 * std::atan2(w.y, w.x)); });
    cosine("9 % by a chessboard", [](Vec<T> w) { return w.x * w.y > 0 ? T(1.09) : T(0.91); });
    add("uniform hemisphere, 9 % by the height", [](T u, T v) {
        return about_z(u, v);
    }).pdf([](Vec<T> w) { return w.z >= 0 ? (T(0.91) + T(0.18) * w.z) / (2 * pi<T>) : 0; });
    for (size_t i = before; i < codes.size(); ++i) codes[i].tolerance = 0.1;
}

template <class T>
void directions(Codes& codes) {
    cosines<T>(codes);
    uniform_directions<T>(codes);
    phase_functions<T>(codes);
    fishers<T>(codes);
    fibres<T>(codes);
    tolerated<T>(codes);
}

}  // namespace campaign

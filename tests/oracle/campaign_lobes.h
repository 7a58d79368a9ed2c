// oracle/campaign_lobes.h  microfacets: normals, what they reflect and refract, and mixtures
#pragma once
#include "campaign.h"

namespace campaign {

template <class T>
struct Roughness {
    T x, y;
    std::string text() const { return x == y ? say("%g", x) : say("(%g, %g)", x, y); }
};

// ---- Distributions D of normals, and normals h of density D cos
// ----------------------------------

// GGX (Walter et al. 2007; anisotropic: Burley 2012), by slopes: small roughness keeps its digits.
template <class T>
Vec<T> ggx_normal(T u, T v, Roughness<T> a) {
    const T r = std::sqrt(u / (1 - u)), phi = 2 * pi<T> * v;
    return unit(Vec<T>{a.x * r * std::cos(phi), a.y * r * std::sin(phi), 1});
}
template <class T>
T ggx(Vec<T> h, Roughness<T> a) {
    if (h.z <= 0) return 0;
    const T x = h.x / a.x, y = h.y / a.y, s = x * x + y * y + h.z * h.z;
    return 1 / (pi<T> * a.x * a.y * s * s);
}

template <class T>
Vec<T> beckmann_normal(T u, T v, Roughness<T> a) {
    const T r = std::sqrt(-std::log(1 - u)), phi = 2 * pi<T> * v;
    return unit(Vec<T>{a.x * r * std::cos(phi), a.y * r * std::sin(phi), 1});
}
template <class T>
T beckmann(Vec<T> h, Roughness<T> a) {
    if (h.z <= 0) return 0;
    const T x = h.x / (a.x * h.z), y = h.y / (a.y * h.z), c2 = h.z * h.z;
    return std::exp(-(x * x + y * y)) / (pi<T> * a.x * a.y * c2 * c2);
}

template <class T>
void normals(Codes& codes) {
    const std::string ggx_family = "GGX, all normals";
    for (const Roughness<T> a : {Roughness<T>{T(1e-3), T(1e-3)},
                                 {T(0.01), T(0.01)},
                                 {T(0.05), T(0.05)},
                                 {T(0.2), T(0.2)},
                                 {T(0.5), T(0.5)},
                                 {T(0.8), T(0.8)},
                                 {T(1), T(1)},
                                 {T(0.5), T(0.05)},
                                 {T(0.1), T(1)},
                                 {T(0.03), T(0.003)}})
        add<T>(
            codes, ggx_family, "h by slopes, " + a.text(),
            [a](T u, T v) { return ggx_normal(u, v, a); },
            [a](Vec<T> h) { return ggx(h, a) * h.z; });
    for (const T a : {T(1e-3), T(0.1), T(0.5)})
        add<T>(
            codes, ggx_family, say("h by cos, %g", a),
            [a](T u, T v) {
                return polar(std::sqrt((1 - u) / (1 + (a * a - 1) * u)), 2 * pi<T> * v);
            },
            [a](Vec<T> h) { return textbook::ggx_d(h, a) * h.z; });
    for (const Roughness<T> a : {Roughness<T>{T(0.01), T(0.01)},
                                 {T(0.1), T(0.1)},
                                 {T(0.5), T(0.5)},
                                 {T(1), T(1)},
                                 {T(0.6), T(0.06)}})
        add<T>(
            codes, "Beckmann", "h, " + a.text(), [a](T u, T v) { return beckmann_normal(u, v, a); },
            [a](Vec<T> h) { return beckmann(h, a) * h.z; });
    // GTR1 (Burley 2012), by sin^2 and by cos^2.
    for (const T a : {T(1e-3), T(0.01), T(0.1), T(0.5), T(0.9)})
        add<T>(
            codes, "GTR1", say("h by sin, %g", a),
            [a](T u, T v) {
                const T s2 = a * a * std::expm1(-u * 2 * std::log(a)) / (1 - a * a);
                const T sine = std::sqrt(s2), phi = 2 * pi<T> * v;
                return Vec<T>{sine * std::cos(phi), sine * std::sin(phi),
                              std::sqrt(std::max(T(0), 1 - s2))};
            },
            [a](Vec<T> h) {
                if (h.z <= 0) return T(0);
                const T s2 = h.x * h.x + h.y * h.y;
                return h.z * (1 - a * a) / (-2 * pi<T> * std::log(a) * (s2 + a * a * h.z * h.z));
            });
    for (const T a : {T(1e-3), T(0.1)})
        add<T>(
            codes, "GTR1", say("h by cos, %g", a),
            [a](T u, T v) {
                const T c2 = (1 - std::pow(a * a, 1 - u)) / (1 - a * a);
                return polar(std::sqrt(std::max(T(0), c2)), 2 * pi<T> * v);
            },
            [a](Vec<T> h) {
                if (h.z <= 0) return T(0);
                const T t = 1 + (a * a - 1) * h.z * h.z;
                return h.z * (a * a - 1) / (pi<T> * std::log(a * a) * t);
            });
    // "Charlie" (Estevez, Kulla 2017).
    for (const T a : {T(0.05), T(0.3), T(0.5), T(1)})
        add<T>(
            codes, "Charlie", say("h, %g", a),
            [a](T u, T v) {
                const T sine = std::pow(u, a / (2 * a + 1)), phi = 2 * pi<T> * v;
                return Vec<T>{sine * std::cos(phi), sine * std::sin(phi),
                              std::sqrt(std::max(T(0), 1 - sine * sine))};
            },
            [a](Vec<T> h) {
                if (h.z <= 0) return T(0);
                const T sine = std::sqrt(h.x * h.x + h.y * h.y);
                return (2 + 1 / a) * std::pow(sine, 1 / a) / (2 * pi<T>)*h.z;
            });
}

// ---- Ashikhmin and Shirley 2000
// ------------------------------------------------------------------

// Half vectors, a quadrant at a time.
template <class T>
Vec<T> ashikhmin_normal(T u, T v, T nu, T nv) {
    const int quadrant = int(4 * u);
    const T part = 4 * u - T(quadrant), quarter = quadrant % 2 == 0 ? part : 1 - part;
    const T angle = std::atan(std::sqrt((nu + 1) / (nv + 1)) * std::tan(pi<T> / 2 * quarter));
    const T phi = quadrant == 0   ? angle
                  : quadrant == 1 ? pi<T> - angle
                  : quadrant == 2 ? pi<T> + angle
                                  : 2 * pi<T> - angle;
    const T c = std::cos(phi), s = std::sin(phi);
    return polar(std::pow(1 - v, 1 / (nu * c * c + nv * s * s + 1)), phi);
}
template <class T>
T ashikhmin(Vec<T> h, T nu, T nv) {
    if (h.z <= 0) return 0;
    const T s2 = 1 - h.z * h.z, front = std::sqrt((nu + 1) * (nv + 1)) / (2 * pi<T>);
    return s2 > 0 ? front * std::pow(h.z, (nu * h.x * h.x + nv * h.y * h.y) / s2) : front;
}

template <class T>
void ashikhmins(Codes& codes) {
    const std::string family = "Ashikhmin and Shirley";
    for (const auto& c : {std::pair<T, T>{0, 0}, {10, 10}, {100, 10}, {10, 1000}, {1e4, 1e3}}) {
        const T nu = c.first, nv = c.second;
        add<T>(
            codes, family, say("h, (%g, %g)", nu, nv),
            [nu, nv](T u, T v) { return ashikhmin_normal(u, v, nu, nv); },
            [nu, nv](Vec<T> h) { return ashikhmin(h, nu, nv); });
    }
    const Vec<T> wo = polar(T(0.6), T(1));
    add<T>(
        codes, family, "wi, (100, 20)",
        [=](T u, T v) { return reflected(wo, ashikhmin_normal(u, v, T(100), T(20))); },
        [=](Vec<T> wi) {
            if (wi.z <= 0) return T(0);
            const Vec<T> h = unit(wo + wi);
            return ashikhmin(h, T(100), T(20)) / (4 * dot(wo, h));
        });
}

// ---- Reflection and refraction
// -------------------------------------------------------------------

template <class T>
Vec<T> view(double degrees) {
    return polar(T(std::cos(degrees * oracle::pi / 180)), T(0.7));
}

// Smith's masking of GGX.
template <class T>
T ggx_masking(Vec<T> w, Roughness<T> a) {
    if (w.z <= 0) return 0;
    const T x = a.x * w.x, y = a.y * w.y;
    return 2 * w.z / (w.z + std::sqrt(w.z * w.z + x * x + y * y));
}

// Visible normals by a disc (Heitz 2018), and by a cap of the sphere (Dupuy, Benyoub 2023).
template <class T>
Vec<T> visible_by_disc(Vec<T> wo, T u, T v, Roughness<T> a) {
    const Vec<T> s = unit(Vec<T>{a.x * wo.x, a.y * wo.y, wo.z});
    const T length2 = s.x * s.x + s.y * s.y;
    const Vec<T> t1 = length2 > 0 ? 1 / std::sqrt(length2) * Vec<T>{-s.y, s.x, 0} : Vec<T>{1, 0, 0};
    auto [p1, p2] = polar_disc(u, v);
    const T half = (1 + s.z) / 2;
    p2 = (1 - half) * std::sqrt(std::max(T(0), 1 - p1 * p1)) + half * p2;
    const T p3 = std::sqrt(std::max(T(0), 1 - p1 * p1 - p2 * p2));
    const Vec<T> n = p1 * t1 + p2 * cross(s, t1) + p3 * s;
    return unit(Vec<T>{a.x * n.x, a.y * n.y, std::max(T(1e-9), n.z)});
}
template <class T>
Vec<T> visible_by_cap(Vec<T> wo, T u, T v, Roughness<T> a) {
    const Vec<T> s = unit(Vec<T>{a.x * wo.x, a.y * wo.y, wo.z});
    const Vec<T> n = polar((1 - u) * (1 + s.z) - s.z, 2 * pi<T> * v) + s;
    return unit(Vec<T>{a.x * n.x, a.y * n.y, n.z});
}
template <class T>
T visible_pdf(Vec<T> wo, Vec<T> h, Roughness<T> a) {
    return ggx_masking(wo, a) * ggx(h, a) * std::max(T(0), dot(wo, h)) / wo.z;
}
// What they reflect.
template <class T>
T visible_reflected_pdf(Vec<T> wo, Vec<T> wi, Roughness<T> a) {
    return wi.z > 0 ? ggx_masking(wo, a) * ggx(unit(wo + wi), a) / (4 * wo.z) : 0;
}

// Beckmann's visible normals by slopes (Heitz, d'Eon 2014), whose inverses are found by halving.
template <class T>
struct BeckmannVisible {
    Vec<double> wo;
    Roughness<double> a;

    template <class F>
    static double where(double target, double low, const F& f) {
        double high = 9;
        for (int i = 0; i < 60; ++i) {
            const double middle = (low + high) / 2;
            (f(middle) < target ? low : high) = middle;
        }
        return low;
    }
    Vec<T> sample(T u, T v) const {
        const Vec<double> s = unit(Vec<double>{a.x * wo.x, a.y * wo.y, wo.z});
        const double sine = std::hypot(s.x, s.y), least = std::max(-9.0, -s.z / sine);
        auto along = [&](double t) {
            return s.z * std::sqrt(oracle::pi) * (std::erf(t) - std::erf(least)) +
                   sine * (std::exp(-least * least) - std::exp(-t * t));
        };
        const double x = where(double(u) * along(9), least, along);
        const double y = where(2 * double(v) - 1, -9, [](double t) { return std::erf(t); });
        const Vec<double> h = unit(
            Vec<double>{a.x * (s.x * x - s.y * y) / sine, a.y * (s.y * x + s.x * y) / sine, 1});
        const Vec<double> wi = reflected(wo, h);
        return {T(wi.x), T(wi.y), T(wi.z)};
    }
    T pdf(Vec<T> w) const {
        if (w.z <= 0) return 0;
        const double b = wo.z / std::hypot(a.x * wo.x, a.y * wo.y);
        const double lambda =
            (std::erf(b) - 1) / 2 + std::exp(-b * b) / (2 * b * std::sqrt(oracle::pi));
        const Vec<double> h = unit(wo + Vec<double>{w.x, w.y, w.z});
        return T(beckmann(h, a) / ((1 + lambda) * 4 * wo.z));
    }
};

template <class T>
void reflections(Codes& codes) {
    struct Case {
        double degrees;
        T x, y;
    };
    for (const auto& [degrees, x, y] : {Case{30, T(0.1), T(0.1)},
                                        {30, T(0.5), T(0.5)},
                                        {60, T(0.3), T(0.3)},
                                        {80, T(0.3), T(0.3)},
                                        {0, T(1), T(1)},
                                        {45, T(0.5), T(0.1)}}) {
        const Vec<T> wo = view<T>(degrees);
        const Roughness<T> a{x, y};
        add<T>(
            codes, "GGX, all normals", say("wi at %g degrees, ", degrees) + a.text(),
            [wo, a](T u, T v) { return reflected(wo, ggx_normal(u, v, a)); },
            [wo, a](Vec<T> wi) {
                if (wi.z <= 0) return T(0);
                const Vec<T> h = unit(wo + wi);
                return ggx(h, a) * h.z / (4 * dot(wo, h));
            });
    }
    for (const auto& [degrees, x, y] : {Case{30, T(0.3), T(0.3)}, {70, T(0.5), T(0.2)}}) {
        const Vec<T> wo = view<T>(degrees);
        const Roughness<T> a{x, y};
        add<T>(
            codes, "Beckmann", say("wi at %g degrees, ", degrees) + a.text(),
            [wo, a](T u, T v) { return reflected(wo, beckmann_normal(u, v, a)); },
            [wo, a](Vec<T> wi) {
                if (wi.z <= 0) return T(0);
                const Vec<T> h = unit(wo + wi);
                return beckmann(h, a) * h.z / (4 * dot(wo, h));
            });
    }
    for (const auto& [degrees, x, y] : {Case{30, T(0.3), T(0.3)}, {65, T(0.5), T(0.2)}}) {
        const BeckmannVisible<T> visible{view<double>(degrees), {double(x), double(y)}};
        add<T>(
            codes, "Beckmann",
            say("wi by visible normals at %g degrees, ", degrees) + Roughness<T>{x, y}.text(),
            [visible](T u, T v) { return visible.sample(u, v); },
            [visible](Vec<T> wi) { return visible.pdf(wi); });
    }
    for (const auto& [degrees, x, y] : {Case{45, T(1e-3), T(1e-3)},
                                        {45, T(0.02), T(0.02)},
                                        {45, T(0.3), T(0.3)},
                                        {45, T(1), T(1)},
                                        {0, T(0.1), T(0.1)},
                                        {85, T(0.1), T(0.1)},
                                        {85, T(0.7), T(0.7)},
                                        {89, T(0.3), T(0.3)},
                                        {60, T(0.6), T(0.06)},
                                        {75, T(0.05), T(0.5)},
                                        {30, T(0.03), T(0.003)}}) {
        const Vec<T> wo = view<T>(degrees);
        const Roughness<T> a{x, y};
        add<T>(
            codes, "GGX, visible normals", say("wi at %g degrees, ", degrees) + a.text(),
            [wo, a](T u, T v) { return reflected(wo, visible_by_disc(wo, u, v, a)); },
            [wo, a](Vec<T> wi) { return visible_reflected_pdf(wo, wi, a); });
    }
    for (const auto& [degrees, x, y] : {Case{45, T(0.3), T(0.3)}, {70, T(0.5), T(0.1)}}) {
        const Vec<T> wo = view<T>(degrees);
        const Roughness<T> a{x, y};
        const std::string where = say(" at %g degrees, ", degrees) + a.text();
        add<T>(
            codes, "GGX, visible normals", "h" + where,
            [wo, a](T u, T v) { return visible_by_disc(wo, u, v, a); },
            [wo, a](Vec<T> h) { return visible_pdf(wo, h, a); });
        add<T>(
            codes, "GGX, visible normals", "wi by caps" + where,
            [wo, a](T u, T v) { return reflected(wo, visible_by_cap(wo, u, v, a)); },
            [wo, a](Vec<T> wi) { return visible_reflected_pdf(wo, wi, a); });
    }
    // In the world's coordinates, about a normal.
    for (const T rough : {T(0.1), T(0.5)}) {
        const Frame<T> frame(unit(Vec<T>{1, -2, T(0.5)}));
        const Vec<T> wo = view<T>(55);
        const Roughness<T> a{rough, rough};
        add<T>(
            codes, "GGX, visible normals", say("wi by caps in the world, %g", rough),
            [=](T u, T v) { return frame.world(reflected(wo, visible_by_cap(wo, u, v, a))); },
            [=](Vec<T> wi) { return visible_reflected_pdf(wo, frame.local(wi), a); });
    }
    // Refraction (Walter et al. 2007), into glass and out of it; ratio: index above over below.
    for (const T ratio : {1 / T(1.5), T(1.5)})
        for (const T rough : {T(0.1), T(0.4)}) {
            const Vec<T> wo = view<T>(35);
            const Roughness<T> a{rough, rough};
            add<T>(
                codes, "refraction", say("wi, ratio %.3g, roughness %g", ratio, rough),
                [=](T u, T v) -> std::optional<Vec<T>> {
                    const Vec<T> h = ggx_normal(u, v, a);
                    const T c = dot(wo, h), under = 1 + ratio * ratio * (c * c - 1);
                    if (c <= 0 || under <= 0) return {};
                    return (ratio * c - std::sqrt(under)) * h + -ratio * wo;
                },
                [=](Vec<T> wi) {
                    if (wi.z >= 0) return T(0);
                    Vec<T> h = unit(ratio * wo + wi);
                    if (h.z < 0) h = T(-1) * h;
                    const T o = dot(wo, h), i = dot(wi, h), sum = ratio * o + i;
                    if (o <= 0 || i >= 0) return T(0);
                    return ggx(h, a) * h.z * -i / (sum * sum);
                });
        }
}

// ---- Mixtures
// ------------------------------------------------------------------------------------

template <class T>
void mixtures(Codes& codes) {
    const std::string family = "mixtures";
    const Vec<T> wo = view<T>(50);
    for (const T rough : {T(0.02), T(0.1), T(0.3)}) {
        const Roughness<T> a{rough, rough};
        auto pdf = [=](Vec<T> wi) {
            return textbook::cosine_pdf(wi) / 2 + visible_reflected_pdf(wo, wi, a) / 2;
        };
        auto lobe = [=](T u, T v) { return reflected(wo, visible_by_disc(wo, u, v, a)); };
        add<T>(
            codes, family, say("diffuse and GGX %g, three numbers", rough),
            [=](T which, T u, T v) {
                return which < T(0.5) ? textbook::cosine_sample(u, v) : lobe(u, v);
            },
            pdf);
        add<T>(
            codes, family, say("diffuse and GGX %g, two numbers", rough),
            [=](T u, T v) {
                return u < T(0.5) ? textbook::cosine_sample(2 * u, v) : lobe(2 * u - 1, v);
            },
            pdf);
    }
    add<T>(
        codes, family, "cosine and uniform hemisphere",
        [](T u, T v) {
            return u < T(0.25) ? textbook::cosine_sample(4 * u, v)
                               : polar((u - T(0.25)) / T(0.75), 2 * pi<T> * v);
        },
        [](Vec<T> w) { return w.z >= 0 ? w.z / (4 * pi<T>)+T(0.75) / (2 * pi<T>) : 0; });
    add<T>(
        codes, family, "diffuse reflection and transmission",
        [](T u, T v) {
            if (u < T(0.6)) return textbook::cosine_sample(u / T(0.6), v);
            Vec<T> w = textbook::cosine_sample((u - T(0.6)) / T(0.4), v);
            w.z = -w.z;
            return w;
        },
        [](Vec<T> w) { return (w.z > 0 ? T(0.6) * w.z : T(-0.4) * w.z) / pi<T>; });
    add<T>(
        codes, family, "diffuse, Phong 10 and Phong 1000, three numbers",
        [](T which, T u, T v) {
            return which < T(0.2)   ? textbook::cosine_sample(u, v)
                   : which < T(0.5) ? textbook::phong_sample(u, v, T(10))
                                    : textbook::phong_sample(u, v, T(1000));
        },
        [](Vec<T> w) {
            return T(0.2) * textbook::cosine_pdf(w) + T(0.3) * textbook::phong_pdf(w, T(10)) +
                   T(0.5) * textbook::phong_pdf(w, T(1000));
        });
}

template <class T>
void lobes(Codes& codes) {
    normals<T>(codes);
    ashikhmins<T>(codes);
    reflections<T>(codes);
    mixtures<T>(codes);
}

}  // namespace campaign

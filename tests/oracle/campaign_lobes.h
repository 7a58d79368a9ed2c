// oracle/campaign_lobes.h  microfacets: normals, what they reflect and refract, and mixtures
#pragma once
#include "campaign.h"

namespace campaign {

template <class T>
struct Roughness {
    T x, y;
    Roughness(double a) : Roughness(a, a) {}
    Roughness(double a, double b) : x(T(a)), y(T(b)) {}
    std::string text() const { return x == y ? say("%g", x) : say("(%g, %g)", x, y); }
};

// ---- Distributions D of normals, and normals h of density D cos ---------------------------------

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

// The density of what normals of this density reflect.
template <class T, class Pdf>
T reflected_pdf(Vec<T> wo, Vec<T> wi, const Pdf& of_normal) {
    if (wi.z <= 0) return 0;
    const Vec<T> h = unit(wo + wi);
    return of_normal(h) / (4 * dot(wo, h));
}

template <class T>
void normals(Codes& codes) {
    const Family<T> in_ggx{codes, "GGX, all normals"}, in_beckmann{codes, "Beckmann"},
        gtr1{codes, "GTR1"}, charlie{codes, "Charlie"};
    using Some = std::initializer_list<Roughness<T>>;
    for (const Roughness<T> a :
         Some{1e-3, 0.01, 0.05, 0.2, 0.5, 0.8, 1, {0.5, 0.05}, {0.1, 1}, {0.03, 0.003}})
        in_ggx("h by slopes, " + a.text(), [a](T u, T v) {
            return ggx_normal(u, v, a);
        }).pdf([a](Vec<T> h) { return ggx(h, a) * h.z; });
    for (const T a : {T(1e-3), T(0.1), T(0.5)})
        in_ggx(say("h by cos, %g", a), [a](T u, T v) {
            return about_z(std::sqrt((1 - u) / (1 + (a * a - 1) * u)), v);
        }).pdf([a](Vec<T> h) { return textbook::ggx_d(h, a) * h.z; });
    for (const Roughness<T> a : Some{0.01, 0.1, 0.5, 1, {0.6, 0.06}})
        in_beckmann("h, " + a.text(), [a](T u, T v) {
            return beckmann_normal(u, v, a);
        }).pdf([a](Vec<T> h) { return beckmann(h, a) * h.z; });
    // GTR1 (Burley 2012), by sin^2 and by cos^2.
    for (const T a : {T(1e-3), T(0.01), T(0.1), T(0.5), T(0.9)})
        gtr1(say("h by sin, %g", a), [a](T u, T v) {
            const T s2 = a * a * std::expm1(-u * 2 * std::log(a)) / (1 - a * a);
            const auto [x, y] = on_circle(std::sqrt(s2), v);
            return Vec<T>{x, y, std::sqrt(std::max(T(0), 1 - s2))};
        }).pdf([a](Vec<T> h) {
            if (h.z <= 0) return T(0);
            const T s2 = h.x * h.x + h.y * h.y;
            return h.z * (1 - a * a) / (-2 * pi<T> * std::log(a) * (s2 + a * a * h.z * h.z));
        });
    for (const T a : {T(1e-3), T(0.1)})
        gtr1(say("h by cos, %g", a), [a](T u, T v) {
            const T c2 = (1 - std::pow(a * a, 1 - u)) / (1 - a * a);
            return about_z(std::sqrt(std::max(T(0), c2)), v);
        }).pdf([a](Vec<T> h) {
            if (h.z <= 0) return T(0);
            const T t = 1 + (a * a - 1) * h.z * h.z;
            return h.z * (a * a - 1) / (pi<T> * std::log(a * a) * t);
        });
    // "Charlie" (Estevez, Kulla 2017).
    for (const T a : {T(0.05), T(0.3), T(0.5), T(1)})
        charlie(say("h, %g", a), [a](T u, T v) {
            const T sine = std::pow(u, a / (2 * a + 1));
            const auto [x, y] = on_circle(sine, v);
            return Vec<T>{x, y, std::sqrt(std::max(T(0), 1 - sine * sine))};
        }).pdf([a](Vec<T> h) {
            if (h.z <= 0) return T(0);
            const T sine = std::sqrt(h.x * h.x + h.y * h.y);
            return (2 + 1 / a) * std::pow(sine, 1 / a) / (2 * pi<T>)*h.z;
        });
}

// ---- Ashikhmin and Shirley 2000 -----------------------------------------------------------------

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
    const Family<T> add{codes, "Ashikhmin and Shirley"};
    for (const auto& c : {std::pair<T, T>{0, 0}, {10, 10}, {100, 10}, {10, 1000}, {1e4, 1e3}}) {
        const T nu = c.first, nv = c.second;
        add(say("h, (%g, %g)", nu, nv), [nu, nv](T u, T v) {
            return ashikhmin_normal(u, v, nu, nv);
        }).pdf([nu, nv](Vec<T> h) { return ashikhmin(h, nu, nv); });
    }
    const Vec<T> wo = polar(T(0.6), T(1));
    add("wi, (100, 20)", [=](T u, T v) {
        return reflected(wo, ashikhmin_normal(u, v, T(100), T(20)));
    }).pdf([=](Vec<T> wi) {
        return reflected_pdf(wo, wi, [](Vec<T> h) { return ashikhmin(h, T(100), T(20)); });
    });
}

// ---- Reflection and refraction ------------------------------------------------------------------

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
    const Vec<T> n = about_z((1 - u) * (1 + s.z) - s.z, v) + s;
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
struct View {
    Vec<T> wo;
    Roughness<T> a;
    std::string text;  // with which the name of a code ends
    View(double degrees, Roughness<T> rough)
        : wo(view<T>(degrees)), a(rough), text(say("at %g degrees, ", degrees) + a.text()) {}
};

template <class T>
void reflections(Codes& codes) {
    const Family<T> in_ggx{codes, "GGX, all normals"}, beckmanns{codes, "Beckmann"},
        visible{codes, "GGX, visible normals"}, refraction{codes, "refraction"};
    using Views = std::initializer_list<View<T>>;
    for (const View<T>& s :
         Views{{30, 0.1}, {30, 0.5}, {60, 0.3}, {80, 0.3}, {0, 1}, {45, {0.5, 0.1}}})
        in_ggx("wi " + s.text, [s](T u, T v) {
            return reflected(s.wo, ggx_normal(u, v, s.a));
        }).pdf([s](Vec<T> wi) {
            return reflected_pdf(s.wo, wi, [&](Vec<T> h) { return ggx(h, s.a) * h.z; });
        });
    for (const View<T>& s : Views{{30, 0.3}, {70, {0.5, 0.2}}})
        beckmanns("wi " + s.text, [s](T u, T v) {
            return reflected(s.wo, beckmann_normal(u, v, s.a));
        }).pdf([s](Vec<T> wi) {
            return reflected_pdf(s.wo, wi, [&](Vec<T> h) { return beckmann(h, s.a) * h.z; });
        });
    for (const auto& [degrees, x, y] : {std::tuple(30, 0.3, 0.3), {65, 0.5, 0.2}}) {
        const View<T> s(degrees, {x, y});
        const BeckmannVisible<T> by_slopes{view<double>(degrees), {double(s.a.x), double(s.a.y)}};
        beckmanns.both("wi by visible normals " + s.text, by_slopes);
    }
    for (const View<T>& s : Views{{45, 1e-3},
                                  {45, 0.02},
                                  {45, 0.3},
                                  {45, 1},
                                  {0, 0.1},
                                  {85, 0.1},
                                  {85, 0.7},
                                  {89, 0.3},
                                  {60, {0.6, 0.06}},
                                  {75, {0.05, 0.5}},
                                  {30, {0.03, 0.003}}})
        visible("wi " + s.text, [s](T u, T v) {
            return reflected(s.wo, visible_by_disc(s.wo, u, v, s.a));
        }).pdf([s](Vec<T> wi) { return visible_reflected_pdf(s.wo, wi, s.a); });
    for (const View<T>& s : Views{{45, 0.3}, {70, {0.5, 0.1}}}) {
        visible("h " + s.text, [s](T u, T v) {
            return visible_by_disc(s.wo, u, v, s.a);
        }).pdf([s](Vec<T> h) { return visible_pdf(s.wo, h, s.a); });
        visible("wi by caps " + s.text, [s](T u, T v) {
            return reflected(s.wo, visible_by_cap(s.wo, u, v, s.a));
        }).pdf([s](Vec<T> wi) { return visible_reflected_pdf(s.wo, wi, s.a); });
    }
    // In the world's coordinates, about a normal.
    const Frame<T> frame(unit(Vec<T>{1, -2, T(0.5)}));
    for (const T rough : {T(0.1), T(0.5)}) {
        const View<T> s(55, rough);
        visible(say("wi by caps in the world, %g", rough), [=](T u, T v) {
            return frame.world(reflected(s.wo, visible_by_cap(s.wo, u, v, s.a)));
        }).pdf([=](Vec<T> wi) { return visible_reflected_pdf(s.wo, frame.local(wi), s.a); });
    }
    // Refraction (Walter et al. 2007), into glass and out of it; ratio: index above over below.
    for (const T ratio : {1 / T(1.5), T(1.5)})
        for (const T rough : {T(0.1), T(0.4)}) {
            const Vec<T> wo = view<T>(35);
            const Roughness<T> a = rough;
            refraction(say("wi, ratio %.3g, roughness %g", ratio, rough),
                       [=](T u, T v) -> std::optional<Vec<T>> {
                           const Vec<T> h = ggx_normal(u, v, a);
                           const T c = dot(wo, h), under = 1 + ratio * ratio * (c * c - 1);
                           if (c <= 0 || under <= 0) return {};
                           return (ratio * c - std::sqrt(under)) * h + -ratio * wo;
                       })
                .pdf([=](Vec<T> wi) {
                    if (wi.z >= 0) return T(0);
                    Vec<T> h = unit(ratio * wo + wi);
                    if (h.z < 0) h = T(-1) * h;
                    const T o = dot(wo, h), i = dot(wi, h), sum = ratio * o + i;
                    if (o <= 0 || i >= 0) return T(0);
                    return ggx(h, a) * h.z * -i / (sum * sum);
                });
        }
}

// ---- Mixtures -----------------------------------------------------------------------------------

template <class T>
void mixtures(Codes& codes) {
    const Family<T> add{codes, "mixtures"};
    const Vec<T> wo = view<T>(50);
    for (const T rough : {T(0.02), T(0.1), T(0.3)}) {
        const Roughness<T> a = rough;
        auto pdf = [=](Vec<T> wi) {
            return textbook::cosine_pdf(wi) / 2 + visible_reflected_pdf(wo, wi, a) / 2;
        };
        auto lobe = [=](T u, T v) { return reflected(wo, visible_by_disc(wo, u, v, a)); };
        add(say("diffuse and GGX %g, three numbers", rough), [=](T which, T u, T v) {
            return which < T(0.5) ? textbook::cosine_sample(u, v) : lobe(u, v);
        }).pdf(pdf);
        add(say("diffuse and GGX %g, two numbers", rough), [=](T u, T v) {
            return u < T(0.5) ? textbook::cosine_sample(2 * u, v) : lobe(2 * u - 1, v);
        }).pdf(pdf);
    }
    add("cosine and uniform hemisphere", [](T u, T v) {
        return u < T(0.25) ? textbook::cosine_sample(4 * u, v)
                           : about_z((u - T(0.25)) / T(0.75), v);
    }).pdf([](Vec<T> w) { return w.z >= 0 ? w.z / (4 * pi<T>)+T(0.75) / (2 * pi<T>) : 0; });
    add("diffuse reflection and transmission", [](T u, T v) {
        if (u < T(0.6)) return textbook::cosine_sample(u / T(0.6), v);
        Vec<T> w = textbook::cosine_sample((u - T(0.6)) / T(0.4), v);
        w.z = -w.z;
        return w;
    }).pdf([](Vec<T> w) { return (w.z > 0 ? T(0.6) * w.z : T(-0.4) * w.z) / pi<T>; });
    add("diffuse, Phong 10 and Phong 1000, three numbers", [](T which, T u, T v) {
        return which < T(0.2)   ? textbook::cosine_sample(u, v)
               : which < T(0.5) ? textbook::phong_sample(u, v, T(10))
                                : textbook::phong_sample(u, v, T(1000));
    }).pdf([](Vec<T> w) {
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

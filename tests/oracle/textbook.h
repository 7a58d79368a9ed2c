// oracle/textbook.h  samplers and densities as books print them, in float or double
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

namespace textbook {

template <class T>
struct Vec {
    T x, y, z;
    friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec operator*(T s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
    friend T dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend Vec cross(Vec a, Vec b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    friend Vec unit(Vec a) { return (1 / std::sqrt(dot(a, a))) * a; }
};
template <class T>
constexpr T pi = std::numbers::pi_v<T>;

template <class T>
Vec<T> polar(T cosine, T phi) {
    const T sine = std::sqrt(std::max(T(0), 1 - cosine * cosine));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

// Malley's method, cos(theta) / pi.
template <class T>
Vec<T> cosine_sample(T u, T v) {
    const T r = std::sqrt(u), phi = 2 * pi<T> * v;
    const T x = r * std::cos(phi), y = r * std::sin(phi);
    return {x, y, std::sqrt(std::max(T(0), 1 - x * x - y * y))};
}
template <class T>
T cosine_pdf(Vec<T> w) {
    return w.z > 0 ? w.z / pi<T> : 0;
}

// (n + 1) / (2 pi) cos^n about z (Blinn 1977; Lafortune, Willems 1994).
template <class T>
Vec<T> phong_sample(T u, T v, T n) {
    return polar(std::pow(u, 1 / (n + 1)), 2 * pi<T> * v);
}
template <class T>
T phong_pdf(Vec<T> w, T n) {
    return w.z > 0 ? (n + 1) / (2 * pi<T>)*std::pow(w.z, n) : 0;
}

// Uniform in the cone about z whose cosines are above c.
template <class T>
Vec<T> cone_sample(T u, T v, T c) {
    return polar((1 - u) + u * c, 2 * pi<T> * v);
}
template <class T>
T cone_pdf(Vec<T> w, T c) {
    return w.z >= c ? 1 / (2 * pi<T> * (1 - c)) : 0;
}

// GGX (Walter, Marschner, Li, Torrance 2007).
template <class T>
T ggx_d(Vec<T> h, T a) {
    if (h.z <= 0) return 0;
    const T c2 = h.z * h.z, d = c2 * (a * a - 1) + 1;
    return a * a / (pi<T> * d * d);
}
template <class T>
T ggx_g1(Vec<T> w, T a) {
    if (w.z <= 0) return 0;
    const T c2 = w.z * w.z, t2 = std::max(T(0), 1 - c2) / c2;
    return 2 / (1 + std::sqrt(1 + a * a * t2));
}
template <class T>
Vec<T> reflected(Vec<T> wo, Vec<T> h) {
    return 2 * dot(wo, h) * h + T(-1) * wo;
}
// By half vectors, D cos(theta_h): theta_h from tan^2 = a^2 u / (1 - u).
template <class T>
Vec<T> ggx_half_sample(Vec<T> wo, T u, T v, T a) {
    const T tan2 = a * a * u / (1 - u), c = 1 / std::sqrt(1 + tan2);
    return reflected(wo, polar(c, 2 * pi<T> * v));
}
template <class T>
T ggx_half_pdf(Vec<T> wo, Vec<T> wi, T a) {
    if (wi.z <= 0) return 0;
    const Vec<T> h = unit(wo + wi);
    return ggx_d(h, a) * h.z / (4 * dot(wo, h));
}
// By visible normals (Heitz 2018).
template <class T>
Vec<T> ggx_visible_sample(Vec<T> wo, T u, T v, T a) {
    const Vec<T> s = unit(Vec<T>{a * wo.x, a * wo.y, wo.z});
    const T length2 = s.x * s.x + s.y * s.y;
    const Vec<T> t1 =
        length2 > 0 ? (1 / std::sqrt(length2)) * Vec<T>{-s.y, s.x, 0} : Vec<T>{1, 0, 0};
    const Vec<T> t2 = cross(s, t1);
    const T r = std::sqrt(u), phi = 2 * pi<T> * v, half = (1 + s.z) / 2;
    const T p1 = r * std::cos(phi);
    const T p2 = (1 - half) * std::sqrt(1 - p1 * p1) + half * r * std::sin(phi);
    const T p3 = std::sqrt(std::max(T(0), 1 - p1 * p1 - p2 * p2));
    const Vec<T> n = p1 * t1 + p2 * t2 + p3 * s;
    return reflected(wo, unit(Vec<T>{a * n.x, a * n.y, std::max(T(0), n.z)}));
}
template <class T>
T ggx_visible_pdf(Vec<T> wo, Vec<T> wi, T a) {
    if (wi.z <= 0) return 0;
    const Vec<T> h = unit(wo + wi);
    return ggx_g1(wo, a) * ggx_d(h, a) / (4 * wo.z);
}

}  // namespace textbook

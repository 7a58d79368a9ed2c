// oracle/campaign_lights.h  directions to lights: spheres, rectangles, triangles, maps
#pragma once
#include "campaign.h"

namespace campaign {

// Uniform in a spherical triangle (Arvo 1995), whose corners turn counterclockwise from outside.
template <class T>
struct SphericalTriangle {
    Vec<T> a, b, c;
    T alpha, cos_alpha, sin_alpha, cos_c, area;
    SphericalTriangle(Vec<T> a_, Vec<T> b_, Vec<T> c_) : a(unit(a_)), b(unit(b_)), c(unit(c_)) {
        const Vec<T> ab = unit(cross(a, b)), bc = unit(cross(b, c)), ca = unit(cross(c, a));
        auto angle = [](Vec<T> m, Vec<T> n) {
            return std::acos(std::clamp(-dot(m, n), T(-1), T(1)));
        };
        alpha = angle(ca, ab);
        area = alpha + angle(ab, bc) + angle(bc, ca) - pi<T>;
        cos_alpha = std::cos(alpha), sin_alpha = std::sin(alpha), cos_c = dot(a, b);
    }
    static Vec<T> across(Vec<T> v, Vec<T> axis) { return unit(v + -dot(v, axis) * axis); }
    Vec<T> sample(T u, T v) const {
        const T s = std::sin(u * area - alpha), t = std::cos(u * area - alpha);
        const T p = t - cos_alpha, q = s + sin_alpha * cos_c;
        const T cosine = std::clamp(
            ((q * t - p * s) * cos_alpha - q) / ((q * s + p * t) * sin_alpha), T(-1), T(1));
        const Vec<T> d = cosine * a + std::sqrt(1 - cosine * cosine) * across(c, a);
        const T z = 1 - v * (1 - dot(d, b));
        return z * b + std::sqrt(std::max(T(0), 1 - z * z)) * across(d, b);
    }
    T pdf(Vec<T> w) const {
        const bool inside =
            dot(w, cross(a, b)) > 0 && dot(w, cross(b, c)) > 0 && dot(w, cross(c, a)) > 0;
        return inside ? 1 / area : 0;
    }
};

// Uniform in the solid angle of the rectangle (x0, x1) x (y0, y1) at z = -d (Urena et al. 2013).
template <class T>
struct SphericalRectangle {
    T x0, x1, y0, y1, z0, b0, b1, k, area;
    SphericalRectangle(T x0_, T x1_, T y0_, T y1_, T d) : x0(x0_), x1(x1_), y0(y0_), y1(y1_) {
        z0 = -d;
        const Vec<T> v00{x0, y0, z0}, v01{x0, y1, z0}, v10{x1, y0, z0}, v11{x1, y1, z0};
        const Vec<T> n0 = unit(cross(v00, v10)), n1 = unit(cross(v10, v11)),
                     n2 = unit(cross(v11, v01)), n3 = unit(cross(v01, v00));
        b0 = n0.z, b1 = n2.z;
        k = 2 * pi<T> - std::acos(-dot(n2, n3)) - std::acos(-dot(n3, n0));
        area = std::acos(-dot(n0, n1)) + std::acos(-dot(n1, n2)) - k;
    }
    Vec<T> sample(T u, T v) const {
        const T angle = u * area + k;
        const T f = (std::cos(angle) * b0 - b1) / std::sin(angle);
        const T c = std::clamp((f > 0 ? 1 : -1) / std::sqrt(f * f + b0 * b0), T(-1), T(1));
        const T x = std::clamp(-c * z0 / std::sqrt(std::max(T(1e-12), 1 - c * c)), x0, x1);
        const T d2 = x * x + z0 * z0;
        const T h0 = y0 / std::sqrt(d2 + y0 * y0), h1 = y1 / std::sqrt(d2 + y1 * y1);
        const T h = h0 + v * (h1 - h0), rest = 1 - h * h;
        return unit(Vec<T>{x, rest > T(1e-12) ? h * std::sqrt(d2 / rest) : y1, z0});
    }
    T pdf(Vec<T> w) const {
        if (w.z >= 0) return 0;
        const T x = w.x * z0 / w.z, y = w.y * z0 / w.z;
        return x >= x0 && x <= x1 && y >= y0 && y <= y1 ? 1 / area : 0;
    }
};

template <class T>
void solid_angles(Codes& codes) {
    const Family<T> add{codes, "spherical polygons"};
    auto triangle = [&](const char* name, Vec<T> a, Vec<T> b, Vec<T> c) {
        add.both(name, SphericalTriangle<T>(a, b, c));
    };
    triangle("triangle, an octant", {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    triangle("triangle, nearly half of all", {1, 0, T(0.05)}, {T(-0.5), T(0.87), T(0.05)},
             {T(-0.5), T(-0.87), T(0.05)});
    auto rectangle = [&](const char* name, T x0, T x1, T y0, T y1, T d) {
        add.both(name, SphericalRectangle<T>(x0, x1, y0, y1, d));
    };
    rectangle("rectangle 2 x 1, at 1", -1, 1, T(-0.5), T(0.5), 1);
    rectangle("rectangle beside the foot, at 1", T(0.5), 3, 1, 2, 1);
    if constexpr (std::is_same_v<T, double>) {
        triangle("triangle, sides of 0.02", {1, 0, 0}, {1, 0.02, 0}, {1, 0, 0.02});
        triangle("triangle, a sliver 20 : 1", {1, 0, 0}, {1, 1, 0}, {1, 0.5, 0.05});
        rectangle("rectangle 10 x 10, at 0.1", -5, 5, -5, 5, 0.1);
        rectangle("rectangle 0.1 x 0.1, at 3", -0.05, 0.05, -0.05, 0.05, 3);
    }
}

// Points of a light by area, as directions: density distance^2 / (area cos).
template <class T>
void areas(Codes& codes) {
    const Family<T> add{codes, "lights by area"};
    struct Lamp {
        const char* name;
        T x0, x1, y0, y1, height;
    };
    for (const auto& c : {Lamp{"rectangle 2 x 2, at 2", -1, 1, -1, 1, 2},
                          {"rectangle beside the foot, at 1", 1, 4, T(-0.5), T(0.5), 1},
                          {"rectangle 10 x 10, at 0.5", -5, 5, -5, 5, T(0.5)}}) {
        const T x0 = c.x0, x1 = c.x1, y0 = c.y0, y1 = c.y1, height = c.height;
        add(c.name, [=](T u, T v) {
            return unit(Vec<T>{x0 + u * (x1 - x0), y0 + v * (y1 - y0), height});
        }).pdf([=](Vec<T> w) {
            if (w.z <= 0) return T(0);
            const T s = height / w.z, x = w.x * s, y = w.y * s;
            if (!(x >= x0 && x <= x1 && y >= y0 && y <= y1)) return T(0);
            return s * s / ((x1 - x0) * (y1 - y0) * w.z);
        });
    }
    for (const T height : {T(0.5), T(3)})
        add(say("disc of radius 1, at %g", height), [height](T u, T v) {
            const auto [x, y] = concentric_disc(u, v);
            return unit(Vec<T>{x, y, height});
        }).pdf([height](Vec<T> w) {
            if (w.z <= 0) return T(0);
            const T s = height / w.z;
            if (s * s * (w.x * w.x + w.y * w.y) > 1) return T(0);
            return s * s / (pi<T> * w.z);
        });
    add("triangle", [](T u, T v) {
        const T r = std::sqrt(u);
        return unit(Vec<T>{2 * r * (1 - v) - T(0.5), 3 * r * v - 1, 1});
    }).pdf([](Vec<T> w) {
        if (w.z <= 0) return T(0);
        const T b = (w.x / w.z + T(0.5)) / 2, c = (w.y / w.z + 1) / 3;
        return b >= 0 && c >= 0 && b + c <= 1 ? 1 / (3 * w.z * w.z * w.z) : 0;
    });
    // The far half of a sphere is hidden: these samples fail.
    for (const T distance : {T(1.2), T(4)})
        add(say("sphere of radius 1, at %g, half of it hidden", distance),
            [distance](T u, T v) -> std::optional<Vec<T>> {
                const Vec<T> n = about_z(1 - 2 * u, v), p = n + Vec<T>{0, 0, distance};
                if (dot(n, p) >= 0) return {};
                return unit(p);
            })
            .pdf([distance](Vec<T> w) {
                const T b = distance * w.z, s2 = w.x * w.x + w.y * w.y;
                const T rest = 1 - distance * distance * s2;
                if (b <= 0 || rest <= 0) return T(0);
                const T t = b - std::sqrt(rest);  // the cosine is sqrt(rest)
                return t * t / (4 * pi<T> * std::sqrt(rest));
            });
}

// Maps of the environment: cells of (phi, theta), of very unequal weights.
template <class T>
void maps(Codes& codes) {
    const Family<T> add{codes, "maps of the environment"};
    for (const size_t width : {size_t(4), size_t(16), size_t(64)}) {
        std::vector<double> weights;
        for (size_t i = 0; i < width * width / 2; ++i)
            weights.push_back(i % 5 == 3   ? 0
                              : i % 7 == 2 ? 20
                                           : 0.1 + std::fmod(double(i) * 0.61803, 1));
        const Tiles<T> tiles(width, weights);
        add(say("%zu x %zu", width, width / 2), [tiles](T u, T v) {
            const auto [x, y] = tiles.sample(u, v);
            const auto [wx, wy] = on_circle(std::sin(pi<T> * y), x);
            return Vec<T>{wx, wy, std::cos(pi<T> * y)};
        }).pdf([tiles](Vec<T> w) {
            T x = std::atan2(w.y, w.x) / (2 * pi<T>);
            if (x < 0) x += 1;
            const T sine = std::sqrt(w.x * w.x + w.y * w.y), y = std::atan2(sine, w.z) / pi<T>;
            return sine > 0 ? tiles.pdf({std::min(x, T(0.9999999)), std::min(y, T(0.9999999))}) /
                                  (2 * pi<T> * pi<T> * sine)
                            : 0;
        });
    }
}

template <class T>
void lights(Codes& codes) {
    solid_angles<T>(codes);
    areas<T>(codes);
    maps<T>(codes);
}

}  // namespace campaign

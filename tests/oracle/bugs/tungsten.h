// bugs/tungsten.h  vectors and numbers of Tungsten, as far as its BSDFs need them
#pragma once
#include "bug.h"

template <class T>
struct Vec2 {
    T v[2] = {};
    Vec2() = default;
    Vec2(T a, T b) : v{a, b} {}
    template <class S>
    explicit Vec2(const Vec2<S>& o) : v{T(o.x()), T(o.y())} {}
    T x() const { return v[0]; }
    T y() const { return v[1]; }
    T& x() { return v[0]; }
    T& y() { return v[1]; }
};
template <class T>
struct Vec3 {
    T v[3] = {};
    Vec3() = default;
    explicit Vec3(T a) : v{a, a, a} {}
    Vec3(T a, T b, T c) : v{a, b, c} {}
    T x() const { return v[0]; }
    T y() const { return v[1]; }
    T z() const { return v[2]; }
    T& z() { return v[2]; }
    T dot(const Vec3& o) const { return v[0] * o.v[0] + v[1] * o.v[1] + v[2] * o.v[2]; }
    Vec3 normalized() const { return *this * (1 / std::sqrt(dot(*this))); }
    friend Vec3 operator+(Vec3 a, Vec3 b) {
        return {a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2]};
    }
    friend Vec3 operator-(Vec3 a, Vec3 b) { return a + b * T(-1); }
    friend Vec3 operator-(Vec3 a) { return a * T(-1); }
    friend Vec3 operator*(Vec3 a, T s) { return {a.v[0] * s, a.v[1] * s, a.v[2] * s}; }
    friend Vec3 operator*(T s, Vec3 a) { return a * s; }
    Vec3& operator*=(T s) { return *this = *this * s; }
};
using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

#define CONSTEXPR constexpr
constexpr float PI = 3.14159265f, INV_PI = 1 / PI, TWO_PI = 2 * PI, INV_TWO_PI = 1 / TWO_PI;
constexpr float INV_FOUR_PI = 0.25f / PI;
inline float sqr(float x) { return x * x; }

template <class E>
struct StringableEnum {
    E e;
    StringableEnum(int i) : e(E(i)) {}
    operator E() const { return e; }
};

struct BsdfLobes {
    enum Lobe {
        GlossyReflectionLobe = 1,
        GlossyTransmissionLobe = 2,
        DiffuseReflectionLobe = 4,
        DiffuseTransmissionLobe = 8
    };
    int lobes = 0;
    BsdfLobes(int l = 0) : lobes(l) {}
    bool test(BsdfLobes l) const { return (lobes & l.lobes) != 0; }
};

// The numbers of one sample, in the order in which they are drawn.
struct Numbers {
    float u[3];
    int next = 0;
    float next1D() { return u[next++]; }
    Vec2f next2D() {
        next += 2;
        return {u[next - 2], u[next - 1]};
    }
    bool nextBoolean(float p) { return next1D() < p; }
};
struct SurfaceScatterEvent {
    Numbers* sampler = nullptr;
    Vec3f wi, wo, weight;
    float pdf = 0;
    BsdfLobes requestedLobe = 15, sampledLobe;
    int info = 0;
};

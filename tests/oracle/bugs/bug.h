// bugs/bug.h  what shaders need to be C++, and how a program of this folder answers
//
// `run` cuts lines of a published renderer into excerpt.h; the program includes it after this
// header.
#pragma once
#include <float.h>
#include <math.h>

#include "../oracle.h"

// ---- Vectors of HLSL, GLSL, Slang and CUDA ------------------------------------------------------

struct float2 {
    float x = 0, y = 0;
    float2() = default;
    float2(float s) : x(s), y(s) {}
    float2(float x_, float y_) : x(x_), y(y_) {}
    float2 xy() const { return *this; }
};

struct float3 {
    float x = 0, y = 0, z = 0;
    float3() = default;
    float3(float s) : x(s), y(s), z(s) {}
    float3(float x_, float y_, float z_) : x(x_), y(y_), z(z_) {}
    float3(float2 v, float z_) : x(v.x), y(v.y), z(z_) {}
    float2 xy() const { return {x, y}; }
    float operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};
using vec2 = float2;
using vec3 = float3;

#define VECTOR_OPERATOR(op)                                                                        \
    inline float2 operator op(float2 a, float2 b) { return {a.x op b.x, a.y op b.y}; }             \
    inline float3 operator op(float3 a, float3 b) { return {a.x op b.x, a.y op b.y, a.z op b.z}; } \
    inline float2& operator op##=(float2& a, float2 b) { return a = a op b; }                      \
    inline float3& operator op##=(float3& a, float3 b) { return a = a op b; }
VECTOR_OPERATOR(+)
VECTOR_OPERATOR(-)
VECTOR_OPERATOR(*)
VECTOR_OPERATOR(/)
#undef VECTOR_OPERATOR
inline float2 operator-(float2 a) { return {-a.x, -a.y}; }
inline float3 operator-(float3 a) { return {-a.x, -a.y, -a.z}; }

inline float min(float a, float b) { return a < b ? a : b; }
inline float max(float a, float b) { return a > b ? a : b; }
inline float clamp(float x, float a, float b) { return min(max(x, a), b); }
inline float saturate(float x) { return clamp(x, 0, 1); }
inline float mad(float a, float b, float c) { return a * b + c; }
inline float sign(float x) { return float((x > 0) - (x < 0)); }
inline float rsqrt(float x) { return 1 / sqrt(x); }
inline float inversesqrt(float x) { return 1 / sqrt(x); }
inline float3 lerp(float3 a, float3 b, float3 t) { return a + (b - a) * t; }
inline float mix(float a, float b, float t) { return a + (b - a) * t; }
inline float3 mix(float3 a, float3 b, float3 t) { return a + (b - a) * t; }
inline float3 pow(float3 a, float3 b) { return {pow(a.x, b.x), pow(a.y, b.y), pow(a.z, b.z)}; }
inline float3 sqrt(float3 a) { return {sqrt(a.x), sqrt(a.y), sqrt(a.z)}; }
inline float dot(float2 a, float2 b) { return a.x * b.x + a.y * b.y; }
inline float dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float length(float2 a) { return sqrt(dot(a, a)); }
inline float length(float3 a) { return sqrt(dot(a, a)); }
inline float3 normalize(float3 a) { return a / length(a); }
inline float3 cross(float3 a, float3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float3 reflect(float3 i, float3 n) { return i - n * (2 * dot(i, n)); }
inline float3 refract(float3 i, float3 n, float eta) {
    const float c = dot(n, i), k = 1 - eta * eta * (1 - c * c);
    return k < 0 ? float3(0) : i * eta - n * (eta * c + sqrt(k));
}
inline void sincos(float a, float& s, float& c) { s = sin(a), c = cos(a); }
inline float luminance(float3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

// ---- The answer ---------------------------------------------------------------------------------

// Prints the first line of the verdict, or that the lines pass; `run` reads the exit status.
inline int answer(const oracle::Verdict& v) {
    std::puts(v.pass ? "passes" : v.text.substr(0, v.text.find('\n')).c_str());
    if (std::getenv("ALL")) std::puts(v.text.c_str());
    return v.pass ? 0 : 1;
}

// I0(13) by its logarithm: I0(x) is the mean of exp(x cos phi), exact of 64 equal angles.
inline int answer_of_log_i0(float log_i0(float)) {
    double I0 = 0;
    for (int i = 0; i < 64; ++i) I0 += std::exp(13 * std::cos(2 * oracle::pi * i / 64)) / 64;
    auto ratio = [&] { return std::round(500 * std::exp(log_i0(13)) / I0) / 500; };
    return answer(oracle::expect_mean(1, 10, ratio, {.name = "I0(13) / truth"}));
}

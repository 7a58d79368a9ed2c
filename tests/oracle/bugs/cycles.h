// bugs/cycles.h  names of the kernel of Cycles, as far as its closures need them
#pragma once
#include "bug.h"

#define ccl_device static
#define ccl_device_inline static inline
#define ccl_device_forceinline static inline
#define ccl_private
constexpr float M_PI_F = 3.14159265f, M_PI_2_F = M_PI_F / 2, M_2PI_F = 2 * M_PI_F,
                M_1_PI_F = 1 / M_PI_F;
enum {
    LABEL_NONE = 0,
    LABEL_REFLECT = 1,
    LABEL_GLOSSY = 2,
    LABEL_SINGULAR = 4,
    LABEL_TRANSMIT = 8,
    LABEL_DIFFUSE = 16
};
using Spectrum = float3;
inline Spectrum make_spectrum(float f) { return f; }
inline Spectrum zero_spectrum() { return 0; }
inline float2 make_float2(float x, float y) { return {x, y}; }
inline float3 make_float3(float x, float y, float z) { return {x, y, z}; }
inline float fast_acosf(float x) { return std::acos(clamp(x, -1, 1)); }
inline float fast_cosf(float x) { return std::cos(x); }
inline float fast_atan2f(float y, float x) { return std::atan2(y, x); }
inline void fast_sincosf(float x, float* s, float* c) { *s = std::sin(x), *c = std::cos(x); }
inline float safe_asinf(float x) { return std::asin(clamp(x, -1, 1)); }
inline float safe_sqrtf(float x) { return std::sqrt(max(x, 0)); }
inline void make_orthonormals_tangent(float3 N, float3 T, float3* X, float3* Y) {
    *Y = normalize(cross(N, T)), *X = cross(*Y, N);
}
inline void make_orthonormals(float3 N, float3* X, float3* Y) {
    make_orthonormals_tangent(N, fabs(N.x) < 0.5f ? float3(1, 0, 0) : float3(0, 1, 0), X, Y);
}
struct ShaderClosure {
    float3 N, T;
};

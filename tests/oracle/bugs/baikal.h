// bugs/baikal.h  what OpenCL has and C++ has not, for Radeon ProRender's open renderer
#pragma once
#include "bug.h"

#define INLINE inline
#define TEXTURE_ARG_LIST int
#define TEXTURE_ARGS 0
#define TEXTURE_ARGS_IDX(index) 0
constexpr float PI = 3.14159265f, DENOM_EPS = 1e-8f, ROUGHNESS_EPS = 1e-4f;
inline float native_sqrt(float x) { return sqrt(x); }
inline float native_sin(float x) { return sin(x); }
inline float native_cos(float x) { return cos(x); }
inline float native_powr(float x, float y) { return pow(x, y); }
inline float3 native_powr(float3 x, float y) { return pow(x, float3(y)); }
inline float3 make_float3(float x, float y, float z) { return {x, y, z}; }

// bugs/chameleon.h  names of CUDA, as far as ChameleonRT's BSDF needs them
#pragma once
#include "bug.h"

#define __device__ inline
#undef M_1_PI
constexpr float M_1_PI = 0.318309886f;
inline float pow2(float x) { return x * x; }
inline float3 make_float3(float x, float y, float z) { return {x, y, z}; }

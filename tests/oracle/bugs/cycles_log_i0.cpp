// bugs/cycles_log_i0.cpp  Cycles: log I0 of principled hair has 1/16x where the series has 1/8x
//
// source: blender/blender v3.4.1 intern/cycles/kernel/closure/bsdf_hair_principled.h
// cut: /^ccl_device_inline float bessel_I0(/,/^}/
// cut: /^ccl_device_inline float log_bessel_I0(/,/^}/
// repair: s/0.5f \* \(1.f \/ \(8.0f \* x\) - M_LN_2PI_F - logf\(x\)\)/1.f \/ (8.0f * x) - 0.5f * (M_LN_2PI_F + logf(x))/
#include "cycles.h"
constexpr float M_LN_2PI_F = 1.8378770664093454f;
inline float sqr(float x) { return x * x; }
#include "excerpt.h"

int main() { return answer_of_log_i0(log_bessel_I0); }

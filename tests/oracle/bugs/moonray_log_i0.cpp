// bugs/moonray_log_i0.cpp  OpenMoonRay: log I0 of hair is 0.059 too large for all x > 12
//
// source: dreamworksanimation/moonray 30a977ebc104158272f42b9ffb42e262fe334322 lib/rendering/shading/bsdf/hair/HairUtil.h
// cut: /^    logBesselIO(float x)/,/^    }/
// cut: /^    besselIO(float x)/,/^    }/
// C++: s/^    (logBesselIO|besselIO)\(/inline float \1(/; s/scene_rdl2::math:://g
// repair: s/log\(oneOverX \+ 0\.125f\*oneOverX\)\)/log(oneOverX)) + 0.125f*oneOverX/
#include "bug.h"
constexpr float sTwoPi = 2 * 3.14159265f;
inline float besselIO(float x);
#include "excerpt.h"

int main() {
    // I0(x) is the mean of exp(x cos phi); the mean over 64 equal angles is exact for x = 13.
    const double x = 13;
    double I0 = 0;
    for (int i = 0; i < 64; ++i) I0 += std::exp(x * std::cos(2 * oracle::pi * i / 64)) / 64;
    auto ratio = [&] { return std::round(500 * std::exp(logBesselIO(float(x))) / I0) / 500; };
    return answer(oracle::expect_mean(1, 10, ratio, {.name = "I0(13) / truth"}));
}

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

int main() { return answer_of_log_i0(logBesselIO); }

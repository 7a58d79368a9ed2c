// bugs/osl_background.cpp  OSL testrender: the black part of a sky is not a number
//
// source: AcademySoftwareFoundation/OpenShadingLanguage 6c670a687004d17fd81e8834fb30a04c7a9171f1 src/testrender/background.h
// cut: /^struct Background {/,/^};/
// repair: s/return values\[i\];/return pdf > 0 ? values[i] : Vec3(0);/
#include <algorithm>
#include "bug.h"

#define OSL_DASSERT(condition)
using Vec3 = float3;
template <class T>
struct Dual2 {  // without derivatives
    T v;
    Dual2(T v_ = {}, float = 0, float = 0) : v(v_) {}
    operator T() const { return v; }
};
inline void fast_sincos(float a, Dual2<float>* s, Dual2<float>* c) { *s = sin(a), *c = cos(a); }
inline Vec3 make_Vec3(float x, float y, float z) { return {x, y, z}; }
namespace OIIO {
inline float fast_atan2(float y, float x) { return atan2(y, x); }
}  // namespace OIIO
#include "excerpt.h"

int main() {
    Background sky;  // white above, black below
    sky.prepare(
        32, [](Vec3 w, int*) { return Vec3(w.z > 0); }, (int*)nullptr);
    oracle::Random random(oracle::seed_of("OSL, Background"));
    auto radiance = [&] {
        const float z = 2 * float(random.single()) - 1, phi = 2 * float(M_PI * random.single());
        const float r = sqrt(1 - z * z);
        float pdf;
        const Vec3 radiance_over_pdf = sky.eval({r * cos(phi), r * sin(phi), z}, pdf);
        return radiance_over_pdf.x * pdf;
    };
    return answer(oracle::expect_mean(0.5, 100000, radiance, {.name = "radiance of a white dome"}));
}

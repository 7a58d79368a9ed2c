// bugs/moonray.cpp  bugs of OpenMoonRay
#include "bug.h"

// What lobes of OpenMoonRay's fabrics need to be C++.
using Vec3f = float3;
using Color = float3;
constexpr float sPi = 3.14159265f, sOneOverPi = 1 / sPi, sOneOverTwoPi = 0.5f / sPi,
                sEpsilon = 1e-6f;
const Color sBlack(0);
inline float rcp(float x) { return 1 / x; }
inline float safeASin(float x) { return asin(clamp(x, -1, 1)); }
inline float safeACos(float x) { return acos(clamp(x, -1, 1)); }
inline void sincos(float a, float* s, float* c) { *s = sin(a), *c = cos(a); }
inline bool computeNormalizedHalfVector(Vec3f a, Vec3f b, Vec3f& h) {
    h = normalize(a + b);
    return true;
}
struct Fresnel {
    Color eval(float) const { return 1; }
};
struct BsdfSlice {
    Vec3f wo;
    Vec3f getWo() const { return wo; }
    bool getIncludeCosineTerm() const { return true; }
    float computeShadowTerminatorFix(Vec3f, Vec3f) const { return 1; }
};
// A fabric whose normal is z and whose threads run along x.
struct Lobe {
    struct {
        Vec3f getN() const { return {0, 0, 1}; }
    } mFrame;
    Vec3f mThreadDirection{1, 0, 0};
    Color mColor{1};
    float mSpecularExponent, mNormalizationFactor = 1;
    const Fresnel* getFresnel() const { return nullptr; }
    Color getScale() const { return 1; }
    Color computeScaleAndFresnel(float) const { return 1; }
    Color eval(const BsdfSlice&, const Vec3f& wi, float* pdf) const;
    void sampleVector(const Vec3f& wo, float r1, float r2, Vec3f& wi) const;
};

// Samples of a lobe against the pdf that eval returns.
inline int answer_fabric(Lobe lobe, const char* name) {
    const BsdfSlice slice{{0.5f, 0, 0.8660254f}};
    oracle::Random random(oracle::seed_of(name));
    auto sample = [&](float u, float v) {
        Vec3f wi;
        lobe.sampleVector(slice.wo, u, v, wi);
        return normalize(wi);
    };
    auto pdf = [&](Vec3f wi) {
        float p = 0;
        lobe.eval(slice, wi, &p);
        return p;
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = name}));
}

#ifdef moonray_dwa_fabric
// OpenMoonRay: samples halve an angle, the pdf has half vectors
//
// source: dreamworksanimation/moonray 6f49185999c634d4797713d0731ee6c5d9af8af6 lib/rendering/shading/bsdf/fabric/BsdfDwaFabric.cc
// cut: /^DwaFabricBsdfLobe::eval(/,/^}/
// cut: /^DwaFabricBsdfLobe::sampleVector(/,/^}/
// C++: s/^DwaFabricBsdfLobe::eval/Color Lobe::eval/; s/^DwaFabricBsdfLobe::sample/void Lobe::sample/
// C++: s/scene_rdl2::math:://g
// repair: s/\*pdf = \(mSpecularExponent\+1\.0f\).*/*pdf = pdf_of_angles(*this, slice.getWo(), wi);/; s/\*pdf \*= 0\.25 \* rcp\(cosHWo\);//
// repair: s/if \(r2 < 0\.5f\) thetaH \*= -1\.0f;/if (r2 < 0.5f) thetaH *= -1.0f, r2 *= 2; else r2 = 2 * r2 - 1;/
// thetaI = 2 thetaH - thetaO, 1 - |sin thetaH| has the density (n+1) s^n, phi is uniform on (0,
// pi).
inline float pdf_of_angles(const Lobe& lobe, Vec3f wo, Vec3f wi) {
    const double sine = dot(lobe.mThreadDirection, wi), n = lobe.mSpecularExponent,
                 theta_h = (asin(dot(lobe.mThreadDirection, wo)) + asin(sine)) / 2;
    return (n + 1) / (4 * sPi) * pow(1 - fabs(sin(theta_h)), n) * cos(theta_h) /
           sqrt(std::max(1 - sine * sine, 1e-6));
}
#include "excerpt.h"

int main() { return answer_fabric({.mSpecularExponent = 20}, "DWA fabric"); }
#endif

#ifdef moonray_kajiya_kay
// OpenMoonRay: one number chooses the side and the azimuth of a thread
//
// source: dreamworksanimation/moonray 6f49185999c634d4797713d0731ee6c5d9af8af6 lib/rendering/shading/bsdf/fabric/BsdfKajiyaKayFabric.cc
// cut: /^KajiyaKayFabricBsdfLobe::eval(/,/^}/
// cut: /^KajiyaKayFabricBsdfLobe::sampleVector(/,/^}/
// C++: s/^KajiyaKayFabricBsdfLobe::eval/Color Lobe::eval/; s/^KajiyaKay\w+::sample/void Lobe::sample/
// C++: s/scene_rdl2::math:://g; s/if \(fabricBRDF\/\(\*pdf\) > 4\)/if (false)/
// repair: s/if \(\(thetaD < thetaO\) && \(r2 < 0\.5\)\)/const bool minus = r2 < 0.5f; r2 = minus ? 2 * r2 : 2 * r2 - 1; if (thetaD < thetaO \&\& minus)/
#include "excerpt.h"

int main() {
    // Without the clamp of the pdf near the peak, a declared trade of bias for noise.
    return answer_fabric({.mSpecularExponent = 32}, "Kajiya and Kay");
}
#endif

#ifdef moonray_log_i0
// OpenMoonRay: log I0 of hair is 0.059 too large for all x > 12
//
// source: dreamworksanimation/moonray 30a977ebc104158272f42b9ffb42e262fe334322 lib/rendering/shading/bsdf/hair/HairUtil.h
// cut: /^    logBesselIO(float x)/,/^    }/
// cut: /^    besselIO(float x)/,/^    }/
// C++: s/^    (logBesselIO|besselIO)\(/inline float \1(/; s/scene_rdl2::math:://g
// repair: s/log\(oneOverX \+ 0\.125f\*oneOverX\)\)/log(oneOverX)) + 0.125f*oneOverX/
constexpr float sTwoPi = 2 * 3.14159265f;
inline float besselIO(float x);
#include "excerpt.h"

int main() { return answer_of_log_i0(logBesselIO); }
#endif

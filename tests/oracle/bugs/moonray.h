// bugs/moonray.h  what lobes of OpenMoonRay's fabrics need to be C++
#pragma once
#include "bug.h"

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

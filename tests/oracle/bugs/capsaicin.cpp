// bugs/capsaicin.cpp  bugs of Capsaicin
#include "bug.h"

#ifdef capsaicin_brdf_pdf
// Capsaicin: one half vector chooses the lobe, another its pdf
//
// source: GPUOpen-LibrariesAndSDKs/Capsaicin 5a3bf2a2b9b736bf660a6f4da17a6959ab4fc836 src/core/src/math/sampling.hlsl
// cut: /^float3 mapToCosineHemisphere(float2 samples)$/,/^}/
// source: GPUOpen-LibrariesAndSDKs/Capsaicin 5a3bf2a2b9b736bf660a6f4da17a6959ab4fc836 src/core/src/materials/material_evaluation.hlsl
// cut: /^float3 fresnel(/,/^}/
// cut: /^float3 diffuseCompensationTerm(/,/^}/
// cut: /^float evaluateNDFTrowbridgeReitz(/,/^}/
// source: GPUOpen-LibrariesAndSDKs/Capsaicin 5a3bf2a2b9b736bf660a6f4da17a6959ab4fc836 src/core/src/materials/material_sampling.hlsl
// cut: /^float3 sampleGGXVNDFBounded(/,/^}/
// cut: /^float3 sampleGGX(/,/^}/
// cut: /^float sampleGGXVNDFBoundedPDF(/,/^}/
// cut: /^float sampleGGXPDF(/,/^}/
// cut: /^float3 calculateGGXSpecularDirection(/,/^}/
// cut: /^float3 sampleLambert(/,/^}/
// cut: /^float sampleLambertPDF(/,/^}/
// cut: /^float calculateBRDFProbability(/,/^}/
// cut: /^float sampleBRDFPDF(MaterialBRDF material, float dotNH/,/^}/
// cut: /^float sampleBRDFPDF(MaterialBRDF material, float3 normal/,/^}/
// cut: /^float sampleBRDFPDF2(/,/^}/
// cut: /^float3 sampleBRDFType(/,/^}/
// C++: s/^float3 sampleBRDFType/template <class RNG> &/
// repair: s/^    float probabilityBRDF = calculateBRDFProbability\(material.F0, dotHV, .*/    float3 dominant = calculateGGXSpecularDirection(float3(0, 0, 1), localView, sqrt(material.roughnessAlpha)); dotHV = saturate(dot(normalize(localView + dominant), localView));\n&/
constexpr float PI = 3.14159265f, INV_PI = 1 / PI, TWO_PI = 2 * PI;
struct MaterialBRDF {
    float3 albedo, F0;
    float roughnessAlpha, roughnessAlphaSqr;
};
struct Quaternion {  // here the normal is z
    float3 transform(float3 v) const { return v; }
    Quaternion inverse() const { return *this; }
};
inline Quaternion QuaternionRotationZ(float3) { return {}; }
inline float clampMax(float x) { return max(x, FLT_MIN); }
inline float3 evaluateBRDF(MaterialBRDF, float, float, float, float) { return 0; }
struct Numbers {
    float u, v, w;
    float2 rand2() { return {u, v}; }
    float rand() { return w; }
};
#include "excerpt.h"

int main() {
    const MaterialBRDF material{0.5f, 0.04f, 0.3f, 0.09f};
    const float3 normal(0, 0, 1), view(0.988686f, 0, 0.15f);
    oracle::Random random(oracle::seed_of("Capsaicin, sampleBRDFType"));
    auto sample = [&](float u, float v, float w) {
        Numbers numbers{u, v, w};
        float3 reflectance;
        float pdf;
        bool specular;
        return sampleBRDFType(material, numbers, normal, view, reflectance, pdf, specular);
    };
    // Below the horizon the BRDF is 0, and nobody asks for the pdf.
    auto pdf = [&](float3 light) {
        return light.z > 0 ? sampleBRDFPDF(material, normal, view, light) : 0;
    };
    // The small number that their D adds to alpha^2 is 1e-4 of it.
    return answer(oracle::expect_density(random, sample, pdf, {.tolerance = 1e-3, .name = "BRDF"}));
}
#endif

#ifdef capsaicin_cosine_inverse
// Capsaicin: the inverse of a map is a forward map
//
// source: GPUOpen-LibrariesAndSDKs/Capsaicin 5a3bf2a2b9b736bf660a6f4da17a6959ab4fc836 src/core/src/math/sampling.hlsl
// cut: /^float2 mapToDiskInverse(/,/^}/
// cut: /^float3 mapToCosineHemisphere(float2 samples)$/,/^}/
// cut: /^float2 mapToCosineHemisphereInverse(float3 direction)$/,/^}/
// repair: s/^    float r = sqrt\(direction.x\);/    return mapToDiskInverse(direction.xy());\n&/
constexpr float TWO_PI = 2 * 3.14159265f, INV_TWO_PI = 1 / TWO_PI;
inline float lengthSqr(float2 v) { return dot(v, v); }
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("Capsaicin, mapToCosineHemisphereInverse"));
    auto there_and_back = [&] {
        const float2 u(float(random.single()), float(random.single()));
        const float2 back = mapToCosineHemisphereInverse(mapToCosineHemisphere(u));
        return length(back - u) < 1e-3f ? 1 : 0;
    };
    return answer(oracle::expect_mean(1, 1000, there_and_back, {.name = "inverse(map(u)) == u"}));
}
#endif

#ifdef capsaicin_gaussian
// Capsaicin: a polar method that rejects nothing
//
// source: GPUOpen-LibrariesAndSDKs/Capsaicin 5a3bf2a2b9b736bf660a6f4da17a6959ab4fc836 src/core/src/math/sampling.hlsl
// cut: /^float2 mapToGaussian(/,/^}/
// C++: s/(mean|deviation)\.xx/\1/g
// repair: s/^    float2 points = .*/    float2 points = sqrt(-2.0f * log(1.0f - samples.x)) * float2(cos(6.2831853f * samples.y), sin(6.2831853f * samples.y));/
inline float lengthSqr(float2 v) { return dot(v, v); }
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("Capsaicin, mapToGaussian"));
    auto sample = [](float u, float v) { return mapToGaussian({u, v}); };
    auto pdf = [](float2 p) {
        const float2 d = (p - 0.5f) * 6;  // the deviation is 1/6
        return 36 * std::exp(-0.5 * dot(d, d)) / (2 * oracle::pi);
    };
    return answer(
        oracle::expect_density(random, sample, pdf, oracle::Plane{}, {.name = "Gaussian"}));
}
#endif

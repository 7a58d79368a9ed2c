// bugs/baikal.cpp  bugs of Radeon ProRender Baikal
#include "bug.h"

// What OpenCL has and C++ has not, for Radeon ProRender's open renderer.
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

#ifdef baikal_disney
// Radeon ProRender Baikal: sample and pdf choose the lobe differently
//
// source: GPUOpen-LibrariesAndSDKs/RadeonProRender-Baikal 3c38b9688edc6bc0956ea468ce531e3653691855 Baikal/Kernels/CL/disney.cl
// cut: /^float GTR1(/,/^}/
// cut: /^float GTR2_Aniso(/,/^}/
// cut: /^INLINE float Disney_GetPdf(/,/^}/
// cut: /^INLINE float3 Disney_Sample(/,/^}/
// repair: s/specular \* 0\.3f \* mix/specular * 0.1f * mix/
#define WHITE make_float3(1.f, 1.f, 1.f)
struct Colour {
    float3 xyz;
};
struct DifferentialGeometry {
    struct {
        struct {
            Colour base_color{0.5f};
            float metallic = 0, specular = 0.5f, anisotropy = 0, roughness = 0.5f;
            float specular_tint = 0, sheen_tint = 0, sheen = 0;
            float clearcoat_gloss = 0, clearcoat = 0, subsurface = 0;
        } disney;
    } mat;
};
inline float3 Texture_GetValue3f(float3 v, const DifferentialGeometry*, int) { return v; }
inline float Texture_GetValue1f(float v, const DifferentialGeometry*, int) { return v; }
inline float3 Sample_MapToHemisphere(float2 u, float3, float) {
    const float r = sqrt(u.y), phi = 2 * PI * u.x;
    return {r * cos(phi), sqrt(1 - u.y), r * sin(phi)};
}
inline float3 Disney_Evaluate(const DifferentialGeometry*, float3, float3, int) { return 0; }
#include "excerpt.h"

int main() {
    const DifferentialGeometry dg;
    const float3 wi(0, 1, 0);
    oracle::Random random(oracle::seed_of("Baikal, Disney"));
    auto sample = [&](float u, float v) {
        float3 wo;
        float pdf;
        Disney_Sample(&dg, wi, 0, {u, v}, &wo, &pdf);
        return wo;
    };
    auto pdf = [&](float3 wo) { return wo.y > 0 ? Disney_GetPdf(&dg, wi, wo, 0) : 0; };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "Disney"}));
}
#endif

#ifdef baikal_refraction
// Radeon ProRender Baikal: rough glass breaks Snell's law
//
// source: GPUOpen-LibrariesAndSDKs/RadeonProRender-Baikal 89e1d5e8eb51bda3287652b0958c45a1ef876cfc Baikal/Kernels/CL/bxdf_uberv2_bricks.cl
// cut: /^float UberV2_MicrofacetDistribution_GGX_D(/,/^}/
// cut: /^void UberV2_MicrofacetDistribution_GGX_SampleNormal(/,/^}/
// cut: /^float UberV2_MicrofacetRefractionGGX_GetPdf(/,/^}/
// cut: /^float3 UberV2_MicrofacetRefractionGGX_Sample(/,/^}/
// repair: s/float d = 1 \+ eta \* \(c \* c - 1\);/float d = 1 + eta * eta * (c * c - 1);/
// repair: s/^    float wodotwh = .*/&\n    if (dot(wi, wh) * dot(wo, wh) >= 0.f) return 0.f;/
struct Colour {
    float3 xyz;
};
struct UberV2ShaderData {
    Colour refraction_color;
    float refraction_roughness, refraction_ior;
};
inline float3 UberV2_MicrofacetRefractionGGX_Evaluate(const UberV2ShaderData*, float3, float3,
                                                      int) {
    return 0;
}
#include "excerpt.h"

int main() {
    const UberV2ShaderData glass{{1}, 0.3f, 1.5f};
    const float3 wi(0, 1, 0);
    oracle::Random random(oracle::seed_of("Baikal, MicrofacetRefractionGGX"));
    auto sample = [&](float u, float v) {
        float3 wo;
        float pdf = 0;
        UberV2_MicrofacetRefractionGGX_Sample(&glass, wi, 0, {u, v}, &wo, &pdf);
        return wo;
    };
    auto pdf = [&](float3 wo) { return UberV2_MicrofacetRefractionGGX_GetPdf(&glass, wi, wo, 0); };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "refraction"}));
}
#endif

#ifdef baikal_sphere
// Radeon ProRender Baikal: points of a sphere lie on a cylinder
//
// source: GPUOpen-LibrariesAndSDKs/RadeonProRender-Baikal 3d547804355fde5e7aff7fb8c9e5a5d5e6cb7f23 Baikal/Kernels/CL/sampling.cl
// cut: /^float3 Sample_MapToSphere(/,/^}/
// repair: s/float x = cos\(phi\);/float x = r * cos(phi);/; s/float y = sin\(phi\);/float y = r * sin(phi);/
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("Baikal, Sample_MapToSphere"));
    auto sample = [](float u, float v) { return Sample_MapToSphere({u, v}); };
    auto pdf = [](float3) { return 1 / (4 * PI); };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "sphere"}));
}
#endif

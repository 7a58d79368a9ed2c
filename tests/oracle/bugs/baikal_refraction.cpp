// bugs/baikal_refraction.cpp  Radeon ProRender Baikal: rough glass breaks Snell's law
//
// source: GPUOpen-LibrariesAndSDKs/RadeonProRender-Baikal 89e1d5e8eb51bda3287652b0958c45a1ef876cfc Baikal/Kernels/CL/bxdf_uberv2_bricks.cl
// cut: /^float UberV2_MicrofacetDistribution_GGX_D(/,/^}/
// cut: /^void UberV2_MicrofacetDistribution_GGX_SampleNormal(/,/^}/
// cut: /^float UberV2_MicrofacetRefractionGGX_GetPdf(/,/^}/
// cut: /^float3 UberV2_MicrofacetRefractionGGX_Sample(/,/^}/
// repair: s/float d = 1 \+ eta \* \(c \* c - 1\);/float d = 1 + eta * eta * (c * c - 1);/
// repair: s/^    float wodotwh = .*/&\n    if (dot(wi, wh) * dot(wo, wh) >= 0.f) return 0.f;/
#include "baikal.h"
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

// bugs/baikal_disney.cpp  Radeon ProRender Baikal: sample and pdf choose the lobe differently
//
// source: GPUOpen-LibrariesAndSDKs/RadeonProRender-Baikal 3c38b9688edc6bc0956ea468ce531e3653691855 Baikal/Kernels/CL/disney.cl
// cut: /^float GTR1(/,/^}/
// cut: /^float GTR2_Aniso(/,/^}/
// cut: /^INLINE float Disney_GetPdf(/,/^}/
// cut: /^INLINE float3 Disney_Sample(/,/^}/
// repair: s/specular \* 0\.3f \* mix/specular * 0.1f * mix/
#include "baikal.h"
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

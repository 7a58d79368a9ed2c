// bugs/cycles_ashikhmin.cpp  Cycles: a half vector is turned round, its cosine is not
//
// source: blender/blender v3.4.1 intern/cycles/kernel/closure/bsdf_ashikhmin_shirley.h
// cut: /^ccl_device_inline float bsdf_ashikhmin_shirley_roughness_to_exponent/,/^}/
// cut: /^ccl_device_forceinline Spectrum bsdf_ashikhmin_shirley_eval/,/^}/
// cut: /^ccl_device_inline void bsdf_ashikhmin_shirley_sample_first_quadrant/,/^}/
// cut: /^ccl_device int bsdf_ashikhmin_shirley_sample/,/^}/
// repair: s/^    H = -H;/    H = -H, HdotI = -HdotI;/
#include "cycles.h"

struct MicrofacetBsdf : ShaderClosure {
    float alpha_x, alpha_y;
};
#include "excerpt.h"

int main() {
    MicrofacetBsdf bsdf;
    bsdf.N = {0, 0, 1}, bsdf.T = {1, 0, 0}, bsdf.alpha_x = bsdf.alpha_y = 0.9f;
    const float3 I(0.98480775f, 0, 0.17364818f);  // 80 degrees
    oracle::Random random(oracle::seed_of("Cycles, bsdf_ashikhmin_shirley"));
    auto sample = [&](float u, float v) {
        Spectrum eval;
        float3 wi;
        float pdf;
        float2 roughness;
        bsdf_ashikhmin_shirley_sample(&bsdf, bsdf.N, I, u, v, &eval, &wi, &pdf, &roughness);
        return wi;
    };
    auto pdf = [&](float3 wi) {
        float p;
        bsdf_ashikhmin_shirley_eval(&bsdf, bsdf.N, I, wi, &p);
        return p;
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "Ashikhmin-Shirley"}));
}

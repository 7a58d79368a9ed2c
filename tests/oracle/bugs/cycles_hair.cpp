// bugs/cycles_hair.cpp  Cycles: the pdf of a hair sample takes an azimuth that is scaled already
//
// source: blender/blender v3.4.1 intern/cycles/kernel/closure/bsdf_hair.h
// cut: /^ccl_device Spectrum bsdf_hair_reflection_eval/,/^}/
// cut: /^ccl_device int bsdf_hair_reflection_sample/,/^}/
// repair: s/fast_cosf\(phi \* 0.5f\)/fast_cosf(phi \/ roughness2 * 0.5f)/
#include "cycles.h"

struct HairBsdf : ShaderClosure {
    float roughness1, roughness2, offset;
};
#include "excerpt.h"

int main() {
    HairBsdf hair;
    hair.N = {0, 0, 1}, hair.T = {1, 0, 0};
    hair.roughness1 = 0.3f, hair.roughness2 = 0.5f, hair.offset = 0;
    const float3 I(0.6f, 0, 0.8f);
    oracle::Random random(oracle::seed_of("Cycles, bsdf_hair_reflection_sample"));
    auto ratio = [&] {
        const float u = float(random.single()), v = float(random.single());
        Spectrum eval;
        float3 wi;
        float sampled = 0, evaluated = 0;
        float2 roughness;
        bsdf_hair_reflection_sample(&hair, hair.N, I, u, v, &eval, &wi, &sampled, &roughness);
        bsdf_hair_reflection_eval(&hair, I, wi, &evaluated);
        return sampled > 0.05f ? evaluated / sampled : 1;
    };
    // Both are computed from rounded angles, most at the rim, where they are small.
    auto rounded = [&] { return std::round(10 * ratio()) / 10; };
    return answer(oracle::expect_mean(1, 10000, rounded, {.name = "pdf of eval / pdf of sample"}));
}

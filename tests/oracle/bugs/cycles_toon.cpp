// bugs/cycles_toon.cpp  Cycles: a toon's sample has the brightness of another angle than its own
//
// source: blender/blender v3.4.1 intern/cycles/kernel/sample/mapping.h
// cut: /^ccl_device_inline void sample_uniform_cone(/,/^}/
// source: blender/blender v3.4.1 intern/cycles/kernel/closure/bsdf_toon.h
// cut: /^ccl_device float bsdf_toon_get_intensity(/,/^}/
// cut: /^ccl_device float bsdf_toon_get_sample_angle(/,/^}/
// cut: /^ccl_device Spectrum bsdf_diffuse_toon_eval(/,/^}/
// cut: /^ccl_device int bsdf_diffuse_toon_sample(/,/^}/
// repair: s/^( *)sample_uniform_cone\(bsdf->N, .*/&\n\1angle = safe_acosf(dot(bsdf->N, *omega_in));/
#include "cycles.h"

constexpr float M_1_2PI_F = 1 / M_2PI_F;
inline float sqr(float x) { return x * x; }
inline float safe_acosf(float x) { return std::acos(clamp(x, -1, 1)); }
struct ToonBsdf : ShaderClosure {
    float size, smooth;
};
#include "excerpt.h"

int main() {
    ToonBsdf toon;
    toon.N = {0, 0, 1}, toon.size = 0.5f, toon.smooth = 0.3f;
    oracle::Random random(oracle::seed_of("Cycles, bsdf_diffuse_toon_sample"));
    auto weight = [&] {  // of a sample, less what eval says of its direction
        const float u = float(random.single()), v = float(random.single());
        Spectrum sampled;
        float3 wi;
        float pdf, same;
        bsdf_diffuse_toon_sample(&toon, toon.N, toon.N, u, v, &sampled, &wi, &pdf);
        const Spectrum evaluated = bsdf_diffuse_toon_eval(&toon, toon.N, wi, &same);
        return std::round(100 * (sampled.x - evaluated.x) / pdf) / 100;
    };
    return answer(oracle::expect_mean(0, 10000, weight, {.name = "sample's weight - eval / pdf"}));
}

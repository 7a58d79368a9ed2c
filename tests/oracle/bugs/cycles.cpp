// bugs/cycles.cpp  bugs of Cycles
#include "bug.h"

// Names of the kernel of Cycles, as far as its closures need them.
#define ccl_device static
#define ccl_device_inline static inline
#define ccl_device_forceinline static inline
#define ccl_private
constexpr float M_PI_F = 3.14159265f, M_PI_2_F = M_PI_F / 2, M_2PI_F = 2 * M_PI_F,
                M_1_PI_F = 1 / M_PI_F;
enum {
    LABEL_NONE = 0,
    LABEL_REFLECT = 1,
    LABEL_GLOSSY = 2,
    LABEL_SINGULAR = 4,
    LABEL_TRANSMIT = 8,
    LABEL_DIFFUSE = 16
};
using Spectrum = float3;
inline Spectrum make_spectrum(float f) { return f; }
inline Spectrum zero_spectrum() { return 0; }
inline float2 make_float2(float x, float y) { return {x, y}; }
inline float3 make_float3(float x, float y, float z) { return {x, y, z}; }
inline float fast_acosf(float x) { return std::acos(clamp(x, -1, 1)); }
inline float fast_cosf(float x) { return std::cos(x); }
inline float fast_atan2f(float y, float x) { return std::atan2(y, x); }
inline void fast_sincosf(float x, float* s, float* c) { *s = std::sin(x), *c = std::cos(x); }
inline float safe_asinf(float x) { return std::asin(clamp(x, -1, 1)); }
inline float safe_sqrtf(float x) { return std::sqrt(max(x, 0)); }
inline void make_orthonormals_tangent(float3 N, float3 T, float3* X, float3* Y) {
    *Y = normalize(cross(N, T)), *X = cross(*Y, N);
}
inline void make_orthonormals(float3 N, float3* X, float3* Y) {
    make_orthonormals_tangent(N, fabs(N.x) < 0.5f ? float3(1, 0, 0) : float3(0, 1, 0), X, Y);
}
struct ShaderClosure {
    float3 N, T;
};

#ifdef cycles_ashikhmin
// Cycles: a half vector is turned round, its cosine is not
//
// source: blender/blender v3.4.1 intern/cycles/kernel/closure/bsdf_ashikhmin_shirley.h
// cut: /^ccl_device_inline float bsdf_ashikhmin_shirley_roughness_to_exponent/,/^}/
// cut: /^ccl_device_forceinline Spectrum bsdf_ashikhmin_shirley_eval/,/^}/
// cut: /^ccl_device_inline void bsdf_ashikhmin_shirley_sample_first_quadrant/,/^}/
// cut: /^ccl_device int bsdf_ashikhmin_shirley_sample/,/^}/
// repair: s/^    H = -H;/    H = -H, HdotI = -HdotI;/
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
#endif

#ifdef cycles_hair
// Cycles: the pdf of a hair sample takes an azimuth that is scaled already
//
// source: blender/blender v3.4.1 intern/cycles/kernel/closure/bsdf_hair.h
// cut: /^ccl_device Spectrum bsdf_hair_reflection_eval/,/^}/
// cut: /^ccl_device int bsdf_hair_reflection_sample/,/^}/
// repair: s/fast_cosf\(phi \* 0.5f\)/fast_cosf(phi \/ roughness2 * 0.5f)/
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
#endif

#ifdef cycles_log_i0
// Cycles: log I0 of principled hair has 1/16x where the series has 1/8x
//
// source: blender/blender v3.4.1 intern/cycles/kernel/closure/bsdf_hair_principled.h
// cut: /^ccl_device_inline float bessel_I0(/,/^}/
// cut: /^ccl_device_inline float log_bessel_I0(/,/^}/
// repair: s/0.5f \* \(1.f \/ \(8.0f \* x\) - M_LN_2PI_F - logf\(x\)\)/1.f \/ (8.0f * x) - 0.5f * (M_LN_2PI_F + logf(x))/
constexpr float M_LN_2PI_F = 1.8378770664093454f;
inline float sqr(float x) { return x * x; }
#include "excerpt.h"

int main() { return answer_of_log_i0(log_bessel_I0); }
#endif

#ifdef cycles_toon
// Cycles: a toon's sample has the brightness of another angle than its own
//
// source: blender/blender v3.4.1 intern/cycles/kernel/sample/mapping.h
// cut: /^ccl_device_inline void sample_uniform_cone(/,/^}/
// source: blender/blender v3.4.1 intern/cycles/kernel/closure/bsdf_toon.h
// cut: /^ccl_device float bsdf_toon_get_intensity(/,/^}/
// cut: /^ccl_device float bsdf_toon_get_sample_angle(/,/^}/
// cut: /^ccl_device Spectrum bsdf_diffuse_toon_eval(/,/^}/
// cut: /^ccl_device int bsdf_diffuse_toon_sample(/,/^}/
// repair: s/^( *)sample_uniform_cone\(bsdf->N, .*/&\n\1angle = safe_acosf(dot(bsdf->N, *omega_in));/
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
#endif

// bugs/chameleon.cpp  bugs of ChameleonRT
#include "bug.h"

// Names of CUDA, as far as ChameleonRT's BSDF needs them.
#define __device__ inline
#undef M_1_PI
constexpr float M_1_PI = 0.318309886f;
inline float pow2(float x) { return x * x; }
inline float3 make_float3(float x, float y, float z) { return {x, y, z}; }

#ifdef chameleon_fresnel
// ChameleonRT: g of the Fresnel equations is its square
//
// source: Twinklebear/ChameleonRT ce4c9dd6dadca5a8c83bc1bd53014d7df6e29ab4 backends/optix/disney_bsdf.h
// cut: /^__device__ float fresnel_dielectric(/,/^}/
// repair: s/^	return 0.5f \* pow2\(g - cos_theta_i\).*/	g = sqrt(g);\n&/
#include "excerpt.h"

int main() {
    // At normal incidence ((n - 1) / (n + 1))^2.
    auto normal = [] { return std::round(1e5 * fresnel_dielectric(1, 1, 1.5f)) / 1e5; };
    return answer(oracle::expect_mean(0.04, 10, normal, {.name = "Fresnel, glass, 0 degrees"}));
}
#endif

#ifdef chameleon_gtr
// ChameleonRT: the sine of half vectors is its square
//
// source: Twinklebear/ChameleonRT ce4c9dd6dadca5a8c83bc1bd53014d7df6e29ab4 backends/optix/disney_bsdf.h
// cut: /^__device__ float3 spherical_dir(/,/^}/
// cut: /^__device__ float gtr_2(/,/^}/
// cut: /^__device__ float3 sample_gtr_1_h(/,/^}/
// cut: /^__device__ float3 sample_gtr_2_h(/,/^}/
// repair: s/sin_theta_h = 1.f - cos_theta_h_sqr/sin_theta_h = sqrt(1.f - cos_theta_h_sqr)/
#include "excerpt.h"

int main() {
    const float3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    oracle::Random random(oracle::seed_of("ChameleonRT, sample_gtr_2_h"));
    auto sample = [&](float u, float v) { return sample_gtr_2_h(z, x, y, 0.3f, float2(u, v)); };
    auto pdf = [&](float3 h) { return h.z > 0 ? gtr_2(h.z, 0.3f) * h.z : 0; };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "GTR2"}));
}
#endif

// bugs/chameleon_fresnel.cpp  ChameleonRT: g of the Fresnel equations is its square
//
// source: Twinklebear/ChameleonRT ce4c9dd6dadca5a8c83bc1bd53014d7df6e29ab4 backends/optix/disney_bsdf.h
// cut: /^__device__ float fresnel_dielectric(/,/^}/
// repair: s/^	return 0.5f \* pow2\(g - cos_theta_i\).*/	g = sqrt(g);\n&/
#include "chameleon.h"
#include "excerpt.h"

int main() {
    // At normal incidence ((n - 1) / (n + 1))^2.
    auto normal = [] { return std::round(1e5 * fresnel_dielectric(1, 1, 1.5f)) / 1e5; };
    return answer(oracle::expect_mean(0.04, 10, normal, {.name = "Fresnel, glass, 0 degrees"}));
}

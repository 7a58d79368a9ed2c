// bugs/luxcore_schlick.cpp  LuxCore: the density of half vectors lacks n.h
//
// source: LuxCoreRender/LuxCore 641f30b325e0e086c440635966f684fab58f4a83 src/slg/materials/material.cpp
// cut: /^float slg::SchlickDistribution_SchlickZ(/,/^}/
// cut: /^float slg::SchlickDistribution_SchlickA(/,/^}/
// cut: /^float slg::SchlickDistribution_D(/,/^}/
// cut: /^static float GetPhi(/,/^}/
// cut: /^void slg::SchlickDistribution_SampleH(/,/^}/
// cut: /^float slg::SchlickDistribution_Pdf(/,/^}/
// C++: s/slg:://g
// repair: s/^	return SchlickDistribution_D\(roughness, wh, anisotropy\);/	return SchlickDistribution_D(roughness, wh, anisotropy) * fabsf(wh.z);/
// repair: s/^	\*pdf = \*d;/	*pdf = *d * fabsf(wh->z);/
#include "bug.h"
using Vector = float3;
constexpr float INV_PI = 0.318309886f;
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("LuxCore, SchlickDistribution"));
    auto sample = [](float u, float v) {
        Vector wh;
        float d, pdf;
        SchlickDistribution_SampleH(0.2f, 0, u, v, &wh, &d, &pdf);
        return wh;
    };
    auto pdf = [](Vector wh) { return wh.z > 0 ? SchlickDistribution_Pdf(0.2f, wh, 0) : 0; };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "half vectors"}));
}

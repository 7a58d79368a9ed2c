// bugs/capsaicin_cosine_inverse.cpp  Capsaicin: the inverse of a map is a forward map
//
// source: GPUOpen-LibrariesAndSDKs/Capsaicin 5a3bf2a2b9b736bf660a6f4da17a6959ab4fc836 src/core/src/math/sampling.hlsl
// cut: /^float2 mapToDiskInverse(/,/^}/
// cut: /^float3 mapToCosineHemisphere(float2 samples)$/,/^}/
// cut: /^float2 mapToCosineHemisphereInverse(float3 direction)$/,/^}/
// repair: s/^    float r = sqrt\(direction.x\);/    return mapToDiskInverse(direction.xy());\n&/
#include "bug.h"

constexpr float TWO_PI = 2 * 3.14159265f, INV_TWO_PI = 1 / TWO_PI;
inline float lengthSqr(float2 v) { return dot(v, v); }
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("Capsaicin, mapToCosineHemisphereInverse"));
    auto there_and_back = [&] {
        const float2 u(float(random.single()), float(random.single()));
        const float2 back = mapToCosineHemisphereInverse(mapToCosineHemisphere(u));
        return length(back - u) < 1e-3f ? 1 : 0;
    };
    return answer(oracle::expect_mean(1, 1000, there_and_back, {.name = "inverse(map(u)) == u"}));
}

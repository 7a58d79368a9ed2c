// bugs/tinybvh_cosine.cpp  tinybvh: a cosine lobe is made of half a sphere
//
// source: jbikker/tinybvh 5b1d29b207d80be1551eef531193f96390a58e8b tools.cl
// cut: /^float3 CosWeightedDiffReflection(/,/^}/
// C++: s/\(float3\)\( /float3( /
// repair: s/^	const float r = sqrt\( 1 - r1 \* r1 \)/	const float z = 2 * r1 - 1, r = sqrt( 1 - z * z )/; s/r1\);$/z);/
#include "bug.h"
constexpr float PI = 3.14159265f;
inline float3 fast_normalize(float3 v) { return normalize(v); }
#include "excerpt.h"

int main() {
    const float3 N(0.6f, 0, 0.8f);
    oracle::Random random(oracle::seed_of("tinybvh, CosWeightedDiffReflection"));
    auto sample = [&](float u, float v) { return CosWeightedDiffReflection(N, u, v); };
    auto pdf = [&](float3 w) { return max(dot(w, N), 0) / PI; };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "cosine"}));
}

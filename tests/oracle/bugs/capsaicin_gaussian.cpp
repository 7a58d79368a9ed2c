// bugs/capsaicin_gaussian.cpp  Capsaicin: a polar method that rejects nothing
//
// source: GPUOpen-LibrariesAndSDKs/Capsaicin 5a3bf2a2b9b736bf660a6f4da17a6959ab4fc836 src/core/src/math/sampling.hlsl
// cut: /^float2 mapToGaussian(/,/^}/
// C++: s/(mean|deviation)\.xx/\1/g
// repair: s/^    float2 points = .*/    float2 points = sqrt(-2.0f * log(1.0f - samples.x)) * float2(cos(6.2831853f * samples.y), sin(6.2831853f * samples.y));/
#include "bug.h"

inline float lengthSqr(float2 v) { return dot(v, v); }
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("Capsaicin, mapToGaussian"));
    auto sample = [](float u, float v) { return mapToGaussian({u, v}); };
    auto pdf = [](float2 p) {
        const float2 d = (p - 0.5f) * 6;  // the deviation is 1/6
        return 36 * std::exp(-0.5 * dot(d, d)) / (2 * oracle::pi);
    };
    return answer(
        oracle::expect_density(random, sample, pdf, oracle::Plane{}, {.name = "Gaussian"}));
}

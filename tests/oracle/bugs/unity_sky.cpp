// bugs/unity_sky.cpp  Unity HDRP: the last column and the last row of a sky have no samples
//
// source: Unity-Technologies/Graphics 4b98cece5623e02f03c9ff311bca0f749ba4fd94 Packages/com.unity.render-pipelines.high-definition/Runtime/RenderPipeline/PathTracing/Shaders/PathTracingSkySampling.hlsl
// cut: /^float GetSkyCDF(/,/^}/
// cut: /^float SampleSkyCDF(/,/^}/
// C++: s/i \+ \(smp/float(i) + (smp/
// repair: s/float cdfSup = i < size \?/float cdfSup = i + 1 < size ?/
#include "bug.h"

struct uint2 {
    unsigned x, y;
};
// Eight texels, brighter to the right: sums of those before. Beyond the texture Direct3D reads 0.
constexpr int size = 8;
struct Sums {
    float2 operator[](uint2 at) const {
        return at.x < size ? float(at.x * (at.x + 1)) / (size * (size + 1)) : 0;
    }
};
#define PTSKY_TEXTURE2D(name) Sums name
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("Unity, SampleSkyCDF"));
    auto sample = [](float u) { return SampleSkyCDF(Sums{}, size, 0, u); };
    auto pdf = [](float x) { return 2 * float(int(x * size) + 1) / (size + 1); };
    return answer(oracle::expect_density(random, sample, pdf, oracle::Interval{0, 1},
                                         {.name = "column of the sky"}));
}

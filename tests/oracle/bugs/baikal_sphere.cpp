// bugs/baikal_sphere.cpp  Radeon ProRender Baikal: points of a sphere lie on a cylinder
//
// source: GPUOpen-LibrariesAndSDKs/RadeonProRender-Baikal 3d547804355fde5e7aff7fb8c9e5a5d5e6cb7f23 Baikal/Kernels/CL/sampling.cl
// cut: /^float3 Sample_MapToSphere(/,/^}/
// repair: s/float x = cos\(phi\);/float x = r * cos(phi);/; s/float y = sin\(phi\);/float y = r * sin(phi);/
#include "baikal.h"
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("Baikal, Sample_MapToSphere"));
    auto sample = [](float u, float v) { return Sample_MapToSphere({u, v}); };
    auto pdf = [](float3) { return 1 / (4 * PI); };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "sphere"}));
}

// bugs/yocto_cylinder.cpp  yocto-gl: a cylinder of area 4 pi with the pdf of a disk
//
// source: xelatihy/yocto-gl 8db180f3dc9bba03687d3fd190d2e09f099819d4 libs/yocto/yocto_sampling.h
// cut: /^inline vec3f sample_cylinder(.*{/,/^}/
// cut: /^inline float sample_cylinder_pdf(.*{/
// repair: s/return 1 \/ pif;/return 1 \/ (4 * pif);/
#include "bug.h"
using vec2f = float2;
using vec3f = float3;
constexpr float pif = 3.14159265f;
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("yocto-gl, sample_cylinder"));
    auto sample = [](float u, float v) { return sample_cylinder({u, v}); };
    auto pdf = [](vec3f p) { return sample_cylinder_pdf(p); };
    return answer(oracle::expect_jacobian(random, sample, pdf, {.name = "cylinder"}));
}

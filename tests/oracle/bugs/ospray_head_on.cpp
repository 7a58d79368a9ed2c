// bugs/ospray_head_on.cpp  OSPRay: glass seen head on has no direction
//
// source: RenderKit/ospray 3be5b5d0ff3dbba015b33bbc96eb19284ea2628d modules/cpu/render/bsdfs/RobustDielectric.ih
// cut: /^struct RefractionResult/,/^};/
// cut: /^inline RefractionResult RefractionDirection(/,/^}/
// repair: s/cos1_abs < 1\.f - 1e-6f\)/cos1_abs < 1.f + 1e-6f)/
#include "bug.h"
using vec3f = float3;
inline float sqr(float x) { return x * x; }
inline float clamp(float x) { return clamp(x, 0, 1); }
inline vec3f make_vec3f(float x) { return x; }
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("OSPRay, RefractionDirection"));
    auto length_of = [&] {
        const float ior = 1 + float(random.single());
        return length(RefractionDirection({0, 0, -1}, {0, 0, 1}, ior).outgoingDirection);
    };
    return answer(oracle::expect_mean(1, 1000, length_of, {.name = "length of the refraction"}));
}

// bugs/ospray.cpp  bugs of OSPRay
#include "bug.h"

#ifdef ospray_head_on
// OSPRay: glass seen head on has no direction
//
// source: RenderKit/ospray 3be5b5d0ff3dbba015b33bbc96eb19284ea2628d modules/cpu/render/bsdfs/RobustDielectric.ih
// cut: /^struct RefractionResult/,/^};/
// cut: /^inline RefractionResult RefractionDirection(/,/^}/
// repair: s/cos1_abs < 1\.f - 1e-6f\)/cos1_abs < 1.f + 1e-6f)/
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
#endif

#ifdef ospray_quad
// OSPRay: a quad light is sampled by cosine, and evaluated as if it was not
//
// source: RenderKit/ospray 34af6ace0a0912a660ca6e012c6e15bb851128a9 modules/cpu/lights/SphericalQuadSampling.ih
// cut: /^#define template_SphericalQuad_create/,/^#undef template_SphericalQuad_create/
// cut: /^inline vec3f sampleSphericalQuad(/,/^}/
// cut: /^inline float solve_quadratic(/,/^#undef template_computeCosineWeightedRNG/
// source: RenderKit/ospray 96907f9c4f1139d42659cea531b5bc40e145ffd3 modules/cpu/lights/QuadLight.ispc
// cut: /^inline Light_SampleRes SampleArea(/,/^}/
// cut: /^inline Light_SampleRes Sample(/,/^}/
// cut: /^inline Light_EvalRes Eval(/,/^}/
// repair: s/make_vec2f\(cosW\.x, cosW\.y\)/s/; s/cosW\.z \/ quad\.S/1.f \/ quad.S/
#define OSPRAY_TARGET_SYCL
#define uniform
using vec2f = float2;
using vec3f = float3;
constexpr double two_pi = 2 * oracle::pi;
inline float rcp(float x) { return 1 / x; }
inline float sqr(float x) { return x * x; }
inline vec3f neg(vec3f v) { return -v; }
inline vec3f make_vec3f(float x) { return x; }
inline vec3f make_vec3f(float x, float y, float z) { return {x, y, z}; }
inline vec2f make_vec2f(float x) { return x; }
inline vec2f make_vec2f(float x, float y) { return {x, y}; }
inline void sincos(float a, float* s, float* c) { *s = sin(a), *c = cos(a); }
struct SphericalQuad {
    vec3f e0, e1, z;
    float S, k, n0z, n0z2, n2z, x0, x1, y0, y02, y1, y12, z0, z02;
};
struct IntensityDistribution {
    bool lid = false;
};
inline float IntensityDistribution_eval(const IntensityDistribution*, vec3f, vec3f, float, vec3f) {
    return 1;
}
struct QuadLight {
    vec3f radiance{1};
    IntensityDistribution intensityDistribution;
};
struct QuadLightDynamic {
    vec3f position, edge1, edge2, nnormal, c0, c90;
    float ppdf;
};
struct DifferentialGeometry {
    vec3f P, Ng;
};
struct Light_SampleRes {
    vec3f weight, dir;
    float dist, pdf;
};
struct Light_EvalRes {
    vec3f radiance;
    float pdf = 0;
};
#include "excerpt.h"

int main() {
    // A window of 2 x 2 at a distance of 1, a little above the floor.
    const QuadLight light;
    const QuadLightDynamic dyn{{1, -1, 0.1f}, {0, 0, 2}, {0, 2, 0}, {1, 0, 0}, {}, {}, 0.25f};
    const DifferentialGeometry floor{{0, 0, 0}, {0, 0, 1}};
    oracle::Random random(oracle::seed_of("OSPRay, QuadLight"));
    auto ratio = [&] {
        const float u = float(random.single()), v = float(random.single());
        const auto s = Sample(&light, dyn, floor, {u, v});
        const auto e = Eval(&light, dyn, floor, s.dir, 0, 1000);
        return e.pdf > 0 ? s.pdf / e.pdf : 1;  // rays by the rim may miss
    };
    return answer(oracle::expect_mean(1, 100000, ratio, {.name = "pdf of Sample / pdf of Eval"}));
}
#endif

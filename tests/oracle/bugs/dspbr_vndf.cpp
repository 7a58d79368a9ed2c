// bugs/dspbr_vndf.cpp  dspbr-pt: the disk of visible normals is squeezed along a wrong axis
//
// source: DassaultSystemes-Technology/dspbr-pt 256f44fe4b9b96d63318317c55dd17e99ae70372 packages/lib/shader/bsdfs/microfacet.glsl
// cut: /^float projected_roughness(/,/^}/
// cut: /^float ggx_smith_lambda(/,/^}/
// cut: /^float ggx_smith_g1(/,/^}/
// cut: /^float ggx_eval(/,/^}/
// cut: /^float ggx_eval_vndf(/,/^}/
// cut: /^vec3 ggx_sample_vndf(/,/^}/
// repair: s/cross\(wi, vec3\(0, 1, 0\)\)/cross(wi, vec3(0, 0, 1))/
#include "bug.h"
constexpr float PI = 3.14159265f, EPS = 1e-8f, EPS_COS = 1e-6f;
inline float sqr(float x) { return x * x; }
struct Geometry {
    vec3 n, t, b;
};
#include "excerpt.h"

int main() {
    const Geometry g{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    const vec2 alpha(0.64f, 0.64f);
    const vec3 wi = normalize(vec3(0.9f, 0, 0.436f));
    oracle::Random random(oracle::seed_of("dspbr-pt, ggx_sample_vndf"));
    auto sample = [&](float u, float v) { return ggx_sample_vndf(alpha, wi, {u, v}); };
    auto pdf = [&](vec3 h) { return dot(h, wi) > 0 ? ggx_eval_vndf(alpha, wi, h, g) : 0; };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "visible normals"}));
}

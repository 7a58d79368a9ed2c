// bugs/glsl_pathtracer_glass.cpp  GLSL-PathTracer: rough glass keeps lobes on the wrong side
//
// source: knightcrawler25/GLSL-PathTracer a35af147ef5f18e4ddb04bad7c74250b1b75b378 src/shaders/common/sampling.glsl
// cut: /^float GTR1(/,/^void SampleSphereLight/
// C++: /^void SampleSphereLight/d
// source: knightcrawler25/GLSL-PathTracer e1069a5379ab4aaf9fe4fe8ad6d5ee402da0c652 src/shaders/common/disney.glsl
// cut: /^vec3 DisneyEval(.*;/,$
// repair: s/^( *)L = normalize\(reflect\(-V, H\)\);$/&\n\1if (L.z <= 0.0) return vec3(0.0);/
// repair: s/^( *)L = normalize\(refract\(-V, H, state.eta\)\);$/&\n\1if (L.z >= 0.0) return vec3(0.0);/
// repair: s/^( *)float VDotH = abs\(dot\(V, H\)\);$/&\n\1if (!reflect and dot(V, H) * dot(L, H) >= 0.0) return vec3(0.0);/
#include "bug.h"

constexpr float PI = 3.14159265f, INV_PI = 1 / PI, TWO_PI = 2 * PI;
float numbers[3];
int drawn = 0;
inline float number() { return numbers[drawn++ % 3]; }
#define rand number
inline float Luminance(vec3 c) { return luminance(c); }
struct Material {
    vec3 baseColor = 1;
    float ior = 1.5, roughness = 0.7, ax = 0.5, ay = 0.5, sheen = 0, sheenTint = 0, subsurface = 0;
    float specularTint = 0, clearcoat = 0, clearcoatRoughness = 0.1, metallic = 0, specTrans = 1;
};
struct State {
    Material mat;
    float eta = 1 / 1.5f;  // the eye is outside
};
#include "excerpt.h"

int main() {
    const State state;
    const vec3 N(0, 0, 1), V = normalize({0.9f, 0, 0.5f});
    oracle::Random random(oracle::seed_of("GLSL-PathTracer, DisneySample"));
    auto sample = [&](float u, float v, float w) -> std::optional<vec3> {
        numbers[0] = u, numbers[1] = v, numbers[2] = w, drawn = 0;
        vec3 L;
        float pdf;
        DisneySample(state, V, N, L, pdf);
        if (pdf > 0) return L;
        return {};
    };
    auto pdf = [&](vec3 L) {
        float p;
        DisneyEval(state, V, N, L, p);
        return p;
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "glass"}));
}

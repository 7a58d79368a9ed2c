// bugs/glsl_pathtracer.cpp  bugs of GLSL-PathTracer
#include "bug.h"

#ifdef glsl_pathtracer_envmap
// GLSL-PathTracer: light of an environment comes from texel
// corners
//
// source: knightcrawler25/GLSL-PathTracer 32fa794b72689520e5f90b1c6ff8cd6b2a6ed1c6 src/shaders/common/envmap.glsl
// cut: /^vec2 BinarySearch(/,/^}/
// cut: /^float EnvMapPdf(/,/^}/
// cut: /^vec4 SampleEnvMap(/,/^}/
// C++: s/\)\.xyz;/).xyz();/
// repair: s/^    return uv \/ envMapRes;/    return (uv + vec2(rand(), rand())) \/ envMapRes;/
constexpr float PI = 3.14159265f, TWO_PI = 2 * PI, envMapRot = 0;
constexpr int width = 8, height = 4;
const vec2 envMapRes(width, height);
struct vec4 {
    float x, y, z, w;
    float& r = x;
    vec3 xyz() const { return {x, y, z}; }
};
// A map of 8 x 4 texels, brightest at the lower right; its cumulated sums.
enum Texture { envMapTex, envMapCDFTex };
inline float grey(int i) { return 1 + 0.1f * float(i); }
inline float sum_to(int i) { return float(i + 1) + 0.05f * float(i * (i + 1)); }
const float envMapTotalSum = sum_to(width * height - 1);
inline vec4 texture(Texture t, vec2 uv) {
    const int x = std::min(int(uv.x * width), width - 1),
              y = std::min(int(uv.y * height), height - 1);
    const int i = x + width * y;
    const float g = t == envMapTex ? grey(i) : sum_to(i);
    return {g, g, g, 1};
}
inline float Luminance(vec3 c) { return c.x; }
float numbers[3];
int drawn = 0;
inline float number() { return numbers[drawn++ % 3]; }
#define rand number
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("GLSL-PathTracer, SampleEnvMap"));
    auto sample = [](float u, float v, float w) {
        numbers[0] = u, numbers[1] = v, numbers[2] = w, drawn = 0;
        vec3 color;
        return SampleEnvMap(color).xyz();
    };
    auto pdf = [](vec3 w) {  // as the integrator computes it for rays that leave the scene
        const float sine = std::hypot(w.x, w.z), theta = atan2(sine, w.y);
        const vec2 uv((PI + atan2(w.z, w.x)) / TWO_PI, theta / PI);
        return sine > 0 ? EnvMapPdf(texture(envMapTex, uv).xyz()) / sine : 0;
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "environment"}));
}
#endif

#ifdef glsl_pathtracer_glass
// GLSL-PathTracer: rough glass keeps lobes on the wrong side
//
// source: knightcrawler25/GLSL-PathTracer a35af147ef5f18e4ddb04bad7c74250b1b75b378 src/shaders/common/sampling.glsl
// cut: /^float GTR1(/,/^void SampleSphereLight/
// C++: /^void SampleSphereLight/d
// source: knightcrawler25/GLSL-PathTracer e1069a5379ab4aaf9fe4fe8ad6d5ee402da0c652 src/shaders/common/disney.glsl
// cut: /^vec3 DisneyEval(.*;/,$
// repair: s/^( *)L = normalize\(reflect\(-V, H\)\);$/&\n\1if (L.z <= 0.0) return vec3(0.0);/
// repair: s/^( *)L = normalize\(refract\(-V, H, state.eta\)\);$/&\n\1if (L.z >= 0.0) return vec3(0.0);/
// repair: s/^( *)float VDotH = abs\(dot\(V, H\)\);$/&\n\1if (!reflect and dot(V, H) * dot(L, H) >= 0.0) return vec3(0.0);/
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
#endif

// bugs/dspbr.cpp  bugs of dspbr-pt
#include "bug.h"

#ifdef dspbr_envmap
// dspbr-pt: light of an environment comes from texel corners
//
// source: DassaultSystemes-Technology/dspbr-pt 54df3d228c3f48a28a57c418c6ba39bb032115bc packages/lib/shader/utils.glsl
// cut: /^float computeTheta(/,/^}/
// cut: /^float computePhi(/,/^}/
// cut: /^vec3 fromThetaPhi(/,/^}/
// cut: /^vec2 dir_to_uv(/,/^}/
// cut: /^vec3 uv_to_dir(/,/^}/
// cut: /^int lower_bound(/,/^}/
// source: DassaultSystemes-Technology/dspbr-pt 54df3d228c3f48a28a57c418c6ba39bb032115bc packages/lib/shader/lighting.glsl
// cut: /^int sampleRow1D(/,/^}/
// cut: /^ivec2 ibl_sample_pixel(/,/^}/
// cut: /^vec3 ibl_sample_direction(/,/^}/
// cut: /^float ibl_pdf(/,/^}/
// repair: s/vec2 uv = vec2\(xy\) \/ u_ibl_resolution;/vec2 uv = (vec2(xy) + vec2(rng_float(), rng_float())) \/ u_ibl_resolution;/
constexpr float PI = 3.14159265f, TWO_PI = 2 * PI, EPS_COS = 0.001f;
const vec2 u_ibl_resolution(8, 4);
struct ivec2 {
    int x, y;
    ivec2(int x_, int y_) : x(x_), y(y_) {}
    operator vec2() const { return {float(x), float(y)}; }
};
inline float atan(float y, float x) { return atan2(y, x); }
inline vec3 rotate_dir_phi(vec3 dir, bool) { return dir; }
// A map of 8 x 4 texels, brightest at the lower right: probabilities and their sums.
enum sampler2D {
    u_sampler_env_map_pdf,
    u_sampler_env_map_cdf,
    u_sampler_env_map_yPdf,
    u_sampler_env_map_yCdf
};
inline float share(int i, int n) { return 2 * float(i + 1) / float(n * (n + 1)); }
inline float sum_to(int i, int n) { return float((i + 1) * (i + 2)) / float(n * (n + 1)); }
inline vec2 texelFetch(sampler2D map, ivec2 at, int) {
    const int n = map < u_sampler_env_map_yPdf ? 8 : 4;
    return map % 2 == 0 ? share(at.x, n) : sum_to(at.x, n);
}
float numbers[2];
int drawn = 0;
inline float rng_float() { return numbers[drawn++ % 2]; }
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("dspbr-pt, ibl_sample_direction"));
    auto sample = [](float a, float b, float c, float d) {
        numbers[0] = c, numbers[1] = d;
        float pdf;
        return ibl_sample_direction(a, b, pdf);
    };
    return answer(oracle::expect_density(random, sample, ibl_pdf, {.name = "environment"}));
}
#endif

#ifdef dspbr_vndf
// dspbr-pt: the disk of visible normals is squeezed along a wrong axis
//
// source: DassaultSystemes-Technology/dspbr-pt 256f44fe4b9b96d63318317c55dd17e99ae70372 packages/lib/shader/bsdfs/microfacet.glsl
// cut: /^float projected_roughness(/,/^}/
// cut: /^float ggx_smith_lambda(/,/^}/
// cut: /^float ggx_smith_g1(/,/^}/
// cut: /^float ggx_eval(/,/^}/
// cut: /^float ggx_eval_vndf(/,/^}/
// cut: /^vec3 ggx_sample_vndf(/,/^}/
// repair: s/cross\(wi, vec3\(0, 1, 0\)\)/cross(wi, vec3(0, 0, 1))/
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
#endif

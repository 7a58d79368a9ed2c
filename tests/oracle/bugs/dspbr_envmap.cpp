// bugs/dspbr_envmap.cpp  dspbr-pt: light of an environment comes from texel corners
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
#include "bug.h"

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

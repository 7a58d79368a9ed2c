// bugs/mdl_disk.cpp  MDL SDK: azimuth of (1 - r^2)^(n_x cos^2 + n_y sin^2) on the disk
//
// source: NVIDIA/MDL-SDK 052a30a27f4ab3931a53e5540cd64240f657a613 src/mdl/jit/libbsdf/libbsdf_utilities.h
// cut: /^BSDF_INLINE float2 sample_disk_distribution/,/^}/
// cut: /^BSDF_INLINE float eval_disk_distribution/,/^}/
// repair: s/^(    const float cp0sqr = .*)/\1\n    const float mx = exponent.x + 1.0f, my = exponent.y + 1.0f;/
// repair: s/^(    const float tmp0 = ).*/\1mx - cp0sqr * mx;/
// repair: s/^(    const float tmp = ).*/\1tmp0 + cp0sqr * my;/
// repair: s/(cp0 \* math::sqrt\()exponent.y/\1my/; s/(sp0 \* math::sqrt\()exponent.x/\1mx/
#include "bug.h"

#define BSDF_INLINE inline
namespace math {
using ::pow, ::sqrt;
inline void sincos(float a, float* s, float* c) { *s = sin(a), *c = cos(a); }
}  // namespace math
inline float2 make_float2(float x, float y) { return {x, y}; }
#include "excerpt.h"

int main() {
    const float2 exponent(30, 2);
    oracle::Random random(oracle::seed_of("MDL SDK, sample_disk_distribution"));
    auto sample = [&](float u, float v) { return sample_disk_distribution({u, v}, exponent); };
    auto pdf = [&](float2 p) { return eval_disk_distribution(p.x, p.y, exponent); };
    return answer(oracle::expect_density(random, sample, pdf, oracle::Plane{}, {.name = "disk"}));
}

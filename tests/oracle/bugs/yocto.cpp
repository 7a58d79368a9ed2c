// bugs/yocto.cpp  bugs of yocto-gl
#include "bug.h"

#ifdef yocto_cylinder
// yocto-gl: a cylinder of area 4 pi with the pdf of a disk
//
// source: xelatihy/yocto-gl 8db180f3dc9bba03687d3fd190d2e09f099819d4 libs/yocto/yocto_sampling.h
// cut: /^inline vec3f sample_cylinder(.*{/,/^}/
// cut: /^inline float sample_cylinder_pdf(.*{/
// repair: s/return 1 \/ pif;/return 1 \/ (4 * pif);/
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
#endif

#ifdef yocto_weights
// yocto-gl: small weights choose the first; weights are no probabilities
//
// source: xelatihy/yocto-gl 8db180f3dc9bba03687d3fd190d2e09f099819d4 libs/yocto/yocto_sampling.h
// cut: /^inline int sample_discrete_weights(const vector<float>& weights, float r) {/,/^  return weights/
// C++: s/^  return weights\[idx\];/&\n}/
// repair: s/sum - \(float\)0.00001/std::nextafter(sum, 0.0f)/
// repair: s/return weights\[idx\];/float sum = 0; for (float w : weights) sum += w; return weights[idx] \/ sum;/
using std::vector;
template <class T>
T clamp(T x, T a, T b) {
    return x < a ? a : x > b ? b : x;
}
#include "excerpt.h"

int main() {
    const vector<float> weights = {2e-6f, 3e-6f, 1e-6f, 5e-6f};
    oracle::Random random(oracle::seed_of("yocto-gl, sample_discrete_weights"));
    auto choose = [&](float u) { return sample_discrete_weights(weights, u); };
    auto probability = [&](int i) { return sample_discrete_weights_pdf(weights, i); };
    return answer(oracle::expect_choice(random, choose, probability, 4, {.name = "weights"}));
}
#endif

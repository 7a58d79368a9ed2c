// bugs/falcor_dual_hg.cpp  Falcor: a mixture of two lobes returns the pdf of the lobe that it chose
//
// source: NVIDIAGameWorks/Falcor d8401106c14c3cfebf0137e41c6989bc85980148 Source/Falcor/Rendering/Volumes/PhaseFunction.slang
// cut: /^float3\? evalHenyeyGreenstein/,/^}/
// cut: /^struct DualHenyeyGreensteinPhaseFunction/,/^}/
// C++: s/ : IPhaseFunction//; s/^}$/};/; s/__init\(/Dual(/; s/this\./this->/
// C++: s/bool sample<S : ISampleGenerator>/template <class S> bool sample/; s/struct DualHenyey\w*/struct Dual/
// repair: s/pdf = evalHenyeyGreenstein\(-cosTheta, meancosineSelectAvg\)/pdf = evalPdf(wi, wo)/
#include "bug.h"

constexpr float M_1_4PI = 0.25f / 3.14159265f, M_2PI = 2 * 3.14159265f;
inline float3 sampleNext3D(oracle::Random& r) {
    const float x = float(r.single()), y = float(r.single()), z = float(r.single());
    return {x, y, z};
}
inline float3 perp_stark(float3 u) {
    return normalize(cross(u, fabs(u.x) < 0.5f ? float3(1, 0, 0) : float3(0, 1, 0)));
}
#include "excerpt.h"

int main() {
    const float3 wi(0, 0.6f, 0.8f);
    Dual phase(0.7f, -0.3f, 0.4f);
    oracle::Random random(oracle::seed_of("Falcor, DualHenyeyGreensteinPhaseFunction"));
    auto ratio = [&] {
        float3 wo, weight;
        float pdf;
        phase.sample(wi, wo, pdf, weight, random);
        return pdf / phase.evalPdf(wi, wo);
    };
    return answer(oracle::expect_mean(1, 100000, ratio, {.name = "pdf of sample / evalPdf"}));
}

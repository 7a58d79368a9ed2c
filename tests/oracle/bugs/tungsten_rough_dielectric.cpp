// bugs/tungsten_rough_dielectric.cpp  Tungsten: half vectors that do not refract have a pdf
//
// source: tunabrain/tungsten ab41818aec170e376e3a0f80168ae13b020ca6f4 src/core/bsdfs/Microfacet.hpp
// cut: /^class Microfacet/,/^};/
// source: tunabrain/tungsten b082713589b107a2c93a64023fe4315779748d16 src/core/bsdfs/Fresnel.hpp
// cut: /^static inline float dielectricReflectance/,/^}/
// source: tunabrain/tungsten ab41818aec170e376e3a0f80168ae13b020ca6f4 src/core/bsdfs/RoughDielectricBsdf.cpp
// cut: /^template <typename T>/,/^}/
// cut: /^bool RoughDielectricBsdf::sampleBase/,/^}/
// cut: /^float RoughDielectricBsdf::pdfBase/,/^}/
// C++: s/RoughDielectricBsdf::|Fresnel:://g
// repair: s/^    float pdf;$/    if (!reflect and wiDotM*woDotM >= 0.0f) return 0.0f;\n    float pdf;/
// repair: s/^    float cosThetaT = 0.0f;$/    if (wiDotM*wiDotN <= 0.0f) return false;\n&/
#include "tungsten.h"

namespace SampleWarp {
inline double invertPhi(const Vec3d&, float) { return 0; }
}  // namespace SampleWarp
#include "excerpt.h"

int main() {
    const Vec3f wi = Vec3f(0.6f, 0, -0.8f);  // inside
    const float roughness = 0.5f, ior = 1.5f;
    const Microfacet::Distribution ggx(2);
    oracle::Random random(oracle::seed_of("Tungsten, RoughDielectricBsdf::pdfBase"));
    auto sample = [&](float u, float v, float w) -> std::optional<Vec3f> {
        Numbers numbers{{u, v, w}};
        SurfaceScatterEvent event{&numbers, wi};
        if (!sampleBase(event, true, true, roughness, ior, ggx)) return {};
        return event.wo;
    };
    auto pdf = [&](Vec3f wo) {
        SurfaceScatterEvent event{nullptr, wi, wo};
        return pdfBase(event, true, true, roughness, ior, ggx);
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "rough glass"}));
}

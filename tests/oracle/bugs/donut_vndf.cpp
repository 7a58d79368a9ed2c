// bugs/donut_vndf.cpp  Donut, RTXDI: the pdf of visible normals lacks G1, and has V.H for N.V
//
// source: NVIDIAGameWorks/donut 59489813934ea13b7e141a3888e206d8d52dfc1a include/donut/shaders/brdf.hlsli
// cut: /^float G1_Smith/,/^}/
// cut: /^float3 ImportanceSampleGGX_VNDF/,/^}/
// cut: /^float ImportanceSampleGGX_VNDF_PDF/,/^}/
// repair: s/return \(VoH > 0.0\).*/float NoV = saturate(dot(N, V)); return G1_Smith(roughness, NoV) * D \/ (4.0 * NoV);/
#include "bug.h"

inline float square(float x) { return x * x; }
#include "excerpt.h"

int main() {
    const float roughness = 0.6f;
    const float3 N(0, 0, 1), V = normalize({1, 0.5f, 0.8f});
    oracle::Random random(oracle::seed_of("Donut, ImportanceSampleGGX_VNDF_PDF"));
    auto sample = [&](float u, float v) {
        return reflect(-V, normalize(ImportanceSampleGGX_VNDF({u, v}, roughness, V, 1)));
    };
    // Below the horizon Donut uses no sample and asks for no density.
    auto pdf = [&](float3 L) {
        return L.z > 0 ? ImportanceSampleGGX_VNDF_PDF(roughness, N, V, L) : 0;
    };
    oracle::Options o{.name = "GGX"};
    const float G1 = G1_Smith(roughness, V.z);
    o.factors = {{"G1 / N.V", G1 / V.z}, {"V.H", [&](const oracle::Triple& l) {
                                              return dot(V,
                                                         normalize(V + float3(l[0], l[1], l[2])));
                                          }}};
    return answer(oracle::expect_density(random, sample, pdf, o));
}

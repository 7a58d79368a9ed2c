// bugs/visible_normals.cpp  bugs of GGX by visible normals, in Donut and in lajolla
#include "bug.h"

#ifdef donut_vndf
// Donut, RTXDI: the pdf of visible normals lacks G1, and has V.H for N.V
//
// source: NVIDIAGameWorks/donut 59489813934ea13b7e141a3888e206d8d52dfc1a include/donut/shaders/brdf.hlsli
// cut: /^float G1_Smith/,/^}/
// cut: /^float3 ImportanceSampleGGX_VNDF/,/^}/
// cut: /^float ImportanceSampleGGX_VNDF_PDF/,/^}/
// repair: s/return \(VoH > 0.0\).*/float NoV = saturate(dot(N, V)); return G1_Smith(roughness, NoV) * D \/ (4.0 * NoV);/
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
#endif

#ifdef lajolla_vndf
// lajolla: the disk of visible normals is squeezed along a wrong axis
//
// source: BachiLi/lajolla_public 66fe566544a93fca0cea3c1bef27c14bff8f9256 src/microfacet.h
// cut: /^inline Real GTR2(/,/^}/
// cut: /^inline Real smith_masking_gtr2(/,/^}/
// cut: /^inline Vector3 sample_visible_normals(/,/^}/
// C++: s/Vector3 v2 = v_local \* v_local/Vector3 v2{v_local.x * v_local.x, v_local.y * v_local.y, v_local.z * v_local.z}/
// repair: s/Frame hemi_frame\(hemi_dir_in\);/Frame hemi_frame = with_normal_above(hemi_dir_in);/
using Real = double;
constexpr Real c_PI = oracle::pi;
inline Real max(Real a, Real b) { return a > b ? a : b; }
struct Vector2 {
    Real x, y;
};
struct Vector3 {
    Real x, y, z;
};
inline Vector3 operator-(Vector3 a) { return {-a.x, -a.y, -a.z}; }
inline Vector3 operator*(Real s, Vector3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vector3 operator+(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Real dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector3 normalize(Vector3 a) { return 1 / sqrt(dot(a, a)) * a; }
// Frisvad's frame, as lajolla's frame.h has it, and the one that Heitz asks for: y below z.
struct Frame {
    Vector3 x, y, n;
    Frame(Vector3 x_, Vector3 y_, Vector3 n_) : x(x_), y(y_), n(n_) {}
    explicit Frame(Vector3 n_) : n(n_) {
        const Real a = 1 / (1 + n.z), b = -n.x * n.y * a;
        x = {1 - n.x * n.x * a, b, -n.x}, y = {b, 1 - n.y * n.y * a, -n.y};
    }
};
inline Frame with_normal_above(Vector3 n) {
    const Vector3 x = normalize(Vector3{-n.y, n.x, 0});
    return {x, {n.y * x.z - n.z * x.y, n.z * x.x - n.x * x.z, n.x * x.y - n.y * x.x}, n};
}
inline Vector3 to_world(const Frame& f, Vector3 v) { return v.x * f.x + v.y * f.y + v.z * f.n; }
#include "excerpt.h"

int main() {
    const Real roughness = 0.8;
    const Vector3 wi = normalize(Vector3{0.9, 0, 0.436});
    oracle::Random random(oracle::seed_of("lajolla, sample_visible_normals"));
    auto sample = [&](Real u, Real v) {
        return sample_visible_normals(wi, roughness * roughness, {u, v});
    };
    auto pdf = [&](Vector3 h) {
        const bool seen = h.z > 0 && dot(h, wi) > 0;
        return seen ? GTR2(h.z, roughness) * smith_masking_gtr2(wi, roughness) * dot(h, wi) / wi.z
                    : 0;
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "visible normals"}));
}
#endif

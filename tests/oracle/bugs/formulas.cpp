// bugs/formulas.cpp  bugs of six renderers, stated as formulas in our own code
//
// REPAIRED is 0 for the published formula and 1 for the right one.
#include "bug.h"

constexpr float PI = 3.14159265f;
inline float square(float x) { return x * x; }
// A direction by its z and a number for the azimuth.
inline float3 turned(float z, float v) {
    const float r = sqrt(max(0, 1 - z * z)), phi = 2 * PI * v;
    return {r * cos(phi), r * sin(phi), z};
}

// GGX of width alpha: D, Smith's G1, and a normal that V sees (Dupuy and Benyoub 2023).
inline float ggx_d(float3 h, float alpha) {
    return square(alpha / (1 + (square(alpha) - 1) * square(h.z))) / PI;
}
inline float ggx_g1(float3 w, float alpha) {
    return 2 * w.z / (w.z + sqrt(square(alpha) + (1 - square(alpha)) * square(w.z)));
}
inline float3 visible_normal(float3 V, float alpha, float u, float v) {
    const float3 stretch(alpha, alpha, 1), s = normalize(V * stretch);
    return normalize((s + turned(1 - u * (1 + s.z), v)) * stretch);
}

#ifdef bulbit_sheen
// Bulbit: Charlie's sheen takes the cosine for its square
//
// formula: Sopiro/Bulbit 539e6cb4a55d3d6406865a77bd831955803f8be2 include/bulbit/microfacet.h
int main() {
    const float r = 0.5f;  // D = (2 + 1/r) sin^(1/r) / 2 pi, and D cos is a density
    oracle::Random random(oracle::seed_of("Bulbit, CharlieSheenDistribution"));
    auto sample = [&](float u, float v) {
        return turned(sqrt(1 - pow(u, 2 * r / (2 * r + 1))), v);
    };
    auto pdf = [&](float3 h) {
        const float sine2 = 1 - (REPAIRED ? square(h.z) : h.z);
        return h.z > 0 ? (2 + 1 / r) * pow(sine2, 0.5f / r) / (2 * PI) * h.z : 0;
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "D cos"}));
}
#endif

#ifdef dxr_vndf
// DXRPathTracer: near the pole the tangent is not orthogonal to the view
//
// formula: TheRealMJP/DXRPathTracer 0af23bd4c6b6bdc6858aca30775aed88c2426af7 SampleFramework12/v1.02/Shaders/Sampling.hlsl
int main() {
    const float alpha = 0.1f;
    const float3 V(0.3907311f, 0, 0.9205049f), z(0, 0, 1), stretch(alpha, alpha, 1);  // 23 degrees
    oracle::Random random(oracle::seed_of("DXRPathTracer, SampleGGXVisibleNormal"));
    auto sample = [&](float u, float v) {  // Heitz (2017): half a disk in the plane, half squeezed
        const float3 s = normalize(V * stretch);
        const bool pole = REPAIRED ? s.x == 0 && s.y == 0 : s.z >= 0.999f;
        const float3 t1 = pole ? float3(1, 0, 0) : normalize(cross(s, z)), t2 = cross(t1, s);
        const float a = 1 / (1 + s.z), r = sqrt(u);
        const float phi = v < a ? v / a * PI : PI + (v - a) / (1 - a) * PI;
        const float x = r * cos(phi), y = r * sin(phi) * (v < a ? 1 : s.z);
        const float3 h = t1 * x + t2 * y + s * sqrt(max(0, 1 - x * x - y * y));
        return normalize(float3(h.x, h.y, max(0, h.z)) * stretch);
    };
    auto pdf = [&](float3 h) {
        return h.z > 0 ? ggx_g1(V, alpha) * ggx_d(h, alpha) * max(0, dot(V, h)) / V.z : 0;
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "visible normals"}));
}
#endif

#ifdef eevee_cone
// Blender EEVEE: the angle of a direction in a cone is uniform, not its cosine
//
// formula: blender/blender 014829352079723ed757313bd3e052097559b6cc source/blender/draw/engines/eevee_next/shaders/eevee_bxdf_sampling_lib.glsl
int main() {
    const float angle = 0.3f, rim = cos(angle);
    oracle::Random random(oracle::seed_of("EEVEE, sample_uniform_cone"));
    auto sample = [&](float u, float v) {
        return turned(REPAIRED ? mix(rim, 1, u) : cos(angle * u), v);
    };
    auto pdf = [&](float3 w) { return w.z >= rim ? 1 / (2 * PI * (1 - rim)) : 0; };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "cone"}));
}
#endif

#ifdef eevee_refraction
// Blender EEVEE: refraction by microfacets that face the ground has a pdf
//
// formula: blender/blender 02ff76fc1a977b07d9a9dc1cf839bc62c5aec4e4 source/blender/draw/engines/eevee/shaders/eevee_bxdf_microfacet.bsl.hh
int main() {
    const float alpha = 0.5f, ior = 1.5f;
    const float3 V(0.9539392f, 0, 0.3f);
    oracle::Random random(oracle::seed_of("EEVEE, bxdf_ggx_eval_refraction"));
    auto sample = [&](float u, float v) {
        return refract(-V, visible_normal(V, alpha, u, v), 1 / ior);
    };
    auto pdf = [&](float3 L) {
        if (dot(L, V) * ior >= -1) return 0.0f;  // nothing refracts these into each other
        const float3 sum = -(L * ior + V), H = normalize(sum);
        if (REPAIRED && H.z <= 0) return 0.0f;
        const float D = ggx_d({0, 0, max(H.z, 1e-8f)}, alpha);
        return D * ggx_g1(V, alpha) * saturate(dot(V, H)) * saturate(-dot(L, H)) * square(ior) /
               dot(sum, sum) / V.z;
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "rough refraction"}));
}
#endif

#ifdef lygia_henyey_greenstein
// lygia: 4 + pi for 4 pi
//
// formula: patriciogonzalezvivo/lygia 370bb5081ddca28a9c6199cf4673e365f61224fb lighting/common/henyeyGreenstein.glsl
int main() {
    const float g = 0.76f;
    oracle::Random random(oracle::seed_of("lygia, henyeyGreenstein"));
    auto sample = [&](float u, float v) {
        return turned((1 + g * g - square((1 - g * g) / (1 - g + 2 * g * u))) / (2 * g), v);
    };
    auto pdf = [&](float3 w) {
        return (1 - g * g) / ((REPAIRED ? 4 * PI : 4 + PI) * pow(1 + g * g - 2 * g * w.z, 1.5f));
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "Henyey-Greenstein"}));
}
#endif

#ifdef q2rtx_frame
// Q2RTX: near -z the two tangents of a normal are those of -z
//
// formula: NVIDIA/Q2RTX f2526e9a165949f66e91e82f0d63aa7bb2567b4d src/refresh/vkpt/shader/utils.glsl
int main() {
    const float3 n(0.0191974f, 0, -0.9998157f);  // 1.1 degrees from -z
    float3 x(0, -1, 0), y(-1, 0, 0);
    if (REPAIRED || n.z >= -0.999805696f) {  // Duff et al. (2017)
        const float s = n.z < 0 ? -1 : 1, a = -1 / (s + n.z), b = n.x * n.y * a;
        x = {1 + s * n.x * n.x * a, s * b, -s * n.x}, y = {b, s + n.y * n.y * a, -n.y};
    }
    oracle::Random random(oracle::seed_of("Q2RTX, construct_ONB_frisvad"));
    auto sample = [&](float u, float v) {
        const float3 w = turned(sqrt(u), v);
        return normalize(x * w.x + y * w.y + n * w.z);
    };
    auto pdf = [&](float3 w) { return max(0, dot(n, w)) / PI; };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "cosine about a normal"}));
}
#endif

#ifdef q2rtx_vndf
// Q2RTX: the pdf of visible normals lacks G1, and has V.H for N.V, as in Donut
//
// formula: NVIDIA/Q2RTX f2526e9a165949f66e91e82f0d63aa7bb2567b4d src/refresh/vkpt/shader/brdf.glsl
int main() {
    const float alpha = 0.36f;
    const float3 V = normalize({1, 0.5f, 0.8f});
    oracle::Random random(oracle::seed_of("Q2RTX, ImportanceSampleGGX_VNDF_PDF"));
    auto sample = [&](float u, float v) { return reflect(-V, visible_normal(V, alpha, u, v)); };
    auto pdf = [&](float3 L) {  // below the horizon nobody asks for it
        const float3 H = normalize(V + L);
        const float of_normals = REPAIRED ? ggx_g1(V, alpha) * dot(V, H) / V.z : 1;
        return L.z > 0 ? of_normals * ggx_d(H, alpha) / (4 * dot(V, H)) : 0;
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "GGX"}));
}
#endif

#ifdef smallvcm_phong
// SmallVCM: Phong's samples below the horizon have a value and a pdf, which it denies when asked
//
// formula: SmallVCM/SmallVCM a13690f03d3414f76ba32b5f0e259e6e5d10ed7b src/bsdf.hxx
struct Sample {
    float3 wi;
    float f, pdf;
};
int main() {
    const float n = 20;
    oracle::Random random(oracle::seed_of("SmallVCM, Phong"));
    auto of_lobe = [&](float3 wo, float3 wi) {
        return pow(max(0, dot(reflect(-wo, {0, 0, 1}), wi)), n) / (2 * PI);
    };
    auto lit = [](float3 wo, float3 wi) { return wo.z > 0 && wi.z > 0; };
    auto sample = [&](float3 wo, float u, float v) -> std::optional<Sample> {
        const float3 z = reflect(-wo, {0, 0, 1}), w = turned(pow(v, 1 / (n + 1)), u);
        const float3 x = normalize(cross(z, fabs(z.x) < 0.5f ? float3(1, 0, 0) : float3(0, 1, 0)));
        const float3 wi = x * w.x + cross(z, x) * w.y + z * w.z;
        if (REPAIRED && !lit(wo, wi)) return {};
        return Sample{wi, (n + 2) * of_lobe(wo, wi), (n + 1) * of_lobe(wo, wi)};
    };
    auto pdf = [&](float3 wo, float3 wi) { return lit(wo, wi) ? (n + 1) * of_lobe(wo, wi) : 0; };
    auto eval = [&](float3 wo, float3 wi) { return lit(wo, wi) ? (n + 2) * of_lobe(wo, wi) : 0; };
    return answer(oracle::expect_bsdf(random, sample, pdf, eval, {.name = "Phong"}));
}
#endif

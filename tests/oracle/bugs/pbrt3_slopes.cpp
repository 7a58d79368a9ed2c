// bugs/pbrt3_slopes.cpp  pbrt-v3: a rational fit stands for the inverse of a distribution
//
// source: mmp/pbrt-v3 919b47c8daf692251f31bb61ec642f6d65f3eff9 src/core/microfacet.cpp
// cut: /^static void TrowbridgeReitzSample11(/,/^}/
// cut: /^static Vector3f TrowbridgeReitzSample(/,/^}/
// C++: /CHECK\(|Assert\(/d
// repair: s/^    \*slope_y = S \* z/    for (int i = 0; i < 8; ++i) { Float q = 1 \/ (1 + z * z); z -= (std::atan(z) + z * q - U2 * Pi \/ 2) \/ (2 * q * q); }\n&/
#include "bug.h"
using Float = double;
constexpr Float Pi = oracle::pi;
struct Vector3f {
    Float x, y, z;
};
inline Float Dot(Vector3f a, Vector3f b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector3f Normalize(Vector3f a) {
    const Float l = std::sqrt(Dot(a, a));
    return {a.x / l, a.y / l, a.z / l};
}
inline Float CosTheta(Vector3f w) { return w.z; }
inline Float CosPhi(Vector3f w) { return w.x / std::hypot(w.x, w.y); }
inline Float SinPhi(Vector3f w) { return w.y / std::hypot(w.x, w.y); }
#include "excerpt.h"

int main() {
    const Float a = 0.3;
    const Vector3f wo = Normalize({0.7, 0.2, 0.6});
    oracle::Random random(oracle::seed_of("pbrt-v3, TrowbridgeReitzSample"));
    auto sample = [&](Float u, Float v) { return TrowbridgeReitzSample(wo, a, a, u, v); };
    auto pdf = [&](Vector3f h) {
        if (h.z <= 0 || Dot(wo, h) <= 0) return 0.0;
        const Float t = 1 + (a * a - 1) * h.z * h.z, D = a * a / (Pi * t * t);
        const Float G1 = 2 / (1 + std::sqrt(1 + a * a * (1 / (wo.z * wo.z) - 1)));
        return D * G1 * Dot(wo, h) / wo.z;
    };
    return answer(oracle::expect_density(random, sample, pdf, {.name = "visible normals"}));
}

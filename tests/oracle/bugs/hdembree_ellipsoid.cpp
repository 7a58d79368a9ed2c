// bugs/hdembree_ellipsoid.cpp  OpenUSD hdEmbree: the pdf of a stretched sphere light is constant
//
// source: PixarAnimationStudios/OpenUSD 0ea9f95ee444079ca3660afa6e0acb68c6dc60b3 pxr/imaging/plugin/hdEmbree/lightSamplers.cpp
// cut: /^_AreaSphere(/,/^}/
// cut: /^struct _ShapeSample/,/^};/
// cut: /^_SampleSphere(/,/^}/
// C++: s/^_AreaSphere\(/float _AreaSphere(/; s/^_SampleSphere\(/_ShapeSample _SampleSphere(/
// repair: s/const float area = _AreaSphere\(xf, radius\)/const float area = 4 * _pi<float> * radius * radius * float(xf.GetDeterminant3()) * (nLight * normalXform).GetLength()/
#include "bug.h"

template <class T>
constexpr T _pi = T(oracle::pi);
using GfVec2f = float2;
struct GfVec3f : float3 {
    using float3::float3;
    GfVec3f(float3 v) : float3(v) {}
    float GetLength() const { return length(*this); }
    GfVec3f GetNormalized() const { return normalize(*this); }
};
// Scales along the axes are all that this program needs.
struct GfMatrix3f {
    float3 scale;
};
struct GfMatrix4f {
    float3 scale;
    GfVec3f TransformDir(GfVec3f v) const { return v * scale; }
    GfVec3f Transform(GfVec3f p) const { return p * scale; }
    double GetDeterminant3() const { return scale.x * scale.y * scale.z; }
};
inline GfVec3f operator*(GfVec3f v, const GfMatrix3f& m) { return float3(v) * m.scale; }
#include "excerpt.h"

int main() {
    // |n_z| over an ellipsoid is twice the area of its shadow, an ellipse of half axes 3 and 1.
    const float3 scale(3, 1, 1);
    oracle::Random random(oracle::seed_of("hdEmbree, _SampleSphere"));
    auto estimate = [&] {
        const float u = float(random.single()), v = float(random.single());
        const _ShapeSample s = _SampleSphere({scale}, {1 / scale}, 1, u, v);
        return s.invPdfA * fabs(s.nWorld.z);
    };
    return answer(oracle::expect_mean(6 * oracle::pi, 100000, estimate, {.name = "two shadows"}));
}

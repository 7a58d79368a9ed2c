// bugs/tungsten.cpp  bugs of Tungsten
#include "bug.h"

// Vectors and numbers of Tungsten, as far as its BSDFs need them.
template <class T>
struct Vec2 {
    T v[2] = {};
    Vec2() = default;
    Vec2(T a, T b) : v{a, b} {}
    template <class S>
    explicit Vec2(const Vec2<S>& o) : v{T(o.x()), T(o.y())} {}
    T x() const { return v[0]; }
    T y() const { return v[1]; }
    T& x() { return v[0]; }
    T& y() { return v[1]; }
};
template <class T>
struct Vec3 {
    T v[3] = {};
    Vec3() = default;
    explicit Vec3(T a) : v{a, a, a} {}
    Vec3(T a, T b, T c) : v{a, b, c} {}
    T x() const { return v[0]; }
    T y() const { return v[1]; }
    T z() const { return v[2]; }
    T& z() { return v[2]; }
    T dot(const Vec3& o) const { return v[0] * o.v[0] + v[1] * o.v[1] + v[2] * o.v[2]; }
    Vec3 normalized() const { return *this * (1 / std::sqrt(dot(*this))); }
    friend Vec3 operator+(Vec3 a, Vec3 b) {
        return {a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2]};
    }
    friend Vec3 operator-(Vec3 a, Vec3 b) { return a + b * T(-1); }
    friend Vec3 operator-(Vec3 a) { return a * T(-1); }
    friend Vec3 operator*(Vec3 a, T s) { return {a.v[0] * s, a.v[1] * s, a.v[2] * s}; }
    friend Vec3 operator*(T s, Vec3 a) { return a * s; }
    Vec3& operator*=(T s) { return *this = *this * s; }
};
using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

#define CONSTEXPR constexpr
constexpr float PI = 3.14159265f, INV_PI = 1 / PI, TWO_PI = 2 * PI, INV_TWO_PI = 1 / TWO_PI;
constexpr float INV_FOUR_PI = 0.25f / PI;
inline float sqr(float x) { return x * x; }

template <class E>
struct StringableEnum {
    E e;
    StringableEnum(int i) : e(E(i)) {}
    operator E() const { return e; }
};

struct BsdfLobes {
    enum Lobe {
        GlossyReflectionLobe = 1,
        GlossyTransmissionLobe = 2,
        DiffuseReflectionLobe = 4,
        DiffuseTransmissionLobe = 8
    };
    int lobes = 0;
    BsdfLobes(int l = 0) : lobes(l) {}
    bool test(BsdfLobes l) const { return (lobes & l.lobes) != 0; }
};

// The numbers of one sample, in the order in which they are drawn.
struct Numbers {
    float u[3];
    int next = 0;
    float next1D() { return u[next++]; }
    Vec2f next2D() {
        next += 2;
        return {u[next - 2], u[next - 1]};
    }
    bool nextBoolean(float p) { return next1D() < p; }
};
struct SurfaceScatterEvent {
    Numbers* sampler = nullptr;
    Vec3f wi, wo, weight;
    float pdf = 0;
    BsdfLobes requestedLobe = 15, sampledLobe;
    int info = 0;
};

#ifdef tungsten_cylinder
// Tungsten: a cylinder of area 4 pi with the pdf of a disk
//
// source: tunabrain/tungsten 1e1fd82e90963b79d91ffab040fd1fa6c31ee488 src/core/sampling/SampleWarp.hpp
// cut: /^static inline Vec3f uniformCylinder(/,/^}/
// cut: /^static inline float uniformCylinderPdf(/,/^}/
// repair: s/return INV_PI;/return INV_FOUR_PI;/
// After the types that it needs:
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("Tungsten, uniformCylinder"));
    auto sample = [](float u, float v) {
        Vec2f xi(u, v);
        return uniformCylinder(xi);
    };
    auto pdf = [](Vec3f) { return uniformCylinderPdf(); };
    return answer(oracle::expect_jacobian(random, sample, pdf, {.name = "cylinder"}));
}
#endif

#ifdef tungsten_diffuse_transmission
// Tungsten: the pdf of a sample lacks the choice of side
//
// source: tunabrain/tungsten 1e1fd82e90963b79d91ffab040fd1fa6c31ee488 src/core/sampling/SampleWarp.hpp
// cut: /^static inline Vec3f cosineHemisphere(/,/^}/
// cut: /^static inline float cosineHemispherePdf(/,/^}/
// source: tunabrain/tungsten 4a40d4bb46a895102d386475df7b7f497a735f22 src/core/bsdfs/DiffuseTransmissionBsdf.cpp
// cut: /^bool DiffuseTransmissionBsdf::sample/,/^}/
// cut: /^float DiffuseTransmissionBsdf::pdf/,/^}/
// C++: s/DiffuseTransmissionBsdf::|SampleWarp:://g; s/ const$//
// repair: s/event.pdf = .*/event.pdf = pdf(event);/
constexpr float _transmittance = 0.5f;
inline Vec3f albedo(int) { return Vec3f(1.0f); }
float pdf(const SurfaceScatterEvent& event);
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("Tungsten, DiffuseTransmissionBsdf"));
    auto ratio = [&] {
        Numbers numbers{{float(random.single()), float(random.single()), float(random.single())}};
        SurfaceScatterEvent event{&numbers, Vec3f(0.6f, 0, 0.8f)};
        sample(event);
        return event.pdf / pdf(event);
    };
    return answer(oracle::expect_mean(1, 1000, ratio, {.name = "pdf of sample / pdf()"}));
}
#endif

#ifdef tungsten_rough_dielectric
// Tungsten: half vectors that do not refract have a pdf
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
#endif

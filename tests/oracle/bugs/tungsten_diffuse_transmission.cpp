// bugs/tungsten_diffuse_transmission.cpp  Tungsten: the pdf of a sample lacks the choice of side
//
// source: tunabrain/tungsten 1e1fd82e90963b79d91ffab040fd1fa6c31ee488 src/core/sampling/SampleWarp.hpp
// cut: /^static inline Vec3f cosineHemisphere(/,/^}/
// cut: /^static inline float cosineHemispherePdf(/,/^}/
// source: tunabrain/tungsten 4a40d4bb46a895102d386475df7b7f497a735f22 src/core/bsdfs/DiffuseTransmissionBsdf.cpp
// cut: /^bool DiffuseTransmissionBsdf::sample/,/^}/
// cut: /^float DiffuseTransmissionBsdf::pdf/,/^}/
// C++: s/DiffuseTransmissionBsdf::|SampleWarp:://g; s/ const$//
// repair: s/event.pdf = .*/event.pdf = pdf(event);/
#include "tungsten.h"

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

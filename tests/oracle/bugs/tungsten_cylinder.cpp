// bugs/tungsten_cylinder.cpp  Tungsten: a cylinder of area 4 pi with the pdf of a disk
//
// source: tunabrain/tungsten 1e1fd82e90963b79d91ffab040fd1fa6c31ee488 src/core/sampling/SampleWarp.hpp
// cut: /^static inline Vec3f uniformCylinder(/,/^}/
// cut: /^static inline float uniformCylinderPdf(/,/^}/
// repair: s/return INV_PI;/return INV_FOUR_PI;/
#include "tungsten.h"
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

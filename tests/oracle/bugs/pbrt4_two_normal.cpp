// bugs/pbrt4_two_normal.cpp  pbrt-v4: the root is taken of r^2 cos(phi), not of r^2
//
// source: mmp/pbrt-v4 08418214e4df767a4e6aa95230821e05f3621da9 src/pbrt/util/sampling.h
// cut: /^PBRT_CPU_GPU inline Point2f SampleTwoNormal(/,/^}/
// repair: s/std::sqrt\(r2 \* std::(cos|sin)\(2 \* Pi \* u\[1\]\)\)/std::sqrt(r2) * std::\1(2 * Pi * u[1])/
#include "bug.h"
#define PBRT_CPU_GPU
using Float = float;
using Point2f = std::array<float, 2>;
constexpr Float Pi = 3.14159265f;
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("pbrt-v4, SampleTwoNormal"));
    auto sample = [](float u, float v) { return SampleTwoNormal({u, v}); };
    auto pdf = [](Point2f p) {
        return std::exp(-0.5 * (p[0] * p[0] + p[1] * p[1])) / (2 * oracle::pi);
    };
    return answer(oracle::expect_density(random, sample, pdf, oracle::Plane{}, {.name = "normal"}));
}

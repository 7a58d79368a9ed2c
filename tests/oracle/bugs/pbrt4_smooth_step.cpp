// bugs/pbrt4_smooth_step.cpp  pbrt-v4: a function of x does not use x, and the inverse is 0 / 0
//
// source: mmp/pbrt-v4 08418214e4df767a4e6aa95230821e05f3621da9 src/pbrt/util/sampling.h
// cut: /^PBRT_CPU_GPU inline Float InvertSmoothStepSample(/,/^}/
// repair: s/\{ return 2 \* Pow<3>/{ Float t = (x - a) \/ (b - a); return 2 * Pow<3>/
#include "bug.h"
#define PBRT_CPU_GPU
using Float = float;
template <int n>
Float Pow(Float x) {
    Float power = 1;
    for (int i = 0; i < n; ++i) power *= x;
    return power;
}
#include "excerpt.h"

int main() {
    // The distribution is 2 t^3 - t^4: 3/16 at t = 1/2.
    auto inverse = [] { return InvertSmoothStepSample(3, 2, 4); };
    return answer(oracle::expect_mean(0.1875, 10, inverse, {.name = "inverse at t = 1/2"}));
}

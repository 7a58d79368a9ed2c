// bugs/pbrt4.cpp  bugs of pbrt-v4
#include "bug.h"

#ifdef pbrt4_log_i0
// pbrt-v4: log I0 of hair has 1/16x where the series has 1/8x
//
// source: mmp/pbrt-v4 667f618feb881cddf17ac67d6d6fd2a5d6b9b4c0 src/pbrt/util/math.h
// cut: /^inline Float I0(Float x) {/,/^}/
// cut: /^inline Float LogI0(Float x) {/,/^}/
// repair: s/0.5f \* \(-std::log\(2 \* Pi\) \+ std::log\(1 \/ x\) \+ 1 \/ \(8 \* x\)\)/0.5f * (-std::log(2 * Pi) + std::log(1 \/ x)) + 1 \/ (8 * x)/
using Float = float;
constexpr Float Pi = 3.14159265f;
inline int64_t Sqr(int64_t x) { return x * x; }
#include "excerpt.h"

int main() { return answer_of_log_i0(LogI0); }
#endif

#ifdef pbrt4_smooth_step
// pbrt-v4: a function of x does not use x, and the inverse is 0 / 0
//
// source: mmp/pbrt-v4 08418214e4df767a4e6aa95230821e05f3621da9 src/pbrt/util/sampling.h
// cut: /^PBRT_CPU_GPU inline Float InvertSmoothStepSample(/,/^}/
// repair: s/\{ return 2 \* Pow<3>/{ Float t = (x - a) \/ (b - a); return 2 * Pow<3>/
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
#endif

#ifdef pbrt4_two_normal
// pbrt-v4: the root is taken of r^2 cos(phi), not of r^2
//
// source: mmp/pbrt-v4 08418214e4df767a4e6aa95230821e05f3621da9 src/pbrt/util/sampling.h
// cut: /^PBRT_CPU_GPU inline Point2f SampleTwoNormal(/,/^}/
// repair: s/std::sqrt\(r2 \* std::(cos|sin)\(2 \* Pi \* u\[1\]\)\)/std::sqrt(r2) * std::\1(2 * Pi * u[1])/
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
#endif

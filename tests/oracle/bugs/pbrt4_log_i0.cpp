// bugs/pbrt4_log_i0.cpp  pbrt-v4: log I0 of hair has 1/16x where the series has 1/8x
//
// source: mmp/pbrt-v4 667f618feb881cddf17ac67d6d6fd2a5d6b9b4c0 src/pbrt/util/math.h
// cut: /^inline Float I0(Float x) {/,/^}/
// cut: /^inline Float LogI0(Float x) {/,/^}/
// repair: s/0.5f \* \(-std::log\(2 \* Pi\) \+ std::log\(1 \/ x\) \+ 1 \/ \(8 \* x\)\)/0.5f * (-std::log(2 * Pi) + std::log(1 \/ x)) + 1 \/ (8 * x)/
#include "bug.h"
using Float = float;
constexpr Float Pi = 3.14159265f;
inline int64_t Sqr(int64_t x) { return x * x; }
#include "excerpt.h"

int main() { return answer_of_log_i0(LogI0); }

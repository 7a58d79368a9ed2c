// bugs/mitsuba_log_i0.cpp  Mitsuba 3: log I0 of rough fibers has 1/16x where the series has 1/8x
//
// source: mitsuba-renderer/mitsuba3 b88c2d5202ef34939e0814ba5dde064a7114cb72 include/mitsuba/core/warp.h
// cut: /^    Value i0(Value x) {/,/^    }/
// cut: /^    Value log_i0(Value x) {/,/^    }/
// C++: s/^    Value (i0|log_i0)\(/    template <typename Value>\n&/
// repair: s/0.5f \* \(dr::log\(dr::rcp\(dr::TwoPi<Value> \* x\)\) \+ dr::rcp\(8.f \* x\)\)/0.5f * dr::log(dr::rcp(dr::TwoPi<Value> * x)) + dr::rcp(8.f * x)/
#include "bug.h"
namespace dr {
template <class T>
constexpr T TwoPi = T(2 * oracle::pi);
inline double sqr(double x) { return x * x; }
inline double rcp(double x) { return 1 / x; }
inline double log(double x) { return std::log(x); }
inline double select(bool c, double a, double b) { return c ? a : b; }
}  // namespace dr
#include "excerpt.h"

int main() {
    // I0(x) is the mean of exp(x cos phi); the mean over 64 equal angles is exact for x = 13.
    const double x = 13;
    double I0 = 0;
    for (int i = 0; i < 64; ++i) I0 += std::exp(x * std::cos(2 * oracle::pi * i / 64)) / 64;
    auto ratio = [&] { return std::round(500 * std::exp(log_i0(x)) / I0) / 500; };
    return answer(oracle::expect_mean(1, 10, ratio, {.name = "I0(13) / truth"}));
}

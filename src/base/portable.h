// base/portable.h  1  exponentials and logarithms with the same bits everywhere
//
// Each C library rounds exp, log and pow in its own way, and glibc even by the processor: one
// result in a thousand differs.  Images use only these functions, unit_circle of world/warp.h, and
// what IEEE 754 rounds: + - * / sqrt fma.  Powers of two are split off exactly.  The remainder goes
// to Taylor polynomials that are exact to rounding.  Errors are below 3 * 2^-53.  Always double.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

namespace penumbra::portable {

inline constexpr double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;

// x = 2^k m > 0 and normal, 1/2 <= m^2 < 2: k log(2) + 2 artanh(s), s = (m - 1) / (m + 1).
inline double log(double x) {
    const int64_t bits = std::bit_cast<int64_t>(x), k = (bits - 0x3fe6a09e667f3bcd) >> 52;
    const double m = std::bit_cast<double>(bits - k * (int64_t(1) << 52)), s = (m - 1) / (m + 1);
    const double s2 = s * s, s4 = s2 * s2;
    double even = 0, odd = 0;  // the powers 2, 6, ... and 4, 8, ... of artanh(s) / s
    for (int degree = 19; degree > 2; degree -= 4) {
        even = even * s4 + 1. / degree;
        odd = odd * s4 + 1. / (degree + 2);
    }
    const double rest = 2 * s * (s2 * (even + s2 * odd));
    return double(k) * ln2_high + (2 * s + (rest + double(k) * ln2_low));
}
inline double log1p(double x) {
    const double sum = 1 + x;
    return log(sum) + ((1 - sum) + x) / sum;
}

// e^x - less for less = 0 or 1, without cancellation, x <= 1; it ends at x = -708.
inline double exp_less(double x, double less) {
    x = x < -708 ? -708 : x;
    const double k = std::floor(x * 0x1.71547652b82fep0 + 0.5);
    const double rest = (x - k * ln2_high) - k * ln2_low, rest2 = rest * rest;
    double even = 0, odd = 0;  // cosh(rest) - 1 and sinh(rest) / rest - 1
    for (int degree = 12; degree > 1; degree -= 2) {
        even = (even + 1) * (rest2 * (1. / (degree * (degree - 1))));
        odd = (odd + 1) * (rest2 * (1. / (degree * (degree + 1))));
    }
    const double scale = std::bit_cast<double>((int64_t(k) + 1023) << 52);
    return scale * (even + (rest + rest * odd)) + (scale - less);
}
inline double exp(double x) { return exp_less(x, 0); }
inline double expm1(double x) { return exp_less(x, 1); }

// For 0 < base <= 1 and exponent >= 0.
inline double pow(double base, double exponent) { return exp(exponent * log(base)); }

}  // namespace penumbra::portable

// path/sobol.h  1  Sobol' points in pairs, best at powers of two
#pragma once
#include <bit>
#include <cstdint>

#include "base/rng.h"
#include "base/vec.h"

namespace penumbra {

// Words are binary fractions of [0,1): digit 0 is the highest bit.

// The radical inverse of i in base 2 (van der Corput 1935): its bits in reverse order.
inline uint64_t reverse_bits(uint64_t i) {
    auto swap = [&i](int by, uint64_t low) { i = (i >> by & low) | (i & low) << by; };
    swap(1, 0x5555555555555555);
    swap(2, 0x3333333333333333);
    swap(4, 0x0f0f0f0f0f0f0f0f);
    return __builtin_bswap64(i);
}

// The reversed index r becomes (r + a)(b | 1) modulo 2^64, for random a and b.  Carries only run
// upwards: bit j of the result depends on bits 0 ... j of r.  So the 2^k indices from a multiple of
// 2^k on, whose r have the same 64 - k low bits, become another such block.  Let the reversals of
// two indices first differ in bit j.  Then a makes one image uniform, and b makes the difference of
// both uniform among the odd multiples of 2^j.  Pairs of indices, which alone matter for the
// variance of a mean, have the law of a nested uniform shuffle (Owen 1995; Burley 2020, JCGT 9(4)).
inline uint64_t shuffled(uint64_t r, uint64_t a, uint64_t b) { return (r + a) * (b | 1); }

// The second coordinate of the Sobol' point (1967) with first coordinate x: its digit j is the sum
// of C(k, j) times digit k of x modulo 2.  C(k, j) is odd if k has all the bits of j (Lucas 1878):
// one step for every bit.  2^k points from a multiple of 2^k on are a (0,2)-sequence: each
// rectangle of area 2^-k that halving cuts from the unit square holds one of them.
inline uint64_t sobol_y(uint64_t x) {
    x ^= (x & 0x5555555555555555) << 1;
    x ^= (x & 0x3333333333333333) << 2;
    x ^= (x & 0x0f0f0f0f0f0f0f0f) << 4;
    x ^= (x & 0x00ff00ff00ff00ff) << 8;
    x ^= (x & 0x0000ffff0000ffff) << 16;
    return x ^ x << 32;
}

// The point of the reversed index, after its shuffle.  Each of the first 2^64 points is equally
// likely: it is uniform, and pairs with other a and b are independent of it.  A random bit decides
// if the digit before it is added to a digit of x or y.  Of a random linear scrambling (Matousek
// 1998, J. Complexity 14) this diagonal matters most for edges at an angle to the axes.  Digit d of
// x takes bit 63 - d of b, that of y bit 31 - d; the shuffle of 2^k samples takes bits below k.
inline vec2 sobol_pair(uint64_t reversed, uint64_t a, uint64_t b) {
    const uint64_t x = shuffled(reversed, a, b), y = sobol_y(x);
    return {to_unit(x ^ (x >> 1 & b)), to_unit(y ^ (y >> 1 & std::rotl(b, 32)))};
}

// The third coordinate: the index, as a polynomial sum i_k X^k modulo 2, is written in base p = X^2
// + X + 1, with two bits per digit; these are the digits of z (Niederreiter 1987).  First in base
// p^16, then each half in base p^8, and so on: p^m = X^2m + X^m + 1 for powers m of 2.
inline uint64_t sobol_z(uint64_t x) {
    auto divide = [&x](int m, uint64_t upper) {  // divides the part at X^2m and above by p^m
        const uint64_t above = upper & upper >> m;
        x ^= (x & above) << m;
        x ^= (x & upper) << 2 * m ^ (x & (upper ^ above)) << m;
    };
    divide(16, 0x00000000ffffffff);
    divide(8, 0x0000ffff0000ffff);
    divide(4, 0x00ff00ff00ff00ff);
    divide(2, 0x0f0f0f0f0f0f0f0f);
    divide(1, 0x3333333333333333);
    return x;
}

// A third number for the pair of the same words.  2^k consecutive points are a (1,3)-sequence: each
// box of volume 2^(1-k) that halving cuts from the unit cube holds two of them.
inline real sobol_third(uint64_t reversed, uint64_t a, uint64_t b) {
    return to_unit(sobol_z(shuffled(reversed, a, b)));
}

// A single number, from one random word: the points of 2^k indices form a shifted grid.
inline real sobol_single(uint64_t reversed, uint64_t bits) {
    return to_unit(shuffled(reversed, bits, mix(bits)));
}

}  // namespace penumbra

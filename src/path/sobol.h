// path/sobol.h  1  Sobol' points in pairs, most even at powers of two
#pragma once
#include <bit>
#include <cstdint>

#include "base/vec.h"

// Words are binary fractions of [0,1): digit 0 is the highest bit.

// The radical inverse of i in base 2 (van der Corput 1935): its bits in reverse order.
inline uint64_t mirrored(uint64_t i) {
    auto swap = [&i](int by, uint64_t low) { i = (i >> by & low) | (i & low) << by; };
    swap(1, 0x5555555555555555);
    swap(2, 0x3333333333333333);
    swap(4, 0x0f0f0f0f0f0f0f0f);
    return __builtin_bswap64(i);
}

// A mirrored index, shuffled: (t + a) b modulo 2^64, for random a and random, odd b.  The 2^k
// indices from a multiple of 2^k on become 2^k others of that kind, anywhere, since carries run
// from the last digit of t, which is the first of the index, to its first.  Of two indices that
// have their first j digits in common, a makes one uniform, and b makes their difference uniform
// among the odd multiples of 2^j: all later digits are independent.  That is the law of two indices
// in a nested uniform shuffle (Owen 1995; Burley 2020, JCGT 9(4)), for one product; and the
// variance of a mean depends on its samples two by two.
inline uint64_t shuffled(uint64_t t, uint64_t a, uint64_t b) { return (t + a) * (b | 1); }

// The second coordinate of the Sobol' point (1967) of which the first is x: its digit j is the sum
// of C(k, j) times digit k of x modulo 2.  C(k, j) is odd if k has all the bits of j (Lucas 1878),
// which is a step for every bit.  Of 2^k points from a multiple of 2^k on, each rectangle of area
// 2^-k that halving the unit square cuts out holds one ((0,2)-sequence).
inline uint64_t sobol_y(uint64_t x) {
    x ^= (x & 0x5555555555555555) << 1;
    x ^= (x & 0x3333333333333333) << 2;
    x ^= (x & 0x0f0f0f0f0f0f0f0f) << 4;
    x ^= (x & 0x00ff00ff00ff00ff) << 8;
    x ^= (x & 0x0000ffff0000ffff) << 16;
    return x ^ x << 32;
}

// The point of the index mirrored in t after its shuffle: any of the first 2^64 is as likely, so it
// is uniform, and pairs of other a and b can be put beside it.  To a digit of x and of y, by coin,
// the digit before it is added: of a random linear scrambling (Matousek 1998, J. Complexity 14) the
// diagonal that matters most for edges at an angle to the axes.  Means do not mind that b is in
// both: the coins of the first digits are b's digits from 31 up, and the shuffle of fewer than 2^31
// samples uses those below.
inline vec2 sobol_pair(uint64_t t, uint64_t a, uint64_t b) {
    const uint64_t x = shuffled(t, a, b), y = sobol_y(x);
    return {to_unit(x ^ (x >> 1 & b)), to_unit(y ^ (y >> 1 & std::rotl(b, 32)))};
}

// The third coordinate: the index, as a polynomial sum i_k X^k modulo 2, is written in base p = X^2
// + X + 1, two bits a digit, and these are the digits of z (Niederreiter 1987).  First in base
// p^16, then each half in base p^8, and so on: p^m = X^2m + X^m + 1 for powers m of 2.
inline uint64_t sobol_z(uint64_t x) {
    auto divide = [&x](int m, uint64_t upper) {  // by p^m what stands at X^2m and above
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

// A number beside the pair of the same words, for what the pair is chosen for: of 2^k points in a
// row, a box of volume 2^(1-k) that halving the cube cuts out holds two ((1,3)-sequence).
inline real sobol_third(uint64_t t, uint64_t a, uint64_t b) {
    return to_unit(sobol_z(shuffled(t, a, b)));
}

// A single number: the points of 2^k indices are a grid, shifted.
inline real sobol_single(uint64_t t, uint64_t a, uint64_t b) { return to_unit(shuffled(t, a, b)); }

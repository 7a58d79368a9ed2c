// path/halton.h  1  radical inverses: points more even than random ones
#pragma once
#include <cstdint>
#include <vector>

#include "base/vec.h"

// The first n primes, by the sieve of Eratosthenes.  p_n < n (ln n + ln ln n) for n >= 6 (Rosser
// 1941).
inline std::vector<uint32_t> first_primes(size_t n) {
    const double x = double(std::max<size_t>(n, 6));
    const size_t limit = size_t(x * (std::log(x) + std::log(std::log(x)))) + 1;
    std::vector<bool> composite(limit + 1);
    std::vector<uint32_t> primes;
    for (size_t p = 2; primes.size() < n; ++p) {
        if (composite[p]) continue;
        primes.push_back(uint32_t(p));
        for (size_t q = p * p; q <= limit; q += p) composite[q] = true;
    }
    return primes;
}

// A prime, say, and what divides by it fast: of n, b < 2^32 the quotient floor(n / b) is
// floor(n m / 2^64), m = ceil(2^64 / b), for n (m b - 2^64) < n b < 2^64 (Granlund, Montgomery
// 1994).
struct Base {
    uint64_t b;
    uint64_t reciprocal;  // m
    uint64_t most;        // powers of b above this have no next one

    Base(uint32_t base) : b(base), reciprocal(UINT64_MAX / b + 1), most(UINT64_MAX / b) {}
    operator uint32_t() const { return uint32_t(b); }

    uint64_t quotient(uint64_t n) const {
        if (n > UINT32_MAX) return n / b;
        const uint64_t low = n * (reciprocal & UINT32_MAX);
        return (n * (reciprocal >> 32) + (low >> 32)) >> 32;
    }
    uint64_t remainder(uint64_t n) const { return n - quotient(n) * b; }
};

// Radical inverse of i (van der Corput 1935; Halton 1960): i = sum d_k b^k becomes
// sum d_k b^(-k-1), which is never 1.
inline real radical_inverse(const Base& base, uint64_t i) {
    // BEGIN SOLUTION 4.1  the digits of an index, mirrored at the point
    // They gather as digits / power, both exact; those after the 64th bit are below every rounding
    // and are left out.
    uint64_t digits = 0, power = 1;
    while (i > 0 && power <= base.most) {
        const uint64_t rest = base.quotient(i);
        digits = digits * base.b + (i - rest * base.b);
        power *= base.b;
        i = rest;
    }
    return std::min(below_one, real(double(digits) / double(power)));
    // STUB  the last digit alone: no more points than the base has digits
    // return real(base.remainder(i)) / real(base.b);
    // END SOLUTION
}

// The next digit of a fraction of 2^64ths, which is replaced by what follows that digit.
inline uint64_t next_digit(const Base& base, uint64_t& fraction) {
    const uint64_t low = (fraction & UINT32_MAX) * base.b;
    const uint64_t high = (fraction >> 32) * base.b + (low >> 32);
    fraction *= base.b;
    return high >> 32;
}

// The same with digits scrambled at random.  For uniform random bits every point is uniform; any
// set of points stays as even as it was.
inline real scrambled_radical_inverse(const Base& base, uint64_t i, uint64_t shift_bits,
                                      uint64_t factor_bits) {
    // BEGIN SOLUTION 4.2  digits scrambled at random, the endless zeros ahead of an index, too
    // d_k becomes (a d_k + c_k) mod b, 1 <= a < b, with the c_k the digits of a uniform number
    // (random linear scrambling: Matousek 1998, J. Complexity 14).
    const uint64_t factor = 1 + ((factor_bits >> 32) * (base.b - 1) >> 32);
    uint64_t digits = 0, power = 1;
    while (i > 0 && power <= base.most) {
        const uint64_t rest = base.quotient(i), digit = i - rest * base.b;
        const uint64_t shift = next_digit(base, shift_bits);
        digits = digits * base.b + base.remainder(factor * digit + shift);
        power *= base.b;
        i = rest;
    }
    const double zeros = double(to_unit(shift_bits));  // those ahead of i, scrambled: c_k alone
    return std::min(below_one, real((double(digits) + zeros) / double(power)));
    // STUB  steps of a random length from a random place: every point uniform, none even
    // return to_unit(shift_bits + i * (factor_bits | base.b));
    // END SOLUTION
}

// path/halton.h  1  radical inverses: low-discrepancy points
#pragma once
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace penumbra {

// The first n primes (sieve of Eratosthenes).  p_n < n (ln n + ln ln n) for n >= 6 (Rosser 1941).
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

// Radical inverse of i (van der Corput 1935; Halton 1960): i = sum d_k b^k becomes
// sum d_k b^(-k-1), which is never 1.
inline real radical_inverse(uint32_t base, uint64_t i) {
    // exercise 4.1
    // digits / power are both exact.  Digits after the 64th bit, below any rounding, are left out.
    uint64_t digits = 0, power = 1;
    while (i > 0 && power <= UINT64_MAX / base) {
        const uint64_t rest = i / base;
        digits = digits * base + (i - rest * base);
        power *= base;
        i = rest;
    }
    return std::min(below_one, real(double(digits) / double(power)));
    // end
}

// Returns the next digit of a fraction in 2^64ths, and removes it from the fraction.
inline uint64_t next_digit(uint32_t base, uint64_t& fraction) {
    const uint64_t low = (fraction & UINT32_MAX) * base;
    const uint64_t high = (fraction >> 32) * base + (low >> 32);
    fraction *= base;
    return high >> 32;
}

// The same with randomly scrambled digits.  For uniform random bits every point is uniform, and any
// set of points keeps its discrepancy.
inline real scrambled_radical_inverse(uint32_t base, uint64_t i, uint64_t shift_bits,
                                      uint64_t factor_bits) {
    // exercise 4.2
    // d_k becomes (a d_k + c_k) mod b, 1 <= a < b, with the c_k the digits of a uniform number
    // (random linear scrambling: Matousek 1998, J. Complexity 14).
    const uint64_t factor = 1 + ((factor_bits >> 32) * (base - 1) >> 32);
    uint64_t digits = 0, power = 1;
    while (i > 0 && power <= UINT64_MAX / base) {
        const uint64_t rest = i / base, digit = i - rest * base;
        const uint64_t shift = next_digit(base, shift_bits);
        digits = digits * base + (factor * digit + shift) % base;
        power *= base;
        i = rest;
    }
    const double zeros = double(to_unit(shift_bits));  // leading zeros of i, scrambled: c_k only
    return std::min(below_one, real((double(digits) + zeros) / double(power)));
    // end
}

}  // namespace penumbra

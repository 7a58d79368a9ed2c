// path/halton_test.cpp  radical inverses: exact values, exact stratification, exact limits
#include "path/halton.h"

#include <algorithm>

#include "base/rng.h"
#include "oracle/expect.h"

namespace {
using namespace penumbra;

// The radical inverse as an exact fraction of 128-bit integers: digits / power.
__extension__ typedef unsigned __int128 uint128;
struct Fraction {
    uint128 digits = 0, power = 1;
};
Fraction exact(uint32_t base, uint64_t i) {
    Fraction f;
    for (; i > 0; i /= base) {
        f.digits = f.digits * base + i % base;
        f.power *= base;
    }
    return f;
}

// Relative distance between x and the fraction, in ulp of real.
double ulps_off(real x, Fraction f) {
    const long double truth = (long double)(f.digits) / (long double)(f.power);
    return double(std::abs((long double)(x)-truth) / truth) / double(ulp);
}

}  // namespace

TEST_CASE("the first primes are 2, 3, 5, ... and the 10000th is 104729") {
    const auto primes = first_primes(10000);
    CHECK(std::vector<uint32_t>(primes.begin(), primes.begin() + 8) ==
          std::vector<uint32_t>{2, 3, 5, 7, 11, 13, 17, 19});
    CHECK(primes.size() == 10000);
    CHECK(primes.back() == 104729);
    for (size_t n : {0, 1, 2, 5, 6, 7}) CHECK(first_primes(n).size() == n);
}

TEST_CASE("radical inverses are the exact fractions, rounded; also beyond 2^32 and 2^53") {
    CHECK(radical_inverse(3, 1) == real(1) / 3);
    CHECK(radical_inverse(3, 2) == real(2) / 3);
    CHECK(radical_inverse(3, 3) == real(1) / 9);
    CHECK(radical_inverse(3, 4) == real(4) / 9);
    CHECK(radical_inverse(3, 5) == real(7) / 9);
    CHECK(radical_inverse(2, 0) == 0);
    double worst = 0;
    for (uint32_t base : {2u, 3u, 5u, 7u, 11u, 29u, 541u, 7919u, 104729u})
        for (int k = 0; k <= 60; ++k)
            for (uint64_t i : {(uint64_t(1) << k) - 1, uint64_t(1) << k, (uint64_t(1) << k) + 1,
                               (uint64_t(1) << k) * 7 / 5}) {
                if (i == 0 || exact(base, i).digits >> 64) continue;
                worst = std::max(worst, ulps_off(radical_inverse(base, i), exact(base, i)));
            }
    // Rounding occurs four times: digits to double, power to double, quotient, result to real.
    CHECK(worst <= 4);
}

TEST_CASE("no radical inverse is 1, scrambled or not") {
    CHECK(radical_inverse(2, UINT64_MAX) == below_one);  // 1 - 2^-64 would round to 1
    CHECK(scrambled_radical_inverse(2, UINT64_MAX, 0, 0) < 1);
    CHECK(radical_inverse(2, 33554431) < 1);
    CHECK(radical_inverse(3, 3188645) < 1);
    for (uint32_t base : {2u, 3u, 541u})
        for (uint64_t i = 0; i < 1000; ++i)
            CHECK(scrambled_radical_inverse(base, i, UINT64_MAX, UINT64_MAX) < 1);
}

TEST_CASE("aligned blocks of 2^i 3^j indices put one point into every 2^-i x 3^-j box") {
    Rng rng{seed_here()};
    for (int trial = 0; trial < 20; ++trial) {
        const bool scrambled = trial > 0;
        const uint64_t shift2 = rng.bits(), shift3 = rng.bits(), factor3 = rng.bits();
        for (uint64_t columns : {1, 2, 4, 8, 16})
            for (uint64_t rows : {1, 3, 9, 27}) {
                const uint64_t n = columns * rows, start = n * (rng.bits() % 1000000);
                std::vector<int> hits(n);
                for (uint64_t i = start; i < start + n; ++i) {
                    const real x = scrambled ? scrambled_radical_inverse(2, i, shift2, rng.bits())
                                             : radical_inverse(2, i);
                    const real y = scrambled ? scrambled_radical_inverse(3, i, shift3, factor3)
                                             : radical_inverse(3, i);
                    // Rounding may move a point across a boundary: 1/3 is not representable.
                    const auto row = uint64_t(y * real(rows) * (1 + 8 * ulp));
                    ++hits[uint64_t(x * real(columns)) * rows + std::min(row, rows - 1)];
                }
                CHECK(std::all_of(hits.begin(), hits.end(), [](int h) { return h == 1; }));
            }
    }
}

TEST_CASE("the digits of a fraction are exact, carries and all") {
    Rng rng{3};
    for (uint32_t base : {2u, 3u, 10u, 104729u, UINT32_MAX})
        for (uint64_t fraction :
             {uint64_t(0), UINT64_MAX, UINT64_MAX / base + 1, rng.bits(), rng.bits()}) {
            const uint128 product = uint128(fraction) * base;
            uint64_t rest = fraction;
            CHECK(next_digit(base, rest) == uint64_t(product >> 64));
            CHECK(rest == uint64_t(product));
        }
}

TEST_CASE("scrambling permutes the digits: the first b points fall into b different strata") {
    Rng rng{seed_here()};
    for (uint32_t base : {2u, 3u, 7u, 29u, 541u})
        for (int trial = 0; trial < 50; ++trial) {
            const uint64_t shift = rng.bits(), factor = rng.bits();
            std::vector<int> hits(base);
            for (uint64_t i = 0; i < base; ++i) {
                const real u = scrambled_radical_inverse(base, i, shift, factor);
                REQUIRE((u >= 0 && u < 1));
                ++hits[std::min<size_t>(size_t(u * real(base) * (1 + 8 * ulp)), base - 1)];
            }
            CHECK(*std::max_element(hits.begin(), hits.end()) == 1);
        }
}

TEST_CASE("the factors 1 ... b-1 have equal shares of the bits, the first and the last, too") {
    // Index 1 has the digit 1, so that the factor shows; the shift is half a digit more.
    for (uint32_t base : {2u, 3u, 5u, 29u, 541u}) {
        const uint64_t share = 1000, n = share * (base - 1), half = (uint64_t(1) << 63) / base;
        std::vector<uint64_t> hits(base);
        for (uint64_t k = 0; k < n; ++k) {
            const uint64_t bits = k * (UINT64_MAX / n) + UINT64_MAX / n / 2;
            ++hits[size_t(scrambled_radical_inverse(base, 1, half, bits) * real(base))];
        }
        CHECK(hits[0] == 0);
        for (uint32_t factor = 1; factor < base; ++factor) {
            CHECK(hits[factor] >= share - 1);
            CHECK(hits[factor] <= share + 1);
        }
    }
}

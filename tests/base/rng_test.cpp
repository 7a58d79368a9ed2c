// base/rng_test.cpp  the stream of SplitMix64, and keys that differ if any of their inputs does
#include "base/rng.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

using namespace penumbra;

TEST_CASE("the stream is SplitMix64: its first numbers from seed 1234567") {
    // These are published values of SplitMix64 (Steele, Lea, Flood 2014).
    Rng rng{1234567};
    for (uint64_t known : {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                           4593380528125082431u, 16408922859458223821u})
        CHECK(rng.bits() == known);
}

TEST_CASE("uniform numbers are the upper 53 bits, as a part of [0,1)") {
    // 6457827717110365317 = 3153236189995295 * 2^11 + a remainder.
    CHECK(Rng{1234567}.uniform() == 3153236189995295 / 0x1p53);
    Rng rng{0};
    double least = 1, greatest = 0;
    for (int i = 0; i < 100000; ++i) {
        const double u = rng.uniform();
        least = std::min(least, u), greatest = std::max(greatest, u);
    }
    CHECK(least >= 0);
    CHECK(least < 1e-3);
    CHECK(greatest > 1 - 1e-3);
    CHECK(greatest < 1);
}

TEST_CASE("small keys and numbers in any order make different keys, 0 and 0 too") {
    std::set<uint64_t> keys;
    for (uint64_t a = 0; a < 64; ++a)
        for (uint64_t b = 0; b < 64; ++b) keys.insert(hash(a, b));
    // There are 4096 words of 64 bits: two are equal by chance with probability 5e-13.
    CHECK(keys.size() == 4096);
    CHECK(keys.count(0) == 0);
}

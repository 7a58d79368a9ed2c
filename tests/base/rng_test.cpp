// base/rng_test.cpp  the stream of SplitMix64, and keys that differ wherever their numbers do
#include "base/rng.h"

#include <doctest/doctest.h>

#include <set>

TEST_CASE("the stream is SplitMix64: its first numbers from seed 1234567") {
    // Its known values (Steele, Lea, Flood 2014).
    Rng rng{1234567};
    for (uint64_t known : {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                           4593380528125082431u, 16408922859458223821u})
        CHECK(rng.bits() == known);
}

TEST_CASE("small keys and numbers in any order make different keys, 0 and 0 too") {
    std::set<uint64_t> keys;
    for (uint64_t a = 0; a < 64; ++a)
        for (uint64_t b = 0; b < 64; ++b) keys.insert(hash(a, b));
    // 4096 words of 64 bits: two are equal by chance with probability 5e-13.
    CHECK(keys.size() == 4096);
    CHECK(keys.count(0) == 0);
}

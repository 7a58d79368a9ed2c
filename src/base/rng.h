// base/rng.h  1  random numbers as a function of a key
#pragma once
#include <cstdint>

namespace penumbra {

// Stafford's mix 13, a bijection of 64 bits: every input bit flips every output bit with
// probability about 1/2 (the finaliser of SplitMix64; Steele, Lea, Flood 2014).
inline uint64_t mix(uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

inline constexpr uint64_t golden = 0x9e3779b97f4a7c15u;  // 2^64 / golden ratio, odd

// A new key from a key and one more number; keys of different numbers are independent in practice.
inline uint64_t hash(uint64_t key, uint64_t x) { return mix(key + mix(x + golden) * golden + x); }

// SplitMix64: a plain stream of bits.  Its state is a counter: draw number n depends on n only.
struct Rng {
    uint64_t state = 0;
    uint64_t bits() { return mix(state += golden); }
    double uniform() { return double(bits() >> 11) * 0x1p-53; }  // in [0,1)
};

}  // namespace penumbra

// sampler.h  floor 3  the numbers of one path
#pragma once
#include "rng.h"
#include "vec.h"

// Numbers of [0,1), each a function of (seed, pixel, sample, dimension) alone: any thread may draw
// any path at any time.
class Sampler {
public:
    Sampler(uint64_t seed, uint64_t pixel, uint64_t sample)
        : rng_{hash(hash(hash(0, seed), pixel), sample)} {}

    real next() { return to_unit(rng_.bits()); }
    vec2 next2() {
        const real x = next(), y = next();
        return {x, y};
    }

private:
    Rng rng_;  // counts the dimensions
};

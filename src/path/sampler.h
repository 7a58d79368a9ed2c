// path/sampler.h  2  samplers: the random numbers of a path
#pragma once
#include <bit>
#include <vector>

#include "base/rng.h"
#include "path/halton.h"
#include "path/sobol.h"

enum class SamplerKind {
    independent,  // pseudo-random numbers
    stratified,   // jittered 4 x 4 grids, shuffled
    halton,       // scrambled Halton points, with a randomisation per pixel
    sobol         // Sobol' points, with a randomisation per pixel and pair of dimensions
};

// Dimensions of the numbers of a path: dimension(k, what) at vertex k; the first surface has k = 0.
enum class Draw { light_x, light_y, wi_x, wi_y, pick, lobe, roulette, count };
inline constexpr uint32_t film_x = 0, film_y = 1;
inline constexpr uint32_t dimension(int vertex, Draw what) {
    return 2 + uint32_t(vertex) * uint32_t(Draw::count) + uint32_t(what);
}

// Parameters that the samplers of all paths share.
struct Pattern {
    SamplerKind kind = SamplerKind::sobol;
    uint64_t seed = 0;
    std::vector<uint32_t> bases = {};  // halton: one prime per dimension
};

// For paths of up to `depth` bounces.
inline Pattern make_pattern(SamplerKind kind, uint64_t seed, int depth) {
    Pattern p{kind, seed};
    if (kind == SamplerKind::halton) p.bases = first_primes(dimension(depth, Draw::light_x));
    return p;
}

// stratified: each 16 samples are one of each cell of a 4 x 4 grid.  Those of an incomplete grid
// are an unbiased random choice.
inline constexpr uint32_t grid_columns = 4, grid_cells = 16;

// A random permutation of 0 ... 15, at i: a keyed bijection (Kensler 2013), then rotated, so that
// all values are exactly equally likely.
inline uint32_t permute(uint32_t i, uint64_t key) {
    uint64_t bits = key;
    for (int round = 0; round < 4; ++round, bits = std::rotr(bits, 17)) {
        i = (i * (uint32_t(bits) | 1) + uint32_t(bits >> 32)) % grid_cells;
        i ^= i >> 2;
    }
    return (i + uint32_t(mix(key) >> 60)) % grid_cells;
}

// Strata: a number in part `part` of [0,1), one of `parts` equal ones; and a point in cell `cell`
// of a grid of the unit square, cell 0 ... columns * rows - 1.  The bits are random.
// exercise 4.4
inline real in_part(uint32_t part, uint32_t parts, uint64_t bits) {
    return std::min(below_one, (real(part) + to_unit(bits)) / real(parts));
}
inline vec2 in_cell(uint32_t cell, uint32_t columns, uint32_t rows, uint64_t bits) {
    return {in_part(cell % columns, columns, bits), in_part(cell / columns, rows, mix(bits))};
}
// end

inline constexpr uint64_t most_samples = uint64_t(1) << 40;  // of each replication

// Sample i of replication `set` of pixel (x, y).
struct PixelSample {
    int x = 0, y = 0;
    uint64_t i = 0;
    uint32_t set = 0;
};

// The numbers in [0,1) of one sample of one pixel.  They depend only on (seed, pixel, replication,
// sample, dimension): any thread may draw any path at any time.  Each replication of a pixel, its
// `set`, has a randomisation of its own.
class Sampler {
public:
    Sampler(const Pattern& pattern, uint64_t pixel, uint64_t sample, uint32_t set = 0)
        : pattern_(pattern), index_(sample), key_(hash(hash(hash(0, pattern.seed), pixel), set)) {
        if (pattern.kind == SamplerKind::independent) key_ = hash(key_, sample);
        if (pattern.kind == SamplerKind::sobol) index_ = mirrored(index_);
    }
    Sampler(const Pattern&&, uint64_t, uint64_t, uint32_t = 0) = delete;  // it would be gone

    real get(uint32_t dim) const {
        switch (pattern_.kind) {
            case SamplerKind::independent: return to_unit(random(dim));
            case SamplerKind::stratified: {
                const auto [cell, jitter] = stratum(dim);
                return in_part(cell, grid_cells, jitter);
            }
            case SamplerKind::halton: {
                // exercise 4.3
                const uint64_t bits = random(dim);
                return scrambled_radical_inverse(pattern_.bases[dim], index_, bits, mix(bits));
                // end
            }
            default: return sobol_single(index_, random(dim));
        }
    }

    // Dimensions dim and dim + 1.
    vec2 get2(uint32_t dim) const {
        if (pattern_.kind == SamplerKind::sobol)
            return sobol_pair(index_, random(dim), random(dim + 1));
        if (pattern_.kind == SamplerKind::stratified) {
            const auto [cell, jitter] = stratum(dim);
            return in_cell(cell, grid_columns, grid_cells / grid_columns, jitter);
        }
        const real x = get(dim), y = get(dim + 1);
        return {x, y};
    }

    // The number that chooses the light or the lobe; the pair of the same vertex samples it.
    real choice(int vertex, Draw what) const {
        if (pattern_.kind != SamplerKind::sobol) return get(dimension(vertex, what));
        const uint32_t pair = dimension(vertex, what == Draw::pick ? Draw::light_x : Draw::wi_x);
        return sobol_third(index_, random(pair), random(pair + 1));
    }

private:
    const Pattern& pattern_;
    uint64_t index_;  // index of the sample; sobol: mirrored
    uint64_t key_;    // hash of seed, pixel and replication; independent: also of the sample

    uint64_t random(uint32_t dim) const { return mix(key_ + (dim + 1) * golden); }

    // The cell of this sample in its grid, and random bits for the position in it.
    struct Stratum {
        uint32_t cell;
        uint64_t jitter;
    };
    Stratum stratum(uint32_t dim) const {
        const uint64_t key = random(dim);
        const uint32_t cell =
            permute(uint32_t(index_ % grid_cells), mix(key + index_ / grid_cells * golden));
        return {cell, hash(key, index_)};
    }
};

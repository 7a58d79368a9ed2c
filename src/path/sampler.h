// path/sampler.h  2  samplers: the random numbers of a path
#pragma once
#include <bit>
#include <variant>
#include <vector>

#include "base/rng.h"
#include "path/halton.h"
#include "path/sobol.h"

namespace penumbra {

// Dimensions of the numbers of a path: dimension(k, what) at vertex k; the first surface has k = 0.
enum class Dimension { light_x, light_y, wi_x, wi_y, which_light, lobe, roulette, count };
inline constexpr uint32_t film_x = 0, film_y = 1;
inline constexpr uint32_t dimension(int k, Dimension what) {
    return 2 + uint32_t(k) * uint32_t(Dimension::count) + uint32_t(what);
}
static_assert(dimension(0, Dimension::light_y) ==
              dimension(0, Dimension::light_x) + 1);  // pairs, see get2
static_assert(dimension(0, Dimension::wi_y) == dimension(0, Dimension::wi_x) + 1);

// ---- Strata -------------------------------------------------------------------------------------

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

// ---- Kinds of samplers --------------------------------------------------------------------------

// A kind gives number `dim` of a path, in [0,1).  It may also give a pair of numbers, dim and
// dim + 1, by get2, and by choice the number that chooses the light or the lobe for this pair.

// Each kind is made of the sample's index and a random key for its pixel and replication.
struct PathKey {
    uint64_t index, key;
    const std::vector<uint32_t>& bases;  // one prime per dimension, for Halton points
    uint64_t random(uint32_t dim) const { return mix(key + (dim + 1) * golden); }
};

// Pseudo-random numbers.
struct Independent : PathKey {
    explicit Independent(const PathKey& of) : PathKey{of.index, hash(of.key, of.index), of.bases} {}
    real get(uint32_t dim) const { return to_unit(random(dim)); }
};

// Jittered 4 x 4 grids, shuffled.
struct Stratified : PathKey {
    explicit Stratified(const PathKey& of) : PathKey(of) {}
    real get(uint32_t dim) const {
        const auto [cell, jitter] = stratum(dim);
        return in_part(cell, grid_cells, jitter);
    }
    vec2 get2(uint32_t dim) const {
        const auto [cell, jitter] = stratum(dim);
        return in_cell(cell, grid_columns, grid_cells / grid_columns, jitter);
    }
    // The cell of this sample in its grid, and random bits for the position in it.
    struct Stratum {
        uint32_t cell;
        uint64_t jitter;
    };
    Stratum stratum(uint32_t dim) const {
        const uint64_t bits = random(dim);
        const uint32_t cell =
            permute(uint32_t(index % grid_cells), mix(bits + index / grid_cells * golden));
        return {cell, hash(bits, index)};
    }
};

// Scrambled Halton points, with a randomisation per pixel.
struct Halton : PathKey {
    explicit Halton(const PathKey& of) : PathKey(of) {}
    real get(uint32_t dim) const {
        // exercise 4.3
        const uint64_t bits = random(dim);
        return scrambled_radical_inverse(bases[dim], index, bits, mix(bits));
        // end
    }
};

// Sobol' points, with a randomisation per pixel and pair of dimensions.
struct Sobol : PathKey {
    explicit Sobol(const PathKey& of) : PathKey{reverse_bits(of.index), of.key, of.bases} {}
    real get(uint32_t dim) const { return sobol_single(index, random(dim)); }
    vec2 get2(uint32_t dim) const { return sobol_pair(index, random(dim), random(dim + 1)); }
    real choice(uint32_t pair) const { return sobol_third(index, random(pair), random(pair + 1)); }
};

enum class SamplerKind { independent, stratified, halton, sobol };
using SamplePoints = std::variant<Independent, Stratified, Halton, Sobol>;
inline SamplePoints points_of(SamplerKind kind, const PathKey& path) {
    switch (kind) {
        case SamplerKind::independent: return Independent(path);
        case SamplerKind::stratified: return Stratified(path);
        case SamplerKind::halton: return Halton(path);
        case SamplerKind::sobol: break;
    }
    return Sobol(path);
}

// ---- The sampler of a path ----------------------------------------------------------------------

// Parameters that the samplers of all paths share.
struct SamplerSettings {
    SamplerKind kind = SamplerKind::sobol;
    uint64_t seed = 0;
    std::vector<uint32_t> bases = {};  // halton: one prime per dimension
};

// For paths of up to `depth` bounces.
inline SamplerSettings sampler_settings(SamplerKind kind, uint64_t seed, int depth) {
    SamplerSettings settings{kind, seed};
    if (kind == SamplerKind::halton)
        settings.bases = first_primes(dimension(depth, Dimension::light_x));
    return settings;
}

inline constexpr uint64_t max_samples = uint64_t(1) << 40;  // of each replication

// Sample i of a replication of pixel (x, y).
struct PixelSample {
    int x = 0, y = 0;
    uint64_t i = 0;
    uint32_t replication = 0;
};

// The numbers in [0,1) of one sample of one pixel.  They depend only on (seed, pixel, replication,
// sample, dimension): any thread may draw any path at any time.  Each replication of a pixel
// has a randomisation of its own.  The settings must outlive the sampler.
class Sampler {
public:
    Sampler(const SamplerSettings& p, uint64_t pixel, uint64_t sample, uint32_t replication = 0)
        : points_(points_of(p.kind,
                            {sample, hash(hash(hash(0, p.seed), pixel), replication), p.bases})) {}
    Sampler(const SamplerSettings&&, uint64_t, uint64_t, uint32_t = 0) = delete;

    real get(uint32_t dim) const {
        return std::visit([&](const auto& points) { return points.get(dim); }, points_);
    }

    // Dimensions dim and dim + 1.
    vec2 get2(uint32_t dim) const {
        auto pair = [&](const auto& points) -> vec2 {
            if constexpr (requires { points.get2(dim); }) return points.get2(dim);
            const real x = points.get(dim), y = points.get(dim + 1);
            return {x, y};
        };
        return std::visit(pair, points_);
    }

    // The number that chooses the light or the lobe; the pair of the same vertex samples it.
    real choice(int k, Dimension what) const {
        const uint32_t pair =
            dimension(k, what == Dimension::which_light ? Dimension::light_x : Dimension::wi_x);
        auto third = [&](const auto& points) {
            if constexpr (requires { points.choice(pair); }) return points.choice(pair);
            return points.get(dimension(k, what));
        };
        return std::visit(third, points_);
    }

private:
    SamplePoints points_;
};

}  // namespace penumbra

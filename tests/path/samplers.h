// path/samplers.h  all samplers, and the cells of their values
#pragma once
#include "oracle/expect.h"
#include "path/sampler.h"

namespace penumbra {

inline constexpr SamplerKind samplers[] = {SamplerKind::independent, SamplerKind::stratified,
                                           SamplerKind::halton, SamplerKind::sobol};
inline constexpr const char* sampler_names[] = {"independent", "stratified", "halton", "sobol"};

// Returns which of n equal parts of [0,1) contains u.
inline uint64_t part(uint64_t n, real u) {
    REQUIRE((u >= 0 && u < 1));
    return uint64_t(u * real(n));
}

// Expects equal probabilities of all counted events.
inline oracle::Verdict expect_alike(const std::vector<uint64_t>& counts) {
    return oracle::expect_counts(counts,
                                 std::vector<double>(counts.size(), 1 / double(counts.size())));
}

}  // namespace penumbra

using namespace penumbra;

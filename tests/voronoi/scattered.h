// voronoi/scattered.h  random sites in a window
#pragma once
#include "oracle/expect.h"
#include "voronoi/plane.h"

namespace penumbra {

inline constexpr Rectangle unit_square = {{0, 0}, {1, 1}};

inline std::vector<Site> scattered(uint64_t n, oracle::Random& random,
                                   const Rectangle& in = unit_square) {
    std::vector<Site> sites;
    for (uint64_t i = 0; i < n; ++i) {
        const double x = random(), y = random();  // drawn in this order on every compiler
        sites.push_back({in.lo.x + x * in.width(), in.lo.y + y * in.height()});
    }
    return sites;
}

}  // namespace penumbra

using namespace penumbra;

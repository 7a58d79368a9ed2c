// base/moments.h  converts the program's moments to estimates that the oracle judges
#pragma once
#include "base/stats.h"
#include "oracle/oracle.h"

namespace penumbra {

inline oracle::Estimate estimate(const Moments& m, double unit = 0x1p-53) {
    return {m.mean, m.standard_error(), double(m.n) - 1, unit};
}

}  // namespace penumbra

using namespace penumbra;

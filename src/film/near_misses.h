// film/near_misses.h  1  what a film knows of light that samples nearly met: by -DWITH_UNSEEN
#pragma once

#ifdef WITH_UNSEEN
#include "unseen/near_misses.h"
#else
namespace penumbra {
struct NearMisses {
    void add(const NearMisses&) {}
    void end_pilot() {}
};
}  // namespace penumbra
#endif

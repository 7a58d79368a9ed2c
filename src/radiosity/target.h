// radiosity/target.h  1  stopping criteria of shooting, and its unit
#pragma once
#include <cstdint>

namespace penumbra {

// Whichever comes first; 0: no limit.
struct ShootingTarget {
    double unshot = 0;   // fraction of the emitted power
    double seconds = 0;  // total of all runs
    uint64_t shots = 0;
    double error = 0;  // see Shooting::error
};

// The unit that shoots at once.
enum class Shooter {
    element,  // one triangle of the mesh: as published
    face      // a whole face, in parts that are small as a vertex sees them, after the links of
              // Hanrahan, Salzman, Aupperle (1991)
};

}  // namespace penumbra

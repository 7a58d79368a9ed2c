// radiosity/target.h  1  how far shooting is to go, and what shoots at once
#pragma once
#include <cstdint>

// Whichever comes first; 0: no limit.
struct ShootingTarget {
    double unshot = 0;   // of the emitted power
    double seconds = 0;  // of all runs together
    uint64_t shots = 0;
    double error = 0;  // see Shooting::error
};

// What shoots at once.
enum class Shooter {
    element,  // one triangle of the mesh: as published
    face      // a whole face, in parts that are small as a vertex sees them, after the links of
              // Hanrahan, Salzman, Aupperle (1991)
};

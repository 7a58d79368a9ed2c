// path/scenes.h  scenes on which the techniques disagree if one of them is wrong
#pragma once
#include <string>

#include "text/scene_file.h"

namespace penumbra {

inline NamedScene scene_of(const std::string& text) { return parse_scene(text, "test").scene; }

inline const char* const glowing_room = R"(
size 8 4
camera 0 0.3 1.8  0 0 0  60
diffuse half 0.5 0.5 0.5
phong   gloss 0.2 0.2 0.2  0.3 0.3 0.3  0
light glow  0.4 0.4 0.4 twosided half
box 4 3 4  0  -2 -1.5 -2   glow
sphere -0.7 0 0  0.5  glow
)";

// A light behind a wall, unequal lights (one a triangle, one two-sided) and a Phong floor: the
// techniques disagree here if a weight, a density or a visibility is wrong.
inline const char* const unequal = R"(
size 64 32
camera 0 1.5 6  0 0.8 0  50
depth 3
diffuse white 0.7 0.6 0.5
phong   floor 0.2 0.3 0.3  0.5 0.4 0.5  12
diffuse wall  0.5 0.5 0.5
light big     2 2 3
light small   12 9 6  white
light both    3 4 3  twosided
quad -5 0 -5   0 0 10  10 0 0   floor
quad -5 0 -3   10 0 0  0 5 0    white
sphere -1.6 1.6 0  0.8   big
sphere  1.8 0.7 0.4  0.4 small
triangle -0.5 2.6 -1  0.9 2.6 -1  0.2 2.9 0.6   both
quad 0.3 0 -1  0 0 2.5  0 1.4 0  wall
)";

// Two quad lights, one seen only in reflections; spheres of Phong, mirror and glass.
inline const char* const shiny = R"(
size 64 32
camera 0 1.2 6  0 0.8 0  45
depth 4
diffuse white 0.6 0.6 0.7
phong   gloss 0.1 0.2 0.1  0.7 0.6 0.7  40
phong   lobe  0 0 0  0.9 0.9 0.9  3
mirror  mirror 0.8 0.9 0.9
glass   glass 1.5
light   lamp  4 4 3
light   back  2 2.5 3  white
quad -4 0 -4   0 0 8  8 0 0    white
quad -4 0 -3   8 0 0  0 4 0    lobe
quad -1.5 3 -1.5  3 0 0  0 0 3   lamp
quad 3 0 2  0 0 -3  0 2.5 0   back
sphere -1.6 0.7 0  0.7   gloss
sphere 0 0.7 0.5  0.6   mirror
sphere 1.5 0.6 0.2  0.6   glass
)";

}  // namespace penumbra

using namespace penumbra;

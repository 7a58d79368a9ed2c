// world/prepare.h  7  what rendering needs of a scene: the BVH, normals, and the choice of lights
#pragma once
#include "world/scene.h"

#ifdef WITH_MANY
#include "many/arrivals.h"
#else
namespace penumbra {
inline LightList light_choice_for(const Scene& s) { return {s.lights, intensities_of(s.lights)}; }
}  // namespace penumbra
#endif

namespace penumbra {

// Scene files are checked first, and surfaces that lie in each other moved apart: see src/check.
inline void prepare(Scene& s) {
    s.bvh = Tree(s.shapes);
    s.constants.clear();
    for (const Shape& shape : s.shapes) s.constants.push_back(constants_of(shape));
    s.light_choice = light_choice_for(s);  // last: it may trace rays
}

}  // namespace penumbra

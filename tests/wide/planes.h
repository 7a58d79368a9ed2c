// wide/planes.h  the box of a shape as the nodes of the wide BVH store it
#pragma once
#include "wide/wide_bvh.h"
#include "world/hard_rays.h"

template <>
inline Box stored_box<WideBvh>(const Shape& s) {
    const wide::Planes p = wide::planes(wide::outwards(bounds(s)));
    return {{-real(p[0]), -real(p[1]), -real(p[2])}, {real(p[3]), real(p[4]), real(p[5])}};
}

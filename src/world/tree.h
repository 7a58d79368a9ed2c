// world/tree.h  5  the BVH of a scene: plain, or by -DTREE_WIDE with eight children per node
#pragma once

// Both give the same answers, bit for bit.  The wide one, in a folder of its own, is faster.
#ifdef TREE_WIDE
#include "wide/wide_bvh.h"
namespace penumbra {
using Tree = WideBvh;
}
#else
#include "world/bvh.h"
namespace penumbra {
using Tree = Bvh;
}
#endif

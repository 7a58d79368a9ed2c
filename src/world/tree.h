// world/tree.h  5  the tree of a scene: plain, or by -DTREE_WIDE with eight children a node
#pragma once

// Both answer alike, bit for bit; the wide one, in a folder of its own, is faster.
#ifdef TREE_WIDE
#include "wide/wide_bvh.h"
using Tree = WideBvh;
#else
#include "world/bvh.h"
using Tree = Bvh;
#endif

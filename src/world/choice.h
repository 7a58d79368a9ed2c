// world/choice.h  5  the choice of lights of a scene: plain, or by -DWITH_MANY in a tree
#pragma once

#ifdef WITH_MANY
#include "many/light_tree.h"
namespace penumbra {
using LightChoice = LightTree;
}
#else
#include "world/light_choice.h"
namespace penumbra {
using LightChoice = LightList;
}
#endif

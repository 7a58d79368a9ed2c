// world/mesh.h  7  meshes of other programs, if this program was built with src/mesh
#pragma once
#include <optional>

#include "world/scene.h"

// Coordinates are no larger: their fourth powers must neither overflow nor vanish.
inline constexpr double longest_length = sizeof(real) == 4 ? 1e9 : 1e30;

// A scene of so many shapes takes 1 GB; a mesh that is placed again and again asks for any number.
inline constexpr size_t most_shapes = 1 << 22;

#if __has_include("mesh/obj.h")
#include "mesh/obj.h"
#else
struct ObjReader {
    ObjReader(Scene&, real, vec3, std::optional<uint32_t>) {}
    std::vector<std::string> read(const std::string& path) {
        throw UserError(path + ": this program was built without src/mesh");
    }
};
#endif

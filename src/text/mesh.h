// text/mesh.h  7  meshes of other programs, if -DWITH_MESH: with src/mesh
#pragma once
#include <optional>

#include "text/named_scene.h"

namespace penumbra {

// Coordinates are no larger: their fourth powers must neither overflow nor vanish.
inline constexpr double max_length = sizeof(real) == 4 ? 1e9 : 1e30;

// A mesh is scaled, its z axis made the y axis if that is up, turned about y as boxes are, moved.
struct MeshPlacement {
    real scale = 1;
    bool z_up = false;
    vec2 turn{1, 0};  // cosine and sine
    vec3 move = {};

    vec3 operator()(vec3 p) const {
        p = p * scale;
        if (z_up) p = {p.x, p.z, -p.y};
        return vec3{turn.x * p.x + turn.y * p.z, p.y, turn.x * p.z - turn.y * p.x} + move;
    }
};

}  // namespace penumbra

#ifdef WITH_MESH
#include "mesh/obj.h"
#else
namespace penumbra::mesh {
struct ObjReader {
    std::vector<std::string> files, warnings;
    ObjReader(NamedScene&, const MeshPlacement&, std::optional<uint32_t>, uint32_t, int64_t&) {}
    void read(const std::string& path) {
        throw UserError(path + ": this program was built without src/mesh");
    }
};
}  // namespace penumbra::mesh
#endif

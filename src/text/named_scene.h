// text/named_scene.h  2  a scene with what messages call its parts
#pragma once
#include <map>
#include <string>

#include "world/scene.h"

namespace penumbra {

// A scene of so many shapes takes 1 GB.
inline constexpr size_t max_shapes = 1 << 22;

// Names of materials, and the lines of the file that made shapes and lights; empty where no file
// is.  Of meshes, their files by line, and of each shape its own line there, or 0.
struct NamedScene : Scene {
    std::vector<std::string> names;
    std::vector<uint32_t> line_of, line_of_light, line_in_mesh;
    std::map<uint32_t, std::string> mesh_of;
};

// "line 3", or in a mesh "line 3 (m.obj:10)".
inline std::string where(const NamedScene& s, uint32_t shape) {
    const std::string line = "line " + std::to_string(s.line_of[shape]);
    if (shape >= s.line_in_mesh.size() || s.line_in_mesh[shape] == 0) return line;
    return line + " (" + s.mesh_of.at(s.line_of[shape]) + ":" +
           std::to_string(s.line_in_mesh[shape]) + ")";
}

inline void add_material(NamedScene& s, const Material& m, const std::string& name) {
    s.materials.push_back(m);
    s.names.push_back(name);
}

}  // namespace penumbra

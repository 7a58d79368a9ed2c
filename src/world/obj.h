// world/obj.h  1  meshes in: Wavefront OBJ and MTL files
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>

#include "base/files.h"
#include "base/vec.h"

// Polygons, with the materials that their file gives them.
struct ObjMesh {
    struct Material {
        rgb kd, ke;  // diffuse albedo, emitted radiance
    };
    struct Face {
        std::vector<uint32_t> corners;  // three or more indices of vertices
        int material = -1;              // index of materials; -1: none given
        int line = 0;                   // in the file
    };
    std::vector<vec3> vertices;
    std::vector<Material> materials;
    std::vector<Face> faces;
};

// Reads `v` and `f` (any number of corners, v, v/vt, v//vn or v/vt/vn, indices from 1 or, negative,
// from the last vertex back), `usemtl` and `mtllib` (`newmtl` with `Kd` and `Ke`; the rest of an
// MTL file has no meaning here).  Texture coordinates, normals, groups, lines and points are
// skipped.
class ObjReader {
public:
    // Throws UserError "PATH:LINE: what is wrong".
    static ObjMesh read(const std::string& path) {
        ObjReader reader;
        reader.each_line(path, [&] { reader.statement(path); });
        return std::move(reader.mesh_);
    }

private:
    ObjMesh mesh_;
    std::map<std::string, int> material_;  // by name
    int current_ = -1;
    std::vector<std::string> words_;
    int line_ = 0;

    template <class Statement>
    void each_line(const std::string& path, Statement read_words) {
        std::istringstream in(read_file(path));
        int line = 0;
        for (std::string text; std::getline(in, text);) {
            line_ = ++line;
            std::istringstream words(text.substr(0, text.find('#')));
            words_.clear();
            for (std::string word; words >> word;) words_.push_back(word);
            try {
                if (!words_.empty()) read_words();
            } catch (const UserError& e) {
                throw UserError(path + ":" + std::to_string(line) + ": " + e.what());
            }
        }
    }

    void statement(const std::string& path) {
        const std::string& keyword = words_[0];
        static const std::vector<std::string_view> skipped = {"vt", "vn", "vp", "g",
                                                              "o",  "s",  "l",  "p"};
        if (keyword == "v") {
            mesh_.vertices.push_back(triple());
        } else if (keyword == "f") {
            face();
        } else if (keyword == "usemtl") {
            auto found = material_.find(word(1));
            if (found == material_.end())
                throw UserError("undefined material " + in_quotes(word(1)));
            current_ = found->second;
        } else if (keyword == "mtllib") {
            const auto folder = std::filesystem::path(path).parent_path();
            const std::string library = (folder / word(1)).string();
            each_line(library, [&] { material_statement(); });
        } else if (std::find(skipped.begin(), skipped.end(), keyword) == skipped.end()) {
            throw UserError(
                unknown("keyword", keyword, {"v", "f", "usemtl", "mtllib", "vt", "vn"}));
        }
    }

    void material_statement() {
        const std::string& keyword = words_[0];
        if (keyword == "newmtl") {
            if (!material_.try_emplace(word(1), int(mesh_.materials.size())).second)
                throw UserError("a second material " + in_quotes(word(1)));
            mesh_.materials.emplace_back();
        }
        if (keyword != "Kd" && keyword != "Ke") return;
        if (mesh_.materials.empty()) throw UserError(keyword + " before newmtl");
        const rgb colour = triple();
        if (std::min({colour.x, colour.y, colour.z}) < 0)
            throw UserError("a colour must not be negative");
        if (keyword == "Kd" && max_of(colour) > 1) throw UserError("Kd must not exceed 1");
        (keyword == "Kd" ? mesh_.materials.back().kd : mesh_.materials.back().ke) = colour;
    }

    void face() {
        ObjMesh::Face face{{}, current_, line_};
        const auto count = int64_t(mesh_.vertices.size());
        for (size_t i = 1; i < words_.size(); ++i) {
            const std::string text = words_[i].substr(0, words_[i].find('/'));
            const double index = parse_number(text);
            const double k = index < 0 ? double(count) + index : index - 1;
            if (index != std::floor(index) || !(k >= 0 && k < double(count)))
                throw UserError("no vertex " + in_quotes(text) + " among the " +
                                std::to_string(count) + " so far");
            face.corners.push_back(uint32_t(k));
        }
        if (face.corners.size() < 3) throw UserError("a face needs three corners or more");
        mesh_.faces.push_back(face);
    }

    const std::string& word(size_t i) const {
        if (words_.size() <= i) throw UserError(words_[0] + " needs a name");
        return words_[i];
    }
    vec3 triple() const {
        if (words_.size() < 4) throw UserError(words_[0] + " needs three numbers");
        return {real(parse_number(words_[1])), real(parse_number(words_[2])),
                real(parse_number(words_[3]))};
    }
};

// The polygon's corners, turned so that the triangles (0, i, i+1) all face the same way; nothing
// if there is no such corner to start from.  Convex polygons always have one, and are not turned.
inline std::optional<std::vector<vec3>> fan_of(const std::vector<vec3>& corners) {
    const size_t n = corners.size();
    vec3 normal;  // twice the area (Newell)
    for (size_t i = 1; i + 1 < n; ++i)
        normal += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    for (size_t start = 0; start < n; ++start) {
        std::vector<vec3> turned(corners);
        std::rotate(turned.begin(), turned.begin() + std::ptrdiff_t(start), turned.end());
        bool fair = true;
        for (size_t i = 1; i + 1 < n; ++i) {
            const vec3 area = cross(turned[i] - turned[0], turned[i + 1] - turned[0]);
            fair = fair && dot(area, normal) >= 0;
        }
        if (fair) return turned;
    }
    return {};
}

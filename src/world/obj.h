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
        std::string name;
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
    std::vector<std::string> files;  // that it was read from
    uint64_t bytes = 0;              // of them
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
        if (reader.mesh_.faces.empty()) throw UserError(path + ": no face in it");
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
        const std::string bytes = read_file(path);
        mesh_.bytes += bytes.size();
        std::istringstream in(bytes);
        mesh_.files.push_back(path);
        int line = 0;
        for (std::string text; std::getline(in, text);) {
            line_ = ++line;
            words_ = words_before(text, '#');
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
            current_ = look_up(material_, word(1), "material");
        } else if (keyword == "mtllib") {
            const auto folder = std::filesystem::path(path).parent_path();
            const std::string library = (folder / word(1)).string();
            const size_t before = mesh_.materials.size();
            each_line(library, [&] { material_statement(); });
            if (mesh_.materials.size() == before) throw UserError(library + ": no material in it");
        } else if (std::find(skipped.begin(), skipped.end(), keyword) == skipped.end()) {
            // What is no mesh at all may be anything, and is not shown.
            if (!looks_like_a_keyword(keyword)) throw UserError("not a line of an OBJ file");
            throw UserError(
                unknown("keyword", keyword, {"v", "f", "usemtl", "mtllib", "vt", "vn"}));
        }
    }

    static bool looks_like_a_keyword(const std::string& word) {
        auto fits = [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        };
        return word.size() <= 20 && std::all_of(word.begin(), word.end(), fits);
    }

    void material_statement() {
        const std::string& keyword = words_[0];
        if (keyword == "newmtl") {
            if (!material_.try_emplace(word(1), int(mesh_.materials.size())).second)
                throw UserError("a second material " + in_quotes(word(1)));
            mesh_.materials.push_back({word(1), {}, {}});
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

// A polygon's corners, turned so that the triangles (0, i, i+1) all face the same way; how many
// were tried as the first, in as many steps each as there are corners.
struct Fan {
    std::vector<vec3> corners;
    size_t tried;
};

// Nothing if there is no such corner to start from.  Convex polygons always have one, and are not
// turned.  Others may have to try every corner, in n^2 steps: not with more than `most_concave`.
inline constexpr size_t most_concave = 1000;
inline std::optional<Fan> fan_of(std::vector<vec3> corners) {
    const size_t n = corners.size();
    vec3 normal;  // twice the area (Newell)
    for (size_t i = 1; i + 1 < n; ++i)
        normal += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    auto fair_from = [&](size_t start) {
        for (size_t i = 1; i + 1 < n; ++i) {
            const vec3 a = corners[start], b = corners[(start + i) % n] - a,
                       c = corners[(start + i + 1) % n] - a;
            if (!(dot(cross(b, c), normal) >= 0)) return false;
        }
        return true;
    };
    for (size_t start = 0; start < (n <= most_concave ? n : 1); ++start)
        if (fair_from(start)) {
            std::rotate(corners.begin(), corners.begin() + std::ptrdiff_t(start), corners.end());
            return Fan{std::move(corners), start + 1};
        }
    return {};
}

// ---- Meshes that are repeated -------------------------------------------------------------------

// What files may ask for: a number that takes half a second, and more in proportion to their bytes.
// A mesh that is placed once never asks for more; 15 bytes that place it again do.
struct Allowance {
    const char* what;
    uint64_t of_any, a_byte;

    // `bytes`: of all files, each once.
    void check(uint64_t n, uint64_t bytes) const {
        if (n <= of_any + a_byte * bytes) return;
        throw UserError("meshes are repeated too often: more than " + std::to_string(of_any) + " " +
                        what + ", and " + std::to_string(a_byte) + " for each of the " +
                        std::to_string(bytes) + " bytes read");
    }
};
inline constexpr Allowance most_shapes{"shapes", 1 << 18, 8};
inline constexpr Allowance most_materials{"materials", 1 << 16, 8};
inline constexpr Allowance most_fan_steps{"steps to cut up concave faces", 1 << 25, 256};

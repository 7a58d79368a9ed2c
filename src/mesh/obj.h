// mesh/obj.h  1  meshes in: Wavefront OBJ and MTL files
#pragma once
#include <filesystem>
#include <map>
#include <optional>

#include "base/files.h"
#include "world/mesh.h"

// A polygon's corners, turned so that the triangles (0, i, i+1) all face the same way.  Convex
// polygons are not turned.  Nothing if none of the first corners will do as the start.
inline constexpr size_t most_starts = 16;
inline std::optional<std::vector<vec3>> fan_of(std::vector<vec3> corners) {
    const size_t n = corners.size();
    vec3 normal;  // twice the area (Newell)
    for (size_t i = 1; i + 1 < n; ++i)
        normal += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    auto all_face_its_way = [&] {
        for (size_t i = 1; i + 1 < n; ++i)
            if (!(dot(cross(corners[i] - corners[0], corners[i + 1] - corners[0]), normal) >= 0))
                return false;
        return true;
    };
    for (size_t start = 0; start < std::min(n, most_starts); ++start) {
        if (all_face_its_way()) return corners;
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    }
    return {};
}

// Adds a mesh to a scene: its polygons, scaled and moved, and its materials.  Reads `v` and `f`
// (any number of corners, v, v/vt, v//vn or v/vt/vn, indices from 1 or, negative, from the last
// vertex back), `usemtl` and `mtllib` (`newmtl` with `Kd` and `Ke`; the rest of an MTL file has no
// meaning here).  Texture coordinates, normals, groups, lines and points are skipped.
class ObjReader {
public:
    // Faces that name no material have the one that is given.
    ObjReader(Scene& scene, real scale, vec3 move, std::optional<uint32_t> given)
        : scene_(scene), scale_(scale), move_(move), current_(given) {}

    // Returns the files that it read.  Throws UserError "PATH:LINE: what is wrong".
    std::vector<std::string> read(const std::string& path) {
        read_file_of(path, [&](const Words& words) { statement(words, path); });
        if (faces_ == 0) throw UserError(path + ": no face in it");
        return files_;
    }

private:
    Scene& scene_;
    const real scale_;
    const vec3 move_;
    std::optional<uint32_t> current_;
    std::map<std::string, uint32_t> material_;  // by name
    std::vector<vec3> vertices_;
    std::vector<std::string> files_;
    size_t faces_ = 0;

    template <class Read>
    void read_file_of(const std::string& path, Read read) {
        files_.push_back(path);
        read_lines(read_file(path), path, [&](const Words& words, uint32_t) { read(words); });
    }

    void statement(const Words& words, const std::string& path) {
        const std::string& keyword = words[0];
        constexpr std::string_view skipped[] = {"vt", "vn", "vp", "g", "o", "s", "l", "p"};
        if (keyword == "v") {
            vertices_.push_back(triple(words) * scale_ + move_);
        } else if (keyword == "f") {
            face(words);
        } else if (keyword == "usemtl") {
            current_ = look_up(material_, name(words), "material");
        } else if (keyword == "mtllib") {
            const auto folder = std::filesystem::path(path).parent_path();
            const std::string library = (folder / name(words)).string();
            const size_t before = material_.size();
            read_file_of(library, [&](const Words& of_it) { material_statement(of_it, before); });
            if (material_.size() == before) throw UserError(library + ": no material in it");
        } else if (std::ranges::find(skipped, keyword) == std::end(skipped)) {
            // It is not shown: what is no mesh at all may be anything.
            throw UserError("not a line of an OBJ file");
        }
    }

    // `before`: materials of other libraries.
    void material_statement(const Words& words, size_t before) {
        const std::string& keyword = words[0];
        if (keyword == "newmtl") {
            if (!material_.try_emplace(name(words), uint32_t(scene_.materials.size())).second)
                throw UserError("a second material " + in_quotes(name(words)));
            add_material(scene_, {}, name(words));
        }
        if (keyword != "Kd" && keyword != "Ke") return;
        if (material_.size() == before) throw UserError(keyword + " before newmtl");
        const rgb colour = triple(words);
        if (std::min({colour.x, colour.y, colour.z}) < 0)
            throw UserError("a colour must not be negative");
        if (keyword == "Kd" && max_of(colour) > 1) throw UserError("Kd must not exceed 1");
        Material& m = scene_.materials.back();
        (keyword == "Kd" ? m.kd : m.Le) = colour;
    }

    void face(const Words& words) {
        std::vector<vec3> corners;
        const size_t count = vertices_.size();
        for (size_t i = 1; i < words.size(); ++i) {
            const std::string text = words[i].substr(0, words[i].find('/'));
            const double index = parse_number(text);
            const double k = index < 0 ? double(count) + index : index - 1;
            if (index != std::floor(index) || !(k >= 0 && k < double(count)))
                throw UserError("no vertex " + in_quotes(text) + " among the " +
                                std::to_string(count) + " so far");
            corners.push_back(vertices_[size_t(k)]);
            if (double(max_abs(corners.back())) > longest_length) throw UserError("too far away");
        }
        if (corners.size() < 3) throw UserError("a face needs three corners or more");
        if (!current_) throw UserError("no material: give one here or in 'mesh'");
        polygon(corners);
        ++faces_;
        if (std::max(scene_.shapes.size(), scene_.materials.size()) > most_shapes)
            throw UserError("more than " + std::to_string(most_shapes) + " shapes, or materials");
    }

    // Parallelograms are lights in one piece.
    void polygon(const std::vector<vec3>& corners) {
        const auto fan = fan_of(corners);
        if (!fan)
            throw UserError("none of its first " + std::to_string(most_starts) +
                            " corners sees all others: cut this polygon up");
        const std::vector<vec3>& c = *fan;
        if (c.size() == 4 && c[0] + c[2] == c[1] + c[3])
            add_face(scene_, c[0], c[1], c[2], c[3], *current_);
        else
            for (size_t i = 1; i + 1 < c.size(); ++i)
                add_triangle(scene_, c[0], c[i], c[i + 1], *current_);
    }

    static const std::string& name(const Words& words) {
        if (words.size() < 2) throw UserError(words[0] + " needs a name");
        return words[1];
    }
    static vec3 triple(const Words& words) {
        if (words.size() < 4) throw UserError(words[0] + " needs three numbers");
        return {real(parse_number(words[1])), real(parse_number(words[2])),
                real(parse_number(words[3]))};
    }
};

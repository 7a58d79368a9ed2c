// mesh/obj.h  3  meshes in: Wavefront OBJ files
#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <span>

#include "mesh/ears.h"
#include "mesh/mtl.h"
#include "text/mesh.h"

namespace penumbra::mesh {

// Adds a mesh to a scene: its polygons, placed, and those of its materials that they name.  Reads
// `v` and `f` (any number of corners, v, v/vt, v//vn or v/vt/vn, indices from 1 or, negative, from
// the last vertex back), `usemtl` and `mtllib`.  Other lines are skipped.
class ObjReader {
public:
    // Faces whose material is not known have the one that is given, or are grey.  `line`: of the
    // scene's file.  Cutting up polygons spends `left`, which all meshes of a scene share.
    ObjReader(NamedScene& scene, const MeshPlacement& place, std::optional<uint32_t> given,
              uint32_t line, int64_t& left)
        : scene_(scene), place_(place), given_(given), line_(line), left_(left) {}

    std::vector<std::string> files, warnings;

    // Throws UserError "PATH:LINE: what is wrong".
    void read(const std::string& path) {
        path_ = path;
        files.push_back(path);
        scene_.mesh_of[line_] = std::filesystem::path(path).filename().string();
        scene_.line_in_mesh.resize(scene_.shapes.size());
        read_obj_lines(path, [&](const ObjLine& l, uint32_t line) { statement(l, line); });
        // The line is not shown: a file that is no mesh may be anything.
        if (vertices_.empty() && first_skipped_ > 0)
            throw error_at(path, first_skipped_, "not a line of an OBJ file");
        if (faces_.empty()) throw UserError(path + ": no face in it");
        for (const Face& face : faces_) {
            try {
                add(face);
            } catch (const UserError& e) {
                throw error_at(path, face.line, e.what());
            }
        }
        for (const auto& [note, met] : notes_)
            warnings.push_back(note.path + ": " + counted(met.count, note.noun) +
                               (met.count == 1 ? " is " : " are ") + note.fact + ", first " +
                               (met.name.empty() ? "" : in_quotes(met.name) + " ") + "at line " +
                               std::to_string(met.line) + note.remedy);
    }

private:
    struct Face {
        uint32_t line, use, first, count;
    };
    // A name of `usemtl`, its first line, and its material, as soon as a face needs it.
    struct Use {
        std::string name;
        uint32_t line = 0;
        std::optional<uint32_t> material = {};
    };
    // A warning, how often it applies, and where first.
    struct Note {
        std::string path, noun, fact, remedy;
        auto operator<=>(const Note&) const = default;
    };
    struct Met {
        size_t count = 0;
        uint32_t line = 0;
        std::string name = {};
    };

    NamedScene& scene_;
    const MeshPlacement place_;
    const std::optional<uint32_t> given_;
    const uint32_t line_;
    int64_t& left_;
    std::string path_;
    std::set<std::string> libraries_;
    std::map<std::string, Mtl> mtl_;
    std::map<std::string, uint32_t> use_of_;
    std::vector<Use> uses_{{}};
    uint32_t use_ = 0;  // the current one; 0: none
    std::vector<vec3> vertices_;
    std::vector<uint32_t> corners_;  // of all faces: indices of vertices
    std::vector<Face> faces_;
    uint32_t first_skipped_ = 0;
    std::map<Note, Met> notes_;

    void note(const Note& note, uint32_t line, const std::string& name = {}) {
        Met& met = notes_[note];
        if (met.count++ == 0) met.line = line, met.name = name;
    }

    // ---- Lines ----------------------------------------------------------------------------------

    void statement(const ObjLine& l, uint32_t line) {
        constexpr std::string_view meaningless[] = {"vt", "vn", "vp", "g", "o", "s", "l", "p"};
        if (l[0] == "v") {
            if (l.size() < 4) throw UserError("v needs three numbers");
            for (size_t i = 4; i < l.size(); ++i) coordinate(l[i]);  // a weight or a colour
            vertices_.push_back(place_({coordinate(l[1]), coordinate(l[2]), coordinate(l[3])}));
        } else if (l[0] == "f" || l[0] == "fo") {
            face(l, line);
        } else if (l[0] == "usemtl") {
            const auto [use, fresh] = use_of_.try_emplace(l.name(), uint32_t(uses_.size()));
            if (fresh) uses_.push_back({l.name(), line});
            use_ = l.size() > 1 ? use->second : 0;
        } else if (l[0] == "mtllib") {
            libraries(l, line);
        } else if (std::ranges::find(meaningless, l[0]) == std::end(meaningless)) {
            if (first_skipped_ == 0) first_skipped_ = line;
            note({path_, "line", "skipped", ""}, line, std::string(l[0]));
        }
    }

    // Some programs write "nan", "-inf" or "1.#IND" where they had no number.
    static real coordinate(std::string_view word) {
        if (word.find_first_of("nN") != word.npos) return std::numeric_limits<real>::quiet_NaN();
        return real(parse_number(word, std::numeric_limits<double>::infinity()));
    }

    // Vertices may follow the faces that they belong to.
    void face(const ObjLine& l, uint32_t line) {
        faces_.push_back({line, use_, uint32_t(corners_.size()), uint32_t(l.size() - 1)});
        for (size_t i = 1; i < l.size(); ++i) {
            const std::string_view text = l[i].substr(0, l[i].find('/'));
            const double index = parse_number(text);
            const double k = index < 0 ? double(vertices_.size()) + index : index - 1;
            if (index != std::floor(index) || !(k >= 0 && k < UINT32_MAX)) throw no_vertex(text);
            corners_.push_back(uint32_t(k));
        }
        if (faces_.size() > max_shapes) throw too_many();
    }
    UserError no_vertex(std::string_view text) const {
        return UserError("no vertex " + in_quotes(text) + " among " +
                         std::to_string(vertices_.size()));
    }
    static UserError too_many() {
        return UserError("more than " + std::to_string(max_shapes) + " shapes");
    }

    // ---- Materials ------------------------------------------------------------------------------

    // One name with blanks, or several names; '\' as Windows writes them.
    void libraries(const ObjLine& l, uint32_t line) {
        const auto path = [&](std::string name) {
            std::ranges::replace(name, '\\', '/');
            std::erase(name, '"');
            const auto folder = std::filesystem::path(path_).parent_path();
            return (folder / name).lexically_normal().string();
        };
        const auto is_there = [&](const std::string& name) {
            std::error_code unreachable;
            return std::filesystem::is_regular_file(path(name), unreachable);
        };
        std::vector<std::string> names(l.words.begin() + 1, l.words.end());
        if (is_there(l.name())) names = {l.name()};
        for (const std::string& name : names) {
            if (!libraries_.insert(path(name)).second) continue;
            if (is_there(name))
                library(path(name));
            else
                note({path_, "material file", "missing", ""}, line, name);
        }
    }

    void library(const std::string& path) {
        files.push_back(path);
        Mtl second, *current = nullptr;
        read_obj_lines(path, [&](const ObjLine& l, uint32_t line) {
            if (l[0] == "newmtl") {
                const auto [own, fresh] = mtl_.try_emplace(l.name());
                current = fresh ? &own->second : &second;
                if (!fresh)
                    note({path, "material", "defined twice", ": the first counts"}, line, l.name());
            } else if (!current || !understood(*current, l)) {
                unused(l[0], path, line);
            }
        });
    }

    // A property without a number is left as it was.
    static bool understood(Mtl& material, const ObjLine& l) {
        try {
            return material.read(l);
        } catch (const UserError&) {
            return false;
        }
    }

    // Words other than letters are not shown: what is no library at all may be anything.
    void unused(std::string_view word, const std::string& path, uint32_t line) {
        constexpr std::string_view textures[] = {"bump", "disp", "decal", "refl", "norm"};
        const bool texture =
            word.starts_with("map_") || std::ranges::find(textures, word) != std::end(textures);
        const bool letters =
            std::ranges::all_of(word, [](unsigned char c) { return std::isalpha(c) || c == '_'; });
        note({path, texture ? "texture" : "statement", "not used", ""}, line,
             std::string(letters ? word : ""));
    }

    uint32_t material(uint32_t use, uint32_t line) {
        Use& u = uses_[use];
        if (use == 0 && !given_)
            note({path_, "face", "without material", ": 'grey' is used"}, line);
        if (u.material) return *u.material;
        const std::string instead =
            ": " + in_quotes(given_ ? scene_.names[*given_] : "grey") + " is used";
        const auto found = mtl_.find(u.name);
        if (found == mtl_.end()) {
            if (use > 0) note({path_, "material", "not defined", instead}, u.line, u.name);
            if (given_) return *(u.material = given_);
            const Material grey{Rough({0.5, 0.5, 0.5})};
            add_material(scene_, grey, "grey");
        } else {
            const Mtl& m = found->second;
            auto tell = [&](bool so, const char* fact, const char* remedy) {
                if (so) note({path_, "material", fact, remedy}, u.line, u.name);
            };
            tell(m.albedo() > 1, "too bright", ": scaled to an albedo of 1");
            tell(m.is_blank(), "without Kd", ": grey of albedo 0.5");
            tell(m.is_clear() && !m.is_glass(), "opaque", ": d or Tr without Ni above 1");
            add_material(scene_, m.material(), u.name);
        }
        return *(u.material = uint32_t(scene_.materials.size() - 1));
    }

    // ---- Polygons -------------------------------------------------------------------------------

    void add(const Face& face) {
        Corners c;
        for (uint32_t k : std::span(corners_).subspan(face.first, face.count)) {
            if (k >= vertices_.size()) throw no_vertex(std::to_string(uint64_t(k) + 1));
            c.push_back(vertices_[k]);
        }
        auto is_near = [](vec3 p) { return is_finite(p) && double(max_abs(p)) <= max_length; };
        if (c.size() < 3 || !std::ranges::all_of(c, is_near))
            return note({path_, "face", "left out", ": faces need three corners, near enough"},
                        face.line);
        polygon(c, material(face.use, face.line), face.line);
        if (scene_.shapes.size() > max_shapes) throw too_many();
        scene_.line_in_mesh.resize(scene_.shapes.size(), face.line);
    }

    // Parallelograms are lights in one piece.
    void polygon(const Corners& c, uint32_t material, uint32_t line) {
        const bool plain = face_one_way(c, fan_of(c));
        if (plain && c.size() == 4 && c[0] + c[2] == c[1] + c[3])
            return add_face(scene_, c[0], c[1], c[2], c[3], material);
        const auto ears = plain ? std::nullopt : Ears(c).cut(left_);
        const Cuts triangles = ears.value_or(fan_of(c));
        if (!plain && !ears && left_ < int64_t(c.size() * c.size()))
            note({path_, "face", "too large to cut up", ": triangles may overlap"}, line);
        else if (is_folded(c, triangles))
            note({path_, "face", "folded", ": triangles may overlap"}, line);
        for (auto [i, j, k] : triangles) add_triangle(scene_, c[i], c[j], c[k], material);
    }
};

}  // namespace penumbra::mesh

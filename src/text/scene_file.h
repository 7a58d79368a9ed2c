// text/scene_file.h  8  reading scenes/NAME.scene: one table of statements, each with its reader
//
// Parsing, messages and the table of reference/scenes.md all follow from `grammar`.  Scenes are
// checked if -DWITH_CHECK: with src/check.
#pragma once
#include <array>
#include <map>
#include <set>
#include <sstream>

#include "path/sampler.h"
#include "text/files.h"
#include "text/mesh.h"
#include "world/prepare.h"

#ifdef WITH_CHECK
#include "check/scene_check.h"
#else
namespace penumbra {
inline constexpr bool moves_surfaces = false;
inline std::vector<std::string> check_and_prepare(NamedScene& s, const std::string&) {
    prepare(s);
    return {"this program was built without src/check: light may be wrong where surfaces touch"};
}
}  // namespace penumbra
#endif

namespace penumbra {

// Cosine and sine of an angle in degrees.
inline vec2 turned_about_y(real degrees) {
    const real turns = degrees / 360;
    return unit_circle(turns - std::floor(turns));
}

// Size along x, y, z from the origin, then rotated about y (x' = c x + s z, z' = c z - s x), then
// moved.  Faces outwards.  Each corner is computed once, so the box is watertight.
inline void add_box(Scene& s, vec3 size, real degrees, vec3 move, uint32_t material) {
    const vec2 turn = turned_about_y(degrees);
    const double cosine = double(turn.x), sine = double(turn.y);
    vec3 corner[8];  // bit 0: far in x, bit 1: in y, bit 2: in z
    for (int i = 0; i < 8; ++i) {
        const double x = double(size.x) * (i & 1), z = double(size.z) * (i >> 2);
        corner[i] = {real(cosine * x + sine * z + double(move.x)),
                     size.y * real(i >> 1 & 1) + move.y,
                     real(cosine * z - sine * x + double(move.z))};
    }
    for (auto [a, b, c, d] : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6},   // -z, +z
                              std::array{0, 1, 5, 4}, std::array{2, 6, 7, 3},   // -y, +y
                              std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}})  // -x, +x
        add_face(s, corner[a], corner[b], corner[c], corner[d], material);
}

// A scene, warnings to its author, the files of its meshes and its own, and its text.
struct ParsedScene {
    NamedScene scene;
    std::vector<std::string> warnings, files;
    std::string text = {};
};

class SceneReader;

// One statement a line, keyword first, material last; '#' starts a comment.
struct Statement {
    enum Kind { setting, material, content } kind;  // a setting stands once
    std::string_view keyword, words, meaning;
    void (*read)(SceneReader&);          // reads the words after the keyword, or after NAME
    std::string_view default_text = {};  // without it; "": nothing
};
inline const Statement& statement_of(const Words& words);

// Reads statements one after the other; every error is a UserError without the line number.
class SceneReader {
public:
    // Files are named relative to `folder`.
    explicit SceneReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

    NamedScene scene;

    void statement(const Words& words, uint32_t line) {
        words_ = words;
        next_ = 1;
        line_ = line;
        const Statement& statement = statement_of(words);
        if (statement.kind == Statement::setting && !seen_.insert(words[0]).second)
            throw UserError("a second " + words[0]);
        if (statement.kind == Statement::material) {
            name_ = words_[next_++];
            if (material_.contains(name_)) throw UserError("a second material " + in_quotes(name_));
        }
        statement.read(*this);
        if (scene.shapes.size() > max_shapes)
            throw UserError("more than " + std::to_string(max_shapes) + " shapes");
        scene.line_of.resize(scene.shapes.size(), line);
        scene.line_of_light.resize(scene.lights.size(), line);
    }

    // Checks the whole scene.  `name` is the name of the scene's file.
    ParsedScene finish(const std::string& name) {
        NamedScene& s = scene;
        if (!seen_.contains("camera")) throw UserError(name + ": no camera");
        const std::string dropped = "dropped " + counted(s.dropped, "triangle") + " without area";
        if (s.shapes.empty())
            throw UserError(name +
                            ": empty scene: " + (s.dropped > 0 ? dropped : "it has no shape"));
        auto warn = [&](const std::string& what) { warnings_.push_back(what); };
        if (s.dropped > 0) warn(dropped);
        for (const std::string& warning : check_and_prepare(s, name)) warn(warning);
        if (s.lights.empty()) warn("no light: the image will be black");
        return {std::move(scene), std::move(warnings_), std::move(files_)};
    }

    // ---- Words, for the readers of statements --------------------------------------------------

    std::string last() const { return in_quotes(words_[next_ - 1]); }  // word read
    real number(double most = max_number) { return real(parse_number(words_[next_++], most)); }
    real positive(const std::string& what, double most = max_number) {
        const real x = number(most);
        if (!(x > 0)) throw UserError(what + " must be positive, not " + last());
        return x;
    }
    real length_of(const std::string& what) {
        const real x = positive(what, max_length);
        if (double(x) < 1 / max_length) throw UserError(what + " is too small: " + last());
        return x;
    }
    vec3 point() {
        real x = number(max_length), y = number(max_length), z = number(max_length);
        return {x, y, z};
    }
    rgb colour() {
        rgb c;
        for (auto channel : axis) {
            c.*channel = number();
            if (c.*channel < 0) throw UserError("a colour must not be negative: " + last());
        }
        return c;
    }
    uint64_t count(uint64_t least, uint64_t most) {
        return parse_count(words_[next_++], least, most);
    }
    Size size() {
        next_ += 2;
        return parse_size(words_[next_ - 2], words_[next_ - 1]);
    }
    uint32_t material() { return look_up(material_, words_[next_++], "material"); }

    // ---- Statements of several steps -----------------------------------------------------------

    // Gives the name that was read to a material.
    void define(const Material& m) {
        if (max_of(m.albedo()) > 1)
            throw UserError("reflects more than it receives: a channel of the albedo exceeds 1");
        material_[name_] = uint32_t(scene.materials.size());
        add_material(scene, m, name_);
    }
    void define(auto of) { define(Material{Scattering(std::in_place_type<decltype(of)>, of)}); }

    void light() {
        Material m{Rough(), colour()};
        m.twosided = next_ < words_.size() && words_[next_] == "twosided";
        next_ += m.twosided;
        if (next_ < words_.size()) m.scattering = scene.materials[material()].scattering;
        if (next_ < words_.size()) throw UserError("unknown word " + in_quotes(words_[next_]));
        define(m);
    }

    void camera() {
        vec3 eye = point(), target = point();
        real fov = number();
        if (!(fov > 0 && fov < 180)) throw UserError("field of view must be between 0 and 180");
        scene.camera = look_at(eye, target, fov);
        if (!is_finite(scene.camera.right))
            throw UserError("the camera must look somewhere, and not along y, which is up");
    }

    void mesh() {
        const std::filesystem::path path = folder_ / words_[next_++];
        const std::string made = path.lexically_normal().string();
        if (made.starts_with("build/") && !std::filesystem::exists(path))
            throw UserError(made + ": not made yet: make " + made);
        MeshPlacement place{length_of("scale")};
        place.move = point();
        auto says = [&](const char* word) {  // a material of this name comes first
            return next_ < words_.size() && words_[next_] == word && !material_.contains(word);
        };
        while (says("turn") || says("z_up")) {
            if (words_[next_++] == "z_up")
                place.z_up = true;
            else if (next_ == words_.size())
                throw UserError("turn needs degrees");
            else
                place.turn = turned_about_y(number());
        }
        std::optional<uint32_t> given;
        if (next_ < words_.size()) given = material();
        if (next_ < words_.size()) throw UserError("unknown word " + in_quotes(words_[next_]));
        mesh::ObjReader reader(scene, place, given, line_, left_);
        reader.read(path.string());
        files_.insert(files_.end(), reader.files.begin(), reader.files.end());
        for (const std::string& warning : reader.warnings)
            if (std::ranges::find(warnings_, warning) == warnings_.end())
                warnings_.push_back(warning);
    }

private:
    const std::filesystem::path folder_;
    std::vector<std::string> warnings_, files_;  // files: of meshes
    std::map<std::string, uint32_t> material_;   // by name
    std::set<std::string> seen_;                 // statements that stand only once
    Words words_;
    std::string name_;  // of the material that is defined
    size_t next_ = 0;   // word to read
    uint32_t line_ = 0;
    int64_t left_ = 1 << 29;  // tests to cut up polygons: about a second
};

// ---- The grammar -------------------------------------------------------------------------------

inline constexpr Statement grammar[] = {
    {Statement::setting, "size", "WIDTH HEIGHT", "width and height in pixels, which are square",
     [](SceneReader& r) { r.scene.size = r.size(); }, "256 128"},
    {Statement::setting, "camera", "EYE_X EYE_Y EYE_Z  TARGET_X TARGET_Y TARGET_Z  VERTICAL_FOV",
     "pinhole camera; +y is up; field of view in degrees", [](SceneReader& r) { r.camera(); }},
    {Statement::setting, "depth", "BOUNCES", "maximum number of bounces; 0: emission only",
     [](SceneReader& r) { r.scene.depth = int(r.count(0, max_depth)); }, "8"},
    {Statement::setting, "samples", "PER_PIXEL", "default samples per pixel",
     [](SceneReader& r) { r.scene.samples = r.count(1, max_samples); }, "64"},
    {Statement::setting, "exposure", "FACTOR", "factor from radiance to PNG",
     [](SceneReader& r) { r.scene.exposure = r.positive("exposure"); }, "1"},
    {Statement::material, "diffuse", "NAME  R G B", "albedo ρ: f = ρ/π",
     [](SceneReader& r) { r.define(Rough(r.colour())); }},
    {Statement::material, "phong",
     "NAME  DIFFUSE_R DIFFUSE_G DIFFUSE_B  LOBE_R LOBE_G LOBE_B  EXPONENT",
     "f = ρ/π + ρ' (n+2)/(2π) cosⁿ of the angle to the mirror direction",
     [](SceneReader& r) {
         const rgb diffuse = r.colour(), lobe = r.colour();
         const real n = r.number(1e6);
         if (n < 0) throw UserError("the exponent must not be negative");
         r.define(Rough(diffuse, lobe, n));
     }},
    {Statement::material, "mirror", "NAME  R G B", "reflectance",
     [](SceneReader& r) { r.define(Mirror(r.colour())); }},
    {Statement::material, "glass", "NAME  INDEX_OF_REFRACTION",
     "smooth dielectric, Fresnel; 1 outside",
     [](SceneReader& r) { r.define(Glass(r.positive("index of refraction"))); }},
    {Statement::material, "light", "NAME  R G B  [twosided] [MATERIAL]",
     "emits this radiance; reflects like MATERIAL, or not at all",
     [](SceneReader& r) { r.light(); }},
    {Statement::content, "pointlight", "X Y Z  R G B", "intensity: radiance × length²",
     [](SceneReader& r) {
         const vec3 p = r.point();
         add_light(r.scene, {p, PointLight(), r.colour()});
     }},
    {Statement::content, "sphere", "X Y Z  RADIUS  MATERIAL", "emits outwards",
     [](SceneReader& r) {
         const vec3 centre = r.point();
         const real radius = r.length_of("radius");
         add_sphere(r.scene, centre, radius, r.material());
     }},
    {Statement::content, "triangle", "AX AY AZ  BX BY BZ  CX CY CZ  MATERIAL",
     "emits on the side of (B−A)×(C−A)",
     [](SceneReader& r) {
         const vec3 a = r.point(), b = r.point(), c = r.point();
         add_triangle(r.scene, a, b, c, r.material());
     }},
    {Statement::content, "quad", "X Y Z  UX UY UZ  VX VY VZ  MATERIAL",
     "a parallelogram: a corner and two edges; emits on the side of U×V",
     [](SceneReader& r) {
         const vec3 p = r.point(), u = r.point(), v = r.point();
         add_quad(r.scene, p, u, v, r.material());
     }},
    {Statement::content, "mesh", "FILE.obj  SCALE  X Y Z  [turn DEGREES_ABOUT_Y] [z_up] [MATERIAL]",
     "polygons, scaled, z made y by `z_up`, rotated about y, moved; MATERIAL is for faces whose "
     "own is missing; FILE is relative to the scene's folder, in quotes if it has blanks",
     [](SceneReader& r) { r.mesh(); }},
    {Statement::content, "box", "WIDTH HEIGHT DEPTH  DEGREES_ABOUT_Y  X Y Z  MATERIAL",
     "axis-aligned with a corner at the origin, then rotated about y and moved; emits outwards",
     [](SceneReader& r) {
         const real w = r.length_of("width"), h = r.length_of("height"), d = r.length_of("depth");
         const real degrees = r.number();
         const vec3 move = r.point();
         add_box(r.scene, {w, h, d}, degrees, move, r.material());
     }},
};

// The statement that these words are; throws UserError if there is none, or if they are too few or
// too many.
inline const Statement& statement_of(const Words& words) {
    std::vector<std::string_view> known;
    for (const Statement& s : grammar) {
        known.push_back(s.keyword);
        if (s.keyword != words[0]) continue;
        size_t least = 0, most = 0;
        std::istringstream in{std::string(s.words)};
        bool needed = true;  // those that are not come last
        for (std::string word; in >> word; ++most) least += needed = needed && word[0] != '[';
        const size_t found = words.size() - 1;
        if (found >= least && found <= most) return s;
        throw UserError("too " + std::string(found < least ? "few" : "many") + " words (" +
                        std::to_string(found) + "): " + words[0] + " " + std::string(s.words));
    }
    throw UserError(unknown("keyword", words[0], known));
}

// Throws UserError "NAME:LINE: what is wrong".
inline ParsedScene parse_scene(const std::string& text, const std::string& name) {
    SceneReader reader(std::filesystem::path(name).parent_path());
    read_lines(text, name, [&](std::string_view text_of, uint32_t line) {
        if (const Words words = words_before(text_of, '#'); !words.empty())
            reader.statement(words, line);
    });
    return reader.finish(name);
}

// A scene may come through a pipe, too.
inline ParsedScene read_scene(const std::string& path) {
    std::string text = read_file(path, path == "/dev/stdin");
    ParsedScene parsed = parse_scene(text, path);
    parsed.files.push_back(path);
    parsed.text = std::move(text);
    return parsed;
}

}  // namespace penumbra

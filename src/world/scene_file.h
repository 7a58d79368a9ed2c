// world/scene_file.h  8  reading scenes/NAME.scene
#pragma once
#include <map>
#include <set>
#include <sstream>

#include "world/grammar.h"
#include "world/obj.h"
#include "world/scene_check.h"

// A scene, what its author should know about it, and the files that it was read from.
struct ParsedScene {
    Scene scene;
    std::vector<std::string> warnings, files;
};

// Reads statements one after the other; every error is a UserError without the line number.
class Parser {
public:
    // Files are named relative to `folder`.
    explicit Parser(std::filesystem::path folder) : folder_(std::move(folder)) {}

    void statement(const std::string& text, int line) {
        bytes_ += text.size() + 1;
        words_ = words_before(text, '#');
        if (words_.empty()) return;
        next_ = 1;
        line_ = line;
        const Statement& statement = statement_of(words_);
        if (statement.kind == Statement::setting) set(words_[0]);
        if (statement.kind == Statement::material) define(words_[0]);
        if (statement.kind == Statement::content) add(words_[0]);
        scene_.line_of.resize(scene_.shapes.size(), uint32_t(line));
        scene_.line_of_light.resize(scene_.lights.size(), uint32_t(line));
    }

    // What only the whole scene can tell.
    ParsedScene finish() {
        if (!seen_.contains("camera")) throw UserError("no camera");
        if (scene_.shapes.empty()) throw UserError("empty scene: nothing to look at");
        for (const SphereLight& l : sphere_lights_)
            if (length(scene_.camera.eye - l.centre) <= l.r) {
                line_ = l.line;
                throw UserError("the camera is inside this sphere light");
            }
        ParsedScene result;
        if (dropped_ > 0)
            result.warnings.push_back(std::to_string(dropped_) +
                                      (dropped_ == 1 ? " triangle without area was dropped"
                                                     : " triangles without area were dropped"));
        check_light(result.warnings);
        prepare(scene_);
        result.scene = std::move(scene_);
        result.files = std::move(files_);
        return result;
    }

    int line() const { return line_; }

private:
    // Refuses what rounding would decide, and tells what can be seen but for that.
    void check_light(std::vector<std::string>& warnings) {
        for (const auto& [line, cover] : drop_covered_lights(scene_))
            warnings.push_back("line " + std::to_string(line) + ": this light is dark: line " +
                               std::to_string(cover) + " covers it, which comes first");
        if (const auto on = light_on_surface(scene_)) {
            line_ = int(on->line_of_light);
            throw UserError("this point light lies on the surface of line " +
                            std::to_string(on->line) + ": move it off");
        }
        const Coarse c = coarsest(scene_);
        if (c.part > real(0.01))
            warnings.push_back(
                "line " + std::to_string(c.line) + ": numbers of " + std::to_string(sizeof(real)) +
                " bytes are coarse here: rays start " +
                std::to_string(int(std::min(real(1e9), 100 * c.part))) +
                " % of this shape's size off the surface of line " + std::to_string(c.because));
        if (scene_.lights.empty()) warnings.push_back("no light: all will be black");
    }

    // Lengths: their fourth powers must neither overflow nor vanish.
    static constexpr double longest = sizeof(real) == 4 ? 1e9 : 1e30;
    static constexpr uint64_t max_depth = 1000000, max_samples = 1 << 20;

    struct SphereLight {
        vec3 centre;
        real r;
        int line;
    };

    const std::filesystem::path folder_;
    Scene scene_;
    std::map<std::string, uint32_t> material_;  // by name
    std::map<std::string, int> seen_;           // line of the statements that stand only once
    std::vector<SphereLight> sphere_lights_;
    std::vector<std::string> files_;  // of meshes
    std::vector<std::string> words_;
    size_t next_ = 0;  // word to read
    int line_ = 0, dropped_ = 0;
    std::set<std::string> meshes_;        // that were read
    uint64_t bytes_ = 0, fan_steps_ = 0;  // of all files, each once; that concave faces took

    // ---- Statements ---------------------------------------------------------------------------

    void set(const std::string& keyword) {
        once(keyword);
        if (keyword == "size") scene_.size = parse_size(words_[1], words_[2]);
        if (keyword == "camera") camera();
        if (keyword == "depth") scene_.depth = int(parse_count(words_[1], 0, max_depth));
        if (keyword == "samples") scene_.samples = parse_count(words_[1], 1, max_samples);
        if (keyword == "exposure") scene_.exposure = positive("exposure");
    }

    void add(const std::string& keyword) {
        Scene& s = scene_;
        if (keyword == "pointlight") {
            vec3 p = point();
            add_point_light(s, p, colour());
        } else if (keyword == "sphere") {
            vec3 centre = point();
            real r = length_of("radius");
            uint32_t m = material();
            add_sphere(s, centre, r, m);
            if (s.materials[m].emits()) sphere_lights_.push_back({centre, r, line_});
        } else if (keyword == "triangle") {
            vec3 a = point(), b = point(), c = point();
            dropped_ += add_triangle(s, a, b, c, material());
        } else if (keyword == "quad") {
            vec3 p = point(), u = point(), v = point();
            dropped_ += add_quad(s, p, u, v, material());
        } else if (keyword == "mesh") {
            mesh();
        } else {  // box
            real w = length_of("width"), h = length_of("height"), d = length_of("depth");
            real degrees = number();
            vec3 move = point();
            dropped_ += add_box(s, {w, h, d}, degrees, move, material());
        }
    }

    void once(const std::string& keyword) {
        auto [place, is_new] = seen_.try_emplace(keyword, line_);
        if (!is_new)
            throw UserError("a second " + keyword + ", after line " +
                            std::to_string(place->second));
    }

    // ---- Words ----------------------------------------------------------------------------------

    std::string last() const { return in_quotes(words_[next_ - 1]); }  // word read
    real number(double most = largest_number) { return real(parse_number(words_[next_++], most)); }
    real positive(const std::string& what) {
        real x = number();
        if (!(x > 0)) throw UserError(what + " must be positive, not " + last());
        return x;
    }
    real length_of(const std::string& what) {
        real x = number(longest);
        if (!(x > 0)) throw UserError(what + " must be positive, not " + last());
        if (double(x) < 1 / longest) throw UserError(what + " is too small: " + last());
        return x;
    }
    vec3 point() {
        real x = number(longest), y = number(longest), z = number(longest);
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
    void check_albedo(rgb albedo) const {
        if (max_of(albedo) > 1 + 4 * ulp)
            throw UserError("reflects more than it receives: a channel of the albedo exceeds 1");
    }

    uint32_t material() { return look_up(material_, words_[next_++], "material"); }

    void camera() {
        vec3 eye = point(), target = point();
        real fov = number();
        if (!(fov > 0 && fov < 180)) throw UserError("field of view must be between 0 and 180");
        scene_.camera = look_at(eye, target, fov);
        if (!is_finite(scene_.camera.right))
            throw UserError("the camera must look somewhere, and not along y, which is up");
    }

    // Polygons of an OBJ file, scaled and moved.  Parallelograms are lights in one piece.
    void mesh() {
        const std::string path = (folder_ / words_[next_++]).string();
        const real scale = length_of("scale");
        const vec3 move = point();
        std::optional<uint32_t> given;
        if (next_ < words_.size()) given = material();
        const ObjMesh mesh = ObjReader::read(path);
        if (meshes_.insert(true_name(path)).second) bytes_ += mesh.bytes;
        files_.insert(files_.end(), mesh.files.begin(), mesh.files.end());
        const auto first = uint32_t(scene_.materials.size());
        for (const ObjMesh::Material& m : mesh.materials) {
            Material material;
            material.kd = m.kd;
            material.Le = m.ke;
            scene_.materials.push_back(material);
            scene_.names.push_back(m.name);
        }
        most_materials.check(scene_.materials.size(), bytes_);
        for (const ObjMesh::Face& face : mesh.faces) {
            try {
                if (face.material < 0 && !given)
                    throw UserError("no material: give one here or in 'mesh'");
                std::vector<vec3> corners;
                for (uint32_t i : face.corners) corners.push_back(mesh.vertices[i] * scale + move);
                polygon(corners, face.material < 0 ? *given : first + uint32_t(face.material));
            } catch (const UserError& e) {
                throw UserError(path + ":" + std::to_string(face.line) + ": " + e.what());
            }
            most_shapes.check(scene_.shapes.size(), bytes_);
            most_fan_steps.check(fan_steps_, bytes_);
        }
    }

    void polygon(const std::vector<vec3>& corners, uint32_t m) {
        for (vec3 c : corners)
            if (double(max_abs(c)) > longest) throw UserError("too far away");
        const auto fan = fan_of(corners);
        if (!fan && corners.size() > most_concave)
            throw UserError("concave, with more than " + std::to_string(most_concave) +
                            " corners: cut this polygon up");
        if (!fan) throw UserError("no corner sees all others: cut this polygon up");
        const std::vector<vec3>& c = fan->corners;
        if (fan->tried > 1) fan_steps_ += fan->tried * c.size();
        if (c.size() == 4 && c[0] + c[2] == c[1] + c[3])
            dropped_ += add_face(scene_, c[0], c[1], c[2], c[3], m);
        else
            for (size_t i = 1; i + 1 < c.size(); ++i)
                dropped_ += add_triangle(scene_, c[0], c[i], c[i + 1], m);
    }

    // diffuse, phong, mirror, glass, light
    void define(const std::string& keyword) {
        const std::string name = words_[next_++];
        if (material_.contains(name)) throw UserError("a second material " + in_quotes(name));
        Material m;
        if (keyword == "diffuse") {
            m.kd = colour();
        } else if (keyword == "phong") {
            m.kd = colour();
            m.ks = colour();
            m.exponent = number(1e6);
            if (m.exponent < 0) throw UserError("the exponent must not be negative");
        } else if (keyword == "mirror") {
            m.kind = Material::Kind::mirror;
            m.ks = colour();
        } else if (keyword == "glass") {
            m.kind = Material::Kind::glass;
            m.ior = positive("index of refraction");
        } else {
            rgb Le = colour();
            bool twosided = next_ < words_.size() && words_[next_] == "twosided";
            if (twosided) ++next_;
            if (next_ < words_.size()) m = scene_.materials[material()];
            if (next_ < words_.size()) throw UserError("unknown word " + in_quotes(words_[next_]));
            m.Le = Le;
            m.twosided = twosided;
        }
        check_albedo(m.kd + m.ks);
        material_[name] = uint32_t(scene_.materials.size());
        scene_.materials.push_back(m);
        scene_.names.push_back(name);
    }
};

// Throws UserError "NAME:LINE: what is wrong".
inline ParsedScene parse_scene(const std::string& text, const std::string& name) {
    std::istringstream in(text);
    Parser parser(std::filesystem::path(name).parent_path());
    int number = 0;
    try {
        for (std::string line; std::getline(in, line);) parser.statement(line, ++number);
        return parser.finish();
    } catch (const UserError& e) {
        int line = std::max(1, parser.line());
        throw UserError(name + ":" + std::to_string(line) + ": " + e.what());
    }
}

// A scene may come through a pipe, too.
inline ParsedScene read_scene(const std::string& path) {
    ParsedScene parsed = parse_scene(read_file(path, path == "/dev/stdin"), path);
    parsed.files.push_back(path);
    return parsed;
}

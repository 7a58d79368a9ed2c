// text/scene_file.h  9  reading scenes/NAME.scene
#pragma once
#include <map>
#include <set>

#include "path/sampler.h"
#include "text/files.h"
#include "text/grammar.h"
#include "text/mesh.h"
#include "text/scene_check.h"
#include "world/prepare.h"

// A scene, warnings to its author, and the files that it was read from.
struct ParsedScene {
    NamedScene scene;
    std::vector<std::string> warnings, files;
};

// Reads statements one after the other; every error is a UserError without the line number.
class SceneReader {
public:
    // Files are named relative to `folder`.
    explicit SceneReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

    void statement(const Words& words, uint32_t line) {
        words_ = words;
        next_ = 1;
        line_ = line;
        const Statement& statement = statement_of(words);
        if (statement.kind == Statement::setting) set(words[0]);
        if (statement.kind == Statement::material) define(words[0]);
        if (statement.kind == Statement::content) add(words[0]);
        if (scene_.shapes.size() > max_shapes)
            throw UserError("more than " + std::to_string(max_shapes) + " shapes");
        scene_.line_of.resize(scene_.shapes.size(), line);
        scene_.line_of_light.resize(scene_.lights.size(), line);
    }

    // Checks the whole scene.  `name` is the name of the scene's file.
    ParsedScene finish(const std::string& name) {
        NamedScene& s = scene_;
        if (!seen_.contains("camera")) throw UserError(name + ": no camera");
        const std::string dropped = "dropped " + counted(s.dropped, "triangle") + " without area";
        if (s.shapes.empty())
            throw UserError(name +
                            ": empty scene: " + (s.dropped > 0 ? dropped : "it has no shape"));
        auto warn = [&](const std::string& what) { warnings_.push_back(what); };
        if (s.dropped > 0) warn(dropped);
        const std::vector<std::string> moved = Separation(s, name).warnings;
        warnings_.insert(warnings_.end(), moved.begin(), moved.end());
        prepare(s);
        if (const auto on = point_light_on_surface(s))
            throw error_at(
                name, s.line_of_light[on->light],
                "this point light lies on the surface of " + where(s, on->shape) + ": move it off");
        for (const auto& [length, shape] : coarse_lengths(s, !moved.empty()))
            warn(too_coarse(where(s, shape),
                            "ray origins are offset by more than 1 % of this shape's " + length));
        if (s.lights.empty()) warn("no light: the image will be black");
        return {std::move(scene_), std::move(warnings_), std::move(files_)};
    }

private:
    const std::filesystem::path folder_;
    NamedScene scene_;
    std::vector<std::string> warnings_, files_;  // files: of meshes
    std::map<std::string, uint32_t> material_;   // by name
    std::set<std::string> seen_;                 // statements that stand only once
    Words words_;
    size_t next_ = 0;  // word to read
    uint32_t line_ = 0;
    int64_t left_ = 1 << 29;  // tests to cut up polygons: about a second

    // ---- Statements ---------------------------------------------------------------------------

    void set(const std::string& keyword) {
        if (!seen_.insert(keyword).second) throw UserError("a second " + keyword);
        if (keyword == "size") scene_.size = parse_size(words_[1], words_[2]);
        if (keyword == "camera") camera();
        if (keyword == "depth") scene_.depth = int(parse_count(words_[1], 0, max_depth));
        if (keyword == "samples") scene_.samples = parse_count(words_[1], 1, most_samples);
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
            add_sphere(s, centre, r, material());
        } else if (keyword == "triangle") {
            vec3 a = point(), b = point(), c = point();
            add_triangle(s, a, b, c, material());
        } else if (keyword == "quad") {
            vec3 p = point(), u = point(), v = point();
            add_quad(s, p, u, v, material());
        } else if (keyword == "mesh") {
            mesh();
        } else {  // box
            real w = length_of("width"), h = length_of("height"), d = length_of("depth");
            real degrees = number();
            vec3 move = point();
            add_box(s, {w, h, d}, degrees, move, material());
        }
    }

    // ---- Words ----------------------------------------------------------------------------------

    std::string last() const { return in_quotes(words_[next_ - 1]); }  // word read
    real number(double most = largest_number) { return real(parse_number(words_[next_++], most)); }
    real positive(const std::string& what, double most = largest_number) {
        const real x = number(most);
        if (!(x > 0)) throw UserError(what + " must be positive, not " + last());
        return x;
    }
    real length_of(const std::string& what) {
        const real x = positive(what, longest_length);
        if (double(x) < 1 / longest_length) throw UserError(what + " is too small: " + last());
        return x;
    }
    vec3 point() {
        real x = number(longest_length), y = number(longest_length), z = number(longest_length);
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
    uint32_t material() { return look_up(material_, words_[next_++], "material"); }

    void camera() {
        vec3 eye = point(), target = point();
        real fov = number();
        if (!(fov > 0 && fov < 180)) throw UserError("field of view must be between 0 and 180");
        scene_.camera = look_at(eye, target, fov);
        if (!is_finite(scene_.camera.right))
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
        mesh::ObjReader reader(scene_, place, given, line_, left_);
        reader.read(path.string());
        files_.insert(files_.end(), reader.files.begin(), reader.files.end());
        for (const std::string& warning : reader.warnings)
            if (std::ranges::find(warnings_, warning) == warnings_.end())
                warnings_.push_back(warning);
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
            const rgb Le = colour();
            const bool twosided = next_ < words_.size() && words_[next_] == "twosided";
            next_ += twosided;
            if (next_ < words_.size()) m = scene_.materials[material()];
            if (next_ < words_.size()) throw UserError("unknown word " + in_quotes(words_[next_]));
            m.Le = Le;
            m.twosided = twosided;
        }
        if (max_of(m.kd + m.ks) > 1)
            throw UserError("reflects more than it receives: a channel of the albedo exceeds 1");
        material_[name] = uint32_t(scene_.materials.size());
        add_material(scene_, m, name);
    }
};

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
    ParsedScene parsed = parse_scene(read_file(path, path == "/dev/stdin"), path);
    parsed.files.push_back(path);
    return parsed;
}

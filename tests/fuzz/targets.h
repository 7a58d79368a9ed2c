// fuzz/targets.h  what can be fed with any bytes, by its name
//
// A target takes what a program would take from a file or a command line.  A UserError is an
// answer; every other exception, a crash, a hang and a broken demand are bugs.
#pragma once
#include "app/indirect.h"
#include "app/merge.h"
#include "app/option_checks.h"
#include "app/radiosity_options.h"
#include "app/render.h"
#include "fuzz/drawn.h"
#include "fuzz/invariants.h"
#include "world/scene_file.h"

namespace fuzz {

// Whether work(), which a user's mistake may end, was done.
template <class Work>
bool accepted(Work work) {
    try {
        work();
        return true;
    } catch (const UserError& e) {
        demand(e.what()[0] != 0, "a refusal that says nothing");
        return false;
    }
}

// ---- Files --------------------------------------------------------------------------------------

// A scene's text; "=== m.obj" and "=== m.mtl" begin a mesh and its materials.
inline void scene(std::string_view input) {
    const Bundle files = bundle(input, "s.scene");
    write_meshes(files);
    accepted([&] {
        check_scene(parse_scene(std::string(files.at("s.scene")), place() / "s.scene").scene);
    });
}

// A mesh; "=== m.mtl" begins its materials.
inline void obj(std::string_view input) {
    write_meshes(bundle(input, "m.obj"));
    const bool is_mesh = accepted([] { check_mesh(ObjReader::read(place() / "m.obj")); });
    const char* const around =
        "camera 0 0 5  0 0 0  40\ndiffuse grey .5 .5 .5\nmesh m.obj  2  1 0 -1  grey\n";
    const bool is_scene =
        accepted([&] { check_scene(parse_scene(around, place() / "s.scene").scene); });
    demand(is_mesh || !is_scene, "a scene of a mesh that is refused");
}

// An image; it is what its bytes say.
inline void pfm(std::string_view input) {
    place().write("i.pfm", input);
    accepted([&] {
        const Image image = read_pfm(place() / "i.pfm");
        const size_t bytes = image.pixels.size() * sizeof image.pixels[0];
        demand(image.pixels.size() == size_t(image.width) * size_t(image.height) && bytes > 0,
               "an image of another size");
        const std::string again = encode_pfm(image);
        demand(bytes < input.size() &&
                   std::string_view(again).ends_with(input.substr(input.size() - bytes)),
               "an image of other pixels");
    });
}

// ---- Options ------------------------------------------------------------------------------------

// A word a line.
inline std::vector<std::string> words_of(std::string_view input) {
    std::vector<std::string> words;
    for (size_t start = 0; start < input.size() && words.size() < 1000;) {
        const size_t end = std::min(input.find('\n', start), input.size());
        words.emplace_back(input.substr(start, end - start));
        start = end + 1;
    }
    return words;
}

template <class O>
void check_options(const OptionTable<O>& table, const O& o) {
    demand(o.help || !o.scene.empty(), "options without a scene");
    demand(o.threads >= 1 && o.threads <= 1024, "threads that cannot be");
    demand(std::isfinite(o.seconds) && o.seconds >= 0, "a time that cannot be");
    for (const std::string& name : o.outputs)
        demand(name.ends_with(".png") || name.ends_with(".pfm"), "an image of no kind");
    for (const Option<O>& row : table) row.stats(o);
}

inline void options(std::string_view input) {
    const std::vector<std::string> words = words_of(input);
    accepted([&] { check_options(option_table, parse_options(words)); });
    accepted([&] { check_options(radiosity_table, parse_radiosity(words)); });
}

// ---- Images -------------------------------------------------------------------------------------

// Between places on a grid, along axes and not.
inline void check_rays(const Scene& s, Choices c) {
    for (int i = 0; i < 16; ++i) {
        vec3 p[2];
        for (vec3& q : p)
            for (auto k : axis) q.*k = real((double(c.byte()) - 128) / 16);
        if (!(p[0] == p[1])) check_ray(s, {p[0], unit(p[1] - p[0])});
    }
}

// The scene as the options want it, and its image.
inline void render_scene(Scene s, const Options& o, bool moderate) {
    s.size = *o.size;
    s.depth = *o.depth;
    for (Light& l : s.lights) l.by_angle = o.polygons == Polygons::angle;
    try {
        const Job job = job_of(o, s);
        const Rendered r = rendered(job);
        // Variances may be too large for a file: they are refused when they are written.
        if (moderate || o.view != View::variance)
            check_image(r.image, job.part.size(), o.direct == Estimator::stochastic);
    } catch (const SystemError& e) {
        demand(!moderate, e.what());  // a sample that is not finite, and is told
    }
}

// A well-formed scene, by tiny renders.
inline void render(std::string_view input) {
    Drawn d = drawn(input);
    d.options.push_back("s.scene");
    accepted([&] {
        const Options o = parse_options(d.options);
        const Scene s = parse_scene(d.scene, "s.scene").scene;
        check_scene(s);
        check_rays(s, Choices(input));
        render_scene(s, o, d.moderate);
    });
}

// ---- Films --------------------------------------------------------------------------------------

// Films of one small scene, as renders leave them: of means, of means with sets where noise is, of
// direct light, and in the midst of a pass.
struct SmallFilm {
    static constexpr Size size{5, 3};
    static constexpr const char* scene =
        "camera 0 0 5  0 0 0  40\ndepth 2\ndiffuse grey .5 .5 .5\nlight lamp 1 1 1\n"
        "sphere 0 0 0  1  grey\nsphere 2 2 2  .5  lamp\n";
    static constexpr unsigned kinds = 4;

    static Options options(unsigned kind) {
        Options o = parse_options({"--quiet", "--threads", "1", "--spp", kind == 1 ? "17" : "4",
                                   "--light", "nee", "--direct", kind == 2 ? "ratio" : "stochastic",
                                   "--sets", kind == 1 ? "noise" : "2", "s.scene"});
        o.size = size;
        return o;
    }
    static Image render(const Options& o) {
        Scene s = parse_scene(scene, "s.scene").scene;
        s.size = size;
        const Job job = job_of(o, s);
        return rendered(job, identity_of(job, "0123456789abcdef")).image;
    }
    // The file's bytes.
    static std::string make(unsigned kind) {
        Options o = options(kind);
        o.checkpoint = place() / "small.film";
        render(o);
        if (kind == 3) {
            FilmReader file(o.checkpoint);
            auto state = read_film<MeanPixel>(file, o.checkpoint, size);
            state.samples = state.samples_of_others = 3;
            state.pass = 1;
            state.ahead.assign(state.ahead.size(), 1);
            state.image.pixels.assign(state.first.size(), {0, 0, 0});
            write_film(o.checkpoint, file.header(), state);
        }
        return read_file(o.checkpoint);
    }
};
inline const std::string& small_film(unsigned kind) {
    static std::string films[SmallFilm::kinds];
    if (films[kind].empty()) films[kind] = SmallFilm::make(kind);
    return films[kind];
}

// Bytes changed, inserted or left out, or the end.
inline std::string edited(std::string bytes, Choices& c) {
    while (!c.empty()) {
        const unsigned edit = c.byte();
        const size_t high = c.byte(), at = std::min(bytes.size(), high << 8 | c.byte());
        const unsigned value = c.byte();
        if (edit < 128 && at < bytes.size()) bytes[at] = char(bytes[at] ^ char(value));
        if (edit >= 128 && edit < 160) bytes.insert(at, 1 + edit % 16, char(value));
        if (edit >= 160 && edit < 192) bytes.erase(at, 1 + edit % 16);
        if (edit >= 192 && edit < 208) bytes.resize(at);
    }
    return bytes;
}

// With a length and a sum that are right.
inline void write_forged(const std::string& name, const std::string& bytes) {
    const size_t end = std::min(bytes.find("\n\n"), bytes.size());
    FilmHeader header;
    for (size_t line = 0, start = 0; start < end; ++line) {
        const size_t stop = std::min(bytes.find('\n', start), end);
        const std::string text = bytes.substr(start, stop - start);
        const size_t space = std::min(text.find(' '), text.size());
        if (line >= 3)  // the first are the writer's
            header.set(text.substr(0, space), text.substr(std::min(space + 1, text.size())));
        start = stop + 1;
    }
    FilmWriter file(name, header);
    const size_t numbers = std::min(end + 2, bytes.size());
    file.append(bytes.data() + numbers, bytes.size() - numbers);
    file.commit();
}

// A render that goes on from the file, as penumbra does.
inline void go_on(const std::string& name, unsigned kind) {
    Options o = SmallFilm::options(kind);
    o.resume = name;
    SmallFilm::render(o);
}

// A picture of that film alone, as merge does.
inline void merge_alone(const std::string& name, unsigned kind) {
    const std::vector<Band> bands = bands_of({name});
    const Size size = bands.front().front().picture;
    auto row = [&](int y, const auto& pixels) {
        demand(y < size.height && int(pixels.size()) == size.width, "a row of another picture");
    };
    if (kind == 2)
        merge<ShadowPixel>(bands, {Estimator::ratio}, Shows::values, row);
    else
        merge<MeanPixel>(bands, {}, Shows::values, row);
}

// The first byte says of which film; then edits of it: one that is not the same is refused, one
// whose sum is forged is what it says.
inline void film(std::string_view input) {
    Choices c(input);
    const unsigned first = c.byte(), kind = first % SmallFilm::kinds;
    const std::string bytes = edited(small_film(kind), c);
    const std::string name = place() / "f.film";
    if (first < 128) {
        place().write("f.film", bytes);
        const bool is_taken = accepted([&] { go_on(name, kind); });
        accepted([&] { merge_alone(name, kind); });
        demand(is_taken == (bytes == small_film(kind)),
               "a damaged film is taken, or a good one not");
    } else if (accepted([&] { write_forged(name, bytes); })) {
        accepted([&] { go_on(name, kind); });
        accepted([&] { merge_alone(name, kind); });
    }
}

// ---- All of them --------------------------------------------------------------------------------

struct Target {
    const char* name;
    void (*run)(std::string_view);
    unsigned share;  // of the time, in hundredths
};
inline constexpr Target targets[] = {
    {"scene", scene, 25},     {"obj", obj, 20},   {"pfm", pfm, 5},
    {"options", options, 10}, {"film", film, 10}, {"render", render, 30},
};

inline const Target* find(std::string_view name) {
    for (const Target& t : targets)
        if (t.name == name) return &t;
    return nullptr;
}

}  // namespace fuzz

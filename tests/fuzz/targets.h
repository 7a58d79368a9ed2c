// fuzz/targets.h  fuzzing targets for arbitrary bytes, by their names
//
// A target gets what a program would read from a file or a command line.  A UserError is a valid
// answer; every other exception, a crash, a hang and a violated invariant are bugs.
#pragma once
#include "app/render.h"
#include "fuzz/drawn.h"
#include "fuzz/invariants.h"
#include "keep/keep.h"
#include "keep/read_pfm.h"
#include "text/scene_file.h"

namespace penumbra::fuzz {

// Whether work() completed; a user's mistake may end it.
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
inline const char* const around_mesh =
    "camera 0 0 5  0 0 0  40\ndiffuse grey .5 .5 .5\nmesh m.obj  2  1 0 -1  grey\n";
inline void obj(std::string_view input) {
    write_meshes(bundle(input, "m.obj"));
    accepted([&] { check_scene(parse_scene(around_mesh, place() / "s.scene").scene); });
}

// An image; its pixels must match its bytes.
inline void pfm(std::string_view input) {
    place().write("i.pfm", input);
    accepted([&] {
        const Image image = read_pfm(place() / "i.pfm");
        const size_t bytes = image.pixels.size() * sizeof image.pixels[0];
        demand(image.pixels.size() == size_t(image.width) * size_t(image.height) && bytes > 0,
               "an image of another size");
        demand(bytes < input.size(), "an image of more pixels");
        const char* rows = input.data() + (input.size() - bytes);
        const size_t row = bytes / size_t(image.height);
        for (int y = image.height - 1; y >= 0; --y, rows += row)
            demand(std::memcmp(rows, &image.at(0, y), row) == 0, "an image of other pixels");
    });
}

// ---- Options ------------------------------------------------------------------------------------

// Splits text into one word per line.
inline std::vector<std::string> words_of(std::string_view input) {
    std::vector<std::string> words;
    std::istringstream in{std::string(input)};
    for (std::string word; words.size() < 1000 && std::getline(in, word);) words.push_back(word);
    return words;
}

inline void check_options(const OptionTable& table, const Options& o) {
    demand(o.help || !o.scene.empty(), "options without a scene");
    demand(o.threads >= 1 && o.threads <= 1024, "threads that cannot be");
    demand(std::isfinite(o.seconds) && o.seconds >= 0, "a time that cannot be");
    for (const std::string& name : o.outputs)
        demand(name.ends_with(".png") || name.ends_with(".pfm") || name.ends_with(".hdr"),
               "an image of no kind");
    for (const Option& row : table)
        if (row.json) demand(!row.json().empty(), "an option without a value in JSON");
}

inline void options(std::string_view input) {
    Options o;
    OptionTable table = option_table(o);
    accepted([&] {
        parse_options(table, o, words_of(input));
        check_options(table, o);
    });
}

// ---- Images -------------------------------------------------------------------------------------

// Rays between points on a grid, also along axes.
inline void check_rays(const Scene& s, Choices c) {
    for (int i = 0; i < 16; ++i) {
        vec3 p[2];
        for (vec3& q : p)
            for (auto k : axis) q.*k = real((double(c.byte()) - 128) / 16);
        if (!(p[0] == p[1])) check_ray(s, {p[0], unit(p[1] - p[0])});
    }
}

inline SampleFunction radiance_of(const Scene& s, const Options& o, const SamplerSettings& p) {
    return [&, far = far_of(s)](const PixelSample& at, Tally& tally) {
        const Start begin = start(s, p, at);
        if (o.view.of) return ++tally.rays, o.view.of({s, begin, meet(s, begin.ray), far});
        return Li(s, o.technique, begin.ray, begin.sampler);
    };
}

// Renders the scene with the options, and checks its image.
inline void render_scene(Scene s, const Options& o, bool moderate) {
    s.size = *o.size;
    s.depth = *o.depth;
    try {
        const Plan plan = plan_of(o, s);
        const SamplerSettings p = sampler_settings(o.sampler, o.seed, s.depth);
        const SampleFunction L = radiance_of(s, o, p);
        check_image(render(o, plan, L).image, plan.size, true);
    } catch (const SystemError& e) {
        demand(!moderate, e.what());  // a reported non-finite sample
    }
}

// Renders a well-formed scene at tiny sizes.
inline void render(std::string_view input) {
    Drawn d = drawn(input);
    d.options.push_back("s.scene");
    accepted([&] {
        Options o;
        OptionTable table = option_table(o);
        parse_options(table, o, d.options);
        const NamedScene s = parse_scene(d.scene, "s.scene").scene;
        check_scene(s);
        check_rays(s, Choices(input));
        render_scene(s, o, d.moderate);
    });
}

// ---- Films --------------------------------------------------------------------------------------

// Films of one small scene as renders leave them: complete ones with fixed and with adaptive
// replications, and checkpoints within a pass and within the pilot.
class SmallFilm {
public:
    static constexpr unsigned kinds = 4;
    static constexpr Size size{5, 3};

    explicit SmallFilm(unsigned kind) : kind_(kind), p_(sampler_settings(o_.sampler, 0, 2)) {
        s_ = parse_scene(text, "s.scene").scene;
        s_.size = size;
        o_.quiet = true, o_.threads = 1;
        o_.spp = is_adaptive() ? 80 : 4, o_.replications = is_adaptive() ? 0 : 2;
    }

    // Resumes the file as penumbra does.
    void go_on(const std::string& name) {
        o_.keep = name;
        demand(render(o_, plan(), L_, what()).not_kept.empty(), "a film that is not kept");
    }
    void make(const std::string& name) {
        if (kind_ < 2) return go_on(name);
        Film f = film_for(plan());
        Tally tally;
        tally.near.resize(f.near.size());
        for (size_t b = 0; b < f.blocks() / 2; ++b) add_samples(f, b, 2, L_, tally);
        demand(Keeper(name, what()).write(f, {1, 1, tally.rays}, false).empty(),
               "no film is written");
    }

private:
    static constexpr const char* text =
        "camera 0 0 5  0 0 0  40\ndepth 2\ndiffuse grey .5 .5 .5\nlight lamp 1 1 1\n"
        "sphere 0 0 0  1  grey\nsphere 2 2 2  .5  lamp\n";
    const unsigned kind_;
    Options o_;
    Scene s_;
    const SamplerSettings p_;
    const SampleFunction L_ = radiance_of(s_, o_, p_);

    bool is_adaptive() const { return kind_ % 2 == 1; }
    // With a group of lights.
    Plan plan() const {
        Plan p = plan_of(o_, s_);
        p.near.resize(1);
        return p;
    }
    FilmOf what() const {
        const std::string K = is_adaptive() ? "adaptive" : "2";
        return {{}, {{"size", "5x3"}, {"replications", K}, {"rows", "0-2"}}, {}};
    }
};
inline const std::string& small_film(unsigned kind) {
    static std::string films[SmallFilm::kinds];
    if (films[kind].empty()) {
        const std::string name = place() / ("small" + std::to_string(kind) + ".film");
        SmallFilm(kind).make(name);
        films[kind] = read_file(name);
    }
    return films[kind];
}

// Changes, inserts or removes bytes, or cuts the end.
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

// Writes the bytes with a correct length and checksum.
inline void write_forged(const std::string& name, const std::string& bytes) {
    const size_t end = std::min(bytes.find("\n\n"), bytes.size());
    Facts head;
    std::istringstream lines(bytes.substr(0, end));
    std::string line;
    for (int i = 0; std::getline(lines, line); ++i) {
        const size_t space = std::min(line.find(' '), line.size());
        if (i >= 3)  // the writer adds the first ones
            head.push_back({line.substr(0, space), line.substr(std::min(space + 1, line.size()))});
    }
    const size_t numbers = std::min(end + 2, bytes.size());
    write_film_file(name, head, {std::as_bytes(std::span(bytes).subspan(numbers))});
}

// Merges only that film, as merge does.
inline void merge_alone(const std::string& name) {
    const FilmReader file(name);
    const Size size{int(file.number("size", 65536)), int(file.number("size", 65536, 'x'))};
    const double last = file.number("rows", size.height - 1, '-');
    FilmPixels film(name, {size.width, int(last - file.number("rows", last)) + 1});
    ImageError e;
    for (int i = 0; i < size.width * int(last + 1 - file.number("rows", last)); ++i) {
        Pixel p;
        film.add_next(p);
        e.add(p);
    }
    spent_in(file);
    doubt_of(film.film(), e, {});
}

// The first byte selects a film; the others edit it.  An edited film must be refused, except when a
// forged checksum makes it a valid other film.
inline void film(std::string_view input) {
    Choices c(input);
    const unsigned first = c.byte(), kind = first % SmallFilm::kinds;
    const std::string bytes = edited(small_film(kind), c);
    const std::string name = place() / "f.film";
    if (first < 128)
        place().write("f.film", bytes);
    else
        write_forged(name, bytes);
    accepted([&] { merge_alone(name); });
    const bool is_taken = accepted([&] { SmallFilm(kind).go_on(name); });
    demand(first >= 128 || is_taken == (bytes == small_film(kind)),
           "a damaged film is taken, or a good one not");
}

// ---- Lights in other surfaces -------------------------------------------------------------------

// The mean radiance of a picture, by independent paths.
inline Moments mean_radiance(const Scene& s, LightMode mode, uint64_t paths) {
    const SamplerSettings p{SamplerKind::independent, uint64_t(mode)};
    Moments m;
    for (uint64_t i = 0; i < paths; ++i) {
        const Start at = start(s, p, {int(i % 8), int(i / 8 % 8), i / 64});
        m.add(double(mean_of(Li(s, {Direction::bsdf, mode, 0}, at.ray, at.sampler))));
    }
    return m;
}

// All light modes must give the same light.  Light samples in corners have rare large values, and
// their sample variance underestimates the error.
inline void lamps(std::string_view input) {
    Choices c(input);
    const std::string text = drawn_lamps(c);
    NamedScene s = parse_scene(text, "s.scene").scene;
    s.size = {8, 8};
    check_scene(s);
    const Moments hit = mean_radiance(s, LightMode::none, 4096);
    for (const LightMode mode : {LightMode::nee, LightMode::mis}) {
        const Moments m = mean_radiance(s, mode, 4096);
        const double error = std::hypot(m.standard_error(), hit.standard_error());
        const double room = mode == LightMode::nee ? 0.05 * hit.mean : 0;
        demand(std::abs(m.mean - hit.mean) <= 8 * error + room,
               "light modes that disagree: " + std::to_string(m.mean) + " for " +
                   std::to_string(hit.mean) + " +- " + std::to_string(error) + " in\n" + text);
    }
}

struct Target {
    const char* name;
    void (*run)(std::string_view);
    unsigned share;  // of the time, in hundredths
};
inline constexpr Target targets[] = {
    {"scene", scene, 25}, {"obj", obj, 20},       {"pfm", pfm, 5},      {"options", options, 10},
    {"film", film, 10},   {"render", render, 20}, {"lamps", lamps, 10},
};

inline const Target* find(std::string_view name) {
    for (const Target& t : targets)
        if (t.name == name) return &t;
    return nullptr;
}

}  // namespace penumbra::fuzz

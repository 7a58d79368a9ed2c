// labs/trade_runs.h  4  what is rendered for a trade: scenes, settings, runs and their seconds
#pragma once
#include <optional>

#include "app/render.h"
#include "labs/lab.h"
#include "labs/trade_data.h"
#include "world/scene_file.h"

namespace trade {

inline std::vector<std::string> words_of(const std::string& line) {
    std::istringstream in(line);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

// ---- Scenes -------------------------------------------------------------------------------------

// A scene, and what of it is measured: some rows of its image, or all of it; all else as in its
// file, but where all is diffuse light is scattered without end, so that paths and maps have one
// truth.
struct Ground {
    std::string name;
    Scene scene;
    int rows = 0;  // 0: all
    bool diffuse = true, point_lights = false;
    std::optional<double> H = {};           // longest edge of maps' triangles, if diffuse
    std::vector<std::string> faceted = {};  // warnings about what maps change

    std::string file() const { return "scenes/" + name + ".scene"; }
    // The image's pixels over those measured.
    double scale() const { return rows ? double(scene.size.height) / rows : 1; }
};

// (3/4)^64 = 1e-8 of the light is left.
inline constexpr int without_end = 64;

inline Ground ground_of(const std::string& name, int rows) {
    Ground g{name, {}, rows};
    g.scene = read_scene(g.file()).scene;
    Scene& s = g.scene;
    for (const Light& l : s.lights) g.point_lights |= l.kind == Light::Kind::point;
    for (size_t i = 0; i < s.shapes.size(); ++i)
        g.diffuse &= !other_than_diffuse(s.materials[s.material_of[i]]);
    if (!g.diffuse) return g;
    s.depth = without_end;
    g.H = edge_length(g.file(), s, {}, 16, Particles::bytes());
    g.faceted = faceted(s, *g.H).warnings;
    return g;
}

// Row y of the image, as an image of its own: the same pixels, for a camera's forward need not be
// of length 1.
inline Scene row_of(const Scene& whole, int y) {
    Scene row = whole;
    Camera& c = row.camera;
    const double height = whole.size.height;
    c.forward += c.up * real((height - 1 - 2 * y) / height * double(c.tan_half));
    c.tan_half /= real(height);
    row.size.height = 1;
    return row;
}

// All, or rows at even distances, each from the middle of its part of the image.
inline std::vector<Scene> parts_of(const Scene& whole, int rows) {
    if (rows == 0) return {whole};
    std::vector<Scene> parts;
    for (int k = 0; k < rows; ++k)
        parts.push_back(row_of(whole, (2 * k + 1) * whole.size.height / (2 * rows)));
    return parts;
}

// ---- Settings -----------------------------------------------------------------------------------

inline std::vector<std::string> values_of(const std::string& option) {
    std::vector<std::string> values;
    for (const auto& row : option_table)
        if (row.name == option)
            for (const std::string_view word : option::words_of(row.value))
                values.emplace_back(word);
    return values;
}

// "--sampler sobol --light mis", and whatever else is not the default.
inline std::string written(const Options& o) {
    std::string words =
        as_written(option_table, o, "--sampler") + " " + as_written(option_table, o, "--light");
    for (const char* name : {"--direct", "--indirect"})
        if (const std::string own = as_written(option_table, o, name);
            own != as_written(option_table, Options{}, name))
            words += " " + own;
    return words;
}

// What the renderer makes of these words for this scene; nothing if it refuses them.
inline std::optional<Options> options_of(const Ground& g, const std::string& line) {
    std::vector<std::string> words = words_of(line);
    words.push_back(g.file());
    try {
        Options o = parse_options(words);
        const bool lesson = o.sampler == SamplerKind::halton_naive;  // by paths is enough
        if (lesson && (has_maps(o) || o.direct != Estimator::stochastic)) return {};
        if (has_maps(o) && !g.diffuse) return {};
        if (g.point_lights && o.technique.light == LightMode::none) return {};
        return o;
    } catch (const UserError&) {
        return {};
    }
}

inline TradeSetting setting_of(const Ground& g, const Options& o, bool is_float) {
    TradeSetting s{written(o), is_float};
    s.unbiased = o.sampler != SamplerKind::halton_naive && !estimates_pixels(o.direct) &&
                 o.indirect != Indirect::map && (!has_maps(o) || g.faceted.empty());
    s.takes_every_scene = !has_maps(o) && o.technique.light != LightMode::none;
    return s;
}

// All samplers x --light x --direct x --indirect that the scene allows.
inline std::vector<TradeSetting> settings_of(const Ground& g, bool is_float) {
    std::vector<TradeSetting> all;
    for (const std::string& indirect : values_of("--indirect"))
        for (const std::string& direct : values_of("--direct"))
            for (const std::string& light : values_of("--light"))
                for (const std::string& sampler : values_of("--sampler"))
                    if (const auto o =
                            options_of(g, "--sampler " + sampler + " --light " + light +
                                              " --direct " + direct + " --indirect " + indirect))
                        all.push_back(setting_of(g, *o, is_float));
    return all;
}

// ---- Runs ---------------------------------------------------------------------------------------

struct Task {
    std::string words;
    uint64_t spp = 1, seed = 0;
};

// An image, and core seconds: of maps, whatever the number of pixels, and of the pixels.
struct Taken {
    Image image = {};
    double fixed = 0, seconds = 0;
    double of_whole(const Ground& g) const { return fixed + g.scale() * seconds; }
};

// An image below others of its width.
inline void append(Image& image, const Image& below) {
    image.width = below.width, image.height += below.height;
    image.pixels.insert(image.pixels.end(), below.pixels.begin(), below.pixels.end());
}

// Renders tasks one after the other on all cores, as the program does.
class Renderer {
public:
    explicit Renderer(const Ground& g) : g_(g), parts_(parts_of(g.scene, g.rows)) {}

    Taken operator()(const Task& task) {
        Options o = parse_options(all_words(task));
        if (has_maps(o)) return by_maps(o);
        return images(o, parts_, [](const Options& own, const Scene& part) {
            return rendered(job_of(own, part)).image;
        });
    }

private:
    // Of as many particles as the whole image has: samplers share them.
    struct Known {
        std::string of;
        std::vector<Scene> parts;
        Maps maps;
        double seconds = 0;
    };
    const Ground& g_;
    const std::vector<Scene> parts_;
    std::optional<Known> known_;

    std::vector<std::string> all_words(const Task& task) const {
        std::vector<std::string> words = words_of(task.words);
        for (const std::string& word :
             {std::string("--quiet"), std::string("--spp"), std::to_string(task.spp),
              std::string("--seed"), std::to_string(task.seed), g_.file()})
            words.push_back(word);
        return words;
    }

    // The parts at once, each on one core and with numbers of its own.
    template <class Render>
    static Taken images(const Options& o, const std::vector<Scene>& parts, Render render) {
        const double before = processor_seconds();
        std::vector<Image> of(parts.size());
        auto part = [&](int k) {
            Options own = o;
            if (parts.size() > 1) own.threads = 1, own.seed = hash(o.seed, uint64_t(k));
            of[size_t(k)] = render(own, parts[size_t(k)]);
        };
        if (parts.size() == 1)
            part(0);
        else
            parallel_rows(int(parts.size()), all_cores(), part, [](double) {});
        Taken taken;
        taken.seconds = processor_seconds() - before;
        for (const Image& image : of) append(taken.image, image);
        return taken;
    }

    Taken by_maps(Options& o) {
        o.mesh = g_.H;
        o.particles = walks_of(o, g_.scene).particles;
        const std::string of = as_written(option_table, o, "--indirect") +
                               as_written(option_table, o, "--light") + std::to_string(o.seed) +
                               " " + std::to_string(o.spp);
        if (!known_ || known_->of != of) fill(of, o);
        Taken taken = images(o, known_->parts, [&](const Options& own, const Scene& part) {
            return rendered(job_of(own, part, known_->maps)).image;
        });
        taken.fixed = known_->seconds;
        return taken;
    }

    void fill(const std::string& of, const Options& o) {
        const double before = processor_seconds();
        const Scene scene = endless(g_.scene, *o.mesh).scene;
        Maps maps = maps_of(o, scene);
        const double seconds = processor_seconds() - before;
        known_.reset();
        known_.emplace(Known{of, parts_of(scene, g_.rows), std::move(maps), seconds});
    }
};

// All in this precision.  What is not measured comes first, so that the first does not find the
// machine cold.
inline std::vector<Taken> rendered_here(const Ground& g, const std::vector<Task>& tasks) {
    Renderer render(g);
    std::vector<Taken> all;
    if (!tasks.empty()) render({tasks[0].words, 1, tasks[0].seed});
    for (const Task& task : tasks) all.push_back(render(task));
    return all;
}

// ---- The other precision ------------------------------------------------------------------------

// The lab itself, built with other numbers, renders what a file lists: the scene and its rows,
// then a task a row.  It writes FILE.K.pfm, and FILE.seconds.
inline std::string encode_tasks(const Ground& g, const std::vector<Task>& tasks) {
    std::string list = text("%s %d\n", g.name, g.rows);
    for (const Task& t : tasks)
        list += std::to_string(t.spp) + " " + std::to_string(t.seed) + " " + t.words + "\n";
    return list;
}

inline void render_listed(const std::string& file) {
    std::istringstream list(read_file(file));
    std::string name, words, seconds;
    int rows = 0;
    list >> name >> rows;
    const Ground g = ground_of(name, rows);
    std::vector<Task> tasks;
    for (Task t; list >> t.spp >> t.seed && std::getline(list, t.words);) tasks.push_back(t);
    const std::vector<Taken> all = rendered_here(g, tasks);
    for (size_t k = 0; k < all.size(); ++k) {
        write_file(text("%s.%zu.pfm", file, k), encode_pfm(all[k].image));
        seconds += text("%.17g %.17g\n", all[k].fixed, all[k].seconds);
    }
    write_file(file + ".seconds", seconds);
}

// All by `program`, in the folder out/.
inline std::vector<Taken> rendered_by(const std::string& program, const Ground& g,
                                      const std::vector<Task>& tasks) {
    std::vector<Taken> all(tasks.size());
    if (tasks.empty()) return all;
    const std::string file = "out/trade" + std::to_string(::getpid());
    write_file(file, encode_tasks(g, tasks));
    execute({program, "--render", file});
    std::istringstream seconds(read_file(file + ".seconds"));
    for (size_t k = 0; k < all.size(); ++k) {
        const std::string pfm = text("%s.%zu.pfm", file, k);
        all[k].image = read_pfm(pfm);
        seconds >> all[k].fixed >> all[k].seconds;
        std::filesystem::remove(pfm);
    }
    std::filesystem::remove(file);
    std::filesystem::remove(file + ".seconds");
    return all;
}

}  // namespace trade

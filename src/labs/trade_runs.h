// labs/trade_runs.h  4  what is rendered for a trade: scenes, settings, runs and their seconds
#pragma once
#include <optional>

#include "app/option_checks.h"
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

// A scene as it is measured: as in its file, or some times narrower and lower; but where all is
// diffuse light is scattered without end, so that paths and maps have one truth.
struct Ground {
    std::string name;
    Scene scene;
    int part = 1;
    bool diffuse = true, point_lights = false;
    std::optional<double> H = {};           // longest edge of maps' triangles, if diffuse
    std::vector<std::string> faceted = {};  // warnings about what maps change

    std::string file() const { return "scenes/" + name + ".scene"; }
};

// (3/4)^64 = 1e-8 of the light is left.
inline constexpr int without_end = 64;

inline Ground ground_of(const std::string& name, int part) {
    Ground g{name, {}, part};
    g.scene = read_scene(g.file()).scene;
    Scene& s = g.scene;
    s.size = {std::max(1, s.size.width / part), std::max(1, s.size.height / part)};
    for (const Light& l : s.lights) g.point_lights |= l.kind == Light::Kind::point;
    for (size_t i = 0; i < s.shapes.size(); ++i)
        g.diffuse &= !other_than_diffuse(s.materials[s.material_of[i]]);
    if (!g.diffuse) return g;
    s.depth = without_end;
    g.H = edge_length(g.file(), s, {}, 16, Particles::bytes());
    g.faceted = faceted(s, *g.H).warnings;
    return g;
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
    for (const char* name : {"--direct", "--indirect", "--sets"})
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

// All samplers x --light x --direct x --indirect that the scene allows, and the default without
// more samples where noise is.
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
    if (const auto o = options_of(g, "--sets 1")) all.push_back(setting_of(g, *o, is_float));
    return all;
}

// ---- Runs ---------------------------------------------------------------------------------------

struct Task {
    std::string words;
    uint64_t spp = 1, seed = 0;
};

// An image, and core seconds: of maps, and of the rest.
struct Taken {
    Image image = {};
    double maps = 0, rest = 0;
    double seconds() const { return maps + rest; }
};

// Renders tasks one after the other on all cores, as the program does.
class Renderer {
public:
    explicit Renderer(const Ground& g) : g_(g) {}

    Taken operator()(const Task& task) {
        Options o = parse_options(all_words(task));
        if (!has_maps(o)) return timed([&] { return rendered(job_of(o, g_.scene)).image; });
        o.mesh = g_.H;
        const std::string of = as_written(option_table, o, "--indirect") +
                               as_written(option_table, o, "--light") + std::to_string(o.seed) +
                               " " + std::to_string(o.spp);
        if (!known_ || known_->of != of) fill(of, o);
        Taken taken = timed([&] { return rendered(job_of(o, known_->scene, known_->maps)).image; });
        taken.maps = known_->seconds;
        return taken;
    }

private:
    // Samplers share maps, each of which is charged for them.
    struct Known {
        std::string of;
        Scene scene;
        Maps maps;
        double seconds = 0;
    };
    const Ground& g_;
    std::optional<Known> known_;

    std::vector<std::string> all_words(const Task& task) const {
        std::vector<std::string> words = words_of(task.words);
        for (const std::string& word :
             {std::string("--quiet"), std::string("--spp"), std::to_string(task.spp),
              std::string("--seed"), std::to_string(task.seed), g_.file()})
            words.push_back(word);
        return words;
    }

    template <class Render>
    static Taken timed(Render render) {
        const double before = processor_seconds();
        Taken taken{render()};
        taken.rest = processor_seconds() - before;
        return taken;
    }

    void fill(const std::string& of, const Options& o) {
        const double before = processor_seconds();
        Scene scene = endless(g_.scene, *o.mesh).scene;
        Maps maps = maps_of(o, scene);
        const double seconds = processor_seconds() - before;
        known_.reset();
        known_.emplace(Known{of, std::move(scene), std::move(maps), seconds});
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

// The lab itself, built with other numbers, renders what a file lists: the scene and its part,
// then a task a row.  It writes FILE.K.pfm, and FILE.seconds.
inline std::string encode_tasks(const Ground& g, const std::vector<Task>& tasks) {
    std::string list = text("%s %d\n", g.name, g.part);
    for (const Task& t : tasks)
        list += std::to_string(t.spp) + " " + std::to_string(t.seed) + " " + t.words + "\n";
    return list;
}

inline void render_listed(const std::string& file) {
    std::istringstream list(read_file(file));
    std::string name, words, seconds;
    int part = 1;
    list >> name >> part;
    const Ground g = ground_of(name, part);
    std::vector<Task> tasks;
    for (Task t; list >> t.spp >> t.seed && std::getline(list, t.words);) tasks.push_back(t);
    const std::vector<Taken> all = rendered_here(g, tasks);
    for (size_t k = 0; k < all.size(); ++k) {
        write_file(text("%s.%zu.pfm", file, k), encode_pfm(all[k].image));
        seconds += text("%.17g %.17g\n", all[k].maps, all[k].rest);
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
        seconds >> all[k].maps >> all[k].rest;
        std::filesystem::remove(pfm);
    }
    std::filesystem::remove(file);
    std::filesystem::remove(file + ".seconds");
    return all;
}

}  // namespace trade

// labs/trade_runs.h  4  what is rendered for a trade: scenes, settings, runs and their seconds
#pragma once
#include <optional>

#include "labs/films.h"
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

// A scene as it is measured: as in its file, or some times narrower and lower.
struct Ground {
    std::string name;
    Scene scene;
    int part = 1;
    bool point_lights = false;

    std::string file() const { return "scenes/" + name + ".scene"; }
};

inline Ground ground_of(const std::string& name, int part) {
    Ground g{name, {}, part};
    g.scene = read_scene(g.file()).scene;
    Scene& s = g.scene;
    s.size = {std::max(1, s.size.width / part), std::max(1, s.size.height / part)};
    for (const Light& l : s.lights) g.point_lights |= l.kind == Light::Kind::point;
    return g;
}

// ---- Settings -----------------------------------------------------------------------------------

inline std::vector<std::string> values_of(const std::string& option) {
    Options o;
    OptionTable table = option_table(o);
    std::vector<std::string> values;
    for (const Text word : ::words_of(row(table, option).value)) values.emplace_back(word);
    return values;
}

// The default.
inline std::string default_words() {
    Options o;
    OptionTable table = option_table(o);
    return "--sampler " + row(table, "--sampler").otherwise + " --light " +
           row(table, "--light").otherwise;
}

inline Options options_of(const std::string& line) {
    Options o;
    OptionTable table = option_table(o);
    parse_words(table, words_of(line),
                [](const std::string& word) { throw UserError(in_quotes(word)); });
    return o;
}

// All samplers x --light that the scene allows, and the default without more samples where noise
// is.
inline std::vector<TradeSetting> settings_of(const Ground& g, bool is_float) {
    std::vector<TradeSetting> all;
    for (const std::string& light : values_of("--light"))
        for (const std::string& sampler : values_of("--sampler"))
            if (!g.point_lights || light != "none") {
                all.push_back({"--sampler " + sampler + " --light " + light, is_float});
                all.back().takes_every_scene = light != "none";
            }
    all.push_back({default_words() + " --sets 1", is_float});
    return all;
}

// ---- Runs ---------------------------------------------------------------------------------------

struct Task {
    std::string words;
    uint64_t spp = 1, seed = 0;
};

// An image, and core seconds.
struct Taken {
    Image image = {};
    double seconds = 0;
};

// By all cores.
inline Taken taken_by(const Ground& g, const Task& task) {
    Options o = options_of(task.words);
    o.spp = task.spp, o.seed = task.seed;
    const double before = processor_seconds();
    Taken taken{rendered(g.scene, o)};
    taken.seconds = processor_seconds() - before;
    return taken;
}

// All in this precision.  What is not measured comes first, so that the first does not find the
// machine cold.
inline std::vector<Taken> rendered_here(const Ground& g, const std::vector<Task>& tasks) {
    std::vector<Taken> all;
    if (!tasks.empty()) taken_by(g, {tasks[0].words, 1, tasks[0].seed});
    for (const Task& task : tasks) all.push_back(taken_by(g, task));
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
        write_image(text("%s.%zu.pfm", file, k), all[k].image, 1);
        seconds += text("%.17g\n", all[k].seconds);
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
        seconds >> all[k].seconds;
        std::filesystem::remove(pfm);
    }
    std::filesystem::remove(file);
    std::filesystem::remove(file + ".seconds");
    return all;
}

}  // namespace trade

// app/checkpoints.h  7  what a run leaves to go on from: when, and what it says of itself
#pragma once
#include "app/job.h"
#include "film/checkpoint.h"

// ---- What a film is of --------------------------------------------------------------------------

// A sum over what the scene was read from.
inline std::string sum_of_files(const std::vector<std::string>& files) {
    Checksum sum;
    for (const std::string& file : files) {
        const std::string bytes = read_file(file);
        sum.add(bytes.data(), bytes.size());
        const uint64_t size = bytes.size();
        sum.add(&size, sizeof size);
    }
    char text[20];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sum.value()));
    return text;
}

// Options on which samples depend, but for the size and the part.
inline constexpr std::array options_of_samples = {
    "--sampler",  "--sets", "--direction", "--light", "--direct", "--polygons",
    "--indirect", "--pick", "--seed",      "--view",  "--film"};

inline constexpr const char* precision = sizeof(real) == 4 ? "float" : "double";

// All that two films must share to be of one picture, and their parts of it.  What follows from the
// samples of the picture is here, if samples depend on it.
inline FilmHeader identity_of(const Job& job, const std::string& sum_of_scene) {
    const Options& o = job.o;
    FilmHeader h;
    auto exact = [](double x) {
        char text[32];
        std::snprintf(text, sizeof text, "%.17g", x);
        return std::string(text);
    };
    h.set("scene", sum_of_scene);
    h.set("precision", precision);
    h.set("size",
          std::to_string(job.part.picture.width) + "x" + std::to_string(job.part.picture.height));
    for (const char* name : options_of_samples)
        h.set(name + 2, as_written(option_table, o, name).substr(std::strlen(name) + 1));
    h.set("roulette", exact(double(o.technique.roulette)));
    set_count(h, "depth", uint64_t(job.scene.depth));
    if (o.sampler == SamplerKind::stratified)
        h.set("grid", std::to_string(job.pattern.columns) + "x" + std::to_string(job.pattern.rows));
    if (o.film != Weighting::mc) set_count(h, "weights", job.part.total);
    if (job.maps) {
        h.set("mesh", exact(*o.mesh));
        set_count(h, "particles", walks_of(o, job.scene).particles);
    }
    h.set("rows", as_text(job.part.row_range()));
    h.set("samples", o.samples ? as_text(*o.samples) : "all");
    if (o.samples) set_count(h, "spp", job.part.total);
    return h;
}

// Throws UserError, by the first line that differs: `header` has to begin with what is expected.
// `as` says of what that is: "", or " as in a.film".
inline void check_identity(const std::string& path, const FilmHeader& header,
                           const FilmHeader& expected, const std::string& as = "") {
    for (const auto& [key, value] : expected.entries) {
        const std::string its = header.find(key).value_or("not known");
        if (its == value) continue;
        if (key == "scene") throw UserError(path + ": its scene is another one");
        std::string why = path + ": its " + key + " is " + its + ", not " + value + as;
        if (key == "grid" || key == "weights" || key == "particles") why += " (as --spp has it)";
        throw UserError(why);
    }
}

// ---- What was measured so far -------------------------------------------------------------------

inline void set_run(FilmHeader& h, const RunStats& run, bool complete) {
    h.set("complete", complete ? "yes" : "no");
    h.set("seconds", json::number(run.seconds));
    h.set("cpu-seconds", json::number(run.cpu_seconds));
    set_count(h, "rays", run.rays);
    set_count(h, "redraws", run.redraws);
    set_count(h, "fallbacks", run.fallbacks);
    if (!run.maps) return;
    const auto& [H, triangles, particles, rays, error, seconds, slope] = *run.maps;
    h.set("map-triangles", std::to_string(triangles));
    set_count(h, "map-particles", particles);
    set_count(h, "map-rays", rays);
    h.set("map-error", json::number(error));
    h.set("map-seconds", json::number(seconds));
    for (size_t c = 0; c < 3; ++c)
        h.set("map-slope-" + std::to_string(c), json::number(double(slope.*axis[c])));
}

// Throws UserError, of the file, if there is no such number; NaN is "null".
inline double number_in(const FilmHeader& h, const std::string& key, const std::string& path) {
    const std::string text = h.find(key).value_or("");
    if (text == "null") return NAN;
    try {
        return parse_number(text);
    } catch (const UserError& e) {
        throw UserError(path + ": " + key + ": " + e.what());
    }
}

inline MapStats maps_in(const FilmHeader& h, const std::string& path) {
    MapStats maps;
    maps.H = number_in(h, "mesh", path);
    maps.triangles = size_t(count_in(h, "map-triangles", path));
    maps.particles = count_in(h, "map-particles", path);
    maps.rays = count_in(h, "map-rays", path);
    maps.error = number_in(h, "map-error", path);
    maps.seconds = number_in(h, "map-seconds", path);
    for (size_t c = 0; c < 3; ++c)
        maps.slope.*axis[c] = real(number_in(h, "map-slope-" + std::to_string(c), path));
    return maps;
}

inline RunStats run_in(const FilmHeader& h, const std::string& path) {
    RunStats run;
    run.seconds = number_in(h, "seconds", path);
    run.cpu_seconds = number_in(h, "cpu-seconds", path);
    run.rays = count_in(h, "rays", path);
    run.redraws = count_in(h, "redraws", path);
    run.fallbacks = count_in(h, "fallbacks", path);
    if (h.find("mesh")) run.maps = maps_in(h, path);
    return run;
}

// ---- When ---------------------------------------------------------------------------------------

// Seconds from a checkpoint that took so many to the next one: all of them take less than a
// hundredth of the time.
inline double until_next(double every, double took) { return std::max(every, 100 * took); }

// The files of one run.
class Checkpoints {
public:
    Checkpoints(const Job& job, FilmHeader identity)
        : path_(job.o.checkpoint),
          every_(job.o.every),
          identity_(std::move(identity)),
          name_(printable(job.o.scene)),
          exposure_(double(job.scene.exposure)),
          next_(job.o.every) {}

    const FilmHeader& identity() const { return identity_; }
    bool are_wanted() const { return !path_.empty(); }
    bool are_there() const { return std::filesystem::exists(path_); }

    // After so many seconds of this run.
    bool is_due(double seconds) const { return are_wanted() && seconds >= next_; }

    // A disk that is full is no reason to stop: the file stays as it was, and the next one may fit.
    template <class Pixel>
    void write_meanwhile(const FilmState<Pixel>& state, const RunStats& run, double seconds) {
        const auto start = std::chrono::steady_clock::now();
        try {
            write(state, run, false);
        } catch (const SystemError& e) {
            std::fprintf(stderr, "%s; the render goes on\n", printable(e.what()).c_str());
        }
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        next_ = seconds + took.count() + until_next(every_, took.count());
    }

    template <class Pixel>
    void write(const FilmState<Pixel>& state, const RunStats& run, bool complete) const {
        FilmHeader header = identity_;
        header.set("name", name_);
        header.set("exposure", json::number(exposure_));
        set_run(header, run, complete);
        write_film(path_, std::move(header), state);
    }

private:
    const std::string path_;
    const double every_;
    const FilmHeader identity_;
    const std::string name_;  // of the scene
    const double exposure_;
    double next_;
};

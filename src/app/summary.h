// app/summary.h  3  what a run of penumbra measured: its progress, its line, its statistics
#pragma once
#include "app/options.h"
#include "app/report.h"

// The maps that paths end on; see app/indirect.h.
struct MapStats {
    double H = NAN;  // longest edge
    size_t triangles = 0;
    uint64_t particles = 0, rays = 0;
    double error = NAN, seconds = 0;  // see Particles::error
    rgb slope{1, 1, 1};
};

// What a run measured.
struct RunStats {
    uint64_t spp = 0;
    double seconds = 0;
    uint64_t rays = 0;
    uint64_t non_finite = 0;
    bool interrupted = false;
    std::array<double, 3> mean_radiance{}, variance_of_mean{};  // a channel at a time
    uint64_t redraws = 0, fallbacks = 0;                        // of weights, see Weigher
    std::optional<MapStats> maps;
};

// Of passes towards a target.
class SampleProgress {
public:
    SampleProgress(const Target& target, bool quiet)
        : samples_(target.samples), bar_(target.seconds, quiet) {}

    double elapsed() const { return bar_.elapsed(); }

    // `samples` so far, with the finished part of the running pass.
    void show(double samples) {
        bar_.show(samples_ ? samples / double(samples_) : 0,
                  fixed(samples, 1) + " samples per pixel");
    }

private:
    const uint64_t samples_;
    Progress bar_;
};

// The line that stays.
inline std::string summary(const std::string& scene, const RunStats& run) {
    return scene + ": " + std::to_string(run.spp) + " samples per pixel, " + fixed(run.seconds, 2) +
           " s, " + fixed(double(run.rays) / run.seconds * 1e-6, 2) + " Mrays/s, " +
           std::to_string(run.non_finite) + " non-finite" +
           (run.interrupted ? " (interrupted)" : "");
}

// What the maps took, and what they say of themselves.
inline std::string summary(const MapStats& maps) {
    return "maps: " + std::to_string(maps.triangles) + " triangles, " +
           std::to_string(maps.particles) + " particles, " +
           (std::isfinite(maps.error) ? "error " + percent(maps.error) + ", " : "") +
           fixed(maps.seconds, 2) + " s";
}

// One object.
inline std::string encode_stats(const Options& o, Size size, int depth, const RunStats& run) {
    json::Object object = asked_for(o, option_table, size);
    auto count = [](auto n) { return std::to_string(n); };
    object.add("depth", run.maps ? "null" : count(depth));  // null: without end
    if (run.maps) {
        const auto& [H, triangles, particles, rays, error, seconds, slope] = *run.maps;
        object.add("map_mesh", json::number(H));
        object.add("map_triangles", count(triangles));
        object.add("map_particles", count(particles));
        object.add("map_error", json::number(error));
        object.add("map_seconds", json::number(seconds));
        object.add("map_rays", count(rays));
        object.add("map_slope", json::numbers({double(slope.x), double(slope.y), double(slope.z)}));
    }
    object.add("film_redraws", count(run.redraws));
    object.add("film_fallbacks", count(run.fallbacks));
    object.add("precision", sizeof(real) == 4 ? "\"float\"" : "\"double\"");
    object.add("interrupted", json::truth(run.interrupted));
    object.add("samples_per_pixel", count(run.spp));
    object.add("seconds", json::number(run.seconds));
    object.add("cpu_seconds", json::number(cpu_seconds()));
    object.add("rays", count(run.rays));
    object.add("mrays_per_second", json::number(double(run.rays) / run.seconds * 1e-6));
    object.add("mean_radiance", json::numbers(run.mean_radiance));
    object.add("variance_of_mean", json::numbers(run.variance_of_mean));
    object.add("non_finite", count(run.non_finite));
    object.add("peak_memory_bytes", count(peak_memory_bytes()));
    return object.text();
}

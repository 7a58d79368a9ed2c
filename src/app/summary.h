// app/summary.h  3  what a run of penumbra measured: its progress, its line, its statistics
#pragma once
#include "app/options.h"
#include "app/report.h"

// What a run measured.
struct RunStats {
    uint64_t spp = 0;
    double seconds = 0;
    uint64_t rays = 0;
    uint64_t non_finite = 0;
    bool interrupted = false;
    std::array<double, 3> mean_radiance{}, variance_of_mean{};  // a channel at a time
    uint64_t redraws = 0, fallbacks = 0;                        // of weights, see Weigher
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

// One object.
inline std::string encode_stats(const Options& o, Size size, int depth, const RunStats& run) {
    json::Object object = asked_for(o, option_table, size);
    auto count = [](auto n) { return std::to_string(n); };
    object.add("depth", count(depth));
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

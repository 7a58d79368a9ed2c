// app/summary.h  3  what a run of penumbra measured: its progress, its line, its statistics
#pragma once
#include "app/options.h"
#include "app/report.h"
#include "film/error.h"

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
    double seconds = 0, cpu_seconds = 0;
    uint64_t rays = 0;
    uint64_t non_finite = 0;
    bool interrupted = false;
    std::array<double, 3> mean_radiance{};  // a channel at a time
    ImageError error;
    double sets = 1;                      // of samples, a pixel in the mean
    double exponent_of_cost = 2;          // seconds ~ d_rel^-this
    std::string stopped_by;               // "samples", "time", "error" or "interrupt"
    uint64_t redraws = 0, fallbacks = 0;  // of weights, see Weigher
    std::optional<MapStats> maps;
};

// Of passes towards a target.
class SampleProgress {
public:
    // After `before` seconds of runs that this one goes on from.
    explicit SampleProgress(const Target& target, bool quiet, double before = 0)
        : samples_(target.samples), bar_(target.seconds, quiet, before) {}

    // That so many samples are likely to be enough.
    void expect(uint64_t samples) { expected_ = samples_ ? std::min(samples_, samples) : samples; }

    double elapsed() const { return bar_.elapsed(); }

    // `samples` so far, with the finished part of the running pass.
    void show(double samples) {
        const uint64_t all = expected_ ? expected_ : samples_;
        bar_.show(all ? samples / double(all) : 0, fixed(samples, 1) + " samples per pixel");
    }

private:
    const uint64_t samples_;
    uint64_t expected_ = 0;  // by what the error is; 0: by no error
    Progress bar_;
};

// ---- The error in words -------------------------------------------------------------------------

// What an image's error does not count, if it has any.
inline const char* bias_class(const Options& o) {
    if (o.sampler == SamplerKind::halton_naive || o.indirect == Indirect::map) return "biased";
    const bool unbiased = o.film == Weighting::mc || o.film == Weighting::torus;
    return unbiased && !estimates_pixels(o.direct) ? "unbiased" : "consistent";
}

// Why there is no error to state; "": there is.
inline std::string why_no_error(const Options& o, const RunStats& run) {
    if (o.sampler == SamplerKind::halton_naive) return "halton-naive is not random";
    if (sets_of(o) == 1) return "one set of samples";
    if (run.spp == 1 && run.sets == 1) return "one sample";
    if (run.error.norm == 0) return "the image is black";
    if (!std::isfinite(run.error.d_rel()))
        return run.interrupted ? "interrupted early" : "its sets are not finite";
    return "";
}

// The nearest number of one digit.
inline double one_digit(double x) {
    const double unit = std::pow(10, std::floor(std::log10(x)));
    return std::round(x / unit) * unit;
}

// "d_rel 2.1 % ± 0.1 %; 1 % needs 34 s"
inline std::string told_error(const Options& o, const RunStats& run) {
    if (const std::string why = why_no_error(o, run); !why.empty())
        return "error not known: " + why;
    const double d = run.error.d_rel(), half = one_digit(d / 2);
    std::string words = "d_rel " + significant(100 * d, 2) + " % ± " +
                        significant(100 * run.error.standard_error(), 1) + " %";
    const std::string bias = bias_class(o);
    if (bias != "unbiased") words += " without its bias (" + bias + ")";
    if (d == 0) return words;
    return words + "; " + significant(100 * half, 1) + " % needs " +
           significant(run.seconds * std::pow(d / half, run.exponent_of_cost), 2) + " s";
}

// The line that stays.
inline std::string summary(const Options& o, const RunStats& run) {
    std::string line = o.scene + ": " + std::to_string(run.spp) + " samples per pixel, " +
                       fixed(run.seconds, 2) + " s, " +
                       fixed(double(run.rays) / run.seconds * 1e-6, 2) + " Mrays/s, " +
                       std::to_string(run.non_finite) + " non-finite";
    if (run.spp > 0) line += ", " + told_error(o, run);
    if (o.error > 0 && !run.interrupted) line += " (stopped by " + run.stopped_by + ")";
    return line + (run.interrupted ? " (interrupted)" : "");
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
    object.add("cpu_seconds", json::number(run.cpu_seconds));
    object.add("rays", count(run.rays));
    object.add("mrays_per_second", json::number(double(run.rays) / run.seconds * 1e-6));
    object.add("mean_radiance", json::numbers(run.mean_radiance));
    std::array<double, 3> of_mean = run.error.square;
    for (double& v : of_mean) v /= double(size.width) * double(size.height);
    object.add("variance_of_mean", json::numbers(of_mean));
    object.add("sets_per_pixel", json::number(run.sets));
    object.add("d_rel", json::number(run.error.d_rel()));
    object.add("d_rel_standard_error", json::number(run.error.standard_error()));
    const bool falls = run.error.d2() > 0;  // or is 0, or not known
    object.add("seconds_to_half_d_rel",
               json::number(falls ? run.seconds * std::pow(2, run.exponent_of_cost) : double(NAN)));
    object.add("bias", json::string(bias_class(o)));
    object.add("stopped_by", json::string(run.stopped_by));
    object.add("non_finite", count(run.non_finite));
    object.add("peak_memory_bytes", count(peak_memory_bytes()));
    return object.text();
}

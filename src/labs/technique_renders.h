// labs/technique_renders.h  4  the renders of techniques.cpp
#pragma once
#include <array>

#include "labs/lab.h"
#include "labs/naive_halton.h"
#include "world/scene_file.h"

namespace techniques {

inline const std::string scene = "scenes/coursework.scene";
inline constexpr double exposure = 0.6;  // the scene's

struct Technique {
    const char *name, *sampler, *direction, *light;
};
inline constexpr std::array<Technique, 14> all = {{
    {"uniform", "independent", "uniform", "none"},
    {"+ cosine", "independent", "bsdf", "none"},
    {"+ Halton", "halton", "uniform", "none"},
    {"+ NEE", "independent", "uniform", "nee"},
    {"cosine + Halton", "halton", "bsdf", "none"},
    {"cosine + NEE", "independent", "bsdf", "nee"},
    {"Halton + NEE", "halton", "uniform", "nee"},
    {"all three", "halton", "bsdf", "nee"},
    {"all three, MIS", "halton", "bsdf", "mis"},
    {"stratified, cosine + NEE", "stratified", "bsdf", "nee"},
    {"naive Halton", "naive", "uniform", "none"},
    {"naive, cosine", "naive", "bsdf", "none"},
    {"naive, NEE", "naive", "uniform", "nee"},
    {"naive, cosine + NEE", "naive", "bsdf", "nee"},
}};

// Their places in `all`.
inline constexpr size_t uniform = 0, cosine = 1, halton = 2, nee = 3, cosine_halton = 4,
                        cosine_nee = 5, halton_nee = 6, all_three = 7, mis = 8, naive = 10,
                        naive_both = 13;

struct Effort {
    bool quick = false;
    std::string reference = "reference/coursework.pfm";
    uint64_t seeds = 8, fewer_seeds = 4;  // at equal samples; in the dearer series
    uint64_t spp = 64, many = 256, limit = 4096;
    double seconds = 5;
};

// ---- Renders ------------------------------------------------------------------------------------

inline double mean(const Rendering& r) {
    const std::vector<double> channels = stats(r.stats, "mean_radiance");
    return (channels[0] + channels[1] + channels[2]) / 3;
}

struct Result {
    Rendering rendering;
    double mse = 0, d_rel = 0;
    double cost() const { return mse * rendering.core_seconds(); }
    double samples() const { return double(rendering.samples()); }
    double radiance() const { return mean(rendering); }
};
using Results = std::vector<Result>;             // one a seed
using Series = std::array<Results, all.size()>;  // by name

struct Study {
    std::string program;
    Effort plan;
    Rendering reference;
    double mean_square = 0;  // of the reference's numbers
    Series equal = {}, timed = {}, many = {}, eighth = {}, limit = {};
};

// By the lab's own loop; if time is what ends it, with as many points as 16 say that it allows.
inline Rendering naive_rendering(const Technique& t, const std::array<std::string, 2>& stop) {
    const Scene read = read_scene(scene).scene;
    ::Technique technique;
    technique.direction = t.direction == std::string("bsdf") ? Direction::bsdf : Direction::uniform;
    technique.light = t.light == std::string("nee") ? LightMode::nee : LightMode::none;
    Rendering r;
    auto take = [&](uint64_t spp) {
        const double before = processor_seconds();
        r.image = naive_halton::render(read, technique, spp);
        const double seconds = processor_seconds() - before;
        std::array<double, 3> sum{};
        for (const auto& pixel : r.image.pixels)
            for (size_t c = 0; c < 3; ++c)
                sum[c] += double(pixel[c]) / double(r.image.pixels.size());
        r.stats =
            text("\"samples_per_pixel\": %.0f\n\"cpu_seconds\": %.9g\n", double(spp), seconds) +
            text("\"mean_radiance\": [%.9g, %.9g, %.9g]\n", sum[0], sum[1], sum[2]);
        return seconds;
    };
    if (stop[0] == "--spp") {
        take(parse_count(stop[1], 1, UINT32_MAX));
    } else {
        const double cores = parse_number(stop[1]) * all_cores();
        take(uint64_t(std::max(1.0, 16 * cores / take(16))));
    }
    return r;
}

// Seeds outside, so that whatever else the machine does hits all alike; but one for naive points,
// which are the same for all.
inline Series render(const Study& s, const std::vector<size_t>& which, uint64_t first_seed,
                     uint64_t seeds, const std::array<std::string, 2>& stop) {
    Series series;
    Steps progress(which.size() * seeds);
    for (uint64_t k = 0; k < seeds; ++k)
        for (size_t name : which) {
            const Technique& t = all[name];
            progress.next(t.name);
            if (name >= naive && k > 0) continue;
            const std::string seed = std::to_string(first_seed + 100 * name + k);
            Result r{name >= naive
                         ? naive_rendering(t, stop)
                         : rendering(s.program,
                                     {scene, "--sampler", t.sampler, "--direction", t.direction,
                                      "--light", t.light, "--seed", seed, stop[0], stop[1]})};
            if (r.rendering.image.pixels.size() != s.reference.image.pixels.size())
                throw UserError(s.plan.reference + ": not of the scene's size");
            r.mse = mse(s.reference.image, r.rendering.image);
            r.d_rel = std::sqrt(r.mse / s.mean_square);
            series[name].push_back(r);
        }
    return series;
}

// No two renders, nor the reference, share random numbers.
inline Study render_all(const std::string& program, const Effort& plan) {
    Study s{program, plan, read_rendering(plan.reference)};
    for (const auto& pixel : s.reference.image.pixels)
        for (float x : pixel)
            s.mean_square += double(x) * double(x) / double(3 * s.reference.image.pixels.size());
    std::vector<size_t> every(all.size());
    std::iota(every.begin(), every.end(), size_t(0));
    auto samples = [](uint64_t n) {
        return std::array<std::string, 2>{"--spp", std::to_string(n)};
    };
    s.equal = render(s, every, 10000, plan.seeds, samples(plan.spp));
    s.timed = render(s, every, 20000, plan.fewer_seeds, {"--time", text("%g", plan.seconds)});
    s.many = render(s, {nee, halton_nee, cosine_nee, all_three}, 30000, plan.fewer_seeds,
                    samples(plan.many));
    s.eighth = render(s, {naive, naive_both}, 40000, 1, samples(plan.limit / 8));
    s.limit = render(s, {naive, naive_both}, 40000, 1, samples(plan.limit));
    return s;
}

}  // namespace techniques

// app/plan.h  3  from options to a plan: a scene, its samples, and who judges their error
//
// Light that samples may have missed is looked for if -DWITH_UNSEEN: with src/unseen.
#pragma once
#include "app/options.h"
#include "film/loop.h"
#include "text/scene_file.h"

#ifdef WITH_UNSEEN
#include "unseen/unseen.h"
#else
namespace penumbra {
inline std::vector<std::string> hidden_lights(const NamedScene&) { return {}; }
struct MissedLight {
    void add(const std::vector<NearMisses>&, double, double) {}
    std::string doubt(double, double, double) const { return ""; }
};
struct LightRecorder {
    explicit LightRecorder(auto&&...) {}
    std::vector<NearMisses> near_misses(uint32_t) const { return {}; }
    std::vector<size_t> noisy() const { return {}; }
    static std::string why_unknown(const Film&, const ImageError&) { return ""; }
    NoVisitor visitor(Tally&) const { return {}; }
};
}  // namespace penumbra
#endif

namespace penumbra {

// A scene with the user's options; throws UserError if it cannot be rendered.
inline ParsedScene with_options(ParsedScene parsed, const Options& o) {
    NamedScene& scene = parsed.scene;
    for (const std::string& hidden : hidden_lights(scene)) parsed.warnings.push_back(hidden);
    scene.size = o.size.value_or(scene.size);
    scene.depth = o.depth.value_or(scene.depth);
    if (o.view.scatters) scene.depth = 1;  // for the numbers of one direction
    if (o.view.of) scene.exposure = 1;     // a scene's own is meant for radiance
    if (o.exposure) scene.exposure = real(*o.exposure);
    for (size_t i = 0; i < scene.lights.size(); ++i)
        if (scene.lights[i].is_delta() && o.technique.light == LightMode::none)
            throw UserError(o.scene + ":" + std::to_string(scene.line_of_light[i]) +
                            ": --light none: rays never hit a " + name_of(scene.lights[i]) +
                            " light");
    if (o.rows && o.rows->last >= scene.size.height)
        throw UserError("--rows: the picture has rows 0-" + std::to_string(scene.size.height - 1));
    return parsed;
}
inline ParsedScene load(const Options& o) { return with_options(read_scene(o.scene), o); }

inline RowRange rows_of(const Options& o, const Scene& scene) {
    return o.rows.value_or(RowRange{0, scene.size.height - 1});
}

// Bytes of a film, later with its image: sums, and weight, deviation or image, and n of a block.
inline double bytes_of(Size size, uint32_t K) {
    return (24.0 * K + 16) * double(size.width) * double(size.height);
}

// Replications of each pixel, by default: 2, and up to 8 in pictures of less than 400 pixels, whose
// error may be that of one pixel.  7 replications give its standard error as a quarter.
inline uint32_t replications_of(Size size) {
    return uint32_t(std::clamp(799 / (size.width * size.height) + 1, 2, 8));
}

// Samples of a pixel of mean noise, over those of a replication of weight 1.
inline uint64_t samples_for_one(const Plan& plan) {
    return plan.replications * (plan.is_adaptive ? typical_weight : 1);
}

// A scene without light is black, whatever error is asked for.  A recorder observes the samples.
inline Plan plan_of(const Options& o, const Scene& scene, const LightRecorder* recorder = nullptr) {
    Plan plan;
    plan.error = scene.lights.empty() ? 0 : o.error, plan.seconds = o.seconds;
    const bool ends = o.spp > 0 || plan.seconds > 0 || plan.error > 0;
    const uint64_t N = ends ? o.spp : scene.samples;
    const uint32_t K = replications_of(scene.size);
    plan.replications = o.replications ? o.replications : N > 0 && N < K ? uint32_t(N) : K;
    plan.is_adaptive = o.replications == 0 && plan.replications == 2 && N != 2;
    plan.samples = (N + samples_for_one(plan) - 1) / samples_for_one(plan);
    plan.threads = o.threads;
    const RowRange rows = rows_of(o, scene);
    plan.size = {scene.size.width, rows.count()}, plan.first_row = rows.first;
    if (!recorder) return plan;
    plan.noisy = recorder->noisy();
    plan.may_miss_light = [](const Film& film, const ImageError& error) {
        return !LightRecorder::why_unknown(film, error).empty();
    };
    plan.near = recorder->near_misses(plan.replications * (plan.is_adaptive ? min_of_noisy : 1));
    return plan;
}

// The same where one sample of the film is the mean of all paths of a replication.
inline Plan plan_at_once(const Options& o, const Scene& scene) {
    Plan plan = plan_of(o, scene);
    plan.paths = plan.samples, plan.samples = 1;
    return plan;
}

// Why an error may be far too small; `missed_light` says which light samples may have missed.
inline std::string in_words(Doubt doubt, const std::function<std::string()>& missed_light) {
    switch (doubt) {
        case Doubt::no: break;
        case Doubt::black: return "no sample found light";
        case Doubt::missed_light: return missed_light();
        case Doubt::few_pixels: return "a few pixels dominate it";
        case Doubt::noise: return "the picture is mostly noise";
    }
    return "";
}

}  // namespace penumbra

// labs/bench_paths.h  4  how long a path takes, beside the textbook's tracer, for bench
#pragma once
#include "labs/page.h"
#include "labs/textbook.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "world/scene_file.h"

namespace bench {

// What traces paths in turns with others, row by row of an image.
struct PathRunner {
    std::string name;
    std::function<uint64_t(int y, uint64_t seed)> trace;  // a row; the rays that it took
    std::vector<double> seconds = {};                     // a round
    uint64_t rays = 0;                                    // of all rounds
};

inline constexpr uint64_t path_samples = 16;  // a pixel and round

inline PathRunner textbook_runner(const Scene& scene) {
    auto trace = [&scene, room = textbook::room_of(scene),
                  image = Image(scene.size.width, scene.size.height)](int y,
                                                                      uint64_t seed) mutable {
        room.rays = 0;
        textbook::render_row(room, scene, seed, path_samples, y, image);
        return room.rays;
    };
    return {"the textbook's", trace};
}

inline PathRunner path_runner(const std::string& name, const Scene& scene, const Technique& t,
                              SamplerKind kind) {
    auto trace = [&scene, t, kind](int y, uint64_t seed) {
        const Pattern pattern = make_pattern(kind, seed, scene.depth, path_samples);
        uint64_t rays = 0;
        rgb sum;
        auto count = [&](const Segment&, const Step& e) {
            rays += 1 + (e.direct.light != nullptr);
        };
        for (int x = 0; x < scene.size.width; ++x)
            for (uint64_t i = 0; i < path_samples; ++i) {
                const Start s = start(scene, pattern, {x, y, i});
                sum += Li(scene, t, s.ray, s.sampler, count);
            }
        if (!is_finite(sum)) throw SystemError("a sample was not finite");
        return rays;
    };
    return {name, trace};
}

// Lines for one scene; the textbook's tracer knows but diffuse quadrangles.
inline void race_paths(std::vector<std::vector<std::string>>& lines, const std::string& name,
                       int rounds) {
    const Scene scene = read_scene("scenes/" + name + ".scene").scene;
    const Technique nee{Direction::bsdf, LightMode::nee, 0},
        mis{Direction::bsdf, LightMode::mis, 0};
    std::vector<PathRunner> all = {
        textbook_runner(scene),
        path_runner("ours, the same technique", scene, nee, SamplerKind::independent),
        path_runner("ours, MIS and Halton points", scene, mis, SamplerKind::halton),
        path_runner("ours, the default", scene, {}, SamplerKind::sobol)};
    for (int round = 0; round < rounds; ++round) {
        for (PathRunner& r : all) r.seconds.push_back(0);
        for (int y = 0; y < scene.size.height; ++y)
            for (PathRunner& r : all) {
                const double start = processor_seconds();
                r.rays += r.trace(y, uint64_t(round));
                r.seconds.back() += processor_seconds() - start;
            }
    }
    const double paths = double(scene.size.width) * double(scene.size.height) * path_samples;
    for (const PathRunner& r : all) {
        std::vector<double> ratios;
        for (size_t k = 0; k < r.seconds.size(); ++k)
            ratios.push_back(r.seconds[k] / all[0].seconds[k]);
        const double each = double(r.rays) / (paths * rounds), path = median(r.seconds) / paths;
        lines.push_back({name, r.name, text("%.2f", 1e6 * path), text("%.2f", each),
                         text("%.3f", 1e6 * path / each), with_range(ratios, "%.2f")});
    }
}

inline std::vector<std::vector<std::string>> all_paths(int rounds) {
    std::vector<std::vector<std::string>> lines;
    for (const char* name : {"cornell36", "cornell36b"}) race_paths(lines, name, rounds);
    return lines;
}

}  // namespace bench

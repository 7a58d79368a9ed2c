// labs/bench_paths.h  4  CPU time per path, compared with a textbook path tracer, for bench
#pragma once
#include "labs/page.h"
#include "labs/textbook.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "world/scene_file.h"

// A path tracer that renders an image row by row, in turns with others.
struct PathRunner {
    std::string name;
    std::function<void(int y, uint64_t seed)> trace;
    std::vector<double> seconds = {};  // CPU time of each round
};

inline constexpr uint64_t path_samples = 16;  // per pixel and round

inline PathRunner path_runner(const std::string& name, const Scene& scene, const Technique& t,
                              SamplerKind kind) {
    auto trace = [&scene, t, kind](int y, uint64_t seed) {
        const Pattern pattern = make_pattern(kind, seed, scene.depth, path_samples);
        rgb sum;
        for (int x = 0; x < scene.size.width; ++x)
            for (uint64_t i = 0; i < path_samples; ++i) {
                const Start s = start(scene, pattern, {x, y, i});
                sum += Li(scene, t, s.ray, s.sampler);
            }
        if (!is_finite(sum)) throw SystemError("a sample was not finite");
    };
    return {name, trace};
}

// Table lines for scenes that the textbook path tracer supports: diffuse quadrilaterals.
inline Lines all_paths(int rounds) {
    Lines lines;
    for (const char* name : {"cornell36", "cornell36b"}) {
        const Scene scene = read_scene(text("scenes/%s.scene", name)).scene;
        textbook::Room room = textbook::room_of(scene);
        Image image(scene.size.width, scene.size.height);
        std::vector<PathRunner> all = {
            {"the textbook's",
             [&](int y, uint64_t seed) {
                 textbook::render_row(room, scene, seed, path_samples, y, image);
             }},
            path_runner("ours, the same technique", scene, {Direction::bsdf, LightMode::nee, 0},
                        SamplerKind::independent),
            path_runner("ours, MIS and Halton points", scene, {Direction::bsdf, LightMode::mis, 0},
                        SamplerKind::halton),
            path_runner("ours, the default", scene, {}, SamplerKind::sobol)};
        for (int round = 0; round < rounds; ++round) {
            for (PathRunner& r : all) r.seconds.push_back(0);
            for (int y = 0; y < scene.size.height; ++y)
                for (PathRunner& r : all) {
                    const double start = processor_seconds();
                    r.trace(y, uint64_t(round));
                    r.seconds.back() += processor_seconds() - start;
                }
        }
        const double paths = double(image.pixels.size()) * path_samples;
        for (const PathRunner& r : all) {
            std::vector<double> ratios;
            for (size_t k = 0; k < r.seconds.size(); ++k)
                ratios.push_back(r.seconds[k] / all[0].seconds[k]);
            lines.push_back({name, r.name, text("%.2f", 1e6 * median(r.seconds) / paths),
                             with_range(ratios, "%.2f")});
        }
    }
    return lines;
}

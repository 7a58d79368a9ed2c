// labs/shadow_regions.h  3  where a scene is lit, in penumbra and in umbra, for shadows
#pragma once
#include "film/passes.h"
#include "shadow/shadow.h"
#include "world/scene_file.h"

// How much is measured.
struct ShadowPlan {
    bool quick = false;
    std::string only = {};                // one scene
    int shrink = 2;                       // of the sides of the images that are measured
    uint64_t look = 1024;                 // samples to find the regions
    uint64_t spp = 64, trials = 1024;     // in penumbra; of these per estimate
    uint64_t bias_trials = 64;            // of 4096 samples
    uint64_t seeds = 3, render_spp = 64;  // whole renders
    size_t most_pixels = 200;             // of a region
    std::string renderer = {};            // its program

    bool wants(const std::string& scene) const { return only.empty() || only == scene; }
};
inline ShadowPlan quick_plan(const std::string& only) {
    return {true, only, 8, 128, 64, 64, 8, 2, 16, 20};
}

inline constexpr const char* estimator_names[] = {"stochastic", "control", "ratio", "regression"};
inline constexpr Estimator estimators[] = {Estimator::stochastic, Estimator::control,
                                           Estimator::ratio, Estimator::regression};

// A scene by next-event estimation with independent numbers.
struct Stage {
    Scene scene;
    Technique technique;
    Pattern pattern;

    int width() const { return scene.size.width; }
    int height() const { return scene.size.height; }
};

inline Stage load(const std::string& name, int shrink) {
    Stage v{read_scene("scenes/" + name + ".scene").scene,
            {Direction::bsdf, LightMode::nee, 0},
            {SamplerKind::independent, 1}};
    v.scene.size = {v.width() / shrink, v.height() / shrink};
    return v;
}

// Direct light that the camera sees by sample i of a pixel.
inline Shadowed first_light(const Stage& v, PixelSample p, uint64_t i) {
    const Start at = start(v.scene, v.pattern, {p.x, p.y, i});
    return shadowed(v.scene, step(v.scene, v.technique, {at.ray, at.ray.o}, at.sampler));
}

// Of its green channel, unless told.
inline void add(ShadowMoments& m, const Shadowed& s, real rgb::*channel = &rgb::y) {
    m.add(double(s.U.*channel), double(s.w.*channel), double(s.wV.*channel));
}

// one(k) for every k < count, by all threads.
template <class One>
void in_parallel(size_t count, One one) {
    if (count > 0)
        in_parallel(count, std::max(1u, std::thread::hardware_concurrency()), one, [](double) {});
}

enum Region { lit, penumbra, umbra, between, other };
inline constexpr const char* region_names[] = {"lit", "penumbra", "umbra", "between", "other"};

struct Regions {
    int width = 0, height = 0;
    std::vector<Region> of;  // every pixel, row by row

    Region at(PixelSample p) const { return of[size_t(p.y * width + p.x)]; }

    // As evenly spread as can be.
    std::vector<PixelSample> pixels(Region r, size_t most) const {
        std::vector<PixelSample> all, some;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (at({x, y}) == r) all.push_back({x, y});
        const size_t n = std::min(most, all.size());
        for (size_t i = 0; i < n; ++i) some.push_back(all[i * all.size() / n]);
        return some;
    }
};

// What samples of a pixel found.
struct Seen {
    bool visible = false, occluded = false, no_U = false;
    double visible_part = 0;
};

inline Seen look(const Stage& v, PixelSample p, uint64_t samples) {
    Seen seen;
    ShadowMoments m;
    for (uint64_t i = 0; i < samples; ++i) {
        const Shadowed s = first_light(v, p, (uint64_t(1) << 40) + i);
        add(m, s);
        if (s.w.y > 0) (s.wV.y > 0 ? seen.visible : seen.occluded) = true;
        seen.no_U = seen.no_U || !(s.U.y > 0);
    }
    seen.visible_part = visible_part(m);
    return seen;
}

// Lit and umbra: no sample of the pixel or of its neighbours says otherwise.  Penumbra: 10 to 90 %
// of the light is seen.
inline Regions find_regions(const Stage& v, uint64_t samples) {
    const int w = v.width(), h = v.height();
    Regions r{w, h, std::vector<Region>(size_t(w * h), other)};
    std::vector<Seen> seen(r.of.size());
    in_parallel(size_t(h), [&](size_t y) {
        for (int x = 0; x < w; ++x) seen[y * size_t(w) + size_t(x)] = look(v, {x, int(y)}, samples);
    });
    auto classify = [&](int x, int y) {
        Seen around;
        for (int j = std::max(0, y - 1); j <= std::min(h - 1, y + 1); ++j)
            for (int i = std::max(0, x - 1); i <= std::min(w - 1, x + 1); ++i) {
                const Seen& s = seen[size_t(j * w + i)];
                around.visible |= s.visible, around.occluded |= s.occluded, around.no_U |= s.no_U;
            }
        if (!around.no_U && around.visible != around.occluded) return around.visible ? lit : umbra;
        const Seen& here = seen[size_t(y * w + x)];
        if (here.no_U) return other;
        return here.visible_part >= 0.1 && here.visible_part <= 0.9 ? penumbra : between;
    };
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) r.of[size_t(y * w + x)] = classify(x, y);
    return r;
}

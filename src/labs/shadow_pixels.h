// labs/shadow_pixels.h  3  pixels in light, penumbra and umbra: noise and bias of four estimators
// there
#pragma once
#include "base/stats.h"
#include "film/passes.h"
#include "labs/maps.h"
#include "shadow/shadow.h"
#include "world/scene_file.h"

// How much is measured.
struct ShadowPlan {
    bool quick = false;
    int shrink = 2;                       // of the sides of the images that are measured
    uint64_t look = 1024;                 // samples to find the regions
    uint64_t spp = 64, trials = 1024;     // in penumbra; of these per estimate
    uint64_t bias_trials = 64;            // of 4096 samples
    uint64_t seeds = 4, render_spp = 64;  // whole renders
    size_t most_pixels = 200;             // of a region
};
inline constexpr ShadowPlan quick_plan = {true, 8, 128, 64, 64, 8, 2, 16, 20};

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

// ---- Noise and bias
// ------------------------------------------------------------------------------

// By estimator.
struct Noise {
    double U = 0;
    std::array<Moments, 4> value, beyond_U;  // the estimates; without the pixel's own antialiasing
    std::array<double, 4> predicted{};       // variance
    bool shadow = false;                     // some sample is occluded
    uint64_t blind = 0;                      // estimates none of whose samples found light
};

// `trials` estimates of `spp` samples.  The prediction is Var(w V - beta (w - U)) / spp from all of
// the pixel's samples; where U is the same all over the pixel, Var(w V), Var(w (1 - V)), Var(w (V -
// R)) and (1 - corr^2) Var(w V).
inline Noise measure_noise(const Stage& v, PixelSample p, uint64_t spp, uint64_t trials) {
    Noise noise;
    ShadowMoments all;
    Moments wV;
    for (uint64_t t = 0; t < trials; ++t) {
        ShadowMoments m;
        for (uint64_t i = 0; i < spp; ++i) {
            const Shadowed s = first_light(v, p, t * spp + i);
            add(m, s);
            wV.add(double(s.wV.y));
            noise.shadow = noise.shadow || s.wV.y < s.w.y;
        }
        all = merge(all, m);
        noise.blind += m.w <= 0;
        for (size_t e = 0; e < 4; ++e) {
            const double value = estimate(estimators[e], m);
            noise.value[e].add(value);
            if (m.w > 0) noise.beyond_U[e].add(value - m.U);
        }
    }
    noise.U = all.U;
    const double R = all.U > 0 ? all.wV / all.U : 0;
    const double betas[] = {0, 1, R, all.bb > 0 ? all.b_wV / all.bb : 0};
    for (size_t e = 0; e < 4; ++e)
        noise.predicted[e] = (wV.m2 - 2 * betas[e] * all.b_wV + betas[e] * betas[e] * all.bb) /
                             double(all.n) / double(spp);
    return noise;
}

inline constexpr int bias_steps = 13;  // N = 1 ... 4096

// Of ratio and regression, by log2 N: the estimates, and these minus mean(w V) - beta mean(w - U),
// which is unbiased.
struct Bias {
    std::array<std::array<Moments, bias_steps>, 2> value, excess;
};

inline Bias measure_bias(const Stage& v, PixelSample p, uint64_t trials, size_t steps) {
    Bias bias;
    ShadowMoments all;
    for (uint64_t i = 0; i < 4096; ++i) add(all, first_light(v, p, (uint64_t(1) << 41) + i));
    const double betas[] = {all.wV / all.U, all.b_wV / all.bb};
    for (uint64_t t = 0; t < trials; ++t) {
        ShadowMoments m;
        for (size_t k = 0; k < steps; ++k) {
            while (m.n < uint64_t(1) << k) add(m, first_light(v, p, t * 4096 + m.n));
            for (size_t e = 0; e < 2; ++e) {
                const double value = estimate(estimators[2 + e], m);
                bias.value[e][k].add(value);
                bias.excess[e][k].add(value - (m.wV - betas[e] * (m.w - m.U)));
            }
        }
    }
    return bias;
}

// ---- A picture ----------------------------------------------------------------------------------

// Calls paint(p) for every pixel.
template <class Paint>
void paint_all(const Stage& v, Paint paint) {
    in_parallel(size_t(v.height()), [&](size_t y) {
        for (int x = 0; x < v.width(); ++x) paint(PixelSample{x, int(y)});
    });
}

// Direct light by each estimator, its deviation, and what part of the light is seen.
struct ShadowImages {
    static constexpr uint64_t spp = 16, trials = 8;
    std::array<Image, 4> light, deviation;
    Image visible;
};

inline void paint_shadows(ShadowImages& images, const Stage& v, PixelSample p) {
    std::array<Moments, 4> values;
    ShadowMoments all;
    for (uint64_t t = 0; t < images.trials; ++t) {
        std::array<ShadowMoments, 3> m;
        for (uint64_t i = t * images.spp; i < (t + 1) * images.spp; ++i) {
            const Shadowed s = first_light(v, p, i);
            for (size_t c = 0; c < 3; ++c) add(m[c], s, axis[c]);
        }
        all = merge(all, m[1]);
        for (size_t e = 0; e < 4; ++e) {
            values[e].add(estimate(estimators[e], m[1]));
            for (size_t c = 0; c < 3 && t == 0; ++c)
                images.light[e].at(p.x, p.y)[c] = float(estimate(estimators[e], m[c]));
        }
    }
    for (size_t e = 0; e < 4; ++e) {
        const auto deviation = float(std::sqrt(values[e].variance()));
        images.deviation[e].at(p.x, p.y) = {deviation, deviation, deviation};
    }
    const auto part = float(visible_part(all));
    images.visible.at(p.x, p.y) = {part, part, part};
}

inline Svg shadow_sheet(const Stage& v) {
    const Image blank(v.width(), v.height());
    ShadowImages images{{blank, blank, blank, blank}, {blank, blank, blank, blank}, blank};
    paint_all(v, [&](PixelSample p) { paint_shadows(images, v, p); });
    const double exposure = double(v.scene.exposure), most = 0.25;
    Svg sheet(4 * 268 + 12, 3 * 160 + 10);
    for (int e = 0; e < 4; ++e) {
        const double left = 12 + 268 * e;
        draw_picture(sheet, {left, 25}, std::string(estimator_names[e]) + ", 16 samples",
                     images.light[size_t(e)], exposure);
        draw_picture(sheet, {left, 185}, "its standard deviation", images.deviation[size_t(e)],
                     exposure / most);
    }
    draw_picture(sheet, {12, 345}, "visible part of the light", images.visible, 1);
    draw_scale(sheet, {318, 380}, 200, {{"visible part of the light", 0, 1, false}, greys});
    draw_scale(
        sheet, {586, 380}, 200,
        {{"standard deviation, white above = 1", 0, most, false, {0, 0.05, 0.1, 0.15, 0.2, 0.25}},
         greys});
    return sheet;
}

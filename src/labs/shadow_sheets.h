// labs/shadow_sheets.h  5  pictures of light in shadow, of its noise and its bias, for shadows
#pragma once
#include "labs/maps.h"
#include "labs/shadow_noise.h"

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

// Where ratio is too bright and too dark, from one sample to sixteen.
inline Svg bias_sheet(const Stage& v, const Regions& regions, uint64_t trials) {
    constexpr size_t last = 5;
    const Map map{{"bias of ratio, thousandths of radiance", -2, 2, false}, blue_to_red};
    std::array<Image, last> images;
    images.fill(Image(v.width(), v.height()));
    paint_all(v, [&](PixelSample p) {
        const Region r = regions.at(p);
        const bool biased = r == penumbra || r == between;
        const Bias bias = biased ? measure_bias(v, p, trials, last) : Bias{};
        for (size_t k = 0; k < last; ++k)
            images[k].at(p.x, p.y) = map(1000 * bias.excess[0][k].mean);
    });
    Svg sheet(3 * 268 + 12, 2 * 162);
    for (size_t k = 0; k < last; ++k) {
        const Place at = {12 + 268 * double(k % 3), 25 + 162 * double(k / 3)};
        draw_picture(sheet, at, "N = " + std::to_string(1 << k), images[k], 1);
    }
    draw_scale(sheet, {576, 230}, 200, map);
    return sheet;
}

// labs/shadow_noise.h  4  noise and bias of single pixels in light and shadow, for shadows
#pragma once
#include "base/stats.h"
#include "labs/shadow_regions.h"

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

// shadow/estimators.h  1  light in shadow: plain Monte Carlo, control variate, ratio, regression
//
// The integral is S = E[w V].  A sample has w, its unshadowed light, and w V, its light with
// visibility V.  U = E[w] is known, as a number or at every sample.  With R = S / E[w], for many
// samples (Heitz, Hill, McGuire 2018; supplement):
//
// clang-format off
//   estimator   class       N variance             N bias
//   stochastic  unbiased    Var(w V)               0
//   control     unbiased    Var(w (1 - V))         0
//   ratio       consistent  Var(w (V - R))         -E[w^2 (V - R)] / W
//   regression  consistent  (1 - corr^2) Var(w V)  -E[(w - W)^2 e] / Var(w), e the residual
// clang-format on
#pragma once
#include <cstdint>

namespace penumbra {

enum class Estimator { stochastic, control, ratio, regression };

// True if it needs all samples of a pixel together and is not a mean of samples.
inline bool estimates_pixels(Estimator e) {
    return e != Estimator::stochastic && e != Estimator::control;
}

// Means and centred moments of n samples (U, w, w V), with b = w - U.
struct ShadowMoments {
    uint64_t n = 0;
    double U = 0, w = 0, wV = 0;  // means
    double bb = 0;                // sum of (b - mean)^2
    double b_wV = 0, b_U = 0;     // sums of (b - mean) (w V - mean) and (b - mean) (U - mean)

    // In one pass (Welford 1962), and of two parts (Chan, Golub, LeVeque 1983).  Equal numbers have
    // equal means: w and w V agree to the last bit where V is 1.
    // exercise 5.4
    void add(double new_U, double new_w, double new_wV) {
        const double to_U = new_U - U, to_w = new_w - w, to_wV = new_wV - wV, to_b = to_w - to_U;
        const double before = double(n), step = 1 / double(++n);
        U += to_U * step;
        w += to_w * step;
        wV += to_wV * step;
        bb += to_b * to_b * (before * step);
        b_wV += to_b * to_wV * (before * step);
        b_U += to_b * to_U * (before * step);
    }
    friend ShadowMoments merge(const ShadowMoments& x, const ShadowMoments& y) {
        if (x.n == 0) return y;
        const double N = double(x.n) + double(y.n), part = double(y.n) / N;
        const double to_U = y.U - x.U, to_w = y.w - x.w, to_wV = y.wV - x.wV, to_b = to_w - to_U;
        const double both = double(x.n) * part;
        return {x.n + y.n,
                x.U + to_U * part,
                x.w + to_w * part,
                x.wV + to_wV * part,
                x.bb + y.bb + to_b * to_b * both,
                x.b_wV + y.b_wV + to_b * to_wV * both,
                x.b_U + y.b_U + to_b * to_U * both};
    }
    // end
};

// The same for a constant U = W: sums of deviations from it, so that they do not cancel.
struct SumsAbout {
    double W = 0;
    uint64_t n = 0;
    double w = 0, wV = 0, b = 0, bb = 0, b_wV = 0;

    void add(double new_w, double new_wV) {
        const double new_b = new_w - W;
        ++n;
        w += new_w;
        wV += new_wV;
        b += new_b;
        bb += new_b * new_b;
        b_wV += new_b * new_wV;
    }
    ShadowMoments moments() const {
        const double N = double(n);
        return {n, W, w / N, wV / N, bb - b * b / N, b_wV - b * wV / N, 0};
    }
};

// Unbiased.
inline double stochastic(const ShadowMoments& m) { return m.wV; }

// The control variate for one sample or for means of many, as numbers or colours.  Unbiased.  It is
// exactly U where nothing occludes the light.
template <class T>
T control(const T& U, const T& w, const T& wV) {
    // exercise 5.1
    const T in_shadow = w - wV;
    return U - in_shadow;
    // end
}
inline double control(const ShadowMoments& m) { return control(m.U, m.w, m.wV); }

// visible_part: R from these samples; 0 if none of them found any light.  ratio: consistent;
// exactly U in full light, and 0 in full shadow.
// exercise 5.2
inline double visible_part(const ShadowMoments& m) { return m.w > 0 ? m.wV / m.w : 0; }
inline double ratio(const ShadowMoments& m) { return m.U * visible_part(m); }
// end

// Consistent.  Like ratio, exact in full light and in full shadow.
inline double regression(const ShadowMoments& m) {
    // exercise 5.3
    // If U varies between samples, w V follows it anyway.  So beta is the slope of w V - R U on b;
    // then fully lit and fully dark pixels are as free of noise as with ratio.  Written as a
    // correction of ratio, since mean(w V) = R mean(w).  The slope through a few samples has
    // infinite variance; then beta is R.
    if (m.n < 8 || !(m.bb > 0)) return ratio(m);
    const double R = visible_part(m), beta = (m.b_wV - R * m.b_U) / m.bb;
    return m.U * R + (R - beta) * (m.w - m.U);
    // end
}

inline double estimate(Estimator e, const ShadowMoments& m) {
    switch (e) {
        case Estimator::stochastic: return stochastic(m);
        case Estimator::control: return control(m);
        case Estimator::ratio: return ratio(m);
        case Estimator::regression: break;
    }
    return regression(m);
}

}  // namespace penumbra

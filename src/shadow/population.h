// shadow/population.h  2  expected values and variances of the four estimators
//
// All are mean(w V) - beta mean(w - U):
//   estimator   beta
//   stochastic  0
//   control     1
//   ratio       R estimated
//   regression  Cov(w V, w) / Var(w) estimated
#pragma once
#include "shadow/estimators.h"

namespace penumbra {

// Moments of the population, for visibility that is 0 or 1.
struct ShadowPopulation {
    double W, S;     // E[w], E[w V]
    double ww, wwV;  // E[w^2], E[w^2 V]
    double www, wwwV;

    double R() const { return S / W; }
    double beta(Estimator e) const {
        switch (e) {
            case Estimator::stochastic: return 0;
            case Estimator::control: return 1;
            case Estimator::ratio: return R();
            case Estimator::regression: break;
        }
        return (wwV - S * W) / (ww - W * W);
    }
    // N times the variance, which is that of w V - beta w; exactly 0 without noise.
    double variance(Estimator e) const {
        const double b = beta(e), lit = 1 - b, mean = S - b * W;
        return lit * lit * wwV + b * b * (ww - wwV) - mean * mean;
    }
    // N times the bias, for large N.
    double bias(Estimator e) const {
        if (e == Estimator::ratio) return -(wwV - R() * ww) / W;
        if (e != Estimator::regression) return 0;
        // E[(w - W)^2 (w V - S - beta (w - W))] / Var(w)
        const double var = ww - W * W, third = www - 3 * W * ww + 2 * W * W * W;
        const double with_wV = wwwV - 2 * W * wwV + W * W * S - S * var;
        return -(with_wV - beta(e) * third) / var;
    }
};

}  // namespace penumbra

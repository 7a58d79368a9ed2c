// voronoi/weighted.h  6  pixels whose samples weigh as much as their Voronoi cells
#pragma once
#include "path/sampler.h"
#include "voronoi/weights.h"

// For a film in place of L, the radiance of sample i of a set of a pixel: that times n w_i, so that
// the film's plain mean is the weighted one.  The weights need all n samples of a set, so its first
// one renders them all.  Bias class: see Weighting.
class WeightedPixels {
public:
    WeightedPixels(Weighting kind, const Pattern& pattern, uint64_t n)
        : kind_(kind), pattern_(pattern), n_(n) {}

    const Weigher& weigher() const { return weigher_; }

    // Of pixel number `pixel` of the pattern; in order, set by set: L(i).
    template <class Radiance>
    rgb operator()(uint64_t pixel, uint32_t set, uint64_t i, Radiance L) {
        if (i == 0) gather(pixel, set, L);
        return values_[i] * real((*weights_)[i] * double(values_.size()));
    }

private:
    const Weighting kind_;
    const Pattern& pattern_;
    const uint64_t n_;
    Weigher weigher_;
    std::vector<rgb> values_;
    std::vector<Site> places_;
    const std::vector<double>* weights_ = nullptr;

    template <class Radiance>
    void gather(uint64_t pixel, uint32_t set, Radiance& L) {
        values_.clear();
        places_.clear();
        for (uint64_t i = 0; i < n_; ++i) {
            const vec2 u = Sampler(pattern_, pixel, i, set).get2(film_x);  // as L draws it
            places_.push_back({double(u.x), double(u.y)});
            values_.push_back(L(i));
        }
        // No path draws this number.
        const uint64_t strip = hash(hash(hash(0, pattern_.seed), pixel), UINT64_MAX - set);
        weights_ = &weigher_(kind_, places_, strip);
    }
};

// voronoi/weighted.h  6  a row of pixels whose samples weigh as much as their Voronoi cells
#pragma once
#include "path/sampler.h"
#include "voronoi/weights.h"

// For Film::add_row in place of L, the radiance of sample i of a set of pixel x of a row: that
// times n w_i, so that the film's plain mean is the weighted one.  The weights need all n samples
// of a set, so its first one renders them all.  Bias class: see Weighting.
template <class Radiance>
class WeightedRow {
public:
    // Pixel 0 of the row is number `first` of the pattern.
    WeightedRow(Weighting kind, const Pattern& pattern, uint64_t n, uint64_t first, Radiance L)
        : kind_(kind), pattern_(pattern), n_(n), first_(first), L_(L) {}

    const Weigher& weigher() const { return weigher_; }

    rgb operator()(int x, uint64_t i, uint32_t set) {
        if (i == 0) gather(x, set);
        return values_[i] * real((*weights_)[i] * double(values_.size()));
    }

private:
    const Weighting kind_;
    const Pattern& pattern_;
    const uint64_t n_, first_;
    Radiance L_;
    Weigher weigher_;
    std::vector<rgb> values_;
    std::vector<Site> places_;
    const std::vector<double>* weights_ = nullptr;

    void gather(int x, uint32_t set) {
        const uint64_t pixel = first_ + uint64_t(x);
        values_.clear();
        places_.clear();
        for (uint64_t i = 0; i < n_; ++i) {
            const vec2 u = Sampler(pattern_, pixel, i, set).get2(film_x);  // as L draws it
            places_.push_back({double(u.x), double(u.y)});
            values_.push_back(L_(x, i, set));
        }
        // No path draws this number.
        const uint64_t strip = hash(hash(hash(0, pattern_.seed), pixel), UINT64_MAX - set);
        weights_ = &weigher_(kind_, places_, strip);
    }
};

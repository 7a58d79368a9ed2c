// course/subject.h  1  what the tests of week 6 are about: samplers, estimators, intersectors
#pragma once
#include <cstdint>
#include <functional>
#include <optional>

#include "base/vec.h"

namespace penumbra::course {

// Directions about +z from two numbers of [0,1), one direction (of length 1) for each pair, or
// nothing where the pair is rejected; and their density per solid angle.  It is 0 below the
// horizon, and integrates to 1 less the part of the pairs that is rejected.
struct Sampler {
    std::function<std::optional<vec3>(double u, double v)> sample;
    std::function<double(vec3)> pdf;
};

// Estimates of `truth` from n >= 1 random numbers or more, which follow from the seed: other seeds,
// other and independent numbers.  Its mean is `truth` for every n if it is unbiased; if it is
// consistent alone, its mean is off by c / n + O(1 / n^2), with an unknown c.  Either way four
// times as many samples leave at most 0.6 of the standard deviation.
struct Estimator {
    std::function<double(uint64_t seed, int n)> estimate;
    double truth = 0;
    bool unbiased = true;
};

// The points o + t d with 0 < t <= tmax; d has length 1.
struct Beam {
    vec3 o, d;
    double tmax = infinity;
};

// A triangle (r = 0), seen from both its sides, or a sphere (centre a, radius r > 0), met from
// outside and from within.
struct Body {
    vec3 a, b, c;
    double r = 0;
};

// The distance t of the first point of the beam that lies on the body, or nothing.
struct Intersector {
    std::function<std::optional<double>(const Body&, const Beam&)> meet;
};

}  // namespace penumbra::course

// base/stats.h  1  moments that do not cancel
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

// A sum of numbers >= 0 that is the same in any order: in multiples of 2^-60.
__extension__ typedef unsigned __int128 FixedPoint;
inline FixedPoint fixed_point(double x) { return FixedPoint(std::min(x, 0x1p40) * 0x1p60); }
inline double value_of(FixedPoint sum) { return std::ldexp(double(sum), -60); }

// Count, mean and squared distances to it, one number at a time (Welford 1962) or merged (Chan,
// Golub, LeVeque 1983).  Always double: these are statements about numbers, not numbers of the
// renderer.
struct Moments {
    uint64_t n = 0;
    double mean = 0;
    double m2 = 0;  // sum of (x - mean)^2

    void add(double x) {
        const double before = double(n), delta = x - mean, step = delta / double(++n);
        mean += step;
        m2 += delta * step * before;
    }

    void merge(const Moments& other) {
        if (other.n == 0) return;
        const double na = double(n), nb = double(other.n), total = na + nb;
        const double delta = other.mean - mean;
        m2 += other.m2 + delta * delta * (na * nb / total);
        mean += delta * (nb / total);
        n += other.n;
    }

    double variance() const { return n > 1 ? m2 / double(n - 1) : 0; }  // of one x, unbiased
    double standard_error() const { return n ? std::sqrt(variance() / double(n)) : 0; }
};

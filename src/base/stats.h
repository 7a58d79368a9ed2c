// base/stats.h  1  mean and variance without cancellation
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace penumbra {

inline double square(double x) { return x * x; }  // double, also where the renderer uses float

// Count, mean and sum of squared deviations, updated by one number (Welford 1962) or merged (Chan,
// Golub, LeVeque 1983).  Always double, also where the renderer uses float.
struct Moments {
    uint64_t n = 0;
    double mean = 0;
    double m2 = 0;  // sum of (value - mean)^2

    void add(double value) {
        const double before = double(n), delta = value - mean, step = delta / double(++n);
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

    double variance() const { return n > 1 ? m2 / double(n - 1) : 0; }  // unbiased, for one value
    double standard_error() const { return n ? std::sqrt(variance() / double(n)) : 0; }
};

// The p-value, two-sided, of a standard normal z.
inline double p_of_z(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

}  // namespace penumbra

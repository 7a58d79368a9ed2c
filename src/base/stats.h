// base/stats.h  1  moments that do not cancel, and the p-value of z
#pragma once
#include <cmath>
#include <cstdint>

// Count, mean and centred moments, one number at a time (Welford 1962; third moment: Terriberry
// 2007) or merged (Chan, Golub, LeVeque 1983; Pebay 2008).  Always double: these are statements
// about numbers, not numbers of the renderer.
struct Moments {
    uint64_t n = 0;
    double mean = 0;
    double m2 = 0;  // sum of (x - mean)^2
    double m3 = 0;  // sum of (x - mean)^3

    void add(double x) {
        const double before = double(n), delta = x - mean, step = delta / double(++n);
        mean += step;
        m3 += step * step * delta * before * (before - 1) - 3 * step * m2;
        m2 += delta * step * before;
    }

    void merge(const Moments& other) {
        if (other.n == 0) return;
        const double na = double(n), nb = double(other.n), total = na + nb;
        const double delta = other.mean - mean;
        m3 += other.m3 + delta * delta * delta * na * nb * (na - nb) / (total * total) +
              3 * delta * (na * other.m2 - nb * m2) / total;
        m2 += other.m2 + delta * delta * (na * nb / total);
        mean += delta * (nb / total);
        n += other.n;
    }

    double variance() const { return n > 1 ? m2 / double(n - 1) : 0; }  // of one x, unbiased
    double standard_error() const { return n ? std::sqrt(variance() / double(n)) : 0; }
    double skewness() const {
        return m2 > 0 ? std::sqrt(double(n)) * m3 / (m2 * std::sqrt(m2)) : 0;
    }
};

// Two-sided p-value of a standard normal z.
inline double p_of_z(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

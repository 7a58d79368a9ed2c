// stats.h  floor 0  moments that do not cancel, and the p-value of a z
#pragma once
#include <cmath>
#include <cstdint>

// Count, mean and centred second moment, one number at a time (Welford 1962) or merged
// (Chan, Golub, LeVeque 1983). Always double: these are statements about numbers, not numbers
// of the renderer.
struct Moments {
    uint64_t n = 0;
    double mean = 0;
    double m2 = 0;  // sum of (x - mean)^2

    void add(double x) {
        double delta = x - mean;
        mean += delta / double(++n);
        m2 += delta * (x - mean);
    }

    void merge(const Moments& other) {
        if (other.n == 0) return;
        double delta = other.mean - mean;
        double total = double(n + other.n);
        m2 += other.m2 + delta * delta * (double(n) * double(other.n) / total);
        mean += delta * (double(other.n) / total);
        n += other.n;
    }

    double variance() const { return n > 1 ? m2 / double(n - 1) : 0; }  // of one x, unbiased
    double standard_error() const { return n ? std::sqrt(variance() / double(n)) : 0; }
};

// Two-sided p-value of a standard normal z.
inline double p_of_z(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

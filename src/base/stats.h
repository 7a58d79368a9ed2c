// base/stats.h  1  moments that do not cancel, and the p-values of z, t and chi-squared
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

// Regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0: series below a + 1, continued
// fraction (Lentz) above (Abramowitz, Stegun 6.5.29, 6.5.31).
inline double gamma_q(double a, double x) {
    if (x <= 0) return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double k = a + 1; term > sum * 1e-17; ++k) sum += term *= x / k;
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;
    for (int i = 1; i < 10000; ++i) {
        const double numerator = -i * (i - a);
        b += 2;
        d = 1 / (numerator * d + b);
        c = b + numerator / c;
        fraction *= c * d;
        if (std::abs(c * d - 1) < 1e-15) break;
    }
    return front * fraction;
}

// P(X >= chi2) for chi-squared with k degrees of freedom.
inline double p_of_chi2(double chi2, double k) { return gamma_q(k / 2, chi2 / 2); }

// Regularised incomplete beta function I_x(a, b) by continued fraction (Abramowitz, Stegun 26.5.8).
inline double beta_i(double a, double b, double x) {
    if (x <= 0 || x >= 1) return x <= 0 ? 0 : 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - beta_i(b, a, 1 - x);
    const double front = std::exp(a * std::log(x) + b * std::log1p(-x) + std::lgamma(a + b) -
                                  std::lgamma(a) - std::lgamma(b)) /
                         a;
    double c = 1, d = 1 / (1 - (a + b) * x / (a + 1)), fraction = d;
    for (int m = 1; m < 10000; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / (1 + even * d);
        c = 1 + even / c;
        fraction *= c * d;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / (1 + odd * d);
        c = 1 + odd / c;
        fraction *= c * d;
        if (std::abs(c * d - 1) < 1e-15) break;
    }
    return front * fraction;
}

// Two-sided p-value of Student's t with k degrees of freedom; normal from 10^7 on, where p differs
// by t^4 / 4k = 2e-5 of itself at t = 5.
inline double p_of_t(double t, double k) {
    return k < 1e7 ? beta_i(k / 2, 0.5, k / (k + t * t)) : p_of_z(t);
}

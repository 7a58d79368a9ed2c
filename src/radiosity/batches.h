// radiosity/batches.h  1  the error of a map, as the spread of batches tells it
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

// Of a map: in the quadratic mean over surfaces and channels, relative to the quadratic mean of E.
struct MapError {
    double error = NAN;
    double uncertainty = NAN;  // standard error of `error`
};

// Integrals over all surfaces and channels, of batches of one length: of the square of their mean;
// of the square of what batch b is off the mean, and of that times the mean.
template <int batches>
struct BatchSquares {
    double whole = 0;
    std::array<double, batches> off{}, along{};

    // The spread tells the variance of the mean without bias, hence the square of the light, too;
    // their ratio is biased.  Infinite if noise is all that there is.  Its own standard error is
    // that of the jackknife, which leaves out one batch after the other (Tukey 1958).
    MapError stated() const {
        double spread = 0, sum = 0, squares = 0;
        for (double x : off) spread += x;
        const double all = relative(whole, spread / (batches - 1), batches);
        if (!(all > 0) || std::isinf(all)) return {all, all};
        for (size_t b = 0; b < batches; ++b) {
            constexpr double n = batches - 1;  // that are left
            const double rest = whole - 2 * along[b] / n + off[b] / (n * n);
            const double without =
                relative(rest, (spread - off[b] * batches / n) / (n - 1), batches - 1);
            sum += without - all, squares += (without - all) * (without - all);
        }
        // Of the variance of normal numbers it says (n - 1) / (n - 2) times too much.
        const double variance = (squares - sum * sum / batches) * (batches - 2) / batches;
        return {all, std::sqrt(std::max(variance, 0.0))};
    }

private:
    // The error of the mean of all batches, by the mean of n of them and the variance of one.
    static double relative(double square, double variance, int n) {
        const double light = square - variance / n;
        if (variance <= 0) return 0;
        return light > 0 ? std::sqrt(variance / batches / light) : double(INFINITY);
    }
};

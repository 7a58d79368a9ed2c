// radiosity/batches.h  1  the error of a map, estimated from the spread of batches
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {

// The error of a map: the RMSE over surfaces and channels, relative to the RMS of E.
struct MapError {
    double error = NAN;
    double uncertainty = NAN;  // standard error of `error`
};

// Integrals over all surfaces and channels, for batches of one length: of the square of their mean;
// of the squared deviation of batch b; and of that deviation times the mean.
template <int batches>
struct BatchSquares {
    double whole = 0;
    std::array<double, batches> off{}, along{};

    // The spread estimates the variance of the mean without bias, and so the square of the light;
    // their ratio is biased.  Infinite if all is noise.  The jackknife gives its standard error: it
    // leaves out one batch after another (Tukey 1958).
    MapError stated() const {
        double spread = 0, sum = 0, squares = 0;
        for (double x : off) spread += x;
        const double all = relative(whole, spread / (batches - 1), batches);
        if (!(all > 0) || std::isinf(all)) return {all, all};
        for (size_t b = 0; b < batches; ++b) {
            constexpr double n = batches - 1;  // batches left
            const double rest = whole - 2 * along[b] / n + off[b] / (n * n);
            const double without =
                relative(rest, (spread - off[b] * batches / n) / (n - 1), batches - 1);
            sum += without - all, squares += (without - all) * (without - all);
        }
        // It overestimates the variance of normal numbers (n - 1) / (n - 2) times.
        const double variance = (squares - sum * sum / batches) * (batches - 2) / batches;
        return {all, std::sqrt(std::max(variance, 0.0))};
    }

private:
    // The error of the mean of all batches, from the mean of n of them and the variance of one.
    static double relative(double square, double variance, int n) {
        const double light = square - variance / n;
        if (variance <= 0) return 0;
        return light > 0 ? std::sqrt(variance / batches / light) : double(INFINITY);
    }
};

}  // namespace penumbra

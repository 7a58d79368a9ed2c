// radiosity/missing.h  4  a bound on the error of a map, from the unshot exitance
//
// The missing light is F U + F rho F U + ..., with the unshot exitance U and its transport F.  The
// kernel of F is symmetric, and no point sees more than a hemisphere, so F increases no RMS
// (Schur's test), and the sum is at most b = |U| / (1 - greatest rho).  No missing light is
// negative, so that limit^2 >= E^2 + missing^2.  Both hold except for the discretisation of F.
#pragma once
#include <array>

#include "base/vec.h"

namespace penumbra {

// Integrals over surfaces: of the square of E, all channels together, and of the square of U.
struct Missing {
    double light = 0;
    std::array<double, 3> unsent{};

    void add(const Missing& other) {
        light += other.light;
        for (size_t k = 0; k < 3; ++k) unsent[k] += other.unsent[k];
    }

    // An element with E and U at its corners.  The integral of the square of a linear function with
    // corner values a, b, c is A / 12 ((a + b + c)^2 + a^2 + b^2 + c^2).
    void add(double area, const std::array<rgb, 3>& E, const std::array<rgb, 3>& U) {
        auto square = [](const std::array<rgb, 3>& x) {
            const rgb sum = x[0] + x[1] + x[2];
            return sum * sum + x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
        };
        const rgb ofE = square(E), ofU = square(U);
        for (size_t k = 0; k < 3; ++k) {
            light += area / 12 * double(ofE.*axis[k]);
            unsent[k] += area / 12 * double(ofU.*axis[k]);
        }
    }

    // Adds missing exitance at any place: |U + V| <= |U| + |V|.
    void lose(const Missing& other) {
        for (size_t k = 0; k < 3; ++k) {
            const double sum = std::sqrt(unsent[k]) + std::sqrt(other.unsent[k]);
            unsent[k] = sum * sum;
        }
    }

    // Bound on the RMS of the missing light over surfaces and channels, relative to the limit: 1
    // while E is 0.
    double error(rgb max_reflected) const {
        double b2 = 0;
        for (size_t k = 0; k < 3; ++k) {
            const double absorbed = 1 - double(max_reflected.*axis[k]);
            if (unsent[k] > 0) b2 += unsent[k] / (absorbed * absorbed);
        }
        return b2 == 0 ? 0 : std::isinf(b2) ? 1 : std::sqrt(b2 / (light + b2));
    }
};

}  // namespace penumbra

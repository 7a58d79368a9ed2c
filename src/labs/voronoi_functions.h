// labs/voronoi_functions.h  1  functions on a square with their integrals, for voronoi2d
//
// Functions of Table 2 in Vandewiele et al. 2025, "Voronoi integration of the rendering equation",
// and one that vanishes on the border.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "voronoi/plane.h"

namespace penumbra {

// A function on [-1/2, 1/2]^2 with its integral.
struct Function {
    std::string name;
    double (*at)(Site);
    double integral;
    double rim = NAN;  // integral of the outward derivative over the border; NaN: not given
};

namespace functions {

inline double power_of_xy(double alpha, Site p) { return std::pow(std::abs(p.x * p.y), alpha); }
// |x y|^alpha.  Its outward derivative on x = 1/2 is alpha (1/2)^(alpha - 1) |y|^alpha.
inline Function holder(const std::string& alpha, double a, double (*at)(Site)) {
    const double side = 2 * std::pow(0.5, a + 1) / (a + 1);  // integral of |x|^alpha
    return {"holder_" + alpha, at, side * side, 4 * a * std::pow(0.5, a - 1) * side};
}

// The integral of -1 / ln r over the square.  In polar coordinates int r dr / -ln r = E1(-2 ln r)
// up to the side is smooth in phi.  The midpoint rule integrates it over one of eight parts.
inline double integral_of_not_holder() {
    constexpr int steps = 20000;
    double sum = 0;
    for (int k = 0; k < steps; ++k) {
        const double phi = std::numbers::pi / 4 * (k + 0.5) / steps;
        sum += -std::expint(2 * std::log(0.5 / std::cos(phi)));
    }
    return 8 * sum * std::numbers::pi / 4 / steps;
}

// The integral is (2 int_0^1/2 x sin(1/x) dx)^2.  With t = 1/x, integration by parts twice gives
// int_2^inf sin t / t^3 dt = sin 2 / 8 + cos 2 / 4 - (pi/2 - Si(2)) / 2.
inline double integral_of_not_c1() {
    constexpr double si = 1.6054129768026948;  // Si(2)
    const double half = std::sin(2) / 8 + std::cos(2) / 4 - (std::numbers::pi / 2 - si) / 2;
    return 4 * half * half;
}

inline double tent(double x) { return std::max(0.0, 1 - 2 * std::abs(x)); }

inline std::vector<Function> all() {
    return {
        holder("1", 1, [](Site p) { return power_of_xy(1, p); }),
        holder("0.5", 0.5, [](Site p) { return power_of_xy(0.5, p); }),
        holder("0.1", 0.1, [](Site p) { return power_of_xy(0.1, p); }),
        holder("0.01", 0.01, [](Site p) { return power_of_xy(0.01, p); }),
        // The next two are -1 / ln r and x y sin(1/x) sin(1/y).
        {"not_holder", [](Site p) { return -1 / std::log(std::hypot(p.x, p.y)); },
         integral_of_not_holder()},
        {"not_c1", [](Site p) { return p.x * p.y * std::sin(1 / p.x) * std::sin(1 / p.y); },
         integral_of_not_c1()},
        // The outward derivative of hat on x = 1/2 is -2 (1 - 2 |y|).
        {"hat", [](Site p) { return tent(p.x) * tent(p.y); }, 0.25, -4},
    };
}

}  // namespace functions

}  // namespace penumbra

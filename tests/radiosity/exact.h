// radiosity/exact.h  illuminance that is known without a renderer
#pragma once
#include <array>

#include "base/closed_forms.h"

namespace penumbra::exact {

// ---- The cube -----------------------------------------------------------------------------------

// Inside of a cube of 10 m, a point light of 50 000 cd at its centre, walls of reflectance 2/3.
// Points of a face are (x, y) in [-1,1]^2.  L is in nit, +-10^-5: labs/cube_test.cpp derives it
// from the integral equation.  On an edge it is the limit from within the face.
inline constexpr double cube_half_width = 5, cube_intensity = 50000, cube_albedo = 2.0 / 3;

struct CubePoint {
    char name;
    double x, y, luminance;
};
inline constexpr std::array<CubePoint, 6> cube_points = {{{'A', 0, 0, 892.79810},
                                                          {'B', 0.5, 0, 768.69470},
                                                          {'C', 0.5, 0.5, 686.69745},
                                                          {'D', 1, 0, 565.09748},
                                                          {'E', 1, 0.5, 522.41378},
                                                          {'F', 1, 1, 388.44554}}};
inline constexpr double cube_mean_luminance =
    2000.0 / 3;  // by energy: Phi / (A (1 - rho)) rho / pi

// E (lx) before the first bounce.
inline double cube_direct(double x, double y) {
    return cube_intensity / (cube_half_width * cube_half_width) / std::pow(1 + x * x + y * y, 1.5);
}

// Integrals of E times the hats of 2 x 2 cells (lm), cut from (-1, -1) towards (1, 1).  Vertex 3 j
// + i is at (i - 1, j - 1); its hat covers so many triangles of 12.5 m^2.
struct CubeHat {
    std::vector<int> vertices;
    int triangles;
    double flux;
};
inline const std::array<CubeHat, 4> cube_hats = {{{{0, 8}, 2, 24009.1885},
                                                  {{2, 6}, 1, 10738.5565},
                                                  {{1, 3, 5, 7}, 3, 38863.1216},
                                                  {{4}, 6, 89211.2888}}};

// ---- Two concentric spheres ---------------------------------------------------------------------

// Their radii, reflectances rho and exitances M.
struct Spheres {
    double r, R, rho_inner, rho_outer, M_inner, M_outer;
};
struct OfSpheres {
    double inner, outer;
};
// E_inner = B_outer and E_outer = F_21 B_inner + F_22 B_outer, where B = M + rho E.  The form
// factors (Howell's C-136) follow by reciprocity: all light from the inner sphere arrives.
inline OfSpheres illuminances(const Spheres& s) {
    const double to_inner = (s.r / s.R) * (s.r / s.R), own = 1 - to_inner;
    const double outer = (to_inner * (s.M_inner + s.rho_inner * s.M_outer) + own * s.M_outer) /
                         (1 - s.rho_outer * (own + to_inner * s.rho_inner));
    return {s.M_outer + s.rho_outer * outer, outer};
}

}  // namespace penumbra::exact

// radiosity/exact_light_test.cpp  the references for radiosity, against integrals and energy
#include "radiosity/exact.h"

#include <doctest/doctest.h>

using namespace closed_forms;

namespace {

// The mean of f(x, y) over the unit square: n^2 midpoints that crowd towards x = 0 as x^2 does.
double mean(int n, auto f) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = (i + 0.5) / n, v = (j + 0.5) / n;
            sum += 2 * u * f(u * u, v);
        }
    return sum / (n * n);
}

}  // namespace

TEST_CASE("the cube's direct light: a sixth of what the light sends falls on each face") {
    const double side = 2 * exact::cube_half_width;
    const double mean_direct =
        mean(400, [](double x, double y) { return exact::cube_direct(x, y); });
    CHECK(mean_direct * side * side ==
          doctest::Approx(4 * Pi * exact::cube_intensity / 6).epsilon(1e-5));
    const double E = mean_direct / (1 - exact::cube_albedo);
    CHECK(E * exact::cube_albedo / Pi == doctest::Approx(exact::cube_mean_luminance).epsilon(1e-5));
    CHECK(exact::cube_direct(0, 0) == 2000);
    for (const exact::CubePoint& p : exact::cube_points)
        CHECK(p.luminance > exact::cube_albedo / Pi * exact::cube_direct(p.x, p.y));
}

TEST_CASE("rectangles: form factors are means of those at points, and sum to 1 in a box") {
    for (const std::array<double, 3>& box : {std::array{1.0, 1.0, 1.0}, {2.0, 3.0, 1.5}}) {
        // A floor of w x d sees the ceiling at height h, and the wall over the edge x = 0.
        const double w = box[0], d = box[1], h = box[2];
        CAPTURE(w);
        const double to_ceiling = mean(400, [&](double x, double z) {
            const double l = -w * x, r = w + l, n = -d * z, f = d + n;
            return polygon_irradiance({{l, h, n}, {r, h, n}, {r, h, f}, {l, h, f}}) / Pi;
        });
        const double to_wall = mean(400, [&](double x, double z) {
            const double l = -w * x, n = -d * z, f = d + n;
            return polygon_irradiance({{l, 0, n}, {l, h, n}, {l, h, f}, {l, 0, f}}) / Pi;
        });
        CHECK(opposed(w / h, d / h) == doctest::Approx(to_ceiling).epsilon(1e-5));
        CHECK(perpendicular(w / d, h / d) == doctest::Approx(to_wall).epsilon(1e-5));
        const double sum = opposed(w / h, d / h) + 2 * perpendicular(w / d, h / d) +
                           2 * perpendicular(d / w, h / w);
        CHECK(std::abs(sum - 1) < 4e-15);
        // Reciprocity for the areas w d and h d.
        CHECK(w * perpendicular(w / d, h / d) ==
              doctest::Approx(h * perpendicular(h / d, w / d)).epsilon(1e-14));
    }
    CHECK(std::abs(opposed(1, 1) - 0.199824895698) < 1e-12);
    CHECK(std::abs(perpendicular(1, 1) - 0.200043776075) < 1e-12);
}

TEST_CASE("a sphere in a sphere: the mean of what points of the outer one see, wherever it lies") {
    const double R = 2, r = 0.5;
    for (double offset : {0.0, 0.3, 1.2}) {
        CAPTURE(offset);
        double sum = 0;
        const int n = 2000;
        for (int i = 0; i < n; ++i) {
            // Bands of equal area; the direction to the inner sphere's centre at (0, 0, offset).
            const double z = R * (2 * (i + 0.5) / n - 1);
            const double d = std::sqrt(R * R - 2 * z * offset + offset * offset);
            sum += sphere_irradiance(r / d, (R * R - z * offset) / (R * d)) / Pi / n;
        }
        CHECK(exact::to_inner_sphere(r, R) == doctest::Approx(sum).epsilon(1e-5));
    }
    CHECK(exact::to_inner_sphere(r, R) + exact::to_itself(r, R) == 1);
}

TEST_CASE(
    "two spheres that emit and reflect: the sum of all bounces; what is emitted is absorbed") {
    const exact::Spheres s{0.5, 2, 0.3, 0.8, 5, 1};
    const double to_inner = exact::to_inner_sphere(s.r, s.R), own = exact::to_itself(s.r, s.R);
    double inner = 0, outer = 0;
    for (int bounce = 0; bounce < 300; ++bounce) {
        const double B_inner = s.M_inner + s.rho_inner * inner,
                     B_outer = s.M_outer + s.rho_outer * outer;
        inner = B_outer, outer = to_inner * B_inner + own * B_outer;
    }
    const exact::OfSpheres E = exact::illuminances(s);
    CHECK(E.inner == doctest::Approx(inner).epsilon(1e-13));
    CHECK(E.outer == doctest::Approx(outer).epsilon(1e-13));
    const double emitted = s.r * s.r * s.M_inner + s.R * s.R * s.M_outer;
    const double absorbed =
        s.r * s.r * (1 - s.rho_inner) * E.inner + s.R * s.R * (1 - s.rho_outer) * E.outer;
    CHECK(absorbed == doctest::Approx(emitted).epsilon(1e-14));
    // In a furnace both have the same E.
    const exact::OfSpheres uniform = exact::illuminances({0.5, 2, 0.3, 0.8, 0.7 * 4, 0.2 * 4});
    CHECK(uniform.inner == doctest::Approx(4).epsilon(1e-14));
    CHECK(uniform.outer == doctest::Approx(4).epsilon(1e-14));
}

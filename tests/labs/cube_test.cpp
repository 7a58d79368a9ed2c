// labs/cube_test.cpp  the cube's radiosity, derived without tables
#include "labs/cube.h"

#include <doctest/doctest.h>

#include "radiosity/exact.h"

namespace {

using namespace penumbra;
using cube::Solution;

const Solution& room() {
    static const Solution solution;
    return solution;
}

double relative(double value, double truth) { return std::abs(value / truth - 1); }

// Points off the nodes, from the middle to the darkest place.
const double places[] = {0, 0.3, 0.77, 0.99, 0.9999, 1 - 1e-7};

// E at the end of a ray from the point (x, y) of the face z = -1.
double at_end_of_ray(double x, double y, double sin2, double phi) {
    const double dx = std::sqrt(sin2) * std::cos(phi), dy = std::sqrt(sin2) * std::sin(phi),
                 dz = std::sqrt(1 - sin2);
    const double to_x = (std::copysign(1, dx) - x) / dx, to_y = (std::copysign(1, dy) - y) / dy,
                 to_z = 2 / dz, t = std::min({to_x, to_y, to_z});
    const double hit_x = x + t * dx, hit_y = y + t * dy, hit_z = t * dz - 1;
    return t == to_z   ? room().illuminance(hit_x, hit_y)
           : t == to_x ? room().illuminance(hit_y, hit_z)
                       : room().illuminance(hit_x, hit_z);
}

// The irradiance over all directions of density cos / pi: sin^2 and azimuth are uniform (Malley).
// Pieces end where rays change walls.  It shares with the solver only E at the ends of rays, and
// nodes for integrals.
double by_rays(double x, double y) {
    const std::vector<cube::Graded> rule = cube::graded(48);
    std::vector<double> corners;
    for (double a : {-1, 1})
        for (double b : {-1, 1}) corners.push_back(std::atan2(b - y, a - x));
    std::sort(corners.begin(), corners.end());
    double sum = 0;
    for (size_t i = 0; i < 4; ++i) {
        const double width =
            i < 3 ? corners[i + 1] - corners[i] : corners[0] + 2 * cube::pi - corners[3];
        for (const cube::Graded& g : rule) {
            const double phi = corners[i] + width * g.at, c = std::cos(phi), s = std::sin(phi);
            const double to_wall =
                std::min((std::copysign(1, c) - x) / c, (std::copysign(1, s) - y) / s);
            const double to_ceiling = to_wall * to_wall / (to_wall * to_wall + 4);
            for (const cube::Graded& h : rule)
                sum += width / (2 * cube::pi) * g.weight * h.weight *
                       (to_ceiling * at_end_of_ray(x, y, to_ceiling * h.at, phi) +
                        (1 - to_ceiling) * at_end_of_ray(x, y, 1 - (1 - to_ceiling) * h.at, phi));
        }
    }
    return cube::direct(x, y) + cube::albedo * sum;
}

}  // namespace

TEST_CASE("the cube at A to F and in the mean: the numbers of radiosity/exact.h, to 10^-5 nit") {
    for (const exact::CubePoint& p : exact::cube_points) {
        CAPTURE(p.name);
        CHECK(std::abs(room().luminance(p.x, p.y) - p.luminance) < 1e-5);
    }
    CHECK(relative(cube::mean_illuminance * cube::albedo / cube::pi, exact::cube_mean_luminance) <
          1e-15);
    for (double x : places)
        CHECK(cube::direct(x, 0.3) == doctest::Approx(exact::cube_direct(x, 0.3)));
    // The published value, to 0.1 nit; only C was printed 0.1 too low.
    CHECK(std::abs(room().luminance(0, 0) - 892.8) < 0.05);
    CHECK(std::abs(room().luminance(0.5, 0) - 768.7) < 0.05);
    CHECK(std::abs(room().luminance(0.5, 0.5) - 686.6) < 0.1);
    CHECK(std::abs(room().luminance(1, 0) - 565.1) < 0.05);
    CHECK(std::abs(room().luminance(1, 0.5) - 522.4) < 0.05);
    CHECK(std::abs(room().luminance(1, 1) - 388.4) < 0.05);
}

TEST_CASE("the cube's solution converges: each step from 12 to 24 nodes brings a digit") {
    const Solution coarse({12}), middle({16}), fine({20});
    for (const exact::CubePoint& p : exact::cube_points) {
        CAPTURE(p.name);
        const double L = room().luminance(p.x, p.y);
        const double first = std::abs(coarse.luminance(p.x, p.y) - middle.luminance(p.x, p.y)) / L,
                     second = std::abs(middle.luminance(p.x, p.y) - fine.luminance(p.x, p.y)) / L,
                     third = std::abs(fine.luminance(p.x, p.y) - L) / L;
        CHECK(first < 1e-5);
        CHECK(second < 1e-6);
        CHECK(third < 1e-7);
        // The limit if steps keep their ratio (Aitken); the last steps are rounding.
        CHECK((third < 1e-10 || third * third / (second - third) < 1e-8));
    }
    // Integrals with more nodes do not change any digit.
    const Solution closer({12, 16, 48});
    for (const exact::CubePoint& p : exact::cube_points)
        CHECK(relative(closer.luminance(p.x, p.y), coarse.luminance(p.x, p.y)) < 1e-9);
}

TEST_CASE("the cube's form factors sum to 1 at every point, at edges and corners, too") {
    for (double x : places)
        for (double y : places) CHECK(std::abs(room().closure(x, y) - 1) < 1e-12);
    for (double y : places) CHECK(std::abs(room().closure(1, y) - 1) < 1e-12);
    CHECK(std::abs(room().closure(-1, 1) - 1) < 1e-12);
}

TEST_CASE("the cube's equation holds between the nodes, and E goes on steadily to the edges") {
    for (double x : places)
        for (double y : places) {
            CAPTURE(x);
            CAPTURE(y);
            CHECK(relative(room().illuminance(x, y), room().by_equation(x, y)) < 2e-7);
            CHECK(room().illuminance(x, y) == room().illuminance(-x, y));
            CHECK(relative(room().illuminance(x, y), room().illuminance(y, x)) < 1e-14);
        }
    for (double y : places)
        CHECK(relative(room().illuminance(1 - 1e-12, y), room().illuminance(1, y)) < 2e-7);
}

TEST_CASE("towards an edge E falls as s^0.69, as two walls at a right angle want it") {
    // E = E_edge + c s^a with the kernel s t / (2 (s^2 + t^2)^(3/2)) between the walls requires 1 /
    // rho = int_0^inf t^a t / (2 (1 + t^2)^(3/2)) dt, a beta function.
    auto bounce = [](double a) {
        return std::tgamma(a / 2 + 1) * std::tgamma((1 - a) / 2) / (4 * std::tgamma(1.5));
    };
    double low = 0, high = 1;
    while (high - low > 1e-12)
        (bounce((low + high) / 2) < 1 / cube::albedo ? low : high) = (low + high) / 2;
    auto rise = [](double s) { return room().illuminance(1 - s, 0) - room().illuminance(1, 0); };
    const double seen = std::log2(rise(2e-6) / rise(1e-6));
    CHECK(low == doctest::Approx(0.69).epsilon(0.005));
    CHECK(std::abs(seen - low) < 0.002);
}

TEST_CASE("the cube's equation by rays over the hemisphere, from none of the solver's formulas") {
    for (const cube::Point& p : {cube::Point{0.3, 0.55}, {0.95, 0.2}, {0.9999, 0.7}}) {
        CAPTURE(p.x);
        CHECK(relative(by_rays(p.x, p.y), room().by_equation(p.x, p.y)) < 1e-9);
    }
}

TEST_CASE("integrals over triangles of the face: they add up, and hats to the whole") {
    // A grid of 4 x 4, cut from the lower left to the upper right.
    auto one = [](double, double) { return 1.0; };
    auto f = [](double x, double y) { return 1 + x - y * y + x * x * y; };
    double whole = 0, of_f = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            const double x = i / 2.0 - 1, y = j / 2.0 - 1;
            const cube::Point a{x, y}, b{x + 0.5, y}, c{x + 0.5, y + 0.5}, d{x, y + 0.5};
            for (const std::array<cube::Point, 3>& t : {std::array{a, b, c}, std::array{a, c, d}}) {
                whole += cube::integral(room(), t, one);
                of_f += cube::integral(room(), t, f);
            }
        }
    CHECK(relative(whole / 4, exact::cube_mean_luminance) < 1e-8);
    const cube::Point a{-1, -1}, b{1, -1}, c{1, 1}, d{-1, 1};
    CHECK(relative(
              cube::integral(room(), {a, b, d}, f, 40) + cube::integral(room(), {b, c, d}, f, 40),
              of_f) < 1e-8);
    // The hats of the three corners add up to 1.
    const cube::Point p{0.5, 0.5}, q{1, 0.5}, r{1, 1};
    auto near_p = [](double x, double) { return 2 - 2 * x; };
    auto near_r = [](double, double y) { return 2 * y - 1; };
    auto near_q = [&](double x, double y) { return 1 - near_p(x, y) - near_r(x, y); };
    const std::array t{p, q, r};
    CHECK(relative(cube::integral(room(), t, near_p) + cube::integral(room(), t, near_q) +
                       cube::integral(room(), t, near_r),
                   cube::integral(room(), t, one)) < 1e-13);
}

TEST_CASE("integrals of E times the hats of 2 x 2 cells: the numbers of radiosity/exact.h") {
    // Cells are halved from one corner to the opposite one; they are coarse, hence n = 24.
    for (const exact::CubeHat& hat : exact::cube_hats)
        for (int vertex : hat.vertices) {
            double nit = 0;  // over [-1,1]^2
            for (double x : {-1, 0})
                for (double y : {-1, 0})
                    for (bool upper : {false, true}) {
                        const std::array<cube::Point, 3> t = {
                            {{x, y},
                             upper ? cube::Point{x + 1, y + 1} : cube::Point{x + 1, y},
                             upper ? cube::Point{x, y + 1} : cube::Point{x + 1, y + 1}}};
                        const double px = vertex % 3 - 1, py = vertex / 3 - 1;
                        for (size_t k = 0; k < 3; ++k) {
                            if (t[k].x != px || t[k].y != py) continue;
                            const cube::Point a = t[(k + 1) % 3], b = t[(k + 2) % 3];
                            auto twice = [](cube::Point p, cube::Point q, double sx, double sy) {
                                return (q.x - p.x) * (sy - p.y) - (q.y - p.y) * (sx - p.x);
                            };
                            nit += cube::integral(
                                room(), t,
                                [&](double sx, double sy) {
                                    return twice(a, b, sx, sy) / twice(a, b, px, py);
                                },
                                24);
                        }
                    }
            const double lumen = 25 * nit * cube::pi / cube::albedo;  // 10 m per side: 25 times
            CHECK(lumen == doctest::Approx(hat.flux).epsilon(1e-7).scale(0));
        }
}

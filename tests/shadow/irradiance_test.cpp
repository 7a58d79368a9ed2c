// shadow/irradiance_test.cpp  closed forms against published values, quadrature and each other
#include "shadow/irradiance.h"

#include "base/closed_forms.h"
#include "shadow/checks.h"

namespace {

// The integral of cos+ over the cone of half-angle sigma about an axis at this elevation: in closed
// form over the azimuth, by quadrature over the polar angle theta.  The horizon first cuts the
// circle at theta = kink.  A split there and theta = kink + (..) u^2 smooth the root.
double cone_by_quadrature(double elevation, double sigma) {
    const double pi_ = std::numbers::pi, kink = std::min(std::abs(elevation), sigma),
                 rest = sigma - kink;
    auto circle = [&](double theta) {
        const double a = std::cos(theta) * std::sin(elevation),
                     b = std::sin(theta) * std::cos(elevation);
        if (a >= b) return 2 * pi_ * a * std::sin(theta);
        if (a <= -b) return 0.0;
        return 2 * (a * std::acos(-a / b) + std::sqrt((b - a) * (b + a))) * std::sin(theta);
    };
    auto below = [&](double u) { return kink * circle(kink * u); };
    auto above = [&](double u) { return 2 * u * rest * circle(kink + rest * u * u); };
    const oracle::Agreement close{1e-14 * sigma * sigma * sigma, 1e-14};
    return oracle::integral(below, 0, 1, close) + oracle::integral(above, 0, 1, close);
}

Polygon polygon(std::initializer_list<vec3> corners) {
    Polygon p;
    for (vec3 v : corners) p.add(v);
    return p;
}
Polygon quad(vec3 p, vec3 u, vec3 v) { return polygon({p, p + u, p + u + v, p + v}); }

// A differential element and the rectangle a x b at distance h above it, one corner on its normal
// (Howell, catalogue, C-11 for a differential element), times pi.
double corner(double a, double b, double h) {
    const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / 2;
}

}  // namespace

TEST_CASE("sphere irradiance: published values at 75, 90 and 105 degrees") {
    const struct {
        double cosine, s2, E, within;
    } rows[] = {{std::cos(75 * std::numbers::pi / 180), 0.25, 0.221200880053, 5e-12},
                {0, 0.25, 0.090586073706, 1e-12},
                {std::cos(105 * std::numbers::pi / 180), 0.25, 0.017924877377, 5e-11},
                {1, 0.25, std::numbers::pi / 4, 1e-12},
                {0, 1, std::numbers::pi / 2, 1e-12}};
    for (const auto& row : rows) {
        CAPTURE(row.cosine);
        CHECK(double(irradiance_sphere(real(row.cosine), real(row.s2))) ==
              approx(row.E, row.within));
    }
    CHECK(irradiance_sphere(std::cos(121 * pi / 180), 0.25) == 0);
    CHECK(irradiance_sphere(-1, 1) == 0);
}

TEST_CASE("sphere irradiance: every tilt against quadrature, from a touching sphere to s = 1e-9") {
    for (double s :
         {1 - 1e-6, 0.999, 0.9, 0.6, 0.3, 0.26, 0.24, 0.1, 1e-2, 1e-3, 5e-4, 1e-4, 1e-6, 1e-9}) {
        const double sigma = std::asin(s);
        for (int i = -24; i <= 24; ++i) {
            const double k = i / 20.0, elevation = k * sigma, cosine = std::sin(elevation);
            if (std::abs(elevation) > std::numbers::pi / 2) continue;
            const double truth = cone_by_quadrature(elevation, sigma);
            const double E = double(irradiance_sphere(real(cosine), real(s * s)));
            INFO("s = ", s, ", k = ", k, ": ", E, " expected ", truth);
            // Relative to the largest value at the horizon; rounding of s^2 and cos shifts k.
            const double slack = single ? 2e-6 : 2e-13;
            CHECK(std::abs(E - truth) <= slack * (s * s * s + truth) / std::sqrt(1.000001 - s * s));
        }
    }
}

TEST_CASE("polygon irradiance: a ceiling and a wall that the horizon halves") {
    auto E = [](vec3 p, vec3 u, vec3 v) { return double(irradiance_polygon(quad(p, u, v))); };
    CHECK(E({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}) == approx(1.740839502734));
    CHECK(E({1, -1, -1}, {0, 2, 0}, {0, 0, 2}) == approx(0.350188287714));
    CHECK(E({1, -1, -2}, {0, 2, 0}, {0, 0, 2}) == 0);
    CHECK(E({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}) == 0);
}

TEST_CASE("polygon irradiance: a corner overhead at every size, across the change of formula") {
    for (double size = 1e-9; size < 1e7; size *= 1.7) {
        const double a = size, b = 0.6 * size;
        const Polygon p = quad({0, 0, 1}, {real(a), 0, 0}, {0, real(b), 0});
        INFO("size ", size);
        CHECK(double(irradiance_polygon(p)) == approx(corner(a, b, 1), 2e-12, 3e-5));
    }
}

TEST_CASE(
    "polygon irradiance: a tiny one is its area times both cosines over the square distance") {
    for (int power = single ? -10 : -20; power >= (single ? -12 : -32); power -= 2) {
        const real side = std::ldexp(real(1), power);
        const vec3 centre{1, 2, 2}, u{side, 0, 0}, v{0, side, 0};
        const double E = double(irradiance_polygon(quad(centre - (u + v) / 2, u, v)));
        const double truth = double(dot(cross(u, v), centre)) * 2 / 81;
        INFO("side 2^", power);
        CHECK(E == approx(std::abs(truth), 1e-11, 2e-5));
    }
}

TEST_CASE("polygon irradiance: random triangles and parallelograms against Lambert's sum") {
    oracle::Random random(oracle::seed_of("polygon irradiance"));
    auto number = [&] { return real(2 * random() - 1); };
    int cut = 0;
    for (int i = 0; i < 3000; ++i) {
        const vec3 centre = unit({number(), number(), number() / 3}) * real(1.2);
        const vec3 u = vec3{number(), number(), number()} * real(0.6),
                   v = vec3{number(), number(), number()} * real(0.6);
        const vec3 p = centre - (u + v) / 2;
        const Polygon whole = i % 2 ? quad(p, u, v) : polygon({p, p + u, p + v});
        std::vector<closed_forms::Point> corners;  // with +y upwards
        for (int k = 0; k < whole.n; ++k) {
            const vec3 at = whole.at(k);
            corners.push_back({double(at.x), double(at.z), double(at.y)});
        }
        const double E = double(irradiance_polygon(whole)),
                     truth = closed_forms::polygon_irradiance(corners);
        INFO("polygon ", i, ": ", E, " expected ", truth);
        CHECK(std::abs(E - truth) < (single ? 4e-6 : 1e-13));
        const Polygon above = above_horizon(whole);
        cut += above.n > 0 && above.n != whole.n;
        for (int k = 0; k < above.n; ++k) CHECK(above.at(k).z >= 0);
    }
    CHECK(cut > 500);
}

TEST_CASE("polygon irradiance: parts add up; order, sense and scale of the corners do not matter") {
    oracle::Random random(oracle::seed_of("polygon additivity"));
    auto number = [&] { return real(2 * random() - 1); };
    auto E = [](const Polygon& p) { return double(irradiance_polygon(p)); };
    for (int i = 0; i < 300; ++i) {
        const real far = std::pow(real(10), real(8 * random() - 1) * (single ? real(0.4) : 1));
        const vec3 p = vec3{number(), number(), number()} * far, u{number(), number(), number()},
                   v{number(), number(), number()};
        const real t = real(random());
        const Polygon q = quad(p, u, v);
        const double whole = E(q);
        // The horizon may leave little of the solid angle; the corners have rounding errors.
        const double distance = double(length(p)) + 1;
        const double angle = double(length(cross(u, v))) / sqr(distance);
        const double slack = angle * (64 * double(ulp) * distance + (single ? 3e-4 : 1e-11));
        const double parts = E(quad(p, u * t, v)) + E(quad(p + u * t, u * (1 - t), v));
        CHECK(std::abs(parts - whole) <= slack);
        const double turned = E(polygon({q.at(2), q.at(3), q.at(0), q.at(1)}));
        CHECK(std::abs(turned - whole) <= slack);
        const double reversed = E(polygon({q.at(3), q.at(2), q.at(1), q.at(0)}));
        CHECK(std::abs(reversed - whole) <= slack);
        CHECK(E(quad(p * 1024, u * 1024, v * 1024)) == whole);
    }
}

TEST_CASE(
    "polygon irradiance: a disc of slices tends to the disc, tilted as a sphere's cap would be") {
    // A sphere looks the same as the disc where its cone meets a plane across the axis.
    const int slices = 2000;
    for (double degrees : {0.0, 40.0, 75.0, 100.0}) {
        const double beta = degrees * std::numbers::pi / 180, s = 0.5, r = s / std::sqrt(1 - s * s);
        const vec3 axis_{real(std::sin(beta)), 0, real(std::cos(beta))};
        const Frame f = frame(axis_);
        double sum = 0;
        for (int i = 0; i < slices; ++i) {
            auto rim = [&](int k) {
                const double phi = 2 * std::numbers::pi * k / slices;
                return axis_ + f.to_world({real(r * std::cos(phi)), real(r * std::sin(phi)), 0});
            };
            sum += double(irradiance_polygon(polygon({axis_, rim(i), rim(i + 1)})));
        }
        const double truth = double(irradiance_sphere(real(std::cos(beta)), real(s * s)));
        CHECK(sum == approx(truth, 1e-5, 1e-4));
    }
}

TEST_CASE(
    "sphere irradiance: a horizon that touches it, within ulps, leaves all of it or nothing") {
    oracle::Random random(oracle::seed_of("sphere at the horizon"));
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        const real s = std::exp2(real(-20 * random() * random())) * real(0.9999);
        for (real side : {real(1), real(-1)})
            for (real cosine = side * s, k = 0; k < 6; ++k, cosine = std::nextafter(cosine, 0)) {
                const double E = double(irradiance_sphere(cosine, s * s));
                const double truth = side > 0 ? std::numbers::pi * std::pow(double(s), 3) : 0;
                worst = std::max(worst, std::abs(E - truth) / std::pow(double(s), 3));
            }
    }
    CHECK(worst < 64 * double(ulp));
}

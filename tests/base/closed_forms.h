// base/closed_forms.h  closed forms of light, independent of the renderer's code
//
// E denotes irradiance.
#pragma once
#include <cmath>
#include <numbers>
#include <vector>

namespace penumbra::closed_forms {

inline constexpr double Pi = std::numbers::pi;

struct Point {
    double x, y, z;
};
inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point operator*(double s, Point a) { return {s * a.x, s * a.y, s * a.z}; }
inline double times(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Point turned(Point a, Point b) {  // the cross product
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double size_of(Point a) { return std::sqrt(times(a, a)); }

// 1 + rho + ... (n terms): the sum over bounces.
inline double geometric(double rho, int n) { return (1 - std::pow(rho, n)) / (1 - rho); }

// E from a sphere of radiance 1; s = radius / distance, c = cosine between the normal and the
// direction to its centre (Martinez, Radiative view factors; Lagarde, de Rousiers 2014).
inline double sphere_irradiance(double s, double c) {
    if (c >= s) return Pi * s * s * c;
    if (c <= -s) return 0;
    const double x = std::sqrt(1 / (s * s) - 1), y = -x * c / std::sqrt(1 - c * c);
    const double q = std::sqrt(1 - c * c) * std::sqrt(1 - y * y);
    return s * s * (c * std::acos(y) - x * q) + std::atan(q / x);
}

// E from the half of that sphere behind an edge through its axis, all above the horizon. n_a and
// n_h are the normal's components along the axis and from the edge towards the visible half.  This
// is Lambert's integral along half the rim and back along the edge.
inline double half_sphere_irradiance(double s, double n_a, double n_h) {
    return Pi / 2 * s * s * n_a + (std::asin(s) - s * std::sqrt(1 - s * s)) * n_h;
}

// E at the origin, normal +y, from a convex polygon of radiance 1, clipped at the horizon.
// Lambert: the sum over the edges of their angle times the cosine of their plane (Arvo 1995).
inline double polygon_irradiance(const std::vector<Point>& corners) {
    std::vector<Point> above;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Point a = corners[i], b = corners[(i + 1) % corners.size()];
        if (a.y >= 0) above.push_back(a);
        if (a.y * b.y < 0) above.push_back(a + (a.y / (a.y - b.y)) * (b - a));
    }
    double sum = 0;
    for (size_t i = 0; i < above.size(); ++i) {
        const Point a = above[i], b = above[(i + 1) % above.size()], axis_ab = turned(a, b);
        const double sine = size_of(axis_ab);
        if (sine > 0) sum += std::atan2(sine, times(a, b)) * axis_ab.y / sine;
    }
    return std::abs(sum) / 2;
}

// Form factor of equal opposed rectangles a x b at distance c: x = a / c, y = b / c (Howell C-11).
inline double opposed(double x, double y) {
    const double u = std::sqrt(1 + x * x), v = std::sqrt(1 + y * y);
    return 2 / (Pi * x * y) *
           (std::log(u * v / std::sqrt(1 + x * x + y * y)) + x * v * std::atan(x / v) +
            y * u * std::atan(y / u) - x * std::atan(x) - y * std::atan(y));
}

// Form factor from a rectangle of width w (over the common edge) to its neighbour of height h at a
// right angle (Howell C-14).
inline double perpendicular(double w, double h) {
    const double W = w * w, H = h * h, S = W + H;
    return (w * std::atan(1 / w) + h * std::atan(1 / h) -
            std::sqrt(S) * std::atan(1 / std::sqrt(S)) +
            (std::log((1 + W) * (1 + H) / (1 + S)) + W * std::log(W * (1 + S) / ((1 + W) * S)) +
             H * std::log(H * (1 + S) / ((1 + H) * S))) /
                4) /
           (Pi * w);
}

// Form factor from a disc of radius a to a coaxial disc of radius b at distance h (Howell C-41).
inline double coaxial(double a, double b, double h) {
    const double A = a / h, B = b / h, x = 1 + (1 + B * B) / (A * A);
    return (x - std::sqrt(x * x - 4 * (b / a) * (b / a))) / 2;
}

// Form factor from an element to a parallel disc of radius r at height h, axis at distance a.
inline double element_to_disc(double a, double r, double h) {
    const double H = h * h / (a * a), K = r * r / (a * a), z = 1 + H + K;
    return (1 - (1 + H - K) / std::sqrt(z * z - 4 * K)) / 2;
}

inline double sphere_solid_angle(double s) { return 2 * Pi * s * s / (1 + std::sqrt(1 - s * s)); }

// Solid angle of a rectangle seen along its axis; p and q are the tangents of its half-angles.
inline double rectangle_solid_angle(double p, double q) {
    return 4 * std::atan(p * q / std::sqrt(1 + p * p + q * q));
}

}  // namespace penumbra::closed_forms

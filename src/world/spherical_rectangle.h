// world/spherical_rectangle.h  1  uniform directions towards a rectangle
#pragma once
#include <optional>

#include "base/vec.h"

// A rectangle by the directions and the lengths of its edges; a = 0: the edges are not
// perpendicular.
struct RectangleFrame {
    vec3 x, y, z;
    real a = 0, b = 0;
};
inline RectangleFrame rectangle_frame(vec3 u, vec3 v) {
    const real a = length(u), b = length(v);
    if (std::abs(dot(u, v)) > 16 * ulp * a * b) return {};
    const vec3 x = u / a, y = v / b;
    return {x, y, cross(x, y), a, b};
}

// A rectangle as seen from a point, in the frame of its edges: x0 ... x1 by y0 ... y1 in the plane
// z = z0 < 0.  The solid angle is the excess of the angles between the planes through its sides
// (Urena, Fajardo, King 2013, CGF 32(4)).
struct SeenRectangle {
    vec3 x, y, z;
    real x0, x1, y0, y1, z0;
    real b0, b1, k;
    real solid_angle;
};

// Corner p relative to the point.  Nothing if the edges are not perpendicular, or if the excess is
// so small that too few of its digits would be left.
inline std::optional<SeenRectangle> see_rectangle(const RectangleFrame& of, vec3 p) {
    constexpr real least = sizeof(real) == 4 ? real(4e-3) : real(1e-5);  // about ulp^(1/3)
    if (of.a == 0) return {};
    SeenRectangle r;
    r.x = of.x, r.y = of.y, r.z = of.z;
    r.z0 = dot(p, r.z);
    if (r.z0 > 0) {
        r.z = -r.z;
        r.z0 = -r.z0;
    }
    r.x0 = dot(p, r.x);
    r.y0 = dot(p, r.y);
    r.x1 = r.x0 + of.a;
    r.y1 = r.y0 + of.b;
    // Normals of the four planes have z components -y0, x1, y1, -x0 over these lengths; neighbours
    // are perpendicular but for z.
    const real n0 = -r.y0 / std::hypot(r.z0, r.y0), n1 = r.x1 / std::hypot(r.z0, r.x1);
    const real n2 = r.y1 / std::hypot(r.z0, r.y1), n3 = -r.x0 / std::hypot(r.z0, r.x0);
    r.b0 = n0;
    r.b1 = n2;
    r.k = 2 * pi - std::acos(-n2 * n3) - std::acos(-n3 * n0);
    r.solid_angle = std::acos(-n0 * n1) + std::acos(-n1 * n2) - r.k;
    if (!(r.solid_angle > least)) return {};
    return r;
}

// The point of the rectangle, relative to where it is seen from.
inline vec3 sample_rectangle(const SeenRectangle& r, vec2 u) {
    // The part of the solid angle on the side of x0 is u.x.
    const real angle = u.x * r.solid_angle + r.k;
    const real f = (std::cos(angle) * r.b0 - r.b1) / std::sin(angle);
    const real c = std::clamp(std::copysign(1 / std::hypot(f, r.b0), f), -below_one, below_one);
    const real x = std::clamp(-c * r.z0 / std::sqrt((1 - c) * (1 + c)), r.x0, r.x1);
    // On the strip of this x the sine of the elevation is uniform (Archimedes).
    const real d = std::hypot(x, r.z0);
    const real h0 = r.y0 / std::hypot(d, r.y0), h1 = r.y1 / std::hypot(d, r.y1);
    const real h = std::clamp(h0 + u.y * (h1 - h0), -below_one, below_one);
    const real y = std::clamp(h * d / std::sqrt((1 - h) * (1 + h)), r.y0, r.y1);
    return x * r.x + y * r.y + r.z0 * r.z;
}
inline real pdf_rectangle(const SeenRectangle& r) { return 1 / r.solid_angle; }

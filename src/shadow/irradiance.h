// shadow/irradiance.h  1  irradiance by unoccluded spheres and polygons
//
// Irradiance over radiance (sr): the integral of max(0, cos theta) over the directions to the
// emitter, with theta from the receiver's normal.  A diffuse surface reflects rho / pi of it to the
// eye.  The part below the receiver's horizon is clipped.
#pragma once
#include <algorithm>
#include <array>
#include <optional>

#include "base/vec.h"

namespace penumbra {

// ---- Spheres ----------------------------------------------------------------------------------

// t - atan(t) for t >= 0 without cancellation.
inline real t_minus_atan(real t) {
    if (t > real(0.25)) return t - std::atan(t);
    real sum = 0, power = t * t * t;
    for (real k = 3; std::abs(power / k) > sum * ulp / 4; k += 2, power *= -t * t) sum += power / k;
    return sum;
}

// A sphere with its centre at `cosine` to the normal, and with half-angle sigma, sin^2(sigma) =
// (r / d)^2 <= 1 (Martinez, Radiative view factors; Lagarde, de Rousiers 2014).  If the horizon
// cuts it, with y = -cot(sigma) cot(beta), q = sin(beta) sqrt(1 - y^2), t = q tan(sigma):
//   E / L = sin^2 cos(beta) acos(y) + atan(t) - q sin(sigma) cos(sigma).
// The last two cancel to their third order for small sigma: q sin cos = t - t sin^2.
inline real irradiance_sphere(real cosine, real sin2) {
    if (sqr(cosine) >= sin2) return cosine > 0 ? pi * sin2 * cosine : 0;
    const real s = std::sqrt(sin2);
    const real cos_sigma = std::sqrt(1 - sin2), sin_beta = std::sqrt((1 - cosine) * (1 + cosine));
    const real y = std::clamp(-cos_sigma * cosine / (s * sin_beta), real(-1), real(1));
    const real q = sin_beta * std::sqrt((1 - y) * (1 + y));
    const real first = sin2 * cosine * std::acos(y);
    if (q * s > cos_sigma) return first + std::atan2(q * s, cos_sigma) - q * s * cos_sigma;
    const real t = q * s / cos_sigma;
    return std::max(real(0), first + sin2 * t - t_minus_atan(t));
}

// ---- Polygons ---------------------------------------------------------------------------------

// A convex polygon seen from the receiver: vertices relative to it, z along its normal.
struct Polygon {
    int n = 0;
    std::array<vec3, 8> v;
    void add(vec3 p) { v[size_t(n++)] = p; }
    vec3 at(int i) const { return v[size_t(i < n ? i : i - n)]; }  // i < 2 n
};

// The part of at most four corners above the horizon z = 0 (Sutherland, Hodgman 1974).
inline Polygon above_horizon(const Polygon& p) {
    Polygon above;
    for (int i = 0; i < p.n; ++i) {
        const vec3 a = p.at(i), b = p.at(i + 1);
        if (a.z > 0) above.add(a);
        if ((a.z > 0) != (b.z > 0)) {
            const vec3 c = a + (b - a) * (a.z / (a.z - b.z));
            above.add({c.x, c.y, 0});
        }
    }
    return above;
}

// Small polygons: the integral of cos cos' / r^2 over the area, on each triangle of a fan by the
// midpoints of its sides.  This rule is exact to second order: its error is the angle cubed.
inline real irradiance_by_area(const Polygon& p) {
    real sum = 0;
    for (int i = 1; i + 1 < p.n; ++i) {
        const vec3 a = p.at(0), b = p.at(i), c = p.at(i + 1), twice_area = cross(b - a, c - a);
        for (const vec3 m : {(a + b) / 2, (b + c) / 2, (c + a) / 2}) {
            const real r2 = dot(m, m);
            sum += std::abs(dot(twice_area / r2, m)) * (m.z / r2);
        }
    }
    return sum / 6;
}

// A sum over the edges, exact for polygons of any size (Lambert 1760; Arvo 1995, thesis, sec. 3).
// The sum cancels: its error is some ulp divided by the angle.
inline real irradiance_lambert(const Polygon& p) {
    // exercise 5.5
    // E / L = 1/2 |sum of Theta (Gamma)_z|, Theta the angle under which an edge is seen and Gamma
    // the unit normal of its plane with the receiver.
    real sum = 0;
    const vec3 first = unit(p.at(0));
    vec3 a = first;
    for (int i = 1; i <= p.n; ++i) {
        const vec3 b = i < p.n ? unit(p.at(i)) : first, c = cross(a, b);
        const real sine = length(c);
        if (sine > 0) sum += std::atan2(sine, dot(a, b)) * (c.z / sine);
        a = b;
    }
    return std::abs(sum) / 2;
    // end
}

// A polygon of three or four corners, from either side, by the more accurate formula.
inline real irradiance_polygon(const Polygon& whole) {
    constexpr real small = sizeof(real) == 4 ? real(1.6e-2) : real(1e-4);  // ulp^(1/4)
    const Polygon p = above_horizon(whole);
    real side2 = 0, nearest2 = infinity;
    for (int i = 0; i < p.n; ++i) {
        const vec3 side = p.at(i + 1) - p.at(i);
        side2 = std::max(side2, dot(side, side));
        nearest2 = std::min(nearest2, dot(p.at(i), p.at(i)));
    }
    if (p.n < 3) return 0;
    return side2 < sqr(small) * nearest2 ? irradiance_by_area(p) : irradiance_lambert(p);
}

// ---- Needles ----------------------------------------------------------------------------------

// x - sin(x) for x >= 0 without cancellation.
inline real x_minus_sin(real x) {
    if (x > real(0.5)) return x - std::sin(x);
    real sum = 0, term = x * x * x / 6;
    for (real k = 4; std::abs(term) > sum * ulp / 4; k += 2) {
        sum += term;
        term *= -x * x / (k * (k + 1));
    }
    return sum;
}

// A triangle from the corner a to a side with midpoint m = a + d that is short compared with its
// distance.  Its irradiance, divided by twice its area times the distance of its plane, is the
// integral of s z / r^4 for s from 0 to 1 along a + s d above the horizon.  With the angle psi from
// a towards m and z = a_z / |a| cos(psi) + t_z sin(psi), it is the integral of
// sin(psi) z |a| / |a x d|^2.
inline real along_needle(vec3 a, vec3 d) {
    const real a2 = dot(a, a), ad = dot(a, d), r = std::sqrt(a2), crossed = length(cross(a, d));
    if (!(crossed > 0)) return 0;  // edge-on
    const real m_z = a.z + d.z, a_z = a.z / r, t_z = (d.z * a2 - a.z * ad) / (r * crossed);
    if (a.z <= 0 && m_z <= 0) return 0;
    const real horizon = a.z < 0 ? std::atan2(-a_z, t_z) : std::atan2(a_z, -t_z);
    auto twice_integral = [&](real psi) {  // from 0
        return a_z * sqr(std::sin(psi)) + t_z * x_minus_sin(2 * psi) / 2;
    };
    const real lower = a.z < 0 ? twice_integral(horizon) : 0;
    const real upper = twice_integral(m_z < 0 ? horizon : std::atan2(crossed, a2 + ad));
    return (upper - lower) * r / (2 * sqr(crossed));
}

// The triangle a, a + u, a + v if it is thin compared with its distance, by its median lines.  The
// error is the square of the angle of its height.  A sum over edges would cancel, and corners that
// are rounded to ulp of their distance would lose the height itself.
inline std::optional<real> irradiance_needle(vec3 a, vec3 u, vec3 v) {
    constexpr real thin = sizeof(real) == 4 ? real(4e-3) : real(6e-6);  // ulp^(1/3)
    const vec3 w = v - u, twice_area = cross(u, v);
    const real uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
    // From one end of its longest side, that side and the one to the third corner.
    vec3 p = a, e = u, f = v;
    if (ww > uu && ww > vv) p = a + u, e = w, f = -u;
    if (vv >= uu && vv >= ww) e = v, f = u;
    const real ee = dot(e, e), nearest = std::clamp(-dot(p, e) / ee, real(0), real(1));
    const real distance = length(p + e * nearest), height = length(twice_area / std::sqrt(ee));
    if (!(height < thin * distance)) return {};
    const real foot = dot(e, f) / ee, unit_ = 1 / distance;  // foot of the height on that side
    p = p * unit_, e = e * unit_, f = f * unit_;
    const vec3 to_middle = (f + e * foot) / 2;  // to the middle of the height
    return std::abs(dot(twice_area * unit_ * unit_, p)) *
           (foot * along_needle(p, to_middle) + (1 - foot) * along_needle(p + e, to_middle - e));
}

// ---- Triangles and parallelograms -------------------------------------------------------------

// A quad with this corner and two edges.
inline real irradiance_triangle(vec3 a, vec3 u, vec3 v) {
    if (const auto thin = irradiance_needle(a, u, v)) return *thin;
    Polygon p;
    for (vec3 corner : {a, a + u, a + v}) p.add(corner);
    return irradiance_polygon(p);
}

inline real irradiance_quad(vec3 a, vec3 u, vec3 v) {
    const auto half = irradiance_needle(a, u, v), other = irradiance_needle(a + u + v, -u, -v);
    if (half && other) return *half + *other;
    Polygon p;
    for (vec3 corner : {a, a + u, a + u + v, a + v}) p.add(corner);
    return irradiance_polygon(p);
}

}  // namespace penumbra

// world/warp.h  1  points and directions from uniform numbers u in [0,1)^2, with densities
//
// Every sampler stands above its density.  Densities are per solid angle (1/sr) unless the name
// ends in _area (1/length^2).  Local z is the axis.
#pragma once
#include "base/portable.h"
#include "base/vec.h"

namespace penumbra {

// The point at u turns of the unit circle, 0 <= u <= 1.  The nearest quarter of a turn is split off
// exactly.  For the remainder, |x| <= pi / 4, Taylor polynomials are exact to rounding.
inline vec2 unit_circle(real u) {
    const int quarter = int(4 * u + real(0.5));
    const real x = 2 * pi * (u - real(quarter) / 4), x2 = x * x;
    constexpr auto over = [](int n) constexpr {
        double product = 1;
        for (int i = 2; i <= n; ++i) product *= i;
        return real(1 / product);
    };
    real cosine = over(16), sine = over(15);
    cosine = cosine * x2 - over(14), sine = sine * x2 - over(13);
    cosine = cosine * x2 + over(12), sine = sine * x2 + over(11);
    cosine = cosine * x2 - over(10), sine = sine * x2 - over(9);
    cosine = cosine * x2 + over(8), sine = sine * x2 + over(7);
    cosine = cosine * x2 - over(6), sine = sine * x2 - over(5);
    cosine = cosine * x2 + over(4), sine = sine * x2 + over(3);
    cosine = cosine * x2 - over(2), sine = sine * x2 - 1;
    cosine = cosine * x2 + 1, sine = -x * sine;
    const bool odd = quarter & 1;
    const real sign_c = quarter == 1 || quarter == 2 ? -1 : 1, sign_s = quarter & 2 ? -1 : 1;
    return {sign_c * (odd ? sine : cosine), sign_s * (odd ? cosine : sine)};
}

// At u turns about z.
inline vec3 spherical(real cos_theta, real sin_theta, real u) {
    const vec2 at = unit_circle(u);
    return {sin_theta * at.x, sin_theta * at.y, cos_theta};
}

// exercise 2.1
// Uniform over the hemisphere z > 0: z = 1 - u is uniform (Archimedes).
inline vec3 sample_uniform_hemisphere(vec2 u) {
    real z = 1 - u.x;
    return spherical(z, std::sqrt(u.x * (1 + z)), u.y);
}
inline real pdf_uniform_hemisphere(real cos_theta) { return cos_theta > 0 ? 1 / (2 * pi) : 0; }

// Uniform over the sphere: z is uniform in [-1,1].
inline vec3 sample_uniform_sphere(vec2 u) {
    return spherical(1 - 2 * u.x, 2 * std::sqrt(u.x * (1 - u.x)), u.y);
}
inline real pdf_uniform_sphere() { return 1 / (4 * pi); }
// end

// Directions of the hemisphere z > 0, dense where their cosine is large.
// exercise 2.2
// A uniform point of the disc, lifted to the hemisphere (Malley 1988).
inline vec3 sample_cosine_hemisphere(vec2 u) {
    return spherical(std::sqrt(1 - u.x), std::sqrt(u.x), u.y);
}
inline real pdf_cosine_hemisphere(real cos_theta) {
    return cos_theta > 0 ? cos_theta * (1 / pi) : 0;
}
// end

// Directions about z with a density proportional to cos^n(alpha), 0 for alpha >= 90 degrees
// (Phong 1975; Lafortune, Willems 1994).
// exercise 2.4
// The density is (n+1)/(2 pi) cos^n(alpha), and cos(alpha) = (1-u)^(1/(n+1)); 1 - cos^2 by expm1
// keeps its digits for large n.
inline vec3 sample_phong_lobe(vec2 u, real n) {
    double log_cos = portable::log1p(-u.x) / (n + 1);
    return spherical(portable::exp(log_cos), std::sqrt(-portable::expm1(2 * log_cos)), u.y);
}
inline real pdf_phong_lobe(real cos_alpha, real n) {
    return cos_alpha > 0 ? (n + 1) / (2 * pi) * portable::pow(cos_alpha, n) : 0;
}
// end

// exercise 2.5
// Solid angle of the cone of half-angle sigma, from sin^2(sigma), sigma <= 90 degrees:
// 2 pi (1 - cos) = 2 pi sin^2 / (1 + cos) without cancellation.
inline real solid_angle_cone(real sin2_max) {
    return 2 * pi * sin2_max / (1 + std::sqrt(1 - sin2_max));
}

// Uniform over that cone about z.  With x = 1 - cos(theta), sin^2(theta) = x (2 - x).
inline vec3 sample_cone(vec2 u, real sin2_max) {
    real x = u.x * sin2_max / (1 + std::sqrt(1 - sin2_max));
    return spherical(1 - x, std::sqrt(x * (2 - x)), u.y);
}
inline real pdf_cone(real sin2_max) { return 1 / solid_angle_cone(sin2_max); }
// end

// A triangle with corner at the origin and edges e, f.
// exercise 2.3
// The corner's barycentric coordinate is 1 - sqrt(u) (Turk 1990).
inline vec3 sample_triangle(vec2 u, vec3 e, vec3 f) {
    real s = std::sqrt(u.x);
    return s * (1 - u.y) * e + s * u.y * f;
}
inline real pdf_triangle_area(vec3 e, vec3 f) { return 2 / length(cross(e, f)); }
// end

// Uniform over the parallelogram with corner at the origin and edges e, f.
inline vec3 sample_quad(vec2 u, vec3 e, vec3 f) { return u.x * e + u.y * f; }
inline real pdf_quad_area(vec3 e, vec3 f) { return 1 / length(cross(e, f)); }

// Weight of the technique with density pdf beside one with density other, for one sample of each
// (power heuristic, Veach 1997, eq. 9.14), without overflow.  Infinite pdf (a delta) weighs 1.
inline real power_heuristic(real pdf, real other) {
    if (pdf == 0) return 0;
    real ratio = other / pdf;
    return 1 / (1 + ratio * ratio);
}

}  // namespace penumbra

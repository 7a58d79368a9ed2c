// base/vec.h  1  numbers, vectors, colours and frames
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace penumbra {

#ifndef REAL
#define REAL double
#endif
using real = REAL;  // the only switch of precision: make REAL=float

inline constexpr real pi = std::numbers::pi_v<real>;
inline constexpr real infinity = std::numeric_limits<real>::infinity();
inline constexpr real ulp = std::numeric_limits<real>::epsilon() / 2;  // rounding error of one op
inline constexpr real below_one = 1 - ulp;                             // largest real < 1

// The top bits of a random word, 53 in double, 24 in float, as a number in [0,1): none becomes 1.
inline real to_unit(uint64_t bits) {
    constexpr int digits = std::numeric_limits<real>::digits;
    return real(bits >> (64 - digits)) * (1 / real(uint64_t(1) << digits));
}

inline real sqr(real x) { return x * x; }

struct vec2 {
    real x = 0, y = 0;
};

// Width and height of an image, in pixels.
struct Size {
    int width = 0, height = 0;
};

struct vec3 {
    real x = 0, y = 0, z = 0;
};
using rgb = vec3;  // linear radiance or reflectance, one number per channel

// A coordinate axis, to be used as v.*axis[i].
inline constexpr real vec3::*axis[3] = {&vec3::x, &vec3::y, &vec3::z};

inline vec3 operator+(vec3 a, vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline vec3 operator-(vec3 a, vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline vec3 operator*(vec3 a, vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline vec3 operator*(vec3 a, real b) { return {a.x * b, a.y * b, a.z * b}; }
inline vec3 operator*(real a, vec3 b) { return b * a; }
inline vec3 operator/(vec3 a, real b) { return {a.x / b, a.y / b, a.z / b}; }
inline vec3 operator-(vec3 a) { return {-a.x, -a.y, -a.z}; }
inline vec3& operator+=(vec3& a, vec3 b) { return a = a + b; }
inline vec3& operator*=(vec3& a, vec3 b) { return a = a * b; }
inline vec3& operator/=(vec3& a, real b) { return a = a / b; }
inline bool operator==(vec3 a, vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

inline real dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline real length(vec3 a) { return std::sqrt(dot(a, a)); }
// NaN if a component is: std::max would lose one of y or z.
inline real max_of(vec3 a) {
    const real sum = a.x + a.y + a.z;
    return std::isnan(sum) ? sum : std::max({a.x, a.y, a.z});
}
inline real max_abs(vec3 a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }
inline real mean_of(vec3 a) { return (a.x + a.y + a.z) / 3; }
// For vectors whose square is denormal or infinite: a power of two scales them first, exactly.
[[gnu::noinline]] inline vec3 unit_of_extreme(vec3 a) {
    constexpr int exponent = std::numeric_limits<real>::max_exponent / 4 * 3;
    a = a * std::ldexp(real(1), max_abs(a) < 1 ? exponent : -exponent);
    return a / length(a);
}

// Within 4.5 ulp for any length.  Always inlined: paths call it all the time.
[[gnu::always_inline]] inline vec3 unit(vec3 a) {
    const real a2 = dot(a, a);
    if (!std::isnormal(a2)) [[unlikely]]
        return unit_of_extreme(a);
    return a * (1 / std::sqrt(a2));
}

inline bool is_finite(vec3 a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

// a b - c d within 1.5 ulp, however much cancels (Kahan; Jeannerod et al. 2013, Math. Comp. 82).
inline real difference_of_products(real a, real b, real c, real d) {
    real cd = c * d;
    return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

// a + b = value + error, exactly (Knuth).
struct ExactSum {
    real value, error;
};
inline ExactSum exact_sum(real a, real b) {
    const real value = a + b, b_added = value - a;
    return {value, (a - (value - b_added)) + (b - b_added)};
}

// Accurate component by component: the normals of slivers depend on it.
inline vec3 cross(vec3 a, vec3 b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

// Right-handed orthonormal frame (x, y, n); local z is n.
struct Frame {
    vec3 x, y, n;
    vec3 to_world(vec3 local) const { return x * local.x + y * local.y + n * local.z; }
    vec3 to_local(vec3 world) const { return {dot(world, x), dot(world, y), dot(world, n)}; }
};

// Frame about the unit vector n, continuous except at the plane n.z = 0, stable at both poles
// (Duff et al. 2017, JCGT 6(1)).
inline Frame frame(vec3 n) {
    real sign = std::copysign(real(1), n.z);
    real a = -1 / (sign + n.z);
    real b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

}  // namespace penumbra

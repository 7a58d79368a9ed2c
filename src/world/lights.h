// world/lights.h  2  light sampling: spheres, polygons, points
#pragma once
#include <optional>

#include "world/shapes.h"
#include "world/warp.h"

namespace penumbra {

// To be made by the functions below, which compute n and pdf_area.
struct Light {
    enum class Kind { sphere, triangle, quad, point } kind = Kind::point;
    vec3 p = {};          // centre of a sphere, corner of a polygon, the point
    vec3 u = {}, v = {};  // edges of a polygon; it emits on the side of u x v
    real r = 0;           // radius of a sphere; it emits outwards
    vec3 n = {};          // unit normal of a polygon
    real pdf_area = 0;    // density of uniform points of a polygon, 1 / its area
    rgb L = {};           // radiance; of a point: intensity, radiance x length^2
    bool twosided = false;
    real error = 0;    // of surface points, see Surface
    real pick = 0;     // probability that the scene chooses this light by its power
    vec3 centre = {};  // a sphere about it, of radius reach
    real reach = 0;

    bool is_round() const { return kind == Kind::sphere || kind == Kind::point; }
    vec3 area_vector() const { return cross(u, v) * real(kind == Kind::quad ? 1 : 0.5); }
};

inline Light point_light(vec3 p, rgb intensity) {
    Light l{Light::Kind::point, p};
    l.L = intensity, l.centre = p;
    return l;
}
inline Light sphere_light(vec3 centre, real r) {
    Light l{Light::Kind::sphere, centre, {}, {}, r};
    l.centre = centre, l.reach = r;
    return l;
}
inline Light triangle_light(vec3 p, vec3 u, vec3 v) {
    Light l{Light::Kind::triangle, p, u, v, 0, unit(cross(u, v)), pdf_triangle_area(u, v)};
    const vec3 c = (u + v) / 3;
    l.centre = p + c, l.reach = std::max({length(c), length(u - c), length(v - c)});
    return l;
}
inline Light quad_light(vec3 p, vec3 u, vec3 v) {
    Light l{Light::Kind::quad, p, u, v, 0, unit(cross(u, v)), pdf_quad_area(u, v)};
    l.centre = p + (u + v) / 2, l.reach = std::max(length(u + v), length(u - v)) / 2;
    return l;
}

// Emitted power in all directions, mean of the channels (watts).  A float might overflow.
inline double power(const Light& l) {
    double L = double(mean_of(l.L)), r = double(l.r);
    constexpr double pi_ = std::numbers::pi;
    if (l.kind == Light::Kind::point) return 4 * pi_ * L;
    if (l.kind == Light::Kind::sphere) return pi_ * L * 4 * pi_ * r * r;
    return pi_ * L * double(length(l.area_vector())) * (l.twosided ? 2 : 1);
}

// A point of the light seen from p: the unit direction to it, the radiance from there and the
// density of wi (1/sr).  A point light has pdf 1 and L = I / d^2.
struct LightSample {
    vec3 wi;
    Surface at;
    rgb L;
    real pdf = 0;
    bool delta = false;
};

// sin^2 of the half-angle of the cone that a sphere subtends; nothing from its inside, nor from
// where rounding leaves open whether p is on its inner side or on its outer.
inline std::optional<real> sin2_subtended(const Light& l, vec3 p) {
    vec3 f = l.p - p;
    real d2 = dot(f, f);
    if (!(d2 > sqr(l.r + l.error))) return {};
    return sqr(l.r) / d2;
}

// Density per solid angle of the direction from p to the point y, for uniform points of a polygon.
inline real pdf_polygon_by_area(const Light& l, vec3 p, const Surface& y) {
    // exercise 2.6
    vec3 w = y.p - p;
    real d2 = dot(w, w);
    real cos_y = std::abs(dot(y.n, w)) / std::sqrt(d2);
    return cos_y > 0 ? l.pdf_area * d2 / cos_y : 0;
    // end
}

// Uniform over the cone that the sphere subtends (Shirley, Wang, Zimmerman 1996).  In radii, the
// ray passes the centre at a distance of sin(beta) = sin(theta) / sin(sigma) and meets the sphere
// cos(beta) before.
inline std::optional<LightSample> sample_sphere_light(const Light& l, vec3 p, vec2 u) {
    auto sin2_max = sin2_subtended(l, p);
    if (!sin2_max) return {};
    vec3 local = sample_cone(u, *sin2_max);
    real sin_max = std::sqrt(*sin2_max), sin2 = sqr(local.x) + sqr(local.y);
    vec3 foot = vec3{local.z * local.x, local.z * local.y, -sin2} / sin_max;
    real before = std::sqrt(std::max(real(0), 1 - sin2 / *sin2_max));
    const Frame f = frame(unit(l.p - p));
    vec3 wi = f.to_world(local);
    vec3 n = unit(f.to_world(foot - before * local));
    return LightSample{wi, {l.p + l.r * n, n, l.error}, l.L, pdf_cone(*sin2_max)};
}

// Uniform over the area; nothing from the side that does not emit.
inline std::optional<LightSample> sample_polygon_light(const Light& l, vec3 p, vec2 u) {
    vec3 on = l.kind == Light::Kind::quad ? sample_quad(u, l.u, l.v) : sample_triangle(u, l.u, l.v);
    Surface y{l.p + on, l.n, l.error};
    vec3 wi = unit(y.p - p);
    real cos_y = -dot(y.n, wi);
    if (!(cos_y > 0 || (l.twosided && cos_y < 0))) return {};
    const real pdf = pdf_polygon_by_area(l, p, y);
    if (!(pdf > 0)) return {};  // edge-on, except for the rounding of wi
    return LightSample{wi, y, l.L, pdf};
}

// Nothing if the light emits nothing from the sampled point to p.
inline std::optional<LightSample> sample_light(const Light& l, vec3 p, vec2 u) {
    if (l.kind == Light::Kind::sphere) return sample_sphere_light(l, p, u);
    if (l.kind != Light::Kind::point) return sample_polygon_light(l, p, u);
    vec3 w = l.p - p;
    real d2 = dot(w, w);
    if (!(d2 > 0)) return {};
    return LightSample{w / std::sqrt(d2), {l.p, {}, 0}, l.L / d2, 1, true};
}

// Density (1/sr) with which sample_light from p chooses the point y of the light.
inline real pdf_light(const Light& l, vec3 p, const Surface& y) {
    if (l.kind == Light::Kind::point) return 0;
    if (l.kind != Light::Kind::sphere) return pdf_polygon_by_area(l, p, y);
    auto sin2_max = sin2_subtended(l, p);
    return sin2_max ? pdf_cone(*sin2_max) : 0;
}

}  // namespace penumbra

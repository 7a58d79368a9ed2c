// world/lights.h  2  light sampling: points, spheres, polygons
//
// A kind of light is a struct with these; the functions at the end call them, Light has the rest.
//     name            in what is told of a path
//     is_delta        true if it has no surface that a ray could meet
//     place(l)        sets what of Emitter follows from its shape, and the centre from l.p
//     intensity(L)    L times the area that it shows from afar, at most; of a point, L itself
//     point(l, u)     a point of its surface, uniformly distributed, by u in [0,1)^2
//     sample(l, p, u) a point that shines on p; none if the point that u chooses does not
//     pdf(l, p, y)    density (1/sr) with which sample from p chooses the point y
#pragma once
#include <optional>
#include <variant>

#include "world/shapes.h"
#include "world/warp.h"

namespace penumbra {

// What a light of any kind has.
struct Emitter {
    vec3 p = {};       // centre of a sphere, corner of a polygon, the point
    rgb L = {};        // radiance; of a point: intensity, radiance x length^2
    real error = 0;    // of surface points, see Surface
    vec3 centre = {};  // of a sphere that holds the light
    real radius = 0;   // of that sphere
    vec3 n = {};        // unit normal of its bright side; 0 if it shines in all directions
    real pdf_area = 0;  // of a polygon: density of uniform points, 1 / its area
    bool twosided = false;

    bool is_round() const { return n == vec3{}; }
};

// A point of the light seen from p: the unit direction to it, the radiance from there and the
// density of wi (1/sr).  A point light has pdf 1 and L = I / d^2.
struct LightSample {
    vec3 wi;
    Surface at;
    rgb L;
    real pdf = 0;
};

// ---- Kinds of lights ----------------------------------------------------------------------------

struct PointLight {
    static constexpr auto name = "point";
    static constexpr bool is_delta = true;

    void place(Emitter&) const {}
    double intensity(double I) const { return I; }
    Surface point(const Emitter& l, vec2) const { return {l.p, {}, l.error}; }
    std::optional<LightSample> sample(const Emitter& l, vec3 p, vec2) const {
        vec3 w = l.p - p;
        real d2 = dot(w, w);
        if (!(d2 > 0)) return {};
        return LightSample{w / std::sqrt(d2), {l.p, {}, 0}, l.L / d2, 1};
    }
    real pdf(const Emitter&, vec3, const Surface&) const { return 0; }
};

// Emits outwards.
struct SphereLight {
    static constexpr auto name = "sphere";
    static constexpr bool is_delta = false;
    real r = 0;  // radius

    void place(Emitter& l) const { l.radius = r; }
    double intensity(double L) const { return L * std::numbers::pi * double(r) * double(r); }
    Surface point(const Emitter& l, vec2 u) const {
        const vec3 n = sample_uniform_sphere(u);
        return {l.p + r * n, n, l.error};
    }
    // sin^2 of the half-angle of the cone that it subtends; nothing from its inside, nor from
    // where rounding leaves open whether p is on its inner side or on its outer.
    std::optional<real> sin2_subtended(const Emitter& l, vec3 p) const {
        vec3 f = l.p - p;
        real d2 = dot(f, f);
        if (!(d2 > sqr(r + l.error))) return {};
        return sqr(r) / d2;
    }
    // Uniform over the cone (Shirley, Wang, Zimmerman 1996).  In radii, the ray passes the centre
    // at a distance of sin(beta) = sin(theta) / sin(sigma) and meets the sphere cos(beta) before.
    std::optional<LightSample> sample(const Emitter& l, vec3 p, vec2 u) const {
        auto sin2_max = sin2_subtended(l, p);
        if (!sin2_max) return {};
        vec3 local = sample_cone(u, *sin2_max);
        real sin_max = std::sqrt(*sin2_max), sin2 = sqr(local.x) + sqr(local.y);
        vec3 foot = vec3{local.z * local.x, local.z * local.y, -sin2} / sin_max;
        real before = std::sqrt(std::max(real(0), 1 - sin2 / *sin2_max));
        const Frame f = frame(unit(l.p - p));
        vec3 wi = f.to_world(local);
        vec3 n = unit(f.to_world(foot - before * local));
        return LightSample{wi, {l.p + r * n, n, l.error}, l.L, pdf_cone(*sin2_max)};
    }
    real pdf(const Emitter& l, vec3 p, const Surface&) const {
        auto sin2_max = sin2_subtended(l, p);
        return sin2_max ? pdf_cone(*sin2_max) : 0;
    }
};

// Density per solid angle of the direction from p to the point y, for uniform points of an area.
inline real pdf_polygon_by_area(const Emitter& l, vec3 p, const Surface& y) {
    // exercise 2.6
    vec3 w = y.p - p;
    real d2 = dot(w, w);
    real cos_y = std::abs(dot(y.n, w)) / std::sqrt(d2);
    return cos_y > 0 ? l.pdf_area * d2 / cos_y : 0;
    // end
}

// Corner p and two edges, which span a triangle or a parallelogram.  Emits on the side of e x f.
template <int corners>
struct PolygonLight {
    static constexpr bool is_delta = false, is_quad = corners == 4;
    static constexpr auto name = is_quad ? "quad" : "triangle";
    vec3 e, f;

    void place(Emitter& l) const {
        const vec3 to_centre = (e + f) / real(is_quad ? 2 : 3);
        l.n = unit(cross(e, f));
        l.pdf_area = is_quad ? pdf_quad_area(e, f) : pdf_triangle_area(e, f);
        l.centre = l.p + to_centre;
        l.radius =
            is_quad ? std::max(length(e + f), length(e - f)) / 2
                    : std::max({length(to_centre), length(e - to_centre), length(f - to_centre)});
    }
    double intensity(double L) const {
        return L * double(length(cross(e, f) * real(is_quad ? 1 : 0.5)));
    }
    Surface point(const Emitter& l, vec2 u) const {
        return {l.p + (is_quad ? sample_quad(u, e, f) : sample_triangle(u, e, f)), l.n, l.error};
    }
    // Uniform over the area; nothing from the side that does not emit.
    std::optional<LightSample> sample(const Emitter& l, vec3 p, vec2 u) const {
        const Surface y = point(l, u);
        vec3 wi = unit(y.p - p);
        real cos_y = -dot(y.n, wi);
        if (!(cos_y > 0 || (l.twosided && cos_y < 0))) return {};
        const real pdf = pdf_polygon_by_area(l, p, y);
        if (!(pdf > 0)) return {};  // edge-on, except for the rounding of wi
        return LightSample{wi, y, l.L, pdf};
    }
    real pdf(const Emitter& l, vec3 p, const Surface& y) const {
        return pdf_polygon_by_area(l, p, y);
    }
};
using TriangleLight = PolygonLight<3>;
using QuadLight = PolygonLight<4>;

using LightKind = std::variant<PointLight, SphereLight, TriangleLight, QuadLight>;

// ---- Lights -------------------------------------------------------------------------------------

struct Light : Emitter {
    LightKind kind;

    Light(vec3 at, auto k, rgb radiance = {}) : kind(std::in_place_type<decltype(k)>, k) {
        p = centre = at, L = radiance;
        std::visit([&](const auto& light) { light.place(*this); }, kind);
    }
    // This kind of light, or null if it is another.
    template <class Kind>
    const Kind* as() const {
        return std::get_if<Kind>(&kind);
    }
    // What its kind answers.
    decltype(auto) ask(auto question) const { return std::visit(question, kind); }
    bool is_delta() const {
        return ask([](const auto& light) { return light.is_delta; });
    }
};

inline const char* name_of(const Light& l) {
    return l.ask([](const auto& light) { return light.name; });
}
// Of the mean of the channels.  A float might overflow.
inline double intensity(const Light& l, double factor = 1) {
    const double L = factor * double(mean_of(l.L));
    return l.ask([&](const auto& light) { return light.intensity(L); });
}
inline std::optional<LightSample> sample_light(const Light& l, vec3 p, vec2 u) {
    return l.ask([&](const auto& light) { return light.sample(l, p, u); });
}
inline real pdf_light(const Light& l, vec3 p, const Surface& y) {
    return l.ask([&](const auto& light) { return light.pdf(l, p, y); });
}
inline Surface point_of(const Light& l, vec2 u) {
    return l.ask([&](const auto& light) { return light.point(l, u); });
}

}  // namespace penumbra

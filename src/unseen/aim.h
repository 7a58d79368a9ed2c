// unseen/aim.h  1  something to aim at: an edge, a corner of a gap, a shape; also in mirrors
#pragma once
#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "base/portable.h"
#include "world/scene.h"

namespace penumbra {

// Each aim has directions from a point y, and their density per solid angle.  Distances h are
// log-uniform from 2^-19 to 1, in units of the aim: their density is 1 / (h log 2^19).
inline constexpr int octaves = 19;  // a gap of a millimetre is beside an edge of 60 m, too
inline constexpr real log_of_octaves = octaves * std::numbers::ln2_v<real>;
inline real distance_of(real u) { return real(portable::pow(0.5, double(octaves * (1 - u)))); }
inline bool is_distance(real h) { return h >= real(1) / (1 << octaves) && h <= 1; }

// Light comes in by gaps, and gaps lie beside edges, from a to b.  The third corner of the edge's
// triangle is c.  A direction from y goes through
//     a + x e + 8 |e| h w,    e = b - a, x uniform in [0,1),
// w the normal of the plane of y and the edge, away from the triangle.
struct EdgeAim {
    vec3 a, b, c;

    bool operator==(const EdgeAim& other) const {  // also of another triangle
        return (a == other.a && b == other.b) || (a == other.b && b == other.a);
    }
    std::optional<vec3> toward(vec3 y, vec2 u) const {
        const vec3 r = a - y, e = b - a, n = cross(e, r);
        if (!(dot(n, n) > 0)) return {};
        const vec3 w = unit(n) * (dot(n, c - a) > 0 ? real(-1) : real(1));
        return unit(r + e * u.x + w * (widest * length(e) * distance_of(u.y)));
    }
    // At t d = r + x e + h w: t^2 / cosine, 1 / |e| and the density of h.  Most edges are told by
    // the signs of h and t, which need no square root.
    real pdf(vec3 y, vec3 d) const {
        const vec3 r = a - y, e = b - a, n = cross(e, r);
        const real dn = dot(d, n), nn = dot(n, n);  // n n is ee rr - er^2, too
        if (!(dot(n, c - a) > 0 ? dn < 0 : dn > 0)) return 0;
        const vec3 in_plane = d - n * (dn / nn);
        const real ee = dot(e, e), er = dot(e, r), rr = dot(r, r);
        const real de = dot(in_plane, e), dr = dot(in_plane, r);
        const real t = nn / (dr * ee - de * er), x = t * (de * rr - dr * er) / nn;
        if (!(t > 0 && x >= 0 && x < 1)) return 0;
        const real width = std::sqrt(ee), h = t * std::abs(dn) / std::sqrt(nn);
        if (!is_distance(h / (widest * width))) return 0;
        const real cosine = std::abs(dot(d, cross(e, n))) / (width * std::sqrt(nn));
        return sqr(t) / (cosine * width * h * log_of_octaves);
    }

private:
    static constexpr real widest = 8;
};

// Where the eye sees an outline cross another, of edges or balls, a gap may begin: h is the tangent
// of the angle between the direction and the one to p.
struct CornerAim {
    vec3 p;

    std::optional<vec3> toward(vec3 y, vec2 u) const {
        const real h = distance_of(u.y);
        const vec2 about = unit_circle(u.x);
        return unit(frame(unit(p - y)).to_world({h * about.x, h * about.y, 1}));
    }
    // h cos^3 dh dphi is the solid angle, 1 / (2 pi) the density of phi.
    real pdf(vec3 y, vec3 d) const {
        const vec3 to = unit(p - y);
        const real cosine = dot(to, d), h = length(cross(to, d)) / cosine;
        if (!(cosine > 0 && is_distance(h))) return 0;
        return 1 / (2 * pi * sqr(h) * sqr(cosine) * cosine * log_of_octaves);
    }
};

// A shape may be small and throw light: the directions of light samples, as if it were a lamp.
class ShapeAim {
public:
    explicit ShapeAim(const Shape& shape)
        : shape_(shape),
          as_light_(shape.is_triangle()
                        ? Light(shape.a, TriangleLight{shape.b - shape.a, shape.c - shape.a})
                        : Light(shape.a, SphereLight{shape.r})) {
        as_light_.twosided = true;
    }
    std::optional<vec3> toward(vec3 y, vec2 u) const {
        const auto at = sample_light(as_light_, y, u);
        return at && pdf(y, at->wi) > 0 ? std::optional(at->wi) : std::nullopt;  // not if edge-on
    }
    real pdf(vec3 y, vec3 d) const {
        const vec3 to_centre = as_light_.centre - y, across = to_centre - d * dot(to_centre, d);
        if (dot(across, across) > sqr(as_light_.radius * real(1.001))) return 0;  // 1.001: rounding
        const Ray ray{y, d};
        const auto hit = intersect(shape_, ray, shear(d), infinity);
        return hit ? pdf_light(as_light_, y, surface(shape_, ray, *hit)) : 0;
    }

private:
    Shape shape_;
    Light as_light_;
};

inline vec3 centroid(const Shape& s) { return s.is_triangle() ? (s.a + s.b + s.c) / 3 : s.a; }
// The same three times as large: glass displaces what it shows.
inline Shape grown(Shape s) {
    const vec3 centre = centroid(s);
    for (vec3* p : {&s.a, &s.b, &s.c}) *p = centre + 3 * (*p - centre);
    s.r *= 3;
    return s;
}

// A mirror or pane of glass: a triangle, or both of a quad.  What it shows to an eye is what the
// eye's image behind it sees.
struct PlaneMirror {
    size_t first, last;  // shapes of the scene
    vec3 a, b, c;        // corners of the first
    vec3 n;              // unit normal

    vec3 turn(vec3 v) const { return v - n * (2 * dot(n, v)); }
    vec3 image(vec3 p) const { return a + turn(p - a); }
    // True if a corner of another is on the eye's side.  Neighbours in one plane do not show each
    // other by rounding: the height counts from 1e-4 of the distance on.
    bool shows(const PlaneMirror& other, vec3 eye) const {
        const real side = dot(n, eye - a) > 0 ? real(1) : real(-1);
        return std::ranges::any_of(std::array{other.a, other.b, other.c}, [&](vec3 p) {
            return side * dot(n, p - a) > real(1e-4) * length(p - a);
        });
    }
};

}  // namespace penumbra

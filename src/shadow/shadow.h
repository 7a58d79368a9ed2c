// shadow/shadow.h  2  light that comes directly from lights: known but for its shadows
//
// On diffuse surfaces the light of spheres and polygons has a closed form U, were nothing in the
// way.  Control, ratio and regression use it where the camera sees the surface itself, not in a
// mirror.  All else stays as sampled and is added: Phong lobes, later vertices of a path, point
// lights, the inside of spheres, and lights nearer to their receiver than rounding.
#pragma once
#include "film/film.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "shadow/estimators.h"
#include "shadow/irradiance.h"

// Of one sample, radiance to the eye: exact without shadows; as one light sample estimates that,
// E[w] = U; and what shadows leave of the estimate.
struct Shadowed {
    rgb U, w, wV;
};
inline bool is_finite(const Shadowed& s) { return is_finite(s.U) && is_finite(s.w); }

// ---- The closed form --------------------------------------------------------------------------

// Whether U counts this light at x.
inline bool has_closed_form(const Light& l, const Surface& x) {
    const real error = 2 * (x.error + l.error);
    if (l.kind == Light::Kind::point) return false;
    const vec3 p = x.p - l.p;
    if (l.kind == Light::Kind::sphere) return dot(p, p) > sqr(l.r + error);
    const vec3 n = cross(l.u, l.v);
    return std::abs(dot(n, p)) > error * length(n);
}

// Irradiance / pi of a diffuse surface by one light that has a closed form.
inline rgb unshadowed_light(const Light& l, const Surface& x, const Frame& local) {
    const vec3 p = l.p - x.p;
    if (l.kind == Light::Kind::sphere) {
        const real d2 = dot(p, p);
        return l.L * (irradiance_sphere(dot(local.n, p) / std::sqrt(d2), sqr(l.r) / d2) / pi);
    }
    if (!l.twosided && dot(cross(l.u, l.v), p) >= 0) return {};  // its dark side
    const vec3 a = local.to_local(p), u = local.to_local(l.u), v = local.to_local(l.v);
    const bool quad = l.kind == Light::Kind::quad;
    return l.L * ((quad ? irradiance_quad(a, u, v) : irradiance_triangle(a, u, v)) / pi);
}

inline rgb unshadowed(const Scene& scene, const Material& m, const Surface& x, const Frame& local) {
    rgb sum;
    if (max_of(m.kd) <= 0) return sum;
    for (const Light& l : scene.lights)
        if (has_closed_form(l, x)) sum += unshadowed_light(l, x, local);
    return m.kd * sum;
}

// ---- One sample ---------------------------------------------------------------------------------

// Of a path's first vertex.  Light samples must be all that brings direct light: LightMode::nee.
inline Shadowed shadowed(const Scene& scene, const Step& e) {
    if (!e.met || scene.depth == 0 || e.x.cos_o == 0 || e.x.material->is_delta()) return {};
    const Vertex& x = e.x;
    const DirectLight& d = e.direct;
    Shadowed s;
    s.U = unshadowed(scene, *x.material, x.at, x.local);
    if (!d.light || !has_closed_form(*d.light, x.at)) return s;
    s.w = x.material->kd / pi * d.sample.L * (d.cosine / d.pdf * d.weight);
    if (!d.occluded) s.wV = s.w;
    return s;
}

// A path's radiance: all that is sampled once and for all, and what a pixel's samples are yet to
// make of the light in `first`.
struct ShadowSample {
    rgb rest;
    Shadowed first;
};

// By steps as Li adds them up, and by the control variate if that is the estimator.  Unbiased.
template <class Account>
ShadowSample shadow_Li(const Scene& scene, const Technique& t, Estimator estimator, const Start& at,
                       Account account) {
    ShadowSample sample;
    Li(scene, t, at.ray, at.sampler, [&](const Segment& s, const Step& e) {
        auto& [rest, first] = sample;
        rest += s.beta * e.Le * e.weight;
        if (s.k == 0) first = shadowed(scene, e);
        rest += s.k == 0 ? e.direct.L - first.wV : s.beta * e.direct.L;
        if (s.k == 0 && estimator == Estimator::control)
            rest += control(first.U, first.w, first.wV);
        account(s, e);
    });
    return sample;
}

// ---- Pixels -------------------------------------------------------------------------------------

// For Film.  Ratio and regression need the moments of all samples of a set: the mean of the ratios
// of single samples would never converge.
struct ShadowPixel {
    static constexpr const char* name = "shadows";
    using Sample = ShadowSample;
    MeanPixel rest;
    ShadowMoments shadowed[3] = {};  // a channel at a time

    static ShadowPixel unwritten() { return {MeanPixel::unwritten(), {}}; }
    static bool fits(const ShadowSample& s) {
        return fits_float(s.rest) && is_finite(s.first.U) && is_finite(s.first.w);
    }
    void add(uint64_t i, const ShadowSample& s) {
        rest.add(i, s.rest);
        for (size_t c = 0; c < 3; ++c)
            shadowed[c].add(double(s.first.U.*axis[c]), double(s.first.w.*axis[c]),
                            double(s.first.wV.*axis[c]));
    }

    void add(const ShadowPixel& p) {
        rest.add(p.rest);
        for (size_t c = 0; c < 3; ++c) shadowed[c] = merge(shadowed[c], p.shadowed[c]);
    }

    double spread(uint64_t i, const ShadowSample& s) const { return rest.spread(i, s.rest); }
    // What shadows leave to be found counts as if V were a coin that falls anew for every sample.
    double noise(uint64_t n, double spread) const {
        double sum = rest.noise(n, spread);
        for (const ShadowMoments& m : shadowed) {
            const double R = visible_part(m);
            sum += n < 2 ? 0 : (m.bb / double(n - 1) + m.w * m.w) * R * (1 - R) / double(n);
        }
        return sum;
    }

    // By an estimator that needs all samples.
    struct Value {
        Estimator estimator = Estimator::ratio;
        double operator()(const ShadowPixel& p, uint64_t n, size_t c) const {
            return p.rest.sum[c] / double(n) + estimate(estimator, p.shadowed[c]);
        }
    };
};

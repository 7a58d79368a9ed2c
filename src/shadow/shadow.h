// shadow/shadow.h  2  direct light: analytic without shadows, sampled shadows
//
// On diffuse surfaces the unshadowed light of spheres and polygons has a closed form U.  Control,
// ratio and regression use it where the camera sees the surface itself, not in a mirror.  They add
// all else as sampled: Phong lobes, later vertices of a path, point lights, the inside of spheres,
// and lights nearer to their receiver than rounding.
#pragma once
#include "app/render.h"
#include "app/threads.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "shadow/estimators.h"
#include "shadow/irradiance.h"

namespace penumbra {

// Radiance to the eye, for one sample: U is exact and unshadowed; w is its estimate by one light
// sample, E[w] = U; wV is the estimate with its shadow.
struct Shadowed {
    rgb U, w, wV;
};
inline bool is_finite(const Shadowed& s) { return is_finite(s.U) && is_finite(s.w); }

// ---- The closed form --------------------------------------------------------------------------

// True if U contains this light at x.
inline bool has_closed_form(const Light& l, const Surface& x) {
    const real error = 2 * (x.error + l.error);
    const vec3 p = x.p - l.p;
    if (l.is_delta()) return false;
    return l.is_round() ? dot(p, p) > sqr(l.radius + error) : std::abs(dot(l.n, p)) > error;
}

// Irradiance by a light at p from a surface, at radiance 1.  Of these kinds alone, not of
// those that derive from them.
template <class Kind>
requires Kind::is_delta real irradiance(const Kind&, vec3, const Frame&) {
    return 0;  // never asked: it has no closed form
}
inline real irradiance(const std::same_as<SphereLight> auto& l, vec3 p, const Frame& local) {
    const real d2 = dot(p, p);
    return irradiance_sphere(dot(local.n, p) / std::sqrt(d2), sqr(l.r) / d2);
}
inline real irradiance(const std::same_as<TriangleLight> auto& l, vec3 p, const Frame& local) {
    return irradiance_triangle(local.to_local(p), local.to_local(l.e), local.to_local(l.f));
}
inline real irradiance(const std::same_as<QuadLight> auto& l, vec3 p, const Frame& local) {
    return irradiance_quad(local.to_local(p), local.to_local(l.e), local.to_local(l.f));
}

// Irradiance / pi of a diffuse surface by one light that has a closed form.
inline rgb unshadowed_light(const Light& l, const Surface& x, const Frame& local) {
    const vec3 p = l.p - x.p;
    if (!l.is_round() && !l.twosided && dot(l.n, p) >= 0) return {};  // its dark side
    return l.L * (l.ask([&](const auto& kind) { return irradiance(kind, p, local); }) / pi);
}

inline rgb unshadowed(const Scene& scene, const Material& m, const Surface& x, const Frame& local) {
    rgb sum;
    if (max_of(m.diffuse()) <= 0) return sum;
    for (const Light& l : scene.lights)
        if (has_closed_form(l, x)) sum += unshadowed_light(l, x, local);
    return m.diffuse() * sum;
}

// ---- One sample ---------------------------------------------------------------------------------

// For the first vertex of a path, without BSDF sampling of direct light: LightMode::nee.
inline Shadowed shadowed(const Scene& scene, const VertexEvents& e) {
    if (!e.met || scene.depth == 0 || e.vertex.cos_o == 0 || e.vertex.material->is_delta())
        return {};
    const Vertex& x = e.vertex;
    const DirectLight& d = e.direct;
    Shadowed s;
    s.U = unshadowed(scene, *x.material, x.at, x.local);
    if (!d.light || !has_closed_form(*d.light, x.at)) return s;
    s.w = x.material->diffuse() / pi * d.sample.L * (d.cosine / d.pdf * d.weight);
    if (!d.occluded) s.wV = s.w;
    return s;
}

// A path's radiance: `rest` is final; an estimator combines `first` of all samples of a pixel.
struct ShadowSample {
    rgb rest;
    Shadowed first;
};

// Adds up what the vertices of a path bring, as Li does.
template <class Visitor>
ShadowSample shadow_Li(const Scene& scene, const Technique& t, const Start& at, Visitor visit) {
    ShadowSample sample;
    Li(scene, t, at.ray, at.sampler, [&](const PathState& path, const VertexEvents& e) {
        auto& [rest, first] = sample;
        rest += path.beta * e.Le * e.weight;
        if (path.k == 0) first = shadowed(scene, e);
        rest += path.k == 0 ? e.direct.L - first.wV : path.beta * e.direct.L;
        visit(path, e);
    });
    return sample;
}

// ---- Pixels -------------------------------------------------------------------------------------

// Moments of n samples: ratio and regression need them, because the mean of ratios of single
// samples would never converge.
struct ShadowPixel {
    Sum rest{};
    ShadowMoments shadowed[3] = {};  // per channel

    void add(const ShadowSample& s) {
        add_to(rest, s.rest);
        for (size_t c = 0; c < 3; ++c)
            shadowed[c].add(double(s.first.U.*axis[c]), double(s.first.w.*axis[c]),
                            double(s.first.wV.*axis[c]));
    }
    rgb value(Estimator e) const {
        rgb L;
        for (size_t c = 0; c < 3; ++c) {
            const ShadowMoments& m = shadowed[c];
            L.*axis[c] = real(rest[c] / double(m.n) + estimate(e, m));
        }
        return L;
    }
};

// The function that renders a sample of the film: the estimate by all n paths of a replication.
inline SampleFunction shadow_estimate(const Scene& scene, const Technique& t,
                                      const SamplerSettings& settings, Estimator e, uint64_t n) {
    return [=, &scene, &settings](PixelSample s, Tally& tally) {
        ShadowPixel pixel;
        for (s.i = 0; s.i < n; ++s.i) {
            const Start at = start(scene, settings, s);
            auto count = [&tally](const PathState&, const VertexEvents& here) {
                if (interrupted) throw Interrupted();
                tally.rays += 1 + (here.direct.light != nullptr);
            };
            const ShadowSample one = shadow_Li(scene, t, at, count);
            if (!fits_float(one.rest) || !is_finite(one.first))
                throw SystemError(in_words(s) + " is not finite (replay it by penumbra " +
                                  in_words(s, "--light nee --pixel ", " --sample ") + ")");
            pixel.add(one);
        }
        return pixel.value(e);
    };
}

}  // namespace penumbra

// direct.h  floor 4  light that comes directly from lights: sampled, and known but for its shadows
//
// On diffuse surfaces the light of spheres and polygons has a closed form U, were nothing in the
// way.  --direct control, ratio and regression use it where the camera sees the surface itself, not
// in a mirror.  All else stays as sampled and is added: Phong lobes, later vertices of a path,
// point lights, the inside of spheres, and lights nearer to their receiver than rounding.
#pragma once
#include "estimators.h"
#include "image.h"
#include "irradiance.h"
#include "options.h"
#include "sampler.h"
#include "scene.h"

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
    Polygon corners;
    corners.add(a);
    corners.add(a + u);
    if (l.kind == Light::Kind::quad) corners.add(a + u + v);
    corners.add(a + v);
    return l.L * (irradiance_polygon(corners) / pi);
}

inline rgb unshadowed(const Scene& scene, const Material& m, const Surface& x, const Frame& local) {
    rgb sum;
    if (max_of(m.kd) <= 0) return sum;
    for (const Light& l : scene.lights)
        if (has_closed_form(l, x)) sum += unshadowed_light(l, x, local);
    return m.kd * sum;
}

// ---- One light sample -------------------------------------------------------------------------

// Whether the path's vertex is one where U is used.
inline bool splits(const Options& o, int vertex) {
    return o.direct != Estimator::stochastic && vertex == 0;
}

struct DirectLight {
    rgb L;              // what is not in `shadowed`
    Shadowed shadowed;  // zeros unless splits()
    uint64_t rays = 0;
    // How it came about; only if a ray was traced.
    const Light* light = nullptr;
    LightSample sample = {};
    real pdf = 0, weight = 0;
    bool occluded = false;
};

// Radiance that one light, chosen at random, sends by way of x to wo: unbiased for the sum of all,
// f L cos / (pick pdf) where nothing is in the way.  Under MIS, its weighted share of it.
inline DirectLight direct_light(const Scene& scene, const Options& o, const Material& m,
                                const Surface& x, const Frame& local, vec3 wo,
                                const Sampler& sampler, int vertex) {
    if (o.light == LightMode::none || scene.lights.empty() || m.is_delta()) return {};
    const bool split = splits(o, vertex);
    DirectLight nothing;
    if (split) nothing.shadowed.U = unshadowed(scene, m, x, local);
    const Light& light = choose_light(scene, sampler.get(dimension(vertex, Draw::pick)));
    const auto s = sample_light(light, x.p, sampler.get2(dimension(vertex, Draw::light_x)));
    if (!s) return nothing;
    const vec3 wi = local.to_local(s->wi);
    const rgb f = eval(m, wo, wi);
    if (max_of(f) <= 0) return nothing;
    const real pdf_light = light.pick * s->pdf;
    const bool share = o.light == LightMode::mis && !s->delta;
    const real weight = share ? power_heuristic(pdf_light, pdf(m, wo, wi, o.direction)) : 1;
    const bool occluded = scene.bvh.occluded(spawn_to(x, s->at));
    const rgb L = occluded ? rgb{} : f * s->L * (wi.z / pdf_light * weight);
    const rgb known = split && has_closed_form(light, x) ? m.kd / pi : rgb{};
    const rgb w = known * s->L * (wi.z / pdf_light * weight);
    const rgb wV = occluded ? rgb{} : w;
    return {L - wV, {nothing.shadowed.U, w, wV}, 1, &light, *s, pdf_light, weight, occluded};
}

// ---- Pixels -----------------------------------------------------------------------------------

// Moments of the samples, per pixel and channel, of even and odd samples apart: ratio and
// regression need those of the whole pixel.  The mean of the ratios of single samples would never
// converge.
class ShadowFilm {
public:
    ShadowFilm(Estimator e, Size size)
        : estimator_(e),
          width_(size_t(size.width)),
          pixels_(width_ * size_t(size.height)),
          next_(pixels_) {}

    // As in Film: a pass adds to copies, which count once it is complete.
    void begin_row(int y) {
        const size_t first = size_t(y) * width_;
        std::copy_n(&pixels_[first], width_, &next_[first]);
    }
    void add(int x, int y, uint64_t sample, const Shadowed& s) {
        Channels& half = next_[size_t(y) * width_ + size_t(x)][sample % 2];
        for (size_t c = 0; c < 3; ++c)
            half[c].add(double(s.U.*axis[c]), double(s.w.*axis[c]), double(s.wV.*axis[c]));
    }
    void end_pass() { pixels_.swap(next_); }

    // Adds the estimates of all samples, or of the even (0) or odd (1) ones alone.
    Image added_to(Image image) const {
        for (size_t i = 0; i < pixels_.size(); ++i)
            for (size_t c = 0; c < 3; ++c)
                image.pixels[i][c] +=
                    float(estimate(estimator_, merge(pixels_[i][0][c], pixels_[i][1][c])));
        return image;
    }
    Image half_added_to(Image image, size_t odd) const {
        for (size_t i = 0; i < pixels_.size(); ++i)
            for (size_t c = 0; c < 3; ++c)
                image.pixels[i][c] += float(estimate(estimator_, pixels_[i][odd][c]));
        return image;
    }

private:
    using Channels = std::array<ShadowMoments, 3>;
    Estimator estimator_;
    size_t width_;
    std::vector<std::array<Channels, 2>> pixels_, next_;
};

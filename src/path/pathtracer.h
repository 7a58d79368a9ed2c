// path/pathtracer.h  3  the path tracer: radiance along a ray, vertex by vertex
//
// Read it downwards: the vertex where a ray stops, light sampling at it, the rendering equation at
// it, the sum over a path.  Directions are in world space unless they are said to be local.
#pragma once
#include <optional>

#include "path/sampler.h"
#include "world/scene.h"

namespace penumbra {

// The estimator of direct light.
enum class LightMode {
    none,  // BSDF sampling only
    nee,   // light sampling only (next-event estimation)
    mis    // both, weighted by the power heuristic
};

// Parameters of paths, apart from the scene.
struct Technique {
    Direction direction = Direction::bsdf;
    LightMode light = LightMode::mis;
    real roulette = real(0.25);  // Russian roulette for paths of a throughput below this; 0: never
};

// A path's numbers stay in registers only if its loop is compiled as one function.  Its parts are
// called in two or three places, so that the compiler does not inline them by itself.
#define PART [[gnu::always_inline]] inline

// ---- Where a ray stops --------------------------------------------------------------------------

struct Vertex {
    Hit hit;
    Surface at;
    const Material* material = nullptr;
    real cos_o = 0;  // between the surface's own normal and wo; negative on its back
    Frame local;     // z is the normal on the side of wo
    vec3 wo;         // to where the ray came from, local
};

PART Vertex vertex(const Scene& scene, const Ray& ray, const Hit& hit) {
    Vertex x;
    x.hit = hit;
    x.at = scene.surface(ray, hit);
    x.material = &scene.material(hit);
    x.cos_o = -dot(x.at.n, ray.d);
    x.local = frame(x.cos_o > 0 ? x.at.n : -x.at.n);
    x.wo = x.local.to_local(-ray.d);
    return x;
}

inline std::optional<Vertex> meet(const Scene& scene, const Ray& ray) {
    const auto hit = scene.bvh.closest(ray);
    return hit ? std::optional(vertex(scene, ray, *hit)) : std::nullopt;
}

// ---- Light sampling -----------------------------------------------------------------------------

// Why a vertex takes no light sample.
enum class Unlit {
    no,  // a shadow ray was traced, or the path ended before
    by_technique,
    without_lights,
    by_delta,         // a mirror or glass
    light_averted,    // the light does not emit towards the surface
    light_behind,     // the light is behind the surface
    reflects_nothing  // the BSDF is 0
};

struct DirectLight {
    rgb L;  // radiance reflected towards wo
    Unlit unlit = Unlit::no;
    // These are set only if a shadow ray was traced.
    const Light* light = nullptr;
    LightSample sample = {};
    real cosine = 0;  // between the normal and the direction to the light
    real pdf = 0;     // of the light and of the point on it (1/sr)
    real weight = 0;  // MIS weight against BSDF sampling
    bool occluded = false;
};

// Samples one light, chosen at random.  Unbiased for the sum over all lights; with MIS, for its
// weighted share.
PART DirectLight direct_light(const Scene& scene, const Technique& t, const Vertex& x,
                              const Sampler& sampler, int vertex) {
    const Material& m = *x.material;
    auto none = [](Unlit why) { return DirectLight{{}, why}; };
    if (t.light == LightMode::none) return none(Unlit::by_technique);
    if (scene.lights.empty()) return none(Unlit::without_lights);
    if (m.is_delta()) return none(Unlit::by_delta);
    const real u_pick = scene.lights.size() > 1 ? sampler.choice(vertex, Draw::pick) : 0;
    const auto chosen = scene.light_tree.choose(x.at.p, x.local.n, u_pick);
    const Light& light = scene.lights[chosen.light];
    const auto s = sample_light(light, x.at.p, sampler.get2(dimension(vertex, Draw::light_x)));
    if (!s) return none(Unlit::light_averted);
    const vec3 wi = x.local.to_local(s->wi);
    const rgb f = eval(m, x.wo, wi);
    if (max_of(f) <= 0) return none(wi.z > 0 ? Unlit::reflects_nothing : Unlit::light_behind);
    // exercise 3.3
    // f L cos / pdf where nothing is in the way; pdf is of the light and of the point on it.
    const real pdf_light = chosen.pick * s->pdf;
    const bool share = t.light == LightMode::mis && !s->delta;
    const real weight = share ? power_heuristic(pdf_light, pdf(m, x.wo, wi, t.direction)) : 1;
    const bool occluded = scene.bvh.occluded(spawn_to(x.at, s->at));
    const rgb L = occluded ? rgb{} : f * s->L * (wi.z / pdf_light * weight);
    return {L, Unlit::no, &light, *s, wi.z, pdf_light, weight, occluded};
    // end
}

// ---- One vertex ---------------------------------------------------------------------------------

// The path so far, after k bounces.  Its last ray was sampled at the point `from` with density pdf
// (infinite: by the camera, a mirror or glass).  Radiance L along this ray contributes beta L to
// the eye.
struct Segment {
    Ray ray;
    vec3 from;
    real pdf = infinity;
    rgb beta{1, 1, 1};
    int k = 0;
    vec3 n = {};    // normal of the surface at `from`, on the side of the ray
    real eta2 = 1;  // factor of beta by refraction, which the path gives back where it leaves glass
};

enum class End { no, leaves_scene, bounces, in_surface, reflects_nothing, roulette };

// The events where that ray stopped.
struct Step {
    bool met = false;  // true if the ray met a surface, at x
    Vertex x = {};
    rgb Le = {};                // emitted towards wo
    real weight = 0;            // MIS weight of Le against light sampling
    DirectLight direct = {};    // reflected towards wo
    BsdfSample scattered = {};  // its wi is local
    vec3 wi = {};               // the same in world space
    End end = End::no;          // reason for termination
    Segment next = {};          // the path so far, if it does not end here
};

// MIS weight of emission that a BSDF sample has met, against light sampling.
inline real weight_of_emission(const Scene& scene, const Technique& t, const Segment& s,
                               const Vertex& x) {
    // exercise 3.4
    if (t.light == LightMode::none || std::isinf(s.pdf)) return 1;
    const size_t i = size_t(scene.light_of[x.hit.id]);
    const real pick = scene.light_tree.pick_of(i, s.from, s.n);
    const real pdf = pick * pdf_light(scene.lights[i], s.from, x.at);
    // Light samples have pdf 0 inside a two-sided sphere light.
    if (t.light == LightMode::nee) return pdf > 0 ? 0 : 1;
    return power_heuristic(s.pdf, pdf);
    // end
}

// The rendering equation (Kajiya 1986) at one vertex x:
//   L(x, wo) = Le(x, wo) + integral over wi of f(x, wo, wi) L(y, -wi) |cos| dwi.
// One direction estimates the integral; one light sample also estimates the direct light.
PART Step step(const Scene& scene, const Technique& t, const Segment& s, const Sampler& sampler) {
    Step e;
    auto ends = [&e](bool here, End why) {
        if (here) e.end = why;
        return here;
    };
    const auto hit = scene.bvh.closest(s.ray);
    if (ends(!hit, End::leaves_scene)) return e;
    e.met = true;
    const Vertex& x = e.x = vertex(scene, s.ray, *hit);
    const Material& m = *x.material;
    if (m.emits()) {
        e.Le = emitted(m, x.cos_o);
        e.weight = weight_of_emission(scene, t, s, x);
    }
    if (ends(s.k == scene.depth, End::bounces)) return e;
    if (ends(x.cos_o == 0, End::in_surface)) return e;
    e.direct = direct_light(scene, t, x, sampler, s.k);

    const vec2 u = sampler.get2(dimension(s.k, Draw::wi_x));
    const real u_lobe = m.has_choice() ? sampler.choice(s.k, Draw::lobe) : 0;
    const BsdfSample& b = e.scattered = sample(m, x.wo, x.cos_o > 0, u_lobe, u, t.direction);
    e.wi = x.local.to_world(b.wi);
    if (ends(max_of(b.f) <= 0, End::reflects_nothing)) return e;
    // exercise 3.2
    // The product of f |cos| / pdf over all bounces.
    rgb beta = s.beta * (b.f * (std::abs(b.wi.z) / b.pdf));
    // end
    // What enters a diamond is as bright when it has left it (Pharr, Jakob, Humphreys 2023, sec.
    // 14.5.4).
    const real eta2 = s.eta2 * b.eta2, threshold = t.roulette * eta2;
    // exercise 3.5
    // Arvo, Kirk 1990.  Surviving paths have a throughput of at least the threshold.
    if (max_of(beta) < threshold) {
        const real survival = max_of(beta) / threshold;
        const real u_survival = sampler.get(dimension(s.k, Draw::roulette));
        if (ends(u_survival >= survival, End::roulette)) return e;
        beta /= survival;
    }
    // end
    const real pdf = m.is_delta() ? infinity : b.pdf;
    e.next = {spawn(x.at, e.wi), x.at.p, pdf, beta, s.k + 1, x.local.n, eta2};
    return e;
}

// ---- The path -----------------------------------------------------------------------------------

struct NoVisitor {
    void operator()(const Segment&, const Step&) const {}
};

// Radiance that arrives along a ray, against its direction.  Unbiased, except for the scene's
// depth.  Calls visit(segment, step) at every vertex.
template <class Visitor = NoVisitor>
rgb Li(const Scene& scene, const Technique& t, const Ray& ray, const Sampler& sampler,
       Visitor visit = {}) {
    // exercise 3.1
    rgb L;
    for (Segment s{ray, ray.o};;) {
        const Step e = step(scene, t, s, sampler);
        L += s.beta * e.Le * e.weight;
        L += s.beta * e.direct.L;
        visit(s, e);
        if (e.end != End::no) return L;
        s = e.next;
    }
    // end
}

#undef PART

}  // namespace penumbra

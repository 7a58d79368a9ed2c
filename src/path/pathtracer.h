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
    real roulette = real(0.25);  // Russian roulette below this throughput / eta2
};

// A path's numbers stay in registers only if its loop is compiled as one function.  Its parts are
// called in two or three places, so the compiler would not inline them by itself.
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

PART Vertex vertex_of(const Scene& scene, const Ray& ray, const Hit& hit) {
    Vertex vertex;
    vertex.hit = hit;
    vertex.at = scene.surface(ray, hit);
    vertex.material = &scene.material(hit);
    vertex.cos_o = -dot(vertex.at.n, ray.d);
    vertex.local = frame(vertex.cos_o > 0 ? vertex.at.n : -vertex.at.n);
    vertex.wo = vertex.local.to_local(-ray.d);
    return vertex;
}

inline std::optional<Vertex> meet(const Scene& scene, const Ray& ray) {
    const auto hit = scene.bvh.closest(ray);
    return hit ? std::optional(vertex_of(scene, ray, *hit)) : std::nullopt;
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

// Samples one light, chosen at random.  Unbiased for the sum over lights; with MIS, for its part.
PART DirectLight direct_light(const Scene& scene, const Technique& technique, const Vertex& vertex,
                              const Sampler& sampler, int k) {
    const Material& material = *vertex.material;
    auto none = [](Unlit why) { return DirectLight{{}, why}; };
    if (technique.light == LightMode::none) return none(Unlit::by_technique);
    if (scene.lights.empty()) return none(Unlit::without_lights);
    if (material.is_delta()) return none(Unlit::by_delta);
    const real u_light = scene.lights.size() > 1 ? sampler.choice(k, Dimension::which_light) : 0;
    const auto chosen = scene.light_choice.choose(vertex.at.p, vertex.local.n, u_light);
    const Light& light = scene.lights[chosen.light];
    const auto sample =
        sample_light(light, vertex.at.p, sampler.get2(dimension(k, Dimension::light_x)));
    if (!sample) return none(Unlit::light_averted);
    const vec3 wi = vertex.local.to_local(sample->wi);
    const rgb f = eval(material, vertex.wo, wi);
    if (max_of(f) <= 0) return none(wi.z > 0 ? Unlit::reflects_nothing : Unlit::light_behind);
    // exercise 3.3
    // f L cos / pdf where nothing is in the way; pdf is of the light and of the point on it.
    const real pdf_light = chosen.probability * sample->pdf;
    const bool by_mis = technique.light == LightMode::mis && !light.is_delta();
    const real weight =
        by_mis ? power_heuristic(pdf_light, pdf(material, vertex.wo, wi, technique.direction)) : 1;
    const bool occluded = scene.bvh.occluded(spawn_to(vertex.at, sample->at));
    const rgb L = occluded ? rgb{} : f * sample->L * (wi.z / pdf_light * weight);
    return {L, Unlit::no, &light, *sample, wi.z, pdf_light, weight, occluded};
    // end
}

// ---- One vertex ---------------------------------------------------------------------------------

// The path so far, after k bounces.  Its last ray was sampled at the point `from` with density pdf
// (infinite: by the camera, a mirror or glass).  Its radiance L contributes beta L to the eye.
struct PathState {
    Ray ray;
    vec3 from;
    real pdf = infinity;
    rgb beta{1, 1, 1};
    int k = 0;
    vec3 n = {};    // normal of the surface at `from`, on the side of the eye
    real eta2 = 1;  // factor of beta by refraction, which the path gives back where it leaves glass
};

enum class End { no, leaves_scene, bounces, in_surface, reflects_nothing, roulette };

// What happens at the vertex where the last ray of a path stops.
struct VertexEvents {
    bool met = false;  // true if the ray met a surface, at the vertex
    Vertex vertex = {};
    rgb Le = {};                // emitted towards wo
    real weight = 0;            // MIS weight of Le against light sampling
    DirectLight direct = {};    // reflected towards wo
    BsdfSample scattered = {};  // its wi is local
    vec3 wi = {};               // the same in world space
    End end = End::no;          // reason for termination
    PathState next = {};        // the path so far, if it does not end here
};

// MIS weight of emission that a BSDF sample has met, against light sampling.
inline real weight_of_emission(const Scene& scene, const Technique& technique,
                               const PathState& path, const Vertex& vertex) {
    // exercise 3.4
    if (technique.light == LightMode::none || std::isinf(path.pdf)) return 1;
    const size_t i = size_t(scene.light_of[vertex.hit.id]);
    const real probability = scene.light_choice.probability_of(i, path.from, path.n);
    const real pdf = probability * pdf_light(scene.lights[i], path.from, vertex.at);
    // Light samples have pdf 0 inside a two-sided sphere light.
    if (technique.light == LightMode::nee) return pdf > 0 ? 0 : 1;
    return power_heuristic(path.pdf, pdf);
    // end
}

// The rendering equation (Kajiya 1986) at one vertex x:
//   L(x, wo) = Le(x, wo) + integral over wi of f(x, wo, wi) L(y, -wi) |cos| dwi.
// One direction estimates the integral; one light sample also estimates the direct light.
PART VertexEvents step(const Scene& scene, const Technique& technique, const PathState& path,
                       const Sampler& sampler) {
    VertexEvents here;
    auto ends = [&here](bool reached, End why) {
        if (reached) here.end = why;
        return reached;
    };
    const auto hit = scene.bvh.closest(path.ray);
    if (ends(!hit, End::leaves_scene)) return here;
    here.met = true;
    const Vertex& vertex = here.vertex = vertex_of(scene, path.ray, *hit);
    const Material& material = *vertex.material;
    if (material.emits()) {
        here.Le = emitted(material, vertex.cos_o);
        here.weight = weight_of_emission(scene, technique, path, vertex);
    }
    if (ends(path.k == scene.depth, End::bounces)) return here;
    if (ends(vertex.cos_o == 0, End::in_surface)) return here;
    here.direct = direct_light(scene, technique, vertex, sampler, path.k);

    const vec2 u = sampler.get2(dimension(path.k, Dimension::wi_x));
    const real u_lobe = material.has_choice() ? sampler.choice(path.k, Dimension::lobe) : 0;
    const BsdfSample& scattered = here.scattered =
        sample(material, vertex.wo, vertex.cos_o > 0, u_lobe, u, technique.direction);
    here.wi = vertex.local.to_world(scattered.wi);
    if (ends(max_of(scattered.f) <= 0, End::reflects_nothing)) return here;
    // exercise 3.2
    // The product of f |cos| / pdf over all bounces.
    rgb beta = path.beta * (scattered.f * (std::abs(scattered.wi.z) / scattered.pdf));
    // end
    // Light that leaves glass gives eta2 back: beta / eta2 counts (Pharr et al. 2023, sec. 14.5.4).
    const real eta2 = path.eta2 * scattered.eta2, threshold = technique.roulette * eta2;
    // exercise 3.5
    // Arvo, Kirk 1990.  Surviving paths have a throughput of at least the threshold.
    if (max_of(beta) < threshold) {
        const real survival = max_of(beta) / threshold;
        const real u_survival = sampler.get(dimension(path.k, Dimension::roulette));
        if (ends(u_survival >= survival, End::roulette)) return here;
        beta /= survival;
    }
    // end
    const real pdf = material.is_delta() ? infinity : scattered.pdf;
    here.next = {
        spawn(vertex.at, here.wi), vertex.at.p, pdf, beta, path.k + 1, vertex.local.n, eta2};
    return here;
}

// ---- The path -----------------------------------------------------------------------------------

struct NoVisitor {
    void operator()(const PathState&, const VertexEvents&) const {}
};

// Radiance that arrives along a ray, against its direction.  Unbiased, except for the scene's
// depth.  Calls visit(path, vertex events) at every vertex.
template <class Visitor = NoVisitor>
rgb Li(const Scene& scene, const Technique& technique, const Ray& ray, const Sampler& sampler,
       Visitor visit = {}) {
    // exercise 3.1
    rgb L;
    for (PathState path{ray, ray.o};;) {
        const VertexEvents here = step(scene, technique, path, sampler);
        L += path.beta * here.Le * here.weight;
        L += path.beta * here.direct.L;
        visit(path, here);
        if (here.end != End::no) return L;
        path = here.next;
    }
    // end
}

#undef PART

}  // namespace penumbra

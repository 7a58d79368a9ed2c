// world/bsdf.h  2  how light scatters: diffuse, Phong, mirror, glass
//
// Local coordinates: z is the surface normal on wo's side, so wo.z > 0.  wo points to the eye, wi
// to the light, both unit.  A kind of scattering is a struct with
//   name      what messages call such a surface
//   eval      f without the cosine (1/sr); 0 for wi.z <= 0 and for a delta direction
//   pdf       density of wi per solid angle over the whole sphere; 0 for a delta direction
//   sample    a direction wi from three numbers; `outside`: wo is on the side of the surface's own
//             normal.  A direction below the horizon is kept, with f = 0: dropping it would bias
//             the estimate.
//   albedo    the greatest part of light that goes on, per channel
//   diffuse   pi times the part of f that is the same for all directions
//   is_delta  it scatters into single directions; transmits: also through the surface
//   has_choice  a direction takes the third number: for reflection or refraction, lobe or cosine
//   ior       index of refraction inside, 1 outside
#pragma once
#include <variant>

#include "world/warp.h"

namespace penumbra {

// Sampling of directions at diffuse and glossy surfaces.
enum class Direction {
    uniform,  // over the hemisphere
    bsdf      // proportional to cosine and Phong lobe, a mixture of the two
};

// A direction, f there and its density.  For a delta direction both contain the same delta, which
// cancels in f / pdf and is left out: pdf is then a probability.
struct BsdfSample {
    vec3 wi;
    rgb f;
    real pdf = 0;
    real eta2 = 1;  // factor of f by which refraction concentrates radiance
};

inline vec3 reflect(vec3 wo) { return {-wo.x, -wo.y, wo.z}; }

// ---- Kinds of scattering ------------------------------------------------------------------------

// Scatters into all directions of its side.
struct Opaque {
    static constexpr bool is_delta = false, transmits = false;
    static constexpr real ior = 1;
};

// f = kd / pi + ks (n+2) / (2 pi) max(0, cos alpha)^n, alpha the angle between wi and the mirror
// direction (Lafortune, Willems 1994).  Reflects at most kd + ks; reciprocal.
struct Rough : Opaque {
    static constexpr auto name = "rough";
    rgb kd;             // diffuse albedo
    rgb ks;             // scale of the Phong lobe
    real exponent = 0;  // of the Phong lobe

    explicit Rough(rgb diffuse_albedo = {}, rgb lobe = {}, real power = 0)
        : kd(diffuse_albedo), ks(lobe), exponent(power) {}

    rgb albedo() const { return kd + ks; }
    rgb diffuse() const { return kd; }
    bool has_choice() const { return !(ks == rgb{}); }

    rgb eval(vec3 wo, vec3 wi) const {
        if (wi.z <= 0) return {};
        if (ks == rgb{}) return kd * (1 / pi);
        real cos_alpha = dot(reflect(wo), wi);
        real lobe =
            cos_alpha > 0 ? (exponent + 2) / (2 * pi) * portable::pow(cos_alpha, exponent) : 0;
        return kd * (1 / pi) + ks * lobe;
    }

    // Fraction of the samples that follow the Phong lobe rather than the cosine.
    real lobe_probability() const {
        if (ks == rgb{}) return 0;
        real cosine = mean_of(kd), lobe = mean_of(ks);
        return lobe > 0 ? lobe / (cosine + lobe) : 0;
    }

    // The Phong lobe may reach below the horizon, where eval is 0.
    real pdf(vec3 wo, vec3 wi, Direction direction) const {
        if (direction == Direction::uniform) return pdf_uniform_hemisphere(wi.z);
        real share = lobe_probability();
        real lobe = share > 0 ? pdf_phong_lobe(dot(reflect(wo), wi), exponent) : 0;
        return (1 - share) * pdf_cosine_hemisphere(wi.z) + share * lobe;
    }

    BsdfSample sample(vec3 wo, bool, real u_lobe, vec2 u, Direction direction) const {
        vec3 wi;
        if (direction == Direction::uniform)
            wi = sample_uniform_hemisphere(u);
        else if (u_lobe < lobe_probability())
            wi = frame(reflect(wo)).to_world(sample_phong_lobe(u, exponent));
        else
            wi = sample_cosine_hemisphere(u);
        return {wi, eval(wo, wi), pdf(wo, wi, direction)};
    }
};

// Scatters into single directions only.
struct Delta : Opaque {
    static constexpr bool is_delta = true;
    rgb eval(vec3, vec3) const { return {}; }
    real pdf(vec3, vec3, Direction) const { return 0; }
};

struct Mirror : Delta {
    static constexpr auto name = "a mirror";
    rgb reflectance;

    explicit Mirror(rgb tint) : reflectance(tint) {}
    rgb albedo() const { return reflectance; }
    rgb diffuse() const { return {}; }
    bool has_choice() const { return false; }
    BsdfSample sample(vec3 wo, bool, real, vec2, Direction) const {
        return {reflect(wo), reflectance / wo.z, 1};
    }
};

struct Glass : Delta {
    static constexpr auto name = "glass";
    static constexpr bool transmits = true;
    real ior;

    explicit Glass(real index) : ior(index) {}
    rgb albedo() const { return {1, 1, 1}; }
    rgb diffuse() const { return {}; }
    bool has_choice() const { return true; }
    BsdfSample sample(vec3 wo, bool outside, real u_lobe, vec2, Direction) const;
};

// exercise 3.6
// Reflectance of a smooth dielectric for unpolarised light (Fresnel); eta = n_i / n_t, cosines of
// the angles of incidence and refraction.
inline real fresnel(real cos_i, real cos_t, real eta) {
    real parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    real perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return (sqr(parallel) + sqr(perpendicular)) / 2;
}

// Reflects with probability Fresnel, else refracts (Snell).  Refraction multiplies radiance by the
// square of (index on the side of wo) / (index on the side of wi), eta^2 (Veach 1997, sec. 5.2).
inline BsdfSample sample_glass(const Glass& m, vec3 wo, bool outside, real u) {
    real eta = outside ? 1 / m.ior : m.ior;
    real cos2_t = (1 - eta) * (1 + eta) + sqr(eta * wo.z);  // 1 - eta^2 sin^2, grazing, too
    real cos_t = cos2_t > 0 ? std::sqrt(cos2_t) : 0;
    real reflectance = cos2_t > 0 ? fresnel(wo.z, cos_t, eta) : 1;
    if (u < reflectance) {
        real f = reflectance / wo.z;
        return {reflect(wo), {f, f, f}, reflectance};
    }
    real f = (1 - reflectance) * sqr(eta) / cos_t;
    return {{-eta * wo.x, -eta * wo.y, -cos_t}, {f, f, f}, 1 - reflectance};
}
// end

inline BsdfSample Glass::sample(vec3 wo, bool outside, real u_lobe, vec2, Direction) const {
    BsdfSample drawn = sample_glass(*this, wo, outside, u_lobe);
    if (drawn.wi.z < 0) drawn.eta2 = sqr(outside ? 1 / ior : ior);
    return drawn;
}

using Scattering = std::variant<Rough, Mirror, Glass>;

// ---- Materials ----------------------------------------------------------------------------------

// Scattering by a surface, on both of its sides, and its emission.
struct Material {
    Scattering scattering = Rough();
    rgb Le = {};            // emitted radiance
    bool twosided = false;  // emits on both sides

    // This kind of scattering, or null if it is another.
    template <class Kind>
    const Kind* as() const {
        return std::get_if<Kind>(&scattering);
    }
    // What its kind of scattering answers.
    decltype(auto) ask(auto question) const { return std::visit(question, scattering); }

    bool is_delta() const {
        return ask([](const auto& kind) { return kind.is_delta; });
    }
    bool transmits() const {
        return ask([](const auto& kind) { return kind.transmits; });
    }
    bool has_choice() const {
        return ask([](const auto& kind) { return kind.has_choice(); });
    }
    rgb albedo() const {
        return ask([](const auto& kind) { return kind.albedo(); });
    }
    rgb diffuse() const {
        return ask([](const auto& kind) { return kind.diffuse(); });
    }
    bool reflects() const { return is_delta() || !(max_of(albedo()) <= 0); }
    bool emits() const { return !(max_of(Le) <= 0); }
};

// Radiance that a surface emits at an angle to its normal with this cosine.
inline rgb emitted(const Material& material, real cosine) {
    return cosine > 0 || material.twosided ? material.Le : rgb{};
}

inline rgb eval(const Material& material, vec3 wo, vec3 wi) {
    return material.ask([&](const auto& kind) { return kind.eval(wo, wi); });
}
inline real pdf(const Material& material, vec3 wo, vec3 wi, Direction direction) {
    return material.ask([&](const auto& kind) { return kind.pdf(wo, wi, direction); });
}
inline BsdfSample sample(const Material& material, vec3 wo, bool outside, real u_lobe, vec2 u,
                         Direction direction) {
    return material.ask([&](auto& kind) { return kind.sample(wo, outside, u_lobe, u, direction); });
}

}  // namespace penumbra

// world/bsdf.h  2  how light scatters: diffuse, Phong, mirror, glass
//
// Local coordinates: z is the surface normal on wo's side, so wo.z > 0.  wo points to the eye, wi
// to the light, both unit.  eval is f without the cosine (1/sr).
#pragma once
#include "world/warp.h"

// Scattering by a surface, on both of its sides, and its emission.
struct Material {
    enum class Kind { rough, mirror, glass } kind = Kind::rough;
    rgb kd;             // rough: diffuse albedo
    rgb ks;             // rough: scale of the Phong lobe; mirror: reflectance
    real exponent = 0;  // of the Phong lobe
    real ior = 1;       // glass: index of refraction inside, 1 outside
    rgb Le;             // emitted radiance
    bool twosided = false;

    bool is_delta() const { return kind != Kind::rough; }  // scatters into single directions
    bool transmits() const { return kind == Kind::glass; }
    bool reflects() const { return is_delta() || max_of(kd + ks) > 0; }
    bool emits() const { return max_of(Le) > 0; }
    // True if a direction takes a third number: for reflection or refraction, for lobe or cosine.
    bool has_choice() const {
        return kind == Kind::glass || (kind == Kind::rough && !(ks == rgb{}));
    }
};

// Radiance that a surface emits at an angle to its normal with this cosine.
inline rgb emitted(const Material& m, real cosine) {
    return cosine > 0 || m.twosided ? m.Le : rgb{};
}

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

inline vec3 mirrored(vec3 wo) { return {-wo.x, -wo.y, wo.z}; }

// f = kd / pi + ks (n+2) / (2 pi) max(0, cos alpha)^n, alpha the angle between wi and the mirror
// direction (Lafortune, Willems 1994).  Reflects at most kd + ks; reciprocal.  Mirrors and glass:
// 0.
inline rgb eval(const Material& m, vec3 wo, vec3 wi) {
    if (m.is_delta() || wi.z <= 0) return {};
    if (m.ks == rgb{}) return m.kd * (1 / pi);
    real cos_alpha = dot(mirrored(wo), wi);
    real lobe =
        cos_alpha > 0 ? (m.exponent + 2) / (2 * pi) * portable::pow(cos_alpha, m.exponent) : 0;
    return m.kd * (1 / pi) + m.ks * lobe;
}

// Fraction of the samples that follow the Phong lobe rather than the cosine.
inline real lobe_probability(const Material& m) {
    if (m.ks == rgb{}) return 0;
    real d = mean_of(m.kd), s = mean_of(m.ks);
    return s > 0 ? s / (d + s) : 0;
}

// Density of wi per solid angle over the whole sphere.  The Phong lobe may reach below the horizon,
// where eval is 0.  Mirrors and glass: 0.
inline real pdf(const Material& m, vec3 wo, vec3 wi, Direction direction) {
    if (m.is_delta()) return 0;
    if (direction == Direction::uniform) return pdf_uniform_hemisphere(wi.z);
    real q = lobe_probability(m);
    real lobe = q > 0 ? pdf_phong_lobe(dot(mirrored(wo), wi), m.exponent) : 0;
    return (1 - q) * pdf_cosine_hemisphere(wi.z) + q * lobe;
}

// exercise 3.6
// Reflectance of a smooth dielectric for unpolarised light (Fresnel); eta = n_i / n_t, cosines of
// the angles of incidence and refraction.
inline real fresnel(real cos_i, real cos_t, real eta) {
    real parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    real perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return (sqr(parallel) + sqr(perpendicular)) / 2;
}

// Reflects with probability Fresnel, else refracts (Snell).  Radiance grows with the square of the
// index: eta^2 when it leaves the medium of wi for that of wo (Veach 1997, sec. 5.2).
inline BsdfSample sample_glass(const Material& m, vec3 wo, bool outside, real u) {
    real eta = outside ? 1 / m.ior : m.ior;
    real cos2_t = (1 - eta) * (1 + eta) + sqr(eta * wo.z);  // 1 - eta^2 sin^2, grazing, too
    real cos_t = cos2_t > 0 ? std::sqrt(cos2_t) : 0;
    real reflectance = cos2_t > 0 ? fresnel(wo.z, cos_t, eta) : 1;
    if (u < reflectance) {
        real f = reflectance / wo.z;
        return {mirrored(wo), {f, f, f}, reflectance};
    }
    real f = (1 - reflectance) * sqr(eta) / cos_t;
    return {{-eta * wo.x, -eta * wo.y, -cos_t}, {f, f, f}, 1 - reflectance, sqr(eta)};
}
// end

// A direction wi from three numbers; `outside`: wo is on the side of the surface's own normal.  A
// direction below the horizon is kept, with f = 0: dropping it would bias the estimate.
inline BsdfSample sample(const Material& m, vec3 wo, bool outside, real u_lobe, vec2 u,
                         Direction direction) {
    if (m.kind == Material::Kind::mirror) return {mirrored(wo), m.ks / wo.z, 1};
    if (m.kind == Material::Kind::glass) return sample_glass(m, wo, outside, u_lobe);
    vec3 wi;
    if (direction == Direction::uniform)
        wi = sample_uniform_hemisphere(u);
    else if (u_lobe < lobe_probability(m))
        wi = frame(mirrored(wo)).to_world(sample_phong_lobe(u, m.exponent));
    else
        wi = sample_cosine_hemisphere(u);
    return {wi, eval(m, wo, wi), pdf(m, wo, wi, direction)};
}

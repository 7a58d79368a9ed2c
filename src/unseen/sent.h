// unseen/sent.h  2  what lights bring to the picture, by paths that begin at them
//
// Paths from the eye may all miss a way of light that is easy to find from the lamp: over a small
// bright surface, through a ball of glass or a gap.  Both kinds of paths estimate the same radiance
// (Veach 1997, ch. 4), where the eye sees a surface that is no mirror or glass.
#pragma once
#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "base/portable.h"
#include "base/rng.h"
#include "film/near_misses.h"
#include "world/scene.h"

namespace penumbra {

inline constexpr size_t max_light_groups = 256;  // more lights share groups with neighbours

inline size_t group_of(const Scene& s, size_t light) {
    return s.lights.size() <= max_light_groups ? light : light * max_light_groups / s.lights.size();
}

// Some rows of the picture, with the pixels 0, 1 ...
struct Band {
    int first = 0, count = 0;
};

// The pixel that a direction from the eye goes through, and its solid angle there (sr).
struct Through {
    size_t pixel;
    double solid_angle;
};
inline std::optional<Through> pixel_through(const Scene& s, const Band& band, vec3 d) {
    const Camera& c = s.camera;
    const double side = 2 * double(c.tan_half) / s.size.height, cosine = double(dot(d, c.forward));
    if (!(cosine > 0)) return {};
    const int width = s.size.width;
    const double x = width / 2.0 + double(dot(d, c.right)) / (cosine * side);
    const double y = s.size.height / 2.0 - double(dot(d, c.up)) / (cosine * side) - band.first;
    if (!(x >= 0 && x < width && y >= 0 && y < band.count)) return {};
    return Through{size_t(y) * size_t(width) + size_t(x), side * side * cosine * cosine * cosine};
}

// ---- Gaps ---------------------------------------------------------------------------------------

// Directions beside edges, for light comes in by gaps, and gaps lie there.  An edge leads from a
// to a + e; the third corner of its triangle is c.  A direction from y goes through
//     a + x e + h w,    x uniform in [0,1), log h uniform from |e| / 4096 to 8 |e|,
// w the normal of the plane of y and the edge, away from the triangle.
class Edges {
    struct Edge {
        vec3 a, e, c;
    };

public:
    // Those of triangles that do not shine, without the diagonals of quads; of many 128, each as
    // likely as any other (a reservoir, Vitter 1985).
    explicit Edges(const Scene& s) {
        constexpr uint64_t most = 128;
        uint64_t seen = 0;
        auto add = [&](const Edge& edge) {
            const uint64_t place = hash(seen, 0) % (seen + 1);
            if (seen++ < most)
                edges_.push_back(edge);
            else if (place < most)
                edges_[place] = edge;
        };
        auto halves = [&](size_t i, size_t j) {  // of a quad
            return j < s.shapes.size() && s.shapes[i].a == s.shapes[j].a &&
                   s.shapes[i].c == s.shapes[j].b && s.shapes[j].is_triangle();
        };
        for (size_t i = 0; i < s.shapes.size(); ++i) {
            const auto& [a, b, c, r] = s.shapes[i];
            if (!s.shapes[i].is_triangle() || s.light_of[i] != no_light) continue;
            add({b, c - b, a});
            if (!halves(i, i + 1)) add({c, a - c, b});
            if (i == 0 || !halves(i - 1, i)) add({a, b - a, c});
        }
    }
    bool empty() const { return edges_.empty(); }

    vec3 sample(vec3 y, real u_edge, vec2 u) const {
        const Edge& edge = edges_[size_t(u_edge * real(edges_.size()))];
        const vec3 r = edge.a - y, e = edge.e;
        const vec3 d =
            r + e * u.x +
            away(edge, r) * (8 * length(e) * real(portable::pow(0.5, double(15 * (1 - u.y)))));
        return dot(d, d) > 0 ? unit(d) : d;
    }
    // Density per solid angle.
    real pdf(vec3 y, vec3 d) const {
        real sum = 0;
        for (const Edge& edge : edges_) sum += pdf_beside(edge, edge.a - y, d);
        return edges_.empty() ? 0 : sum / real(edges_.size());
    }

private:
    std::vector<Edge> edges_;

    static vec3 away(const Edge& edge, vec3 r) {
        const vec3 n = cross(edge.e, r);
        if (!(dot(n, n) > 0)) return {};
        return unit(n) * (dot(n, edge.c - edge.a) > 0 ? real(-1) : real(1));
    }
    // At t d = r + x e + h w: t^2 / cosine, 1 / |e| and 1 / (h log 2^15).
    static real pdf_beside(const Edge& edge, vec3 r, vec3 d) {
        const vec3 e = edge.e, w = away(edge, r), in_plane = d - w * dot(d, w);
        const real ee = dot(e, e), er = dot(e, r), rr = dot(r, r), det = ee * rr - er * er;
        const real de = dot(in_plane, e), dr = dot(in_plane, r);
        const real t = det / (dr * ee - de * er), x = t * (de * rr - dr * er) / det;
        const real width = std::sqrt(ee), h = t * dot(d, w);
        if (!(t > 0 && x >= 0 && x < 1 && h >= width / 4096 && h <= 8 * width)) return 0;
        const real cosine = std::abs(dot(d, cross(e / width, w)));
        return sqr(t) / (cosine * width * h * (15 * std::numbers::ln2_v<real>));
    }
};

// ---- Paths from lights --------------------------------------------------------------------------

// Random numbers of a path from a light.
struct Draws {
    uint64_t key, count = 0;
    real one() { return to_unit(hash(key, count++)); }
    vec2 two() {
        const real x = one();
        return {x, one()};
    }
};

// A ray from a light, with its flux over its density; of a point light, intensity over density.
struct Emission {
    Ray ray;
    rgb flux;
};
// Half of all directions are beside edges.
inline Emission emission(const Light& l, const Edges& edges, Draws& u) {
    const Surface from = point_of(l, u.two());
    const bool is_point = l.is_delta(), is_turned = l.twosided && u.one() < real(0.5);
    const vec3 n = is_turned ? -from.n : from.n;
    const real area = l.is_round() ? 4 * pi * sqr(l.reach) : 1 / l.pdf_area;
    const real beside = edges.empty() ? 0 : real(0.5), u_kind = u.one(), u_edge = u.one();
    const vec2 at = u.two();
    const vec3 d = u_kind < beside ? edges.sample(from.p, u_edge, at)
                   : is_point      ? sample_uniform_sphere(at)
                                   : frame(n).to_world(sample_cosine_hemisphere(at));
    const real cosine = is_point ? 1 : std::max(real(0), dot(n, d));
    const real pdf =
        (1 - beside) * (is_point ? 1 / (4 * pi) : cosine / pi) + beside * edges.pdf(from.p, d);
    return {spawn(from, d), l.L * ((is_point ? 1 : area * cosine * (l.twosided ? 2 : 1)) / pdf)};
}

// A path from a light.  Calls splat(pixel, radiance) where the eye sees it: the mean radiance of
// the pixel, by this path.  Unbiased for what paths of up to 32 bounces from the eye find behind a
// first surface that is no mirror or glass; white walls would hold a path for ever.
template <class Splat>
void follow_light(const Scene& s, const Band& band, const Edges& edges, const Light& l,
                  uint64_t key, Splat splat) {
    Draws u{key};
    auto [ray, flux] = emission(l, edges, u);
    for (int k = 0; k < std::min(s.depth, 32) && max_of(flux) > 0; ++k) {
        const auto hit = s.bvh.closest(ray);
        if (!hit) return;
        const Surface x = s.surface(ray, *hit);
        const Material& m = s.material(*hit);
        const real cosine = -dot(x.n, ray.d);
        if (cosine == 0 || (k == 0 && l.is_delta() && m.is_delta())) return;
        const vec3 n = cosine > 0 ? x.n : -x.n, to_eye = s.camera.eye - x.p, d = unit(to_eye);
        const Frame local = frame(n);
        const vec3 wo = local.to_local(-ray.d);
        if (const auto to = pixel_through(s, band, -d); to && dot(n, d) > 0 && !m.is_delta()) {
            const rgb L = flux * eval(m, wo, local.to_local(d)) *
                          (dot(n, d) / dot(to_eye, to_eye) / real(to->solid_angle));
            const Ray back = spawn_to({x.p, n, x.error}, {s.camera.eye, {}, 0});
            if (max_of(L) > 0 && !s.bvh.occluded(back)) splat(to->pixel, L);
        }
        const real u_lobe = u.one();
        const BsdfSample b = sample(m, wo, cosine > 0, u_lobe, u.two(), Direction::bsdf);
        if (!(max_of(b.f) > 0)) return;
        // Flux, unlike radiance, does not change by refraction (Veach 1997, sec. 5.2).
        const rgb goes_on = b.f * (std::abs(b.wi.z) / (b.pdf * b.eta2));
        const real survival = std::min(real(1), max_of(goes_on));
        if (u.one() >= survival) return;
        flux *= goes_on / survival;
        ray = spawn(x, local.to_world(b.wi));
    }
}

// Eight for each pixel, as far as they take no more than a tenth of a second.
inline uint64_t light_paths(const Scene& s, const Band& band) {
    return std::min<uint64_t>(8 * uint64_t(s.size.width) * uint64_t(band.count), 1 << 14);
}

// Adds what each group of lights sends to the picture, by so many paths, half of which the lights
// share alike and half by their strengths.
inline void add_sent(std::vector<NearMisses>& groups, const Scene& s, const Band& band,
                     const Edges& edges, uint64_t paths) {
    double most = std::numeric_limits<double>::min(), all = 0;
    for (const Light& l : s.lights) most = std::max(most, strength(l));
    for (const Light& l : s.lights) all += strength(l, 1 / most);
    if (!(all > 0)) return;
    std::vector<double> upto;  // sums of probabilities
    for (const Light& l : s.lights)
        upto.push_back((upto.empty() ? 0 : upto.back()) + 0.5 / double(s.lights.size()) +
                       0.5 * strength(l, 1 / most) / all);
    struct InPixel {
        double sum = 0, squares = 0;
    };
    std::vector<std::map<size_t, InPixel>> pixels(groups.size());
    std::vector<double> squares(groups.size());
    for (uint64_t k = 0; k < paths; ++k) {
        const double u = (double(k) + 0.5) / double(paths) * upto.back();
        const size_t i = size_t(std::ranges::upper_bound(upto, u) - upto.begin());
        const double p = (upto[i] - (i > 0 ? upto[i - 1] : 0)) * double(paths);
        const size_t g = group_of(s, i);
        double sum = 0;
        follow_light(s, band, edges, s.lights[i], hash(paths, k), [&](size_t pixel, rgb L) {
            const double c = double(mean_of(L)) / p;
            InPixel& at = pixels[g][pixel];
            at.sum += c, at.squares += c * c, sum += c;
        });
        groups[g].sent += sum, squares[g] += sum * sum;
    }
    for (size_t g = 0; g < groups.size(); ++g) {
        groups[g].sent_variance = squares[g];
        // Unbiased for the square of a pixel's mean: products of two visits, not of one with
        // itself.
        double of_pairs = 0;
        for (const auto& [pixel, at] : pixels[g]) of_pairs += at.sum * at.sum - at.squares;
        groups[g].sent_squares =
            std::max(of_pairs, square(groups[g].sent) / (band.count * s.size.width));
    }
}

}  // namespace penumbra

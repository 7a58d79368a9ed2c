// unseen/sent.h  3  what lights bring to the picture, by paths that begin at them
//
// Paths from the eye may all miss a way of light that is easy to find from the lamp: over a small
// bright surface, through a ball of glass or a gap.  Both kinds of paths estimate the same radiance
// (Veach 1997, ch. 4), where the eye sees a surface that is no mirror or glass.
#pragma once
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "base/stats.h"
#include "unseen/aims.h"
#include "unseen/near_misses.h"

namespace penumbra {

inline constexpr int max_bounces = 32;  // white walls would hold a path for ever
inline constexpr size_t max_light_groups = 256;

// The group of each light.  Of more lights than groups the brighter half of the groups has one
// each, for others that are met often must not speak for a small bright one; the rest share with
// neighbours.
inline std::vector<size_t> light_groups(const Scene& s) {
    const size_t n = s.lights.size(), alone = n > max_light_groups ? max_light_groups / 2 : n;
    std::vector<size_t> order(n), group(n);
    std::iota(order.begin(), order.end(), 0);
    if (alone < n)
        std::ranges::stable_sort(order, std::greater(),
                                 [&](size_t i) { return mean_of(s.lights[i].L); });
    for (size_t k = 0; k < n; ++k)
        group[order[k]] = k < alone ? k : alone + order[k] * (max_light_groups - alone) / n;
    return group;
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

// ---- Sums over paths ----------------------------------------------------------------------------

// What lights bring to pixels over many paths, by groups of any kind.
class PictureSums {
public:
    explicit PictureSums(size_t groups) : of_group_(groups) {}

    // By the present path, to the mean of the pixel.
    void add(size_t group, size_t pixel, double c) { path_[{group, pixel}] += c; }
    void end_path() {
        std::map<size_t, double> of_path;
        for (const auto& [where, c] : path_) {
            const auto [group, pixel] = where;
            Pair& at = pixels_[where];
            at.sum += c, at.squares += c * c, of_path[group] += c;
        }
        for (const auto& [group, c] : of_path)
            of_group_[group].sum += c, of_group_[group].squares += c * c;
        path_.clear();
    }
    // Unbiased for the square of a pixel's mean: products of two paths, not of one with itself.
    Brought of(size_t group, double pixels) const {
        double pairs = 0;
        const auto end = pixels_.lower_bound({group + 1, 0});
        for (auto it = pixels_.lower_bound({group, 0}); it != end; ++it)
            pairs += square(it->second.sum) - it->second.squares;
        const auto& [sum, squares] = of_group_[group];
        return {sum, std::max(pairs, sum * sum / pixels), squares};
    }

private:
    struct Pair {
        double sum = 0, squares = 0;
    };
    std::vector<Pair> of_group_;
    std::map<std::pair<size_t, size_t>, Pair> pixels_;
    std::map<std::pair<size_t, size_t>, double> path_;
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
    std::optional<size_t> aim = {};  // number of the edge or shape that it aims at
    double pdf = 0;                  // 1/sr
};
// Half of all directions aim.
inline Emission emission(const Light& l, const Aims& aims, Draws& u) {
    const Surface from = point_of(l, u.two());
    const bool is_point = l.is_delta(), is_turned = l.twosided && u.one() < real(0.5);
    const vec3 n = is_turned ? -from.n : from.n;
    const real area = l.is_round() ? 4 * pi * sqr(l.radius) : 1 / l.pdf_area;
    const real aimed = aims.size() == 0 ? 0 : real(0.5), u_kind = u.one(), u_aim = u.one();
    const vec2 at = u.two();
    const auto aim = u_kind < aimed ? aims.sample(from.p, u_aim, at) : std::nullopt;
    const vec3 d = aim              ? aim->d
                   : u_kind < aimed ? vec3{}
                   : is_point       ? sample_uniform_sphere(at)
                                    : frame(n).to_world(sample_cosine_hemisphere(at));
    const real cosine = is_point ? dot(d, d) : std::max(real(0), dot(n, d));
    if (cosine == 0) return {{from.p, n}, {}};
    const real pdf =
        (1 - aimed) * (is_point ? 1 / (4 * pi) : cosine / pi) + aimed * aims.pdf(from.p, d);
    return {spawn(from, d), l.L * ((is_point ? 1 : area * cosine * (l.twosided ? 2 : 1)) / pdf),
            aim ? std::optional(aim->at) : std::nullopt, double(pdf)};
}

// A path from a light, from its emission.  Calls splat(pixel, radiance, first shape) where the eye
// sees it: the mean radiance of the pixel, by this path.  Unbiased for what paths of up to
// max_bounces from the eye find behind a first surface that is no mirror or glass.
template <class Splat>
void follow_light(const Scene& s, const Band& band, const Light& l, const Emission& emitted,
                  Draws& u, Splat splat) {
    Ray ray = emitted.ray;
    rgb flux = emitted.flux;
    uint32_t first = 0;
    for (int k = 0; k < std::min(s.depth, max_bounces) && max_of(flux) > 0; ++k) {
        const auto hit = s.bvh.closest(ray);
        if (!hit) return;
        if (k == 0) first = hit->id;
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
            if (max_of(L) > 0 && !s.bvh.occluded(back)) splat(to->pixel, L, first);
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
inline uint64_t aimed_paths(const Scene& s, const Band& band) {
    return std::min<uint64_t>(8 * uint64_t(s.size.width) * uint64_t(band.count), 1 << 14);
}

// The class of a shape's area.
inline size_t class_of(const Shape& shape) {
    return class_of(shape.is_triangle() ? double(length(area_vector(shape))) / 2
                                        : 4 * std::numbers::pi * sqr(double(shape.r)));
}

inline std::vector<uint8_t> area_classes(const Scene& s) {
    std::vector<uint8_t> all;
    for (const Shape& shape : s.shapes) all.push_back(uint8_t(class_of(shape)));
    return all;
}

// What each group of lights sends to the picture, by so many paths, half of which the lights share
// alike and half by their intensities.  Half of the paths learn where to aim, the others count.
inline PictureSums sent_by_lights(const Scene& s, const Band& band, Aims aims, uint64_t paths) {
    PictureSums sums(std::min(s.lights.size(), max_light_groups) * classes);
    const std::vector<size_t> group_of = light_groups(s);
    double most = std::numeric_limits<double>::min(), all = 0;
    for (const Light& l : s.lights) most = std::max(most, intensity(l));
    for (const Light& l : s.lights) all += intensity(l, 1 / most);
    if (!(all > 0)) return sums;
    std::vector<double> upto;  // sums of probabilities
    for (const Light& l : s.lights)
        upto.push_back((upto.empty() ? 0 : upto.back()) + 0.5 / double(s.lights.size()) +
                       0.5 * intensity(l, 1 / most) / all);
    const uint64_t learning = aims.size() > 0 ? paths / 2 : 0;
    std::vector<double> worth(aims.size());
    for (uint64_t k = 0; k < paths; ++k) {
        if (k == learning) aims.prefer(worth);
        const bool learns = k < learning;
        const double n = double(learns ? learning : paths - learning);
        const double at = (double(learns ? k : k - learning) + 0.5) / n * upto.back();
        const size_t i = size_t(std::ranges::upper_bound(upto, at) - upto.begin());
        const double p = (upto[i] - (i > 0 ? upto[i - 1] : 0)) * n;
        Draws u{hash(paths, k)};
        const Emission emitted = emission(s.lights[i], aims, u);
        double sum = 0;
        follow_light(s, band, s.lights[i], emitted, u, [&](size_t pixel, rgb L, uint32_t shape) {
            const double c = double(mean_of(L)) / p;
            sum += c;
            if (!learns) sums.add(group_of[i] * classes + class_of(s.shapes[shape]), pixel, c);
        });
        sums.end_path();
        if (emitted.aim) worth[*emitted.aim] += square(sum * emitted.pdf);
    }
    return sums;
}

}  // namespace penumbra

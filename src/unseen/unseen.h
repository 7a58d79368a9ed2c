// unseen/unseen.h  2  estimates of light that no sample has met, from near misses of small lights
//
// The variance of samples does not contain light that no sample has met.  A light scaled s times
// about its centre and 1/s^2 as bright sends about the same light, but BSDF samples meet it s^2
// times as often: near misses reveal rare light before a sample meets it.
#pragma once
#include <bit>
#include <map>

#include "base/json.h"
#include "film/passes.h"
#include "path/halton.h"
#include "path/pathtracer.h"
#include "unseen/hidden.h"

inline constexpr size_t growths = 11;            // s = 1, 2, 4 ... 1024
inline constexpr size_t most_light_groups = 64;  // more lights share groups with neighbours

// ---- Evidence -----------------------------------------------------------------------------------

// A group of lights, as the camera sees them.
struct LightGroup {
    double line = 0;  // line of its first light; 0: not known
    double L2 = 0;    // greatest square of radiance, mean of the channels
    double area = 0;  // visible area in pixels
    double a = 0;     // sum over pixels of a (1 - a), for the covered part a of a pixel
    double K = 1;     // replications of these pixels
};

// The evidence of a film: for each group its LightGroup, then c and c^2 of near misses (see below)
// for each growth, first of paths by mirrors and glass only, then of other paths.
inline constexpr size_t light_kinds = 2, of_group = 5 + light_kinds * growths * 2;
inline size_t place(size_t group, size_t kind) { return group * of_group + 5 + kind * growths * 2; }

inline LightGroup group_in(const std::vector<FixedPoint>& evidence, size_t group) {
    auto number = [&](size_t i) {
        return std::bit_cast<double>(uint64_t(evidence[group * of_group + i]));
    };
    return {number(0), number(1), number(2), number(3), number(4)};
}
inline std::vector<FixedPoint> no_evidence_yet(const std::vector<LightGroup>& groups) {
    std::vector<FixedPoint> evidence(groups.size() * of_group);
    for (size_t g = 0; g < groups.size(); ++g) {
        const auto& [line, L2, area, a, K] = groups[g];
        size_t i = g * of_group;
        for (double x : {line, L2, area, a, K}) evidence[i++] = std::bit_cast<uint64_t>(x);
    }
    return evidence;
}

inline double mean_square(rgb L) {
    double sum = 0;
    for (auto c : axis) sum += double(L.*c) * double(L.*c);
    return sum / 3;
}

inline size_t group_of(const Scene& s, size_t light) {
    return light * std::min(s.lights.size(), most_light_groups) / s.lights.size();
}

// ---- Lights in view of the camera ---------------------------------------------------------------

// Adds the parts of pixels that a light covers in some rows, by sampling so many of its points.
inline void add_view(std::map<size_t, double>& parts, const Scene& s, const Light& light,
                     size_t points, int first_row, int rows) {
    const Camera& c = s.camera;
    const double pixel = 2 * double(c.tan_half) / s.size.height;
    const int width = s.size.width;
    for (size_t k = 0; k < points; ++k) {
        const vec2 u{(real(k) + real(0.5)) / real(points), radical_inverse(2, k)};
        const auto at = sample_light(light, c.eye, u);
        const double cosine = at ? double(dot(at->wi, c.forward)) : 0;
        if (!(cosine > 0)) continue;
        const double right = double(dot(at->wi, c.right)), up = double(dot(at->wi, c.up));
        const double x = width / 2.0 + right / (cosine * pixel);
        const double y = s.size.height / 2.0 - up / (cosine * pixel) - first_row;
        if (!(x >= 0 && x < width && y >= 0 && y < rows)) continue;
        if (s.bvh.occluded(spawn_to({c.eye, {}, 0}, at->at))) continue;
        // Relative to the solid angle of the pixel there.
        parts[size_t(y) * size_t(width) + size_t(x)] +=
            1 / (double(at->pdf) * double(points) * sqr(pixel) * cosine * cosine * cosine);
    }
}

struct LightsInView {
    std::vector<LightGroup> groups;
    std::vector<size_t> noisy;  // pixels of groups that cover less than 16
};

// Samples 1024 points of each group.
inline LightsInView lights_in_view(const Scene& s, int first_row, int rows) {
    LightsInView view;
    view.groups.resize(std::min(s.lights.size(), most_light_groups));
    std::vector<std::map<size_t, double>> parts(view.groups.size());
    for (size_t i = 0; i < s.lights.size(); ++i) {
        if (s.lights[i].kind == Light::Kind::point) continue;
        LightGroup& g = view.groups[group_of(s, i)];
        if (g.line == 0 && i < s.line_of_light.size()) g.line = s.line_of_light[i];
        g.L2 = std::max(g.L2, mean_square(s.lights[i].L));
        const size_t points = 1024 * view.groups.size() / s.lights.size() + 1;
        add_view(parts[group_of(s, i)], s, s.lights[i], points, first_row, rows);
    }
    for (size_t g = 0; g < parts.size(); ++g) {
        LightGroup& group = view.groups[g];
        for (const auto& [i, a] : parts[g]) {
            group.area += a;
            group.a += std::max(0.0, a * (1 - a));
        }
        if (group.area < 16)
            for (const auto& [i, a] : parts[g]) view.noisy.push_back(i);
    }
    return view;
}

// ---- Hits and near misses -----------------------------------------------------------------------

// Bit k is set if the ray would meet the light scaled 2^k times, before its end and from the bright
// side.  A sphere counts as a disc about its centre that faces the ray.
inline uint32_t growths_met(const Light& l, const Ray& ray) {
    const vec3 f = l.centre - ray.o;
    const bool is_ball = l.kind == Light::Kind::sphere;
    const real cosine = is_ball ? -1 : dot(l.n, ray.d);
    const real t = is_ball ? dot(f, ray.d) : dot(l.n, f) / cosine;
    if (l.kind == Light::Kind::point || !(t > 0 && t < ray.tmax)) return 0;
    if (!(cosine < 0 || (l.twosided && cosine > 0))) return 0;
    const vec3 y = t * ray.d - f, N = cross(l.u, l.v);
    // The growth that is needed.  A polygon is scaled about its centre.
    const real a = dot(cross(y, l.v), N) / dot(N, N), b = dot(cross(l.u, y), N) / dot(N, N);
    const real least = is_ball                       ? length(y) / l.r
                       : l.kind == Light::Kind::quad ? 2 * std::max(std::abs(a), std::abs(b))
                                                     : 3 * std::max({-a, -b, a + b});
    const real most = length(f) / l.reach;  // the light is then as large as its distance
    uint32_t met = 0;
    for (size_t k = 0; k < growths; ++k)
        met |= uint32_t(real(1 << k) >= least && real(1 << k) < most) << k;
    return met;
}

// Sums, along a path, light that its rays met or nearly met:
//     c = |beta L w|^2 / (3 L2 K^2)
// for every growth that makes a ray meet the light.  It counts rays after mirrors and glass, where
// there is no light sampling, and after narrow lobes, where it has a low weight.
struct NearMisses {
    const Scene& scene;
    const Technique& technique;
    const std::vector<LightGroup>& groups;
    Tally& tally;
    bool is_specular = true;

    void operator()(const Segment& s, const Step& e) {
        constexpr real narrow = 10;  // 1/sr
        is_specular = is_specular && std::isinf(s.pdf);
        if (s.k > 0 && s.pdf > narrow && !groups.empty()) add_near_misses(s, e);
    }

private:
    // Rarely called, so not inlined into the path's loop.
    [[gnu::noinline]] void add_near_misses(const Segment& s, const Step& e) {
        const size_t n = scene.lights.size();
        const bool met_one = e.met && max_of(e.Le) > 0;
        const size_t met = met_one ? size_t(scene.light_of[e.x.hit.id]) : n;
        if (met_one) add(s, met, ~0u, double(e.weight));
        Ray ray = s.ray;
        ray.tmax = e.met ? e.x.hit.t : infinity;
        // Of many lights one represents all, drawn by bits of the ray.
        const size_t drawn =
            n > most_light_groups ? hash(std::bit_cast<uint64_t>(double(ray.d.x)), 0) % n : n;
        for (size_t l = drawn % n; l < (drawn < n ? drawn + 1 : n); ++l)
            if (const uint32_t near = growths_met(scene.lights[l], ray) & ~1u; near && l != met)
                add(s, l, near, weight_of(s, l) * (drawn < n ? std::sqrt(double(n)) : 1));
    }
    // MIS weight of a light that is met in its centre.
    double weight_of(const Segment& s, size_t i) const {
        const Light& l = scene.lights[i];
        if (technique.light == LightMode::none || std::isinf(s.pdf)) return 1;
        if (technique.light == LightMode::nee) return 0;
        const real pdf = pick_of(scene, i, s.from, s.n) * pdf_light(l, s.from, {l.centre, l.n, 0});
        return double(power_heuristic(s.pdf, pdf));
    }
    void add(const Segment& s, size_t light, uint32_t near, double weight) {
        const size_t g = group_of(scene, light);
        const double w = weight * tally.share;
        const double c = mean_square(s.beta * scene.lights[light].L) / groups[g].L2 * w * w;
        if (!(c > 0)) return;
        const FixedPoint c1 = fixed_point(c), c2 = fixed_point(c * c);
        FixedPoint* sum = &tally.sums[place(g, is_specular ? 0 : 1)];
        for (size_t k = 0; k < growths; ++k, sum += 2)
            if (near >> k & 1) sum[0] += c1, sum[1] += c2;
    }
};

// ---- Light that may be missing ------------------------------------------------------------------

// The evidence of films of one picture.
class Unseen {
public:
    // A film with t samples in each replication; its picture has a weight in the mean of several.
    void add(const std::vector<FixedPoint>& evidence, double t, double weight = 1) {
        lights_.resize(evidence.size() / of_group);
        for (size_t g = 0; g < lights_.size(); ++g) {
            const LightGroup group = group_in(evidence, g);
            const double v = weight * weight * group.L2, n = t * group.K;
            lights_[g].line = group.line;
            lights_[g].met += group.area * n;
            lights_[g].variance += v * group.a / n;
            for (size_t i = 0; i < light_kinds * growths; ++i) {
                const FixedPoint* const sum = &evidence[place(g, 0) + 2 * i];
                NearSum& of = lights_[g].near[i];
                of.c += value_of(sum[0]), of.c2 += value_of(sum[1]);
                of.variance += v * value_of(sum[0]) / (t * t);
            }
        }
    }

    // Why the error of an image may be more than twice its estimate; "": no reason is known.  `d2`:
    // square of the estimate; `norm`: |f|.
    std::string doubt(double d2, double norm, double pixels) const {
        double unseen = 0, most = 0;  // variances, summed over pixels
        std::string why;
        auto consider = [&](double variance, double line, const char* where, double met) {
            unseen += variance;
            if (!(variance > most)) return;
            most = variance;
            why = (line > 0 ? "the light of line " + fixed(line, 0) : "a light") + where +
                  " was hit " + counted(fixed(met, 0), "time");
        };
        for (const OneLight& l : lights_) {
            if (l.met < 10) consider(l.variance, l.line, ", smaller than a pixel,", l.met);
            for (size_t kind = 0; kind < light_kinds; ++kind) {
                const NearSum* const s = &l.near[kind * growths];
                double greatest = 0;
                for (size_t k = 0; k < growths; ++k)
                    if (s[k].count() >= 5)
                        greatest = std::max(greatest, std::ldexp(s[k].variance, -2 * int(k)));
                if (s->count() < 10)
                    consider(greatest, l.line,
                             kind == 0 ? " in mirrors or glass" : " by way of mirrors or glass",
                             s->count());
            }
        }
        if (!(unseen > 3 * d2 * pixels)) return "";
        return why + "; light not yet found may amount to " +
               significant(100 * std::sqrt(unseen / pixels) / norm, 1) + " %";
    }

private:
    struct NearSum {
        double c = 0, c2 = 0, variance = 0;
        double count() const { return c > 0 ? c * c / c2 : 0; }  // (Kish 1965)
    };
    struct OneLight {
        double line = 0, met = 0, variance = 0;  // met: expected number of camera rays
        std::array<NearSum, light_kinds * growths> near;
    };
    std::vector<OneLight> lights_;
};

// Observes the paths of a render, and judges its estimated error.
class Witness {
public:
    Witness(const Scene& scene, const Technique& t) : scene_(scene), technique_(t) {}

    void watch(Plan& plan) {
        LightsInView view = lights_in_view(scene_, plan.first_row, plan.size.height);
        for (LightGroup& g : view.groups) g.K = plan.sets ? plan.sets : least_of_noisy;
        groups_ = view.groups;
        plan.noisy = view.noisy;
        plan.evidence = no_evidence_yet(groups_);
        plan.judge = [](const Film& f, const ImageError& e) {
            Unseen unseen;
            unseen.add(f.evidence, double(f.least_taken()));
            return unseen.doubt(e.d2(), e.norm, double(f.pixels()));
        };
    }
    NearMisses visitor(Tally& tally) const { return {scene_, technique_, groups_, tally}; }

private:
    const Scene& scene_;
    const Technique technique_;
    std::vector<LightGroup> groups_;
};

// unseen/unseen.h  5  estimates of light that no sample has met, from near misses of small lights
//
// The variance of samples does not contain light that no sample has met.  A light of s^2
// times its area and 1/s^2 its radiance sends about the same light, but BSDF samples meet it s^2
// times as often: near misses reveal rare light before a sample meets it.
#pragma once
#include "film/loop.h"
#include "text/json.h"
#include "text/words.h"
#include "unseen/hidden.h"
#include "unseen/view.h"

namespace penumbra {

// ---- Hits and near misses -----------------------------------------------------------------------

// Bit k is set if the ray would meet the light grown to 4^k times its area, from the bright side: a
// disc of its area about its centre, in its plane; that of a sphere faces the ray.
inline uint32_t growths_met(const Light& light, const Ray& ray) {
    if (light.is_delta()) return 0;
    const vec3 to_centre = light.centre - ray.o;
    const bool is_ball = light.is_round();
    const real cosine = is_ball ? -1 : dot(light.n, ray.d);
    const real t = is_ball ? dot(to_centre, ray.d) : dot(light.n, to_centre) / cosine;
    if (!(t > 0 && t < ray.tmax)) return 0;
    if (!(cosine < 0 || (light.twosided && cosine > 0))) return 0;
    const real r = is_ball ? light.radius : 1 / std::sqrt(pi * light.pdf_area);
    // most: the disc is as large as its distance.
    const real least = length(t * ray.d - to_centre) / r, most = length(to_centre) / r;
    uint32_t met = 0;
    for (size_t k = 0; k < growths; ++k)
        met |= uint32_t(real(1 << k) >= least && real(1 << k) < most) << k;
    return met;
}

// Sums, along a path, what lights bring, and light that its rays met or nearly met:
//     c = |beta L|^2 / (3 L2 K^2)
// for every growth that makes a ray meet the light.  It counts rays after mirrors and glass, where
// there is no light sampling.
struct NearMissVisitor {
    const Scene& scene;
    const std::vector<NearMisses>& groups;
    const std::vector<size_t>& group_of;  // of each light
    const std::vector<uint8_t>& area_class;
    Tally& tally;
    bool is_seen = false;  // the first surface is no mirror or glass
    uint32_t before = 0;   // shape of the last vertex

    void operator()(const PathState& path, const VertexEvents& here) {
        if (path.k == 0) is_seen = here.met && !here.vertex.material->is_delta();
        if (path.k > 0 && std::isinf(path.pdf) && !groups.empty()) add_near_misses(path, here);
        const uint32_t shape = here.met ? here.vertex.hit.id : 0;
        visit_lights(scene, path, here, [&](size_t light, rgb L, bool is_met) {
            add_came(light, L, area_class[is_met ? before : shape]);
        });
        before = shape;
    }

private:
    // A path may bring up to 2^20 times what lights bring to all of the picture.
    void add_came(size_t light, rgb L, size_t lit) {
        const double mean = double(mean_of(L));
        if (groups.empty() || !(mean > 0)) return;
        const size_t g = group_of[light], k = class_of(mean);
        auto add = [&](const Brought& of, Brought& to) {
            const double part = of.sum > 0 ? mean * tally.share / of.sum : 0;
            to.add(uint64_t(0x1p40 * std::min(0x1p20, part)), 1);
        };
        if (is_seen) add(groups[g].from_light[lit], tally.near[g].from_light[lit]);
        add(groups[g].from_eye[k], tally.near[g].from_eye[k]);
        const double c = mean_square(L) / groups[g].L2 * square(tally.share);
        if (c > 0) tally.near[g].squares[k] += fixed_point(0x1p20 * c);
    }
    // Rarely called, so not inlined into the path's loop.
    [[gnu::noinline]] void add_near_misses(const PathState& path, const VertexEvents& here) {
        const size_t n = scene.lights.size();
        const bool met_one = here.met && max_of(here.Le) > 0;
        const size_t met = met_one ? size_t(scene.light_of[here.vertex.hit.id]) : n;
        if (met_one) add(path, met, ~0u);
        Ray ray = path.ray;
        ray.tmax = here.met ? here.vertex.hit.t : infinity;
        // Of many lights one represents all, drawn by bits of the ray.
        const size_t drawn =
            n > max_light_groups ? hash(std::bit_cast<uint64_t>(double(ray.d.x)), 0) % n : n;
        for (size_t l = drawn % n; l < (drawn < n ? drawn + 1 : n); ++l)
            if (const uint32_t near = growths_met(scene.lights[l], ray) & ~1u; near && l != met)
                add(path, l, near, drawn < n ? double(n) : 1);
    }
    void add(const PathState& path, size_t light, uint32_t near, double represented = 1) {
        const size_t g = group_of[light];
        const double c = mean_square(path.beta * scene.lights[light].L) / groups[g].L2 *
                         square(tally.share) * represented;
        if (!(c > 0)) return;
        const FixedPoint c1 = fixed_point(c), c2 = fixed_point(c * c);
        for (size_t k = 0; k < growths; ++k)
            if (near >> k & 1) tally.near[g].sum[k][0] += c1, tally.near[g].sum[k][1] += c2;
    }
};

// ---- Light that may be missing ------------------------------------------------------------------

// The near misses of films of one picture.
class MissedLight {
public:
    // Of a film with t samples in each replication of weight 1, 0 if it has only a pilot; its
    // picture has a weight in the mean of several.
    void add(const std::vector<NearMisses>& groups, double t, double weight = 1) {
        is_pilot_ = is_pilot_ || t == 0;
        lights_.resize(groups.size());
        for (size_t g = 0; g < lights_.size(); ++g) {
            const NearMisses& group = groups[g];
            const double v = weight * weight * group.L2, n = t * group.K;
            lights_[g].line = group.line;
            for (size_t k = 0; k < classes; ++k) {
                lights_[g].from_light[k].add(group.from_light[k], t, weight);
                lights_[g].from_eye[k].add(group.from_eye[k], t, weight);
                lights_[g].from_eye[k].by_chance +=
                    v * std::ldexp(value_of(group.squares[k]), -20) / (t * t);
            }
            lights_[g].samples += n, lights_[g].weight += weight;
            lights_[g].met += group.area * n, lights_[g].variance += v * group.a / n;
            for (size_t k = 0; k < growths; ++k) {
                const auto& [c, c2] = group.sum[k];
                NearSum& of = lights_[g].near[k];
                of.c += value_of(c), of.c2 += value_of(c2);
                of.variance += v * value_of(c) / (t * t);
            }
        }
    }

    // Why the relative error of an image may be more than twice its estimate; empty if none is
    // known.  `d2`: square of the estimated error; `norm`: |f|.
    std::string doubt(double d2, double norm, double pixels) const {
        if (is_pilot_) return "too few samples";
        double unseen = 0, most = 0;  // variances, summed over pixels
        std::string why;
        auto consider = [&](double variance, const std::string& what) {
            unseen += variance;
            if (variance > most) most = variance, why = what;
        };
        for (const OneLight& l : lights_) {
            const std::string name =
                l.line > 0 ? "the light of line " + fixed(l.line, 0) : "a light";
            auto hit = [&](const char* where, double met) {
                return name + where + " was hit " + counted(fixed(met, 0), "time");
            };
            for (const Missing& of : l.from_light)
                consider(of.missing(), "paths from the eye bring less than paths from " + name);
            for (const Missing& of : l.from_eye) {
                consider(of.missing(), "paths from the eye that aim bring more of " + name);
                if (of.hits < std::max(10.0, l.few() / 2))
                    consider(of.by_chance, hit(" by rare bright paths", of.hits));
            }
            if (l.met < std::max(10.0, l.few()))
                consider(l.variance, hit(", smaller than a pixel,", l.met));
            double greatest = 0;
            for (size_t k = 0; k < growths; ++k)
                if (l.near[k].count() >= 5)
                    greatest = std::max(greatest, std::ldexp(l.near[k].variance, -2 * int(k)));
            if (l.near[0].count() < 10)
                consider(greatest, hit(" by way of mirrors or glass", l.near[0].count()));
        }
        // What is missing is missing from the truth F, too: (d^2 + u) / (F^2 + u) > 4 d^2 / F^2?
        const double F2 = std::max(0.0, norm * norm - d2);
        if (!(unseen * (F2 - 4 * d2) > 3 * d2 * F2 * pixels)) return "";
        return why + "; light not yet found may amount to " +
               significant(100 * std::sqrt(unseen / pixels) / norm, 1) + " %";
    }

private:
    struct NearSum {
        double c = 0, c2 = 0, variance = 0;
        double count() const { return c > 0 ? c * c / c2 : 0; }  // (Kish 1965)
    };
    struct Missing {
        double sum = 0, squares = 0, variance = 0, came = 0, hits = 0;
        double by_chance = 0;  // variance of the hits, for their number is random (Poisson)

        void add(const Brought& of, double t, double weight) {
            sum += weight * of.sum, squares += weight * of.squares;
            variance += weight * of.variance;
            came += weight * of.sum * std::ldexp(double(of.came), -40) / t;
            hits += double(of.hits);
        }
        // Sum over pixels of squares, if less came by more than three standard errors.  Of few
        // paths the squares are mostly too low: chosen by the aimed scenes of calibration.
        double missing() const {
            return sum - came > 3 * std::sqrt(variance) ? 2 * square((sum - came) / sum) * squares
                                                        : 0;
        }
    };
    struct OneLight {
        double line = 0, variance = 0, met = 0;  // met: expected camera rays
        double samples = 0, weight = 0;          // of a pixel near a light; of the films
        std::array<Missing, classes> from_light, from_eye;
        std::array<NearSum, growths> near;

        // Fewer hits than a sixteenth of a pixel's samples are rare, even if it has all of them; of
        // more than half as many the number is hardly random: chosen by calibration.
        double few() const { return samples / weight / 16; }
    };
    std::vector<OneLight> lights_;
    bool is_pilot_ = false;
};

// Observes the paths of a render, of a band, and judges its estimated error.
class LightRecorder {
public:
    LightRecorder(const Scene& scene, const Technique& t, int first_row, int rows,
                  const std::vector<uint32_t>& line_of_light = {})
        : scene_(scene), group_of_(light_groups(scene)), area_class_(area_classes(scene)) {
        const Band band{first_row, rows};
        const uint64_t paths = aimed_paths(scene, band);
        const Aims aims(scene);
        view_ = lights_in_view(scene, band, t, aims.of_eye(scene), paths, line_of_light);
        const PictureSums sent = sent_by_lights(scene, band, aims, paths);
        for (size_t g = 0; g < view_.groups.size(); ++g)
            for (size_t k = 0; k < classes; ++k)
                view_.groups[g].from_light[k] =
                    sent.of(g * classes + k, double(rows) * scene.size.width);
    }

    // Lights, and pixels near them, of a film whose noisy pixels have K samples or more for each
    // sample of a replication of weight 1.
    std::vector<NearMisses> near_misses(uint32_t K) const {
        std::vector<NearMisses> near = view_.groups;
        for (NearMisses& g : near) g.K = K;
        return near;
    }
    const std::vector<size_t>& noisy() const { return view_.noisy; }
    static std::string why_unknown(const Film& film, const ImageError& error) {
        MissedLight unseen;
        unseen.add(film.near, double(film.min_samples_done()));
        return unseen.doubt(error.d2(), error.norm(), error.pixels);
    }
    NearMissVisitor visitor(Tally& tally) const {
        return {scene_, view_.groups, group_of_, area_class_, tally};
    }

private:
    const Scene& scene_;
    const std::vector<size_t> group_of_;
    const std::vector<uint8_t> area_class_;
    LightsInView view_;
};

}  // namespace penumbra

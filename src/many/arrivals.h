// many/arrivals.h  2  which lights the eye's surfaces see: a factor of their intensities
#pragma once
#include "base/rng.h"
#include "many/light_tree.h"
#include "world/scene.h"

namespace penumbra {

// Sums over surfaces of a light's estimated contributions, and of those that nothing hides.
struct Arrival {
    double all = 0, squares = 0, visible = 0;
    void add(double w, bool is_visible) {
        all += w, squares += w * w;
        if (is_visible) visible += w;
    }
    // Where a light is visible with probability v, the variance is least if its share is in
    // proportion to w sqrt(v), for its contribution has the mean square v w^2.  Fewer than 16
    // surfaces, by their effective number (Kish 1965), say nothing: what an eighth of them sees,
    // all of so few may miss, with a probability of (7/8)^16 = 12 %.
    double factor() const { return all * all / squares >= 16 ? std::sqrt(visible / all) : 1; }
};

// Adds the contributions of all lights of a tree to a surface, with its material and the direction
// wo from which it is seen.  beta: throughput from there to the eye.
inline void add_arrivals(std::vector<Arrival>& arrivals, const Scene& s, const LightTree& tree,
                         const Surface& x, const Frame& local, const Material& m, vec3 wo,
                         double beta, uint64_t key) {
    tree.visit_weights(x.p, local.n, [&](size_t i, real weight) {
        const vec2 u{to_unit(hash(key, 2 * i)), to_unit(hash(key, 2 * i + 1))};
        const auto y = sample_light(s.lights[i], x.p, u);
        const real f = y ? max_of(eval(m, wo, local.to_local(y->wi))) : 0;
        if (!(f > 0)) return;
        arrivals[i].add(beta * double(f) * double(weight), !s.bvh.occluded(spawn_to(x, y->at)));
    });
}

// Of each light, along 512 paths from the eye (fewer gave a sun too few surfaces that it could
// shine on), of three surfaces that are no mirrors or glass; fewer in scenes of more than 170
// lights, none where the tests could not suffice for a factor.  A function of the scene alone,
// which samples of the picture do not influence: choices by it are unbiased.
inline std::vector<Arrival> arrivals_of(const Scene& s) {
    constexpr uint64_t paths = 512, max_draws = 64;
    constexpr uint64_t max_tests = 1 << 18;  // of visibility: a tenth of a second or so
    std::vector<Arrival> arrivals(s.lights.size());
    if (s.lights.size() < 2 || s.lights.size() > max_tests / 16) return arrivals;
    const LightTree tree(s.lights, intensities_of(s.lights));
    for (uint64_t path = 0, tests = 0; path < paths && tests < max_tests; ++path) {
        uint64_t draws = 0;
        auto u = [&] { return to_unit(hash(path, draws++)); };
        auto u2 = [&] {
            const real x = u();
            return vec2{x, u()};
        };
        const vec2 at = u2();  // of a view twice as wide as high, whatever the size of the picture
        Ray ray = camera_ray(s.camera, {2, 1}, 2 * at.x, at.y);
        rgb beta{1, 1, 1};
        for (int surfaces = 0; surfaces < 3 && draws < max_draws;) {
            const auto hit = s.bvh.closest(ray);
            if (!hit) break;
            const Surface x = s.surface(ray, *hit);
            const Material& m = s.material(*hit);
            const bool outside = dot(x.n, ray.d) < 0;
            const Frame local = frame(outside ? x.n : -x.n);
            const vec3 wo = local.to_local(-ray.d);
            if (!m.is_delta()) {
                add_arrivals(arrivals, s, tree, x, local, m, wo, double(max_of(beta)),
                             hash(path, max_draws + draws));
                ++surfaces, tests += s.lights.size();
            }
            const real u_lobe = u();
            const BsdfSample b = sample(m, wo, outside, u_lobe, u2(), Direction::bsdf);
            if (!(max_of(b.f) > 0)) break;
            beta *= b.f * (std::abs(b.wi.z) / b.pdf);
            ray = spawn(x, local.to_world(b.wi));
        }
    }
    return arrivals;
}

// Intensities count times the factor of what arrives.
inline LightTree light_choice_for(const Scene& s) {
    std::vector<double> intensities = intensities_of(s.lights);
    const std::vector<Arrival> arrivals = arrivals_of(s);
    for (size_t i = 0; i < intensities.size(); ++i) intensities[i] *= arrivals[i].factor();
    return {s.lights, intensities};
}

}  // namespace penumbra

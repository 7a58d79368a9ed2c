// world/prepare.h  7  what rendering needs of a scene: the BVH, and the choice of lights
#pragma once
#include "base/rng.h"
#include "world/scene.h"

namespace penumbra {

// ---- Light that arrives -------------------------------------------------------------------------

// Sums over surfaces of a light's estimated contributions, and of those that nothing hides.
struct Arrival {
    double all = 0, squares = 0, visible = 0;
    void add(double w, bool is_visible) {
        all += w, squares += w * w;
        if (is_visible) visible += w;
    }
    // Where a light is visible with probability v, the variance is least if its share is in
    // proportion to w sqrt(v), for its contribution has the mean square v w^2.  Fewer than 16
    // surfaces (Kish 1965) say nothing: what an eighth of them sees, all of so few may miss, with
    // a probability of (7/8)^16 = 12 %.
    double factor() const { return all * all / squares >= 16 ? std::sqrt(visible / all) : 1; }
};

// Strengths are those of the lights, times the factor of what arrives.
inline LightTree light_tree_of(const std::vector<Light>& lights,
                               const std::vector<Arrival>& arrivals) {
    std::vector<double> of(lights.size());
    double most = std::numeric_limits<double>::min();
    for (size_t i = 0; i < lights.size(); ++i)
        most = std::max(most, of[i] = strength(lights[i]) * arrivals[i].factor());
    std::vector<real> strengths;
    for (double x : of) strengths.push_back(real(x / most));
    return {lights, strengths};
}

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
    const LightTree tree = light_tree_of(s.lights, arrivals);
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

// ---- Preparation --------------------------------------------------------------------------------

// Scene files are checked first, and surfaces that lie in each other moved apart: see src/check.
inline void prepare(Scene& s) {
    s.bvh = Tree(s.shapes);
    s.facing.clear();
    for (const Shape& shape : s.shapes) s.facing.push_back(facing(shape));
    s.light_tree = light_tree_of(s.lights, arrivals_of(s));
}

}  // namespace penumbra

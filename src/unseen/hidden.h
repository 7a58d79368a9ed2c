// unseen/hidden.h  1  lights that no path can find
#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/rng.h"
#include "text/named_scene.h"

namespace penumbra {

// The first hit that is not glass.  The ray then starts behind the glass.
inline std::optional<Hit> hit_through_glass(const Scene& s, Ray& ray) {
    auto hit = s.bvh.closest(ray);
    for (int k = 0; k < 64 && hit && s.material(*hit).transmits(); ++k) {
        ray = {spawn(s.surface(ray, *hit), ray.d).o, ray.d, ray.tmax - hit->t};
        hit = s.bvh.closest(ray);
    }
    return hit;
}

// Follows 512 paths of 32 bounces from a light.  If none leaves the scene or comes in view of the
// eye, returns the shape that the last of them met first.  Mirrors and glass end the first ray of a
// point light, for no light sample uses them.
inline std::optional<uint32_t> hides(const Scene& s, const Light& l) {
    std::optional<uint32_t> first;
    for (uint64_t i = 0; i < 512; ++i) {
        auto u = [&](uint64_t k) {
            return vec2{to_unit(hash(i, 2 * k)), to_unit(hash(i, 2 * k + 1))};
        };
        vec3 d = sample_uniform_sphere(u(0));
        const Surface from = point_of(l, u(33));
        if (!l.twosided && dot(d, from.n) < 0) d = -d;
        Ray ray = spawn(from, d);
        const bool point = l.is_delta();
        auto hit = point ? s.bvh.closest(ray) : hit_through_glass(s, ray);
        if (hit) first = hit->id;
        for (uint64_t k = 1; k <= 32; ++k) {
            if (!hit) return {};
            if (point && k == 1 && s.material(*hit).is_delta()) break;
            const Surface x = s.surface(ray, *hit);
            const vec3 n = dot(x.n, ray.d) < 0 ? x.n : -x.n;
            Ray to_eye = spawn_to({x.p, n, x.error}, {s.camera.eye, {}, 0});
            if (dot(n, s.camera.eye - x.p) > 0 && !hit_through_glass(s, to_eye)) return {};
            ray = spawn(x, frame(n).to_world(sample_cosine_hemisphere(u(k))));
            hit = hit_through_glass(s, ray);
        }
    }
    return first;
}

// Warnings: hidden lights, the first of each of 100 lines; light of points that only samples of
// directions could find.
inline std::vector<std::string> hidden_lights(const NamedScene& s) {
    std::vector<std::string> warnings;
    auto warn = [&](size_t light, const std::string& what) {
        warnings.push_back("line " + std::to_string(s.line_of_light[light]) + ": " + what);
    };
    std::set<uint32_t> told;
    for (size_t k = 0; k < s.lights.size(); ++k) {
        if (!told.insert(s.line_of_light[k]).second || told.size() > 100) continue;
        if (const auto shape = hides(s, s.lights[k]))
            warn(k, "this light is hidden by " + where(s, *shape) +
                        ": none of 512 paths from it comes out or in view of the eye");
    }
    const auto bare = std::ranges::find_if(s.lights, &Light::is_delta);
    if (bare != s.lights.end() &&
        std::ranges::any_of(s.material_of, [&](auto m) { return s.materials[m].is_delta(); }))
        warn(size_t(bare - s.lights.begin()),
             std::string("a ") + name_of(*bare) +
                 " light does not shine through glass or by mirrors, where no path finds it: "
                 "that light is missing" +
                 (bare->as<PointLight>() ? "; a sphere of radius r and radiance I / (pi r^2) "
                                           "shines there, too"
                                         : ""));
    return warnings;
}

}  // namespace penumbra

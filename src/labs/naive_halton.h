// labs/naive_halton.h  3  a common misuse of Halton points, which makes them seem useless
//
// All decisions of a path reuse bases 2 and 3, and all pixels have the same points, so images are
// biased.  A decision by three numbers would add base 5, but there is none here.
#pragma once
#include "app/threads.h"
#include "film/image.h"
#include "labs/lab.h"
#include "path/pathtracer.h"

namespace penumbra::naive_halton {

// Radiance along a ray from the single point u: by NEE if t.light is nee, else by BSDF sampling.
inline rgb radiance(const Scene& scene, const Technique& t, Ray ray, vec2 u) {
    const bool nee = t.light == LightMode::nee;
    bool count_emission = true;  // false where NEE accounts for it
    rgb L, beta{1, 1, 1};
    for (int k = 0;; ++k) {
        const auto x = meet(scene, ray);
        if (!x) return L;
        const Material& m = *x->material;
        if (m.emits() && count_emission) L += beta * emitted(m, x->cos_o);
        if (k == scene.depth || x->cos_o == 0) return L;
        if (nee && !m.is_delta() && !scene.lights.empty()) {
            const auto chosen = scene.light_choice.choose(x->at.p, x->local.n, u.x);
            const auto s = sample_light(scene.lights[chosen.light], x->at.p, u);
            if (s && !scene.bvh.occluded(spawn_to(x->at, s->at))) {
                const vec3 wi = x->local.to_local(s->wi);
                L += beta * eval(m, x->wo, wi) * s->L * (wi.z / (chosen.probability * s->pdf));
            }
        }
        const BsdfSample b = sample(m, x->wo, x->cos_o > 0, u.x, u, t.direction);
        if (max_of(b.f) <= 0) return L;
        beta = beta * (b.f * (std::abs(b.wi.z) / b.pdf));
        if (max_of(beta) < t.roulette) {
            const real survival = max_of(beta) / t.roulette;
            if (u.x >= survival) return L;
            beta /= survival;
        }
        count_emission = !nee || m.is_delta();
        ray = spawn(x->at, x->local.to_world(b.wi));
    }
}

// Renders an image.  Each pixel is the mean over the first `spp` points.
inline Image render(const Scene& scene, const Technique& t, uint64_t spp) {
    Image image(scene.size.width, scene.size.height);
    auto row = [&](int y, unsigned) {
        for (int x = 0; x < image.width; ++x) {
            rgb sum;
            for (uint64_t i = 0; i < spp; ++i) {
                const vec2 u{radical_inverse(2, i), radical_inverse(3, i)};
                sum +=
                    radiance(scene, t,
                             camera_ray(scene.camera, scene.size, real(x) + u.x, real(y) + u.y), u);
            }
            for (size_t c = 0; c < 3; ++c) image.at(x, y)[c] = float(sum.*axis[c] / real(spp));
        }
    };
    by_workers(image.height, all_cores(), row, [](double) {});
    return image;
}

}  // namespace penumbra::naive_halton

// views.h  floor 4  other things to look at than radiance, and one path in words
#pragma once
#include <cstdio>

#include "options.h"
#include "scene.h"

// ---- Views (--view) ---------------------------------------------------------------------------

// What a ray sees; black where it meets nothing.
inline rgb view_along(const Scene& scene, View view, const Ray& ray) {
    if (view == View::bvh) {
        const Bvh::Work work = scene.bvh.work(ray);
        return {real(work.nodes), real(work.shapes), 0};
    }
    const auto hit = scene.bvh.closest(ray);
    if (!hit) return {};
    if (view == View::depth) return {hit->t, hit->t, hit->t};
    const Surface x = surface(scene.shapes[hit->id], ray, *hit);
    if (view == View::normal) return (x.n + vec3{1, 1, 1}) / 2;
    const Material& m = scene.material(*hit, x.p);
    return m.kind == Material::Kind::glass ? rgb{1, 1, 1} : m.kd + m.ks;
}

// Factor to PNG: a scene's own is meant for radiance.  Depth reaches white at the diagonal of the
// scene's box, work at 64 visits.
inline real default_exposure(const Scene& scene, View view) {
    if (view == View::radiance || view == View::variance) return scene.exposure;
    if (view == View::bvh) return real(1) / 64;
    if (view != View::depth) return 1;
    Box box;
    for (const Shape& s : scene.shapes) box.add(bounds(s));
    return 1 / length(box.hi - box.lo);
}

// ---- One path (--pixel) -----------------------------------------------------------------------

// Writes down what happens on a path, a line an event, with every digit: what it prints is what
// the image was made of.
class PathLog {
public:
    explicit PathLog(std::FILE* out) : out_(out) {}

    void film(vec2 u, const Ray& ray) const {
        print("film", {u.x, u.y});
        print("ray from", ray.o);
        print("ray towards", ray.d);
    }
    void vertex(int k, const Hit& hit, const Surface& x, rgb throughput) const {
        std::fprintf(out_, "vertex %d: shape %u at distance %.17g\n", k, hit.id, double(hit.t));
        print("  p", x.p);
        print("  n", x.n);
        print("  throughput", throughput);
    }
    void emission(rgb Le, real weight) const {
        print("  emission", Le);
        print("  its weight", {weight});
    }
    void light(const Light& light, const LightSample& s, real pdf, real weight, bool occluded,
               rgb L) const {
        constexpr const char* kinds[] = {"sphere", "triangle", "quad", "point"};
        std::fprintf(out_, "  light sample: %s light, chosen with probability %.17g, %s\n",
                     kinds[int(light.kind)], double(light.pick), occluded ? "occluded" : "visible");
        print("    at", s.at.p);
        print("    wi", s.wi);
        print("    pdf", {pdf});
        print("    its weight", {weight});
        print("    reflected", L);
    }
    void shadowed(rgb U, rgb w, rgb wV) const {
        print("  without shadows, exact", U);
        print("  without shadows, as sampled", w);
        print("  as sampled, with shadows", wV);
    }
    void scattering(vec3 wi, rgb f, real cosine, real pdf) const {
        print("  wi", wi);
        print("  f", f);
        print("  cosine", {cosine});
        print("  pdf", {pdf});
    }
    void end(const char* why, rgb L) const {
        std::fprintf(out_, "end: %s\n", why);
        print("L", L);
    }

private:
    std::FILE* out_;

    void print(const char* what, std::initializer_list<real> numbers) const {
        std::fprintf(out_, "%s:", what);
        for (real x : numbers) std::fprintf(out_, " %.17g", double(x));
        std::fputc('\n', out_);
    }
    void print(const char* what, vec3 v) const { print(what, {v.x, v.y, v.z}); }
};

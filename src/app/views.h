// app/views.h  2  other things to look at than radiance (--view)
#pragma once
#include "app/options.h"

// What a ray sees; black where it meets nothing.
inline rgb view_along(const Scene& scene, View view, const Ray& ray) {
    if (view == View::bvh) {
        const Tree::Work work = scene.bvh.work(ray);
        return {real(work.nodes), real(work.shapes), 0};
    }
    const auto x = meet(scene, ray);
    if (!x) return {};
    if (view == View::depth) return {x->hit.t, x->hit.t, x->hit.t};
    if (view == View::normal) return (x->at.n + vec3{1, 1, 1}) / 2;
    const Material& m = *x->material;
    return m.kind == Material::Kind::glass ? rgb{1, 1, 1} : m.kd + m.ks;
}

// Factor to PNG: a scene's own is meant for radiance.  Depth reaches white at the diagonal of the
// scene's box, work at 64 visits.
inline real default_exposure(const Scene& scene, View view) {
    if (view == View::radiance) return scene.exposure;
    if (view == View::bvh) return real(1) / 64;
    if (view != View::depth) return 1;
    return 1 / diagonal(scene);
}

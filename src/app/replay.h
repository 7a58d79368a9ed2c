// app/replay.h  7  one path in words (--pixel)
#pragma once
#include <cstdio>

#include "app/job.h"

// Writes down what happens on a path, a line an event, with every digit: what it prints is what
// the image was made of.
class PathLog {
public:
    PathLog(const Scene& scene, std::FILE* out) : scene_(scene), out_(out) {}

    void film(const Start& at) const {
        print("film", {at.u.x, at.u.y});
        print("ray from", at.ray.o);
        print("ray towards", at.ray.d);
    }

    // A vertex, as an account of Li.
    void operator()(const Segment& s, const Step& e) const {
        if (!e.met) return;
        const Vertex& x = e.x;
        std::fprintf(out_, "vertex %d: shape %u%s at distance %.17g\n", s.k, x.hit.id,
                     origin(x.hit.id).c_str(), double(x.hit.t));
        print("  p", x.at.p);
        print("  n", x.at.n);
        print("  throughput", s.beta);
        if (x.material->emits()) {
            print("  emission", e.Le);
            print("  its weight", {e.weight});
        }
        if (e.direct.light) light(e.direct);
        if (e.scattered.pdf > 0) {
            print("  wi", e.wi);
            print("  f", e.scattered.f);
            print("  cosine", {std::abs(e.scattered.wi.z)});
            print("  pdf", {e.scattered.pdf});
        }
    }

    // The same where maps may end a path.
    void operator()(const Segment& s, const Step& e, const Mapped& m) const {
        (*this)(s, e);
        if (!e.met || m.q == 1) return;
        print("  reflected, by the maps", m.R);
        print("  its weight", {m.weight});
        print("  probability to go on", {m.q});
    }

    // What the estimators of direct light make of the first vertex.
    void shadowed(const Shadowed& s) const {
        print("first vertex without shadows, exact", s.U);
        print("first vertex without shadows, as sampled", s.w);
        print("first vertex as sampled, with shadows", s.wV);
    }

    void end(const char* why, rgb L) const {
        std::fprintf(out_, "end: %s\n", why);
        print("L", L);
    }

private:
    const Scene& scene_;
    std::FILE* out_;

    // Where the scene's file has this shape.
    std::string origin(uint32_t shape) const {
        if (scene_.line_of.empty()) return "";
        return ", material " + in_quotes(scene_.names[scene_.material_of[shape]]) + ", line " +
               std::to_string(scene_.line_of[shape]) + ",";
    }

    void light(const DirectLight& d) const {
        constexpr const char* kinds[] = {"sphere", "triangle", "quad", "point"};
        std::fprintf(out_, "  light sample: %s light, chosen with probability %.17g, %s\n",
                     kinds[int(d.light->kind)], double(d.pdf / d.sample.pdf),
                     d.occluded ? "occluded" : "visible");
        print("    at", d.sample.at.p);
        print("    wi", d.sample.wi);
        print("    pdf", {d.pdf});
        print("    its weight", {d.weight});
        print("    reflected", d.L);
    }
    void print(const char* what, std::initializer_list<real> numbers) const {
        std::fprintf(out_, "%s:", what);
        for (real x : numbers) std::fprintf(out_, " %.17g", double(x));
        std::fputc('\n', out_);
    }
    void print(const char* what, vec3 v) const { print(what, {v.x, v.y, v.z}); }
};

// Prints one path of the image.
inline void replay(const Job& job) {
    const auto& [o, scene, pattern, passes, part, maps, rest] = job;
    const PathLog log(scene, stdout);
    const PixelSample which{o.replay->x, o.replay->y, o.sample.value_or(0), o.set.value_or(0)};
    const Start at = start(scene, pattern, which);
    log.film(at);
    if (is_plain_view(o.view))
        return log.end("a view, not radiance", view_along(scene, o.view, at.ray));
    const char* why = nullptr;
    auto account = [&](const Segment& s, const Step& e) {
        log(s, e);
        why = e.end;
    };
    if (maps)
        return log.end(why,
                       mapped_Li(job, which, [&](const Segment& s, const Step& e, const Mapped& m) {
                           log(s, e, m);
                           why = m.goes ? e.end : "the maps";
                       }));
    if (o.direct == Estimator::stochastic)
        return log.end(why, Li(scene, o.technique, at.ray, at.sampler, account));
    const ShadowSample sample = shadow_Li(scene, o.technique, o.direct, at, account);
    log.shadowed(sample.first);
    log.end(why, sample.rest);
}

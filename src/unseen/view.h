// unseen/view.h  4  what lights bring to the picture, by paths from the eye that aim
#pragma once
#include "path/halton.h"
#include "path/pathtracer.h"
#include "unseen/sent.h"

namespace penumbra {

inline double mean_square(rgb L) {
    return (sqr(double(L.x)) + sqr(double(L.y)) + sqr(double(L.z))) / 3;
}

// Calls visit(light, L, is_met) with what lights bring at a vertex, but where the eye sees them: a
// light that the ray met lights the vertex before.
template <class Visit>
void visit_lights(const Scene& s, const PathState& path, const VertexEvents& here, Visit visit) {
    if (path.k > 0 && max_of(here.Le) > 0)
        visit(size_t(s.light_of[here.vertex.hit.id]), path.beta * here.Le * here.weight, true);
    if (here.direct.light)
        visit(size_t(here.direct.light - s.lights.data()), path.beta * here.direct.L, false);
}

// ---- Paths from the eye -------------------------------------------------------------------------

// What a path from the eye finds that aims at edge or shape number `aim`, with density pdf per
// pixel: mean channels of what lights bring, and the light that the eye sees.
struct EyePath {
    size_t aim, pixel;
    double pdf = 0;
    std::vector<std::pair<size_t, double>> brought = {};
    std::optional<size_t> seen = {};
    double pdf_of_points = 0;  // density per pixel of samples of the light that the eye sees
};

// The view of the next ray: that of a mirror, or the same behind glass; nothing at other surfaces.
inline std::optional<size_t> next_view(const Aims& aims, size_t view, const VertexEvents& here) {
    if (here.end != End::no || !here.vertex.material->is_delta()) return {};
    return here.scattered.wi.z < 0 ? view : aims.in_mirror(view, here.vertex.hit.id);
}

// Path k of many, of up to 32 bounces, if it goes into the picture, and comes by the mirrors of the
// view at which it aims, and no other of which a view goes on.  (Each path is in one view: together
// they are all paths.)
inline std::optional<EyePath> eye_path(const Scene& s, const Band& band, const Technique& technique,
                                       const Aims& aims, uint64_t k) {
    static const SamplerSettings settings{SamplerKind::independent};
    const vec3 eye = s.camera.eye;
    const auto aim =
        aims.sample(eye, radical_inverse(3, k), {radical_inverse(5, k), radical_inverse(2, k)});
    const auto to = aim ? pixel_through(s, band, aim->d) : std::nullopt;
    if (!to) return {};
    EyePath found{aim->at, to->pixel};
    const Sampler sampler(settings, 0, k);
    std::optional<size_t> view = 0;
    for (PathState path{{eye, aim->d}, eye}; path.k <= max_bounces;) {
        const VertexEvents here = step(s, technique, path, sampler);
        if (view) {
            const auto next = next_view(aims, *view, here);
            if (!next && *view != aims.view_of(aim->at)) return {};
            view = next;
        }
        if (path.k == 0 && max_of(here.Le) > 0) {
            found.seen = size_t(s.light_of[here.vertex.hit.id]);
            found.pdf_of_points =
                double(pdf_light(s.lights[*found.seen], eye, here.vertex.at)) * to->solid_angle;
        }
        visit_lights(s, path, here, [&](size_t light, rgb L, bool) {
            if (mean_of(L) > 0) found.brought.emplace_back(light, mean_of(L));
        });
        if (here.end != End::no) break;
        path = here.next;
    }
    found.pdf = double(aims.pdf(eye, aim->d, aims.view_of(aim->at))) * to->solid_angle;
    return found.pdf > 0 ? std::optional(found) : std::nullopt;
}

// Learns where to aim: half by all that an aim brings, half by its parts of each class of radiance,
// for the brightest light would have nearly all.
inline void learn(Aims& aims, const Scene& s, const Band& band, const Technique& technique,
                  uint64_t paths) {
    std::vector<std::array<double, classes>> brought(aims.size());
    std::array<double, classes> all{};
    for (uint64_t k = 0; k < paths; ++k)
        if (const auto path = eye_path(s, band, technique, aims, k))
            for (const auto& [light, L] : path->brought)
                brought[path->aim][class_of(L)] += L, all[class_of(L)] += L;
    const double sum = std::accumulate(all.begin(), all.end(), 0.0);
    const double present = double(std::ranges::count_if(all, [](double L) { return L > 0; }));
    std::vector<double> worth(aims.size());
    for (size_t i = 0; i < worth.size(); ++i)
        for (size_t k = 0; k < classes; ++k)
            if (all[k] > 0) worth[i] += brought[i][k] * (1 / sum + 1 / (present * all[k]));
    aims.prefer(worth);
}

// ---- Lights in view -----------------------------------------------------------------------------

struct LightsInView {
    std::vector<NearMisses> groups;
    std::vector<size_t> noisy;  // pixels of groups whose points cover less than 16
};

// Calls add(light, pixel, pdf of the point, pdf of aims), densities per pixel, for n points of each
// light that the eye sees.
template <class Add>
void visit_points(const Scene& s, const Band& band, const Aims& aims, size_t n, Add add) {
    const vec3 eye = s.camera.eye;
    for (size_t i = 0; i < s.lights.size(); ++i)
        for (size_t k = 0; k < n && !s.lights[i].is_delta(); ++k) {
            const vec2 u{(real(k) + real(0.5)) / real(n), radical_inverse(2, k)};
            const auto at = sample_light(s.lights[i], eye, u);
            const auto to = at ? pixel_through(s, band, at->wi) : std::nullopt;
            if (to && !s.bvh.occluded(spawn_to({eye, {}, 0}, at->at)))
                add(i, to->pixel, double(at->pdf) * to->solid_angle,
                    double(aims.pdf(eye, at->wi)) * to->solid_angle);
        }
}

// Samples 1024 points of each group, and follows paths from the eye: parts of pixels that lights
// cover, and what else they bring.  Half of the paths learn where to aim, the others count.  Lines
// are those of the scene's file, or none.
inline LightsInView lights_in_view(const Scene& s, const Band& band, const Technique& technique,
                                   Aims aims, uint64_t paths,
                                   const std::vector<uint32_t>& line_of_light = {}) {
    const std::vector<size_t> group_of = light_groups(s);
    const size_t groups = std::min(s.lights.size(), max_light_groups);
    const size_t points = 1024 * groups / std::max<size_t>(1, s.lights.size()) + 1;
    const uint64_t aimed = aims.size() > 0 && groups > 0 ? paths / 2 : 0;
    if (aimed > 0) learn(aims, s, band, technique, aimed);

    std::vector<std::map<size_t, double>> parts(groups);
    // A sample of either kind counts as one of both together.
    auto add = [&](size_t light, size_t pixel, double pdf_of_points, double pdf) {
        parts[group_of[light]][pixel] += 1 / (pdf_of_points * double(points) + pdf * double(aimed));
    };
    std::vector<double> by_points(groups);  // area; aims, and their luck, choose no samples
    auto add_point = [&](size_t light, size_t pixel, double pdf_of_points, double pdf) {
        by_points[group_of[light]] += 1 / (pdf_of_points * double(points));
        add(light, pixel, pdf_of_points, pdf);
    };
    visit_points(s, band, aims, points, add_point);
    PictureSums sums(groups * classes);
    for (uint64_t k = aimed; k < 2 * aimed; ++k)
        if (const auto path = eye_path(s, band, technique, aims, k)) {
            if (path->seen) add(*path->seen, path->pixel, path->pdf_of_points, path->pdf);
            for (const auto& [light, L] : path->brought)
                sums.add(group_of[light] * classes + class_of(L), path->pixel,
                         L / (path->pdf * double(aimed)));
            sums.end_path();
        }

    LightsInView view{std::vector<NearMisses>(groups), {}};
    for (size_t i = 0; i < s.lights.size(); ++i) {
        NearMisses& group = view.groups[group_of[i]];
        if (group.line == 0 && i < line_of_light.size()) group.line = line_of_light[i];
        group.L2 = std::max(group.L2, mean_square(s.lights[i].L));
    }
    for (size_t g = 0; g < groups; ++g) {
        NearMisses& group = view.groups[g];
        for (size_t k = 0; k < classes; ++k)
            group.from_eye[k] = sums.of(g * classes + k, band.count * s.size.width);
        for (const auto& [i, a] : parts[g]) group.area += a, group.a += std::max(0.0, a * (1 - a));
        if (by_points[g] < 16)
            for (const auto& [i, a] : parts[g]) view.noisy.push_back(i);
    }
    return view;
}

}  // namespace penumbra

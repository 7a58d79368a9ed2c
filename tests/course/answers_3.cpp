// course/answers_3.cpp  answers of week 3: the path
//
// The judge says which scene: this program only builds it, and asks the path tracer.
#include <stdexcept>

#include "course/answers.h"
#include "path/pathtracer.h"
#include "world/prepare.h"

using namespace penumbra;
using course::In, course::Out, course::row, course::vec3_of;

namespace {

Scene scene;  // the one that was asked for last

// 13 numbers: kind, kd, ks, exponent, ior, Le, whether two-sided.
Material material_of(In x) {
    const Scattering kinds[] = {Rough(vec3_of(x, 1), vec3_of(x, 4), real(x[7])),
                                Mirror(vec3_of(x, 4)), Glass(real(x[8]))};
    return {kinds[size_t(x[0])], vec3_of(x, 9), x[12] != 0};
}

// 23 numbers: 0 and a centre and a radius, or 1 and a corner and two edges, or 2 and the place and
// the intensity of a point light; from the tenth on a material.
void add(In x) {
    const uint32_t material = uint32_t(scene.materials.size());
    scene.materials.push_back(material_of(x.subspan(10)));
    if (x[0] == 0) add_sphere(scene, vec3_of(x, 1), real(x[4]), material);
    if (x[0] == 1) add_quad(scene, vec3_of(x, 1), vec3_of(x, 4), vec3_of(x, 7), material);
    if (x[0] == 2) add_light(scene, {vec3_of(x, 1), PointLight(), vec3_of(x, 4)});
}

Out build(In x) {
    scene = {};
    scene.depth = int(x[0]);
    for (size_t at = 1; at + 23 <= x.size(); at += 23) add(x.subspan(at, 23));
    prepare(scene);
    return {double(scene.shapes.size()), double(scene.lights.size())};
}

// The numbers of path `seed`.
Sampler sampler(double seed) {
    static const SamplerSettings settings{SamplerKind::independent, 3};
    return {settings, 0, uint64_t(seed)};
}

// 3 numbers: how light is found, how directions are chosen, the threshold of roulette.
Technique technique(In x) { return {Direction(int(x[1])), LightMode(int(x[0])), real(x[2])}; }

// 17 numbers.
PathState path_state(In x) {
    const Ray ray{vec3_of(x, 0), vec3_of(x, 3)};
    return {ray, vec3_of(x, 6), real(x[9]), vec3_of(x, 10), int(x[13]), vec3_of(x, 14)};
}

// In glass there is one more number, eta2.
VertexEvents asked_step(In x) {
    const Sampler numbers_of_path = sampler(x[3]);
    PathState arrives = path_state(x.subspan(4));
    if (x.size() > 21) arrives.eta2 = real(x[21]);
    return step(scene, technique(x), arrives, numbers_of_path);
}
Out take_step(In x) {
    const VertexEvents e = asked_step(x);
    const bool goes_on = e.end == End::no;
    const PathState& s = e.next;
    return row(e.met, goes_on, e.weight, e.Le, e.direct.L, e.wi, e.vertex.local.n, s.ray.o, s.ray.d,
               s.from, s.pdf, goes_on ? s.beta : rgb{}, s.k, s.n, e.scattered.f, e.scattered.wi,
               e.scattered.pdf);
}

// Of the ray that goes on; 0 if none does.
rgb throughput(In x) {
    const VertexEvents e = asked_step(x);
    return e.end != End::no ? rgb{} : e.next.beta;
}

rgb found_by_aiming(In x) {
    const Sampler numbers_of_path = sampler(x[3]);
    const auto at = meet(scene, {vec3_of(x, 4), vec3_of(x, 7)});
    if (!at) throw std::runtime_error("the ray meets nothing");
    return direct_light(scene, technique(x), *at, numbers_of_path, 0).L;
}

// What a light sample is made of before the student's lines: the chance of its light, its density,
// whether it is a point light's, cosine, density of a scattered ray, f, L, from where and to where;
// then what the lines make of it.  Nothing: 0 everywhere.
Out light_sample(In x) {
    const Technique t = technique(x);
    const Sampler numbers_of_path = sampler(x[3]);
    const auto at = meet(scene, {vec3_of(x, 4), vec3_of(x, 7)});
    if (!at) throw std::runtime_error("the ray meets nothing");
    const auto chosen = scene.light_choice.choose(
        at->at.p, at->local.n, numbers_of_path.choice(0, Dimension::which_light));
    const Light& light = scene.lights[chosen.light];
    const auto s =
        sample_light(light, at->at.p, numbers_of_path.get2(dimension(0, Dimension::light_x)));
    if (!s) return Out(23);
    const vec3 wi = at->local.to_local(s->wi);
    const DirectLight d = direct_light(scene, t, *at, numbers_of_path, 0);
    return row(chosen.probability, s->pdf, light.is_delta(), wi.z,
               pdf(*at->material, at->wo, wi, t.direction), eval(*at->material, at->wo, wi), s->L,
               at->at.p, s->at.p, d.L, d.pdf, d.weight, d.occluded);
}

// How often visit is called, and how often with the path whose turn it is.
Out visits(In x) {
    int calls = 0, in_turn = 0;
    Li(scene, technique(x), {vec3_of(x, 4), vec3_of(x, 7)}, sampler(x[3]),
       [&](const PathState& s, const VertexEvents&) { in_turn += s.k == calls++; });
    return row(calls, in_turn);
}

// A light's shape, a point of it and the normal there: 7 numbers.
Vertex on_a_light(In x) {
    Vertex y;
    y.hit.id = uint32_t(x[0]);
    y.at = {vec3_of(x, 1), vec3_of(x, 4)};
    y.material = &scene.material(y.hit);
    return y;
}

real weight(In x) {
    return weight_of_emission(scene, technique(x), path_state(x.subspan(3)),
                              on_a_light(x.subspan(20)));
}

// How likely a light sample from there is to choose that light, and the density of its point.
Out likelihood(In x) {
    const PathState s = path_state(x.subspan(3));
    const Vertex y = on_a_light(x.subspan(20));
    const size_t light = size_t(scene.light_of[y.hit.id]);
    return row(scene.light_choice.probability_of(light, s.from, s.n),
               pdf_light(scene.lights[light], s.from, y.at));
}

Out glass(In x) {
    const BsdfSample b = sample_glass(Glass(real(x[0])), vec3_of(x, 3), x[1] != 0, real(x[2]));
    return row(b.wi, b.f, b.pdf);
}

}  // namespace

int main() {
    return course::answer_all({
        {"scene", 0, build},
        {"Li", 10,
         [](In x) {
             return Li(scene, technique(x), {vec3_of(x, 4), vec3_of(x, 7)}, sampler(x[3]));
         }},
        {"visits", 10, visits},
        {"step", 21, take_step},
        {"throughput", 21, throughput},
        {"throughput_in_glass", 22, throughput},
        {"ended_by_roulette", 21,
         [](In x) { return Out{double(asked_step(x).end == End::roulette)}; }},
        {"direct_light", 10, found_by_aiming},
        {"light_sample", 10, light_sample},
        {"weight_of_emission", 27, weight},
        {"likelihood", 27, likelihood},
        {"sample_glass", 6, glass},
        {"number", 3,
         [](In x) { return sampler(x[0]).get(dimension(int(x[1]), Dimension(int(x[2])))); }},
    });
}

// course/answers_R.cpp  answers of the radiosity project: shooting, and a particle's walk
#include <tuple>

#include "base/rng.h"
#include "course/answers.h"
#include "radiosity/particles.h"
#include "radiosity/shooting.h"

using namespace penumbra;
using course::In, course::Out;

namespace {

rgb colour_of(In x, size_t at) { return course::vec3_of(x, at); }

Material diffuse(rgb albedo, rgb radiance) { return {Rough(albedo), radiance}; }

// The inside of a box of 2 x 3 x 1 whose walls are alike; with a lamp, only the ceiling y = 3
// emits.  A triangle may hang in it.
Scene room(rgb albedo, rgb radiance, bool lamp, bool shade = false) {
    Scene s;
    s.materials = {diffuse(albedo, lamp ? rgb{} : radiance), diffuse(albedo, radiance)};
    vec3 c[8];
    for (int i = 0; i < 8; ++i) c[i] = {real(2 * (i & 1)), real(3 * (i >> 1 & 1)), real(i >> 2)};
    add_face(s, c[0], c[1], c[3], c[2], 0), add_face(s, c[4], c[6], c[7], c[5], 0);  // -z, +z
    add_face(s, c[0], c[4], c[5], c[1], 0), add_face(s, c[2], c[3], c[7], c[6], 1);  // -y, +y
    add_face(s, c[0], c[2], c[6], c[4], 0), add_face(s, c[1], c[5], c[7], c[3], 0);  // -x, +x
    if (shade) add_triangle(s, {0.25, 0.5, 0.5}, {1.75, 0.5, 0.5}, {0.25, 2, 0.5}, 0);
    prepare(s);
    return s;
}

// albedo, radiance (r, g, b), lamp, whether whole faces shoot, side of elements, most shots.
// Elements, shots, what is unshot; of E in each channel the least, the greatest, and its integral
// over pi L times the area that emits.
Out shoot(In x) {
    const Scene scene = room(colour_of(x, 0), colour_of(x, 3), x[6] > 0);
    const Mesh mesh = make_mesh(scene, x[8]);
    Shooting shooting(scene, mesh, x[7] > 0 ? Shooter::face : Shooter::element, 1);
    shooting.run({1e-6, 0, uint64_t(x[9]), 0}, [](const Shooting&) {});
    Out out = {double(mesh.elements()), double(shooting.shots()), shooting.unshot()};
    const double emitting = x[6] > 0 ? 2 : 22;
    for (size_t c = 0; c < 3; ++c) {
        double least = double(infinity), greatest = 0, sum = 0;
        for (const Face& f : mesh.faces)
            for (uint32_t e = f.element; e < f.element + f.elements(); ++e)
                for (uint32_t v : mesh.corners[e]) {
                    const double E = double(shooting.map()[2 * v].*axis[c]);
                    least = std::min(least, E), greatest = std::max(greatest, E);
                    sum += E * double(f.area()) / double(3 * f.elements());
                }
        const double L = std::max(x[3 + c], 1e-300);
        out.insert(out.end(), {least, greatest, sum / (double(pi) * L * emitting)});
    }
    return out;
}

// What is private in Shooting: an explicit instantiation may name it.
struct Key {
    friend auto opened(Key);
};
template <auto... members>
struct Opened {
    friend auto opened(Key) { return std::tuple(members...); }
};
template struct Opened<&Shooting::load, &Shooting::exitance, &Shooting::tree_, &Shooting::map_,
                       &Shooting::shot_, &Shooting::sent_, &Shooting::radiance_, &Shooting::side_>;

// Whether the triangle, of 4 elements, or a wall of 2 x 3 cells; whether its back; whether its
// first element alone; a seed of what was received and sent before.  What load returns; L of the
// node; of every element its area, M, what was shot before, L, and what is shot and sent after.
Out loaded(In x) {
    const bool back = x[1] > 0;
    const Scene scene = room({0.6, 0.3, 0.2}, {1, 2, 3}, true, true);
    const Mesh mesh = make_mesh(scene, 1.5);
    Shooting shooting(scene, mesh, Shooter::face, 1);
    const auto [load, exitance, tree, map, shot, sent, radiance, side] = opened(Key{});
    const uint32_t face = x[0] > 0 ? uint32_t(mesh.faces.size()) - 1 : 0;
    const Face& f = mesh.faces[face];
    Rng rng{hash(uint64_t(x[3]), 1)};
    auto any = [&] { return rgb{real(rng.uniform()), real(rng.uniform()), real(rng.uniform())}; };
    for (rgb& E : shooting.*map) E = any();
    for (Corners& c : shooting.*shot)
        for (rgb& M : c) M = any() / 2;
    shooting.*side = 2 * face + back;
    Out out;
    std::vector<Out> before;
    for (uint32_t e = f.element; e < f.element + f.elements(); ++e) {
        const Corners M = (shooting.*exitance)(f, e, back), was = (shooting.*shot)[2 * e + back];
        before.push_back(course::row(M[0], M[1], M[2], was[0], was[1], was[2]));
    }
    const uint32_t node =
        x[2] > 0 ? (shooting.*tree).leaf(f.element) : (shooting.*tree).first(face);
    const rgb said = (shooting.*load)(node);
    const Corners& all = (shooting.*radiance)[node];
    out = course::row(said, all[0], all[1], all[2]);
    for (uint32_t e = f.element; e < f.element + f.elements(); ++e) {
        const uint32_t leaf = (shooting.*tree).leaf(e);
        const Corners &L = (shooting.*radiance)[leaf], &now = (shooting.*shot)[2 * e + back];
        out = course::row(out, (shooting.*tree)[leaf].area, before[e - f.element], L[0], L[1], L[2],
                          now[0], now[1], now[2], (shooting.*sent)[2 * e + back]);
    }
    return out;
}

// albedo (r, g, b), number of the particle, seed.  Rays; emitted, absorbed, escaped power; stops;
// their power in sum and at the second of them, the greatest of any; cosine of the second ray at
// the first stop (0 if there is none), and what its direction along x and z adds up to; of the
// third at the second stop, and the product of both rays along that wall.
Out walked(In x) {
    static rgb albedo;
    static Scene scene;
    if (scene.shapes.empty() || albedo != colour_of(x, 0)) {
        albedo = colour_of(x, 0);
        scene = room(albedo, {1, 2, 4}, false);
    }
    const uint64_t seed = uint64_t(x[4]);
    const SamplerSettings settings = Particles::settings(SamplerKind::independent, seed),
                          more = sampler_settings(SamplerKind::independent, seed, 0);
    Balance b;
    std::vector<rgb> power;
    std::vector<vec3> at;
    std::vector<vec3> n;
    const uint32_t rays =
        walk(scene, LightsByPower(scene.lights), WalkNumbers(settings, more, 0, uint64_t(x[3])), b,
             [&](const Vertex& v, rgb p) {
                 power.push_back(p), at.push_back(v.at.p), n.push_back(v.local.n);
             });
    rgb sum, greatest;
    for (rgb p : power)
        for (auto c : axis) sum.*c += p.*c, greatest.*c = std::max(greatest.*c, p.*c);
    const vec3 w = at.size() > 1 ? unit(at[1] - at[0]) : vec3{},
               next = at.size() > 2 ? unit(at[2] - at[1]) : vec3{};
    const real cosine = at.empty() ? 0 : dot(w, n[0]), then = at.size() > 2 ? dot(next, n[1]) : 0,
               along = at.size() > 2 ? dot(w, next) - dot(w, n[1]) * then : 0;
    return course::row(rays, b.emitted, b.absorbed, b.escaped, power.size(), sum,
                       power.size() > 1 ? power[1] : rgb{}, greatest, cosine, w.x + w.z, then,
                       along);
}

}  // namespace

int main() {
    return course::answer_all({{"shoot", 10, shoot}, {"load", 4, loaded}, {"walk", 5, walked}});
}

// course/answers_R.cpp  answers of the radiosity project: shooting, and a particle's walk
#include "course/answers.h"
#include "radiosity/particles.h"
#include "radiosity/shooting.h"

using course::In, course::Out;

namespace {

rgb colour_of(In x, size_t at) { return course::vec3_of(x, at); }

Material diffuse(rgb albedo, rgb radiance) {
    Material m;
    m.kd = albedo, m.Le = radiance;
    return m;
}

// The inside of a box of 2 x 3 x 1 whose walls are alike; with a lamp, only the ceiling y = 3
// emits.
Scene room(rgb albedo, rgb radiance, bool lamp) {
    Scene s;
    s.materials = {diffuse(albedo, lamp ? rgb{} : radiance), diffuse(albedo, radiance)};
    vec3 c[8];
    for (int i = 0; i < 8; ++i) c[i] = {real(2 * (i & 1)), real(3 * (i >> 1 & 1)), real(i >> 2)};
    add_face(s, c[0], c[1], c[3], c[2], 0), add_face(s, c[4], c[6], c[7], c[5], 0);  // -z, +z
    add_face(s, c[0], c[4], c[5], c[1], 0), add_face(s, c[2], c[3], c[7], c[6], 1);  // -y, +y
    add_face(s, c[0], c[2], c[6], c[4], 0), add_face(s, c[1], c[5], c[7], c[3], 0);  // -x, +x
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

// albedo (r, g, b), number of the particle, seed.  Rays; emitted, absorbed, escaped power; stops;
// their power in sum and at the second of them, the greatest of any; cosine of the second ray at
// the first stop (0 if there is none), and what its direction along x and z adds up to.
Out walked(In x) {
    static rgb albedo;
    static Scene scene;
    if (scene.shapes.empty() || albedo != colour_of(x, 0)) {
        albedo = colour_of(x, 0);
        scene = room(albedo, {1, 2, 4}, false);
    }
    const uint64_t seed = uint64_t(x[4]);
    const Pattern pattern = Particles::pattern(SamplerKind::independent, seed, 16),
                  more = make_pattern(SamplerKind::independent, seed, 0, 0);
    Balance b;
    std::vector<rgb> power;
    std::vector<vec3> at;
    vec3 n;
    const uint32_t rays =
        walk(scene, WalkNumbers(pattern, more, 0, uint64_t(x[3])), b, [&](const Vertex& v, rgb p) {
            if (power.empty()) n = v.local.n;
            power.push_back(p), at.push_back(v.at.p);
        });
    rgb sum, greatest;
    for (rgb p : power)
        for (auto c : axis) sum.*c += p.*c, greatest.*c = std::max(greatest.*c, p.*c);
    const vec3 w = at.size() > 1 ? unit(at[1] - at[0]) : vec3{};
    return course::row(rays, b.emitted, b.absorbed, b.escaped, power.size(), sum,
                       power.size() > 1 ? power[1] : rgb{}, greatest, dot(w, n), w.x + w.z);
}

}  // namespace

int main() { return course::answer_all({{"shoot", 10, shoot}, {"walk", 5, walked}}); }

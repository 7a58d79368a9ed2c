// labs/room.h  3  scenes cut into triangles, and illumination maps on them
#pragma once
#include "app/threads.h"
#include "labs/lab.h"
#include "radiosity/particles.h"
#include "radiosity/shooting.h"

namespace penumbra {

// A scene cut into triangles, with its mesh.  No edge is longer than the H of make_room().
struct Room {
    std::string name;
    NamedScene scene;
    Mesh mesh;
};

inline Room make_room(const std::string& name, const NamedScene& read, double H) {
    Room r{name, faceted(read, H).scene, {}};
    r.mesh = make_mesh(r.scene, H);
    return r;
}
inline NamedScene scene_named(const std::string& name) {
    return read_scene("scenes/" + name + ".scene").scene;
}

// Traces n particles.
inline void walk(Particles& particles, uint64_t n, unsigned threads = all_cores()) {
    by_workers(
        Particles::batches, threads,
        [&](size_t batch, unsigned) { particles.add(batch, Particles::of_each(n)); },
        [](double) {});
}

// The integral of the square of a map over all surfaces, summed over channels.
inline double square_of(const Mesh& mesh, const IlluminationMap& map) {
    double sum = 0;
    for (const Face& f : mesh.faces)
        for (const bool back : {false, true}) {
            Sums x;
            for (uint32_t v = 0; v < f.vertices(); ++v) x.push_back(map[2 * (f.vertex + v) + back]);
            const rgb square = Projection(mesh, f).square(x);
            for (auto c : axis) sum += double(square.*c);
        }
    return sum;
}

// Extrapolates to a + (a - b) * factor.
inline IlluminationMap beyond(IlluminationMap a, const IlluminationMap& b, double factor) {
    for (size_t i = 0; i < a.size(); ++i) a[i] += real(factor) * (a[i] - b[i]);
    return a;
}
inline IlluminationMap difference(IlluminationMap a, const IlluminationMap& b) {
    for (size_t i = 0; i < a.size(); ++i) a[i] += -b[i];
    return a;
}

}  // namespace penumbra

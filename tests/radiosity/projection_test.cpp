// radiosity/projection_test.cpp  least squares, solved, and means over hats
#include "radiosity/projection.h"

#include "base/rng.h"
#include "oracle/expect.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

// The faces under test have an area of 3 each.
const Scene scenes[] = {scene_of_quads({{{1, 2, 0}, {2, 0, 0}, {0.5, 1.5, 0}}}),
                        one_triangle({0, 0, 1}, {2, 0, 0}, {0.4, 3, 0})};

// A point of an element: the weights of its hats, and its share in an integral over the face.
struct At {
    std::array<uint32_t, 3> vertex;
    std::array<real, 3> hat;
    real weight;
    rgb of(const Sums& x) const {
        return hat[0] * x[vertex[0]] + hat[1] * x[vertex[1]] + hat[2] * x[vertex[2]];
    }
};
// Dunavant's rule of degree 4 (1985): six points of each triangle.
std::vector<At> points(const Mesh& mesh) {
    std::vector<At> all;
    for (const auto& corners : mesh.corners)
        for (auto [a, weight] : {std::pair{0.445948490915965, 0.223381589678011},
                                 std::pair{0.091576213509771, 0.109951743655322}})
            for (auto [b, c] : {std::pair{a, a}, std::pair{a, 1 - 2 * a}, std::pair{1 - 2 * a, a}})
                all.push_back({corners,
                               {real(1 - b - c), real(b), real(c)},
                               real(weight * double(area_of(mesh.faces[0])))});
    return all;
}

// Integrals of each hat times a function with a value at each point: b_v.
template <class Value>
Sums against_hats(const Mesh& mesh, Value value) {
    Sums b(mesh.vertices());
    for (const At& at : points(mesh))
        for (size_t k = 0; k < 3; ++k) b[at.vertex[k]] += at.weight * at.hat[k] * value(at);
    return b;
}

rgb linear(vec3 p) { return {1 + p.x - 2 * p.y, 7 * p.x + p.y, real(0.01)}; }

double worst(const Sums& a, const Sums& b) {
    double off = 0;
    for (size_t v = 0; v < a.size(); ++v) off = std::max(off, double(max_abs(a[v] - b[v])));
    return off;
}

Sums random_sums(size_t n, Rng& rng) {
    Sums b(n);
    for (rgb& x : b)
        for (auto a : axis) x.*a = real(2 * rng.uniform() - 1);
    return b;
}

}  // namespace

TEST_CASE(
    "the mean over a hat is that of the illuminance: of constants everywhere, within by symmetry") {
    for (const Scene& s : scenes) {
        const Mesh mesh = make_mesh(s, 0.4);
        const Projection onto(mesh, mesh.faces[0]);
        const std::vector<vec3> at = grid_points(mesh.faces[0]);
        auto means = [&](auto E) {
            auto value = [&](const At& x) { return E(x.of(at)); };
            return onto(against_hats(mesh, value), Functional::mean);
        };
        for (rgb E : means([](vec3) { return rgb{1, 5, 0}; }))
            CHECK(double(max_abs(E - rgb{1, 5, 0})) <= (single ? 1e-5 : 1e-13));
        const Sums E = means(linear);
        std::vector<int> triangles(mesh.vertices());
        for (const auto& corner : mesh.corners)
            for (uint32_t v : corner) ++triangles[v];
        double within = 0, border = 0;
        for (size_t v = 0; v < E.size(); ++v) {
            double& off = triangles[v] == 6 ? within : border;
            off = std::max(off, double(max_abs(E[v] - linear(at[v]))));
        }
        CHECK(within <= (single ? 1e-4 : 1e-12));
        CHECK(border > 0.1);  // here a hat lies on one side of its vertex
    }
}

TEST_CASE("M x = b is solved: x against the hats is b again; dark channels stay dark") {
    Rng rng{seed_here()};
    for (const Scene& s : scenes)
        for (double H : {9.0, 1.5, 0.7})
            for (size_t bright : {0, 1, 2, 3}) {
                const Mesh mesh = make_mesh(s, H);
                CAPTURE(mesh.vertices());
                CAPTURE(bright);
                Sums b = random_sums(mesh.vertices(), rng);
                for (rgb& x : b)
                    for (size_t c = bright; c < 3; ++c) x.*axis[c] = 0;
                const Sums x = Projection(mesh, mesh.faces[0])(b, Functional::projection);
                for (rgb value : x)
                    for (size_t c = bright; c < 3; ++c) CHECK(value.*axis[c] == 0);
                const Sums again = against_hats(mesh, [&](const At& at) { return at.of(x); });
                CHECK(worst(again, b) <= (single ? 2e-5 : 1e-12));
            }
}

TEST_CASE("square() is the integral of a map's square") {
    Rng rng{seed_here()};
    for (const Scene& s : scenes) {
        const Mesh mesh = make_mesh(s, 0.5);
        const Projection onto(mesh, mesh.faces[0]);
        const Sums x = random_sums(mesh.vertices(), rng);
        rgb sum;
        for (const At& at : points(mesh)) sum += at.of(x) * at.of(x) * at.weight;
        const rgb square = onto.square(x);
        for (auto a : axis) CHECK(double(square.*a) == approx(double(sum.*a), 1e-12, 1e-5));
        const Sums constant(mesh.vertices(), rgb{2, 0, -1});
        CHECK(double(onto.square(constant).x) == approx(4 * double(mesh.faces[0].area())));
        CHECK(double(onto.square(constant).z) == approx(double(mesh.faces[0].area())));
    }
}

TEST_CASE("a face of a mesh of several has its own vertices and elements") {
    const Scene s = cubic_room();
    const Mesh mesh = make_mesh(s, 4);
    Rng rng{seed_here()};
    const Sums b = random_sums(mesh.faces[0].vertices(), rng);
    for (Functional f : {Functional::projection, Functional::mean}) {
        const Sums first = Projection(mesh, mesh.faces[0])(b, f);
        for (const Face& face : mesh.faces)
            CHECK(worst(Projection(mesh, face)(b, f), first) <=
                  (single ? 1e-3 : 1e-12));  // cells are equal up to rounding
    }
}

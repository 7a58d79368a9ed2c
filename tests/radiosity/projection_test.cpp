// radiosity/projection_test.cpp  least squares: exact where they must be, with errors of the stated
// order elsewhere
#include "radiosity/projection.h"

#include "base/rng.h"
#include "oracle/expect.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

// The faces under test have an area of 3 each.
const Scene scenes[] = {one_quad({1, 2, 0}, {2, 0, 0}, {0.5, 1.5, 0}),
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
template <class E>
Sums integrals(const Mesh& mesh, E value) {
    const Sums grid = grid_points(mesh.faces[0]);
    return against_hats(mesh, [&](const At& at) { return value(at.of(grid)); });
}

rgb linear(vec3 p) { return {1 + p.x - 2 * p.y, 7 * p.x + p.y, real(0.01)}; }
rgb curved(vec3 p) { return {std::exp(p.x), std::sin(2 * p.y), p.x * p.y}; }

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

// The RMS distance over the face between a map and E.
template <class E>
double distance(const Mesh& mesh, const Sums& x, E value) {
    const Sums grid = grid_points(mesh.faces[0]);
    double sum = 0;
    for (const At& at : points(mesh)) {
        const rgb d = at.of(x) - value(at.of(grid));
        sum += double(at.weight * dot(d, d) / mesh.faces[0].area());
    }
    return std::sqrt(sum);
}

}  // namespace

TEST_CASE("linear illuminance is projected onto itself, whatever the face and the mesh") {
    for (const Scene& s : scenes)
        for (double H : {9.0, 1.2, 0.3}) {
            CAPTURE(H);
            const Mesh mesh = make_mesh(s, H);
            const Projection onto(mesh, mesh.faces[0]);
            Sums truth;
            for (vec3 p : grid_points(mesh.faces[0])) truth.push_back(linear(p));
            CHECK(worst(onto(integrals(mesh, linear), Functional::projection), truth) <=
                  (single ? 1e-4 : 1e-12));
        }
}

TEST_CASE(
    "the mean over a hat is that of the illuminance: of constants everywhere, within by symmetry") {
    for (const Scene& s : scenes) {
        const Mesh mesh = make_mesh(s, 0.4);
        const Projection onto(mesh, mesh.faces[0]);
        const std::vector<vec3> at = grid_points(mesh.faces[0]);
        const Sums one = onto(integrals(mesh, [](vec3) { return rgb{1, 5, 0}; }), Functional::mean);
        for (rgb E : one) CHECK(double(max_abs(E - rgb{1, 5, 0})) <= (single ? 1e-5 : 1e-13));
        const Sums E = onto(integrals(mesh, linear), Functional::mean);
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

TEST_CASE(
    "errors fall with the square of the mesh; of means, with its power 3/2, for their borders") {
    for (const Scene& s : scenes) {
        double before[2] = {};
        for (double H : {0.6, 0.3, 0.15}) {
            const Mesh mesh = make_mesh(s, H);
            const Projection onto(mesh, mesh.faces[0]);
            const Sums b = integrals(mesh, curved);
            int k = 0;
            for (Functional f : {Functional::projection, Functional::mean}) {
                const double error = distance(mesh, onto(b, f), curved);
                // A strip of width H along the border has errors of order H: their RMS is H
                // sqrt(H).  Triangles are halved, and quads nearly so.
                const double order = std::log2(before[k] / error);
                if (before[k] > 0) CHECK(order == doctest::Approx(k ? 1.5 : 2).epsilon(0.12));
                before[k++] = error;
            }
        }
        CHECK(before[0] < before[1] / 5);
    }
}

TEST_CASE("M x = b is solved: x against the hats is b again, a dark channel beside two others") {
    Rng rng{seed_here()};
    for (const Scene& s : scenes)
        for (double H : {9.0, 1.5, 0.7}) {
            const Mesh mesh = make_mesh(s, H);
            CAPTURE(mesh.vertices());
            Sums b = random_sums(mesh.vertices(), rng);
            for (rgb& x : b) x.z = 0;
            const Sums x = Projection(mesh, mesh.faces[0])(b, Functional::projection);
            const Sums again = against_hats(mesh, [&](const At& at) { return at.of(x); });
            CHECK(worst(again, b) <= (single ? 2e-5 : 1e-12));
        }
}

TEST_CASE("a dark channel, and no light at all, stay dark") {
    Rng rng{seed_here()};
    const Mesh mesh = make_mesh(scenes[0], 0.4);
    const Projection onto(mesh, mesh.faces[0]);
    for (Functional f : {Functional::projection, Functional::mean}) {
        Sums all = random_sums(mesh.vertices(), rng), red = all;
        for (rgb& value : red) value.y = value.z = 0;
        Sums expected = onto(all, f);
        for (rgb& value : expected) value.y = value.z = 0;
        const Sums found = onto(red, f);
        for (rgb value : found) CHECK((value.y == 0 && value.z == 0));
        CHECK(worst(found, expected) <= (single ? 1e-4 : 1e-12) * worst(found, Sums(found.size())));
        for (rgb value : onto(Sums(found.size()), f)) CHECK(value == rgb{});
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

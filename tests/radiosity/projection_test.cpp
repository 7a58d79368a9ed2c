// radiosity/projection_test.cpp  least squares: exact where they must be, of the order they are
// said
#include "radiosity/projection.h"

#include "base/rng.h"
#include "oracle/expect.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

// The faces that are tried: their area is 3 each.
const Scene scenes[] = {one_quad({1, 2, 0}, {2, 0, 0}, {real(0.5), real(1.5), 0}),
                        one_triangle({0, 0, 1}, {2, 0, 0}, {real(0.4), 3, 0})};

// Dunavant's rule of degree 4 (1985): six points of a triangle.
struct At {
    double b, c, weight;
};
std::vector<At> rule() {
    std::vector<At> points;
    for (auto [a, weight] : {std::pair{0.445948490915965, 0.223381589678011},
                             std::pair{0.091576213509771, 0.109951743655322}})
        for (auto [b, c] : {std::pair{a, a}, std::pair{a, 1 - 2 * a}, std::pair{1 - 2 * a, a}})
            points.push_back({b, c, weight});
    return points;
}

// The corners of an element, on the grid and not where they receive.
std::array<vec3, 3> corners(const Mesh& mesh, uint32_t e) {
    const Face& f = mesh.faces[0];
    std::array<vec3, 3> p;
    uint32_t v = 0;
    for (uint32_t j = 0; j <= f.rows; ++j)
        for (uint32_t i = 0; i <= (f.quad ? f.columns : f.rows - j); ++i, ++v)
            for (size_t k = 0; k < 3; ++k)
                if (mesh.corners[e][k] == v) p[k] = point_at(f, real(i), real(j));
    return p;
}

// Integrals of E times each hat: b_v.
template <class E>
Sums integrals(const Mesh& mesh, E value) {
    Sums b(mesh.vertices());
    for (uint32_t e = 0; e < mesh.elements(); ++e) {
        const auto [p, q, r] = corners(mesh, e);
        for (const At& at : rule()) {
            const double hat[] = {1 - at.b - at.c, at.b, at.c};
            const vec3 x = real(hat[0]) * p + real(hat[1]) * q + real(hat[2]) * r;
            for (size_t k = 0; k < 3; ++k)
                b[mesh.corners[e][k]] +=
                    value(x) * real(at.weight * hat[k] * double(area_of(mesh.faces[0])));
        }
    }
    return b;
}

rgb linear(vec3 p) { return {1 + p.x - 2 * p.y, 7 * p.x + p.y, real(0.01)}; }
rgb curved(vec3 p) { return {std::exp(p.x), std::sin(2 * p.y), p.x * p.y}; }

std::vector<vec3> grid(const Mesh& mesh) {
    std::vector<vec3> at(mesh.vertices());
    for (uint32_t e = 0; e < mesh.elements(); ++e) {
        const auto p = corners(mesh, e);
        for (size_t k = 0; k < 3; ++k) at[mesh.corners[e][k]] = p[k];
    }
    return at;
}

double worst(const Sums& a, const Sums& b) {
    double off = 0;
    for (size_t v = 0; v < a.size(); ++v) off = std::max(off, double(max_abs(a[v] - b[v])));
    return off;
}

// Solves A x = b by Gauss's elimination with pivots.
std::vector<double> solved(std::vector<std::vector<double>> A, std::vector<double> b) {
    const size_t n = b.size();
    for (size_t k = 0; k < n; ++k) {
        size_t pivot = k;
        for (size_t i = k; i < n; ++i)
            if (std::abs(A[i][k]) > std::abs(A[pivot][k])) pivot = i;
        std::swap(A[k], A[pivot]), std::swap(b[k], b[pivot]);
        for (size_t i = k + 1; i < n; ++i) {
            const double f = A[i][k] / A[k][k];
            for (size_t j = k; j < n; ++j) A[i][j] -= f * A[k][j];
            b[i] -= f * b[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; ++j) b[k] -= A[k][j] * b[j];
        b[k] /= A[k][k];
    }
    return b;
}

// M_vw, the integral of h_v h_w, by quadrature.
std::vector<std::vector<double>> mass(const Mesh& mesh) {
    std::vector M(mesh.vertices(), std::vector<double>(mesh.vertices()));
    for (uint32_t e = 0; e < mesh.elements(); ++e)
        for (const At& at : rule()) {
            const double hat[] = {1 - at.b - at.c, at.b, at.c};
            for (size_t i = 0; i < 3; ++i)
                for (size_t j = 0; j < 3; ++j)
                    M[mesh.corners[e][i]][mesh.corners[e][j]] +=
                        at.weight * hat[i] * hat[j] * double(area_of(mesh.faces[0]));
        }
    return M;
}

Sums random_sums(size_t n, Rng& rng) {
    Sums b(n);
    for (rgb& x : b)
        for (auto a : axis) x.*a = real(2 * rng.uniform() - 1);
    return b;
}

// The quadratic mean over the face of a map's distance from E.
template <class E>
double distance(const Mesh& mesh, const Sums& x, E value) {
    double sum = 0;
    for (uint32_t e = 0; e < mesh.elements(); ++e) {
        const auto p = corners(mesh, e);
        const auto& v = mesh.corners[e];
        for (const At& at : rule()) {
            const real hat[] = {real(1 - at.b - at.c), real(at.b), real(at.c)};
            const vec3 q = hat[0] * p[0] + hat[1] * p[1] + hat[2] * p[2];
            const rgb d = hat[0] * x[v[0]] + hat[1] * x[v[1]] + hat[2] * x[v[2]] - value(q);
            sum += at.weight * double(dot(d, d)) / double(mesh.elements());
        }
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
            const Sums E = onto(integrals(mesh, linear), Functional::projection);
            const std::vector<vec3> at = grid(mesh);
            for (size_t v = 0; v < E.size(); ++v)
                CHECK(double(max_abs(E[v] - linear(at[v]))) <= (single ? 1e-4 : 1e-12));
        }
}

TEST_CASE(
    "the mean over a hat is that of the illuminance: of constants everywhere, within by symmetry") {
    for (const Scene& s : scenes) {
        const Mesh mesh = make_mesh(s, 0.4);
        const Projection onto(mesh, mesh.faces[0]);
        const std::vector<vec3> at = grid(mesh);
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
        CHECK(border > 0.1);  // a hat there lies on one side of its vertex
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
                // A strip of width H along the border has errors of order H: their quadratic mean
                // is H sqrt(H).  Triangles are halved, and quads nearly so.
                const double order = std::log2(before[k] / error);
                if (before[k] > 0) CHECK(order == doctest::Approx(k ? 1.5 : 2).epsilon(0.12));
                before[k++] = error;
            }
        }
        CHECK(before[0] < before[1] / 5);
    }
}

TEST_CASE("M x = b is solved as a dense matrix is, each channel by itself") {
    Rng rng{seed_here()};
    for (const Scene& s : scenes)
        for (double H : {9.0, 1.5, 0.7}) {
            const Mesh mesh = make_mesh(s, H);
            CAPTURE(mesh.vertices());
            const Projection onto(mesh, mesh.faces[0]);
            Sums b = random_sums(mesh.vertices(), rng);
            for (rgb& x : b) x.z = 0;
            const Sums x = onto(b, Functional::projection);
            for (auto channel : axis) {
                std::vector<double> right;
                for (const rgb& value : b) right.push_back(double(value.*channel));
                const auto truth = solved(mass(mesh), right);
                double size = 0, off = 0;
                for (size_t v = 0; v < truth.size(); ++v) {
                    size = std::max(size, std::abs(truth[v]));
                    off = std::max(off, std::abs(truth[v] - double(x[v].*channel)));
                }
                CHECK(off <= (single ? 2e-5 : 1e-12) * size);
            }
        }
}

TEST_CASE("maps are linear in the sums; a dark channel, and no light at all, stay dark") {
    Rng rng{seed_here()};
    const Mesh mesh = make_mesh(scenes[0], 0.4);
    const Projection onto(mesh, mesh.faces[0]);
    const size_t n = mesh.vertices();
    for (Functional f : {Functional::projection, Functional::mean}) {
        const Sums a = random_sums(n, rng), b = random_sums(n, rng);
        Sums both(n);
        for (size_t v = 0; v < n; ++v) both[v] = real(0.3) * a[v] + 2 * b[v];
        const Sums x = onto(a, f), y = onto(b, f), z = onto(both, f);
        Sums sum(n);
        double size = 0;
        for (size_t v = 0; v < n; ++v) {
            sum[v] = real(0.3) * x[v] + 2 * y[v];
            size = std::max(size, double(max_abs(sum[v])));
        }
        CHECK(worst(z, sum) <= (single ? 1e-4 : 1e-12) * size);
        Sums red = a;
        for (rgb& value : red) value.y = value.z = 0;
        const Sums of_red = onto(red, f);
        double off = 0;
        for (size_t v = 0; v < n; ++v) {
            CHECK(of_red[v].y == 0);
            CHECK(of_red[v].z == 0);
            off = std::max(off, std::abs(double(of_red[v].x - x[v].x)));
        }
        CHECK(off <= (single ? 1e-4 : 1e-12) * size);
        for (rgb value : onto(Sums(n), f)) CHECK(value == rgb{});
    }
}

TEST_CASE("what is projected has its integral: no light is lost, whatever the sums") {
    Rng rng{seed_here()};
    for (const Scene& s : scenes) {
        const Mesh mesh = make_mesh(s, 0.5);
        const Face& f = mesh.faces[0];
        const Sums b = random_sums(mesh.vertices(), rng);
        const Sums x = Projection(mesh, f)(b, Functional::projection);
        IlluminationMap map(number_of_sides(mesh));
        rgb sum;
        for (size_t v = 0; v < b.size(); ++v) map[2 * v] = x[v], sum += b[v];
        CHECK(double(max_abs(integral(mesh, map, f, false) - sum)) <= (single ? 1e-4 : 1e-12));
    }
}

TEST_CASE("square() is the integral of a map's square") {
    Rng rng{seed_here()};
    for (const Scene& s : scenes) {
        const Mesh mesh = make_mesh(s, 0.5);
        const Projection onto(mesh, mesh.faces[0]);
        const Sums x = random_sums(mesh.vertices(), rng);
        rgb sum;
        for (uint32_t e = 0; e < mesh.elements(); ++e)
            for (const At& at : rule()) {
                const auto& v = mesh.corners[e];
                const rgb E =
                    real(1 - at.b - at.c) * x[v[0]] + real(at.b) * x[v[1]] + real(at.c) * x[v[2]];
                sum += E * E * real(at.weight) * area_of(mesh.faces[0]);
            }
        const rgb square = onto.square(x);
        for (auto a : axis) CHECK(double(square.*a) == approx(double(sum.*a), 1e-12, 1e-5));
        const Sums constant(mesh.vertices(), rgb{2, 0, -1});
        CHECK(double(onto.square(constant).x) == approx(4 * double(mesh.faces[0].area())));
        CHECK(double(onto.square(constant).z) == approx(double(mesh.faces[0].area())));
    }
}

TEST_CASE("a face of a mesh of several has its own vertices and elements") {
    const Scene s = cube();
    const Mesh mesh = make_mesh(s, 4);
    Rng rng{seed_here()};
    const Sums b = random_sums(mesh.faces[0].vertices(), rng);
    for (Functional f : {Functional::projection, Functional::mean}) {
        const Sums first = Projection(mesh, mesh.faces[0])(b, f);
        for (const Face& face : mesh.faces)
            CHECK(worst(Projection(mesh, face)(b, f), first) <=
                  (single ? 1e-3 : 1e-12));  // cells are equal but for rounding
    }
}

// radiosity/mesh_test.cpp  grids of faces, and where a hit lies in them
#include "radiosity/mesh.h"

#include <bit>
#include <map>

#include "base/program.h"
#include "base/rng.h"
#include "oracle/expect.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

// Quads that are long, high, skew and tiny, on the axes and off them; triangles, too.
Scene furniture() {
    Scene s;
    const uint32_t d = add(s, diffuse(grey(0.5)));
    add_room(s, {4, 3, 2}, d);
    add_quad(s, {1, 1, 1}, {real(0.7), real(0.1), 0}, {0, 0, real(0.4)}, d);
    add_quad(s, {1, 2, 1}, {real(0.1), 0, 0}, {0, real(0.1), 1}, d);
    add_quad(s, {3, 1, 1}, {1, 0, real(0.2)}, {real(0.8), real(0.6), 0}, d);
    add_quad(s, {2, 1, real(0.5)}, {real(-0.4), 0, 0}, {real(0.3), real(0.3), 0}, d);
    add_triangle(s, {1, 1, 0}, {3, 1, real(0.3)}, {1, 2, 1}, d);
    add_triangle(s, {2, 2, 1}, {real(2.01), 2, 1}, {2, real(2.02), 1}, d);
    prepare(s);
    return s;
}

double longest_edge(const Mesh& mesh) {
    double longest = 0;
    for (const Face& f : mesh.faces)
        for (uint32_t e = f.element; e < f.element + f.elements(); ++e)
            for (size_t k = 0; k < 3; ++k)
                longest = std::max(longest, double(length(corner_of(mesh, e, k) -
                                                          corner_of(mesh, e, (k + 1) % 3))));
    return longest;
}

// Of all grids of a parallelogram whose edges are no longer than H.
double fewest_cells(const Face& f, double H) {
    const vec3 u = f.b - f.a, v = f.d - f.a;
    double fewest = 1e9;
    for (int m = 1; m < 200; ++m)
        for (int n = 1; n < 200 && m * n < fewest; ++n) {
            const vec3 x = u / real(m), y = v / real(n);
            if (double(std::max({length(x), length(y), length(x + y)})) <= H * (1 + 1e-9))
                fewest = m * n;
        }
    return fewest;
}

// Where the grid has each vertex of a face, in the order in which meshes number them.
std::vector<vec3> grid_points(const Face& f) {
    std::vector<vec3> points;
    for (uint32_t j = 0; j <= f.rows; ++j)
        for (uint32_t i = 0; i <= (f.quad ? f.columns : f.rows - j); ++i)
            points.push_back(f.a + real(i) / real(f.columns) * (f.b - f.a) +
                             real(j) / real(f.rows) * ((f.quad ? f.d : f.c) - f.a));
    return points;
}

// Hits of a shape: inside, on its edges, at its corners, on the lines of an n x n grid.
std::vector<Hit> hits_on(uint32_t shape, uint32_t n, Rng& rng) {
    std::vector<Hit> hits;
    auto hit = [&](double v, double w) { hits.push_back({1, shape, real(v), real(w)}); };
    for (int k = 0; k < 60; ++k) {
        const double v = rng.uniform(), w = (1 - v) * rng.uniform();
        hit(v, w), hit(v, 0), hit(0, v), hit(v, 1 - v);
        const double i = std::floor(v * n) / n;
        hit(i, w * (1 - i)), hit(w * (1 - i), i);
    }
    hit(0, 0), hit(1, 0), hit(0, 1), hit(0.5, 0.5);
    return hits;
}

template <class Visit>
void for_hits(const Scene& s, const Mesh& mesh, Visit visit) {
    Rng rng{seed_here()};
    for (uint32_t i = 0; i < s.shapes.size(); ++i)
        for (const Hit& hit : hits_on(i, mesh.faces[mesh.face_of[i]].columns, rng)) visit(hit);
}

std::string refusal(const Scene& s, double H, double memory) {
    try {
        check_fits(s, H, {}, memory);
        return "";
    } catch (const UserError& e) {
        return e.what();
    }
}

}  // namespace

TEST_CASE("no edge is longer than H, and cells are few") {
    const Scene s = furniture();
    for (double H : {10.0, 1.0, 0.5, 0.3, 0.1}) {
        CAPTURE(H);
        const Mesh mesh = make_mesh(s, H);
        CHECK(longest_edge(mesh) <= H * (1 + (single ? 1e-5 : 1e-9)));
        for (const Face& f : mesh.faces) {
            CAPTURE(f.shape);
            if (f.quad) {
                CHECK(f.columns * f.rows <= 1.34 * fewest_cells(f, H));
                continue;
            }
            const double edge =
                double(std::max({length(f.b - f.a), length(f.c - f.b), length(f.a - f.c)}));
            CHECK(std::has_single_bit(f.rows));
            CHECK(f.columns == f.rows);
            CHECK((f.rows == 1 || edge / (f.rows / 2) > H));
        }
    }
}

TEST_CASE("squares are cut into squares; H that divides them is not missed by rounding") {
    for (int n : {1, 2, 3, 4, 7, 10, 49}) {
        const Mesh mesh = make_mesh(cube(), 10 * std::sqrt(2.0) / n * (single ? 1 + 1e-6 : 1));
        REQUIRE(mesh.faces.size() == 6);
        for (const Face& f : mesh.faces) {
            CHECK(f.quad);
            CHECK(f.columns == uint32_t(n));
            CHECK(f.rows == uint32_t(n));
        }
        CHECK(mesh.elements() == size_t(12 * n * n));
        CHECK(mesh.vertices() == size_t(6 * (n + 1) * (n + 1)));
    }
}

TEST_CASE("two triangles are one face only if they are a parallelogram of one kind") {
    Scene s;
    const uint32_t d = add(s, diffuse(grey(0.5))), e = add(s, diffuse(grey(0.5)));
    const uint32_t l = add(s, diffuse({}, grey(1)));
    const vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, q{0, 1, 0};
    auto pair = [&](vec3 last, uint32_t first, uint32_t second) {
        add_triangle(s, a, b, c, first), add_triangle(s, a, c, last, second);
    };
    pair(q, d, d);                  // shapes 0, 1: one
    pair({0, real(1.1), 0}, d, d);  // 2, 3: a trapezium
    pair(q, d, e);                  // 4, 5: two materials
    pair(q, l, l);                  // 6, 7: two lights
    add_quad(s, a, b, q, l);        // 8, 9: one light
    add_triangle(s, a, b, c, d);    // 10, 11: not in this order
    add_triangle(s, c, q, a, d);
    prepare(s);
    const Mesh mesh = make_mesh(s, 9);
    std::vector<uint32_t> faces;
    for (const Face& f : mesh.faces) faces.push_back(f.quad ? 100 + f.shape : f.shape);
    CHECK(faces == std::vector<uint32_t>{100, 2, 3, 4, 5, 6, 7, 108, 10, 11});
    CHECK(mesh.face_of == std::vector<uint32_t>{0, 0, 1, 2, 3, 4, 5, 6, 7, 7, 8, 9});
    CHECK(sizes(s, 9).faces == 10);
}

TEST_CASE("vertices are shared within a face, and by no other; each is a corner of an element") {
    const Scene s = furniture();
    const Mesh mesh = make_mesh(s, 0.5);
    uint32_t vertex = 0, element = 0;
    for (const Face& f : mesh.faces) {
        CHECK(f.vertex == vertex);
        CHECK(f.element == element);
        std::vector<int> used(f.vertices());
        for (uint32_t e = f.element; e < f.element + f.elements(); ++e)
            for (uint32_t v : mesh.corners[e]) {
                REQUIRE(v >= f.vertex);
                REQUIRE(v < f.vertex + f.vertices());
                ++used[v - f.vertex];
            }
        // One to three triangles at corners, three at edges (of triangles, too), six inside.
        std::map<int, int> count;
        for (int k : used) ++count[k];
        CHECK(count[0] == 0);
        const int m = int(f.columns), n = int(f.rows);
        if (f.quad) {
            CHECK(count[6] == (m - 1) * (n - 1));
            CHECK(count[3] == 2 * (m - 1) + 2 * (n - 1));
            CHECK(count[2] == 2);
            CHECK(count[1] == 2);
        } else {
            CHECK(count[6] == (n - 1) * (n - 2) / 2);
            CHECK(count[3] == 3 * (n - 1));
            CHECK(count[1] == 3);
        }
        vertex += f.vertices(), element += f.elements();
    }
    CHECK(mesh.vertices() == vertex);
    CHECK(mesh.elements() == element);
}

TEST_CASE("elements look to their face's side, are equal, and together are the face") {
    const Scene s = furniture();
    const Mesh mesh = make_mesh(s, 0.5);
    for (const Face& f : mesh.faces) {
        CAPTURE(f.shape);
        const auto grid = grid_points(f);
        double sum = 0;
        for (uint32_t e = f.element; e < f.element + f.elements(); ++e) {
            auto at = [&](size_t k) { return grid[mesh.corners[e][k] - f.vertex]; };
            const vec3 twice = cross(at(1) - at(0), at(2) - at(0));
            CHECK(dot(twice, f.n) > 0);
            sum += double(length(twice)) / 2;
            CHECK(double(length(twice)) / 2 == approx(double(area_of(f)), 1e-12, 1e-4));
        }
        CHECK(sum == approx(double(f.area()), 1e-12, 1e-5));
        double of_shapes = 0;
        for (uint32_t i = 0; i < s.shapes.size(); ++i)
            if (&mesh.faces[mesh.face_of[i]] == &f)
                of_shapes += double(length(area_vector(s.shapes[i]))) / 2;
        CHECK(sum == approx(of_shapes, 1e-12, 1e-5));
        CHECK(length(f.n - unit(area_vector(s.shapes[f.shape]))) == 0);
    }
}

TEST_CASE("vertices receive light where they are; on a border, a thousandth of a cell within") {
    const Scene s = furniture();
    const Mesh mesh = make_mesh(s, 0.5);
    for (const Face& f : mesh.faces) {
        CAPTURE(f.shape);
        const auto grid = grid_points(f);
        const vec3 u = f.b - f.a, v = (f.quad ? f.d : f.c) - f.a;
        for (uint32_t k = 0; k < f.vertices(); ++k) {
            const vec3 p = mesh.at[f.vertex + k], in = p - f.a;
            // Its coordinates along u and v (Cramer), in cells.
            const double uu = double(dot(u, u)), uv = double(dot(u, v)), vv = double(dot(v, v));
            const double pu = double(dot(in, u)), pv = double(dot(in, v));
            const double i = (pu * vv - pv * uv) / (uu * vv - uv * uv) * f.columns;
            const double j = (pv * uu - pu * uv) / (uu * vv - uv * uv) * f.rows;
            const vec3 off = grid[k] - f.a;
            const double gu = double(dot(off, u)), gv = double(dot(off, v));
            const double x = (gu * vv - gv * uv) / (uu * vv - uv * uv) * f.columns;
            const double y = (gv * uu - gu * uv) / (uu * vv - uv * uv) * f.rows;
            const double least = (single ? 0.8 : 0.99) / 1024;  // of a triangle: after scaling
            CHECK(i >= least);
            CHECK(j >= least);
            CHECK(std::abs(i - x) <= 2.01 / 1024);
            CHECK(std::abs(j - y) <= 2.01 / 1024);
            if (f.quad) {
                CHECK(i <= f.columns - least);
                CHECK(j <= f.rows - least);
            } else {
                CHECK(i + j <= f.rows - least);
            }
            const double room = single ? 1e-3 : 1e-9;
            const bool border =
                x < room || y < room ||
                (f.quad ? x > f.columns - room || y > f.rows - room : x + y > f.rows - room);
            if (!border) CHECK(length(p - grid[k]) <= 64 * ulp * 5);
        }
    }
}

TEST_CASE("a hit is where its three vertices and weights say: every shape, inside and on borders") {
    const Scene s = furniture();
    for (double H : {9.0, 0.5, 0.11}) {
        const Mesh mesh = make_mesh(s, H);
        std::vector<vec3> grid;
        for (const Face& f : mesh.faces)
            for (vec3 p : grid_points(f)) grid.push_back(p);
        double sum_off = 0, place_off = 0, negative = 0;
        bool of_an_element = true;
        for_hits(s, mesh, [&](const Hit& hit) {
            const auto [vertex, weight] = between(mesh, hit);
            const Face& f = mesh.faces[mesh.face_of[hit.id]];
            vec3 p;
            double sum = 0;
            for (size_t k = 0; k < 3; ++k) {
                REQUIRE(vertex[k] >= f.vertex);
                REQUIRE(vertex[k] < f.vertex + f.vertices());
                p += weight[k] * grid[vertex[k]];
                sum += double(weight[k]);
                negative = std::min(negative, double(weight[k]));
            }
            sum_off = std::max(sum_off, std::abs(sum - 1));
            place_off = std::max(place_off, double(length(p - point_of(s, hit))));
            // The three are corners of one element.
            bool found = false;
            for (uint32_t e = f.element; e < f.element + f.elements() && !found; ++e)
                found = mesh.corners[e] == vertex;
            of_an_element &= found;
        });
        CAPTURE(H);
        CHECK(of_an_element);
        CHECK(sum_off <= 8 * double(ulp));
        CHECK(place_off <= 64 * double(ulp) * 5);
        // Rounding may put a hit on a line of the grid beyond it.
        CHECK(negative >= -64 * double(ulp) * 40);
    }
}

TEST_CASE("hats are 1 at their vertex, and linear functions are what they are between") {
    const Scene s = furniture();
    const Mesh mesh = make_mesh(s, 0.3);
    auto linear = [](vec3 p) { return double(3 * p.x - 2 * p.y + real(0.5) * p.z + 1); };
    std::vector<double> value;
    for (const Face& f : mesh.faces)
        for (vec3 p : grid_points(f)) value.push_back(linear(p));
    double off = 0;
    for_hits(s, mesh, [&](const Hit& hit) {
        const auto [vertex, weight] = between(mesh, hit);
        double sum = 0;
        for (size_t k = 0; k < 3; ++k) sum += double(weight[k]) * value[vertex[k]];
        off = std::max(off, std::abs(sum - linear(point_of(s, hit))));
    });
    CHECK(off <= 1e3 * double(ulp));
    // Rays that hit: the same from the tree's own hits, from both sides.
    Rng rng{seed_here()};
    for (int k = 0; k < 3000; ++k) {
        vec3 d;
        for (auto a : axis) d.*a = real(rng.uniform() - 0.5);
        const Ray ray{{2, real(1.5), real(0.9)}, unit(d)};
        const auto hit = s.bvh.closest(ray);
        REQUIRE(hit);
        const auto [vertex, weight] = between(mesh, *hit);
        double sum = 0;
        for (size_t i = 0; i < 3; ++i) sum += double(weight[i]) * value[vertex[i]];
        const double truth = linear(surface(s.shapes[hit->id], ray, *hit).p);
        CHECK(std::abs(sum - truth) <= 1e3 * double(ulp));
    }
}

TEST_CASE("sizes are those of the mesh, before there is one") {
    const Scene s = furniture();
    for (double H : {10.0, 1.0, 0.33, 0.1, 0.04}) {
        CAPTURE(H);
        const Sizes n = sizes(s, H);
        const Mesh mesh = make_mesh(s, H);
        CHECK(n.faces == double(mesh.faces.size()));
        CHECK(n.elements == double(mesh.elements()));
        CHECK(n.vertices == double(mesh.vertices()));
        CHECK(Bytes{2, 3, 5}.of(n) == 2 * n.faces + 3 * n.elements + 5 * n.vertices);
    }
}

TEST_CASE("sizes of spheres are those of their facets; at most, where facets are cut again") {
    const std::string text =
        "camera 0 0 50  0 0 0  40\ndiffuse d .5 .5 .5\nlight l 1 1 1\nsphere 0 0 0  1  d\n"
        "sphere 5 0 0  2  l\nquad 0 9 0  1 0 0  0 1 0  d\ntriangle 0 0 9  1 0 9  0 1 9  d\n";
    const Scene s = parse_scene(text, "a.scene").scene;
    for (double H : {5.0, 0.7, 0.331, 0.33, 0.329, 0.2, 0.12, 0.06}) {
        CAPTURE(H);
        const Mesh mesh = make_mesh(faceted(s, H).scene, H);
        const Sizes n = sizes(s, H);
        CHECK(n.faces == double(mesh.faces.size()));
        CHECK(n.elements == double(mesh.elements()));
        CHECK(n.vertices == double(mesh.vertices()));
        CHECK(longest_edge(mesh) <= H * (1 + (single ? 1e-5 : 1e-9)));
    }
    // Facets of ten quarterings are at most 1.3e-3 radii long: H of a thirtieth of that takes 32^2
    // triangles of each.
    const Sizes fine = sizes(one_quad({9, 9, 9}, {1, 0, 0}, {0, 1, 0}), 4e-5),
                all = sizes(parse_scene("camera 0 0 50  0 0 0  40\ndiffuse d .5 .5 .5\n"
                                        "sphere 0 0 0  1  d\nquad 9 9 9  1 0 0  0 1 0  d\n",
                                        "a.scene")
                                .scene,
                            4e-5);
    const double facets = 20 * std::pow(4, 10), cells = 64 * 64;
    CHECK(all.faces - fine.faces == facets);
    CHECK((all.elements - fine.elements) / facets == approx(cells));
    CHECK((all.vertices - fine.vertices) / facets == approx(65 * 66 / 2));
}

TEST_CASE("what does not fit is refused, with a mesh that does; and nothing that fits") {
    const Scene s = furniture();
    const double memory = 1e6;
    int refused = 0, taken = 0;
    for (double H : {1.0, 0.3, 0.1, 0.05, 0.01, 1e-3, 1e-6, 1e-12}) {
        CAPTURE(H);
        const std::string text = refusal(s, H, memory);
        const Sizes n = sizes(s, H);
        const bool fits = Bytes{}.of(n) <= memory;
        REQUIRE((text == "") == fits);
        ++(fits ? taken : refused);
        if (fits) continue;
        double wanted = 0, triangles = 0, needs = 0, has = 0, would_fit = 0;
        REQUIRE(std::sscanf(text.c_str(),
                            "edges of %lf would be %lf triangles and take %lf GB of %lf GB memory; "
                            "%lf would fit",
                            &wanted, &triangles, &needs, &has, &would_fit) == 5);
        CHECK(wanted == approx(H, 0.005, 0.005));
        CHECK(triangles == approx(n.elements, 0.005, 0.005));
        CHECK(needs * 1e9 == approx(Bytes{}.of(n), 0.005, 0.005));
        CHECK(has == 0.001);
        // As it is printed, and not much coarser than it must be.
        CHECK(refusal(s, would_fit, memory) == "");
        CHECK(would_fit > H);
        CHECK(refusal(s, would_fit / 1.3, memory) != "");
    }
    CHECK(refused >= 3);
    CHECK(taken >= 2);
    CHECK(refusal(s, 0.1, 100).ends_with("no mesh would fit"));
    // Numbers of 32 bits would overflow: refused however much memory there is.
    CHECK(refusal(s, 1e-4, 1e300) != "");
    CHECK(bytes_of_machine() > 1e8);
    CHECK(bytes_of_machine() < 1e15);
}

// radiosity/mesh_test.cpp  grids of faces, and the position of hits in them
#include "radiosity/mesh.h"

#include <bit>
#include <map>

#include "base/rng.h"
#include "oracle/expect.h"
#include "radiosity/rooms.h"
#include "text/complaint.h"
#include "text/program.h"

using namespace rooms;

namespace {

constexpr double slack = single ? 1e-5 : 1e-9;  // relative to a length

// The fewest cells of a parallelogram's grid with edges no longer than H.
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

// Coordinates along the edges of a face (Cramer), in cells.
std::array<double, 2> in_cells(const Face& f, vec3 p) {
    const vec3 u = f.b - f.a, v = (f.quad ? f.d : f.c) - f.a, in = p - f.a;
    const double uu = double(dot(u, u)), uv = double(dot(u, v)), vv = double(dot(v, v));
    const double pu = double(dot(in, u)), pv = double(dot(in, v)), det = uu * vv - uv * uv;
    return {(pu * vv - pv * uv) / det * f.columns, (pv * uu - pu * uv) / det * f.rows};
}

// The distance to the nearest border, in cells.
double from_border(const Face& f, std::array<double, 2> at) {
    const auto [x, y] = at;
    return std::min({x, y, f.quad ? std::min(f.columns - x, f.rows - y) : f.rows - x - y});
}

void check_sizes(const Scene& s, const Mesh& mesh, double H) {
    const Sizes n = sizes(s, H);
    CHECK(n.faces == double(mesh.faces.size()));
    CHECK(n.elements == double(mesh.elements()));
    CHECK(n.vertices == double(mesh.vertices()));
    CHECK(Bytes{2, 3, 5}.of(n) == 2 * n.faces + 3 * n.elements + 5 * n.vertices);
}

std::string refusal(const Scene& s, double H, double memory) {
    return ::complaint([&] { check_fits(s, H, {}, memory); });
}

}  // namespace

TEST_CASE("no edge is longer than H, and cells are few; sizes are known before there is a mesh") {
    const Scene s = furniture();
    for (double H : {10.0, 1.0, 0.5, 0.33, 0.3, 0.1, 0.04}) {
        CAPTURE(H);
        const Mesh mesh = make_mesh(s, H);
        check_sizes(s, mesh, H);
        CHECK(longest_edge(mesh) <= H * (1 + slack));
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
        const Mesh mesh =
            make_mesh(cubic_room(), 10 * std::sqrt(2.0) / n * (single ? 1 + 1e-6 : 1));
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
    pair(q, d, d);                // shapes 0, 1: one face
    pair({0, 1.1, 0}, d, d);      // 2, 3: a trapezium
    pair(q, d, e);                // 4, 5: two materials
    pair(q, l, l);                // 6, 7: two lights
    add_quad(s, a, b, q, l);      // 8, 9: one light
    add_triangle(s, a, b, c, d);  // 10, 11: not in this order
    add_triangle(s, c, q, a, d);
    prepare(s);
    const Mesh mesh = make_mesh(s, 9);
    std::vector<uint32_t> faces;
    for (const Face& f : mesh.faces) faces.push_back(f.quad ? 100 + f.shape : f.shape);
    CHECK(faces == std::vector<uint32_t>{100, 2, 3, 4, 5, 6, 7, 108, 10, 11});
    CHECK(mesh.face_of == std::vector<uint32_t>{0, 0, 1, 2, 3, 4, 5, 6, 7, 7, 8, 9});
    CHECK(sizes(s, 9).faces == 10);
}

TEST_CASE("vertices are shared within a face alone; elements are its equal parts, on its side") {
    const Scene s = furniture();
    const Mesh mesh = make_mesh(s, 0.5);
    std::vector<double> of_shapes(mesh.faces.size());
    for (uint32_t i = 0; i < s.shapes.size(); ++i)
        of_shapes[mesh.face_of[i]] += double(length(area_vector(s.shapes[i]))) / 2;
    uint32_t vertex = 0, element = 0;
    for (const Face& f : mesh.faces) {
        CAPTURE(f.shape);
        CHECK(f.vertex == vertex);
        CHECK(f.element == element);
        CHECK(length(f.n - unit(area_vector(s.shapes[f.shape]))) == 0);
        std::vector<int> used(f.vertices());
        const auto grid = grid_points(f);
        double area = 0;
        for (uint32_t e = f.element; e < f.element + f.elements(); ++e) {
            vec3 corner[3];
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t v = mesh.corners[e][k];
                REQUIRE(v >= f.vertex);
                REQUIRE(v < f.vertex + f.vertices());
                ++used[v - f.vertex], corner[k] = grid[v - f.vertex];
            }
            const vec3 twice = cross(corner[1] - corner[0], corner[2] - corner[0]);
            CHECK(dot(twice, f.n) > 0);
            CHECK(double(length(twice)) / 2 == approx(double(area_of(f)), 1e-12, 1e-4));
            area += double(length(twice)) / 2;
        }
        CHECK(area == approx(double(f.area()), 1e-12, 1e-5));
        CHECK(area == approx(of_shapes[&f - mesh.faces.data()], 1e-12, 1e-5));
        // Corners touch one to three triangles, edges (of triangles, too) three, inner points six.
        std::map<int, int> count;
        for (int k : used) ++count[k];
        const int m = int(f.columns), n = int(f.rows);
        CHECK(count[0] == 0);
        CHECK(count[6] == (f.quad ? (m - 1) * (n - 1) : (n - 1) * (n - 2) / 2));
        CHECK(count[3] == (f.quad ? 2 * (m - 1) + 2 * (n - 1) : 3 * (n - 1)));
        CHECK(count[1] == (f.quad ? 2 : 3));
        if (f.quad) CHECK(count[2] == 2);
        vertex += f.vertices(), element += f.elements();
    }
    CHECK(mesh.vertices() == vertex);
    CHECK(mesh.elements() == element);
}

TEST_CASE("vertices receive light where they are; on a border, a thousandth of a cell within") {
    const Mesh mesh = make_mesh(furniture(), 0.5);
    for (const Face& f : mesh.faces) {
        CAPTURE(f.shape);
        const auto grid = grid_points(f);
        for (uint32_t k = 0; k < f.vertices(); ++k) {
            const vec3 p = mesh.at[f.vertex + k];
            const auto at = in_cells(f, p), meant = in_cells(f, grid[k]);
            CHECK(from_border(f, at) >= (single ? 0.8 : 0.99) / 1024);  // scaled for triangles
            CHECK(std::abs(at[0] - meant[0]) <= 2.01 / 1024);
            CHECK(std::abs(at[1] - meant[1]) <= 2.01 / 1024);
            if (from_border(f, meant) >= (single ? 1e-3 : 1e-9))
                CHECK(length(p - grid[k]) <= 64 * ulp * 5);
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
        auto see = [&](const Hit& hit, vec3 where) {
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
            place_off = std::max(place_off, double(length(p - where)));
            const auto first = mesh.corners.begin() + f.element, end = first + f.elements();
            of_an_element &= std::find(first, end, vertex) != end;
        };
        // Inside each shape, on its edges, at its corners, on the lines of its grid.
        Rng rng{seed_here()};
        for (uint32_t shape = 0; shape < s.shapes.size(); ++shape) {
            const uint32_t n = mesh.faces[mesh.face_of[shape]].columns;
            std::vector<std::array<double, 2>> places = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}};
            for (int k = 0; k < 60; ++k) {
                const double v = rng.uniform(), w = (1 - v) * rng.uniform();
                const double i = std::floor(v * n) / n, rest = w * (1 - i);
                for (const auto& at :
                     {std::array{v, w}, {v, 0}, {0, v}, {v, 1 - v}, {i, rest}, {rest, i}})
                    places.push_back(at);
            }
            for (auto [v, w] : places) {
                const Hit hit{1, shape, real(v), real(w)};
                see(hit, point_of(s, hit));
            }
        }
        // By rays, from both sides.
        for (int k = 0; k < 3000; ++k) {
            vec3 d;
            for (auto a : axis) d.*a = real(rng.uniform() - 0.5);
            const Ray ray{{2, 1.5, 0.9}, unit(d)};
            const auto hit = s.bvh.closest(ray);
            REQUIRE(hit);
            see(*hit, surface(s.shapes[hit->id], ray, *hit).p);
        }
        CAPTURE(H);
        CHECK(of_an_element);
        CHECK(sum_off <= 8 * double(ulp));
        CHECK(place_off <= 64 * double(ulp) * 5);
        // Rounding may move a hit across a line of the grid.
        CHECK(negative >= -64 * double(ulp) * 40);
    }
}

TEST_CASE("sizes of spheres are those of their facets; at most, where facets are cut again") {
    const std::string before = "camera 0 0 50  0 0 0  40\ndiffuse d .5 .5 .5\nlight l 1 1 1\n";
    const NamedScene s =
        parse_scene(before +
                        "sphere 0 0 0  1  d\nsphere 5 0 0  2  l\n"
                        "quad 0 9 0  1 0 0  0 1 0  d\ntriangle 0 0 9  1 0 9  0 1 9  d\n",
                    "a.scene")
            .scene;
    for (double H : {5.0, 0.7, 0.331, 0.33, 0.329, 0.2, 0.12, 0.06}) {
        CAPTURE(H);
        const Mesh mesh = make_mesh(faceted(s, H).scene, H);
        check_sizes(s, mesh, H);
        CHECK(longest_edge(mesh) <= H * (1 + slack));
    }
    // Facets after ten quarterings have edges of at most 1.3e-3 radii.  H is a thirtieth of that:
    // 32^2 triangles each.
    const std::string quad = before + "quad 9 9 9  1 0 0  0 1 0  d\n";
    const Sizes fine = sizes(parse_scene(quad, "a.scene").scene, 4e-5),
                all = sizes(parse_scene(quad + "sphere 0 0 0  1  d\n", "a.scene").scene, 4e-5);
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
        // The printed H fits, and is not much coarser than it must be.
        CHECK(refusal(s, would_fit, memory) == "");
        CHECK(would_fit > H);
        CHECK(refusal(s, would_fit / 1.3, memory) != "");
    }
    CHECK(refused >= 3);
    CHECK(taken >= 2);
    CHECK(refusal(s, 0.1, 100).ends_with("no mesh would fit"));
    // Indices of 32 bits would overflow: the mesh is refused for any memory.
    CHECK(refusal(s, 1e-4, 1e300) != "");
    CHECK(bytes_of_machine() > 1e8);
    CHECK(bytes_of_machine() < 1e15);
}

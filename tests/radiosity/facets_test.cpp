// radiosity/facets_test.cpp  icospheres, the conversion of lights, refused scenes
#include "radiosity/facets.h"

#include <set>

#include "oracle/expect.h"
#include "radiosity/rooms.h"
#include "text/complaint.h"

using namespace rooms;

namespace {

using Facet = std::array<vec3, 3>;
using Key = std::array<double, 3>;

std::vector<Facet> icosphere(int k) {
    auto faces = icosahedron();
    for (; k > 0; --k) faces = quartered(faces);
    return faces;
}

double longest_edge(const std::vector<Facet>& faces) {
    real longest = 0;
    for (const auto& [a, b, c] : faces)
        longest = std::max({longest, length(a - b), length(b - c), length(c - a)});
    return double(longest);
}

Key key(vec3 p) { return {double(p.x), double(p.y), double(p.z)}; }

const std::string camera = "camera 0 0 50  0 0 0  40\n";
NamedScene parsed(const std::string& text) { return parse_scene(camera + text, "a.scene").scene; }

std::string complaint(const std::string& text) {
    return ::complaint([&] { check_diffuse(parsed(text), "a.scene"); });
}

double area(const Scene& s) {
    double sum = 0;
    for (const Shape& t : s.shapes) sum += double(length(area_vector(t))) / 2;
    return sum;
}

}  // namespace

TEST_CASE("icospheres are closed, and look outwards: every edge has two facets, one each way") {
    for (int k = 0; k < 5; ++k) {
        CAPTURE(k);
        const auto faces = icosphere(k);
        REQUIRE(faces.size() == size_t(20 * std::pow(4, k)));
        std::set<std::pair<Key, Key>> edges;
        std::set<Key> vertices;
        for (const Facet& f : faces) {
            CHECK(dot(cross(f[1] - f[0], f[2] - f[0]), f[0] + f[1] + f[2]) > 0);
            for (size_t i = 0; i < 3; ++i) {
                edges.insert({key(f[i]), key(f[(i + 1) % 3])}), vertices.insert(key(f[i]));
                CHECK(std::abs(length(f[i]) - 1) <= 4 * ulp);
            }
        }
        CHECK(vertices.size() == faces.size() / 2 + 2);  // Euler: V - E + F = 2
        CHECK(edges.size() == 3 * faces.size());
        for (const auto& [from, to] : edges) CHECK(edges.contains({to, from}));
    }
    CHECK(longest_edge(icosphere(0)) ==
          approx(4 / std::sqrt(10 + 2 * std::sqrt(5.0)), 1e-14, 1e-6));
}

TEST_CASE("as many quarterings as an edge needs: none is longer than H, one less would not do") {
    for (int k = 2; k < 7; ++k)
        for (double r : {1.0, 2.5}) {
            CAPTURE(k);
            CAPTURE(r);
            const double H = edge_of_facets(real(r), k);  // the smallest H with k
            CHECK(quarterings(real(r), H) == k);
            CHECK(quarterings(real(r), H * (1 - 1e-6)) == k + 1);
            CHECK(facets_of_sphere(real(r), H) == double(icosphere(k).size()));
            const double longest = r * longest_edge(icosphere(k));
            CHECK(longest <= H);
            CHECK(longest > 0.97 * H);
        }
    CHECK(quarterings(1, 3) == 2);      // never fewer
    CHECK(quarterings(1, 1e-9) == 10);  // the mesh cuts longer edges
}

TEST_CASE(
    "the area that an icosphere lacks is what the warning says, a quarter at each quartering") {
    double before = 0;
    const vec3 centre{1, 2, 3};
    for (double H : {0.34, 0.17, 0.084, 0.042}) {
        CAPTURE(H);
        const NamedScene s =
            parsed("diffuse d .5 .5 .5\nsphere 1 2 3  2  d\npointlight 9 9 9  1 1 1\n");
        const Faceted f = faceted(s, 2 * H);
        const auto& facets = f.scene.shapes;
        const double less = 1 - area(f.scene) / (16 * std::numbers::pi);
        REQUIRE(f.warnings.size() == 1);
        CHECK(f.warnings[0] ==
              oracle::say("3: the sphere becomes %zu triangles; their area is %.2g %% less",
                          facets.size(), 100 * less));
        CHECK(double(facets.size()) == facets_of_sphere(2, 2 * H));
        // A facet of edge h lies about h^2 / 8 deeper than its sphere: the error is of second
        // order.
        CHECK(less > 0);
        if (before > 0) CHECK(before / less == doctest::Approx(4).epsilon(0.02));
        before = less;
        for (const Shape& x : facets) {
            REQUIRE(dot(area_vector(x), x.a - centre) > 0);
            for (vec3 p : {x.b, x.c}) REQUIRE(std::abs(length(p - centre) - 2) < 32 * ulp);
        }
    }
}

TEST_CASE("lights stay with their shapes and their power; facets of a ball are brighter") {
    const NamedScene s = parsed(R"(
diffuse d .5 .5 .5
light a 1 2 3
light b 5 5 5 twosided d
sphere 0 0 0  1  a
quad 4 0 0  1 0 0  0 1 0  b
pointlight 9 9 9  7 7 7
sphere 9 0 0  2  d
triangle 0 4 0  1 4 0  0 5 0  a
sphere 0 9 0  1  b
)");
    const NamedScene f = faceted(s, 0.6).scene;
    const auto facets = size_t(facets_of_sphere(1, 0.6)), large = size_t(facets_of_sphere(2, 0.6));
    REQUIRE(f.shapes.size() == 2 * facets + 2 + large + 1);
    REQUIRE(f.lights.size() == 2 * facets + 3);
    REQUIRE(f.material_of.size() == f.shapes.size());
    REQUIRE(f.line_of.size() == f.shapes.size());
    REQUIRE(f.line_of_light.size() == f.lights.size());
    std::vector<int> shapes_of(f.lights.size());
    double small = 0;  // the facets of a unit sphere
    for (size_t i = 0; i < f.shapes.size(); ++i) {
        if (i < facets) small += double(length(area_vector(f.shapes[i]))) / 2;
        const Material& m = f.materials[f.material_of[i]];
        const int32_t k = f.light_of[i];
        REQUIRE((k != no_light) == m.emits());
        if (k == no_light) continue;
        const Light& l = f.lights[size_t(k)];
        ++shapes_of[size_t(k)];
        CHECK(l.L == m.Le);
        CHECK(m.diffuse() ==
              (f.line_of[i] == 6 || f.line_of[i] == 10 ? rgb{} : s.materials[0].diffuse()));
        CHECK(l.twosided == m.twosided);
        CHECK(f.line_of_light[size_t(k)] == f.line_of[i]);
        const bool quad = f.line_of[i] == 7;
        if (quad) {
            CHECK(l.as<QuadLight>());
        } else {
            REQUIRE(l.as<TriangleLight>());
            const auto& [e, g] = *l.as<TriangleLight>();
            CHECK(l.p == f.shapes[i].a);
            CHECK(length(l.p + e - f.shapes[i].b) <= 8 * ulp * 20);
            CHECK(length(l.p + g - f.shapes[i].c) <= 8 * ulp * 20);
        }
    }
    for (size_t k = 0; k < f.lights.size(); ++k)
        CHECK(shapes_of[k] == (f.lights[k].is_delta() ? 0 : f.lights[k].as<QuadLight>() ? 2 : 1));
    const double Pi = std::numbers::pi;
    CHECK(small < 4 * Pi);
    CHECK(double(f.lights[size_t(f.light_of[0])].L.z) == approx(3 * 4 * Pi / small));
    const rgb power = emitted_power(f);  // a, b on both sides, the point, a
    CHECK(double(power.x) == approx(Pi * (4 * Pi + 10 + 2 * 5 * 4 * Pi + 4 * 7 + 0.5)));
    CHECK(double(power.z) == approx(Pi * (3 * 4 * Pi + 10 + 2 * 5 * 4 * Pi + 4 * 7 + 1.5)));
}

TEST_CASE("a scene without spheres is itself") {
    const NamedScene s = parsed(
        "diffuse d .5 .5 .5\nlight l 1 2 3\nbox 10 10 10  0  -5 -5 -5  d\n"
        "pointlight 0 0 0  1 1 1\nquad -1 4 -1  2 0 0  0 0 2  l\n");
    const Faceted f = faceted(s, 1);
    CHECK(f.warnings.empty());
    REQUIRE(f.scene.shapes.size() == s.shapes.size());
    for (size_t i = 0; i < s.shapes.size(); ++i) {
        CHECK(f.scene.shapes[i].c == s.shapes[i].c);
        CHECK(f.scene.material_of[i] == s.material_of[i]);
    }
    CHECK(f.scene.light_of == s.light_of);
    CHECK(f.scene.lights.size() == 2);
    const Ray ray{{}, unit({1, 2, 3})};
    CHECK(f.scene.bvh.closest(ray)->t == s.bvh.closest(ray)->t);
}

TEST_CASE(
    "what scatters otherwise than diffusely is refused by its line, and only if it is there") {
    const std::string light = "light l 1 1 1\nquad 0 9 0  1 0 0  0 0 1  l\ndiffuse d .5 .5 .5\n",
                      glossy = "phong p .1 .1 .1  0 .4 0  7\n",
                      end = "; radiosity supports diffuse surfaces only";
    const std::pair<std::string, std::string> rows[] = {
        {"sphere 0 0 0  1  d\n", ""},
        {"mirror m .9 .9 .9\nsphere 0 0 0  1  d\n", ""},
        {"mirror m .9 .9 .9\nsphere 0 0 0  1  m\n", "a.scene:6: material 'm' is a mirror" + end},
        {"glass g 1.5\nsphere 9 0 0  1  d\nsphere 0 0 0  1  g\n",
         "a.scene:7: material 'g' is glass" + end},
        {glossy + "sphere 0 0 0  1  p\n", "a.scene:6: material 'p' is glossy" + end},
        {"phong p .1 .1 .1  0 0 0  7\nsphere 0 0 0  1  p\n", ""},
        {glossy + "light k 1 1 1 twosided p\nquad 0 0 0  1 0 0  0 1 0  k\n",
         "a.scene:7: material 'k' is glossy" + end}};
    for (const auto& [text, why] : rows) CHECK(complaint(light + text) == why);
}

TEST_CASE("a room whose walls absorb nothing is warned of, by its first line") {
    const std::string text =
        "diffuse grey .5 .5 .5\ndiffuse white .3 1 .3\npointlight 0 0 1  1 1 1\n"
        "quad 0 0 0  1 0 0  0 1 0  grey\nquad 0 0 2  1 0 0  0 1 0  white\n";
    const Faceted f = faceted(parsed(text), 1);
    REQUIRE(f.warnings.size() == 1);
    CHECK(f.warnings[0] == "6: reflects all light: in a closed room, paths never end");
}

// radiosity/particles_test.cpp  particles are unbiased for their functionals, and know their error
#include "radiosity/particles.h"

#include <random>

#include "base/moments.h"
#include "oracle/expect.h"
#include "radiosity/exact.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

constexpr double Pi = std::numbers::pi;
constexpr SamplerKind kinds[] = {SamplerKind::independent, SamplerKind::stratified,
                                 SamplerKind::halton, SamplerKind::sobol};

// A whole run: n particles, and a seed of the test's name.
Particles run(const Scene& s, const Mesh& mesh, SamplerKind kind, uint64_t n, uint64_t seed) {
    Particles p(s, mesh, Particles::pattern(kind, hash(seed_here(), seed), n));
    for (size_t batch = 0; batch < Particles::batches; ++batch)
        p.add(batch, n / Particles::batches);
    return p;
}

double flux(const Mesh& mesh, const IlluminationMap& map, size_t face, bool back) {
    return double(integral(mesh, map, mesh.faces[face], back).x);
}

// A room of colours, lit by a lamp, a triangle that emits on both sides and a point; open: its last
// wall is missing.
Scene study(bool open) {
    Scene s;
    const uint32_t walls = add(s, diffuse({real(0.7), real(0.5), real(0.2)}));
    add(s, diffuse({real(0.3), real(0.6), real(0.6)}));
    add_room(s, {3, 2, real(2.5)}, walls, 2);
    if (open)
        for (int k = 0; k < 2; ++k)
            s.shapes.pop_back(), s.material_of.pop_back(), s.light_of.pop_back();
    add_quad(s, {1, real(1.9), 1}, {real(0.5), 0, 0}, {0, 0, real(0.7)},
             add(s, diffuse(grey(0.1), {5, 4, 2})));
    add_triangle(s, {real(0.3), real(0.4), 2}, {1, real(0.4), 2}, {real(0.3), 1, real(2.2)},
                 add(s, diffuse(grey(0.4), grey(1), true)));
    add_point_light(s, {real(0.7), real(1.1), real(0.6)}, {0, real(0.1), real(0.2)});
    prepare(s);
    return s;
}

// An emitting plate 2 x 1 at z = 0, two triangles if it emits on both sides, and a black one of 1 x
// 1 above, or beyond the shorter edge.
Scene plates(bool above, bool twosided) {
    Scene s;
    const uint32_t lamp = add(s, diffuse(grey(0), grey(1), twosided)),
                   black = add(s, diffuse(grey(0)));
    if (twosided) {
        add_triangle(s, {}, {2, 0, 0}, {2, 1, 0}, lamp),
            add_triangle(s, {}, {2, 1, 0}, {0, 1, 0}, lamp);
    } else {
        add_quad(s, {}, {2, 0, 0}, {0, 1, 0}, lamp);
    }
    if (above) {
        add_quad(s, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, black);
        add_quad(s, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, black);
    } else {
        add_quad(s, {}, {0, 1, 0}, {0, 0, 1}, black);
        add_quad(s, {}, {0, 0, -1}, {0, 1, 0}, black);
    }
    prepare(s);
    return s;
}

// The integral of E times hat number k over a unit square of one cell, E from the closed form, by
// midpoints, 400 x 400.  Corners: 0 at (0, 0), 1 at (1, 0), 2 at (0, 1), 3 at (1, 1).
std::array<double, 4> hats_of_one_cell(auto E) {
    std::array<double, 4> b{};
    const int n = 400;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double s = (i + 0.5) / n, t = (j + 0.5) / n, e = E(s, t) / (n * n);
            const bool half = t > s;  // of the diagonal from 0 to 3
            b[0] += e * (half ? 1 - t : 1 - s), b[3] += e * (half ? s : t);
            b[half ? 2 : 1] += e * (half ? t - s : s - t);
        }
    return b;
}

}  // namespace

TEST_CASE("what is emitted is absorbed or escapes: coloured, open and closed, every sampler") {
    for (bool open : {false, true})
        for (SamplerKind kind : kinds) {
            CAPTURE(open);
            const Scene s = study(open);
            const Mesh mesh = make_mesh(s, 1);
            const Balance b = run(s, mesh, kind, 16000, 1).balance();
            for (auto a : axis) {
                CHECK(double(b.emitted.*a) ==
                      approx(double(b.absorbed.*a) + double(b.escaped.*a), 1e-11, 1e-3));
                CHECK((b.escaped.*a > 0) == open);
                // Each light is chosen in proportion to its power, so colours differ by chance.
                CHECK(double(b.emitted.*a) == approx(double(emitted_power(s).*a), 0.1, 0.1));
            }
            CHECK(double(mean_of(b.emitted)) ==
                  approx(double(mean_of(emitted_power(s))), 1e-9, 1e-3));
        }
}

TEST_CASE("many particles are as exact as one: their sums do not lose what is small beside them") {
    Scene s;
    add_quad(s, {}, {1, 0, 0}, {0, 1, 0}, add(s, diffuse(grey(0), grey(1))));
    prepare(s);
    const Mesh mesh = make_mesh(s, 9);
    Particles p(s, mesh, Particles::pattern(SamplerKind::independent, 1, 0));
    p.add(0, 100000);
    CHECK(double(p.balance().emitted.x) == approx(Pi, 1e-10, 1e-6));
    CHECK(p.balance().escaped == p.balance().emitted);
}

TEST_CASE("power is what the lights have: the mean over particles, a channel at a time") {
    const Scene s = study(false);
    const Mesh mesh = make_mesh(s, 9);
    for (SamplerKind kind : kinds)
        for (auto a : axis)
            EXPECT(
                oracle::expect_replicates(
                    double(emitted_power(s).*a), 64,
                    [&](int r) {
                        return double(run(s, mesh, kind, 1600, uint64_t(r)).balance().emitted.*a);
                    }),
                0.02);
}

TEST_CASE("a point sends a sixth of its power to every wall of a cube around it") {
    Scene s;
    add_room(s, {2, 2, 2}, add(s, diffuse(grey(0))));
    add_point_light(s, {1, 1, 1}, grey(1));
    prepare(s);
    const Mesh mesh = make_mesh(s, 3);
    for (SamplerKind kind : kinds) {
        std::vector<IlluminationMap> maps;
        for (uint64_t r = 0; r < 64; ++r) maps.push_back(run(s, mesh, kind, 3200, r).map());
        for (size_t face = 0; face < 6; ++face)
            EXPECT(oracle::expect_replicates(4 * Pi / 6, 64,
                                             [&](int r) {
                                                 return flux(mesh, maps[size_t(r)], face, false) +
                                                        flux(mesh, maps[size_t(r)], face, true);
                                             }),
                   0.06);
    }
}

TEST_CASE("the sums are the same, bit for bit, for any number of threads and passes") {
    const Scene s = study(true);
    const Mesh mesh = make_mesh(s, 1);
    for (SamplerKind kind : kinds) {
        const Particles one = run(s, mesh, kind, 3200, 1);
        CHECK(one.particles() == 3200);
        CHECK(one.of_each() == 200);
        CHECK(one.rays() > one.particles());
        for (unsigned threads : {1u, 2u, 3u, 5u}) {
            Particles p(s, mesh, Particles::pattern(kind, hash(seed_here(), 1), 3200));
            for (uint64_t n : {8, 64, 128})
                in_parallel(
                    Particles::batches, threads, [&](size_t b) { p.add(b, n); }, [](double) {});
            CHECK(p.of_each() == 200);
            CHECK(p.map() == one.map());
            CHECK(p.error() == one.error());
            CHECK(p.rays() == one.rays());
            CHECK(p.balance().absorbed == one.balance().absorbed);
        }
        CHECK(run(s, mesh, kind, 3200, 2).map() != one.map());
    }
}

TEST_CASE("batches are randomisations of their own; without one there is no error to tell") {
    const Scene s = study(true);
    const Mesh mesh = make_mesh(s, 1);
    const Pattern pattern = Particles::pattern(SamplerKind::halton, 1, 1600);
    std::vector<IlluminationMap> maps;
    for (size_t batch : {0u, 1u, 15u}) {
        Particles p(s, mesh, pattern);
        p.add(batch, 100);
        CHECK(std::isnan(p.error()));
        maps.push_back(p.map());
    }
    CHECK(maps[0] != maps[1]);
    CHECK(maps[1] != maps[2]);
    Particles stopped(s, mesh, pattern);
    interrupted = 1;
    stopped.add(0, 100);
    interrupted = 0;
    CHECK(stopped.particles() == 0);
}

TEST_CASE("a furnace is uniform within the reported error; 16 batches tell it within a factor") {
    const Scene s = room({2, 3, 1}, diffuse({real(0.5), real(0.2), real(0.9)}, {1, 2, real(0.2)}));
    const Mesh mesh = make_mesh(s, 2.2);
    for (SamplerKind kind : kinds)
        for (Functional f : {Functional::projection, Functional::mean}) {
            const Particles p = run(s, mesh, kind, 32000, 1);
            const IlluminationMap map = p.map(f);
            double off = 0, size = 0;
            for (const Face& face : mesh.faces) {
                const Projection onto(mesh, face);
                Sums d(face.vertices());
                for (uint32_t v = 0; v < d.size(); ++v) {
                    CHECK(map[2 * (face.vertex + v) + 1] == rgb{});
                    d[v] = map[2 * (face.vertex + v)] - pi * rgb{2, real(2.5), 2};
                }
                const rgb square = onto.square(d);
                off += double(square.x + square.y + square.z);
                size += Pi * Pi * (4 + 6.25 + 4) * double(face.area());
            }
            const double error = std::sqrt(off / size);
            CAPTURE(error);
            CHECK(p.error(f) < 0.03);
            // 54 vertices and three channels: not one number but a hundred are averaged.
            CHECK(error == doctest::Approx(p.error(f)).epsilon(0.5));
        }
}

TEST_CASE("where noise is all that there is, the reported error does not stop at 100 %") {
    const Scene s = cube();
    const Mesh mesh = make_mesh(s, 0.7);  // many more vertices than hits
    CHECK(run(s, mesh, SamplerKind::independent, 32, 1).error() > 2);
}

TEST_CASE("plates: what a receiver gets, by closed forms, and each of its hats, by quadrature") {
    for (bool above : {true, false}) {
        // The receiver is one cell, s along y and t along x (above) or z (beside).
        const auto b = hats_of_one_cell([&](double u, double v) {
            if (above)
                return closed_forms::polygon_irradiance(
                    {{-v, 1, -u}, {2 - v, 1, -u}, {2 - v, 1, 1 - u}, {-v, 1, 1 - u}});
            return closed_forms::polygon_irradiance(
                {{-u, 0, -v}, {1 - u, 0, -v}, {1 - u, 2, -v}, {-u, 2, -v}});
        });
        const double F =
            above ? closed_forms::opposed(2, 1) : 2 * closed_forms::perpendicular(2, 1);
        CHECK(b[0] + b[1] + b[2] + b[3] == doctest::Approx(Pi * F).epsilon(1e-4));
        for (bool twosided : {false, true})
            for (SamplerKind kind : kinds) {
                CAPTURE(above);
                CAPTURE(twosided);
                const Scene s = plates(above, twosided);
                const Mesh mesh = make_mesh(s, 1.5);
                const size_t first = twosided ? 2 : 1;  // after the lamp
                REQUIRE(mesh.faces[first].elements() == 2);
                std::vector<IlluminationMap> maps, means;
                for (uint64_t r = 0; r < 64; ++r) {
                    const Particles p = run(s, mesh, kind, 6400, r);
                    maps.push_back(p.map()), means.push_back(p.map(Functional::mean));
                }
                auto expect = [&](double truth, double largest, auto value) {
                    EXPECT(oracle::expect_replicates(
                               truth, 64, [&](int r) { return double(value(size_t(r))); }),
                           largest);
                };
                expect(Pi * F, 0.06, [&](size_t r) { return flux(mesh, maps[r], first, false); });
                if (twosided)
                    expect(Pi * F, 0.06,
                           [&](size_t r) { return flux(mesh, maps[r], first + 1, false); });
                for (uint32_t k = 0; k < 4; ++k) {
                    const double hat = k == 0 || k == 3 ? 1 / 3.0 : 1 / 6.0;  // its own integral
                    const uint32_t v = mesh.faces[first].vertex + k;
                    expect(b[k] / hat, 0.15, [&](size_t r) { return means[r][2 * v].y; });
                }
                for (size_t face = 0; face < first + 2; ++face) {
                    CHECK(flux(mesh, maps[0], face, true) == 0);
                    if (face < first) CHECK(flux(mesh, maps[0], face, false) == 0);
                }
                if (!twosided) CHECK(flux(mesh, maps[0], first + 1, false) == 0);
            }
    }
}

TEST_CASE("the cube: sums over hats of 2 x 2 cells, against the exact solution") {
    const Scene s = cube();
    const Mesh mesh = make_mesh(s, 10 * std::sqrt(2.0) / 2 * (1 + 1e-6));
    REQUIRE(mesh.vertices() == 54);
    for (SamplerKind kind : kinds) {
        std::vector<IlluminationMap> maps;
        for (uint64_t r = 0; r < 96; ++r)
            maps.push_back(run(s, mesh, kind, 1600, r).map(Functional::mean));
        for (const exact::CubeHat& hat : exact::cube_hats) {
            CAPTURE(hat.triangles);
            // A hat's own integral: a third of its triangles, of 12.5 m^2.
            const double size = 12.5 * hat.triangles / 3;
            EXPECT(oracle::expect_replicates(
                       hat.flux / size, 96,
                       [&](int r) {
                           double sum = 0;
                           for (const Face& f : mesh.faces)
                               for (int k : hat.vertices)
                                   sum +=
                                       double(maps[size_t(r)][2 * (f.vertex + uint32_t(k)) + 1].x);
                           return sum / double(6 * hat.vertices.size());
                       }),
                   0.05);
        }
    }
}

TEST_CASE("a sphere in a sphere, of facets: as the closed form of spheres of their areas") {
    // All that leaves the inner one, which is convex, arrives at the outer one, so reciprocity
    // takes areas alone; that facets are lit as evenly as a sphere is true but for their size.
    const Scene from = parse_scene(
                           "camera 0 0 50  0 0 0  40\ndiffuse d .8 .8 .8\n"
                           "diffuse g .3 .3 .3\nlight l 1 1 1 g\n"
                           "sphere 0 0 0  4  d\nsphere 0 0 0  2  l\n",
                           "a.scene")
                           .scene;
    const Scene lit = faceted(from, 1.5).scene;
    const Mesh mesh = make_mesh(lit, 1.5);
    double inner = 0, outer = 0;
    for (const Face& f : mesh.faces) (length(f.a) < 3 ? inner : outer) += double(f.area());
    CHECK(inner == doctest::Approx(16 * Pi).epsilon(0.05));
    const double exitance = Pi * 16 * Pi / inner;  // the power is that of the sphere
    const exact::OfSpheres truth = exact::illuminances(
        {std::sqrt(inner / (4 * Pi)), std::sqrt(outer / (4 * Pi)), 0.3, 0.8, exitance, 0});
    for (SamplerKind kind : kinds) {
        std::vector<std::array<double, 2>> E;
        for (uint64_t r = 0; r < 32; ++r) {
            const IlluminationMap map = run(lit, mesh, kind, 6400, r).map();
            E.push_back({0, 0});
            for (size_t k = 0; k < mesh.faces.size(); ++k) {
                const bool of_inner = length(mesh.faces[k].a) < 3;
                E.back()[of_inner ? 0 : 1] += flux(mesh, map, k, !of_inner);
            }
        }
        EXPECT(oracle::expect_replicates(truth.inner * inner, 32,
                                         [&](int r) { return E[size_t(r)][0]; }),
               0.05);
        EXPECT(oracle::expect_replicates(truth.outer * outer, 32,
                                         [&](int r) { return E[size_t(r)][1]; }),
               0.05);
    }
}

TEST_CASE("the reported error is right: its square is the mean of squares, whatever the sampler") {
    const Scene s = room({2, 3, 1}, diffuse({real(0.5), real(0.2), real(0.7)}, {1, 2, real(0.6)}));
    const Mesh mesh = make_mesh(s, 2.2);
    const vec3 truth = pi * rgb{2, real(2.5), 2};
    for (SamplerKind kind : kinds)
        for (Functional f : {Functional::projection, Functional::mean}) {
            Moments actual, reported;
            for (uint64_t r = 0; r < 128; ++r) {
                const Particles p = run(s, mesh, kind, 1600, r);
                const IlluminationMap map = p.map(f);
                double off = 0, size = 0;
                for (const Face& face : mesh.faces) {
                    Sums d(face.vertices());
                    for (uint32_t v = 0; v < d.size(); ++v)
                        d[v] = map[2 * (face.vertex + v)] - truth;
                    const rgb square = Projection(mesh, face).square(d);
                    off += double(square.x + square.y + square.z);
                    size += double(dot(truth, truth) * face.area());
                }
                actual.add(off / size), reported.add(p.error(f) * p.error(f));
            }
            EXPECT(oracle::expect_equal(estimate(actual), estimate(reported)), 0.3);
        }
}

// Checks that the mean square of what is stated is the variance of the errors.
static void expect_uncertainty(const std::vector<MapError>& stated, double largest) {
    Moments errors, actual, claimed;
    for (const MapError& e : stated) errors.add(e.error);
    for (const auto& [error, uncertainty] : stated)
        actual.add((error - errors.mean) * (error - errors.mean)),
            claimed.add(uncertainty * uncertainty);
    EXPECT(oracle::expect_equal(estimate(actual), estimate(claimed)), largest);
}

TEST_CASE("the stated error's own uncertainty is its spread, of batches that are normal numbers") {
    std::mt19937_64 random(seed_here());
    std::normal_distribution<double> normal;
    std::vector<MapError> stated;
    for (int r = 0; r < 4000; ++r) {
        constexpr int n = 16, dimensions = 30;
        BatchSquares<n> b;
        for (int d = 0; d < dimensions; ++d) {
            double x[n], mean = 0;
            for (double& each : x) each = 1 + normal(random), mean += each / n;
            b.whole += mean * mean;
            for (size_t k = 0; k < n; ++k)
                b.off[k] += (x[k] - mean) * (x[k] - mean), b.along[k] += (x[k] - mean) * mean;
        }
        stated.push_back(b.stated());
    }
    expect_uncertainty(stated, 0.22);
}

TEST_CASE("the stated error's own uncertainty is its spread from run to run") {
    const Scene s = room({2, 3, 1}, diffuse({real(0.5), real(0.2), real(0.7)}, {1, 2, real(0.6)}));
    const Mesh mesh = make_mesh(s, 1);
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::halton}) {
        std::vector<MapError> stated;
        for (uint64_t r = 0; r < 400; ++r) stated.push_back(run(s, mesh, kind, 1600, r).stated());
        expect_uncertainty(stated, 0.7);
    }
}

TEST_CASE("batches that differ in one thing tell its error, and twice as much is twice the error") {
    // 16 batches of one number, 1 + x or 1 - x: variance of the mean x^2 / 15.
    auto of = [](double x) {
        BatchSquares<16> b;
        b.whole = 1;
        for (size_t k = 0; k < 16; ++k) b.off[k] = x * x, b.along[k] = k % 2 ? x : -x;
        return b.stated();
    };
    CHECK(of(0).error == 0);
    CHECK(of(0).uncertainty == 0);
    for (double x : {0.1, 0.2}) {
        const double own = x * x / 15;
        CHECK(of(x).error == doctest::Approx(std::sqrt(own / (1 - own))).epsilon(1e-12));
    }
    // All are alike off the mean: without one of them the variance falls or rises by as much.
    CHECK(of(0.1).uncertainty < 0.05 * of(0.1).error);
    BatchSquares<16> one;  // that alone is off (but for the mean, which is beside it)
    one.whole = 1, one.off.fill(1e-4 / 225), one.off[3] = 1e-4;
    CHECK(one.stated().error ==
          doctest::Approx(std::sqrt(1e-4 * (1 + 1 / 15.0) / 240)).epsilon(1e-4));
    CHECK(one.stated().uncertainty > 0.9 * one.stated().error);
    CHECK(std::isinf(of(4).error));
    CHECK(std::isinf(of(4).uncertainty));
}

TEST_CASE("walls that reflect all light end, too, and what is emitted is absorbed") {
    const Scene s = room({1, 1, 1}, diffuse(grey(1), grey(1)));
    const Mesh mesh = make_mesh(s, 1.5);
    const Particles p = run(s, mesh, SamplerKind::halton, 1600, 1);
    CHECK(double(p.balance().absorbed.x) == approx(double(p.balance().emitted.x), 1e-11, 1e-3));
    CHECK(p.rays() / p.particles() > 20);
    CHECK(p.rays() / p.particles() < 100);  // 1 / (1 - 0.98) are survived
}

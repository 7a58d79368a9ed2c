// radiosity/particles_test.cpp  particles are unbiased for their functionals; the reported error
#include "radiosity/particles.h"

#include <random>

#include "app/threads.h"
#include "base/moments.h"
#include "oracle/expect.h"
#include "radiosity/exact.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

constexpr double Pi = std::numbers::pi;

// A complete run of n particles; its seed depends on the test's name.
Particles run(const Meshed& m, SamplerKind kind, uint64_t n, uint64_t seed) {
    Particles p(m.scene, m.mesh, Particles::settings(kind, hash(seed_here(), seed)));
    for (size_t batch = 0; batch < Particles::batches; ++batch)
        p.add(batch, n / Particles::batches);
    return p;
}

double flux(const Mesh& mesh, const IlluminationMap& map, size_t face, bool back = false) {
    return double(integral(mesh, map, mesh.faces[face], back).x);
}

std::vector<IlluminationMap> maps_of_runs(const Meshed& m, SamplerKind kind, uint64_t n,
                                          uint64_t runs, Functional f = Functional::projection) {
    std::vector<IlluminationMap> maps;
    for (uint64_t r = 0; r < runs; ++r) maps.push_back(run(m, kind, n, r).map(f));
    return maps;
}

// Checks the mean of a functional of maps, or of other results of runs.
template <class Told>
void expect_mean(const std::vector<Told>& runs, double truth, double largest, auto value) {
    EXPECT(oracle::expect_replicates(truth, int(runs.size()),
                                     [&](int r) { return double(value(runs[size_t(r)])); }),
           largest);
}

// An emitting plate 2 x 1 at z = 0, two triangles if it emits on both sides, and a black plate 1 x
// 1 above or beyond the shorter edge.  The black plate has a mirror image in the emitting one.
Scene plates(bool above, bool twosided) {
    Scene s;
    const uint32_t lamp = add(s, diffuse(grey(0), grey(1), twosided)),
                   black = add(s, diffuse(grey(0)));
    const vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    if (twosided) {
        add_triangle(s, {}, {2, 0, 0}, {2, 1, 0}, lamp);
        add_triangle(s, {}, {2, 1, 0}, {0, 1, 0}, lamp);
    } else {
        add_quad(s, {}, {2, 0, 0}, y, lamp);
    }
    add_quad(s, above ? z : vec3{}, y, above ? x : z, black);
    add_quad(s, above ? -z : vec3{}, above ? x : -z, y, black);
    prepare(s);
    return s;
}

// The integral of E times hat number k over a unit square of one cell, for a closed form E, by 400
// x 400 midpoints.  Corners: 0 at (0, 0), 1 at (1, 0), 2 at (0, 1), 3 at (1, 1).
std::array<double, 4> hats_of_one_cell(auto E) {
    std::array<double, 4> b{};
    const int n = 400;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double s = (i + 0.5) / n, t = (j + 0.5) / n, e = E(s, t) / (n * n);
            const bool half = t > s;  // halves at the diagonal from 0 to 3
            b[0] += e * (half ? 1 - t : 1 - s), b[3] += e * (half ? s : t);
            b[half ? 2 : 1] += e * (half ? t - s : s - t);
        }
    return b;
}

}  // namespace

TEST_CASE("a light is chosen as often as its power says, and says so") {
    std::vector<Light> s;
    for (real intensity : {1, 5, 2})
        s.push_back({{}, PointLight(), {intensity, intensity, intensity}});
    const LightsByPower three(s);
    // The shares of 8000 equidistant numbers are [0, 1/8), [1/8, 6/8) and [6/8, 1).
    std::vector<int> count(3);
    for (int i = 0; i < 8000; ++i) ++count.at(three.choose((real(i) + real(0.5)) / 8000));
    CHECK(count == std::vector<int>{1000, 5000, 2000});
    for (size_t i = 0; i < 3; ++i)
        CHECK(std::abs(three.probability_of(i) - real(count[i]) / 8000) < 2 * ulp);
    CHECK(three.choose(0) == 0);
    CHECK(three.choose(three.probability_of(0)) == 1);  // the first has what is below
    CHECK(three.choose(below_one) == 2);
    s.push_back({{}, PointLight(), {real(1e-30), 0, 0}});  // weak: its share rounds to 0
    const LightsByPower four(s);
    CHECK(four.probability_of(3) > 0);
    CHECK(four.choose(below_one) == 3);
    CHECK(four.choose(1) == 3);  // also beyond all numbers
    // Powers that underflow are alike.
    for (const real faint : {std::numeric_limits<real>::denorm_min(), real(0)}) {
        const LightsByPower dim({4, Light({}, PointLight(), {faint, 0, 0})});
        for (size_t i = 0; i < 4; ++i) CHECK(dim.probability_of(i) == real(0.25));
    }
}

TEST_CASE("power: pi L A, twice that of two sides, 4 pi I, means of the channels") {
    const Light quad({}, QuadLight{{3, 0, 0}, {1, 2, 0}}, {1, 2, 3});
    Light both = quad;
    both.twosided = true;
    for (const auto& [l, over_pi] :
         {std::pair{Light({}, SphereLight{0.5}, {1, 2, 3}), 2 * std::numbers::pi},
          {quad, 2.0 * 6},
          {both, 2.0 * 12},
          {Light({}, TriangleLight{{3, 0, 0}, {1, 2, 0}}, {1, 2, 3}), 2.0 * 3},
          {Light({}, PointLight(), {1, 2, 3}), 8.0}})
        CHECK(power(l) == doctest::Approx(std::numbers::pi * over_pi).epsilon(1e-6));
}

TEST_CASE("what is emitted is absorbed or escapes: coloured, open and closed, every sampler") {
    for (bool open : {false, true})
        for (SamplerKind kind : all_samplers) {
            CAPTURE(open);
            const Meshed m(study(open), 1);
            const Balance b = run(m, kind, 16000, 1).balance();
            const rgb found = b.absorbed + b.escaped;
            for (auto a : axis) {
                CHECK(double(b.emitted.*a) == approx(double(found.*a), 1e-11, 1e-3));
                CHECK((b.escaped.*a > 0) == open);
            }
            // The choice of lights is proportional to the mean of the channels.
            const double emitted = double(mean_of(emitted_power(m.scene)));
            CHECK(double(mean_of(b.emitted)) == approx(emitted, 1e-9, 1e-3));
        }
}

TEST_CASE("many particles are as exact as one: their sums do not lose what is small beside them") {
    const Meshed m(scene_of_quads({{{}, {1, 0, 0}, {0, 1, 0}, diffuse(grey(0), grey(1))}}), 9);
    Particles p(m.scene, m.mesh, Particles::settings(SamplerKind::independent, 1));
    p.add(0, 100000);
    CHECK(double(p.balance().emitted.x) == approx(Pi, 1e-10, 1e-6));
    CHECK(p.balance().escaped == p.balance().emitted);
}

TEST_CASE("power is what the lights have: the mean over particles, a channel at a time") {
    const Meshed m(study(), 9);
    const rgb power = emitted_power(m.scene);
    for (SamplerKind kind : all_samplers) {
        std::vector<rgb> emitted;
        for (uint64_t r = 0; r < 64; ++r)
            emitted.push_back(run(m, kind, 1600, r).balance().emitted);
        for (auto a : axis)
            expect_mean(emitted, double(power.*a), 0.02, [&](rgb e) { return e.*a; });
    }
}

TEST_CASE("a point sends a sixth of its power to every wall of a cube around it") {
    const Meshed m(room({2, 2, 2}, diffuse(grey(0)), {1, 1, 1}, grey(1)), 3);
    for (SamplerKind kind : all_samplers) {
        const auto maps = maps_of_runs(m, kind, 3200, 64);
        for (size_t face = 0; face < 6; ++face)
            expect_mean(maps, 4 * Pi / 6, 0.06,
                        [&](const auto& map) { return flux(m.mesh, map, face); });
    }
}

TEST_CASE("the sums are the same, bit for bit, for any number of threads and passes") {
    const Meshed m(study(true), 1);
    for (SamplerKind kind : all_samplers) {
        const Particles one = run(m, kind, 3200, 1);
        CHECK((one.particles() == 3200 && one.of_each() == 200));
        CHECK(one.rays() > one.particles());
        for (unsigned threads : {1u, 2u, 3u, 5u}) {
            Particles p(m.scene, m.mesh, Particles::settings(kind, hash(seed_here(), 1)));
            for (uint64_t n : {8, 64, 128})
                by_workers(
                    Particles::batches, threads, [&](size_t b, unsigned) { p.add(b, n); },
                    [](double) {});
            CHECK(p.of_each() == 200);
            CHECK(p.map() == one.map());
            CHECK(p.error() == one.error());
            CHECK(p.rays() == one.rays());
            CHECK(p.balance().absorbed == one.balance().absorbed);
        }
        CHECK(run(m, kind, 3200, 2).map() != one.map());
    }
}

TEST_CASE("batches are randomisations of their own; without one there is no error to tell") {
    const Meshed m(study(true), 1);
    const SamplerSettings settings = Particles::settings(SamplerKind::halton, 1);
    std::vector<IlluminationMap> maps;
    for (size_t batch : {0u, 1u, 15u}) {
        Particles p(m.scene, m.mesh, settings);
        p.add(batch, 100);
        CHECK(std::isnan(p.error()));
        maps.push_back(p.map());
    }
    CHECK(maps[0] != maps[1]);
    CHECK(maps[1] != maps[2]);
    Particles stopped(m.scene, m.mesh, settings);
    interrupted = 1;
    stopped.add(0, 100);
    interrupted = 0;
    CHECK(stopped.particles() == 0);
}

TEST_CASE("where noise is all that there is, the reported error does not stop at 100 %") {
    const Meshed m(cubic_room(), 0.7);  // many more vertices than hits
    CHECK(run(m, SamplerKind::independent, 32, 1).error() > 2);
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
            for (SamplerKind kind : all_samplers) {
                CAPTURE(above);
                CAPTURE(twosided);
                const Meshed m(plates(above, twosided), 1.5);
                const Mesh& mesh = m.mesh;
                const size_t first = twosided ? 2 : 1, receivers = twosided ? 2 : 1;
                REQUIRE(mesh.faces[first].elements() == 2);
                std::vector<IlluminationMap> maps, means;
                for (uint64_t r = 0; r < 64; ++r) {
                    const Particles p = run(m, kind, 1600, r);
                    maps.push_back(p.map()), means.push_back(p.map(Functional::mean));
                }
                for (size_t face = 0; face < first + 2; ++face) {
                    CHECK(flux(mesh, maps[0], face, true) == 0);
                    if (face >= first && face < first + receivers)
                        expect_mean(maps, Pi * F, 0.12,
                                    [&](const auto& map) { return flux(mesh, map, face); });
                    else
                        CHECK(flux(mesh, maps[0], face) == 0);
                }
                for (uint32_t k = 0; k < 4; ++k) {
                    const double hat = k == 0 || k == 3 ? 1 / 3.0 : 1 / 6.0;  // integral of the hat
                    const uint32_t v = mesh.faces[first].vertex + k;
                    expect_mean(means, b[k] / hat, 0.3,
                                [&](const auto& map) { return map[2 * v].y; });
                }
            }
    }
}

TEST_CASE("the cube: sums over hats of 2 x 2 cells, against the exact solution") {
    const Meshed m(cubic_room(), 10 * std::sqrt(2.0) / 2 * (1 + 1e-6));
    REQUIRE(m.mesh.vertices() == 54);
    for (SamplerKind kind : all_samplers) {
        const auto means = maps_of_runs(m, kind, 1600, 96, Functional::mean);
        for (const exact::CubeHat& hat : exact::cube_hats) {
            CAPTURE(hat.triangles);
            // The integral of a hat is a third of the area of its triangles, 12.5 m^2 each.
            const double size = 12.5 * hat.triangles / 3;
            expect_mean(means, hat.flux / size, 0.05, [&](const IlluminationMap& map) {
                double sum = 0;
                for (const Face& f : m.mesh.faces)
                    for (int k : hat.vertices) sum += double(map[2 * (f.vertex + k) + 1].x);
                return sum / double(6 * hat.vertices.size());
            });
        }
    }
}

TEST_CASE("a sphere in a sphere, of facets: as the closed form of spheres of their areas") {
    // All light from the convex inner sphere arrives at the outer one, so that reciprocity needs
    // only areas.  The facets are lit evenly up to their size.
    const NamedScene balls = parse_scene(
                                 "camera 0 0 50  0 0 0  40\ndiffuse d .8 .8 .8\n"
                                 "diffuse g .3 .3 .3\nlight l 1 1 1 g\n"
                                 "sphere 0 0 0  4  d\nsphere 0 0 0  2  l\n",
                                 "a.scene")
                                 .scene;
    const Meshed m(faceted(balls, 1.5).scene, 1.5);
    const Mesh& mesh = m.mesh;
    auto is_inner = [&](size_t k) { return length(mesh.faces[k].a) < 3; };
    double inner = 0, outer = 0;
    for (size_t k = 0; k < mesh.faces.size(); ++k)
        (is_inner(k) ? inner : outer) += double(mesh.faces[k].area());
    CHECK(inner == doctest::Approx(16 * Pi).epsilon(0.05));
    const double exitance = Pi * 16 * Pi / inner;  // the power equals that of the sphere
    const exact::OfSpheres truth = exact::illuminances(
        {std::sqrt(inner / (4 * Pi)), std::sqrt(outer / (4 * Pi)), 0.3, 0.8, exitance, 0});
    // All that is emitted is absorbed.
    CHECK(0.7 * truth.inner * inner + 0.2 * truth.outer * outer == approx(Pi * 16 * Pi));
    for (SamplerKind kind : all_samplers) {
        const auto maps = maps_of_runs(m, kind, 1600, 32);
        for (bool of_inner : {true, false})
            expect_mean(maps, of_inner ? truth.inner * inner : truth.outer * outer, 0.1,
                        [&](const IlluminationMap& map) {
                            double E = 0;
                            for (size_t k = 0; k < mesh.faces.size(); ++k)
                                if (is_inner(k) == of_inner) E += flux(mesh, map, k, !of_inner);
                            return E;
                        });
    }
}

TEST_CASE("the reported error is right: its square is the mean of squares, whatever the sampler") {
    const Meshed m(furnace(), 2.2);
    constexpr Functional functionals[] = {Functional::projection, Functional::mean};
    for (SamplerKind kind : all_samplers) {
        Moments actual[2], reported[2];
        for (uint64_t r = 0; r < 128; ++r) {
            const Particles p = run(m, kind, 1600, r);
            for (size_t k : {0, 1}) {
                const IlluminationMap map = p.map(functionals[k]);
                for (size_t v = 1; v < map.size(); v += 2) REQUIRE(map[v] == rgb{});
                actual[k].add(furnace_error2(m.mesh, map));
                reported[k].add(std::pow(p.error(functionals[k]), 2));
            }
        }
        for (size_t k : {0, 1}) {
            EXPECT(oracle::expect_equal(estimate(actual[k]), estimate(reported[k])), 0.3);
            CHECK(reported[k].mean < 0.03 * 0.03 * 32000 / 1600);
        }
    }
}

TEST_CASE(
    "the stated error and its uncertainty are the jackknife's, without bias for normal numbers") {
    constexpr size_t n = 16, all = n;
    std::mt19937_64 random(seed_here());
    std::normal_distribution<double> normal;
    std::array<std::array<double, n>, 30> x;  // by dimensions and batches
    for (auto& numbers : x)
        for (double& each : numbers) each = 1 + normal(random);
    auto moments = [](const std::array<double, n>& numbers, size_t left_out) {
        Moments m;
        for (size_t b = 0; b < n; ++b)
            if (b != left_out) m.add(numbers[b]);
        return m;
    };
    // The error of the mean of all, from all batches but one.
    auto error_without = [&](size_t left_out) {
        double square = 0, variance = 0;
        for (const auto& numbers : x) {
            const Moments m = moments(numbers, left_out);
            square += m.mean * m.mean, variance += m.variance();
        }
        return std::sqrt(variance / n / (square - variance / (left_out == all ? n : n - 1)));
    };
    BatchSquares<n> squares;
    for (const auto& numbers : x) {
        const double mean = moments(numbers, all).mean;
        squares.whole += mean * mean;
        for (size_t b = 0; b < n; ++b) {
            squares.off[b] += (numbers[b] - mean) * (numbers[b] - mean);
            squares.along[b] += (numbers[b] - mean) * mean;
        }
    }
    Moments errors;
    for (size_t b = 0; b < n; ++b) errors.add(error_without(b));
    const MapError stated = squares.stated();
    CHECK(stated.error == approx(error_without(all), 1e-12, 1e-12));
    // The jackknife's variance is (n-1)/n m2, and (n-1)/(n-2) times too large.
    CHECK(stated.uncertainty == approx(std::sqrt(errors.m2 * (n - 2) / n), 1e-9, 1e-9));
}

TEST_CASE("the stated error's own uncertainty is its spread from run to run") {
    const Meshed m(furnace(), 1);
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::halton}) {
        std::vector<MapError> stated;
        for (uint64_t r = 0; r < 200; ++r) stated.push_back(run(m, kind, 1600, r).stated());
        Moments errors, actual, claimed;
        for (const MapError& e : stated) errors.add(e.error);
        for (const auto& [error, uncertainty] : stated) {
            actual.add((error - errors.mean) * (error - errors.mean));
            claimed.add(uncertainty * uncertainty);
        }
        EXPECT(oracle::expect_equal(estimate(actual), estimate(claimed)), 1.2);
    }
}

TEST_CASE("batches that agree have no error; the error of nothing but noise is infinite") {
    for (double x : {0.0, 4.0}) {  // batches of one number each, 1 + x or 1 - x
        BatchSquares<16> b;
        b.whole = 1;
        for (size_t k = 0; k < 16; ++k) b.off[k] = x * x, b.along[k] = k % 2 ? x : -x;
        const double expected = x > 0 ? double(INFINITY) : 0;
        CHECK(b.stated().error == expected);
        CHECK(b.stated().uncertainty == expected);
    }
}

TEST_CASE("walls that reflect all light end, too, and what is emitted is absorbed") {
    const Meshed m(room({1, 1, 1}, diffuse(grey(1), grey(1))), 1.5);
    const Particles p = run(m, SamplerKind::halton, 1600, 1);
    CHECK(double(p.balance().absorbed.x) == approx(double(p.balance().emitted.x), 1e-11, 1e-3));
    CHECK(p.rays() / p.particles() > 20);
    CHECK(p.rays() / p.particles() < 100);  // expected survivors: 1 / (1 - 0.98)
}

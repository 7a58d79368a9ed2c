// path/pathtracer_test.cpp  radiance: closed forms, and agreement of all techniques
#include "path/pathtracer.h"

#include <span>

#include "base/moments.h"
#include "oracle/expect.h"
#include "path/paths.h"
#include "path/scenes.h"

namespace {

// Mean of an image over pixels, samples and channels.  Its standard error pools the variances
// within pixels: one test of the whole image detects more than a test per pixel.
oracle::Estimate image_mean(const Scene& scene, const Technique& t, uint64_t seed, uint64_t spp) {
    const SamplerSettings settings{SamplerKind::independent, seed};
    const auto pixel_mean = [&](int pixel) {
        const int x = pixel % scene.size.width, y = pixel / scene.size.width;
        Moments m;
        for (uint64_t i = 0; i < spp; ++i)
            m.add(double(mean_of(radiance(scene, t, settings, x, y, i))));
        return m;
    };
    double sum = 0, squares = 0;
    for (const Moments& m : side_by_side(scene.size.width * scene.size.height, pixel_mean)) {
        sum += m.mean;
        squares += sqr(m.standard_error());
    }
    const double pixels = double(scene.size.width) * scene.size.height;
    oracle::Estimate e;
    e.mean = sum / pixels;
    e.standard_error = std::sqrt(squares) / pixels;
    e.unit = ulp;
    return e;
}

using enum Direction;
using enum LightMode;

struct Named : Technique {
    const char* name;
};
constexpr Named techniques[] = {
    {{bsdf, none, 0}, "bsdf, none"},
    {{bsdf, mis, 0}, "bsdf, mis"},
    {{bsdf, nee, 0}, "bsdf, nee"},
    {{uniform, mis, 0}, "uniform, mis"},
    {{uniform, nee, 0}, "uniform, nee"},
    {{uniform, none, 0}, "uniform, none"},
    {{bsdf, mis, 1}, "bsdf, mis, roulette"},
    {{bsdf, nee, real(0.5)}, "bsdf, nee, roulette of the dim"},
    {{uniform, none, 1}, "uniform, none, roulette"},
};

// The decisions at a vertex: which light, the point on it, the next direction, and termination.
struct Decision {
    const Light* light;  // null below a horizon
    vec3 on_light, wi;
    bool goes_on;
    bool operator==(const Decision&) const = default;
};
std::vector<Decision> decisions(const Scene& scene, const Technique& t,
                                const SamplerSettings& settings, int x) {
    std::vector<Decision> path;
    radiance(scene, t, settings, x, 0, 5, [&](const PathState&, const VertexEvents& e) {
        path.push_back({e.direct.light, e.direct.sample.at.p, e.wi, e.end == End::no});
    });
    return path;
}

// A set of decisions that differ at a vertex.
enum Differs { of_light = 1, of_place = 2, of_direction = 4, of_end = 8 };
int difference(const Decision& a, const Decision& b) {
    const bool other_light = a.light && b.light && a.light != b.light;
    return other_light * of_light + !(a.on_light == b.on_light) * of_place +
           !(a.wi == b.wi) * of_direction + (a.goes_on != b.goes_on) * of_end;
}

// The decisions that a dimension may change at its vertex, and those that it must change sometimes.
struct Purpose {
    int may, must;
};
Purpose purpose(Dimension what, bool glossy) {
    switch (what) {
        case Dimension::which_light: return {of_light | of_place, of_light};
        case Dimension::light_x:
        case Dimension::light_y: return {of_place, of_place};
        case Dimension::lobe:
            if (!glossy) return {0, 0};
            [[fallthrough]];
        case Dimension::wi_x:
        case Dimension::wi_y: return {of_direction | (glossy ? of_end : 0), of_direction};
        default: return glossy ? Purpose{0, 0} : Purpose{of_end, of_end};
    }
}

// The reference: BSDF sampling only has no light samples that could be wrong.
oracle::Estimate by_chance(const Scene& scene, uint64_t spp) {
    return image_mean(scene, techniques[0], ~seed_here(), spp);
}

// Expects all other techniques to agree with BSDF sampling of `reference` samples per pixel.
// Techniques without light samples take twice as many samples, because their noise is heavy-tailed.
void expect_same_mean(const Scene& scene, uint64_t reference, uint64_t spp, double largest) {
    const oracle::Estimate truth = by_chance(scene, reference);
    uint64_t seed = seed_here();
    for (const Named& t : std::span(techniques).subspan(1)) {
        const uint64_t n = t.light == none ? 2 * spp : spp;
        EXPECT(oracle::expect_equal(image_mean(scene, t, seed++, n), truth).of(t.name), largest);
    }
}

bool all_different(std::vector<real> numbers) {
    std::sort(numbers.begin(), numbers.end());
    return std::adjacent_find(numbers.begin(), numbers.end()) == numbers.end();
}

}  // namespace

TEST_CASE("a furnace has the radiance Le (1 - rho^(D+1)) / (1 - rho) at every depth D") {
    Scene scene = scene_of(glowing_room);
    for (const Named& t : techniques)
        for (int depth : {0, 1, 2, 5, 20}) {
            // Light sampling only has infinite variance where emitting walls meet (1 / d^2).
            if (t.light == nee) continue;
            scene.depth = depth;
            const double truth = 0.4 * (1 - std::pow(0.5, depth + 1)) / (1 - 0.5);
            const oracle::Estimate mean =
                image_mean(scene, t, seed_here(), t.roulette > 0 ? 400 : 100);
            EXPECT(oracle::expect_mean(truth, mean).of(t.name), 0.07);
        }
}

TEST_CASE("a furnace by cosine sampling alone has no noise") {
    Scene scene = scene_of(glowing_room);
    scene.depth = 7;
    const Technique t{bsdf, none, 0};
    const real truth = real(0.4) * (1 - std::pow(real(0.5), real(8))) / real(0.5);
    const SamplerSettings settings{SamplerKind::independent, seed_here()};
    real worst = 0;
    for (uint64_t i = 0; i < 2000; ++i)
        worst = std::max(worst,
                         max_abs(radiance(scene, t, settings, 3, 2, i) - rgb{truth, truth, truth}));
    CHECK(worst < 64 * ulp);
}

TEST_CASE("balls of clear glass and of perfect mirror are invisible in a furnace") {
    const Scene scene = scene_of(R"(
size 16 16
camera 0 0.3 1.8  0 0 0  60
depth 300
diffuse half 0.5 0.5 0.5
light glow  0.4 0.4 0.4 twosided half
glass glass 1.5
mirror mirror 1 1 1
box 4 3 4  0  -2 -1.5 -2   glow
sphere -0.6 0 0  0.5  glass
sphere 0.6 0 0  0.5  mirror
)");
    const Technique t{bsdf, none, 0};
    const SamplerSettings settings{SamplerKind::independent, seed_here()};
    real worst = 0;
    for (uint64_t i = 0; i < 8; ++i)
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                const vec3 off = radiance(scene, t, settings, x, y, i) / real(0.8) - rgb{1, 1, 1};
                worst = max_abs(off) <= worst ? worst : max_abs(off);
            }
    CHECK(worst < 256 * ulp);
}

TEST_CASE("light within glass leaves it as (1 - R) L / n^2") {
    // At normal incidence R = (0.5 / 2.5)^2.
    const Scene scene = scene_of(R"(
size 1 1
camera 0 0 5  0 0 0  0.0001
depth 1
glass glass 1.5
light lamp 1 1 1
sphere 0 0 0  1  glass
sphere 0 0 0  0.5  lamp
)");
    EXPECT(oracle::expect_mean(0.96 / 2.25, image_mean(scene, techniques[1], seed_here(), 60000)),
           0.01);
}

TEST_CASE("lobe, direction and roulette draw numbers of their own: a glossy floor under a lamp") {
    const Scene scene = scene_of(R"(
size 1 1
camera 3 1.5 0  0 0 0  1
depth 1
phong floor 0.2 0.3 0.3  0.5 0.4 0.5  12
light lamp 1 1 1
quad -9 0 -9  0 0 18  18 0 0  floor
quad -1 1 -1  2 0 0  0 0 2  lamp
)");
    const oracle::Estimate reference = image_mean(scene, {uniform, none, 0}, 99, 100000);
    for (real roulette : {real(0), real(1)}) {
        const Technique t{bsdf, none, roulette};
        EXPECT(oracle::expect_equal(image_mean(scene, t, seed_here(), 100000), reference), 0.09);
    }
}

TEST_CASE("what covers part of a pixel gives that part of its radiance") {
    // The pixel covers [-1, 1]^2 at z = 0; the light covers [0.4, 1] x [-1, 0] of it: 15 %.
    const Scene scene = scene_of(R"(
size 1 1
camera 0 0 5  0 0 0  22.619864948040426
depth 0
light lamp 1 1 1
quad 0.4 -1 0  0.6 0 0  0 1 0  lamp
)");
    EXPECT(oracle::expect_mean(0.15, image_mean(scene, techniques[1], seed_here(), 40000)), 0.1);
}

TEST_CASE("every pixel has random numbers of its own, and every bounce, and every light sample") {
    Scene scene = scene_of(glowing_room);
    scene.size = {9, 5};
    const SamplerSettings settings{SamplerKind::independent, seed_here()};
    std::vector<real> across, down;
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 9; ++x) {
            const vec2 u = start(scene, settings, {x, y, 0}).u;
            across.push_back(u.x);
            down.push_back(u.y);
        }
    CHECK(all_different(across));
    CHECK(all_different(down));
    // On diffuse surfaces a cosine depends on one dimension; all vertices see the lamp.
    scene = scene_of(R"(
camera 0 0 0.5  0 0 0  60
depth 60
diffuse half 0.5 0.5 0.5
light lamp  1 1 1  half
box 2 2 2  0  -1 -1 -1   half
quad -0.1 0.9 -0.1  0.2 0 0  0 0 0.2   lamp
)");
    std::vector<real> cosines, on_the_lamp;
    radiance(scene, techniques[2], settings, 0, 0, 0, [&](const PathState&, const VertexEvents& e) {
        if (e.end == End::no) cosines.push_back(e.scattered.wi.z);
        if (e.direct.light) on_the_lamp.push_back(e.direct.sample.at.p.x);
    });
    CHECK(cosines.size() == 60);
    CHECK(all_different(cosines));
    CHECK(on_the_lamp.size() >= 10);
    CHECK(all_different(on_the_lamp));
}

TEST_CASE("every number of a path moves what it is for, and nothing else at or before its vertex") {
    // Another base changes the Halton point in that dimension only.  Diffuse paths end by roulette;
    // glossy ones have two lobes and end below the surface.
    const std::string room = R"(
size 400 1
camera 0 0.1 1.9  0 0 0  60
depth 3
light ball  1 1 1  half
light panel 1 1 1  half
box 4 4 4  0  -2 -2 -2  half
sphere -1 0.5 0  0.3  ball
quad -0.5 1.5 -0.5  1 0 0  0 0 1  panel
)";
    for (bool glossy : {false, true}) {
        const Scene scene = scene_of(
            (glossy ? "phong half 0.3 0.3 0.3  0.3 0.3 0.3  4\n" : "diffuse half 0.5 0.5 0.5\n") +
            room);
        const Technique t{bsdf, mis, real(glossy ? 0 : 1)};
        const SamplerSettings settings =
            sampler_settings(SamplerKind::halton, seed_here(), scene.depth + 1);
        for (uint32_t dim = dimension(0, Dimension(0)); dim < settings.bases.size(); ++dim) {
            const Dimension what =
                Dimension((dim - dimension(0, Dimension(0))) % uint32_t(Dimension::count));
            const size_t k = (dim - dimension(0, Dimension(0))) / uint32_t(Dimension::count);
            const bool last = int(k) == scene.depth;  // the path ends here anyway
            const auto [may, must] = last ? Purpose{0, 0} : purpose(what, glossy);
            SamplerSettings other = settings;
            other.bases[dim] = 2;  // all bases are greater than 2
            int moved = 0, wrong = 0;
            for (int x = 0; x < scene.size.width; ++x) {
                const auto a = decisions(scene, t, settings, x), b = decisions(scene, t, other, x);
                const size_t before = std::min(k, a.size());
                wrong += b.size() < before ||
                         !std::equal(a.begin(), a.begin() + long(before), b.begin());
                if (a.size() <= k || b.size() <= k) {
                    wrong += a.size() != b.size();
                    continue;
                }
                const int here = difference(a[k], b[k]);
                wrong += (here & ~may) != 0;
                const bool same_way = (here & (of_direction | of_end)) == 0;
                wrong += same_way && !std::equal(a.begin() + long(k) + 1, a.end(),
                                                 b.begin() + long(k) + 1, b.end());
                moved += (here & must) != 0;
            }
            CAPTURE(glossy);
            CAPTURE(dim);
            CHECK(wrong == 0);
            CHECK((moved > 10) == (must != 0));
        }
    }
}

TEST_CASE(
    "the weights of a light's point, aimed at and hit, add up to 1 above a vast ground, too") {
    // A ray starts 32 ulp of the ground's size above it: 7e-12 in double, 4e-3 in float.  MIS
    // weighs hits from the ground itself, as it does light samples.
    const Scene scene = scene_of(R"(
size 20 20
camera 0 2 0.1  0 0 0  60
diffuse white 0.5 0.5 0.5
light ball 1 1 1
quad -2000 0 -2000  0 0 4000  4000 0 0  white
sphere 0.3 0.5 0  0.2  ball
sphere -0.5 0.4 0.2  0.1  ball
)");
    const SamplerSettings settings{SamplerKind::independent, seed_here()};
    int hits = 0;
    real worst = 0;
    for (int i = 0; i < 800; ++i) {
        const Technique t{uniform, mis, 0};
        const int x = i / 2 % 20, y = i / 40;
        const Start at = start(scene, settings, {x, y, 0});
        const auto ground = meet(scene, at.ray);
        if (!ground || ground->material->emits()) continue;
        const DirectLight aimed = direct_light(scene, t, *ground, at.sampler, 0);
        if (!aimed.light) continue;
        const vec3 wi = ground->local.to_local(aimed.sample.wi);
        const real density = pdf(*ground->material, ground->wo, wi, t.direction);
        const PathState s{spawn(ground->at, aimed.sample.wi),
                          ground->at.p,
                          density,
                          {1, 1, 1},
                          1,
                          ground->local.n};
        const auto lamp = meet(scene, s.ray);
        if (!lamp || &scene.lights[size_t(scene.light_of[lamp->hit.id])] != aimed.light) continue;
        worst =
            std::max(worst, std::abs(aimed.weight + weight_of_emission(scene, t, s, *lamp) - 1));
        ++hits;
    }
    CHECK(hits > 400);
    CHECK(worst <= 4 * ulp);
}

TEST_CASE("a path knows the normal that it left, on its own side") {
    // Both floors face down.
    const Scene scene = scene_of(R"(
size 16 16
camera 0 2 6  0 1 0  60
depth 6
diffuse white 0.8 0.8 0.8
phong   gloss 0.2 0.2 0.2  0.6 0.6 0.6  8
light   lamp  1 1 1 twosided white
quad -9 0 -9  18 0 0  0 0 18  white
quad -9 3 9  0 0 -18  18 0 0  gloss
sphere 1 1 0  0.7  lamp
)");
    const SamplerSettings settings{SamplerKind::independent, seed_here()};
    int steps = 0, wrong = 0;
    for (int i = 0; i < 256; ++i)
        radiance(scene, {bsdf, mis, 0}, settings, i % 16, i / 16, 0,
                 [&](const PathState&, const VertexEvents& e) {
                     if (e.end != End::no) return;
                     const Surface& at = e.vertex.at;
                     ++steps;
                     wrong += !(dot(e.next.n, e.next.ray.d) > 0);
                     wrong += e.next.n != at.n && e.next.n != -at.n;
                 });
    CHECK(steps > 500);
    CHECK(wrong == 0);
}

TEST_CASE("every way to find light finds the same: unequal lights, occlusion, Phong") {
    expect_same_mean(scene_of(unequal), 400, 55, 0.08);
}

// NEE has no light samples for a caustic seen in a mirror: all three modes count light that arrives
// via mirror or glass when a path hits the light.
TEST_CASE("every way to find light finds the same: mirror, glass, glossy caustics") {
    expect_same_mean(scene_of(shiny), 300, 115, 0.08);
}

TEST_CASE("every way finds the same inside a two-sided sphere light, and by a lobe of exponent 0") {
    const Scene scene = scene_of(R"(
size 32 16
camera 0 0 5  0 0 0  20
depth 3
diffuse grey 0.6 0.6 0.6
phong lobe 0 0 0  0.9 0.9 0.9  0
glass clear 1
light shell 1 1 1 twosided clear
light lamp 5 5 5
sphere 0 0 0  2  shell
sphere -0.4 0 0  0.3  grey
sphere 0.4 0 0  0.3  lobe
sphere 0 0.9 0  0.2  lamp
)");
    expect_same_mean(scene, 100, 25, 0.015);
}

TEST_CASE(
    "a point light gives rho / pi I cos / d^2 under MIS, too, and nothing behind an obstacle") {
    const std::string text = R"(
size 1 1
camera 0 4 3  0 0 0  0.0001
depth 1
diffuse white 0.5 0.5 0.5
pointlight 1 2 0  3 3 3
quad -5 0 -5  0 0 10  10 0 0  white
)";
    const Technique t{bsdf, mis, 0};
    // At the origin: d^2 = 5, cos = 2 / sqrt 5.  The pixel is 1e-5 wide: 1e-5 relative.
    const double truth = 0.5 / double(pi) * 3 / 5 * 2 / std::sqrt(5.0);
    CHECK(double(radiance(scene_of(text), t, {SamplerKind::independent}, 0, 0, 0).x) ==
          doctest::Approx(truth).epsilon(1e-4));
    const Scene shadowed = scene_of(text + "sphere 0.5 1 0  0.1  white\n");
    CHECK(radiance(shadowed, t, {SamplerKind::independent}, 0, 0, 0).x == 0);
}

TEST_CASE("Russian roulette keeps paths at its threshold T: the rays that they have in the mean") {
    // A closed box of albedo 1/2 without light sampling.  After m bounces the throughput is T or
    // more.  The next bounce has survival probability 2^-(m+1) / T, and each later one 1/2.
    Scene scene = scene_of(glowing_room);
    scene.depth = 1000;
    const SamplerSettings settings{SamplerKind::independent, seed_here()};
    for (const auto& [threshold, mean] : {std::pair{1., 2.}, {0.7, 1 + 1 / 0.7}, {0.25, 4.}}) {
        Moments rays;
        for (uint64_t i = 0; i < 20000; ++i)
            rays.add(double(rays_of(scene, {bsdf, none, real(threshold)}, settings, 1, 1, i)));
        EXPECT(oracle::expect_mean(mean, estimate(rays)), 0.05);
    }
}

TEST_CASE("Russian roulette ends no path in clear glass, which takes nothing away") {
    Scene scene = scene_of(
        "size 8 4\ncamera 0 0 5  0 0 0  30\nglass diamond 2.4\nsphere 0 0 0  1  diamond\n");
    scene.depth = 1000;
    const SamplerSettings settings{SamplerKind::independent, seed_here()};
    int within = 0;
    for (uint64_t i = 0; i < 1000; ++i) {
        const Start at = start(scene, settings, {4, 2, i});
        Li(scene, {bsdf, none, real(0.9)}, at.ray, at.sampler,
           [&](const PathState& s, const VertexEvents& e) {
               CHECK(e.end != End::roulette);
               within += e.met && s.k > 0;
           });
    }
    CHECK(within > 1000);
}

TEST_CASE("a reflectance that is not a number reaches the film, whichever its channel") {
    Scene room = scene_of(glowing_room);
    for (auto channel : axis) {
        rgb rho;
        rho.*channel = std::numeric_limits<real>::quiet_NaN();
        for (Material& m : room.materials) m.scattering = Rough(rho);
        for (const Named& t : techniques) {
            INFO(std::string(t.name));
            int finite = 0;
            for (uint64_t i = 0; i < 100; ++i)
                finite += is_finite(radiance(room, t, {SamplerKind::independent, 1}, 4, 2, i));
            CHECK(finite == 0);
        }
    }
}

TEST_CASE("the camera's rays fill the solid angle 4 atan(p q / sqrt(1 + p^2 + q^2))") {
    const Camera camera = look_at({3, -2, 5}, {-1, 4, 2}, 50);
    const Size size{96, 40};
    const double q = double(camera.tan_half), p = q * size.width / size.height;
    // Jacobian of camera_ray by central differences, summed over 4 x 4 points per pixel.
    double sum = 0;
    const real h = real(0.125);
    for (int y = 0; y < 4 * size.height; ++y)
        for (int x = 0; x < 4 * size.width; ++x) {
            const real cx = (real(x) + real(0.5)) / 4, cy = (real(y) + real(0.5)) / 4;
            const vec3 dx =
                camera_ray(camera, size, cx + h, cy).d - camera_ray(camera, size, cx - h, cy).d;
            const vec3 dy =
                camera_ray(camera, size, cx, cy + h).d - camera_ray(camera, size, cx, cy - h).d;
            sum += double(length(cross(dx, dy)));
        }
    const double truth = 4 * std::atan(p * q / std::sqrt(1 + p * p + q * q));
    CHECK(std::abs(sum / truth - 1) < 2e-5);  // midpoint rule: (1/4 pixel)^2 / 24 of the curvature
    // Corners lie exactly on the frustum's edges; the top left is first.
    const vec3 d = camera_ray(camera, size, 0, 0).d;
    CHECK(std::abs(double(dot(d, camera.right) / dot(d, camera.forward)) + p) < 1e-5);
    CHECK(std::abs(double(dot(d, camera.up) / dot(d, camera.forward)) - q) < 1e-5);
}

TEST_CASE("quasi-random and stratified samples find what independent ones find") {
    Scene scene = scene_of(unequal);
    const Technique& t = techniques[1];
    const oracle::Estimate reference = image_mean(scene, t, ~seed_here(), 100);
    scene.size = {32, 16};
    for (SamplerKind kind : {SamplerKind::stratified, SamplerKind::halton, SamplerKind::sobol}) {
        // A replication is one randomisation of every pixel's whole point set.
        const auto replicate = [&, first = seed_here()](int k) {
            const SamplerSettings settings =
                sampler_settings(kind, first + uint64_t(k), scene.depth);
            double sum = 0;
            for (int y = 0; y < scene.size.height; ++y)
                for (int x = 0; x < scene.size.width; ++x)
                    for (uint64_t i = 0; i < 16; ++i)
                        sum += double(mean_of(radiance(scene, t, settings, x, y, i)));
            return sum / (16.0 * scene.size.width * scene.size.height);
        };
        Moments replicates;
        for (double mean : side_by_side(24, replicate)) replicates.add(mean);
        EXPECT(oracle::expect_equal(estimate(replicates, ulp), reference), 0.05);
    }
}

// pathtracer_test.cpp  radiance: closed forms, and every way to find light finds the same
#include "../src/pathtracer.cpp"

#include "expect.h"

namespace {

// Mean of an image over pixels, samples and channels.  Its standard error pools the variances
// within pixels: one test of the whole image sees what no test of a pixel would.
Estimate image_mean(const Scene& scene, const Options& o, uint64_t spp) {
    const Pattern pattern{SamplerKind::independent, o.seed};
    double sum = 0, squares = 0;
    for (int y = 0; y < scene.size.height; ++y)
        for (int x = 0; x < scene.size.width; ++x) {
            Moments m;
            for (uint64_t i = 0; i < spp; ++i)
                m.add(double(mean_of(pixel(scene, o, pattern, x, y, i).L)));
            sum += m.mean;
            squares += sqr(m.standard_error());
        }
    const double pixels = double(scene.size.width) * scene.size.height;
    Estimate e;
    e.mean = sum / pixels;
    e.standard_error = std::sqrt(squares) / pixels;
    e.unit = ulp;
    return e;
}

struct Technique {
    const char* name;
    Direction direction;
    LightMode light;
    int roulette;
};

constexpr Technique techniques[] = {
    {"bsdf, mis", Direction::bsdf, LightMode::mis, 0},
    {"bsdf, nee", Direction::bsdf, LightMode::nee, 0},
    {"bsdf, none", Direction::bsdf, LightMode::none, 0},
    {"uniform, mis", Direction::uniform, LightMode::mis, 0},
    {"uniform, nee", Direction::uniform, LightMode::nee, 0},
    {"uniform, none", Direction::uniform, LightMode::none, 0},
    {"bsdf, mis, roulette", Direction::bsdf, LightMode::mis, 1},
    {"bsdf, nee, roulette", Direction::bsdf, LightMode::nee, 2},
    {"uniform, none, roulette", Direction::uniform, LightMode::none, 1},
};

Options options(const Technique& t, uint64_t seed) {
    Options o;
    o.direction = t.direction;
    o.light = t.light;
    o.roulette = t.roulette;
    o.seed = seed;
    return o;
}

// The lines that a path's log has about `what`, of sample 0.
std::vector<std::string> logged(const Scene& scene, const Options& o, int x, int y,
                                const std::string& what) {
    std::FILE* file = std::tmpfile();
    const PathLog log(file);
    const Pattern pattern = make_pattern(o.sampler, o.seed, false, scene.depth, 64);
    pixel(scene, o, pattern, x, y, 0, &log);
    std::string text(size_t(std::ftell(file)), ' ');
    std::rewind(file);
    REQUIRE(std::fread(text.data(), 1, text.size(), file) == text.size());
    std::fclose(file);
    std::istringstream in(text);
    std::vector<std::string> found;
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(what)) found.push_back(line);
    return found;
}

bool all_different(std::vector<std::string> lines) {
    std::sort(lines.begin(), lines.end());
    return std::adjacent_find(lines.begin(), lines.end()) == lines.end();
}

Scene scene_of(const std::string& text) { return parse_scene(text, "test").scene; }

const char* const furnace = R"(
size 8 4
camera 0 0.3 1.8  0 0 0  60
diffuse half 0.5 0.5 0.5
phong   gloss 0.2 0.2 0.2  0.3 0.3 0.3  0
light glow  0.4 0.4 0.4 twosided half
box 4 3 4  0  -2 -1.5 -2   glow
sphere -0.7 0 0  0.5  glow
)";

// A light behind a wall, unequal lights, one of them a triangle and one two-sided, a Phong floor:
// where the techniques would part if a weight, a density or a visibility were wrong.
const char* const unequal = R"(
size 64 32
camera 0 1.5 6  0 0.8 0  50
depth 3
diffuse white 0.7 0.6 0.5
phong   floor 0.2 0.3 0.3  0.5 0.4 0.5  12
diffuse wall  0.5 0.5 0.5
light big     2 2 3
light small   12 9 6  white
light both    3 4 3  twosided
quad -5 0 -5   0 0 10  10 0 0   floor
quad -5 0 -3   10 0 0  0 5 0    white
sphere -1.6 1.6 0  0.8   big
sphere  1.8 0.7 0.4  0.4 small
triangle -0.5 2.6 -1  0.9 2.6 -1  0.2 2.9 0.6   both
quad 0.3 0 -1  0 0 2.5  0 1.4 0  wall
)";

// Two quad lights, one seen only through reflections; spheres of Phong, mirror and glass.
const char* const shiny = R"(
size 64 32
camera 0 1.2 6  0 0.8 0  45
depth 4
diffuse white 0.6 0.6 0.7
phong   gloss 0.1 0.2 0.1  0.7 0.6 0.7  40
phong   lobe  0 0 0  0.9 0.9 0.9  3
mirror  mirror 0.8 0.9 0.9
glass   glass 1.5
light   lamp  4 4 3
light   back  2 2.5 3  white
quad -4 0 -4   0 0 8  8 0 0    white
quad -4 0 -3   8 0 0  0 4 0    lobe
quad -1.5 3 -1.5  3 0 0  0 0 3   lamp
quad 3 0 2  0 0 -3  0 2.5 0   back
sphere -1.6 0.7 0  0.7   gloss
sphere 0 0.7 0.5  0.6   mirror
sphere 1.5 0.6 0.2  0.6   glass
)";

}  // namespace

TEST_CASE("a furnace has the radiance Le (1 - rho^(D+1)) / (1 - rho) at every depth D") {
    Scene scene = scene_of(furnace);
    for (const Technique& t : techniques)
        for (int depth : {0, 1, 2, 5, 20}) {
            // Light samples alone have infinite variance where emitting walls meet (1 / d^2).
            if (t.light == LightMode::nee) continue;
            scene.depth = depth;
            const double truth = 0.4 * (1 - std::pow(0.5, depth + 1)) / (1 - 0.5);
            const Estimate mean = image_mean(scene, options(t, seed_here()), 400);
            EXPECT(expect_mean(truth, mean).of(t.name), 0.07);
        }
}

TEST_CASE("a furnace by cosine sampling alone has no noise") {
    Scene scene = scene_of(furnace);
    scene.depth = 7;
    const Options o = options({"", Direction::bsdf, LightMode::none, 0}, seed_here());
    const real truth = real(0.4) * (1 - std::pow(real(0.5), real(8))) / real(0.5);
    const Pattern pattern{SamplerKind::independent, o.seed};
    real worst = 0;
    for (uint64_t i = 0; i < 2000; ++i)
        worst = std::max(worst,
                         max_abs(pixel(scene, o, pattern, 3, 2, i).L - rgb{truth, truth, truth}));
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
    const Options o = options({"", Direction::bsdf, LightMode::none, 0}, seed_here());
    const Pattern pattern{SamplerKind::independent, o.seed};
    real worst = 0;
    for (uint64_t i = 0; i < 20; ++i)
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                const vec3 off = pixel(scene, o, pattern, x, y, i).L / real(0.8) - rgb{1, 1, 1};
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
    const Options o = options(techniques[0], seed_here());
    EXPECT(expect_mean(0.96 / 2.25, image_mean(scene, o, 60000)), 0.01);
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
    const Technique uniform{"", Direction::uniform, LightMode::none, 0};
    const Estimate reference = image_mean(scene, options(uniform, 99), 400000);
    for (int roulette : {0, 1}) {
        const Technique t{"", Direction::bsdf, LightMode::none, roulette};
        EXPECT(expect_equal(image_mean(scene, options(t, seed_here()), 400000), reference), 0.04);
    }
}

TEST_CASE("what covers part of a pixel gives that part of its radiance") {
    // The pixel spans [-1, 1]^2 at z = 0, the light [0.4, 1] x [-1, 0] of it: 15 %.
    const Scene scene = scene_of(R"(
size 1 1
camera 0 0 5  0 0 0  22.619864948040426
depth 0
light lamp 1 1 1
quad 0.4 -1 0  0.6 0 0  0 1 0  lamp
)");
    const Options o = options(techniques[0], seed_here());
    EXPECT(expect_mean(0.15, image_mean(scene, o, 40000)), 0.1);
}

TEST_CASE("every pixel has random numbers of its own, and every bounce, and every light sample") {
    Scene scene = scene_of(furnace);
    scene.size = {9, 5};
    Options o = options(techniques[1], seed_here());
    o.sampler = SamplerKind::independent;
    std::vector<std::string> pixels;
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 9; ++x) pixels.push_back(logged(scene, o, x, y, "film:").at(0));
    CHECK(all_different(pixels));
    // Diffuse: a cosine is a function of one number; the lamp is seen by all vertices.
    scene = scene_of(R"(
camera 0 0 0.5  0 0 0  60
depth 60
diffuse half 0.5 0.5 0.5
light lamp  1 1 1  half
box 2 2 2  0  -1 -1 -1   half
quad -0.1 0.9 -0.1  0.2 0 0  0 0 0.2   lamp
)");
    const auto cosines = logged(scene, o, 0, 0, "  cosine:"),
               at = logged(scene, o, 0, 0, "    at:");
    CHECK(cosines.size() == 60);
    CHECK(all_different(cosines));
    CHECK(at.size() >= 10);
    CHECK(all_different(at));
}

TEST_CASE("every way to find light finds the same: unequal lights, occlusion, Phong") {
    const Scene scene = scene_of(unequal);
    const Estimate reference = image_mean(scene, options(techniques[0], ~seed_here()), 400);
    uint64_t seed = seed_here();
    for (const Technique& t : techniques) {
        const Estimate mean = image_mean(scene, options(t, seed++), 230);
        EXPECT(expect_equal(mean, reference).of(t.name), 0.06);
    }
}

TEST_CASE("every way to find light finds the same: mirror, glass, glossy caustics") {
    const Scene scene = scene_of(shiny);
    const Estimate reference = image_mean(scene, options(techniques[0], ~seed_here()), 400);
    uint64_t seed = seed_here();
    for (const Technique& t : techniques) {
        // Next-event estimation has no answer to a caustic seen in a mirror but the same one:
        // all three count light that arrives by way of mirror or glass when they hit it.
        // Light found by chance comes in rare large parts: more samples, or one decides the error.
        const uint64_t spp = t.light == LightMode::none ? 920 : 230;
        const Estimate mean = image_mean(scene, options(t, seed++), spp);
        EXPECT(expect_equal(mean, reference).of(t.name), 0.06);
    }
}

TEST_CASE("every way finds the same inside a two-sided sphere light, and by a lobe of exponent 0") {
    const char* const shell = R"(
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
)";
    const Scene scene = scene_of(shell);
    const Estimate reference = image_mean(scene, options(techniques[5], ~seed_here()), 1500);
    uint64_t seed = seed_here();
    for (const Technique& t : techniques) {
        const Estimate mean = image_mean(scene, options(t, seed++), 400);
        EXPECT(expect_equal(mean, reference).of(t.name), 0.03);
    }
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
    const Options o = options({"", Direction::bsdf, LightMode::mis, 0}, 1);
    // At the origin: d^2 = 5, cos = 2 / sqrt 5.  The pixel is 1e-5 wide: 1e-5 relative.
    const double truth = 0.5 / double(pi) * 3 / 5 * 2 / std::sqrt(5.0);
    CHECK(double(pixel(scene_of(text), o, {SamplerKind::independent}, 0, 0, 0).L.x) ==
          doctest::Approx(truth).epsilon(1e-4));
    const Scene shadowed = scene_of(text + "sphere 0.5 1 0  0.1  white\n");
    CHECK(pixel(shadowed, o, {SamplerKind::independent}, 0, 0, 0).L.x == 0);
}

TEST_CASE("Russian roulette shortens paths to 1 / (1 - rho) scatterings") {
    // Closed box, albedo 0.5, no light sampling: rays = 1 + survivors, a geometric sum of mean 2.
    Scene scene = scene_of(furnace);
    scene.depth = 1000;
    const Options o = options({"", Direction::bsdf, LightMode::none, 1}, seed_here());
    const Pattern pattern{SamplerKind::independent, o.seed};
    Moments rays;
    for (uint64_t i = 0; i < 100000; ++i) rays.add(double(pixel(scene, o, pattern, 1, 1, i).rays));
    EXPECT(expect_mean(2, estimate(rays)), 0.02);
}

TEST_CASE("the camera's rays fill the solid angle 4 atan(p q / sqrt(1 + p^2 + q^2))") {
    const Camera camera = look_at({3, -2, 5}, {-1, 4, 2}, 50);
    const Size size{96, 40};
    const double q = double(camera.tan_half), p = q * size.width / size.height;
    // Jacobian of camera_ray by central differences, summed over 4 x 4 points a pixel.
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
    // Corners: exactly on the frustum's edges, top left first.
    const vec3 d = camera_ray(camera, size, 0, 0).d;
    CHECK(std::abs(double(dot(d, camera.right) / dot(d, camera.forward)) + p) < 1e-5);
    CHECK(std::abs(double(dot(d, camera.up) / dot(d, camera.forward)) - q) < 1e-5);
}

TEST_CASE("what --pixel replays is what the image is made of, bit for bit") {
    Scene scene = scene_of(shiny);
    scene.size = {6, 4};
    for (SamplerKind kind :
         {SamplerKind::independent, SamplerKind::stratified, SamplerKind::halton}) {
        Options o;
        o.sampler = kind;
        o.spp = 4;
        o.quiet = true;
        const Pattern pattern = make_pattern(kind, seed_here(), false, scene.depth, o.spp);
        Film film(scene.size);
        render(scene, o, pattern, film);
        std::FILE* out = std::tmpfile();
        const PathLog log(out);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 6; ++x) {
                double even = 0, odd = 0;  // as the film adds them
                for (uint64_t i = 0; i < 4; ++i) {
                    const rgb L = pixel(scene, o, pattern, x, y, i, &log).L;
                    (i % 2 ? odd : even) += double(L.y);
                }
                CHECK(film.image().at(x, y)[1] == float((even + odd) / 4));
            }
        CHECK(std::ftell(out) > 10000);
        std::fclose(out);
    }
}

TEST_CASE("quasi-random and stratified samples find what independent ones find") {
    const Scene scene = scene_of(unequal);
    const Options o = options(techniques[0], 0);
    const Estimate reference = image_mean(scene, options(techniques[0], ~seed_here()), 400);
    for (SamplerKind kind : {SamplerKind::stratified, SamplerKind::halton}) {
        // A replicate is one randomisation of every pixel's whole point set.
        Moments replicates;
        for (uint64_t seed = 0; seed < 32; ++seed) {
            const Pattern pattern = make_pattern(kind, seed_here() + seed, false, scene.depth, 16);
            double sum = 0;
            for (int y = 0; y < scene.size.height; ++y)
                for (int x = 0; x < scene.size.width; ++x)
                    for (uint64_t i = 0; i < 16; ++i)
                        sum += double(mean_of(pixel(scene, o, pattern, x, y, i).L));
            replicates.add(sum / (16.0 * scene.size.width * scene.size.height));
        }
        EXPECT(expect_equal(estimate(replicates, ulp), reference), 0.03);
    }
}

TEST_CASE("the statistics' variance is that of the mean from seed to seed") {
    Scene scene = scene_of(unequal);
    scene.size = {24, 12};
    for (bool halves : {false, true}) {
        Options o;
        o.scene = "a \"scene\"";
        o.sampler = halves ? SamplerKind::halton : SamplerKind::independent;
        o.halves = halves;
        o.seed = seed_here();
        o.spp = 8;
        o.threads = 1;
        o.quiet = true;
        Moments means, predicted;
        for (int run = 0; run < 300; ++run, ++o.seed) {
            const Pattern pattern = make_pattern(o.sampler, o.seed, halves, scene.depth, o.spp);
            Film film(scene.size);
            render(scene, o, pattern, film);
            const Image variance = film.variance(variance_estimate(o));
            means.add(mean_of_pixels(film.image())[1]);
            predicted.add(mean_of_pixels(variance)[1] / double(variance.pixels.size()));
        }
        // A variance from 300 means is known within sqrt(2 / 299) = 8 % (normal means); 4.9 of
        // those are 40 %.
        const double ratio = means.variance() / predicted.mean;
        INFO("measured over predicted ", ratio);
        CHECK(std::abs(ratio - 1) < 4.9 * std::sqrt(2.0 / 299));
    }
}

// ---- Four estimators of direct light ------------------------------------------------------------

namespace {

constexpr Estimator direct_estimators[] = {Estimator::stochastic, Estimator::control,
                                           Estimator::ratio, Estimator::regression};

Options direct_options(Estimator e, uint64_t seed, uint64_t spp) {
    Options o;
    o.light = LightMode::nee;
    o.direct = e;
    o.sampler = SamplerKind::independent;
    o.seed = seed;
    o.spp = spp;
    o.threads = 1;
    o.quiet = true;
    return o;
}

struct Rendered {
    Image image, variance;
};
Rendered rendered(const Scene& scene, const Options& o) {
    const Pattern pattern = make_pattern(o.sampler, o.seed, o.halves, scene.depth, o.spp);
    Film film(scene.size);
    ShadowFilm shadows(o.direct, scene.size);
    if (!estimates_pixels(o.direct)) {
        render(scene, o, pattern, film);
        return {film.image(), film.variance(variance_estimate(o))};
    }
    render(scene, o, pattern, film, &shadows);
    return {shadows.added_to(film.image()), variance_of(film, shadows, variance_estimate(o))};
}

// The ground under a sphere light, a wall between them in part; every pixel sees the same point.
const char* const half_shadow = R"(
size 8 4
camera 0 6 6  0 0 0  0.001
depth 1
diffuse grey 0.5 0.25 0.75
diffuse wall 0 0 0
light lamp 3 2 1
quad -9 0 -9  0 0 18  18 0 0  grey
sphere 0 4 0  2   lamp
)";

}  // namespace

TEST_CASE("direct: every estimator finds the same image; its parts are those of a plain sample") {
    for (const char* text : {unequal, shiny}) {
        Scene scene = scene_of(text);
        scene.size = {16, 8};
        // Ratio and regression: at 64 samples their bias is some thousandths of their noise.
        Estimate reference;
        for (Estimator e : direct_estimators) {
            Moments means;
            for (uint64_t seed = 0; seed < 20; ++seed)
                means.add(mean_of_pixels(
                    rendered(scene, direct_options(e, 100 * uint64_t(e) + seed, 64)).image)[1]);
            const Estimate mean{means.mean, means.standard_error(), 19};
            if (e == Estimator::stochastic) reference = mean;
            const Verdict v = expect_equal(mean, reference);
            INFO("estimator ", int(e), ": ", v.text);
            CHECK((e == Estimator::stochastic || v.pass));
            CHECK(v.delta_min < 0.2);
        }
        const Pattern pattern{SamplerKind::independent, 5};
        for (uint64_t i = 0; i < 200; ++i) {
            const int x = int(i % 16), y = int(i % 8);
            auto L = [&](Estimator e) {
                return pixel(scene, direct_options(e, 5, 1), pattern, x, y, i);
            };
            const PathSample plain = L(Estimator::stochastic), control_ = L(Estimator::control),
                             ratio_ = L(Estimator::ratio);
            const Shadowed& s = ratio_.shadowed;
            CHECK(double(max_abs(ratio_.L + s.wV - plain.L)) < 1e-5);
            CHECK(double(max_abs(control_.L - s.U + s.w - plain.L)) < 1e-4);
            CHECK(plain.shadowed.U == rgb{});
            CHECK(plain.rays == ratio_.rays);
        }
    }
}

TEST_CASE("direct: what is fully lit or fully dark has no noise at all") {
    const Scene open = scene_of(half_shadow);
    const Scene dark = scene_of(half_shadow + std::string("quad -3 1 -3  0 0 3.9  6 0 0  wall\n"));
    for (Estimator e : direct_estimators) {
        const Image lit = rendered(open, direct_options(e, 1, 16)).image,
                    umbra = rendered(dark, direct_options(e, 1, 16)).image;
        // rho L / pi E, at 30 degrees' half-angle: E = pi sin^2.  Pixels differ by their own
        // places.
        double spread = 0;
        for (const auto& p : lit.pixels)
            spread = std::max(spread, std::abs(double(p[0]) / (0.5 * 3 * 0.25) - 1));
        INFO("estimator ", int(e));
        if (e == Estimator::stochastic)
            CHECK(spread > 1e-3);
        else
            CHECK(spread < 1e-5);
        double brightest = 0;
        for (const auto& p : umbra.pixels) brightest = std::max(brightest, double(std::abs(p[1])));
        if (e == Estimator::control)
            CHECK(brightest > 1e-3);
        else
            CHECK(brightest == 0);
    }
}

TEST_CASE("direct: the variance that a run states is that from seed to seed, for ratio by halves") {
    // A lobe, too: light beside that of the closed form.
    std::string text = half_shadow + std::string("quad -3 1 -3  0 0 6  2.9 0 0  wall\n");
    text.replace(text.find("diffuse grey 0.5 0.25 0.75"), 26,
                 "phong grey 0.5 0.25 0.75 .2 .2 .2 2");
    const Scene scene = scene_of(text);
    for (Estimator e : direct_estimators) {
        Moments values, stated;
        for (uint64_t seed = 0; seed < 60; ++seed) {
            const Rendered r = rendered(scene, direct_options(e, seed, 64));
            for (size_t i = 0; i < r.image.pixels.size(); ++i) {
                values.add(double(r.image.pixels[i][1]));
                stated.add(double(r.variance.pixels[i][1]));
            }
        }
        // 1920 values: their variance is known within 3.2 %, the mean of as many squares as well.
        const double measured = values.variance() / stated.mean;
        INFO("estimator ", int(e), ": measured over stated ", measured);
        CHECK(std::abs(measured - 1) < 4.9 * std::sqrt(2 * 2.0 / 1920));
    }
}

TEST_CASE("direct: ratio and regression do not depend on threads or passes, and are whole-pixel") {
    const Scene scene = scene_of(half_shadow + std::string("quad -3 1 -3  0 0 6  2.9 0 0  wall\n"));
    for (Estimator e : {Estimator::ratio, Estimator::regression}) {
        Options o = direct_options(e, 1, 48);
        const Image one = rendered(scene, o).image;
        o.threads = 3;
        CHECK(rendered(scene, o).image.pixels == one.pixels);
        // By hand, from the samples of one pixel.
        const Pattern pattern = make_pattern(o.sampler, o.seed, o.halves, scene.depth, o.spp);
        ShadowMoments m;
        for (uint64_t i = 0; i < 48; ++i) {
            const Shadowed s = pixel(scene, o, pattern, 2, 1, i).shadowed;
            m.add(double(s.U.z), double(s.w.z), double(s.wV.z));
        }
        CHECK(double(one.at(2, 1)[2]) == doctest::Approx(estimate(e, m)).epsilon(1e-6));
    }
}

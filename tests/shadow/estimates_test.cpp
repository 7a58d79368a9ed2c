// shadow/estimates_test.cpp  images made of estimates from all light samples of a replication
#include "app/render.h"
#include "film/spread.h"
#include "oracle/expect.h"
#include "path/scenes.h"
#include "shadow/checks.h"
#include "shadow/shadow.h"

namespace {

// A ground under a sphere light, partly covered by a wall; every pixel sees the same point.
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
const std::string in_half = half_shadow + std::string("quad -3 1 -3  0 0 6  2.9 0 0  wall\n");

const Technique nee{Direction::bsdf, LightMode::nee, 0};

// Renders as the program does, with n samples per replication.
Picture render(const Scene& scene, Estimator e, uint64_t n, uint64_t seed, uint32_t K,
               unsigned threads = 1, SamplerKind kind = SamplerKind::independent) {
    Options o;
    o.replications = K, o.spp = n * K, o.threads = threads, o.quiet = true;
    const Plan plan = plan_at_once(o, scene);
    const SamplerSettings settings = sampler_settings(kind, seed, scene.depth);
    const SampleFunction L = shadow_estimate(scene, nee, settings, e, n);
    return render(o, plan, L);
}

double mean_of(const Image& image) {
    double sum = 0;
    for (const auto& pixel : image.pixels) sum += double(pixel[1]);
    return sum / double(image.pixels.size());
}

}  // namespace

TEST_CASE("estimates: all of them find what paths find; their parts are those of a plain sample") {
    for (const char* text : {unequal, shiny}) {
        Scene scene = scene_of(text);
        scene.size = {8, 8};
        // The bias of ratio and regression at 64 samples is some thousandths of their noise.
        oracle::Estimate reference;
        for (Estimator e : estimators) {
            Moments means;
            for (uint64_t seed = 0; seed < 20; ++seed)
                means.add(mean_of(render(scene, e, 64, 100 * uint64_t(e) + seed, 1).image));
            CAPTURE(int(e));
            if (e == Estimator::stochastic)
                reference = estimate(means);
            else
                EXPECT(oracle::expect_equal(estimate(means), reference), 0.3);
        }
        const SamplerSettings settings{SamplerKind::independent, 5};
        for (uint64_t i = 0; i < 200; ++i) {
            const Start at = start(scene, settings, {int(i % 8), int(i / 8 % 8), i});
            const rgb plain = Li(scene, nee, at.ray, at.sampler);
            const ShadowSample s = shadow_Li(scene, nee, at, NoVisitor{});
            CHECK(double(max_abs(s.rest + s.first.wV - plain)) < 1e-5);
        }
    }
}

TEST_CASE("estimates: what is fully lit or fully dark has no noise at all") {
    const Scene open = scene_of(half_shadow);
    const Scene dark = scene_of(half_shadow + std::string("quad -3 1 -3  0 0 3.9  6 0 0  wall\n"));
    for (Estimator e : estimators) {
        const Image lit = render(open, e, 16, 1, 1).image, umbra = render(dark, e, 16, 1, 1).image;
        // rho L / pi E, at 30 degrees' half-angle: E = pi sin^2.  Pixels differ slightly, because
        // their points do.
        double spread = 0, brightest = 0;
        for (const auto& p : lit.pixels)
            spread = std::max(spread, std::abs(double(p[0]) / (0.5 * 3 * 0.25) - 1));
        for (const auto& p : umbra.pixels) brightest = std::max(brightest, double(std::abs(p[1])));
        INFO("estimator ", int(e));
        CHECK((spread > 1e-3) == (e == Estimator::stochastic));
        if (e != Estimator::stochastic) CHECK(spread < 1e-5);
        CHECK((brightest > 1e-3) == (e == Estimator::control));
        if (e != Estimator::control) CHECK(brightest == 0);
    }
}

TEST_CASE("estimates: the error that a run states is the spread from seed to seed") {
    // A glossy lobe adds light that the closed form omits.
    std::string text = in_half;
    text.replace(text.find("diffuse grey 0.5 0.25 0.75"), 26,
                 "phong grey 0.5 0.25 0.75 .2 .2 .2 2");
    const Scene scene = scene_of(text);
    for (Estimator e : estimators)
        for (uint32_t sets : {2u, 4u}) {
            Spread spread;
            for (uint64_t seed = 0; seed < 120; ++seed) {
                const Picture p = render(scene, e, 16, hash(seed_here(), seed), sets);
                spread.add(p.image, p.run.error.d2());
            }
            const std::string name =
                "estimator " + std::to_string(int(e)) + ", sets " + std::to_string(sets);
            EXPECT(oracle::expect_mean(1, spread.ratio()).of(name), 0.4);
        }
}

TEST_CASE("estimates do not depend on threads, and take the samples of each replication together") {
    const Scene scene = scene_of(in_half);
    constexpr uint64_t n = 48;
    for (Estimator e : estimators)
        for (SamplerKind kind : {SamplerKind::independent, SamplerKind::stratified}) {
            const Picture two = render(scene, e, n, 7, 2, 1, kind);
            CHECK(render(scene, e, n, 7, 2, 3, kind).image.pixels == two.image.pixels);
            CHECK(two.run.spp == 2 * n);
            CHECK(two.run.replications == 2);
            // A path has a camera ray, a shadow ray and a scattered ray.
            CHECK(two.run.rays == 3 * n * 2 * two.image.pixels.size());
            const SamplerSettings settings = sampler_settings(kind, 7, scene.depth);
            double sum = 0;
            for (uint32_t set : {0u, 1u}) {
                const ShadowMoments m = moments_of(n, [&, i = uint64_t(0)]() mutable {
                    const Start at = start(scene, settings, {2, 1, i++, set});
                    const Shadowed s = shadow_Li(scene, nee, at, NoVisitor{}).first;
                    return std::array{s.U.z, s.w.z, s.wV.z};
                });
                sum += estimate(e, m) / 2;
            }
            CHECK(double(two.image.at(2, 1)[2]) == doctest::Approx(sum).epsilon(1e-6));
        }
}

TEST_CASE("estimates: a sample that is not finite fails the run, and says what replays it") {
    Scene scene = scene_of(half_shadow);
    scene.lights[0].L = {real(NAN), 1, 1};
    std::string why;
    try {
        render(scene, Estimator::ratio, 3, 1, 2);
    } catch (const SystemError& e) {
        why = e.what();
    }
    CAPTURE(why);
    CHECK(why.find(" sample 0") != why.npos);
    CHECK(why.find("(replay it by penumbra --light nee --pixel ") != why.npos);
}

// app/render_test.cpp  images as options ask for them: replay, statistics, direct light
#include "app/render.h"

#include "app/replay.h"
#include "base/moments.h"
#include "oracle/expect.h"
#include "path/paths.h"
#include "path/scenes.h"

TEST_CASE("what --pixel replays is what the image is made of, bit for bit") {
    Scene scene = scene_of(shiny);
    scene.size = {6, 4};
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::stratified, SamplerKind::halton,
                             SamplerKind::sobol}) {
        Options o;
        o.sampler = kind;
        o.spp = 4;
        o.quiet = true;
        o.seed = seed_here();
        const Job job = job_of(o, scene);
        const Image image = rendered(job).image;
        std::FILE* out = std::tmpfile();
        const PathLog log(scene, out);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 6; ++x) {
                double even = 0, odd = 0;  // as the film adds them
                for (uint64_t i = 0; i < 4; ++i) {
                    const rgb L = radiance(scene, o.technique, job.pattern, x, y, i, log);
                    (i % 2 ? odd : even) += double(L.y);
                }
                CHECK(image.at(x, y)[1] == float((even + odd) / 4));
            }
        CHECK(std::ftell(out) > 10000);
        std::fclose(out);
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
            const auto [image, variance, stats] = rendered(job_of(o, scene));
            means.add(mean_of_pixels(image)[1]);
            predicted.add(stats.variance_of_mean[1]);
            CHECK(mean_of_pixels(variance)[1] / double(variance.pixels.size()) ==
                  doctest::Approx(stats.variance_of_mean[1]).epsilon(1e-6).scale(0));
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
    o.technique.light = LightMode::nee;
    o.direct = e;
    o.sampler = SamplerKind::independent;
    o.seed = seed;
    o.spp = spp;
    o.threads = 1;
    o.quiet = true;
    return o;
}

Rendered render(const Scene& scene, const Options& o) { return rendered(job_of(o, scene)); }

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
        oracle::Estimate reference;
        for (Estimator e : direct_estimators) {
            Moments means;
            for (uint64_t seed = 0; seed < 20; ++seed)
                means.add(mean_of_pixels(
                    render(scene, direct_options(e, 100 * uint64_t(e) + seed, 64)).image)[1]);
            const oracle::Estimate mean{means.mean, means.standard_error(), 19};
            if (e == Estimator::stochastic) reference = mean;
            const oracle::Verdict v = oracle::expect_equal(mean, reference);
            INFO("estimator ", int(e), ": ", v.text);
            CHECK((e == Estimator::stochastic || v.pass));
            CHECK(v.delta_min < 0.2);
        }
        const Pattern pattern{SamplerKind::independent, 5};
        for (uint64_t i = 0; i < 200; ++i) {
            const int x = int(i % 16), y = int(i % 8);
            const Start at = start(scene, pattern, {x, y, i});
            const Technique nee{Direction::bsdf, LightMode::nee};
            const rgb plain = Li(scene, nee, at.ray, at.sampler);
            auto sample = [&](Estimator e) { return shadow_Li(scene, nee, e, at, NoAccount{}); };
            const ShadowSample of_control = sample(Estimator::control),
                               of_ratio = sample(Estimator::ratio);
            const Shadowed& s = of_ratio.first;
            CHECK(double(max_abs(of_ratio.rest + s.wV - plain)) < 1e-5);
            CHECK(double(max_abs(of_control.rest - s.U + s.w - plain)) < 1e-4);
        }
    }
}

TEST_CASE("direct: what is fully lit or fully dark has no noise at all") {
    const Scene open = scene_of(half_shadow);
    const Scene dark = scene_of(half_shadow + std::string("quad -3 1 -3  0 0 3.9  6 0 0  wall\n"));
    for (Estimator e : direct_estimators) {
        const Image lit = render(open, direct_options(e, 1, 16)).image,
                    umbra = render(dark, direct_options(e, 1, 16)).image;
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
            const Rendered r = render(scene, direct_options(e, seed, 64));
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
        const Image one = render(scene, o).image;
        o.threads = 3;
        CHECK(render(scene, o).image.pixels == one.pixels);
        // By hand, from the samples of one pixel.
        const Pattern pattern = job_of(o, scene).pattern;
        ShadowMoments m;
        for (uint64_t i = 0; i < 48; ++i) {
            const Start at = start(scene, pattern, {2, 1, i});
            const Shadowed s = shadow_Li(scene, o.technique, e, at, NoAccount{}).first;
            m.add(double(s.U.z), double(s.w.z), double(s.wV.z));
        }
        CHECK(double(one.at(2, 1)[2]) == doctest::Approx(estimate(e, m)).epsilon(1e-6));
    }
}

TEST_CASE("what may be said about a variance: by samples, by halves, or nothing") {
    Options o;
    for (bool halves : {false, true}) {
        o.halves = halves;
        o.sampler = SamplerKind::independent;
        CHECK(variance_from(o) == VarianceFrom::samples);
        for (SamplerKind kind :
             {SamplerKind::stratified, SamplerKind::halton, SamplerKind::sobol}) {
            o.sampler = kind;
            CHECK(variance_from(o) == (halves ? VarianceFrom::halves : VarianceFrom::nothing));
        }
    }
}

// app/render_test.cpp  images as options ask for them: replay, statistics, direct light
#include "app/render.h"

#include <set>

#include "app/replay.h"
#include "base/moments.h"
#include "film/spread.h"
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
        o.sets = 2;
        o.quiet = true;
        o.seed = seed_here();
        const Job job = job_of(o, scene);
        const Image image = rendered(job).image;
        std::FILE* out = std::tmpfile();
        const PathLog log(scene, out);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 6; ++x) {
                double sum[2] = {};  // as the film adds them
                for (uint32_t set : {0u, 1u})
                    for (uint64_t i = 0; i < 4; ++i) {
                        const Start at = start(scene, job.pattern, {x, y, i, set});
                        sum[set] += double(Li(scene, o.technique, at.ray, at.sampler, log).y);
                    }
                CHECK(image.at(x, y)[1] == float((sum[0] / 4 + sum[1] / 4) / 2));
            }
        CHECK(std::ftell(out) > 10000);
        std::fclose(out);
    }
}

// ---- Sets of samples, and the error that they tell ----------------------------------------------

namespace {

Scene small(const char* text, Size size) {
    Scene scene = scene_of(text);
    scene.size = size;
    return scene;
}

Options quick(SamplerKind kind, uint64_t spp) {
    Options o;
    o.scene = "a \"scene\"";
    o.sampler = kind;
    o.seed = seed_here();
    o.spp = spp;
    o.threads = 1;
    o.quiet = true;
    return o;
}

// For a film, as renders take them.
auto samples_of(const Job& job) {
    return [&job](int x, int y, uint64_t i, uint32_t set) {
        uint64_t rays = 0;
        return radiance(job, start(job.scene, job.pattern, {x, y, i, set}), rays);
    };
}

}  // namespace

TEST_CASE("the stated error is the spread of images from seed to seed; sets do not move the mean") {
    const Scene scene = small(unequal, {24, 12});
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        Moments of_two;
        for (uint32_t sets : {2u, sets_by_noise}) {
            const int runs = sets == sets_by_noise ? 150 : 300;
            Options o = quick(kind, sets == sets_by_noise ? 18 : 6);
            o.sets = sets;
            Spread spread;
            Moments means, stated;
            for (int run = 0; run < runs; ++run, ++o.seed) {
                const Rendered r = rendered(job_of(o, scene));
                spread.add(r.image, r.run.error.d2());
                means.add(r.run.mean_radiance[1]);
                stated.add(r.run.error.square[1] / (24 * 12));
                const std::array<double, 3> mean = mean_of_pixels(r.image);  // of floats
                for (size_t c = 0; c < 3; ++c)
                    CHECK(std::abs(r.run.mean_radiance[c] - mean[c]) <= 0x1p-24 * mean[c]);
            }
            const std::string name =
                "sampler " + std::to_string(int(kind)) + ", sets " + std::to_string(sets);
            EXPECT(oracle::expect_mean(1, spread.ratio()).of(name), 0.5);
            // A variance from 150 means is known within sqrt(2 / 149) = 12 % (normal means), the
            // mean of what is stated far better.
            INFO(name, ": ", means.variance() / stated.mean);
            CHECK(std::abs(means.variance() / stated.mean - 1) < 4.9 * std::sqrt(2.0 / (runs - 1)));
            if (sets != sets_by_noise)
                of_two = means;
            else
                EXPECT(oracle::expect_equal(estimate(means, 0x1p-24), estimate(of_two, 0x1p-24))
                           .of(name),
                       0.05);
        }
    }
}

TEST_CASE("one set is set 0 alone, bit for bit, and all sets by noise have it among them") {
    const Scene scene = small(unequal, {24, 12});
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        Options o = quick(kind, 20);
        o.sets = 1;
        const Job job = job_of(o, scene);
        const Rendered one = rendered(job);
        CHECK(one.run.sets == 1);
        CHECK(std::isnan(one.run.error.d_rel()));
        o.sets = sets_by_noise;
        const Rendered noisy = rendered(job_of(o, scene));
        CHECK(noisy.run.sets > 1.05);
        CHECK(noisy.run.sets < 2.5);
        CHECK(noisy.run.error.d_rel() > 0);
        CHECK(noisy.run.rays > one.run.rays);
        int alike = 0, pixels = 24 * 12;
        for (int i = 0; i < pixels; ++i) {
            double sum = 0;
            for (uint64_t k = 0; k < 20; ++k)
                sum += double(radiance(scene, o.technique, job.pattern, i % 24, i / 24, k).x);
            CHECK(one.image.pixels[size_t(i)][0] == float(sum / 20));
            alike += noisy.image.pixels[size_t(i)] == one.image.pixels[size_t(i)];
        }
        CHECK(alike > pixels / 5);  // where there is little noise
        CHECK(alike < pixels - pixels / 20);
    }
}

TEST_CASE(
    "sets by noise: an image is the same whatever the threads, and however passes divide it") {
    const Scene scene = small(unequal, {24, 12});
    for (SamplerKind kind : {SamplerKind::stratified, SamplerKind::sobol}) {
        Options o = quick(kind, 48);
        const Rendered one = rendered(job_of(o, scene));
        o.threads = 3;
        const Rendered three = rendered(job_of(o, scene));
        CHECK(three.image.pixels == one.image.pixels);
        CHECK(three.run.error.d2() == one.run.error.d2());
        CHECK(three.run.error.spread == one.run.error.spread);
        CHECK(three.run.sets == one.run.sets);
        // By passes of another size: the sets are chosen after as many samples.
        const Job job = job_of(o, scene);
        Film<MeanPixel> film(scene.size);
        auto add = [&](uint64_t n) { whole_pass(film, n, samples_of(job)); };
        const uint64_t pause = job.passes.pause;
        CHECK(pause >= samples_before_sets);
        CHECK(pause % job.pattern.period() == 0);
        for (uint64_t n = 0; n < pause; n += 4) add(4);
        film.add_sets(sets_where_noise_is(film.noise(), film.size, o.seed));
        add(0);
        while (film.samples() < 48) add(1);
        CHECK(film.image().pixels == one.image.pixels);
    }
}

TEST_CASE("at fewer than 16 samples sets are chosen all the same, but not of one sample") {
    const Scene scene = small(unequal, {24, 12});
    for (uint64_t spp : {1, 2, 5}) {
        const Rendered r = rendered(job_of(quick(SamplerKind::sobol, spp), scene));
        CHECK(r.run.spp == spp);
        CHECK((r.run.sets > 1) == (spp > 1));
        CHECK(std::isnan(r.run.error.d_rel()) == (spp == 1));
        CHECK(first_non_finite(r.image) == std::nullopt);
    }
}

TEST_CASE("an image without noise has an error of 0, and one set, which another one measures") {
    const Scene scene = scene_of(R"(
size 8 4
camera 0 0 0  0 0 -1  60
diffuse half 0.5 0.5 0.5
box 4 4 4  0  -2 -2 -2  half
)");
    Options o = quick(SamplerKind::sobol, 32);
    o.view = View::albedo;
    const Rendered r = rendered(job_of(o, scene));
    CHECK(r.image.at(3, 2) == std::array<float, 3>{0.5f, 0.5f, 0.5f});
    CHECK(r.run.error.d_rel() == 0);
    CHECK(r.run.error.standard_error() == 0);
    CHECK(r.run.sets == 2);  // of 32 pixels all are measured
}

// ---- Until the error is small enough ------------------------------------------------------------

TEST_CASE("--error: an image ends once its stated error is small enough, and says what ended it") {
    const Scene scene = small(unequal, {24, 12});
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::stratified, SamplerKind::sobol})
        for (double E : {0.5, 0.1, 0.04}) {
            Options o = quick(kind, 0);
            o.error = E;
            const Rendered r = rendered(job_of(o, scene));
            CAPTURE(int(kind));
            CAPTURE(E);
            CHECK(r.run.stopped_by == "error");
            CHECK(r.run.error.d_rel() <= E);
            CHECK(r.run.error.d_rel() + r.run.error.standard_error() / 2 <= E);
            CHECK(r.run.spp >= samples_before_sets);
            CHECK(r.run.spp % job_of(o, scene).pattern.period() == 0);
            // No more than it costs: at the last look but one it was larger.
            if (r.run.spp > samples_before_sets) CHECK(r.run.error.d_rel() > E / 3);
            // The number of samples follows from options and seed, not from time or threads.
            o.threads = 3;
            const Rendered again = rendered(job_of(o, scene));
            CHECK(again.run.spp == r.run.spp);
            CHECK(again.image.pixels == r.image.pixels);
            // As an image of as many samples that were asked for.
            o.error = 0, o.spp = r.run.spp;
            if (kind != SamplerKind::stratified)  // its grids follow from --spp
                CHECK(rendered(job_of(o, scene)).image.pixels == r.image.pixels);
        }
}

TEST_CASE("--error with limits: whichever comes first ends the image, and is said") {
    const Scene scene = small(unequal, {24, 12});
    Options o = quick(SamplerKind::sobol, 40);
    CHECK(rendered(job_of(o, scene)).run.stopped_by == "samples");
    o.error = 1e-6;
    const Rendered samples = rendered(job_of(o, scene));
    CHECK(samples.run.stopped_by == "samples");
    CHECK(samples.run.spp == 40);
    CHECK(samples.run.error.d_rel() > 1e-6);
    o.spp = 8;  // before the first look
    o.error = 0.9;
    CHECK(rendered(job_of(o, scene)).run.stopped_by == "samples");
    o.spp = 1 << 20, o.error = 0.3, o.seconds = 1e6;
    const Rendered error = rendered(job_of(o, scene));
    CHECK(error.run.stopped_by == "error");
    CHECK(error.run.spp < 100);
    o.error = 1e-6, o.seconds = 0.05;
    const Rendered time = rendered(job_of(o, scene));
    CHECK(time.run.stopped_by == "time");
    CHECK(time.run.spp < 1 << 20);
}

TEST_CASE("--error ends an image at the first look that finds its error small enough") {
    // By the rule itself, applied to a film of each number of samples at which it is looked at.
    const Scene scene = small(unequal, {24, 12});
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::stratified}) {
        Options o = quick(kind, 0);
        o.error = 0.03;
        const Job job = job_of(o, scene);
        const Rendered r = rendered(job);
        const uint64_t pause = job.passes.pause, period = job.passes.period;
        Film<MeanPixel> film(scene.size);
        whole_pass(film, pause, samples_of(job));
        film.add_sets(sets_where_noise_is(film.noise(), film.size, o.seed));
        whole_pass(film, 0, samples_of(job));
        std::vector<uint64_t> looks = {pause};
        while (!is_small_enough(error_of(film), o.error) && looks.back() < 10000) {
            looks.push_back(next_look(looks.back(), pause, period));
            whole_pass(film, looks.back() - film.samples(), samples_of(job));
        }
        CAPTURE(int(kind));
        CHECK(r.run.spp == looks.back());
        CHECK(r.run.error.d_rel() == error_of(film).d_rel());
        CHECK(r.image.pixels == film.image().pixels);
        CHECK(looks.size() >= 3);
    }
}

TEST_CASE("--error looks when it would look anyway, and not after every pass") {
    // Two sets whose means agree after 33 samples, and again after 36: looks are at 32, 34, 36.
    // Passes that take a fifth of a second shrink, those that take a tenth stay: one sample each.
    const Scene scene = small(unequal, {4, 3});
    Options o = quick(SamplerKind::independent, 100);
    o.error = 1e-6, o.sets = 2;
    const Job of_options = job_of(o, scene);
    Passes passes = of_options.passes;
    passes.pause = 32;
    const Job job{o, scene, of_options.pattern, passes, of_options.part};
    std::set<uint64_t> begun;
    const Rendered r = fill<MeanPixel>(job, {}, {}, [&] {
        return [&, slow = true](const PixelSample& s, uint64_t&) mutable {
            const bool first_of_pass = slow && s.x == 0 && s.y == 0;
            slow = false;
            if (first_of_pass) begun.insert(s.i);
            if (first_of_pass && s.i >= 7)
                std::this_thread::sleep_for(std::chrono::milliseconds(s.i < 21 ? 210 : 110));
            const real off = s.i == 0 || s.i == 33 ? 1 : s.i == 32 || s.i == 35 ? -1 : 0;
            return rgb{1, 1, 1} + real(s.set) * off * rgb{1, 1, 1};
        };
    });
    CHECK(begun.count(33));
    CHECK(r.run.spp == 36);
    CHECK(r.run.stopped_by == "error");
}

TEST_CASE(
    "a limit is no plan: grids and maps of an image that its error ends are no larger for it") {
    Scene scene = small(unequal, {24, 12});
    scene.samples = 64;
    Options o = quick(SamplerKind::stratified, 65536);
    CHECK(job_of(o, scene).pattern.period() == 256);
    o.error = 0.1;
    CHECK(job_of(o, scene).pattern.period() == 16);
    o.indirect = Indirect::map;
    CHECK(walks_of(o, scene).particles == 24 * 12 * 64 / 16);
    o.spp = 32;
    CHECK(walks_of(o, scene).particles == 24 * 12 * 32 / 16);
    o.error = 0, o.spp = 65536;
    CHECK(walks_of(o, scene).particles == 24 * 12 * 65536 / 16);
}

TEST_CASE("of a black image no error is known: light may have been missed, if there is any") {
    const Scene scene =
        small("camera 0 0 5  0 0 0  40\ndiffuse m .5 .5 .5\nsphere 0 0 0 1 m\n", {9, 9});
    Options o = quick(SamplerKind::sobol, 0);
    o.error = 0.01;
    const Rendered black = rendered(job_of(o, scene));
    CHECK(black.run.stopped_by == "error");  // without lights it stays black
    CHECK(black.run.spp == 16);
    CHECK(std::isnan(black.run.error.d_rel()));
    Options normals = o;  // a view is not dark without lights
    normals.view = View::normal;
    const Rendered view = rendered(job_of(normals, scene));
    CHECK(view.run.stopped_by == "error");
    CHECK(view.run.spp > 16);
    CHECK(view.run.error.d_rel() < 0.01);
    const Scene turned = small(
        "camera 0 0 5  0 0 0  40\nlight l 1 1 1\n"
        "quad -1 -1 0  0 2 0  2 0 0  l\n",
        {9, 9});
    o.spp = 40;
    const Rendered unlit = rendered(job_of(o, turned));
    CHECK(unlit.run.stopped_by == "samples");
    CHECK(unlit.run.error.norm == 0);
    CHECK(std::isnan(unlit.run.error.d_rel()));
    o.error = 0, o.spp = 16, o.sets = 1;
    CHECK(std::isnan(rendered(job_of(o, scene)).run.error.d_rel()));
    o.sampler = SamplerKind::halton_naive, o.sets = sets_by_noise;
    CHECK(std::isnan(rendered(job_of(o, scene)).run.error.d_rel()));
}

TEST_CASE("an interrupted image says so; its error is known if its sets were complete") {
    const Scene scene = small(unequal, {24, 12});
    Options o = quick(SamplerKind::sobol, 1 << 20);
    o.error = 1e-6;
    std::jthread user([] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        interrupted = SIGINT;
    });
    const Rendered r = rendered(job_of(o, scene));
    user.join();
    interrupted = 0;
    CHECK(r.run.interrupted);
    CHECK(r.run.stopped_by == "interrupt");
    REQUIRE(r.run.spp > 0);
    // The same number of samples, asked for, gives the same image.
    if (r.run.sets > 1 && std::isfinite(r.run.error.d_rel())) {
        o.error = 0, o.spp = r.run.spp;
        CHECK(rendered(job_of(o, scene)).image.pixels == r.image.pixels);
    }
}

// ---- Ctrl-C inside a path -----------------------------------------------------------------------

namespace {

// Paths that end after 10^6 mirrors alone.
const char* const mirrors = R"(
size 1 1
camera 0 0 5  0 0 0  40
depth 1000000
mirror m 1 1 1
box 20 20 20  7  -10 -10 -10  m
)";

}  // namespace

TEST_CASE("a path is left at once: after Ctrl-C it takes no further step") {
    const Scene scene = scene_of(mirrors);
    const Pattern pattern{SamplerKind::independent, seed_here()};
    const Start at = start(scene, pattern, {0, 0, 0, 0});
    uint64_t rays = 0;
    int steps = 0;
    auto count = counting(rays);
    CHECK_THROWS_AS(Li(scene, {}, at.ray, at.sampler,
                       [&](const Segment& segment, const Step& e) {
                           if (++steps == 1000) interrupted = SIGINT;
                           count(segment, e);
                       }),
                    Interrupted);
    interrupted = 0;
    CHECK(steps == 1000);
    CHECK(rays == 999);
}

TEST_CASE("samples whose path was left do not count: neither they nor their rays") {
    const Scene scene = scene_of(mirrors);
    for (Estimator e : {Estimator::stochastic, Estimator::control, Estimator::ratio}) {
        Options o = quick(SamplerKind::independent, 1);
        o.technique.light = LightMode::nee;
        o.direct = e, o.sets = 1;
        const uint64_t of_sample = rendered(job_of(o, scene)).run.rays;
        CHECK(of_sample > 1000000);
        o.spp = 1 << 20;
        std::jthread user([] {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            interrupted = SIGINT;
        });
        const RunStats run = rendered(job_of(o, scene)).run;
        user.join();
        interrupted = 0;
        CAPTURE(int(e));
        CHECK(run.interrupted);
        CHECK(run.rays == run.spp * of_sample);
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

Options one_set(Options o) {
    o.sets = 1;
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
                    render(scene, one_set(direct_options(e, 100 * uint64_t(e) + seed, 64)))
                        .image)[1]);
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

TEST_CASE("direct: the error that a run states is the spread from seed to seed, for ratio, too") {
    // A lobe, too: light beside that of the closed form.
    std::string text = half_shadow + std::string("quad -3 1 -3  0 0 6  2.9 0 0  wall\n");
    text.replace(text.find("diffuse grey 0.5 0.25 0.75"), 26,
                 "phong grey 0.5 0.25 0.75 .2 .2 .2 2");
    const Scene scene = scene_of(text);
    for (Estimator e : direct_estimators)
        for (uint32_t sets : {2u, sets_by_noise}) {
            Spread spread;
            for (uint64_t seed = 0; seed < 120; ++seed) {
                Options o = direct_options(e, hash(seed_here(), seed), 32);
                o.sets = sets;
                const Rendered r = render(scene, o);
                spread.add(r.image, r.run.error.d2());
            }
            const std::string name =
                "estimator " + std::to_string(int(e)) + ", sets " + std::to_string(sets);
            EXPECT(oracle::expect_mean(1, spread.ratio()).of(name), 0.4);
        }
}

TEST_CASE("--view variance is that of the image of as many sets, a pixel at a time") {
    std::string text = half_shadow + std::string("quad -3 1 -3  0 0 6  2.9 0 0  wall\n");
    const Scene scene = scene_of(text);
    for (Estimator e : {Estimator::stochastic, Estimator::ratio}) {
        Moments values, stated;  // every pixel sees the same point
        for (uint64_t seed = 0; seed < 60; ++seed) {
            Options o = direct_options(e, hash(seed_here(), seed), 32);
            o.sets = 2;
            const Rendered r = render(scene, o);
            o.view = View::variance, o.sets = sets_by_noise;
            const Rendered v = render(scene, o);
            CHECK(v.run.error.d2() == r.run.error.d2());
            for (size_t i = 0; i < r.image.pixels.size(); ++i) {
                values.add(double(r.image.pixels[i][1]));
                stated.add(double(v.image.pixels[i][1]));
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
        const Image noisy = render(scene, o).image;
        o.threads = 3;
        CHECK(render(scene, o).image.pixels == noisy.pixels);
        o.sets = 1;
        const Image one = render(scene, o).image;
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

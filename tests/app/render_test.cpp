// app/render_test.cpp  images as requested by options: samples, error, time, rows, replay
#include "app/render.h"

#include "app/replay.h"
#include "base/cases.h"
#include "base/complaint.h"
#include "film/spread.h"
#include "oracle/expect.h"
#include "path/samplers.h"
#include "path/scenes.h"

namespace {

Scene small(const char* text, Size size) {
    Scene scene = scene_of(text);
    scene.size = size;
    return scene;
}

Options quick(SamplerKind kind, uint64_t spp) {
    Options o;
    o.scene = "a.scene";
    o.sampler = kind;
    o.seed = seed_here();
    o.spp = spp;
    o.threads = 1;
    o.quiet = true;
    return o;
}

struct Work {
    Plan plan;
    Pattern pattern;

    Work(const Options& o, const Scene& scene)
        : plan(plan_of(o, scene)),
          pattern(make_pattern(o.sampler, o.seed, scene.depth, plan.known_samples())) {
        plan.period = pattern.period();
    }
    Radiance radiance(const Options& o, const Scene& scene) const {
        return [&, t = o.technique](const PixelSample& s, Tally& tally) {
            const Start at = start(scene, pattern, s);
            return Li(scene, t, at.ray, at.sampler, [&](const Segment&, const Step& e) {
                tally.rays += 1 + (e.direct.light != nullptr);
            });
        };
    }
};

Picture rendered(const Options& o, const Scene& scene) {
    const Work j(o, scene);
    return render(o, j.plan, j.radiance(o, scene));
}

const Scene& unequal_picture() {
    static const Scene scene = small(unequal, {24, 12});
    return scene;
}
// The picture has direct light only: half the noise and a fourth of the work.
const Scene& direct_picture() {
    static const Scene scene = [] {
        Scene s = small(unequal, {16, 8});
        s.depth = 1;
        return s;
    }();
    return scene;
}

}  // namespace

TEST_CASE("a plan is what options and scene ask for") {
    Scene scene = unequal_picture();
    scene.samples = 7;
    Options o = quick(SamplerKind::sobol, 0);
    auto target = [&] {
        const Plan plan = plan_of(o, scene);
        return said(plan.target.samples, plan.target.seconds, plan.target.error);
    };
    auto picture = [&] {
        const Plan plan = plan_of(o, scene);
        return said(plan.size.width, plan.size.height, plan.first_row, plan.sets);
    };
    CHECK(target() == "4 0 0");  // the scene's
    CHECK(picture() == "24 12 0 0");
    o.seconds = 3;
    CHECK(target() == "0 3 0");
    o.seconds = 0, o.error = 0.1;
    CHECK(target() == "0 0 0.1");
    o.spp = 9;
    CHECK(target() == "5 0 0.1");
    CHECK(plan_of(o, scene).known_samples() == 0);  // the error may end it earlier
    o.error = 0;
    CHECK(plan_of(o, scene).known_samples() == 5);
    o.sets = 4, o.rows = {3, 6};
    CHECK(target() == "3 0 0");
    CHECK(picture() == "24 4 3 4");
    for (uint32_t sets : {0u, 1u, 2u}) {
        o.spp = 1, o.sets = sets;
        CHECK(plan_of(o, scene).sets == std::max(1u, sets));  // one sample makes one replication
        o.spp = 2;
        CHECK(plan_of(o, scene).sets == sets);
    }
    // Few pixels have 8 replications, unless the user wants others; a band is as its picture.
    o = quick(SamplerKind::sobol, 64);
    o.rows = {1, 1};
    scene.size = {3, 5};
    CHECK(picture() == "3 1 1 8");
    CHECK(target() == "8 0 0");
    scene.size = {4, 4};
    CHECK(picture() == "4 1 1 0");
    scene.size = {3, 5}, o.sets = 2;
    CHECK(picture() == "3 1 1 2");
    // No more replications than samples; as many as are needed where no number is asked for.
    o.sets = 0;
    for (uint64_t spp : {1u, 2u, 3u, 7u, 8u}) {
        o.spp = spp;
        CHECK(picture() == said(3, 1, 1, spp));
        CHECK(target() == "1 0 0");
    }
    o.spp = 9;
    CHECK(picture() == "3 1 1 8");
    o.spp = 0, o.error = 0.1;
    CHECK(picture() == "3 1 1 8");
    CHECK(rendered(quick(SamplerKind::sobol, 2), small(unequal, {2, 2})).run.spp == 2);
}

TEST_CASE(
    "a scene without light needs no error to be black; where light was missed, none is known") {
    const Scene dark =
        small("camera 0 0 5  0 0 0  40\ndiffuse m .5 .5 .5\nsphere 0 0 0 1 m\n", {9, 9});
    Options o = quick(SamplerKind::sobol, 0);
    o.error = 0.1;
    CHECK(plan_of(o, dark).target.error == 0);
    CHECK(plan_of(o, dark).target.samples == dark.samples / 2);
    const Scene turned =
        small("camera 0 0 5  0 0 0  40\nlight l 1 1 1\nquad -1 -1 0  0 2 0  2 0 0  l\n", {9, 9});
    o.spp = 40;
    for (const Scene& scene : {dark, turned}) {
        const Run run = rendered(o, scene).run;
        CHECK(run.stopped_by == "samples");
        CHECK(run.error.norm == 0);
        CHECK(std::isnan(run.error.d_rel()));
    }
}

TEST_CASE("what --pixel replays is what the image is made of, bit for bit") {
    const Scene scene = small(shiny, {6, 4});
    for (SamplerKind kind : samplers) {
        Options o = quick(kind, 8);
        o.sets = 2;
        const Image image = rendered(o, scene).image;
        const Pattern pattern = Work(o, scene).pattern;
        std::FILE* out = std::tmpfile();
        const PathLog log(scene, out);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 6; ++x) {
                double sum[2] = {};  // in the film's order of addition
                for (uint32_t set : {0u, 1u})
                    for (uint64_t i = 0; i < 4; ++i) {
                        const Start at = start(scene, pattern, {x, y, i, set});
                        sum[set] += double(Li(scene, o.technique, at.ray, at.sampler, log).y);
                    }
                CHECK(image.at(x, y)[1] == float((sum[0] / 4 + sum[1] / 4) / 2));
            }
        CHECK(std::ftell(out) > 10000);
        std::fclose(out);
    }
}

TEST_CASE("images of few samples: one has no error, two and three have two replications") {
    const Scene& scene = unequal_picture();
    for (uint64_t spp : {1, 2, 3, 4}) {
        const Picture p = rendered(quick(SamplerKind::sobol, spp), scene);
        CAPTURE(spp);
        CHECK(first_non_finite(p.image) == std::nullopt);
        CHECK(std::isnan(p.run.error.d_rel()) == (spp == 1));
        if (spp < 3)
            CHECK(said(p.run.spp, p.run.sets) == said(spp, spp));
        else
            CHECK(p.run.sets > 2);
        CHECK((spp < 3 || p.run.spp == 2 * p.run.sets));
        CHECK(p.run.stopped_by == "samples");
        CHECK(p.run.rays > 0);
    }
    for (uint32_t sets : {1u, 2u, 5u}) {
        Options o = quick(SamplerKind::halton, 3);
        o.sets = sets;
        const Picture p = rendered(o, scene);
        CHECK(p.run.sets == sets);
        CHECK(p.run.spp == (sets == 1 ? 3 : sets == 2 ? 4 : 5));
        CHECK(std::isnan(p.run.error.d_rel()) == (sets == 1));
    }
}

TEST_CASE("the stated error is the spread from seed to seed; replications do not move the mean") {
    const Scene& scene = direct_picture();
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        Moments of_two;
        for (uint32_t sets : {2u, 0u}) {
            const int runs = sets ? 300 : 150;
            Options o = quick(kind, sets ? 12 : 36);
            o.sets = sets;
            Spread spread;
            Moments means, stated;
            for (int run = 0; run < runs; ++run, ++o.seed) {
                const Picture p = rendered(o, scene);
                spread.add(p.image, p.run.error.d2());
                means.add(p.run.error.mean[1]);
                stated.add(p.run.error.square[1] / (16 * 8));
            }
            const std::string name =
                "sampler " + std::to_string(int(kind)) + ", sets " + std::to_string(sets);
            // The check detects half or twice the right value.
            EXPECT(oracle::expect_mean(1, spread.ratio()).of(name), 0.7);
            // The variance of 150 means has a standard error of sqrt(2 / 149) = 12 % (normal
            // means); that of the mean estimate is far smaller.
            INFO(name, ": ", means.variance() / stated.mean);
            CHECK(std::abs(means.variance() / stated.mean - 1) < 4.9 * std::sqrt(2.0 / (runs - 1)));
            if (sets)
                of_two = means;
            else
                EXPECT(oracle::expect_equal(estimate(means), estimate(of_two)).of(name), 0.05);
        }
    }
}

TEST_CASE(
    "one replication is the first alone; rows are those of the picture; threads do not matter") {
    const Scene& scene = unequal_picture();
    for (SamplerKind kind : samplers)
        for (uint32_t sets : {0u, 1u, 3u}) {
            Options o = quick(kind, 36);
            o.sets = sets;
            const Picture one = rendered(o, scene);
            o.threads = 3;
            const Picture three = rendered(o, scene);
            CHECK(three.image.pixels == one.image.pixels);
            if (sets != 1) CHECK(three.run.error.d2() == one.run.error.d2());
            if (sets != 1) CHECK(three.run.error.spread == one.run.error.spread);
            CHECK(three.run.sets == one.run.sets);
            CHECK(three.run.rays == one.run.rays);
            o.rows = {3, 6};
            const Picture band = rendered(o, scene);
            CHECK(band.image.height == 4);
            if (sets > 0)
                CHECK(std::equal(band.image.pixels.begin(), band.image.pixels.end(),
                                 one.image.pixels.begin() + 3 * 24));
            if (sets != 1) continue;
            o = quick(kind, 36);
            o.sets = 1;
            const Pattern pattern = Work(o, scene).pattern;
            for (int i : {0, 100, 287}) {
                double sum = 0;
                for (uint64_t k = 0; k < 36; ++k) {
                    const Start at = start(scene, pattern, {i % 24, i / 24, k});
                    sum += double(Li(scene, o.technique, at.ray, at.sampler).x);
                }
                CHECK(one.image.pixels[size_t(i)][0] == float(sum / 36));
            }
        }
}

TEST_CASE("--error: an image ends at the first check that finds its error small enough") {
    const Scene& scene = unequal_picture();
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::stratified, SamplerKind::sobol})
        for (double E : {0.6, 0.1, 0.04}) {
            Options o = quick(kind, 0);
            o.error = E;
            const Picture p = rendered(o, scene);
            INFO("sampler ", int(kind), ", E = ", E);
            CHECK(p.run.stopped_by == "error");
            // The reference applies the rule to a film at every number of samples with a check.
            const Work j(o, scene);
            const uint64_t period = j.pattern.period(), first = (8 + period - 1) / period * period;
            const Radiance L = j.radiance(o, scene);
            Film film = make_film(scene.size, 0);
            fill(film, Plan{j.plan.target, period}.pilot(), L);
            choose_sets(film, INFINITY);
            uint64_t checks = 0;
            do {
                fill(film, next_check(film.least_taken(), first, period), L);
                ++checks;
            } while (!is_small_enough(error_of(film), E));
            CHECK(p.run.spp == film.total() / 288);
            CHECK(p.image.pixels == image_of(film).pixels);
            CHECK(p.run.error.d_rel() == error_of(film).d_rel());
            CHECK((checks > 3 || E > 0.05 || period > 1));
            // The number of samples depends on options and seed, not on time or threads.
            o.threads = 3;
            CHECK(rendered(o, scene).image.pixels == p.image.pixels);
        }
}

TEST_CASE("--error: pictures of a few pixels reach theirs, with noise or without") {
    // The lamp is out of view; the wall behind the point light does not shade the floor.
    const std::string room =
        "camera 2 1 0  0 0 0  40\ndiffuse m .8 .8 .8\nlight l 5 5 5\n"
        "quad -9 0 -9  0 0 18  18 0 0  m\nquad -9 3.001 -9  18 0 0  0 0 18  m\n";
    const std::string noisy = room + "depth 2\nquad 4 .5 4  0 1 0  1 0 0  l\n",
                      smooth = room + "depth 1\npointlight 0 3 0  10 10 10\n";
    for (const Size size : {Size{1, 1}, Size{2, 1}, Size{3, 2}, Size{3, 5}})
        for (uint64_t r = 0; r < 10; ++r) {
            Options o = quick(SamplerKind::sobol, 1 << 20);
            o.seed += r, o.error = 0.05;
            INFO(size.width, "x", size.height, ", seed ", o.seed);
            const Run run = rendered(o, small(noisy.c_str(), size)).run;
            CHECK(run.doubt == "");
            CHECK(run.stopped_by == "error");
        }
    Scene point = small(smooth.c_str(), {1, 1});
    point.camera.tan_half = real(1e-3);
    for (const uint32_t sets : {0u, 2u}) {
        Options o = quick(SamplerKind::sobol, 4000);
        o.sets = sets, o.error = 0.01;
        const Run run = rendered(o, point).run;
        CHECK(run.error.d2() > 0);
        CHECK(run.error.d_rel() < 1e-6);
        CHECK(run.stopped_by == "error");
        CHECK(run.spp == 8 * run.sets);  // by the first check
    }
}

TEST_CASE("--error with limits: whichever comes first ends the image, and is said") {
    const Scene& scene = unequal_picture();
    Options o = quick(SamplerKind::sobol, 40);
    CHECK(rendered(o, scene).run.stopped_by == "samples");
    o.error = 1e-6;
    const Picture samples = rendered(o, scene);
    CHECK(samples.run.stopped_by == "samples");
    CHECK(samples.run.spp == doctest::Approx(20 * samples.run.sets));
    CHECK(samples.run.error.d_rel() > 1e-6);
    o.spp = 8, o.error = 0.9;  // before the first check
    CHECK(rendered(o, scene).run.stopped_by == "samples");
    o.spp = 1 << 20, o.error = 0.3, o.seconds = 1e6;
    const Picture error = rendered(o, scene);
    CHECK(error.run.stopped_by == "error");
    CHECK(error.run.spp < 200);
    o.error = 1e-6, o.seconds = 0.05;
    const Picture time = rendered(o, scene);
    CHECK(time.run.stopped_by == "time");
    CHECK(time.run.spp < 1 << 20);
    CHECK(time.run.seconds >= 0.05);
    CHECK(time.run.seconds < 5);
    o.spp = 0, o.seconds = 1e-9;
    CHECK(rendered(o, scene).run.stopped_by == "time");  // in the pilot
}

TEST_CASE("what half the error costs follows from its course, of samples that end as they do") {
    const Scene& scene = direct_picture();
    auto exponent = [&](SamplerKind kind) {
        Moments exponents;
        Options o = quick(kind, 256);
        for (int run = 0; run < 16; ++run, ++o.seed) {
            exponents.add(rendered(o, scene).run.exponent_of_cost);
            CHECK(exponents.mean >= 1);
            CHECK(exponents.mean <= 2);
        }
        return exponents.mean;
    };
    CHECK(exponent(SamplerKind::independent) > 1.5);
    CHECK(exponent(SamplerKind::sobol) < 1.65);
}

TEST_CASE("an interrupted image says so, and is of the samples that it has") {
    const Scene& scene = unequal_picture();
    Options o = quick(SamplerKind::sobol, 1 << 20);
    o.error = 1e-6;
    std::thread user([] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        interrupted = SIGINT;
    });
    const Picture p = rendered(o, scene);
    user.join();
    interrupted = 0;
    CHECK(p.run.interrupted);
    CHECK(p.run.stopped_by == "interrupt");
    CHECK(p.run.spp > 0);
    CHECK(first_non_finite(p.image) == std::nullopt);
    // Ctrl-C in the first pass leaves pixels without samples: no image can be written.
    uint64_t calls = 0;
    const Radiance L = [&](const PixelSample&, Tally&) {
        if (++calls == 100) interrupted = SIGINT;
        return rgb{1, 1, 1};
    };
    const Picture none = render(o, plan_of(o, scene), L);
    interrupted = 0;
    CHECK(none.run.spp == 0);
    CHECK(none.run.interrupted);
    // Ctrl-C comes just after the pilot, when most pixels have only its samples.
    const Radiance others = [](const PixelSample& s, Tally&) {
        if (s.set > 0) interrupted = SIGINT;
        return rgb{1, 1, 1};
    };
    const Picture pilot = render(o, plan_of(o, scene), others);
    interrupted = 0;
    CHECK(pilot.run.spp >= double(pilot_samples));
    CHECK(first_non_finite(pilot.image) == std::nullopt);
}

TEST_CASE("a sample that is not finite is an error that tells how to replay it") {
    auto why = [](PixelSample bad, const Plan& plan) {
        return complaint<SystemError>([&] {
            render(quick(SamplerKind::independent, 0), plan, [&](const PixelSample& s, Tally&) {
                const bool is = s.x == bad.x && s.y == bad.y && s.i >= bad.i && s.set == bad.set;
                return rgb{1, is ? real(NAN) : 1, 1};
            });
        });
    };
    Plan plan{{3}, 1, 1, INFINITY, {8, 4}};
    plan.sets = 2;
    CHECK(why({7, 2, 1, 0}, plan)
              .starts_with("2 samples were not finite, the first at pixel 7,2 "
                           "sample 1 (replay it by --pixel 7,2 --sample 1)"));
    CHECK(why({7, 2, 2, 1}, plan)
              .starts_with("1 sample was not finite, the first at pixel 7,2 "
                           "sample 2,1 (replay it by --pixel 7,2 --sample 2,1)"));
    plan.first_row = 10;
    CHECK(why({0, 13, 0, 0}, plan).find("--pixel 0,13 --sample 0)") != std::string::npos);
}

TEST_CASE("a film that the machine does not hold is refused before it is made") {
    const Options o = quick(SamplerKind::sobol, 4);
    // A thousand bytes per pixel suffice for two replications of each, not for 1024.
    const Size size{1 << 14, int(bytes_of_machine() / 1000 / (1 << 14))};
    Plan plan{{4}, 1, 1, bytes_of_machine(), size};
    plan.sets = 1024;
    const Radiance L = [](const PixelSample&, Tally&) { return rgb{}; };
    auto refused = [&] { return complaint<UserError>([&] { render(o, plan, L); }); };
    const std::string why = refused();
    CHECK(why.starts_with("16384x" + std::to_string(size.height) + " pixels do not fit into the "));
    CHECK(why.ends_with(" GB of this machine: render fewer rows at a time (--rows)"));
    // An adaptive film has at least two replications per pixel.
    plan.size = {8, 4}, plan.sets = 0, plan.memory = bytes_of(plan.size, 1.9);
    CHECK(refused().starts_with("8x4 pixels do not fit"));
    plan.memory = bytes_of(plan.size, 2);
    CHECK(refused() == "");
}

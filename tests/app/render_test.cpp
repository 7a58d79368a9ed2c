// app/render_test.cpp  images as requested by options: samples, error, time, rows
#include "app/render.h"

#include "app/threads.h"
#include "base/cases.h"
#include "film/spread.h"
#include "oracle/expect.h"
#include "path/samplers.h"
#include "path/scenes.h"
#include "text/complaint.h"

namespace {

NamedScene small(const char* text, Size size) {
    NamedScene scene = scene_of(text);
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
    SamplerSettings settings;

    Work(const Options& o, const Scene& scene)
        : plan(plan_of(o, scene)), settings(sampler_settings(o.sampler, o.seed, scene.depth)) {}
    SampleFunction radiance(const Options& o, const Scene& scene) const {
        return [&, t = o.technique](const PixelSample& s, Tally& tally) {
            const Start at = start(scene, settings, s);
            return Li(scene, t, at.ray, at.sampler, [&](const PathState&, const VertexEvents& e) {
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
    static const Scene scene = small(unequal, {24, 18});
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
    // "K, samples of each": of a picture without and with --replications.
    auto planned = [&](Size size, const std::string& words) {
        Options o;
        OptionTable table = option_table(o);
        parse_options(table, o, split(words + " a.scene"));
        scene.size = size;
        const Plan p = plan_of(o, scene);
        CHECK(said(p.seconds, p.error, p.threads) == said(o.seconds, o.error, o.threads));
        CHECK((p.is_adaptive == (o.replications == 0 && p.replications == 2 && o.spp != 2)));
        CHECK(said(p.size.width, p.size.height, p.first_row) ==
              said(size.width, o.rows ? o.rows->count() : size.height, o.rows ? o.rows->first : 0));
        return said(p.replications, p.samples);
    };
    // Small pictures have up to 8 replications, of equal weights; no picture has more than samples.
    // With weights a pixel of mean noise has 2.
    const struct {
        std::string words, large, middle, small;  // 64x32 and 20x20, 12x12, 10x10 and 1x1
    } rows[] = {
        {"", "2 2", "6 2", "7 1"},  // the scene's
        {"--spp 1", "1 1", "1 1", "1 1"},
        {"--spp 2", "2 1", "2 1", "2 1"},
        {"--spp 3", "2 1", "3 1", "3 1"},
        {"--spp 4", "2 1", "4 1", "4 1"},
        {"--spp 5", "2 2", "5 1", "5 1"},
        {"--spp 8", "2 2", "6 2", "8 1"},
        {"--spp 17", "2 5", "6 3", "8 3"},
        {"--spp 64", "2 16", "6 11", "8 8"},
        {"--spp 65", "2 17", "6 11", "8 9"},
        {"--time 3", "2 0", "6 0", "8 0"},
        {"--error 10%", "2 0", "6 0", "8 0"},
        {"--time 3 --error 10% --spp 64", "2 16", "6 11", "8 8"},
        {"--time 3 --spp 1", "1 1", "1 1", "1 1"},
        {"--rows 0-0 -o a.pfm --spp 64", "2 16", "6 11", "8 8"},
    };
    for (const auto& row : rows) {
        INFO(row.words);
        CHECK(planned({64, 32}, row.words) == row.large);
        CHECK(planned({20, 20}, row.words) == row.large);
        CHECK(planned({12, 12}, row.words) == row.middle);
        CHECK(planned({10, 10}, row.words) == row.small);
        CHECK(planned({1, 1}, row.words) == row.small);
    }
    CHECK(planned({19, 21}, "--spp 64") == "3 22");
    CHECK(planned({19, 14}, "--spp 64") == "4 16");
    CHECK(planned({100, 1}, "--rows 0-0 -o a.pfm") == "7 1");
    CHECK(planned({64, 32}, "--rows 30-31 -o a.pfm") == "2 2");
    // --replications K is what it says, whatever the picture.
    for (const auto& row : {std::pair{"1", "1 7"},
                            {"1 --spp 1", "1 1"},
                            {"2 --spp 1", "2 1"},
                            {"2 --spp 3", "2 2"},
                            {"2 --spp 64", "2 32"},
                            {"3 --spp 64", "3 22"},
                            {"1024 --spp 64", "1024 1"},
                            {"4 --time 1", "4 0"},
                            {"4 --error 1%", "4 0"},
                            {"3 --rows 0-0 -o a.pfm", "3 3"}})
        for (const Size size : {Size{64, 32}, Size{10, 10}, Size{1, 1}}) {
            INFO(row.first);
            Options o;
            OptionTable table = option_table(o);
            parse_options(table, o, split(std::string("--replications ") + row.first + " a.scene"));
            scene.size = size;
            const Plan p = plan_of(o, scene), together = plan_at_once(o, scene);
            CHECK(said(p.replications, p.samples) == row.second);
            CHECK_FALSE(p.is_adaptive);
            // One sample of the film stands for all paths of a replication.
            CHECK(said(p.paths, together.samples, together.paths) == said(1, 1, p.samples));
            CHECK(said(together.replications, together.is_adaptive) == said(p.replications, false));
        }
    // A scene of one sample has one replication, and a band that of its picture.
    scene.samples = 1;
    CHECK(planned({64, 32}, "") == "1 1");
    CHECK(planned({64, 32}, "--time 1") == "2 0");
}

TEST_CASE("a film begins as its plan says; near misses belong to radiance only") {
    // A lamp smaller than a pixel makes that pixel noisy.
    const Scene scene =
        small("camera 0 0 5  0 0 0  40\nlight l 1 1 1\nsphere 0.1 0.1 0  0.01  l\n", {30, 20});
    const LightRecorder recorder(scene, {}, 0, 20);
    REQUIRE(recorder.noisy().size() == 1);
    for (const uint32_t K : {0u, 1u, 2u, 5u}) {
        Options o = quick(SamplerKind::sobol, 64);
        o.replications = K;
        const Plan view = plan_of(o, scene), plan = plan_of(o, scene, &recorder);
        CHECK((view.noisy.empty() && view.near.empty() && !view.may_miss_light));
        CHECK(film_for(view).near.empty());
        CHECK(plan.noisy == recorder.noisy());
        CHECK(bool(plan.may_miss_light));
        CHECK(said(plan.replications, plan.samples) == said(view.replications, view.samples));
        // The pixel has weight 4 or more, if weights are chosen.
        const Film film = film_for(plan);
        REQUIRE(film.near.size() == 1);
        CHECK(film.near[0].K == (K ? float(K) : 2 * 4));
        CHECK(film.near[0].area == recorder.near_misses(1)[0].area);
        CHECK(said(film.size.width, film.size.height, film.replications, film.is_pilot) ==
              said(30, 20, K ? K : 2, K == 0));
    }
}

TEST_CASE(
    "a scene without light needs no error to be black; where light was missed, none is known") {
    const Scene dark =
        small("camera 0 0 5  0 0 0  40\ndiffuse m .5 .5 .5\nsphere 0 0 0 1 m\n", {9, 9});
    Options o = quick(SamplerKind::sobol, 0);
    o.error = 0.1;
    CHECK(plan_of(o, dark).error == 0);
    CHECK(plan_of(o, dark).samples == (dark.samples + 7) / 8);  // 9x9 pixels
    const Scene turned =
        small("camera 0 0 5  0 0 0  40\nlight l 1 1 1\nquad -1 -1 0  0 2 0  2 0 0  l\n", {9, 9});
    o.spp = 40;
    for (const Scene& scene : {dark, turned}) {
        const Run run = rendered(o, scene).run;
        CHECK(run.stopped_by == Stop::samples);
        CHECK(run.error.norm() == 0);
        CHECK(std::isnan(run.error.d_rel()));
    }
}

TEST_CASE("images of few samples: one has no error; others are those of a film as planned") {
    const Scene& scene = unequal_picture();
    for (uint64_t spp : {1, 2, 3, 4, 5, 9, 64}) {
        const Options o = quick(SamplerKind::sobol, spp);
        const Picture p = rendered(o, scene);
        const Work j(o, scene);
        const Film film = spp < 3 ? filled(scene.size, spp == 1 ? 1 : 2, 1, j.radiance(o, scene))
                                  : filled(scene.size, 0, (spp + 3) / 4, j.radiance(o, scene));
        CAPTURE(spp);
        CHECK(first_non_finite(p.image) == std::nullopt);
        CHECK(p.image.pixels == image_of(film).pixels);
        CHECK(p.run.spp == film.samples_per_pixel());
        CHECK(std::isnan(p.run.error.d_rel()) == (spp == 1));
        CHECK(said(p.run.replications, p.run.stopped_by) == said(spp == 1 ? 1 : 2, Stop::samples));
        CHECK(p.run.rays > 0);
        // Another --spp may take the same samples, and is said to.
        const Options again = quick(SamplerKind::sobol, uint64_t(p.run.repeat_spp));
        CHECK(rendered(again, scene).image.pixels == p.image.pixels);
    }
    for (uint32_t K : {1u, 2u, 5u}) {
        Options o = quick(SamplerKind::halton, 3);
        o.replications = K;
        const Picture p = rendered(o, scene);
        CHECK(p.run.replications == K);
        CHECK(p.run.spp == (K == 1 ? 3 : K == 2 ? 4 : 5));
        CHECK(std::isnan(p.run.error.d_rel()) == (K == 1));
    }
    // Without noise, and without neighbours, pixels have weight 2.
    for (const auto& [side, spp] : {std::pair{1, 8.0}, {2, 8.0}, {20, 2.0}})
        for (uint64_t N = 2; N <= 9; ++N) {
            const Picture p =
                render(quick(SamplerKind::sobol, N),
                       plan_of(quick(SamplerKind::sobol, N), small(unequal, {side, side})),
                       [](const PixelSample&, Tally&) {
                           return rgb{1, 1, 1};
                       });
            const double K = std::min(spp, double(N));
            CHECK(p.run.replications == K);
            const double each = K == 2 && N > 2 ? 4 : K;
            CHECK(p.run.spp == each * std::ceil(double(N) / each));
            CHECK(p.run.error.d_rel() == 0);
        }
}

TEST_CASE("the stated error is the spread from seed to seed; replications do not move the mean") {
    const Scene& scene = direct_picture();
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        Moments of_two;
        constexpr double pixels = 16 * 8;
        for (uint32_t sets : {2u, 0u}) {
            const int runs = sets ? 300 : 150;
            Options o = quick(kind, sets ? 12 : 36);
            o.replications = sets;
            Spread spread;
            Moments means, stated;
            for (int run = 0; run < runs; ++run, ++o.seed) {
                const Picture p = rendered(o, scene);
                spread.add(p.image, p.run.error.d2());
                means.add(p.run.error.values[1] / pixels);
                stated.add(p.run.error.variances[1] / (pixels * pixels));
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
            o.replications = sets;
            const Picture one = rendered(o, scene);
            o.threads = 3;
            const Picture three = rendered(o, scene);
            CHECK(three.image.pixels == one.image.pixels);
            if (sets != 1) CHECK(three.run.error.d2() == one.run.error.d2());
            if (sets != 1) CHECK(three.run.error.terms2 == one.run.error.terms2);
            CHECK(three.run.replications == one.run.replications);
            CHECK(three.run.rays == one.run.rays);
            o.rows = {3, 6};
            const Picture band = rendered(o, scene);
            CHECK(band.image.height == 4);
            if (sets > 0)
                CHECK(std::equal(band.image.pixels.begin(), band.image.pixels.end(),
                                 one.image.pixels.begin() + 3 * 24));
            if (sets != 1) continue;
            o = quick(kind, 36);
            o.replications = 1;
            const SamplerSettings settings = Work(o, scene).settings;
            for (int i : {0, 100, 287}) {
                double sum = 0;
                for (uint64_t k = 0; k < 36; ++k) {
                    const Start at = start(scene, settings, {i % 24, i / 24, k});
                    sum += double(Li(scene, o.technique, at.ray, at.sampler).x);
                }
                CHECK(one.image.pixels[size_t(i)][0] == float(sum / 36));
            }
        }
}

TEST_CASE("--error: an image ends at the first check that finds its error small enough") {
    const Scene& scene = unequal_picture();
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::stratified, SamplerKind::sobol})
        for (double E : {0.6, 0.1, 0.02}) {
            Options o = quick(kind, 0);
            o.error = E;
            const Picture p = rendered(o, scene);
            INFO("sampler ", int(kind), ", E = ", E);
            CHECK(p.run.stopped_by == Stop::error);
            // The reference applies the rule to a film at every number of samples with a check.
            const Work j(o, scene);
            const SampleFunction L = j.radiance(o, scene);
            Film film = make_film(scene.size, 2, true);
            fill_pilot(film, pilot_samples, L);
            uint64_t checks = 0;
            do {
                fill(film, next_check(film.min_samples_done()), L);
                ++checks;
            } while (doubt_of(film, error_of(film), {}) != Doubt::no ||
                     !is_small_enough(error_of(film), E));
            CHECK(p.run.spp == film.samples_per_pixel());
            CHECK(p.image.pixels == image_of(film).pixels);
            CHECK(p.run.error.d_rel() == error_of(film).d_rel());
            CHECK((checks > 3 || E > 0.05));
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
            CHECK(run.stopped_by == Stop::error);
        }
    Scene point = small(smooth.c_str(), {1, 1});
    point.camera.tan_half = real(1e-3);
    for (const uint32_t sets : {0u, 2u}) {
        Options o = quick(SamplerKind::sobol, 4000);
        o.replications = sets, o.error = 0.01;
        const Run run = rendered(o, point).run;
        CHECK(run.error.d2() > 0);
        CHECK(run.error.d_rel() < 1e-6);
        CHECK(run.stopped_by == Stop::error);
        CHECK(run.spp == 8 * (sets ? sets : 8));  // by the first check
    }
}

TEST_CASE("--error with limits: whichever comes first ends the image, and is said") {
    const Scene& scene = unequal_picture();
    Options o = quick(SamplerKind::sobol, 40);
    CHECK(rendered(o, scene).run.stopped_by == Stop::samples);
    o.error = 1e-6;
    const Picture samples = rendered(o, scene);
    CHECK(samples.run.stopped_by == Stop::samples);
    CHECK(samples.run.spp ==
          filled(scene.size, 0, 10, Work(o, scene).radiance(o, scene)).samples_per_pixel());
    CHECK(samples.run.error.d_rel() > 1e-6);
    o.spp = 8, o.error = 0.9;  // before the first check
    CHECK(rendered(o, scene).run.stopped_by == Stop::samples);
    o.spp = 1 << 20, o.error = 0.3, o.seconds = 1e6;
    const Picture error = rendered(o, scene);
    CHECK(error.run.stopped_by == Stop::error);
    CHECK(error.run.spp < 200);
    o.error = 1e-6, o.seconds = 0.05;
    const Picture time = rendered(o, scene);
    CHECK(time.run.stopped_by == Stop::time);
    CHECK(time.run.spp < 1 << 20);
    CHECK(time.run.seconds >= 0.05);
    CHECK(time.run.seconds < 5);
    o.spp = 0, o.seconds = 1e-9;
    CHECK(rendered(o, scene).run.stopped_by == Stop::time);  // in the pilot
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
    CHECK(p.run.interrupted());
    CHECK(p.run.stopped_by == Stop::interrupt);
    CHECK(p.run.spp > 0);
    CHECK(first_non_finite(p.image) == std::nullopt);
    // Ctrl-C in the first pass leaves pixels without samples: no image can be written.
    uint64_t calls = 0;
    const SampleFunction L = [&](const PixelSample&, Tally&) {
        if (++calls == 100) interrupted = SIGINT;
        return rgb{1, 1, 1};
    };
    const Picture none = render(o, plan_of(o, scene), L);
    interrupted = 0;
    CHECK(none.run.spp == 0);
    CHECK(none.run.interrupted());
    // Ctrl-C comes just after the pilot, when most pixels have only its samples.
    const SampleFunction others = [](const PixelSample& s, Tally&) {
        if (s.i >= pilot_samples) interrupted = SIGINT;
        return rgb{1, 1, 1};
    };
    const Picture pilot = render(o, plan_of(o, scene), others);
    interrupted = 0;
    CHECK(pilot.run.spp >= 2 * double(pilot_samples));
    CHECK(pilot.run.spp < 2.1 * double(pilot_samples));
    CHECK(pilot.run.stopped_by == Stop::interrupt);
    CHECK(first_non_finite(pilot.image) == std::nullopt);
}

TEST_CASE("a sample that is not finite is an error that tells how to replay it") {
    auto why = [](PixelSample bad, const Plan& plan) {
        return complaint<SystemError>([&] {
            render(quick(SamplerKind::independent, 0), plan, [&](const PixelSample& s, Tally&) {
                const bool is = s.x == bad.x && s.y == bad.y && s.i >= bad.i &&
                                s.replication == bad.replication;
                return rgb{1, is ? real(NAN) : 1, 1};
            });
        });
    };
    Plan plan{{8, 4}};
    plan.samples = 3;
    for (const bool is_adaptive : {true, false}) {
        plan.is_adaptive = is_adaptive;
        CHECK(why({0, 1, 0, 0}, plan)
                  .starts_with("1 sample was not finite, the first at pixel 0,1 sample 0 ("));
    }
    CHECK(why({7, 2, 1, 0}, plan)
              .starts_with("2 samples were not finite, the first at pixel 7,2 "
                           "sample 1 (replay it by --pixel 7,2 --sample 1)"));
    CHECK(why({7, 2, 2, 1}, plan)
              .starts_with("1 sample was not finite, the first at pixel 7,2 "
                           "sample 2,1 (replay it by --pixel 7,2 --sample 2,1)"));
    plan.first_row = 10;
    CHECK(why({0, 13, 0, 0}, plan).find("--pixel 0,13 --sample 0)") != std::string::npos);
}

TEST_CASE("memory for a film and its image is what its arrays have") {
    CHECK(sizeof(Sum) == 24);
    for (uint32_t K : {1u, 2u, 8u})
        for (Size size : {Size{40, 30}, Size{512, 300}})
            for (bool is_pilot : {false, true}) {
                Film f = make_film(size, K, is_pilot);
                for (bool is_chosen : {false, true}) {
                    if (is_chosen && is_pilot) choose_weights(f);
                    const Image image = image_of(f);
                    auto bytes = [](const auto& v) { return double(v.capacity() * sizeof v[0]); };
                    const double later = std::max(bytes(f.pilot_deviation), bytes(image.pixels));
                    const double all =
                        bytes(f.sum) + bytes(f.weight) + bytes(f.samples_done) + later;
                    CHECK(all <= bytes_of(size, K));
                    CHECK(all > 0.8 * bytes_of(size, K));
                }
            }
}

TEST_CASE("a film that the machine does not hold is refused before it is made") {
    const Options o = quick(SamplerKind::sobol, 4);
    const SampleFunction L = [](const PixelSample&, Tally&) { return rgb{}; };
    for (const uint32_t K : {2u, 1024u}) {
        const double pixels = 1.001 * bytes_of_machine() / bytes_of({1, 1}, K);
        const Size size{1 << 14, int(pixels / (1 << 14)) + 1};
        CHECK(bytes_of(size, K) < 1.01 * bytes_of_machine());
        Plan plan{size};
        plan.replications = K, plan.samples = 4;
        const std::string why = complaint<UserError>([&] { render(o, plan, L); });
        CHECK(why.starts_with("16384x" + std::to_string(size.height) +
                              " pixels do not fit into the "));
        CHECK(why.ends_with(" GB of this machine: render fewer rows at a time (--rows)"));
    }
}

// app/indirect_test.cpp  images by paths that end on maps, as options ask for them
#include "app/indirect.h"

#include "app/render.h"
#include "app/replay.h"
#include "base/moments.h"
#include "film/spread.h"
#include "oracle/expect.h"
#include "path/scenes.h"

namespace {

const char* const room = R"(
size 12 8
camera 0 0 1.9  0 -0.2 0  70
depth 2
diffuse white .7 .7 .7
diffuse red .6 .1 .1
light lamp 8 8 6
box 4 3 4  0  -2 -1.5 -2  white
box 0.8 1.2 0.8  30  -0.4 -1.5 -0.4  red
quad -.5 1.49 -.5  1 0 0  0 0 1  lamp
)";

constexpr Indirect with_maps[] = {Indirect::map, Indirect::control, Indirect::regression};
constexpr SamplerKind kinds[] = {SamplerKind::independent, SamplerKind::stratified,
                                 SamplerKind::halton, SamplerKind::sobol,
                                 SamplerKind::halton_naive};

Options options(Indirect indirect, uint64_t seed = 1) {
    Options o;
    o.indirect = indirect;
    o.mesh = 0.5;
    o.spp = 4;
    o.seed = seed;
    o.threads = 1;
    o.quiet = true;
    return o;
}

Scene stage() { return endless(scene_of(room), 0.5).scene; }

Rendered render_of(const Options& o, const Scene& scene) {
    const Maps maps = maps_of(o, scene);
    return rendered(job_of(o, scene, maps));
}

}  // namespace

TEST_CASE("maps: an image is a function of its options and its seed, whatever the threads") {
    const Scene scene = stage();
    for (Indirect indirect : with_maps)
        for (SamplerKind kind : kinds)
            for (uint32_t sets : {3u, sets_by_noise}) {
                if (kind == SamplerKind::halton_naive && sets == 3) continue;
                Options o = options(indirect);
                o.sampler = kind, o.sets = sets;
                const Image one = render_of(o, scene).image;
                o.threads = 3;
                CHECK(render_of(o, scene).image.pixels == one.pixels);
                o.seed = 2;
                CHECK((render_of(o, scene).image.pixels != one.pixels));
            }
}

TEST_CASE("maps: what --pixel replays is what the image is made of, bit for bit") {
    const Scene scene = stage();
    for (Indirect indirect : with_maps) {
        Options o = options(indirect);
        o.sets = 2;
        const Maps maps = maps_of(o, scene);
        const Job job = job_of(o, scene, maps);
        const Image image = rendered(job).image;
        std::FILE* out = std::tmpfile();
        const PathLog log(scene, out);
        bool ended = false, went_on = false;
        for (int y = 0; y < scene.size.height; ++y)
            for (int x = 0; x < scene.size.width; ++x) {
                double sum[2] = {};  // as the film adds them
                for (uint32_t set : {0u, 1u})
                    for (uint64_t i = 0; i < 4; ++i) {
                        auto account = [&](const Segment& s, const Step& e, const Mapped& m) {
                            log(s, e, m);
                            (m.goes ? went_on : ended) |= s.k > 0;
                        };
                        sum[set] += double(mapped_Li(job, {x, y, i, set}, account).y);
                    }
                CHECK(image.at(x, y)[1] == float((sum[0] / 4 + sum[1] / 4) / 2));
            }
        CHECK(ended);
        CHECK(went_on == (indirect != Indirect::map));
        CHECK(std::ftell(out) > 10000);
        std::fclose(out);
    }
}

TEST_CASE("maps: a particle for 16 samples, or a 16th of the time, or as many as are asked for") {
    const Scene scene = stage();
    Options o = options(Indirect::map);
    o.spp = 64;
    CHECK(walks_of(o, scene).particles == 12 * 8 * 4);
    CHECK(walks_of(o, scene).seconds == 0);
    CHECK(maps_of(o, scene).stats.particles == 12 * 8 * 4);
    for (Indirect less : {Indirect::control, Indirect::regression}) {
        o.indirect = less;
        CHECK(walks_of(o, scene).particles == 12 * 8);
    }
    o.indirect = Indirect::map;
    o.spp = 0, o.seconds = 8;
    CHECK(walks_of(o, scene).particles == 0);
    CHECK(walks_of(o, scene).seconds == 0.5);
    o.particles = 1000;
    CHECK(walks_of(o, scene).particles == 1000);
    CHECK(walks_of(o, scene).seconds == 8);
    // Where an error alone ends the image, the scene's samples count: walks end in any case.
    o.particles = 0, o.seconds = 0, o.error = 0.01;
    CHECK(walks_of(o, scene).particles == 12 * 8 * scene.samples / 16);
    o.spp = 32;
    CHECK(walks_of(o, scene).particles == 12 * 8 * 2);
}

TEST_CASE("maps: their time and their rays count") {
    const Scene scene = stage();
    const Options o = options(Indirect::control);
    Maps maps = maps_of(o, scene);
    CHECK(maps.stats.seconds > 0);
    CHECK(maps.stats.rays > maps.stats.particles);
    CHECK(maps.stats.triangles == maps.known.mesh.elements());
    const uint64_t rays = rendered(job_of(o, scene, maps)).run.rays;
    maps.stats.rays += 1000, maps.stats.seconds = 2;
    const RunStats run = rendered(job_of(o, scene, maps)).run;
    CHECK(run.rays == rays + 1000);
    CHECK(run.seconds > 2);
    Options timed = o;
    timed.spp = 0, timed.seconds = 5;
    CHECK(job_of(timed, scene, maps).passes.target.seconds == 3);
    timed.seconds = 1;  // all of it is used up: the shortest time, for 0 is no limit
    CHECK(job_of(timed, scene, maps).passes.target.seconds > 0);
    CHECK(job_of(timed, scene, maps).passes.target.seconds < 0.1);
}

TEST_CASE("maps: the slope of regression is 1 but for noise, that of control exactly") {
    const Scene scene = stage();
    Options o = options(Indirect::regression);
    o.particles = 100000;
    const Maps maps = maps_of(o, scene);
    for (auto c : axis) CHECK(double(maps.stats.slope.*c) == doctest::Approx(1).epsilon(0.1));
    CHECK(maps_of(options(Indirect::control), scene).stats.slope == rgb{1, 1, 1});
    CHECK(maps.gather(o, scene).slope == maps.stats.slope);
}

// Over seeds, maps and all: 300 pixels' means of a few samples each.
TEST_CASE("maps: control and regression see what whole paths see") {
    Scene whole = scene_of(room);
    whole.depth = 30;  // 0.7^30 is left
    const Scene scene = stage();
    Moments truth;
    for (uint64_t seed = 0; seed < 48; ++seed) {
        Options o = options(Indirect::path, hash(seed_here(), seed));
        o.spp = 16, o.sets = 1;
        truth.add(mean_of_pixels(rendered(job_of(o, whole)).image)[0]);
    }
    for (Indirect indirect : {Indirect::control, Indirect::regression})
        for (SamplerKind kind : {SamplerKind::independent, SamplerKind::halton}) {
            Moments means;
            for (uint64_t seed = 0; seed < 48; ++seed) {
                Options o = options(indirect, hash(seed_here(), seed));
                o.sampler = kind, o.spp = 16, o.sets = 1;
                means.add(mean_of_pixels(render_of(o, scene).image)[0]);
            }
            CAPTURE(int(indirect));
            EXPECT(oracle::expect_equal(estimate(means, double(ulp)), estimate(truth)), 0.1);
        }
}

TEST_CASE("maps: the stated error is the spread of images on the same maps, from seed to seed") {
    const Scene scene = stage();
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::halton})
        for (uint32_t sets : {2u, sets_by_noise}) {
            Options o = options(Indirect::control, seed_here());
            o.sampler = kind, o.sets = sets;
            o.particles = 4096;
            // What maps differ by, their pixels share.
            const Maps maps = maps_of(o, scene);
            Spread spread;
            for (int run = 0; run < 200; ++run, ++o.seed) {
                const Rendered r = rendered(job_of(o, scene, maps));
                spread.add(r.image, r.run.error.d2());
            }
            const std::string name =
                "sampler " + std::to_string(int(kind)) + ", sets " + std::to_string(sets);
            EXPECT(oracle::expect_mean(1, spread.ratio()).of(name), 0.5);
        }
}

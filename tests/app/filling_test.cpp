// app/filling_test.cpp  a run that is interrupted and goes on ends as one that was not
#include "app/render.h"

#include <bit>

#include "base/folder.h"
#include "path/scenes.h"

namespace {

Options options_for(SamplerKind kind, uint64_t spp) {
    Options o;
    o.scene = "test";
    o.sampler = kind;
    o.spp = spp;
    o.seed = 7;
    o.threads = 1;
    o.quiet = true;
    return o;
}

// What was asked of a film's L, before which one of them a signal comes.
struct Calls {
    uint64_t seen = 0, signal_at = UINT64_MAX;
    void count() {
        if (++seen == signal_at) interrupted = SIGTERM;
    }
};

Rendered means_run(const Options& o, const Scene& scene, Calls& calls) {
    interrupted = 0;
    const Job job = job_of(o, scene);
    auto L = [&] {
        return [&](const PixelSample& s, uint64_t& rays) {
            calls.count();
            return radiance(job, start(job.scene, job.pattern, s), rays);
        };
    };
    const Rendered r = fill<MeanPixel>(job, identity_of(job, "0"), {}, L);
    interrupted = 0;
    return r;
}

Rendered ratios_run(const Options& o, const Scene& scene, Calls& calls) {
    interrupted = 0;
    const Job job = job_of(o, scene);
    auto L = [&] {
        return [&](const PixelSample& s, uint64_t& rays) {
            calls.count();
            const Start at = start(job.scene, job.pattern, s);
            return shadow_Li(job.scene, o.technique, o.direct, at, counting(rays));
        };
    };
    const Rendered r = fill<ShadowPixel>(job, identity_of(job, "0"), {o.direct}, L);
    interrupted = 0;
    return r;
}

std::array<double, 9> numbers_of(const RunStats& run) {
    const auto& [square, spread, norm, greatest] = run.error;
    return {square[0], square[1],       square[2],           spread, norm, greatest,
            run.sets,  double(run.spp), run.mean_radiance[1]};
}

// Bit by bit, NaN for NaN.
bool same(const Rendered& a, const Rendered& b) {
    using Bits = std::array<uint64_t, 9>;
    return a.image.pixels.size() == b.image.pixels.size() &&
           std::memcmp(a.image.pixels.data(), b.image.pixels.data(),
                       a.image.pixels.size() * sizeof a.image.pixels[0]) == 0 &&
           std::bit_cast<Bits>(numbers_of(a.run)) == std::bit_cast<Bits>(numbers_of(b.run)) &&
           a.run.stopped_by == b.run.stopped_by;
}

// Interrupts a run at every `step`-th call of L, and what goes on from it again after as many; each
// chain has to end as `whole` did.
template <class Render>
void expect_chains(Options o, const Scene& scene, uint64_t step, Render render) {
    const Folder folder;
    Calls all;
    const Rendered whole = render(o, scene, all);
    REQUIRE(all.seen > 20 * step);
    o.checkpoint = folder / "a.film";
    uint64_t wrong = 0, unfinished = 0, first_wrong = 0;
    for (uint64_t at = 1; at < all.seen; at += step) {
        o.resume = "";
        std::filesystem::remove(o.checkpoint);
        Rendered r;
        for (uint64_t runs = 0;; ++runs) {
            REQUIRE(runs < 2 * all.seen);
            // A block of a pass may be as much: once is enough to see that it goes on.
            Calls calls{0, runs < 3 ? at : UINT64_MAX};
            r = render(o, scene, calls);
            REQUIRE(r.not_kept.empty());
            if (!r.run.interrupted) break;
            o.resume = o.checkpoint;
            CHECK(FilmReader(o.resume).header().find("complete") == "no");
            unfinished += FilmReader(o.resume).header().find("unfinished") == "yes";
        }
        if (!same(r, whole) && ++wrong == 1) first_wrong = at;
        CHECK(FilmReader(o.checkpoint).header().find("complete") == "yes");
        // What is complete stays as it is.
        Calls none;
        o.resume = o.checkpoint;
        if (!same(render(o, scene, none), whole)) ++wrong;
        CHECK(none.seen == 0);
    }
    INFO(wrong, " wrong, the first interrupted at call ", first_wrong, " of ", all.seen);
    CHECK(wrong == 0);
    CHECK(unfinished > 10);
}

Scene small(const char* text) {
    Scene scene = scene_of(text);
    scene.size = {7, 4};
    return scene;
}

}  // namespace

TEST_CASE("interrupted anywhere, also while other sets are brought, and resumed: the same image") {
    const Scene scene = small(unequal);
    for (uint64_t spp : {5, 16, 21}) {
        CAPTURE(spp);
        expect_chains(options_for(SamplerKind::sobol, spp), scene, 11, means_run);
    }
}

TEST_CASE("a film that is kept has the sets of a run without a break, however short its time was") {
    const Scene scene = small(unequal);
    const Folder folder;
    Calls all;
    Options o = options_for(SamplerKind::stratified, 16);
    const Rendered whole = means_run(o, scene, all);
    o.spp = 0, o.seconds = 1e-9;  // ends after its first grid of 16
    const Rendered hurried = means_run(o, scene, all);
    o.checkpoint = folder / "a.film";
    const Rendered kept = means_run(o, scene, all);
    CHECK(kept.run.spp == 16);
    CHECK(kept.run.sets == whole.run.sets);
    CHECK(kept.image.pixels == whole.image.pixels);
    CHECK(hurried.image.pixels != whole.image.pixels);
}

TEST_CASE("a film without samples replaces none") {
    const Scene scene = small(unequal);
    const Folder folder;
    Options o = options_for(SamplerKind::sobol, 16);
    o.checkpoint = folder / "a.film";
    Calls all, one{0, 1};
    means_run(o, scene, all);
    const std::string before = read_file(o.checkpoint);
    const Rendered r = means_run(o, scene, one);
    CHECK(r.run.interrupted);
    CHECK(r.run.spp == 0);
    CHECK(r.not_kept.empty());
    const bool same_bytes = read_file(o.checkpoint) == before;
    CHECK(same_bytes);
}

TEST_CASE("so with sets that are there from the start, on grids, and until the error is small") {
    const Scene scene = small(unequal);
    Options o = options_for(SamplerKind::stratified, 24);
    o.sets = 3;
    expect_chains(o, scene, 37, means_run);
    o.sets = sets_by_noise;
    o.view = View::variance;
    expect_chains(o, scene, 29, means_run);
    o = options_for(SamplerKind::independent, 0);
    o.error = 0.15;
    expect_chains(o, scene, 41, means_run);
}

TEST_CASE("so with pixels that are no means") {
    Options o = options_for(SamplerKind::halton, 19);
    o.technique.light = LightMode::nee;
    o.direct = Estimator::ratio;
    expect_chains(o, small(unequal), 19, ratios_run);
}

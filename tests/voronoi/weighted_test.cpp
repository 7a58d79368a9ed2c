// voronoi/weighted_test.cpp  a pixel's weighted mean: sum of w L, with weights from its own samples
#include "voronoi/weighted.h"

#include "app/render.h"
#include "film/spread.h"
#include "oracle/expect.h"

namespace {

constexpr Weighting weightings[] = {Weighting::mc, Weighting::vor, Weighting::fvor, Weighting::cvor,
                                    Weighting::torus};

}  // namespace

TEST_CASE("a weighted mean is the sum of w L for every set of a pixel, and constants stay") {
    Scene scene;
    scene.size = {4, 3};
    for (Weighting kind : weightings)
        for (uint64_t n : {1, 2, 9, 64}) {
            const SamplerSettings settings{SamplerKind::independent, 7};
            WeightTroubles troubles;
            auto place = [&](const PixelSample& s) {
                return Sampler(settings, uint64_t(4 * s.y + s.x), s.i, s.replication).get2(film_x);
            };
            const SampleFunction L = [&](const PixelSample& s, Tally& tally) {
                return ++tally.rays, rgb{1, place(s).x, real(s.i % 3)};
            };
            const SampleFunction mean = weighted_mean(scene, settings, kind, n, L, troubles);
            uint64_t expected_redraws = 0, expected_fallbacks = 0;
            // One strip of vor in 4000 leaves the cell of one sample unbounded, and is drawn anew.
            const bool redrawn = kind == Weighting::vor && n == 1;
            for (int set = 0; set < (redrawn ? 20000 : 3); ++set) {
                const PixelSample s{set / 2 % 4, set / 8 % 3, 0, unsigned(set % 2 + set / 24 * 2)};
                Tally tally;
                const rgb found = mean(s, tally);
                CHECK(tally.rays == n);
                std::vector<Site> places;
                for (uint64_t i = 0; i < n; ++i) {
                    const vec2 u = place({s.x, s.y, i, s.replication});
                    places.push_back({double(u.x), double(u.y)});
                }
                Weigher weigher;
                const auto& w = weigher(kind, places,
                                        hash(hash(hash(0, settings.seed), uint64_t(4 * s.y + s.x)),
                                             UINT64_MAX - s.replication));
                expected_redraws += weigher.redraws, expected_fallbacks += weigher.fallbacks;
                double second = 0, third = 0;
                for (uint64_t i = 0; i < n; ++i)
                    second += w[i] * places[i].x, third += w[i] * double(i % 3);
                CHECK(std::abs(double(found.x) - 1) <= 64 * double(ulp));
                CHECK(std::abs(double(found.y) - second) <= 64 * double(ulp));
                CHECK(std::abs(double(found.z) - third) <= 192 * double(ulp));
            }
            CHECK(troubles.redraws == expected_redraws);
            if (redrawn) CHECK(troubles.redraws > 0);
            CHECK(troubles.fallbacks == expected_fallbacks);
        }
}

TEST_CASE("the stated d^2 of weighted means is that from seed to seed, on any number of threads") {
    Scene scene;
    scene.size = {6, 6};
    for (Weighting kind : weightings) {
        Spread spread;
        for (uint64_t r = 0; r < 600; ++r) {
            const SamplerSettings settings{SamplerKind::independent, hash(seed_here(), r)};
            WeightTroubles troubles;
            const SampleFunction sample = [&](const PixelSample& s, Tally&) {
                const Sampler numbers(settings, uint64_t(6 * s.y + s.x), s.i, s.replication);
                return heteroscedastic(s.x, s.y, numbers.get2(film_x));
            };
            const SampleFunction L = weighted_mean(scene, settings, kind, 6, sample, troubles);
            Options o;
            o.replications = 2, o.spp = 12, o.quiet = true;
            auto rendered = [&](unsigned threads) {
                o.threads = threads;
                return render(o, plan_at_once(o, scene), L);
            };
            const Picture p = rendered(1);
            if (r == 0) CHECK(rendered(3).image.pixels == p.image.pixels);
            CHECK(p.run.spp == 12);
            spread.add(p.image, p.run.error.d2());
        }
        EXPECT(oracle::expect_mean(1, spread.ratio()).of("weighting " + std::to_string(int(kind))),
               0.4);
    }
}

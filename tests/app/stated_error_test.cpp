// app/stated_error_test.cpp  d^2 as images of every sampler and wing state it, beside what it is
#include <memory>

#include "film/error.h"
#include "film/spread.h"
#include "oracle/expect.h"
#include "path/sampler.h"
#include "shadow/shadow.h"
#include "voronoi/weighted.h"

TEST_CASE("the stated d^2 is that from seed to seed: every sampler, two and three sets, by noise") {
    // By noise 576 pixels are measured with a chance of 1/9 or more.
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::stratified, SamplerKind::halton,
                             SamplerKind::sobol})
        for (uint32_t sets : {2u, 3u, by_noise}) {
            const Size size = sets == by_noise ? Size{24, 24} : Size{12, 9};
            Spread spread;
            for (uint64_t r = 0; r < (sets == by_noise ? 240 : 800); ++r) {
                const uint64_t seed = hash(seed_here(), r);
                const Pattern pattern = make_pattern(kind, seed, 1, 24);
                MeanFilm film(size);
                fill(film, sets, seed, 24, [&](int x, int y, uint64_t i, uint32_t set) {
                    const uint64_t pixel = uint64_t(y * size.width + x);
                    return heteroscedastic(x % 12, y, Sampler(pattern, pixel, i, set).get2(film_x));
                });
                spread.add(film.image(), error_of(film).d2());
            }
            const std::string name =
                "sampler " + std::to_string(int(kind)) + ", sets " + std::to_string(sets);
            EXPECT(oracle::expect_mean(1, spread.ratio()).of(name), 0.25);
        }
}

TEST_CASE("the stated d^2 of ratio and regression is that from seed to seed") {
    for (Estimator e : {Estimator::ratio, Estimator::regression})
        for (uint32_t sets : {2u, by_noise}) {
            Spread spread;
            for (uint64_t r = 0; r < 240; ++r) {
                const uint64_t seed = hash(seed_here(), r);
                Film<ShadowPixel> film({12, 12}, {e});
                fill(film, sets, seed, 24, [&](int x, int y, uint64_t i, uint32_t set) {
                    Rng rng{hash(hash(hash(seed, uint64_t(12 * y + x)), set), i)};
                    const real U = real(std::exp2(-0.3 * x)), w = U * real(0.5 + rng.uniform()),
                               V = rng.uniform() < (y + 0.5) / 12,
                               rest = U * real(rng.uniform()) / 8;
                    const rgb grey{1, 1, 1};
                    return ShadowSample{rest * grey, {U * grey, w * grey, w * V * grey}};
                });
                spread.add(film.image(), error_of(film).d2());
            }
            const std::string name =
                "estimator " + std::to_string(int(e)) + ", sets " + std::to_string(sets);
            EXPECT(oracle::expect_mean(1, spread.ratio()).of(name), 0.25);
        }
}

TEST_CASE("the stated d^2 of Voronoi-weighted films is that from seed to seed") {
    for (Weighting weighting : {Weighting::vor, Weighting::cvor, Weighting::torus}) {
        Spread spread;
        for (uint64_t r = 0; r < 600; ++r) {
            const uint64_t seed = hash(seed_here(), r);
            const Pattern pattern{SamplerKind::independent, seed};
            MeanFilm film({6, 6});
            film.add_sets(std::vector<Sets>(36, {2}));
            WeightedPixels weighted(weighting, pattern, 12);
            whole_pass(film, 12, [&](int x, int y, uint64_t i, uint32_t set) {
                const uint64_t pixel = uint64_t(6 * y + x);
                return weighted(pixel, set, i, [&](uint64_t k) {
                    return heteroscedastic(x, y, Sampler(pattern, pixel, k, set).get2(film_x));
                });
            });
            spread.add(film.image(), error_of(film).d2());
        }
        const std::string name = "weighting " + std::to_string(int(weighting));
        EXPECT(oracle::expect_mean(1, spread.ratio()).of(name), 0.4);
    }
}

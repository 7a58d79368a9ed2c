// voronoi/weighted_test.cpp  a pixel's weighted mean: sum of w L, with the weights of its own
// samples
#include "voronoi/weighted.h"

#include <doctest/doctest.h>

TEST_CASE("weighted pixels add up to n sum w L for every set of each, and constants to n") {
    for (Weighting film : {Weighting::vor, Weighting::fvor, Weighting::cvor, Weighting::torus})
        for (uint64_t spp : {1, 2, 9, 64}) {
            const Pattern pattern{SamplerKind::independent, 7};
            WeightedPixels weighted(film, pattern, spp);
            for (int k = 0; k < 10; ++k) {
                const uint64_t pixel = uint64_t(10 + k / 2);
                const uint32_t set = uint32_t(k % 2);
                auto place = [&](uint64_t i) {
                    return Sampler(pattern, pixel, i, set).get2(film_x);
                };
                auto L = [&](uint64_t i) { return rgb{1, place(i).x, real(i % 3)}; };
                rgb sum;
                for (uint64_t i = 0; i < spp; ++i) sum += weighted(pixel, set, i, L);
                std::vector<Site> places;
                for (uint64_t i = 0; i < spp; ++i)
                    places.push_back({double(place(i).x), double(place(i).y)});
                Weigher weigher;
                const auto& w = weigher(film, places,
                                        hash(hash(hash(0, pattern.seed), pixel), UINT64_MAX - set));
                double expected = 0, third = 0;
                for (uint64_t i = 0; i < spp; ++i) {
                    expected += double(spp) * w[i] * places[i].x;
                    third += double(spp) * w[i] * double(i % 3);
                }
                const double n = double(spp), allowed = 64 * n * double(ulp);
                CHECK(std::abs(double(sum.x) - n) <= allowed);
                CHECK(std::abs(double(sum.y) - expected) <= allowed);
                CHECK(std::abs(double(sum.z) - third) <= 3 * allowed);
            }
        }
}

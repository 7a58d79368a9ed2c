// voronoi/weighted_test.cpp  a pixel's weighted mean: sum of w L, with the weights of its own
// samples
#include "voronoi/weighted.h"

#include <doctest/doctest.h>

TEST_CASE("a weighted row adds up to n sum w L for every set of every pixel, and constants to n") {
    const int width = 5;
    const int y = 2;
    for (Weighting film : {Weighting::vor, Weighting::fvor, Weighting::cvor, Weighting::torus})
        for (uint64_t spp : {1, 2, 9, 64}) {
            const Pattern pattern{SamplerKind::independent, 7};
            auto place = [&](int x, uint64_t i, uint32_t set) {
                return Sampler(pattern, uint64_t(y * width + x), i, set).get2(film_x);
            };
            auto L = [&](int x, uint64_t i, uint32_t set) {
                return rgb{1, place(x, i, set).x, real(i % 3)};
            };
            WeightedRow row(film, pattern, spp, uint64_t(y * width), L);
            for (int k = 0; k < 2 * width; ++k) {
                const int x = k / 2;
                const uint32_t set = uint32_t(k % 2);
                rgb sum;
                for (uint64_t i = 0; i < spp; ++i) sum += row(x, i, set);
                std::vector<Site> places;
                for (uint64_t i = 0; i < spp; ++i)
                    places.push_back({double(place(x, i, set).x), double(place(x, i, set).y)});
                Weigher weigher;
                const uint64_t pixel = uint64_t(y * width + x);
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

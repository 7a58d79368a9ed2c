// weighted_test.cpp  a pixel's weighted mean: sum of w L, with the weights of its own samples
#include "../src/weighted.h"

#include <doctest/doctest.h>

namespace {

Options options(Weighting film, uint64_t spp) {
    Options o;
    o.film = film;
    o.spp = spp;
    o.sampler = SamplerKind::independent;
    o.seed = 7;
    return o;
}

}  // namespace

TEST_CASE("a weighted row adds up to n sum w L for every pixel, and constants to n") {
    const Size size = {5, 4};
    const int y = 2;
    for (Weighting film : {Weighting::vor, Weighting::fvor, Weighting::cvor, Weighting::torus})
        for (uint64_t spp : {1, 2, 9, 64}) {
            const Options o = options(film, spp);
            const Pattern pattern{SamplerKind::independent, o.seed};
            auto place = [&](int x, uint64_t i) {
                return Sampler(pattern, uint64_t(y * size.width + x), i).get2(film_x);
            };
            auto L = [&](int x, uint64_t i) { return rgb{1, place(x, i).x, real(i % 3)}; };
            WeightedRow row(o, pattern, size, y, L);
            for (int x = 0; x < size.width; ++x) {
                rgb sum;
                for (uint64_t i = 0; i < spp; ++i) sum += row(x, i);
                std::vector<Site> places;
                for (uint64_t i = 0; i < spp; ++i)
                    places.push_back({double(place(x, i).x), double(place(x, i).y)});
                Weigher weigher;
                const uint64_t pixel = uint64_t(y * size.width + x);
                const auto& w =
                    weigher(film, places, hash(hash(hash(0, o.seed), pixel), UINT64_MAX));
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

TEST_CASE("--film other than mc: independent samples, their number known, no variance") {
    auto parse = [](std::vector<std::string> words) {
        words.insert(words.end(), {"--sampler", "independent", "x.scene"});
        return parse_options(words);
    };
    CHECK(parse({}).film == Weighting::mc);
    CHECK(parse({"--film", "fvor"}).film == Weighting::fvor);
    CHECK(parse({"--film", "mc", "--time", "1"}).film == Weighting::mc);
    for (const char* film : {"vor", "fvor", "cvor", "torus"}) {
        CHECK_THROWS_AS(parse({"--film", film, "--time", "1"}), UserError);
        CHECK_THROWS_AS(parse({"--film", film, "--spp", "2000000"}), UserError);
        CHECK_THROWS_AS(parse({"--film", film, "--view", "variance"}), UserError);
        CHECK_THROWS_AS(parse_options({"--film", film, "x.scene"}), UserError);
    }
    CHECK_THROWS_AS(parse({"--film", "voronoi"}), UserError);
}

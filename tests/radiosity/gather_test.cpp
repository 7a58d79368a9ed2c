// radiosity/gather_test.cpp  final gathering: its error is that of the maps, averaged over a bounce
#include "radiosity/gather.h"

#include "base/moments.h"
#include "oracle/expect.h"
#include "radiosity/particles.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

// Walls that glow, seen from inside: everywhere L = Le + rho L.
constexpr double glow = 0.4 / (1 - 0.5);
Scene glowing() {
    Scene s = room({3, 2, 2}, diffuse(grey(0.5), grey(0.4), true));
    s.camera = look_at({1, 1, real(1.9)}, {1, 1, 0}, 60);
    s.size = {8, 8};
    s.depth = 1;
    return s;
}

// E = pi L on the inner sides, times a factor; outside it is dark.
KnownLight maps_of(const Scene& s, rgb factor) {
    Mesh mesh = make_mesh(s, 1);
    IlluminationMap map(number_of_sides(mesh));
    for (size_t k = 0; k < map.size(); k += 2) map[k] = pi * real(glow) * factor;
    return known_light(s, std::move(mesh), std::move(map));
}

const Technique by_hitting{Direction::bsdf, LightMode::none, 0};
const Technique techniques[] = {{Direction::bsdf, LightMode::mis, 0},
                                {Direction::uniform, LightMode::mis, 0}};

}  // namespace

TEST_CASE("known light is rho E / pi on both sides of every face") {
    const Scene s = glowing();
    Mesh mesh = make_mesh(s, 1);
    const size_t sides = number_of_sides(mesh);
    for (const rgb& R : known_light(s, std::move(mesh), IlluminationMap(sides, grey(3))).R)
        CHECK(double(R.x) == approx(1.5 / double(pi)));
}

TEST_CASE("maps that are exact leave nothing to chance: a furnace, its light found by hitting") {
    const Scene s = glowing();
    const KnownLight known = maps_of(s, grey(1));
    const SamplerSettings settings = sampler_settings(SamplerKind::independent, seed_here(), 1);
    const SampleFunction L = final_gather(s, by_hitting, known, settings);
    for (uint64_t i = 0; i < 200; ++i) {
        Tally tally;
        CHECK(double(L({int(i % 8), int(i / 8 % 8), i}, tally).x) == approx(glow));
        CHECK(tally.rays == 2);
    }
}

TEST_CASE("paths end on what the maps hold, whatever that is") {
    const Scene s = glowing();
    for (const rgb factor : {grey(1), grey(0), rgb{3, 2, -1}}) {
        const KnownLight known = maps_of(s, factor);
        for (const Technique& t : techniques)
            for (SamplerKind kind : all_samplers) {
                constexpr uint64_t n = 64;
                constexpr int replicates = 256;
                std::vector<rgb> means;
                for (int r = 0; r < replicates; ++r) {
                    const SamplerSettings settings =
                        sampler_settings(kind, hash(seed_here(), uint64_t(r)), 1);
                    const SampleFunction L = final_gather(s, t, known, settings);
                    rgb sum;
                    Tally tally;
                    for (uint64_t i = 0; i < n; ++i) sum += L({3, 4, i}, tally);
                    means.push_back(sum / real(n));
                }
                for (size_t c = 0; c < 3; ++c) {
                    // The sum of Le, of Le after one bounce, and of rho times the maps' light.
                    const double known_light = 0.5 * glow * double(factor.*axis[c]),
                                 truth = 0.4 + 0.5 * (0.4 + known_light);
                    CAPTURE(int(t.light));
                    CAPTURE(int(kind));
                    auto mean = [&](int r) { return double(means[size_t(r)].*axis[c]); };
                    EXPECT(oracle::expect_replicates(truth, replicates, mean), 0.2);
                }
            }
    }
}

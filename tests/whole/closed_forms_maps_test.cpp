// whole/closed_forms_maps_test.cpp  paths that end on maps meet closed forms of diffuse triangles
#include "base/moments.h"
#include "labs/indirect_paths.h"
#include "oracle/expect.h"
#include "path/samplers.h"
#include "radiosity/particles.h"
#include "text/scene_file.h"
#include "whole/known_scenes.h"

using namespace closed_forms;

namespace {

// A scene that maps support, and its radiance for unlimited bounces.  In most of these scenes light
// scatters at most once.
struct Endless {
    std::string name;
    NamedScene scene;
    double truth;
    const Known* known;
};
std::vector<Endless> endless_scenes(const std::vector<Known>& rows) {
    std::vector<Endless> list;
    for (const Known& k : rows) {
        NamedScene s = parse_scene(k.text, k.name).scene;
        const bool triangles =
            std::none_of(s.shapes.begin(), s.shapes.end(), [](const Shape& x) { return x.r > 0; });
        if (!triangles || s.depth == 0) continue;
        check_diffuse(s, k.name);
        const bool closed = std::string_view(k.name) == "closed room, point light";
        const double more = closed ? 1 / (1 - 0.7) / geometric(0.7, 3) : 1;
        s.depth = std::numeric_limits<int>::max();
        list.push_back({k.name, std::move(s), k.truth * more, &k});
    }
    return list;
}

// Maps for the ends of paths, with a wrong scale: 0, or a multiple of the particles' map.
KnownLight maps_of(const Scene& scene, double scale) {
    Mesh mesh = make_mesh(scene, double(diagonal(scene)) / 8);
    constexpr uint64_t n = 4096;
    Particles p(scene, mesh, Particles::settings(SamplerKind::halton, hash(seed_here(), 1)));
    for (size_t batch = 0; batch < Particles::batches; ++batch) p.add(batch, Particles::of_each(n));
    IlluminationMap map = p.map();
    for (rgb& E : map) E = E * real(scale);
    return known_light(scene, std::move(mesh), std::move(map));
}

// One sample of the known radiance.
double measure(const Endless& e, const Gather& g, const SamplerSettings& settings,
               const SamplerSettings& rest, uint64_t i) {
    const Sampler first(settings, 0, i);
    const EndlessNumbers u(first, Sampler(rest, 0, i));
    const vec2 film = first.get2(film_x);
    const Ray ray = e.known->start ? e.known->start(film)
                                   : camera_ray(e.scene.camera, e.scene.size, film.x, film.y);
    return double(mean_of(Li(g, ray, u)));
}

}  // namespace

TEST_CASE("paths that end on maps meet every closed form of diffuse triangles") {
    const std::vector<Known> rows = known_scenes();
    const std::vector<Endless> scenes = endless_scenes(rows);
    CHECK(scenes.size() >= 11);
    for (const Endless& e : scenes)
        for (double scale : {0.0, 1.0, 3.0})
            for (SamplerKind kind : samplers) {
                const KnownLight known = maps_of(e.scene, scale);
                const bool nee = !e.known->no_nee && kind == SamplerKind::halton;
                Gather g{e.scene, {Direction::bsdf, LightMode::mis, 0}, known};
                g.technique.light = nee ? LightMode::nee : LightMode::mis;
                INFO(e.name, ", scale ", scale, ", sampler ", int(kind));
                EXPECT(oracle::expect_replicates(
                           e.truth, 64,
                           [&](int r) {
                               const uint64_t n = 16 * uint64_t(e.known->aimed);
                               const uint64_t seed = hash(seed_here(), uint64_t(r));
                               const SamplerSettings settings =
                                                         EndlessNumbers::settings(kind, seed),
                                                     rest = EndlessNumbers::independent(seed);
                               double sum = 0;
                               for (uint64_t i = 0; i < n; ++i)
                                   sum += measure(e, g, settings, rest, i);
                               return sum / double(n);
                           }),
                       0.3);
            }
}

// radiosity/solution.h  8  from options to illumination maps, their summary and statistics
#pragma once
#include "app/render.h"
#include "app/threads.h"
#include "radiosity/mesh_view.h"
#include "radiosity/options.h"
#include "radiosity/shooting.h"
#include "radiosity/walks.h"

namespace penumbra {

// ---- The scene ----------------------------------------------------------------------------------

struct Stage {
    NamedScene scene;  // triangles only
    Mesh mesh;
    double H = 0;      // longest edge
    double bytes = 0;  // memory of mesh and solution
};

// The longest edge: a part of the scene's diagonal unless --mesh is given.  Throws UserError if the
// scene is not diffuse, its error is not bounded, or the mesh does not fit into memory.
inline double edge_length(const RadiosityOptions& o, const NamedScene& scene, const Bytes& bytes) {
    if (const uint32_t line = line_of_white(scene); line && o.error > 0 && !is_random(o))
        throw UserError("--error: " + o.scene + ":" + std::to_string(line) +
                        ": reflects all light, so that nothing bounds the unshot power: use "
                        "--method particles");
    check_diffuse(scene, o.scene);
    const double H = o.mesh.value_or(double(diagonal(scene)) / (o.final_gather ? 16 : 32));
    try {
        check_fits(scene, H, bytes, bytes_of_machine());
    } catch (const UserError& e) {
        throw UserError((o.mesh ? "--mesh: " : "--mesh, by default: ") + std::string(e.what()));
    }
    return H;
}

inline Bytes bytes_of(const RadiosityOptions& o) {
    return is_random(o) ? Particles::bytes() : Shooting::bytes();
}

inline Stage stage_of(const RadiosityOptions& o, const NamedScene& scene, double H) {
    Faceted facets = faceted(scene, H);
    for (const std::string& w : facets.warnings) tell(o, o.scene + ":" + w);
    Stage stage{std::move(facets.scene), {}, H, bytes_of(o).of(sizes(scene, H))};
    stage.mesh = make_mesh(stage.scene, H);
    return stage;
}

// ---- Methods ------------------------------------------------------------------------------------

// The result of a method; NaN: not known.
struct Solution {
    IlluminationMap map;
    uint64_t shots = 0, particles = 0, rays = 0;
    double unshot = NAN, seconds = 0, cpu_seconds = 0;
    MapError stated = {};  // by shooting, an upper bound
    int signal = 0;        // the signal that interrupted it
    bool empty() const { return shots == 0 && particles == 0; }
};

inline std::string shot(uint64_t shots, double unshot) {
    return counted(shots, "shot") + ", " + in_percent(unshot) + " unshot";
}

inline Solution shoot(const RadiosityOptions& o, const Stage& stage) {
    const Shooter shooter = o.method == Method::shooting ? Shooter::element : Shooter::face;
    Shooting solver(stage.scene, stage.mesh, shooter, o.threads);
    Progress progress(o.seconds, o.quiet);
    solver.run({o.unshot, o.seconds, o.shots, o.error}, [&](const Shooting& now) {
        const double unshot = now.unshot();
        // It falls by about the same factor from shot to shot.
        double done = o.shots ? double(now.shots()) / double(o.shots) : 0;
        if (o.unshot > 0 && unshot > 0)
            done = std::max(done, std::log(unshot) / std::log(o.unshot));
        if (o.error > 0) done = std::max(done, std::log(now.error()) / std::log(o.error));
        progress.show(done, shot(now.shots(), unshot));
    });
    Solution s{solver.map()};
    s.shots = solver.shots(), s.rays = solver.rays(), s.unshot = solver.unshot();
    s.stated.error = solver.error();
    s.seconds = progress.elapsed();
    return s;
}

inline Solution walk(const RadiosityOptions& o, const Stage& stage, SamplerKind kind, uint64_t seed,
                     const WalksTarget& target) {
    const SamplerSettings settings = Particles::settings(kind, seed);
    Walked w = walk_all(stage.scene, stage.mesh, settings, target, o);
    Solution s{std::move(w.map)};
    s.particles = w.particles, s.rays = w.rays, s.stated = w.stated, s.seconds = w.seconds;
    return s;
}

inline Solution solve(const RadiosityOptions& o, const Stage& stage) {
    const double before = cpu_seconds();
    Solution s = is_random(o) ? walk(o, stage, o.sampler, o.seed, {o.particles, o.seconds, o.error})
                              : shoot(o, stage);
    s.cpu_seconds = cpu_seconds() - before;
    s.signal = interrupted;
    return s;
}

// Maps for final gathering: unless --particles is given, one particle for 16 paths, or a sixteenth
// of the time.  All pixels share the noise of the maps; it is then small against that of the paths
// (by `make indirect`).  With --error the number of samples is not known: at most the scene's.
inline WalksTarget walks_of(const RadiosityOptions& o, const NamedScene& scene) {
    if (o.particles > 0) return {o.particles, o.seconds};
    uint64_t N = o.spp > 0 || o.seconds > 0 ? o.spp : scene.samples;
    if (o.error > 0) N = o.spp > 0 ? std::min<uint64_t>(o.spp, scene.samples) : scene.samples;
    const double pixels = double(scene.size.width) * double(scene.size.height);
    return {uint64_t(std::min(0x1p62, std::ceil(pixels * double(N) / 16))), o.seconds / 16};
}

// ---- Summary and statistics ---------------------------------------------------------------------

// The option that ended the run; "": there was no light left, or none at all.
inline std::string stopped_by(const RadiosityOptions& o, const Solution& s) {
    if (s.signal) return "signal";
    if (o.error > 0 &&
        (is_random(o) ? ErrorTarget(o.error).met(s.stated) : s.stated.error <= o.error))
        return "--error";
    if (o.unshot > 0 && s.unshot <= o.unshot) return "--unshot";
    if (o.shots > 0 && s.shots >= o.shots) return "--shots";
    if (o.particles > 0 && s.particles >= o.particles) return "--particles";
    return o.seconds > 0 && s.seconds >= o.seconds ? "--time" : "";
}

inline std::string error_of(const RadiosityOptions& o, const Solution& s) {
    if (!std::isfinite(s.stated.error)) return "error not known";
    const std::string words = is_random(o) ? "estimated " + error_words(s.stated)
                                           : "error at most " + in_percent(s.stated.error);
    return words + ", without the error of the mesh";
}

inline std::string summary(const RadiosityOptions& o, const Mesh& mesh, const Solution& s) {
    std::string line = o.scene + ": " + std::to_string(mesh.elements()) + " triangles, " +
                       (is_random(o) ? counted(s.particles, "particle") : shot(s.shots, s.unshot)) +
                       ", " + fixed(s.seconds, 2) + " s, " +
                       fixed(double(s.rays) / s.seconds * 1e-6, 2) + " Mrays/s, ";
    const std::string by = stopped_by(o, s), error = error_of(o, s);
    if (s.signal) return line + error + " (interrupted)";
    return line + (o.error > 0 && !by.empty() ? outcome_words(o.error, by, error) : error);
}

inline std::string encode_stats(const RadiosityOptions& o, const OptionTable& table,
                                const Stage& stage, const Solution& s,
                                const std::array<double, 3>& mean) {
    json::Object object = asked_for(table, o.scene, stage.scene.size);
    auto count = [](auto n) { return std::to_string(n); };
    const std::string by = stopped_by(o, s);
    for (const auto& [key, value] :
         Facts{{"rays_per_pixel", count(o.rays * o.rays)},
               {"mesh", json::number(stage.H)},
               {"faces", count(stage.mesh.faces.size())},
               {"elements", count(stage.mesh.elements())},
               {"vertices", count(stage.mesh.vertices())},
               {"bytes", json::number(stage.bytes)},
               {"precision", sizeof(real) == 4 ? "\"float\"" : "\"double\""},
               {"interrupted", json::truth(s.signal != 0)},
               {"shots", count(s.shots)},
               {"unshot", json::number(s.unshot)},
               {"particles", count(s.particles)},
               {"error", json::number(s.stated.error)},
               {"error_uncertainty", json::number(s.stated.uncertainty)},
               {"error_asked", o.error > 0 ? json::number(o.error) : "null"},
               {"bias", "\"biased\""},  // a map is linear on each triangle
               {"stopped_by", by.empty() ? "null" : json::string(by)},
               {"seconds", json::number(s.seconds)},
               {"cpu_seconds", json::number(cpu_seconds())},
               {"map_cpu_seconds", json::number(s.cpu_seconds)},
               {"rays", count(s.rays)},
               {"mrays_per_second", json::number(double(s.rays) / s.seconds * 1e-6)},
               {"mean_of_image", json::numbers(mean)},
               {"peak_memory_bytes", count(peak_memory_bytes())}})
        object.add(key, value);
    return object.text();
}

}  // namespace penumbra

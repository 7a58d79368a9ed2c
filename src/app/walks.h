// app/walks.h  3  the scene of triangles that maps need, and particles that fill them, with a bar
#pragma once
#include "app/report.h"
#include "radiosity/particles.h"

// ---- The scene ----------------------------------------------------------------------------------

// How long edges of the triangles are, a part of the scene's diagonal unless --mesh says it; throws
// UserError if the scene, read from `name`, is none for illumination maps, or its mesh none for
// this machine.
inline double edge_length(const std::string& name, const Scene& scene, std::optional<double> mesh,
                          int parts, const Bytes& bytes) {
    check_diffuse(scene, name);
    const double H = mesh.value_or(double(diagonal(scene)) / parts);
    try {
        check_fits(scene, H, bytes, bytes_of_machine());
    } catch (const UserError& e) {
        throw UserError((mesh ? "--mesh: " : "--mesh, by default: ") + std::string(e.what()));
    }
    return H;
}

// ---- Particles ----------------------------------------------------------------------------------

// How far it is, for the bar and for the line that stays.
inline std::string walked(uint64_t particles, double error) {
    return std::to_string(particles) + " particles" +
           (std::isfinite(error) ? ", error " + percent(error) : "");
}

// What walks stop after, whichever comes first; 0: no limit.
struct WalksTarget {
    uint64_t particles = 0;
    double seconds = 0;
};

// Particles, as render() fills a film and shows how far it is.
class Walks {
public:
    Walks(const WalksTarget& target, bool quiet, Particles& particles)
        : quiet_(quiet),
          limit_(target.particles),
          particles_(particles),
          bar_(target.seconds, quiet) {}

    const Size size{1, Particles::batches};
    uint64_t samples() const { return particles_.samples(); }
    uint64_t non_finite() const { return particles_.non_finite(); }

    // The error takes time of its own: it is asked for when the particles have doubled.
    void end_pass(uint64_t n) {
        particles_.end_pass(n);
        if (quiet_ || samples() < 2 * of_ || elapsed() < 1) return;
        of_ = samples();
        error_ = particles_.error();
    }

    double elapsed() const { return bar_.elapsed(); }

    // In the meantime it falls like 1 / sqrt(n).
    void show(double samples) {
        const double n = samples * Particles::batches;
        bar_.show(limit_ ? n / double(limit_) : 0,
                  walked(uint64_t(n), error_ * std::sqrt(double(of_) / samples)));
    }

private:
    const bool quiet_;
    const uint64_t limit_;
    Particles& particles_;
    Progress bar_;
    uint64_t of_ = 0;  // samples at which the error was that
    double error_ = NAN;
};

// A map that particles filled, and what it took.
struct Walked {
    IlluminationMap map;  // black if none walked
    uint64_t particles = 0, rays = 0;
    double error = NAN, seconds = 0;  // see Particles::error
};

// Lets particles walk until the target is met, or `interrupted`.
inline Walked walk_all(const Scene& scene, const Mesh& mesh, const Pattern& pattern,
                       const WalksTarget& target, const CommonOptions& o) {
    Particles particles(scene, mesh, pattern);
    Walks walks(target, o.quiet, particles);
    // Maps of fewer in a batch are nothing but noise.
    constexpr uint64_t least = 256;
    const Passes passes{{Particles::of_each(target.particles), target.seconds},
                        least * pattern.period(),
                        o.threads};
    if (!scene.lights.empty())
        render(
            walks, passes, [&](int batch, uint64_t n) { particles.add(batch, n); }, walks);
    Walked w{{}, particles.particles(), particles.rays()};
    w.map = w.particles > 0 ? particles.map() : IlluminationMap(number_of_sides(mesh));
    w.error = particles.error();
    w.seconds = walks.elapsed();
    return w;
}

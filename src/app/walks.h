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
inline std::string walked(uint64_t particles, const MapError& e) {
    std::string words = std::to_string(particles) + " particles";
    if (std::isfinite(e.error)) words += ", error " + percent(e.error);
    if (std::isfinite(e.uncertainty)) words += " ± " + percent(e.uncertainty);
    return words;
}

// What walks stop after, whichever comes first; 0: no limit.
struct WalksTarget {
    uint64_t particles = 0;
    double seconds = 0;
    double error = 0;  // of the map, see Particles::stated
};

// When to look at the error: one that is asked for is met once it is reached with more than its own
// uncertainty on top, for a run ends where its error looks small.
class ErrorTarget {
public:
    explicit ErrorTarget(double error) : asked_(error) {}

    // Particles of each batch before which nobody looks.  An error does not tell of light that no
    // particle has carried: a part p of all power, on a part a of the surfaces, is p^2 / a of
    // |E|^2, and goes unseen with the probability exp(-16 least p).
    static constexpr uint64_t least = 4096;

    bool met(const MapError& e) const { return at_most(e) <= asked_; }

    // The part of all work that n particles are, by 1 / sqrt(n) (Halton's are faster).
    double done(const MapError& e) const { return sqr(asked_ / at_most(e)); }

    // After a look at n, which was not enough: a little early by 1 / sqrt(n), so that a look that
    // errs is followed by another one; by no less than 4 %, 2 % of the error, so that looks are few
    // beside the walks.
    uint64_t next(uint64_t n, const MapError& e) const {
        const double more = std::clamp(0.9 / done(e), 1.04, 4.0);
        return uint64_t(std::ceil(double(n) * more));
    }

private:
    const double asked_;
    // By measurement (reference/radiosity-error.md): a run's error is itself a draw, which spreads
    // as the error of one of 16 batches would, so that 95 % of runs are to come to at most 1.05 E.
    static constexpr double margin = 1.5;
    static double at_most(const MapError& e) {
        const double sum = e.error + margin * e.uncertainty;
        return std::isnan(sum) ? double(INFINITY) : sum;
    }
    static double sqr(double x) { return x * x; }
};

// Particles, as render() fills a film and shows how far it is.
class Walks {
public:
    Walks(const WalksTarget& target, bool quiet, Particles& particles)
        : quiet_(quiet), target_(target), particles_(particles), bar_(target.seconds, quiet) {}

    size_t blocks() const { return particles_.blocks(); }
    uint64_t samples() const { return particles_.samples(); }
    uint64_t non_finite() const { return particles_.non_finite(); }

    void begin_pass(uint64_t n) { particles_.begin_pass(n); }
    // The error takes time of its own: it is asked for when the particles have doubled.
    void end_pass(uint64_t n) {
        particles_.end_pass(n);
        if (!quiet_ && samples() >= 2 * of_ && elapsed() >= 1) look();
    }

    // The error as it is now.
    const MapError& look() {
        if (of_ != samples()) error_ = particles_.stated(), of_ = samples();
        return error_;
    }

    double elapsed() const { return bar_.elapsed(); }

    // In the meantime it falls like 1 / sqrt(n).
    void show(double samples) {
        const double n = samples * Particles::batches, since = double(of_) / samples;
        double done = target_.particles ? n / double(target_.particles) : 0;
        if (target_.error > 0 && of_ > 0)
            done = std::max(done, ErrorTarget(target_.error).done(error_) / since);
        const double falls = std::sqrt(since);
        bar_.show(done, walked(uint64_t(n), {error_.error * falls, error_.uncertainty * falls}));
    }

private:
    const bool quiet_;
    const WalksTarget target_;
    Particles& particles_;
    Progress bar_;
    uint64_t of_ = 0;  // samples at which the error was that
    MapError error_;
};

// A map that particles filled, and what it took.
struct Walked {
    IlluminationMap map;  // black if none walked
    uint64_t particles = 0, rays = 0;
    MapError stated = {};
    double error = NAN, seconds = 0;  // the error stated
};

// Lets particles walk until the target is met, or `interrupted`.
inline Walked walk_all(const Scene& scene, const Mesh& mesh, const Pattern& pattern,
                       const WalksTarget& target, const CommonOptions& o) {
    Particles particles(scene, mesh, pattern);
    Walks walks(target, o.quiet, particles);
    // Maps of fewer in a batch are nothing but noise.
    const uint64_t least = 256 * pattern.period(), limit = Particles::of_each(target.particles);
    auto walk_to = [&](uint64_t samples) {
        render(
            walks, {{samples, target.seconds}, least, o.threads},
            [&](size_t batch, uint64_t n) { particles.add(batch, n); }, walks);
        return walks.samples() == samples;
    };
    // Whole grids, but for the limit.
    auto reachable = [&](uint64_t samples) {
        const uint64_t grid = pattern.period(), whole = (samples + grid - 1) / grid * grid;
        return limit ? std::min(whole, limit) : whole;
    };
    const ErrorTarget enough(target.error);
    uint64_t to = target.error > 0 ? reachable(ErrorTarget::least) : limit;
    if (!scene.lights.empty())
        while (walk_to(to) && to != limit && !enough.met(walks.look()))
            to = reachable(enough.next(to, walks.look()));
    Walked w{{}, particles.particles(), particles.rays()};
    w.map = w.particles > 0 ? particles.map() : IlluminationMap(number_of_sides(mesh));
    w.stated = particles.stated();
    w.error = w.stated.error;
    w.seconds = walks.elapsed();
    return w;
}

// radiosity/walks.h  7  particles walk until a target is met, with a bar
#pragma once
#include "app/report.h"
#include "app/threads.h"
#include "radiosity/particles.h"

namespace penumbra {

inline std::string in_percent(double x) { return significant(100 * x, 3) + " %"; }
// "error 2.9 % ± 0.05 %"
inline std::string error_words(const MapError& e) {
    return "error " + in_percent(e.error) +
           (std::isfinite(e.uncertainty) ? " ± " + in_percent(e.uncertainty) : "");
}

// Progress for the bar.
inline std::string walked(uint64_t particles, const MapError& e) {
    return counted(particles, "particle") + (std::isfinite(e.error) ? ", " + error_words(e) : "");
}

// Limits of walks, whichever comes first; 0: no limit.
struct WalksTarget {
    uint64_t particles = 0;
    double seconds = 0;
    double error = 0;  // error of the map, see Particles::stated
};

// The error checks.  An error is met once the estimate plus 1.5 times its uncertainty is at most
// the error wanted: a run ends where its estimate happens to be small.
class ErrorTarget {
public:
    explicit ErrorTarget(double error) : asked_(error) {}

    // Particles of each batch before the first check.  The estimate does not contain light that no
    // particle has carried: a part p of all power, on a part a of the surfaces, is p^2 / a of
    // |E|^2, and is missed with probability exp(-16 least p).
    static constexpr uint64_t least = 4096;

    bool met(const MapError& e) const { return at_most(e) <= asked_; }

    // Fraction of all work done, by 1 / sqrt(n); Halton points converge faster.
    double done(const MapError& e) const { return std::pow(asked_ / at_most(e), 2); }

    // The next check after n particles, a little early by 1 / sqrt(n), because a check may err.  At
    // least 4 % more particles, 2 % of the error, so that checks take little time.
    uint64_t next(uint64_t n, const MapError& e) const {
        const double more = std::clamp(0.9 / done(e), 1.04, 4.0);
        return uint64_t(std::ceil(double(n) * more));
    }

private:
    const double asked_;
    // By measurement (reference/radiosity-error.md): 95 % of runs end at an error of at most 1.05
    // E. A run's error is itself random, with the spread of the error of one of 16 batches.
    static constexpr double margin = 1.5;
    static double at_most(const MapError& e) {
        const double sum = e.error + margin * e.uncertainty;
        return std::isnan(sum) ? double(INFINITY) : sum;
    }
};

// A map that particles filled, and what it took.
struct Walked {
    IlluminationMap map;  // black if none walked
    uint64_t particles = 0, rays = 0;
    MapError stated = {};
    double seconds = 0;
};

class Walks {
public:
    // All arguments except the target must outlive it.
    Walks(const Scene& scene, const Mesh& mesh, const SamplerSettings& settings,
          const WalksTarget& target, const CommonOptions& o)
        : target_(target),
          o_(o),
          particles_(scene, mesh, settings),
          bar_(target.seconds, o.quiet) {}

    // Until the target is met, or `interrupted`.
    void run() {
        const ErrorTarget enough(target_.error);
        const uint64_t limit = Particles::of_each(target_.particles);
        auto reachable = [&](uint64_t n) { return limit ? std::min(n, limit) : n; };
        uint64_t to = target_.error > 0 ? reachable(ErrorTarget::least) : limit;
        while (walk_to(to) && to != limit && !enough.met(error_now())) {
            if (limit == 0 && target_.seconds == 0 && particles_.is_endless())
                throw UserError(
                    "--error: none of " + std::to_string(particles_.particles()) +
                    " particles lost light in some channel: its light never ends, and its error "
                    "stays unknown; add --particles or --time, or let a surface absorb some");
            to = reachable(enough.next(to, error_now()));
        }
    }

    Walked walked() const {
        Walked w{{}, particles_.particles(), particles_.rays(), particles_.stated()};
        w.map = particles_.map();
        w.seconds = bar_.elapsed();
        return w;
    }

private:
    const WalksTarget target_;
    const CommonOptions& o_;
    static constexpr uint64_t least = 256;  // particles of a pass: maps of fewer are only noise
    Particles particles_;
    Progress bar_;
    uint64_t of_ = 0;  // particles of each batch when error_ was estimated
    MapError error_;

    // The error as it is now.
    const MapError& error_now() {
        if (of_ != particles_.of_each()) error_ = particles_.stated(), of_ = particles_.of_each();
        return error_;
    }

    // Traces until every batch has so many; 0: as many as there is time for.  False: fewer.
    bool walk_to(uint64_t to) {
        for (;;) {
            const uint64_t n = particles_.of_each();
            const double elapsed = bar_.elapsed();
            const bool is_over = n > 0 && target_.seconds > 0 && elapsed >= target_.seconds;
            if (is_over || (n > 0 && n == to)) return n == to;
            const double each = n > 0 ? elapsed / double(n) * least : 0;
            const uint64_t fit = least * end_of_pass(n / least, elapsed, each, target_.seconds),
                           next = to ? std::min(fit, to) : fit;
            const bool complete = by_workers(
                Particles::batches, o_.threads,
                [&](size_t batch, unsigned) { particles_.add(batch, next - n); },
                [&](double part) { show(double(n) + part * double(next - n)); });
            if (!complete) return false;
            // The estimate takes time: it is made when the particles have doubled.
            if (!o_.quiet && next >= 2 * of_ && bar_.elapsed() >= 1) error_now();
        }
    }

    // Between checks the error is taken to fall like 1 / sqrt(n).
    void show(double each) {
        const double n = each * Particles::batches, since = double(of_) / each;
        double done = target_.particles ? n / double(target_.particles) : 0;
        if (target_.error > 0 && of_ > 0)
            done = std::max(done, ErrorTarget(target_.error).done(error_) / since);
        const double falls = std::sqrt(since);
        bar_.show(done, penumbra::walked(uint64_t(n),
                                         {error_.error * falls, error_.uncertainty * falls}));
    }
};

// Without light there are no particles.
inline Walked walk_all(const Scene& scene, const Mesh& mesh, const SamplerSettings& settings,
                       const WalksTarget& target, const CommonOptions& o) {
    Walks walks(scene, mesh, settings, target, o);
    if (!scene.lights.empty()) walks.run();
    return walks.walked();
}

}  // namespace penumbra

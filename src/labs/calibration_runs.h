// labs/calibration_runs.h  4  renders that are stopped where an error was asked for, beside the
// truth
#pragma once
#include <atomic>
#include <thread>

#include "labs/calibration.h"
#include "labs/films.h"
#include "labs/seeds.h"
#include "world/scene_file.h"

// What of(k) is for all k < n, on all cores.
template <class T, class Of>
std::vector<T> over_threads(uint64_t n, Of of) {
    std::vector<T> all(n);
    std::atomic<uint64_t> next = 0;
    std::vector<std::jthread> threads;
    for (unsigned t = 0; t < all_cores(); ++t)
        threads.emplace_back([&] {
            for (uint64_t k; (k = next++) < n;) all[k] = of(k);
        });
    threads.clear();  // joins
    return all;
}

// ---- The truth ----------------------------------------------------------------------------------

// A scene, and the image of it by a long run, whose own error its eight replications
// know.
struct Study {
    std::string name;
    Scene scene;
    Image image;
    uint64_t samples = 0;         // of each replication
    double norm = 0, square = 0;  // of the image: quadratic mean, d^2
    double greatest = 0;          // of one pixel, of that

    double own_error() const { return std::sqrt(square) / norm; }
    // Some of the light comes by so few paths that one pixel has much of all the error.
    bool is_rare() const { return greatest > 0.1; }
    // E|f - g|^2 = d^2 + (own error)^2, for the two are independent.
    double truth2(const Image& f) const { return mse(f, image) - square; }
};

// Until its own error is at most `enough`, or it has so many samples.
inline Study study(const std::string& name, Size size, double enough, uint64_t most) {
    constexpr uint64_t first = 64, other_seed = 1000000;
    Study s{name, read_scene("scenes/" + name + ".scene").scene, {}};
    s.scene.size = size;
    const Pattern pattern = make_pattern(SamplerKind::sobol, other_seed, s.scene.depth, 0);
    const Radiance L = radiance_of(s.scene, {}, pattern);
    Film film = make_film(size, 8);
    ImageError e;
    for (s.samples = first;; s.samples *= 2) {
        fill(film, s.samples, L, all_cores());
        e = error_of(film);
        if (e.d_rel() <= enough || s.samples >= most) break;
    }
    s.image = image_of(film);
    s.norm = e.norm, s.square = e.d2(), s.greatest = e.greatest / e.d2();
    return s;
}

// ---- Runs ---------------------------------------------------------------------------------------

// What one run showed: where each stopper stopped (nothing: it did not), and looks at 8, 32, 128
// ... samples, whatever they show.
struct Run {
    std::vector<std::optional<Look>> stops;
    Looks fixed;
};

inline Look look_at(const Film& film, const ImageError& e, const Study& study) {
    return {film.least_taken(),           0,         e.d2(), e.d2() > 0 ? e.spread / e.d2() / 2 : 0,
            study.truth2(image_of(film)), study.norm};
}

// As penumbra does, on one thread, until all have stopped or there are `most` samples.
inline Run run_until(const Study& study, SamplerKind sampler, uint64_t seed,
                     std::vector<Stopper> stoppers, uint64_t most) {
    const Pattern pattern = make_pattern(sampler, seed, study.scene.depth, 0);
    const Radiance L = radiance_of(study.scene, {}, pattern);
    const double before = thread_seconds();
    Film film = make_film(study.scene.size, 0);
    fill(film, pilot_samples, L);
    choose_sets(film, INFINITY);
    fill(film, first_look, L);
    Run run{std::vector<std::optional<Look>>(stoppers.size()), {}};
    for (uint64_t fixed = first_look;;) {
        const ImageError e = error_of(film);
        Look look = look_at(film, e, study);
        look.seconds = thread_seconds() - before;
        if (look.samples == fixed) run.fixed.push_back(look), fixed *= 4;
        uint64_t next = UINT64_MAX;
        for (size_t k = 0; k < stoppers.size(); ++k) {
            if (stoppers[k].stops(e, look.samples)) run.stops[k] = look;
            if (!stoppers[k].stopped()) next = std::min(next, stoppers[k].next());
        }
        if (next == UINT64_MAX || look.samples >= most) return run;
        fill(film, std::min({next, fixed, most}), L);
    }
}

// Where those that stopped did.
inline Looks stops_of(const std::vector<Run>& runs, size_t stopper) {
    Looks stops;
    for (const Run& r : runs)
        if (r.stops[stopper]) stops.push_back(*r.stops[stopper]);
    return stops;
}

// At so many samples, if all runs went so far: those that did not had stopped for what they saw.
inline Looks at_fixed(const std::vector<Run>& runs, uint64_t samples) {
    Looks looks;
    for (const Run& r : runs)
        for (const Look& l : r.fixed)
            if (l.samples == samples) looks.push_back(l);
    return looks.size() == runs.size() ? looks : Looks();
}

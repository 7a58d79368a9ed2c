// labs/calibration_runs.h  4  renders that are stopped where an error was asked for, beside the
// truth
#pragma once
#include <atomic>
#include <thread>

#include "app/render.h"
#include "labs/calibration.h"
#include "labs/seeds.h"
#include "world/scene_file.h"

struct Silent {
    void show(double) {}
};

// n more samples of every set of the film.
inline void add_samples(Film<MeanPixel>& film, const Job& job, uint64_t n, unsigned threads) {
    Silent silent;
    auto add = [&](size_t block, uint64_t more) {
        film.add_block(block, more, [&](int x, int y, uint64_t i, uint32_t set) {
            uint64_t rays = 0;
            return radiance(job, start(job.scene, job.pattern, {x, y, i, set}), rays);
        });
    };
    if (threads > 1) {
        add_pass(film, n, threads, add, silent);
        return;
    }
    for (size_t block = 0; block < film.blocks(); ++block) add(block, n);
    film.end_pass(n);
}

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

// A scene, and the image of it by a long run, whose own error its eight sets know.
struct Study {
    std::string name;
    Scene scene;
    Image image;
    uint64_t samples = 0;         // of each set
    double norm = 0, square = 0;  // of the image: quadratic mean, d^2
    double greatest = 0;          // of one pixel, of that

    double own_error() const { return std::sqrt(square) / norm; }
    // Some of the light comes by so few paths that one pixel has much of all the error.
    bool is_rare() const { return greatest > 0.1; }
    // E|f - g|^2 = d^2 + (own error)^2, for the two are independent.
    double truth2(const Image& f) const { return mse(f, image) - square; }
};

inline Options options_for(const std::string& sampler, uint64_t seed) {
    Options o = parse_words(option_table, {"--sampler", sampler});
    o.seed = seed;
    o.error = 0.01;  // no samples are known before
    return o;
}

// Until its own error is at most `enough`, or it has so many samples.
inline Study study(const std::string& name, Size size, double enough, uint64_t most) {
    constexpr uint64_t first = 64, other_seed = 1000000;
    Study s{name, read_scene("scenes/" + name + ".scene").scene, {}};
    s.scene.size = size;
    const Options o = options_for("sobol", other_seed);
    for (Light& l : s.scene.lights) l.by_angle = o.polygons == Polygons::angle;
    const Job job = job_of(o, s.scene);
    Film<MeanPixel> film(size);
    film.add_sets(std::vector<Sets>(film.number_of_pixels(), {8}));
    ImageError e;
    for (uint64_t n = first; !(e.d_rel() <= enough) && film.samples() < most; n = film.samples()) {
        add_samples(film, job, n, all_cores());
        e = error_of(film);
    }
    s.image = film.image(), s.samples = film.samples();
    s.norm = e.norm, s.square = e.d2(), s.greatest = e.greatest / e.d2();
    return s;
}

// ---- Runs ---------------------------------------------------------------------------------------

// What one run showed: where each stopper stopped (nothing: it did not), and looks at 16, 64, 256
// ... samples, whatever they show.
struct Run {
    std::vector<std::optional<Look>> stops;
    Looks fixed;
};

inline Look look_at(Film<MeanPixel>& film, const ImageError& e, const Study& study) {
    return {film.samples(),
            0,
            e.d2(),
            e.d2() > 0 ? e.spread / e.d2() / 2 : 0,
            study.truth2(film.image()),
            study.norm};
}

// As fill() does, on one thread, until all have stopped or there are `most` samples.
inline Run run_until(const Study& study, const Options& o, std::vector<Stopper> stoppers,
                     uint64_t most, const Allocation& by) {
    const Job job = job_of(o, study.scene);
    const double before = thread_seconds();
    Film<MeanPixel> film(study.scene.size);
    add_samples(film, job, samples_before_sets, 1);
    film.add_sets(sets_where_noise_is(film.noise(), film.size, o.seed, by));
    add_samples(film, job, 0, 1);
    Run run{std::vector<std::optional<Look>>(stoppers.size()), {}};
    for (uint64_t fixed = samples_before_sets;;) {
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
        add_samples(film, job, std::min({next, fixed, most}) - look.samples, 1);
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

// labs/illumination_truth.h  5  maps against the path tracer, which has no mesh: total errors
#pragma once
#include "labs/illumination_race.h"

namespace illumination {

// Two independent runs together; half their distance is the error of their mean.
struct Pair {
    Image mean;
    double own = 0;
};
inline Pair pair_of(const Image& a, const Image& b) {
    Pair p{a, d_rel(a, b) / 2};
    for (size_t i = 0; i < a.pixels.size(); ++i)
        for (size_t c = 0; c < 3; ++c) p.mean.pixels[i][c] = (a.pixels[i][c] + b.pixels[i][c]) / 2;
    return p;
}

// What is compared: over triangles of edges H, on small images, for their truth is dear.
struct Test {
    std::string scene;
    std::vector<double> H;      // from coarse to fine
    uint64_t spp = 512;         // of each of the truth's two runs
    uint64_t particles = 4000;  // of each of two runs, an element
    Size size = {128, 64};
};

// Path tracing without an end that is felt: (.73)^64 is 10^-9.
inline Rendering traced(const std::string& penumbra, const Test& t, uint64_t spp, uint64_t seed) {
    return rendering(penumbra, {"scenes/" + t.scene + ".scene", "--depth", "64", "--spp",
                                text("%lu", spp), "--seed", text("%lu", seed), "--size",
                                text("%dx%d", t.size.width, t.size.height)});
}
inline double wall_seconds(const Rendering& r) { return stats(r.stats, "seconds")[0]; }

inline Pair truth_of(const std::string& penumbra, const Test& t) {
    const Rendering a = traced(penumbra, t, t.spp, 901), b = traced(penumbra, t, t.spp, 902);
    return pair_of(a.image, b.image);
}

// One camera's image by path tracing, with more and more samples.
inline Curve traced_curve(const std::string& penumbra, const Test& t, const Pair& truth) {
    Curve c;
    for (uint64_t spp : {2, 4, 8, 16, 32, 64}) {
        double square = 0, seconds = 0;
        for (uint64_t seed : {1, 2}) {
            const Rendering r = traced(penumbra, t, spp, seed);
            const double error = without(d_rel(truth.mean, r.image), truth.own);
            square += error * error / 2, seconds += wall_seconds(r) / 2;
        }
        c.add(seconds, std::sqrt(square));
    }
    return c;
}

// A mesh: what is wrong with its solutions, and what they cost.
struct AtH {
    double H = 0;
    size_t elements = 0;
    double limit = 0;  // total error of the particles' limit: discretisation alone
    double floor = 0;  // from that limit to shooting's: where the realistic error stops
    double view = 0;   // seconds to draw a camera's image of a map
    Curve total;       // the total error of the hierarchy
    Curve particles;   // total errors of single runs of particles
    // Of shooting's look at 1 % of unshot power.
    double total_at_1 = 0, realistic_at_1 = 0, optimistic_at_1 = 0, seconds_at_1 = 0;
};

inline double seconds_of_view(const Room& room, const IlluminationMap& map) {
    const Clock::time_point start = Clock::now();
    radiance_image(room.scene, room.mesh, map, 4, all_cores());
    return seconds_since(start);
}

inline AtH at(const Test& t, double H, const Pair& truth) {
    const Room room = illumination::room(t.scene, H, t.size);
    const Eye eye(room);
    AtH r{H, room.mesh.elements(), 0, 0, 0, {}, {}, 0, 0, 0, 0};
    auto run = [&](uint64_t seed, uint64_t n) {
        return fill(room, eye, SamplerKind::halton, seed, n);
    };
    auto total = [&](const Image& image) { return without(d_rel(truth.mean, image), truth.own); };
    const uint64_t n = t.particles * r.elements;
    const Filled a = run(1, n), b = run(2, n);
    const Pair limit = pair_of(a.image, b.image);
    r.limit = without(total(limit.mean), limit.own);
    r.view = seconds_of_view(room, a.map);
    for (uint64_t part : {1024, 256, 64, 16}) {
        const Filled f = run(3, n / part);
        r.particles.add(f.seconds, total(f.image));
    }
    r.particles.add(a.seconds, total(a.image));
    const std::vector<Shot> shots = shoot(room, eye, Shooter::face, unshot_down_to(1e-3), 120);
    const Shot& last = shots.back();
    for (const Shot& s : shots) {
        const double realistic = without(d_rel(limit.mean, s.image), limit.own),
                     optimistic = d_rel(last.image, s.image);
        r.total.add(s.seconds, total(s.image));
        r.floor = realistic;
        if (s.unshot > 0.01 || r.seconds_at_1 > 0) continue;
        r.total_at_1 = total(s.image), r.realistic_at_1 = realistic, r.optimistic_at_1 = optimistic;
        r.seconds_at_1 = s.seconds;
    }
    return r;
}

struct Comparison {
    Test test;
    Pair truth;
    Curve traced;
    std::vector<AtH> meshes;
};

inline Comparison compared(const std::string& penumbra, const Test& t) {
    Comparison c{t, truth_of(penumbra, t), {}, {}};
    c.traced = traced_curve(penumbra, t, c.truth);
    for (double H : t.H) c.meshes.push_back(at(t, H, c.truth));
    return c;
}

// From how many cameras on one solution and its views take less time than as many images of the
// same error by path tracing; none: infinity.
inline double cameras(double solution, double view, double traced) {
    return traced > view ? std::max(1.0, std::ceil(solution / (traced - view))) : INFINITY;
}

}  // namespace illumination

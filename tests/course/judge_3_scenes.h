// course/judge_3_scenes.h  scenes of week 3, and what is asked about paths in them
//
// Scenes stand here, beside what is known of them; the program that answers only builds them.
#pragma once
#include "course/judge.h"

namespace penumbra::course {
namespace {

// ---- Scenes -------------------------------------------------------------------------------------

struct Stuff {
    enum Kind { rough, mirror, glass } kind = rough;
    Triple kd{}, ks{};
    double exponent = 0, ior = 1;
    Triple Le{};
    bool twosided = false;
};

Triple any_colour(Judge& j) { return {j.random(), j.random(), j.random()}; }

Stuff glowing(const Triple& Le, Stuff m = {}) {
    m.Le = Le;
    return m;
}

Out thing(double kind, const Triple& a, const Triple& b, const Triple& c, const Stuff& m) {
    return row(kind, a, b, c, int(m.kind), m.kd, m.ks, m.exponent, m.ior, m.Le, m.twosided);
}
Out ball(const Triple& centre, double r, const Stuff& m) {
    return thing(0, centre, {r, 0, 0}, {}, m);
}
Out quad(const Triple& p, const Triple& u, const Triple& v, const Stuff& m) {
    return thing(1, p, u, v, m);
}
Out point_light(const Triple& p, const Triple& intensity) { return thing(2, p, intensity, {}, {}); }

void build(Judge& j, int depth, const std::vector<Out>& things) {
    Out all{double(depth)};
    for (const Out& t : things) all = row(all, t);
    j.ask("scene", all);
}

// ---- Questions ----------------------------------------------------------------------------------

enum Light { by_chance, by_aiming, by_both };
enum Directions { uniform, by_bsdf };

struct Technique {
    Light light = by_chance;
    Directions directions = by_bsdf;
    double roulette = 0;
    Out numbers() const { return {double(light), double(directions), roulette}; }
};

// A path's ray that was drawn with density pdf after k scatterings, n being the normal it left.
Out path_state(const Triple& o, const Triple& d, const Triple& beta = {1, 1, 1}, int k = 0,
            double pdf = oracle::infinity, const Triple& n = {}) {
    return row(o, d, o, pdf, beta, k, n);
}

// What is asked of path `seed`.
Out question(const Technique& t, uint64_t seed, const Out& more) {
    return row(t.numbers(), seed, more);
}
uint64_t any_seed(Judge& j) { return j.random.bits() >> 32; }
Out ray(const Triple& o, const Triple& d) { return row(o, d); }

// Who computes in float here and there is as right: errors of some roundings, and of 1e-6, are
// none.
double tolerance(const Judge& j, double roundings = 1e4) {
    return std::max(1e-6, roundings * j.epsilon);
}
// Which factor they are off by, if it is one for all, and what may have been forgotten.
std::string off_by(In came, In expected, const std::vector<oracle::Factor>& factors = {}) {
    double factor = 0;
    for (size_t i = 0; i < came.size(); ++i)
        if (std::abs(expected[i]) > 1e-9) factor = came[i] / expected[i];
    for (size_t i = 0; i < came.size(); ++i)
        if (!(std::abs(came[i] - factor * expected[i]) <= 1e-6 * std::abs(came[i]) + 1e-12))
            return "";
    if (factor == 0 || !std::isfinite(factor)) return "";
    return ", " + oracle::detail::times(factor, 1e-5) + " times as much" +
           oracle::detail::cause_of(factor, 1e-5, factors);
}
// A colour.
void colour(Judge& j, const std::string& what, const Triple& came, const Triple& expected,
            const std::vector<oracle::Factor>& factors = {}) {
    j.vector(what, came, expected, tolerance(j));
    if (!j.items.back().right) j.items.back().seen += off_by(came, expected, factors);
}

// Numbers, of which the first that is wrong is told.
void all_near(Judge& j, const std::string& what, const Out& came, const Out& expected) {
    size_t at = 0;
    while (at + 1 < came.size() && near(came[at], expected[at], tolerance(j))) ++at;
    j.number(what, came.at(at), expected.at(at), tolerance(j));
}

// What happened at a vertex.
struct Step {
    bool goes_on;
    double weight;
    Triple Le, direct, beta;
    Triple along, normal;  // where the path goes on, in the world
    Out next;
    Triple f, wi;  // wi is local
    double pdf;
    Triple factor() const { return std::abs(wi[2]) / pdf * f; }
};
Step step(In x) {
    return {x[1] != 0,     x[2],          triple(x, 3),  triple(x, 6),
            triple(x, 25), triple(x, 9),  triple(x, 12), Out(x.begin() + 15, x.begin() + 32),
            triple(x, 32), triple(x, 35), x[38]};
}
Step take_step(Judge& j, const Technique& t, uint64_t seed, const Out& from) {
    return step(j.ask("step", question(t, seed, from)));
}

}  // namespace
}  // namespace penumbra::course

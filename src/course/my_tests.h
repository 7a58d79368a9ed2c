// course/my_tests.h  2  the tests of week 6: each says whether its subject may be right
//
// Each takes its random numbers from the seed alone, and returns false only if it is sure: of a
// thousand runs on right subjects at most one is a false alarm.
#pragma once
#include "course/subject.h"
#include "oracle/oracle.h"

namespace penumbra::course {

// Whether directions and density may belong together.  Lengths count as 1 within 1e-4, far above
// what float loses.
inline bool sampler_passes(const Sampler& subject, uint64_t seed) {
    // exercise 6.1
    oracle::Random random(seed);
    // At the borders of the square a logarithm or a root may have no value.
    const double last = 1 - 0x1p-24, ends[] = {0, 0x1p-24, random(), last};
    for (double u : ends)
        for (double v : ends)
            if (const auto w = subject.sample(u, v); w && !(std::abs(length(*w) - 1) < 1e-4))
                return false;
    return oracle::expect_density(random, subject.sample, subject.pdf,
                                  {.alpha = 1e-4, .sees = 0.03, .axis = {0, 0, 1}})
        .pass;
    // end
}

// Whether the estimates may have the mean that their class promises.
inline bool estimator_passes(const Estimator& subject, uint64_t seed) {
    // exercise 6.2
    oracle::Random random(seed);
    const oracle::Options sure{.alpha = 1e-4};
    auto run = [&](int n) { return subject.estimate(random.bits(), n); };
    if (!std::isfinite(run(1))) return false;
    auto limit = [&] {
        if (subject.unbiased) return run(4);
        // What the bias has of c / n cancels.
        const double once = run(64), twice = run(128);
        return 2 * twice - once;
    };
    const auto means = oracle::draw(subject.unbiased ? 20000 : 4000, limit);
    if (!oracle::judge("mean", means, subject.truth, sure).pass) return false;
    // Of 2000 normal numbers the standard deviation is known within 1.6 %.
    const double few = oracle::draw(2000, [&] { return run(16); }).variance();
    const double many = oracle::draw(2000, [&] { return run(64); }).variance();
    return std::sqrt(many) <= 0.7 * std::sqrt(few) + 1e-12 * std::abs(subject.truth);
    // end
}

// Whether beams may meet bodies where they ought to: within 1e-3 of the distance, far above what
// float loses.
inline bool intersector_passes(const Intersector& subject, uint64_t seed) {
    // exercise 6.3
    oracle::Random random(seed);
    auto in = [&](double a, double b) { return real(a + (b - a) * random()); };
    auto somewhere = [&] { return vec3{in(-1, 1), in(-1, 1), in(-1, 1)}; };
    // A beam from o to the point p of the body, or past the body through p.
    auto aimed = [&](const Body& s, vec3 o, vec3 p, bool is_met) {
        const double t = length(p - o);
        auto meets = [&](vec3 d, double tmax, bool expected) {
            const auto hit = subject.meet(s, {o, d, tmax});
            return expected ? hit && std::abs(*hit - t) <= 1e-3 * t : !hit;
        };
        return meets(unit(p - o), infinity, is_met) && meets(unit(p - o), 0.99 * t, false) &&
               (length(o - s.a) < s.r || meets(unit(o - p), infinity, false));
    };
    for (int i = 0; i < 300; ++i) {
        const real size = std::exp2(in(-10, 10)), r = size * in(0.1, 1), edge = real(1.02) * r;
        const vec3 a = size * somewhere(), b = size * somewhere(), c = size * somewhere();
        const vec3 n = unit(somewhere()), side = unit(cross(n, somewhere()));
        bool good = aimed({a, b, c, r}, a + r * n + size * (n + in(-3, 3) * side), a + r * n, true);
        good = good && aimed({a, b, c, r}, a + in(0, 0.9) * r * side, a + r * n, true);
        good = good && aimed({a, b, c, r}, a + edge * n + size * side, a + edge * n, false);
        const vec3 up = unit(cross(b - a, c - a)), away = size * (i % 2 ? up - n / 2 : n / 2 - up);
        if (length(cross(b - a, c - a)) < size * size / 10) continue;
        for (real x : {in(0.02, 0.98), in(-1, -0.02)}) {  // a negative weight is outside
            const vec3 q = x * a + (1 - x) * (b + in(0.02, 0.98) * (c - b));
            for (const Body& s : {Body{a, b, c}, Body{b, c, a}, Body{c, a, b}})
                good = good && aimed(s, q + away, q, x > 0);
        }
        if (!good) return false;
    }
    return true;
    // end
}

}  // namespace penumbra::course

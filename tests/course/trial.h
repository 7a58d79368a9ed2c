// course/trial.h  a student's tests on trial: what they say of subjects, and what they look at
//
// All subjects look alike from outside: whoever takes a function apart finds the same type.
#pragma once
#include "course/my_tests.h"

#include <ctime>
#include <set>

#include "course/answers.h"
#include "course/kinds.h"
#include "course/practice.h"
#include "course/shuffle.h"

namespace penumbra::course {

inline Sampler sealed(const Sampler& s) {
    return {[s](double u, double v) { return s.sample(u, v); }, [s](vec3 w) { return s.pdf(w); }};
}
inline Estimator sealed(const Estimator& s) {
    return {[s](uint64_t seed, int n) { return s.estimate(seed, n); }, s.truth, s.unbiased};
}
inline Intersector sealed(const Intersector& s) {
    return {[s](const Body& body, const Beam& beam) { return s.meet(body, beam); }};
}

// A test of one exercise without the type of its subjects: wrong ones come first.
struct Trial {
    size_t wrong = 0, right = 0;
    std::function<bool(size_t index, uint64_t seed)> passes;
    std::function<Out(uint64_t seed)> looks;  // at what the test looks, from one run on a spy
    Out kinds = {};                           // of all subjects, kinds.h
};

// What a spy has seen: of all that was asked, in its order, and some features by name.
struct Seen {
    uint64_t all = 0;
    std::vector<bool> features = {};
    void look(std::initializer_list<double> asked, const std::vector<bool>& has) {
        for (double x : asked) all = hash(all, std::bit_cast<uint64_t>(x));
        features.resize(has.size());
        for (size_t i = 0; i < has.size(); ++i) features[i] = features[i] || has[i];
    }
    Out out() const { return row(all >> 11, features); }
};

template <class Subject>
Trial trial(const Lineup<Subject>& lineup, bool test(const Subject&, uint64_t),
            std::function<Out(uint64_t)> looks) {
    std::vector<Subject> all;
    Out of;
    for (const auto* side : {&lineup.wrong, &lineup.right})
        for (const Named<Subject>& s : *side)
            all.push_back(sealed(s.subject)), of.push_back(kind_of(s.name));
    return {lineup.wrong.size(), lineup.right.size(),
            [=](size_t index, uint64_t seed) { return test(all[index], seed); }, looks, of};
}

// Samples and densities, and many of them.
inline Out looks_of_samplers(uint64_t seed) {
    const Sampler right = practice_samplers().right[2].subject;  // in double
    Seen seen;
    size_t asked = 0;
    sampler_passes({[&](double u, double v) {
                        seen.look({u, v}, {true, false, ++asked >= 1000});
                        return right.sample(u, v);
                    },
                    [&](vec3 w) {
                        seen.look({w.x, w.y, w.z}, {false, true, false});
                        return right.pdf(w);
                    }},
                   seed);
    return seen.out();
}

// Many estimates, several numbers of samples, what is said of a subject of either class, and that
// fewer than ten estimates have the same seed.
inline Out looks_of_estimators(uint64_t seed) {
    Seen seen;
    int first = 0;
    size_t asked = 0;
    std::set<uint64_t> seeds;
    for (bool unbiased : {true, false})
        estimator_passes({[&](uint64_t of, int n) {
                              if (first == 0) first = n;
                              seeds.insert(of);
                              seen.look({double(of >> 32), double(uint32_t(of)), double(n)},
                                        {++asked >= 200, n != first, n >= 32});
                              return mean_of_exp(of, n);
                          },
                          std::numbers::e - 1, unbiased},
                         seed);
    seen.features.resize(3);  // of a test that asks nothing
    seen.features.push_back(10 * seeds.size() > asked);
    return seen.out();
}

// Spheres, triangles, beams that end, beams that begin within; that all directions have length 1;
// and that the last digits of a distance do not decide: spies whose distances are off by so many
// units in the last place that one of them says what a test of equality expects: it asks further
// questions.
inline Out looks_of_intersectors(uint64_t seed) {
    const Intersector right = practice_intersectors().right[0].subject;
    size_t asked = 0;
    bool all_unit = true, minute = false;
    auto spied = [&](int64_t units) {
        Seen seen;
        asked = 0;
        intersector_passes(
            {[&](const Body& s, const Beam& beam) {
                const auto [o, d, tmax] = beam;
                const bool within = s.r > 0 && length(o - s.a) < s.r, ends = std::isfinite(tmax);
                seen.look({o.x, o.y, o.z, d.x, d.y, d.z}, {s.r > 0, s.r == 0, ends, within});
                all_unit = all_unit && std::abs(length(d) - 1) < 1e-4;
                ++asked;
                const auto t = right.meet(s, beam);
                return t ? std::optional(std::bit_cast<double>(std::bit_cast<int64_t>(*t) + units))
                         : t;
            }},
            seed);
        return seen;
    };
    Seen seen = spied(0);
    const size_t before = asked;
    for (int64_t units = -1000; before <= 10 && units <= 1000; ++units)
        spied(units), minute = minute || asked > before;
    seen.features.resize(4);
    seen.features.insert(seen.features.end(), {all_unit, !minute});
    return seen.out();
}

// The student's tests of the three exercises, on these subjects.
inline std::vector<Trial> trials_of(const Lineup<Sampler>& samplers,
                                    const Lineup<Estimator>& estimators,
                                    const Lineup<Intersector>& intersectors) {
    return {trial(samplers, sampler_passes, looks_of_samplers),
            trial(estimators, estimator_passes, looks_of_estimators),
            trial(intersectors, intersector_passes, looks_of_intersectors)};
}
inline std::vector<Trial> practice() {
    return trials_of(practice_samplers(), practice_estimators(), practice_intersectors());
}

inline double seconds_of_cpu() { return double(std::clock()) / CLOCKS_PER_SEC; }

// The answers: trials[e] is that of exercise 6.e.  `practice` are those of the published subjects;
// without trials of hidden ones they are those that count.
inline int on_trial(const std::vector<Trial>& hidden, const std::vector<Trial>& practice) {
    const std::vector<Trial>& trials = hidden.empty() ? practice : hidden;
    auto run = [](const Trial& t, size_t index, double seed) {
        const double begun = seconds_of_cpu();
        const bool passes = t.passes(index, uint64_t(seed));
        return Out{double(passes), seconds_of_cpu() - begun};
    };
    auto at = [](const std::vector<Trial>& all, double e) { return all.at(size_t(e) - 1); };
    return answer_all({
        // Exercise: how many subjects are wrong, and how many are right.
        {"count", 1,
         [=](In x) {
             const Trial t = at(trials, x[0]);
             return Out{double(t.wrong), double(t.right)};
         }},
        {"kinds", 1, [=](In x) { return at(trials, x[0]).kinds; }},
        // Whether subjects are published, so that they may be called by their numbers.
        {"published", 1, [=](In) { return Out{double(hidden.empty())}; }},
        // Exercise: a number that follows from all that the test asks.
        {"asks", 1, [=](In x) { return at(practice, x[0]).looks(1)[0]; }},
        // Exercise, key, place, seed: whether the subject at this place passes, and its seconds.
        {"test", 4,
         [=](In x) {
             const Trial t = at(trials, x[0]);
             return run(t, shuffled(x[1], t.wrong + t.right).at(size_t(x[2])), x[3]);
         }},
        // Exercise, index, seed: whether this published subject passes.
        {"practice", 3,
         [=](In x) {
             return Out{double(at(practice, x[0]).passes(size_t(x[1]), uint64_t(x[2])))};
         }},
        // Exercise: whether a seed gives the same questions again, another one others, and what
        // they look at.
        {"looks", 1,
         [=](In x) {
             const Trial t = at(practice, x[0]);
             Out first = t.looks(1);
             const double same = first[0] == t.looks(1)[0], other = first[0] != t.looks(2)[0];
             first[0] = other;
             first.insert(first.begin(), same);
             return first;
         }},
    });
}

// For whoever wants to see what a test does: `answers_6 6.1 2` runs that of 6.1 on the second
// subject of practice.h, wrong ones first, and leaves the oracle's pictures in out/check/.
inline int show(const std::vector<Trial>& practice, const std::string& exercise, size_t number) {
    const size_t e = exercise.size() == 3 ? size_t(exercise[2] - '1') : practice.size();
    if (e >= practice.size() || number < 1 || number > practice[e].wrong + practice[e].right) {
        std::fprintf(stderr, "say an exercise and a number, e.g. 6.1 2\n");
        return 2;
    }
    oracle::pictures = "out/check";
    const bool is_wrong = number <= practice[e].wrong, passes = practice[e].passes(number - 1, 1);
    std::printf("a %s subject %s\n", is_wrong ? "wrong" : "right",
                passes ? "passes" : "is refused");
    return passes == is_wrong;
}

}  // namespace penumbra::course

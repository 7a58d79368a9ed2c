// course/my_tests_test.cpp  the tests of week 6 find what is wrong, published or hidden, and
// nothing else.
#include "course/trial.h"

#include <set>

#include "course/hidden_subjects.h"
#include "oracle/expect.h"

using namespace penumbra;
using namespace course;

namespace {

// What students' tests ask of the oracle is no check of this suite.
using oracle::Aside;

// All wrong subjects are refused in all of a few runs; right ones pass in nearly all of many: one
// false alarm in a thousand runs is what a test may have.
template <class Subject, class Test>
void expect_judgement(const Lineup<Subject>& lineup, Test test, int runs) {
    const Aside aside;
    oracle::Random random(seed_here());
    for (const Named<Subject>& s : lineup.wrong)
        for (int i = 0; i < 3; ++i) {
            INFO("wrong: ", s.name);
            CHECK_FALSE(test(s.subject, random.bits()));
        }
    double alarms = 0, all = 0;
    for (const Named<Subject>& s : lineup.right)
        for (int i = 0; i < runs; ++i, ++all) alarms += !test(s.subject, random.bits());
    INFO(alarms, " false alarms in ", all, " runs");
    CHECK(oracle::p_at_least(alarms, all, 1e-3) > 1e-6);
}

}  // namespace

TEST_CASE("a test of samplers finds wrong ones, and lets right ones pass") {
    expect_judgement(practice_samplers(), sampler_passes, 20);
    expect_judgement(hidden_samplers(), sampler_passes, 10);
}

TEST_CASE("a test of estimators finds wrong ones, and lets right ones pass") {
    expect_judgement(practice_estimators(), estimator_passes, 300);
    expect_judgement(hidden_estimators(), estimator_passes, 300);
}

TEST_CASE("a test of intersectors finds wrong ones, and lets right ones pass") {
    expect_judgement(practice_intersectors(), intersector_passes, 300);
    expect_judgement(hidden_intersectors(), intersector_passes, 300);
}

TEST_CASE("right intersectors meet the farthest point of a sphere, through its centre") {
    oracle::Random random(seed_here());
    auto number = [&] { return real(2 * random() - 1); };
    for (const auto& lineup : {practice_intersectors(), hidden_intersectors()})
        for (const Named<Intersector>& s : lineup.right)
            for (int i = 0; i < 300; ++i) {
                const vec3 centre{number(), number(), number()};
                const vec3 d = unit({number(), number(), number()});
                const real r = std::exp2(4 * number()), t = real(1.7) * r;
                const auto came = s.subject.meet({centre, {}, {}, r}, {centre - (t - r) * d, d});
                INFO(s.name);
                REQUIRE(came);
                CHECK(std::abs(*came - t) <= 1e-3 * t);
            }
}

// What is graded must not be a kind that no student can see.
TEST_CASE("of each kind of hidden subjects one is published, wrong or right as those are") {
    auto kinds_of = [](const auto& side) {
        std::set<int> kinds;
        for (const auto& s : side) {
            CAPTURE(s.name);
            CHECK(kind_of(s.name) >= 0);
            kinds.insert(kind_of(s.name));
        }
        return kinds;
    };
    auto expect_same = [&](const auto& hidden, const auto& published) {
        CHECK(kinds_of(hidden.wrong) == kinds_of(published.wrong));
        CHECK(kinds_of(hidden.right) == kinds_of(published.right));
    };
    expect_same(hidden_samplers(), practice_samplers());
    expect_same(hidden_estimators(), practice_estimators());
    expect_same(hidden_intersectors(), practice_intersectors());
}

// What is handed in meets float, so what is published must.
TEST_CASE("a published sampler and a published intersector compute in float, and are right") {
    const auto& sampler = practice_samplers().right[0].subject;
    double off = 0, lowest = 1, apart = 0;
    for (double u : {0.1, 0.3, 1 - 0x1p-24})
        for (double v : {0., 0.2, 0.7}) {
            const vec3 w = *sampler.sample(u, v);
            off = std::max(off, std::abs(double(length(w)) - 1));
            lowest = std::min(lowest, double(w.z));
        }
    CHECK(off > 1e-9);
    CHECK(off < 1e-6);
    CHECK(lowest < 0);
    CHECK(lowest > -1e-7);
    const auto all = practice_intersectors().right;
    for (double z : {3.1, 4.7, 5.3}) {
        const Beam beam{{0, 0, 0}, {0, 0, 1}};
        const double t = *all[1].subject.meet({{0, 0, real(z)}, {}, {}, 1}, beam);
        apart = std::max(apart, std::abs(t / (double(real(z)) - 1) - 1));
    }
    CHECK(apart > 1e-10);
    CHECK(apart < 1e-6);
}

TEST_CASE("tests draw what follows from their seeds") {
    const Aside aside;
    for (const Trial& t : practice()) {
        const Out looks = t.looks(1);
        CHECK(looks == t.looks(1));
        CHECK(looks[0] != t.looks(2)[0]);
        CHECK(looks[0] != t.looks(3)[0]);
        // They look at all that there is.
        for (size_t i = 1; i < looks.size(); ++i) CHECK(looks[i] == 1);
    }
}

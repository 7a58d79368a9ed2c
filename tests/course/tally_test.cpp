// course/tally_test.cpp  a test gets points for what it finds, and loses them by false alarms
#include "course/tally.h"

#include <functional>
#include <set>

#include "oracle/expect.h"

using namespace penumbra;
using namespace course;

namespace {

// A student's test of 12 wrong subjects and 7 right ones, without the student: refuses(subject)
// says what it does.
template <class Refuses>
struct Played {
    oracle::Random random;
    Refuses refuses;
    double seconds = 0.01;
    size_t wrong = 12, right = 7;
    std::set<std::pair<double, bool>> places = {};  // asked for, and whether wrong
    std::set<double> seeds = {};

    Out ask(const std::string& question, const Out& in) {
        if (question == "count") return {double(wrong), double(right)};
        const size_t subject = shuffled(in.at(1), wrong + right).at(size_t(in.at(2)));
        places.emplace(in[2], subject < wrong);
        seeds.insert(in.at(3));
        return {refuses(subject) ? 0.0 : 1.0, seconds};
    }
};
template <class Refuses>
Played<Refuses> played(Refuses refuses) {
    return {oracle::Random(seed_here()), refuses};
}

}  // namespace

TEST_CASE(
    "whoever finds all that is wrong, and nothing else, gets all points; whoever guesses none") {
    oracle::Random coin(seed_here());
    auto guess = [&](double p) { return [&, p](size_t) { return coin() < p; }; };
    std::vector<int> runs(19);
    struct Row {
        const char* who;
        std::function<bool(size_t)> refuses;
        double credit;
        size_t found, alarms;
    };
    for (const Row& r : std::vector<Row>{
             {"finds all", [](size_t subject) { return subject < 12; }, 1, 12, 0},
             {"finds half", [](size_t subject) { return subject < 6; }, 0.5, 6, 0},
             {"refuses now and then",
              [&](size_t subject) { return subject < 12 && runs[subject]++ == 0; }, 0, 0, 0},
             {"says yes to all", [](size_t) { return false; }, 0, 0, 0},
             {"says no to all", [](size_t) { return true; }, 0, 12, 7 * 23}}) {
        auto j = played(r.refuses);
        const Tally t = tally(j, 1);
        CAPTURE(r.who);
        CHECK(t.credit() == r.credit);
        CHECK(t.found() == r.found);
        CHECK(t.alarms == r.alarms);
        CHECK(t.quiet() == (r.alarms == 0));
        CHECK(t.runs == 12 * 3 + 7 * 23);
        CHECK(t.right_runs >= 130);
        CHECK(t.in_time());
        CHECK(j.seeds.size() == t.runs);
    }
    for (double p : {0.3, 0.5, 0.9}) {
        auto j = played(guess(p));
        CHECK(tally(j, 1).credit() == 0);
    }
}

TEST_CASE("a false alarm that chance explains costs nothing, more cost five times their share") {
    for (int alarms : {1, 2, 3, 12}) {
        int left = alarms;
        auto j = played([&](size_t subject) { return subject < 12 || left-- > 0; });
        const Tally t = tally(j, 1);
        CHECK(t.alarms == size_t(alarms));
        CHECK(t.quiet() == (alarms <= 2));
        CHECK(t.credit() == doctest::Approx(alarms <= 2 ? 1 : 1 - 5.0 * alarms / (7 * 23)));
    }
}

TEST_CASE("a right subject is singled out if it is refused more often than the others are") {
    struct Row {
        const char* who;
        std::vector<int> refused;  // runs of each right subject
        std::vector<size_t> out;
    };
    for (const Row& r :
         std::vector<Row>{{"by chance, now and then", {2, 0, 1, 0, 0, 1, 0}, {}},
                          {"by chance, often", {5, 5, 4, 6, 5, 3, 5}, {}},
                          {"one, sometimes", {3, 0, 0, 0, 0, 0, 0}, {0}},
                          {"two, always", {0, 23, 0, 23, 0, 0, 0}, {1, 3}},
                          {"all but one", {23, 23, 23, 0, 23, 23, 23}, {0, 1, 2, 4, 5, 6}}}) {
        std::vector<int> left = r.refused;
        auto j = played([&](size_t subject) { return subject < 12 || left[subject - 12]-- > 0; });
        const Tally t = tally(j, 1);
        std::vector<size_t> out;
        for (size_t i = 0; i < 7; ++i)
            if (t.is_singled_out(12 + i)) out.push_back(i);
        CAPTURE(r.who);
        CHECK(out == r.out);
    }
}

TEST_CASE("right subjects have as many runs if they are few") {
    for (size_t right : {1, 3, 6, 7}) {
        auto j = played([](size_t subject) { return subject < 12; });
        j.right = right;
        const Tally t = tally(j, 1);
        CAPTURE(right);
        CHECK(t.right_runs >= 161);
        CHECK(t.right_runs < 161 + right);
    }
}

TEST_CASE("when time is up no more is asked") {
    auto j = played([](size_t subject) { return subject < 12; });
    j.seconds = 10;
    const Tally t = tally(j, 1);
    CHECK(t.runs == 20);  // 197 runs have 197 s
    CHECK_FALSE(t.in_time());
    CHECK(t.credit() < 1);
}

TEST_CASE("nothing follows from a subject's place") {
    auto j = played([](size_t subject) { return subject < 12; });
    for (int i = 0; i < 3; ++i) (void)tally(j, 1);
    CHECK(j.places.size() == 2 * 19);
    // Every subject comes to every place alike.
    std::vector<double> counts(19);
    for (double key = 0; key < 19000; ++key) {
        const auto order = shuffled(key, 19);
        CHECK(std::set<size_t>(order.begin(), order.end()).size() == 19);
        ++counts[size_t(std::find(order.begin(), order.end(), 5u) - order.begin())];
    }
    EXPECT(oracle::expect_counts(counts, std::vector<double>(19, 1 / 19.0)), 0.073);
}

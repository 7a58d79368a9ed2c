// course/judge_6.cpp  judges week 6: tests that the student wrote, by what they find and by false
// alarms
#include "course/judge.h"
#include "course/kinds.h"
#include "course/tally.h"

using namespace penumbra;
using course::Judge, course::Out, course::Rows, course::Tally;

namespace {

constexpr size_t wrong[] = {5, 5, 6}, right = 3;  // published subjects of every exercise

// Whether a right one passes in all of ten runs (2), in most or in few; each run is asked for
// alone, as it may take its time.
double passes(Judge& j, double exercise, double subject) {
    int passed = 0;
    for (double seed = 1; seed <= 10; ++seed)
        passed += j.ask("practice", Out{exercise, subject, seed}).at(0) > 0;
    return passed == 10 ? 2 : passed > 5 ? 1 : 0;
}

// "2 of 3 about tmax, 1 of 1 about ...": of these subjects the ones of which this is so, by kinds.
template <class Is>
std::string by_kind(const Out& of, size_t begin, size_t end, Is is) {
    std::string text;
    for (size_t kind = 0; kind < course::kinds.size(); ++kind) {
        size_t all = 0, some = 0;
        for (size_t i = begin; i < end; ++i)
            if (of.at(i) == double(kind)) ++all, some += is(i);
        if (some > 0)
            text += oracle::say("%s%zu of %zu about %s", text.empty() ? "" : ", ", some, all,
                                course::kinds[kind].c_str());
    }
    return text;
}

// The published subjects are few, and may be called by their numbers; of hidden ones, their kinds.
std::string missed(const Tally& t, const Out& of) {
    std::string text = oracle::say("%zu of %zu found", t.found(), t.wrong);
    if (t.found() == 0) return text + ": it never refuses any of them";
    const std::string about = by_kind(of, 0, t.wrong, [&](size_t i) { return !t.is_found(i); });
    if (!about.empty()) return text + ", but not " + about;
    for (size_t i = 0; i < t.wrong; ++i)
        if (!t.is_found(i)) text += oracle::say(", not number %zu", i + 1);
    return text;
}

// Whether right subjects are refused for what they are, or now and then, by chance.
std::string refused(const Tally& t, const Out& of) {
    std::string text = oracle::say("%zu false alarms in %zu runs", t.alarms, t.right_runs);
    auto out = [&](size_t i) { return t.is_singled_out(i); };
    size_t n = 0;
    std::string numbers;
    for (size_t i = t.wrong; i < t.refused.size(); ++i)
        if (out(i)) ++n, numbers += oracle::say(", number %zu", i + 1);
    if (t.alarms == 0) return text;
    if (t.alarms == t.right_runs) return text + ": whatever is right is refused";
    if (n == 0) return text + ", now and then: it refuses what chance alone brings";
    const std::string about = by_kind(of, t.wrong, t.refused.size(), out);
    return text +
           oracle::say("; %zu of %zu right subjects are refused for what they are", n,
                       t.refused.size() - t.wrong) +
           (about.empty() ? numbers : ", " + about);
}

course::Judging judging(double exercise) {
    return [exercise](Judge& j) {
        j.credit = 0;
        const Out looks = j.probe("looks", Rows(Out{exercise})).numbers;
        const size_t first_right = wrong[size_t(exercise) - 1];
        for (size_t i = 0; i < first_right; ++i)
            j.probe("practice", Rows(Out{exercise, double(i), 1}));
        for (size_t i = 0; i < right; ++i)
            j.remember({passes(j, exercise, double(first_right + i))});
        j.probe_stub("asks", Rows(Out{exercise}));
        j.exact("the same seed gives the same run", looks.at(0) == 1,
                "twice the same seed, and the subject was asked other questions");
        j.exact("other seeds give other random numbers", looks.at(1) == 1,
                "two seeds, and the subject was asked the same questions");
        const Tally t = course::tally(j, exercise);
        j.allows = course::limit * double(t.runs);
        const Out of = j.ask("kinds", Out{exercise});
        j.exact("a run takes 1 s of CPU at most, on average", t.in_time(),
                oracle::say("%zu runs took %.3g s each", t.runs, t.seconds / double(t.runs)));
        j.items.push_back({"right subjects pass", true, t.quiet(), refused(t, of)});
        j.exact("wrong subjects are refused", t.found() == t.wrong, missed(t, of));
        j.credit = t.credit();
    };
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv,
                         {{"6.1", judging(1)}, {"6.2", judging(2)}, {"6.3", judging(3)}});
}

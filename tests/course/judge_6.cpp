// course/judge_6.cpp  judges week 6: tests that the student wrote, by what they find and by false
// alarms
#include "course/judge.h"
#include "course/kinds.h"
#include "course/tally.h"

using namespace penumbra;
using course::Judge, course::Out, course::Rows, course::Tally;

namespace {

constexpr size_t wrong[] = {10, 8, 17}, right[] = {4, 7, 4};  // published subjects

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

// "number 3 (tmax), number 7 (...)": of published subjects these.
template <class Is>
std::string by_number(const Out& of, size_t begin, size_t end, Is is) {
    std::string text;
    for (size_t i = begin; i < end; ++i)
        for (size_t kind = 0; is(i) && kind < course::kinds.size(); ++kind)
            if (of.at(i) == double(kind))
                text += oracle::say("%snumber %zu (%s)", text.empty() ? "" : ", ", i + 1,
                                    course::kinds[kind].c_str());
    return text;
}

std::string missed(const Tally& t, const Out& of, bool published) {
    const std::string text = oracle::say("%zu of %zu found", t.found(), t.wrong);
    if (t.found() == 0) return text + ": it never refuses any of them";
    auto out = [&](size_t i) { return !t.is_found(i); };
    return text + ", but not " +
           (published ? by_number(of, 0, t.wrong, out) : by_kind(of, 0, t.wrong, out));
}

// Whether right subjects are refused for what they are, or now and then, by chance.
std::string refused(const Tally& t, const Out& of, bool published) {
    std::string text = oracle::say("%zu false alarms in %zu runs", t.alarms, t.right_runs);
    auto out = [&](size_t i) { return t.is_singled_out(i); };
    const size_t end = t.refused.size();
    size_t n = 0;
    for (size_t i = t.wrong; i < end; ++i) n += out(i);
    if (t.alarms == 0) return text;
    if (t.alarms == t.right_runs) return text + ": whatever is right is refused";
    if (n == 0) return text + ", now and then: it refuses what chance alone brings";
    return text +
           oracle::say("; %zu of %zu right subjects are refused for what they are: ", n,
                       end - t.wrong) +
           (published ? by_number(of, t.wrong, end, out) : by_kind(of, t.wrong, end, out));
}

course::Judging judging(double exercise) {
    return [exercise](Judge& j) {
        j.credit = 0;
        const Out looks = j.probe("looks", Rows(Out{exercise})).numbers;
        const size_t first_right = wrong[size_t(exercise) - 1];
        const bool published = j.ask("published", Out{exercise}).at(0) > 0;
        for (size_t i = 0; i < first_right; ++i)
            j.probe("practice", Rows(Out{exercise, double(i), 1}));
        for (size_t i = 0; i < right[size_t(exercise) - 1]; ++i)
            j.remember({passes(j, exercise, double(first_right + i))});
        j.probe_stub("asks", Rows(Out{exercise}));
        j.exact("the same seed gives the same run", looks.at(0) == 1,
                "twice the same seed, and the subject was asked other questions");
        j.exact("other seeds give other random numbers", looks.at(1) == 1,
                "two seeds, and the subject was asked the same questions");
        if (exercise == 3)
            j.exact("directions of beams have length 1", looks.at(6) == 1,
                    "a beam went along a vector of another length; divide it by its length");
        const Tally t = course::tally(j, exercise);
        j.allows = course::limit * double(t.runs);
        const Out of = j.ask("kinds", Out{exercise});
        j.exact("a run takes 1 s of CPU at most, on average", t.in_time(),
                oracle::say("%zu runs took %.3g s each", t.runs, t.seconds / double(t.runs)));
        j.items.push_back({"right subjects pass", true, t.quiet(), refused(t, of, published)});
        j.exact("wrong subjects are refused", t.found() == t.wrong, missed(t, of, published));
        j.credit = t.credit();
    };
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv,
                         {{"6.1", judging(1)}, {"6.2", judging(2)}, {"6.3", judging(3)}});
}

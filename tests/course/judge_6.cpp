// course/judge_6.cpp  judges week 6: tests that the student wrote, by what they find and by false
// alarms
#include "course/judge.h"
#include "course/tally.h"

using course::Judge, course::Out, course::Rows, course::Tally;

namespace {

constexpr double subjects[] = {8, 8, 9};  // published ones of every exercise

// The published subjects are few, and may be called by their numbers.
std::string missed(const Tally& t) {
    std::string text = oracle::say("%zu of %zu found", t.found(), t.wrong);
    if (t.wrong > 6) return text;
    for (size_t i = 0; i < t.wrong; ++i)
        if (!t.is_found(i)) text += oracle::say(", not number %zu", i + 1);
    return text;
}

course::Judging judging(double exercise) {
    return [exercise](Judge& j) {
        j.credit = 0;
        const Out looks = j.probe("looks", Rows(Out{exercise})).numbers;
        for (double i = 0; i < subjects[size_t(exercise) - 1]; ++i)
            j.probe("practice", Rows(Out{exercise, i}));
        j.exact("the same seed gives the same run", looks.at(0) == 1,
                "twice the same seed, and the subject was asked other questions");
        j.exact("other seeds give other random numbers", looks.at(1) == 1,
                "two seeds, and the subject was asked the same questions");
        const Tally t = course::tally(j, exercise);
        j.exact("a run takes 1 s of CPU at most, on average", t.in_time(),
                oracle::say("%zu runs took %.3g s each", t.runs, t.seconds / double(t.runs)));
        j.items.push_back({"right subjects pass", true, t.quiet(),
                           oracle::say("%zu false alarms in %zu runs", t.alarms, t.right_runs)});
        j.exact("wrong subjects are refused", t.found() == t.wrong, missed(t));
        j.credit = t.credit();
    };
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv,
                         {{"6.1", judging(1)}, {"6.2", judging(2)}, {"6.3", judging(3)}});
}

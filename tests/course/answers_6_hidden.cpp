// course/answers_6_hidden.cpp  answers of week 6 for grades: the same tests, on hidden subjects
//
// The student's tests come first, in trial.h: they see no name of what follows.
#include "course/trial.h"

#include "course/hidden_subjects.h"

using namespace penumbra;

int main() {
    oracle::pictures = "";
    using namespace course;
    return on_trial(trials_of(hidden_samplers(), hidden_estimators(), hidden_intersectors()),
                    practice());
}

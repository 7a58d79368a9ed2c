// course/answers_6_hidden.cpp  answers of week 6 for grades: the same tests, on hidden subjects
//
// The tests come first: they see no name of what follows.
#include "course/my_tests.h"

#include "course/hidden_subjects.h"
#include "course/trial.h"

int main() {
    oracle::pictures = "";
    using namespace course;
    return on_trial({trial_of_samplers(hidden_samplers(), sampler_passes),
                     trial_of_estimators(hidden_estimators(), estimator_passes),
                     trial_of_intersectors(hidden_intersectors(), intersector_passes)},
                    {trial_of_samplers(practice_samplers(), sampler_passes),
                     trial_of_estimators(practice_estimators(), estimator_passes),
                     trial_of_intersectors(practice_intersectors(), intersector_passes)});
}

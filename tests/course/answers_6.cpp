// course/answers_6.cpp  answers of week 6: the student's tests, on the published subjects
#include "course/my_tests.h"

#include "course/trial.h"

int main(int argc, char** argv) {
    oracle::pictures = "";
    using namespace course;
    const std::vector<Trial> practice = {
        trial_of_samplers(practice_samplers(), sampler_passes),
        trial_of_estimators(practice_estimators(), estimator_passes),
        trial_of_intersectors(practice_intersectors(), intersector_passes)};
    if (argc == 3) return show(practice, argv[1], size_t(std::atoi(argv[2])));
    return on_trial(practice, practice);
}

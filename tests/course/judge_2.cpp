// course/judge_2.cpp  judges week 2: warps and densities
#include "course/judge.h"

using course::Judge, course::Out, course::Rows;

namespace {

// Directions of the upper hemisphere from two numbers, and their density as a function of the
// cosine.
oracle::Verdict follows(Judge& j, const std::string& sample, const std::string& pdf) {
    return j.batched({sample, pdf}, [](oracle::Random& random, auto& known) {
        return oracle::expect_density(
            random,
            [&](double u, double v) {
                const Out& w = known[0]({u, v}, {0, 0, 1});
                return oracle::Triple{w[0], w[1], w[2]};
            },
            [&](const oracle::Triple& w) { return known[1]({w[2]}, {1})[0]; }, {.sees = 0.05});
    });
}

// Exact: every direction is unit and above the horizon.
void expect_upper(Judge& j, const Rows& directions) {
    double off = 0, lowest = 1;
    for (size_t i = 0; i < directions.size(); ++i) {
        const auto w = directions[i];
        off = std::max(off, std::abs(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] - 1));
        lowest = std::min(lowest, w[2]);
    }
    j.exact("directions have length 1", off < 64 * j.epsilon,
            oracle::say("the square of a length is off by %.3g", off));
    j.exact("directions are above the horizon", lowest >= 0, oracle::say("z = %.6g", lowest));
}

void cosine_hemisphere(Judge& j) {
    Rows u;
    for (double x : {0.0, 0.1, 0.25, 0.5, 0.9})
        for (double y : {0.0, 0.3, 0.8}) u.add({x, y});
    expect_upper(j, j.probe("sample_cosine_hemisphere", u));
    const Rows p = j.probe("pdf_cosine_hemisphere", {{1}, {0.5}, {0}, {-0.5}});
    j.number("the density straight up is 1 / pi", p.numbers[0], 1 / oracle::pi, 8 * j.epsilon);
    j.number("the density at 60 degrees is half of that", p.numbers[1], 0.5 / oracle::pi,
             8 * j.epsilon);
    j.exact("the density below the horizon is 0", p.numbers[3] == 0,
            oracle::say("it is %.6g at a cosine of -0.5", p.numbers[3]));
    j.statistical("directions follow their density",
                  follows(j, "sample_cosine_hemisphere", "pdf_cosine_hemisphere"));
}

}  // namespace

int main(int argc, char** argv) { return course::judge(argc, argv, {{"2.2", cosine_hemisphere}}); }

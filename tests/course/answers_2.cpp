// course/answers_2.cpp  answers of week 2: warps and densities
#include "course/answers.h"
#include "world/warp.h"

using course::In, course::Out, course::numbers;

namespace {
vec2 u_of(In x) { return {real(x[0]), real(x[1])}; }
}  // namespace

int main() {
    return course::answer_all({
        {"sample_cosine_hemisphere", 2,
         [](In u) { return numbers(sample_cosine_hemisphere(u_of(u))); }},
        {"pdf_cosine_hemisphere", 1,
         [](In cosine) { return Out{double(pdf_cosine_hemisphere(real(cosine[0])))}; }},
    });
}

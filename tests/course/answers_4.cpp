// course/answers_4.cpp  answers of week 4: Halton's points, scrambled; strata
#include "course/answers.h"
#include "path/sampler.h"

using namespace penumbra;
using course::In, course::Out;

namespace {

// Two halves of 32 bits: doubles hold no more than 53.
uint64_t bits_of(In x, size_t at) { return uint64_t(x[at]) << 32 | uint64_t(x[at + 1]); }

// Base, index, bits of shift and factor.
real scrambled(In x) {
    return scrambled_radical_inverse(uint32_t(x[0]), bits_of(x, 1), bits_of(x, 3), bits_of(x, 5));
}

// Seed, pixel, sample: all numbers that a path of so many vertices may draw, the film's first.
constexpr int depth = 8;
Out path(In x) {
    static SamplerSettings settings = sampler_settings(SamplerKind::halton, 0, depth);
    settings.seed = uint64_t(x[0]);
    const Sampler sampler(settings, uint64_t(x[1]), uint64_t(x[2]));
    Out all{double(sampler.get(film_x)), double(sampler.get(film_y))};
    for (int vertex = 0; vertex < depth; ++vertex)
        for (uint32_t what = 0; what < uint32_t(Dimension::count); ++what)
            all.push_back(double(sampler.get(dimension(vertex, Dimension(what)))));
    return all;
}

}  // namespace

int main() {
    return course::answer_all({
        {"radical_inverse", 3, [](In x) { return radical_inverse(uint32_t(x[0]), bits_of(x, 1)); }},
        {"scrambled_radical_inverse", 7, scrambled},
        {"path", 3, path},
        {"in_part", 4, [](In x) { return in_part(uint32_t(x[0]), uint32_t(x[1]), bits_of(x, 2)); }},
        {"in_cell", 5,
         [](In x) {
             return in_cell(uint32_t(x[0]), uint32_t(x[1]), uint32_t(x[2]), bits_of(x, 3));
         }},
    });
}

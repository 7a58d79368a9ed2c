// course/kinds.h  kinds of subjects of week 6, in the words of its sheet
//
// A subject's name is "KIND: DETAIL".  A report says of which kinds a test has missed some, or
// always refuses one that is right; which of the hidden ones they are is not said.
#pragma once
#include <string>
#include <vector>

namespace penumbra::course {

inline const std::vector<std::string> kinds = {
    // wrong samplers
    "a factor of the density", "the form of the density", "pairs that cover a part alone",
    "the horizon", "lengths", "the borders of the square",
    // wrong estimators
    "the mean", "a bias of c / n", "noise that does not fall", "numbers that are not finite",
    "the limit of a consistent one",
    // wrong intersectors
    "roots of a sphere", "the radius", "tmax", "edges of a triangle", "what lies behind",
    "sides of a triangle", "small bodies and distances", "the distance", "coordinates",
    // right ones
    "the rounding of float", "rejected pairs", "less noise than random numbers have",
    "no noise at all", "a declared bias", "a truth of 0", "another way"};

// Its number; -1: its name has none.
inline int kind_of(const std::string& name) {
    for (size_t i = 0; i < kinds.size(); ++i)
        if (name.starts_with(kinds[i] + ": ")) return int(i);
    return -1;
}

}  // namespace penumbra::course

// bugs/appleseed_ggx.cpp  appleseed: at normal incidence the azimuth is 2/pi of a number, not 2 pi
//
// source: appleseedhq/appleseed b1d6476e337b43d221cc16b5d649cab6e1ae9c01 src/appleseed/foundation/math/microfacet.cpp
// cut: /^Vector2f GGXMDF::sample11(/,/^}/
// C++: s/GGXMDF:://; s/^(    const float         gamma\)) const/\1/; s/return Vector2f\((.*)\);/return {\1};/
// repair: s/TwoOverPi<float>\(\) \* s\[1\]/TwoPi<float>() * s[1]/
#include "bug.h"

using Vector2f = std::array<float, 2>;
using Vector3f = std::array<float, 3>;
template <class T>
T TwoOverPi() {
    return T(2 / oracle::pi);
}
template <class T>
T TwoPi() {
    return T(2 * oracle::pi);
}
inline float square(float x) { return x * x; }
#include "excerpt.h"

int main() {
    oracle::Random random(oracle::seed_of("appleseed, GGXMDF::sample11"));
    auto slopes = [](float u, float v, float w) { return sample11(1, {u, v, w}, 0); };
    auto pdf = [](Vector2f s) {
        const double t = 1 + square(s[0]) + square(s[1]);
        return 1 / (oracle::pi * t * t);
    };
    return answer(oracle::expect_density(random, slopes, pdf, oracle::Plane{}, {.name = "slopes"}));
}

// course/answers_5.cpp  answers of week 5: estimators of shadowed light
#include "course/answers.h"
#include "shadow/estimators.h"
#include "shadow/irradiance.h"

using namespace penumbra;
using course::In, course::Out;

namespace {

// n, U, w, wV, bb, b_wV, b_U.
ShadowMoments moments_of(In x) { return {uint64_t(x[0]), x[1], x[2], x[3], x[4], x[5], x[6]}; }
Out of_moments(const ShadowMoments& m) {
    return course::row(m.n, m.U, m.w, m.wV, m.bb, m.b_wV, m.b_U);
}

// Of samples U, w, wV.
ShadowMoments moments_of_samples(In x) {
    ShadowMoments m;
    for (size_t i = 0; i + 3 <= x.size(); i += 3) m.add(x[i], x[i + 1], x[i + 2]);
    return m;
}

Polygon polygon_of(In x) {
    Polygon p;
    for (size_t i = 0; i + 3 <= x.size() && p.n < 8; i += 3) p.add(course::vec3_of(x, i));
    return p;
}

}  // namespace

int main() {
    return course::answer_all({
        {"control", 3, [](In x) { return control(x[0], x[1], x[2]); }},
        // U, w and w V of three channels.
        {"control_of_colours", 9,
         [](In x) {
             using course::vec3_of;
             return control(vec3_of(x, 0), vec3_of(x, 3), vec3_of(x, 6));
         }},
        {"visible", 7, [](In x) { return visible_part(moments_of(x)); }},
        {"ratio", 7, [](In x) { return ratio(moments_of(x)); }},
        {"regression", 7, [](In x) { return regression(moments_of(x)); }},
        {"moments", 0, [](In x) { return of_moments(moments_of_samples(x)); }},
        // Of the first x[0] samples, and of the others.
        {"merged", 0,
         [](In x) {
             const size_t first = 3 * size_t(x[0]);
             return of_moments(merge(moments_of_samples(x.subspan(1, first)),
                                     moments_of_samples(x.subspan(1 + first))));
         }},
        {"lambert", 0, [](In x) { return irradiance_lambert(polygon_of(x)); }},
    });
}

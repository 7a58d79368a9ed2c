// course/answers_2.cpp  answers of week 2: warps and densities
#include "course/answers.h"
#include "world/lights.h"
#include "world/warp.h"

using namespace penumbra;
using course::In, course::vec3_of;

namespace {

vec2 u_of(In x) { return {real(x[0]), real(x[1])}; }

// Corner and edges of a quad, the point that sees it, the place on it along its edges.
real polygon_density(In x) {
    const Light l(vec3_of(x, 0), QuadLight{vec3_of(x, 3), vec3_of(x, 6)});
    const vec3 y = l.p + real(x[12]) * vec3_of(x, 3) + real(x[13]) * vec3_of(x, 6);
    return pdf_polygon_by_area(l, vec3_of(x, 9), {y, l.n, 0});
}

}  // namespace

int main() {
    return course::answer_all({
        {"sample_uniform_hemisphere", 2, [](In u) { return sample_uniform_hemisphere(u_of(u)); }},
        {"pdf_uniform_hemisphere", 1, [](In c) { return pdf_uniform_hemisphere(real(c[0])); }},
        {"sample_uniform_sphere", 2, [](In u) { return sample_uniform_sphere(u_of(u)); }},
        {"pdf_uniform_sphere", 0, [](In) { return pdf_uniform_sphere(); }},
        {"sample_cosine_hemisphere", 2, [](In u) { return sample_cosine_hemisphere(u_of(u)); }},
        {"pdf_cosine_hemisphere", 1, [](In c) { return pdf_cosine_hemisphere(real(c[0])); }},
        {"sample_triangle", 8,
         [](In x) { return sample_triangle(u_of(x), vec3_of(x, 2), vec3_of(x, 5)); }},
        {"pdf_triangle_area", 6, [](In x) { return pdf_triangle_area(vec3_of(x), vec3_of(x, 3)); }},
        {"sample_phong_lobe", 3, [](In x) { return sample_phong_lobe(u_of(x), real(x[2])); }},
        {"pdf_phong_lobe", 2, [](In x) { return pdf_phong_lobe(real(x[0]), real(x[1])); }},
        {"sample_cone", 3, [](In x) { return sample_cone(u_of(x), real(x[2])); }},
        {"solid_angle_cone", 1, [](In sin2) { return solid_angle_cone(real(sin2[0])); }},
        {"pdf_cone", 1, [](In sin2) { return pdf_cone(real(sin2[0])); }},
        {"pdf_polygon_by_area", 14, polygon_density},
    });
}

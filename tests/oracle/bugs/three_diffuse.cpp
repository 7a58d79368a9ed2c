// bugs/three_diffuse.cpp  three-gpu-pathtracer: minus the normal, plus the normal, is no direction
//
// source: gkjohnson/three-gpu-pathtracer v0.0.26 src/shader/sampling/shape_sampling_functions.glsl.js
// cut: /^	vec3 sampleSphere( vec2 uv ) {/,/^	}/
// source: gkjohnson/three-gpu-pathtracer v0.0.26 src/shader/bsdf/bsdf_functions.glsl.js
// cut: /^	vec3 diffuseDirection( vec3 wo, SurfaceRecord surf ) {/,/^	}/
// repair: s/lightDirection = normalize\( lightDirection \);/lightDirection = length( lightDirection ) < 1e-6 ? vec3( 0.0, 0.0, 1.0 ) : normalize( lightDirection );/
#include "bug.h"

constexpr float PI = 3.14159265f;
struct SurfaceRecord {};
vec2 number;
inline vec2 rand2(int) { return number; }
#include "excerpt.h"

int main() {
    // Numbers of the lattice of 1/4: u = 0 is one of 2^32 of theirs, and comes in every large
    // image.
    int i = 0;
    auto length_of = [&] {
        number = vec2(float(i % 4) / 4, float(i / 4) / 4), ++i;
        return length(diffuseDirection(vec3(0, 0, 1), {}));
    };
    oracle::Options o{.name = "length of a direction"};
    return answer(oracle::expect_mean(
        1, 16, [&] { return std::round(1e5 * length_of()) / 1e5; }, o));
}

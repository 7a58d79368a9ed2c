// labs/knot.cpp  3  writes a mesh to render: a trefoil knot of 24 000 triangles
//
//   build/knot FILE.obj
//
// The mesh is a tube of radius 0.42 about the (2,3) torus knot p(t) = ((2 + cos 3t) cos 2t,
// (2 + cos 3t) sin 2t, sin 3t).  It has 600 rings of 20 corners, each normal to the tangent p'(t).
#include "base/vec.h"
#include "text/files.h"
#include "text/program.h"

namespace {
using namespace penumbra;

constexpr int rings = 600, corners = 20;
constexpr double radius = 0.42;

std::string knot() {
    auto index = [](int ring, int corner) { return ring % rings * corners + corner % corners + 1; };
    std::string points = "# trefoil knot, " + std::to_string(2 * rings * corners) + " triangles\n",
                triangles;
    char line[128];
    for (int i = 0; i < rings; ++i) {
        const double t = 2 * std::numbers::pi * i / rings, w = 2 + std::cos(3 * t),
                     dw = -3 * std::sin(3 * t);
        const vec3 centre{real(w * std::cos(2 * t)), real(w * std::sin(2 * t)),
                          real(std::sin(3 * t))},
            tangent{real(dw * std::cos(2 * t) - 2 * w * std::sin(2 * t)),
                    real(dw * std::sin(2 * t) + 2 * w * std::cos(2 * t)),
                    real(3 * std::cos(3 * t))};
        // The tangent is never radial on the torus, so the tube has no twist and no seam.
        const vec3 axis_point = unit(vec3{centre.x, centre.y, 0}) * real(2);
        const vec3 b = unit(cross(tangent, centre - axis_point)), a = unit(cross(b, tangent));
        for (int j = 0; j < corners; ++j) {
            const double angle = 2 * std::numbers::pi * j / corners;
            const vec3 p =
                centre + a * real(radius * std::cos(angle)) + b * real(radius * std::sin(angle));
            std::snprintf(line, sizeof line, "v %.7f %.7f %.7f\n", double(p.x), double(p.y),
                          double(p.z));
            points += line;
            const int q = index(i, j), r = index(i, j + 1), s = index(i + 1, j + 1);
            std::snprintf(line, sizeof line, "f %d %d %d\nf %d %d %d\n", q, index(i + 1, j), s, q,
                          s, r);
            triangles += line;
        }
    }
    return points + triangles;
}

int run(const std::vector<std::string>& words) {
    const std::string usage = "usage: knot FILE.obj";
    if (words.size() == 1 && (words[0] == "--help" || words[0] == "-h"))
        return std::printf("%s\nWrites a mesh to render: a trefoil knot of %d triangles.\n",
                           usage.c_str(), 2 * rings * corners),
               0;
    if (words.size() != 1 || !words[0].ends_with(".obj")) throw UserError(usage);
    write_file(words[0], knot());
    return 0;
}

}  // namespace

int main(int argc, char** argv) try { return finished(run({argv + 1, argv + argc})); } catch (...) {
    return failed();
}

// course/answers_1.cpp  answers of week 1: intersections and the tree
#include "course/answers.h"
#include "world/bvh.h"
#include "world/scene.h"

using namespace penumbra;
using course::In, course::row, course::Out, course::vec3_of;

namespace {

// Whether something is hit, and the numbers of the hit.
Out hit_of(const std::optional<Hit>& hit) {
    if (!hit) return {0, 0, 0, 0};
    return row(1, hit->t, hit->v, hit->w);
}

// Eye, target, field of view, width, height, x, y: the ray's origin, direction and end.
Out ask_camera(In x) {
    const Camera camera = look_at(vec3_of(x, 0), vec3_of(x, 3), real(x[6]));
    const Ray ray = camera_ray(camera, {int(x[7]), int(x[8])}, real(x[9]), real(x[10]));
    return row(ray.o, ray.d, ray.tmax);
}

// Each begins with origin, direction, tmax of a ray.
Ray ray_of(In x) { return {vec3_of(x, 0), vec3_of(x, 3), real(x[6])}; }

// Centre, radius.
Out ask_sphere(In x) {
    const Shape s{vec3_of(x, 7), {}, {}, real(x[10])};
    return hit_of(intersect_sphere(s, ray_of(x), real(x[6])));
}

// Corners.
Out ask_triangle(In x) {
    const Ray ray = ray_of(x);
    const Shape s{vec3_of(x, 7), vec3_of(x, 10), vec3_of(x, 13)};
    return hit_of(intersect_triangle(s, ray, shear(ray.d), ray.tmax));
}

// Lower and upper corner.
Out ask_box(In x) {
    const auto t = enter_box({vec3_of(x, 7), vec3_of(x, 10)}, Probe(ray_of(x)));
    return row(t.has_value(), t.value_or(0));
}

// Lower and upper corners of boxes: the cost of the best division, and how many are on the left.
Out ask_split(In x) {
    std::vector<Box> boxes;
    for (size_t i = 0; i + 6 <= x.size(); i += 6)
        boxes.push_back({vec3_of(x, i), vec3_of(x, i + 3)});
    const Split d = best_split(boxes);
    return row(d.cost, d.left);
}

// tmax, then four numbers a node: its first, its count, where a ray enters it and where it meets
// what is in the leaf; -1: it does not.  A box holds no more than its node's number.  The hit, how
// many boxes were asked and how many leaves looked at, and the first six of these.
Out ask_tree(In x) {
    const size_t n = (x.size() - 1) / 4;
    std::vector<TreeNode> nodes(n);
    for (size_t i = 0; i < n; ++i) {
        nodes[i].box.lo.x = nodes[i].box.hi.x = real(i);
        nodes[i].first = uint32_t(x[1 + 4 * i]), nodes[i].count = uint32_t(x[2 + 4 * i]);
    }
    double boxes = 0, leaves = 0;
    Out seen(6, -1);
    auto enter = [&](const Box& b) -> std::optional<real> {
        ++boxes;
        const double t = x[3 + 4 * size_t(b.lo.x)];
        return t < 0 ? std::nullopt : std::optional(real(t));
    };
    auto look = [&](const TreeNode& leaf, Hit best) {
        if (leaves < 6) seen[size_t(leaves)] = double(leaf.box.lo.x);
        ++leaves;
        const double t = x[4 + 4 * size_t(leaf.box.lo.x)];
        return t < 0 || real(t) > best.t ? best : Hit{real(t), uint32_t(leaf.box.lo.x)};
    };
    const Hit hit = nearest_hit(nodes, Hit{real(x[0])}, enter, look);
    const bool any = hit.id != UINT32_MAX;
    return row(any ? hit.t : -1, any ? double(hit.id) : -1, boxes, leaves, seen);
}

}  // namespace

int main() {
    return course::answer_all({{"camera_ray", 11, ask_camera},
                               {"intersect_sphere", 11, ask_sphere},
                               {"intersect_triangle", 16, ask_triangle},
                               {"enter_box", 13, ask_box},
                               {"best_split", 0, ask_split},
                               {"nearest_hit", 0, ask_tree}});
}

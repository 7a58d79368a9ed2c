// world/bvh_test.cpp  the binary BVH gives the answers of a loop over all shapes, in less time
#include "world/bvh.h"

#include "world/tree_cases.h"

TEST_CASE_TEMPLATE_INVOKE(random_and_awkward, Bvh);
TEST_CASE_TEMPLATE_INVOKE(one_shape, Bvh);
TEST_CASE_TEMPLATE_INVOKE(slivers_edge_on, Bvh);
TEST_CASE_TEMPLATE_INVOKE(all_sizes, Bvh);
TEST_CASE_TEMPLATE_INVOKE(coincident, Bvh);
TEST_CASE_TEMPLATE_INVOKE(identical, Bvh);
TEST_CASE_TEMPLATE_INVOKE(exponentially_spaced, Bvh);
TEST_CASE_TEMPLATE_INVOKE(beyond_float, Bvh);
TEST_CASE_TEMPLATE_INVOKE(infinitely_far, Bvh);
TEST_CASE_TEMPLATE_INVOKE(empty_and_nan, Bvh);

TEST_CASE("a ray looks at few nodes and shapes of the plain tree: nearest first, none behind") {
    Dice random{{5}};
    const MeanWork small = work_of_rays<Bvh>(many(20000, real(0.03), random), random);
    const MeanWork large = work_of_rays<Bvh>(many(2000, 1, random), random);
    CHECK(small.nodes < 63);
    CHECK(small.shapes < 1);
    CHECK(large.nodes < 510);
    CHECK(large.shapes < 193);
}

TEST_CASE("boxes are entered where a point within comes first, or missed if none does") {
    // Points along the ray are classified as inside or outside the box.
    Dice random{{7}};
    int wrong = 0, met = 0;
    for (int i = 0; i < 3000; ++i) {
        Box b;
        for (int k = 0; k < 2; ++k) b.add(random.direction(random(0, 2)));
        const vec3 o = random.direction(random(0, 3)), to = random.direction(random(0, 2));
        const Ray ray{o, unit(to - o), random(0, 6)};
        const auto t = enter_box(b, Probe(ray));
        met += t.has_value();
        auto depth = [&](real s) {  // distance of the point at s from the box
            const vec3 p = ray.o + s * ray.d;
            return std::max({b.lo.x - p.x, p.x - b.hi.x, b.lo.y - p.y, p.y - b.hi.y, b.lo.z - p.z,
                             p.z - b.hi.z});
        };
        const real close = 64 * ulp;
        for (int k = 0; k <= 100; ++k) {
            const real s = ray.tmax * real(k) / 100;
            wrong += depth(s) < -close && !(t && *t <= s + close);
        }
        if (t) wrong += !(*t >= 0 && *t <= ray.tmax && depth(*t) < close);
        if (t && *t > 0) wrong += depth(*t) < -close;
    }
    CHECK(wrong == 0);
    CHECK(met > 300);
    CHECK(met < 2700);
    // A ray that rises by 1 along 2^24.
    const real far = 0x1p24;
    const Probe rising(Ray{{}, {1, 1 / far, 0}});
    CHECK(enter_box({{far, real(0.5), -1}, {2 * far, 9, 1}}, rising) == far);
    CHECK(!enter_box({{far, -9, -1}, {2 * far, real(0.5), 1}}, rising));
}

TEST_CASE("nearest_hit looks for what is nearer than the best that it is given, and at that only") {
    std::vector<TreeNode> nodes(3);
    nodes[0].first = 1;
    nodes[1].box.lo.x = 1, nodes[1].count = 1;
    nodes[2].box.lo.x = 2, nodes[2].count = 1;
    int seen = 0;
    auto enter = [](const Box& b) { return std::optional(std::min(b.lo.x, real(2))); };
    auto look = [&](const TreeNode& leaf, Hit best) {
        ++seen;
        return best.t < leaf.box.lo.x + 1 ? best : Hit{leaf.box.lo.x + 1, uint32_t(leaf.box.lo.x)};
    };
    nodes[0].box.lo.x = 0;
    CHECK(nearest_hit(nodes, Hit{}, enter, look).id == 1);
    CHECK(seen == 2);  // the second leaf begins at the first hit
    CHECK(nearest_hit(nodes, Hit{real(1.5)}, enter, look).t == real(1.5));
    CHECK(seen == 3);
    CHECK(nearest_hit(nodes, Hit{real(0.5)}, enter, look).t == real(0.5));
    CHECK(seen == 3);
}

TEST_CASE("boxes are divided where areas times numbers are least, in any order of sizes") {
    Dice random{{6}};
    int wrong = 0;
    for (int i = 0; i < 2000; ++i) {
        std::vector<Box> boxes(2 + random.below(12));
        for (Box& b : boxes) {
            b.add(random.direction());
            b.add(b.lo + random.decades(-3, 1) * vec3{random(0, 1), random(0, 1), random(0, 1)});
        }
        auto cost = [&](size_t left) {
            Box halves[2];
            for (size_t k = 0; k < boxes.size(); ++k) halves[k >= left].add(boxes[k]);
            return double(halves[0].half_area()) * double(left) +
                   double(halves[1].half_area()) * double(boxes.size() - left);
        };
        const Split d = best_split(boxes);
        double least = HUGE_VAL;
        for (size_t k = 1; k < boxes.size(); ++k) least = std::min(least, cost(k));
        wrong += !(d.left > 0 && d.left < boxes.size() && cost(d.left) <= least * (1 + 1e-5) &&
                   std::abs(double(d.cost) - least) <= least * 1e-5);
    }
    CHECK(wrong == 0);
}

// course/binary_bvh_test.cpp  the starter's tree answers as the renderer's and a loop over all
// shapes do do
#include "course/bvh.h"

#include <doctest/doctest.h>

#include "world/bvh.h"
#include "world/hard_rays.h"

namespace {

using Comparison = ComparisonOf<BinaryBvh>;

bool answers_alike(const BinaryBvh& tree, const Bvh& other, const Ray& ray) {
    return same(tree.closest(ray), other.closest(ray)) && tree.occluded(ray) == other.occluded(ray);
}

// Boxes and shapes looked at, in the mean of 10000 rays from a sphere of radius 1.
struct Work {
    double boxes = 0, shapes = 0;
};
Work work_of_rays(const BinaryBvh& tree, Dice& random) {
    const int rays = 10000;
    Work mean;
    for (int i = 0; i < rays; ++i) {
        const vec3 o = random.direction();
        const BinaryBvh::Work work = tree.work({o, random.direction()});
        mean.boxes += double(work.boxes) / rays, mean.shapes += double(work.shapes) / rays;
    }
    return mean;
}

Shapes many(int n, real edge, Dice& random) {
    Shapes scene;
    for (int i = 0; i < n; ++i) scene.push_back(triangle(edge, random));
    return scene;
}

}  // namespace

TEST_CASE("the starter's tree equals a loop over all shapes, on random and on awkward rays") {
    Dice random{{1}};
    const Shapes scenes[] = {
        soup(30, 0, random), soup(15, 15, random), soup(0, 20, random), ball(2), grid(2), room(),
        soup(5, 0, random)};
    for (const Shapes& scene : scenes) {
        Comparison c{scene};
        judge(c, int(2000000 / (20 + scene.size())), 1, random);
        CAPTURE(scene.size());
        CHECK(c.different == 0);
        CHECK(c.hits > c.rays / 5);
        CHECK(c.hits < c.rays);
    }
}

TEST_CASE("the starter's tree of one shape is hit exactly when the shape is, from far away too") {
    Dice random{{2}};
    int hits = 0, different = 0;
    for (int i = 0; i < 30000; ++i) {
        Shape s = i % 2 == 0 ? soup(0, 1, random)[0] : triangle(1, random);
        if (i % 4 > 0) s.a = {}, s.b.x = s.b.y = s.c.y = 0;
        const Shapes scene{s};
        Comparison c{scene};
        const Shape tip = s.is_sphere() ? s : Shape{s.a, s.a, s.a};
        const real reach = random.decades(0, 7);
        for (int k = 0; k < 2; ++k) c.judge(aimed(s, at_edge, reach, random));
        for (int k = 0; k < 8; ++k) c.judge(aimed(tip, near_axis, reach, random));
        different += c.different;
        hits += c.hits;
    }
    CHECK(different == 0);
    CHECK(hits > 100000);
}

TEST_CASE(
    "the starter's tree and the renderer's agree at all sizes, and of equal hits on the first") {
    Dice random{{3}};
    Shapes mixture;
    for (int i = 0; i < 60; ++i)
        mixture.push_back(scaled(soup(i % 2, 1 - i % 2, random), random.decades(-8, 8))[0]);
    for (int i = 0; i < 60; ++i) {  // small ones far out, each of them twice
        const Shape s = soup(i % 2, 1 - i % 2, random)[0];
        const vec3 far = random.decades(0, 8) * random.direction();
        mixture.push_back({s.a + far, s.b + far, s.c + far, s.r});
        mixture.push_back(mixture.back());
    }
    const BinaryBvh tree(mixture);
    const Bvh other(mixture);
    int different = 0, hits = 0;
    for (int exponent = -8; exponent <= 8; ++exponent)
        for (int i = 0; i < 4000; ++i) {
            const Ray ray = aimed(mixture[random.below(mixture.size())], i % aims,
                                  std::pow(real(10), real(exponent)), random);
            hits += other.closest(ray).has_value();
            different += !answers_alike(tree, other, ray);
        }
    CHECK(different == 0);
    CHECK(hits > 10000);
}

TEST_CASE("20000 identical triangles, and 20000 at exponentially spaced places, fit the stack") {
    Dice random{{4}};
    const Shapes alike(20000, triangle(1, random));
    Comparison same_place{alike};
    for (int i = 0; i < 60; ++i) same_place.judge(aimed(alike[0], i % aims, 1, random));
    CHECK(same_place.different == 0);
    CHECK(same_place.hits > 5);
    const real octaves = sizeof(real) == 8 ? 300 : 40;
    Shapes spaced;
    for (int i = 0; i < 20000; ++i) {
        const real x = std::exp2(octaves * (2 * real(i) / 20000 - 1));
        spaced.push_back({{x, -x, -x}, {x, x, -x}, {x, 0, x}});
    }
    Comparison c{spaced};
    for (int i = 0; i < 12; ++i) {
        const real x = std::exp2(octaves * random(-1, 1));
        const vec3 skew = unit({1, random(-1, 1) / 4, random(-1, 1) / 4});
        for (vec3 d : {vec3{1, 0, 0}, vec3{-1, 0, 0}, skew, -skew, random.direction()}) {
            c.judge({{0, 0, 0}, d});
            c.judge({{x, x / 9, x / 7}, d});
        }
    }
    CHECK(c.different == 0);
    CHECK(c.hits > c.rays / 4);
}

TEST_CASE("a ray looks at few boxes and shapes of the starter's tree: nearest first, none behind") {
    Dice random{{5}};
    const Work small = work_of_rays(BinaryBvh(many(20000, real(0.03), random)), random);
    const Work large = work_of_rays(BinaryBvh(many(2000, 1, random)), random);
    CAPTURE(small.boxes);
    CAPTURE(small.shapes);
    CAPTURE(large.boxes);
    CAPTURE(large.shapes);
    CHECK(small.boxes < 63);
    CHECK(small.shapes < 1);
    CHECK(large.boxes < 510);
    CHECK(large.shapes < 193);
}

TEST_CASE("an empty starter's tree is missed, and a ray that is not a number misses every tree") {
    const real nan = std::numeric_limits<real>::quiet_NaN();
    const Ray ray{{0, 0, 3}, {0, 0, -1}};
    for (const BinaryBvh& tree : {BinaryBvh{}, BinaryBvh(Shapes{})}) {
        CHECK(!tree.closest(ray));
        CHECK(!tree.occluded(ray));
        CHECK(tree.work(ray).boxes == 0);
    }
    const BinaryBvh tree(room());
    CHECK(tree.closest(ray));
    for (const Ray& bad : {Ray{{0, 0, 3}, {nan, nan, nan}}, Ray{{nan, 0, 3}, {0, 0, -1}}}) {
        CHECK(!tree.closest(bad));
        CHECK(!tree.occluded(bad));
    }
}

TEST_CASE("boxes are entered where a point within comes first, or missed if none does") {
    // Of points along the ray, which are in the box and which are not.
    Dice random{{7}};
    int wrong = 0, met = 0;
    for (int i = 0; i < 3000; ++i) {
        Box b;
        for (int k = 0; k < 2; ++k) b.add(random.direction(random(0, 2)));
        const vec3 o = random.direction(random(0, 3)), to = random.direction(random(0, 2));
        const Ray ray{o, unit(to - o), random(0, 6)};
        const auto t = enter_box(b, Probe(ray));
        met += t.has_value();
        auto depth = [&](real s) {  // how far outside the box the point at s is
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
    CHECK(seen == 2);  // the second begins where the first hit is
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
        const Division d = best_division(boxes);
        double least = HUGE_VAL;
        for (size_t k = 1; k < boxes.size(); ++k) least = std::min(least, cost(k));
        wrong += !(d.left > 0 && d.left < boxes.size() && cost(d.left) <= least * (1 + 1e-5) &&
                   std::abs(double(d.cost) - least) <= least * 1e-5);
    }
    CHECK(wrong == 0);
}

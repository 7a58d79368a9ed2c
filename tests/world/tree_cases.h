// world/tree_cases.h  the cases that test every BVH
//
//     TEST_CASE_TEMPLATE_INVOKE(random_and_awkward, Bvh);
#pragma once
#include "world/hard_rays.h"

// Nodes and shapes visited per ray: averages of 10000 rays from a sphere of radius 1.
struct MeanWork {
    double nodes = 0, shapes = 0;
};
template <class Tree>
MeanWork work_of_rays(const Shapes& scene, Dice& random) {
    const Tree tree(scene);
    const int rays = 10000;
    MeanWork mean;
    for (int i = 0; i < rays; ++i) {
        const vec3 o = random.direction();
        const auto work = tree.work({o, random.direction()});
        mean.nodes += double(work.nodes) / rays, mean.shapes += double(work.shapes) / rays;
    }
    return mean;
}

TEST_CASE_TEMPLATE_DEFINE(
    "closest and occluded equal a loop over all shapes, on random and on awkward rays", Tree,
    random_and_awkward) {
    Dice random{{1}};
    const Shapes scenes[] = {
        soup(30, 0, random), soup(15, 15, random), soup(0, 20, random), ball(2), grid(2), room(),
        soup(5, 0, random)};
    for (const Shapes& scene : scenes) {
        ComparisonOf<Tree> c{scene};
        judge(c, int(2000000 / (20 + scene.size())), 1, random);
        CAPTURE(scene.size());
        CHECK(c.different == 0);
        CHECK(c.hits > c.rays / 5);
        CHECK(c.hits < c.rays);
    }
}

TEST_CASE_TEMPLATE_DEFINE("a tree of one shape is hit exactly when the shape is, from far away too",
                          Tree, one_shape) {
    // At that distance rounding moves a ray by more than the padding of a box, which is relative to
    // the shape: the slabs must be wide enough.  Planes through 0 are exact even in float.
    Dice random{{2}};
    int hits = 0, different = 0;
    for (int i = 0; i < 20000; ++i) {
        Shape s = i % 8 == 0 ? soup(0, 1, random)[0] : triangle(1, random);
        if (i % 4 > 0) s.a = {}, s.b.x = s.b.y = s.c.y = 0;
        const Shapes scene{s};
        ComparisonOf<Tree> c{scene};
        const Shape tip = s.r > 0 ? s : Shape{s.a, s.a, s.a};
        const real reach = random.decades(0, 7);
        for (int k = 0; k < 2; ++k) c.judge(aimed<Tree>(s, at_edge, reach, random));
        for (int k = 0; k < 8; ++k) c.judge(aimed<Tree>(tip, near_axis, reach, random));
        different += c.different;
        hits += c.hits;
    }
    CHECK(different == 0);
    CHECK(hits > 60000);
}

TEST_CASE_TEMPLATE_DEFINE(
    "slivers seen edge-on or at their ends are hit in their boxes or not at all", Tree,
    slivers_edge_on) {
    Dice random{{3}};
    int hits = 0, different = 0;
    for (int i = 0; i < 100; ++i) {
        const Shapes scene = slivers(10, random);
        ComparisonOf<Tree> c{scene};
        for (int k = 0; k < 2000; ++k)
            c.judge(aimed<Tree>(scene[random.below(10)], k % 2 ? beside : in_plane, 1, random));
        different += c.different;
        hits += c.hits;
    }
    CHECK(different == 0);
    CHECK(hits > 10000);
}

TEST_CASE_TEMPLATE_DEFINE(
    "tree and loop agree at coordinates of 1e8, of 1e-8, and of all sizes at once", Tree,
    all_sizes) {
    Dice random{{4}};
    auto one = [&](int i) { return soup(i % 2, 1 - i % 2, random)[0]; };
    Shapes mixture;
    for (int i = 0; i < 60; ++i) mixture.push_back(scaled(one(i), random.decades(-8, 8)));
    for (int i = 0; i < 60; ++i) {  // small shapes far out
        const Shape s = one(i);
        mixture.push_back(moved(s, random.decades(0, 8) * random.direction()));
    }
    auto compare = [&](const Shapes& scene, int rays, std::vector<real> reaches) {
        ComparisonOf<Tree> c{scene};
        for (real reach : reaches) judge(c, rays, reach, random);
        CHECK(c.different == 0);
        CHECK(c.hits > c.rays / 5);
    };
    for (real size : {real(1e8), real(1e-8)})
        for (const Shapes& scene : {soup(30, 30, random), room(), grid(2)})
            compare(scaled(scene, size), 4000, {size});
    std::vector<real> reaches;
    for (int exponent = -8; exponent <= 8; ++exponent)
        reaches.push_back(std::pow(real(10), real(exponent)));
    compare(mixture, 2000, reaches);
}

TEST_CASE_TEMPLATE_DEFINE("of coincident shapes the first is hit, wherever the tree has put it",
                          Tree, coincident) {
    Dice random{{5}};
    int wrong = 0;
    for (int i = 0; i < 300; ++i) {
        // 60 draws from 12 shapes: the expected index is that of the first copy.
        const Shapes originals = soup(6, 6, random);
        Shapes scene;
        for (int k = 0; k < 60; ++k) scene.push_back(originals[random.below(12)]);
        auto copy = [](const Shape& s, const Shape& t) {
            return s.a == t.a && s.b == t.b && s.c == t.c && s.r == t.r;
        };
        const Tree tree(scene);
        for (int k = 0; k < 100; ++k) {
            const auto hit = tree.closest({2 * random.direction(), random.direction()});
            if (!hit) continue;
            for (uint32_t first = 0; first < hit->id; ++first)
                wrong += copy(scene[first], scene[hit->id]);
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE_TEMPLATE_DEFINE("of identical triangles the first is hit", Tree, identical) {
    Dice random{{6}};
    const Shape t = triangle(1, random);
    const Tree tree(Shapes(30000, t));
    int wrong = 0, hits = 0;
    for (int i = 0; i < 120; ++i) {
        Ray ray = aimed<Tree>(t, i % aims, 1, random);
        auto expected = nearest({t}, ray);
        wrong += !same(tree.closest(ray), expected);
        wrong += tree.occluded(ray) != expected.has_value();
        hits += expected.has_value();
        if (!expected) continue;
        ray.tmax = expected->t;
        wrong += !same(tree.closest(ray), expected);
    }
    CHECK(wrong == 0);
    CHECK(hits > 10);
}

TEST_CASE_TEMPLATE_DEFINE("triangles at exponentially spaced places do not exhaust the stack", Tree,
                          exponentially_spaced) {
    // The cubes of the coordinates stay finite; in double they exceed the range of float boxes.
    const real octaves = sizeof(real) == 8 ? 300 : 40;
    Dice random{{7}};
    Shapes scene;
    const int n = 30000;
    for (int i = 0; i < n; ++i) {
        const real x = std::exp2(octaves * (2 * real(i) / n - 1));
        scene.push_back({{x, -x, -x}, {x, x, -x}, {x, 0, x}});
    }
    ComparisonOf<Tree> c{scene};
    for (int i = 0; i < 12; ++i) {
        const real x = std::exp2(octaves * random(-1, 1));
        const vec3 skew = unit({1, random(-1, 1) / 4, random(-1, 1) / 4});
        for (vec3 d : {vec3{1, 0, 0}, vec3{-1, 0, 0}, skew, -skew, random.direction()}) {
            c.judge({{0, 0, 0}, d});
            c.judge({{x, x / 9, x / 7}, d});
            c.judge({{2 * scene.back().a.x, 0, 0}, d});
        }
    }
    CHECK(c.different == 0);
    CHECK(c.hits > c.rays / 4);
}

TEST_CASE_TEMPLATE_DEFINE(
    "triangles of 1e-30 are hit by rays so nearly along an axis that 1/d is beyond float", Tree,
    beyond_float) {
    if (sizeof(real) == 4) return;
    const real distance = real(1e10), size = real(1e-30);
    Shapes scene;
    for (int i = 0; i < 20; ++i) {
        const real y = real(i) * size;
        scene.push_back({{0, y, -size}, {0, y + size, -size}, {0, y, size}});
    }
    ComparisonOf<Tree> c{scene};
    for (int i = 0; i < 20; ++i)
        c.judge({{-distance, 0, 0}, {1, (real(i) + real(0.3)) * size / distance, 0}});
    CHECK(c.different == 0);
    CHECK(c.hits == 20);
}

TEST_CASE_TEMPLATE_DEFINE(
    "rays from infinitely far, as floats see it, meet what there is and nothing else", Tree,
    infinitely_far) {
    // The boxes of absent children are empty, but such a ray enters even those.
    Dice random{{11}};
    const real far = sizeof(real) == 8 ? real(1e300) : real(1e38);
    for (int n : {1, 3, 9, 20}) {
        const Shapes scene = soup(n, n % 3, random);
        ComparisonOf<Tree> c{scene};
        for (int octant = 0; octant < 8; ++octant)
            for (real size : {real(1), far}) {
                const vec3 o =
                    size * vec3{octant & 1 ? real(1) : real(-1), octant & 2 ? real(1) : real(-1),
                                octant & 4 ? real(1) : real(-1)};
                for (int i = 0; i < 50; ++i) c.judge({o, random.direction()});
                c.judge({o, unit({-o.x / size, -o.y / size, -o.z / size})});
            }
        CHECK(c.different == 0);
    }
}

TEST_CASE_TEMPLATE_DEFINE(
    "an empty tree is missed, and a ray that is not a number misses every tree", Tree,
    empty_and_nan) {
    const real nan = std::numeric_limits<real>::quiet_NaN();
    const Ray ray{{0, 0, 3}, {0, 0, -1}};
    for (const Tree& tree : {Tree{}, Tree(Shapes{})}) {
        CHECK(!tree.closest(ray));
        CHECK(!tree.occluded(ray));
        CHECK(tree.work(ray).nodes == 0);
    }
    const Shapes scene = room();
    const Tree tree(scene);
    CHECK(tree.closest(ray));
    for (const Ray& bad : {Ray{{0, 0, 3}, {nan, nan, nan}}, Ray{{nan, 0, 3}, {0, 0, -1}}}) {
        CHECK(!tree.closest(bad));
        CHECK(!tree.occluded(bad));
    }
}

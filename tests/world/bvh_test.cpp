// world/bvh_test.cpp  a tree answers as a loop over all shapes does, bit for bit, only sooner
#include "world/bvh.h"

#include "world/geometry.h"

namespace {

using Shapes = std::vector<Shape>;

// ---- Brute force --------------------------------------------------------------------------------

// The nearest hit of all; of equals the first.
std::optional<Hit> nearest(const Shapes& shapes, const Ray& ray) {
    const Shear k = shear(ray.d);
    std::optional<Hit> best;
    for (uint32_t i = 0; i < shapes.size(); ++i) {
        const auto hit = intersect(shapes[i], ray, k, ray.tmax);
        if (!hit || (best && hit->t >= best->t)) continue;
        best = hit;
        best->id = i;
    }
    return best;
}

bool same(const std::optional<Hit>& a, const std::optional<Hit>& b) {
    if (!a || !b) return !a && !b;
    return a->t == b->t && a->id == b->id && a->v == b->v && a->w == b->w;
}

// Rays on which tree and loop differ, be they endless or end at, just before or about the hit.
struct Comparison {
    const Shapes& shapes;
    Bvh tree{shapes};
    int rays = 0, hits = 0, different = 0;

    void judge(Ray ray) {
        const auto expected = nearest(shapes, ray);
        bool equal = agrees(ray, expected);
        if (expected) {
            const real t = expected->t;
            for (real end : {t, std::nextafter(t, real(0)), rays % 2 ? t / 2 : t * 2}) {
                ray.tmax = end;
                equal = equal && agrees(ray, t <= end ? expected : std::nullopt);
            }
        }
        ++rays;
        hits += expected.has_value();
        different += !equal;
    }
    bool agrees(const Ray& ray, const std::optional<Hit>& expected) const {
        return same(tree.closest(ray), expected) && tree.occluded(ray) == expected.has_value();
    }
};

// ---- Rays ---------------------------------------------------------------------------------------

// A corner of a triangle, a pole of a sphere.
vec3 corner(const Shape& s, Dice& random) {
    const size_t i = random.below(3);
    if (!s.is_sphere()) return i == 0 ? s.a : i == 1 ? s.b : s.c;
    vec3 p = s.a;
    p.*axis[i] += random.sign() * s.r;
    return p;
}

// A plane of the box of a shape as the tree stores it.
real box_plane(const Shape& s, size_t a, Dice& random) {
    const bvh::Planes p = bvh::planes(bvh::outwards(bounds(s)));
    return random.below(2) ? real(-p[a]) : real(p[3 + a]);
}

// A ray that has to do with the shape; distances are in units of `reach`.
enum Aim {
    anywhere,
    at_edge,
    at_corner,
    beside,
    in_plane,
    near_axis,
    across_axis,
    along_axis,
    aims
};
Ray aimed(const Shape& s, int aim, real reach, Dice& random) {
    const vec3 anyhow = random.direction();
    const real distance = reach * random.decades(-1, 1);
    if (aim == anywhere) return {distance * random.direction(), anyhow};
    vec3 target = corner(s, random), d = anyhow;
    const vec3 e = s.b - s.a, f = s.c - s.a;
    if (aim == at_edge && s.is_sphere()) {  // tangent
        const vec3 n = random.direction();
        target = s.a + s.r * n, d = unit(cross(n, d));
    } else if (aim == at_edge) {
        const vec3 next = target == s.a ? s.b : target == s.b ? s.c : s.a;
        target += random(0, 1) * (next - target);
    } else if (aim == beside) {
        target = s.a + random(-1, 2) * e + random(-1, 2) * f;
    } else if (aim == in_plane && !s.is_sphere()) {
        target = s.a + random(0, real(0.5)) * e + random(0, real(0.5)) * f;
        d = unit(random(-1, 1) * e + random(-1, 1) * f);
    } else if (aim == near_axis) {
        // In double also where the inverse is beyond float.
        const real least = sizeof(real) == 8 && random.below(3) == 0 ? -44 : -8;
        for (auto a : axis) d.*a *= random.decades(least, 0);
        d.*axis[random.below(3)] += random.sign();
        d = unit(d);
    } else if (aim == across_axis || aim == along_axis) {  // zeros of both signs, box planes
        const size_t odd = random.below(3);
        for (size_t a = 0; a < 3; ++a) {
            if ((a == odd) == (aim == across_axis)) d.*axis[a] = random.sign() * 0;
            if (random.below(2)) target.*axis[a] = box_plane(s, a, random);
        }
        d = unit(d);
    }
    if (!is_finite(d)) d = anyhow;  // a triangle without area
    const vec3 o = target - distance * d;
    // Rounding may have moved o off the line: aim again, unless the plane is what matters.
    const vec3 again = unit(target - o);
    if ((aim < in_plane || aim == near_axis) && is_finite(again)) d = again;
    return {o, d};
}

void judge(Comparison& c, int rays, real reach, Dice& random) {
    for (int i = 0; i < rays; ++i)
        c.judge(aimed(c.shapes[random.below(c.shapes.size())], i % aims, reach, random));
}

// ---- Scenes, about as large as 1
// -----------------------------------------------------------------

Shape triangle(real edge, Dice& random) {
    const real distance = random(0, 1);  // in this order, whatever the compiler
    const vec3 a = distance * random.direction();
    return {a, a + edge * random.direction(), a + edge * random.direction()};
}

Shapes soup(int triangles, int spheres, Dice& random) {
    Shapes scene;
    for (int i = 0; i < triangles; ++i) scene.push_back(triangle(random.decades(-2, 0), random));
    for (int i = 0; i < spheres; ++i)
        scene.push_back({random(0, 1) * random.direction(), {}, {}, random.decades(-2, 0)});
    return scene;
}

Shapes slivers(int n, Dice& random) {
    Shapes scene;
    for (int i = 0; i < n; ++i) {
        const vec3 a = random(0, 1) * random.direction(), e = random.direction();
        const vec3 f = random(0, 1) * e + random.decades(-11, -2) * random.direction();
        scene.push_back({a, a + e, a + f});
    }
    return scene;
}

void add_quad(Shapes& scene, vec3 p, vec3 u, vec3 v) {
    scene.push_back({p, p + u, p + u + v});
    scene.push_back({p, p + u + v, p + v});
}

// Quads of a cubic grid, all axes, every fourth of them twice.
Shapes grid(int n) {
    Shapes scene;
    const real step = real(1) / real(n);
    int count = 0;
    for (int a = 0; a < 3; ++a)
        for (int i = 0; i < n * n * n; ++i) {
            vec3 p, u, v;
            p.*axis[0] = real(i % n) * step, p.*axis[1] = real(i / n % n) * step;
            p.*axis[2] = real(i / n / n) * step;
            u.*axis[(a + 1) % 3] = step, v.*axis[(a + 2) % 3] = step;
            for (int twice = 0; twice <= (count++ % 4 == 0); ++twice) add_quad(scene, p, u, v);
        }
    return scene;
}

void add_box(Shapes& scene, vec3 p, vec3 size, real cosine, real sine) {
    const vec3 x = size.x * vec3{cosine, 0, sine}, z = size.z * vec3{-sine, 0, cosine};
    const vec3 y{0, size.y, 0};
    for (const auto& [o, u, v] :
         {std::array{p, x, y}, {p, y, z}, {p, z, x}, {p + x, y, z}, {p + y, z, x}, {p + z, x, y}})
        add_quad(scene, o, u, v);
}

// A room with two boxes, a ball, and a lamp in the plane of the ceiling.
Shapes room() {
    Shapes scene;
    add_box(scene, {-1, -1, -1}, {2, 2, 2}, 1, 0);
    add_box(scene, {real(-0.7), -1, real(-0.5)}, {real(0.6), real(1.2), real(0.6)}, real(0.96),
            real(0.28));
    add_box(scene, {real(0.1), -1, 0}, {real(0.6), real(0.6), real(0.6)}, 1, 0);
    add_quad(scene, {real(-0.3), 1, real(-0.3)}, {real(0.6), 0, 0}, {0, 0, real(0.6)});
    scene.push_back({{real(0.4), 0, real(0.3)}, {}, {}, real(0.4)});
    return scene;
}

Shapes scaled(Shapes shapes, real k) {
    for (Shape& s : shapes) s = scaled(s, k);
    return shapes;
}

// Nodes opened and shapes looked at, in the mean of 10000 rays from a sphere of radius 1.
struct Work {
    double nodes = 0, shapes = 0;
};
Work work_of_rays(const Bvh& tree, Dice& random) {
    const int rays = 10000;
    Work mean;
    for (int i = 0; i < rays; ++i) {
        const vec3 o = random.direction();
        const Bvh::Work work = tree.work({o, random.direction()});
        mean.nodes += double(work.nodes) / rays, mean.shapes += double(work.shapes) / rays;
    }
    return mean;
}

}  // namespace

TEST_CASE("closest and occluded equal a loop over all shapes, on random and on awkward rays") {
    Dice random{{1}};
    const Shapes scenes[] = {
        soup(30, 0, random), soup(15, 15, random), soup(0, 20, random), ball(2), grid(2), room(),
        soup(5, 0, random)};
    for (const Shapes& scene : scenes) {
        Comparison c{scene};
        judge(c, int(5000000 / (20 + scene.size())), 1, random);
        CAPTURE(scene.size());
        CHECK(c.different == 0);
        CHECK(c.hits > c.rays / 5);
        CHECK(c.hits < c.rays);
    }
}

TEST_CASE("a tree of one shape is hit exactly when the shape is, from far away too") {
    // From there rounding moves a ray by more than the padding of a box, which is in proportion to
    // the shape: the slabs must be wide enough.  Planes through 0 are not even rounded to float.
    Dice random{{2}};
    int hits = 0, different = 0;
    for (int i = 0; i < 60000; ++i) {
        Shape s = i % 8 == 0 ? soup(0, 1, random)[0] : triangle(1, random);
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
    CHECK(hits > 200000);
}

TEST_CASE("slivers seen edge-on or at their ends are hit in their boxes or not at all") {
    Dice random{{3}};
    int hits = 0, different = 0;
    for (int i = 0; i < 200; ++i) {
        const Shapes scene = slivers(10, random);
        Comparison c{scene};
        for (int k = 0; k < 2000; ++k)
            c.judge(aimed(scene[random.below(10)], k % 2 ? beside : in_plane, 1, random));
        different += c.different;
        hits += c.hits;
    }
    CHECK(different == 0);
    CHECK(hits > 20000);
}

TEST_CASE("tree and loop agree at coordinates of 1e8, of 1e-8, and of all sizes at once") {
    Dice random{{4}};
    Shapes mixture;
    for (int i = 0; i < 60; ++i)
        mixture.push_back(scaled(soup(i % 2, 1 - i % 2, random), random.decades(-8, 8))[0]);
    for (int i = 0; i < 60; ++i) {  // small ones far out
        Shape s = soup(i % 2, 1 - i % 2, random)[0];
        const vec3 far = random.decades(0, 8) * random.direction();
        s = {s.a + far, s.b + far, s.c + far, s.r};
        mixture.push_back(s);
    }
    for (real size : {real(1e8), real(1e-8)})
        for (const Shapes& scene : {soup(30, 30, random), room(), grid(2)}) {
            const Shapes placed = scaled(scene, size);
            Comparison c{placed};
            judge(c, 10000, size, random);
            CHECK(c.different == 0);
            CHECK(c.hits > c.rays / 5);
        }
    Comparison c{mixture};
    for (int exponent = -8; exponent <= 8; ++exponent)
        judge(c, 4000, std::pow(real(10), real(exponent)), random);
    CHECK(c.different == 0);
    CHECK(c.hits > c.rays / 5);
}

TEST_CASE("of coincident shapes the first is hit, wherever the tree has put it") {
    Dice random{{5}};
    int wrong = 0;
    for (int i = 0; i < 300; ++i) {
        // 12 shapes, 5 times over, in any order: the least index is that of the first copy.
        const Shapes originals = soup(6, 6, random);
        Shapes scene;
        for (int k = 0; k < 60; ++k) scene.push_back(originals[random.below(12)]);
        auto copy = [](const Shape& s, const Shape& t) {
            return s.a == t.a && s.b == t.b && s.c == t.c && s.r == t.r;
        };
        const Bvh tree(scene);
        for (int k = 0; k < 100; ++k) {
            const auto hit = tree.closest({2 * random.direction(), random.direction()});
            if (!hit) continue;
            for (uint32_t first = 0; first < hit->id; ++first)
                wrong += copy(scene[first], scene[hit->id]);
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("1e5 identical triangles: at most 128 bytes of nodes each, and the first is hit") {
    Dice random{{6}};
    const Shape t = triangle(1, random);
    const Shapes scene(100000, t);
    const Bvh tree(scene);
    CHECK(tree.bytes() < scene.size() * (sizeof(Shape) + 128));
    CHECK(tree.bytes() >= scene.size() * 3 * sizeof(vec3));
    int wrong = 0, hits = 0;
    for (int i = 0; i < 120; ++i) {
        Ray ray = aimed(t, i % aims, 1, random);
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

TEST_CASE("1e5 triangles at exponentially spaced places do not exhaust the stack") {
    // As far as the cubes of coordinates are numbers; in double beyond the floats of the boxes.
    const real octaves = sizeof(real) == 8 ? 300 : 40;
    Dice random{{7}};
    Shapes scene;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const real x = std::exp2(octaves * (2 * real(i) / n - 1));
        scene.push_back({{x, -x, -x}, {x, x, -x}, {x, 0, x}});
    }
    Comparison c{scene};
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

TEST_CASE("a ray opens 7.8 nodes among 20000 triangles: nearest first, none behind the hit") {
    Dice random{{8}};
    Shapes scene;
    for (int i = 0; i < 20000; ++i) scene.push_back(triangle(real(0.03), random));
    const Bvh tree(scene);
    const Work work = work_of_rays(tree, random);
    // 7.80 and 11.9.  In the order of the node 9.0 and 15.1; boxes behind the hit, too, 8.1
    // and 12.3.
    CHECK(work.nodes < 7.9);
    CHECK(work.shapes < 12.1);
}

TEST_CASE("a ray looks at 411 of 2000 large triangles, whose boxes overlap: none behind the hit") {
    // Here most boxes that begin before a hit hold what is hit behind it.
    Dice random{{8}};
    Shapes scene;
    for (int i = 0; i < 2000; ++i) scene.push_back(triangle(1, random));
    const Bvh tree(scene);
    const Work work = work_of_rays(tree, random);
    // 35.6 and 410.5; in the order of the node 37.9 and 435.
    CHECK(work.nodes < 35.75);
    CHECK(work.shapes < 414);
}

TEST_CASE("a tree takes up 90 bytes a triangle at most in double, 54 in float") {
    // 9 numbers, an index, and 14 bytes of nodes, which are as large in both.
    const size_t most = 9 * sizeof(real) + 4 + 14;
    Dice random{{10}};
    Shapes small, large;
    for (int i = 0; i < 20000; ++i) {
        small.push_back(triangle(real(0.03), random));
        large.push_back(triangle(1, random));
    }
    for (const Shapes& scene : {ball(6), grid(8), small, large}) {
        CAPTURE(scene.size());
        CHECK(Bvh(scene).bytes() < scene.size() * most);
        CHECK(Bvh(scene).bytes() > scene.size() * (9 * sizeof(real) + 4));
    }
}

TEST_CASE("triangles of 1e-30 are hit by rays so nearly along an axis that 1/d is beyond float") {
    if (sizeof(real) == 4) return;
    const real distance = real(1e10), size = real(1e-30);
    Shapes scene;
    for (int i = 0; i < 20; ++i) {
        const real y = real(i) * size;
        scene.push_back({{0, y, -size}, {0, y + size, -size}, {0, y, size}});
    }
    Comparison c{scene};
    for (int i = 0; i < 20; ++i)
        c.judge({{-distance, 0, 0}, {1, (real(i) + real(0.3)) * size / distance, 0}});
    CHECK(c.different == 0);
    CHECK(c.hits == 20);
}

TEST_CASE("rays from infinitely far, as floats see it, meet what there is and nothing else") {
    // Absent children's boxes are empty, but such a ray meets even those.
    Dice random{{11}};
    const real far = sizeof(real) == 8 ? real(1e300) : real(1e38);
    for (int n : {1, 3, 9, 20}) {
        const Shapes scene = soup(n, n % 3, random);
        Comparison c{scene};
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

TEST_CASE("an empty tree is missed, and a ray that is not a number misses every tree") {
    const real nan = std::numeric_limits<real>::quiet_NaN();
    const Ray ray{{0, 0, 3}, {0, 0, -1}};
    for (const Bvh& tree : {Bvh{}, Bvh(Shapes{})}) {
        CHECK(!tree.closest(ray));
        CHECK(!tree.occluded(ray));
        CHECK(tree.bytes() == 0);
    }
    const Shapes scene = room();
    const Bvh tree(scene);
    CHECK(tree.closest(ray));
    for (const Ray& bad : {Ray{{0, 0, 3}, {nan, nan, nan}}, Ray{{nan, 0, 3}, {0, 0, -1}}}) {
        CHECK(!tree.closest(bad));
        CHECK(!tree.occluded(bad));
    }
}

TEST_CASE("a scene 2^20 times as large is hit at 2^20 times the distance, bit for bit") {
    Dice random{{9}};
    const real k = std::ldexp(real(1), 20);
    const Shapes scene = soup(50, 50, random), large = scaled(scene, k);
    const Bvh tree(scene), large_tree(large);
    int different = 0, hits = 0;
    for (int i = 0; i < 60000; ++i) {
        const Ray ray = aimed(scene[random.below(scene.size())], i % aims, 1, random);
        auto hit = tree.closest(ray);
        hits += hit.has_value();
        if (hit) hit->t *= k;
        different += !same(hit, large_tree.closest({ray.o * k, ray.d}));
    }
    CHECK(different == 0);
    CHECK(hits > 20000);
}

TEST_CASE("below a depth of 32 nodes are halved, on spines to the left and to the right") {
    // Sizes and places in powers of two: each split parts the few largest from all the others, of
    // which there are 200 octaves.
    for (real side : {real(1), real(-1)}) {
        Shapes scene;
        const int n = 2000;
        for (int i = 0; i < n; ++i) {
            const real x = std::exp2(real(200) * real(i) / n - 140);
            scene.push_back({{side * x, -x, -x}, {side * x, x, -x}, {side * x, 0, x}});
        }
        const bvh::BinaryTree tree = bvh::build(scene);
        // Children follow their parents.
        std::vector<int> depth(tree.branches.size());
        int deepest = 0, halved = 0, uneven = 0;
        for (size_t i = 0; i < tree.branches.size(); ++i) {
            const bvh::Branch& b = tree.branches[i];
            deepest = std::max(deepest, depth[i]);
            if (b.leaf()) continue;
            depth[b.left] = depth[b.left + 1] = depth[i] + 1;
            if (depth[i] < bvh::BinaryTree::sah_depth) continue;
            ++halved;
            uneven += tree.branches[b.left].count != b.count / 2;
        }
        CAPTURE(side);
        CHECK(halved > 10);
        CHECK(uneven == 0);
        CHECK(deepest <= bvh::BinaryTree::depth);
    }
}

// world/shapes_test.cpp  intersections of rays with shapes, against references
#include "world/geometry.h"

namespace {

bool meets(const Shape& s, const Ray& ray) { return meet(s, ray).has_value(); }

big3 point(const Shape& s, const Hit& hit) {
    return (1 - big(hit.v) - hit.w) * big3(s.a) + hit.v * big3(s.b) + hit.w * big3(s.c);
}
big3 point(const Ray& ray, real t) { return big3(ray.o) + t * big3(ray.d); }

Shape placed_anywhere(const Shape& s, Dice& random) {
    return placed(s, placements[random.below(std::size(placements))], random);
}

// ---- Spheres ------------------------------------------------------------------------------------

// Both roots for d of any length, and r^2 - (distance of the centre from the ray)^2.
struct Roots {
    big near, far, discriminant;
};
Roots roots(const Shape& s, const Ray& ray) {
    const big3 f = big3(ray.o) - s.a, d = ray.d;
    const big b = -dot(f, d) / dot(d, d);
    const big3 foot = f + b * d;
    const big discriminant = big(s.r) * s.r - dot(foot, foot);
    const big half = std::sqrt(std::max(big(0), discriminant) / dot(d, d));
    return {b - half, b + half, discriminant};
}

// Hits against the reference.  Rounding moves hits, and the ray near the centre, by at most 24 ulp
// (D + R); D is the distance from the origin to the centre.  Along the ray: f 1 ulp D, its product
// with d 3, |d| = 1 within 4.5 another 9, the last sum 1; c / q adds 6 (c) and 1.  Across: f 1, b d
// 1.  The discriminant loses 3 ulp R.  Second-order terms are 4 % of that at D/R = 1e4 in float.
// Along the normal, errors along the ray shrink by the cosine.
struct SphereVerdict {
    static constexpr big most = 24;
    Worst error;  // in ulp (D + R)
    int wrong = 0, hits = 0, misses = 0;

    void judge(const Shape& s, const Ray& ray) {
        const Roots expected = roots(s, ray);
        const big unit_error = ulp * (length(big3(ray.o) - s.a) + s.r);
        const auto hit = meet(s, ray);
        ++(hit ? hits : misses);
        if (std::abs(expected.discriminant) <= 2 * most * unit_error * s.r) {  // tangent
            if (hit) error.see(std::abs(length(point(ray, hit->t) - s.a) - s.r) / unit_error);
            return;
        }
        const big t = expected.near > 0 ? expected.near : expected.far;
        const big cosine = std::sqrt(std::max(big(0), expected.discriminant)) / s.r;
        if (hit.has_value() != (expected.discriminant > 0 && t > 0))
            ++wrong;
        else if (hit)
            error.see(std::abs(hit->t - t) * cosine / unit_error);
    }
};

// ---- Triangles ----------------------------------------------------------------------------------

// Meshes enclose all points within 0.3 of the origin (times the needle's axes).
Triangles outwards(Triangles mesh) {
    for (Shape& s : mesh)
        if (dot(cross(s.b - s.a, s.c - s.a), s.a + s.b + s.c) < 0) std::swap(s.b, s.c);
    return mesh;
}

Triangles box() {
    Triangles mesh;
    for (int a = 0; a < 3; ++a)
        for (real side : {real(-1), real(1)}) {
            auto corner = [&](real u, real v) {
                vec3 p;
                p.*axis[a] = side, p.*axis[(a + 1) % 3] = u, p.*axis[(a + 2) % 3] = v;
                return p;
            };
            mesh.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
            mesh.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
        }
    return outwards(mesh);
}

template <class Map>
Triangles mapped(Triangles mesh, Map map) {
    for (Shape& s : mesh) s = {map(s.a), map(s.b), map(s.c)};
    return mesh;
}

}  // namespace

// ---- Boxes --------------------------------------------------------------------------------------

TEST_CASE("bounds contain their shape, and its surface points with their error") {
    Dice random{{1}};
    Worst outside;
    auto contain = [&](const Box& box, big3 p, big error) {
        outside.see(std::max({box.lo.x - p.x, box.lo.y - p.y, box.lo.z - p.z, p.x - box.hi.x,
                              p.y - box.hi.y, p.z - box.hi.z}) +
                    error);
    };
    for (int i = 0; i < 20000; ++i) {
        const real size = random.decades(-2, 0);
        const Shape t = placed_anywhere(random_triangle(random, size), random);
        for (vec3 corner : {t.a, t.b, t.c}) contain(bounds(t), corner, 0);
        const Shape s = placed_anywhere({{}, {}, {}, size}, random);
        for (int a = 0; a < 3; ++a)
            for (big side : {big(-1), big(1)}) {
                big3 pole = s.a;
                (a == 0 ? pole.x : a == 1 ? pole.y : pole.z) += side * s.r;
                contain(bounds(s), pole, 0);
            }
        const vec2 u = random.barycentrics();
        for (const auto& [shape, hit] : {std::pair{t, Hit{0, 0, u.x, u.y}}, {s, Hit{s.r}}}) {
            const Surface x = surface(shape, {s.a, random.direction()}, hit);
            contain(bounds(shape), x.p, x.error / 2);  // the error of p is less
        }
    }
    CHECK(outside.value == 0);
}

TEST_CASE("boxes grow by points and boxes, and an empty one has no area and adds nothing") {
    Box box, other;
    CHECK(box.half_area() == 0);
    box.add(vec3{1, 5, -1});
    CHECK(box.half_area() == 0);
    box.add(vec3{0, 7, 2});
    box.add(Box{});
    CHECK((box.lo == vec3{0, 5, -1} && box.hi == vec3{1, 7, 2}));
    CHECK(box.half_area() == 1 * 2 + 2 * 3 + 3 * 1);
    other.add(vec3{-1, 6, 9});
    box.add(other);
    CHECK((box.lo == vec3{-1, 5, -1} && box.hi == vec3{1, 7, 9}));
}

// ---- Spheres ------------------------------------------------------------------------------------

TEST_CASE("a sphere is hit where a long double reference hits it, from near, far and inside") {
    Dice random{{2}};
    SphereVerdict near, far, within, past, above;
    const Shape ground{{0, real(-1e6), 0}, {}, {}, real(1e6)};
    const real farthest = sizeof(real) == 8 ? 7 : 4;  // decades of D/R
    for (int i = 0; i < 100000; ++i) {
        const Shape s{random.direction(random(0, 100)), {}, {}, random.decades(-3, 3)};
        const vec3 close = s.a + random.direction(s.r * random(2, 10));
        const vec3 remote = s.a + random.direction(s.r * random.decades(1, farthest));
        const vec3 inner = s.a + random.direction(s.r * random(0, real(0.99)));
        const real x = random(0, real(1.5));
        near.judge(s, aimed(s, close, x, random));
        far.judge(s, aimed(s, remote, x, random));
        within.judge(s, {inner, random.direction()});
        past.judge(s, {close, -aimed(s, close, x, random).d});
        above.judge(ground, {{0, real(1e-3), 0}, random.direction()});
    }
    for (const SphereVerdict* verdict : {&near, &far, &within, &past, &above}) {
        CHECK(verdict->wrong == 0);
        CHECK(verdict->error.value < SphereVerdict::most);
    }
    CHECK(within.misses == 0);
    CHECK(past.hits == 0);
    CHECK(std::min(above.hits, above.misses) > 40000);
}

TEST_CASE("from a billionth of its radius above a sphere or below, rays go as far as they should") {
    // Where the sphere touches the origin, c = y (y + 2 r) + x^2 + z^2 has no cancellation.  The
    // error of b is 4 ulp r, and that of the root of b^2 - c >= 3/4 b^2 is 1.15 times as much.  So
    // q has a relative error of 5 ulp r / b, and c of 4 ulp plus 4 ulp^2 r^2 = 2 ulp^2 r / y.
    // Root, sum and division add 3 ulp.
    Dice random{{21}};
    Worst off;
    int wrong = 0, hits = 0;
    for (int i = 0; i < 200000; ++i) {
        const real r = random.decades(-3, 6), h = r * random.decades(-9, -2);
        const Shape s{{random(-10, 10) * r, -r, random(-10, 10) * r}, {}, {}, r};
        const vec3 aside = random.direction(h);
        const real z = random.decades(-3, 0) * random.sign();
        const vec3 d = spherical(z, std::sqrt(1 - z * z), random(0, 1));
        const Ray ray{{s.a.x + aside.x, i % 2 ? h : -h, s.a.z + aside.z}, {d.x, d.z, d.y}};
        const big y = ray.o.y, x0 = big(ray.o.x) - s.a.x, z0 = big(ray.o.z) - s.a.z;
        const big c = y * (y + 2 * big(r)) + x0 * x0 + z0 * z0;
        const big b = -(x0 * ray.d.x + (y + r) * ray.d.y + z0 * ray.d.z);
        if (b * b < 4 * std::abs(c)) continue;
        const big root = std::sqrt(b * b - c), q = b + std::copysign(root, b);
        const big near = b > 0 ? c / q : q, far = b > 0 ? q : c / q, t = near > 0 ? near : far;
        const auto hit = meet(s, ray);
        wrong += hit.has_value() != (t > 0);
        hits += hit.has_value();
        if (hit)
            off.see(std::abs(hit->t - t) / t / (ulp * (7 + 5 * r / std::abs(b) + 2 * ulp * r / h)));
    }
    CHECK(wrong == 0);
    CHECK(off.value < 1);
    CHECK(hits > 80000);
}

TEST_CASE("tangent rays touch: the edge belongs to the sphere, what lies beyond does not") {
    const Shape s{{0, 0, 0}, {}, {}, 1};
    CHECK(meet(s, {{-5, 1, 0}, {1, 0, 0}})->t == 5);
    CHECK(meets(s, {{-5, 1 - 2 * ulp, 0}, {1, 0, 0}}));
    CHECK(!meets(s, {{-5, 1 + 2 * ulp, 0}, {1, 0, 0}}));
    Dice random{{5}};
    SphereVerdict verdict;
    for (int i = 0; i < 200000; ++i) {
        const Shape t{random.direction(), {}, {}, random.decades(-3, 3)};
        const real d = random.decades(real(0.1), 4), off = random.decades(0, 4) * ulp * d;
        const vec3 o = t.a + random.direction(d * t.r);
        verdict.judge(t, aimed(t, o, 1 + (i % 2 ? off : -off), random));
    }
    CHECK(verdict.wrong == 0);
    CHECK(verdict.error.value < SphereVerdict::most);
    CHECK(std::min(verdict.hits, verdict.misses) > 50000);
}

TEST_CASE("from a point exactly on a sphere, rays out miss it and rays in meet its far side") {
    Dice random{{6}};
    int wrong = 0;
    Worst error;
    for (vec3 q : {vec3{2, 3, 6}, vec3{1, 4, 8}, vec3{4, 4, 7}, vec3{1, 2, 2}, vec3{0, 3, 4}})
        for (int i = 0; i < 20000; ++i) {
            const vec3 sign{i & 1 ? real(1) : real(-1), i & 2 ? real(1) : real(-1), 1};
            const Shape s{{real(-5), 17, 3}, {}, {}, length(q)};  // an integer, exact
            const Ray ray{s.a + q * sign, random.direction()};
            const auto hit = meet(s, ray);
            const real out = dot(q * sign, ray.d);
            // Both products have errors of 3 ulp R: beyond that their signs agree.
            wrong += hit && out > 6 * ulp * s.r;
            wrong += !hit && out < -s.r * std::sqrt(8 * ulp);
            if (hit)
                error.see(std::abs(hit->t - roots(s, ray).far) * std::abs(out) / s.r /
                          (ulp * 2 * s.r));
        }
    CHECK(wrong == 0);
    CHECK(error.value < 24);  // as above, with f exact and c = 0
}

TEST_CASE("surface moves a sphere's hit onto the sphere, however far the eye") {
    Dice random{{7}};
    Worst off, tilt, shift;
    bool covered = true;
    for (int i = 0; i < 100000; ++i) {
        const Shape s = placed_anywhere({{}, {}, {}, 1}, random);
        const vec3 o = s.a + random.direction(s.r * random.decades(real(0.1), 4));
        const real x_radii = random(0, real(0.9));
        const Ray ray = aimed(s, o, x_radii, random);
        const auto hit = meet(s, ray);
        if (!hit) continue;
        const Surface x = surface(s, ray, *hit);
        const big size = max_abs(s.a) + s.r, radius = length(big3(x.p) - s.a);
        // n is unit within 4 ulp; its product with r adds 1, the sum with a 1 of each coordinate.
        off.see(std::abs(radius - s.r) / (ulp * size));
        covered = covered && std::abs(radius - s.r) <= x.error / 2;
        tilt.see(std::abs(length(big3(x.n)) - 1) / ulp);
        tilt.see(dot(x.n, x.p - s.a) > 0 ? 0 : infinity);
        // Along the ray hits err by 24 ulp (D + R) / cosine, cosine >= sqrt(1 - 0.9^2).
        shift.see(length(point(ray, hit->t) - x.p) / (ulp * (length(s.a - o) + size)));
    }
    CHECK(off.value < 4 + 1 + std::sqrt(3.0));
    CHECK(tilt.value < 4);
    CHECK(shift.value < 100);
    CHECK(covered);
}

// ---- Triangles ----------------------------------------------------------------------------------

TEST_CASE("closed meshes let no ray out at an edge or a corner") {
    const real flat = std::exp2(real(20)) * ulp;  // thin, but 2^20 times the rounding
    const vec3 needle{1, real(0.01), flat};
    const struct {
        Triangles mesh;
        vec3 size;
    } meshes[] = {{outwards(ball(2)), {1, 1, 1}},
                  {box(), {1, 1, 1}},
                  {outwards(cones(150, 1 / real(50))), {1, 1, 1}},  // 300 triangles around a corner
                  {outwards(cones(8, real(1e-8))), {1, 1, 1}},      // slivers of aspect 1e8
                  {mapped(outwards(ball(2)), [&](vec3 p) { return p * needle; }), needle}};
    const Frame turned = frame(unit({1, -2, 3}));
    Dice random{{8}};
    for (const auto& [mesh, size] : meshes)
        for (int kind = 0; kind < 6; ++kind) {
            auto place = [&](vec3 p) {
                const vec3 q = turned.to_world(p);
                return kind == 0   ? p
                       : kind == 1 ? -p  // inside out
                       : kind == 2 ? q
                       : kind == 3 ? q + vec3{10000, -20000, 5000}
                       : kind == 4 ? real(1e3) * q
                                   : real(1e-3) * q;
            };
            const Triangles scene = mapped(mesh, place);
            int leaks = 0;
            const int n = 20000;
            for (int i = 0; i < n; ++i) {
                const Shape& s = scene[random.below(scene.size())];
                const vec3 corner[3] = {s.a, s.b, s.c};
                const size_t k = random.below(3);
                const real along = random(0, 1);
                const vec3 target =
                    i % 3 == 0 ? corner[k] : corner[k] + along * (corner[(k + 1) % 3] - corner[k]);
                const vec3 o = place(random.direction(i % 4 ? random(0, real(0.3)) : 0) * size);
                const Ray ray{o, unit(target - o)};
                const Shear k_ray = shear(ray.d);
                leaks += std::none_of(scene.begin(), scene.end(), [&](const Shape& t) {
                    return intersect_triangle(t, ray, k_ray, infinity).has_value();
                });
            }
            CAPTURE(scene.size());
            CAPTURE(kind);
            CHECK(leaks == 0);
        }
}

TEST_CASE("a triangle is hit where a long double reference hits it, from both sides, else missed") {
    Dice random{{9}};
    Worst v_error, t_error;
    int wrong = 0, outside = 0;
    for (int i = 0; i < 80000; ++i) {
        const Shape s = placed_anywhere(random_triangle(random, 1), random);
        const vec3 target = point(s, i % 2 ? random.barycentrics() : random.pair(-0.5, 1.5));
        const vec3 o = target + random.direction(length(s.b - s.a) * random.decades(-1, 3));
        const Ray ray{o, unit(target - o)};
        // The reference is by Moller, Trumbore 1997.
        const big3 e = big3(s.b) - s.a, f = big3(s.c) - s.a, g = big3(o) - s.a, d = ray.d;
        const big det = dot(cross(d, f), e);
        const big v = dot(cross(d, f), g) / det, w = dot(cross(g, e), d) / det;
        const big t = dot(cross(g, e), f) / det;
        // The shear moves each corner by 5 ulp of its distance M (difference, slope 2, product,
        // sum).  The weights err by twice as much over the least height of the triangle as seen
        // from the ray, |det| over its longest edge, times sqrt(3) for the slant of the shear. t
        // errs by that times the longest edge, plus 16 ulp for products, sums and the division.
        const big M =
            std::max({length(big3(s.a) - o), length(big3(s.b) - o), length(big3(s.c) - o)});
        const big longest = std::max({length(e), length(f), length(e - f)});
        const big weight_error = 2 * std::sqrt(3.0) * 5 * ulp * M * longest / std::abs(det);
        const big distance_error = 2 * weight_error * longest + 16 * ulp * M;
        const big inside = std::min({v, w, 1 - v - w});
        if (weight_error > 0.01 || std::abs(inside) < weight_error) continue;
        if (t < distance_error) continue;
        const auto hit = meet(s, ray);
        wrong += hit.has_value() != (inside > 0);
        outside += inside < 0;
        if (!hit) continue;
        v_error.see(std::max(std::abs(hit->v - v), std::abs(hit->w - w)) / weight_error);
        t_error.see(std::abs(hit->t - t) / distance_error);
    }
    CHECK(wrong == 0);
    CHECK(outside > 10000);
    CHECK(v_error.value < 1);
    CHECK(t_error.value < 1);
}

TEST_CASE("every hit of a triangle lies on its ray, however thin the triangle") {
    // The shear moves corners by 5 ulp of their distance M; weights (products 1.5 ulp, sum 2,
    // division 1) and sums add 7 ulp, in two coordinates. t loses 16 ulp along the ray.
    Dice random{{10}};
    Worst off;
    int hits = 0, infinite = 0;
    for (int i = 0; i < 300000; ++i) {
        Shape s = random_sliver(random, sizeof(real) == 8 ? 50 : 24);
        if (i % 3 == 0) s.c = s.a + (i % 2 ? 3 : real(0.5)) * (s.b - s.a);  // area 0
        const vec3 e = s.b - s.a, f = s.c - s.a;
        const vec2 u = i % 5 ? random.barycentrics() : random.pair(-1, 2), v = random.pair(-1, 1);
        const vec3 target = point(s, u), edge_on = unit(v.x * e + v.y * f);
        const real distance = random.decades(-1, 2);
        const vec3 o = target + (i % 2 ? distance * edge_on : random.direction(distance));
        const Ray ray{o, unit(target - o)};
        const auto hit = meet(s, ray);
        if (!hit) continue;
        ++hits;
        const big M = std::max({length(s.a - o), length(s.b - o), length(s.c - o)});
        off.see(length(point(s, *hit) - point(ray, hit->t)) / (ulp * M));
        infinite += !(std::isfinite(hit->t) && std::isfinite(hit->v) && std::isfinite(hit->w));
    }
    CHECK(hits > 50000);
    CHECK(infinite == 0);
    CHECK(off.value < std::sqrt(2.0) * (5 + 7) + 16);
}

TEST_CASE("a triangle with two equal corners is never hit") {
    Dice random{{11}};
    int hits = 0;
    for (int i = 0; i < 100000; ++i) {
        const vec3 a = random.direction(), b = a + random.direction(random.decades(-6, 1));
        const Shape s[] = {{a, a, b}, {a, b, b}, {a, b, a}, {a, a, a}};
        const vec3 o = random.direction(3), target = a + random(0, 1) * (b - a);
        for (const Shape& t : s) hits += meets(t, {o, unit(target - o)});
    }
    CHECK(hits == 0);
}

TEST_CASE("tiny triangles are hit") {
    Dice random{{12}};
    int misses = 0;
    for (int i = 0; i < 100000; ++i) {
        const real edge = random.decades(sizeof(real) == 8 ? -12 : -8, -6);
        const Frame f = frame(random.direction());
        const Shape s{-edge * f.x - edge * f.y, edge * f.x, edge * f.y};
        misses += !meets(s, {real(1e3) * edge * f.n, -f.n});
    }
    CHECK(misses == 0);
}

TEST_CASE("a triangle's surface point and normal are those of the triangle, however far the eye") {
    Dice random{{13}};
    Worst off, tilt;
    bool covered = true;
    for (int i = 0; i < 100000; ++i) {
        const Shape s =
            placed_anywhere(i % 2 ? random_triangle(random, 1) : random_sliver(random, 9), random);
        const vec2 u = random.barycentrics();
        const Hit hit{random.decades(0, 6), 0, u.x, u.y};
        const vec3 d = random.direction();
        const Surface x = surface(s, {point(s, u) - hit.t * d, d}, hit);
        const big distance = length(point(s, hit) - x.p);
        // Two sums and three products make 5 ulp per coordinate; 1 - v - w adds 2.
        off.see(distance / (ulp * std::max({max_abs(s.a), max_abs(s.b), max_abs(s.c)})));
        covered = covered && distance <= x.error / 2;
        // The rounded b - a and c - a; 1.5 ulp per component (Jeannerod et al. 2013), 4.5 for unit.
        const big3 n = cross(big3(s.b - s.a), big3(s.c - s.a));
        if (length(n) > 0) tilt.see(length(1 / length(n) * n - x.n) / ulp);
    }
    CHECK(off.value < std::sqrt(3.0) * 7);
    CHECK(tilt.value < std::sqrt(3.0) * (1.5 + 4.5));
    CHECK(covered);
}

TEST_CASE("rays reach up to tmax, that included, and begin after their origin") {
    const Shape shapes[] = {{{-1, -1, 0}, {1, -1, 0}, {0, 2, 0}}, {{0, 0, -1}, {}, {}, 1}};
    for (const Shape& s : shapes) {
        CHECK(meet(s, {{0, 0, 3}, {0, 0, -1}, 3})->t == 3);
        CHECK(!meets(s, {{0, 0, 3}, {0, 0, -1}, std::nextafter(real(3), real(0))}));
        CHECK(!meets(s, {{0, 0, 3}, {0, 0, 1}}));
        CHECK(!meets(s, {{0, 0, 0}, {0, 0, 1}}));
        const real nan = std::numeric_limits<real>::quiet_NaN();
        CHECK(!meets(s, {{0, 0, 3}, {nan, nan, nan}}));
        CHECK(!meets(s, {{nan, 0, 3}, {0, 0, -1}}));
    }
    CHECK(!meets(shapes[0], {{0, 0, 0}, {0, 0, -1}}));
    CHECK(meet(shapes[1], {{0, 0, 0}, {0, 0, -1}})->t == 2);
    CHECK(!meets(shapes[1], {{0, 0, 0}, {0, 0, -1}, 1}));
}

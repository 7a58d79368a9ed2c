// world/shapes_spawn_test.cpp  rays leave their surface for good; segments end before their ends
#include "world/geometry.h"
#include "world/lights.h"

namespace {

bool meets(const Shape& s, const Ray& ray) { return meet(s, ray).has_value(); }

// A point of the shape as a path finds it: the hit of a ray from a few sizes away.  Empty if
// rounding leaves too little of the shape to hit.
std::optional<Surface> seen(const Shape& s, Dice& random) {
    const real size = s.r > 0 ? s.r : max_abs(s.b - s.a);
    for (int attempt = 0; attempt < 100; ++attempt) {
        const vec3 target =
            s.r > 0 ? s.a + random.direction(random(0, s.r)) : point(s, random.barycentrics());
        const vec3 o = target + random.direction(4 * size);
        const Ray ray{o, unit(target - o)};
        if (const auto hit = meet(s, ray)) return surface(s, ray, *hit);
    }
    return {};
}

const Shape unit_ball{{}, {}, {}, 1};

// A direction on the side of n; half of them are near the horizon (down to a cosine of 1e-7).
vec3 leaving(const Surface& x, Dice& random) {
    const real z = random.below(2) ? random(0, 1) : random.decades(-7, 0);
    const vec3 d = frame(x.n).to_world(spherical(z, std::sqrt(1 - z * z), random(0, 1)));
    return dot(d, x.n) < 0 ? -d : d;
}

}  // namespace

TEST_CASE("a ray that leaves a surface never meets it again, at any angle") {
    Dice random{{14}};
    int again = 0, rays = 0;
    for (const Placement& p : placements)
        for (int i = 0; i < 2000; ++i) {
            const Shape shapes[] = {unit_ball, random_triangle(random, 1),
                                    random_triangle(random, real(0.01)), random_sliver(random, 12)};
            for (const Shape& shape : shapes) {
                const Shape s = placed(shape, p, random);
                const auto x = seen(s, random);
                for (int k = 0; x && k < 24; ++k) {
                    const vec3 d = leaving(*x, random);
                    again += meets(s, spawn(*x, d));
                    if (s.r == 0) again += meets(s, spawn(*x, -d));
                    ++rays;
                }
            }
        }
    CHECK(again == 0);
    CHECK(rays > 1000000);
}

TEST_CASE("a ray sent into a sphere meets its far side") {
    Dice random{{15}};
    Worst off;
    for (const Placement& p : placements)
        for (int i = 0; i < 20000; ++i) {
            const Shape s = placed(unit_ball, p, random);
            const Surface x = seen(s, random).value();
            const vec3 d = -leaving(x, random);
            if (dot(d, x.n) == 0) continue;
            const auto hit = meet(s, spawn(x, d));
            const real chord = 2 * s.r * -dot(d, x.n);
            // The origin lies 2 errors deep, within another: with h = 3 error the far root is
            // within h / cos of the chord, and within sqrt(2 r h) of it (2 r cos -> 0).
            const real h = 3 * x.error;
            const real bound = h + std::min(h * 2 * s.r / chord, std::sqrt(2 * s.r * h));
            off.see(hit ? std::abs(hit->t - chord) / bound : infinity);
        }
    CHECK(off.value < 1);
}

TEST_CASE("a ray starts 2 errors off its surface, and meets what lies 6 errors above") {
    Dice random{{16}};
    int jumped = 0;
    Worst off;
    for (const Placement& p : placements)
        for (int i = 0; i < 20000; ++i) {
            const Shape s = placed(i % 3 ? random_triangle(random, 1) : unit_ball, p, random);
            const Surface x = seen(s, random).value();
            const vec3 up = i % 2 ? x.n : -x.n;
            const Ray ray = spawn(x, up);
            // The error has 16 ulp: rounding takes 1 per coordinate of o and of the lid's corners.
            off.see(length(big3(ray.o) - x.p - 2 * x.error * big3(up)) / x.error);
            const vec3 centre = x.p + 6 * x.error * up;
            const Frame f = frame(x.n);
            const vec3 e = 100 * x.error * f.x, g = 100 * x.error * f.y;
            jumped += !meets({centre - e - g, centre + e, centre + g}, ray);
        }
    CHECK(jumped == 0);
    CHECK(off.value < std::sqrt(3.0) / 8);
}

TEST_CASE("nothing is between two surface points that see each other, and what is, is found") {
    Dice random{{17}};
    int blocked = 0, open = 0, segments = 0;
    for (const Placement& p : placements)
        for (int i = 0; i < 40000; ++i) {
            const vec3 centre = random.direction(p.distance);
            auto shape = [&](real at) {
                const Shape s = i % 3 ? random_triangle(random, 1) : unit_ball;
                return moved(scaled(moved(s, random.direction(at)), p.scale), centre);
            };
            // The shapes are neighbours, or one is up to 1e5 sizes away from the other.
            const Shape a = shape(0), b = shape(i % 2 ? real(3) : random.decades(1, 5));
            const Surface x = seen(a, random).value(), y = seen(b, random).value();
            // Cases that rounding may decide are skipped.
            const real distance = length(y.p - x.p), doubt = x.error + y.error;
            auto faces = [&](const Shape& s, const Surface& from, const Surface& to) {
                const real height = dot(from.n, to.p - from.p);
                return (s.r > 0 ? height : std::abs(height)) > doubt + real(1e-6) * distance;
            };
            if (!faces(a, x, y) || !faces(b, y, x)) continue;
            for (const Ray& ray : {spawn_to(x, y), spawn_to(y, x)}) {
                ++segments;
                blocked += meets(a, ray) || meets(b, ray);
                const vec3 half = ray.o + ray.tmax / 2 * ray.d;
                open += !meets({half, {}, {}, ray.tmax / 8}, ray);
                open += !(std::abs(ray.tmax - distance) < 3 * (doubt + 16 * ulp * distance));
            }
        }
    CHECK(segments > 100000);
    CHECK(blocked == 0);
    CHECK(open == 0);
}

TEST_CASE("points of one sphere see each other through its inside, and two walls across an edge") {
    Dice random{{18}};
    int blocked = 0;
    for (const Placement& p : placements)
        for (int i = 0; i < 20000; ++i) {
            const Shape s = placed(unit_ball, p, random);
            const Surface x = seen(s, random).value(), y = seen(s, random).value();
            // The chord is deep enough if its sagitta, chord^2 / 8 r, is half an error.
            const vec3 chord = y.p - x.p;
            if (dot(chord, chord) > 4 * s.r * x.error) blocked += meets(s, spawn_to(x, y));

            const real size = p.scale, z = p.distance;
            const Shape floor{{z, z, -size}, {z + size, z, 0}, {z, z, size}};
            const Shape wall{{z, z, -size}, {z, z, size}, {z, z + size, 0}};
            auto near_edge = [&](const Shape& t) {
                const real off = 4 * rounding_error(t) / size + random.decades(-9, -1);
                return surface(
                    t, {},
                    &t == &floor ? Hit{1, 0, off, (1 - off) / 2} : Hit{1, 0, (1 - off) / 2, off});
            };
            const Ray ray = spawn_to(near_edge(floor), near_edge(wall));
            blocked += meets(floor, ray) || meets(wall, ray);
        }
    CHECK(blocked == 0);
}

TEST_CASE("no light stands in its own way, near or far") {
    Dice random{{19}};
    int blocked = 0, samples = 0;
    for (int i = 0; i < 100000; ++i) {
        const Shape t = random_triangle(random, 1), ball{{}, {}, {}, real(0.5)};
        Light lights[] = {Light(t.a, TriangleLight{t.b - t.a, t.c - t.a}),
                          Light(ball.a, SphereLight{ball.r})};
        lights[0].error = rounding_error(t), lights[1].error = rounding_error(ball);
        lights[0].twosided = true;
        const Shape floor = placed(random_triangle(random, 1), {1, random.decades(1, 5)}, random);
        const Surface x = seen(floor, random).value();
        for (const Light& light : lights) {
            const auto y = sample_light(light, x.p, random.pair(0, 1));
            if (!y) continue;
            // Rounding may put points of the limb behind the sphere, where it shadows them.
            const bool sphere = light.is_round();
            const real cosine = -dot(y->at.n, y->wi);
            if ((sphere ? cosine : std::abs(cosine)) < real(1e-6)) continue;
            ++samples;
            blocked += meets(sphere ? ball : t, spawn_to(x, y->at));
        }
    }
    CHECK(samples > 180000);
    CHECK(blocked == 0);
}

TEST_CASE("a scene 2^20 times as large gives the same numbers 2^20 times as large, bit for bit") {
    Dice random{{20}};
    const real k = std::ldexp(real(1), 20);
    int different = 0;
    for (int i = 0; i < 50000; ++i) {
        const Shape s =
            i % 2 ? Shape{random.direction(), {}, {}, random(0, 2)} : random_triangle(random, 2);
        const Shape large = scaled(s, k);
        const Box box = bounds(s), large_box = bounds(large);
        different += !(box.lo * k == large_box.lo && box.hi * k == large_box.hi);
        const vec3 o = random.direction(4);
        const Ray ray{o, unit(random.direction() - o)}, large_ray{o * k, ray.d};
        const auto hit = meet(s, ray), large_hit = meet(large, large_ray);
        different += hit.has_value() != large_hit.has_value();
        if (!hit || !large_hit) continue;
        different +=
            !(hit->t * k == large_hit->t && hit->v == large_hit->v && hit->w == large_hit->w);
        const Surface x = surface(s, ray, *hit), y = surface(large, large_ray, *large_hit);
        different += !(x.p * k == y.p && x.n == y.n && x.error * k == y.error);
        const Surface eye{o, -ray.d, ulp}, large_eye{o * k, -ray.d, ulp * k};
        for (const auto& [a, b] : {std::pair{spawn(x, -ray.d), spawn(y, -ray.d)},
                                   {spawn_to(x, eye), spawn_to(y, large_eye)}})
            different += !(a.o * k == b.o && a.d == b.d && a.tmax * k == b.tmax);
    }
    CHECK(different == 0);
}

// whole/extremes_world_test.cpp  rays and shapes, directions, materials, the camera
#include "base/stats.h"
#include "text/scene_file.h"
#include "whole/extremes.h"
#include "world/nearest.h"
#include "world/scene.h"

namespace {

// ---- Spheres and triangles ----------------------------------------------------------------------

// The part of rays that miss, and the distance of o + t d and of the paths' point from the surface:
// the maximum in distances, the mean in radii.
struct FarSphere {
    double missed = 0, hit_off = 0, hit_mean = 0, point_off = 0, point_mean = 0;
};
FarSphere far_sphere(real d) {
    Dice random{{oracle::seed_of("far sphere")}};
    FarSphere result;
    Worst hit_off, point_off;
    Moments hit_mean, point_mean;
    const int n = 50000;
    for (int i = 0; i < n; ++i) {
        const real x = random(0, real(0.99));
        const Shape s{{}, {}, {}, random.decades(-3, 3)};
        const Ray ray = aimed(s, s.a + d * s.r * random.direction(), x, random);
        const auto hit = meet(s, ray);
        result.missed += hit ? 0 : 1.0 / n;
        if (!hit) continue;
        auto off = [&](big3 p) { return double(std::abs(length(p - s.a) - s.r) / s.r); };
        const double at_hit = off(big3(ray.o) + hit->t * big3(ray.d));
        const double at_point = off(surface(s, ray, *hit).p);
        hit_off.see(at_hit / double(d));
        hit_mean.add(at_hit);
        point_off.see(at_point / double(d));
        point_mean.add(at_point);
    }
    result.hit_off = hit_off.value, result.hit_mean = hit_mean.mean;
    result.point_off = point_off.value, result.point_mean = point_mean.mean;
    return result;
}

// A height of 1e-3 over a sphere of radius 1e6, measured by a ray straight down.
double over_a_planet() {
    const Shape s{{0, real(-1e6), 0}, {}, {}, real(1e6)};
    const auto hit = meet(s, {{0, real(1e-3), 0}, {0, -1, 0}});
    return hit ? relative(hit->t, real(1e-3)) : HUGE_VAL;
}

// Counts rays that leave a surface point outwards, at any angle, and hit their own shape.
double met_again() {
    return count_of("met again", 20000, [](Dice& random, int i) {
        const real sizes[] = {real(1e-6), 1, real(1e6)};
        const real size = sizes[i % 3], distance = i % 2 ? real(1e6) : 0;
        const vec3 at = distance * random.direction();
        Shape s{at, {}, {}, size};
        if (i % 5 == 0) s = {at, at + size * random.direction(), at + size * random.direction()};
        int again = 0;
        if (s.r == 0 && s.a == s.b) return again;
        const vec3 target = s.r > 0 ? s.a : (s.a + s.b + s.c) / 3;
        const vec3 o = target + 4 * size * random.direction();
        if (o == target) return again;
        const Ray ray{o, unit(target - o)};
        const auto hit = meet(s, ray);
        if (!hit) return again;
        const Surface x = surface(s, ray, *hit);
        if (!is_finite(x.n)) return again;
        const Frame f = frame(x.n);
        for (int k = 0; k < 16; ++k) {
            const real z = k % 2 ? random(0, 1) : random.decades(-12, 0);
            const vec3 d = f.to_world(spherical(z, std::sqrt(1 - z * z), random(0, 1)));
            if (dot(d, x.n) > 0) again += meet(s, spawn(x, d)).has_value();
        }
        return again;
    });
}

// Counts rays from inside, aimed at corners and edges, that leave the mesh.
double leaks(Triangles mesh, vec3 move) {
    for (Shape& s : mesh) s = {s.a + move, s.b + move, s.c + move};
    const Tree bvh(mesh);
    return count_of("leaks", 40000, [&](Dice& random, int i) {
        const Shape& s = mesh[random.below(mesh.size())];
        const vec3 corner[3] = {s.a, s.b, s.c};
        const size_t k = random.below(3);
        const real along = i % 3 ? random(0, 1) : 0;
        const vec3 target = corner[k] + along * (corner[(k + 1) % 3] - corner[k]);
        const vec3 o = move + random(0, real(0.3)) * random.direction();
        return !bvh.closest({o, unit(target - o)});
    });
}

// Rays along axes, in the faces of boxes and of the BVH: compares the BVH with a loop.
double along_axes() {
    Dice dice{{oracle::seed_of("boxes")}};
    auto corner = [](Dice& random, size_t n) {
        return vec3{real(random.below(n)), real(random.below(n)), real(random.below(n))};
    };
    Scene boxes;
    boxes.materials.resize(1);
    for (int i = 0; i < 60; ++i)
        add_box(boxes, {1, 1, real(i % 3 ? 1 : 0.5)}, 0, corner(dice, 6), 0);
    const std::vector<Shape>& shapes = boxes.shapes;
    const Tree bvh(shapes);
    return count_of("along axes", 20000, [&](Dice& random, int i) {
        const vec3 o = corner(random, 7) - vec3{real(i % 7 == 0 ? 10 : 0), 0, 0};
        vec3 d{i & 1 ? -real(0) : real(0), i & 2 ? -real(0) : real(0), i & 4 ? -real(0) : real(0)};
        d.*axis[i % 3] = i & 8 ? -1 : 1;
        const Ray ray{o, d};
        const auto hit = bvh.closest(ray);
        return !same(hit, nearest(shapes, ray)) + (bvh.occluded(ray) != hit.has_value());
    });
}

// A ray sees the first of coincident shapes, whatever surrounds them.
double coincident() {
    return count_of("coincident", 50, [](Dice& random, int) {
        std::vector<Shape> shapes;
        const Shape wall{{-9, -9, 0}, {9, -9, 0}, {0, 12, 0}};
        const size_t n = 1 + random.below(40), first = random.below(n);
        for (size_t i = 0; i < n; ++i)
            shapes.push_back(i == first || (i > first && random.below(2))
                                 ? wall
                                 : Shape{random.direction() - vec3{0, 0, 3}, {}, {}, 1});
        const Tree bvh(shapes);
        int wrong = 0;
        for (int i = 0; i < 200; ++i) {
            const auto hit = bvh.closest({{random(-2, 2), random(-2, 2), 5}, {0, 0, -1}});
            wrong += !hit || hit->id != first;
        }
        return wrong;
    });
}

// A sheet `gap` before a wall, and random points at a height z above the wall.
struct Sheet {
    std::vector<Shape> shapes;
    explicit Sheet(real gap) {
        for (real z : {real(0), gap}) shapes.push_back({{-20, -20, z}, {20, -20, z}, {0, 30, z}});
    }
    static vec3 point(Dice& random, real z) { return {random(-3, 3), random(-3, 3), z}; }
};

// The part of rays from afar that hit the wall.
double sheet_before_wall(real gap) {
    const Tree bvh(Sheet(gap).shapes);
    return count_of("sheet", 20000,
                    [&](Dice& random, int) {
                        const vec3 o = Sheet::point(random, 10), to = Sheet::point(random, 0);
                        const auto hit = bvh.closest({o, unit(to - o)});
                        return !hit || hit->id == 0;
                    }) /
           20000;
}

// The part of the wall's shadow rays that miss the sheet.
double shadow_of_sheet(real gap) {
    const Sheet sheet(gap);
    const Tree bvh(sheet.shapes);
    return count_of(
               "shadow of a sheet", 20000,
               [&](Dice& random, int) {
                   const Surface x{
                       Sheet::point(random, 0), {0, 0, 1}, rounding_error(sheet.shapes[0])};
                   return !bvh.occluded(spawn_to(x, {Sheet::point(random, 10), {0, 0, -1}, 0}));
               }) /
           20000;
}

// Triangles with edges of 10^-k, and without area, as scenes accept them.  Each is dropped, or has
// as its normal the product of its rounded edges.
double tiny_normals() {
    Scene scene;
    scene.materials.resize(1);
    const real least = is_double ? -320 : -44;
    return worst_of("tiny normals", 20000, [&](Dice& random, Worst& worst, int i) {
        const vec3 a = i % 2 ? vec3{} : random.direction();
        const real size = random.decades(least, 0);
        const vec3 b = a + size * random.direction();
        const vec3 c = i % 5 ? a + size * random.direction() : i % 3 ? b : a + 2 * (b - a);
        scene.shapes.clear();
        add_triangle(scene, a, b, c, 0);
        add_quad(scene, a, b - a, c - a, 0);
        for (const Shape& s : scene.shapes) {
            const big3 n = cross(big3(s.b - s.a), big3(s.c - s.a));
            worst.see(length(surface(s, {}, {}).n - 1 / length(n) * n));
        }
    });
}

double few_shapes() {
    int wrong = Tree(std::vector<Shape>{}).closest({{}, {0, 0, 1}}).has_value();
    const Tree one({{{0, 0, 5}, {}, {}, 1}});
    wrong += one.closest({{}, {0, 0, 1}})->t != 4;
    wrong += one.closest({{}, {0, 0, -1}}).has_value();
    const real nan = std::numeric_limits<real>::quiet_NaN();
    wrong += one.closest({{}, {nan, nan, nan}}).has_value();
    return wrong;
}

// ---- Directions ---------------------------------------------------------------------------------

// The largest scalar product of two axes.
double skewness(const Frame& f) {
    return double(std::max({std::abs(dot(big3(f.x), f.y)), std::abs(dot(big3(f.y), f.n)),
                            std::abs(dot(big3(f.n), f.x))}));
}

double frames_anywhere() {
    return worst_of("frames", 20000, [](Dice& random, Worst& worst) {
        worst.see(skewness(frame(random.direction())));
    });
}

// Directions 1e-9, 1e-20 and 0 from both poles.
double frames_at_poles() {
    Worst worst;
    for (real z : {real(-1), real(1)})
        for (real tiny : {real(1e-4), real(4.5e-5), real(1e-9), real(1e-20), real(0)})
            for (real angle = 0; angle < 6; angle += real(0.01))
                worst.see(skewness(frame({tiny * std::cos(angle), tiny * std::sin(angle),
                                          z * std::sqrt(1 - tiny * tiny)})));
    return worst.value;
}

// Directions from the corners of the unit square: the error of their lengths.
double corners_of_the_square() {
    Worst worst;
    const real ends[] = {0, std::numeric_limits<real>::denorm_min(), ulp, real(0.5), below_one};
    for (real x : ends)
        for (real y : ends)
            for (vec3 w : {sample_uniform_hemisphere({x, y}), sample_cosine_hemisphere({x, y}),
                           sample_phong_lobe({x, y}, 0), sample_phong_lobe({x, y}, real(1e6)),
                           sample_cone({x, y}, 1), sample_cone({x, y}, real(1e-30))}) {
                worst.see(std::abs(length(big3(w)) - 1));
                worst.see(w.z >= 0 ? 0 : HUGE_VAL);
            }
    return worst.value;
}

// Near the pole of a uniform hemisphere: sin^2 = u (2 - u).
double sines_at_the_pole() {
    return worst_of("pole", 10000, [&](Dice& random, Worst& worst) {
        const real u = random.decades(is_double ? -15 : -7, 0);
        const vec3 w = sample_uniform_hemisphere({u, real(0.3)});
        // 1 - u is rounded, and so is the point; the sine is that of u.
        worst.see(relative(std::hypot(big(w.x), big(w.y)), std::sqrt(big(u) * (2 - big(u)))));
    });
}

// Exponent 1e5: sine of the angle from the axis.
double lobe_sines() {
    const real n = real(1e5);
    return worst_of("lobe", 10000, [&](Dice& random, Worst& worst) {
        const real u = random.decades(is_double ? -12 : -6, 0);
        const vec3 w = sample_phong_lobe({u, real(0.3)}, n);
        const big truth = std::sqrt(-std::expm1(2 * std::log1p(-big(u)) / (big(n) + 1)));
        worst.see(relative(std::hypot(big(w.x), big(w.y)), truth));
    });
}

// Reflection at a cosine of 1e-6 by a lobe of exponent 1e5.  Compares the density by `pdf` from wi
// with that from u; the weight f cos / pdf must be ks (n+2) / (n+1) cos.
struct Lobe {
    double density = 0, weight = 0;
};
Lobe grazing_lobe() {
    const Material m{Rough({}, {1, 1, 1}, real(1e5))};
    const real z = real(1e-6);
    const vec3 wo{std::sqrt(1 - z * z), 0, z};
    Worst density, weight;
    each_cell(64, [&](vec2 u) {
        const BsdfSample s = sample(m, wo, true, 0, u, Direction::bsdf);
        const big n = m.as<Rough>()->exponent;
        density.see(relative(s.pdf, (n + 1) / (2 * big_pi) * std::pow(1 - big(u.x), n / (n + 1))));
        if (s.wi.z > 0) weight.see(relative(s.f.x * (s.wi.z / s.pdf), (n + 2) / (n + 1) * s.wi.z));
    });
    return {double(density.value), double(weight.value)};
}

// ---- Glass --------------------------------------------------------------------------------------

Material glass(real ior) { return {Glass(ior)}; }
vec3 at_cosine(real z) { return {std::sqrt((1 - z) * (1 + z)), 0, z}; }

// The reflectance of sample_glass against Fresnel's in long double.
double glass_off(real ior, bool outside, real z) {
    const BsdfSample s = sample(glass(ior), at_cosine(z), outside, 0, {}, Direction::bsdf);
    const big reflectance = s.wi.z > 0 ? big(s.pdf) : 1 - big(s.pdf);
    const big eta = outside ? 1 / big(ior) : big(ior);
    const big i = z, cos2 = (1 - eta) * (1 + eta) + eta * eta * i * i, c = std::sqrt(cos2);
    const big parallel = (i - eta * c) / (i + eta * c), cross = (eta * i - c) / (eta * i + c);
    const big truth = cos2 > 0 ? (parallel * parallel + cross * cross) / 2 : 1;
    return double(std::abs(reflectance - truth));
}

// At cosines down to 10^-12.
double grazing_glass(std::vector<real> indices, bool from_outside_alone) {
    Worst worst;
    for (real ior : indices)
        for (bool outside : {true, from_outside_alone})
            for (real z = 1; z > real(1e-12); z *= real(0.7)) worst.see(glass_off(ior, outside, z));
    return worst.value;
}

double critical_glass() {
    Worst worst;
    for (real ior : {real(1.5), real(1.0001), real(2.4)}) {
        const real critical = std::sqrt(1 - 1 / (ior * ior));
        for (real off = real(0.01); off > ulp; off *= real(0.8))
            for (real z : {critical * (1 - off), critical * (1 + off), critical})
                worst.see(glass_off(ior, false, z));
    }
    return worst.value;
}

// f cos / pdf is 1 for reflection, eta^2 for refraction: index 10^-30 to 10^30.
double glass_weights() {
    return worst_of("glass", 100000, [&](Dice& random, Worst& worst, int i) {
        const real ior = i % 3 ? random.decades(-30, 30) : random(real(0.5), 2);
        const vec3 wo = i % 7 ? at_cosine(random.decades(-9, 0)) : vec3{0, 0, 1};
        const bool outside = i % 2;
        const BsdfSample s = sample(glass(ior), wo, outside, random(0, 1), {}, Direction::bsdf);
        const big eta = s.wi.z > 0 ? 1 : outside ? 1 / big(ior) : big(ior);
        worst.see(relative(s.f.x * (std::abs(s.wi.z) / s.pdf), eta * eta));
        worst.see(is_finite(s.wi) ? 0 : HUGE_VAL);
    });
}

// ---- Camera -------------------------------------------------------------------------------------

// Neighbouring pixels of a telescope: the angle between their rays is 2 tan(fov / 2) / height.
double telescope(real degrees) {
    const Camera c = look_at({}, {1, 2, -3}, degrees);
    const big angle = 2 * std::tan(big(degrees) * big_pi / 360) / 128;
    Worst worst;
    for (int x = 100; x < 150; ++x) {
        const Ray a = camera_ray(c, {256, 128}, real(x), 64),
                  b = camera_ray(c, {256, 128}, real(x + 1), 64);
        worst.see(relative(length(big3(a.d) - b.d), angle));
    }
    return worst.value;
}

// The height of the image plane for a field of view of 179.99 degrees.
double wide_angle() {
    const real degrees = real(179.99);
    const Camera c = look_at({}, {0, 0, -1}, degrees);
    return relative(c.tan_half, std::tan(big(degrees) * big_pi / 360));
}

// A view almost straight down: how far the axes are from orthonormal.
double from_above(real off) {
    const Camera c = look_at({real(0.3) + off, 1, off / 3}, {real(0.3), real(0.2), 0}, 40);
    return double(
        std::max({std::abs(dot(big3(c.right), c.up)), std::abs(dot(big3(c.up), c.forward)),
                  std::abs(dot(big3(c.forward), c.right)), std::abs(length(big3(c.right)) - 1),
                  std::abs(length(big3(c.up)) - 1)}));
}

}  // namespace

TEST_CASE("extremes of shapes and directions: no more error than they may have") {
    const FarSphere near = far_sphere(real(1e4)), far = far_sphere(real(1e7)),
                    farther = far_sphere(1 / ulp);
    const Lobe lobe = grazing_lobe();
    check_rows({
        // Rounding of a unit direction moves the hit by 3 ulp of the distance, of the roots by 5.
        {"sphere 10^4 radii away: hit off the surface, in distances", ulps(8),
         [&] { return near.hit_off; }},
        {"sphere 10^4 radii away: point of a path off the surface, in distances",
         within(5e-16, 3e-7), [&] { return near.point_off; }},
        {"sphere 10^4 radii away: part of the rays within 0.99 R that miss", to_the_bit,
         [&] { return near.missed; }},
        // In float those 3 ulp are 1.8 radii.
        {"sphere 10^7 radii away: part of the rays within 0.99 R that miss", within(0, any),
         [&] { return far.missed; }},
        {"sphere 10^7 radii away: hit off the surface, mean, in radii", within(8e7 * d_ulp, any),
         [&] { return far.hit_mean; }},
        {"sphere 10^7 radii away: point of a path off the surface, mean, in radii",
         within(6e-10, 4 * f_ulp), [&] { return far.point_mean; }},
        {"sphere 1 / ulp radii away: the same", ulps(4), [&] { return farther.point_mean; }},
        {"sphere of radius 10^6 seen from 10^-3: distance", ulps(8), over_a_planet},
        {"rays leaving spheres of 10^-6 ... 10^6, 10^6 from the origin: met again", to_the_bit,
         met_again},
        {"closed mesh at (148376, 1234, -223423), aimed at edges and corners: leaks", to_the_bit,
         of(leaks, ball(3), vec3{148376, 1234, -223423})},
        {"closed mesh of slivers, aspect 10^8, aimed at edges and corners: leaks", to_the_bit,
         of(leaks, cones(150, real(1e-8)), vec3{})},
        {"rays along axes, +0 and -0, in faces of boxes: tree unlike loop", to_the_bit, along_axes},
        {"coincident surfaces: not the first one seen", to_the_bit, coincident},
        {"sheet 10^-6 before a wall, from 10: part of the rays that see the wall", within(0, 0.5),
         of(sheet_before_wall, 1e-6)},
        {"sheet 10^-6 above a floor: part of the shadow rays that pass", within(0, any),
         of(shadow_of_sheet, 1e-6)},
        // The product has 1.5 ulp per component, the unit vector 3.5; times sqrt(3).
        {"triangles from 1 to denormal, and without area: normal", ulps(9), tiny_normals},
        {"no shape, one shape, a ray that is not a number: wrong answers", to_the_bit, few_shapes},

        {"frames about n.z = +-1, and 10^-9 off: scalar products of axes", within(2.8e-16, 1e-7),
         frames_at_poles},
        // n is unit within 2 ulp.
        {"frames anywhere: scalar products of axes", ulps(8), frames_anywhere},
        {"samplers at the corners of the unit square: length", ulps(8), corners_of_the_square},
        {"uniform hemisphere near its pole: sines", ulps(8), sines_at_the_pole},
        {"Phong exponent 10^5: sines from the axis", ulps(8), lobe_sines},
        // Rounding of the cosine, 4 ulp, times the exponent.
        {"Phong exponent 10^5, grazing: density", ulps(4e5), [&] { return lobe.density; }},
        {"Phong exponent 10^5, grazing: weight", ulps(16), [&] { return lobe.weight; }},
        {"glass of index 1, cosines down to 10^-12: reflectance", ulps(8),
         of(grazing_glass, std::vector<real>{1}, false)},
        {"glass of index 1.5 ... 100, cosines down to 10^-12: reflectance", ulps(16),
         of(grazing_glass, std::vector<real>{real(1.5), real(2.4), 100}, true)},
        // 4 ulp of cos^2 cancel; their root is the refracted cosine over n cos. 1 - R is 2 (n + 1 /
        // n) / cos times that: 2 (n^2 + 1) sqrt(4 ulp), n = 2.4.
        {"glass at its critical angle: reflectance", within(2.9e-7, 6.6e-3), critical_glass},
        {"glass of index 10^-30 ... 10^30: weights", ulps(16), glass_weights},
        {"field of view of 10^-4 degrees: angle between pixels", within(1e-6, any),
         of(telescope, 1e-4)},
        {"field of view of 179.99 degrees: its tangent", within(1e-11, 1e-2), wide_angle},
        {"camera 10^-9 from looking straight down: axes", ulps(8), of(from_above, 1e-9)},
    });
}

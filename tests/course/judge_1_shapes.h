// course/judge_1_shapes.h  judges 1.1 to 1.4: rays of the camera, and where they meet spheres,
// triangles and boxes
#pragma once
#include "course/judge.h"

namespace penumbra::course {
namespace {

using oracle::say;

double between(Judge& j, double low, double high) { return course::between(j.random, low, high); }
Triple in_cube(Judge& j) { return course::in_cube(j.random); }
Triple direction(Judge& j) { return any_direction(j.random); }
// A direction at an angle to the normal whose cosine is at least 0.2 in size.
Triple slanted(Judge& j, Triple n) {
    for (;;) {
        const Triple d = direction(j);
        if (std::abs(dot(d, n)) > 0.2) return d;
    }
}

constexpr double endless = oracle::infinity;

// The item before is a limit, and whether it is right tells mistakes.
void telling_limit(Judge& j) {
    j.limit();
    j.remember({double(j.items.back().right)});
}

// {hit, t, ...} as it came beside a distance as expected, a negative one for a miss.
void see(Several& s, In came, double expected, double tolerance, const std::string& where) {
    const auto shown = [](bool hit, double t) { return hit ? say("t = %.9g", t) : "a miss"; };
    const bool hit = came[0] != 0, to_hit = expected >= 0;
    s.see(hit == to_hit && (!hit || std::abs(came[1] - expected) <= tolerance),
          where + ": " + shown(to_hit, expected) + " expected, " + shown(hit, came[1]) + " came");
}

// A question with a distance as its answer, right within so many roundings of it or of 1.
struct Asked {
    Out ray;
    double expected;
    std::string where;
    double roundings = 16;
};
// What is looked at by some of them; without a name, nothing: it tells mistakes.
struct Look {
    std::string what;
    std::vector<Asked> asked;
    bool limit = false;
};
void look(Judge& j, const std::string& question, const std::vector<Look>& looks) {
    for (const Look& l : looks) {
        Several distances;
        for (const Asked& a : l.asked)
            see(distances, j.probe(question, Rows(a.ray))[0], a.expected,
                a.roundings * j.epsilon * std::max(1.0, a.expected), a.where);
        if (!l.what.empty()) j.all(l.what, distances);
        if (l.limit) j.limit();
    }
}

// By which an error of a distance is measured: those of a scene of size 1, or another.
double size_of(double distance) {
    return distance > 0.01 && distance < 100 ? 1 : std::abs(distance);
}
// Many rays, each with its distance; or all of them miss.
Rows aimed(Judge& j, const std::string& question, const std::string& what, const std::string& where,
           const Rows& rays, const Out& expected = {}, double roundings = 0) {
    const Rows came = j.ask(question, rays);
    Several distances;
    for (size_t i = 0; i < came.size(); ++i) {
        const double t = expected.empty() ? -1 : expected[i];
        see(distances, came[i], t, roundings * j.epsilon * size_of(t), where);
    }
    j.all(what, distances);
    return came;
}

// ---- 1.1  The camera ----------------------------------------------------------------------------

// 90 degrees high, looking along -z: at a distance of 1 the image reaches from -1 to 1.
Out seen_along_z(double w, double h, double x, double y) {
    return {0, 0, 0, 0, 0, -1, 90, w, h, x, y};
}
// The place of that image that a direction goes through.
std::string place_of(Triple d, double w, double h) {
    if (!(d[2] < 0)) return "no place of the image";
    return say("(%.4g, %.4g)", (w - h * d[0] / d[2]) / 2, (h + h * d[1] / d[2]) / 2);
}

void camera(Judge& j) {
    const double digits =
        std::max(16 * j.epsilon, 0x1p-20);  // a right solution may compute in float
    const struct {
        std::string what;
        Out asked;
        Triple to;
    } worked[] = {
        {"the middle of the image is straight ahead", seen_along_z(64, 32, 32, 16), {0, 0, -1}},
        {"90 degrees of view: the middle of the upper edge is 45 degrees up",
         seen_along_z(64, 32, 32, 0),
         {0, 1, -1}},
        {"an image twice as wide sees twice as far to the right",
         seen_along_z(64, 32, 64, 16),
         {2, 0, -1}},
        {"a quarter from the left, a quarter from below, upright",
         seen_along_z(32, 64, 8, 48),
         {-0.25, -0.5, -1}},
        {"the eye elsewhere: rays go where they went from the origin",
         {3, 2, 1, 3, 2, 0, 90, 64, 32, 48, 8},
         {1, 0.5, -1}},
        {"an image of 3 x 3 has a middle, too: (1.5, 1.5)",
         seen_along_z(3, 3, 1.5, 1.5),
         {0, 0, -1}}};
    for (const auto& [what, asked, to] : worked) {
        // By the first four mistakes are told.
        const bool tells = j.items.size() < 4;
        const Rows ray =
            tells ? j.probe("camera_ray", Rows(asked)) : j.ask("camera_ray", Rows(asked));
        const Triple came = triple(ray[0], 3);
        j.vector(what, came, unit(to), digits);
        j.items.back().seen += say(": the ray for (%g, %g) of %g x %g goes through ", asked[9],
                                   asked[10], asked[7], asked[8]) +
                               place_of(came, asked[7], asked[8]);
    }
    const Out tilted = j.ask("camera_ray", Out{0, 0, 0, 0, -3, -4, 90, 64, 32, 32, 0});
    j.vector("the camera tilted: up is at right angles to where it looks", triple(tilted, 3),
             unit({0, 0.2, -1.4}), digits);
    // Any camera: unit directions from the eye, and places of the image plane are evenly spaced.
    double off_unit = 0, off_eye = 0, off_even = 0, off_view = 0, off_all = 0, end = endless;
    for (int i = 0; i < 100; ++i) {
        const Triple eye = 3 * in_cube(j), ahead = slanted(j, 1 / std::sqrt(3.0) * Triple{1, 0, 1});
        const Triple target = eye + between(j, 1, 5) * ahead;
        const double fov = between(j, 20, 100), w = 16 + std::floor(100 * j.random());
        const double h = 16 + std::floor(100 * j.random());
        const double x = between(j, 0, w), y = between(j, 0, h);
        auto at = [&](double px, double py) { return row(eye, target, fov, w, h, px, py); };
        const Rows rays = j.ask("camera_ray", {at(0, 0), at(x, y), at(x / 2, y / 2), at(w / 2, 0)});
        Triple plane[4];
        const Triple right = unit(cross(ahead, {0, 1, 0})), up = cross(right, ahead);
        const double tan_half = std::tan(fov * oracle::pi / 360);
        const Triple to =
            ahead + (2 * x - w) / h * tan_half * right + (1 - 2 * y / h) * tan_half * up;
        off_all = worse(off_all, length(triple(rays[1], 3) - unit(to)));
        for (size_t k = 0; k < 4; ++k) {
            const Triple o = triple(rays[k]), dir = triple(rays[k], 3);
            off_unit = worse(off_unit, std::abs(dot(dir, dir) - 1));
            off_eye = worse(off_eye, length(o - eye));
            end = -worse(-end, -rays[k][6]);
            plane[k] = 1 / dot(dir, ahead) * dir;
        }
        const Triple bend = plane[2] - 0.5 * (plane[0] + plane[1]);
        off_even = worse(off_even, length(bend));
        const double angle = std::atan(length(plane[3] - ahead)) * 360 / oracle::pi;
        off_view = worse(off_view, std::abs(angle - fov) / fov);
    }
    const double rounded = std::max(4096 * j.epsilon, 0x1p-18);
    j.below("directions have length 1", off_unit, 2 * digits);
    j.below("rays start at the eye", off_eye, digits);
    j.exact("rays have no end", end == endless, say("one ends at t = %.6g", end));
    j.below("the field of view is the one that was asked for", off_view, rounded,
            "off by %.3g of it");
    j.below("steps on the image plane are even, so that straight lines stay straight", off_even,
            rounded);
    j.below("any camera, wherever it stands and looks: any place of the image", off_all, rounded);
}

// ---- 1.2  Spheres -------------------------------------------------------------------------------

// Rays to points that face them, at known distances; rays past the sphere; and rays from inside.
void random_spheres(Judge& j) {
    Rows hits, misses, inside, ending;
    Out distance, to_far;
    for (int i = 0; i < 1000; ++i) {
        const Triple centre = 2 * in_cube(j);
        const double r = between(j, 0.5, 2), t = between(j, 0.1, 5);
        const Triple normal = direction(j);
        Triple d = slanted(j, normal);
        if (dot(d, normal) > 0) d = -1.0 * d;
        hits.add(row(centre + r * normal - t * d, d, endless, centre, r));
        distance.push_back(t);
        const Triple aside = unit(cross(normal, d));
        misses.add(row(centre + between(j, 1.01, 2) * r * aside - between(j, -5, 5) * d, d, endless,
                       centre, r));
        const double scale = std::ldexp(1, i % 3 * 20 - 20);
        const Triple in = scale * between(j, 0.1, 0.95) * r * direction(j),
                     to = scale * r * normal - in;
        inside.add(row(in, unit(to), endless, Triple{}, scale * r));
        to_far.push_back(length(to));
        ending.add(row(in, unit(to), 0.99 * length(to), Triple{}, scale * r));
    }
    // b^2 - c loses some 3 b^2 <= 150 ulp, which the root divides by 2 x 0.2 x 0.5.
    aimed(j, "intersect_sphere", "1000 spheres are hit where their near side was aimed at",
          "a sphere whose near side was aimed at", hits, distance, 1024);
    aimed(j, "intersect_sphere", "rays past 1000 spheres miss them", "a ray past a sphere", misses);
    aimed(j, "intersect_sphere", "from anywhere inside, the far side is met, whatever the scale",
          "from inside", inside, to_far, 1024);
    aimed(j, "intersect_sphere", "from inside, a ray that ends before the far side meets nothing",
          "from inside, tmax before it", ending);
}

void far_spheres(Judge& j) {
    // A unit sphere so far away that its size is lost beside the square of the distance.
    const double far = j.epsilon > 0x1p-50 ? 0x1p9 : 0x1p20;
    Rows rays;
    Out distance;
    for (double x : {0.0, 0.25, 0.5, 0.75, 1.5, 3.0})
        for (double z : {far, 0x1p30}) {
            rays.add({x, 0, z, 0, 0, -1, endless, 0, 0, 0, 1});
            distance.push_back(x < 1 ? z - std::sqrt(1 - x * x) : -1);
        }
    aimed(j, "intersect_sphere", "from far away a sphere is as large as from nearby", "from afar",
          rays, distance, 16);
    j.limit();
}

void sphere(Judge& j) {
    const Triple o{0, 0, 0}, c{1, 2, 3}, z{0, 0, 1}, back{0, 0, -1}, above{1, 2, 10}, in{1, 2, 4};
    const double tiny = 0x1p-24;
    look(
        j, "intersect_sphere",
        {{"a sphere of radius 2, 7 away: its near side is 5 away",
          {{row(above, back, endless, c, 2), 5, "straight ahead"}}},
         {"a sphere of radius 2.5, passed at 1.5 or 2 from its centre, is 5 or 5.5 away",
          {{row(Triple{1, 3.5, 10}, back, endless, c, 2.5), 5, "at 1.5"},
           {row(Triple{1, 4, 10}, back, endless, c, 2.5), 5.5, "at 2"}}},
         {"a sphere of radius 2.5, passed at 3 from its centre, is missed",
          {{row(Triple{1, 5, 10}, back, endless, c, 2.5), -1, "beside"}}},
         {"from inside a sphere its far side is seen",
          {{row(in, back, endless, c, 2), 3, "from inside"}}},
         {"a sphere behind the origin is not seen", {{row(above, z, endless, c, 2), -1, "behind"}}},
         {"the ray ends at tmax",
          {{row(above, back, 4.5, c, 2), -1, "near side beyond tmax"},
           {row(above, back, 6, c, 2), 5, "all but the near side beyond tmax", 16.0 / 5},
           {row(in, back, 2.5, c, 2), -1, "from inside, far side beyond tmax"}}},
         {"tiny spheres are seen from nearby",
          {{row(3 * tiny * z, back, endless, o, tiny), 2 * tiny, "scaled by 2^-24"}},
          true},
         {"", {{row(Triple{2, 0, 0x1p30}, back, endless, o, 1), -1, "beside, from afar"}}}});
    aimed(j, "intersect_sphere", "a ray that starts on a sphere and leaves does not meet it",
          "from its top, away", Rows(row(Triple{1, 2, 5}, z, endless, c, 2)));
    j.limit();
    // Some roundings of 1, the radius.
    const double near = 0x1p-16;
    aimed(j, "intersect_sphere", "a hit counts however near it is, at 2^-16 of the radius",
          "from nearby",
          {row((1 + near) * z, back, endless, o, 1), row((1 - near) * z, z, endless, o, 1)},
          {near, near}, 4 / near);
    j.limit();
    aimed(j, "intersect_sphere", "a hit at tmax itself counts", "tmax = 5, 5 away",
          Rows(row(above, back, 5, c, 2)), {5}, 16);
    telling_limit(j);
    random_spheres(j);
    far_spheres(j);
}

// ---- 1.3  Triangles -----------------------------------------------------------------------------

// A triangle that is no sliver.
std::array<Triple, 3> any_triangle(Judge& j) {
    for (;;) {
        const Triple a = in_cube(j), b = in_cube(j), c = in_cube(j), n = cross(b - a, c - a);
        if (dot(n, n) > 0.04) return {a, b, c};
    }
}

void random_triangles(Judge& j) {
    const size_t n = 1000;
    Rows hits, misses;
    Out distance;
    std::vector<std::array<double, 2>> place;  // v, w
    Rows small;
    for (size_t i = 0; i < n; ++i) {
        const auto [a, b, c] = any_triangle(j);
        const Triple d = slanted(j, unit(cross(b - a, c - a)));
        double v = between(j, 0.01, 0.98), w = between(j, 0.01, 0.98), t = between(j, 0.1, 5);
        if (v + w > 0.99) v = 0.99 - v, w = 0.99 - w;
        if (v < 0.01 || w < 0.01) v = w = 0.2;
        hits.add(row(a + v * (b - a) + w * (c - a) - t * d, d, endless, a, b, c));
        distance.push_back(t), place.push_back({v, w});
        // Beyond one of the edges, at a time.
        const double along = between(j, 0.1, 0.9), out = between(j, 0.01, 1);
        const Triple p = i % 3 == 0   ? a + along * (b - a) - out * (c - a)
                         : i % 3 == 1 ? a + along * (c - a) - out * (b - a)
                                      : b + along * (c - b) + out * (b - a);
        misses.add(row(p - t * d, d, endless, a, b, c));
        const double s = 0x1p-20;
        small.add(row(s * (p - t * d), d, endless, s * a, s * b, s * c));
    }
    const Rows hit =
        aimed(j, "intersect_triangle", "1000 triangles are hit where they were aimed at",
              "a triangle", hits, distance, 4096);
    double off = 0;
    for (size_t i = 0; i < n; ++i)
        if (hit[i][0] != 0)
            for (size_t k : {0, 1}) off = worse(off, std::abs(hit[i][2 + k] - place[i][k]));
    j.below("v and w say where: (1-v-w) a + v b + w c", off, 4096 * j.epsilon);
    aimed(j, "intersect_triangle", "rays past an edge of 1000 triangles miss them",
          "a ray past an edge of a triangle", misses);
    aimed(j, "intersect_triangle",
          "rays past an edge miss triangles that are a million times as small",
          "scaled by 2^-20, past an edge", small);
    j.limit();
}

// Rays through the edge that two triangles share, seen from either side and at any angle.
void shared_edges(Judge& j) {
    const size_t n = 50000;
    Rows left, right;
    for (size_t i = 0; i < n; ++i) {
        const auto [a, b, c] = any_triangle(j);
        const Triple opposite = a + (b - c) + 0.1 * in_cube(j);
        const Triple n_first = cross(b - a, c - a), n_second = cross(b - a, opposite - a);
        const Triple d = slanted(j, unit(n_first)), other = slanted(j, unit(n_second));
        const Triple aim = i % 2 ? d : other;
        const Triple o = a + between(j, 0.05, 0.95) * (b - a) - between(j, 0.5, 5) * aim;
        // Both must be seen from the same side: then they lie on both sides of the edge.
        if (dot(aim, n_first) * dot(aim, n_second) >= 0) continue;
        // Corners in any order.
        const Triple one[] = {a, b, c}, next[] = {b, a, opposite};
        const size_t k = i % 3, l = i / 3 % 3;
        left.add(row(o, aim, endless, one[k], one[(k + 1) % 3], one[(k + 2) % 3]));
        right.add(row(o, aim, endless, next[l], next[(l + 1) % 3], next[(l + 2) % 3]));
    }
    // Where nothing is rounded, the ray is on the edge itself.
    for (double x : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        left.add({x, 0, 2, 0, 0, -1, endless, 0, 0, 0, 1, 0, 0, 0, 1, 0});
        right.add({x, 0, 2, 0, 0, -1, endless, 1, 0, 0, 0, 0, 0, 1, -1, 0});
    }
    const Rows first = j.ask("intersect_triangle", left),
               second = j.ask("intersect_triangle", right);
    size_t leaks = 0;
    for (size_t i = 0; i < first.size(); ++i) leaks += !(first[i][0] > 0 || second[i][0] > 0);
    j.exact("no ray passes between triangles that share an edge", leaks == 0,
            say("%zu of %zu pass", leaks, first.size()));
}

void triangle(Judge& j) {
    const std::string question = "intersect_triangle";
    const Triple a{0, 0, 0}, b{4, 0, 0}, c{0, 2, 0}, back{0, 0, -1}, z{0, 0, 1}, above{1, 1, 5};
    const Triple shift{-1, -0.5, 1};
    const double tiny = 0x1p-24;
    look(j, question,
         {{"a triangle is 5 away from 5 above it",
           {{row(above, back, endless, a, b, c), 5, "above (1, 1, 0)"}}},
          {"the back of a triangle is hit, too",
           {{row(Triple{1, 1, -5}, z, endless, a, b, c), 5, "below (1, 1, 0)"}}},
          {"a triangle is hit slantwise, with its corners in another order, and elsewhere",
           {{row(Triple{-2, 1, -4}, Triple{0.6, 0, 0.8}, endless, a, b, c), 5,
             "slanted, from below"},
            {row(above, back, endless, a, c, b), 5, "corners in another order"},
            {row(-4.0 * z, z, endless, a + shift, b + shift, c + shift), 5, "elsewhere"}}},
          {"a ray beside a triangle misses it",
           {{row(Triple{3, 1, 5}, back, endless, a, b, c), -1, "beyond the edge from b to c"},
            {row(Triple{2, -0.5, 5}, back, endless, a, b, c), -1, "beyond the edge from a to b"}}},
          {"a triangle behind the origin is not hit",
           {{row(above, z, endless, a, b, c), -1, "behind"}}},
          {"a triangle beyond the end of the ray is not hit",
           {{row(above, back, 4.5, a, b, c), -1, "tmax = 4.5, 5 away"}}},
          {"", {{row(Triple{2, 0, 5}, back, endless, a, b, c), 5, "on an edge"}}},
          {"no triangle is too small, and none too near",
           {{row(Triple{tiny, tiny / 2, 1}, back, endless, a, tiny * b, tiny * c), 1,
             "scaled by 2^-24, from 1 away"},
            {row(Triple{1, 1, tiny}, back, endless, a, b, c), tiny, "from 2^-24 away", 16 * tiny}},
           true}});
    const Out first = j.ask(question, row(above, back, endless, a, b, c));
    j.vector("from above (1, 1, 0), v = 1/4 and w = 1/2", {first[2], first[3], 0}, {0.25, 0.5, 0},
             16 * j.epsilon);
    aimed(j, question, "a ray that starts on a triangle does not meet it", "from (1, 1, 0)",
          Rows(row(Triple{1, 1, 0}, back, endless, a, b, c)));
    j.limit();
    aimed(j, question, "the end of a slanted ray is told along the ray", "tmax = 4.5, 5 away",
          Rows(row(Triple{-2, 1, -4}, Triple{0.6, 0, 0.8}, 4.5, a, b, c)));
    j.limit();
    aimed(j, question, "a hit at tmax itself counts", "tmax = 5, 5 away",
          Rows(row(above, back, 5, a, b, c)), {5}, 16);
    telling_limit(j);
    // In its plane, along axes: then no edge function is rounded, and all are 0.
    aimed(j, question, "a triangle seen edge-on is missed", "in its plane, through it",
          {row(Triple{-1, 0.5, 0}, Triple{1, 0, 0}, endless, a, b, c),
           row(Triple{1, 5, 0}, Triple{0, -1, 0}, endless, a, b, c),
           row(Triple{0, 1, 7}, back, endless, a, Triple{0, 2, 0}, Triple{0, 1, 3})});
    telling_limit(j);
    random_triangles(j);
    shared_edges(j);
}

// ---- 1.4  Boxes ---------------------------------------------------------------------------------

// Points of a face that a ray enters by, at known distances; and rays past an edge.
void random_boxes(Judge& j) {
    const size_t n = 1000;
    Rows hits, flat, misses;
    Out distance, to_flat;
    for (size_t i = 0; i < n; ++i) {
        const Triple middle = 2 * in_cube(j);
        Triple half, p = middle;
        for (size_t k = 0; k < 3; ++k) {
            half[k] = between(j, 0.1, 1);
            p[k] += between(j, -0.99, 0.99) * half[k];
        }
        const size_t face = i % 3, other = (face + 1) % 3;
        const bool is_flat = i % 4 == 0;
        if (is_flat) half[face] = 0;
        Triple normal{};
        const double side = i % 2 ? 1 : -1, t = between(j, 0.1, 5);
        normal[face] = side;
        p[face] = middle[face] + side * half[face];
        Triple d = slanted(j, normal);
        if (dot(d, normal) > 0) d = -1.0 * d;
        (is_flat ? flat : hits).add(row(p - t * d, d, endless, middle - half, middle + half));
        (is_flat ? to_flat : distance).push_back(t);
        // Within a plane that has all of the box on one side.
        Triple corner = middle, away{}, along = direction(j);
        corner[face] += side * half[face], corner[other] -= side * half[other];
        away[face] = side * between(j, 0.3, 1), away[other] = -side * between(j, 0.3, 1);
        along = unit(cross(away, along));
        misses.add(row(corner + between(j, 0.02, 1) * away - between(j, -5, 5) * along, along,
                       endless, middle - half, middle + half));
    }
    aimed(j, "enter_box", "boxes are entered where they were aimed at", "a face that was aimed at",
          hits, distance, 1024);
    aimed(j, "enter_box", "flat boxes, of no thickness, are entered where they were aimed at",
          "a flat box that was aimed at", flat, to_flat, 1024);
    aimed(j, "enter_box", "rays past an edge of 1000 boxes miss them", "a ray past an edge",
          misses);
}

void box(Judge& j) {
    const Triple lo{2, -1, -3}, hi{5, 1, 3}, x{1, 0, 0}, left{-1, 0, 0}, o{0, 0, 0};
    const Triple d{0.6, 0, 0.8}, minus_zero{1, -0.0, -0.0}, steep{0.6, 0.8, 0}, right{9, 0, 0};
    look(j, "enter_box",
         {{"along x, a box that begins at x = 2 is 2 away",
           {{row(o, x, endless, lo, hi), 2, "from the origin along x"}}},
          {"backwards along x, from x = 9, a box that ends at x = 5 is 4 away",
           {{row(right, left, endless, lo, hi), 4, "along -x"}}},
          {"slanted rays enter at 10/3, or pass above or beside",
           {{row(Triple{0, 0, -1}, d, endless, lo, hi), 10.0 / 3, "along (0.6, 0, 0.8)", 9.6},
            {row(o, steep, endless, lo, hi), -1, "along (0.6, 0.8, 0), above it"},
            {row(Triple{0, 0, 4}, x, endless, lo, hi), -1, "along x at z = 4, beside it"}}},
          {"a ray that starts inside is in it at once",
           {{row(Triple{3, 0.5, 1}, d, endless, lo, hi), 0, "from inside"}}},
          {"a box behind the origin is not met", {{row(right, x, endless, lo, hi), -1, "behind"}}},
          {"the ray ends at tmax",
           {{row(o, x, 1.5, lo, hi), -1, "tmax = 1.5, 2 away"},
            {row(o, x, 3, lo, hi), 2, "tmax = 3, within the box", 8}}},
          {"where the direction is 0 the ray is between two planes, or never",
           {{row(Triple{0, 2, 0}, minus_zero, endless, lo, hi), -1,
             "along x at y = 2, above it; d.y = -0"},
            {row(o, minus_zero, endless, lo, hi), 2, "along x; d.y = -0", 8}}}});
    // Where a ray rises by 1 along 2^24, a component of its direction is no rounding of 0.
    const double far = 0x1p24;
    aimed(j, "enter_box", "nearly parallel is not parallel", "rising by 1 within 2^24",
          {row(o, unit({1, 1 / far, 0}), endless, Triple{far, 0.5, -1}, Triple{2 * far, 9, 1}),
           row(o, unit({1, 1 / far, 0}), endless, Triple{far, -9, -1}, Triple{2 * far, 0.5, 1})},
          {far, -1}, 16);
    telling_limit(j);
    random_boxes(j);
}

}  // namespace
}  // namespace penumbra::course

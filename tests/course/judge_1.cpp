// course/judge_1.cpp  judges week 1: intersections and the tree
#include <chrono>

#include "course/judge.h"

using namespace course;
using oracle::say;

namespace {

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

// Distances as expected, a negative one for a miss, beside {hit, t, ...} as they came.
struct Distances {
    int wrong = 0;
    std::string first;  // of the wrong ones

    void see(In came, double expected, double tolerance, const std::string& where) {
        const bool hit = came[0] != 0;
        if (hit == (expected >= 0) && (!hit || std::abs(came[1] - expected) <= tolerance)) return;
        if (wrong++ > 0) return;
        first = where + ": " +
                (expected >= 0 ? say("t = %.9g expected", expected) : "a miss expected") + ", " +
                (hit ? say("t = %.9g", came[1]) : "a miss") + " came";
    }
    void judge(Judge& j, const std::string& what, size_t of) const {
        j.exact(what, wrong == 0, first + (of > 1 ? say(" (%d of %zu are wrong)", wrong, of) : ""));
    }
};

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
Rows look(Judge& j, const std::string& question, const std::vector<Look>& looks) {
    Rows rays;
    for (const Look& l : looks)
        for (const Asked& a : l.asked) rays.add(a.ray);
    const Rows came = j.probe(question, rays);
    size_t i = 0;
    for (const Look& l : looks) {
        Distances d;
        for (const Asked& a : l.asked)
            d.see(came[i++], a.expected, a.roundings * j.epsilon * std::max(1.0, a.expected),
                  a.where);
        if (!l.what.empty()) d.judge(j, l.what, l.asked.size());
        if (l.limit) j.limit();
    }
    return came;
}

// By which an error of a distance is measured: those of a scene of size 1, or another.
double size_of(double distance) {
    return distance > 0.01 && distance < 100 ? 1 : std::abs(distance);
}
// Many rays, each with its distance; or all of them miss.
Rows aimed(Judge& j, const std::string& question, const std::string& what, const std::string& where,
           const Rows& rays, const Out& expected = {}, double roundings = 0) {
    const Rows came = j.ask(question, rays);
    Distances d;
    for (size_t i = 0; i < came.size(); ++i)
        d.see(came[i], expected.empty() ? -1 : expected[i],
              expected.empty() ? 0 : roundings * j.epsilon * size_of(expected[i]), where);
    d.judge(j, what, came.size());
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
    const auto see = seen_along_z;
    const Rows asked{see(64, 32, 32, 16), see(64, 32, 32, 0), see(64, 32, 64, 16),
                     see(32, 64, 8, 48)};
    const Rows d = j.probe("camera_ray", asked);
    auto points_to = [&](const std::string& what, size_t i, Triple to) {
        const In a = asked[i];
        const Triple came = triple(d[i], 3);
        j.vector(what, came, unit(to), digits);
        j.items.back().seen +=
            say(": the ray for (%g, %g) of %g x %g goes through ", a[9], a[10], a[7], a[8]) +
            place_of(came, a[7], a[8]);
    };
    points_to("the middle of the image is straight ahead", 0, {0, 0, -1});
    points_to("90 degrees of view: the middle of the upper edge is 45 degrees up", 1, {0, 1, -1});
    points_to("an image twice as wide sees twice as far to the right", 2, {2, 0, -1});
    points_to("a quarter from the left, a quarter from below, upright", 3, {-0.25, -0.5, -1});
    const Rows other = j.ask("camera_ray", {{3, 2, 1, 3, 2, 0, 90, 64, 32, 48, 8},
                                            {0, 0, 0, 0, -3, -4, 90, 64, 32, 32, 0},
                                            {0, 0, 0, 0, 0, -1, 90, 3, 3, 1.5, 1.5}});
    const auto also = [&](const std::string& what, size_t i, Triple to) {
        j.vector(what, triple(other[i], 3), unit(to), digits);
    };
    also("the eye elsewhere: rays go where they went from the origin", 0, {1, 0.5, -1});
    also("the camera tilted: up is at right angles to where it looks", 1, {0, 0.2, -1.4});
    also("an image of 3 x 3 has a middle, too: (1.5, 1.5)", 2, {0, 0, -1});
    j.items.back().seen +=
        ": the ray for (1.5, 1.5) goes through " + place_of(triple(other[2], 3), 3, 3);
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
    aimed(j, "intersect_sphere", "unless the ray ends before it", "from inside, tmax before it",
          ending);
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
    const Rows came = j.ask("intersect_sphere", rays);
    Distances d;
    for (size_t i = 0; i < came.size(); ++i)
        d.see(came[i], distance[i], 16 * j.epsilon * rays[i][2], say("from %.6g away", rays[i][2]));
    d.judge(j, "from far away a sphere is as large as from nearby", came.size());
    j.limit();
}

void sphere(Judge& j) {
    const Triple o{0, 0, 0}, c{1, 2, 3}, z{0, 0, 1}, back{0, 0, -1}, above{1, 2, 10}, in{1, 2, 4};
    const double tiny = 0x1p-24;
    look(
        j, "intersect_sphere",
        {{"a sphere of radius 2, 7 away: its near side is 5 away",
          {{row(above, back, endless, c, 2), 5, "straight ahead"}}},
         {"one of radius 2.5, passed at 1.5 or 2 from its centre, is 5 or 5.5 away",
          {{row(Triple{1, 3.5, 10}, back, endless, c, 2.5), 5, "at 1.5"},
           {row(Triple{1, 4, 10}, back, endless, c, 2.5), 5.5, "at 2"}}},
         {"passed at 3 it is missed",
          {{row(Triple{1, 5, 10}, back, endless, c, 2.5), -1, "beside"}}},
         {"from its inside the far side is seen",
          {{row(in, back, endless, c, 2), 3, "from inside"}}},
         {"a sphere behind the origin is not seen", {{row(above, z, endless, c, 2), -1, "behind"}}},
         {"the ray ends at tmax",
          {{row(above, back, 4.5, c, 2), -1, "near side beyond tmax"},
           {row(above, back, 7, c, 2), 5, "far side beyond tmax", 16.0 / 5},
           {row(in, back, 2.5, c, 2), -1, "from inside, far side beyond tmax"}}},
         {"tiny spheres are seen from nearby",
          {{row(3 * tiny * z, back, endless, o, tiny), 2 * tiny, "scaled by 2^-24"}},
          true},
         {"", {{row(Triple{2, 0, 0x1p30}, back, endless, o, 1), -1, "beside, from afar"}}}});
    aimed(j, "intersect_sphere", "a ray that starts on a sphere and leaves does not meet it",
          "from its top, away", Rows(row(Triple{1, 2, 5}, z, endless, c, 2)));
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
    aimed(j, "intersect_triangle", "nor are they hit where all is a million times as small",
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
    const Rows first = look(
        j, question,
        {{"from 5 above: 5 away", {{row(above, back, endless, a, b, c), 5, "above (1, 1, 0)"}}}});
    const double v = first[0][2], w = first[0][3];
    j.exact("there v = 1/4 and w = 1/2", std::abs(v - 0.25) + std::abs(w - 0.5) < 16 * j.epsilon,
            say("v = %.6g, w = %.6g", v, w));
    look(j, question,
         {{"from below: its back is hit, too",
           {{row(Triple{1, 1, -5}, z, endless, a, b, c), 5, "below (1, 1, 0)"}}},
          {"slanted, with its corners in another order, and elsewhere it is hit, too",
           {{row(Triple{-2, 1, -4}, Triple{0.6, 0, 0.8}, endless, a, b, c), 5,
             "slanted, from below"},
            {row(above, back, endless, a, c, b), 5, "corners in another order"},
            {row(-4.0 * z, z, endless, a + shift, b + shift, c + shift), 5, "elsewhere"}}},
          {"beside it: missed",
           {{row(Triple{3, 1, 5}, back, endless, a, b, c), -1, "beyond the edge from b to c"},
            {row(Triple{2, -0.5, 5}, back, endless, a, b, c), -1, "beyond the edge from a to b"}}},
          {"behind the origin: not hit", {{row(above, z, endless, a, b, c), -1, "behind"}}},
          {"beyond the end of the ray: not hit",
           {{row(above, back, 4.5, a, b, c), -1, "tmax = 4.5, 5 away"}}},
          {"", {{row(Triple{2, 0, 5}, back, endless, a, b, c), 5, "on an edge"}}},
          {"no triangle is too small, and none too near",
           {{row(Triple{tiny, tiny / 2, 1}, back, endless, a, tiny * b, tiny * c), 1,
             "scaled by 2^-24, from 1 away"},
            {row(Triple{1, 1, tiny}, back, endless, a, b, c), tiny, "from 2^-24 away", 16 * tiny}},
           true}});
    aimed(j, question, "a ray that starts on a triangle does not meet it", "from (1, 1, 0)",
          Rows(row(Triple{1, 1, 0}, back, endless, a, b, c)));
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
    aimed(j, "enter_box", "so are flat ones, of no thickness", "a flat box that was aimed at", flat,
          to_flat, 1024);
    aimed(j, "enter_box", "rays past an edge of 1000 boxes miss them", "a ray past an edge",
          misses);
}

void box(Judge& j) {
    const Triple lo{2, -1, -3}, hi{5, 1, 3}, x{1, 0, 0}, left{-1, 0, 0}, o{0, 0, 0};
    const Triple d{0.6, 0, 0.8}, minus_zero{1, -0.0, -0.0}, steep{0.6, 0.8, 0}, right{9, 0, 0};
    look(j, "enter_box",
         {{"along x, a box that begins at x = 2 is 2 away",
           {{row(o, x, endless, lo, hi), 2, "from the origin along x"}}},
          {"backwards along x, from x = 9, one that ends at x = 5 is 4 away",
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

// ---- 1.5  The tree ------------------------------------------------------------------------------

// A tree as the program is asked about it: of a node its first child or shape, its count, where a
// ray enters it and where it meets what is in the leaf, or -1.
struct Table {
    Out numbers{endless};
    size_t nodes = 1;

    explicit Table(double tmax = endless) : numbers{tmax, 0, 0, 0, -1} {}
    double& enter(size_t i) { return numbers[3 + 4 * i]; }
    double& hit(size_t i) { return numbers[4 + 4 * i]; }
    bool is_leaf(size_t i) const { return numbers[2 + 4 * i] > 0; }

    // Gives a node two children, and says the first of them.
    size_t divide(size_t i, double enter_left, double enter_right) {
        const size_t left = nodes;
        numbers[1 + 4 * i] = double(left);
        nodes += 2;
        for (double e : {enter_left, enter_right}) numbers.insert(numbers.end(), {0, 0, e, -1});
        return left;
    }
    void make_leaf(size_t i, double t) {
        numbers[1 + 4 * i] = 0, numbers[2 + 4 * i] = 1, hit(i) = t;
    }
};

Table two_leaves(double enter_left, double hit_left, double enter_right, double hit_right,
                 double tmax = endless) {
    Table t(tmax);
    t.divide(0, enter_left, enter_right);
    t.make_leaf(1, hit_left), t.make_leaf(2, hit_right);
    return t;
}

// Full, eight levels deep; each box is entered behind its parent's, or missed.
void grow(Judge& j, Table& t, size_t i, int levels) {
    auto wait = [&] { return -std::log(1 - j.random()); };
    const double e = t.enter(i);
    if (levels == 0) return t.make_leaf(i, e >= 0 && j.random() < 0.35 ? e + 0.5 * wait() : -1);
    const double l = e >= 0 && j.random() < 0.8 ? e + 0.4 * wait() : -1;
    const double r = e >= 0 && j.random() < 0.8 ? e + 0.4 * wait() : -1;
    const size_t left = t.divide(i, l, r);
    grow(j, t, left, levels - 1), grow(j, t, left + 1, levels - 1);
}

void random_trees(Judge& j) {
    const size_t n = 600;
    Rows trees;
    Out nearest, needed;  // the nearest hit; leaves that begin before it, which none can leave out
    for (size_t i = 0; i < n; ++i) {
        // Every fourth ray ends somewhere.
        Table t(i % 4 ? endless : between(j, 0, 3));
        grow(j, t, 0, 8);
        double best = t.numbers[0], before = 0;
        for (size_t k = 0; k < t.nodes; ++k)
            if (t.is_leaf(k) && t.hit(k) >= 0) best = std::min(best, t.hit(k));
        for (size_t k = 0; k < t.nodes; ++k)
            before += t.is_leaf(k) && t.enter(k) >= 0 && t.enter(k) <= best;
        trees.add(t.numbers);
        nearest.push_back(best < t.numbers[0] ? best : -1), needed.push_back(before);
    }
    const Rows came = j.ask("nearest_hit", trees);
    double boxes = 0, leaves = 0, least = 0;
    size_t wrong = 0;
    for (size_t i = 0; i < n; ++i) {
        wrong += std::abs(came[i][0] - nearest[i]) > 8 * j.epsilon * nearest[i] + 8 * j.epsilon;
        boxes += came[i][2] / n, leaves += came[i][3] / n, least += needed[i] / n;
    }
    j.none("in 600 trees of 256 leaves the nearest hit is found", wrong, "%zu of 600 are wrong");
    // 1.74 times by the nearer child first, 2.4 by the left one first, 7.5 if none is skipped; and
    // 79 boxes, 145 if none is skipped, 256 by asking each leaf.
    j.exact("no more leaves than that need to be looked at", leaves < 2.05 * least,
            say("%.1f a ray, of which %.1f cannot be avoided; at most %.1f expected", leaves, least,
                2.05 * least));
    j.exact("whole subtrees are skipped, and no box is asked twice", boxes < 110,
            say("%.1f boxes a ray, at most 110 expected", boxes));
}

void tree(Judge& j) {
    Rows pairs;
    for (const Table& t :
         {two_leaves(1, 1.5, 2, 2.5), two_leaves(2, 2.5, 1, 1.5), two_leaves(1, 3, 2, 2.5),
          two_leaves(1, -1, 2, 2.5), two_leaves(1, 1.5, 2, 2.5, 0.5), two_leaves(-1, -1, 1, 2)})
        pairs.add(t.numbers);
    const Rows came = j.probe("nearest_hit", pairs);
    auto finds = [&](const std::string& what, size_t i, double t, Out order) {
        const In c = came[i];
        bool right = std::abs(c[0] - t) < 16 * j.epsilon && c[3] == double(order.size());
        for (size_t k = 0; k < order.size(); ++k) right = right && c[4 + k] == order[k];
        std::string seen = say("t = %.6g; leaves looked at:", c[0]);
        for (size_t k = 0; k < 6 && c[4 + k] >= 0; ++k) seen += c[4 + k] == 1 ? " left" : " right";
        j.exact(what, right, seen + say(" (t = %.6g and %zu expected)", t, order.size()));
    };
    finds("the left leaf is nearer, and its hit is before the right one: one is looked at", 0, 1.5,
          {1});
    finds("the same with left and right exchanged", 1, 1.5, {2});
    finds("a hit behind where the other leaf begins: both are looked at, the nearer hit counts", 2,
          2.5, {1, 2});
    finds("no hit in the nearer leaf: the other one is looked at", 3, 2.5, {1, 2});
    finds("what begins beyond the end of the ray is not looked at", 4, -1, {});
    finds("a box that is missed is not looked at", 5, 2, {2});
    // The left child's second leaf begins behind the hit in its first, the right leaf before it.
    Table three;
    three.divide(0, 1, 4);
    three.make_leaf(2, 4.5);
    three.divide(1, 2, 6);
    three.make_leaf(3, 5), three.make_leaf(4, -1);
    const Out ended = j.ask("nearest_hit", three.numbers);
    j.exact("a box that begins behind the hit is left out, and others still wait", ended[0] == 4.5,
            say("t = 4.5 expected, %.6g came", ended[0]));
    telling_limit(j);
    const Out zero = j.ask("nearest_hit", two_leaves(0, 0.5, 0, 0.25).numbers);
    j.exact("boxes that the ray starts in, which it enters at 0, are opened", zero[0] == 0.25,
            say("t = 0.25 expected, %.6g came", zero[0]));
    telling_limit(j);
    const double tiny = 0x1p-24;
    const Out small =
        j.ask("nearest_hit", two_leaves(tiny, 3 * tiny, 2 * tiny, 2.5 * tiny).numbers);
    j.exact("the same where all is tiny", small[0] == 2.5 * tiny,
            say("t = %.6g expected, %.6g came", 2.5 * tiny, small[0]));
    telling_limit(j);
    Table single, missed;
    single.make_leaf(0, 3), missed.make_leaf(0, 3), missed.enter(0) = -1;
    j.number("a tree that is one leaf", j.ask("nearest_hit", single.numbers)[0], 3, 8 * j.epsilon);
    j.limit();
    j.number("nothing is looked at where the ray misses the root",
             j.ask("nearest_hit", missed.numbers)[3], 0, 0);
    telling_limit(j);
    // At every level a leaf has to wait; one of them is hit.
    double found = 70;
    for (int hit : {0, 1, 15, 31, 63}) {
        Table spine;
        size_t at = 0;
        for (int level = 0; level < 64; ++level) {
            const size_t left = spine.divide(at, level, level + 0.5);
            spine.make_leaf(left + 1, level == hit ? 70.0 : -1), at = left;
        }
        spine.make_leaf(at, -1);
        const double t = j.ask("nearest_hit", spine.numbers)[0];
        if (!(std::abs(t - 70) <= std::abs(found - 70))) found = t;
    }
    j.number("64 levels, on each of which a leaf waits", found, 70, 8 * j.epsilon);
    random_trees(j);
}

// ---- 1.6  Where to divide -----------------------------------------------------------------------

// A cube of this size at a place, as six numbers.
void add_box(Out& boxes, Triple lo, Triple size) { boxes = row(boxes, lo, lo + size); }

// Edges of the box about some of a row's boxes, each with its lower and upper corner.
Triple edges_about(In boxes, size_t from, size_t to) {
    Triple lo = triple(boxes, 6 * from), hi = triple(boxes, 6 * from + 3);
    for (size_t k = from; k < to; ++k)
        for (size_t a = 0; a < 3; ++a)
            lo[a] = std::min(lo[a], boxes[6 * k + a]),
            hi[a] = std::max(hi[a], boxes[6 * k + 3 + a]);
    return hi - lo;
}
double half_area(const Triple& e) { return e[0] * e[1] + e[1] * e[2] + e[2] * e[0]; }

// What costs of divisions may be in place of A_l n_l + A_r n_r, if all are the same thing.
std::string cause_of_costs(const std::vector<Out>& rows, const std::vector<Out>& came) {
    const auto edges = [](const Triple& e) { return e[0] + e[1] + e[2]; };
    using Measure = std::function<double(const Triple&)>;
    const auto sides = [](In boxes, size_t left, const Measure& m) {
        const size_t n = boxes.size() / 6;
        return double(left) * m(edges_about(boxes, 0, left)) +
               double(n - left) * m(edges_about(boxes, left, n));
    };
    const auto alone = [](In boxes, size_t left) {
        double sum[2] = {0, 0};
        const size_t n = boxes.size() / 6;
        for (size_t k = 0; k < n; ++k) sum[k >= left] += half_area(edges_about(boxes, k, k + 1));
        return double(left) * sum[0] + double(n - left) * sum[1];
    };
    const auto all = [](In boxes) { return half_area(edges_about(boxes, 0, boxes.size() / 6)); };
    const auto difference = [&](In boxes, size_t left) {
        const double l = half_area(edges_about(boxes, 0, left));
        const size_t n = boxes.size() / 6;
        return double(left) * l + double(n - left) * (all(boxes) - l);
    };
    const std::pair<const char*, std::function<double(In, size_t)>> causes[] = {
        {"so much it costs, but is every division tried?",
         [&](In b, size_t left) { return sides(b, left, half_area); }},
        {"looks like whole areas, where half areas belong",
         [&](In b, size_t left) { return 2 * sides(b, left, half_area); }},
        {"looks like a cost that is divided by the area about all boxes",
         [&](In b, size_t left) { return sides(b, left, half_area) / all(b); }},
        {"looks like the cost of a renderer that counts a node, too, and divides by the area about "
         "all boxes",
         [&](In b, size_t left) { return 0.125 + sides(b, left, half_area) / all(b); }},
        {"looks like lengths of edges in place of areas",
         [&](In b, size_t left) { return sides(b, left, edges); }},
        {"looks like sums of the boxes' own areas in place of the areas about them", alone},
        {"looks like an area on the right that is all the area less the left one", difference},
        {"looks like areas about the centres of boxes, not about the boxes",
         [&](In b, size_t left) {
             Out centres;
             for (size_t k = 0; 6 * k < b.size(); ++k)
                 add_box(centres, 0.5 * (triple(b, 6 * k) + triple(b, 6 * k + 3)), {});
             return sides(centres, left, half_area);
         }}};
    for (const auto& [cause, cost] : causes) {
        bool holds = true;
        for (size_t i = 0; holds && i < rows.size(); ++i) {
            const double left = came[i][1];
            holds = left >= 1 && left < double(rows[i].size() / 6) &&
                    near(came[i][0], cost(rows[i], size_t(left)), 1e-6);
        }
        if (holds) return std::string(": ") + cause;
    }
    return "";
}

// So many boxes in one place, and others in a place far away: cheapest is to part the two places.
void clusters(Judge& j) {
    int wrong = 0;
    std::string first;
    for (int i = 0; i < 200; ++i) {
        Out boxes;
        double cost = 0;
        const size_t n[] = {1 + size_t(9 * j.random()), 1 + size_t(9 * j.random())};
        for (size_t k : {0, 1}) {
            Triple lo = in_cube(j), size;
            lo[size_t(i % 3)] += 40 * double(k);
            for (double& x : size) x = between(j, 0.1, 2);
            for (size_t m = 0; m < n[k]; ++m) add_box(boxes, lo, size);
            cost += double(n[k]) * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
        }
        const Out d = j.ask("best_division", boxes);
        if (d[1] == double(n[0]) && std::abs(d[0] - cost) < 1024 * j.epsilon * cost) continue;
        if (wrong++ == 0)
            first =
                say("%zu boxes here and %zu far away: cost %.6g after %zu expected, %.6g after "
                    "%.0f came",
                    n[0], n[1], cost, n[0], d[0], d[1]);
    }
    j.exact("two heaps far from each other are parted, at the sum of their costs", wrong == 0,
            first);
}

// Any boxes, flat and alike ones among them: the cheapest of all divisions, tried one by one.
void any_boxes(Judge& j) {
    int wrong = 0, none = 0;
    std::string first;
    for (int i = 0; i < 300; ++i) {
        const size_t n = 2 + size_t(14 * j.random());
        Out boxes;
        for (size_t k = 0; k < n; ++k) {
            Triple lo = 4 * in_cube(j), size;
            for (double& x : size) x = j.random() < 0.1 ? 0 : between(j, 0, 2);
            if (i % 5 == 0 && k > 0) lo = triple(boxes), size = triple(boxes, 3) - lo;
            add_box(boxes, lo, size);
        }
        const auto area = [&](size_t from, size_t to) {
            return half_area(edges_about(boxes, from, to));
        };
        const auto cost = [&](size_t left) {
            return double(left) * area(0, left) + double(n - left) * area(left, n);
        };
        double best = endless;
        for (size_t left = 1; left < n; ++left) best = std::min(best, cost(left));
        const Out d = j.ask("best_division", boxes);
        const double off = 4096 * j.epsilon * best;
        const bool parts = d[1] >= 1 && d[1] < double(n);
        none += !parts;
        // Where two are equally cheap, rounding decides.
        if (parts && std::abs(d[0] - best) <= off && cost(size_t(d[1])) <= best + off) continue;
        if (wrong++ == 0)
            first = say("of %zu boxes the cheapest division costs %.6g, %.6g after %.0f came", n,
                        best, d[0], d[1]) +
                    cause_of_costs({boxes}, {d});
    }
    j.exact("300 rows of any boxes: the cheapest of all divisions", wrong == 0,
            first + say(" (%d are wrong)", wrong));
    j.none("both sides have boxes", size_t(none), "one side of %zu of 300 divisions has none");
}

// By a sweep from each end, eight times as many boxes take some eight times as long, not 64 times.
// A machine that is busy with other things may spoil one comparison, not all.
void two_sweeps(Judge& j) {
    const auto seconds = [&](size_t n) {
        Out boxes;
        for (size_t i = 0; i < n; ++i)
            add_box(boxes, {double(i), j.random(), j.random()}, {1, j.random(), j.random()});
        const auto start = std::chrono::steady_clock::now();
        j.ask("best_division", boxes);
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    double least = endless;
    for (int i = 0; i < 9 && least > 24; ++i) {
        const double few = seconds(1000);
        least = std::min(least, seconds(8000) / few);
    }
    j.exact(
        "eight times as many boxes take not much more than eight times as long", least <= 24,
        say("%.0f times as long: is the box about one side made anew for every division?", least));
    j.limit();
}

void division(Judge& j) {
    // Lower and upper corners of boxes.
    const struct {
        std::string what;
        double cost, left;
        const char* boxes;
    } worked[] = {
        {"two boxes are parted, at the sum of their areas", 8, 1, "0 0 0  1 1 1  2 0 0  4 1 1"},
        {"four in a row and a distant fifth: the fifth is alone", 39, 4,
         "0 0 0  1 1 1  1 0 0  2 1 1  2 0 0  3 1 1  3 0 0  4 1 1  9 0 0  10 1 1"},
        {"a distant first one is alone", 39, 1,
         "0 0 0  1 1 1  7 0 0  8 1 1  8 0 0  9 1 1  9 0 0  10 1 1  10 0 0  11 1 1"},
        {"a large one among small ones is alone", 524, 1,
         "0 0 0  8 8 8  5 5 5  6 6 6  6 2 1  7 3 2  7 1 6  8 2 8  8 4 4  9 5 5"},
        {"boxes of all sizes, some of them flat", 210, 3,
         "0 0 0  4 4 0  1 1 1  3 3 1  0 0 2  1 1 3  2 3 3  3 5 4  0 0 5  5 5 5"},
        {"boxes that overlap", 334, 3,
         "0 3 1  2 4 2  1 0 0  2 2 6  3 1 1  4 2 2  4 4 4  7 7 5  6 0 0  7 1 1"}};
    std::vector<Out> rows, came;
    for (const auto& w : worked) {
        Out boxes;
        std::istringstream words(w.boxes);
        for (double x; words >> x;) boxes.push_back(x);
        const Rows d = j.probe("best_division", Rows(boxes));
        j.exact(w.what, std::abs(d[0][0] - w.cost) < 64 * j.epsilon * w.cost && d[0][1] == w.left,
                say("a cost of %g after %g boxes expected, %g after %g came", w.cost, w.left,
                    d[0][0], d[0][1]));
        rows.push_back(boxes), came.push_back({d[0][0], d[0][1]});
    }
    const std::string cause = cause_of_costs(rows, came);
    for (Item& i : j.items) i.seen += cause;
    any_boxes(j);
    clusters(j);
    two_sweeps(j);
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv,
                         {{"1.1", camera},
                          {"1.2", sphere},
                          {"1.3", triangle},
                          {"1.4", box},
                          {"1.5", tree},
                          {"1.6", division}});
}

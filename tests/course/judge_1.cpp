// course/judge_1.cpp  judges week 1: intersections and the tree
#include "course/judge.h"

using course::In, course::Judge, course::Out, course::Rows;
using oracle::say, oracle::Triple;

namespace {

// ---- Vectors ------------------------------------------------------------------------------------

Triple operator+(Triple a, Triple b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Triple operator-(Triple a, Triple b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Triple operator*(double s, Triple a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(Triple a, Triple b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Triple cross(Triple a, Triple b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Triple unit(Triple a) { return 1 / std::sqrt(dot(a, a)) * a; }

double between(Judge& j, double low, double high) { return low + (high - low) * j.random(); }

Triple in_cube(Judge& j) {
    Triple p;
    for (double& x : p) x = between(j, -1, 1);
    return p;
}
Triple direction(Judge& j) {
    for (;;) {
        const Triple p = in_cube(j);
        if (dot(p, p) > 0.01 && dot(p, p) < 1) return unit(p);
    }
}
// A direction at an angle to the normal whose cosine is at least 0.2 in size.
Triple slanted(Judge& j, Triple n) {
    for (;;) {
        const Triple d = direction(j);
        if (std::abs(dot(d, n)) > 0.2) return d;
    }
}

constexpr double endless = oracle::infinity;

Out row(std::initializer_list<Triple> ray, double tmax, std::initializer_list<Triple> rest) {
    Out numbers;
    for (const Triple& v : ray) numbers.insert(numbers.end(), v.begin(), v.end());
    numbers.push_back(tmax);
    for (const Triple& v : rest) numbers.insert(numbers.end(), v.begin(), v.end());
    return numbers;
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
    void judge(Judge& j, const std::string& what, int of) const {
        j.exact(what, wrong == 0, first + (of > 1 ? say(" (%d of %d are wrong)", wrong, of) : ""));
    }
};

// One row of a probe, which has a distance as its answer.
void expect(Judge& j, const std::string& what, const Rows& came, size_t i, double expected,
            const std::string& where) {
    Distances d;
    d.see(came[i], expected, 16 * j.epsilon * std::max(1.0, expected), where);
    d.judge(j, what, 1);
}

// ---- 1.1  The camera ----------------------------------------------------------------------------

void camera(Judge& j) {
    // 90 degrees high, looking along -z: at a distance of 1 the image reaches from -1 to 1.
    auto see = [](double w, double h, double x, double y) {
        return Out{0, 0, 0, 0, 0, -1, 90, w, h, x, y};
    };
    const Rows d = j.probe("camera_ray", {see(64, 32, 32, 16), see(64, 32, 32, 0),
                                          see(64, 32, 64, 16), see(32, 64, 8, 48)});
    const double e = 16 * j.epsilon, third = 1 / std::sqrt(3.0);
    auto points_to = [&](const std::string& what, size_t i, Triple to) {
        const In came = d[i].subspan(3);
        const Triple u = unit(to);
        const bool right = std::abs(came[0] - u[0]) < e && std::abs(came[1] - u[1]) < e &&
                           std::abs(came[2] - u[2]) < e;
        j.exact(what, right,
                say("(%.6g, %.6g, %.6g) expected, (%.6g, %.6g, %.6g) came", u[0], u[1], u[2],
                    came[0], came[1], came[2]));
    };
    points_to("the middle of the image is straight ahead", 0, {0, 0, -1});
    points_to("90 degrees of view: the middle of the upper edge is 45 degrees up", 1, {0, 1, -1});
    points_to("an image twice as wide sees twice as far to the right", 2, {2, 0, -1});
    points_to("a quarter from the left, a quarter from below, upright", 3, {-0.25, -0.5, -1});
    // Any camera: unit directions from the eye, and places of the image plane are evenly spaced.
    double off_unit = 0, off_eye = 0, off_even = 0, off_view = 0;
    for (int i = 0; i < 100; ++i) {
        const Triple eye = 3 * in_cube(j), ahead = slanted(j, {third, 0, third});
        const Triple target = eye + between(j, 1, 5) * ahead;
        const double fov = between(j, 20, 100), w = 16 + std::floor(100 * j.random());
        const double h = 16 + std::floor(100 * j.random());
        const double x = between(j, 0, w), y = between(j, 0, h);
        auto at = [&](double px, double py) {
            return Out{eye[0], eye[1], eye[2], target[0], target[1], target[2], fov, w, h, px, py};
        };
        const Rows rays = j.ask("camera_ray", {at(0, 0), at(x, y), at(x / 2, y / 2), at(w / 2, 0)});
        Triple plane[4];
        for (size_t k = 0; k < 4; ++k) {
            const In r = rays[k];
            const Triple o{r[0], r[1], r[2]}, dir{r[3], r[4], r[5]};
            off_unit = course::worse(off_unit, std::abs(dot(dir, dir) - 1));
            off_eye = course::worse(off_eye, std::sqrt(dot(o - eye, o - eye)));
            plane[k] = 1 / dot(dir, ahead) * dir;
        }
        const Triple bend = plane[2] - 0.5 * (plane[0] + plane[1]);
        off_even = course::worse(off_even, std::sqrt(dot(bend, bend)));
        const Triple up = plane[3] - ahead;
        const double angle = std::atan(std::sqrt(dot(up, up))) * 360 / oracle::pi;
        off_view = course::worse(off_view, std::abs(angle - fov) / fov);
    }
    j.exact("directions have length 1", off_unit < 32 * j.epsilon, say("off by %.3g", off_unit));
    j.exact("rays start at the eye", off_eye < 16 * j.epsilon, say("off by %.3g", off_eye));
    j.exact("steps on the image plane are even, so that straight lines stay straight",
            off_even < 4096 * j.epsilon, say("off by %.3g", off_even));
    j.exact("the field of view is the one that was asked for", off_view < 4096 * j.epsilon,
            say("off by %.3g of it", off_view));
}

// ---- 1.2  Spheres -------------------------------------------------------------------------------

Out at_sphere(Triple o, Triple d, double tmax, Triple centre, double r) {
    Out x = row({o, d}, tmax, {centre});
    x.push_back(r);
    return x;
}

// Rays to points that face them, at known distances; and rays past the sphere.
void random_spheres(Judge& j) {
    const int n = 1000;
    Rows hits, misses;
    Out distance;
    for (int i = 0; i < n; ++i) {
        const Triple centre = 2 * in_cube(j);
        const double r = between(j, 0.5, 2), t = between(j, 0.1, 5);
        const Triple normal = direction(j);
        Triple d = slanted(j, normal);
        if (dot(d, normal) > 0) d = -1.0 * d;
        hits.add(at_sphere(centre + r * normal - t * d, d, endless, centre, r));
        distance.push_back(t);
        const Triple aside = unit(cross(normal, d));
        misses.add(at_sphere(centre + between(j, 1.01, 2) * r * aside - between(j, -5, 5) * d, d,
                             endless, centre, r));
    }
    const Rows hit = j.ask("intersect_sphere", hits), missed = j.ask("intersect_sphere", misses);
    Distances of_hits, of_misses;
    for (size_t i = 0; i < n; ++i) {
        // b^2 - c loses some 3 b^2 <= 150 ulp, which the root divides by 2 x 0.2 x 0.5.
        of_hits.see(hit[i], distance[i], 1024 * j.epsilon, "a sphere whose near side was aimed at");
        of_misses.see(missed[i], -1, 0, "a ray past a sphere");
    }
    of_hits.judge(j, "1000 spheres are hit where their near side was aimed at", n);
    of_misses.judge(j, "rays past 1000 spheres miss them", n);
}

void far_spheres(Judge& j) {
    // A unit sphere so far away that its size is lost beside the square of the distance.
    const double far = j.epsilon > 0x1p-50 ? 0x1p9 : 0x1p20;
    Rows rays;
    Out distance;
    for (double x : {0.0, 0.25, 0.5, 0.75, 1.5, 3.0})
        for (double z : {far, 0x1p30}) {
            rays.add(at_sphere({x, 0, z}, {0, 0, -1}, endless, {0, 0, 0}, 1));
            distance.push_back(x < 1 ? z - std::sqrt(1 - x * x) : -1);
        }
    const Rows came = j.ask("intersect_sphere", rays);
    Distances d;
    for (size_t i = 0; i < came.size(); ++i)
        d.see(came[i], distance[i], 16 * j.epsilon * rays[i][2], say("from %.6g away", rays[i][2]));
    d.judge(j, "from far away a sphere is as large as from nearby", int(came.size()));
}

void sphere(Judge& j) {
    const Triple c{1, 2, 3}, z{0, 0, 1}, back{0, 0, -1};
    const double tiny = 0x1p-24;
    const Rows t = j.probe(
        "intersect_sphere",
        {at_sphere({1, 2, 10}, back, endless, c, 2), at_sphere({1, 3.5, 10}, back, endless, c, 2.5),
         at_sphere({1, 5, 10}, back, endless, c, 2.5), at_sphere({1, 2, 4}, back, endless, c, 2),
         at_sphere({1, 2, 10}, z, endless, c, 2), at_sphere({1, 2, 10}, back, 4.5, c, 2),
         at_sphere({1, 2, 10}, back, 7, c, 2), at_sphere({1, 2, 4}, back, 2.5, c, 2),
         at_sphere({0, 0, 3 * tiny}, back, endless, {0, 0, 0}, tiny),
         at_sphere({2, 0, 0x1p30}, back, endless, {0, 0, 0}, 1)});
    expect(j, "a sphere of radius 2, 7 away: its near side is 5 away", t, 0, 5, "straight ahead");
    expect(j, "one of radius 2.5, passed at 1.5 from its centre, is 5 away", t, 1, 5, "off centre");
    expect(j, "passed at 3 it is missed", t, 2, -1, "beside");
    expect(j, "from its inside the far side is seen", t, 3, 3, "from inside");
    expect(j, "a sphere behind the origin is not seen", t, 4, -1, "behind");
    Distances end;
    end.see(t[5], -1, 0, "near side beyond tmax");
    end.see(t[6], 5, 16 * j.epsilon, "far side beyond tmax");
    end.see(t[7], -1, 0, "from inside, far side beyond tmax");
    end.judge(j, "the ray ends at tmax", 3);
    expect(j, "tiny spheres are seen from nearby", t, 8, 2 * tiny, "scaled by 2^-24");
    random_spheres(j);
    far_spheres(j);
}

// ---- 1.3  Triangles -----------------------------------------------------------------------------

Out at_triangle(Triple o, Triple d, double tmax, Triple a, Triple b, Triple c) {
    return row({o, d}, tmax, {a, b, c});
}

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
    std::vector<Triple> expected;  // t, v, w
    for (size_t i = 0; i < n; ++i) {
        const auto [a, b, c] = any_triangle(j);
        const Triple d = slanted(j, unit(cross(b - a, c - a)));
        double v = between(j, 0.01, 0.98), w = between(j, 0.01, 0.98), t = between(j, 0.1, 5);
        if (v + w > 0.99) v = 0.99 - v, w = 0.99 - w;
        if (v < 0.01 || w < 0.01) v = w = 0.2;
        hits.add(at_triangle(a + v * (b - a) + w * (c - a) - t * d, d, endless, a, b, c));
        expected.push_back({t, v, w});
        // Beyond one of the edges, at a time.
        const double along = between(j, 0.1, 0.9), out = between(j, 0.01, 1);
        const Triple p = i % 3 == 0   ? a + along * (b - a) - out * (c - a)
                         : i % 3 == 1 ? a + along * (c - a) - out * (b - a)
                                      : b + along * (c - b) + out * (b - a);
        misses.add(at_triangle(p - t * d, d, endless, a, b, c));
    }
    const Rows hit = j.ask("intersect_triangle", hits);
    const Rows missed = j.ask("intersect_triangle", misses);
    Distances of_hits, of_misses;
    double off = 0;
    for (size_t i = 0; i < n; ++i) {
        of_hits.see(hit[i], expected[i][0], 4096 * j.epsilon, "a triangle");
        if (hit[i][0] != 0)
            for (size_t k : {1, 2})
                off = course::worse(off, std::abs(hit[i][1 + k] - expected[i][k]));
        of_misses.see(missed[i], -1, 0, "a ray past an edge of a triangle");
    }
    of_hits.judge(j, "1000 triangles are hit where they were aimed at", int(n));
    j.exact("v and w say where: (1-v-w) a + v b + w c", off < 4096 * j.epsilon,
            say("off by %.3g", off));
    of_misses.judge(j, "rays past an edge of 1000 triangles miss them", int(n));
}

// Rays through the edge that two triangles share, seen from either side and at any angle.
void shared_edges(Judge& j) {
    const size_t n = 50000;
    Rows left, right;
    for (size_t i = 0; i < n; ++i) {
        const auto [a, b, c] = any_triangle(j);
        const Triple opposite = a + (b - c) + 0.1 * in_cube(j),
                     d = slanted(j, unit(cross(b - a, c - a)));
        const Triple other = slanted(j, unit(cross(b - a, opposite - a)));
        const Triple o =
            a + between(j, 0.05, 0.95) * (b - a) - between(j, 0.5, 5) * (i % 2 ? d : other);
        const Triple aim = i % 2 ? d : other;
        // Both must be seen from the same side: then they lie on both sides of the edge.
        const double front = dot(aim, cross(b - a, c - a)),
                     back = dot(aim, cross(opposite - a, b - a));
        if (front * back <= 0) continue;
        left.add(at_triangle(o, aim, endless, a, b, c));
        right.add(at_triangle(o, aim, endless, b, a, opposite));
    }
    // Where nothing is rounded, the ray is on the edge itself.
    for (double x : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        left.add(at_triangle({x, 0, 2}, {0, 0, -1}, endless, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
        right.add(at_triangle({x, 0, 2}, {0, 0, -1}, endless, {1, 0, 0}, {0, 0, 0}, {1, -1, 0}));
    }
    const Rows first = j.ask("intersect_triangle", left),
               second = j.ask("intersect_triangle", right);
    int leaks = 0;
    for (size_t i = 0; i < first.size(); ++i) leaks += !(first[i][0] > 0 || second[i][0] > 0);
    j.exact("no ray passes between triangles that share an edge", leaks == 0,
            say("%d of %zu pass", leaks, first.size()));
}

void triangle(Judge& j) {
    const Triple a{0, 0, 0}, b{4, 0, 0}, c{0, 2, 0}, back{0, 0, -1}, z{0, 0, 1};
    const double tiny = 0x1p-24;
    const Rows t = j.probe(
        "intersect_triangle",
        {at_triangle({1, 1, 5}, back, endless, a, b, c),
         at_triangle({1, 1, -5}, z, endless, a, b, c),
         at_triangle({3, 1, 5}, back, endless, a, b, c),
         at_triangle({1, 1, 5}, z, endless, a, b, c), at_triangle({1, 1, 5}, back, 4.5, a, b, c),
         at_triangle({2, 0, 5}, back, endless, a, b, c),
         at_triangle({tiny, tiny / 2, 1}, back, endless, a, tiny * b, tiny * c),
         at_triangle({1, 1, tiny}, back, endless, a, b, c),
         at_triangle({2, -0.5, 5}, back, endless, a, b, c)});
    expect(j, "from 5 above: 5 away", t, 0, 5, "above (1, 1, 0)");
    j.exact("there v = 1/4 and w = 1/2",
            std::abs(t[0][2] - 0.25) + std::abs(t[0][3] - 0.5) < 16 * j.epsilon,
            say("v = %.6g, w = %.6g", t[0][2], t[0][3]));
    expect(j, "from below: its back is hit, too", t, 1, 5, "below (1, 1, 0)");
    Distances outside;
    outside.see(t[2], -1, 0, "beyond the edge from b to c");
    outside.see(t[8], -1, 0, "beyond the edge from a to b");
    outside.judge(j, "beside it: missed", 2);
    expect(j, "behind the origin: not hit", t, 3, -1, "behind");
    expect(j, "beyond the end of the ray: not hit", t, 4, -1, "tmax = 4.5, 5 away");
    Distances small;
    small.see(t[6], 1, 16 * j.epsilon, "scaled by 2^-24, from 1 away");
    small.see(t[7], tiny, 16 * j.epsilon * tiny, "from 2^-24 away");
    small.judge(j, "no triangle is too small, and none too near", 2);
    random_triangles(j);
    shared_edges(j);
}

// ---- 1.4  Boxes ---------------------------------------------------------------------------------

Out at_box(Triple o, Triple d, double tmax, Triple lo, Triple hi) {
    return row({o, d}, tmax, {lo, hi});
}

// Points of a face that a ray enters by, at known distances; and rays past an edge.
void random_boxes(Judge& j) {
    const size_t n = 1000;
    Rows hits, misses;
    Out distance;
    for (size_t i = 0; i < n; ++i) {
        const Triple middle = 2 * in_cube(j);
        Triple half, p = middle;
        for (size_t k = 0; k < 3; ++k) {
            half[k] = between(j, 0.1, 1);
            p[k] += between(j, -0.99, 0.99) * half[k];
        }
        const size_t face = i % 3, other = (face + 1) % 3;
        Triple normal{};
        const double side = i % 2 ? 1 : -1, t = between(j, 0.1, 5);
        normal[face] = side;
        p[face] = middle[face] + side * half[face];
        Triple d = slanted(j, normal);
        if (dot(d, normal) > 0) d = -1.0 * d;
        hits.add(at_box(p - t * d, d, endless, middle - half, middle + half));
        distance.push_back(t);
        // Within a plane that has all of the box on one side.
        Triple corner = middle, away{}, along = direction(j);
        corner[face] += side * half[face], corner[other] -= side * half[other];
        away[face] = side * between(j, 0.3, 1), away[other] = -side * between(j, 0.3, 1);
        along = unit(cross(away, along));
        misses.add(at_box(corner + between(j, 0.02, 1) * away - between(j, -5, 5) * along, along,
                          endless, middle - half, middle + half));
    }
    const Rows hit = j.ask("enter_box", hits), missed = j.ask("enter_box", misses);
    Distances of_hits, of_misses;
    for (size_t i = 0; i < n; ++i) {
        of_hits.see(hit[i], distance[i], 1024 * j.epsilon, "a face that was aimed at");
        of_misses.see(missed[i], -1, 0, "a ray past an edge");
    }
    of_hits.judge(j, "1000 boxes are entered where they were aimed at", int(n));
    of_misses.judge(j, "rays past an edge of 1000 boxes miss them", int(n));
}

void box(Judge& j) {
    const Triple lo{2, -1, -3}, hi{5, 1, 3}, x{1, 0, 0}, left{-1, 0, 0}, o{0, 0, 0};
    const Triple d{0.6, 0, 0.8}, minus_zero{1, -0.0, -0.0}, steep{0.6, 0.8, 0};
    const Rows t = j.probe(
        "enter_box",
        {at_box(o, x, endless, lo, hi), at_box({9, 0, 0}, left, endless, lo, hi),
         at_box({0, 0, -1}, d, endless, lo, hi), at_box({3, 0.5, 1}, d, endless, lo, hi),
         at_box({9, 0, 0}, x, endless, lo, hi), at_box(o, x, 1.5, lo, hi), at_box(o, x, 3, lo, hi),
         at_box({0, 2, 0}, minus_zero, endless, lo, hi), at_box(o, minus_zero, endless, lo, hi),
         at_box(o, steep, endless, lo, hi), at_box({0, 0, 4}, x, endless, lo, hi)});
    expect(j, "along x, a box that begins at x = 2 is 2 away", t, 0, 2, "from the origin along x");
    expect(j, "backwards along x, from x = 9, one that ends at x = 5 is 4 away", t, 1, 4,
           "along -x");
    Distances slanted_rays;
    slanted_rays.see(t[2], 10.0 / 3, 32 * j.epsilon, "along (0.6, 0, 0.8)");
    slanted_rays.see(t[9], -1, 0, "along (0.6, 0.8, 0), above it");
    slanted_rays.see(t[10], -1, 0, "along x at z = 4, beside it");
    slanted_rays.judge(j, "slanted rays enter at 10/3, or pass above or beside", 3);
    expect(j, "a ray that starts inside is in it at once", t, 3, 0, "from inside");
    expect(j, "a box behind the origin is not met", t, 4, -1, "behind");
    Distances end;
    end.see(t[5], -1, 0, "tmax = 1.5, 2 away");
    end.see(t[6], 2, 16 * j.epsilon, "tmax = 3, within the box");
    end.judge(j, "the ray ends at tmax", 2);
    Distances parallel;
    parallel.see(t[7], -1, 0, "along x at y = 2, above it; d.y = -0");
    parallel.see(t[8], 2, 16 * j.epsilon, "along x; d.y = -0");
    parallel.judge(j, "where the direction is 0 the ray is between two planes, or never", 2);
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
        Table t;
        grow(j, t, 0, 8);
        double best = endless, before = 0;
        for (size_t k = 0; k < t.nodes; ++k)
            if (t.is_leaf(k) && t.hit(k) >= 0) best = std::min(best, t.hit(k));
        for (size_t k = 0; k < t.nodes; ++k)
            before += t.is_leaf(k) && t.enter(k) >= 0 && t.enter(k) <= best;
        trees.add(t.numbers);
        nearest.push_back(best < endless ? best : -1), needed.push_back(before);
    }
    const Rows came = j.ask("nearest_hit", trees);
    double boxes = 0, leaves = 0, least = 0;
    int wrong = 0;
    for (size_t i = 0; i < n; ++i) {
        wrong += std::abs(came[i][0] - nearest[i]) > 8 * j.epsilon * nearest[i] + 8 * j.epsilon;
        boxes += came[i][2] / n, leaves += came[i][3] / n, least += needed[i] / n;
    }
    j.exact("in 600 trees of 256 leaves the nearest hit is found", wrong == 0,
            say("%d of 600 are wrong", wrong));
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
    // At every level a leaf has to wait.
    Table spine;
    size_t at = 0;
    for (int level = 0; level < 64; ++level) {
        const size_t left = spine.divide(at, level, level + 0.5);
        spine.make_leaf(left + 1, level == 0 ? 70.0 : -1), at = left;
    }
    spine.make_leaf(at, -1);
    j.number("64 levels, on each of which a leaf waits", j.ask("nearest_hit", spine.numbers)[0], 70,
             8 * j.epsilon);
    random_trees(j);
}

// ---- 1.6  Where to divide -----------------------------------------------------------------------

// A cube of this size at a place, as six numbers.
void add_box(Out& boxes, Triple lo, Triple size) {
    const Triple hi = lo + size;
    boxes.insert(boxes.end(), lo.begin(), lo.end());
    boxes.insert(boxes.end(), hi.begin(), hi.end());
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

// What changes nothing: the row from its other end, and all boxes moved.
void alike(Judge& j) {
    int ends = 0, moved = 0;
    for (int i = 0; i < 200; ++i) {
        const size_t n = 2 + size_t(14 * j.random());
        std::vector<Triple> lo, size;
        for (size_t k = 0; k < n; ++k) {
            lo.push_back(4 * in_cube(j));
            size.push_back({between(j, 0, 2), between(j, 0, 2), between(j, 0, 2)});
        }
        Out row, reversed, elsewhere;
        for (size_t k = 0; k < n; ++k) {
            add_box(row, lo[k], size[k]);
            add_box(reversed, lo[n - 1 - k], size[n - 1 - k]);
            add_box(elsewhere, lo[k] + Triple{8, -8, 4}, size[k]);
        }
        const Out d = j.ask("best_division", row), r = j.ask("best_division", reversed);
        const Out e = j.ask("best_division", elsewhere);
        const double off = 4096 * j.epsilon * d[0];
        // Where two are equally cheap, rounding decides.
        ends += !(std::abs(d[0] - r[0]) <= off && d[1] >= 1 && d[1] < double(n));
        moved += !(std::abs(d[0] - e[0]) <= off);
    }
    j.exact("a row of boxes costs the same from its other end", ends == 0,
            say("%d of 200 do not", ends));
    j.exact("a row of boxes costs the same elsewhere", moved == 0, say("%d of 200 do not", moved));
}

void division(Judge& j) {
    struct Worked {
        std::string what;
        double cost, left;
        Out boxes;
    };
    const Worked rows[] = {
        {"two boxes are parted, at the sum of their areas",
         8,
         1,
         {0, 0, 0, 1, 1, 1, 2, 0, 0, 4, 1, 1}},
        {"four in a row and a distant fifth: the fifth is alone", 39, 4, {0, 0, 0, 1,  1, 1, 1, 0,
                                                                          0, 2, 1, 1,  2, 0, 0, 3,
                                                                          1, 1, 3, 0,  0, 4, 1, 1,
                                                                          9, 0, 0, 10, 1, 1}},
        {"a distant first one is alone", 39, 1, {0, 0, 0, 1, 1, 1, 7,  0, 0, 8,  1, 1, 8,  0, 0,
                                                 9, 1, 1, 9, 0, 0, 10, 1, 1, 10, 0, 0, 11, 1, 1}},
        {"a large one among small ones is alone", 524, 1, {0, 0, 0, 8, 8, 8, 5, 5, 5, 6,
                                                           6, 6, 6, 2, 1, 7, 3, 2, 7, 1,
                                                           6, 8, 2, 8, 8, 4, 4, 9, 5, 5}},
        {"boxes of all sizes, some of them flat", 210, 3, {0, 0, 0, 4, 4, 0, 1, 1, 1, 3,
                                                           3, 1, 0, 0, 2, 1, 1, 3, 2, 3,
                                                           3, 3, 5, 4, 0, 0, 5, 5, 5, 5}},
        {"boxes that overlap", 334, 3, {0, 3, 1, 2, 4, 2, 1, 0, 0, 2, 2, 6, 3, 1, 1,
                                        4, 2, 2, 4, 4, 4, 7, 7, 5, 6, 0, 0, 7, 1, 1}}};
    for (const Worked& w : rows) {
        const Rows d = j.probe("best_division", Rows(w.boxes));
        j.exact(w.what, std::abs(d[0][0] - w.cost) < 64 * j.epsilon * w.cost && d[0][1] == w.left,
                say("a cost of %g after %g boxes expected, %g after %g came", w.cost, w.left,
                    d[0][0], d[0][1]));
    }
    clusters(j);
    alike(j);
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

// whole/known_scenes.h  scenes of known radiance
//
// L is radiance, rho an albedo; a diffuse receiver shows L = rho E / pi.
#pragma once
#include <functional>
#include <string>

#include "base/closed_forms.h"
#include "text/words.h"
#include "world/shapes.h"

namespace penumbra::closed_forms {

inline std::string words(std::initializer_list<double> numbers) {
    std::string text;
    for (double x : numbers) text += oracle::say(" %.17g", x);
    return text;
}
inline std::string words(Point p) { return words({p.x, p.y, p.z}); }

inline std::string sphere(Point centre, double r, const char* material) {
    std::string text = "sphere";
    return text + words(centre) + words({r}) + " " + material + "\n";
}
// A sphere about the origin, seen from within, with different materials in its lower and upper
// halves.  It consists of two spheres, `apart` times the radius apart; each is the nearer one on
// its side.  Geometry and radiance are those of the sphere up to that fraction.
inline std::string two_halves(double r, const char* lower, const char* upper) {
    const double apart = sizeof(real) == 4 ? 1e-3 : 1e-5;
    return sphere({0, apart * r / 2, 0}, r, lower) + sphere({0, -apart * r / 2, 0}, r, upper);
}
inline std::string quad(Point corner, Point u, Point v, const char* material) {
    std::string text = "quad";
    return text + words(corner) + words(u) + words(v) + " " + material + "\n";
}
inline std::string triangle(Point a, Point b, Point c, const char* material) {
    std::string text = "triangle";
    return text + words(a) + words(b) + words(c) + " " + material + "\n";
}

// A regular polygon with the area of a disc about (x, y, 0), in a plane y = const, facing down.
inline std::vector<Point> disc_corners(double x, double y, double r) {
    constexpr int n = 64;
    const double angle = 2 * Pi / n, R = r * std::sqrt(angle / std::sin(angle));
    std::vector<Point> corners;
    for (int i = 0; i < n; ++i)
        corners.push_back({x + R * std::cos(i * angle), y, R * std::sin(i * angle)});
    return corners;
}
inline std::string disc(double x, double y, double r, const char* material) {
    const std::vector<Point> c = disc_corners(x, y, r);
    std::string text;
    for (size_t i = 0; i < c.size(); ++i)
        text += triangle({x, y, 0}, c[i], c[(i + 1) % c.size()], material);
    return text;
}

// A small patch of albedo 0.8 at the origin, facing +y, and one pixel that sees its middle.
inline const char* const receiver = R"(
size 1 1
camera -0.05 0.1 0.03  0 0 0  0.0001
depth 1
diffuse grey 0.8 0.8 0.8
diffuse black 0 0 0
light lamp 1 1 1
light both 1 1 1 twosided
light strong 9 8 7
light bright 4 4 4
quad -0.04 0 -0.05  0 0 0.1  0.1 0 0  grey
)";

// A point seen from the origin at an angle of `degrees` to the receiver's normal.
inline Point at_angle(double degrees, double distance) {
    const double angle = degrees * Pi / 180;
    return {distance * std::sin(angle), distance * std::cos(angle), 0};
}

using Start = std::function<Ray(vec2)>;

// A ray that hits the surface point p at a right angle, on the side of the unit vector n.
inline Ray onto(Point p, Point n) {
    const Point o = p + 1e-3 * n;
    return {{real(o.x), real(o.y), real(o.z)}, unit(vec3{real(-n.x), real(-n.y), real(-n.z)})};
}
inline Point on_sphere(double u, double v) {
    const double z = 1 - 2 * u, r = std::sqrt(4 * u * (1 - u));
    return {r * std::cos(2 * Pi * v), r * std::sin(2 * Pi * v), z};
}

// Uniform over the walls of a box with a corner at the origin and over a sphere (r may be 0).
inline Start on_walls(Point box, Point centre, double r) {
    return [=](vec2 u) {
        const double xy = box.x * box.y, yz = box.y * box.z, zx = box.z * box.x;
        double place = double(u.x) * (2 * (xy + yz + zx) + 4 * Pi * r * r);
        const double v = double(u.y);
        const struct {
            double area;
            Point corner, a, b;
        } walls[] = {{xy, {0, 0, 0}, {box.x, 0, 0}, {0, box.y, 0}},
                     {yz, {0, 0, 0}, {0, box.y, 0}, {0, 0, box.z}},
                     {zx, {0, 0, 0}, {0, 0, box.z}, {box.x, 0, 0}},
                     {xy, {0, 0, box.z}, {0, box.y, 0}, {box.x, 0, 0}},
                     {yz, {box.x, 0, 0}, {0, 0, box.z}, {0, box.y, 0}},
                     {zx, {0, box.y, 0}, {box.x, 0, 0}, {0, 0, box.z}}};
        for (const auto& w : walls) {
            if (place < w.area)
                return onto(w.corner + (place / w.area) * w.a + v * w.b,
                            (1 / w.area) * turned(w.a, w.b));
            place -= w.area;
        }
        const Point n = on_sphere(std::min(1.0, place / (4 * Pi * r * r)), v);
        return onto(centre + r * n, n);
    };
}

// Reasons why a cell of the matrix is empty.
inline const char* const never_hit = "a point light is never hit";
inline const char* const meeting = "infinite variance of light samples where emitting walls meet";
inline const char* const rare = "fewer than one path in a hundred finds the light";
inline const char* const idle = "roulette after the last scattering that counts changes nothing";
inline const char* const unscattered = "no scattering: nothing but the sampler matters";

struct Known {
    const char* name;
    std::string text;
    double truth;                   // mean of the channels
    Start start;                    // of rays; empty: the camera's
    int aimed, chance;              // samples in units of 4096; chance: of --light none
    const char* no_none = nullptr;  // reasons not to run --light none, nee
    const char* no_nee = nullptr;
};

inline std::vector<Known> known_scenes() {
    std::vector<Known> rows;
    auto add = [&](const Known& k) -> Known& { return rows.emplace_back(k); };
    const Start none = nullptr;
    // The patch under these lights, with the irradiance E.
    auto lit = [&](const char* name, const std::string& lights, double E, int aimed,
                   int chance) -> Known& {
        return add({name, receiver + lights, 0.8 / Pi * E, none, aimed, chance});
    };

    // Furnace: radiance Le + rho L everywhere; a convex body shows rho L of its surroundings.
    const std::string furnace = R"(
size 1 1
camera 0 0.3 1.8  0 0 0  60
diffuse half 0.5 0.5 0.5
light glow  0.4 0.4 0.4 twosided half
box 4 3 4  0  -2 -1.5 -2   glow
sphere -0.7 0 0  0.5  glow
)";
    add({"furnace, depth 0", furnace + "depth 0\n", 0.4, none, 0, 1});
    add({"furnace, depth 1", furnace + "depth 1\n", 0.4 * geometric(0.5, 2), none, 1, 1}).no_nee =
        meeting;
    add({"furnace, depth 8", furnace + "depth 8\n", 0.4 * geometric(0.5, 9), none, 2, 2}).no_nee =
        meeting;
    const std::string bright_room = R"(
size 1 1
camera 0.2 0.3 1.6  0 0 0  15
depth 1
diffuse grey 0.8 0.7 0.6
light glow  0.5 0.5 0.5 twosided
box 4 3 4  0  -2 -1.5 -2   glow
sphere 0 0 0  0.5  grey
)";
    add({"ball in a bright room", bright_room, 0.7 * 0.5, none, 6, 1});

    // Closed room of any shape: the area mean of E after k bounces is rho^k Phi / A.
    const std::string room =
        "camera 1 1 1  0 0 0  40\ndepth 3\ndiffuse wall 0.7 0.7 0.7\n"
        "light lamp 5 4 3 wall\nbox 2 3 1.5  0  0 0 0  wall\n";
    const double walls = 2 * (2 * 3 + 3 * 1.5 + 1.5 * 2), lamp = 4 * Pi * 0.4 * 0.4;
    add({"closed room, point light", room + "pointlight 0.5 2.2 1.1  3 2 1\n",
         0.7 / Pi * (4 * Pi * 2 / walls) * geometric(0.7, 3), on_walls({2, 3, 1.5}, {}, 0), 4, 0})
        .no_none = never_hit;
    add({"closed room, ball light", room + sphere({0.6, 2.2, 0.9}, 0.4, "lamp"),
         4 * lamp / (walls + lamp) * geometric(0.7, 4), on_walls({2, 3, 1.5}, {0.6, 2.2, 0.9}, 0.4),
         4, 4});

    // Integrating sphere: E(x) = E0(x) + mean(rho E0) (1 + mean(rho) + ...).  The light, I = 3, is
    // h above the plane that divides the albedos.  The flux of a cone goes down through this plane.
    const double R = 2, h = 1.2, up = 0.8, low = 0.3;
    const Point x{0.48 * R, 0.6 * R, 0.64 * R}, to_light = Point{0, h, 0} - x;
    const double d = size_of(to_light), cosine = -times(to_light, x) / (d * R);
    const double down = 2 * Pi * (1 - h / std::sqrt(h * h + R * R));
    const double reflected = 3 * (up * (4 * Pi - down) + low * down) / (4 * Pi * R * R);
    const Start at_x = [=](vec2) { return onto(x, (-1 / R) * x); };
    add({"integrating sphere", R"(
camera 0 0 0  0 0 1  40
depth 5
diffuse low 0.3 0.3 0.3
diffuse up 0.8 0.8 0.8
pointlight 0 1.2 0  3 3 3
)" + two_halves(R, "low", "up"),
         up / Pi * (3 * cosine / (d * d) + reflected * geometric((up + low) / 2, 4)), at_x, 4, 0})
        .no_none = never_hit;
    // The lower half glows: exitance pi 2.
    add({"integrating sphere, half glows", R"(
camera 9 9 9  0 0 1  40
depth 5
diffuse dim 0.3 0.3 0.3
light low  2 2 2 twosided dim
diffuse up 0.8 0.8 0.8
)" + two_halves(R, "low", "up"),
         up / Pi * (Pi * 2 / 2) * geometric((up + low) / 2, 5), at_x, 2, 1});

    // Sphere above, across and below the horizon.
    const struct {
        const char* name;
        double degrees, s, d;
        int aimed, chance;
    } tilts[] = {
        {"sphere, 30 degrees", 30, 0.5, 3, 1, 5},
        {"sphere, 75 degrees", 75, 0.5, 3, 3, 10},
        {"sphere, 90 degrees", 90, 0.5, 3, 4, 20},
        {"sphere, 105 degrees", 105, 0.5, 3, 11, 0},
        {"small sphere, 30 degrees", 30, 0.05, 2, 1, 0},
        {"small sphere, 89 degrees", 89, 0.05, 2, 3, 0},
    };
    for (const auto& t : tilts) {
        Known& row = lit(t.name, sphere(at_angle(t.degrees, t.d), t.s * t.d, "lamp"),
                         sphere_irradiance(t.s, std::cos(t.degrees * Pi / 180)), t.aimed, t.chance);
        if (t.chance == 0) row.no_none = rare;
    }

    // Point light: E = I cos / d^2.
    const Point p = at_angle(40, 2.5);
    lit("point light", "pointlight" + words(p) + " 3 4 5\n", 4 * p.y / (2.5 * 2.5 * 2.5), 1, 0)
        .no_none = never_hit;

    // Knife edge: half of the sphere is behind a plane that ends on its axis.
    for (const bool upper : {true, false}) {
        const Point a = at_angle(30, 1), to_seen = (upper ? 1.0 : -1.0) * Point{-a.y, a.x, 0};
        lit(upper ? "knife edge, upper half" : "knife edge, lower half",
            sphere(3 * a, 1.5, "lamp") + quad(a - Point{0, 0, 2}, {0, 0, 4}, -2 * to_seen, "black"),
            half_sphere_irradiance(0.5, a.y, to_seen.y), 2, 9);
    }

    // Polygons overhead, across the horizon, seen from behind, among others, past an edge.
    auto ceiling = [](double left, double right, double y, double z) {
        return std::vector<Point>{{left, y, -z}, {right, y, -z}, {right, y, z}, {left, y, z}};
    };
    std::string text = quad({-1.5, 1.5, -1.5}, {3, 0, 0}, {0, 0, 3}, "lamp");
    lit("ceiling", text, polygon_irradiance(ceiling(-1.5, 1.5, 1.5, 1.5)), 1, 2);
    text += quad({0.2, 0.5, -4}, {4, 0, 0}, {0, 0, 8}, "black");
    lit("ceiling past an edge", text, polygon_irradiance(ceiling(-1.5, 0.6, 1.5, 1.5)), 2, 3);
    lit("wall across the horizon", quad({2, -2, -2}, {0, 0, 4}, {0, 4, 0}, "lamp"),
        polygon_irradiance({{2, -2, -2}, {2, -2, 2}, {2, 2, 2}, {2, 2, -2}}), 3, 7);
    const Point a{1.6, -0.7, 1}, b{1.4, 1.5, -1.2}, c{-0.9, 1.8, 0.6};
    lit("two-sided triangle, its back", triangle(a, b, c, "both"), polygon_irradiance({a, b, c}), 2,
        3);
    text = sphere(at_angle(-50, 2), 0.8, "strong");
    text += quad({0.5, 1, -1}, {2, 0, 0}, {0, 0, 2}, "bright");
    text += triangle({-0.3, 2, 0.3}, {0.3, 2, -0.3}, {-0.3, 2, -0.3}, "strong");
    text += triangle({3, 1, 0}, {3, 2, 0}, {3, 1, 2}, "strong");
    const double unequal = 8 * sphere_irradiance(0.4, std::cos(50 * Pi / 180)) +
                           4 * polygon_irradiance(ceiling(0.5, 2.5, 1, 1));
    lit("unequal lights, two turned away", text, unequal, 4, 4);
    // With so many lights the choice is by power.
    for (const double left : {1.0, 2.0, 3.0})
        text += triangle({left, 3, 0}, {left, 3, 1}, {left + 1, 3, 0}, "lamp");
    lit("seven unequal lights, five turned away", text, unequal, 8, 4);

    // Eclipse: E = pi cos (sin^2 of the light - sin^2 of the body before it).
    lit("sphere eclipsed by a sphere",
        sphere(at_angle(30, 3), 1.5, "lamp") + sphere(at_angle(30, 1), 0.3, "black"),
        Pi * std::cos(Pi / 6) * (0.5 * 0.5 - 0.3 * 0.3), 2, 7);
    lit("disc eclipsed by a disc", disc(0, 2, 1.5, "lamp") + disc(0, 1, 0.4, "black"),
        Pi * (1.5 * 1.5 / 6.25 - 0.16 / 1.16), 1, 4);

    // Form factors: the mean E over a surface, from another of radiance 1, is pi F.
    const std::string plain =
        "camera 9 9 9  0 0 0  40\ndepth 1\ndiffuse grey 0.8 0.8 0.8\n"
        "light lamp 1 1 1\nlight inside 1 1 1 twosided grey\n";
    const std::string floor = plain + "quad -1 0 -1  0 0 5  5 0 0  grey\n";
    const Start on_floor = [](vec2 u) {
        return onto({2 * double(u.x), 0, 3 * double(u.y)}, {0, 1, 0});
    };
    add({"opposed rectangles", floor + "quad 0 1.5 0  2 0 0  0 0 3  lamp\n",
         0.8 * opposed(2 / 1.5, 3 / 1.5), on_floor, 2, 3});
    add({"rectangles at a right angle", floor + "quad 0 0 0  0 1.5 0  0 0 3  lamp\n",
         0.8 * perpendicular(2 / 3.0, 1.5 / 3), on_floor, 6, 6})
        .no_nee = meeting;
    const Start on_disc = [](vec2 u) {
        const double r = std::sqrt(double(u.x)), phi = 2 * Pi * double(u.y);
        return onto({r * std::cos(phi), 0, r * std::sin(phi)}, {0, 1, 0});
    };
    add({"coaxial discs", floor + disc(0, 1.5, 2, "lamp"), 0.8 * coaxial(1, 2, 1.5), on_disc, 1,
         2});
    lit("disc to the side", disc(1, 1.5, 1.2, "lamp"), Pi * element_to_disc(1, 1.2, 1.5), 1, 4);
    auto on_ball = [](double r, double side) -> Start {
        return [=](vec2 u) {
            const Point n = on_sphere(double(u.x), double(u.y));
            return onto(r * n, side * n);
        };
    };
    const Start on_inner = on_ball(1, 1), on_outer = on_ball(2, -1);
    add({"sphere around a bright sphere", plain + "sphere 0 0 0  2 grey\nsphere 0 0 0  1 lamp\n",
         0.8 / 4, on_outer, 1, 4});
    const std::string bright_shell = plain + "sphere 0 0 0  2 inside\nsphere 0 0 0  1 grey\n";
    add({"sphere in a bright sphere", bright_shell, 0.8, on_inner, 1, 1});
    add({"bright sphere around a sphere", bright_shell, 1 + 0.8 * 3 / 4, on_outer, 1, 1});

    // Solid angles: a part Omega / 4 pi of uniform directions sees the light.
    const Start all_round = [](vec2 u) {
        const Point n = on_sphere(double(u.x), double(u.y));
        return Ray{{0, 0, 0}, unit(vec3{real(n.x), real(n.y), real(n.z)})};
    };
    const std::string alone = "camera 9 9 9  0 0 0  40\ndepth 0\nlight lamp 1 1 1\n";
    add({"solid angle of a sphere", alone + sphere({1.2, -2, 0.9}, 2, "lamp"),
         sphere_solid_angle(2 / size_of({1.2, -2, 0.9})) / (4 * Pi), all_round, 0, 20});
    add({"solid angle of a rectangle", alone + quad({-2, -1, -0.5}, {4, 0, 0}, {0, 2, 0}, "lamp"),
         rectangle_solid_angle(4, 2) / (4 * Pi), all_round, 0, 8});
    return rows;
}

}  // namespace penumbra::closed_forms

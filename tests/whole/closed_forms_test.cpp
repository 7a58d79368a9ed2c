// whole/closed_forms_test.cpp  scenes whose radiance is known, by every technique, at one
// significance
//
// The formulas stand here and use nothing of the renderer.  E is irradiance, L radiance, rho an
// albedo; a diffuse receiver shows L = rho E / pi.
#include <functional>

#include "app/options.h"
#include "oracle/expect.h"
#include "path/paths.h"
#include "world/scene_file.h"

namespace {

// ---- Formulas ---------------------------------------------------------------------------------

constexpr double Pi = std::numbers::pi;

struct Point {
    double x, y, z;
};
Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point operator*(double s, Point a) { return {s * a.x, s * a.y, s * a.z}; }
double times(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point turned(Point a, Point b) {  // the cross product
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double size_of(Point a) { return std::sqrt(times(a, a)); }

// 1 + rho + ... of n terms: scattering after scattering.
double geometric(double rho, int n) { return (1 - std::pow(rho, n)) / (1 - rho); }

// E from a sphere of radiance 1, s = radius / distance, c = cosine between the normal and the
// direction to its centre (Martinez, Radiative view factors; Lagarde, de Rousiers 2014).
double sphere_irradiance(double s, double c) {
    if (c >= s) return Pi * s * s * c;
    if (c <= -s) return 0;
    const double x = std::sqrt(1 / (s * s) - 1), y = -x * c / std::sqrt(1 - c * c);
    const double q = std::sqrt(1 - c * c) * std::sqrt(1 - y * y);
    return s * s * (c * std::acos(y) - x * q) + std::atan(q / x);
}

// E from the half of that sphere that is seen past an edge through its axis; n_a and n_h: the
// normal along the axis and along the direction that leads from the edge to what is seen.  All of
// it above the horizon.  Lambert's integral along half the rim and back along the edge.
double half_sphere_irradiance(double s, double n_a, double n_h) {
    return Pi / 2 * s * s * n_a + (std::asin(s) - s * std::sqrt(1 - s * s)) * n_h;
}

// E at the origin, normal +y, from a convex polygon of radiance 1: clipped at the horizon, then
// Lambert's sum over its edges of their angle times the cosine of their plane (Arvo 1995).
double polygon_irradiance(const std::vector<Point>& corners) {
    std::vector<Point> above;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Point a = corners[i], b = corners[(i + 1) % corners.size()];
        if (a.y >= 0) above.push_back(a);
        if (a.y * b.y < 0) above.push_back(a + (a.y / (a.y - b.y)) * (b - a));
    }
    double sum = 0;
    for (size_t i = 0; i < above.size(); ++i) {
        const Point a = above[i], b = above[(i + 1) % above.size()], axis_ab = turned(a, b);
        const double sine = size_of(axis_ab);
        if (sine > 0) sum += std::atan2(sine, times(a, b)) * axis_ab.y / sine;
    }
    return std::abs(sum) / 2;
}

// Form factor of equal rectangles a x b, opposed at distance c: x = a / c, y = b / c (Howell C-11).
double opposed(double x, double y) {
    const double u = std::sqrt(1 + x * x), v = std::sqrt(1 + y * y);
    return 2 / (Pi * x * y) *
           (std::log(u * v / std::sqrt(1 + x * x + y * y)) + x * v * std::atan(x / v) +
            y * u * std::atan(y / u) - x * std::atan(x) - y * std::atan(y));
}

// From a rectangle of width w (over the common edge) to its neighbour of height h at a right angle
// (Howell C-14).
double perpendicular(double w, double h) {
    const double W = w * w, H = h * h, S = W + H;
    return (w * std::atan(1 / w) + h * std::atan(1 / h) -
            std::sqrt(S) * std::atan(1 / std::sqrt(S)) +
            (std::log((1 + W) * (1 + H) / (1 + S)) + W * std::log(W * (1 + S) / ((1 + W) * S)) +
             H * std::log(H * (1 + S) / ((1 + H) * S))) /
                4) /
           (Pi * w);
}

// From a disc of radius a to the coaxial one of radius b, at distance h (Howell C-41).
double coaxial(double a, double b, double h) {
    const double A = a / h, B = b / h, x = 1 + (1 + B * B) / (A * A);
    return (x - std::sqrt(x * x - 4 * (b / a) * (b / a))) / 2;
}

// From an element to a parallel disc of radius r at height h, the axis at distance a.
double element_to_disc(double a, double r, double h) {
    const double H = h * h / (a * a), K = r * r / (a * a), z = 1 + H + K;
    return (1 - (1 + H - K) / std::sqrt(z * z - 4 * K)) / 2;
}

double sphere_solid_angle(double s) { return 2 * Pi * s * s / (1 + std::sqrt(1 - s * s)); }

// Of a rectangle seen along its axis, p and q the tangents of its half-angles.
double rectangle_solid_angle(double p, double q) {
    return 4 * std::atan(p * q / std::sqrt(1 + p * p + q * q));
}

// ---- Scenes -----------------------------------------------------------------------------------

std::string words(std::initializer_list<double> numbers) {
    std::string text;
    for (double x : numbers) text += print(" %.17g", x);
    return text;
}
std::string words(Point p) { return words({p.x, p.y, p.z}); }

std::string sphere(Point centre, double r, const char* material) {
    std::string text = "sphere";
    return text + words(centre) + words({r}) + " " + material + "\n";
}
// A sphere about the origin whose lower half has another material than its upper one, as seen from
// within: two spheres, `apart` times the radius apart, of which each is the nearer on one side.
// They are the sphere but for that part of its radius, and so is the radiance within.
std::string two_halves(double r, const char* lower, const char* upper) {
    const double apart = sizeof(real) == 4 ? 1e-3 : 1e-5;
    return sphere({0, apart * r / 2, 0}, r, lower) + sphere({0, -apart * r / 2, 0}, r, upper);
}
std::string quad(Point corner, Point u, Point v, const char* material) {
    std::string text = "quad";
    return text + words(corner) + words(u) + words(v) + " " + material + "\n";
}
std::string triangle(Point a, Point b, Point c, const char* material) {
    std::string text = "triangle";
    return text + words(a) + words(b) + words(c) + " " + material + "\n";
}

// A regular polygon with the area of a disc about (x, y, 0), in a plane y = const, facing down.
std::vector<Point> disc_corners(double x, double y, double r) {
    constexpr int n = 64;
    const double angle = 2 * Pi / n, R = r * std::sqrt(angle / std::sin(angle));
    std::vector<Point> corners;
    for (int i = 0; i < n; ++i)
        corners.push_back({x + R * std::cos(i * angle), y, R * std::sin(i * angle)});
    return corners;
}
std::string disc(double x, double y, double r, const char* material) {
    const std::vector<Point> c = disc_corners(x, y, r);
    std::string text;
    for (size_t i = 0; i < c.size(); ++i)
        text += triangle({x, y, 0}, c[i], c[(i + 1) % c.size()], material);
    return text;
}

// A small patch of albedo 0.8 at the origin, facing +y, and one pixel that sees its middle.
const char* const receiver = R"(
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

// Seen from the origin under the angle of `degrees` with the receiver's normal.
Point at_angle(double degrees, double distance) {
    const double angle = degrees * Pi / 180;
    return {distance * std::sin(angle), distance * std::cos(angle), 0};
}

using Start = std::function<Ray(vec2)>;

// A ray that hits the surface point p at a right angle, on the side of the unit vector n.
Ray onto(Point p, Point n) {
    const Point o = p + 1e-3 * n;
    return {{real(o.x), real(o.y), real(o.z)}, unit(vec3{real(-n.x), real(-n.y), real(-n.z)})};
}
Point on_sphere(double u, double v) {
    const double z = 1 - 2 * u, r = std::sqrt(4 * u * (1 - u));
    return {r * std::cos(2 * Pi * v), r * std::sin(2 * Pi * v), z};
}

// Uniform over the walls of a box with a corner at the origin and over a sphere (r may be 0).
Start on_walls(Point box, Point centre, double r) {
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

// ---- What is known ----------------------------------------------------------------------------

// Why a cell of the matrix is empty.
const char* const never_hit = "a point light is never hit";
const char* const meeting = "infinite variance of light samples where emitting walls meet";
const char* const rare = "fewer than one path in a hundred finds the light";
const char* const idle = "roulette after the last scattering that counts changes nothing";
const char* const unscattered = "no scattering: nothing but the sampler matters";
const char* const biased = "biased by design";

struct Known {
    const char* name;
    std::string text;
    double truth;                   // mean of the channels
    Start start;                    // of rays; if none: the camera's
    int aimed, chance;              // samples in units of 8192; chance: of --light none
    const char* no_none = nullptr;  // reasons not to run --light none, nee
    const char* no_nee = nullptr;
};

std::vector<Known> known_scenes() {
    std::vector<Known> rows;
    auto add = [&](const Known& k) { rows.push_back(k); };
    const std::string patch = receiver;
    const Start none = nullptr;

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
    add({"furnace, depth 1", furnace + "depth 1\n", 0.4 * geometric(0.5, 2), none, 1, 1});
    rows.back().no_nee = meeting;
    add({"furnace, depth 8", furnace + "depth 8\n", 0.4 * geometric(0.5, 9), none, 2, 2});
    rows.back().no_nee = meeting;
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

    // Closed room: whatever the shape, the area mean of the k-th scattered E is rho^k Phi / A.
    const std::string room =
        "camera 1 1 1  0 0 0  40\ndepth 3\ndiffuse wall 0.7 0.7 0.7\n"
        "light lamp 5 4 3 wall\nbox 2 3 1.5  0  0 0 0  wall\n";
    const double walls = 2 * (2 * 3 + 3 * 1.5 + 1.5 * 2), lamp = 4 * Pi * 0.4 * 0.4;
    add({"closed room, point light", room + "pointlight 0.5 2.2 1.1  3 2 1\n",
         0.7 / Pi * (4 * Pi * 2 / walls) * geometric(0.7, 3), on_walls({2, 3, 1.5}, {}, 0), 4, 0});
    rows.back().no_none = never_hit;
    add({"closed room, ball light", room + sphere({0.6, 2.2, 0.9}, 0.4, "lamp"),
         4 * lamp / (walls + lamp) * geometric(0.7, 4), on_walls({2, 3, 1.5}, {0.6, 2.2, 0.9}, 0.4),
         4, 4});

    // Integrating sphere: E(x) = E0(x) + mean(rho E0) (1 + mean(rho) + ...).  The light, I = 3, is
    // h above the plane that divides the albedos, through which the flux of a cone goes down.
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
         up / Pi * (3 * cosine / (d * d) + reflected * geometric((up + low) / 2, 4)), at_x, 4, 0});
    rows.back().no_none = never_hit;
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
        add({t.name, patch + sphere(at_angle(t.degrees, t.d), t.s * t.d, "lamp"),
             0.8 / Pi * sphere_irradiance(t.s, std::cos(t.degrees * Pi / 180)), none, t.aimed,
             t.chance});
        if (t.chance == 0) rows.back().no_none = rare;
    }

    // Point light: E = I cos / d^2.
    const Point p = at_angle(40, 2.5);
    add({"point light", patch + "pointlight" + words(p) + " 3 4 5\n",
         0.8 / Pi * 4 * p.y / (2.5 * 2.5 * 2.5), none, 1, 0});
    rows.back().no_none = never_hit;

    // Knife edge: half of the sphere is behind a plane that ends on its axis.
    for (const bool upper : {true, false}) {
        const Point a = at_angle(30, 1), to_seen = (upper ? 1.0 : -1.0) * Point{-a.y, a.x, 0};
        std::string text = patch + sphere(3 * a, 1.5, "lamp");
        text += quad(a - Point{0, 0, 2}, {0, 0, 4}, -2 * to_seen, "black");
        add({upper ? "knife edge, upper half" : "knife edge, lower half", text,
             0.8 / Pi * half_sphere_irradiance(0.5, a.y, to_seen.y), none, 2, 9});
    }

    // Polygons overhead, across the horizon, seen from behind, among others, past an edge.
    auto ceiling = [](double left, double right, double y, double z) {
        return std::vector<Point>{{left, y, -z}, {right, y, -z}, {right, y, z}, {left, y, z}};
    };
    std::string text = patch + quad({-1.5, 1.5, -1.5}, {3, 0, 0}, {0, 0, 3}, "lamp");
    add({"ceiling", text, 0.8 / Pi * polygon_irradiance(ceiling(-1.5, 1.5, 1.5, 1.5)), none, 1, 2});
    text += quad({0.2, 0.5, -4}, {4, 0, 0}, {0, 0, 8}, "black");
    add({"ceiling past an edge", text, 0.8 / Pi * polygon_irradiance(ceiling(-1.5, 0.6, 1.5, 1.5)),
         none, 2, 3});
    text = patch + quad({2, -2, -2}, {0, 0, 4}, {0, 4, 0}, "lamp");
    add({"wall across the horizon", text,
         0.8 / Pi * polygon_irradiance({{2, -2, -2}, {2, -2, 2}, {2, 2, 2}, {2, 2, -2}}), none, 3,
         7});
    const Point a{1.6, -0.7, 1}, b{1.4, 1.5, -1.2}, c{-0.9, 1.8, 0.6};
    add({"two-sided triangle, its back", patch + triangle(a, b, c, "both"),
         0.8 / Pi * polygon_irradiance({a, b, c}), none, 2, 3});
    text = patch + sphere(at_angle(-50, 2), 0.8, "strong");
    text += quad({0.5, 1, -1}, {2, 0, 0}, {0, 0, 2}, "bright");
    text += triangle({-0.3, 2, 0.3}, {0.3, 2, -0.3}, {-0.3, 2, -0.3}, "strong");
    text += triangle({3, 1, 0}, {3, 2, 0}, {3, 1, 2}, "strong");
    add({"unequal lights, two turned away", text,
         0.8 / Pi *
             (8 * sphere_irradiance(0.4, std::cos(50 * Pi / 180)) +
              4 * polygon_irradiance(ceiling(0.5, 2.5, 1, 1))),
         none, 4, 4});

    // Eclipse: E = pi cos (sin^2 of the light - sin^2 of what is before it).
    text = patch + sphere(at_angle(30, 3), 1.5, "lamp");
    text += sphere(at_angle(30, 1), 0.3, "black");
    add({"sphere eclipsed by a sphere", text, 0.8 * std::cos(Pi / 6) * (0.5 * 0.5 - 0.3 * 0.3),
         none, 2, 7});
    text = patch + disc(0, 2, 1.5, "lamp");
    text += disc(0, 1, 0.4, "black");
    add({"disc eclipsed by a disc", text, 0.8 * (1.5 * 1.5 / 6.25 - 0.16 / 1.16), none, 1, 4});

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
         0.8 * perpendicular(2 / 3.0, 1.5 / 3), on_floor, 6, 6});
    rows.back().no_nee = meeting;
    const Start on_disc = [](vec2 u) {
        const double r = std::sqrt(double(u.x)), phi = 2 * Pi * double(u.y);
        return onto({r * std::cos(phi), 0, r * std::sin(phi)}, {0, 1, 0});
    };
    add({"coaxial discs", floor + disc(0, 1.5, 2, "lamp"), 0.8 * coaxial(1, 2, 1.5), on_disc, 1,
         2});
    add({"disc to the side", patch + disc(1, 1.5, 1.2, "lamp"), 0.8 * element_to_disc(1, 1.2, 1.5),
         none, 1, 4});
    const Start on_inner = [](vec2 u) {
        const Point n = on_sphere(double(u.x), double(u.y));
        return onto(n, n);
    };
    const Start on_outer = [](vec2 u) {
        const Point n = on_sphere(double(u.x), double(u.y));
        return onto(2 * n, -1 * n);
    };
    add({"sphere around a bright sphere", plain + "sphere 0 0 0  2 grey\nsphere 0 0 0  1 lamp\n",
         0.8 / 4, on_outer, 1, 4});
    const std::string bright_shell = plain + "sphere 0 0 0  2 inside\nsphere 0 0 0  1 grey\n";
    add({"sphere in a bright sphere", bright_shell, 0.8, on_inner, 1, 1});
    add({"bright sphere around a sphere", bright_shell, 1 + 0.8 * 3 / 4, on_outer, 1, 1});

    // Solid angles: of uniform directions a part Omega / 4 pi sees the light.
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

// ---- The matrix -------------------------------------------------------------------------------

// As the user says them: a new option is one more row.
const char* const samplers[] = {"--sampler independent", "--sampler stratified", "--sampler halton",
                                "--sampler halton-naive"};
const char* const techniques[] = {
    "--direction uniform --light none",
    "--direction uniform --light nee",
    "--direction uniform --light mis",
    "--direction bsdf --light none",
    "--direction bsdf --light nee",
    "--direction bsdf --light mis",
    "--direction uniform --light none --roulette 1",
    "--direction uniform --light nee --roulette 1",
    "--direction uniform --light mis --roulette 1",
    "--direction bsdf --light none --roulette 1",
    "--direction bsdf --light nee --roulette 1",
    "--direction bsdf --light mis --roulette 1",
};

Options options_of(const std::string& said) {
    std::vector<std::string> list;
    std::istringstream in(said + " --quiet scene");
    for (std::string word; in >> word;) list.push_back(word);
    return parse_options(list);
}

const char* why_empty(const Known& k, const Scene& scene, const Options& o, bool first) {
    if (o.sampler == SamplerKind::halton_naive) return biased;
    if (scene.depth == 0 && !first) return unscattered;
    if (o.technique.light == LightMode::none && k.no_none) return k.no_none;
    if (o.technique.light == LightMode::nee && k.no_nee) return k.no_nee;
    if (o.technique.light == LightMode::nee && o.technique.roulette > 0 && scene.depth == 1)
        return idle;
    return nullptr;
}

// One sample of what is known.
double measure(const Known& k, const Scene& scene, const Options& o, const Pattern& pattern,
               uint64_t sample) {
    if (!k.start) return double(mean_of(radiance(scene, o.technique, pattern, 0, 0, sample)));
    const Sampler sampler(pattern, 0, sample);
    const vec2 u = sampler.get2(film_x);
    return double(mean_of(Li(scene, o.technique, k.start(u), sampler)));
}

// A cell of the matrix: why it is empty, or its verdict.
struct Cell {
    const char* empty = nullptr;
    Verdict verdict;
    double score = 0;    // standard normal if all is right
    double error = 0;    // standard error relative to the truth
    bool exact = false;  // nothing but rounding
};

// The standard normal number with the p-value of t with df degrees of freedom.
double normal_score(double t, double df) {
    const double p = p_of_t(t, df);
    double low = 0, high = 40;
    while (high - low > 1e-9) (p_of_z((low + high) / 2) > p ? low : high) = (low + high) / 2;
    return std::copysign(low, t);
}

// n independent samples; or, where samples depend on each other, n in 64 randomisations.  Samples
// are bounded (cells in which they are not stay empty), so that only skewness can mislead the
// t-test; it keeps its alpha from n = 1000 skewness^2 on.
Cell check(const Known& k, const Scene& scene, const Options& o, uint64_t n) {
    const bool independent = o.sampler == SamplerKind::independent;
    const int replicates = independent ? 1 : 64;
    const uint64_t points = n / uint64_t(replicates);
    Pattern pattern = make_pattern(o.sampler, o.seed, false, scene.depth, points);
    Moments samples, means;
    for (int i = 0; i < replicates; ++i, ++pattern.seed) {
        Moments of_one;
        for (uint64_t j = 0; j < points; ++j) of_one.add(measure(k, scene, o, pattern, j));
        samples.merge(of_one);
        means.add(of_one.mean);
    }
    Cell cell;
    Estimate e = estimate(independent ? samples : means);
    const double rounding = 256 * double(ulp) * k.truth;
    cell.exact = e.standard_error < rounding;
    e.standard_error = std::hypot(e.standard_error, rounding);
    const double needed = cell.exact ? 0 : 1000 * std::pow(samples.skewness(), 2);
    cell.verdict = needed <= double(samples.n)
                       ? expect_mean(k.truth, e)
                       : failure(print("%.0f samples needed for their skewness", needed));
    cell.score = normal_score((e.mean - k.truth) / e.standard_error, e.df);
    cell.error = e.standard_error / k.truth;
    return cell;
}

// All cells of one scene as one verdict: they share its truth, and most of the program.  The sum of
// m standard normals over sqrt m is one (Stouffer 1949); a common relative bias moves it by the sum
// of bias / error over sqrt m.
struct Pooled {
    double score = 0;
    Verdict verdict{true, 1, 0, "exact"};
};
Pooled pooled(const std::vector<Cell>& cells) {
    double sum = 0, power = 0, m = 0;
    for (const Cell& c : cells)
        if (!c.empty && !c.exact) ++m, sum += c.score, power += 1 / c.error;
    if (m == 0) return {};
    return {sum / std::sqrt(m), expect_mean(1, {1 + sum / power, std::sqrt(m) / power})};
}

void print_matrix(const std::vector<Known>& rows, const std::vector<std::vector<Cell>>& matrix,
                  const std::vector<Pooled>& all) {
    constexpr size_t columns = std::size(techniques);
    std::vector<const char*> reasons;
    auto letter_of = [&](const char* reason) {
        auto found = std::find(reasons.begin(), reasons.end(), reason);
        if (found == reasons.end()) found = reasons.insert(found, reason);
        return char('a' + (found - reasons.begin()));
    };
    std::printf("Sigmas off the closed form; ==: exact but for rounding\n");
    for (size_t t = 0; t < columns; ++t) std::printf("  %c  %s\n", int('A' + t), techniques[t]);
    for (size_t s = 0; s < std::size(samplers); ++s) {
        const Cell& first = matrix[0][s * columns];
        if (first.empty == biased) {
            std::printf("%-32s  (%c)\n", samplers[s], letter_of(biased));
            continue;
        }
        std::printf("%-32s", samplers[s]);
        for (size_t t = 0; t < columns; ++t) std::printf("%5c", int('A' + t));
        std::puts("");
        for (size_t r = 0; r < rows.size(); ++r) {
            std::string line = print("%-32s", rows[r].name);
            for (size_t t = 0; t < columns; ++t) {
                const Cell& c = matrix[r][s * columns + t];
                line += c.empty   ? print("  (%c)", letter_of(c.empty))
                        : c.exact ? "   =="
                                  : print("%+5.1f", c.score);
            }
            std::puts(line.c_str());
        }
    }
    for (size_t i = 0; i < reasons.size(); ++i)
        std::printf("  (%c)  %s\n", int('a' + i), reasons[i]);
    std::printf("%-32s  sigmas  smallest bias seen with 99.9 %% power\n", "all cells of a scene");
    for (size_t r = 0; r < rows.size(); ++r) {
        const auto& [score, verdict] = all[r];
        std::printf("%-32s   %+4.1f   %.2g %%\n", rows[r].name, score, 100 * verdict.delta_min);
    }
}

}  // namespace

TEST_CASE("the closed forms have their published values") {
    auto near = [](double a, double b, double digits) {
        return std::abs(a - b) <= 0.5000001 * digits;
    };
    auto cosine = [](double degrees) { return std::cos(degrees * Pi / 180); };
    CHECK(near(sphere_irradiance(0.5, cosine(75)), 0.221200880053, 1e-12));
    CHECK(near(sphere_irradiance(0.5, cosine(90)), 0.090586073706, 1e-12));
    CHECK(near(sphere_irradiance(0.5, cosine(105)), 0.017924877377, 1e-12));
    CHECK(near(half_sphere_irradiance(0.5, cosine(30), 0.5), 0.385380, 1e-6));
    CHECK(near(half_sphere_irradiance(0.5, cosine(30), -0.5), 0.294794, 1e-6));
    CHECK(near(polygon_irradiance({{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}), 1.740839502734,
               1e-12));
    CHECK(near(polygon_irradiance({{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}}), 0.350188287714,
               1e-12));
    CHECK(near(opposed(1, 1), 0.199824895698, 1e-12));
    CHECK(near(perpendicular(1, 1), 0.200043776075, 1e-12));
    CHECK(near(coaxial(1, 2, 1.5), 0.601653344388, 1e-12));
    CHECK(near(rectangle_solid_angle(1, 1), 4 * Pi / 6, 1e-14));
    // A sphere grazing the horizon, from both sides; a disc overhead.
    CHECK(near(sphere_irradiance(0.5, 0.5 - 1e-9), sphere_irradiance(0.5, 0.5), 1e-8));
    CHECK(near(element_to_disc(1e-4, 1, 2), 0.2, 1e-8));
}

TEST_CASE("polygons stand for discs within 1e-5") {
    const double side = polygon_irradiance(disc_corners(1, 1.5, 1.2)) / Pi;
    CHECK(std::abs(side / element_to_disc(1, 1.2, 1.5) - 1) < 1e-5);
    const double seen =
        polygon_irradiance(disc_corners(0, 2, 1.5)) - polygon_irradiance(disc_corners(0, 1, 0.4));
    CHECK(std::abs(seen / (Pi * (1.5 * 1.5 / 6.25 - 0.16 / 1.16)) - 1) < 1e-5);
    // The mean over a disc, by the midpoint rule: r^2 and the angle (one sector) uniform.
    double mean = 0;
    constexpr int rings = 1000, angles = 4;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < angles; ++j) {
            const double r = std::sqrt((i + 0.5) / rings), phi = 2 * Pi / 64 * (j + 0.5) / angles;
            std::vector<Point> corners = disc_corners(0, 1.5, 2);
            for (Point& p : corners) p = p - Point{r * std::cos(phi), 0, r * std::sin(phi)};
            mean += polygon_irradiance(corners) / Pi / (rings * angles);
        }
    CHECK(std::abs(mean / coaxial(1, 2, 1.5) - 1) < 1e-5);
}

TEST_CASE("every technique finds every closed form") {
    const std::vector<Known> rows = known_scenes();
    std::vector<std::vector<Cell>> matrix;
    std::vector<Pooled> all;  // of each row
    double chi2 = 0, scores = 0;
    for (const Known& k : rows) {
        const Scene scene = parse_scene(k.text, k.name).scene;
        std::vector<Cell> cells;
        for (const char* sampler : samplers)
            for (const char* technique : techniques) {
                const std::string said = print("%s %s", sampler, technique);
                Options o = options_of(said);
                o.seed = seed_of(k.name + said);
                Cell cell;
                cell.empty = why_empty(k, scene, o, technique == techniques[0]);
                if (!cell.empty) {
                    const bool by_chance = o.technique.light == LightMode::none;
                    cell = check(k, scene, o, uint64_t(by_chance ? k.chance : k.aimed) * 8192);
                    EXPECT(cell.verdict.of(print("%s, %s", k.name, said.c_str())),
                           by_chance ? 0.15 : 0.10);
                    if (!cell.exact) chi2 += cell.score * cell.score, ++scores;
                }
                cells.push_back(cell);
            }
        all.push_back(pooled(cells));
        EXPECT(all.back().verdict.of(print("%s, all techniques", k.name)), 0.01);
        matrix.push_back(cells);
    }
    print_matrix(rows, matrix, all);
    // Standard errors tell the truth: the sigmas are standard normal.
    const double above = p_of_chi2(chi2, scores), p = 2 * std::min(above, 1 - above);
    ++statistical_checks;
    INFO("chi-squared of all sigmas: ", chi2, " of ", scores, " degrees of freedom, p = ", p);
    CHECK(p > alpha);
}

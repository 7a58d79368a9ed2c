// course/judge_V.cpp  judges the Voronoi project: a cell is cut, and measured
#include "course/judge.h"

using namespace penumbra;
using namespace course;

namespace {

struct Place {
    double x, y;
};
using Places = std::vector<Place>;
double distance(Place a, Place b) { return std::hypot(a.x - b.x, a.y - b.y); }

// ---- V.1 ----------------------------------------------------------------------------------------

// Points with x dx + y dy <= h.
struct Line {
    double dx, dy, h;
    double beyond(Place p) const { return p.x * dx + p.y * dy - h; }
};
using Lines = std::vector<Line>;

struct Answer {
    Places corners;
    std::vector<int> neighbours;
};

// The square [-1,1]^2 cut by lines, one after the other; all of it, and sites, may be smaller.
Answer cut(Judge& j, const Lines& lines, bool probe = false, double scale = 1) {
    Out in = {-scale, -scale, scale, scale};
    for (const Line& l : lines)
        in.insert(in.end(), {scale * l.dx, scale * l.dy, scale * scale * l.h});
    const Out out = probe ? j.probe("cut", Rows(in)).numbers : j.ask("cut", in);
    Answer a;
    for (size_t i = 0; i + 3 <= out.size(); i += 3) {
        a.corners.push_back({out[i] / scale, out[i + 1] / scale});
        a.neighbours.push_back(int(out[i + 2]));
    }
    return a;
}

// How far the one that is farthest from all of b is from them.
double farthest(const Places& a, const Places& b) {
    double most = 0;
    for (Place p : a) {
        double nearest = oracle::infinity;
        for (Place q : b) nearest = std::min(nearest, distance(p, q));
        most = worse(most, nearest);
    }
    return most;
}
double apart(const Places& a, const Places& b) { return std::max(farthest(a, b), farthest(b, a)); }

const Lines walls = {{-1, 0, 1}, {0, -1, 1}, {1, 0, 1}, {0, 1, 1}};

// Where any two lines cross, unless it is beyond a third.
Places corners_by_force(Lines lines) {
    lines.insert(lines.end(), walls.begin(), walls.end());
    Places corners;
    for (size_t a = 0; a < lines.size(); ++a)
        for (size_t b = 0; b < a; ++b) {
            const Line &l = lines[a], &m = lines[b];
            const double det = l.dx * m.dy - m.dx * l.dy;
            if (std::abs(det) < 1e-9) continue;
            const Place p = {(l.h * m.dy - m.h * l.dy) / det, (l.dx * m.h - m.dx * l.h) / det};
            const bool inside = std::all_of(lines.begin(), lines.end(),
                                            [&](const Line& k) { return k.beyond(p) < 1e-12; });
            if (inside) corners.push_back(p);
        }
    return corners;
}

// Bisectors with neighbours around the site.
Lines random_lines(oracle::Random& random, int n) {
    Lines lines;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * oracle::pi * random(), r = 0.6 + 1.2 * random(),
                     x = r * std::cos(angle), y = r * std::sin(angle);
        lines.push_back({x, y, (x * x + y * y) / 2});
    }
    return lines;
}

// How far edges are from the lines that they are said to be due to.
double edges_off(const Answer& a, const Lines& lines) {
    double most = 0;
    for (size_t i = 0; i < a.corners.size(); ++i) {
        const Place p = a.corners[i], q = a.corners[(i + 1) % a.corners.size()];
        const int n = a.neighbours[i];
        auto off = [&](const Line& l) {
            return std::max(std::abs(l.beyond(p)), std::abs(l.beyond(q)));
        };
        double nearest = oracle::infinity;
        if (n >= 0 && n < int(lines.size())) nearest = off(lines[size_t(n)]);
        for (const Line& w : walls)
            if (n == -1) nearest = std::min(nearest, off(w));
        most = worse(most, nearest);
    }
    return a.corners.empty() ? oracle::infinity : most;
}

// Least turn to the left at a corner, as a sine times two lengths.
double least_turn(const Places& p) {
    double least = p.size() < 3 ? -oracle::infinity : oracle::infinity;
    for (size_t i = 0; i < p.size(); ++i) {
        const Place a = p[i], b = p[(i + 1) % p.size()], c = p[(i + 2) % p.size()];
        least = std::min(least, (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x));
    }
    return least;
}

void cutting(Judge& j) {
    const Answer half = cut(j, {{1, 0, 0.5}}, true),
                 corner = cut(j, {{1, 1, 1.5}, {-0.5, 1, 0.625}}, true),
                 nothing = cut(j, {{1, 0, -2}}, true);
    cut(j, {{1, 0, 0.5}, {0, 1, 0.5}, {1, 1, 0.8}, {-1, 1, 0.9}}, true);
    const char* off = "a corner is off by %.3g";
    const Places expected = {{-1, -1}, {0.5, -1}, {0.5, 1}, {-1, 1}};
    const double half_off = apart(half.corners, expected);
    j.exact("the square [-1,1]^2 cut at x = 1/2 has four corners",
            half_off < 1e-14 && half.corners.size() == 4, oracle::say(off, half_off));
    const Places of_two = corners_by_force({{1, 1, 1.5}, {-0.5, 1, 0.625}});
    j.below("two lines that cut off two corners", apart(corner.corners, of_two), 1e-12, off);
    const Places square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const Places whole = cut(j, {{1, 1, 2.5}, {-1, 0, 3}}).corners;
    for (const auto& [what, came] :
         {std::pair("lines that do not touch it change nothing", whole),
          {"a line that would leave nothing changes nothing", nothing.corners}})
        j.exact(what, apart(came, square) == 0, oracle::say(off, apart(came, square)));
    double corners_off = 0, edges = 0, turn = oracle::infinity, order = 0, tiny = 0;
    for (int k = 0; k < 50; ++k) {
        Lines lines = random_lines(j.random, 3 + k % 8);
        const Answer a = cut(j, lines);
        corners_off = worse(corners_off, apart(a.corners, corners_by_force(lines)));
        edges = worse(edges, edges_off(a, lines));
        turn = std::min(turn, least_turn(a.corners));
        tiny = worse(tiny, apart(a.corners, cut(j, lines, false, 0x1p-30).corners));
        std::reverse(lines.begin(), lines.end());
        order = worse(order, apart(a.corners, cut(j, lines).corners));
    }
    j.below("cells of 3 to 10 neighbours: their corners by trying all pairs of lines", corners_off,
            1e-11, off);
    j.below("every edge lies on the bisector of the neighbour that it names", edges, 1e-11,
            "one is off by %.3g");
    j.exact("corners go round counterclockwise", turn > -1e-12,
            oracle::say("a turn of %.3g to the left", turn));
    j.below("the order of the lines does not matter", order, 1e-11, off);
    const double open = j.ask("open", Out{-1, -1, 1, 1, 1, 0, 0.5}).at(0);
    j.exact("a crossing is a new corner: `stays` is false, whatever it was of the old ones",
            open >= 2, oracle::say("it is so for %g of 2", open));
    j.below("corners of cells whose sites are 1e-9 apart", tiny, 1e-11,
            "a corner is off by %.3g of that");
    j.limit();
}

// ---- V.2 ----------------------------------------------------------------------------------------

Out numbers_of(const Places& p) {
    Out numbers;
    for (Place c : p) numbers.insert(numbers.end(), {c.x, c.y});
    return numbers;
}

struct Measure {
    double area, x, y;
};
Measure measure(Judge& j, const Places& p, bool probe = false) {
    const Out m =
        probe ? j.probe("measured", Rows(numbers_of(p))).numbers : j.ask("measured", numbers_of(p));
    return {m.at(0), m.at(1), m.at(2)};
}
bool alike(const Measure& a, const Measure& b, double tolerance) {
    return near({a.area, a.x, a.y}, {b.area, b.x, b.y}, tolerance);
}
void same(Judge& j, const std::string& what, const Measure& came, const Measure& expected,
          double tolerance = 1e-12) {
    j.exact(what, alike(came, expected, tolerance),
            oracle::say("area %.6g, centroid (%.6g, %.6g) expected; %.6g, (%.6g, %.6g) came",
                        expected.area, expected.x, expected.y, came.area, came.x, came.y));
}

// Corners on an ellipse around (x, y).
Places round_about(double x, double y, double rx, double ry, int n, double turned) {
    Places p;
    for (int i = 0; i < n; ++i) {
        const double angle = turned + 2 * oracle::pi * i / n;
        p.push_back({x + rx * std::cos(angle), y + ry * std::sin(angle)});
    }
    return p;
}

void measuring(Judge& j) {
    const Measure triangle = measure(j, {{-1, -1}, {3, -1}, {-1, 2}}, true),
                  house = measure(j, {{-1, -1}, {2, -1}, {2, 1}, {0, 3}, {-1, 2}}, true);
    measure(j, {{1, 1}, {3, 1}, {3, 2}}, true);  // beyond the site
    same(j, "the sheet's triangle: area 6, centroid (1/3, 0)", triangle, {6, 1 / 3.0, 0});
    same(j, "a rectangle", measure(j, {{-1, -1}, {3, -1}, {3, 1}, {-1, 1}}), {8, 1, 0});
    const double r = 0.5 + j.random();
    same(j, "a regular hexagon about the site", measure(j, round_about(0, 0, r, r, 6, j.random())),
         {1.5 * std::sqrt(3) * r * r, 0, 0});
    const double x = 0.3 * j.random(), y = 0.3 * j.random(), turned = j.random();
    const Measure about = measure(j, round_about(0, 0, 1, 0.7, 7, turned));
    same(j, "moved, it has the same area, and its centroid moves along",
         measure(j, round_about(x, y, 1, 0.7, 7, turned)), {about.area, about.x + x, about.y + y});
    same(j, "whichever corner is named first",
         measure(j, {{0, 3}, {-1, 2}, {-1, -1}, {2, -1}, {2, 1}}), house);
    const Places p = round_about(0.2, 0.1, 1, 0.8, 5, turned);
    const Measure all = measure(j, p), a = measure(j, {p[0], p[1], p[2]}),
                  b = measure(j, {p[0], p[2], p[3], p[4]});
    same(j, "cut along a diagonal, the parts weigh as much as the whole",
         {a.area + b.area, a.area * a.x + b.area * b.x, a.area * a.y + b.area * b.y},
         {all.area, all.area * all.x, all.area * all.y});
    // Any, wherever the site is: triangles from the first corner, relative to it.
    for (int k = 0; k < 20; ++k) {
        Places any = round_about(between(j.random, -2, 2), between(j.random, -2, 2), 1, 0.6,
                                 3 + k % 6, j.random());
        any[0].x *= 1.1;  // not alike all round
        Measure fan{};
        for (size_t i = 1; i + 1 < any.size(); ++i) {
            const double ux = any[i].x - any[0].x, uy = any[i].y - any[0].y,
                         vx = any[i + 1].x - any[0].x, vy = any[i + 1].y - any[0].y,
                         part = (ux * vy - uy * vx) / 2;
            fan.area += part;
            fan.x += part * (any[0].x + (ux + vx) / 3);
            fan.y += part * (any[0].y + (uy + vy) / 3);
        }
        const Measure came = measure(j, any),
                      expected = {fan.area, fan.x / fan.area, fan.y / fan.area};
        if (alike(came, expected, 1e-11) && k < 19) continue;
        same(j, "any polygon, with the site inside or not: triangles from its first corner", came,
             expected, 1e-11);
        break;
    }
    const Measure flat = measure(j, {{-1, -1}, {1, 1}, {2, 2}}, true);
    same(j, "an area of 0 has no centroid: it stays (0, 0)", flat, {0, 0, 0});
    j.limit();
    const double s = 0x1p-40;
    const Measure tiny = measure(j, {{-s, -s}, {3 * s, -s}, {-s, 2 * s}});
    same(j, "the same triangle, 1e-12 as large: in units of its own",
         {tiny.area / s / s, tiny.x / s, tiny.y / s}, {6, 1 / 3.0, 0});
    j.limit();
    j.remember({tiny.area / s / s, tiny.x / s, tiny.y / s});
    const Out rim = j.ask("rim", Out{-1, -1, 3, -1, -1, 2});
    j.exact("rim, which was computed before, is as it was", rim.at(0) == 0 && rim.at(1) == -4,
            oracle::say("(0, -4) expected, (%.6g, %.6g) came", rim.at(0), rim.at(1)));
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv, {{"V.1", cutting}, {"V.2", measuring}});
}

// voronoi_test.cpp  cell areas: exact cases, brute force, and the bias that clipping has
#include "../src/voronoi.h"

#include <doctest/doctest.h>

#include <numbers>

#include "oracle.h"

namespace {

using Points = std::vector<Point>;
constexpr Rectangle unit_square = {{0, 0}, {1, 1}};

double total(const std::vector<VoronoiCell>& cells) {
    double sum = 0;
    for (const VoronoiCell& c : cells) sum += c.area;
    return sum;
}

// ---- Brute force: every cell cut by every site, in long double ----------------------------------

struct Corner {
    long double x, y;
};

// What of a convex polygon is nearer to the origin than to d.
std::vector<Corner> half(const std::vector<Corner>& in, Corner d) {
    auto excess = [&](Corner p) { return d.x * (p.x - d.x / 2) + d.y * (p.y - d.y / 2); };
    std::vector<Corner> out;
    for (size_t k = 0; k < in.size(); ++k) {
        const Corner p = in[k], q = in[(k + 1) % in.size()];
        const long double ep = excess(p), eq = excess(q);
        if (ep <= 0) out.push_back(p);
        if ((ep < 0 && eq > 0) || (ep > 0 && eq < 0)) {
            const long double t = ep / (ep - eq);
            out.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
        }
    }
    return out;
}

struct Measure {
    double area, x, y;  // centroid, from the site
    bool bounded;       // does not touch the start
};

Measure brute_force(const Points& sites, size_t i, const Rectangle& start) {
    const long double ox = sites[i].x, oy = sites[i].y;
    const Corner lo = {start.lo.x - ox, start.lo.y - oy}, hi = {start.hi.x - ox, start.hi.y - oy};
    std::vector<Corner> cell = {lo, {hi.x, lo.y}, hi, {lo.x, hi.y}};
    int copies = 0;
    for (const Point& p : sites) {
        const Corner d = {p.x - ox, p.y - oy};
        const bool same = d.x == 0 && d.y == 0;
        copies += same;
        if (!same) cell = half(cell, d);
    }
    Measure m{0, 0, 0, true};
    long double a = 0, x = 0, y = 0;
    for (size_t k = 0; k < cell.size(); ++k) {
        const Corner p = cell[k], q = cell[(k + 1) % cell.size()];
        const long double cross = p.x * q.y - q.x * p.y;
        a += cross / 2;
        x += cross * (p.x + q.x) / 6;
        y += cross * (p.y + q.y) / 6;
        m.bounded = m.bounded && p.x > lo.x && p.y > lo.y && p.x < hi.x && p.y < hi.y;
    }
    m.area = double(a / copies), m.x = double(x / a), m.y = double(y / a);
    return m;
}

// ---- Sites that are hard, each in its own way ---------------------------------------------------

Points scattered(int n, Random& random) {
    Points p;
    for (int i = 0; i < n; ++i) {
        const double x = random(), y = random();
        p.push_back({x, y});
    }
    return p;
}

// Sites that the rounding to 2^-50 leaves alone.
Points rounded(Points sites) {
    for (Point& p : sites) p = {(p.x + 4) - 4, (p.y + 4) - 4};
    return sites;
}

struct Hard {
    const char* name;
    Points sites;
};

std::vector<Hard> hard_cases(Random& random) {
    std::vector<Hard> cases;
    for (int n : {1, 2, 3, 4, 5, 8, 30, 200})
        cases.push_back({"scattered", rounded(scattered(n, random))});
    auto make = [&](const char* name, int n, auto site) {
        Points p;
        for (int i = 0; i < n; ++i) p.push_back(site(i));
        cases.push_back({name, rounded(p)});
    };
    make("a square lattice", 144, [](int i) { return Point{i % 12 / 12.0, i / 12 / 12.0}; });
    make("a lattice up to the border", 81, [](int i) { return Point{i % 9 / 8.0, i / 9 / 8.0}; });
    make("collinear, horizontal", 60, [&](int) { return Point{random(), 0.3}; });
    make("collinear, vertical", 60, [&](int) { return Point{0.999, random()}; });
    make("collinear, diagonal", 300, [](int i) { return Point{i / 300.0, i / 300.0}; });
    make("almost collinear", 100, [&](int i) { return Point{i / 100.0, 0.5 + 1e-14 * random()}; });
    make("a circle about its centre", 101, [](int i) {
        const double phi = 2 * std::numbers::pi * i / 100, r = i < 100 ? 0.375 : 0;
        return Point{0.5 + r * std::cos(phi), 0.5 + r * std::sin(phi)};
    });
    make("on the border", 80, [&](int i) {
        const double t = random();
        return i % 4 == 0   ? Point{0, t}
               : i % 4 == 1 ? Point{1, t}
               : i % 4 == 2 ? Point{t, 0}
                            : Point{t, 1};
    });
    make("corners", 4, [](int i) { return Point{double(i % 2), double(i / 2)}; });
    make("a cluster in a corner", 300, [&](int i) {
        return i == 0 ? Point{0.9, 0.8} : Point{1e-3 * random(), 1e-3 * random()};
    });
    make("a cluster of rounding errors", 50, [](int i) {
        return Point{0.5 + 0x1p-48 * (i % 7), 0.5 + 0x1p-48 * (i / 7)};
    });
    make("pairs", 60, [&](int i) {
        static Point last;
        if (i % 2 == 0) last = {random(), random()};
        return last;
    });
    make("all equal", 17, [](int) { return Point{0.25, 0.125}; });
    return cases;
}

}  // namespace

TEST_CASE("exact areas: one site, two, four, on the border, in a corner") {
    Voronoi v;
    CHECK(v.clipped(Points{}, unit_square).empty());
    CHECK(v.clipped(Points{{0.3, 0.9}}, unit_square)[0].area == 1);
    CHECK(v.clipped(Points{{0, 1}}, unit_square)[0].area == 1);
    const auto& two = v.clipped(Points{{0.25, 0.5}, {0.5, 0.5}}, unit_square);
    CHECK(two[0].area == 0.375);
    CHECK(two[1].area == 0.625);
    CHECK(two[0].offset.x == doctest::Approx(0.1875 - 0.25).epsilon(1e-15));
    CHECK(two[0].offset.y == 0);
    const auto& diagonal = v.clipped(Points{{0, 0}, {1, 1}}, unit_square);
    CHECK(diagonal[0].area == 0.5);
    CHECK(diagonal[1].area == 0.5);
    for (const auto& c : v.clipped(Points{{0, 0}, {1, 0}, {0, 1}, {1, 1}}, unit_square))
        CHECK(c.area == 0.25);
    // A diamond about the centre: half the diagonal of the cell is 1/4.
    const auto& five = v.clipped(
        Points{{0.5, 0.5}, {0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}}, unit_square);
    CHECK(five[0].area == doctest::Approx(0.125).epsilon(1e-15));
    for (size_t i = 1; i < 5; ++i) CHECK(five[i].area == doctest::Approx(0.875 / 4).epsilon(1e-15));
    // The same place, three times over, and another one.
    const auto& shared =
        v.clipped(Points{{0.25, 0.5}, {0.5, 0.5}, {0.25, 0.5}, {0.25, 0.5}}, unit_square);
    for (size_t i : {0, 2, 3}) CHECK(shared[i].area == 0.125);
    CHECK(shared[1].area == 0.625);
}

TEST_CASE("areas and centroids equal those of brute force in long double, hard cases too") {
    Random random(seed_of("areas equal brute force"));
    Voronoi v;
    for (const Hard& c : hard_cases(random)) {
        const auto cells = v.clipped(c.sites, unit_square);
        double area = 0, centroid = 0;
        for (size_t i = 0; i < c.sites.size(); ++i) {
            const Measure m = brute_force(c.sites, i, unit_square);
            area = std::max(area, std::abs(cells[i].area - m.area));
            if (m.area < 1e-9) continue;
            centroid = std::max(
                {centroid, std::abs(cells[i].offset.x - m.x), std::abs(cells[i].offset.y - m.y)});
        }
        INFO(std::string(c.name), ", ", c.sites.size(), " sites: area off by ", area, ", centroid ",
             centroid);
        CHECK(area < 1e-15 * double(c.sites.size()) + 4e-15);
        CHECK(centroid < 1e-9);
        CHECK(std::abs(total(cells) - 1) <= 1e-12 * double(c.sites.size()));
    }
}

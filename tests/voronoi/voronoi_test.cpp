// voronoi/voronoi_test.cpp  cell areas: exact cases, brute force, and the bias of clipping
#include "voronoi/voronoi.h"

#include <numbers>

#include "base/allocations.h"
#include "voronoi/scattered.h"

namespace {

using Points = std::vector<Site>;

double total(const std::vector<VoronoiCell>& cells) {
    double sum = 0;
    for (const VoronoiCell& c : cells) sum += c.area;
    return sum;
}

// ---- Brute force: every cell cut by every site, in long double ----------------------------------

struct Point {
    long double x, y;
};

// The part of a convex polygon that is nearer to the origin than to d.
std::vector<Point> half(const std::vector<Point>& in, Point d) {
    auto excess = [&](Point p) { return d.x * (p.x - d.x / 2) + d.y * (p.y - d.y / 2); };
    std::vector<Point> out;
    for (size_t k = 0; k < in.size(); ++k) {
        const Point p = in[k], q = in[(k + 1) % in.size()];
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
    double area, x, y;  // centroid, relative to the site
    bool bounded;       // does not touch the initial polygon
};

Measure brute_force(const Points& sites, size_t i, const Rectangle& start) {
    const long double ox = sites[i].x, oy = sites[i].y;
    const Point lo = {start.lo.x - ox, start.lo.y - oy}, hi = {start.hi.x - ox, start.hi.y - oy};
    std::vector<Point> cell = {lo, {hi.x, lo.y}, hi, {lo.x, hi.y}};
    int copies = 0;
    for (const Site& p : sites) {
        const Point d = {p.x - ox, p.y - oy};
        const bool same = d.x == 0 && d.y == 0;
        copies += same;
        if (!same) cell = half(cell, d);
    }
    Measure m{0, 0, 0, true};
    long double a = 0, x = 0, y = 0;
    for (size_t k = 0; k < cell.size(); ++k) {
        const Point p = cell[k], q = cell[(k + 1) % cell.size()];
        const long double cross = p.x * q.y - q.x * p.y;
        a += cross / 2;
        x += cross * (p.x + q.x) / 6;
        y += cross * (p.y + q.y) / 6;
        m.bounded = m.bounded && p.x > lo.x && p.y > lo.y && p.x < hi.x && p.y < hi.y;
    }
    m.area = double(a / copies), m.x = double(x / a), m.y = double(y / a);
    return m;
}

// ---- Hard sites ---------------------------------------------------------------------------------

// Rounds sites to multiples of 2^-50, so that the program does not round them again.
Points rounded(Points sites) {
    for (Site& p : sites) p = {(p.x + 4) - 4, (p.y + 4) - 4};
    return sites;
}

struct Hard {
    const char* name;
    Points sites;
};

std::vector<Hard> hard_cases(oracle::Random& random) {
    std::vector<Hard> cases;
    for (int n : {1, 2, 3, 4, 5, 8, 30, 200})
        cases.push_back({"scattered", rounded(scattered(uint64_t(n), random))});
    auto make = [&](const char* name, int n, auto site) {
        Points p;
        for (int i = 0; i < n; ++i) p.push_back(site(i));
        cases.push_back({name, rounded(p)});
    };
    make("a square lattice", 144, [](int i) { return Site{i % 12 / 12.0, i / 12 / 12.0}; });
    make("a lattice up to the border", 81, [](int i) { return Site{i % 9 / 8.0, i / 9 / 8.0}; });
    make("collinear, horizontal", 60, [&](int) { return Site{random(), 0.3}; });
    make("collinear, vertical", 60, [&](int) { return Site{0.999, random()}; });
    make("collinear, diagonal", 300, [](int i) { return Site{i / 300.0, i / 300.0}; });
    make("almost collinear", 100, [&](int i) { return Site{i / 100.0, 0.5 + 1e-14 * random()}; });
    make("a circle about its centre", 101, [](int i) {
        const double phi = 2 * std::numbers::pi * i / 100, r = i < 100 ? 0.375 : 0;
        return Site{0.5 + r * std::cos(phi), 0.5 + r * std::sin(phi)};
    });
    make("a small circle about its centre", 21, [](int i) {
        const double phi = 2 * std::numbers::pi * i / 20, r = i < 20 ? 0.1 : 0;
        return Site{0.6 + r * std::cos(phi), 0.3 + r * std::sin(phi)};
    });
    make("a turned lattice", 400, [](int i) {  // four sites about each corner, up to rounding
        const double x = (i % 20 - 9.5) / 40, y = (i / 20 - 9.5) / 40, c = std::cos(0.3),
                     s = std::sin(0.3);
        return Site{0.5 + c * x - s * y, 0.5 + s * x + c * y};
    });
    make("random places of a lattice", 120, [&](int) {
        const double x = std::floor(17 * random()) / 16, y = std::floor(17 * random()) / 16;
        return Site{x, y};
    });
    make("on the border", 80, [&](int i) {
        const double t = random();
        return i % 4 == 0   ? Site{0, t}
               : i % 4 == 1 ? Site{1, t}
               : i % 4 == 2 ? Site{t, 0}
                            : Site{t, 1};
    });
    make("corners", 4, [](int i) { return Site{double(i % 2), double(i / 2)}; });
    make("a cluster in a corner", 300, [&](int i) {
        return i == 0 ? Site{0.9, 0.8} : Site{1e-3 * random(), 1e-3 * random()};
    });
    make("a cluster of rounding errors", 50, [](int i) {
        return Site{0.5 + 0x1p-48 * (i % 7), 0.5 + 0x1p-48 * (i / 7)};
    });
    make("pairs", 60, [&](int i) {
        static Site last;
        if (i % 2 == 0) last = {random(), random()};
        return last;
    });
    make("crowds at three places", 450, [](int i) {
        return Site{0.25 + 0.25 * (i % 3), 0.5 - 0.125 * (i % 3)};
    });
    make("all equal", 17, [](int) { return Site{0.25, 0.125}; });
    return cases;
}

}  // namespace

TEST_CASE("exact areas: one site, two, four, on the border, in a corner") {
    const struct {
        Points sites;
        std::vector<double> areas;
    } rows[] = {
        {{}, {}},
        {{{0.3, 0.9}}, {1}},
        {{{0, 1}}, {1}},
        {{{0.25, 0.5}, {0.5, 0.5}}, {0.375, 0.625}},
        {{{0, 0}, {1, 1}}, {0.5, 0.5}},
        {{{0, 0}, {1, 0}, {0, 1}, {1, 1}}, {0.25, 0.25, 0.25, 0.25}},
        // A diamond about the centre: half the diagonal of the cell is 1/4.
        {{{0.5, 0.5}, {0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}},
         {0.125, 0.21875, 0.21875, 0.21875, 0.21875}},
        // Three sites coincide, and one does not.
        {{{0.25, 0.5}, {0.5, 0.5}, {0.25, 0.5}, {0.25, 0.5}}, {0.125, 0.625, 0.125, 0.125}}};
    Voronoi v;
    for (const auto& [sites, areas] : rows) {
        const auto& cells = v.clipped(sites, unit_square);
        REQUIRE(cells.size() == areas.size());
        for (size_t i = 0; i < areas.size(); ++i) {
            CAPTURE(cells.size());
            CAPTURE(i);
            if (areas.size() == 5)
                CHECK(cells[i].area == doctest::Approx(areas[i]).epsilon(1e-15));
            else
                CHECK(cells[i].area == areas[i]);
        }
    }
    const auto& two = v.clipped(rows[3].sites, unit_square);
    CHECK(two[0].offset.x == doctest::Approx(0.1875 - 0.25).epsilon(1e-15));
    CHECK(two[0].offset.y == 0);
}

TEST_CASE("areas and centroids equal those of brute force in long double, hard cases too") {
    oracle::Random random(seed_here());
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
        // The outward normals around the window add up to 0.  On one side they add up to its
        // length, minus what cells that reach from side to side hide.
        Site all;
        double east = 0;
        for (const VoronoiCell& cell : cells) {
            all = {all.x + cell.rim.x, all.y + cell.rim.y};
            east += std::max(cell.rim.x, 0.0);
        }
        CHECK(std::hypot(all.x, all.y) < 1e-12);
        CHECK(east <= 1 + 1e-12);
        if (std::string(c.name) == "pairs" || c.sites.size() == 200) CHECK(east >= 1 - 1e-12);
    }
}

TEST_CASE("sites nearer than 2^-51 are at the same place, though their squares vanish") {
    Voronoi v;
    for (double near : {0x1p-52, 1e-100, 1e-160, 1e-200, 1e-320}) {
        const auto cells = v.clipped(Points{{0, 0}, {near, 0}, {0, near}, {0.5, 0.5}}, unit_square);
        for (size_t i : {0, 1, 2}) {
            CHECK(cells[i].copies == 3);
            CHECK(cells[i].area == doctest::Approx(0.125 / 3).epsilon(1e-14));
        }
        CHECK(cells[3].area == 0.875);
    }
}

TEST_CASE(
    "a torus: brute force with all copies around; translations change nothing; other windows") {
    oracle::Random random(seed_here());
    Voronoi v;
    for (const Rectangle& window : {unit_square, Rectangle{{-1, 2}, {1, 3}}})
        for (uint64_t n : {1, 2, 3, 7, 40, 100}) {
            // The cells of a cluster of 100 are larger than their number suggests.
            const Rectangle tenth = {
                window.lo,
                {window.lo.x + 0.1 * window.width(), window.lo.y + 0.1 * window.height()}};
            const Points sites = scattered(n, random, n == 100 ? tenth : window);
            Points all, moved = sites;
            for (int copy = 0; copy < 25; ++copy)
                for (const Site& p : sites)
                    all.push_back({p.x + (copy % 5 - 2) * window.width(),
                                   p.y + (copy / 5 - 2) * window.height()});
            const auto cells = v.torus(sites, window), clipped = v.clipped(sites, window);
            double off = 0;
            for (size_t i = 0; i < n; ++i) {
                const Measure m = brute_force(all, 12 * n + i, grown(window, 3));
                off = std::max(off, std::abs(cells[i].area - m.area));
                CHECK(std::abs(clipped[i].area - brute_force(sites, i, window).area) <
                      2e-15 * double(n) + 8e-15);
            }
            // Copies up to 5 away are rounded by 4e-16, times the lengths of a cell's edges.
            CHECK(off < 1e-12);
            CHECK(std::abs(total(cells) - window.area()) <= 1e-12 * double(n));
            for (Site& p : moved) p.x += p.x + 0.7 > window.hi.x ? 0.7 - window.width() : 0.7;
            const auto again = v.torus(moved, window);
            for (size_t i = 0; i < n; ++i)
                CHECK(again[i].area == doctest::Approx(cells[i].area).epsilon(1e-12));
        }
    CHECK(v.torus(Points{{0.5, 0.5}, {0.5, 0.5}}, unit_square)[1].area == 0.5);
    // Opposite borders coincide, also for periods that are no binary fractions.
    CHECK(v.torus(Points{{0, 0.5}, {1, 0.5}}, unit_square)[1].area == 0.5);
    const auto& shared = v.torus(Points{{0.2, 0.1}, {0.2, 0.4}, {0.6, 0.2}}, {{0, 0.1}, {1, 0.4}});
    CHECK(shared[0].copies == 2);
    CHECK(shared[0].area == shared[1].area);
}

TEST_CASE("a strip about the window: brute force; what is bounded, inside, settled") {
    oracle::Random random(seed_here());
    Voronoi v;
    int bounded = 0, inside = 0, settled = 0, all = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const int n = 12, m = trial % 30;
        const Rectangle domain = grown(unit_square, 0.5);
        Points sites = scattered(n, random);
        while (int(sites.size()) < n + m) {
            const Site p = {2 * random() - 0.5, 2 * random() - 0.5};
            if (p.x < 0 || p.y < 0 || p.x > 1 || p.y > 1) sites.push_back(p);
        }
        sites = rounded(sites);
        const auto cells = v.stretched(sites, n, domain);
        REQUIRE(cells.size() == n);
        Points more = sites;  // with sites anywhere outside the domain
        for (int k = 0; k < 40; ++k) {
            const Site p = {5 * random() - 2, 5 * random() - 2};
            if (p.x < -0.5 || p.y < -0.5 || p.x > 1.5 || p.y > 1.5) more.push_back(p);
        }
        for (size_t i = 0; i < n; ++i, ++all) {
            const Measure m0 = brute_force(sites, i, grown(domain, 2 * domain.width())),
                          cut = brute_force(sites, i, domain);
            const VoronoiCell& cell = cells[i];
            CHECK(cell.bounded == m0.bounded);
            CHECK(cell.inside == cut.bounded);
            if (m0.bounded) CHECK(std::abs(cell.area - m0.area) < 1e-12);
            const double after = brute_force(more, i, grown(domain, 2 * domain.width())).area;
            if (cell.settled) CHECK(std::abs(after - m0.area) < 1e-14);
            CHECK(cell.settled <= cell.inside);
            CHECK(cell.inside <= cell.bounded);
            bounded += cell.bounded, inside += cell.inside, settled += cell.settled;
        }
    }
    // Each kind occurs often.
    CHECK(settled > 50);
    CHECK(inside > settled + 50);
    CHECK(bounded > inside + 10);
    CHECK(all > bounded + 10);
}

TEST_CASE("who is a neighbour: it shares an edge, and it is mutual") {
    oracle::Random random(seed_here());
    Voronoi v;
    v.with_neighbours = true;
    const Points lattice = {{0.25, 0.5}, {0.5, 0.5}, {0.75, 0.5}, {0.5, 0.25}, {0.5, 0.75}};
    v.clipped(lattice, unit_square);
    std::vector<uint32_t> of_centre(v.neighbours(1).begin(), v.neighbours(1).end());
    std::sort(of_centre.begin(), of_centre.end());
    CHECK(of_centre == std::vector<uint32_t>{0, 2, 3, 4});
    const Points sites = scattered(300, random);
    v.clipped(sites, unit_square);
    size_t edges = 0, one_way = 0;
    for (uint32_t i = 0; i < sites.size(); ++i)
        for (uint32_t j : v.neighbours(i)) {
            ++edges;
            const auto back = v.neighbours(j);
            one_way += std::find(back.begin(), back.end(), i) == back.end();
        }
    CHECK(one_way == 0);
    // Euler: at most 3 n - 6 edges, each seen twice; the window hides a few at the border.
    CHECK(edges <= 2 * (3 * 300 - 6));
    CHECK(edges > 2 * (3 * 300 - 6 - 2 * 4 * 18));
}

TEST_CASE("many sites, scattered, in crowds, clustered or in line: the tree, and no square of n") {
    oracle::Random random(seed_here());
    Voronoi v;
    Points sites = scattered(250000, random), crowds = sites, line = sites, cluster;
    crowds.resize(30000);  // at 1000 distinct points
    for (size_t i = 1000; i < crowds.size(); ++i) crowds[i] = crowds[i % 1000];
    line.resize(20000);
    for (Site& p : line) p.y = 0.25 + p.x / 2;
    cluster = scattered(20000, random, {{0, 0}, {1e-4, 1e-4}});
    cluster[0] = {1, 1};
    for (const Points* p : {&sites, &line, &cluster, &crowds})
        CHECK(std::abs(total(v.clipped(*p, unit_square)) - 1) < 1e-9);
    const auto& cells = v.clipped(crowds, unit_square);
    CHECK(cells[7].area == cells[29007].area);
    CHECK(cells[7].copies == 30);
}

TEST_CASE("once warmed up, no memory is allocated: all windows, copies and clusters, too") {
    oracle::Random random(seed_here());
    Points spread = scattered(1000, random), copies = spread,
           cluster = scattered(1000, random, {{0, 0}, {1e-4, 1e-4}});
    cluster[0] = {1, 1};
    for (size_t i = 100; i < copies.size(); ++i) copies[i] = copies[i % 100];
    Voronoi v;
    v.with_neighbours = true;
    for (const Points* sites : {&spread, &cluster, &copies}) {
        size_t needed[2];
        for (size_t& count : needed) {
            const size_t before = allocations;
            v.clipped(*sites, unit_square);
            v.stretched(*sites, 500, unit_square);
            v.torus(*sites, unit_square);
            count = allocations - before;
        }
        CHECK(needed[1] == 0);
        if (sites == &spread) CHECK(needed[0] > 0);
    }
}

TEST_CASE("a site outside the window, no window, a line of a window are refused") {
    Voronoi v;
    CHECK_THROWS_AS(v.clipped(Points{{1.5, 0.5}}, unit_square), std::domain_error);
    CHECK_THROWS_AS(v.clipped(Points{{NAN, 0.5}}, unit_square), std::domain_error);
    CHECK_THROWS_AS(v.stretched(Points{{0, 0}}, 2, unit_square), std::domain_error);
    for (const Rectangle& line :
         {Rectangle{{0, 0}, {0, 1}}, {{0, 0}, {1, 0}}, {{0, 0}, {1, 1e-4}}}) {
        CHECK_THROWS_AS(v.clipped(Points{{0, 0}}, line), std::domain_error);
        CHECK_THROWS_AS(v.torus(Points{{0, 0}}, line), std::domain_error);
    }
    for (const Rectangle& none :
         {Rectangle{{0, 0}, {1, NAN}}, {{NAN, 0}, {1, 1}}, {{0, 0}, {1, INFINITY}}}) {
        CHECK_THROWS_AS(v.clipped(Points{}, none), std::domain_error);
        CHECK_THROWS_AS(v.torus(Points{}, none), std::domain_error);
    }
    for (const Rectangle& thin : {Rectangle{{0, 0}, {1, 1e-3}}, {{0, 0}, {2e-3, 2}}})
        for (const auto& cells : {v.clipped(Points{{0, 0}}, thin), v.torus(Points{{0, 0}}, thin)})
            CHECK(cells[0].area == doctest::Approx(thin.area()).epsilon(1e-12));
}

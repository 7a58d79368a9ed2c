// voronoi/cell_test.cpp  one cell: wrapping and cutting agree, also for ties and near-ties
#include "voronoi/cell.h"

#include <numbers>

#include "voronoi/scattered.h"

namespace {

constexpr Rectangle frame = {{-2, -1}, {1, 3}}, about_the_site = {{-1, -1}, {1, 1}};

double area_of(Outline o) {
    double twice = 0;
    for (size_t k = 0; k < o.size(); ++k) {
        const Site p = o[k].p, q = o[(k + 1) % o.size()].p;
        twice += p.x * q.y - q.x * p.y;
    }
    return twice / 2;
}

struct Both {
    HalfPlanes lines;
    ConvexPolygon polygon;
    Outline wrapped;

    // Makes the cell of the origin.
    void make(const std::vector<Site>& others) {
        std::vector<double> x, y;
        for (const Site& p : others) x.push_back(p.x), y.push_back(p.y);
        x.resize(x.size() + 8), y.resize(y.size() + 8);
        lines.start(frame);
        REQUIRE(lines.add(x.data(), y.data(), 0, uint32_t(others.size()), {0, 0}));
        wrapped = lines.wrap(lines.nearest());
        polygon.start(frame);
        for (uint32_t k = 0; k < others.size(); ++k) polygon.cut(bisector(others[k], k));
    }
};

}  // namespace

TEST_CASE("lines are refused before a vector beyond them leaves the arrays") {
    const std::vector<double> x(2 * cell::lanes, 0.5);
    HalfPlanes lines;
    lines.start({{-1, -1}, {1, 1}});
    while (lines.size() < 127 && lines.add(x.data(), x.data(), 0, 1, {0, 0})) {
    }
    lines.add(x.data(), x.data(), 0, cell::lanes, {0, 0});
    CHECK(lines.size() <= 128);
}

TEST_CASE("no neighbour: the frame, also if the site is on its border or in a corner") {
    HalfPlanes lines;
    for (const Rectangle& r : {frame, Rectangle{{0, -1}, {3, 1}}, Rectangle{{-4, -4}, {0, 0}}}) {
        lines.start(r);
        const Outline o = lines.wrap(lines.nearest());
        REQUIRE(o.size() == 4);
        CHECK(area_of(o) == r.area());
        for (const Corner& c : o) CHECK(c.neighbour == -1);
    }
}

TEST_CASE("a cell that is wrapped is the cell that is cut: scattered, lattices, circles") {
    oracle::Random random(seed_here());
    Both both;
    double off = 0;
    int corners = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const int kind = trial % 3, n = 1 + int(random() * 40), steps = 3 + int(random() * 9);
        const double turn = 2 * std::numbers::pi * random();
        std::vector<Site> others;
        while (int(others.size()) < n) {
            double x = 2 * random() - 1, y = 2 * random() - 1;
            if (kind == 1) x = std::round(x * steps) / steps, y = std::round(y * steps) / steps;
            if (kind == 2) {  // bisectors through few points, up to rounding
                const double phi = turn + 2 * std::numbers::pi * std::round(x * steps) / steps;
                x = std::cos(phi), y = std::sin(phi);
            }
            if (x != 0 || y != 0) others.push_back({x, y});
        }
        both.make(others);
        REQUIRE(!both.wrapped.empty());
        off = std::max(off, std::abs(area_of(both.wrapped) - area_of(both.polygon.outline())));
        corners = std::max(corners, int(both.wrapped.size()));
    }
    CHECK(off < 2e-14);  // distances are up to 12
    CHECK(corners >= 10);
}

TEST_CASE("corners go around counterclockwise, and each edge knows whose it is") {
    oracle::Random random(seed_here());
    Both both;
    for (int trial = 0; trial < 300; ++trial) {
        const std::vector<Site> others = scattered(20, random, about_the_site);
        both.make(others);
        for (const Outline o : {both.wrapped, both.polygon.outline()})
            for (size_t k = 0; k < o.size(); ++k) {
                const Corner &c = o[k], &next = o[(k + 1) % o.size()];
                CHECK(c.p.x * next.p.y >= next.p.x * c.p.y);
                if (c.neighbour < 0) {
                    const Site mid = {(c.p.x + next.p.x) / 2, (c.p.y + next.p.y) / 2};
                    const Rectangle inner = grown(frame, -1e-12);
                    CHECK(!inner.contains(mid));
                } else {
                    const HalfPlane b = bisector(others[size_t(c.neighbour)], 0);
                    for (const Site p : {c.p, next.p})
                        CHECK(std::abs(b.d.x * p.x + b.d.y * p.y - b.h) < 1e-13);
                }
            }
    }
}

TEST_CASE("only lines that cut a corner off are kept") {
    Both both;
    both.make({{1, 0}, {0, 1}, {-1, 0}, {0, -1}});
    const int before = both.lines.size();
    std::vector<double> x = {2, 0.9, 0.6, 5, -3}, y = {0, 0, 0.6, 5, 0};
    x.resize(16, 0.1), y.resize(16, 0.1);  // must stay unread: they would cut
    REQUIRE(both.lines.add(x.data(), y.data(), 0, 5, {0, 0}));
    both.lines.keep_cutters(before, both.wrapped);
    CHECK(both.lines.size() == before + 2);
    const Outline o = both.lines.wrap(both.lines.nearest());
    // The unit square minus a strip of 0.05 and minus a corner: x + y < 0.6, between (0.45, 0.15)
    // and (0.1, 0.5).
    CHECK(area_of(o) == doctest::Approx(0.95 - 0.35 * 0.35 / 2).epsilon(1e-14));
}

TEST_CASE("the flower's box holds the discs about the corners through the site") {
    const std::vector<Corner> square = {{{1, 0}}, {{0, 1}}, {{-2, 0}}, {{0, -1}}};
    const Rectangle box = flower_box(square);
    CHECK((box.lo.x == -4 && box.hi.x == 2));
    CHECK((box.lo.y == -2 && box.hi.y == 2));
}

TEST_CASE("more neighbours than there is room for, more corners than there is room for") {
    std::vector<double> x, y;
    for (int k = 0; k < 140; ++k) {
        x.push_back(std::cos(2 * std::numbers::pi * k / 100));
        y.push_back(std::sin(2 * std::numbers::pi * k / 100));
    }
    HalfPlanes lines;
    lines.start(frame);
    CHECK(!lines.add(x.data(), y.data(), 0, 132, {0, 0}));
    lines.start(frame);
    REQUIRE(lines.add(x.data(), y.data(), 0, 100, {0, 0}));
    CHECK(lines.wrap(lines.nearest()).empty());
    lines.start(frame);
    CHECK(lines.add(x.data(), y.data(), 0, 20, {0, 0}));
    CHECK(!lines.wrap(lines.nearest()).empty());
}

TEST_CASE("a neighbour at the same place is seen, one that is removed is not") {
    const std::vector<double> x = {1, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                              y = {1, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    HalfPlanes lines;
    lines.start(frame);
    REQUIRE(lines.add(x.data(), y.data(), 0, 3, {0.5, 0.5}));
    CHECK(lines.is_copy(lines.nearest()));
    lines.remove(lines.nearest());
    CHECK(!lines.is_copy(lines.nearest()));
    CHECK(lines.wrap(lines.nearest()).size() >= 4);
}

TEST_CASE("a neighbour within rounding of the site does not cut the site away") {
    oracle::Random random(seed_here());
    ConvexPolygon polygon;
    for (int trial = 0; trial < 1000; ++trial) {
        // Rounding moves corners by 1e-16 or so, more than the distance of these neighbours.
        const double d = 1e-18 * (1 + random()), turn = 2 * std::numbers::pi * random();
        polygon.start({{-random(), -random()}, {random(), random()}});
        for (int k = 0; k < 6; ++k) {
            const double phi = turn + std::numbers::pi * k * (k % 2 ? 1 : 0.3);
            polygon.cut(bisector({d * std::cos(phi), d * std::sin(phi)}, 0));
        }
        REQUIRE(polygon.outline().size() >= 3);
    }
}

// mesh/ears_test.cpp  polygons cut into triangles that cover them once, whatever their corners
#include "mesh/ears.h"

#include <doctest/doctest.h>

#include "base/rng.h"

namespace {

using namespace penumbra;
using mesh::area_vector, mesh::Corners, mesh::Cuts, mesh::Ears, mesh::face_one_way, mesh::fan_of,
    mesh::is_folded;

const int64_t plenty = 1 << 28;

std::optional<Cuts> cut(const Corners& c, int64_t left = plenty) { return Ears(c).cut(left); }

// The areas of triangles on the polygon's side.
std::vector<double> areas(const Corners& c, const Cuts& triangles) {
    const vec3 normal = unit(area_vector(c));
    std::vector<double> all;
    for (const auto& [i, j, k] : triangles)
        all.push_back(double(dot(cross(c[j] - c[i], c[k] - c[i]), normal)) / 2);
    return all;
}

// n - 2 triangles, none turned over, of the polygon's area.
void check(const Corners& c) {
    const auto triangles = cut(c);
    REQUIRE(triangles);
    CHECK(triangles->size() == c.size() - 2);
    double sum = 0;
    for (double area : areas(c, *triangles)) {
        CHECK(area > 0);
        sum += area;
    }
    CHECK(sum == doctest::Approx(double(length(area_vector(c))) / 2).epsilon(1e-5));
}

Corners rotated(Corners c, size_t start) {
    std::rotate(c.begin(), c.begin() + ptrdiff_t(start), c.end());
    return c;
}

// A number of [0,1) for each seed and index.
real number(uint64_t seed, uint64_t i) { return to_unit(mix(mix(seed) + i)); }

// A polygon in the plane, turned in space and rounded to so many digits.
Corners placed(const std::vector<vec2>& flat, uint64_t seed, double digits = 0) {
    const Frame f = frame(
        unit({number(seed, 1) - real(.5), number(seed, 2) - real(.5), number(seed, 3) - real(.5)}));
    Corners c;
    for (vec2 p : flat) {
        vec3 at = p.x * f.x + p.y * f.y;
        if (digits > 0)
            for (auto k : axis) at.*k = real(std::round(double(at.*k) * digits) / digits);
        c.push_back(at);
    }
    return c;
}

// A rectangle of 4 by 3 with so many points inside each edge.
std::vector<vec2> roof(int points) {
    std::vector<vec2> all;
    const real corners[5][2] = {{0, 0}, {4, 0}, {4, 3}, {0, 3}, {0, 0}};
    for (int e = 0; e < 4; ++e)
        for (int i = 0; i <= points; ++i) {
            const real t = real(i) / real(points + 1);
            all.push_back({corners[e][0] + t * (corners[e + 1][0] - corners[e][0]),
                           corners[e][1] + t * (corners[e + 1][1] - corners[e][1])});
        }
    return all;
}

}  // namespace

TEST_CASE("an U, a comb, a spiral and a ring with a bridge, from whichever corner") {
    const Corners u = {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {2, 2, 0},
                       {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    Corners comb = {{0, -1, 0}, {20, -1, 0}};
    for (int i = 20; i >= 0; --i) comb.push_back({real(i), real(i % 2 ? 0 : 5), 0});
    Corners spiral;
    for (int i = 0; i <= 40; ++i)
        spiral.push_back(
            {real((1 + i * .1) * std::cos(i * .4)), real((1 + i * .1) * std::sin(i * .4)), 0});
    for (int i = 40; i >= 0; --i)
        spiral.push_back(
            {real((.8 + i * .1) * std::cos(i * .4)), real((.8 + i * .1) * std::sin(i * .4)), 0});
    const Corners ring = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                          {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    for (const Corners& c : {u, comb, spiral, ring})
        for (size_t start = 0; start < c.size(); ++start) {
            CAPTURE(start);
            check(rotated(c, start));
            Corners back = rotated(c, start);
            std::ranges::reverse(back);
            check(back);
        }
}

TEST_CASE("a flat roof with points inside its edges, turned at random and rounded to 3 digits") {
    for (int points : {0, 1, 3, 4, 5, 7, 9, 30})
        for (uint64_t seed = 0; seed < 100; ++seed) {
            CAPTURE(points);
            CAPTURE(seed);
            const Corners c = placed(roof(points), seed, 1000);
            const auto triangles = cut(c);
            REQUIRE(triangles);
            CHECK(triangles->size() == c.size() - 2);
            double sum = 0;
            for (double area : areas(c, *triangles)) {
                // No sliver along an edge, which rounding may turn over, if there is a choice.
                CHECK((area > 0 || (points == 30 && area > -1e-4)));
                sum += area;
            }
            CHECK(sum == doctest::Approx(12).epsilon(2e-3));
        }
    check(placed(roof(4), 0));  // in line to all digits
    Corners axis_aligned;
    for (vec2 p : roof(4)) axis_aligned.push_back({p.x, p.y, 0});
    check(axis_aligned);
}

TEST_CASE("random stars, seen from anywhere") {
    for (uint64_t seed = 0; seed < 300; ++seed) {
        CAPTURE(seed);
        const size_t n = 4 + seed % 40;
        std::vector<vec2> star;
        for (size_t i = 0; i < n; ++i) {
            const real r = real(.05) + number(seed, 10 + i), turn = real(i) / real(n);
            star.push_back({r * std::cos(2 * pi * turn), r * std::sin(2 * pi * turn)});
        }
        check(placed(star, seed));
    }
}

TEST_CASE("random polygons with holes, which bridges join") {
    for (uint64_t seed = 0; seed < 300; ++seed) {
        CAPTURE(seed);
        const size_t n = 3 + seed % 7;
        Corners c;
        for (size_t i = 0; i < n; ++i) {
            const real turn = real(i) / real(n), angle = 2 * pi * turn;
            const vec3 outer{10 * std::cos(angle), 10 * std::sin(angle), 0};
            c.push_back(outer);
            if (number(seed, i) < real(.2)) continue;
            for (size_t k = 0; k <= 5; ++k) {
                const real r = k % 5 == 0 ? real(.8) : real(.2) + number(seed, 9 * i + k) / 2;
                const real to = angle - 2 * pi * real(k % 5) / 5;
                c.push_back(outer * real(.62) + vec3{r * std::cos(to), r * std::sin(to), 0});
            }
            c.push_back(outer);
        }
        check(c);
    }
}

TEST_CASE("what crosses itself is not cut, nor what takes too long") {
    CHECK(!cut({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}}));  // a bow tie
    Corners pentagram;
    for (int i = 0; i < 5; ++i)
        pentagram.push_back({real(std::cos(i * 2.513274)), real(std::sin(i * 2.513274)), 0});
    CHECK(!cut(pentagram));
    Corners comb = {{0, -1, 0}, {2000, -1, 0}};
    for (int i = 2000; i >= 0; --i) comb.push_back({real(i), real(i % 2 ? 0 : 5), 0});
    // 6.5 million tests.
    CHECK(!cut(comb, 1000000));
    CHECK(!cut(comb, 5000000));
    CHECK(cut(comb, 7000000));
}

TEST_CASE("triangles face one way, or are folded by more than a thousandth of the polygon") {
    const Corners c = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    CHECK(fan_of(c) == Cuts{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    CHECK(!face_one_way(c, fan_of(c)));
    CHECK(!is_folded(c, fan_of(c)));
    CHECK(face_one_way(c, *cut(c)));
    CHECK(is_folded(c, {{0, 3, 2}}));
    const Corners dented = {{0, 0, 0}, {1, real(.003), 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}},
                  dent = {{0, 0, 0}, {1, real(.03), 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}},
                  bow_tie = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                  line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    CHECK(!is_folded(dented, fan_of(dented)));
    CHECK(is_folded(dent, fan_of(dent)));
    CHECK(is_folded(bow_tie, fan_of(bow_tie)));
    CHECK(!is_folded(line, fan_of(line)));
}

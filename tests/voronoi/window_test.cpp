// voronoi/window_test.cpp  sites in a window: units, images on a torus, copies
#include "voronoi/window.h"

#include <doctest/doctest.h>

namespace {

using namespace penumbra;
using Points = std::vector<Site>;

}  // namespace

TEST_CASE("sites are seen from the window's corner, in units of its greater side") {
    WindowSites s;
    s.begin({{10, -5}, {18, -3}}, 0);
    s.add(Points{{10, -5}, {18, -3}, {12, -4.5}});
    CHECK(s.unit() == 8);
    CHECK((s.sites()[0].x == 0 && s.sites()[0].y == 0));
    CHECK((s.sites()[1].x == 1 && s.sites()[1].y == 0.25));
    CHECK((s.sites()[2].x == 0.25 && s.sites()[2].y == 0.0625));
    CHECK_THROWS_AS(s.add(Points{{9.9, -4}}), std::domain_error);
}

TEST_CASE("a repeated window: all images that the domain holds, each once") {
    WindowSites s;
    s.begin({{0, 0}, {2, 1}}, 0.5);  // the domain is [-1/4, 5/4] x [-1/4, 3/4], the period 1 x 1/2
    s.add(Points{{1, 0.5}, {0.25, 0.25}});
    s.repeat(2, 1);
    const Points expected = {{0.5, 0.25},    {0.5, -0.25},   {0.5, 0.75},   {0.125, 0.125},
                             {0.125, 0.625}, {1.125, 0.125}, {1.125, 0.625}};
    CHECK(s.sites().size() == expected.size());
    for (const Site& e : expected)
        CHECK(std::count_if(s.sites().begin(), s.sites().end(),
                            [&](Site p) { return p.x == e.x && p.y == e.y; }) == 1);
}

TEST_CASE("a window that is longer one way is repeated more often the other way") {
    // Domains of [-1/2, 3/2] along the window, periods of 1 x 1/4: rows -2 ... 2 hold the middle.
    for (bool tall : {false, true}) {
        WindowSites s;
        s.begin(tall ? Rectangle{{0, 0}, {1, 4}} : Rectangle{{0, 0}, {4, 1}}, 2);
        s.add(tall ? Points{{0.5, 2}} : Points{{2, 0.5}});
        s.repeat(tall ? 1 : 4, tall ? 4 : 1);
        CHECK(s.sites().size() == 15);
    }
}

TEST_CASE("sites at the same place know the first of them, which knows how many they are") {
    WindowSites s;
    s.begin({{0, 0}, {1, 1}}, 0);
    s.add(Points{{0.5, 0.5}, {0.5, 0.25}, {0.5, 0.5}, {0, 0.5}, {0.5, 0.5}, {0.5, 0.25}});
    CHECK(s.first_of().empty());
    s.find_copies();
    const std::vector<uint32_t> first(s.first_of().begin(), s.first_of().end());
    CHECK(first == std::vector<uint32_t>{0, 1, 0, 3, 0, 1});
    CHECK(s.copies(0) == 3);
    CHECK(s.copies(1) == 2);
    CHECK(s.copies(3) == 1);
    s.begin({{0, 0}, {1, 1}}, 0);
    CHECK(s.first_of().empty());
}

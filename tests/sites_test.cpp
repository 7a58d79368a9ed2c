// sites_test.cpp  every site is in its bucket, and in the tree where it is looked for
#include "../src/sites.h"

#include <doctest/doctest.h>

#include "expect.h"

namespace {

constexpr Rectangle domain = {{-1, 2}, {3, 3}};

std::vector<Site> scattered(int n, Random& random) {
    std::vector<Site> sites;
    for (int k = 0; k < n; ++k) {
        const double x = -1 + 4 * random(), y = 2 + random();
        sites.push_back({x, y});
    }
    return sites;
}

}  // namespace

TEST_CASE("buckets hold every site once, where it is") {
    Random random(seed_here());
    Buckets b;
    for (int n : {0, 1, 2, 7, 1000}) {
        std::vector<Site> sites = scattered(n, random);
        if (n == 7) sites[0] = domain.lo, sites[1] = domain.hi;
        b.sort(sites, {}, domain);
        REQUIRE(b.size() == uint32_t(n));
        CHECK(b.x.size() == size_t(n) + Buckets::spare);
        std::vector<int> seen(size_t(n), 0);
        for (int j = 0; j < b.rows; ++j)
            for (int i = 0; i < b.columns; ++i)
                for (uint32_t k = b.start(i, j); k < b.start(i + 1, j); ++k) {
                    const Site p = b.site(k), q = sites[b.id[k]];
                    CHECK(p.x == q.x);
                    CHECK(p.y == q.y);
                    const Rectangle bucket = {{b.left(i), b.bottom(j)},
                                              {b.left(i + 1), b.bottom(j + 1)}};
                    CHECK(grown(bucket, 1e-12).contains(p));
                    ++seen[b.id[k]];
                }
        CHECK(std::count(seen.begin(), seen.end(), 1) == n);
        if (n == 1000) {  // about square, and about as many as was meant
            CHECK(b.columns == doctest::Approx(4 * b.rows).epsilon(0.1));
            CHECK(n / (b.rows * b.columns) == doctest::Approx(Buckets::per_bucket).epsilon(0.1));
        }
    }
}

TEST_CASE("copies are left out of the buckets") {
    Buckets b;
    const std::vector<Site> sites = {{0, 2.5}, {1, 2.5}, {0, 2.5}, {0, 2.5}};
    const std::vector<uint32_t> first_of = {0, 1, 0, 0};
    b.sort(sites, first_of, domain);
    REQUIRE(b.size() == 2);
    CHECK(b.id[0] + b.id[1] == 1);
}

TEST_CASE("the tree visits all sites of the boxes that meet a disc, and few others") {
    Random random(seed_here());
    Buckets b;
    SiteTree tree;
    for (int n : {1, 8, 9, 500}) {
        const std::vector<Site> sites = scattered(n, random);
        b.sort(sites, {}, domain);
        CHECK(tree.empty());
        tree.grow(b);
        CHECK(!tree.empty());
        for (int trial = 0; trial < 20; ++trial) {
            const Site centre = {-1 + 4 * random(), 2 + random()};
            const double r2 = random() * random();
            auto meets = [&](const Rectangle& box) { return distance2(box, centre) <= r2; };
            std::vector<int> seen(size_t(n), 0);
            int visited = 0;
            CHECK(tree.each(centre, meets, [&](uint32_t k) { return ++seen[k], ++visited, true; }));
            int within = 0;
            for (uint32_t k = 0; k < b.size(); ++k) {
                const Site d = b.site(k) - centre;
                const bool in = d.x * d.x + d.y * d.y <= r2;
                within += in;
                CHECK(seen[k] >= int(in));
                CHECK(seen[k] <= 1);
            }
            if (n == 500) CHECK(visited <= 2 * within + 60);
            // It stops where it is told to.
            int until = visited / 2;
            const bool all = tree.each(centre, meets, [&](uint32_t) { return --until >= 0; });
            CHECK(all == (visited == 0));
        }
        tree.clear();
    }
}

TEST_CASE("the distance of a point from a rectangle") {
    CHECK(distance2(domain, {0, 2.5}) == 0);
    CHECK(distance2(domain, {5, 2.5}) == 4);
    CHECK(distance2(domain, {0, 0}) == 4);
    CHECK(distance2(domain, {-4, 7}) == 25);
}

// voronoi/sites_test.cpp  every site is in its bucket, and in its place in the tree
#include "voronoi/sites.h"

#include <optional>

#include "voronoi/scattered.h"

namespace {

constexpr Rectangle domain = {{-1, 2}, {3, 3}};

}  // namespace

TEST_CASE("buckets hold every site once, where it is") {
    oracle::Random random(seed_here());
    Buckets b;
    for (int n : {0, 1, 2, 7, 1000}) {
        std::vector<Site> sites = scattered(uint64_t(n), random, domain);
        if (n == 7) sites[0] = domain.lo, sites[1] = domain.hi;
        b.sort(sites, {}, domain);
        REQUIRE(b.size() == uint32_t(n));
        CHECK(b.x.size() == size_t(n) + Buckets::spare);
        std::vector<int> seen(size_t(n), 0);
        for (int j = 0; j < b.rows; ++j)
            for (int i = 0; i < b.columns; ++i)
                for (uint32_t k = b.start(i, j); k < b.start(i + 1, j); ++k) {
                    const Site p = b.site(k), q = sites[b.id[k]];
                    CHECK((p.x == q.x && p.y == q.y));
                    const Rectangle bucket = {{b.left(i), b.bottom(j)},
                                              {b.left(i + 1), b.bottom(j + 1)}};
                    CHECK(grown(bucket, 1e-12).contains(p));
                    ++seen[b.id[k]];
                }
        CHECK(std::count(seen.begin(), seen.end(), 1) == n);
        if (n == 1000) {  // about square, and near the intended number
            CHECK(b.columns == doctest::Approx(4 * b.rows).epsilon(0.1));
            CHECK(double(n) / (b.rows * b.columns) ==
                  doctest::Approx(Buckets::per_bucket).epsilon(0.1));
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

TEST_CASE("the tree finds the nearest site that is near enough and not left out") {
    oracle::Random random(seed_here());
    Buckets b;
    SiteTree tree;
    for (int n : {1, 8, 9, 500}) {
        const std::vector<Site> sites = scattered(uint64_t(n), random, domain);
        b.sort(sites, {}, domain);
        CHECK(tree.empty());
        tree.grow(b);
        CHECK(!tree.empty());
        for (int trial = 0; trial < 100; ++trial) {
            const Site site = sites[size_t(n * random())],
                       c = {-2 + 4 * random(), -1 + 2 * random()};
            const double least = trial % 2 ? -INFINITY : 0;
            auto left_out = [&](uint32_t k) { return trial % 3 == 0 && k % 2 == 0; };
            std::optional<uint32_t> found;
            double nearest = trial % 2 ? INFINITY : c.x * c.x + c.y * c.y;
            for (uint32_t k = 0; k < b.size(); ++k) {
                const Site d = b.site(k) - site, away = d - c;
                const double d2 = away.x * away.x + away.y * away.y;
                const bool itself = d.x == 0 && d.y == 0;
                if (!itself && d2 < nearest && !left_out(k)) nearest = d2, found = k;
            }
            auto skip = [&](uint32_t k) {
                return left_out(k) || (b.x[k] == site.x && b.y[k] == site.y);
            };
            CHECK(tree.nearest(b, site, c, least, skip) == found);
        }
        tree.clear();
    }
}

TEST_CASE("the tree looks at few of many sites: scattered, clustered, along a line or a curve") {
    oracle::Random random(seed_here());
    Buckets b;
    SiteTree tree;
    for (int kind = 0; kind < 4; ++kind) {
        std::vector<Site> sites;
        for (int i = 0; i < 20000; ++i) {
            const double t = random(), u = random();
            sites.push_back(kind == 0   ? Site{-1 + 4 * t, 2 + u}
                            : kind == 1 ? Site{-1 + 1e-6 * t, 2 + 1e-6 * u}
                            : kind == 2 ? Site{-1 + 4 * t, 2 + t}
                                        : Site{-1 + 4 * t, 2 + t * t});
        }
        b.sort(sites, {}, domain);
        tree.grow(b);
        for (int trial = 0; trial < 50; ++trial) {
            const Site p = b.site(uint32_t(20000 * random()));
            int seen = 0;  // at least this site and the nearest one
            tree.nearest(b, p, {}, -INFINITY, [&](uint32_t k) {
                ++seen;
                return b.x[k] == p.x && b.y[k] == p.y;
            });
            CHECK(seen >= 2);
            CHECK(seen <= 100);  // out of 20 000
        }
    }
}

TEST_CASE("the distance of a point from a rectangle") {
    for (const auto& [p, d2] :
         {std::pair{Site{0, 2.5}, 0}, {{5, 2.5}, 4}, {{0, 0}, 4}, {{-4, 7}, 25}})
        CHECK(distance2(domain, p) == d2);
}

// path/sobol_test.cpp  each elementary interval contains one point; each dimension has an order of
// its own
#include "path/sobol.h"

#include <map>
#include <set>
#include <vector>

#include "base/moments.h"
#include "base/rng.h"
#include "oracle/expect.h"
#include "path/samplers.h"

namespace {

// The pairs of one randomisation in the order of the sampler.
struct Points {
    uint64_t a = 0, b = 0;
    vec2 operator()(uint64_t i) const { return sobol_pair(reverse_bits(i), a, b); }
    real third(uint64_t i) const { return sobol_third(reverse_bits(i), a, b); }
};
Points random_points(Rng& rng) {
    const uint64_t a = rng.bits(), b = rng.bits();
    return {a, b};
}

// A nested uniform shuffle by its definition: for every aligned block of 2^j indices a coin decides
// whether its halves are exchanged.
uint64_t textbook_shuffled(uint64_t i, int digits, uint64_t key) {
    uint64_t result = 0;
    for (int j = digits - 1; j >= 0; --j) {
        const uint64_t block = i >> j >> 1, coin = hash(hash(key, uint64_t(j)), block) >> 63;
        result = result * 2 + ((i >> j & 1) ^ coin);
    }
    return result;
}

real cubic(vec2 u) { return 4 * u.x * u.y * u.y * u.y + u.x; }              // mean 1
real disc(vec2 u) { return u.x * u.x + u.y * u.y < 1 ? 4 / pi : real(0); }  // mean 1

// The mean of f over the first n points.
template <class F>
double mean_over(const Points& points, uint64_t n, F f) {
    double sum = 0;
    for (uint64_t i = 0; i < n; ++i) sum += double(f(points(i)));
    return sum / double(n);
}

}  // namespace

TEST_CASE("the first points are Sobol's, where nothing is shuffled and shifted") {
    const vec2 first[] = {{0, 0},         {.5, .5},       {.25, .75},    {.75, .25},
                          {.125, .625},   {.625, .125},   {.375, .375},  {.875, .875},
                          {.0625, .9375}, {.5625, .4375}, {.3125, .1875}};
    for (uint64_t i = 0; i < std::size(first); ++i) {
        CHECK(Points{}(i).x == first[i].x);
        CHECK(Points{}(i).y == first[i].y);
    }
}

TEST_CASE("an index is mirrored bit by bit") {
    CHECK(reverse_bits(1) == uint64_t(1) << 63);
    CHECK(reverse_bits(6) == uint64_t(3) << 61);
    Rng rng{seed_here()};
    for (int n = 0; n < 100; ++n) {
        const uint64_t i = rng.bits(), m = reverse_bits(i);
        for (int k = 0; k < 64; ++k) REQUIRE((m >> k & 1) == (i >> (63 - k) & 1));
    }
}

TEST_CASE("the digits of y are sums of those of x by Pascal's triangle, modulo 2") {
    uint64_t odd[64];  // bit j of row k: C(k, j) is odd
    odd[0] = 1;
    for (int k = 1; k < 64; ++k) odd[k] = odd[k - 1] ^ odd[k - 1] << 1;
    Rng rng{seed_here()};
    for (int n = 0; n < 100; ++n) {
        const uint64_t x = rng.bits();
        uint64_t y = 0;
        for (int j = 0; j < 64; ++j)
            for (int k = 0; k < 64; ++k) y ^= (odd[k] >> j & x >> (63 - k) & 1) << (63 - j);
        REQUIRE(sobol_y(x) == y);
    }
}

TEST_CASE("the digits of z are those of the index, a polynomial modulo 2, in base X^2 + X + 1") {
    Rng rng{seed_here()};
    for (int n = 0; n < 100; ++n) {
        const uint64_t i = rng.bits();
        uint64_t z = 0, rest = i;
        for (int k = 0; k < 64; k += 2) {  // repeated division by the base
            uint64_t quotient = 0;
            for (int d = 63; d >= 2; --d)
                if (rest >> d & 1)
                    rest ^= uint64_t(7) << (d - 2), quotient |= uint64_t(1) << (d - 2);
            z |= rest << k;
            rest = quotient;
        }
        REQUIRE(sobol_z(reverse_bits(i)) == reverse_bits(z));
    }
}

TEST_CASE("each box of volume 2^(1-k) holds two of 2^k points in a row, each part of z one") {
    Rng rng{seed_here()};
    for (int n = 0; n < 20; ++n) {
        const Points points = random_points(rng);
        for (int k = 1; k <= 7; ++k)
            for (uint64_t block : {uint64_t(0), uint64_t(5), uint64_t(1) << 36}) {
                const uint64_t size = uint64_t(1) << k, start = block * size;
                std::vector<int> parts(size);
                for (uint64_t i = start; i < start + size; ++i)
                    ++parts[part(size, points.third(i))];
                for (int p : parts) REQUIRE(p == 1);
                for (int c = 0; c < k; ++c)
                    for (int d = 0; c + d < k; ++d) {
                        const uint64_t rows = uint64_t(1) << d, layers = size / 2 >> c >> d;
                        std::vector<int> boxes(size / 2);
                        for (uint64_t i = start; i < start + size; ++i) {
                            const vec2 u = points(i);
                            const uint64_t column = part(uint64_t(1) << c, u.x);
                            ++boxes[(column * rows + part(rows, u.y)) * layers +
                                    part(layers, points.third(i))];
                        }
                        for (int b : boxes) REQUIRE(b == 2);
                    }
            }
    }
}

TEST_CASE("each elementary interval holds one of 2^k points that begin at a multiple of 2^k") {
    Rng rng{seed_here()};
    for (int n = 0; n < 20; ++n) {
        const Points points = n == 0 ? Points{} : random_points(rng);
        for (int k = 0; k <= 10; ++k)
            for (uint64_t block : {uint64_t(0), uint64_t(1), uint64_t(6), uint64_t(1) << 36}) {
                const uint64_t size = uint64_t(1) << k, start = block * size;
                std::vector<int> held(size_t(k + 1) * size);
                for (uint64_t i = start; i < start + size; ++i)
                    for (int c = 0; c <= k; ++c) {  // 2^c columns, 2^(k-c) rows
                        const uint64_t columns = uint64_t(1) << c, rows = size / columns;
                        const uint64_t cell =
                            part(columns, points(i).x) * rows + part(rows, points(i).y);
                        ++held[size_t(c) * size + cell];
                    }
                for (int h : held) REQUIRE(h == 1);
            }
    }
}

TEST_CASE("single numbers: one in each of 2^k parts, for 2^k indices in a row") {
    Rng rng{seed_here()};
    for (int n = 0; n < 20; ++n)
        for (uint64_t block : {uint64_t(0), uint64_t(3), uint64_t(1) << 35}) {
            const uint64_t bits = rng.bits();
            std::vector<int> held(64);
            for (uint64_t i = 64 * block; i < 64 * (block + 1); ++i)
                ++held[part(64, sobol_single(reverse_bits(i), bits))];
            for (int h : held) REQUIRE(h == 1);
        }
}

TEST_CASE("points are uniform over the square, in their first digits and in their last") {
    Rng rng{seed_here()};
    constexpr int digits = std::numeric_limits<real>::digits;
    const real last = real(uint64_t(1) << (digits - 4));  // leaves four digits
    auto fraction = [&](real u) { return u * last - std::floor(u * last); };
    for (uint64_t i : {uint64_t(0), uint64_t(1), uint64_t(77), uint64_t(1) << 40}) {
        std::vector<uint64_t> first_digits(256), last_digits(256), single(256), cubes(512);
        for (int n = 0; n < 60000; ++n) {
            const Points points = random_points(rng);
            const vec2 u = points(i);
            ++cubes[part(8, u.x) * 64 + part(8, u.y) * 8 + part(8, points.third(i))];
            ++first_digits[part(16, u.x) * 16 + part(16, u.y)];
            ++last_digits[part(16, fraction(u.x)) * 16 + part(16, fraction(u.y))];
            const real v = sobol_single(reverse_bits(i), rng.bits());
            ++single[part(16, v) * 16 + part(16, fraction(v))];
        }
        EXPECT(expect_alike(single).of("single"), 0.2);
        EXPECT(expect_alike(cubes).of("cube"), 0.2);
        EXPECT(expect_alike(first_digits).of("first digits"), 0.2);
        EXPECT(expect_alike(last_digits).of("last digits"), 0.2);
    }
}

TEST_CASE("two indices are shuffled as by a coin for every block") {
    // Counts the places of two of 16 indices; a pair has 240 outcomes.
    Rng rng{seed_here()};
    const std::pair<uint64_t, uint64_t> pairs[] = {{0, 1}, {0, 2}, {5, 6}, {3, 12}, {8, 15}};
    for (auto [i, k] : pairs) {
        std::vector<uint64_t> counts(256);
        std::vector<double> expected(256);
        for (int n = 0; n < 200000; ++n) {
            const uint64_t a = rng.bits(), b = rng.bits();
            auto place = [&](uint64_t at) {
                return reverse_bits(shuffled(reverse_bits(at), a, b)) & 15;
            };
            ++counts[place(i) * 16 + place(k)];
        }
        // Places first differ at the highest bit where the indices do; lower bits are independent.
        const int first = int(std::bit_width(i ^ k)) - 1;  // counted from the lowest bit
        for (uint64_t p = 0; p < 16; ++p)
            for (uint64_t q = 0; q < 16; ++q)
                if (int(std::bit_width(p ^ q)) - 1 == first)
                    expected[p * 16 + q] = 1 / (16.0 * double(uint64_t(1) << first));
        std::vector<uint64_t> possible;
        std::vector<double> probabilities;
        for (size_t c = 0; c < 256; ++c) {
            if (expected[c] == 0) REQUIRE(counts[c] == 0);
            if (expected[c] == 0) continue;
            possible.push_back(counts[c]);
            probabilities.push_back(expected[c]);
        }
        EXPECT(oracle::expect_counts(possible, probabilities), 0.1);
    }
}

TEST_CASE("the first four points are any four that can be, each equally often") {
    // A net has one point in each row, column, half and quadrant of 4 x 4 cells; code has its rows.
    auto is_net = [](const uint64_t(&row)[4]) {
        return (row[0] < 2) != (row[1] < 2) && (row[2] < 2) != (row[3] < 2) &&
               std::set<uint64_t>(row, row + 4).size() == 4;
    };
    std::map<uint64_t, uint64_t> counts;
    for (uint64_t code = 0; code < 256; ++code)
        if (is_net({code & 3, code >> 2 & 3, code >> 4 & 3, code >> 6})) counts[code] = 0;
    Rng rng{seed_here()};
    for (int n = 0; n < 50000; ++n) {
        const Points points = random_points(rng);
        uint64_t code = 0;
        for (uint64_t i = 0; i < 4; ++i) code |= part(4, points(i).y) << 2 * part(4, points(i).x);
        REQUIRE(counts.count(code) == 1);
        ++counts[code];
    }
    std::vector<uint64_t> seen;
    for (const auto& [code, times] : counts) seen.push_back(times);
    EXPECT(expect_alike(seen), 0.1);
}

TEST_CASE("pairs of other words stand beside each other like pairs shuffled by coins") {
    // The squared error of 16 samples for the integral of (u.x - 1/2)(v.x - 1/2) + (u.y - 1/2)(v.y
    // - 1/2), by two pairs u and v, is on average the same with a textbook shuffle of v.
    Rng rng{seed_here()};
    auto squared_error = [&](bool textbook) {
        const Points u = random_points(rng);
        Points v = random_points(rng);
        const uint64_t key = rng.bits(), n = 16;
        if (textbook) v.a = 0;  // the order of the index
        double sum = 0;
        for (uint64_t i = 0; i < n; ++i) {
            const vec2 p = u(i), q = v(textbook ? textbook_shuffled(i, 4, key) : i);
            sum +=
                (double(p.x) - .5) * (double(q.x) - .5) + (double(p.y) - .5) * (double(q.y) - .5);
        }
        return sqr(real(sum / double(n))) * 16 * 72;  // 1 for independent numbers
    };
    EXPECT(oracle::expect_equal([&] { return double(squared_error(false)); },
                                [&] { return double(squared_error(true)); }, 200000),
           0.05);
}

TEST_CASE("means over points are unbiased, at powers of two and between them") {
    Rng rng{seed_here()};
    for (uint64_t n : {1, 2, 3, 7, 16, 20}) {
        auto replicate = [&](auto f) {
            return [&, f](int) { return mean_over(random_points(rng), n, f); };
        };
        EXPECT(oracle::expect_replicates(1, 20000, replicate(cubic)).of("smooth"), 0.05);
        EXPECT(oracle::expect_replicates(1, 20000, replicate(disc)).of("discontinuous"), 0.05);
    }
}

TEST_CASE(
    "the error falls faster than that of independent numbers, on smooth and other functions") {
    // For four times the points the squared error falls to a quarter by independent numbers, to
    // about a 16th for smooth functions (error (log n) / n), to an eighth for edges (n^(-3/4)).
    Rng rng{seed_here()};
    auto squared = [&](uint64_t n, auto f) {
        Moments m;
        for (int k = 0; k < 2000; ++k) m.add(mean_over(random_points(rng), n, f));
        return m.variance();
    };
    CHECK(squared(256, cubic) < squared(16, cubic) / 100);
    CHECK(squared(256, disc) < squared(16, disc) / 40);
}

// path/sampler_test.cpp  every dimension is uniform; dimensions and pixels are uncorrelated
#include "path/sampler.h"

#include "base/moments.h"
#include "oracle/expect.h"
#include "path/samplers.h"

namespace {

constexpr int depth = 8;
const uint32_t dimensions = dimension(depth, Dimension::light_x);

// Draws like the path tracer: pairs where it takes pairs, choices where it makes choices.
real draw(const Sampler& s, uint32_t dim) {
    if (dim < 2) return dim == 0 ? s.get2(0).x : s.get2(0).y;
    const uint32_t k = (dim - 2) % uint32_t(Dimension::count);
    if (Dimension(k) == Dimension::which_light || Dimension(k) == Dimension::lobe)
        return s.choice(int((dim - 2) / uint32_t(Dimension::count)), Dimension(k));
    if (k < 4) return k % 2 == 0 ? s.get2(dim).x : s.get2(dim - 1).y;
    return s.get(dim);
}

}  // namespace

TEST_CASE("every number of a path has a dimension of its own, in the order of the path") {
    uint32_t next = film_y + 1;
    for (int vertex = 0; vertex < 1000; ++vertex)
        for (uint32_t what = 0; what < uint32_t(Dimension::count); ++what)
            CHECK(dimension(vertex, Dimension(what)) == next++);
}

TEST_CASE("seed, pixel, set, sample, dimension: whichever is another, the number is another") {
    for (SamplerKind kind : samplers) {
        const SamplerSettings settings = sampler_settings(kind, 5, depth);
        const SamplerSettings reseeded = sampler_settings(kind, 6, depth);
        int equal = 0;
        for (uint64_t pixel = 0; pixel < 100; ++pixel)
            for (uint32_t dim : {0u, 2u, 7u}) {
                const real u = Sampler(settings, pixel, 3).get(dim);
                CHECK(u == Sampler(settings, pixel, 3, 0).get(dim));
                equal += u == Sampler(reseeded, pixel, 3).get(dim);
                equal += u == Sampler(settings, pixel + 1, 3).get(dim);
                equal += u == Sampler(settings, pixel, 4).get(dim);
                for (uint32_t set : {1u, 2u, 7u}) {
                    const real of_set = Sampler(settings, pixel, 3, set).get(dim);
                    equal += u == of_set;
                    equal += of_set == Sampler(settings, pixel + 1, 3).get(dim);
                }
                equal += u == Sampler(settings, pixel, 3).get(dim + 1);
            }
        // One of 3000 pairs of 24-bit numbers is equal by chance with a probability of 1.8e-4.
        INFO(std::string(sampler_names[int(kind)]));
        CHECK(equal < 2);
    }
}

TEST_CASE("a number of the last cell never rounds to 1") {
    for (uint32_t cells : {1u, 3u, 16u, 256u}) {
        CHECK(in_part(cells - 1, cells, UINT64_MAX) < 1);
        CHECK(in_part(0, cells, 0) == 0);
    }
}

TEST_CASE("every number of every sampler is uniform over [0,1)") {
    // The check is over pixels, because these are independent, for every sample index i.
    for (SamplerKind kind : samplers) {
        const SamplerSettings settings = sampler_settings(kind, seed_here(), depth);
        for (uint32_t dim = 0; dim < dimensions; ++dim)
            for (uint64_t sample : {0, 1, 5, 63}) {
                std::vector<uint64_t> cells(16);
                for (uint64_t pixel = 0; pixel < 4000; ++pixel) {
                    ++cells[part(16, draw(Sampler(settings, pixel, sample), dim))];
                }
                const std::string what = sampler_names[int(kind)];
                EXPECT(expect_alike(cells).of(what), 0.2);
            }
    }
}

TEST_CASE("dimensions of a path and neighbouring pixels are uncorrelated") {
    // One pooled check per sampler.  For independent u, v the products (u - 1/2)(v - 1/2) have mean
    // 0 and variance 1/144.  A replication is the sum over one pixel, because its samples are
    // dependent.  Each dimension meets the next three, so that each pair meets the next pair.
    for (SamplerKind kind : samplers) {
        const SamplerSettings settings = sampler_settings(kind, seed_here(), depth);
        Moments between_dimensions, between_pixels;
        for (uint64_t pixel = 0; pixel < 1000; ++pixel) {
            double dims = 0, pixels = 0;
            for (uint64_t sample = 0; sample < 16; ++sample) {
                const Sampler here(settings, 2 * pixel, sample),
                    there(settings, 2 * pixel + 1, sample);
                real last[3] = {};
                for (uint32_t dim = 0; dim < dimensions; ++dim) {
                    const real u = draw(here, dim), v = draw(there, dim);
                    pixels += (double(u) - 0.5) * (double(v) - 0.5);
                    for (uint32_t back = 1; back <= std::min(dim, 3u); ++back)
                        dims += (double(u) - 0.5) * (double(last[(dim - back) % 3]) - 0.5);
                    last[dim % 3] = u;
                }
            }
            between_dimensions.add(dims / (3 * 16 * dimensions));
            between_pixels.add(pixels / (16 * dimensions));
        }
        // Full correlation would give 1/12: the smallest detected bias is in these units.
        const std::string name = sampler_names[int(kind)];
        EXPECT(oracle::expect_mean(0, estimate(between_dimensions)).of(name), 0.02 / 12);
        EXPECT(oracle::expect_mean(0, estimate(between_pixels)).of(name), 0.02 / 12);
    }
}

TEST_CASE("no two numbers of a path come in the same order") {
    // The squared sum of products (u - 1/2)(v - 1/2) over the 16 samples of a pixel, relative to
    // that of independent numbers.  One order for both would make it 3.2 or more on average: for v
    // = u + c modulo 1 the mean product is B2(c) / 2, its square 1 / 720, times 16 * 144.
    for (SamplerKind kind : {SamplerKind::stratified, SamplerKind::sobol}) {
        const SamplerSettings settings = sampler_settings(kind, seed_here(), depth);
        for (uint32_t dim : {film_x, film_y, dimension(0, Dimension::light_x),
                             dimension(1, Dimension::which_light), dimension(1, Dimension::lobe),
                             dimension(1, Dimension::roulette)})
            for (uint32_t other :
                 {dimension(2, Dimension::wi_x), dimension(3, Dimension::light_y),
                  dimension(2, Dimension::lobe), dimension(3, Dimension::roulette)}) {
                double squares = 0;
                for (uint64_t pixel = 0; pixel < 2000; ++pixel) {
                    double sum = 0;
                    for (uint64_t sample = 0; sample < 16; ++sample) {
                        const Sampler s(settings, pixel, sample);
                        sum += (double(draw(s, dim)) - 0.5) * (double(draw(s, other)) - 0.5);
                    }
                    squares += sum * sum * 144 / 16 / 2000;
                }
                INFO(std::string(sampler_names[int(kind)]), " ", dim, " ", other, ": ", squares);
                CHECK(squares < 2);
            }
    }
}

TEST_CASE("Halton points of one pixel fill pairs of dimensions evenly") {
    // The first 2 * 3 samples of every pixel lie in different boxes of a 2 x 3 grid on the film.
    const SamplerSettings settings = sampler_settings(SamplerKind::halton, seed_here(), depth);
    for (uint64_t pixel = 0; pixel < 1000; ++pixel) {
        int boxes[6] = {};
        for (uint64_t i = 0; i < 6; ++i) {
            const vec2 u = Sampler(settings, pixel, i).get2(film_x);
            ++boxes[part(2, u.x) * 3 + part(3, u.y)];
        }
        for (int b : boxes) REQUIRE(b == 1);
    }
    // The first b samples of a dimension of base b lie in different parts.
    for (uint32_t dim = 0; dim < dimensions; ++dim) {
        const uint32_t b = first_primes(dimensions)[dim];
        std::vector<int> parts(b);
        for (uint64_t i = 0; i < b; ++i) ++parts[part(b, Sampler(settings, 3, i).get(dim))];
        CAPTURE(dim);
        CHECK(parts == std::vector<int>(b, 1));
    }
}

TEST_CASE("Sobol' points of one pixel fill every elementary interval, every set's its own") {
    const SamplerSettings settings = sampler_settings(SamplerKind::sobol, seed_here(), depth);
    for (uint64_t pixel = 0; pixel < 100; ++pixel)
        for (uint32_t set : {0u, 1u, 7u})
            for (uint32_t dim :
                 {film_x, dimension(0, Dimension::light_x), dimension(4, Dimension::wi_x)}) {
                int boxes[5][16] = {}, parts[16] = {}, cubes[2][8] = {};
                for (uint64_t i = 32; i < 48; ++i) {
                    const Sampler s(settings, pixel, i, set);
                    const vec2 u = s.get2(dim);
                    for (uint64_t c : {0, 1, 2, 3, 4})  // 2^c columns
                        ++boxes[c][(part(1u << c, u.x) << (4 - c)) + part(16u >> c, u.y)];
                    ++parts[part(16, draw(s, dimension(2, Dimension::which_light)))];
                    for (Dimension choice : {Dimension::which_light, Dimension::lobe}) {
                        const uint32_t k = choice == Dimension::lobe;
                        const vec2 v =
                            s.get2(dimension(1, k ? Dimension::wi_x : Dimension::light_x));
                        const uint64_t z = part(2, draw(s, dimension(1, choice)));
                        ++cubes[k][part(2, v.x) * 4 + part(2, v.y) * 2 + z];
                    }
                }
                for (const auto& shape : boxes)
                    for (int b : shape) REQUIRE(b == 1);
                for (int p : parts) REQUIRE(p == 1);
                for (const auto& cube : cubes)
                    for (int c : cube) REQUIRE(c == 2);
            }
}

TEST_CASE("a cell is a part of the unit square, in grids of all shapes") {
    for (uint32_t columns : {1u, 2u, 3u, 8u})
        for (uint32_t rows : {1u, 4u, 5u})
            for (uint32_t cell = 0; cell < columns * rows; ++cell)
                for (uint64_t bits : {hash(cell, 1), hash(cell, 2)}) {
                    const vec2 u = in_cell(cell, columns, rows, bits);
                    CHECK(part(columns, u.x) == cell % columns);
                    CHECK(part(rows, u.y) == cell / columns);
                }
}

TEST_CASE("each 16 stratified samples have one in every cell of every grid") {
    const SamplerSettings p = sampler_settings(SamplerKind::stratified, seed_here(), depth);
    for (uint64_t pixel = 0; pixel < 100; ++pixel)
        for (uint32_t set : {0u, 1u, 7u})
            for (uint64_t grid : {0, 5}) {
                int film[16] = {}, pick[16] = {};
                for (uint64_t i = 16 * grid; i < 16 * grid + 16; ++i) {
                    const Sampler s(p, pixel, i, set);
                    const vec2 u = s.get2(film_x);
                    ++film[part(4, u.y) * 4 + part(4, u.x)];
                    ++pick[part(16, s.get(dimension(3, Dimension::which_light)))];
                }
                for (size_t c = 0; c < 16; ++c) REQUIRE((film[c] == 1 && pick[c] == 1));
            }
}

TEST_CASE("every pass shuffles its cells anew") {
    const SamplerSettings p = sampler_settings(SamplerKind::stratified, 3, depth);
    int alike = 0;  // passes of equal order: by chance 1 in 16!
    for (uint64_t pixel = 0; pixel < 100; ++pixel) {
        bool same = true;
        for (uint64_t i = 0; i < 16; ++i) {
            const real first = Sampler(p, pixel, i).get(2),
                       second = Sampler(p, pixel, i + 16).get(2);
            same = same && part(16, first) == part(16, second);
        }
        alike += same;
    }
    CHECK(alike == 0);
}

TEST_CASE("permute is a permutation, and takes every value at every place equally often") {
    Rng rng{seed_here()};
    std::vector<std::vector<uint64_t>> values(16, std::vector<uint64_t>(16));
    std::vector<uint64_t> pairs(256);
    for (int k = 0; k < 24000; ++k) {
        const uint64_t key = rng.bits();
        uint32_t seen = 0;
        for (uint32_t i = 0; i < 16; ++i) {
            const uint32_t v = permute(i, key);
            REQUIRE(v < 16);
            seen |= 1u << v, ++values[i][v];
        }
        REQUIRE(seen == 0xffff);
        ++pairs[permute(0, key) * 16 + permute(1, key)];
    }
    for (const auto& at_place : values) EXPECT(expect_alike(at_place), 0.1);
    // Pairs of places 0 and 1 are hashed without proof: chi2 is 326 for 239 degrees of freedom, and
    // would be 336 000 for cyclic shifts only.
    double chi2 = 0;
    for (size_t k = 0; k < 256; ++k)
        if (k / 16 != k % 16) chi2 += sqr(double(pairs[k]) - 100.0) / 100;
    INFO("chi2 of pairs: ", chi2);
    CHECK(chi2 < 334 + 6 * 30);
}

TEST_CASE("the samples of a set are one point set") {
    for (SamplerKind kind : {SamplerKind::halton, SamplerKind::sobol}) {
        const SamplerSettings settings = sampler_settings(kind, seed_here(), depth);
        for (uint64_t pixel = 0; pixel < 100; ++pixel) {
            const real c = Sampler(settings, pixel, 0, 3).get(0),
                       d = Sampler(settings, pixel, 1, 3).get(0);
            CHECK(part(2, c) != part(2, d));
        }
    }
}

TEST_CASE("means over a set are uncorrelated with those of the pixel's other sets") {
    // Products (mean - 1/2)(mean of another replication - 1/2), over the RMS of the means: 1 if
    // both had the same randomisation.
    for (SamplerKind kind : samplers) {
        const SamplerSettings settings = sampler_settings(kind, seed_here(), depth);
        Moments products, squares;
        for (uint64_t pixel = 0; pixel < 4000; ++pixel) {
            double mean[2] = {};
            for (uint32_t set : {0u, 1u})
                for (uint64_t i = 0; i < 5; ++i)  // part of a net of 16: means differ
                    mean[set] += (double(draw(Sampler(settings, pixel, i, set), 2)) - 0.5) / 5;
            products.add(mean[0] * mean[1]);
            squares.add(mean[0] * mean[0]);
        }
        const std::string name = sampler_names[int(kind)];
        EXPECT(oracle::expect_mean(0, estimate(products)).of(name), 0.15 * squares.mean);
    }
}

TEST_CASE("samples 2^32 apart differ, whatever the sampler, in every set") {
    for (SamplerKind kind : samplers)
        for (uint32_t set : {0u, 1u}) {
            const SamplerSettings settings = sampler_settings(kind, seed_here(), depth);
            int equal = 0;
            for (uint64_t i = 0; i < 100; ++i)
                for (uint64_t far : {uint64_t(1) << 32, uint64_t(1) << 33}) {
                    const Sampler near(settings, 7, i, set), beyond(settings, 7, i + far, set);
                    // This dimension has base 3: in base 2 only the digits from the 33rd on differ.
                    equal += near.get2(film_x).y == beyond.get2(film_x).y;
                }
            INFO("sampler ", int(kind), ", set ", set);
            CHECK(equal < 2);
        }
}

TEST_CASE("Halton digits are multiplied by a factor of the dimension's own, in every pixel") {
    // Samples 1 and 0 have the first digits 1 and 0: after scrambling they differ by the factor.
    const SamplerSettings settings = sampler_settings(SamplerKind::halton, seed_here(), depth);
    auto factor = [&](uint64_t pixel, uint32_t dim) {
        const uint32_t base = settings.bases[dim];
        auto digit = [&](uint64_t i) {
            return uint32_t(Sampler(settings, pixel, i).get(dim) * real(base) * (1 + 8 * ulp));
        };
        return (digit(1) + base - digit(0)) % base;
    };
    // The place of a factor in its range, from -1/2 to 1/2.  Its variance is 1/12 except for the
    // smallest bases, which are omitted.
    Moments places, between_dimensions;
    for (uint64_t pixel = 0; pixel < 4000; ++pixel) {
        double sum = 0, products = 0, last = 0;
        for (uint32_t dim = 5; dim < dimensions; ++dim) {
            const double place = (factor(pixel, dim) - 0.5) / (settings.bases[dim] - 1) - 0.5;
            sum += place;
            products += place * last;
            last = place;
        }
        places.add(sum / (dimensions - 5));
        between_dimensions.add(products / (dimensions - 6));
    }
    EXPECT(oracle::expect_mean(0, estimate(places)).of("place"), 0.02);
    EXPECT(oracle::expect_mean(0, estimate(between_dimensions)).of("dimensions"), 0.02 / 12);
    for (uint32_t dim : {1u, 2u, 3u}) {
        std::vector<uint64_t> counts(settings.bases[dim] - 1);
        for (uint64_t pixel = 0; pixel < 4000; ++pixel) {
            const uint32_t f = factor(pixel, dim);
            REQUIRE(f > 0);
            ++counts[f - 1];
        }
        EXPECT(expect_alike(counts), 0.2);
    }
}

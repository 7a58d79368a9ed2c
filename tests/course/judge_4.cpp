// course/judge_4.cpp  judges week 4: Halton's points, scrambled; strata
#include <set>

#include "course/judge.h"

using namespace penumbra;
using namespace course;

namespace {

// Doubles hold 53 bits: 64 are asked for in two halves.
Out bits(uint64_t all) { return {double(all >> 32), double(all & 0xffffffff)}; }

// Which of n equal parts of [0,1) holds x; n if none does.  On their borders rounding is forgiven.
size_t part(const Judge& j, size_t n, double x) {
    const double at = x * double(n) * (1 + 8 * j.epsilon) + double(n) * 1e-300;
    if (!(x >= 0 && x < 1)) return n;
    return std::min(n - 1, size_t(at));
}

// Whether all are in [0,1); and the first that is not.
bool in_range(const Rows& numbers, double& first) {
    for (double x : numbers.numbers)
        if (!(x >= 0 && x < 1)) return first = x, false;
    return true;
}

// Of the numbers that come, how many are in each of n parts; the last count: outside of [0,1).
std::vector<uint64_t> count(Judge& j, const std::string& question, const Rows& at, size_t n) {
    std::vector<uint64_t> counts(n + 1);
    for (double x : j.ask(question, at).numbers) ++counts[part(j, n, x)];
    return counts;
}
// Parts that hold one, and parts that hold none.
size_t without_zeros(const std::vector<uint64_t>& counts) {
    return counts.size() - size_t(std::count(counts.begin(), counts.end(), 0));
}
size_t holes(const std::vector<uint64_t>& counts) {
    return size_t(std::count(counts.begin(), counts.end() - 1, 0));
}

// Counts in equal cells are what chance makes of equal probabilities; what is in no cell counts as
// a cell that should be empty.
oracle::Verdict equal_counts(const std::vector<uint64_t>& counts) {
    std::vector<double> equal(counts.size(), 1 / double(counts.size() - 1));
    equal.back() = 0;
    return oracle::expect_counts(counts, equal);
}

// ---- 4.1 ----------------------------------------------------------------------------------------

Out inverse(double base, uint64_t index) { return row(base, bits(index)); }

// The greatest error of what becomes of indices, in parts of it.
double off_truth(const Rows& came, const Out& truth) {
    double off = 0;
    for (size_t i = 0; i < truth.size(); ++i)
        off = worse(off, std::abs(came.numbers[i] - truth[i]) / (truth[i] > 0 ? truth[i] : 1));
    return off;
}

void radical_inverse(Judge& j) {
    const std::string question = "radical_inverse";
    // Decimal digits can be read: 1234 becomes 0.4321.
    const Rows decimal = j.probe(question, {inverse(10, 0), inverse(10, 7), inverse(10, 10),
                                            inverse(10, 1234), inverse(10, 5600)});
    const double off = off_truth(decimal, {0, 0.7, 0.01, 0.4321, 0.0065});
    j.exact("in base 10 index 1234 becomes 0.4321, 5600 becomes 0.0065", off < 64 * j.epsilon,
            oracle::say("they become %.10g and %.10g%s", decimal.numbers[3], decimal.numbers[4],
                        off < 1e-5 ? ", with no more digits than a float has" : ""));
    const Rows small = j.probe(
        question, {inverse(2, 1), inverse(2, 6), inverse(2, 11), inverse(3, 5), inverse(3, 19)});
    j.exact("in base 2 index 6 becomes 3/8, in base 3 index 5 becomes 7/9",
            off_truth(small, {1 / 2.0, 3 / 8.0, 13 / 16.0, 7 / 9.0, 11 / 27.0}) < 64 * j.epsilon,
            oracle::say("they become %.9g and %.9g", small.numbers[1], small.numbers[3]));

    size_t empty = 0;
    for (const auto& [base, n] : {std::pair(2, 64), {3, 81}, {5, 125}, {7, 343}, {29, 841}}) {
        const Rows at = rows_of(size_t(n), [base = base](size_t i) { return inverse(base, i); });
        empty += holes(count(j, question, at, size_t(n)));
    }
    j.none("the first b^k indices put one point into each of b^k parts", empty,
           "%zu parts stay empty in bases 2, 3, 5, 7 and 29");

    const Rows large =
        j.probe(question, {inverse(2, (uint64_t(1) << 40) + 1), inverse(3, 50031545098999707u + 2),
                           inverse(10, 4000000000000000000u), inverse(10, UINT64_MAX),
                           inverse(10, 10000000000000000001u)});
    // Digits that no sum shows may be dropped.
    const char* indices[] = {"2^40 + 1 in base 2", "3^35 + 2 in base 3", "4 * 10^18 in base 10",
                             "2^64 - 1 in base 10", "10^19 + 1 in base 10"};
    const double truth[] = {0.5 + 0x1p-41, 2 / 3.0, 4e-19, 0.51615590737044764, 0.1};
    Worst off_large;
    for (size_t i = 0; i < large.size(); ++i)
        off_large.see(
            std::abs(large.numbers[i] - truth[i]),
            oracle::say("%s: %.17g expected, %.17g came", indices[i], truth[i], large.numbers[i]));
    j.worst("indices beyond 32 bits keep their digits, as far as 64 bits go", off_large,
            64 * j.epsilon);
    // Of all nines and the like: 1 - b^-k, which rounds to 1; with 65 digits they do not fit.
    const Rows near_one =
        j.ask(question, {inverse(2, UINT64_MAX), inverse(3, 12157665459056928800u),
                         inverse(10, 9999999999999999999u), inverse(2, (1u << 25) - 1)});
    double first = 0;
    const bool below = in_range(near_one, first);
    j.exact("no index becomes 1, not even the largest", below && near_one.numbers[0] > 0.999,
            oracle::say("one becomes %.17g", below ? near_one.numbers[0] : first));
    j.remember({double(below), near_one.numbers[0]});
}

// ---- 4.2 ----------------------------------------------------------------------------------------

const std::string scrambling = "scrambled_radical_inverse";

Out scrambled(double base, uint64_t index, uint64_t shift, uint64_t factor) {
    return row(base, bits(index), bits(shift), bits(factor));
}

// Of n indices with random bits, parts of [0,1) that stay empty, of n; of many trials.
size_t empty_parts(Judge& j, oracle::Random& random, int base, int n, uint64_t first = 0) {
    const uint64_t shift = random.bits(), factor = random.bits();
    const Rows at =
        rows_of(size_t(n), [&](size_t i) { return scrambled(base, first + i, shift, factor); });
    return holes(count(j, scrambling, at, size_t(n)));
}
size_t empty_parts(Judge& j, oracle::Random& random) {
    size_t empty = 0;
    for (const auto& [base, n] : {std::pair(2, 64), {3, 27}, {7, 49}, {29, 29}})
        for (int trial = 0; trial < 20; ++trial) empty += empty_parts(j, random, base, n);
    return empty;
}

// Blocks of b^k indices that differ in their last k digits alone, and some of the last of 64 bits.
struct Block {
    int base, n;
    uint64_t last;  // where it begins
};
const Block blocks[] = {{2, 2, UINT64_MAX - 1},         {2, 64, UINT64_MAX - 63},
                        {3, 3, 12157665459056928801u},  {3, 27, 12157665459056928801u},
                        {7, 7, 3909821048582988049u},   {7, 49, 3909821048582988049u},
                        {29, 29, 10260628712958602189u}};
size_t empty_at_the_end(Judge& j, oracle::Random& random) {
    size_t empty = 0;
    for (const Block& b : blocks)
        for (int trial = 0; trial < 5; ++trial)
            empty += empty_parts(j, random, b.base, b.n, b.last);
    return empty;
}
// Why parts stay empty.
std::string unevenness(Judge& j) {
    for (const Block& b : blocks)
        for (int trial = 0; trial < 10; ++trial) {
            const uint64_t n = uint64_t(b.n), beyond = n * n;
            if (const size_t empty = empty_parts(j, j.random, b.base, b.n, beyond))
                return oracle::say(
                    "in base %d the indices %d to %d leave %zu of %d parts empty: "
                    "two digits become the same, or one becomes none",
                    b.base, int(beyond), int(beyond + n - 1), empty, b.n);
            if (const size_t empty = empty_parts(j, j.random, b.base, b.n))
                return oracle::say(
                    "in base %d the indices %d to %d have a part each, but 0 to %d "
                    "leave %zu empty: the zeros ahead of an index do not become "
                    "what a digit 0 becomes",
                    b.base, int(beyond), int(beyond + n - 1), b.n - 1, empty);
        }
    return "";
}

// With random bits, in n parts.
std::vector<uint64_t> counts_of(Judge& j, oracle::Random& random, int base, uint64_t index,
                                size_t n, size_t draws) {
    const Rows at = rows_of(draws, [&](size_t) {
        const uint64_t shift = random.bits(), factor = random.bits();
        return scrambled(base, index, shift, factor);
    });
    return count(j, scrambling, at, n);
}

// How far the first digit moves from index 0 to another: counts of 0 ... b - 1.
std::vector<uint64_t> moves_of(Judge& j, oracle::Random& random, size_t base, uint64_t other,
                               int draws) {
    Rows at;
    for (int i = 0; i < draws; ++i) {
        const uint64_t shift = random.bits(), factor = random.bits();
        for (uint64_t index : {uint64_t(0), other})
            at.add(scrambled(double(base), index, shift, factor));
    }
    const Rows x = j.ask(scrambling, at);
    std::vector<uint64_t> moves(base);
    for (size_t i = 0; i + 1 < x.size(); i += 2) {
        const size_t from = part(j, base, x.numbers[i]), to = part(j, base, x.numbers[i + 1]);
        ++moves[(to + base - from) % base];
    }
    return moves;
}

void scrambled_digits(Judge& j) {
    // Known mistakes are told by what can be and what cannot, however the bits are used: the same
    // bits for all.
    oracle::Random fixed(1);
    Rows extremes;
    for (uint64_t bits : {uint64_t(0), UINT64_MAX})
        for (uint64_t index : {uint64_t(0), uint64_t(1), UINT64_MAX})
            for (double base : {2.0, 3.0, 541.0}) extremes.add(scrambled(base, index, bits, bits));
    j.probe_stub(scrambling, {scrambled(10, 1234, 0x123456789abcdef, 0xfedcba987654321),
                              scrambled(3, 5, 0x3141592653589793, 0x2718281828459045)});
    double first = 0;
    const bool in = in_range(j.ask(scrambling, extremes), first);
    const size_t any = empty_parts(j, fixed);
    size_t often = 0;
    for (int trial = 0; trial < 20; ++trial) often += empty_parts(j, fixed, 29, 29) > 0;
    auto outside = [&](uint64_t index) { return counts_of(j, fixed, 5, index, 625, 20000); };
    const auto zero = outside(0), larger = outside(7);
    const auto pairs = counts_of(j, fixed, 3, 4, 9, 2000), moves = moves_of(j, fixed, 7, 1, 2000);
    j.remember({double(empty_at_the_end(j, fixed) > 0)});
    j.remember(row(in, any > 0, often > 10, without_zeros(zero), without_zeros(larger),
                   without_zeros(pairs), without_zeros(moves), moves[0] > 0,
                   without_zeros(moves_of(j, fixed, 7, 7, 200))));

    j.exact("numbers are in [0,1), whatever the bits", in && larger.back() + zero.back() == 0,
            in ? "with random bits some are not" : oracle::say("one is %.17g", first));
    const std::string why = unevenness(j);
    const size_t empty = empty_parts(j, j.random);
    j.exact("the first b^k indices still put one point into each of b^k parts",
            empty == 0 && why.empty(),
            why.empty() ? oracle::say("%zu parts of 3380 stay empty", empty) : why);
    j.none("b^k of the largest indices that 64 bits hold put one point into each of b^k parts",
           empty_at_the_end(j, j.random), "%zu parts of 905 stay empty");
    j.limit();
    j.statistical("index 0 becomes any number, for random bits",
                  equal_counts(counts_of(j, j.random, 5, 0, 625, 80000)));
    j.statistical("index 7 becomes any number, with two digits in base 5 that are scrambled apart",
                  equal_counts(counts_of(j, j.random, 5, 7, 625, 80000)));
    // The first digits of 0 and of 1 are two: all pairs of two that differ are as likely.
    std::vector<double> equal(7, 1 / 6.0);
    equal[0] = 0;
    j.statistical("from index 0 to 1 the first digit of 7 moves by any number but 0",
                  oracle::expect_counts(moves_of(j, j.random, 7, 1, 20000), equal));
}

// ---- 4.3 ----------------------------------------------------------------------------------------

// Of the pixels from one on, samples in turn: all numbers of a path.
Rows paths(Judge& j, uint64_t seed, uint64_t pixel, int pixels, int samples) {
    Rows at;
    for (int p = 0; p < pixels; ++p)
        for (int s = 0; s < samples; ++s) at.add({double(seed), double(pixel) + p, double(s)});
    return j.ask("path", at);
}

size_t equal_numbers(In a, In b) {
    size_t equal = 0;
    for (size_t i = 0; i < a.size(); ++i) equal += a[i] == b[i];
    return equal;
}

// The film's two, then seven a vertex.
const size_t of_vertex = 7;
const uint32_t primes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};

// Of the boxes that numbers' bases cut out, those that stay empty: none is after as many samples.
size_t empty_boxes(Judge& j, const std::vector<size_t>& dims) {
    const size_t pixels = 3;
    size_t boxes = 1;
    for (size_t dim : dims) boxes *= primes[dim];
    const Rows x = paths(j, 3, 11, int(pixels), int(boxes));
    size_t empty = 0;
    for (size_t p = 0; p < pixels; ++p) {
        std::set<std::vector<size_t>> hit;
        for (size_t i = p * boxes; i < (p + 1) * boxes; ++i) {
            std::vector<size_t> box;
            for (size_t dim : dims) box.push_back(part(j, primes[dim], x[i][dim]));
            hit.insert(box);
        }
        empty += boxes - std::min(boxes, hit.size());
    }
    return empty;
}

// The first number of a path that, after as many samples as its prime, leaves one of as many parts
// empty; if none does, how many numbers there are.
size_t of_another_base(Judge& j) {
    const Rows x = paths(j, 3, 11, 1, 271);  // the 58th prime
    auto is_prime = [](size_t n) {
        size_t divisor = 2;
        while (n % divisor != 0) ++divisor;
        return divisor == n;
    };
    size_t base = 1;
    for (size_t dim = 0; dim < x.width; ++dim) {
        do ++base;
        while (!is_prime(base));
        std::set<size_t> hit;
        for (size_t i = 0; i < std::min(base, x.size()); ++i) hit.insert(part(j, base, x[i][dim]));
        if (hit.size() < base) return dim;
    }
    return x.width;
}

// Over pixels: pairs of what happens to the first digits of two numbers, of bases 5 and 7.
struct Pairs {
    std::set<size_t> shifts, factors;
    bool lopsided = false;  // whether a digit in base 3 has more than half of all
};
Pairs pairs_of(Judge& j) {
    const size_t pixels = 2000;
    const Rows x = paths(j, 5, 0, int(pixels), 2);
    Pairs pairs;
    size_t thirds[4] = {};
    for (size_t p = 0; p < pixels; ++p) {
        const In zero = x[2 * p], one = x[2 * p + 1];
        const size_t a = part(j, 5, zero[2]), b = part(j, 7, zero[3]);
        pairs.shifts.insert(a * 8 + b);
        pairs.factors.insert((part(j, 5, one[2]) + 5 - a) % 5 * 8 +
                             (part(j, 7, one[3]) + 7 - b) % 7);
        ++thirds[part(j, 3, one[1])];
    }
    pairs.lopsided = *std::max_element(thirds, thirds + 4) > pixels / 2;
    return pairs;
}

// Products of numbers of a vertex and of the next one, less their means: a number a pixel.
oracle::Verdict uncorrelated(Judge& j) {
    const size_t pixels = 1000, samples = 16;
    const Rows x = paths(j, j.random.bits() >> 32, 0, int(pixels), int(samples));
    size_t pixel = 0;
    auto product = [&] {
        double sum = 0;
        for (size_t i = pixel * samples; i < (pixel + 1) * samples; ++i)
            for (size_t k = 2; k + of_vertex < x.width; ++k)
                sum += (x[i][k] - 0.5) * (x[i][k + of_vertex] - 0.5);
        ++pixel;
        // In parts of 1/12: the product's mean if both were the same.
        return 12 * sum / double(samples * (x.width - of_vertex - 2));
    };
    return oracle::expect_mean(0, pixels, product);
}

oracle::Verdict uniform_over_pixels(Judge& j, int sample) {
    const Rows x = paths(j, j.random.bits() >> 32, 0, 4000, sample + 1);
    std::vector<uint64_t> counts(17 * x.width);
    for (size_t i = size_t(sample); i < x.size(); i += size_t(sample) + 1)
        for (size_t k = 0; k < x.width; ++k) ++counts[17 * k + part(j, 16, x[i][k])];
    std::vector<double> equal(counts.size());
    for (size_t c = 0; c < counts.size(); ++c)
        equal[c] = c % 17 == 16 ? 0 : 1 / double(16 * x.width);
    return oracle::expect_counts(counts, equal);
}

void dimensions(Judge& j) {
    const Rows here = paths(j, 3, 11, 2, 2), reseeded = paths(j, 4, 11, 1, 1);
    const size_t width = here.width;
    const std::set<double> different(here[0].begin(), here[0].end());
    const size_t again = equal_numbers(here[0], here[1]), pixel = equal_numbers(here[0], here[2]);
    const size_t seed = equal_numbers(here[0], reseeded[0]);
    const size_t empty[] = {empty_boxes(j, {0, 1}), empty_boxes(j, {2, 3}),
                            empty_boxes(j, {2, 2 + of_vertex})};
    j.remember({double(empty_boxes(j, {0}) > 0)});
    std::string alone;
    for (size_t dim : {0, 2, 3})
        if (const size_t parts = empty_boxes(j, {dim}); parts > 0 && alone.empty())
            alone = oracle::say("; even of number %zu alone, whose base is %u, %zu parts of %zu do",
                                dim, primes[dim], parts, 3 * size_t(primes[dim]));
    const Pairs pairs = pairs_of(j);
    // Numbers of one path that are equal, by vertices.
    size_t same_at_next = 0, same_as_first = 0;
    for (size_t k = 2; k + of_vertex < width; ++k)
        same_at_next += here[0][k] == here[0][k + of_vertex];
    for (size_t k = 1; k < width; ++k) same_as_first += here[0][k] == here[0][0];
    j.remember(row(different.size(), again, pixel, seed, empty[0] > 0, empty[1] > 0, empty[2] > 0,
                   pairs.shifts.size(), pairs.factors.size(), pairs.lopsided, same_at_next,
                   same_as_first));

    j.exact("all numbers of a path are different", different.size() == width,
            oracle::say("%zu of %zu are", different.size(), width));
    j.exact("another pixel or another seed has other numbers", pixel + seed == 0,
            oracle::say("%zu and %zu of %zu are the same", pixel, seed, width));
    j.exact("samples of a pixel fill the boxes of two bases: 2 x 3, 5 x 7, 5 x 29",
            empty[0] + empty[1] + empty[2] == 0,
            oracle::say("%zu, %zu and %zu boxes stay empty in three pixels%s", empty[0], empty[1],
                        empty[2], alone.c_str()));
    const size_t other = of_another_base(j);
    j.exact("number k has the k-th prime for its base, as far as a path goes", other == width,
            oracle::say("number %zu has another one", other));
    j.exact("what scrambles one number says nothing of what scrambles the next",
            pairs.shifts.size() == 35 && pairs.factors.size() == 24,
            oracle::say("over 2000 pixels %zu pairs of first digits of 35 are seen, and %zu pairs "
                        "of steps of 24",
                        pairs.shifts.size(), pairs.factors.size()));
    j.statistical("numbers of consecutive vertices are not correlated", uncorrelated(j));
    j.statistical("each number of sample 1 is uniform over the pixels", uniform_over_pixels(j, 1));
}

// ---- 4.4 ----------------------------------------------------------------------------------------

Out in_part(double which, double parts, uint64_t random) { return row(which, parts, bits(random)); }
Out in_cell(double which, double columns, double rows, uint64_t random) {
    return row(which, columns, rows, bits(random));
}

// Of `parts`, those that a random number of theirs has missed.
size_t missed_parts(Judge& j, oracle::Random& random, size_t parts) {
    const Rows x = j.ask("in_part", rows_of(parts, [&](size_t which) {
                             return in_part(double(which), double(parts), random.bits());
                         }));
    size_t missed = 0;
    for (size_t which = 0; which < parts; ++which)
        missed += part(j, parts, x.numbers[which]) != which;
    return missed;
}

// Numbers of the third of five parts, and points of cell 5 of 4 x 3.
Out thirds(Judge& j, oracle::Random& random, size_t n) {
    return j.ask("in_part", rows_of(n, [&](size_t) { return in_part(2, 5, random.bits()); }))
        .numbers;
}
Rows fifths(Judge& j, oracle::Random& random, size_t n) {
    return j.ask("in_cell", rows_of(n, [&](size_t) { return in_cell(5, 4, 3, random.bits()); }));
}

// Where in the third of five parts a number is, of n; the last count: elsewhere.
std::vector<uint64_t> places_in_part(Judge& j, oracle::Random& random, size_t n, size_t draws) {
    std::vector<uint64_t> counts(n + 1);
    for (double x : thirds(j, random, draws)) {
        const size_t place = part(j, 5 * n, x);
        ++counts[place / n == 2 ? place % n : n];
    }
    return counts;
}

// Of a grid's cells, those that have no point after a point of each.
size_t empty_cells(Judge& j, oracle::Random& random, size_t columns, size_t rows) {
    const Rows x =
        j.ask("in_cell", rows_of(columns * rows, [&](size_t cell) {
                  return in_cell(double(cell), double(columns), double(rows), random.bits());
              }));
    std::set<size_t> hit;
    for (size_t i = 0; i < x.size(); ++i) {
        const size_t a = part(j, columns, x[i][0]), b = part(j, rows, x[i][1]);
        if (a < columns && b < rows) hit.insert(a * rows + b);
    }
    return columns * rows - hit.size();
}

// Where in its cell a point is, in n x n; the last count: outside of the square.
std::vector<uint64_t> places_in_cell(Judge& j, oracle::Random& random, size_t n, size_t draws) {
    const Rows x = fifths(j, random, draws);
    std::vector<uint64_t> counts(n * n + 1);
    for (size_t i = 0; i < x.size(); ++i) {
        const double a = x[i][0], b = x[i][1];
        const bool in = a >= 0 && a < 1 && b >= 0 && b < 1;
        ++counts[in ? part(j, 4 * n, a) % n * n + part(j, 3 * n, b) % n : n * n];
    }
    return counts;
}

void strata(Judge& j) {
    oracle::Random fixed(1);
    auto all_missed = [&](oracle::Random& random) {
        size_t missed = 0;
        for (size_t parts : {1, 2, 3, 16, 100}) missed += missed_parts(j, random, parts);
        return missed;
    };
    const std::pair<size_t, size_t> grids[] = {{4, 4}, {4, 3}, {6, 5}, {1, 5}};
    const auto places = places_in_cell(j, fixed, 4, 2000);
    Rows last;
    for (double parts : {1.0, 3.0, 16.0, 100.0, 256.0})
        last.add(in_part(parts - 1, parts, UINT64_MAX));
    const Rows ends = j.ask("in_part", last);
    double first = 0;
    const bool below = in_range(ends, first);
    const auto along = places_in_part(j, fixed, 10, 1000);
    const Out of_third = thirds(j, fixed, 200);
    const double lowest = *std::min_element(of_third.begin(), of_third.end());
    j.remember(row(all_missed(fixed) > 0, without_zeros(places), places.back() > 0,
                   without_zeros(along), along[0] > 0, along.back() > 0, lowest < 0.39, below));
    size_t down = 0;  // of the four places down a cell, those that were met
    for (size_t b = 0; b < 4; ++b)
        down += places[b] + places[4 + b] + places[8 + b] + places[12 + b] > 0;
    // Between which twentieths the third of five parts is, and in which cell of 4 x 3 points of
    // cell 5 are; -1: not in one.
    const double highest = *std::max_element(of_third.begin(), of_third.end());
    const Rows points = fifths(j, fixed, 200);
    Out cell{std::floor(4 * points[0][0]), std::floor(3 * points[0][1])};
    for (size_t i = 0; i < points.size(); ++i) {
        if (std::floor(4 * points[i][0]) != cell[0]) cell[0] = -1;
        if (std::floor(3 * points[i][1]) != cell[1]) cell[1] = -1;
    }
    j.remember(row(std::floor(20 * lowest + 1e-6), std::floor(20 * highest + 1e-6), cell, down));
    for (const auto& [columns, rows] : grids) {
        bool any = false;
        for (int trial = 0; trial < 10; ++trial) any |= empty_cells(j, fixed, columns, rows) > 0;
        j.remember({double(any)});
    }

    size_t missed = 0, empty = 0;
    for (int trial = 0; trial < 20; ++trial) missed += all_missed(j.random);
    for (int trial = 0; trial < 20; ++trial)
        for (const auto& [columns, rows] : grids) empty += empty_cells(j, j.random, columns, rows);
    Rows five;
    for (double which : {0, 1, 2, 3, 4}) five.add(in_part(which, 5, j.random.bits()));
    const Out of_five = j.ask("in_part", five).numbers;
    j.exact("a number is in its part of [0,1)", missed == 0,
            oracle::say("%zu of 2440 are not; numbers of five parts are %.3g, %.3g, %.3g, %.3g and "
                        "%.3g",
                        missed, of_five[0], of_five[1], of_five[2], of_five[3], of_five[4]));
    j.exact("no number is 1, not even with the highest bits in the last part", below,
            oracle::say("one is %.17g", first));
    j.none("every cell of a grid gets its point, of oblong grids, too", empty,
           "%zu of 1260 stay empty");
    j.statistical("a number is anywhere in its part",
                  equal_counts(places_in_part(j, j.random, 64, 20000)));
    j.statistical("a point is anywhere in its cell, across and down independently",
                  equal_counts(places_in_cell(j, j.random, 8, 20000)));
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv,
                         {{"4.1", radical_inverse},
                          {"4.2", scrambled_digits},
                          {"4.3", dimensions},
                          {"4.4", strata}});
}

// voronoi/weights_test.cpp  Voronoi weights: sums, constants, and biases where the theory has any
#include "voronoi/weights.h"

#include "voronoi/scattered.h"

namespace {

constexpr Weighting all[] = {Weighting::mc, Weighting::vor, Weighting::fvor, Weighting::cvor,
                             Weighting::torus};

// The weighted sum of f over n samples.
template <class F>
double estimate(Weigher& weigher, Weighting kind, uint64_t n, oracle::Random& random, F f) {
    const auto samples = scattered(n, random);
    const auto& w = weigher(kind, samples, random.bits());
    double sum = 0;
    for (size_t i = 0; i < samples.size(); ++i) sum += w[i] * f(samples[i]);
    return sum;
}

double tilted_bowl(Site p) { return p.x * p.x + 2 * p.y * p.y + p.x; }
constexpr double mean_of_bowl = 1.0 / 3 + 2.0 / 3 + 0.5;

// Opposite sides have the same values: on a torus it is continuous.  Its Laplacian is -4.
double bump(Site p) { return p.x * (1 - p.x) + p.y * (1 - p.y); }

// cvor minus the unbiased torus of the same samples: the bias with little noise.
struct Pair {
    Weigher clipped, torus;

    double error(uint64_t n, oracle::Random& random) {
        const auto samples = scattered(n, random);
        const auto& w = clipped(Weighting::cvor, samples, 0);
        const auto& unbiased = torus(Weighting::torus, samples, 0);
        double sum = 0;
        for (size_t i = 0; i < samples.size(); ++i) sum += (w[i] - unbiased[i]) * bump(samples[i]);
        return sum;
    }
};

}  // namespace

TEST_CASE("divided weights add up to 1, so that constants come out exactly, from n = 1 on") {
    oracle::Random random(seed_here());
    Weigher weigher;
    for (Weighting kind : all)
        for (uint64_t n : {1, 2, 3, 5, 17, 64, 300}) {
            const double sum = estimate(weigher, kind, n, random, [](Site) { return 1.0; });
            INFO("weighting ", int(kind), ", n = ", n);
            CHECK(std::abs(sum - 1) <= 1e-12 * double(n));
        }
}

TEST_CASE("the strip's width solves n 4 u e^-u = p, u = pi n width^2") {
    for (double n : {1.0, 64.0, 4096.0, 1e6})
        for (double p : {1e-3, 1e-6}) {
            const double u = std::numbers::pi * n * strip_width(n, p) * strip_width(n, p);
            CHECK(4 * n * u * std::exp(-u) == doctest::Approx(p).epsilon(1e-10));
            CHECK(u > 1);
        }
}

TEST_CASE("Poisson numbers: mean and variance") {
    for (double mean : {0.3, 5.0, 40.0})
        for (bool variance : {false, true}) {
            Rng rng{seed_here()};
            const oracle::Verdict v = oracle::expect_mean(mean, 3000, [&] {
                double sum = 0;
                for (int k = 0; k < 64; ++k) {
                    const double x = double(poisson(mean, rng));
                    sum += (variance ? (x - mean) * (x - mean) : x) / 64;
                }
                return sum;
            });
            EXPECT(v, 0.06);
        }
}

TEST_CASE("vor, undivided: unbiased for a Poisson process (Slivnyak, Mecke), strip and all") {
    oracle::Random random(seed_here());
    Weigher weigher;
    weigher.divide = false;
    weigher.intensity = 25;
    const oracle::Verdict v = oracle::expect_mean(mean_of_bowl, 15000, [&] {
        Rng rng{random.bits()};
        const uint64_t n = poisson(weigher.intensity, rng);
        return n ? estimate(weigher, Weighting::vor, n, random, tilted_bowl) : 0;
    });
    EXPECT(v, 0.022);
    CHECK(weigher.redraws < 30);  // at most p = 0.001 each
}

TEST_CASE("vor, divided: its bias is that of its border, and falls faster than 1/n") {
    // X = sum A (f - mean of f) has mean 0, and S = sum A has mean 1.  So X / S - X has the mean of
    // -X (S - 1).  Only cells at the border make S differ from 1, equally all along the border:
    //   E X (S - 1) -> Var S (mean of f on the border - mean of f),  Var S = O(n^-3/2).
    // The test subtracts this limit; O(n^-2) is left.
    constexpr double on_border = (5.0 / 6 + 17.0 / 6 + 2.0 / 3 + 8.0 / 3) / 4;  // one term per side
    oracle::Random random(seed_here());
    Weigher weigher;
    weigher.divide = false;
    weigher.unbounded = 1e-9;  // with larger values rare huge cells spoil the mean
    const oracle::Verdict v = oracle::expect_bias_decay(0, 32, 10000, [&](uint64_t n) {
        weigher.intensity = double(n);
        Rng rng{random.bits()};
        const auto samples = scattered(poisson(double(n), rng), random);
        const auto& w = weigher(Weighting::vor, samples, random.bits());
        double x = 0, s = 0;
        for (size_t i = 0; i < samples.size(); ++i) {
            x += w[i] * (tilted_bowl(samples[i]) - mean_of_bowl);
            s += w[i];
        }
        return x / s - x + (s - 1) * (s - 1) * (on_border - mean_of_bowl);
    });
    EXPECT(v, 0.036);
}

TEST_CASE("vor draws its strip anew until every cell is bounded, whichever is not") {
    oracle::Random random(seed_here());
    Weigher weigher;
    weigher.unbounded = 20;  // a bound this large makes a narrow strip
    int without_weight = 0;
    for (int k = 0; k < 400; ++k)
        for (double w : weigher(Weighting::vor, scattered(20, random), random.bits()))
            without_weight += w == 0;
    CHECK(weigher.redraws > 100);
    CHECK(weigher.fallbacks == 0);
    CHECK(without_weight == 0);
}

TEST_CASE("fvor without a cell inside falls back to the plain mean, and counts it") {
    oracle::Random random(seed_here());
    Weigher weigher;
    weigher.intensity = 1e-3;  // a strip of this width is empty
    uint64_t uniform = 0;
    for (int k = 0; k < 400; ++k) {
        const auto& w = weigher(Weighting::fvor, scattered(3, random), random.bits());
        uniform += w[0] == w[1] && w[1] == w[2];
    }
    CHECK(weigher.fallbacks > 20);
    CHECK(weigher.fallbacks == uniform);
}

TEST_CASE("torus: unbiased, however few the samples") {
    oracle::Random random(seed_here());
    Weigher weigher;
    for (uint64_t n : {1, 2, 3, 10}) {
        const oracle::Verdict v = oracle::expect_mean(mean_of_bowl, 20000, [&] {
            return estimate(weigher, Weighting::torus, n, random, tilted_bowl);
        });
        EXPECT(v, 0.04);
    }
}

TEST_CASE("clipped: n times the bias has the limit that the border's half-plane gives") {
    // Samples near a border sit on its inner side.  For sites of intensity 1 in a half-plane, the
    // displacement from a point to its nearest site, integrated over the distance of the point, is
    //   c = int_0^1 sqrt(1 - s^2) / k(s)^2 ds,  k = pi - acos s + s sqrt(1 - s^2)
    // inwards; inside, E r^2 = 1/pi.  With f to second order and Gauss's theorem,
    //   n bias -> (1/(4 pi) - c) integral of the Laplacian of f.
    double c = 0;
    constexpr int steps = 100000;  // midpoint rule
    for (int k = 0; k < steps; ++k) {
        const double s = (k + 0.5) / steps, root = std::sqrt(1 - s * s);
        const double area = std::numbers::pi - std::acos(s) + s * root;
        c += root / (area * area) / steps;
    }
    CHECK(c == doctest::Approx(1 / (2 * std::numbers::pi)).epsilon(1e-6));
    const double limit = (1 / (4 * std::numbers::pi) - c) * -4;  // for bump: 1/pi
    oracle::Random random(seed_here());
    Pair pair;
    const oracle::Verdict v = oracle::expect_bias_decay(
        limit, 256, 1250, [&](uint64_t n) { return pair.error(n, random); });
    EXPECT(v, 0.17);
}

TEST_CASE("gradients, reconstruction and border correction are exact for planes") {
    oracle::Random random(seed_here());
    Voronoi v;
    v.with_neighbours = true;
    // A jittered lattice: no cell has collinear neighbours.
    std::vector<Site> sites;
    for (int i = 0; i < 400; ++i) {
        const double x = i % 20 + 0.2 + 0.6 * random(), y = i / 20 + 0.2 + 0.6 * random();
        sites.push_back({x / 20, y / 20});
    }
    const auto& cells = v.clipped(sites, unit_square);
    std::vector<double> plane;
    for (const Site& p : sites) plane.push_back(3 * p.x - 2 * p.y + 1);
    for (size_t i = 0; i < sites.size(); ++i) {
        const Site g = gradient(v, sites, plane, i);
        CHECK(g.x == doctest::Approx(3).epsilon(1e-9));
        CHECK(g.y == doctest::Approx(-2).epsilon(1e-9));
    }
    CHECK(linear_reconstruction(v, cells, sites, plane) == doctest::Approx(1.5).epsilon(1e-12));
    CHECK(std::abs(border_correction(v, cells, sites, plane)) < 1e-12);
}

TEST_CASE("border correction: 4 pi n times it tends to the integral of the outward derivative") {
    // For the bowl, the integral of the Laplacian is 6.  At the border all neighbours are on one
    // side: gradients err by O(n^-1/2). 2 C(4n) - C(n) cancels that and leaves O(1/n), some 0.003
    // here.
    oracle::Random random(seed_here());
    Voronoi v;
    v.with_neighbours = true;
    auto scaled_correction = [&](uint64_t n) {
        const auto sites = scattered(n, random);
        std::vector<double> f;
        for (const Site& p : sites) f.push_back(tilted_bowl(p));
        const auto& cells = v.clipped(sites, unit_square);
        return 4 * std::numbers::pi * double(n) * border_correction(v, cells, sites, f);
    };
    const oracle::Verdict verdict = oracle::expect_mean(6, 500, [&] {
        const double coarse = scaled_correction(256), fine = scaled_correction(1024);
        return 2 * fine - coarse;
    });
    EXPECT(verdict, 0.012);
}

TEST_CASE("a site whose neighbours are in line has no gradient, nor has one of two") {
    Voronoi v;
    v.with_neighbours = true;
    const std::vector<Site> sites = {{0.2, 0.5}, {0.7, 0.5}};
    v.clipped(sites, unit_square);
    const std::vector<double> f = {1, 2};
    CHECK(gradient(v, sites, f, 0).x == 0);
    // The middle has neighbours to the east and west, one of them rotated.  The plane's slopes are
    // determined only if the rotation is large enough.
    for (double turn : {0.02, 0.5}) {
        const std::vector<Site> line = {
            {0.5, 0.5}, {0.9, 0.5}, {0.5 - 0.4 * std::cos(turn), 0.5 - 0.4 * std::sin(turn)}};
        v.clipped(line, unit_square);
        const std::vector<double> plane = {1, 1 + 0.4 * 3, 1 - 0.4 * 3 * std::cos(turn)};
        CHECK(gradient(v, line, plane, 0).x == doctest::Approx(turn > 0.1 ? 3 : 0).epsilon(1e-9));
    }
}
